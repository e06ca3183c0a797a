//! A recording without a viewer: extremes, one instant, where a condition holds.

use super::survey::{InspectError, Survey};
use super::table::{Cells, Key, Origin, Series, Table, Wanted, best, read_cells};
use crate::trace::{Chosen, Condition, Part, Shape, Term};
use std::collections::BTreeMap;
use std::path::Path;

/// A number and when it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    pub value: f64,
    pub time: i64,
}

/// The least and the greatest of something, the first of each.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Span {
    pub least: Option<Mark>,
    pub greatest: Option<Mark>,
}

/// What the numbers of one quantity of one body come to.
#[derive(Clone, Debug)]
pub struct Extremes {
    pub recording: usize,
    pub body: String,
    pub term: Term,
    pub origin: Origin,
    pub rows: u64,
    /// Rows that have a number: it may not be known, or nothing may push.
    pub known: u64,
    /// Of a vector and the like.
    pub size: Option<Span>,
    pub components: Vec<Span>,
    /// Rows with what is no finite number.
    pub not_finite: u64,
    pub first_not_finite: Option<i64>,
}

impl Span {
    fn take(&mut self, value: f64, time: i64) {
        if !value.is_finite() {
            return;
        }
        // Rows may come in any order.
        let mark = Mark { value, time };
        let before = |old: &Mark, than: bool| than || (old.value == value && time < old.time);
        if self.least.is_none_or(|old| before(&old, value < old.value)) {
            self.least = Some(mark);
        }
        if self
            .greatest
            .is_none_or(|old| before(&old, value > old.value))
        {
            self.greatest = Some(mark);
        }
    }
}

impl Extremes {
    fn of(cells: &Cells) -> Self {
        let width = cells.term.shape.components().len();
        Self {
            recording: cells.recording,
            body: cells.body.clone(),
            term: cells.term.clone(),
            origin: cells.origin,
            rows: 0,
            known: 0,
            size: (width > 0).then(Span::default),
            components: vec![Span::default(); width.max(1)],
            not_finite: 0,
            first_not_finite: None,
        }
    }

    fn take(&mut self, time: i64, values: &[f64]) {
        self.rows += 1;
        self.known += u64::from(!values.is_empty());
        for values in values.chunks_exact(self.components.len()) {
            for (span, &value) in self.components.iter_mut().zip(values) {
                span.take(value, time);
            }
            if let Some(size) = &mut self.size {
                let squares: f64 = values.iter().map(|x| x * x).sum();
                size.take(squares.sqrt(), time);
            }
        }
        if values.iter().any(|x| !x.is_finite()) {
            self.not_finite += 1;
            let first = self.first_not_finite.map_or(time, |first| first.min(time));
            self.first_not_finite = Some(first);
        }
    }
}

/// The extremes of every quantity of every body; nothing but them is kept.
pub fn extremes(
    path: &Path,
    survey: &Survey,
    wanted: &Wanted,
) -> Result<Vec<Extremes>, InspectError> {
    let mut places: BTreeMap<(usize, String, String, Origin), usize> = BTreeMap::new();
    let mut all: Vec<Extremes> = Vec::new();
    read_cells(path, survey, wanted, |cells| {
        let name = cells.term.name.clone();
        let key = (cells.recording, cells.body.clone(), name, cells.origin);
        let place = *places.entry(key).or_insert_with(|| {
            all.push(Extremes::of(&cells));
            all.len() - 1
        });
        for (time, values) in cells.rows() {
            all[place].take(time, values);
        }
        Ok(())
    })?;
    let keys = all.iter().map(|extremes| Key {
        recording: extremes.recording,
        body: &extremes.body,
        name: &extremes.term.name,
        origin: extremes.origin,
        rows: extremes.rows,
    });
    let order = best(&keys.collect::<Vec<_>>(), wanted.at_one_rate);
    let mut slots: Vec<Option<Extremes>> = all.into_iter().map(Some).collect();
    Ok(order.into_iter().filter_map(|k| slots[k].take()).collect())
}

