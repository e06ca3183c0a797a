//! Four numbers that go through arithmetic together, lane by lane: a register of AVX2.

use crate::math::dd::two_sum;
use nalgebra::Vector3;
use std::ops::{Add, AddAssign, Mul, Sub};

#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(32))]
pub struct Four(pub [f64; 4]);

impl Four {
    /// The largest in size; not a number where one is none.
    pub fn largest(&self) -> f64 {
        self.0.iter().fold(0.0, |most, c| larger(most, c.abs()))
    }

    /// The sum, and what it rounded away.
    #[inline(always)]
    pub fn plus(self, b: Self) -> (Self, Self) {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, b.0);
        let [a, b, c, d] = [two_sum(a, e), two_sum(b, f), two_sum(c, g), two_sum(d, h)];
        (Self([a.0, b.0, c.0, d.0]), Self([a.1, b.1, c.1, d.1]))
    }

    /// The first three.
    #[inline(always)]
    pub fn vector(&self) -> Vector3<f64> {
        let [x, y, z, _] = self.0;
        Vector3::new(x, y, z)
    }

    #[inline(always)]
    fn lanes(a: Self, b: Self, of: impl Fn(f64, f64) -> f64) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (a.0, b.0);
        Self([of(a, e), of(b, f), of(c, g), of(d, h)])
    }
}

impl From<Vector3<f64>> for Four {
    /// With a 0 behind.
    fn from(v: Vector3<f64>) -> Self {
        Self([v.x, v.y, v.z, 0.0])
    }
}

/// Unlike `f64::max`, not a number where either is none.
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

impl Add for Four {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self::lanes(self, b, |a, b| a + b)
    }
}

impl AddAssign for Four {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl Sub for Four {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self::lanes(self, b, |a, b| a - b)
    }
}

impl Mul for Four {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        Self::lanes(self, b, |a, b| a * b)
    }
}

impl Mul<f64> for Four {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: f64) -> Self {
        self * Self([b; 4])
    }
}
