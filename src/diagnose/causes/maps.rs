//! Which tensor stands for I in the world: `R I Rᵀ` is right, `I`, `Rᵀ I R` and an I that is never inverted are not.

use super::{Cause, Judge};
use crate::diagnose::law::{Inertia, Law, Map};

pub(super) const NOT_ROTATED: Cause = Cause {
    id: "inertia-not-rotated",
    symptom: "fine when axis-aligned, wrong when tilted",
    test: "α in the world is I⁻¹ τ with I in body axes, whatever the attitude",
    does: "uses the body's inertia with world vectors",
    formula: "I_w⁻¹ = R I⁻¹ Rᵀ",
    remedy: "rotate the inverse inertia at every step",
    example: "a tilted, unequal body under a torque in several directions",
    judge: Judge::Laws(&[Law::RIGHT.map(Map::NotRotated)]),
};

pub(super) const BACKWARDS: Cause = Cause {
    id: "inertia-rotated-backwards",
    symptom: "fine when axis-aligned, wrong when tilted; worse the more it is tilted",
    test: "α in the world is that of Rᵀ I R",
    does: "transposes on the wrong side",
    formula: "I_w = R I Rᵀ, R body to world",
    remedy: "swap R and Rᵀ; check against a body turned by 90° about an axis",
    example: "a tilted, unequal body under a torque in several directions",
    judge: Judge::Laws(&[Law::RIGHT.map(Map::Backwards)]),
};

pub(super) const NOT_INVERTED: Cause = Cause {
    id: "inertia-not-inverted",
    symptom: "heavy bodies turn more easily than light ones",
    test: "α is I τ, not I⁻¹ τ",
    does: "multiplies by the inertia where it must divide",
    formula: "α = I⁻¹ τ",
    remedy: "invert the tensor (entry by entry only where it is diagonal)",
    example: "an unequal body under a torque",
    judge: Judge::Laws(&[
        Law::RIGHT.map(Map::NotInverted),
        Law::RIGHT.inertia(Inertia::Inverse),
    ]),
};
