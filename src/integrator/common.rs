//! What several kernels share: states as vectors, damping after a step.

use crate::body::{LANES, State, StateBlock};
use crate::effect::{Decay, Load};

/// A rate of change has the components of a state: x', v', q', ω'.
pub type Rate = State;
pub type RateBlock = StateBlock;

/// `y + h k`.
#[inline(always)]
pub fn along(y: State, h: f64, k: Rate) -> State {
    State {
        x_w: y.x_w + k.x_w * h,
        v_w: y.v_w + k.v_w * h,
        q_wp: y.q_wp + k.q_wp * h,
        omega_w: y.omega_w + k.omega_w * h,
    }
}

/// The velocities times a factor each; position and attitude do not decay.
#[inline(always)]
pub fn decayed(y: State, linear: f64, angular: f64) -> State {
    State {
        v_w: y.v_w * linear,
        omega_w: y.omega_w * angular,
        ..y
    }
}

/// Factors over half a step on v and ω, for methods with an integrating factor.
#[derive(Clone, Copy)]
pub struct HalfDecay {
    pub linear: f64,
    pub angular: f64,
}

impl HalfDecay {
    /// `None` where nothing decays.
    pub fn of(load: &Load, half: f64) -> Option<Self> {
        load.decay().map(|decay| Self {
            linear: decay.linear_factor(half),
            angular: decay.angular_factor(half),
        })
    }
}

/// The same state with an attitude of unit length.
#[inline(always)]
pub fn normalised(y: State) -> State {
    State {
        q_wp: y.q_wp * (1.0 / y.q_wp.norm()),
        ..y
    }
}

/// Damps the velocities for `h` seconds.
pub fn damp(decay: &Decay, h: f64, state: &mut StateBlock) {
    let (linear, angular) = (decay.linear_factor(h), decay.angular_factor(h));
    for lane in 0..LANES {
        state.set(lane, decayed(state.get(lane), linear, angular));
    }
}
