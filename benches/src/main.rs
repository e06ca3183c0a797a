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
mod threads;
mod throughput;
mod weight;

use report::Report;

const USAGE: &str = "usage: torquescope-bench [--json] [--repeats N] [SECTION...]";

type Section = fn(&mut Report, usize);

const SECTIONS: &[(&str, Section)] = &[
    ("methods", throughput::methods),
    ("tutorial", throughput::tutorial),
    ("threads", threads::threads),
    ("weights", weight::weights),
    ("exact", precision::exact),
    ("precision", precision::precision),
    ("read", read::read),
];

fn main() {
    let (mut json, mut repeats, mut only) = (false, 15, Vec::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--json" => json = true,
            "--repeats" => repeats = number(arguments.next()),
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
