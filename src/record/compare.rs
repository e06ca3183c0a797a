//! A run held against a recording of it, row by row, while it is being recorded.
//!
//! Both come in the same order where they are the same, so hardly anything is kept. Rows are matched
//! entity by entity all the same: a recording that another tool has put in order is as good.

use super::messages::Messages;
use super::read::Made;
use super::recorder::{HASHES, number_columns};
use crate::trace::{STREAMS, Shape};
use rerun::external::arrow::array::{Array as _, ArrayRef, Float32Array, Float64Array};
use rerun::external::re_log_types::StoreId;
use rerun::log::Chunk;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::Path;

/// What a run again came to.
#[derive(Clone, Debug, Default)]
pub struct Verdict {
    /// Rows of the recording that were compared.
    pub rows: u64,
    /// Hashes of all states among them.
    pub hashes: u64,
    /// The last step compared.
    pub last_step: u64,
    /// Its time, ns.
    pub last_time: i64,
    pub difference: Option<Difference>,
}

/// The first thing that is not the same.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    pub step: u64,
    /// ns.
    pub time: i64,
    /// Where it is about one.
    pub body: Option<String>,
    /// As `torquescope streams` calls it, with the component: `angular_velocity.x`.
    pub quantity: String,
    pub unit: &'static str,
    /// In the recording, and now.
    pub recorded: String,
    pub again: String,
    /// The last step whose hash of all states is the same, before the first whose is not.
    pub hash_agrees_until: Option<u64>,
    pub hash_differs_from: Option<u64>,
    /// What to go by at the same step: states before what follows from them.
    rank: u8,
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let time = self.time as f64 / 1e9;
        write!(f, "at step {}, t = {time} s: {}", self.step, self.quantity)?;
        if let Some(body) = &self.body {
            write!(f, " of {body}")?;
        }
        let unit = match self.unit {
            "" | "1" => String::new(),
            unit => format!(" {unit}"),
        };
        write!(
            f,
            " is {}{unit} in the recording, {}{unit} now",
            self.recorded, self.again
        )?;
        match (self.hash_agrees_until, self.hash_differs_from) {
            (Some(same), Some(other)) => write!(
                f,
                "; the hash of all states is the same up to step {same} and another from step {other} on"
            ),
            (None, Some(other)) => write!(
                f,
                "; the hash of all states is another from step {other} on"
            ),
            (_, None) => write!(f, "; the hashes of all states are the same throughout"),
        }
    }
}

/// A recording that a run is held against.
pub struct Comparison {
    messages: Messages,
    stores: Vec<StoreId>,
    /// Which of them is compared.
    now: usize,
    /// A chunk of a later store, read ahead.
    ahead: Option<(StoreId, Chunk)>,
    /// Whether the recording is all there.
    is_whole: bool,
    recorded: BTreeMap<String, VecDeque<Rows>>,
    again: BTreeMap<String, VecDeque<Rows>>,
    /// Entities whose rows no longer stand side by side.
    lost: BTreeSet<String>,
    verdict: Verdict,
    hash_agrees_until: Option<u64>,
    hash_differs_from: Option<u64>,
}

/// A chunk, and how many of its rows are done with.
struct Rows {
    chunk: Chunk,
    done: usize,
}

impl Rows {
    fn left(&self) -> usize {
        self.chunk.num_rows().saturating_sub(self.done)
    }

    /// Step and nanosecond of a row.
    fn at(&self, row: usize) -> (i64, i64) {
        let time = |name: &'static str| {
            let timeline = self.chunk.timelines().get(&name.into());
            timeline
                .and_then(|t| t.times_raw().get(row).copied())
                .unwrap_or(0)
        };
        (time("step"), time("sim_time"))
    }
}

impl Comparison {
    pub fn new(path: &Path, made: &Made) -> std::io::Result<Self> {
        Ok(Self {
            messages: Messages::open(path)?,
            stores: made.stores.clone(),
            now: 0,
            ahead: None,
            is_whole: made.cut.is_none(),
            recorded: BTreeMap::new(),
            again: BTreeMap::new(),
            lost: BTreeSet::new(),
            verdict: Verdict::default(),
            hash_agrees_until: None,
            hash_differs_from: None,
        })
    }

