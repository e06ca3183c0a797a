//! How fast recordings are written and how large they are, and how that compares: see docs/performance.md.
//!
//! Every ratio is of times from one run. Nothing here is a test: a slow machine makes nothing fail.

mod by_log;
mod kept;
mod limit;
#[path = "../../src/measure.rs"]
mod measure;
mod memory;
#[path = "../../src/report.rs"]
mod report;
mod scenes;
#[path = "../../src/sections.rs"]
mod sections;
mod stepper;
mod swarm;
mod write;

use sections::Section;

const SECTIONS: &[Section] = &[
    ("write", write::write),
    ("parts", stepper::parts),
    ("stepper", stepper::stepper),
    ("swarm", swarm::swarm),
    ("hour", memory::hour),
];

fn main() {
    match std::env::args().nth(1).as_deref() {
        Some(memory::CHILD) => memory::child(),
        _ => sections::run("torquescope-bench-recording", SECTIONS, 5),
    }
}

/// A file that is gone when the bench is done with it.
pub struct Place(std::path::PathBuf);

impl Place {
    pub fn new(name: &str) -> Self {
        let name = format!("torquescope-bench-{}-{name}.rrd", std::process::id());
        Self(std::env::temp_dir().join(name))
    }

    /// For a recording, again and again.
    pub fn destination(&self) -> torquescope::record::Destination {
        torquescope::record::Destination::new(&self.0).replacing(true)
    }
}

impl std::ops::Deref for Place {
    type Target = std::path::Path;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}
