//! What both benches do with their arguments: sections by name, all where none is named.

use crate::report::Report;

/// A name, and what measures it: into the report, by so many repeats.
pub type Section = (&'static str, fn(&mut Report, usize));

const USAGE: &str = "[--json] [--repeats N] [SECTION...]";

pub fn run(program: &str, sections: &[Section], mut repeats: usize) {
    let stop = || -> ! {
        let names: Vec<&str> = sections.iter().map(|(name, _)| *name).collect();
        eprintln!("usage: {program} {USAGE}\nsections: {}", names.join(", "));
        std::process::exit(2)
    };
    let (mut json, mut only) = (false, Vec::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--json" => json = true,
            "--repeats" => {
                let number = arguments.next().and_then(|text| text.parse().ok());
                repeats = number.filter(|&n| n > 0).unwrap_or_else(|| stop());
            }
            name if sections.iter().any(|(known, _)| *known == name) => only.push(argument),
            _ => stop(),
        }
    }
    let mut report = Report::default();
    for (name, section) in sections {
        if only.is_empty() || only.iter().any(|wanted| wanted == name) {
            section(&mut report, repeats);
        }
    }
    match json {
        true => println!("{}", report.json()),
        false => report.print(),
    }
}