    /// Compares a chunk of the run.
    pub(super) fn take(&mut self, chunk: &Chunk) {
        let path = chunk.entity_path().to_string();
        if is_aside(chunk, &path) || self.lost.contains(&path) {
            return;
        }
        let rows = Rows {
            chunk: chunk.clone(),
            done: 0,
        };
        self.again.entry(path.clone()).or_default().push_back(rows);
        self.compare(&path);
    }

    /// Ends the comparison of one recording and begins that of the next.
    pub(super) fn end(&mut self) -> Verdict {
        while let Some((path, rows)) = self.pull() {
            self.recorded.entry(path).or_default().push_back(rows);
        }
        let paths: BTreeSet<String> = self
            .recorded
            .keys()
            .chain(self.again.keys())
            .cloned()
            .collect();
        for path in paths {
            self.compare(&path);
            self.left_over(&path);
        }
        self.now += 1;
        self.recorded.clear();
        self.again.clear();
        self.lost.clear();
        let mut verdict = std::mem::take(&mut self.verdict);
        let (until, from) = (self.hash_agrees_until.take(), self.hash_differs_from.take());
        if let Some(difference) = &mut verdict.difference {
            difference.hash_agrees_until = until;
            difference.hash_differs_from = from;
        }
        verdict
    }

    /// The next chunk of this recording.
    fn pull(&mut self) -> Option<(String, Rows)> {
        loop {
            let (store, chunk) = self.ahead.take().or_else(|| self.messages.next_chunk())?;
            let index = self.stores.iter().position(|known| *known == store);
            match index {
                Some(index) if index > self.now => {
                    self.ahead = Some((store, chunk));
                    return None;
                }
                Some(index) if index == self.now => {}
                _ => continue,
            }
            let path = chunk.entity_path().to_string();
            if is_aside(&chunk, &path) || self.lost.contains(&path) {
                continue;
            }
            return Some((path, Rows { chunk, done: 0 }));
        }
    }

    fn compare(&mut self, path: &str) {
        loop {
            let left = |queues: &BTreeMap<String, VecDeque<Rows>>| {
                queues.get(path).is_some_and(|queue| !queue.is_empty())
            };
            if !left(&self.again) {
                return;
            }
            if !left(&self.recorded) {
                let Some((other, rows)) = self.pull() else {
                    return;
                };
                self.recorded.entry(other).or_default().push_back(rows);
                continue;
            }
            let fronts = (self.recorded.get_mut(path), self.again.get_mut(path));
            let (Some(recorded), Some(again)) = fronts else {
                return;
            };
            let (Some(old), Some(new)) = (recorded.front_mut(), again.front_mut()) else {
                return;
            };
            let rows = old.left().min(new.left());
            let found = differences(path, old, new, rows);
            // Rows that differ are rows compared.
            if let Some(last) = (rows > 0).then(|| old.at(old.done + rows - 1)) {
                let last = (last.0.max(0) as u64, last.1);
                let so_far = (self.verdict.last_step, self.verdict.last_time);
                (self.verdict.last_step, self.verdict.last_time) = so_far.max(last);
            }
            self.verdict.rows += rows as u64;
            if path == HASHES {
                self.verdict.hashes += rows as u64;
                self.hashes(path, rows, found.first.is_some());
            }
            let (Some(old), Some(new)) = (
                self.recorded.get_mut(path).and_then(VecDeque::front_mut),
                self.again.get_mut(path).and_then(VecDeque::front_mut),
            ) else {
                return;
            };
            old.done += rows;
            new.done += rows;
            let (old_done, new_done) = (old.left() == 0, new.left() == 0);
            if old_done {
                self.recorded.get_mut(path).map(VecDeque::pop_front);
            }
            if new_done {
                self.again.get_mut(path).map(VecDeque::pop_front);
            }
            if let Some(difference) = found.first {
                self.found(difference);
            }
            if found.apart {
                self.lost.insert(path.to_owned());
                self.recorded.remove(path);
                self.again.remove(path);
                return;
            }
        }
    }

