//! Breakpoints: where a condition begins to hold the session stops, at the very step.

use crate::trace::{Condition, Instant, Met, Sample, Subject};

/// A breakpoint.
pub struct Break {
    /// Counts up; none has another's.
    pub id: u64,
    pub condition: Condition,
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
    scratch: Vec<f64>,
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

    pub fn add(&mut self, condition: Condition) -> Result<u64, String> {
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
                let met = one.condition.met_in(subject, sample, &mut self.scratch)?;
                Some((subject, met))
            });
            let began = met.is_some() && !one.held;
            one.held = met.is_some();
            if let (true, None, Some((subject, met))) = (began, &first, met) {
                first = Some(Broke {
                    id: one.id,
                    condition: one.condition.to_string(),
                    at,
                    body: subject.name.clone(),
                    met,
                });
            }
        }
        first
    }
}
