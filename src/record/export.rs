//! Numbers for other programs: a row an instant and body, a column a number.

use super::survey::{STATIC, TimeUnit};
use super::table::{Series, Table};
use serde_json::{Map, Value};
use std::io::{self, Write};

/// A column of the table that is written.
struct Column {
    /// `torque.x`.
    name: String,
    quantity: String,
    /// Which of the quantity's numbers.
    part: usize,
}

/// One body's series side by side.
struct Rows<'t> {
    recording: usize,
    body: &'t str,
    series: Vec<&'t Series>,
    /// Time, and the row of each series there.
    rows: Vec<(i64, Vec<Option<usize>>)>,
}

/// What is written, row by row.
pub struct Export<'t> {
    clock: String,
    unit: TimeUnit,
    columns: Vec<Column>,
    quantities: Vec<&'t str>,
    bodies: Vec<Rows<'t>>,
}

impl<'t> Export<'t> {
    /// `clock`: what its times are called.
    pub fn new(table: &'t Table, clock: &str, unit: TimeUnit) -> Self {
        let mut quantities: Vec<&Series> = Vec::new();
        for series in &table.series {
            if !quantities.iter().any(|q| q.term.name == series.term.name) {
                quantities.push(series);
            }
        }
        let columns = quantities
            .iter()
            .flat_map(|series| columns(series))
            .collect();
        let key = |s: &Series| (s.recording, s.body.clone());
        let bodies = table.series.chunk_by(|a, b| key(a) == key(b));
        Self {
            clock: clock.to_owned(),
            unit,
            columns,
            quantities: quantities.iter().map(|s| s.term.name.as_str()).collect(),
            bodies: bodies.map(Rows::of).collect(),
        }
    }

    pub fn rows(&self) -> usize {
        self.bodies.iter().map(|body| body.rows.len()).sum()
    }

    /// `recording` counts from 1; a number that is not known is empty.
    pub fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        write!(out, "recording,body,{}", field(&self.clock))?;
        for column in &self.columns {
            write!(out, ",{}", field(&column.name))?;
        }
        writeln!(out)?;
        for body in &self.bodies {
            for (time, places) in &body.rows {
                write!(out, "{},{},", body.recording + 1, field(body.body))?;
                if *time != STATIC {
                    write!(out, "{:?}", self.unit.number(*time))?;
                }
                for column in &self.columns {
                    match body.number(column, places) {
                        Some(x) => write!(out, ",{x:?}")?,
                        None => write!(out, ",")?,
                    }
                }
                writeln!(out)?;
            }
        }
        out.flush()
    }

    /// A list of objects, one a line; a number that is not finite is null.
    pub fn json(&self, out: &mut dyn Write) -> io::Result<()> {
        write!(out, "[")?;
        let mut first = true;
        for body in &self.bodies {
            for (time, places) in &body.rows {
                let object = Value::Object(self.object(body, *time, places));
                write!(out, "{}{object}", if first { "\n" } else { ",\n" })?;
                first = false;
            }
        }
        writeln!(out, "\n]")?;
        out.flush()
    }

    fn object(&self, body: &Rows<'_>, time: i64, places: &[Option<usize>]) -> Map<String, Value> {
        let mut object = Map::new();
        object.insert("recording".to_owned(), (body.recording + 1).into());
        object.insert("body".to_owned(), body.body.into());
        let at = (time != STATIC).then(|| self.unit.number(time));
        object.insert(self.clock.clone(), at.into());
        for name in &self.quantities {
            let place = body.series.iter().position(|s| s.term.name == *name);
            let values = place.and_then(|k| Some(body.series[k].row(places[k]?)));
            let Some(values) = values.filter(|values| !values.is_empty()) else {
                continue;
            };
            let value = match values {
                [one] => (*one).into(),
                several => several.to_vec().into(),
            };
            object.insert((*name).to_owned(), value);
        }
        object
    }

    /// Names of the columns of numbers, the clock first.
    pub fn names(&self) -> Vec<&str> {
        let numbers = self.columns.iter().map(|column| column.name.as_str());
        std::iter::once(self.clock.as_str())
            .chain(numbers)
            .collect()
    }

    /// Recording, from 1, and body of each row.
    pub fn labels(&self) -> impl Iterator<Item = (i64, &str)> {
        self.bodies.iter().flat_map(|body| {
            let label = (body.recording as i64 + 1, body.body);
            std::iter::repeat_n(label, body.rows.len())
        })
    }

    /// The numbers of a column, by its place in [`names`](Self::names).
    pub fn column(&self, index: usize) -> impl Iterator<Item = Option<f64>> {
        self.bodies.iter().flat_map(move |body| {
            body.rows.iter().map(move |(time, places)| match index {
                0 => (*time != STATIC).then(|| self.unit.number(*time)),
                k => body.number(&self.columns[k - 1], places),
            })
        })
    }
}

/// The columns of a quantity; of pushes as many as ever act at once.
fn columns(series: &Series) -> Vec<Column> {
    let components = series.term.shape.components();
    let width = components.len().max(1);
    let most = series.rows().map(|(_, values)| values.len()).max();
    let times = most.unwrap_or(0).div_ceil(width).max(1);
    let name = &series.term.name;
    let column = |k: usize| {
        let place = match times {
            1 => name.clone(),
            _ => format!("{name}.{}", k / width + 1),
        };
        Column {
            name: match components.get(k % width) {
                Some(component) => format!("{place}.{component}"),
                None => place,
            },
            quantity: name.clone(),
            part: k,
        }
    };
    (0..times * width).map(column).collect()
}

impl<'t> Rows<'t> {
    /// Rows of one instant go together in the order in which they come.
    fn of(series: &'t [Series]) -> Self {
        let mut rows: Vec<(i64, usize, usize, usize)> = Vec::new();
        for (k, one) in series.iter().enumerate() {
            let mut nth = 0;
            for (row, &time) in one.times.iter().enumerate() {
                let repeats = row > 0 && one.times[row - 1] == time;
                nth = if repeats { nth + 1 } else { 0 };
                rows.push((time, nth, k, row));
            }
        }
        rows.sort_unstable();
        let together = rows.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1));
        let rows = together.map(|all| {
            let mut places = vec![None; series.len()];
            for &(_, _, k, row) in all {
                places[k] = Some(row);
            }
            (all[0].0, places)
        });
        Self {
            recording: series[0].recording,
            body: &series[0].body,
            rows: rows.collect(),
            series: series.iter().collect(),
        }
    }

    fn number(&self, column: &Column, places: &[Option<usize>]) -> Option<f64> {
        let mut all = self.series.iter();
        let k = all.position(|series| series.term.name == column.quantity)?;
        let values = self.series[k].row(places[k]?);
        values.get(column.part).copied()
    }
}

/// A field of a table of commas (RFC 4180).
fn field(text: &str) -> String {
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}
