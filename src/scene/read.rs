//! The file as a whole: its keys, its opening comment, its cross references.

use super::effect::Written;
use super::files::{Enclosure, Files, Library};
use super::keys;
use super::problem::Problems;
use super::table::{Node, Table, nearest};
use super::warnings::{self, Finds, WARNINGS};
use super::{Rate, Record, Scene, Stepping, body, event, pairing};
use crate::integrator::{self, DEFAULT_METHOD, Kind, METHODS, Method};
use crate::trace::{STREAMS, StreamSet};
use std::ops::Range;
use toml::Spanned;
use toml::de::DeTable;

/// Seconds. A thousandth is what game engines and controllers use.
const DEFAULT_STEP: f64 = 1e-3;
/// Of methods that choose their own steps: as accurate as there is need for.
pub(super) const DEFAULT_TOLERANCE: f64 = 1e-12;
/// Half an ulp is 1.1e-16.
const TIGHTEST_TOLERANCE: f64 = 1e-16;
/// Samples a second of the derived streams: what a screen shows.
const DEFAULT_RATE: f64 = 60.0;
/// Times are recorded as whole nanoseconds in 63 bits, which is 292 years.
const LONGEST: f64 = 9.2e9;
/// The unit of a recording's clock, s.
const SHORTEST_STEP: f64 = 1e-9;
/// Rows of the state that are recorded without being asked for by name: about 2 GB.
const MOST_ROWS: f64 = 3e7;
/// More steps than this cannot be counted exactly in an f64 (2⁵³), nor waited for.
const MOST_STEPS: f64 = 9e15;

/// A scene, and where it is to be judged too what about it is probably wrong.
pub(super) fn scene(
    (file, name, source): (&str, &str, &str),
    library: &dyn Library,
    judge: bool,
) -> Result<(Scene, Vec<Finds>), Problems> {
    if source.len() as u64 > super::LARGEST {
        let mut problems = Problems::new(file, "");
        let message = format!(
            "is larger than any scene ({} bytes); a [[swarm]] makes many bodies by one table",
            super::LARGEST
        );
        problems.add(&(0..0), message);
        return Err(problems);
    }
    let mut problems = Problems::new(file, source);
    let Some(document) = document(source, &mut problems) else {
        return Err(problems);
    };
    let top = Table::top(document.get_ref(), &keys::SCENE);
    let files = Files::new(library);
    let scene = read(&top, name, source, &files, &mut problems);
    let allowed = allowed(&top, &mut problems);
    top.check_keys(&mut problems);
    match scene {
        Some(scene) if problems.is_empty() => {
            let found = match judge {
                true => warnings::find(&scene, &top, &allowed),
                false => Vec::new(),
            };
            Ok((scene.with(files.into_enclosures()), found))
        }
        _ => Err(problems),
    }
}

/// The document of a text that is TOML.
pub(crate) fn document<'s>(
    source: &'s str,
    problems: &mut Problems,
) -> Option<Spanned<DeTable<'s>>> {
    let (document, errors) = parse(source);
    // After the first faults a parser guesses.
    for error in errors.iter().take(3) {
        let span = error.span().unwrap_or(0..0);
        problems.add_as("not-toml", &span, format!("not TOML: {}", error.message()));
    }
    document.filter(|_| errors.is_empty())
}

/// The document, and what about it is not TOML.
fn parse(source: &str) -> (Option<Spanned<DeTable<'_>>>, Vec<toml::de::Error>) {
    /// Bytes of a file of which every fault is found: a list of them takes a hundred times the memory.
    const MOST: usize = 1 << 20;
    if source.len() <= MOST {
        let (document, errors) = DeTable::parse_recoverable(source);
        return (Some(document), errors);
    }
    match DeTable::parse(source) {
        Ok(document) => (Some(document), Vec::new()),
        Err(error) => (None, vec![error]),
    }
}

