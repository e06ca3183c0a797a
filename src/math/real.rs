//! What the algorithms of this room ask of a number, so that one text serves f64 and double-double.

use super::Dd;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number in some precision.
pub trait Real:
    Copy
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The gap between 1 and its neighbour, or what stands for it.
    const EPSILON: f64;
    /// `q` with `q⁸/10` below rounding: how near to each other Carlson's series want arguments.
    const SPREAD: f64;
    const PI: Self;

    /// Exact.
    fn real(x: f64) -> Self;
    fn to_f64(self) -> f64;
    fn abs(self) -> Self;
    fn sqrt(self) -> Self;
    fn sin_cos(self) -> (Self, Self);
    fn exp(self) -> Self;
    /// `e^x - 1`, to a relative rounding for small x.
    fn exp_m1(self) -> Self;
}

impl Real for f64 {
    const EPSILON: f64 = f64::EPSILON;
    const SPREAD: f64 = 8e-3;
    const PI: Self = std::f64::consts::PI;

    fn real(x: f64) -> Self {
        x
    }
    fn to_f64(self) -> f64 {
        self
    }
    fn abs(self) -> Self {
        f64::abs(self)
    }
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    fn sin_cos(self) -> (Self, Self) {
        libm::sincos(self)
    }
    fn exp(self) -> Self {
        libm::exp(self)
    }
    fn exp_m1(self) -> Self {
        libm::expm1(self)
    }
}

impl Real for Dd {
    const EPSILON: f64 = 5e-32; // 2⁻¹⁰⁴
    const SPREAD: f64 = 1.2e-4;
    const PI: Self = Dd::PI;

    fn real(x: f64) -> Self {
        Dd::new(x)
    }
    fn to_f64(self) -> f64 {
        Dd::to_f64(self)
    }
    fn abs(self) -> Self {
        Dd::abs(self)
    }
    fn sqrt(self) -> Self {
        Dd::sqrt(self)
    }
    fn sin_cos(self) -> (Self, Self) {
        Dd::sin_cos(self)
    }
    fn exp(self) -> Self {
        Dd::exp(self)
    }
    fn exp_m1(self) -> Self {
        Dd::exp_m1(self)
    }
}
