//! Uniform gravity: force `m g` at the centre of mass.
//!
//! About the reference point the torque is `(R c) × m g`, c from there to the centre of mass:
//! nothing for a free body, the weight's lever arm for one held at a pivot. A body of infinite
//! mass is not moved.

use super::{Argument, Called, Effect, EffectKind, Frame, Term, Value, WrenchBlock};
use crate::body::{InertialBlock, LANES, StateBlock};
use multiversion::multiversion;
use nalgebra::Vector3;
use std::sync::Arc;

pub const KIND: EffectKind = EffectKind {
    name: "gravity",
    argument: Argument::Vector("m/s²"),
    equation: "F = m g at the centre of mass",
    about: "uniform gravity on every body; about a pivot it turns as (R c) × m g",
    make: |value, _| match value {
        Value::Vector(g) if g.amax() > 0.0 => Ok(Called::Load(Arc::new(Gravity { g_w: *g }))),
        _ => Ok(Called::Off),
    },
};

#[derive(Debug)]
struct Gravity {
    /// World, m/s².
    g_w: Vector3<f64>,
}

impl Effect for Gravity {
    fn name(&self) -> &'static str {
        "gravity"
    }

    fn add(&self, _t: f64, inertial: &InertialBlock, state: &StateBlock, wrench: &mut WrenchBlock) {
        weigh(self.g_w, inertial, state, wrench);
    }

    fn terms(&self, inertial: &InertialBlock) -> Option<Vec<Term>> {
        let weight = |lane: usize| {
            let body = inertial.get(lane);
            Term::Force {
                lane,
                force: Frame::World(self.g_w * body.mass),
                point: Frame::Principal(body.centre_p),
            }
        };
        Some((0..LANES).map(weight).collect())
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn weigh(
    g_w: Vector3<f64>,
    inertial: &InertialBlock,
    state: &StateBlock,
    wrench: &mut WrenchBlock,
) {
    for lane in 0..LANES {
        let (body, state) = (inertial.get(lane), state.get(lane));
        let weight_w = g_w * body.mass;
        let tau_w = state.to_world(body.centre_p).cross(&weight_w);
        wrench.add(lane, weight_w, tau_w);
    }
}
