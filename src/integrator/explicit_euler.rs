//! Explicit Euler, everything by the state at the start of the step:
//!
//! ```text
//! x += h v     v += h m⁻¹ F     q += ½ h (ω, 0) q, normalised     ω += h I_w⁻¹ τ     then damping
//! ```
//!
//! Order 1, and known bad: the energy of an oscillation at Ω grows by the factor 1 + (h Ω)² at every
//! step, however small h is. It is here to show that.
//! Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, I.7.

use super::common::{Acceleration, Forces, Kernel, Rate, along, march, normalised};
use super::one_step::OneStep;
use super::{Accepts, Cost, Damping, Interval, Kind, MethodInfo, Models, Step};
use crate::body::{Inertial, State, StateBlock};
use crate::math::spin_rate;

#[derive(Clone, Copy)]
pub struct ExplicitEuler;

const INFO: MethodInfo = MethodInfo {
    name: "explicit-euler",
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
    preserves: "nothing; an oscillation's energy grows by 1 + (hΩ)² a step (kept to show it)",
    cost: Cost {
        evaluations: Some(1),
        weight: 0.24,
    },
    citation: "Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, I.7",
};

impl OneStep for ExplicitEuler {
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

impl Kernel for ExplicitEuler {
    #[inline(always)]
    fn stepped(self, h: f64, lane: usize, forces: impl Forces, body: &Inertial, s: State) -> State {
        let Acceleration { a_w, alpha_w } = forces.acceleration(lane, body, &s);
        let rate = Rate {
            x_w: s.v_w,
            v_w: a_w,
            q_wp: spin_rate(s.omega_w, s.q_wp),
            omega_w: alpha_w,
        };
        normalised(along(s, h, rate))
    }
}
