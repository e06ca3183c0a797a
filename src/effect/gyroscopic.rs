//! The gyroscopic term: `-ω × (I ω)`.
//!
//! `d(I ω)/dt = τ` with a world tensor that turns with the body gives
//! `I dω/dt = τ - ω × (I ω)`. The tutorial's model leaves the term out: its bodies keep their
//! angular *velocity* where real ones keep their angular *momentum*. A scene chooses.
//!
//! Nothing outside applies it, so it is no force that a method asks for but the model itself:
//! [`super::Load::gyroscopic`]. Each method takes it in its own way, many of them exactly.

use super::{Argument, Called, EffectKind, Value};

pub const KIND: EffectKind = EffectKind {
    name: "gyroscopic",
    argument: Argument::Switch,
    equation: "τ = -ω × (I ω)",
    about: "true: bodies keep their angular momentum, as real ones do; false or absent: the tutorial's model",
    make: |value, _| match value {
        Value::Switch(true) => Ok(Called::Gyroscopic),
        _ => Ok(Called::Off),
    },
};
