//! The Runge-Kutta method of order 8 by Dormand and Prince, with step-size control and dense output.
//!
//! ```text
//! gyroscopic:        q' = ½ q (ω_p, 0)   ω_p = I⁻¹ Rᵀ L   L' = τ            x' = v   v' = m⁻¹ F
//! tutorial's model:  q' = ½ (ω_w, 0) q                    ω_w' = I_w⁻¹ τ    x' = v   v' = m⁻¹ F
//! ```
//!
//! The variables are (x, v, q, L_w), without the gyroscopic term (x, v, q, ω_w): what stays in free flow.
//! A free body's momentum is then constant to the last bit, the error estimate is the attitude's alone,
//! and a right-hand side costs one rotation and three divisions. (ω_p in place of L costs as much, and
//! its error in free flow is one more to control.)
//!
//! But of a thin body, `I_max > 16 I_min`, ω_p takes the place of L: `ω_p' = I⁻¹ (Rᵀ τ - ω_p × I ω_p)`. There
//! Rᵀ L over the smallest moment turns an error of q into one of ω that is I_max/I_min times as large: the
//! equations swing at |L|/I_min, however slowly the body turns, and steps would have to follow that.
//!
//! R is that of q/|q|, so that |q| is invariant; q is brought to unit length after the step.
//!
//! With damping the variables are e^{kτ} v and e^{cτ} L, τ from the start of the step: a velocity by
//! itself decays exactly (Lawson's integrating factor).
//!
//! Error: the estimators of orders 5 and 3 combined as in the original, `e5²/√(e5² + 0.01 e3²)`, over
//! each of x, v, q, L (or ω), the largest counting, relative to `|y| + h |y'|` of each and to 1 for q. An instant within
//! the step is read from the polynomial of order 7, for which three more evaluations are made, once.
//!
//! Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, II.4 (control), II.5, II.6.

mod coefficients;
#[cfg(test)]
mod tests;

use super::own_steps::{Run, Walk};
use super::{Accepts, Cost, Damping, Interval, Kind, Method, MethodInfo, Models, Stepper, Work};
use crate::body::{Inertial, State, StateBlock};
use crate::effect::{Term, Wrench};
use crate::math::dd::two_sum;
use crate::math::spin_rate;
use coefficients::{A, C, D, E3, E5, Row};
use multiversion::multiversion;
use nalgebra::{Quaternion, Vector3};
use std::sync::Arc;

pub struct Dop853;

const INFO: MethodInfo = MethodInfo {
    name: "dop853",
    engines: &[],
    kind: Kind::Adaptive,
    order: 8,
    weak_orders: None,
    models: Models::Both,
    accepts: Accepts::Any,
    damping: Damping::Exact("integrating factor: exact by itself, to the tolerance with torques"),
    reversible: false,
    keeps_momentum: true,
    exact_free: false,
    preserves: "a free body's momentum, of a thin one to its tolerance; all else to its tolerance",
    cost: Cost {
        evaluations: None,
        // A step of its own, tolerance 1e-12.
        weight: 3.4,
    },
    citation: "Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, II.5 and II.6 (DOP853); damping: Lawson 1967",
};

impl Method for Dop853 {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn set_out(&self, interval: Interval, t: f64, state: &StateBlock) -> Box<dyn Stepper> {
        let blocks = interval.clone();
        Box::new(Run::new(interval, state, |lane| {
            Body::new(&blocks, lane, t, &state.get(lane))
        }))
    }
}

/// Which spin stands in the variables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Spin {
    /// L, world.
    Momentum,
    /// ω in principal axes, of a thin body.
    Principal,
    /// ω, world: the tutorial's model.
    Velocity,
}

/// Moments farther apart than this make a body thin: its steps would be 16 times as short.
const THIN: f64 = 16.0;

impl Spin {
    fn of(body: &Inertial, gyroscopic: bool) -> Self {
        let moments = body.moments;
        match gyroscopic {
            false => Self::Velocity,
            true if moments.max() > THIN * moments.min() => Self::Principal,
            true => Self::Momentum,
        }
    }
}

/// x, v, q (x, y, z, w) and L or ω; the fourth of a vector is 0.
type Vector = [[f64; 4]; 4];

const ZERO: Vector = [[0.0; 4]; 4];
const PLACE: usize = 0;
const VELOCITY: usize = 1;
const ATTITUDE: usize = 2;
const SPIN: usize = 3;

