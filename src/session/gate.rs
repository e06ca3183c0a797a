//! Rows go to a sink once: what is stepped again says nothing again.

use crate::trace::{Instant, Motion, Note, Sample, Sink, SinkError, Track};
use std::ops::Range;

/// Lets through what is later than a time, s; or from it on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum From {
    After(f64),
    At(f64),
    Start,
    Never,
}

impl From {
    fn passes(self, at: Instant) -> bool {
        match self {
            Self::After(time) => at.time > time,
            Self::At(time) => at.time >= time,
            Self::Start => true,
            Self::Never => false,
        }
    }
}

pub(super) struct Gate<'a> {
    pub inner: &'a mut dyn Sink,
    pub from: From,
}

impl Sink for Gate<'_> {
    fn motions(&mut self, track: &Track<'_>) -> Result<(), SinkError> {
        // They are in order.
        let first = track.instants.partition_point(|at| !self.from.passes(*at));
        if first == track.instants.len() {
            return Ok(());
        }
        let motions: &[Motion] = &track.motions[first * track.bodies.len()..];
        self.inner.motions(&Track {
            bodies: track.bodies.clone(),
            instants: &track.instants[first..],
            motions,
        })
    }

    fn samples(
        &mut self,
        at: Instant,
        bodies: Range<usize>,
        samples: &[Sample],
    ) -> Result<(), SinkError> {
        match self.from.passes(at) {
            true => self.inner.samples(at, bodies, samples),
            false => Ok(()),
        }
    }

    fn note(&mut self, at: Instant, note: &Note) -> Result<(), SinkError> {
        match self.from.passes(at) {
            true => self.inner.note(at, note),
            false => Ok(()),
        }
    }

    fn caught_up(&mut self) -> Result<(), SinkError> {
        self.inner.caught_up()
    }

    fn wants_fingerprints(&self) -> bool {
        self.from != From::Never && self.inner.wants_fingerprints()
    }

    fn fingerprint(&mut self, at: Instant, hash: u64) -> Result<(), SinkError> {
        match self.from.passes(at) {
            true => self.inner.fingerprint(at, hash),
            false => Ok(()),
        }
    }
}