    /// Remembers between which steps the hashes part.
    fn hashes(&mut self, path: &str, rows: usize, some_differ: bool) {
        let fronts = (
            self.recorded.get(path).and_then(VecDeque::front),
            self.again.get(path).and_then(VecDeque::front),
        );
        let (Some(old), Some(new)) = fronts else {
            return;
        };
        if self.hash_differs_from.is_some() {
            return;
        }
        for k in 0..rows {
            let (a, b) = (old.done + k, new.done + k);
            let step = old.at(a).0.max(0) as u64;
            if some_differ && row_difference(&old.chunk, a, &new.chunk, b).is_some() {
                self.hash_differs_from = Some(step);
                return;
            }
            self.hash_agrees_until = Some(step);
        }
    }

    /// Rows that only one side has.
    fn left_over(&mut self, path: &str) {
        let front = |queues: &BTreeMap<String, VecDeque<Rows>>| {
            let rows = queues.get(path)?.front()?;
            Some(rows.at(rows.done))
        };
        let (old, new) = (front(&self.recorded), front(&self.again));
        let (at, recorded, again) = match (old, new) {
            (Some(at), _) => (at, "there", "no longer there"),
            // Of a recording that was cut the rest is not known.
            (None, Some(at)) if self.is_whole => (at, "not there", "there"),
            (None, _) => return,
        };
        self.found(Difference {
            step: at.0.max(0) as u64,
            time: at.1,
            body: body_of(path),
            quantity: format!("the next row of {path}"),
            unit: "",
            recorded: recorded.to_owned(),
            again: again.to_owned(),
            hash_agrees_until: None,
            hash_differs_from: None,
            rank: OTHER,
        });
    }

    /// Keeps the earliest.
    fn found(&mut self, difference: Difference) {
        let key = |d: &Difference| (d.step, d.time, d.rank);
        let first = self.verdict.difference.as_ref();
        if first.is_none_or(|first| key(&difference) < key(first)) {
            self.verdict.difference = Some(difference);
        }
    }
}

/// What is not compared: what does not change with time, and pages, which repeat numbers for people
/// (wall times among them, where those are recorded).
fn is_aside(chunk: &Chunk, path: &str) -> bool {
    chunk.is_static() || path.starts_with("/pages/")
}

/// What comparing some rows gave.
#[derive(Default)]
struct Found {
    first: Option<Difference>,
    /// Whether the rows are not of the same instants, so that those after them mean nothing.
    apart: bool,
}

fn differences(path: &str, old: &Rows, new: &Rows, rows: usize) -> Found {
    for k in 0..rows {
        let (a, b) = (old.done + k, new.done + k);
        let (was, is) = (old.at(a), new.at(b));
        let at = was.min(is);
        let difference = |quantity: Named, recorded, again| Difference {
            step: at.0.max(0) as u64,
            time: at.1,
            body: body_of(path),
            quantity: quantity.name,
            unit: quantity.unit,
            recorded,
            again,
            hash_agrees_until: None,
            hash_differs_from: None,
            rank: quantity.rank,
        };
        if was != is {
            let words = |(step, time): (i64, i64)| format!("step {step}, {} s", time as f64 / 1e9);
            let quantity = Named {
                name: format!("the instant of a row of {path}"),
                unit: "",
                rank: OTHER,
            };
            return Found {
                first: Some(difference(quantity, words(was), words(is))),
                apart: true,
            };
        }
        if let Some((column, recorded, again)) = row_difference(&old.chunk, a, &new.chunk, b) {
            let (part, recorded, again) = part(recorded.as_ref(), again.as_ref());
            return Found {
                first: Some(difference(named(path, &column, part), recorded, again)),
                apart: false,
            };
        }
    }
    Found::default()
}

type Value = Option<ArrayRef>;

