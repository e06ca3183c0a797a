//! Taylor's method: the solution as a polynomial of high order in time, its coefficients by recurrences,
//! for constant forces at points and constant torques.
//!
//! ```text
//! q' = ½ q (ω, 0)    I ω' = (I_j - I_k) ω_j ω_k + τ - c I ω    x' = v    v' = m⁻¹ F - k v
//! y(t + s) = Σ_{k=0..n} y_k s^k     n = ⌈1 - ½ ln tol⌉
//! h = e^{-2 - 0.7/(n-1)} min over k = n, n-1 of (1/‖y_k‖)^{1/k}
//! ```
//!
//! (q, ω) in principal axes; ‖y_k‖ is the largest component of q's coefficient, and of ω's in units of ω.
//! The order follows from the tolerance and is kept; the step follows from how fast the coefficients
//! fall. An instant within a step is the polynomial's value: it costs its evaluation and nothing else.
//!
//! A reference point that is under constant acceleration, damped or not, is not integrated at all
//! ([`Flight`]). Coefficients are in powers of s over a unit of time near the step, a power of two, so that
//! fast and slow bodies neither over- nor underflow. What the last addition to q and ω rounded away is
//! added with the next (Kahan): the rounding of a step is then that of its change alone.
//!
//! Jorba & Zou, A software package for the numerical integration of ODEs by means of high-order Taylor
//! methods, Experimental Mathematics 14 (2005): order and step; Biscani & Izzo, MNRAS 504 (2021), section 2:
//! the step's safety.

mod law;
mod recurrence;
mod travel;

use super::flight::Elapsed;
use super::own_steps::{Run, Walk};
use super::{Accepts, Cost, Damping, Interval, Kind, Method, MethodInfo, Stepper, Work};
use crate::body::{State, StateBlock};
use crate::math::dd::two_sum;
use law::{Law, Travel, padded};
use multiversion::multiversion;
use nalgebra::{Quaternion, Vector3};
use recurrence::{
    Four, Levers, NoLevers, OMEGA, Order, Q, expand, rows, set_attitude, set_direction, set_spin,
};
use std::f64::consts::LOG2_E;
use std::sync::Arc;
use travel::Journey;

pub struct Taylor;

const INFO: MethodInfo = MethodInfo {
    name: "taylor",
    engines: &[],
    kind: Kind::Adaptive,
    order: 20,
    accepts: Accepts::Terms,
    damping: Damping::Within("a linear term of the recurrences: to the tolerance, as all else"),
    reversible: false,
    keeps_momentum: false,
    preserves: "nothing exactly; everything to its tolerance",
    cost: Cost {
        evaluations: 0,
        weight: 12.0,
    },
    citation: "Jorba & Zou, Experimental Mathematics 14 (2005); Biscani & Izzo, MNRAS 504 (2021)",
};

impl Method for Taylor {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn start(&self, interval: Interval, t: f64, state: &StateBlock) -> Box<dyn Stepper> {
        let terms = interval.load.terms(&interval.inertial).unwrap_or_default();
        let tolerance = interval.tolerance;
        let bodies: Vec<Body> = (0..interval.bodies)
            .map(|lane| {
                let start = state.get(lane);
                Body::new(
                    Law::new(&interval, &terms, lane, &start),
                    tolerance,
                    t,
                    &start,
                )
            })
            .collect();
        Box::new(Run::new(interval, state, |lane| bodies[lane].clone()))
    }
}

/// One body on its way.
#[derive(Clone)]
struct Body {
    law: Arc<Law>,
    order: usize,
    /// When it set out; the start and the end of the last step, s.
    set_out: f64,
    from: f64,
    reached: f64,
    /// Coefficients are in powers of time over this, s.
    unit: f64,
    /// Of the step from `from`: the rows of each order.
    series: Vec<Four>,
    journey: Option<Box<Journey>>,
    /// At `reached`; |q| = 1.
    q: [f64; 4],
    omega: [f64; 4],
    /// What the last additions to q and ω rounded away: with it, steps are added as if to twice the
    /// digits (Kahan 1965).
    q_rest: [f64; 4],
    omega_rest: [f64; 4],
    work: Work,
}

impl Body {
    fn new(law: Law, tolerance: f64, t: f64, start: &State) -> Self {
        let order = order(tolerance);
        let journey = match &law.travel {
            Travel::Flight(_) => None,
            Travel::Carried(carried) => Some(Box::new(Journey::new(carried.clone(), order, start))),
        };
        let omega_p = start.to_principal(start.omega_w);
        let turn = power_of_two(omega_p.amax());
        let width = match law.directions.len() {
            0 => rows(0),
            1 => rows(1),
            _ => rows(3),
        };
        Self {
            law: Arc::new(law),
            order,
            set_out: t,
            from: t,
            reached: t,
            unit: 1.0 / turn,
            series: vec![Four::default(); width * (order + 1)],
            journey,
            q: start.q_wp.coords.into(),
            omega: padded(omega_p),
            q_rest: [0.0; 4],
            omega_rest: [0.0; 4],
            work: Work::default(),
        }
    }

