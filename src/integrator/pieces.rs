//! A method that takes every step of the clock in several equal pieces.

use super::{Step, Stepper, Work};
use crate::body::StateBlock;

#[derive(Clone)]
pub struct Pieces {
    inner: Box<dyn Stepper>,
    pieces: u32,
}

impl Pieces {
    pub fn new(inner: Box<dyn Stepper>, pieces: u32) -> Self {
        Self {
            inner,
            pieces: pieces.max(1),
        }
    }

    /// The ends lie where `from + h k/n` puts them, so they do not drift within a step.
    fn cut(&self, step: &Step) -> impl Iterator<Item = Step> {
        let (step, n) = (*step, self.pieces);
        let h = step.h / f64::from(n);
        (0..n).map(move |k| {
            let last = k + 1 == n;
            Step {
                from: step.from + h * f64::from(k),
                h,
                to: match last {
                    true => step.to,
                    false => step.from + h * f64::from(k + 1),
                },
                keep: last && step.keep,
            }
        })
    }
}

impl Stepper for Pieces {
    fn advance(&mut self, steps: &[Step], kept: &mut Vec<StateBlock>) {
        let all: Vec<Step> = steps.iter().flat_map(|step| self.cut(step)).collect();
        self.inner.advance(&all, kept);
    }

    fn state(&self) -> StateBlock {
        self.inner.state()
    }

    fn work(&self) -> Work {
        self.inner.work()
    }

    fn boxed_clone(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}
