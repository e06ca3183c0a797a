//! The classical Runge-Kutta method of order 4 on (x, v, p, ω), where ω is in principal axes and p is the turn
//! since the start of the step, `q = q0 p`:
//!
//! ```text
//! y' = f(t, y):   x' = v   v' = m⁻¹ F   p' = ½ p (ω, 0)   ω' = I⁻¹ (R(q)ᵀ τ - ω × I ω)
//! k1 = f(t, y)   k2 = f(t + h/2, y + h/2 k1)   k3 = f(t + h/2, y + h/2 k2)   k4 = f(t + h, y + h k3)
//! y += h/6 (k1 + 2 k2 + 2 k3 + k4)      q = q0 p, normalised
//! ```
//!
//! Without the term `ω × I ω` it is the tutorial's model in these axes too, since ω does not turn about itself.
//! Between steps ω is in world axes, as the state has it: a step depends on nothing but the state at its start.
//!
//! With damping it is the integrating-factor (Lawson) form: with `E = e^{-c h/2}` on ω (and with
//! k on v) the stages start from `E y` and `E² y`, so that the decay of a velocity by itself is exact for any c h
//! (beside a torque, accuracy needs c h well below 1, as it needs ω h):
//!
//! ```text
//! Y2 = E (y + h/2 k1)   Y3 = E y + h/2 k2   Y4 = E² y + h E k3
//! y' = E² y + h/6 (E² k1 + 2 E (k2 + k3) + k4)
//! ```
//!
//! In principal axes ω' of a free body does not ask for its attitude, and p' is linear in p: so the
//! stages of p may have any length, and torques are taken at `p/|p|`, which is a rotation. (With stages of unit
//! length errors are 2.5 times smaller, in the mean of 25 free bodies by chance, and a step takes 1.2 to 1.35
//! times as long: by a method of order 4 no gain.)
//!
//! Where nothing is applied, or what is stays the same, all four stages of a lane are one kernel: no
//! forces to ask for between them. The same operations in the same order, so the same bits.
//!
//! Hairer, Nørsett & Wanner, Solving ODEs I, II.1; Lawson, SIAM J. Numer. Anal. 4 (1967).
//! Neither energy nor momentum is kept exactly: both drift as h⁴.

use super::common::{DecayFactors, Forces, Kernel, each_lane, march, with_forces};
use super::one_step::OneStep;
use super::{Accepts, Cost, Damping, Interval, Kind, MethodInfo, Models, Step};
use crate::body::{Inertial, QuaternionLanes, State, StateBlock, Vector3Lanes};
use crate::math::turned;
use multiversion::multiversion;
use nalgebra::{Quaternion, Vector3};
use std::ops::Add;

#[derive(Clone, Copy)]
pub struct Rk4;

const INFO: MethodInfo = MethodInfo {
    name: "rk4",
    engines: &[],
    kind: Kind::Fixed,
    order: 4,
    weak_orders: None,
    accepts: Accepts::Any,
    models: Models::Both,
    damping: Damping::Exact("integrating factor: exact by itself, order 4 with torques"),
    reversible: false,
    keeps_momentum: false,
    exact_free: false,
    preserves: "nothing exactly; energy and momentum drift as h⁴",
    cost: Cost {
        evaluations: Some(4),
        weight: 1.0,
    },
    citation: "Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, II.1; damping: Lawson 1967",
};

impl OneStep for Rk4 {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn step(&self, t: f64, h: f64, interval: &Interval, state: &mut StateBlock) {
        self.steps(&[Step::alone(t, h)], interval, state, &mut Vec::new());
    }

    fn steps(
        &self,
        steps: &[Step],
        interval: &Interval,
        state: &mut StateBlock,
        kept: &mut Vec<StateBlock>,
    ) {
        let load = &interval.load;
        if load.decay().is_none() && !load.varies() {
            return march(*self, steps, interval, state, kept);
        }
        let mut stages = Stages::default();
        for step in steps {
            match DecayFactors::of(load, 0.5 * step.h) {
                None => stages.step(step, Undamped, interval, state),
                Some(e) => stages.step(step, e, interval, state),
            }
            if step.keep {
                kept.push(*state);
            }
        }
    }
}