/// The first column in which two rows differ, and what they hold.
fn row_difference(old: &Chunk, a: usize, new: &Chunk, b: usize) -> Option<(String, Value, Value)> {
    let columns: BTreeSet<_> = old
        .components()
        .keys()
        .chain(new.components().keys())
        .collect();
    let mut columns: Vec<_> = columns.into_iter().copied().collect();
    columns.sort_by_key(|column| number_columns().position(|name| name == column.as_str()));
    for column in columns {
        // Wall time is never the same.
        if column.as_str() == "step_time" {
            continue;
        }
        let value = |chunk: &Chunk, row: usize| -> Value {
            let list = chunk.components().get_array(column)?;
            list.is_valid(row).then(|| list.value(row))
        };
        let (was, is) = (value(old, a), value(new, b));
        // Bit by bit: NaN is itself, and -0 is not 0.
        if was != is {
            return Some((column.to_string(), was, is));
        }
    }
    None
}

/// The first component in which two values differ, and both as texts with every digit.
fn part(was: Option<&ArrayRef>, is: Option<&ArrayRef>) -> (Option<usize>, String, String) {
    let (old, new) = (was.map(numbers), is.map(numbers));
    if let (Some(Some(old)), Some(Some(new))) = (&old, &new)
        && old.len() == new.len()
        && let Some(k) = (0..old.len()).find(|&k| old[k].to_bits() != new[k].to_bits())
    {
        return (Some(k), format!("{:?}", old[k]), format!("{:?}", new[k]));
    }
    let words = |value: Option<&ArrayRef>| match value {
        None => "nothing".to_owned(),
        Some(value) => {
            let text: Vec<String> = format!("{value:?}")
                .split_whitespace()
                .map(str::to_owned)
                .collect();
            let text = text.join(" ");
            text.chars().take(120).collect()
        }
    };
    (None, words(was), words(is))
}

fn numbers(value: &ArrayRef) -> Option<Vec<f64>> {
    if let Some(list) = value.as_any().downcast_ref::<Float64Array>() {
        return Some(list.values().to_vec());
    }
    let inner = match value
        .as_any()
        .downcast_ref::<rerun::external::arrow::array::FixedSizeListArray>()
    {
        Some(list) => list.values().slice(
            list.value_offset(0).max(0) as usize,
            list.len() * list.value_length().max(0) as usize,
        ),
        None => value.slice(0, value.len()),
    };
    let list = inner.as_any().downcast_ref::<Float32Array>()?;
    Some(list.values().iter().map(|&x| f64::from(x)).collect())
}

/// A quantity in words.
struct Named {
    name: String,
    unit: &'static str,
    rank: u8,
}

/// Ranks: the state in f64, what follows from it, its picture, its hash, the rest.
const STATE: u8 = 0;
const NUMBER: u8 = 1;
const POSE: u8 = 2;
const HASH: u8 = 3;
const OTHER: u8 = 4;

fn named(path: &str, column: &str, part: Option<usize>) -> Named {
    if path == HASHES {
        return Named {
            name: "the hash of all states".to_owned(),
            unit: "",
            rank: HASH,
        };
    }
    let mut quantities = STREAMS.iter().flat_map(|stream| stream.quantities);
    let quantity = quantities.find(|quantity| quantity.name == column);
    let is_number = path.starts_with("/numbers/") || path.starts_with("/bodies/");
    let Some(quantity) = quantity.filter(|_| is_number) else {
        return Named {
            name: format!("{column} of {path}"),
            unit: "",
            rank: if path.starts_with("/bodies/") {
                POSE
            } else {
                OTHER
            },
        };
    };
    let axes: &[&str] = match quantity.shape {
        Shape::Vector | Shape::Quaternion => &["x", "y", "z", "w"],
        Shape::Matrix => &["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"],
        _ => &[],
    };
    let axis = part.and_then(|k| axes.get(k));
    let is_state = ["position", "orientation", "velocity", "angular_velocity"].contains(&column);
    Named {
        name: axis.map_or(column.to_owned(), |axis| format!("{column}.{axis}")),
        unit: quantity.unit,
        rank: if is_state { STATE } else { NUMBER },
    }
}

/// The body that an entity is about: the second part of its path.
fn body_of(path: &str) -> Option<String> {
    let mut parts = path.split('/').filter(|part| !part.is_empty());
    let (quantity, body) = (parts.next()?, parts.next()?);
    let own = ["scene", "events", "__properties"].contains(&quantity);
    (!own).then(|| body.to_owned())
}
