//! The model and everything that acts on one block of bodies, between two events.

use super::{Decay, Depends, Effect, Term};
use crate::body::{InertialBlock, State, StateBlock, Vector3Lanes};
use nalgebra::Vector3;
use std::sync::Arc;

/// A force and a torque about the reference point, world axes, N and N·m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    pub force_w: Vector3<f64>,
    pub tau_w: Vector3<f64>,
}

/// The wrenches on eight bodies.
#[derive(Clone, Copy, Debug, Default)]
pub struct WrenchBlock {
    force_w: Vector3Lanes,
    tau_w: Vector3Lanes,
}

impl WrenchBlock {
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Wrench {
        Wrench {
            force_w: self.force_w.get(lane),
            tau_w: self.tau_w.get(lane),
        }
    }

    #[inline(always)]
    pub fn add(&mut self, lane: usize, force_w: Vector3<f64>, tau_w: Vector3<f64>) {
        self.force_w.add(lane, force_w);
        self.tau_w.add(lane, tau_w);
    }

    #[inline(always)]
    pub fn add_torque(&mut self, lane: usize, tau_w: Vector3<f64>) {
        self.tau_w.add(lane, tau_w);
    }
}

/// What moves one block of bodies: which model, and the effects present. Empty where nothing acts.
#[derive(Clone, Debug, Default)]
pub struct Load {
    gyroscopic: bool,
    effects: Vec<Arc<dyn Effect>>,
    decay: Option<Decay>,
}

impl Load {
    pub fn push(&mut self, effect: Arc<dyn Effect>) {
        self.effects.push(effect);
    }

    pub fn set_decay(&mut self, decay: Decay) {
        self.decay = Some(decay);
    }

    pub fn set_gyroscopic(&mut self) {
        self.gyroscopic = true;
    }

    /// Whether bodies keep their angular momentum (Euler's equations) and not, as in the
    /// tutorial's model, their angular velocity.
    pub fn gyroscopic(&self) -> bool {
        self.gyroscopic
    }

    /// The names of everything that is active, the model's terms included.
    pub fn names(&self) -> Vec<&'static str> {
        let model = self.gyroscopic.then_some("gyroscopic");
        let decay = self.decay.map(|_| "damping");
        let effects = self.effects.iter().map(|effect| effect.name());
        model.into_iter().chain(decay).chain(effects).collect()
    }

    /// Whether any force or torque is applied.
    pub fn applies(&self) -> bool {
        !self.effects.is_empty()
    }

    /// Exponential decay of the velocities, where the scene has it.
    pub fn decay(&self) -> Option<&Decay> {
        self.decay.as_ref()
    }

    /// The sum of what is applied, in the order the effects were added: without the gyroscopic
    /// term, without decay. `None` where nothing is.
    pub fn wrench(
        &self,
        t: f64,
        inertial: &InertialBlock,
        state: &StateBlock,
    ) -> Option<WrenchBlock> {
        if self.effects.is_empty() {
            return None;
        }
        let mut wrench = WrenchBlock::default();
        for effect in &self.effects {
            effect.add(t, inertial, state, &mut wrench);
        }
        Some(wrench)
    }

    /// What the applied forces and torques depend on.
    pub fn depends(&self, inertial: &InertialBlock) -> Depends {
        let each = self.effects.iter().map(|effect| effect.depends(inertial));
        each.collect()
    }

    /// All effects as constant forces and torques, where they are nothing else.
    pub fn terms(&self, inertial: &InertialBlock) -> Option<Vec<Term>> {
        let each = self.effects.iter().map(|effect| effect.terms(inertial));
        let terms: Option<Vec<Vec<Term>>> = each.collect();
        Some(terms?.concat())
    }
}

/// The axes in which a vector or a point is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Frame {
    /// Fixed in space.
    World(Vector3<f64>),
    /// Turning with the body: principal axes; a point counts from the reference point.
    Principal(Vector3<f64>),
}

impl Frame {
    /// The direction in world axes.
    #[inline]
    pub fn vector_w(&self, state: &State) -> Vector3<f64> {
        match *self {
            Frame::World(v) => v,
            Frame::Principal(v) => state.to_world(v),
        }
    }

    /// The point in the world.
    #[inline]
    pub fn point_w(&self, state: &State) -> Vector3<f64> {
        match *self {
            Frame::World(p) => p,
            Frame::Principal(p) => state.x_w + state.to_world(p),
        }
    }
}
