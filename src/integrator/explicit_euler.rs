//! Explicit Euler, everything by the state at the start of the step:
//!
//! ```text
//! x += h v     v += h m⁻¹ F     q += ½ h (ω, 0) q, normalised     ω += h I_w⁻¹ τ     then damping
//! ```
//!
//! Order 1, and known bad: the energy of an oscillation at Ω grows by the factor 1 + (h Ω)² at every
//! step, however small h is. It is here to show that.
//! Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, I.7.

use super::common::{Acceleration, Forces, Rate, along, damp, normalised, with_forces};
use super::one_step::OneStep;
use super::{Accepts, Cost, Damping, Interval, Kind, MethodInfo, Models};
use crate::body::{InertialBlock, LANES, State, StateBlock};
use crate::math::spin_rate;
use multiversion::multiversion;

#[derive(Clone, Copy)]
pub struct ExplicitEuler;

const INFO: MethodInfo = MethodInfo {
    name: "explicit-euler",
    engines: &[],
    kind: Kind::Fixed,
    order: 1,
    accepts: Accepts::Any,
    models: Models::Both,
    damping: Damping::Exact("after the step, exact factor"),
    reversible: false,
    keeps_momentum: false,
    exact_free: false,
    preserves: "nothing; an oscillation's energy grows by 1 + (hΩ)² a step (kept to show it)",
    cost: Cost {
        evaluations: 1,
        weight: 0.3,
    },
    citation: "Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, I.7",
};

impl OneStep for ExplicitEuler {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn step(&self, t: f64, h: f64, interval: &Interval, state: &mut StateBlock) {
        let (load, inertial) = (&interval.load, &interval.inertial);
        let wrench = load.wrench(t, inertial, state);
        with_forces!(load, wrench.as_ref(), |forces| lanes(
            h, forces, inertial, state
        ));
        if let Some(decay) = load.decay() {
            damp(decay, h, state);
        }
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn lanes<F: Forces>(h: f64, forces: F, inertial: &InertialBlock, state: &mut StateBlock) {
    for lane in 0..LANES {
        let s = state.get(lane);
        let acceleration = forces.acceleration(lane, &inertial.get(lane), &s);
        state.set(lane, kernel(h, acceleration, s));
    }
}

#[inline(always)]
fn kernel(h: f64, acceleration: Acceleration, s: State) -> State {
    let rate = Rate {
        x_w: s.v_w,
        v_w: acceleration.a_w,
        q_wp: spin_rate(s.omega_w, s.q_wp),
        omega_w: acceleration.alpha_w,
    };
    normalised(along(s, h, rate))
}
