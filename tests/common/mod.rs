//! What several suites share.

use std::ops::Range;
use torquescope::trace::{Instant, Note, Sample, Sink, SinkError, Track};

/// A sink that keeps nothing.
pub struct Nowhere;

impl Sink for Nowhere {
    fn motions(&mut self, _: &Track<'_>) -> Result<(), SinkError> {
        Ok(())
    }
    fn samples(&mut self, _: Instant, _: Range<usize>, _: &[Sample]) -> Result<(), SinkError> {
        Ok(())
    }
    fn note(&mut self, _: Instant, _: &Note) -> Result<(), SinkError> {
        Ok(())
    }
}
