//! Level 6: recordings. The only place that says `rerun`.
//!
//! The tree of a recording is by quantity first, so that one click hides every torque:
//! `/bodies/NAME` (position) `/spin` (attitude) `/shape`, `/torque/NAME`, `/alpha/NAME`, …, and
//! `/numbers/NAME`, the same quantities as f64 columns. Pictures hang on the bodies by frames, so
//! that no pose is stored twice. Static things are written once, everything else by columns.

mod blueprint;
mod columns;
mod layout;
mod look;
mod mesh;
mod page;
mod picture;
mod recorder;
mod rrd;
mod scale;
mod viewer;

pub use look::QUANTITY_COLOURS;
pub use recorder::{Heading, Recorder, Summary};
pub use scale::Scales;
pub use viewer::{Assets, native_version_line};

/// The version of Rerun whose files this writes and whose viewer it carries.
pub const RERUN_VERSION: &str = "0.36.3";

/// Why a recording cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("{path}: cannot be written: {why}; {remedy}")]
pub struct RecordError {
    path: String,
    why: String,
    remedy: String,
}

impl RecordError {
    fn new(path: &std::path::Path, error: &dyn std::fmt::Display) -> Self {
        Self {
            path: path.display().to_string(),
            why: error.to_string(),
            remedy: "choose another place with --out, or make room and write access there"
                .to_owned(),
        }
    }
}

impl From<RecordError> for crate::trace::SinkError {
    fn from(error: RecordError) -> Self {
        Self(error.to_string())
    }
}