    /// Rows an order has.
    fn width(&self) -> usize {
        self.series.len() / (self.order + 1)
    }

    /// Expands from the end of the last step.
    fn expand(&mut self) {
        const NONE: usize = rows(0);
        const ONE: usize = rows(1);
        const AXES: usize = rows(3);
        self.work.evaluations += 1;
        let (width, unit, start) = (self.width(), self.unit, (self.q, self.omega));
        let (law, series) = (&self.law, &mut self.series[..]);
        match (width, &mut self.journey) {
            (NONE, _) => expand_from::<NONE, _>(start, law, unit, series, &mut NoLevers),
            (ONE, _) => expand_from::<ONE, _>(start, law, unit, series, &mut NoLevers),
            (_, None) => expand_from::<AXES, _>(start, law, unit, series, &mut NoLevers),
            (_, Some(journey)) => {
                journey.set_out(unit);
                expand_from::<AXES, _>(start, law, unit, series, journey.as_mut());
            }
        }
    }

    /// How far the polynomial is good for, s.
    fn length(&self) -> f64 {
        let width = self.width();
        let attitude = |k: usize| largest(&self.series[width * k + Q]);
        let spin = |k: usize| largest(&self.series[width * k + OMEGA]);
        let speed = |k: usize| {
            self.journey
                .as_ref()
                .map_or(0.0, |journey| journey.speed(k))
        };
        // What ω and v are over a time such as a step takes, so that neither counts as zero.
        let lowest = |of: &dyn Fn(usize) -> f64| of(0).max(of(1)).max(of(2));
        let (spin_scale, speed_scale) = (lowest(&spin), lowest(&speed));
        // log2 of the radius at which term k would be 1.
        let radius = |k: usize| {
            let relative = |size: f64, scale: f64| if size == 0.0 { 0.0 } else { size / scale };
            let spin = relative(spin(k), spin_scale);
            let speed = relative(speed(k), speed_scale);
            -rough_log2(larger(attitude(k), larger(spin, speed))) / k as f64
        };
        let n = self.order;
        let safety = (2.0 + 0.7 / (n - 1) as f64) * LOG2_E;
        self.unit * libm::exp2(radius(n).min(radius(n - 1)) - safety)
    }

    /// Takes q and ω at `s` units from the start for the end of the step.
    fn arrive(&mut self, s: f64) {
        let (turn, spin) = change(self.width(), &self.series, s);
        // Half of what |q|² lacks of 1 brings q to unit length but for the square of that.
        let square: f64 = (self.q.iter().zip(turn))
            .map(|(q, turn)| (q + turn) * (q + turn))
            .sum();
        let lacks = 0.5 * (1.0 - square);
        for lane in 0..4 {
            let turn = turn[lane] + (self.q[lane] + turn[lane]) * lacks + self.q_rest[lane];
            (self.q[lane], self.q_rest[lane]) = two_sum(self.q[lane], turn);
            let spin = spin[lane] + self.omega_rest[lane];
            (self.omega[lane], self.omega_rest[lane]) = two_sum(self.omega[lane], spin);
        }
    }

    /// q, not quite of unit length, and ω, in principal axes, `s` units from the start of the step.
    fn turned(&self, s: f64) -> ([f64; 4], [f64; 4]) {
        let (turn, spin) = change(self.width(), &self.series, s);
        let sum = |a: &Four, b: [f64; 4]| std::array::from_fn(|lane| a.0[lane] + b[lane]);
        (sum(&self.series[Q], turn), sum(&self.series[OMEGA], spin))
    }

    fn state(
        &self,
        interval: &Interval,
        t: f64,
        (q, omega): ([f64; 4], [f64; 4]),
        carried: impl Fn(&Journey) -> (Vector3<f64>, Vector3<f64>),
    ) -> State {
        let (x_w, v_w) = match (&self.law.travel, &self.journey) {
            (_, Some(journey)) => carried(journey),
            (Travel::Flight(flight), None) => {
                flight.at(Elapsed::linear(interval.load.decay(), t - self.set_out))
            }
            // A body that is carried has a journey.
            (Travel::Carried(_), None) => (Vector3::zeros(), Vector3::zeros()),
        };
        let state = State {
            x_w,
            v_w,
            q_wp: Quaternion::from(unit_length(q)),
            omega_w: Vector3::zeros(),
        };
        let [p, q, r, _] = omega;
        State {
            omega_w: state.to_world(Vector3::new(p, q, r)),
            ..state
        }
    }
}

