//! The classical Runge-Kutta method of order 4 on (x, v, q, ω), q normalised after the step:
//!
//! ```text
//! y' = f(t, y):   x' = v   v' = m⁻¹ F   q' = ½ (ω, 0) q   ω' = I_w⁻¹ τ
//! k1 = f(t, y)   k2 = f(t + h/2, y + h/2 k1)   k3 = f(t + h/2, y + h/2 k2)   k4 = f(t + h, y + h k3)
//! y += h/6 (k1 + 2 k2 + 2 k3 + k4)
//! ```
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
//! Where nothing is applied, or what is stays the same, all four stages of a lane are one kernel: no
//! forces to ask for between them. Stages are brought to unit q before f is taken there: the same method on the field f(y/|q|),
//! whose solutions are the same and of which |q| is an invariant. It keeps order 4, and the error is
//! several times smaller than with the rates of a q that is no rotation.
//!
//! Hairer, Nørsett & Wanner, Solving ODEs I, II.1; Lawson, SIAM J. Numer. Anal. 4 (1967).
//! Neither energy nor momentum is kept exactly: both drift as h⁴.

use super::common::{
    DecayFactors, Forces, Kernel, along, each_lane, march, normalised, rate, with_forces,
};
use super::one_step::OneStep;
use super::{Accepts, Cost, Damping, Interval, Kind, MethodInfo, Models, Step};
use crate::body::{Inertial, LANES, State, StateBlock};
use multiversion::multiversion;

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
        let (load, inertial) = (&interval.load, &interval.inertial);
        let half = 0.5 * h;
        let decay = DecayFactors::of(load, half);
        let start = *state;
        let mut at = start;
        if let Some(e) = decay {
            decay_twice(e, state);
        }
        let mut room = None;
        for stage in stages(h) {
            let wrench = load.wrench_in(&mut room, t + stage.ahead, inertial, &at);
            with_forces!(load, wrench, |forces| match decay {
                None => advance(stage, forces, interval, &start, &mut at, state),
                Some(e) => advance_decaying(stage, e, forces, interval, &start, &mut at, state),
            });
        }
        let wrench = load.wrench_in(&mut room, t + h, inertial, &at);
        with_forces!(load, wrench, |forces| finish(
            h, forces, interval, &at, state
        ));
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
        for step in steps {
            self.step(step.from, step.h, interval, state);
            if step.keep {
                kept.push(*state);
            }
        }
    }
}

/// All four stages, under forces that stay.
impl Kernel for Rk4 {
    #[inline(always)]
    fn stepped(self, h: f64, lane: usize, forces: impl Forces, body: &Inertial, y: State) -> State {
        let k1 = rate(lane, forces, body, y);
        let k2 = rate(lane, forces, body, normalised(along(y, 0.5 * h, k1)));
        let k3 = rate(lane, forces, body, normalised(along(y, 0.5 * h, k2)));
        let k4 = rate(lane, forces, body, normalised(along(y, h, k3)));
        let sum = along(along(along(y, h / 6.0, k1), h / 3.0, k2), h / 3.0, k3);
        normalised(along(sum, h / 6.0, k4))
    }
}

/// What becomes of the rates k of a stage.
#[derive(Clone, Copy)]
struct Stage {
    /// Where they are taken, after the start of the step, s.
    ahead: f64,
    /// Their weight in the sum, s.
    weight: f64,
    /// How far they carry to the next stage, s.
    next: f64,
    decay: Decaying,
}

/// How often E comes before k's weight in the sum, before y and k in the next stage, and after them.
#[derive(Clone, Copy)]
struct Decaying {
    sum: u8,
    y: u8,
    k: u8,
    after: u8,
}

/// All stages but the last.
fn stages(h: f64) -> [Stage; 3] {
    let decay = |sum, y, k, after| Decaying { sum, y, k, after };
    let stage = |ahead, weight, next, decay| Stage {
        ahead,
        weight,
        next,
        decay,
    };
    let half = 0.5 * h;
    [
        stage(0.0, h / 6.0, half, decay(2, 0, 0, 1)),
        stage(half, h / 3.0, half, decay(1, 1, 0, 0)),
        stage(half, h / 3.0, h, decay(1, 2, 1, 0)),
    ]
}

/// From a stage to the next.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn advance<F: Forces>(
    stage: Stage,
    forces: F,
    interval: &Interval,
    start: &StateBlock,
    at: &mut StateBlock,
    sum: &mut StateBlock,
) {
    each_lane!(interval.bodies, |lane| {
        let k = rate(lane, forces, &interval.inertial.get(lane), at.get(lane));
        sum.set(lane, along(sum.get(lane), stage.weight, k));
        at.set(lane, normalised(along(start.get(lane), stage.next, k)));
    });
}

/// The same with decay.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn advance_decaying<F: Forces>(
    stage: Stage,
    e: DecayFactors,
    forces: F,
    interval: &Interval,
    start: &StateBlock,
    at: &mut StateBlock,
    sum: &mut StateBlock,
) {
    let Decaying {
        sum: s,
        y,
        k,
        after,
    } = stage.decay;
    let [s, y, k, after] = [s, y, k, after].map(|times| e.times(times));
    each_lane!(interval.bodies, |lane| {
        let rate = rate(lane, forces, &interval.inertial.get(lane), at.get(lane));
        sum.set(lane, along(sum.get(lane), stage.weight, s.on(rate)));
        let next = along(y.on(start.get(lane)), stage.next, k.on(rate));
        at.set(lane, normalised(after.on(next)));
    });
}

/// The last stage.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn finish<F: Forces>(
    h: f64,
    forces: F,
    interval: &Interval,
    at: &StateBlock,
    sum: &mut StateBlock,
) {
    each_lane!(interval.bodies, |lane| {
        let k4 = rate(lane, forces, &interval.inertial.get(lane), at.get(lane));
        sum.set(lane, normalised(along(sum.get(lane), h / 6.0, k4)));
    });
}

fn decay_twice(e: DecayFactors, state: &mut StateBlock) {
    for lane in 0..LANES {
        state.set(lane, e.times(2).on(state.get(lane)));
    }
}