/// One body on its way.
#[derive(Clone)]
struct Body {
    lane: usize,
    spin: Spin,
    terms: Option<Arc<[Term]>>,
    /// Whether what is applied changes with time by itself.
    timed: bool,
    /// For the sake of the decay, s.
    longest: f64,
    /// The last step, s: from where, how long, and its end.
    from: f64,
    h: f64,
    reached: f64,
    /// At its end, |q| = 1; and what the last addition rounded away, to be added with the next (Kahan).
    y: Vector,
    rest: Vector,
    slope: Vector,
    /// The length to try next, s, and the last error.
    next: f64,
    last_error: f64,
    /// The last step's stages, its start, and its end before q was brought to length 1.
    k: [Vector; 16],
    y0: Vector,
    y1: Vector,
    dense: Option<[Vector; 7]>,
    work: Work,
}

/// A step shrinks at most to a third and grows at most sixfold; safety; PI control by β = 0.04.
const SHRINK: f64 = 1.0 / 3.0;
const GROW: f64 = 6.0;
const SAFETY: f64 = 0.9;
const BETA: f64 = 0.04;
/// Steps are cut here in units of the time in which a velocity decays: e³⁰ still leaves digits.
const DECAY_A_STEP: f64 = 30.0;

/// Roundings that the twelve products and sums of an error estimate make, of its largest slope.
const NOISE: f64 = 16.0 * f64::EPSILON;

/// Factors on v and on L or ω at some time in the step.
#[derive(Clone, Copy)]
struct Factors {
    linear: f64,
    angular: f64,
}

impl Factors {
    fn at(interval: &Interval, tau: f64) -> Self {
        let (linear, angular) = interval.load.decay().map_or((1.0, 1.0), |decay| {
            (decay.linear_factor(tau), decay.angular_factor(tau))
        });
        Self { linear, angular }
    }

    /// y with its velocities times these.
    fn on(self, mut y: Vector) -> Vector {
        y[VELOCITY] = y[VELOCITY].map(|c| c * self.linear);
        y[SPIN] = y[SPIN].map(|c| c * self.angular);
        y
    }

    /// y with its velocities divided by these.
    fn off(self, mut y: Vector) -> Vector {
        y[VELOCITY] = y[VELOCITY].map(|c| c / self.linear);
        y[SPIN] = y[SPIN].map(|c| c / self.angular);
        y
    }
}

impl Body {
    fn new(interval: &Interval, lane: usize, t: f64, start: &State) -> Self {
        let body = interval.inertial.get(lane);
        let spin = Spin::of(&body, interval.load.gyroscopic());
        let spins = match spin {
            Spin::Momentum => body.momentum_w(start),
            Spin::Principal => start.to_principal(start.omega_w),
            Spin::Velocity => start.omega_w,
        };
        let y = [
            vector(start.x_w),
            vector(start.v_w),
            start.q_wp.coords.into(),
            vector(spins),
        ];
        let rates = interval
            .load
            .decay()
            .map_or(0.0, |decay| decay.linear_rate().max(decay.angular_rate()));
        let terms = interval.load.terms_of(lane, &interval.inertial);
        let terms = terms.map(Arc::from);
        let mut this = Self {
            lane,
            spin,
            terms,
            timed: interval.load.changes_with_time(lane, &interval.inertial),
            longest: DECAY_A_STEP / rates,
            from: t,
            h: 0.0,
            reached: t,
            y,
            rest: ZERO,
            slope: ZERO,
            next: 0.0,
            last_error: 1e-4,
            k: [ZERO; 16],
            y0: y,
            y1: y,
            dense: None,
            work: Work::default(),
        };
        this.slope = this.rate(interval, t, &y);
        this.next = this.first_length(interval);
        this
    }

