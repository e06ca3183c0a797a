//! A pure torque on one body: a motor, or a couple of equal and opposite forces.

use super::{Effect, Frame, Term, WrenchBlock};
use crate::body::{InertialBlock, LaneSet, StateBlock};

/// A torque on one lane of a block while it lasts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Couple {
    pub lane: usize,
    /// N·m.
    pub torque: Frame,
}

impl Effect for Couple {
    fn name(&self) -> &'static str {
        "torque"
    }

    fn add(&self, _t: f64, _: &InertialBlock, state: &StateBlock, wrench: &mut WrenchBlock) {
        let tau_w = self.torque.vector_w(&state.get(self.lane));
        wrench.add_torque(self.lane, tau_w);
    }

    fn lanes(&self) -> LaneSet {
        LaneSet::one(self.lane)
    }

    fn terms(&self, _: &InertialBlock) -> Option<Vec<Term>> {
        Some(vec![Term::Torque {
            lane: self.lane,
            torque: self.torque,
        }])
    }
}
