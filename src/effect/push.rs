//! A force at a point of one body: `F`, and the torque `(p - x) × F` about its reference point x.

use super::{Effect, Frame, Term, WrenchBlock};
use crate::body::{InertialBlock, LaneSet, StateBlock};

/// A force on one lane of a block while it lasts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    pub lane: usize,
    /// N.
    pub force: Frame,
    /// m.
    pub point: Frame,
}

impl Effect for Push {
    fn name(&self) -> &'static str {
        "push"
    }

    fn add(&self, _t: f64, _: &InertialBlock, state: &StateBlock, wrench: &mut WrenchBlock) {
        let state = state.get(self.lane);
        let force_w = self.force.vector_w(&state);
        let arm_w = self.point.point_w(&state) - state.x_w;
        wrench.add(self.lane, force_w, arm_w.cross(&force_w));
    }

    fn lanes(&self) -> LaneSet {
        LaneSet::one(self.lane)
    }

    fn terms(&self, _: &InertialBlock) -> Option<Vec<Term>> {
        Some(vec![Term::Force {
            lane: self.lane,
            force: self.force,
            point: self.point,
        }])
    }
}
