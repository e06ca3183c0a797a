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
//!   AGM loop, and the phases are reduced to turns in double-double: no loss over 1e9 s;
//! - every quantity is a sum of positive terms, moments entering by their differences: nothing
//!   cancels for thin or nearly symmetric bodies;
//! - which side of the separatrix a motion is on, and how near, is decided exactly.
//!
//! Degenerate cases: rotation about a principal axis and the spherical body are steady rotations;
//! symmetric bodies need no branch of their own (A = 0: one series becomes constant); on the
//! separatrix the elliptic functions become hyperbolic (Λ = 0, Q' = 0).

mod branch;
mod constants;
mod means;
mod series;
#[cfg(test)]
mod tests;

use crate::math::{Dd, Phase, sin_cos_turns};
use branch::Branch;
use constants::{Constants, Form, Pair};
use multiversion::multiversion;
use nalgebra::{Quaternion, Vector3};
use series::{Complex, times};

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
    Steady(Steady),
    Theta(Theta),
}

/// `q = q0 exp(ω t/2)`, ω in principal axes, `|ω|/4π` in double-double.
#[derive(Clone, Debug)]
struct Steady {
    q0: Quaternion<f64>,
    axis: Vector3<f64>,
    turns: Dd,
    omega: Vector3<f64>,
}

/// The theta form in axes 1, 2, 3: 3 the one the momentum circles, 2 the middle one.
#[derive(Clone, Debug)]
struct Theta {
    /// What q(t) is made of by w, x, y, z of `q_b(t)`, the attitude about L.
    columns: [Quaternion<f64>; 4],
    /// Ω/4π, 1/s; σ = ±1 is the branch.
    turns: Dd,
    form: Form,
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

    /// The attitudes at so many instants: the bits that [`attitude`](Self::attitude) has, several
    /// times as fast.
    ///
    /// `attitudes` is as long as `times`.
    pub fn attitudes(&self, times: &[f64], attitudes: &mut [Quaternion<f64>]) {
        match &self.kind {
            Kind::Steady(steady) => fill(steady, times, attitudes),
            Kind::Theta(theta) => match &theta.form {
                Form::Nome(form) => fill(&(theta, form), times, attitudes),
                Form::Complementary(form) => fill(&(theta, form), times, attitudes),
                Form::Separatrix(form) => fill(&(theta, form), times, attitudes),
            },
        }
    }

    pub(super) fn attitude_after(&self, t: impl Time) -> Quaternion<f64> {
        match &self.kind {
            Kind::Steady(steady) => steady.at(t),
            Kind::Theta(theta) => match &theta.form {
                Form::Nome(form) => (theta, form).at(t),
                Form::Complementary(form) => (theta, form).at(t),
                Form::Separatrix(form) => (theta, form).at(t),
            },
        }
    }

    pub(super) fn after(&self, t: impl Time) -> (Quaternion<f64>, Vector3<f64>) {
        let q = self.attitude_after(t);
        let omega = match &self.kind {
            Kind::Steady(steady) => steady.omega,
            Kind::Theta(_) => turn(q.conjugate(), self.momentum_w).component_div(&self.moments),
        };
        (q, omega)
    }
}

/// A time in as many digits as it has.
pub(super) trait Time: Copy {
    /// `t rate`, a phase in turns.
    fn gone(self, rate: Dd) -> Phase;
}

impl Time for f64 {
    #[inline(always)]
    fn gone(self, rate: Dd) -> Phase {
        Phase::gone(self, rate)
    }
}

impl Time for Dd {
    #[inline(always)]
    fn gone(self, rate: Dd) -> Phase {
        let phase = Phase::gone(self.hi, rate);
        Phase {
            rest: phase.rest + self.lo * rate.hi,
            ..phase
        }
    }
}

/// What has an attitude at any time, by one line of arithmetic without a branch: for lanes.
trait Motion {
    fn at(&self, t: impl Time) -> Quaternion<f64>;
}

/// Instants that go through the arithmetic side by side.
const LANES: usize = 8;

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn fill<M: Motion>(motion: &M, times: &[f64], attitudes: &mut [Quaternion<f64>]) {
    let (blocks, rest) = times.as_chunks::<LANES>();
    let (filled, last) = attitudes.split_at_mut((blocks.len() * LANES).min(attitudes.len()));
    for (times, attitudes) in blocks.iter().zip(filled.chunks_mut(LANES)) {
        let mut block = [[0.0; LANES]; 4];
        for lane in 0..LANES {
            let q = motion.at(times[lane]);
            for (component, of) in block.iter_mut().zip(q.coords.iter()) {
                component[lane] = *of;
            }
        }
        for (lane, q) in attitudes.iter_mut().enumerate() {
            let [x, y, z, w] = block.map(|component| component[lane]);
            *q = Quaternion::new(w, x, y, z);
        }
    }
    for (t, q) in rest.iter().zip(last) {
        *q = motion.at(*t);
    }
}

impl Motion for Steady {
    #[inline(always)]
    fn at(&self, t: impl Time) -> Quaternion<f64> {
        let (sin, cos) = sin_cos_turns(t.gone(self.turns).reduced());
        self.q0 * Quaternion::from_parts(cos, self.axis * sin)
    }
}

