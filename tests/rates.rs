//! How often each stream is recorded: the state, the derived streams at the display rate, some at rates of their own.

mod common;

use common::Memory;
use torquescope::scene::Scene;
use torquescope::sim::Simulation;
use torquescope::trace::StreamSet;

/// A body pushed from 0.1234 s (inside a step of 1/480 s) to 0.2 s.
const SCENE: &str = r#"
duration = 0.5
[stepping]
step = 0.0020833333333333333
[record]
state = 120
streams = ["torque", "alpha", "sources", "energy", "error", "drift"]
[record.rates]
torque = 240
energy = 20
alpha = "every"
sources = 20
error = 20
drift = 20
step_time = 3
[effects]
gravity = [0.0, -9.81, 0.0]
gyroscopic = true
[[body]]
name = "a"
mass = 1.0
inertia = [1, 2, 2.5]
angular_velocity = [1, 0.1, 0]
[[event]]
at = 0.1234
for = 0.0766
body = "a"
force = [0, 0, 3.0]
point = { body = [0.5, 0.1, 0] }
"#;

fn run(source: &str) -> Memory {
    let scene = Scene::parse("s", "s", source).unwrap_or_else(|error| panic!("{error}"));
    common::run(&scene).2
}

/// Steps at which a stream is due, each once.
fn steps(memory: &Memory, stream: &str) -> Vec<u64> {
    let rows = memory.samples.iter();
    let due = rows.filter(|(_, _, sample)| sample.due.contains(stream));
    let mut steps: Vec<u64> = due.map(|(at, _, _)| at.step).collect();
    steps.dedup();
    steps
}

/// The same from the scene by hand: every `every`-th step of 1/480 s, the start, the end, and both ends of the
/// push, at 0.1234 s = 59.2 steps and at 96 steps. The one divides a step in two, so steps count one more from there.
fn expected(every: u64) -> Vec<u64> {
    let grid = (0..=240).filter(|k| k % every == 0);
    let mut steps: Vec<u64> = grid.map(|k| k + u64::from(k > 59)).collect();
    steps.extend([60, 97]);
    steps.sort_unstable();
    steps.dedup();
    steps
}

#[test]
fn each_stream_is_due_at_its_own_rate_and_at_every_event() {
    let memory = run(SCENE);
    assert_eq!(steps(&memory, "torque"), expected(2));
    assert_eq!(steps(&memory, "energy"), expected(24));
    assert_eq!(steps(&memory, "sources"), expected(24));
    assert_eq!(steps(&memory, "alpha"), expected(1));
    // Not recorded at all: having a rate does not choose a stream.
    assert!(steps(&memory, "step_time").is_empty());
    assert!(steps(&memory, "momentum").is_empty());
    let states: Vec<u64> = memory.states.iter().map(|at| at.step).collect();
    assert_eq!(states, expected(4));
}

#[test]
fn what_is_not_due_is_not_computed() {
    let memory = run(SCENE);
    let display = expected(8);
    for (at, _, sample) in &memory.samples {
        let due = sample.due.contains("sources");
        assert_eq!(sample.sources.is_empty(), !due, "step {}", at.step);
        // The watchdog looks at the display rate too.
        let known = sample.deviation.energy.is_some();
        let looked = sample.due.contains("drift") || display.contains(&at.step);
        assert!(!known || looked, "step {}", at.step);
    }
    let known = |(_, _, sample): &&_| {
        let sample: &torquescope::trace::Sample = sample;
        sample.due.contains("drift") && sample.deviation.energy.is_some()
    };
    assert!(memory.samples.iter().filter(known).count() > 10);
}

#[test]
fn at_an_event_every_stream_has_a_row_before_and_a_row_after() {
    let memory = run(SCENE);
    let chosen = ["torque", "alpha", "sources", "energy", "error", "drift"];
    for stream in chosen {
        for time in [0.1234, 0.2] {
            let rows = memory.at(0, time);
            let rows = rows.iter().filter(|sample| sample.due.contains(stream));
            let torques: Vec<f64> = rows.map(|sample| sample.tau_w.norm()).collect();
            assert_eq!(torques.len(), 2, "{stream} at {time} s");
            // The push begins or ends between them.
            assert_ne!(torques[0] == 0.0, torques[1] == 0.0, "{stream} at {time} s");
        }
    }
}

#[test]
fn a_rate_that_is_the_display_rate_says_nothing_new() {
    let plain = SCENE.replace("[record]\nstate = 120", "[record]\nrate = 20\nstate = 120");
    let (start, end) = (
        plain.find("[record.rates]").unwrap(),
        plain.find("[effects]").unwrap(),
    );
    let mut none = plain.clone();
    none.replace_range(start..end, "");
    let mut same = plain.clone();
    same.replace_range(
        start..end,
        "[record.rates]\ntorque = 20\nenergy = 20.0\nsources = 20\n",
    );
    assert_eq!(run(&none).samples, run(&same).samples);
}

