//! Uniform gravity: force `m g` at the centre of mass.
//!
//! About the reference point the torque is `(R c) × m g`, c from there to the centre of mass:
//! nothing for a free body, the weight's lever arm for one held at a pivot. A body of infinite
//! mass is not moved.

use super::{
    Argument, Called, Effect, EffectKind, Frame, Member, Spec, Term, Value, WrenchBlock,
    lanes as lanes_of,
};
use crate::body::{InertialBlock, LANES, LaneSet, StateBlock};
use multiversion::multiversion;
use nalgebra::Vector3;
use std::sync::Arc;

pub const KIND: EffectKind = EffectKind {
    name: "gravity",
    argument: Argument::Vector("m/s²"),
    equation: "F = m g at the centre of mass",
    about: "uniform gravity; about a pivot it turns as (R c) × m g",
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

impl Spec for Gravity {
    fn on(&self, members: &[Member<'_>]) -> Arc<dyn Effect> {
        Arc::new(Weight {
            g_w: self.g_w,
            lanes: lanes_of(members),
        })
    }
}

/// The weights of some bodies of a block.
#[derive(Debug)]
struct Weight {
    /// World, m/s².
    g_w: Vector3<f64>,
    lanes: LaneSet,
}

impl Effect for Weight {
    fn name(&self) -> &'static str {
        "gravity"
    }

    fn lanes(&self) -> LaneSet {
        self.lanes
    }

    fn add(&self, _t: f64, inertial: &InertialBlock, state: &StateBlock, wrench: &mut WrenchBlock) {
        weigh(self.lanes, self.g_w, inertial, state, wrench);
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
        Some(self.lanes.iter().map(weight).collect())
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn weigh(
    lanes: LaneSet,
    g_w: Vector3<f64>,
    inertial: &InertialBlock,
    state: &StateBlock,
    wrench: &mut WrenchBlock,
) {
    // All eight are as many rounds as the compiler knows beforehand: vector code.
    if lanes == LaneSet::ALL {
        for lane in 0..LANES {
            weigh_one(lane, g_w, inertial, state, wrench);
        }
    } else {
        for lane in lanes.iter() {
            weigh_one(lane, g_w, inertial, state, wrench);
        }
    }
}

#[inline(always)]
fn weigh_one(
    lane: usize,
    g_w: Vector3<f64>,
    inertial: &InertialBlock,
    state: &StateBlock,
    wrench: &mut WrenchBlock,
) {
    let (body, state) = (inertial.get(lane), state.get(lane));
    let weight_w = g_w * body.mass;
    let tau_w = state.to_world(body.centre_p).cross(&weight_w);
    wrench.add(lane, weight_w, tau_w);
}
