//! Level 4: what one recorded instant holds, whoever made it.
//!
//! Nothing here knows of scenes, methods or recordings. A stepper delivers to a [`Sink`]; so can
//! any other engine that knows its bodies' poses and torques.

mod instant;
mod quantity;
mod streams;

pub use instant::{Instant, Moment, Motion, PointForce, Subject};
pub use quantity::{QUANTITIES, Quantity, Shape};
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
    pub body: usize,
    pub text: String,
    pub kind: NoteKind,
}

/// What a note marks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoteKind {
    Begins,
    Ends,
    Instant,
    /// Something went wrong.
    Failure,
}

/// Why a sink took nothing more: already in the words a user reads.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct SinkError(pub String);

/// Where a trace goes. Instants of a body arrive in order; two rows of one instant are what was
/// just before an event and what is just after it.
pub trait Sink {
    /// The state, as often as it is wanted.
    fn motions(&mut self, track: &Track<'_>) -> Result<(), SinkError>;

    /// All bodies at one instant, with all that follows from the model there.
    fn moments(&mut self, at: Instant, moments: &[Moment]) -> Result<(), SinkError>;

    fn note(&mut self, at: Instant, note: &Note) -> Result<(), SinkError>;
}

/// A number for people: six significant digits, no trailing zeros.
pub fn short(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{}", x + 0.0);
    }
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    if (1e-4..1e7).contains(&rounded.abs()) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

/// A vector for people: components below 1e-12 of the longest are rounding and read 0.
pub fn short_vector(v: Vector3<f64>) -> String {
    let noise = 1e-12 * v.amax();
    let part = |&x: &f64| short(if x.abs() <= noise { 0.0 } else { x });
    let parts: Vec<String> = v.iter().map(part).collect();
    format!("({})", parts.join(", "))
}
