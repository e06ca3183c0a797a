//! A zoo of faulty engines, of right ones that look odd, and of recordings that cannot tell; and what `diagnose` says of them.
//!
//! Thresholds were set on the seeds `TUNED`; nobody looked at recordings of the seeds `UNSEEN` while they were set.
//! `UPDATE_GOLDEN=1 cargo test --test zoo` writes docs/causes.md and docs/zoo.md anew. `ZOO=NAME cargo test --test zoo tuned --
//! --nocapture` prints the verdicts on the recordings whose name has NAME in it.

mod engine;
mod recordings;
mod turn;

use recordings::{Recording, Want, zoo};
use std::collections::BTreeMap;
use std::fmt::Write;
use torquescope::diagnose::{Answer, CAUSES, Verdict, diagnose};

const TUNED: [u64; 1] = [1];
const UNSEEN: [u64; 1] = [20_001];
/// Recordings of each cause and seed.
const EACH: usize = 6;

/// How an answer is.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum How {
    Right,
    /// A set with the right cause in it.
    InSet,
    /// A fault, or a right engine, of which the answer is that the recording cannot tell.
    Missed,
    Wrong,
}

fn how(recording: &Recording, verdict: &Verdict) -> How {
    match &recording.want {
        Want::Fault(cause) if verdict.answer == Answer::Fault => {
            if verdict.one_of.contains(cause) {
                How::InSet
            } else if verdict.cause == *cause {
                How::Right
            } else {
                How::Wrong
            }
        }
        Want::Fine if verdict.answer == Answer::NoFault => How::Right,
        Want::CannotTell if verdict.answer == Answer::CannotTell => How::Right,
        _ if verdict.answer == Answer::CannotTell => How::Missed,
        _ => How::Wrong,
    }
}

#[derive(Default)]
struct Line {
    count: usize,
    by: BTreeMap<How, usize>,
    /// What was said instead.
    instead: BTreeMap<&'static str, usize>,
}

/// Every kind of recording with what was said of it.
fn judged(seeds: [u64; 1]) -> (Vec<(String, Line)>, Vec<String>) {
    let wanted = std::env::var("ZOO").ok();
    let mut lines: Vec<(String, Line)> = Vec::new();
    let mut accused = Vec::new();
    for seed in seeds {
        for recording in zoo(seed, EACH) {
            let verdict = diagnose(&recording.logged);
            let how = how(&recording, &verdict);
            let kind = recording.name.rsplit_once(' ').unwrap().0.to_owned();
            let at = lines.iter().position(|l| l.0 == kind).unwrap_or_else(|| {
                lines.push((kind, Line::default()));
                lines.len() - 1
            });
            let line = &mut lines[at].1;
            line.count += 1;
            *line.by.entry(how).or_default() += 1;
            if how > How::InSet {
                *line.instead.entry(verdict.cause).or_default() += 1;
            }
            if verdict.answer == Answer::Fault && !matches!(recording.want, Want::Fault(_)) {
                accused.push(format!(
                    "{seed}: {} is accused of {}",
                    recording.name, verdict.cause
                ));
            }
            if wanted
                .as_ref()
                .is_some_and(|w| recording.name.contains(w.as_str()))
            {
                let noisy = if recording.noisy { ", noisy" } else { "" };
                println!("{seed}: {}{noisy}: {}", recording.name, verdict.to_json());
            }
        }
    }
    (lines, accused)
}

fn share(lines: &[(String, Line)]) -> (usize, usize, usize) {
    let of = |how: How| lines.iter().filter_map(|l| l.1.by.get(&how)).sum::<usize>();
    let all = lines.iter().map(|l| l.1.count).sum();
    (of(How::Right), of(How::InSet), all)
}

fn table(lines: &[(String, Line)]) -> String {
    let mut text = String::from(
        "| recordings of | number | right | in a set | cannot-tell | wrong | said instead |\n| --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for (kind, line) in lines {
        let n = |how| match line.by.get(&how) {
            Some(n) => n.to_string(),
            None => String::new(),
        };
        let instead: Vec<String> = line
            .instead
            .iter()
            .map(|(c, n)| format!("{c} {n}"))
            .collect();
        writeln!(
            text,
            "| {kind} | {} | {} | {} | {} | {} | {} |",
            line.count,
            n(How::Right),
            n(How::InSet),
            n(How::Missed),
            n(How::Wrong),
            instead.join(", ")
        )
        .unwrap();
    }
    text
}

