//! Level 4: what one recorded instant holds, whoever made it.
//!
//! Nothing here knows of scenes, methods or recordings. A stepper delivers to a [`Sink`]; so can
//! any other engine that knows its bodies' poses and torques.

mod beside;
mod condition;
mod instant;
mod names;
mod quantity;
mod streams;

pub use beside::beside;
pub use condition::{Chosen, Condition, ConditionError, Met, Part, TORQUE_BY, Term, Vocabulary};
pub use instant::{Deviation, Instant, Motion, PointForce, Sample, Subject};
pub use names::nearest;
pub use quantity::{Quantity, Shape};
pub use streams::{STREAMS, Stream, StreamSet};

use nalgebra::Vector3;
use std::ops::Range;
use std::sync::Arc;

/// Poses of some bodies over some instants: `motions[k * bodies.len() + i]` is body
/// `bodies.start + i` at `instants[k]`.
#[derive(Clone, Debug)]
pub struct Track<'a> {
    pub bodies: Range<usize>,
    pub instants: &'a [Instant],
    pub motions: &'a [Motion],
}

/// Motions that are computed where they are wanted: a stepper keeps states in a form of its own, and need not
/// wait while they are turned into motions.
pub struct Poses {
    pub bodies: Range<usize>,
    pub instants: Arc<[Instant]>,
    /// Memory held by it, about.
    pub bytes: usize,
    /// Ordered as in a [`Track`].
    pub motions: Box<dyn FnOnce() -> Vec<Motion> + Send>,
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

    /// The same, still to be computed.
    fn poses(&mut self, poses: Poses) -> Result<(), SinkError> {
        self.motions(&Track {
            bodies: poses.bodies,
            instants: &poses.instants,
            motions: &(poses.motions)(),
        })
    }

    /// Some bodies at one instant, with all that follows from the model there.
    fn samples(
        &mut self,
        at: Instant,
        bodies: Range<usize>,
        samples: &[Sample],
    ) -> Result<(), SinkError>;

    fn note(&mut self, at: Instant, note: &Note) -> Result<(), SinkError>;

    /// Nothing has come for a while.
    fn idle(&mut self) -> Result<(), SinkError> {
        Ok(())
    }

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
    // -1.23400e-2: what the digits are is known then, only their point is elsewhere.
    let rounded = format!("{x:.*e}", digits - 1);
    let (Some((mantissa, exponent)), negative) = (
        rounded.trim_start_matches('-').split_once('e'),
        x.is_sign_negative(),
    ) else {
        return rounded;
    };
    let place: i32 = exponent.parse().unwrap_or(0);
    let mantissa = mantissa.trim_end_matches('0').trim_end_matches('.');
    let mut text = String::with_capacity(16);
    if negative {
        text.push('-');
    }
    if !(-4..7).contains(&place) {
        text.push_str(mantissa);
        text.push('e');
        text.push_str(exponent);
        return text;
    }
    let figures = mantissa.bytes().filter(u8::is_ascii_digit).map(char::from);
    if place < 0 {
        text.push_str("0.");
        text.extend((1..-place).map(|_| '0'));
        text.extend(figures);
        return text;
    }
    let whole = place as usize + 1;
    let count = mantissa.len() - usize::from(mantissa.contains('.'));
    for (k, figure) in figures.enumerate() {
        if k == whole {
            text.push('.');
        }
        text.push(figure);
    }
    text.extend((count..whole).map(|_| '0'));
    text
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

#[cfg(test)]
mod tests {
    use super::*;

    /// As Rust writes the number that six digits make. (Denormal numbers have fewer than six.)
    fn by_parsing(x: f64) -> String {
        let rounded: f64 = format!("{x:.5e}").parse().unwrap();
        match (1e-4..1e7).contains(&rounded.abs()) {
            true => format!("{rounded}"),
            false => format!("{rounded:e}"),
        }
    }

    #[test]
    fn numbers_for_people_are_those_that_rust_writes() {
        let mut some = vec![
            1.0,
            10.0,
            100.0,
            1e6,
            1e7,
            9_999_999.0,
            9_999_994.9,
            999_999.5,
            123_456.0,
            1_234_567.0,
            0.1,
            0.01,
            1e-3,
            1e-4,
            9.999_999e-5,
            9.999_99e-5,
            1e-5,
            1.5e-5,
            0.5,
            2.5,
            123.4,
            1e300,
            f64::MIN_POSITIVE,
            f64::MAX,
        ];
        let mut x = 1.234_567_890_123e-9;
        while x < 1e12 {
            some.push(x);
            x *= 1.037_1;
        }
        for x in some {
            for x in [x, -x] {
                assert_eq!(short(x), by_parsing(x), "{x:e}");
            }
        }
        assert_eq!(short(-0.0), "0");
        assert_eq!(brief(0.123_46), "0.1235");
    }
}
