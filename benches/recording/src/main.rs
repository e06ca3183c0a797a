//! How fast recordings are written and how large they are, and how that compares: see docs/performance.md.
//!
//! Every ratio is of times from one run. Nothing here is a test: a slow machine makes nothing fail.

mod by_log;
mod kept;
mod limit;
#[path = "../../src/measure.rs"]
#[allow(dead_code)]
mod measure;
mod memory;
#[path = "../../src/report.rs"]
mod report;
mod scenes;
mod stepper;
mod swarm;
mod write;

use report::Report;

const USAGE: &str = "usage: torquescope-bench-recording [--json] [--repeats N] [SECTION...]";

type Section = fn(&mut Report, usize);

const SECTIONS: &[(&str, Section)] = &[
    ("write", write::write),
    ("parts", stepper::parts),
    ("stepper", stepper::stepper),
    ("swarm", swarm::swarm),
    ("hour", memory::hour),
];

fn main() {
    let (mut json, mut repeats, mut only) = (false, 5, Vec::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--json" => json = true,
            "--repeats" => repeats = number(arguments.next()),
            memory::CHILD => return memory::child(),
            name if SECTIONS.iter().any(|(known, _)| *known == name) => only.push(argument),
            _ => stop(),
        }
    }
    let mut report = Report::default();
    for (name, section) in SECTIONS {
        if only.is_empty() || only.iter().any(|wanted| wanted == name) {
            section(&mut report, repeats);
        }
    }
    match json {
        true => println!("{}", report.json()),
        false => report.print(),
    }
}

fn number(argument: Option<String>) -> usize {
    let number = argument.and_then(|text| text.parse().ok());
    number.filter(|&n| n > 0).unwrap_or_else(|| stop())
}

fn stop() -> ! {
    let names: Vec<&str> = SECTIONS.iter().map(|(name, _)| *name).collect();
    eprintln!("{USAGE}\nsections: {}", names.join(", "));
    std::process::exit(2)
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
