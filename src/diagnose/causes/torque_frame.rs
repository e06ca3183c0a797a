//! A torque that is in the world and is used as if it were in the body, or the other way.

use super::{Cause, Judge};
use crate::diagnose::law::{Law, Torque};

pub(super) const IN_BODY: Cause = Cause {
    id: "torque-in-body-frame",
    symptom: "fine until the body turns; a thruster or motor pushes along with it, or does not",
    test: "α follows R τ or Rᵀ τ, not τ",
    does: "takes a world torque for one in body axes, or a body torque for one in the world",
    formula: "α_w = I_w⁻¹ τ_w; τ_w = R τ_b",
    remedy: "say in which frame a torque is, in its name, and turn it once",
    example: "a tumbling body under a torque that is steady in the world",
    judge: Judge::Laws(&[
        Law::RIGHT.torque(Torque::TakenForBody),
        Law::RIGHT.torque(Torque::LeftInBody),
    ]),
};