#[test]
fn rates_change_no_motion() {
    let none = SCENE.replace("torque = 240", "").replace("20\n", "60\n");
    let end = |source: &str| {
        let scene = Scene::parse("s", "s", source).unwrap();
        let (outcome, done) = Simulation::new(&scene).run(&mut common::Nowhere);
        done.unwrap();
        outcome.end[0].motion
    };
    assert_eq!(end(SCENE), end(&none));
}

#[test]
fn bands_are_streams_with_one_rate() {
    let scene = Scene::parse("s", "s", SCENE).unwrap();
    let bands = scene.record.bands();
    let names = |set: StreamSet| -> Vec<&str> { set.iter().map(|stream| stream.name).collect() };
    let names: Vec<_> = bands.iter().map(|(_, set)| names(*set)).collect();
    assert_eq!(names[0], Vec::<&str>::new());
    assert!(names.contains(&vec!["torque"]));
    assert!(names.contains(&vec!["alpha"]));
    assert!(names.contains(&vec!["sources", "energy", "error", "drift"]));
    assert_eq!(names.len(), 4);
}

#[test]
fn wrong_rates_are_told_where_they_stand() {
    let wrong = "duration = 1\n[record]\n[record.rates]\ntorque = 0\nalpha = \"often\"\nmomentun = 5\nenergy = [1]\n[[body]]\nname = \"a\"\nmass = 1\ninertia = [1, 1, 1]\n";
    let problems = Scene::parse("s.toml", "s", wrong).err().unwrap();
    let told = problems.to_string();
    let mut lines: Vec<&str> = told.lines().filter(|l| l.starts_with("s.toml:")).collect();
    lines.sort_unstable();
    assert_eq!(
        lines,
        [
            "s.toml:4:10: torque = 0 must be above zero (samples per simulated second)",
            "s.toml:5:9: alpha = \"often\" is neither \"every\" nor a number of samples per simulated second",
            "s.toml:6:1: unknown key `momentun` in [record.rates]; did you mean `momentum`?",
            "s.toml:7:10: energy = [1] is an array, not a text in quotes",
        ],
        "{told}"
    );
}

#[cfg(feature = "cli")]
mod recorded {
    use super::{SCENE, expected};
    use assert_cmd::Command;
    use rerun::external::arrow::array::Array as _;
    use rerun::external::re_log_encoding::DecoderApp;
    use rerun::external::re_log_types::LogMsg;
    use rerun::log::Chunk;
    use std::collections::BTreeMap;
    use std::io::BufReader;
    use std::path::Path;

    /// Steps of the rows of every column of an entity, each step once.
    fn columns(path: &Path, entity: &str) -> BTreeMap<String, Vec<i64>> {
        let file = std::fs::File::open(path).unwrap();
        let mut columns: BTreeMap<String, Vec<i64>> = BTreeMap::new();
        for message in DecoderApp::decode_lazy(BufReader::new(file)) {
            let LogMsg::ArrowMsg(_, message) = message.unwrap() else {
                continue;
            };
            let chunk = Chunk::from_arrow_msg(&message).unwrap();
            if chunk.entity_path().to_string() != entity || chunk.is_static() {
                continue;
            }
            let steps = chunk.timelines()[&"step".into()].times_raw();
            for (name, column) in chunk.components().iter() {
                // A column has a value in every row of its chunk: none is stored where it is not due.
                assert_eq!(column.list_array.len(), steps.len());
                columns.entry(name.to_string()).or_default().extend(steps);
            }
        }
        columns.values_mut().for_each(Vec::dedup);
        columns
    }

    fn torquescope(folder: &Path, arguments: &[&str]) -> String {
        let mut command = Command::cargo_bin("torquescope").unwrap();
        let output = command.current_dir(folder).args(arguments).output();
        let output = output.unwrap();
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    }

    #[test]
    fn a_recording_has_each_column_at_its_rate_and_runs_again_to_the_same_bits() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("s.toml"), SCENE).unwrap();
        torquescope(
            folder.path(),
            &["run", "s.toml", "--set", "record.rates.torque=120"],
        );
        let found = columns(&folder.path().join("s.rrd"), "/numbers/a");
        let wanted = |every| {
            expected(every)
                .iter()
                .map(|&k| k as i64)
                .collect::<Vec<_>>()
        };
        assert_eq!(found["torque"], wanted(4));
        assert_eq!(found["torque_norm"], wanted(4));
        assert_eq!(found["kinetic_energy"], wanted(24));
        assert_eq!(found["angular_acceleration"], wanted(1));
        assert_eq!(found.len(), 8, "{:?}", found.keys());
        let arrows = columns(&folder.path().join("s.rrd"), "/alpha/a");
        assert!(!arrows.is_empty());
        assert!(arrows.values().all(|steps| *steps == wanted(8)));
        let again = torquescope(folder.path(), &["run", "s.rrd", "--verify"]);
        assert!(again.contains("same"), "{again}");
    }
}
