//! Methods that are a function from state to state.

use super::{Interval, Method, MethodInfo, Step, Stepper, Work};
use crate::body::StateBlock;

/// A one-step method without a memory.
pub trait OneStep: Copy + Send + Sync + 'static {
    fn info(&self) -> &'static MethodInfo;

    /// Advances a block from `t` to `t + h` (s).
    fn step(&self, t: f64, h: f64, interval: &Interval, state: &mut StateBlock);

    /// Several steps, one after the other; appends the state after each that is kept.
    fn steps(
        &self,
        steps: &[Step],
        interval: &Interval,
        state: &mut StateBlock,
        kept: &mut Vec<StateBlock>,
    ) {
        for step in steps {
            self.step(step.from, step.h, interval, state);
            if step.keep {
                kept.push(*state);
            }
        }
    }
}

/// Makes a [`Method`] of a [`OneStep`].
pub struct Stepped<M>(pub M);

impl<M: OneStep> Method for Stepped<M> {
    fn info(&self) -> &'static MethodInfo {
        self.0.info()
    }

    fn set_out(&self, mut interval: Interval, t: f64, state: &StateBlock) -> Box<dyn Stepper> {
        interval.load.settle(t, &interval.inertial, state);
        Box::new(Run {
            method: self.0,
            interval,
            state: *state,
            steps: 0,
        })
    }
}

#[derive(Clone)]
struct Run<M> {
    method: M,
    interval: Interval,
    state: StateBlock,
    steps: u64,
}

impl<M: OneStep> Stepper for Run<M> {
    fn advance(&mut self, steps: &[Step], kept: &mut Vec<StateBlock>) {
        self.method
            .steps(steps, &self.interval, &mut self.state, kept);
        self.steps += steps.len() as u64;
    }

    fn state(&self) -> StateBlock {
        self.state
    }

    fn work(&self) -> Work {
        Work {
            steps: self.steps,
            evaluations: self.method.info().cost.evaluations_in(self.steps),
        }
    }

    fn boxed_clone(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}
