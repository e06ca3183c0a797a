//! What a method makes of a load that it refuses: nothing, and visibly so.

use super::{Interval, Step, Stepper, Work};
use crate::body::{State, StateBlock};

/// Bodies that are nowhere, however long it is asked.
#[derive(Clone)]
pub struct Refused(StateBlock);

impl Refused {
    pub fn new(interval: &Interval, state: &StateBlock) -> Self {
        let mut block = *state;
        for lane in interval.lanes() {
            block.set(lane, State::NOWHERE);
        }
        Self(block)
    }
}

impl Stepper for Refused {
    fn advance(&mut self, steps: &[Step], kept: &mut Vec<StateBlock>) {
        let asked_for = steps.iter().filter(|step| step.keep);
        kept.extend(asked_for.map(|_| self.0));
    }

    fn state(&self) -> StateBlock {
        self.0
    }

    fn work(&self) -> Work {
        Work::default()
    }

    fn boxed_clone(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}
