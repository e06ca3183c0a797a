//! Breakpoints: where a condition begins to hold the session stops, at the very step.

use crate::trace::{Instant, Sample, Subject};

/// What is looked for, in a body at an instant.
pub trait Condition: Send {
    /// As it was written, its bound included.
    fn text(&self) -> String;

    /// What makes it true; `None` where it is not.
    fn met_in(&self, subject: &Subject, sample: &Sample) -> Option<Met>;
}

/// What made a condition true.
#[derive(Clone, Debug, PartialEq)]
pub struct Met {
    pub quantity: String,
    pub value: f64,
}

/// Reads a condition, knowing the bodies; the error has its column in the text, in characters from 1.
pub type ReadCondition = fn(&str, &[Subject]) -> Result<Box<dyn Condition>, (usize, String)>;

/// A breakpoint.
pub struct Break {
    /// Counts up; none has another's.
    pub id: u64,
    pub condition: Box<dyn Condition>,
    /// Whether it held when it was looked at last.
    pub(super) held: bool,
}

/// Why a session stopped.
#[derive(Clone, Debug, PartialEq)]
pub struct Broke {
    /// The breakpoint's.
    pub id: u64,
    pub condition: String,
    pub at: Instant,
    /// Name of the body.
    pub body: String,
    pub met: Met,
}

#[derive(Default)]
pub(super) struct Breaks {
    all: Vec<Break>,
    last: u64,
}

/// Breakpoints at most: each is looked at at every step.
const MOST: usize = 64;

impl Breaks {
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    pub fn all(&self) -> &[Break] {
        &self.all
    }

    pub fn add(&mut self, condition: Box<dyn Condition>) -> Result<u64, String> {
        if self.all.len() == MOST {
            return Err(format!("there are {MOST} breakpoints already; clear some"));
        }
        self.last += 1;
        self.all.push(Break {
            id: self.last,
            condition,
            held: false,
        });
        Ok(self.last)
    }

    pub fn clear(&mut self, id: u64) -> bool {
        let before = self.all.len();
        self.all.retain(|one| one.id != id);
        self.all.len() < before
    }

    /// Looks at the bodies as they are; the first that holds and did not before.
    pub fn look(&mut self, at: Instant, subjects: &[Subject], samples: &[Sample]) -> Option<Broke> {
        let mut first = None;
        for one in &mut self.all {
            let mut bodies = subjects.iter().zip(samples);
            let met = bodies.find_map(|(subject, sample)| {
                Some((subject, one.condition.met_in(subject, sample)?))
            });
            let began = met.is_some() && !one.held;
            one.held = met.is_some();
            if let (true, None, Some((subject, met))) = (began, &first, met) {
                first = Some(Broke {
                    id: one.id,
                    condition: one.condition.text(),
                    at,
                    body: subject.name.clone(),
                    met,
                });
            }
        }
        first
    }
}
