//! How long a scene of many bodies takes to read: a swarm by its one table, and the same number of
//! bodies each by a table of its own.

use crate::measure::{Contestant, Timing, contestant, race};
use crate::report::Report;
use torquescope::scene::Scene;

const BODY: &str = "shape = { cuboid = { x = 1.0, y = 0.5, z = 0.2 } }\ndensity = 1000.0\n";
const RANDOM: &str =
    "random = { seed = 7, within = [50, 50, 50], spin = 3.0, orientation = true }\n";

fn swarm(count: usize, spread: &str) -> String {
    format!("[[swarm]]\nname = \"box\"\ncount = {count}\n{BODY}{spread}")
}

fn tables(count: usize) -> String {
    let table = |k| format!("[[body]]\nname = \"box_{k}\"\n{BODY}");
    (0..count).map(table).collect()
}

/// Reads a scene; what it read is dropped outside the time.
fn reading<'a>(bodies: String) -> Contestant<'a> {
    let head = "duration = 1.0\n[record]\nstate = 60\n[effects]\ngyroscopic = true\n";
    let source = format!("{head}{bodies}");
    contestant(
        || None,
        move |read: &mut Option<Scene>| {
            let scene = Scene::parse("swarm.toml", "swarm", &source);
            *read = Some(scene.expect("a scene that is right"));
        },
    )
}

pub fn read(report: &mut Report, repeats: usize) {
    let scenes = [
        (
            "swarm of 10,000, grid",
            10_000,
            swarm(10_000, "grid = { spacing = 2.0 }\n"),
        ),
        ("swarm of 10,000, random", 10_000, swarm(10_000, RANDOM)),
        ("swarm of 100,000, random", 100_000, swarm(100_000, RANDOM)),
        ("10,000 tables", 10_000, tables(10_000)),
    ];
    let sizes = scenes.each_ref().map(|(name, count, _)| (*name, *count));
    let mut contestants: Vec<Contestant<'_>> = scenes
        .into_iter()
        .map(|(.., source)| reading(source))
        .collect();
    let times: Vec<Timing> = race(&mut contestants, repeats);
    report.section("read", "from a scene's text to a checked scene");
    for ((name, count), time) in sizes.into_iter().zip(times) {
        report.time(name, time.per(count), "ns/body", "");
    }
}
