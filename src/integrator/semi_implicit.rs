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

use super::common::{Acceleration, Forces, Kernel, march};
use super::one_step::OneStep;
use super::{Accepts, Cost, Damping, Interval, Kind, MethodInfo, Models, Step};
use crate::body::{Inertial, State, StateBlock};
use crate::math::spin_rate;

#[derive(Clone, Copy)]
pub struct SemiImplicit;

const INFO: MethodInfo = MethodInfo {
    name: "semi-implicit",
    engines: &[],
    kind: Kind::Fixed,
    order: 1,
    weak_orders: None,
    accepts: Accepts::Any,
    models: Models::Both,
    damping: Damping::Exact("after the step, exact factor"),
    reversible: false,
    keeps_momentum: false,
    exact_free: false,
    preserves: "angular velocity where no torque acts and the gyroscopic term is absent",
    cost: Cost {
        evaluations: Some(1),
        weight: 0.25,
    },
    citation: "the tutorial; symplectic Euler: Hairer, Lubich & Wanner, Geometric Numerical Integration, I.1.2",
};

impl OneStep for SemiImplicit {
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
        march(*self, steps, interval, state, kept);
    }
}

impl Kernel for SemiImplicit {
    #[inline(always)]
    fn stepped(self, h: f64, lane: usize, forces: impl Forces, body: &Inertial, s: State) -> State {
        let Acceleration { a_w, alpha_w } = forces.acceleration(lane, body, &s);
        let omega_w = s.omega_w + alpha_w * h;
        let q = s.q_wp + spin_rate(omega_w, s.q_wp) * h;
        let v_w = s.v_w + a_w * h;
        State {
            x_w: s.x_w + v_w * h,
            v_w,
            q_wp: q * (1.0 / q.norm()),
            omega_w,
        }
    }
}
