//! Methods with steps of their own: each body goes through the interval by itself, and what the clock
//! asks for is read from the polynomial that a method has over its last step.
//!
//! A body's steps depend on nothing but its start, the load and the tolerance: not on its neighbours in
//! the block, not on the instants that are kept, not on how many steps of the clock are asked for at once.

#[cfg(test)]
mod tests;

use super::{Interval, Step, Stepper, Work};
use crate::body::{State, StateBlock};

/// One body on its way.
pub trait Walk: Clone + Send + 'static {
    /// The end of the last step, s.
    fn reached(&self) -> f64;

    /// Takes one step of its own choice, not beyond `interval.until`. `None` where the next step would
    /// be too short to be one: the motion cannot be followed.
    fn step(&mut self, interval: &Interval) -> Option<()>;

    /// The state at a time in the last step; at its end, the step's own.
    fn at(&mut self, interval: &Interval, t: f64) -> State;

    fn work(&self) -> Work;
}

/// Steps of a body within one of the clock's, beyond which it is given up: a second or so.
const MOST_STEPS: u32 = 1_000_000;

/// The bodies of a block, each by steps of its own.
#[derive(Clone)]
pub struct Run<W> {
    interval: Interval,
    bodies: Vec<Walker<W>>,
    state: StateBlock,
}

#[derive(Clone)]
struct Walker<W> {
    body: W,
    lost: bool,
}

impl<W: Walk> Run<W> {
    pub fn new(interval: Interval, state: &StateBlock, walk: impl Fn(usize) -> W) -> Self {
        let walker = |lane| Walker {
            body: walk(lane),
            lost: false,
        };
        Self {
            bodies: interval.lanes().map(walker).collect(),
            interval,
            state: *state,
        }
    }
}

impl<W: Walk> Stepper for Run<W> {
    fn advance(&mut self, steps: &[Step], kept: &mut Vec<StateBlock>) {
        let first = kept.len();
        let more = steps.iter().filter(|step| step.keep).count();
        kept.resize(first + more, self.state);
        let Some(last) = steps.last() else {
            return;
        };
        for (lane, walker) in self.bodies.iter_mut().enumerate() {
            let mut row = first;
            for step in steps {
                walker.walk(&self.interval, step.to);
                if step.keep {
                    kept[row].set(lane, walker.at(&self.interval, step.to));
                    row += 1;
                }
            }
            self.state.set(lane, walker.at(&self.interval, last.to));
        }
    }

    fn state(&self) -> StateBlock {
        self.state
    }

    /// Bodies are evaluated one by one here, and counted so.
    fn work(&self) -> Work {
        let works = self.bodies.iter().map(|walker| walker.body.work());
        works.fold(Work::default(), |a, b| a + b)
    }

    fn boxed_clone(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }

    fn bytes(&self) -> usize {
        size_of_val(self) + size_of_val(self.bodies.as_slice())
    }
}

impl<W: Walk> Walker<W> {
    /// Steps on until `t` lies within the last step.
    fn walk(&mut self, interval: &Interval, t: f64) {
        let goal = t.min(interval.until);
        let mut steps = 0;
        while !self.lost && self.body.reached() < goal {
            steps += 1;
            self.lost = steps > MOST_STEPS || self.body.step(interval).is_none();
        }
    }

    /// The state at `t`; nowhere where the body was lost.
    fn at(&mut self, interval: &Interval, t: f64) -> State {
        if self.lost {
            return State::NOWHERE;
        }
        // A clock's last instant may lie a rounding beyond the end.
        let within = t.min(self.body.reached());
        self.body.at(interval, within)
    }
}