/// The warnings that the scene says are meant, each with its place.
fn allowed<'d>(top: &Table<'d>, problems: &mut Problems) -> Vec<(Node<'d>, &'static str)> {
    let mut allowed = Vec::new();
    let Some(node) = top.get("allow") else {
        return allowed;
    };
    for code in node.texts(problems).unwrap_or_default() {
        let text = code.str(problems).unwrap_or_default();
        match WARNINGS.iter().find(|warning| warning.code == text) {
            Some(warning) => allowed.push((code, warning.code)),
            None => {
                let codes: Vec<&str> = WARNINGS.iter().map(|warning| warning.code).collect();
                let message = format!(
                    "\"{}\" is no warning; {}",
                    problems.text(&code.span).trim_matches('"'),
                    nearest(text, &codes)
                );
                problems.add(&code.span, message);
            }
        }
    }
    allowed
}

impl Scene {
    /// With the files that it names; they are part of what it is.
    fn with(mut self, enclosures: Vec<Enclosure>) -> Self {
        for enclosure in &enclosures {
            let bytes = enclosure.fingerprint.to_le_bytes();
            self.fingerprint = hashed(self.fingerprint, &bytes);
        }
        self.enclosures = enclosures;
        self
    }
}

fn read(
    top: &Table<'_>,
    name: &str,
    source: &str,
    files: &Files<'_>,
    problems: &mut Problems,
) -> Option<Scene> {
    let title = top
        .get("title")
        .and_then(|node| node.str(problems))
        .unwrap_or(name);
    let duration = duration(top, problems);
    let (record, rate_chosen) = record(top, problems);
    let clock = record.as_ref().map_or(DEFAULT_RATE, Record::fastest);
    let (stepping, step) = stepping(top, duration, clock, problems);
    let effects = Written::read(top, step.unwrap_or(DEFAULT_STEP), problems);
    let tables = top.tables("body", problems);
    let swarms = top.tables("swarm", problems);
    if let Some(Stepping::Accuracy(_)) = stepping {
        effects.nothing_per_step(problems);
        no_methods(&tables, problems);
        no_methods(&swarms, problems);
    }
    let gyroscopic = |name: &str| effects.is_gyroscopic(name);
    let context = body::Context {
        gyroscopic: &gyroscopic,
        files,
    };
    let bodies = body::read_all(&tables, &swarms, context, problems);
    let effects = effects.on(&bodies, problems);
    if bodies.declared() == 0 && !top.has("body") && !top.has("swarm") {
        problems.add(top.span(), "the scene has no body; add a [[body]]");
    }
    let events = top.tables("event", problems);
    if let (Some(duration), Some(step), false) = (duration, step, rate_chosen) {
        let rows = duration / step * bodies.declared() as f64;
        if rows > MOST_ROWS {
            let message = format!(
                "the state at every step would be {rows:.1e} rows, some {:.0} GB; take a larger step, or say [record] state = 1000 (a second), or state = \"every\" if it is meant",
                rows * 75e-9
            );
            problems.add(&clock_place(top), message);
        }
    }
    let context = event::Context {
        bodies: &bodies,
        effects: effects.as_deref(),
        clock: event::Clock { duration, step },
        by_accuracy: matches!(stepping, Some(Stepping::Accuracy(_))),
    };
    let events = event::read_all(&events, &context, problems);
    // What it says is looked at where its values are put in.
    top.get("sweep");
    let scene = Scene {
        name: name.to_owned(),
        title: title.replace(char::is_control, " "),
        notes: opening_comment(source),
        text: source.into(),
        fingerprint: fingerprint(source.as_bytes()),
        variant: None,
        enclosures: Vec::new(),
        duration: duration?,
        stepping: stepping?,
        step: step?,
        record: record?,
        effects: effects?,
        bodies: bodies.into_valid()?,
        events,
    };
    pairing::check(&scene, top, problems);
    Some(scene)
}

/// Where the scene says how many steps it has.
pub(super) fn clock_place(top: &Table<'_>) -> Range<usize> {
    let mut nowhere = Problems::new("", "");
    let stepping = top.table("stepping", &mut nowhere);
    let step = stepping.and_then(|table| table.get("step"));
    let place = step.or_else(|| top.get("duration"));
    place.map_or(0..0, |node| node.span)
}

fn duration(top: &Table<'_>, problems: &mut Problems) -> Option<f64> {
    let node = top.require(
        "duration",
        "its length in seconds, such as duration = 2.0",
        problems,
    )?;
    let duration = node.positive("s", problems)?;
    if duration < SHORTEST_STEP {
        node.problem(
            "is below a nanosecond, the finest time a recording tells apart",
            problems,
        );
        return None;
    }
    if duration > LONGEST {
        node.problem(
            format!("is longer than a recording's clock counts ({LONGEST:e} s)"),
            problems,
        );
        return None;
    }
    Some(duration)
}

