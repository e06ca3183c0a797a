//! The gyroscopic step of Rapier and Jolt: explicit, and |L| restored after it. In principal axes
//!
//! ```text
//! L = I ω        L' = L - h ω × L        L'' = L' |L| / |L'|        ω ← I⁻¹ L''
//! ```
//!
//! `ω × L` is at right angles to L, so an explicit step only lengthens it; with the length restored it
//! cannot blow up. L's direction is another matter: it wanders in the world, and a body near its middle
//! axis flips too rarely by far at the steps of games (4.97 s for 2.75 at 60 Hz, L up to 9
//! degrees off: `tests/engines.rs`). Order 1.
//!
//! The two engines put it into different steps. `rapier`, four substeps of `s = h/4`:
//!
//! ```text
//! once:    a = m⁻¹ F    α = I_w⁻¹ τ                        as of the step's start
//! 4 times: v += s a    ω += s α    ω ← gyroscopic(s)    x += s v    q ← q + s/2 (ω, 0) q, normalised
//! once:    v *= 1/(1 + k h)    ω *= 1/(1 + c h)
//! ```
//!
//! A force held over four substeps pumps an oscillation at Ω, by 1 + 3/8 (hΩ)² in energy a step.
//!
//! `jolt`, one step; its gyroscopic term is off in the engine unless a body asks for it:
//!
//! ```text
//! ω ← gyroscopic(h)    v += h m⁻¹ F    ω += h I_w⁻¹ τ
//! v *= max(0, 1 - k h)    ω *= max(0, 1 - c h)    x += h v    q ← exp(h ω) q
//! ```
//!
//! Left out, for they are no part of a scheme that converges: Rapier's bound |ω| ≤ π/4h, Jolt's |ω| ≤ 15π
//! rad/s (by default) and its threshold, |ω| h ≤ 1e-6 rad, below which a step turns nothing. Jolt computes in f32; here
//! it is f64.
//!
//! Rapier 0.36.1: `gyroscopic_corrected_angvel` (rigid_body.rs), worker.rs of its island solver. Jolt
//! 5.5: `ApplyGyroscopicForceInternal`, `ApplyForceTorqueAndDragInternal` (MotionProperties.inl),
//! `AddRotationStep` (Body.inl).

use super::common::{decayed, normalised};
use super::one_step::OneStep;
use super::scalar::{applied, each, turned};
use super::{Accepts, Cost, Damping, Interval, Kind, MethodInfo, Models};
use crate::body::{Inertial, State, StateBlock};
use crate::effect::Decay;
use crate::math::spin_rate;
use nalgebra::Vector3;

#[derive(Clone, Copy)]
pub struct Rapier;

#[derive(Clone, Copy)]
pub struct Jolt;

/// Rapier's `num_solver_iterations`, as it is by default.
const SUBSTEPS: u32 = 4;

const RAPIER: MethodInfo = MethodInfo {
    name: "rapier",
    engines: &["rapier"],
    kind: Kind::Fixed,
    order: 1,
    weak_orders: None,
    models: Models::Both,
    accepts: Accepts::Any,
    damping: Damping::Engine("1/(1 + c h) at the step's end: never turns round, order 1"),
    reversible: false,
    keeps_momentum: false,
    exact_free: false,
    preserves: "|L| of a free body in its own gyroscopic step, not L's direction",
    cost: Cost {
        evaluations: Some(1),
        weight: 1.25,
    },
    citation: "Rapier 0.36.1, gyroscopic_corrected_angvel in rigid_body.rs; 4 substeps as by default",
};

const JOLT: MethodInfo = MethodInfo {
    name: "jolt",
    engines: &["jolt"],
    cost: Cost {
        evaluations: Some(1),
        weight: 0.62,
    },
    damping: Damping::Engine("max(0, 1 - c h) before the pose: order 1"),
    citation: "Jolt 5.5, ApplyGyroscopicForceInternal in MotionProperties.inl (off there by default)",
    ..RAPIER
};

impl OneStep for Rapier {
    fn info(&self) -> &'static MethodInfo {
        &RAPIER
    }

    fn step(&self, t: f64, h: f64, interval: &Interval, state: &mut StateBlock) {
        let (load, inertial) = (&interval.load, &interval.inertial);
        let wrench = load.wrench(t, inertial, state);
        let sub = h / f64::from(SUBSTEPS);
        *state = each(interval, |lane| {
            let (body, mut s) = (inertial.get(lane), state.get(lane));
            let push = applied(wrench.as_ref(), lane, &body, &s);
            for _ in 0..SUBSTEPS {
                s.v_w += push.a_w * sub;
                s.omega_w += push.alpha_w * sub;
                if load.gyroscopic() {
                    s.omega_w = restored(sub, &body, &s);
                }
                s.x_w += s.v_w * sub;
                s.q_wp += spin_rate(s.omega_w, s.q_wp) * sub;
                s = normalised(s);
            }
            damped(load.decay(), s, |rate| 1.0 / (1.0 + rate * h))
        });
    }
}

impl OneStep for Jolt {
    fn info(&self) -> &'static MethodInfo {
        &JOLT
    }

    fn step(&self, t: f64, h: f64, interval: &Interval, state: &mut StateBlock) {
        let (load, inertial) = (&interval.load, &interval.inertial);
        let wrench = load.wrench(t, inertial, state);
        *state = each(interval, |lane| {
            let (body, mut s) = (inertial.get(lane), state.get(lane));
            let push = applied(wrench.as_ref(), lane, &body, &s);
            if load.gyroscopic() {
                s.omega_w = restored(h, &body, &s);
            }
            s.v_w += push.a_w * h;
            s.omega_w += push.alpha_w * h;
            s = damped(load.decay(), s, |rate| (1.0 - rate * h).max(0.0));
            s.x_w += s.v_w * h;
            normalised(turned(s.omega_w * h, s))
        });
    }
}

/// ω after the gyroscopic step: `I⁻¹ L''`, world.
fn restored(h: f64, body: &Inertial, s: &State) -> Vector3<f64> {
    let omega_p = s.to_principal(s.omega_w);
    let momentum = body.moments.component_mul(&omega_p);
    let moved = momentum - omega_p.cross(&momentum) * h;
    let (before, after) = (momentum.norm_squared(), moved.norm_squared());
    if after == 0.0 {
        return s.omega_w;
    }
    let momentum = moved * (before / after).sqrt();
    s.to_world(body.inv_moments.component_mul(&momentum))
}

/// The velocities times what the engine makes of their rates.
fn damped(decay: Option<&Decay>, s: State, factor: impl Fn(f64) -> f64) -> State {
    match decay {
        None => s,
        Some(decay) => decayed(s, factor(decay.linear_rate()), factor(decay.angular_rate())),
    }
}
