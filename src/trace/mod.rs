//! Level 4: what one recorded instant holds, whoever made it.
//!
//! Nothing here knows of scenes, methods or recordings. A stepper delivers to a [`Sink`]; so can
//! any other engine that knows its bodies' poses and torques.

mod condition;
mod instant;
mod names;
mod quantity;
mod streams;

pub use condition::{Chosen, Condition, ConditionError, Met, Part, TORQUE_BY, Term, Vocabulary};
pub use instant::{Deviation, Instant, Motion, PointForce, Sample, Subject};
pub use names::nearest;
pub use quantity::{Quantity, Shape};
pub use streams::{STREAMS, Stream, StreamSet};

use nalgebra::Vector3;
use std::ops::Range;

/// Poses of some bodies over some instants: `motions[k * bodies.len() + i]` is body
/// `bodies.start + i` at `instants[k]`.
#[derive(Clone, Debug)]
pub struct Track<'a> {
    pub bodies: Range<usize>,
    pub instants: &'a [Instant],
    pub motions: &'a [Motion],
}

/// A line of the event log.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// The body it is about, where it is about one.
    pub body: Option<usize>,
    pub text: String,
    pub kind: NoteKind,
    /// An impulse (N·s in place of N) and where it struck.
    pub strike: Option<PointForce>,
}

/// What a note marks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoteKind {
    Begins,
    Ends,
    Instant,
    /// Its state was made another one.
    Set,
    /// Something to read, which the motion of no body shows.
    Remark,
    /// Something drifts.
    Warning,
    /// Something went wrong.
    Failure,
}

/// Why a sink took nothing more: already in the words a user reads.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct SinkError(pub String);

/// Where a trace goes. Instants of a body arrive in order; two rows of one instant are what was
/// just before an event and what is just after it. Of a swarm's bodies only the motions come.
pub trait Sink {
    /// The state, as often as it is wanted.
    fn motions(&mut self, track: &Track<'_>) -> Result<(), SinkError>;

    /// Some bodies at one instant, with all that follows from the model there.
    fn samples(
        &mut self,
        at: Instant,
        bodies: Range<usize>,
        samples: &[Sample],
    ) -> Result<(), SinkError>;

    fn note(&mut self, at: Instant, note: &Note) -> Result<(), SinkError>;

    /// Whether [`fingerprint`](Self::fingerprint) is wanted; computing it costs some 30 ns a body.
    fn wants_fingerprints(&self) -> bool {
        false
    }

    /// A hash of every bit of all bodies' states, as the stepper has them, at an instant at which
    /// derived streams are due or an event has begun or ended.
    fn fingerprint(&mut self, at: Instant, hash: u64) -> Result<(), SinkError> {
        let _ = (at, hash);
        Ok(())
    }
}

/// A number for people: six significant digits, no trailing zeros.
pub fn short(x: f64) -> String {
    digits(x, 6)
}

/// A number beside an arrow: four significant digits.
pub fn brief(x: f64) -> String {
    digits(x, 4)
}

fn digits(x: f64, digits: usize) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{}", x + 0.0);
    }
    let rounded: f64 = format!("{x:.*e}", digits - 1).parse().unwrap_or(x);
    if (1e-4..1e7).contains(&rounded.abs()) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

/// Numbers that belong together, for people: those below 1e-9 of the largest do not show
/// among six digits of it and read 0.
pub fn short_numbers(numbers: &[f64]) -> Vec<String> {
    let largest = numbers.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    let clean = |&x: &f64| if x.abs() <= 1e-9 * largest { 0.0 } else { x };
    numbers.iter().map(|x| short(clean(x))).collect()
}

/// A vector for people.
pub fn short_vector(v: Vector3<f64>) -> String {
    format!("({})", short_numbers(v.as_slice()).join(", "))
}