/// How to step, and the clock's step. A scene that asks for an accuracy is on the clock of its
/// recording, `rate` instants a second.
fn stepping(
    top: &Table<'_>,
    duration: Option<f64>,
    rate: f64,
    problems: &mut Problems,
) -> (Option<Stepping>, Option<f64>) {
    let default = |tolerance| {
        integrator::find(DEFAULT_METHOD).map(|method| Stepping::Method { method, tolerance })
    };
    let longest = duration.unwrap_or(f64::INFINITY);
    let default_step = DEFAULT_STEP.min(longest);
    let Some(table) = top.table("stepping", problems) else {
        return (default(DEFAULT_TOLERANCE), Some(default_step));
    };
    if let Some(node) = table.get("accuracy") {
        let accuracy = accuracy(&node, problems);
        for key in ["method", "step", "tolerance"] {
            if let Some(node) = table.get(key) {
                let why =
                    "beside accuracy: with an accuracy the program chooses; keep one of the two";
                node.problem(why, problems);
            }
        }
        table.check_keys(problems);
        let step = (1.0 / rate).clamp(SHORTEST_STEP, longest.max(SHORTEST_STEP));
        return (accuracy.map(Stepping::Accuracy), Some(step));
    }
    let method = match table.get("method") {
        None => integrator::find(DEFAULT_METHOD),
        Some(node) => method(&node, problems),
    };
    let step = match table.get("step") {
        None => Some(default_step),
        Some(node) => step(&node, duration, problems),
    };
    let tolerance = match table.get("tolerance") {
        None => Some(DEFAULT_TOLERANCE),
        Some(node) => tolerance(&node, method, problems),
    };
    table.check_keys(problems);
    let stepping = method.zip(tolerance);
    let stepping = stepping.map(|(method, tolerance)| Stepping::Method { method, tolerance });
    (stepping, step)
}

