//! What recording costs the thread that steps.

use crate::kept::Nowhere;
use crate::measure::{Contestant, Timing, race};
use crate::report::Report;
use crate::{Place, scenes};
use cpu_time::ThreadTime;
use std::cell::RefCell;
use std::time::Instant;
use torquescope::record::{Heading, Recorder};
use torquescope::scene::{Rate, Scene};
use torquescope::sim::Simulation;
use torquescope::trace::{Sink, beside};

const DEFAULT: &str = "";
const STATE: &str = "streams = []";
const ALL: &str = "rate = 1000";

struct Case {
    name: &'static str,
    scene: Scene,
    /// Body-steps.
    size: usize,
}

fn cases() -> Vec<Case> {
    let case = |name, scene: Scene, steps: usize| Case {
        name,
        size: steps * scene.bodies.len(),
        scene,
    };
    vec![
        case("a top by rk4", scenes::top(1 << 17, DEFAULT), 1 << 17),
        case(
            "a top by rk4, the state alone",
            scenes::top(1 << 17, STATE),
            1 << 17,
        ),
        case(
            "1,000 bodies by rk4, state at 60 Hz",
            scenes::bodies(1000, 500, "state = 60"),
            500,
        ),
        case(
            "1,000 bodies by rk4, state at every step",
            scenes::bodies(1000, 500, DEFAULT),
            500,
        ),
        case("swarm of 10,000 by rk4", scenes::swarm(10_000, 128), 128),
    ]
}

/// The same with nothing to record.
fn bare(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.record.rate = 1e-3;
    scene.record.state = Rate::PerSecond(1e-3);
    scene
}

fn run(scene: &Scene, sink: &mut dyn Sink) {
    let (_, done) = Simulation::new(scene).on_threads(1).run(sink);
    done.unwrap_or_else(|error| panic!("{error}"));
}

fn timed(run: impl FnOnce()) -> f64 {
    let start = ThreadTime::now();
    run();
    start.elapsed().as_nanos() as f64
}

/// What the stages before a recorder cost.
pub fn parts(report: &mut Report, repeats: usize) {
    report.section(
        "parts",
        "ns a body-step of the thread that steps, nothing recorded",
    );
    let mut all = cases();
    all.push(Case {
        name: "a top by rk4, everything at every step",
        scene: scenes::top(1 << 15, ALL),
        size: 1 << 15,
    });
    for case in all {
        let bare = bare(&case.scene);
        let mut contestants: Vec<Contestant> = vec![
            Box::new(|| timed(|| run(&bare, &mut Nowhere { computes: false }))),
            Box::new(|| timed(|| run(&case.scene, &mut Nowhere { computes: false }))),
            Box::new(|| timed(|| run(&case.scene, &mut Nowhere { computes: true }))),
        ];
        let times = race(&mut contestants, repeats);
        let names = [
            "stepping alone",
            "and states kept, samples made",
            "and motions made",
        ];
        for (name, time) in names.iter().zip(times) {
            report.time(
                format!("{}: {name}", case.name),
                time.per(case.size),
                "ns",
                "",
            );
        }
    }
}

pub fn stepper(report: &mut Report, repeats: usize) {
    report.section(
        "stepper",
        "a run to a file with the recorder on another core, ns a body-step: thread time of the stepper, and by the clock",
    );
    for case in cases() {
        let place = Place::new("stepper");
        let bare = bare(&case.scene);
        let walls = RefCell::new([Vec::new(), Vec::new(), Vec::new()]);
        // To the end of the run: what is on its way then is some megabytes.
        let clocked = |k: usize, run: &mut dyn FnMut()| {
            let start = Instant::now();
            let thread = timed(run);
            walls.borrow_mut()[k].push(start.elapsed().as_nanos() as f64);
            thread
        };
        let recorder = || {
            let simulation = Simulation::new(&case.scene);
            let heading = Heading::of(&case.scene, &simulation);
            let recorder = Recorder::create(&place.destination(), &heading, simulation.subjects());
            recorder.unwrap_or_else(|error| panic!("{error}"))
        };
        let alone = || clocked(0, &mut || run(&bare, &mut Nowhere { computes: false }));
        let with = || {
            let mut recorder = recorder();
            let time = clocked(1, &mut || {
                beside(&mut recorder, |sink| run(&case.scene, sink))
                    .unwrap_or_else(|error| panic!("{error}"));
            });
            recorder.finish().unwrap_or_else(|error| panic!("{error}"));
            time
        };
        let here = || {
            let mut recorder = recorder();
            let time = clocked(2, &mut || run(&case.scene, &mut recorder));
            recorder.finish().unwrap_or_else(|error| panic!("{error}"));
            time
        };
        let mut contestants: Vec<Contestant> =
            vec![Box::new(alone), Box::new(with), Box::new(here)];
        let times = race(&mut contestants, repeats);
        drop(contestants);
        let walls = walls
            .into_inner()
            .map(|wall| Timing::of(wall).per(case.size));
        let names = ["alone", "recorded beside it", "recorded by the same thread"];
        for ((name, time), wall) in names.iter().zip(&times).zip(walls) {
            let note = format!(
                "× {:.2}; by the clock {:.0} ns",
                time.ns / times[0].ns,
                wall.ns
            );
            report.time(
                format!("{}: {name}", case.name),
                time.per(case.size),
                "ns",
                note,
            );
        }
    }
}
