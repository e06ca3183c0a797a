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
//! fast and slow bodies neither over- nor underflow.
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
use law::{Law, Travel, padded};
use multiversion::multiversion;
use nalgebra::{Quaternion, Vector3};
use recurrence::{Levers, NoLevers, Spin, expand};
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
    /// Of the step from `from`: q and u_d in rows of four, `4 + 4 directions` numbers an order.
    rows: Vec<f64>,
    spins: Vec<Spin>,
    journey: Option<Box<Journey>>,
    /// At `reached`; |q| = 1.
    q: [f64; 4],
    omega: [f64; 4],
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
            0 => 4,
            1 => 8,
            _ => 16,
        };
        Self {
            law: Arc::new(law),
            order,
            set_out: t,
            from: t,
            reached: t,
            unit: 1.0 / turn,
            rows: vec![0.0; width * (order + 1)],
            spins: vec![Spin::default(); order + 1],
            journey,
            q: start.q_wp.coords.into(),
            omega: padded(omega_p),
            work: Work::default(),
        }
    }

    /// Numbers an order in `rows`.
    fn width(&self) -> usize {
        self.rows.len() / (self.order + 1)
    }

    /// Expands from the end of the last step.
    fn expand(&mut self) {
        self.work.evaluations += 1;
        let width = self.width();
        let (unit, start) = (self.unit, (self.q, self.omega));
        let (law, rows, spins) = (&self.law, &mut self.rows[..], &mut self.spins[..]);
        match (width, &mut self.journey) {
            (4, _) => expand_from::<4, _>(start, law, unit, rows, spins, &mut NoLevers),
            (8, _) => expand_from::<8, _>(start, law, unit, rows, spins, &mut NoLevers),
            (_, None) => expand_from::<16, _>(start, law, unit, rows, spins, &mut NoLevers),
            (_, Some(journey)) => {
                journey.set_out(unit);
                expand_from::<16, _>(start, law, unit, rows, spins, journey.as_mut());
            }
        }
    }

    /// How far the polynomial is good for, s.
    fn length(&self) -> f64 {
        let width = self.width();
        let attitude = |k: usize| largest(&self.rows[width * k..]);
        let spin = |k: usize| largest(&self.spins[k].omega);
        let speed = |k: usize| {
            self.journey
                .as_ref()
                .map_or(0.0, |journey| journey.speed(k))
        };
        // What ω and v are over a time such as a step takes, so that neither counts as zero.
        let lowest = |of: &dyn Fn(usize) -> f64| of(0).max(of(1)).max(of(2));
        let (spin_scale, speed_scale) = (lowest(&spin), lowest(&speed));
        let radius = |k: usize| {
            let relative = |size: f64, scale: f64| if size == 0.0 { 0.0 } else { size / scale };
            let size = (attitude(k))
                .max(relative(spin(k), spin_scale))
                .max(relative(speed(k), speed_scale));
            -libm::log(size) / k as f64
        };
        let n = self.order;
        let safety = 2.0 + 0.7 / (n - 1) as f64;
        self.unit * libm::exp(radius(n).min(radius(n - 1)) - safety)
    }

    /// q, not quite of unit length, and ω, in principal axes, `s` units from the start of the step.
    fn turned(&self, s: f64) -> ([f64; 4], [f64; 4]) {
        value(self.width(), &self.rows, &self.spins, s)
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
        let (q, omega) = self.turned(s);
        (self.q, self.omega) = (unit_length(q), omega);
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

/// Fills the rows of order 0 and from them all others.
fn expand_from<const W: usize, L: Levers<W>>(
    (q, omega): ([f64; 4], [f64; 4]),
    law: &Law,
    unit: f64,
    rows: &mut [f64],
    spins: &mut [Spin],
    levers: &mut L,
) {
    let (rows, _) = rows.as_chunks_mut::<W>();
    let order = rows.len() - 1;
    rows[0][..4].copy_from_slice(&q);
    let q = Quaternion::from(q);
    for (d, direction_w) in law.directions.iter().enumerate() {
        let u = rotate_back(q, *direction_w);
        rows[0][4 * (d + 1)..4 * (d + 2)].copy_from_slice(&padded(u));
    }
    spins[0] = Spin::new(omega);
    expand(&law.turning, unit, order, rows, spins, levers);
}

/// `Rᵀ v`.
fn rotate_back(q: Quaternion<f64>, v: Vector3<f64>) -> Vector3<f64> {
    let t = v.cross(&q.imag()) * 2.0;
    v + t * q.w + t.cross(&q.imag())
}

/// The sum of the series of q and ω at `s`: even and odd powers apart, so that neither waits for the
/// other, and the start added last, whose rounding is then the only one that counts.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn value(width: usize, rows: &[f64], spins: &[Spin], s: f64) -> ([f64; 4], [f64; 4]) {
    let square = s * s;
    let (mut later, mut sooner) = ([0.0; 8], [0.0; 8]);
    for (row, spin) in rows.chunks_exact(width).zip(spins).skip(1).rev() {
        let mut next = [0.0; 8];
        for lane in 0..4 {
            next[lane] = row[lane] + later[lane] * square;
            next[lane + 4] = spin.omega[lane] + later[lane + 4] * square;
        }
        (later, sooner) = (sooner, next);
    }
    let (mut q, mut omega) = ([0.0; 4], [0.0; 4]);
    for lane in 0..4 {
        q[lane] = rows[lane] + (sooner[lane] * s + later[lane] * square);
        omega[lane] = spins[0].omega[lane] + (sooner[lane + 4] * s + later[lane + 4] * square);
    }
    (q, omega)
}

/// The largest of the first four.
fn largest(row: &[f64]) -> f64 {
    row.iter().take(4).fold(0.0, |most, c| {
        let size = c.abs();
        // Not f64::max, which would hide what is not a number.
        if most > size { most } else { size }
    })
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

/// The power of two at or below x; 1 where x is none, or too small or too large to have an inverse.
fn power_of_two(x: f64) -> f64 {
    if x > 1e-300 && x < 1e300 {
        f64::from_bits(x.to_bits() & 0x7ff0_0000_0000_0000)
    } else {
        1.0
    }
}