/// Where a condition holds of one body, from a row to a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    pub recording: usize,
    pub body: String,
    pub quantity: String,
    pub unit: &'static str,
    /// The first row that makes it true, and its number.
    pub begins: Mark,
    /// The last row that does.
    pub last: i64,
    /// The first row after that does not; none where it holds until the end.
    pub ends: Option<i64>,
    pub rows: u64,
    /// The number farthest from nothing on the way.
    pub largest: Mark,
}

/// The quantities that a condition asks for; none where it asks for all.
pub fn asked(condition: &Condition) -> Option<Vec<String>> {
    condition
        .chosen()
        .map(|chosen| vec![chosen.term.name.clone()])
}

/// Where it holds, body by body, at the instants that are recorded.
pub fn stretches(table: &Table, condition: &Condition) -> Vec<Stretch> {
    let asked = condition.chosen().map(|chosen| chosen.term.name.as_str());
    let series = table.series.iter();
    let series = series.filter(|s| condition.concerns(&s.body));
    let series = series.filter(|s| asked.is_none_or(|name| s.term.name == name));
    series.flat_map(|s| stretches_of(s, condition)).collect()
}

fn stretches_of(series: &Series, condition: &Condition) -> Vec<Stretch> {
    let mut found: Vec<Stretch> = Vec::new();
    let mut holds = false;
    for (time, values) in series.rows() {
        let Some(value) = condition.met_by(values) else {
            if holds && let Some(stretch) = found.last_mut() {
                stretch.ends = Some(time);
            }
            holds = false;
            continue;
        };
        let mark = Mark { value, time };
        match found.last_mut().filter(|_| holds) {
            Some(stretch) => {
                stretch.last = time;
                stretch.rows += 1;
                if value.abs() > stretch.largest.value.abs() {
                    stretch.largest = mark;
                }
            }
            None => found.push(Stretch {
                recording: series.recording,
                body: series.body.clone(),
                quantity: series.term.name.clone(),
                unit: series.term.unit,
                begins: mark,
                last: time,
                ends: None,
                rows: 1,
                largest: mark,
            }),
        }
        holds = true;
    }
    found
}

/// A line of a plot.
#[derive(Clone, Debug)]
pub struct Curve {
    pub name: String,
    /// Drawn wide and pale, under the others: of components the size.
    pub under: bool,
    pub points: Vec<(f64, f64)>,
}

/// The curves of what was chosen: of one body's vector each component and the size, of several bodies one each.
pub fn curves(
    table: &Table,
    recording: usize,
    chosen: &Chosen,
    second: impl Fn(i64) -> f64,
) -> Vec<Curve> {
    let own = table.series.iter().filter(|s| {
        let body = chosen.body.as_ref().is_none_or(|body| *body == s.body);
        s.recording == recording && body && s.term.name == chosen.term.name
    });
    let own: Vec<&Series> = own.collect();
    let parts: Vec<Part> = match (own.as_slice(), chosen.part) {
        ([_], Part::Size) if chosen.term.shape != Shape::Matrix => {
            let components = 0..chosen.term.shape.components().len();
            std::iter::once(Part::Size)
                .chain(components.map(Part::Component))
                .collect()
        }
        _ => vec![chosen.part],
    };
    let curve = |series: &&Series, part: Part| {
        let line = Chosen {
            part,
            ..chosen.clone()
        };
        let readings = series.rows().flat_map(|(time, values)| {
            let at = second(time);
            line.readings(values)
                .map(move |y| (at, y))
                .collect::<Vec<_>>()
        });
        Curve {
            under: part == Part::Size && parts.len() > 1,
            name: match own.len() {
                1 => line.to_string(),
                _ => series.body.clone(),
            },
            points: readings.filter(|(_, y)| y.is_finite()).collect(),
        }
    };
    let curves = own
        .iter()
        .flat_map(|s| parts.iter().map(move |&part| (s, part)));
    curves.map(|(series, part)| curve(series, part)).collect()
}