impl<F: Pair> Motion for (&Theta, &F) {
    /// `q_b(t)`, unit: `e^{iΩt/2} (α, β)` as (w + iz, x + iy).
    #[inline(always)]
    fn at(&self, t: impl Time) -> Quaternion<f64> {
        let (theta, form) = self;
        let turns = t.gone(theta.turns).reduced();
        let (alpha, beta, more) = form.pair(t);
        let square = |(re, im): Complex| re * re + im * im;
        let norm = 1.0 / (square(alpha) + square(beta)).sqrt();
        let (sin, cos) = sin_cos_turns(turns + more);
        let turn = (cos * norm, sin * norm);
        let ((w, z), (x, y)) = (times(alpha, turn), times(beta, turn));
        let [of_w, of_x, of_y, of_z] = theta.columns;
        of_w * w + of_x * x + of_y * y + of_z * z
    }
}

/// `R(q) v`.
#[inline]
fn turn(q: Quaternion<f64>, v: Vector3<f64>) -> Vector3<f64> {
    let u = q.imag();
    let t = u.cross(&v) * 2.0;
    v + t * q.w + u.cross(&t)
}

/// Components of ω below this part of the largest have squares that underflow beside it, and are
/// felt at no time: but about a middle axis, which they make the motion leave in the end.
const VANISHING: f64 = 1e-140;

fn kind(i: Vector3<f64>, q0: Quaternion<f64>, w: Vector3<f64>) -> Kind {
    // Units of its own: moments and rates near 1, exactly, by powers of two.
    let unit = power_of_two(w.amax());
    let i = i / power_of_two(i.amax());
    let mut w = w / unit;
    if w.amin() < VANISHING && !is_middle(i, w.iamax()) {
        w = w.map(|x| if x.abs() < VANISHING { 0.0 } else { x });
    }
    // dω/dt = 0: each product (I_j - I_k) ω_j ω_k has a factor that is zero.
    let zero = |j: usize, k: usize| i[j] == i[k] || w[j] == 0.0 || w[k] == 0.0;
    if zero(1, 2) && zero(2, 0) && zero(0, 1) {
        Kind::Steady(Steady::new(q0, w, unit))
    } else {
        Kind::Theta(Theta::new(i, q0, w, unit))
    }
}

/// Whether one moment is below that of `axis` and one above.
fn is_middle(i: Vector3<f64>, axis: usize) -> bool {
    i.min() < i[axis] && i[axis] < i.max()
}

/// The power of two at or below x > 0, where that is a normal number: else the least of those, and 1
/// for 0.
fn power_of_two(x: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
    if x == 0.0 {
        1.0
    } else {
        f64::from_bits(x.to_bits() & EXPONENT).max(f64::MIN_POSITIVE)
    }
}

impl Steady {
    /// ω in a unit of rates.
    fn new(q0: Quaternion<f64>, omega: Vector3<f64>, unit: f64) -> Self {
        let square = |x: f64| Dd::product(x, x);
        let rate = square(omega.x)
            .plus(square(omega.y))
            .plus(square(omega.z))
            .sqrt();
        Self {
            q0,
            axis: if rate.hi == 0.0 {
                Vector3::zeros()
            } else {
                omega / rate.hi
            },
            turns: (rate * constants::OVER_FOUR_PI).scaled(unit),
            omega: omega * unit,
        }
    }
}

impl Theta {
    /// ω in a unit of rates.
    fn new(i: Vector3<f64>, q0: Quaternion<f64>, w: Vector3<f64>, unit: f64) -> Self {
        let branch = Branch::choose(i, w);
        let Constants { turns, form } = Constants::new(&branch, unit);
        let mut theta = Self {
            columns: [
                Quaternion::new(1.0, 0.0, 0.0, 0.0),
                Quaternion::new(0.0, 1.0, 0.0, 0.0),
                Quaternion::new(0.0, 0.0, 1.0, 0.0),
                Quaternion::new(0.0, 0.0, 0.0, 1.0),
            ],
            turns,
            form,
        };
        let start = match &theta.form {
            Form::Nome(form) => (&theta, form).at(0.0),
            Form::Complementary(form) => (&theta, form).at(0.0),
            Form::Separatrix(form) => (&theta, form).at(0.0),
        };
        theta.columns = columns(q0, start, &branch);
        theta
    }
}

/// `q(t) = q0 (q_b(0) q_S)* q_b(t) q_S` as a linear map of q_b(t), q_S the change of axes: turned by it,
/// a vector has its components in another order and with other signs.
fn columns(q0: Quaternion<f64>, start: Quaternion<f64>, branch: &Branch) -> [Quaternion<f64>; 4] {
    let old = |v: Vector3<f64>| {
        let mut out = Vector3::zeros();
        for k in 0..3 {
            out[branch.order[k]] = branch.signs[k] * v[k];
        }
        out
    };
    let left = q0 * Quaternion::from_parts(start.w, old(-start.imag()));
    // left times the unit of each axis.
    let (v, w) = (left.imag(), left.w);
    let of = [
        Quaternion::new(-v.x, w, v.z, -v.y),
        Quaternion::new(-v.y, -v.z, w, v.x),
        Quaternion::new(-v.z, v.y, -v.x, w),
    ];
    let along = |k: usize| of[branch.order[k]] * branch.signs[k];
    [left, along(0), along(1), along(2)]
}