    /// y' = f(t, y), without decay.
    fn rate(&mut self, interval: &Interval, t: f64, y: &Vector) -> Vector {
        self.work.evaluations += 1;
        let load = &interval.load;
        let body = interval.inertial.get(self.lane);
        let q = Quaternion::from(y[ATTITUDE]);
        let (state, omega_p) = state(self.spin, &body, y);
        let mut rate = ZERO;
        rate[PLACE] = y[VELOCITY];
        rate[ATTITUDE] = match omega_p {
            Some(omega_p) => (q * Quaternion::from_imag(omega_p * 0.5)).coords.into(),
            None => spin_rate(state.omega_w, q).coords.into(),
        };
        let own = match (self.spin, omega_p) {
            (Spin::Principal, Some(omega_p)) => body.gyroscopic_torque_p(omega_p),
            _ => Vector3::zeros(),
        };
        if self.spin == Spin::Principal {
            rate[SPIN] = vector(body.inv_moments.component_mul(&own));
        }
        if !load.applies() {
            return rate;
        }
        let wrench = self.wrench(interval, t, &state);
        rate[VELOCITY] = vector(wrench.force_w * body.inv_mass);
        rate[SPIN] = vector(match self.spin {
            Spin::Momentum => wrench.tau_w,
            Spin::Principal => {
                let tau_p = state.to_principal(wrench.tau_w) + own;
                body.inv_moments.component_mul(&tau_p)
            }
            Spin::Velocity => body.angular_response(&state, wrench.tau_w),
        });
        rate
    }

    /// What is applied, of this body alone: by terms where there is nothing else, for a block of
    /// effects is made for eight bodies.
    fn wrench(&self, interval: &Interval, t: f64, state: &State) -> Wrench {
        if let Some(terms) = &self.terms {
            let each = terms.iter().map(|term| term.wrench(state));
            return each.fold(Wrench::default(), |a, b| Wrench {
                force_w: a.force_w + b.force_w,
                tau_w: a.tau_w + b.tau_w,
            });
        }
        let mut block = StateBlock::default();
        block.set(self.lane, *state);
        let wrench = interval.load.wrench(t, &interval.inertial, &block);
        wrench.unwrap_or_default().get(self.lane)
    }

    /// The same in the variables of the step, which have their decay taken out.
    fn stage(&mut self, interval: &Interval, from: f64, tau: f64, y: &Vector) -> Vector {
        if interval.load.decay().is_none() {
            return self.rate(interval, from + tau, y);
        }
        let factors = Factors::at(interval, tau);
        let rate = self.rate(interval, from + tau, &factors.on(*y));
        factors.off(rate)
    }

    /// The length of a first step, from the first two derivatives (II.4), as if the eighth were like
    /// them in units of the state; a quantity that starts at zero has no unit yet and does not count.
    fn first_length(&mut self, interval: &Interval) -> f64 {
        let span = interval.until - self.reached;
        let in_units = |y: &Vector, rate: &Vector| {
            let each = y.iter().zip(rate);
            let each = each.filter(|(y, _)| norm(y) > 0.0);
            each.map(|(y, rate)| norm(rate) / norm(y))
                .fold(0.0, f64::max)
        };
        let first = in_units(&self.y, &self.slope);
        let trial = if first > 0.0 {
            0.01 / first
        } else {
            1e-6 * span
        };
        // What starts at next to nothing is no unit either: were such a step too long, it would be
        // refused and shortened.
        let shortest = 1e-12 * span;
        let trial = trial.clamp(shortest, span.max(shortest));
        let ahead = along(&self.y, trial, &self.slope);
        let rate = self.rate(interval, self.reached + trial, &ahead);
        let change = along(&rate, -1.0, &self.slope);
        let second = in_units(&self.y, &change) / trial;
        let eighth = first.max(second) / interval.tolerance;
        let by_error = if eighth > 0.0 {
            libm::pow(0.01 / eighth, 0.125)
        } else {
            span
        };
        by_error
            .min(100.0 * trial)
            .clamp(shortest, span.max(shortest))
    }

    /// The step tried: stages 1 to 11 and the end. The error, 1 being what is allowed.
    fn attempt(&mut self, interval: &Interval, h: f64) -> f64 {
        self.k[0] = self.slope;
        for (stage, row) in A.iter().enumerate().take(12).skip(1) {
            let y = along(&self.y, h, &sum(row, &self.k));
            self.k[stage] = self.stage(interval, self.reached, C[stage] * h, &y);
        }
        self.y1 = along(&self.y, h, &sum(A[12], &self.k));
        let ends = Factors::at(interval, h);
        let end = ends.on(self.y1);
        let error_5 = ends.on(sum(E5, &self.k));
        let error_3 = ends.on(sum(E3, &self.k));
        let of = |part: usize| {
            let size = match part {
                ATTITUDE => 1.0,
                _ => norm(&self.y[part]).max(norm(&end[part])) + h * norm(&self.slope[part]),
            };
            let e5 = norm(&error_5[part]);
            // A difference of slopes is known to some roundings of them; less is no error but noise,
            // and a quantity that starts at zero would make it look large whatever the step.
            let slopes = self.k[..12].iter().map(|k| norm(&k[part]));
            let mut noise = NOISE * slopes.fold(0.0, f64::max);
            if self.timed {
                // A time is known to a rounding, and slopes that change with it no better: what begins at
                // rest under a force that begins at nothing shows it.
                let changes = self.k[..12].iter();
                let changes = changes.map(|k| norm(&along(k, -1.0, &self.k[0])[part]));
                noise += NOISE * (self.reached.abs() / h) * changes.fold(0.0, f64::max);
            }
            if e5 <= noise {
                return 0.0;
            }
            let unit = h / (interval.tolerance * size);
            let (e5, e3) = (e5 * unit, norm(&error_3[part]) * unit);
            e5 * e5 / (e5 * e5 + 0.01 * e3 * e3).sqrt()
        };
        // Not f64::max, which would hide what is not a number.
        let worse = |a: f64, b: f64| if a.is_nan() || a > b { a } else { b };
        let parts = [PLACE, VELOCITY, ATTITUDE, SPIN].into_iter();
        parts.map(of).fold(0.0, worse)
    }