impl Walk for Body {
    fn reached(&self) -> f64 {
        self.reached
    }

    fn step(&mut self, interval: &Interval) -> Option<()> {
        if self.reached > self.from {
            self.unit = power_of_two(self.reached - self.from);
        }
        self.expand();
        let length = self.length();
        // Not so either where it is no number.
        if !(length > 0.0) {
            return None;
        }
        // The step as the two times have it, so that the clock has no rounding of its own.
        let to = match self.reached + 1.01 * length < interval.until {
            true => self.reached + length,
            false => interval.until,
        };
        if to <= self.reached {
            return None;
        }
        self.from = self.reached;
        self.reached = to;
        let s = (to - self.from) / self.unit;
        self.arrive(s);
        if let Some(journey) = &mut self.journey {
            journey.arrive(s);
        }
        self.work.steps += 1;
        Some(())
    }

    fn at(&mut self, interval: &Interval, t: f64) -> State {
        if t >= self.reached {
            return self.state(interval, t, (self.q, self.omega), Journey::end);
        }
        let s = (t - self.from) / self.unit;
        self.state(interval, t, self.turned(s), |journey| journey.at(s))
    }

    fn work(&self) -> Work {
        self.work
    }
}

/// Fills order 0 and from it all others.
fn expand_from<const ROWS: usize, L: Levers<ROWS>>(
    (q, omega): ([f64; 4], [f64; 4]),
    law: &Law,
    unit: f64,
    series: &mut [Four],
    levers: &mut L,
) {
    let (orders, _): (&mut [Order<ROWS>], _) = series.as_chunks_mut();
    set_attitude(&mut orders[0], q);
    set_spin(&mut orders[0], omega);
    let q = Quaternion::from(q);
    for (d, direction_w) in law.directions.iter().enumerate() {
        set_direction(&mut orders[0], d, padded(rotate_back(q, *direction_w)));
    }
    expand(&law.turning, unit, orders, levers);
}

/// `Rᵀ v`.
fn rotate_back(q: Quaternion<f64>, v: Vector3<f64>) -> Vector3<f64> {
    let t = v.cross(&q.imag()) * 2.0;
    v + t * q.w + t.cross(&q.imag())
}

/// What q and ω change by until `s`: the sum of their series but for order 0, even and odd powers apart,
/// so that neither waits for the other.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn change(width: usize, series: &[Four], s: f64) -> ([f64; 4], [f64; 4]) {
    let square = s * s;
    let (mut later, mut sooner) = ([0.0; 8], [0.0; 8]);
    for order in series[width..].chunks_exact(width).rev() {
        let mut next = [0.0; 8];
        for lane in 0..4 {
            next[lane] = order[Q].0[lane] + later[lane] * square;
            next[lane + 4] = order[OMEGA].0[lane] + later[lane + 4] * square;
        }
        (later, sooner) = (sooner, next);
    }
    let (mut q, mut omega) = ([0.0; 4], [0.0; 4]);
    for lane in 0..4 {
        q[lane] = sooner[lane] * s + later[lane] * square;
        omega[lane] = sooner[lane + 4] * s + later[lane + 4] * square;
    }
    (q, omega)
}

/// The largest in size.
fn largest(row: &Four) -> f64 {
    row.0.iter().fold(0.0, |most, c| larger(most, c.abs()))
}

/// Unlike `f64::max`, not a number where either is none.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

fn unit_length(q: [f64; 4]) -> [f64; 4] {
    let [x, y, z, w] = q;
    let inverse = 1.0 / (x * x + y * y + z * z + w * w).sqrt();
    q.map(|c| c * inverse)
}

/// `⌈1 - ½ ln tol⌉`.
fn order(tolerance: f64) -> usize {
    let order = libm::ceil(1.0 - 0.5 * libm::log(tolerance));
    // Tolerances that 64-bit numbers cannot hold, or that are none, take the highest.
    if order >= 4.0 && order <= 20.0 {
        order as usize
    } else if order < 4.0 {
        4
    } else {
        20
    }
}

/// log2 within 0.09: exponent and mantissa as one number. A k-th of that is no matter for a step.
fn rough_log2(x: f64) -> f64 {
    if x.is_finite() {
        x.to_bits() as f64 / (1_u64 << 52) as f64 - 1023.0
    } else {
        f64::NAN
    }
}

/// The power of two at or below x; 1 where x is none, or too small or too large to have an inverse.
fn power_of_two(x: f64) -> f64 {
    if x > 1e-300 && x < 1e300 {
        f64::from_bits(x.to_bits() & 0x7ff0_0000_0000_0000)
    } else {
        1.0
    }
}
