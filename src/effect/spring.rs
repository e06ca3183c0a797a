//! A spring and damper from a point of a body to an anchor fixed in the world:
//!
//! ```text
//! d = p - a    ℓ = |d|    u = d/ℓ    F = -(k (ℓ - ℓ0) + c ṗ·u) u   at p
//! ```
//!
//! p is the body's point, ṗ its velocity, a the anchor. Of rest length ℓ0 = 0 it has no line for its damper to
//! lie along: `F = -k d - c ṗ`, linear throughout. Where ℓ is 0 and ℓ0 is not, the direction is undefined and
//! so is the force, which is taken as nothing there: the spring is at an unstable rest. It pushes as well as
//! pulls. A spring and damper against turning is a `motor` that holds an orientation.

use super::{
    Argument, BodyPoint, Called, Depends, Described, Effect, EffectKind, Member, Spec, Value,
    WrenchBlock,
};
use crate::body::{InertialBlock, LaneSet, StateBlock};
use nalgebra::Vector3;
use std::sync::Arc;

pub const KIND: EffectKind = EffectKind {
    name: "spring",
    argument: Argument::Table(&[
        ("anchor", Argument::Vector("m")),
        ("point", Argument::Point),
        ("stiffness", Argument::Number("N/m")),
        ("rest_length", Argument::Number("m")),
        ("damping", Argument::Number("N·s/m")),
    ]),
    equation: "F = -(k (ℓ - ℓ0) + c dℓ/dt) u at the point, along the line u from the anchor",
    about: "a spring and damper from a point of the body (by default its centre) to an anchor in the world; of rest length 0 it is linear: F = -k d - c v",
    make: |value, _| {
        let Some(anchor_w) = value.vector("anchor") else {
            return Err("lacks anchor, the point in the world it hangs on, m".to_owned());
        };
        let spring = Spring {
            anchor_w,
            point: match value.get("point") {
                Some(Value::Point(point)) => point.clone(),
                _ => BodyPoint::Named("centre".to_owned()),
            },
            law: Law {
                stiffness: value.not_negative("stiffness")?,
                rest_length: value.not_negative("rest_length")?,
                damping: value.not_negative("damping")?,
            },
        };
        if spring.law.stiffness == 0.0 && spring.law.damping == 0.0 {
            return match value.number("stiffness").or(value.number("damping")) {
                Some(_) => Ok(Called::Off),
                None => Err("has neither stiffness (N/m) nor damping (N·s/m)".to_owned()),
            };
        }
        Ok(Called::Load(Arc::new(spring)))
    },
};

#[derive(Clone, Debug)]
struct Spring {
    /// World, m.
    anchor_w: Vector3<f64>,
    point: BodyPoint,
    law: Law,
}

#[derive(Clone, Copy, Debug)]
struct Law {
    /// k, N/m.
    stiffness: f64,
    /// ℓ0, m.
    rest_length: f64,
    /// c, N·s/m.
    damping: f64,
}

impl Law {
    /// The force on the point, N, by where it is from the anchor (m) and its velocity (m/s).
    fn force(&self, d: Vector3<f64>, v: Vector3<f64>) -> Vector3<f64> {
        if self.rest_length == 0.0 {
            return d * -self.stiffness - v * self.damping;
        }
        let length = d.norm();
        if length == 0.0 {
            return Vector3::zeros();
        }
        let u = d / length;
        u * -(self.stiffness * (length - self.rest_length) + self.damping * v.dot(&u))
    }
}

impl Spec for Spring {
    fn on(&self, members: &[Member<'_>]) -> Arc<dyn Effect> {
        let end = |member: &Member<'_>| {
            // Checked when the scene was read ([`Spec::check`]).
            let point_b = member.body.place(&self.point).ok()?;
            Some(End {
                lane: member.lane,
                point_p: member.q_pb * point_b + member.inertial.centre_p,
            })
        };
        Arc::new(Springs {
            anchor_w: self.anchor_w,
            law: self.law,
            ends: members.iter().filter_map(end).collect(),
        })
    }

    fn check(&self, body: &dyn Described) -> Result<(), String> {
        body.place(&self.point).map(|_| ())
    }

    fn moved(&self, by_w: Vector3<f64>) -> Option<Arc<dyn Spec>> {
        Some(Arc::new(Self {
            anchor_w: self.anchor_w + by_w,
            ..self.clone()
        }))
    }
}

/// A spring's end on a body.
#[derive(Clone, Copy, Debug)]
struct End {
    lane: usize,
    /// From the reference point, principal axes, m.
    point_p: Vector3<f64>,
}

/// Springs of one kind on bodies of a block.
#[derive(Debug)]
struct Springs {
    anchor_w: Vector3<f64>,
    law: Law,
    ends: Vec<End>,
}

impl Effect for Springs {
    fn name(&self) -> &'static str {
        "spring"
    }

    fn lanes(&self) -> LaneSet {
        self.ends.iter().map(|end| end.lane).collect()
    }

    fn add(&self, _t: f64, _: &InertialBlock, state: &StateBlock, wrench: &mut WrenchBlock) {
        for end in &self.ends {
            let s = state.get(end.lane);
            let arm_w = s.to_world(end.point_p);
            let d = s.x_w + arm_w - self.anchor_w;
            let v_w = s.v_w + s.omega_w.cross(&arm_w);
            let force_w = self.law.force(d, v_w);
            wrench.add(end.lane, force_w, arm_w.cross(&force_w));
        }
    }

    fn depends(&self, _: &InertialBlock) -> Depends {
        Depends {
            torque: self.ends.iter().any(|end| end.point_p != Vector3::zeros()),
            place: true,
            velocity: self.law.damping > 0.0,
            time: false,
        }
    }
}