/// All four stages, under forces that stay.
impl Kernel for Rk4 {
    #[inline(always)]
    fn stepped(self, h: f64, lane: usize, forces: impl Forces, body: &Inertial, s: State) -> State {
        let y = Y::start(&s);
        let k1 = first_rate(lane, forces, body, &s, y);
        let k2 = rate(lane, forces, body, &s, second(h, Undamped, y, k1));
        let k3 = rate(lane, forces, body, &s, third(h, Undamped, y, k2));
        let k4 = rate(lane, forces, body, &s, fourth(h, Undamped, y, k3));
        ended(h, Undamped, &s, y, [k1, k2, k3, k4])
    }
}

/// A body within a step.
#[derive(Clone, Copy)]
struct Y {
    x_w: Vector3<f64>,
    v_w: Vector3<f64>,
    /// The turn since the start of the step, of any length.
    p: Quaternion<f64>,
    omega_p: Vector3<f64>,
}

/// y', but for p, whose place `2 p' = p (ω, 0)` has.
type Rate = Y;

impl Y {
    #[inline(always)]
    fn start(s: &State) -> Self {
        Self {
            x_w: s.x_w,
            v_w: s.v_w,
            p: Quaternion::from_parts(1.0, Vector3::zeros()),
            omega_p: s.to_principal(s.omega_w),
        }
    }

    /// The state that it is, in a step that started from s.
    #[inline(always)]
    fn since(self, s: &State) -> State {
        let q = s.q_wp * self.p;
        let q_wp = q * (1.0 / q.norm());
        State {
            x_w: self.x_w,
            v_w: self.v_w,
            q_wp,
            omega_w: turned(q_wp, self.omega_p),
        }
    }

    /// `y + h k`, where y is at the start.
    #[inline(always)]
    fn along(self, h: f64, k: Rate) -> Self {
        let p = k.p * (0.5 * h);
        Self {
            x_w: self.x_w + k.x_w * h,
            v_w: self.v_w + k.v_w * h,
            p: Quaternion::from_parts(1.0 + p.w, p.imag()),
            omega_p: self.omega_p + k.omega_p * h,
        }
    }
}

impl Add for Y {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            x_w: self.x_w + other.x_w,
            v_w: self.v_w + other.v_w,
            p: self.p + other.p,
            omega_p: self.omega_p + other.omega_p,
        }
    }
}

/// k1, in a step that starts from s: p is 1 there.
#[inline(always)]
fn first_rate(lane: usize, forces: impl Forces, body: &Inertial, s: &State, y: Y) -> Rate {
    Rate {
        p: Quaternion::from_parts(0.0, y.omega_p),
        ..accelerations(lane, forces, body, y, |tau_w| s.to_principal(tau_w))
    }
}

/// k at a later stage.
#[inline(always)]
fn rate(lane: usize, forces: impl Forces, body: &Inertial, s: &State, y: Y) -> Rate {
    Rate {
        p: twice_rate(y.p, y.omega_p),
        ..accelerations(lane, forces, body, y, |tau_w| {
            let (p, tau_p) = (y.p.conjugate(), s.to_principal(tau_w));
            tau_p + turned_on(p, 2.0 / p.norm_squared(), tau_p)
        })
    }
}

/// x', v' and `ω' = I⁻¹ (τ - ω × I ω)`; p' is not known here.
#[inline(always)]
fn accelerations<F: Forces>(
    lane: usize,
    forces: F,
    body: &Inertial,
    y: Y,
    to_principal: impl Fn(Vector3<f64>) -> Vector3<f64>,
) -> Rate {
    let (a_w, applied_p) = forces.applied(lane, body, to_principal);
    Rate {
        x_w: y.v_w,
        v_w: a_w,
        p: y.p,
        omega_p: match F::GYROSCOPIC {
            true => applied_p + gyroscopic_p(body, y.omega_p),
            false => applied_p,
        },
    }
}

