//! How long what acts goes on acting: for one step, whatever the sub-steps.

use super::{Cause, Judge};
use crate::diagnose::law::{Law, Life};

pub(super) const LIFETIME: Cause = Cause {
    id: "force-lifetime",
    symptom: "depends on the number of sub-steps; keeps accelerating after the push",
    test: "α follows the sum of all that ever acted, or of two steps, or what acted last; or torque and force alike act for a part of the step",
    does: "clears forces after the first sub-step, a step too late, or never",
    formula: "h Σ f per step: a force acts for the whole step and for that step only",
    remedy: "clear forces after the last sub-step of the step",
    example: "pulses of a force, positions logged",
    judge: Judge::Laws(&[
        Law::RIGHT.life(Life::Ever),
        Law::RIGHT.life(Life::TwoSteps),
        Law::RIGHT.life(Life::UntilNext),
    ]),
};
