//! A clamp, as engines have it: after each step of the clock a velocity longer than the limit is cut to it,
//!
//! ```text
//! ω ← ω min(1, ω_max/|ω|)    v ← v min(1, v_max/|v|)
//! ```
//!
//! No force and no law of motion: what was too fast loses momentum and energy at once, so a motion that
//! meets the limit is another motion, and depends on the step. It is here to show that. Engines clamp by
//! default: PhysX at 100 rad/s (`PxRigidDynamic::setMaxAngularVelocity`; 7 before version 4), Jolt at 47.1 rad/s (¼ π 60:
//! an eighth of a turn in a step of 1/60 s) and 500 m/s (`BodyCreationSettings`), Bullet at ½ π a step
//! (`MAX_ANGVEL`; its ¼ π, `ANGULAR_MOTION_THRESHOLD`, bounds the turn and not the velocity). It means something only with steps that are given: methods that choose their
//! own, closed forms and `accuracy` refuse it. A method that carries something beside the state sets out
//! anew from what is left. (Engines clamp between the step's change of velocity and its change of place; here the
//! step that meets the limit is still turned by what it had, the same by every method.)

use super::{Argument, Called, EffectKind};
use crate::body::State;
use nalgebra::Vector3;

pub const KIND: EffectKind = EffectKind {
    name: "speed_limit",
    argument: Argument::Table(&[
        ("angular", Argument::Number("rad/s")),
        ("linear", Argument::Number("m/s")),
    ]),
    equation: "ω ← ω min(1, ω_max/|ω|), v likewise, after each step",
    about: "cuts velocities to a length after each step, as engines do (PhysX: 100 rad/s; Jolt: 47.1 rad/s, 500 m/s); for methods of fixed steps",
    make: |value, _| {
        let of = |key: &str| match value.number(key) {
            Some(x) if x <= 0.0 => Err(format!(
                "{key} = {x} would let nothing move; a limit is above 0"
            )),
            x => Ok(x),
        };
        let limit = SpeedLimit {
            angular: of("angular")?,
            linear: of("linear")?,
        };
        Ok(match limit {
            SpeedLimit {
                angular: None,
                linear: None,
            } => Called::Off,
            limit => Called::Limit(limit),
        })
    },
};

/// The greatest speeds there may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeedLimit {
    /// rad/s.
    angular: Option<f64>,
    /// m/s, of the reference point.
    linear: Option<f64>,
}

impl SpeedLimit {
    /// Both limits, the lower of each.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let lower = |a: Option<f64>, b: Option<f64>| match (a, b) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
        Self {
            angular: lower(self.angular, other.angular),
            linear: lower(self.linear, other.linear),
        }
    }

    /// The state with velocities that are within the limits; `None` where they are already.
    pub fn clamped(&self, s: &State) -> Option<State> {
        let cut = |v: Vector3<f64>, limit: Option<f64>| {
            let (limit, length) = (limit?, v.norm());
            (length > limit).then(|| v * (limit / length))
        };
        let (omega_w, v_w) = (cut(s.omega_w, self.angular), cut(s.v_w, self.linear));
        if omega_w.is_none() && v_w.is_none() {
            return None;
        }
        Some(State {
            omega_w: omega_w.unwrap_or(s.omega_w),
            v_w: v_w.unwrap_or(s.v_w),
            ..*s
        })
    }
}
