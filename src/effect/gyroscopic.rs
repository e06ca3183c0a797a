//! The gyroscopic term: `-ω × (I ω)`.
//!
//! `d(I ω)/dt = τ` with a world tensor that turns with the body gives
//! `I dω/dt = τ - ω × (I ω)`. The tutorial's model leaves the term out: its bodies keep their
//! angular *velocity* where real ones keep their angular *momentum*. A scene chooses.

use super::{Argument, Called, Effect, EffectKind, Value, WrenchBlock};
use crate::body::{InertialBlock, LANES, StateBlock};
use std::sync::Arc;

pub const KIND: EffectKind = EffectKind {
    name: "gyroscopic",
    argument: Argument::Switch,
    equation: "τ = -ω × (I ω)",
    about: "true: bodies keep their angular momentum, as real ones do; false or absent: the tutorial's model",
    make: |value, _| match value {
        Value::Switch(true) => Ok(Called::Load(Arc::new(Gyroscopic))),
        _ => Ok(Called::Off),
    },
};

#[derive(Debug)]
struct Gyroscopic;

impl Effect for Gyroscopic {
    fn add(&self, _t: f64, inertial: &InertialBlock, state: &StateBlock, wrench: &mut WrenchBlock) {
        for lane in 0..LANES {
            let state = state.get(lane);
            let momentum_w = inertial.get(lane).momentum_w(&state);
            wrench.add_torque(lane, -state.omega_w.cross(&momentum_w));
        }
    }

    fn is_inertial(&self) -> bool {
        true
    }
}
