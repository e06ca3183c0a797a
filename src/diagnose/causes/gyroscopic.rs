//! ```text
//! ρ = Σ (α - I⁻¹τ)·α_g / Σ α_g·α_g,   α_g = -I⁻¹ (ω × Iω)
//! ```
//!
//! 1 where it is right, 0 where the term is missing, -1 where its sign is wrong.

use super::{Cause, Judge};
use crate::diagnose::law::{Gyroscopic, Law};

pub(super) const MISSING: Cause = Cause {
    id: "gyroscopic-missing",
    symptom: "a steady, \"boring\" spin; the middle axis never flips, a top does not precess",
    test: "ω obeys α = I⁻¹ τ, without -I⁻¹ (ω × Iω): the coefficient of that term is 0, not 1",
    does: "keeps the angular velocity where nothing acts, instead of the angular momentum",
    formula: "α = I⁻¹ (τ - ω × Iω)",
    remedy: "add the gyroscopic term, and a method that stays stable with it (implicit, or exact)",
    example: "unequal moments, a spin off the axes, no torque",
    judge: Judge::Laws(&[Law::RIGHT.gyroscopic(Gyroscopic::Off)]),
};

pub(super) const SIGN: Cause = Cause {
    id: "gyroscopic-sign",
    symptom: "precesses the wrong way; blows up",
    test: "the coefficient of the gyroscopic term is -1",
    does: "adds ω × Iω to the torque",
    formula: "α = I⁻¹ (τ - ω × Iω)",
    remedy: "subtract it (or swap the factors of the product)",
    example: "unequal moments, a spin off the axes, no torque",
    judge: Judge::Laws(&[Law::RIGHT.gyroscopic(Gyroscopic::Reversed)]),
};

pub(super) const DIAGONAL_ONLY: Cause = Cause {
    id: "gyroscopic-diagonal-only",
    symptom: "right for boxes, wrong for bodies with products of inertia",
    test: "ω obeys Euler's equation with the diagonal of I in the gyroscopic term and all of it elsewhere",
    does: "takes the three diagonal entries of I for the gyroscopic term",
    formula: "α = I⁻¹ (τ - ω × Iω), the same I in both",
    remedy: "the whole tensor, or everything in principal axes",
    example: "a body with products of inertia that tumbles",
    judge: Judge::Laws(&[Law::RIGHT.gyroscopic(Gyroscopic::DiagonalOnly)]),
};
