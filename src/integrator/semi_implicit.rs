//! The tutorial's step, semi-implicit Euler, as corrected:
//!
//! ```text
//! α = I_w⁻¹ τ(t, state)      ω += α h      q += ½ h (ω, 0) q, normalised      ω *= e^{-c h}
//! a = m⁻¹ F(t, state)        v += a h      x += h v                           v *= e^{-k h}
//! ```
//!
//! Order 1. `2 dt` in some copies of the tutorial's fourth line is a misprint for `½ dt`.
//! With the gyroscopic effect the term enters explicitly, and energy grows.
//! Degenerate cases: an inverse moment of 0 leaves that component of ω alone; ω = 0 leaves q alone.

use super::common::damp;
use super::{Method, MethodInfo};
use crate::body::{Inertial, InertialBlock, LANES, State, StateBlock};
use crate::effect::{Load, Wrench, WrenchBlock};
use crate::math::spin_rate;
use multiversion::multiversion;

pub struct SemiImplicit;

const INFO: MethodInfo = MethodInfo {
    name: "semi-implicit",
    order: 1,
    preserves: "angular velocity where no torque acts and the gyroscopic term is absent",
    accepts: "any",
    damping: "after the step, exact factor",
    citation: "the tutorial; symplectic Euler: Hairer, Lubich & Wanner, Geometric Numerical Integration, I.1.2",
};

impl Method for SemiImplicit {
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
    let alpha_w = inertial.angular_response(&s, wrench.tau_w);
    let omega_w = s.omega_w + alpha_w * h;
    let q = s.q_wp + spin_rate(omega_w, s.q_wp) * h;
    let v_w = s.v_w + wrench.force_w * (inertial.inv_mass * h);
    State {
        x_w: s.x_w + v_w * h,
        v_w,
        q_wp: q * (1.0 / q.norm()),
        omega_w,
    }
}
