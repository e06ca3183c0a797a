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

mod four;
mod law;
mod recurrence;
mod travel;

use super::coast::Passage;
use super::flight::Flight;
use super::own_steps::{Run, Walk};
use super::{Accepts, Cost, Damping, Interval, Kind, Method, MethodInfo, Models, Stepper, Work};
use crate::body::{State, StateBlock};
use four::{Four, larger};
use law::{Law, Travel, Turning};
use multiversion::multiversion;
use nalgebra::{Quaternion, Vector3};
use recurrence::{NoLevers, OMEGA, Order, Q, rows, set_attitude, set_direction, set_spin};
use std::f64::consts::LOG2_E;
use travel::Journey;

pub struct Taylor;

const INFO: MethodInfo = MethodInfo {
    name: "taylor",
    engines: &[],
    kind: Kind::Adaptive,
    order: 20,
    weak_orders: None,
    models: Models::Both,
    accepts: Accepts::Terms,
    damping: Damping::Within("a linear term of the recurrences: to the tolerance, as all else"),
    reversible: false,
    keeps_momentum: false,
    exact_free: false,
    preserves: "nothing exactly; everything to its tolerance",
    cost: Cost {
        evaluations: None,
        // A step of its own, tolerance 1e-12: order 15.
        weight: 1.5,
    },
    citation: "Jorba & Zou, Experimental Mathematics 14 (2005); Biscani & Izzo, MNRAS 504 (2021)",
};

impl Method for Taylor {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn set_out(&self, interval: Interval, t: f64, state: &StateBlock) -> Box<dyn Stepper> {
        // Forces that are no terms were refused.
        let terms = interval.load.terms(&interval.inertial).unwrap_or_default();
        let tolerance = interval.tolerance;
        let from = interval.clone();
        Box::new(Run::new(interval, state, |lane| {
            let start = state.get(lane);
            Body::new(Law::new(&from, &terms, lane, &start), tolerance, t, &start)
        }))
    }
}

/// One body on its way.
#[derive(Clone)]
struct Body {
    turning: Turning,
    directions: Vec<Vector3<f64>>,
    route: Route,
    order: usize,
    /// When it set out; the start and the end of the last step, s.
    set_out: f64,
    from: f64,
    reached: f64,
    /// Coefficients are in powers of time over this, s.
    unit: f64,
    /// Of the step from `from`: the rows of each order.
    series: Vec<Four>,
    /// At `reached`, |q| = 1; and what the last addition to it rounded away.
    turn: Turn,
    rest: Turn,
    work: Work,
}

/// Attitude and angular velocity: q as (x, y, z, w), ω as (p, q, r, 0) in principal axes.
#[derive(Clone, Copy, Debug, Default)]
struct Turn {
    q: Four,
    omega: Four,
}

/// Where the reference point is.
#[derive(Clone)]
enum Route {
    Flight(Flight),
    Journey(Box<Journey>),
}

/// Rows of an order with no direction, with one, and with the axes of the world.
const NONE: usize = rows(0);
const ONE: usize = rows(1);
const AXES: usize = rows(3);

/// Tries with a measure of time a thousandth of the last.
const SHORTER: u32 = 8;

/// Below this (rad/s) a spin is no measure of time: its powers would underflow, and what a torque makes
/// of it within a step is far more.
const SLOWEST: f64 = 1e-12;

impl Body {
    fn new(law: Law, tolerance: f64, t: f64, start: &State) -> Self {
        let order = order(tolerance);
        let route = match law.travel {
            Travel::Flight(flight) => Route::Flight(flight),
            Travel::Carried(carried) => {
                Route::Journey(Box::new(Journey::new(carried, order, start)))
            }
        };
        let width = match law.directions.len() {
            0 => NONE,
            1 => ONE,
            _ => AXES,
        };
        let omega_p = start.to_principal(start.omega_w);
        Self {
            turning: law.turning,
            directions: law.directions,
            route,
            order,
            set_out: t,
            from: t,
            reached: t,
            unit: 1.0 / power_of_two(omega_p.amax().max(SLOWEST)),
            series: vec![Four::default(); width * (order + 1)],
            turn: Turn {
                q: Four(start.q_wp.coords.into()),
                omega: omega_p.into(),
            },
            rest: Turn::default(),
            work: Work::default(),
        }
    }

    /// Rows an order has.
    fn width(&self) -> usize {
        self.series.len() / (self.order + 1)
    }

    /// Expands from the end of the last step.
    fn expand(&mut self) {
        self.work.evaluations += 1;
        match (self.width(), &mut self.route) {
            (NONE, _) => self.expand_rows::<NONE>(),
            (ONE, _) => self.expand_rows::<ONE>(),
            (_, Route::Flight(_)) => self.expand_rows::<AXES>(),
            (_, Route::Journey(journey)) => {
                journey.set_out(self.unit);
                let orders = first::<AXES>(&mut self.series, self.turn, &self.directions);
                recurrence::expand(&self.turning, self.unit, orders, journey.as_mut());
            }
        }
    }

    fn expand_rows<const ROWS: usize>(&mut self) {
        let orders = first::<ROWS>(&mut self.series, self.turn, &self.directions);
        recurrence::expand(&self.turning, self.unit, orders, &mut NoLevers);
    }

