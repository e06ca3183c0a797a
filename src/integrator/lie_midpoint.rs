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

use super::common::decayed;
use super::{Method, MethodInfo};
use crate::body::{Inertial, InertialBlock, LANES, State, StateBlock};
use crate::effect::{Load, Wrench, WrenchBlock};
use crate::math::exponential;
use multiversion::multiversion;

pub struct LieMidpoint;

const INFO: MethodInfo = MethodInfo {
    name: "lie-midpoint",
    order: 2,
    preserves: "|q| by construction; rotation at constant ω exactly",
    accepts: "any",
    damping: "integrating factor: exact by itself, order 2 with torques",
    citation: "Hairer, Lubich & Wanner, Geometric Numerical Integration, IV.8; damping: Lawson 1967",
};

/// Factors over half a step on v and ω; 1 where nothing decays.
#[derive(Clone, Copy)]
struct HalfDecay {
    linear: f64,
    angular: f64,
}

impl Method for LieMidpoint {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn step(&self, t: f64, h: f64, load: &Load, inertial: &InertialBlock, state: &mut StateBlock) {
        let half = 0.5 * h;
        let decay = load.decay().map(|d| HalfDecay {
            linear: d.linear_factor(half),
            angular: d.angular_factor(half),
        });
        let start = *state;
        let mut middle = start;
        to_middle(
            half,
            decay,
            &load.wrench(t, inertial, &start),
            inertial,
            &mut middle,
        );
        let wrench = load.wrench(t + half, inertial, &middle);
        across(h, decay, &wrench, inertial, &middle, state);
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn to_middle(
    half: f64,
    decay: Option<HalfDecay>,
    wrench: &WrenchBlock,
    inertial: &InertialBlock,
    state: &mut StateBlock,
) {
    for lane in 0..LANES {
        let s = state.get(lane);
        let (v_w, omega_w) = accelerated(half, wrench.get(lane), &inertial.get(lane), &s, s);
        let moved = State {
            x_w: s.x_w + s.v_w * half,
            v_w,
            q_wp: exponential(s.omega_w * half) * s.q_wp,
            omega_w,
        };
        let moved = match decay {
            None => moved,
            Some(e) => decayed(moved, e.linear, e.angular),
        };
        state.set(lane, moved);
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn across(
    h: f64,
    decay: Option<HalfDecay>,
    wrench: &WrenchBlock,
    inertial: &InertialBlock,
    middle: &StateBlock,
    state: &mut StateBlock,
) {
    for lane in 0..LANES {
        let (s, m) = (state.get(lane), middle.get(lane));
        // E² y + h E k = E (E y + h k).
        let from = match decay {
            None => s,
            Some(e) => decayed(s, e.linear, e.angular),
        };
        let (v_w, omega_w) = accelerated(h, wrench.get(lane), &inertial.get(lane), &m, from);
        let moved = State {
            x_w: s.x_w + m.v_w * h,
            v_w,
            q_wp: exponential(m.omega_w * h) * s.q_wp,
            omega_w,
        };
        let moved = match decay {
            None => moved,
            Some(e) => decayed(moved, e.linear, e.angular),
        };
        state.set(lane, moved);
    }
}

/// The velocities of `from` after `h` seconds of the wrench, at the attitude of `at`.
#[inline(always)]
fn accelerated(
    h: f64,
    wrench: Wrench,
    inertial: &Inertial,
    at: &State,
    from: State,
) -> (nalgebra::Vector3<f64>, nalgebra::Vector3<f64>) {
    (
        from.v_w + wrench.force_w * (inertial.inv_mass * h),
        from.omega_w + inertial.angular_response(at, wrench.tau_w) * h,
    )
}