    /// What the next step is longer by, from this one's error and the last's (PI control).
    fn growth(&mut self, error: f64, refused: bool) -> f64 {
        let grown =
            SAFETY * libm::pow(error, -(0.125 - 0.2 * BETA)) * libm::pow(self.last_error, BETA);
        self.last_error = error.max(1e-4);
        let most = if refused { 1.0 } else { GROW };
        if grown > SHRINK {
            grown.min(most)
        } else {
            SHRINK
        }
    }

    /// The polynomial over the last step (II.6), for which it takes three more stages.
    fn dense(&mut self, interval: &Interval) -> [Vector; 7] {
        let h = self.h;
        for stage in 13..16 {
            let y = along(&self.y0, h, &sum(A[stage], &self.k));
            self.k[stage] = self.stage(interval, self.from, C[stage] * h, &y);
        }
        let whole = along(&self.y1, -1.0, &self.y0);
        let start = along(&times(h, &self.k[0]), -1.0, &whole);
        let both = along(&self.k[0], 1.0, &self.k[12]);
        let ends = along(&times(2.0, &whole), -h, &both);
        let upper = D.map(|row| times(h, &sum(row, &self.k)));
        [whole, start, ends, upper[0], upper[1], upper[2], upper[3]]
    }

    /// Whether damping has left nothing of its velocities, and nothing pushes: then no step is too long.
    fn stands(&self, interval: &Interval) -> bool {
        let still = |part: usize| norm(&self.y[part]) == 0.0;
        !interval.load.applies() && still(VELOCITY) && still(SPIN)
    }

    /// One step to `until` in which nothing changes. (What is left has squares of 0.)
    fn rest_until(&mut self, until: f64) {
        (self.y[VELOCITY], self.y[SPIN]) = ([0.0; 4], [0.0; 4]);
        (self.from, self.h, self.reached) = (self.reached, until - self.reached, until);
        self.y0 = self.y;
        self.dense = Some([ZERO; 7]);
        self.work.steps += 1;
    }

    /// Moves to the end of the step that was tried.
    fn accept(&mut self, interval: &Interval, to: f64, h: f64) {
        let y1 = self.y1;
        self.k[12] = self.stage(interval, self.reached, h, &y1);
        let ends = Factors::at(interval, h);
        // Half of what |q|² lacks of 1 brings q to unit length but for the square of that.
        let lacks = 0.5 * (1.0 - square(&y1[ATTITUDE]));
        let mut change = along(&self.rest, h, &sum(A[12], &self.k));
        let mut slope = self.k[12];
        for lane in 0..4 {
            change[ATTITUDE][lane] += lacks * y1[ATTITUDE][lane];
            slope[ATTITUDE][lane] += lacks * slope[ATTITUDE][lane];
        }
        self.y0 = self.y;
        let (y, rest) = plus(&self.y, &change);
        (self.y, self.rest) = (ends.on(y), ends.on(rest));
        self.slope = ends.on(slope);
        self.from = self.reached;
        (self.h, self.reached) = (h, to);
        self.dense = None;
        self.work.steps += 1;
    }
}

impl Walk for Body {
    fn reached(&self) -> f64 {
        self.reached
    }