    /// How far the polynomial is good for, s; not a number where it is none.
    fn length(&self) -> f64 {
        let width = self.width();
        let attitude = |k: usize| self.series[width * k + Q].largest();
        let spin = |k: usize| self.series[width * k + OMEGA].largest();
        let speed = |k: usize| match &self.route {
            Route::Flight(_) => 0.0,
            Route::Journey(journey) => journey.speed(k),
        };
        // What ω and v are over a time such as a step takes, so that neither counts as zero.
        let scale = |of: &dyn Fn(usize) -> f64| larger(of(0), larger(of(1), of(2)));
        let (spin_scale, speed_scale) = (scale(&spin), scale(&speed));
        let relative = |size: f64, scale: f64| if size == 0.0 { 0.0 } else { size / scale };
        // log2 of the time at which term k would be 1.
        let radius = |k: usize| {
            let spin = relative(spin(k), spin_scale);
            let speed = relative(speed(k), speed_scale);
            -rough_log2(larger(attitude(k), larger(spin, speed))) / k as f64
        };
        let n = self.order;
        let safety = (2.0 + 0.7 / (n - 1) as f64) * LOG2_E;
        // Not f64::min, which would hide what is not a number.
        let radius = -larger(-radius(n), -radius(n - 1));
        self.unit * libm::exp2(radius - safety)
    }

    /// Takes the polynomial at `s` units from the start for the end of the step.
    fn arrive(&mut self, s: f64) {
        let Turn { q, omega } = change(self.width(), &self.series, s);
        // Half of what |q|² lacks of 1 brings q to unit length but for the square of that.
        let [x, y, z, w] = (self.turn.q + q).0;
        let lacks = 0.5 * (1.0 - (x * x + y * y + z * z + w * w));
        let q = q + Four([x, y, z, w]) * lacks;
        (self.turn.q, self.rest.q) = self.turn.q.plus(q + self.rest.q);
        (self.turn.omega, self.rest.omega) = self.turn.omega.plus(omega + self.rest.omega);
        if let Route::Journey(journey) = &mut self.route {
            journey.arrive(s);
        }
    }

    fn state(&self, turn: Turn, (x_w, v_w): (Vector3<f64>, Vector3<f64>)) -> State {
        let q = Quaternion::from(turn.q.0);
        let state = State {
            x_w,
            v_w,
            q_wp: q * (1.0 / q.norm()),
            omega_w: Vector3::zeros(),
        };
        State {
            omega_w: state.to_world(turn.omega.vector()),
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
        let mut length = self.length();
        // Where a spin of next to nothing was the measure of time, powers of it overflow: a shorter
        // measure will do.
        for _ in 0..SHORTER {
            if length > 0.0 {
                break;
            }
            self.unit *= 1.0 / 1024.0;
            self.expand();
            length = self.length();
        }
        if length.is_nan() {
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
        self.arrive((to - self.from) / self.unit);
        self.work.steps += 1;
        Some(())
    }

    fn at(&mut self, interval: &Interval, t: f64) -> State {
        let s = (t - self.from) / self.unit;
        let ends = t >= self.reached;
        let turn = if ends {
            self.turn
        } else {
            let Turn { q, omega } = change(self.width(), &self.series, s);
            Turn {
                q: self.series[Q] + q,
                omega: self.series[OMEGA] + omega,
            }
        };
        let place = match &self.route {
            Route::Flight(flight) => {
                let gone = Passage::of(t - self.set_out, interval.load.decay());
                flight.at(&gone.linear)
            }
            Route::Journey(journey) if ends => journey.end(),
            Route::Journey(journey) => journey.at(s),
        };
        self.state(turn, place)
    }

    fn work(&self) -> Work {
        self.work
    }
}

/// The orders, the first of them filled.
fn first<'s, const ROWS: usize>(
    series: &'s mut [Four],
    turn: Turn,
    directions: &[Vector3<f64>],
) -> &'s mut [Order<ROWS>] {
    let (orders, _): (&mut [Order<ROWS>], _) = series.as_chunks_mut();
    set_attitude(&mut orders[0], turn.q);
    set_spin(&mut orders[0], turn.omega);
    for (d, direction_w) in directions.iter().enumerate() {
        let u = rotate_back(Quaternion::from(turn.q.0), *direction_w);
        set_direction(&mut orders[0], d, u.into());
    }
    orders
}

/// `Rᵀ v`.
fn rotate_back(q: Quaternion<f64>, v: Vector3<f64>) -> Vector3<f64> {
    let t = v.cross(&q.imag()) * 2.0;
    v + t * q.w + t.cross(&q.imag())
}

/// What q and ω change by until `s`: the sum of their series but for order 0, even and odd powers apart,
/// so that neither waits for the other.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn change(width: usize, series: &[Four], s: f64) -> Turn {
    let square = s * s;
    let (mut later, mut sooner) = (Turn::default(), Turn::default());
    for order in series[width..].chunks_exact(width).rev() {
        let next = Turn {
            q: order[Q] + later.q * square,
            omega: order[OMEGA] + later.omega * square,
        };
        (later, sooner) = (sooner, next);
    }
    Turn {
        q: sooner.q * s + later.q * square,
        omega: sooner.omega * s + later.omega * square,
    }
}

/// `⌈1 - ½ ln tol⌉`.
fn order(tolerance: f64) -> usize {
    let order = libm::ceil(1.0 - 0.5 * libm::log(tolerance));
    // Of tolerances that 64-bit numbers cannot hold, or that are none, the highest.
    if order.is_nan() {
        20
    } else {
        order.clamp(4.0, 20.0) as usize
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