pub(super) fn method(node: &Node<'_>, problems: &mut Problems) -> Option<&'static dyn Method> {
    let name = node.str(problems)?;
    let found = integrator::find(name);
    if found.is_none() {
        let names = METHODS.iter().flat_map(|m| {
            let info = m.info();
            std::iter::once(info.name).chain(info.other_names())
        });
        let remedy = nearest(name, &names.collect::<Vec<_>>());
        node.problem(format!("is no method; {remedy}"), problems);
    }
    found
}

/// Bodies have no methods of their own where the program chooses.
fn no_methods(bodies: &[Table<'_>], problems: &mut Problems) {
    for node in bodies.iter().filter_map(|table| table.get("method")) {
        let why = "beside [stepping] accuracy: with an accuracy the program chooses for every body; keep one of the two";
        node.problem(why, problems);
    }
}

fn step(node: &Node<'_>, duration: Option<f64>, problems: &mut Problems) -> Option<f64> {
    let step = node.positive("s", problems)?;
    let steps = duration.unwrap_or(0.0) / step;
    let why = if step < SHORTEST_STEP {
        format!(
            "is below a nanosecond, the finest time a recording tells apart ({SHORTEST_STEP:e} s)"
        )
    } else if steps < 1.0 && duration.is_some() {
        "is longer than the scene".to_owned()
    } else if steps > MOST_STEPS {
        format!("makes {steps:.1e} steps of this scene; at most {MOST_STEPS:e} can be counted")
    } else {
        return Some(step);
    };
    node.problem(why, problems);
    None
}

fn accuracy(node: &Node<'_>, problems: &mut Problems) -> Option<f64> {
    let accuracy = node.positive("rad", problems)?;
    if accuracy > 1.0 {
        node.problem(
            "is more than a radian: no motion is known by that; ask for less",
            problems,
        );
        return None;
    }
    Some(accuracy)
}

pub(super) fn tolerance(
    node: &Node<'_>,
    method: Option<&'static dyn Method>,
    problems: &mut Problems,
) -> Option<f64> {
    let tolerance = node.positive("relative error a step", problems)?;
    if let Some(info) = method.map(|method| method.info())
        && info.kind != Kind::Adaptive
    {
        let message = format!(
            "means nothing to {}, which takes the steps it is given; set `step`, or choose a method that steps by tolerance",
            info.name
        );
        node.problem(message, problems);
        return None;
    }
    if !(TIGHTEST_TOLERANCE..=1e-2).contains(&tolerance) {
        node.problem(
            format!(
                "is not between {TIGHTEST_TOLERANCE:e}, which 64-bit numbers can resolve, and 1e-2"
            ),
            problems,
        );
        return None;
    }
    Some(tolerance)
}

/// What to record, and whether the file says how often the state is.
fn record(top: &Table<'_>, problems: &mut Problems) -> (Option<Record>, bool) {
    let Some(table) = top.table("record", problems) else {
        let record = Record {
            rate: DEFAULT_RATE,
            state: Rate::EveryStep,
            streams: StreamSet::default_set(),
            rates: Vec::new(),
        };
        return (Some(record), false);
    };
    let chosen = table.has("state");
    (record_table(&table, problems), chosen)
}

fn record_table(table: &Table<'_>, problems: &mut Problems) -> Option<Record> {
    let rate = match table.get("rate") {
        None => Some(DEFAULT_RATE),
        Some(node) => node.positive(PER_SECOND, problems),
    };
    let state = match table.get("state") {
        None => Some(Rate::EveryStep),
        Some(node) => how_often(&node, problems),
    };
    let streams = match table.get("streams") {
        None => Some(StreamSet::default_set()),
        Some(node) => streams(&node, problems),
    };
    let rates = match table.get("rates") {
        None => Some(Vec::new()),
        Some(node) => node
            .table("[record.rates]".to_owned(), problems)
            .and_then(|table| rates(&table, problems)),
    };
    table.check_keys(problems);
    Some(Record {
        rate: rate?,
        state: state?,
        streams: streams?,
        rates: rates?,
    })
}

/// The rates of streams that have their own; the names of all streams are its keys.
fn rates(table: &Table<'_>, problems: &mut Problems) -> Option<Vec<(StreamSet, Rate)>> {
    let mut rates = Vec::new();
    let mut all_right = true;
    for stream in STREAMS {
        let Some(node) = table.get(stream.name) else {
            continue;
        };
        let rate = StreamSet::of(stream.name).zip(how_often(&node, problems));
        all_right &= rate.is_some();
        rates.extend(rate);
    }
    (!table.check_keys(problems) && all_right).then_some(rates)
}

const PER_SECOND: &str = "samples per simulated second";

fn how_often(node: &Node<'_>, problems: &mut Problems) -> Option<Rate> {
    if node.is_number() {
        return Some(Rate::PerSecond(node.positive(PER_SECOND, problems)?));
    }
    if node.str(problems)? != "every" {
        node.problem(
            format!("is neither \"every\" nor a number of {PER_SECOND}"),
            problems,
        );
        return None;
    }
    Some(Rate::EveryStep)
}

fn streams(node: &Node<'_>, problems: &mut Problems) -> Option<StreamSet> {
    let mut chosen = StreamSet::none();
    for name in node.texts(problems)? {
        let text = name.str(problems)?;
        match StreamSet::of(text) {
            Some(one) => chosen = chosen.with(one),
            None => {
                let names: Vec<&str> = STREAMS.iter().map(|s| s.name).collect();
                let message = format!("\"{text}\" is no stream; {}", nearest(text, &names));
                problems.add(&name.span, message);
            }
        }
    }
    Some(chosen)
}

/// The comment lines that open a file, without their marks. `#:` is for editors, such as where the
/// schema is.
fn opening_comment(source: &str) -> String {
    let lines = source
        .lines()
        .map_while(|line| line.trim_start().strip_prefix('#'));
    let lines: Vec<&str> = lines
        .filter(|line| !line.starts_with(':'))
        .map(|line| line.strip_prefix(' ').unwrap_or(line))
        .collect();
    lines.join("\n").trim().to_owned()
}

/// FNV-1a over the bytes (Fowler, Noll & Vo): short, and the same everywhere.
pub(super) fn fingerprint(bytes: &[u8]) -> u64 {
    hashed(0xcbf2_9ce4_8422_2325, bytes)
}

fn hashed(start: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(start, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}