/// `-I⁻¹ (ω × I ω) = ((I2 - I3)/I1 ω2 ω3, …)`, rad/s², by the differences of the moments: they are the same at every
/// stage.
#[inline(always)]
fn gyroscopic_p(body: &Inertial, omega_p: Vector3<f64>) -> Vector3<f64> {
    let (i, w) = (body.moments, omega_p);
    let differences = Vector3::new(i.y - i.z, i.z - i.x, i.x - i.y);
    let products = Vector3::new(w.y * w.z, w.z * w.x, w.x * w.y);
    (body.inv_moments.component_mul(&differences)).component_mul(&products)
}

/// `p (ω, 0)`.
#[inline(always)]
fn twice_rate(p: Quaternion<f64>, omega_p: Vector3<f64>) -> Quaternion<f64> {
    // Written out, because the compiler must not leave out products with the 0.
    let (u, w, o) = (p.imag(), p.w, omega_p);
    Quaternion::new(
        -(u.x * o.x) - u.y * o.y - u.z * o.z,
        w * o.x + u.y * o.z - u.z * o.y,
        w * o.y + u.z * o.x - u.x * o.z,
        w * o.z + u.x * o.y - u.y * o.x,
    )
}

/// Y2 of a y at the start. p is 1 and something without a real part, exactly.
#[inline(always)]
fn second(h: f64, e: impl Decaying, y: Y, k1: Rate) -> Y {
    Y {
        p: Quaternion::from_parts(1.0, k1.p.imag() * (0.25 * h)),
        ..e.on(1, y.along(0.5 * h, k1))
    }
}

#[inline(always)]
fn third(h: f64, e: impl Decaying, y: Y, k2: Rate) -> Y {
    e.on(1, y).along(0.5 * h, k2)
}

#[inline(always)]
fn fourth(h: f64, e: impl Decaying, y: Y, k3: Rate) -> Y {
    e.on(2, y).along(h, e.on(1, k3))
}

/// The state at the end of a step that started from s. The sum of the stages' v is, by what they are,
/// `x' = x + h (1 + 4 E + E²)/6 v + h²/6 (E a1 + a2 + E a3)`; and with `Δ = h/6 (E² k1 + …)` of ω
///
/// ```text
/// ω_w' = E² ω_w + R(q0) (Δ + (R(p) - 1) ω_p')
/// ```
///
/// so that what is turned into the world is of the size of h, and its rounding too: ω_p' itself would come
/// back, step by step, longer by what a unit quaternion is off, which is not by chance.
#[inline(always)]
fn ended(h: f64, e: impl Decaying, s: &State, y: Y, [k1, k2, k3, k4]: [Rate; 4]) -> State {
    let middle = e.on(1, k2 + k3);
    let sum = e.on(2, k1) + (middle + middle) + k4;
    let end = e.on(2, y).along(h / 6.0, sum);
    let q = s.q_wp * end.p;
    let inverse = 1.0 / q.norm();
    let (one, two) = (e.factors(1), e.factors(2));
    let mean = (1.0 + 4.0 * one.linear + two.linear) / 6.0;
    let a_w = (k1.v_w + k3.v_w) * one.linear + k2.v_w;
    // |q| is |p|, to rounding.
    let turned_p = turned_on(end.p, 2.0 * inverse * inverse, end.omega_p);
    State {
        x_w: s.x_w + (s.v_w * mean + a_w * (h / 6.0)) * h,
        v_w: end.v_w,
        q_wp: q * inverse,
        omega_w: s.omega_w * two.angular + s.to_world(sum.omega_p * (h / 6.0) + turned_p),
    }
}

/// `(R(p) - 1) v = 2/|p|² u × (u × v + w v)`, p = (u, w), where `scale` is 2/|p|².
#[inline(always)]
fn turned_on(p: Quaternion<f64>, scale: f64, v: Vector3<f64>) -> Vector3<f64> {
    let u = p.imag();
    let t = u.cross(&v) * scale;
    t * p.w + u.cross(&t)
}

/// E: what is left of the velocities after half a step.
trait Decaying: Copy {
    /// After so many halves.
    fn factors(self, halves: u8) -> DecayFactors;

    #[inline(always)]
    fn on(self, halves: u8, y: Y) -> Y {
        let e = self.factors(halves);
        Y {
            v_w: y.v_w * e.linear,
            omega_p: y.omega_p * e.angular,
            ..y
        }
    }
}

