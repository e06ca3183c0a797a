//! From samples in memory to a closed file, in time of the one thread that does it.

use crate::kept::Kept;
use crate::measure::{Contestant, contestant, race, wall};
use crate::report::Report;
use crate::{Place, by_log, limit, scenes};
use std::ops::Range;
use torquescope::record::{Heading, Recorder};
use torquescope::scene::Scene;
use torquescope::sim::Simulation;
use torquescope::trace::{Instant, Note, Sample, Sink, SinkError, Subject, Track};

const STEPS: usize = 1 << 17;
/// Of `log` calls, which take a thousand times as long.
const LOGGED: usize = 4096;
/// Pose, angular velocity, torque, angular acceleration, angular momentum, energy, both tensors: 38 numbers and the
/// lengths of the vectors.
const ALL: &str = "streams = [\"state\", \"torque\", \"alpha\", \"omega\", \"momentum\", \"inertia\", \"inverse_inertia\", \"energy\"]";
const EVERY: &str = "rates = { state = \"every\", torque = \"every\", alpha = \"every\", omega = \"every\", momentum = \"every\", inertia = \"every\", inverse_inertia = \"every\", energy = \"every\" }";

struct Case {
    name: &'static str,
    record: String,
    goal: &'static str,
}

pub fn write(report: &mut Report, repeats: usize) {
    let cases = [
        Case {
            name: "the state, every step",
            record: "streams = []".to_owned(),
            goal: "0.15 µs, 75 B",
        },
        Case {
            name: "and derived streams every 16th",
            record: format!("rate = 62.5\n{ALL}"),
            goal: "0.2 µs, 100 B",
        },
        Case {
            name: "and all there is by default, every 16th",
            record: "rate = 62.5".to_owned(),
            goal: "",
        },
        Case {
            name: "all numbers at every step, pictures every 16th",
            record: format!("rate = 62.5\n{ALL}\n{EVERY}"),
            goal: "0.3 µs, 310 B",
        },
        Case {
            name: "all numbers and pictures at every step",
            record: format!("rate = 1000\n{ALL}"),
            goal: "",
        },
    ];
    report.section(
        "write",
        format!("{STEPS} steps of a forced, damped, asymmetric top, from samples in memory to a closed file; µs and bytes a body-step, thread time"),
    );
    for case in cases {
        measure(report, repeats, &case);
    }
    compare(report, repeats);
}

fn recorder(scene: &Scene, place: &Place) -> (Recorder, Vec<Subject>) {
    let simulation = Simulation::new(scene);
    let subjects = simulation.subjects().to_vec();
    let heading = Heading::of(scene, &simulation);
    let recorder = Recorder::create(&place.destination(), &heading, &subjects);
    (recorder.unwrap_or_else(|error| panic!("{error}")), subjects)
}

fn measure(report: &mut Report, repeats: usize, case: &Case) {
    let scene = scenes::top(STEPS, &case.record);
    let kept = Kept::of(&scene);
    let place = Place::new("write");
    let bytes = std::cell::Cell::new(0);
    let mut contestants: Vec<Contestant> = vec![contestant(
        || Some(recorder(&scene, &place).0),
        |recorder| {
            let Some(mut recorder) = recorder.take() else {
                return;
            };
            let done = kept.play(&mut recorder);
            done.unwrap_or_else(|error| panic!("{error}"));
            let summary = recorder.finish().unwrap_or_else(|error| panic!("{error}"));
            bytes.set(summary.bytes);
        },
    )];
    let time = race(&mut contestants, repeats)[0].per(STEPS);
    drop(contestants);
    row(
        report,
        case.name,
        time,
        bytes.get() as f64 / STEPS as f64,
        case.goal,
    );
}

fn row(report: &mut Report, name: &str, mut time: crate::measure::Timing, bytes: f64, goal: &str) {
    time.ns /= 1e3;
    let goal = match goal {
        "" => String::new(),
        goal => format!("at most {goal}"),
    };
    report.time(name, time, "µs", format!("{bytes:.1} B  {goal}"));
}

/// The limit, and the way of the SDK's examples.
fn compare(report: &mut Report, repeats: usize) {
    let place = Place::new("limit");
    let every = scenes::top(STEPS, &format!("rate = 1000\n{ALL}"));
    let kept = Kept::of(&every);
    let subjects = Simulation::new(&every).subjects().to_vec();
    let all = [
        ("limit: the state through LZ4", kept.state(1024)),
        (
            "limit: all numbers through LZ4",
            kept.derived(&subjects[0], 256),
        ),
    ];
    for (name, chunks) in &all {
        let bytes = std::cell::Cell::new(0);
        let mut contestants: Vec<Contestant> = vec![contestant(
            || (),
            |()| bytes.set(limit::pack(chunks, &place)),
        )];
        let time = race(&mut contestants, repeats)[0].per(STEPS);
        drop(contestants);
        row(report, name, time, bytes.get() as f64 / STEPS as f64, "");
    }
    let mut rows = Rows::default();
    let few = scenes::top(LOGGED, &format!("rate = 1000\n{ALL}"));
    let (_, done) = Simulation::new(&few).run(&mut rows);
    done.unwrap_or_else(|error| panic!("{error}"));
    let mut contestants: Vec<Contestant> = vec![wall(|| (), |()| by_log::log(&rows.0, &place))];
    let time = race(&mut contestants, repeats.min(3))[0].per(rows.0.len());
    let bytes = std::fs::metadata(&*place).map_or(0, |data| data.len());
    row(
        report,
        "a `log` call a step and entity, 4 quantities",
        time,
        bytes as f64 / rows.0.len() as f64,
        "",
    );
}

/// The samples of the first body.
#[derive(Default)]
struct Rows(Vec<(Instant, Sample)>);

impl Sink for Rows {
    fn motions(&mut self, _: &Track<'_>) -> Result<(), SinkError> {
        Ok(())
    }

    fn samples(&mut self, at: Instant, _: Range<usize>, all: &[Sample]) -> Result<(), SinkError> {
        self.0
            .extend(all.first().map(|sample| (at, sample.clone())));
        Ok(())
    }

    fn note(&mut self, _: Instant, _: &Note) -> Result<(), SinkError> {
        Ok(())
    }
}
