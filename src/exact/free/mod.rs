//! The free rigid body: attitude and angular velocity at any time, in closed form.
//!
//! `dm/dt = m × I⁻¹ m`, `dq/dt = ½ q (ω_b, 0)`, m = I ω_b in principal axes, no torque.
//!
//! m are Jacobi's elliptic functions; the attitude is two theta series and a steady precession
//! about L (Jacobi 1849; van Zon & Schofield, J. Comput. Phys. 225, 2007; Celledoni, Fassò,
//! Säfström & Zanna, SIAM J. Sci. Comput. 30, 2008). Three things keep it to a few 1e-15 rad at
//! any time, for any body:
//!
//! - the two rates (of the phase in the series, of the precession) are double-double, from one
//!   AGM loop, and the phases are reduced in double-double: no loss over 1e9 s;
//! - every quantity is a sum of positive terms, moments entering by their differences: nothing
//!   cancels for thin or nearly symmetric bodies;
//! - which side of the separatrix a motion is on, and how near, is decided exactly.
//!
//! Degenerate cases: rotation about a principal axis and the spherical body are steady rotations;
//! symmetric bodies need no branch of their own (A = 0: one series becomes constant); on the
//! separatrix the elliptic functions become hyperbolic (Λ = 0, Q' = 0).

mod branch;
mod constants;
mod series;
#[cfg(test)]
mod tests;

use crate::math::Dd;
use crate::math::dd::nearest;
use branch::Branch;
use constants::Constants;
use nalgebra::{Quaternion, Vector3};
use series::{Series, times};
use std::f64::consts::PI;

/// A torque-free motion, set up once and evaluated at any time.
#[derive(Clone, Debug)]
pub struct FreeMotion {
    moments: Vector3<f64>,
    /// Angular momentum in the world.
    momentum_w: Vector3<f64>,
    kind: Kind,
}

#[derive(Clone, Debug)]
enum Kind {
    /// `q = q0 exp(ω t/2)`, ω in principal axes, `|ω|/4π` in double-double.
    Steady {
        q0: Quaternion<f64>,
        axis: Vector3<f64>,
        turns: Dd,
        omega: Vector3<f64>,
    },
    Theta(Box<Theta>),
}

/// The theta form in axes 1, 2, 3: 3 the one the momentum circles, 2 the middle one.
#[derive(Clone, Debug)]
struct Theta {
    /// Left and right constants: `q(t) = left · q_b(t) · right`.
    left: Quaternion<f64>,
    right: Quaternion<f64>,
    /// σΛ/π and Ω/4π, 1/s; σ = ±1 is the branch.
    lambda_turns: Dd,
    omega_turns: Dd,
    /// σΛ t0 / π.
    offset: Dd,
    series: Series,
}

impl FreeMotion {
    /// From principal moments (kg m², above zero), the attitude q0 (principal axes → world) and
    /// the angular velocity in principal axes (rad/s), both at t = 0.
    pub fn new(moments: Vector3<f64>, q0: Quaternion<f64>, omega_p: Vector3<f64>) -> Self {
        let momentum_p = moments.component_mul(&omega_p);
        Self {
            moments,
            momentum_w: turn(q0, momentum_p),
            kind: kind(moments, q0, omega_p),
        }
    }

    /// The attitude (principal axes → world) at `t` seconds, of either sign.
    pub fn attitude(&self, t: f64) -> Quaternion<f64> {
        self.attitude_after(t)
    }

    /// Attitude and angular velocity in principal axes, `ω = I⁻¹ Rᵀ L`.
    pub fn at(&self, t: f64) -> (Quaternion<f64>, Vector3<f64>) {
        self.after(t)
    }

    pub(super) fn attitude_after(&self, t: impl Time) -> Quaternion<f64> {
        match &self.kind {
            Kind::Steady {
                q0, axis, turns, ..
            } => {
                let (cos, sin) = whole_turns_off(t.times(*turns));
                q0 * Quaternion::from_parts(cos, axis * sin)
            }
            Kind::Theta(theta) => theta.left * theta.at(t) * theta.right,
        }
    }

    pub(super) fn after(&self, t: impl Time) -> (Quaternion<f64>, Vector3<f64>) {
        let q = self.attitude_after(t);
        let omega = match &self.kind {
            Kind::Steady { omega, .. } => *omega,
            Kind::Theta(_) => turn(q.conjugate(), self.momentum_w).component_div(&self.moments),
        };
        (q, omega)
    }
}

/// A time in as many digits as it has.
pub(super) trait Time: Copy {
    fn times(self, rate: Dd) -> Dd;
    fn rough(self) -> f64;
}

impl Time for f64 {
    fn times(self, rate: Dd) -> Dd {
        rate * self
    }
    fn rough(self) -> f64 {
        self
    }
}

impl Time for Dd {
    fn times(self, rate: Dd) -> Dd {
        rate * self
    }
    fn rough(self) -> f64 {
        self.to_f64()
    }
}

/// `R(q) v`.
fn turn(q: Quaternion<f64>, v: Vector3<f64>) -> Vector3<f64> {
    let u = q.imag();
    let t = u.cross(&v) * 2.0;
    v + t * q.w + u.cross(&t)
}