    fn step(&mut self, interval: &Interval) -> Option<()> {
        if self.stands(interval) {
            self.rest_until(interval.until);
            return Some(());
        }
        let mut length = self.next.min(self.longest);
        let mut refused = false;
        loop {
            // The step as the two times have it, so that the clock has no rounding of its own.
            let to = match self.reached + 1.01 * length < interval.until {
                true => self.reached + length,
                false => interval.until,
            };
            let h = to - self.reached;
            let least = 10.0 * f64::EPSILON * self.reached.abs();
            if !(h > least || (h > 0.0 && to == interval.until)) {
                return None;
            }
            let error = self.attempt(interval, h);
            if error <= 1.0 {
                self.accept(interval, to, h);
                self.next = h * self.growth(error, refused);
                return Some(());
            }
            refused = true;
            let shrunk = SAFETY * libm::pow(error, -0.125);
            length = h * if shrunk > SHRINK { shrunk } else { SHRINK };
        }
    }

    fn at(&mut self, interval: &Interval, t: f64) -> State {
        let body = interval.inertial.get(self.lane);
        if t >= self.reached {
            return state(self.spin, &body, &self.y).0;
        }
        let dense = self.dense.unwrap_or_else(|| self.dense(interval));
        self.dense = Some(dense);
        // y0 + s (F0 + u (F1 + s (F2 + ...))), s from 0 to 1 and u = 1 - s.
        let s = (t - self.from) / self.h;
        let mut y = ZERO;
        for (power, part) in dense.iter().enumerate().rev() {
            let factor = if power % 2 == 0 { s } else { 1.0 - s };
            y = times(factor, &along(part, 1.0, &y));
        }
        let y = along(&self.y0, 1.0, &y);
        let y = Factors::at(interval, t - self.from).on(y);
        state(self.spin, &body, &y).0
    }

    fn work(&self) -> Work {
        self.work
    }
}

/// The state that y says and, where it is what the motion is computed from, ω in principal axes.
fn state(spin: Spin, body: &Inertial, y: &Vector) -> (State, Option<Vector3<f64>>) {
    let q = Quaternion::from(y[ATTITUDE]);
    let state = State {
        x_w: spatial(y[PLACE]),
        v_w: spatial(y[VELOCITY]),
        q_wp: q * (1.0 / q.norm()),
        omega_w: spatial(y[SPIN]),
    };
    let omega_p = match spin {
        Spin::Velocity => return (state, None),
        Spin::Principal => state.omega_w,
        Spin::Momentum => {
            // Divided, not times 1/I: a rounding of 1/I would be the same at every step, a phase that grows.
            let turning = |l: f64, i: f64| if i == 0.0 { 0.0 } else { l / i };
            let momentum_p = state.to_principal(state.omega_w);
            momentum_p.zip_map(&body.moments, turning)
        }
    };
    let omega_w = state.to_world(omega_p);
    (State { omega_w, ..state }, Some(omega_p))
}

fn vector(v: Vector3<f64>) -> [f64; 4] {
    [v.x, v.y, v.z, 0.0]
}

fn spatial([x, y, z, _]: [f64; 4]) -> Vector3<f64> {
    Vector3::new(x, y, z)
}

fn square(part: &[f64; 4]) -> f64 {
    part.iter().map(|c| c * c).sum()
}

fn norm(part: &[f64; 4]) -> f64 {
    square(part).sqrt()
}

/// The sum, and what it rounded away.
fn plus(a: &Vector, b: &Vector) -> (Vector, Vector) {
    let (mut sum, mut rest) = (*a, ZERO);
    let parts = sum
        .as_flattened_mut()
        .iter_mut()
        .zip(rest.as_flattened_mut());
    for ((sum, rest), b) in parts.zip(b.as_flattened()) {
        (*sum, *rest) = two_sum(*sum, *b);
    }
    (sum, rest)
}

/// `y + h k`.
fn along(y: &Vector, h: f64, k: &Vector) -> Vector {
    let mut sum = *y;
    for (sum, k) in sum.as_flattened_mut().iter_mut().zip(k.as_flattened()) {
        *sum += h * k;
    }
    sum
}

fn times(factor: f64, y: &Vector) -> Vector {
    y.map(|part| part.map(|c| c * factor))
}

/// `Σ a_j k_j`.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn sum(row: Row, k: &[Vector; 16]) -> Vector {
    let mut sum = ZERO;
    for &(stage, a) in row {
        for (sum, k) in (sum.as_flattened_mut().iter_mut()).zip(k[stage].as_flattened()) {
            *sum += a * k;
        }
    }
    sum
}
