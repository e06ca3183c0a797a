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

    /// All that is known has come: what comes next has to be computed first, which may take a while.
    fn caught_up(&mut self) -> Result<(), SinkError> {
        Ok(())
    }

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
    let known = figures(x.abs(), digits).unwrap_or_else(|| exact_figures(x.abs(), digits));
    let (mut figures, place) = known;
    let mut count = digits as i32;
    while figures % 10 == 0 && count > 1 {
        figures /= 10;
        count -= 1;
    }
    let sign = if x < 0.0 { "-" } else { "" };
    let zeros = |count: i32| &"000000000"[..count.clamp(0, 9) as usize];
    let parted = |after: i32| {
        let unit = 10_u64.pow(after.max(0) as u32);
        (figures / unit, figures % unit)
    };
    if !(-4..7).contains(&place) {
        let (first, rest) = parted(count - 1);
        return match count {
            1 => format!("{sign}{first}e{place}"),
            _ => format!(
                "{sign}{first}.{rest:0width$}e{place}",
                width = count as usize - 1
            ),
        };
    }
    if place < 0 {
        return format!("{sign}0.{}{figures}", zeros(-place - 1));
    }
    let after = count - 1 - place;
    if after <= 0 {
        return format!("{sign}{figures}{}", zeros(-after));
    }
    let (whole, rest) = parted(after);
    format!("{sign}{whole}.{rest:0width$}", width = after as usize)
}

/// The first so many figures of a number above zero, rounded, and the power of ten of the first; `None` where a product
/// in 64 bits cannot tell them.
fn figures(x: f64, digits: usize) -> Option<(u64, i32)> {
    /// All exact.
    const POWERS: [f64; 23] = [
        1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
        1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
    ];
    if !(1e-12..1e12).contains(&x) {
        return None;
    }
    let scaled = |place: i32| match digits as i32 - 1 - place {
        up @ 0.. => x * POWERS[up as usize],
        down => x / POWERS[-down as usize],
    };
    // 2^e ≤ x < 2^(e+1), so this is the place or one below it.
    let exponent = (x.to_bits() >> 52) as i32 - 1023;
    let mut place = (f64::from(exponent) * std::f64::consts::LOG10_2).floor() as i32;
    if scaled(place) >= POWERS[digits] {
        place += 1;
    }
    let y = scaled(place);
    let rest = y - y.floor();
    // y is off by a rounding, 1e-10 or less.
    if (rest - 0.5).abs() < 1e-6 || y < POWERS[digits - 1] {
        return None;
    }
    let figures = y.floor() as u64 + u64::from(rest > 0.5);
    let limit = POWERS[digits] as u64;
    Some(match figures < limit {
        true => (figures, place),
        false => (figures / 10, place + 1),
    })
}

/// The same by the number's every digit: 1.23400e-2.
fn exact_figures(x: f64, digits: usize) -> (u64, i32) {
    let text = format!("{x:.*e}", digits - 1);
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let figures = mantissa.bytes().filter(u8::is_ascii_digit);
    let figures = figures.fold(0, |n, figure| 10 * n + u64::from(figure - b'0'));
    (figures, exponent.parse().unwrap_or(0))
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
        while x < 1e14 {
            some.push(x);
            // Ties, and numbers beside them.
            let tie = (x.to_bits() >> 32) as f64 / 2.0;
            some.extend([tie, tie * (1.0 + f64::EPSILON), tie * (1.0 - f64::EPSILON)]);
            some.extend(
                [1e-3, 1e-6, 1e-9].map(|unit| (tie * 2.0 + 0.5).floor() % 2e6 / 2.0 * unit),
            );
            x *= 1.000_371;
        }
        some.retain(|x| *x != 0.0);
        for x in some {
            for x in [x, -x] {
                assert_eq!(short(x), by_parsing(x), "{x:e}");
            }
        }
        assert_eq!(short(-0.0), "0");
        assert_eq!(brief(0.123_46), "0.1235");
    }
}
