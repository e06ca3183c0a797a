//! What engines make of the same cases: the table that benches/peers/hard_cases.py wrote.

use crate::page::coarse;
use crate::run::Seen;
use crate::{Row, infos, tables};
use std::collections::BTreeMap;
use std::fmt::Write as _;

const ENGINES: [&str; 4] = ["rapier", "mujoco", "mujoco-rk4", "bullet"];

const HEAD: &str = "
## Peers

The same bodies, steps and ends by Rapier 0.36 (f64, as by default), MuJoCo 4.0 (its Euler, and its RK4) and Bullet 3.2.7 through
Python, as benches/peers/hard_cases.py found it; beside them `rk4`, what a scene has that names no method, and the least
error there is here, by whichever method. ok: within 1e-3 rad. lost: no number any more, or the engine gave the motion up. Rapier
and Bullet let no step turn a body by more than an eighth of a turn, whatever it should. –: the engine has no means for it
(MuJoCo's damping does not know the inertia; Bullet's bodies take no fixed point through Python).

| case | Rapier | MuJoCo | MuJoCo, RK4 | Bullet | rk4 here | least here |
| --- | --- | --- | --- | --- | --- | --- |
";

fn words(off: f64) -> String {
    match off <= 1e-3 {
        true => format!("ok {}", coarse(off)),
        false => format!("error {} rad", coarse(off)),
    }
}

fn seen_in_words(seen: &Seen) -> String {
    match seen {
        Seen::Off { off, .. } => words(*off),
        Seen::Lost { time, .. } => format!("lost at {} s, told", coarse(*time)),
        Seen::Refused(_) => "refused".to_owned(),
        Seen::NotRun => "–".to_owned(),
    }
}

/// By case and engine, in words.
fn answers() -> BTreeMap<(&'static str, &'static str), String> {
    let text = include_str!("../../benches/peers/hard_cases.csv");
    let row = |line: &'static str| {
        let mut fields = line.splitn(4, ',');
        let mut next = || fields.next().unwrap();
        let (case, engine, outcome, value) = (next(), next(), next(), next());
        let number = || value.parse::<f64>().unwrap();
        let words = match outcome {
            "off" => words(number()),
            "lost" => format!("lost at {} s", coarse(number())),
            "dropped" => "goes on without the blow".to_owned(),
            _ => "refused".to_owned(),
        };
        ((case, engine), words)
    };
    text.lines().skip(1).map(row).collect()
}

pub fn section() -> String {
    let answers = answers();
    let mut text = HEAD.to_owned();
    for Row { case, seen } in tables().iter().flat_map(|table| &table.rows) {
        let theirs = ENGINES.map(|engine| answers.get(&(case.name.as_str(), engine)));
        if theirs.iter().all(Option::is_none) {
            continue;
        }
        let _ = write!(text, "| {} |", case.name);
        for answer in theirs {
            let _ = write!(text, " {} |", answer.map_or("–", String::as_str));
        }
        let default = infos()
            .zip(seen)
            .find(|(info, _)| info.name == "rk4")
            .map(|(_, seen)| seen_in_words(seen));
        let offs = infos().zip(seen).filter_map(|(info, seen)| match seen {
            Seen::Off { off, .. } => Some((*off, info.name)),
            _ => None,
        });
        // The first of equals, which the lists name first.
        let least = offs.reduce(|a, b| if b.0 < a.0 { b } else { a });
        let least = least.map_or("lost, told".to_owned(), |(off, name)| {
            format!("{} ({name})", words(off))
        });
        let _ = writeln!(text, " {} | {least} |", default.unwrap_or_default());
    }
    text
}

#[test]
fn the_peers_table_names_cases_that_there_are() {
    let names: Vec<&str> = tables()
        .iter()
        .flat_map(|table| &table.rows)
        .map(|row| row.case.name.as_str())
        .collect();
    let answers = answers();
    assert!(answers.len() > 200, "{}", answers.len());
    for (case, engine) in answers.keys() {
        assert!(names.contains(case), "{case}");
        assert!(ENGINES.contains(engine), "{engine}");
    }
}
