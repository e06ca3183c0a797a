//! A method whose velocities are cut to a limit after each step ([`crate::effect::SpeedLimit`]).
//!
//! A method may carry more than the state (a momentum, forces it has asked for, a closed form since it
//! set out): where a velocity was cut it sets out anew from what is left.

use super::{Interval, Method, Step, Stepper, Work};
use crate::body::StateBlock;

#[derive(Clone)]
pub struct Limited {
    method: &'static dyn Method,
    interval: Interval,
    inner: Box<dyn Stepper>,
    /// What the steppers before this one did.
    done: Work,
}

impl Limited {
    pub fn new(
        method: &'static dyn Method,
        interval: Interval,
        t: f64,
        state: &StateBlock,
    ) -> Self {
        Self {
            method,
            inner: method.set_out(interval.clone(), t, state),
            interval,
            done: Work::default(),
        }
    }

    /// The state within the limit, where it is not.
    fn clamped(&self, state: &StateBlock) -> Option<StateBlock> {
        let limit = self.interval.load.limit()?;
        let mut clamped = None;
        for lane in self.interval.lanes() {
            if let Some(slower) = limit.clamped(&state.get(lane)) {
                clamped.get_or_insert(*state).set(lane, slower);
            }
        }
        clamped
    }
}

impl Stepper for Limited {
    fn advance(&mut self, steps: &[Step], kept: &mut Vec<StateBlock>) {
        for step in steps {
            let unseen = Step {
                keep: false,
                ..*step
            };
            self.inner.advance(&[unseen], kept);
            let mut state = self.inner.state();
            if let Some(clamped) = self.clamped(&state) {
                state = clamped;
                self.done = self.work();
                self.inner = self.method.set_out(self.interval.clone(), step.to, &state);
            }
            if step.keep {
                kept.push(state);
            }
        }
    }

    fn state(&self) -> StateBlock {
        self.inner.state()
    }

    fn work(&self) -> Work {
        self.done + self.inner.work()
    }

    fn boxed_clone(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }

    fn bytes(&self) -> usize {
        size_of_val(self) + self.inner.bytes()
    }
}