/// Cosine and sine of 2π times a number of turns, reduced in double-double.
fn whole_turns_off(turns: Dd) -> (f64, f64) {
    let (part, _) = turns.fraction();
    let (sin, cos) = libm::sincos(2.0 * PI * part);
    (cos, sin)
}

/// Components of ω below this part of the largest have squares that underflow beside it, and are
/// felt at no time: but about a middle axis, which they make the motion leave in the end.
const VANISHING: f64 = 1e-140;

fn kind(i: Vector3<f64>, q0: Quaternion<f64>, w: Vector3<f64>) -> Kind {
    // Units of its own: moments and rates near 1, exactly, by powers of two.
    let scale_w = power_of_two(w.amax());
    let i = i / power_of_two(i.amax());
    let mut w = w / scale_w;
    if !is_middle(i, w.iamax()) {
        w = w.map(|x| if x.abs() < VANISHING { 0.0 } else { x });
    }
    // dω/dt = 0: each product (I_j - I_k) ω_j ω_k has a factor that is zero.
    let zero = |j: usize, k: usize| i[j] == i[k] || w[j] == 0.0 || w[k] == 0.0;
    let kind = if zero(1, 2) && zero(2, 0) && zero(0, 1) {
        steady_rotation(q0, w)
    } else {
        Kind::Theta(Box::new(Theta::new(i, q0, w)))
    };
    kind.in_time_units_of(scale_w)
}

/// Whether one moment is below that of `axis` and one above.
fn is_middle(i: Vector3<f64>, axis: usize) -> bool {
    i.min() < i[axis] && i[axis] < i.max()
}

fn power_of_two(x: f64) -> f64 {
    if x == 0.0 {
        1.0
    } else {
        libm::exp2(libm::floor(libm::log2(x)))
    }
}

impl Kind {
    /// The same motion with rates `scale` times as large.
    fn in_time_units_of(self, scale: f64) -> Self {
        match self {
            Self::Steady {
                q0,
                axis,
                turns,
                omega,
            } => Self::Steady {
                q0,
                axis,
                turns: turns.scaled(scale),
                omega: omega * scale,
            },
            Self::Theta(mut theta) => {
                theta.lambda_turns = theta.lambda_turns.scaled(scale);
                theta.omega_turns = theta.omega_turns.scaled(scale);
                if let Series::Separatrix { rate, .. } = &mut theta.series {
                    *rate *= scale;
                }
                Self::Theta(theta)
            }
        }
    }
}

fn steady_rotation(q0: Quaternion<f64>, omega: Vector3<f64>) -> Kind {
    let squares = omega
        .iter()
        .map(|&x| Dd::product(x, x))
        .fold(Dd::ZERO, |a, b| a + b);
    let rate = squares.sqrt();
    let axis = if rate.hi == 0.0 {
        Vector3::zeros()
    } else {
        omega / rate.hi
    };
    Kind::Steady {
        q0,
        axis,
        turns: rate / Dd::PI.scaled(4.0),
        omega,
    }
}

impl Theta {
    fn new(i: Vector3<f64>, q0: Quaternion<f64>, w: Vector3<f64>) -> Self {
        let branch = Branch::choose(i, w);
        let c = Constants::new(&branch);
        let q_s = branch.permutation;
        let rate = c.lambda / Dd::PI * branch.sigma;
        let mut theta = Self {
            left: Quaternion::identity(),
            right: q_s,
            lambda_turns: rate,
            omega_turns: c.omega / Dd::PI.scaled(4.0),
            offset: rate * c.t0,
            series: c.series(),
        };
        let start = theta.at(0.0) * q_s;
        theta.left = q0 * start.conjugate();
        theta
    }

    /// `q_b(t)`, unit: `e^{iΩt/2} (α, β)` as (w + iz, x + iy).
    fn at(&self, t: impl Time) -> Quaternion<f64> {
        let (mut turns, _) = t.times(self.omega_turns).fraction();
        let (alpha, beta) = match &self.series {
            Series::Nome(series) => {
                let (nu, odd) = self.phase(t);
                series.at(nu, odd)
            }
            Series::Complementary {
                terms,
                y_per,
                turns_per,
            } => {
                let (nu, odd) = self.phase(t);
                turns += nu * turns_per;
                turns -= nearest(turns);
                terms.at(y_per * nu, odd)
            }
            Series::Separatrix { terms, rate, y0 } => terms.at(rate * t.rough() + y0, false),
        };
        let square = |(re, im): (f64, f64)| re * re + im * im;
        let norm = 1.0 / (square(alpha) + square(beta)).sqrt();
        let (sin, cos) = libm::sincos(2.0 * PI * turns);
        let turn = (cos * norm, sin * norm);
        let ((w, z), (x, y)) = (times(alpha, turn), times(beta, turn));
        Quaternion::new(w, x, y, z)
    }

    /// ν reduced to [-π/2, π/2], and whether an odd number of π was taken off.
    fn phase(&self, t: impl Time) -> (f64, bool) {
        let (part, whole) = (t.times(self.lambda_turns) + self.offset).fraction();
        let half = 0.5 * whole;
        (PI * part, half != nearest(half))
    }
}
