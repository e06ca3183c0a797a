//! How fast the numerics are, and how that compares: see docs/performance.md.
//!
//! Every ratio is of times from one run. Nothing here is a test: a slow machine makes nothing fail.

mod bodies;
mod by_hand;
mod measure;
mod precision;
mod problems;
mod read;
mod report;
mod sections;
mod threads;
mod throughput;
mod weight;

use sections::Section;

const SECTIONS: &[Section] = &[
    ("methods", throughput::methods),
    ("tutorial", throughput::tutorial),
    ("threads", threads::threads),
    ("weights", weight::weights),
    ("exact", precision::exact),
    ("precision", precision::precision),
    ("read", read::read),
];

fn main() {
    sections::run("torquescope-bench", SECTIONS, 15);
}