impl Decaying for DecayFactors {
    #[inline(always)]
    fn factors(self, halves: u8) -> DecayFactors {
        self.times(halves)
    }
}

/// E = 1. A type, so that the compiler multiplies by nothing.
#[derive(Clone, Copy)]
struct Undamped;

impl Decaying for Undamped {
    #[inline(always)]
    fn factors(self, _: u8) -> DecayFactors {
        DecayFactors {
            linear: 1.0,
            angular: 1.0,
        }
    }
}

/// A block of bodies within a step, where it is asked what is applied at each stage.
#[derive(Default)]
struct Stages {
    at: YBlock,
    /// The same as forces are asked for it.
    seen: StateBlock,
    /// k1, k2, k3.
    rates: [YBlock; 3],
}

impl Stages {
    fn step(&mut self, step: &Step, e: impl Decaying, interval: &Interval, state: &mut StateBlock) {
        let (load, inertial) = (&interval.load, &interval.inertial);
        let (t, h) = (step.from, step.h);
        let mut room = None;
        let wrench = load.wrench_in(&mut room, t, inertial, state);
        with_forces!(load, wrench, |f| advance::<_, _, 1>(
            h, e, f, interval, state, self
        ));
        let wrench = load.wrench_in(&mut room, t + 0.5 * h, inertial, &self.seen);
        with_forces!(load, wrench, |f| advance::<_, _, 2>(
            h, e, f, interval, state, self
        ));
        let wrench = load.wrench_in(&mut room, t + 0.5 * h, inertial, &self.seen);
        with_forces!(load, wrench, |f| advance::<_, _, 3>(
            h, e, f, interval, state, self
        ));
        let wrench = load.wrench_in(&mut room, t + h, inertial, &self.seen);
        with_forces!(load, wrench, |f| finish(h, e, f, interval, self, state));
    }
}

/// From stage N to the next.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn advance<F: Forces, E: Decaying, const N: usize>(
    h: f64,
    e: E,
    forces: F,
    interval: &Interval,
    start: &StateBlock,
    stages: &mut Stages,
) {
    each_lane!(interval.bodies, |lane| {
        let (body, s) = (interval.inertial.get(lane), start.get(lane));
        let y = Y::start(&s);
        let k = match N {
            1 => first_rate(lane, forces, &body, &s, y),
            _ => rate(lane, forces, &body, &s, stages.at.get(lane)),
        };
        let next = match N {
            1 => second(h, e, y, k),
            2 => third(h, e, y, k),
            _ => fourth(h, e, y, k),
        };
        stages.rates[N - 1].set(lane, k);
        stages.at.set(lane, next);
        stages.seen.set(lane, next.since(&s));
    });
}

/// The last stage.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn finish<F: Forces, E: Decaying>(
    h: f64,
    e: E,
    forces: F,
    interval: &Interval,
    stages: &Stages,
    state: &mut StateBlock,
) {
    let [k1, k2, k3] = &stages.rates;
    each_lane!(interval.bodies, |lane| {
        let (body, s) = (interval.inertial.get(lane), state.get(lane));
        let k4 = rate(lane, forces, &body, &s, stages.at.get(lane));
        let k = [k1.get(lane), k2.get(lane), k3.get(lane), k4];
        state.set(lane, ended(h, e, &s, Y::start(&s), k));
    });
}

#[derive(Clone, Copy, Default)]
struct YBlock {
    x_w: Vector3Lanes,
    v_w: Vector3Lanes,
    p: QuaternionLanes,
    omega_p: Vector3Lanes,
}

impl YBlock {
    #[inline(always)]
    fn get(&self, lane: usize) -> Y {
        Y {
            x_w: self.x_w.get(lane),
            v_w: self.v_w.get(lane),
            p: self.p.get(lane),
            omega_p: self.omega_p.get(lane),
        }
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, y: Y) {
        self.x_w.set(lane, y.x_w);
        self.v_w.set(lane, y.v_w);
        self.p.set(lane, y.p);
        self.omega_p.set(lane, y.omega_p);
    }
}
