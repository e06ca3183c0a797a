//! An hour of simulated time at 1 kHz in a process of its own: the most memory it ever had.

use crate::report::Report;
use crate::{Place, scenes};
use torquescope::record::{Heading, Recorder};
use torquescope::sim::Simulation;
use torquescope::trace::beside;

/// The argument by which this program is the process that is measured.
pub const CHILD: &str = "--hour";

const STEPS: usize = 3_600_000;

pub fn hour(report: &mut Report, _: usize) {
    report.section(
        "hour",
        "an hour of simulated time at 1 kHz, the state at every step, all default streams at 60 Hz",
    );
    let program = std::env::current_exe().expect("this program");
    let start = std::time::Instant::now();
    let output = std::process::Command::new(program).arg(CHILD).output();
    let output = output.expect("this program again");
    let took = start.elapsed().as_secs_f64();
    let said = String::from_utf8_lossy(&output.stdout);
    let mut numbers = said
        .split_whitespace()
        .filter_map(|word| word.parse::<f64>().ok());
    match (output.status.success(), numbers.next(), numbers.next()) {
        (true, Some(peak), Some(bytes)) => {
            report.number("most memory", peak / 1024.0, "MiB", "at most 300 MiB");
            report.number("the file", bytes / f64::from(1 << 20), "MiB", "");
            report.number("took", took, "s", "");
        }
        _ => panic!("{}", String::from_utf8_lossy(&output.stderr)),
    }
}

/// Runs it; prints the peak (KiB) and the file's bytes.
pub fn child() {
    let scene = scenes::top(STEPS, "");
    let place = Place::new("hour");
    let simulation = Simulation::new(&scene);
    let heading = Heading::of(&scene, &simulation);
    let recorder = Recorder::create(&place.destination(), &heading, simulation.subjects());
    let mut recorder = recorder.unwrap_or_else(|error| panic!("{error}"));
    let ran = beside(&mut recorder, |sink| simulation.run(sink));
    let (_, done) = ran.unwrap_or_else(|error| panic!("{error}"));
    done.unwrap_or_else(|error| panic!("{error}"));
    let summary = recorder.finish().unwrap_or_else(|error| panic!("{error}"));
    let status = std::fs::read_to_string("/proc/self/status").expect("Linux's /proc");
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let peak = peak.and_then(|line| line.split_whitespace().next());
    println!("{} {}", peak.unwrap_or("?"), summary.bytes);
}
