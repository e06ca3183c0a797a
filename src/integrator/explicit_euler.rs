//! Explicit Euler, everything by the state at the start of the step:
//!
//! ```text
//! x += h v     v += h m⁻¹ F     q += ½ h (ω, 0) q, normalised     ω += h I_w⁻¹ τ     then damping
//! ```
//!
//! Order 1, and known bad: the energy of an oscillation at Ω grows by the factor 1 + (h Ω)² at every
//! step, however small h is. It is here to show that.
//! Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, I.7.

use super::common::{along, damp, normalised};
use super::{Method, MethodInfo};
use crate::body::{Inertial, InertialBlock, LANES, State, StateBlock};
use crate::effect::{Load, Wrench, WrenchBlock};
use crate::math::spin_rate;
use multiversion::multiversion;

pub struct ExplicitEuler;

const INFO: MethodInfo = MethodInfo {
    name: "explicit-euler",
    order: 1,
    preserves: "nothing; an oscillation's energy grows by 1 + (hΩ)² a step (kept to show it)",
    accepts: "any",
    damping: "after the step, exact factor",
    citation: "Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, I.7",
};

impl Method for ExplicitEuler {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn step(&self, t: f64, h: f64, load: &Load, inertial: &InertialBlock, state: &mut StateBlock) {
        let wrench = load.wrench(t, inertial, state);
        lanes(h, &wrench, inertial, state);
        if let Some(decay) = load.decay() {
            damp(decay, h, state);
        }
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn lanes(h: f64, wrench: &WrenchBlock, inertial: &InertialBlock, state: &mut StateBlock) {
    for lane in 0..LANES {
        let next = kernel(h, wrench.get(lane), &inertial.get(lane), state.get(lane));
        state.set(lane, next);
    }
}

#[inline(always)]
fn kernel(h: f64, wrench: Wrench, inertial: &Inertial, s: State) -> State {
    let rate = State {
        x_w: s.v_w,
        v_w: wrench.force_w * inertial.inv_mass,
        q_wp: spin_rate(s.omega_w, s.q_wp),
        omega_w: inertial.angular_response(&s, wrench.tau_w),
    };
    normalised(along(s, h, rate))
}