fn golden(name: &str, text: &str) {
    let path = format!("{}/docs/{name}", env!("CARGO_MANIFEST_DIR"));
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, text).unwrap();
    }
    let there = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        there == text,
        "docs/{name} is not what the tests say; UPDATE_GOLDEN=1 writes it anew"
    );
}

/// At least 98% right, nobody accused who did nothing, no verdict where none can be.
#[test]
fn the_zoo() {
    let mut text = String::from(
        "# The zoo\n\nWhat `diagnose` says of recordings of faulty engines (`tests/zoo`: one switch for each cause, no code shared with the steppers), \
         of right ones that look odd, and of recordings that cannot tell. Bodies, spins, rates and loads are drawn; every third recording has 1% \
         noise on each axis of ω and 0.2° on the attitude; some lack positions, some are printed with seven digits, some engines step by first order, \
         some leave the gyroscopic term out besides. \"In a set\" is an answer of several causes that those data do not tell apart, the right one among \
         them. \"cannot-tell\" counts answers that a recording cannot tell though it could. Written by `UPDATE_GOLDEN=1 cargo test --test zoo`.\n",
    );
    // Both at once: they take as long as each other.
    let found = std::thread::scope(|scope| {
        let judging = [TUNED, UNSEEN].map(|seeds| scope.spawn(move || judged(seeds)));
        judging.map(|thread| thread.join().unwrap())
    });
    let abouts = [
        ("Tuned", "Thresholds were set while looking at these."),
        (
            "Unseen",
            "Other seeds: not looked at while thresholds were set.",
        ),
    ];
    for ((title, about), (lines, accused)) in abouts.into_iter().zip(found) {
        let (right, sets, all) = share(&lines);
        writeln!(
            text,
            "\n## {title}\n\n{about} {all} recordings: {right} right, {sets} in a set, together {:.1}%; accused of those with nothing wrong or nothing \
             to tell: {}.\n\n{}",
            100.0 * (right + sets) as f64 / all as f64,
            accused.len(),
            table(&lines)
        )
        .unwrap();
        println!("{title}: {right} right, {sets} in a set, of {all}; accused: {accused:?}");
        assert!(accused.is_empty(), "{accused:?}");
        assert!(
            (right + sets) as f64 >= 0.98 * all as f64,
            "{}",
            table(&lines)
        );
    }
    golden("zoo.md", &text);
}

/// docs/causes.md is the table.
#[test]
fn causes_are_documented() {
    let mut text = String::from(
        "# What goes wrong with rotation, and how a recording shows it\n\nThe causes that `torquescope diagnose` knows, in the order of its tests. Where a test \
         fails, those after it have no ground. Written by `UPDATE_GOLDEN=1 cargo test --test zoo` from the table `CAUSES` (src/diagnose/causes); how often \
         the answers are right: [zoo.md](zoo.md).\n\nBesides these there are two answers: `none`, and `cannot-tell`, with what to record instead.\n",
    );
    for cause in CAUSES {
        writeln!(
            text,
            "\n## {}\n\n- **What people see:** {}.\n- **How it shows:** {}.\n- **What the code most likely does:** {}.\n- **What is right:** {}.\n- **Remedy:** \
             {}.\n- **A recording that shows it:** {}.",
            cause.id, cause.symptom, cause.test, cause.does, cause.formula, cause.remedy, cause.example
        )
        .unwrap();
    }
    golden("causes.md", &text);
    // Every fault of the zoo is a cause, and every cause is in the zoo.
    let mut kinds: Vec<&str> = recordings::FAULTS.iter().map(|f| f.0).collect();
    kinds.sort_unstable();
    let mut ids: Vec<&str> = CAUSES.iter().map(|c| c.id).collect();
    ids.sort_unstable();
    assert_eq!(kinds, ids);
}
