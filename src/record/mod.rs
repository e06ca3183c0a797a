//! Level 6: recordings. The only place that says `rerun`.
//!
//! The tree of a recording is by quantity first, so that one click hides every torque:
//! `/bodies/NAME` (pose) `/shape`, `/torque/NAME`, `/alpha/NAME`, …, and `/numbers/NAME`, the same quantities as f64
//! columns. Pictures hang by frames on the bodies, or on their places where they do not turn. Static things are written once, everything else by columns.

mod apart;
mod band;
mod blueprint;
mod columns;
mod compare;
mod curves;
mod destination;
mod export;
mod frames;
mod ghosts;
mod heading;
mod inspect;
mod layout;
mod links;
mod look;
mod manifest;
mod mesh;
mod messages;
mod page;
mod parquet;
mod picture;
mod price;
mod provenance;
mod read;
mod recorder;
mod recover;
mod rrd;
mod runs;
mod scale;
mod sources;
mod stencil;
mod survey;
mod swarm;
mod table;
mod viewer;

pub use apart::{Apart, Measure, Pair, Tolerances, apart, pairs};
pub use compare::{Comparison, Difference, Verdict};
pub use curves::{PlotText, plot};
pub use destination::{Destination, PARTIAL, partial_name};
pub use export::Export;
pub use ghosts::{Ghosts, letter};
pub use heading::Heading;
pub use inspect::{Curve, Extremes, Mark, Span, Stretch, asked, curves, extremes, stretches};
pub use links::links;
pub use provenance::{Provenance, VERSION};
pub use read::{Made, ReadError, is_recording, read};
pub use recorder::{Recorder, Summary};
pub use recover::{RecoverError, Recovered, recover, recovered_name};
pub use runs::{Collector, Run};
pub use survey::{Clock, Entity, InspectError, Recording, STATIC, Survey, TimeUnit, survey};
pub use table::{Origin, Series, Table, Wanted, vocabulary};
pub use viewer::{Assets, native_version_line};

/// The version of Rerun whose files this writes and whose viewer it carries.
pub const RERUN_VERSION: &str = "0.36.3";

/// The first bytes of a recording.
pub const MAGIC: &[u8; 4] = b"RRF2";

/// Why a recording cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    #[error("{path}: cannot be written: {why}; choose another file or folder for the recording")]
    Create { path: String, why: String },
    #[error(
        "{path}: writing stopped: {why}; make room there, or record fewer streams or less often{}", kept(.partial)
    )]
    Write {
        path: String,
        why: String,
        /// Where what was recorded until then is.
        partial: Option<String>,
    },
    #[error("{path} exists and is no recording; choose another name, so that it is not lost")]
    Occupied { path: String },
    #[error("{path} exists; --force replaces it, or choose another name")]
    Exists { path: String },
    #[error(
        "{path} is a link to {leads_to}, where there is nothing; remove it, or write to {leads_to} itself"
    )]
    Dangling { path: String, leads_to: String },
    #[error("{path} is being written by another torquescope; wait for it, or choose another name")]
    Busy { path: String },
    #[error(
        "{path} was left by a run that was killed: `torquescope recover {path}` makes a whole recording of it, --force writes over it"
    )]
    Left { path: String },
}

impl From<RecordError> for crate::trace::SinkError {
    fn from(error: RecordError) -> Self {
        Self(error.to_string())
    }
}

fn kept(partial: &Option<String>) -> String {
    match partial {
        Some(path) => format!(
            "; what was recorded until then is in {path}, and `torquescope recover {path}` makes it whole"
        ),
        None => String::new(),
    }
}
