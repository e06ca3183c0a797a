//! A method that takes every step of the clock in several equal pieces.

use super::{Step, Stepper, Work};
use crate::body::StateBlock;

/// Pieces handed on at a time.
const MOST_AT_ONCE: usize = 8192;

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
        // A few thousand pieces at once, so that a long stretch does not take memory.
        let at_once = (MOST_AT_ONCE / self.pieces as usize).max(1);
        for some in steps.chunks(at_once) {
            let pieces: Vec<Step> = some.iter().flat_map(|step| self.cut(step)).collect();
            self.inner.advance(&pieces, kept);
        }
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

    fn bytes(&self) -> usize {
        size_of_val(self) + self.inner.bytes()
    }
}
