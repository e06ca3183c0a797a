//! Two threads against one: bodies do not act on each other between events, so each thread takes half
//! of the blocks through a whole stretch.

use crate::bodies::{Acting, BLOCKS, H, blocks, bodies, steps};
use crate::measure::{Contestant, race, wall};
use crate::report::Report;
use crate::throughput::set_out;
use std::thread::scope;
use torquescope::body::LANES;
use torquescope::integrator::{Step, Stepper, find};

type Steppers = Vec<Box<dyn Stepper>>;

pub fn threads(report: &mut Report, repeats: usize) {
    let blocks = blocks(&bodies(BLOCKS * LANES), Acting::Torques);
    let started = set_out(
        find("semi-implicit").expect("the tutorial's method"),
        &blocks,
    );
    report.section(
        "threads",
        format!(
            "semi-implicit with torques, wall clock, threads joined after every stretch{}",
            load_average()
        ),
    );
    for n in [64, 1_024] {
        let steps = &steps(n, H, false);
        let contestant = |threads: usize| -> Contestant {
            wall(
                || started.clone(),
                move |steppers| step(steppers, steps, threads),
            )
        };
        let times = race(&mut [contestant(1), contestant(2)], repeats);
        let [one, two] = [0, 1].map(|k| times[k].per(blocks.len() * LANES * n));
        report.time(
            format!("one thread, {n} steps a stretch"),
            one,
            "ns/body-step",
            "",
        );
        report.time(
            format!("two threads, {n} steps a stretch"),
            two,
            "ns/body-step",
            "",
        );
        report.number(
            "  one / two",
            one.ns / two.ns,
            "x",
            "goal 1.9 or more, on two idle cores",
        );
    }
}

fn step(steppers: &mut Steppers, steps: &[Step], threads: usize) {
    let each = steppers.len().div_ceil(threads);
    scope(|scope| {
        for steppers in steppers.chunks_mut(each) {
            scope.spawn(move || {
                for stepper in steppers {
                    stepper.advance(steps, &mut Vec::new());
                }
            });
        }
    });
}

/// Who else uses the machine, where it says so.
fn load_average() -> String {
    let load = std::fs::read_to_string("/proc/loadavg").ok();
    let last_minute = load.and_then(|text| text.split(' ').next().map(str::to_owned));
    last_minute.map_or(String::new(), |load| {
        let cores = std::thread::available_parallelism().map_or(0, usize::from);
        format!("; load average {load} on {cores} cores as it began")
    })
}
