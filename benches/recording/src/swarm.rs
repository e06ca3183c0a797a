//! Ten thousand bodies, poses alone, as one entity.

use crate::measure::{Contestant, race};
use crate::report::Report;
use crate::{Place, scenes};
use std::time::Instant;
use torquescope::record::{Heading, Recorder};
use torquescope::sim::Simulation;
use torquescope::trace::beside;

const BODIES: usize = 10_000;
const STEPS: usize = 1000;

pub fn swarm(report: &mut Report, repeats: usize) {
    report.section(
        "swarm",
        format!("{BODIES} bodies × {STEPS} steps of rk4, each of a motion of its own, to a closed file, by the clock"),
    );
    let scene = scenes::swarm(BODIES, STEPS);
    let place = Place::new("swarm");
    let bytes = std::cell::Cell::new(0);
    let mut contestants: Vec<Contestant> = vec![Box::new(|| {
        let simulation = Simulation::new(&scene);
        let heading = Heading::of(&scene, &simulation);
        let recorder = Recorder::create(&place.destination(), &heading, simulation.subjects());
        let mut recorder = recorder.unwrap_or_else(|error| panic!("{error}"));
        let start = Instant::now();
        let ran = beside(&mut recorder, |sink| simulation.run(sink));
        let (_, done) = ran.unwrap_or_else(|error| panic!("{error}"));
        done.unwrap_or_else(|error| panic!("{error}"));
        let summary = recorder.finish().unwrap_or_else(|error| panic!("{error}"));
        bytes.set(summary.bytes);
        start.elapsed().as_nanos() as f64
    })];
    let mut time = race(&mut contestants, repeats.min(3))[0];
    drop(contestants);
    time.ns /= 1e9;
    let mib = bytes.get() as f64 / f64::from(1 << 20);
    let each = bytes.get() as f64 / (BODIES * STEPS) as f64;
    report.time(
        "stepped and recorded",
        time,
        "s",
        format!("{mib:.0} MiB, {each:.1} B a body-step; at most 2 s, 300 MiB"),
    );
}
