//! The explicit midpoint rule on the rotation group: attitudes by the exponential map, never by adding
//! quaternions.
//!
//! ```text
//! half:  v½ = v + h/2 a(t, y)         ω½ = ω + h/2 α(t, y)         q½ = exp(h/2 ω) q      x½ = x + h/2 v
//! whole: v' = v + h a(t + h/2, y½)    ω' = ω + h α(t + h/2, y½)    q' = exp(h ω½) q       x' = x + h v½
//! ```
//!
//! Order 2; |q| = 1 by construction. With damping it is the integrating-factor form: with
//! `E = e^{-c h/2}`, `ω½ = E (ω + h/2 α)` and `ω' = E² ω + h E α½`, likewise v.
//! A rotation at constant ω is exact, however far a step turns.
//!
//! Hairer, Lubich & Wanner, Geometric Numerical Integration, IV.8 (Runge-Kutta-Munthe-Kaas, s = 2).

use super::common::{Acceleration, Forces, HalfDecay, damp, decayed, with_forces};
use super::one_step::OneStep;
use super::{Accepts, Cost, Damping, Interval, Kind, MethodInfo, Models};
use crate::body::{InertialBlock, LANES, State, StateBlock};
use crate::math::exponential;
use multiversion::multiversion;

#[derive(Clone, Copy)]
pub struct LieMidpoint;

const INFO: MethodInfo = MethodInfo {
    name: "lie-midpoint",
    engines: &[],
    kind: Kind::Fixed,
    order: 2,
    accepts: Accepts::Any,
    models: Models::Both,
    damping: Damping::Exact("integrating factor: exact by itself, order 2 with torques"),
    reversible: false,
    keeps_momentum: false,
    exact_free: false,
    preserves: "|q| by construction; rotation at constant ω exactly",
    cost: Cost {
        evaluations: 2,
        weight: 1.4,
    },
    citation: "Hairer, Lubich & Wanner, Geometric Numerical Integration, IV.8; damping: Lawson 1967",
};

impl OneStep for LieMidpoint {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn step(&self, t: f64, h: f64, interval: &Interval, state: &mut StateBlock) {
        let (load, inertial) = (&interval.load, &interval.inertial);
        let half = 0.5 * h;
        let decay = HalfDecay::of(load, half);
        let start = *state;
        let mut middle = start;
        let wrench = load.wrench(t, inertial, &start);
        with_forces!(load, wrench.as_ref(), |forces| advance(
            half,
            decay,
            forces,
            inertial,
            &start,
            &mut middle
        ));
        let wrench = load.wrench(t + half, inertial, &middle);
        // E² y + h E k = E (E y + h k).
        if let Some(decay) = load.decay() {
            damp(decay, half, state);
        }
        with_forces!(load, wrench.as_ref(), |forces| advance(
            h, decay, forces, inertial, &middle, state
        ));
    }
}

/// Takes `state` `h` seconds on with the velocities and accelerations of `at`, then E.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn advance<F: Forces>(
    h: f64,
    decay: Option<HalfDecay>,
    forces: F,
    inertial: &InertialBlock,
    at: &StateBlock,
    state: &mut StateBlock,
) {
    for lane in 0..LANES {
        let at = at.get(lane);
        let acceleration = forces.acceleration(lane, &inertial.get(lane), &at);
        let moved = kernel(h, acceleration, &at, state.get(lane));
        let moved = match decay {
            None => moved,
            Some(e) => decayed(moved, e.linear, e.angular),
        };
        state.set(lane, moved);
    }
}

#[inline(always)]
fn kernel(h: f64, acceleration: Acceleration, at: &State, s: State) -> State {
    State {
        x_w: s.x_w + at.v_w * h,
        v_w: s.v_w + acceleration.a_w * h,
        q_wp: exponential(at.omega_w * h) * s.q_wp,
        omega_w: s.omega_w + acceleration.alpha_w * h,
    }
}
