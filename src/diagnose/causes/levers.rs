//! `τ = (p - c) × f`: from where the lever goes. A body that begins at the world's origin and stays there tells none of them apart.

use super::{Cause, Judge};
use crate::diagnose::law::{Law, Lever};

pub(super) const STALE: Cause = Cause {
    id: "lever-point-stale",
    symptom: "right at first; the further a body has gone, the wilder a push turns it",
    test: "α follows the levers from where the centre of mass was at first",
    does: "keeps the centre of mass in the world from when the body was made, or does not update it before forces are added",
    formula: "τ = (p - c) × f with c as it is now",
    remedy: "update the centre of mass in the world at every step, before forces are added",
    example: "a force at a point of a body that has travelled",
    judge: Judge::Laws(&[Law::RIGHT.lever(Lever::FirstCentre)]),
};

pub(super) const FROM_ORIGIN: Cause = Cause {
    id: "lever-from-origin",
    symptom: "a push through the centre turns the body; the same push does something else elsewhere in the world",
    test: "α follows the levers from the world's origin, or from the body's instead of its centre of mass",
    does: "p × f, or (p - x) × f with the body's origin for x",
    formula: "τ = (p - c) × f, c the centre of mass in the world",
    remedy: "subtract the centre of mass",
    example: "a force at a point of a body away from the origin",
    judge: Judge::Laws(&[
        Law::RIGHT.lever(Lever::WorldOrigin),
        Law::RIGHT.lever(Lever::BodyOrigin),
    ]),
};
