//! Logs of other engines, read row by row: CSV with a header, or JSON lines.
//!
//! A [`Reader`] holds one row, the names of the bodies and the beginning of each body's motion, however long the log is;
//! it reads from anything, a pipe that is still written included. What is declared (units, order, axes: by the header,
//! or by [`Mapping`]s) is turned into the crate's conventions; whether the numbers bear that out is found by the search
//! of [`conventions`](super::conventions) and told, and applied only where [`Reading::AsFound`] is asked for.

mod cells;
mod collect;
mod kind;
mod notes;
mod report;
mod source;
mod track;

pub use collect::Progress;
pub use kind::Format;
pub use report::{Bad, BadRow, Note, Report};

use super::columns::{Columns, MOST_COLUMNS, Question, shown};
use super::conventions::{CannotTell, Conventions, Found, search};
use super::mapping::Mapping;
use super::spellings::{Frame, Quantity};
use super::units::Unit;
use crate::math::turned;
use cells::{Cells, Number, fixed};
use nalgebra::{Quaternion, Vector3};
use source::{EndlessRow, LONGEST, Line, Lines, Table, WrongLine};
use std::collections::{HashMap, VecDeque};
use std::io::{self, BufRead, Cursor, Read};
use track::{Beginning, Track};

/// How a log is to be read.
#[derive(Clone, Debug, Default)]
pub struct Options {
    pub mappings: Vec<Mapping>,
    pub reading: Reading,
}

/// What the numbers are taken for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Reading {
    /// What they are declared as.
    #[default]
    AsDeclared,
    /// What they look like, where that is one thing; the beginning of the log is held back until it is known.
    AsFound,
    /// What is said here, whatever is declared.
    As(Conventions),
}

/// One row: one body at one instant, SI, frames as in [`Rows`](super::Rows). `None` is nothing logged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// The index of its body among [`Reader::bodies`].
    pub body: usize,
    /// Of the file, from 1.
    pub line: u64,
    /// s; of a body never less than in the row before.
    pub time: f64,
    /// The same instant as the body's row before: once more, or after an event.
    pub again: bool,
    pub position: Option<[f64; 3]>,
    /// (x, y, z, w), body to world; as logged, of any length but zero.
    pub attitude: Option<[f64; 4]>,
    pub omega: Option<[f64; 3]>,
    pub velocity: Option<[f64; 3]>,
    pub torque: Option<[f64; 3]>,
    pub force: Option<[f64; 3]>,
    pub point: Option<[f64; 3]>,
}

/// Why there is no log, or no more of it.
#[derive(Debug, thiserror::Error)]
pub enum LogError {
    #[error("{file}: cannot be read: {why}")]
    Unreadable { file: String, why: io::Error },
    #[error("{file}: is {what}, not a log; {remedy}")]
    NotALog {
        file: String,
        what: String,
        remedy: String,
    },
    #[error("{}", questions(file, *line, list))]
    Columns {
        file: String,
        line: u64,
        list: Vec<Question>,
    },
    #[error(
        "{file}:{line}: a row of more than {LONGEST} bytes; is there a quote that is not closed?"
    )]
    Endless { file: String, line: u64 },
    #[error(
        "{file}:{line}: `{column}` has more than {MOST_BODIES} values, which is no name of a body; name another column: --map body=COLUMN, or none"
    )]
    TooManyBodies {
        file: String,
        line: u64,
        column: String,
    },
    #[error("{0}")]
    NoRows(NoRows),
}

/// A log without a row that can be read, and all that was wrong with them.
#[derive(Debug)]
pub struct NoRows(pub Box<Report>);

impl std::fmt::Display for NoRows {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let report = &self.0;
        match report.left_out() {
            0 => write!(f, "{}: has no rows", report.file),
            _ => write!(f, "{report}\n{}: has no row that can be read", report.file),
        }
    }
}

/// One line a question.
fn questions(file: &str, line: u64, questions: &[Question]) -> String {
    let told = |q: &Question| format!("{file}:{line}: {}; {}", q.what, q.remedy);
    let lines: Vec<String> = questions.iter().map(told).collect();
    lines.join("\n")
}

/// What the body of a log is called that names none.
pub const NAMELESS: &str = "body";
/// Bodies of a log at most.
pub const MOST_BODIES: usize = 100_000;
/// Rows that are held back while conventions are looked for.
const HELD: usize = 4096;

/// The vectors of a row, in the order in which a [`Raw`] has them.
const VECTORS: [Quantity; 6] = [
    Quantity::Position,
    Quantity::Omega,
    Quantity::Velocity,
    Quantity::Torque,
    Quantity::Force,
    Quantity::Point,
];
const OMEGA: usize = 1;
const POINT: usize = 5;

/// A row in the units of SI, axes as logged.
#[derive(Clone, Copy, Debug)]
struct Raw {
    body: usize,
    line: u64,
    time: f64,
    again: bool,
    attitude: Option<[f64; 4]>,
    vectors: [Option<[f64; 3]>; 6],
}

/// Where the numbers of a row stand.
struct Plan {
    time: [Option<usize>; 2],
    clock: Option<&'static Unit>,
    body: Option<usize>,
    run: Option<usize>,
    attitude: Option<[usize; 4]>,
    vectors: [Option<Vector>; 6],
    declared: Conventions,
}

#[derive(Clone, Copy)]
struct Vector {
    columns: [usize; 3],
    /// `None` is SI.
    units: [Option<&'static Unit>; 3],
    frame: Frame,
}

impl Plan {
    fn of(columns: &Columns) -> Self {
        let one = |quantity| columns.of(quantity).map(|found| found.columns[0]);
        let vector = |quantity| {
            let found = columns.of(quantity)?;
            let unit = |k: usize| found.units[k].filter(|unit| !unit.is_si());
            Some(Vector {
                columns: found.columns[..].try_into().ok()?,
                units: [unit(0), unit(1), unit(2)],
                frame: found.frame,
            })
        };
        let time = columns.of(Quantity::Time);
        let attitude = columns.of(Quantity::Attitude);
        let vectors = VECTORS.map(vector);
        Self {
            time: [0, 1].map(|k| time?.columns.get(k).copied()),
            clock: time.and_then(|time| time.units[0]),
            body: one(Quantity::Body),
            run: one(Quantity::Run),
            attitude: attitude.and_then(|found| found.columns[..].try_into().ok()),
            declared: Conventions::declared(
                vectors[OMEGA].map_or(Frame::World, |omega| omega.frame),
                attitude.is_some_and(|found| found.conjugated),
            ),
            vectors,
        }
    }
}

/// Where times count from, where the first is so large that an f64 would lose what is between rows.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Origin {
    /// Nothing has been read.
    Open,
    Zero,
    /// 10⁻¹² s.
    Exact(i128),
    /// s.
    Rounded(f64),
}

/// s: above this an f64 is good to no better than 10⁻¹⁰ s, which is what the clock of a fast engine has.
const LARGE: f64 = 1e6;

enum Source<R> {
    Table(Table<io::Chain<Cursor<Vec<u8>>, R>>),
    Lines(Lines<io::Chain<Cursor<Vec<u8>>, R>>),
}

/// A log, row by row.
pub struct Reader<R> {
    file: String,
    source: Source<R>,
    format: Format,
    options: Options,
    columns: Columns,
    plan: Plan,
    origin: Origin,
    bodies: Bodies,
    beginning: Beginning,
    report: Report,
    /// Read, and not yet given.
    held: VecDeque<Raw>,
    /// By which rows are turned into the crate's conventions, once that is known.
    conventions: Option<Conventions>,
    ended: bool,
}

impl<R: BufRead> Reader<R> {
    /// Reads as far as the columns are known. `file` is what messages call it.
    pub fn new(file: &str, mut input: R, options: Options) -> Result<Self, LogError> {
        let head = Head::read(&mut input).map_err(|why| LogError::Unreadable {
            file: file.to_owned(),
            why,
        })?;
        let not_a_log = |(what, remedy): (String, &str)| LogError::NotALog {
            file: file.to_owned(),
            what,
            remedy: remedy.to_owned(),
        };
        if let Some(other) = kind::other(&head.bytes, &head.line) {
            return Err(not_a_log((other.what.to_owned(), other.remedy)));
        }
        if head.line.is_empty() {
            return Err(not_a_log(("empty".to_owned(), HEADER)));
        }
        let format = kind::format(&head.line);
        let lines = head.lines;
        let (source, names) = match format {
            Format::Csv(delimiter) => {
                let header = head.header(delimiter).map_err(not_a_log)?;
                let rows = Cursor::new(header.rest).chain(input);
                let source = Source::Table(Table::new(rows, delimiter, header.before));
                (source, header.names)
            }
            Format::JsonLines => {
                let all = Cursor::new(head.bytes).chain(input);
                (Source::Lines(Lines::new(all)), Vec::new())
            }
        };
        let mut reader = Self {
            file: file.to_owned(),
            format,
            source,
            columns: Columns::default(),
            plan: Plan::of(&Columns::default()),
            origin: Origin::Open,
            bodies: Bodies::default(),
            beginning: Beginning::default(),
            report: Report {
                file: file.to_owned(),
                ..Report::default()
            },
            held: VecDeque::new(),
            conventions: match options.reading {
                Reading::As(conventions) => Some(conventions),
                _ => None,
            },
            ended: false,
            options,
        };
        if !names.is_empty() {
            reader.find_columns(&names, lines)?;
        }
        Ok(reader)
    }

    /// How the log is written.
    pub fn format(&self) -> Format {
        self.format
    }

    /// Which columns are read as what; of JSON lines known from the first row on.
    pub fn columns(&self) -> &Columns {
        &self.columns
    }

    /// Names of the bodies that there have been, in the order in which they came.
    pub fn bodies(&self) -> impl ExactSizeIterator<Item = &str> {
        self.bodies.tracks.iter().map(|track| track.name.as_str())
    }

    pub fn body(&self, index: usize) -> Option<&str> {
        self.bodies
            .tracks
            .get(index)
            .map(|track| track.name.as_str())
    }

    /// Bytes of the log that rows were made of.
    pub fn bytes_read(&self) -> u64 {
        match &self.source {
            Source::Table(table) => table.bytes(),
            Source::Lines(lines) => lines.bytes,
        }
    }

    /// s: what the log called its first instant, where times are counted from it because they are so large.
    pub fn origin(&self) -> Option<f64> {
        match self.origin {
            Origin::Open | Origin::Zero => None,
            Origin::Exact(picos) => Some(picos as f64 / 1e12),
            Origin::Rounded(origin) => Some(origin),
        }
    }

    /// What the numbers look like, body by body, of what has been read; of the first bodies.
    pub fn conventions(&self) -> Vec<(&str, Result<Found, CannotTell>)> {
        let of = |track: &'_ Track| track.sample.as_ref().map(search);
        let tracks = self.bodies.tracks.iter();
        tracks
            .filter_map(|track| Some((track.name.as_str(), of(track)?)))
            .collect()
    }

    /// All that there is to say of what has been read.
    pub fn report(&self) -> Report {
        let mut report = self.report.clone();
        report.columns = self.columns.clone();
        report.notes.extend(self.notes());
        report
    }

    /// The next row; `None` at the end. Rows that cannot be read are in the [`report`](Self::report).
    pub fn next_row(&mut self) -> Result<Option<Row>, LogError> {
        if self.conventions.is_none() && self.options.reading == Reading::AsFound {
            self.settle()?;
        }
        let raw = match self.held.pop_front() {
            Some(raw) => Some(raw),
            None => self.next_raw()?,
        };
        let conventions = self.conventions.unwrap_or(self.plan.declared);
        Ok(raw.map(|raw| self.plan.turned(raw, &conventions)))
    }

    /// Decides by which conventions rows are turned, from as many of them as say it.
    fn settle(&mut self) -> Result<(), LogError> {
        while self.held.len() < HELD
            && let Some(raw) = self.next_raw()?
        {
            self.held.push_back(raw);
        }
        let found = agreed(&self.conventions());
        self.conventions = Some(found.unwrap_or(self.plan.declared));
        if let Some(found) = found.filter(|found| *found != self.plan.declared) {
            let what = format!("read as found: {}", found.told(&self.plan.declared));
            self.report.notes.push(Note::new("read-as-found", what));
        }
        Ok(())
    }

    /// The next row as logged.
    fn next_raw(&mut self) -> Result<Option<Raw>, LogError> {
        while !self.ended {
            let file = self.file.as_str();
            let unreadable = |why: io::Error| match why.get_ref() {
                Some(inner) if inner.is::<EndlessRow>() => None,
                _ => Some(LogError::Unreadable {
                    file: file.to_owned(),
                    why,
                }),
            };
            let taken = match &mut self.source {
                Source::Table(table) => {
                    match table.next() {
                        Ok(true) => {}
                        Ok(false) => {
                            self.ended = true;
                            break;
                        }
                        Err(why) => {
                            self.ended = true;
                            let line = table.next_line();
                            let endless = || LogError::Endless {
                                file: self.file.clone(),
                                line,
                            };
                            return Err(unreadable(why).unwrap_or_else(endless));
                        }
                    }
                    let line = table.line();
                    let (fields, wanted) = (table.record.len(), self.columns.names().len());
                    if fields != wanted {
                        if fields == 1 && table.record[0].is_empty() {
                            continue;
                        }
                        let what = format!("has {fields} fields, the header {wanted}");
                        self.report.bad(BadRow {
                            kind: Bad::Fields,
                            line,
                            column: None,
                            what,
                        });
                        continue;
                    }
                    take(
                        &table.record,
                        line,
                        &self.plan,
                        &mut self.origin,
                        &mut self.bodies,
                        &mut self.beginning,
                    )
                }
                Source::Lines(lines) => {
                    let next = lines.next().map_err(|why| LogError::Unreadable {
                        file: self.file.clone(),
                        why,
                    })?;
                    let line = lines.number;
                    match next {
                        Line::End => {
                            self.ended = true;
                            break;
                        }
                        Line::Wrong(wrong) => {
                            self.report.bad(wrong.told(line));
                            continue;
                        }
                        Line::Row { grown: true } => {
                            let names = lines.names.clone();
                            if let Err(why) = self.find_columns(&names, line) {
                                self.ended = true;
                                return Err(why);
                            }
                        }
                        Line::Row { grown: false } => {}
                    }
                    let Source::Lines(lines) = &self.source else {
                        break;
                    };
                    take(
                        &lines.cells,
                        line,
                        &self.plan,
                        &mut self.origin,
                        &mut self.bodies,
                        &mut self.beginning,
                    )
                }
            };
            match taken {
                Ok(raw) => {
                    self.report.rows += 1;
                    return Ok(Some(raw));
                }
                Err(Refused::Row(wrong)) => {
                    // Of JSON lines there may be none yet.
                    let named = |k: usize| Some((k + 1, shown(self.columns.names().get(k)?)));
                    self.report.bad(BadRow {
                        kind: wrong.kind,
                        line: wrong.line,
                        column: wrong.column.and_then(named),
                        what: wrong.what,
                    });
                }
                Err(Refused::TooManyBodies(line)) => {
                    self.ended = true;
                    let column = self.plan.body.or(self.plan.run);
                    let column = column.map(|k| shown(&self.columns.names()[k]));
                    return Err(LogError::TooManyBodies {
                        file: self.file.clone(),
                        line,
                        column: column.unwrap_or_default(),
                    });
                }
            }
        }
        Ok(None)
    }

    /// Where everything stands, among columns that are new or more than before.
    fn find_columns(&mut self, names: &[String], line: u64) -> Result<(), LogError> {
        let wrong = |questions: Vec<Question>| LogError::Columns {
            file: self.file.clone(),
            line,
            list: questions,
        };
        let columns = Columns::find(names, &self.options.mappings).map_err(wrong)?;
        for before in self.columns.found() {
            let now = columns.of(before.quantity);
            if now.is_some_and(|now| now.columns == before.columns && now.frame == before.frame) {
                continue;
            }
            let listed: Vec<String> = before.columns.iter().map(|&k| shown(&names[k])).collect();
            let (name, listed) = (before.quantity.name(), listed.join(","));
            return Err(wrong(vec![Question {
                what: format!(
                    "{name} was {listed} so far, and with what this row adds it may be something else"
                ),
                remedy: format!("say which: --map {name}={listed}"),
            }]));
        }
        self.plan = Plan::of(&columns);
        self.columns = columns;
        Ok(())
    }
}

impl<R: BufRead> Iterator for Reader<R> {
    type Item = Result<Row, LogError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_row().transpose()
    }
}

/// The conventions that all bodies fit that say anything: as declared, or else the only ones.
fn agreed(bodies: &[(&str, Result<Found, CannotTell>)]) -> Option<Conventions> {
    let mut common: Option<Vec<Conventions>> = None;
    for found in bodies.iter().filter_map(|(_, found)| found.as_ref().ok()) {
        let fitting: Vec<Conventions> = found.fitting.iter().map(|fit| fit.conventions).collect();
        common = Some(match common {
            None => fitting,
            Some(common) => common.into_iter().filter(|c| fitting.contains(c)).collect(),
        });
    }
    let declared = bodies
        .iter()
        .find_map(|(_, found)| Some(found.as_ref().ok()?.declared));
    match common?[..] {
        [first, ..] if Some(first) == declared.map(|fit| fit.conventions) => Some(first),
        [only] => Some(only),
        _ => None,
    }
}

const HEADER: &str =
    "a log begins with the names of its columns: time,body,x,y,z,qx,qy,qz,qw,wx,wy,wz";

/// What a log begins with.
struct Head {
    /// All that was read.
    bytes: Vec<u8>,
    /// The first line that holds something and is no comment.
    line: Vec<u8>,
    /// The last comment before it.
    comment: Option<Vec<u8>>,
    /// Lines that were read.
    lines: u64,
}

/// A table's columns, and where its rows begin.
struct Header {
    names: Vec<String>,
    /// A row that was read with it.
    rest: Vec<u8>,
    /// Lines and bytes before the first row.
    before: (u64, u64),
}

impl Head {
    fn read(input: &mut impl BufRead) -> io::Result<Self> {
        let mut head = Self {
            bytes: Vec::new(),
            line: Vec::new(),
            comment: None,
            lines: 0,
        };
        while head.bytes.len() < LONGEST {
            let start = head.bytes.len();
            let room = (LONGEST - start) as u64;
            if input.take(room).read_until(b'\n', &mut head.bytes)? == 0 {
                break;
            }
            head.lines += 1;
            let line = &head.bytes[start..];
            let line = match start {
                0 => line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(line),
                _ => line,
            };
            let line = line.trim_ascii();
            if line.starts_with(b"#") {
                head.comment = Some(line.trim_ascii_start()[1..].trim_ascii().to_vec());
            } else if !line.is_empty() {
                head.line = line.to_vec();
                break;
            }
        }
        Ok(head)
    }

    fn header(self, delimiter: u8) -> Result<Header, (String, &'static str)> {
        let names = Table::<&[u8]>::header(&self.line, delimiter);
        let words = self
            .line
            .split(|b| *b == b' ')
            .filter(|word| !word.is_empty());
        if names.len() == 1 && words.count() > 2 {
            let what = "a table with blanks between its columns".to_owned();
            return Err((what, "put commas there: tr -s ' ' ',' < FILE"));
        }
        if names.len() > MOST_COLUMNS {
            let what = format!("a table of {} columns", names.len());
            return Err((what, "a log has a row for each body and instant"));
        }
        let before = (self.lines, self.bytes.len() as u64);
        let is_number = |name: &String| name.parse::<f64>().is_ok();
        if !names.iter().all(is_number) {
            return Ok(Header {
                names,
                rest: Vec::new(),
                before,
            });
        }
        // The header may be the comment before, and this the first row.
        let comment = self.comment.unwrap_or_default();
        let commented = Table::<&[u8]>::header(&comment, delimiter);
        if commented.len() != names.len() || commented.iter().all(is_number) {
            return Err(("a table without a header".to_owned(), HEADER));
        }
        let mut rest = self.line;
        rest.push(b'\n');
        Ok(Header {
            names: commented,
            before: (before.0 - 1, before.1.saturating_sub(rest.len() as u64)),
            rest,
        })
    }
}

impl WrongLine {
    fn told(self, line: u64) -> BadRow {
        let (kind, what) = match self {
            Self::TooLong => (Bad::TooLong, format!("is longer than {LONGEST} bytes")),
            Self::NotFinite(at) => (
                Bad::NotFinite,
                format!("NaN or Infinity at character {at}, which is no number"),
            ),
            Self::NotJson(at, why) => (
                Bad::NotJson,
                format!("is no JSON object: {why}, at character {at}"),
            ),
            Self::TooManyFields => (
                Bad::TooLong,
                format!("brings the log to more than {MOST_COLUMNS} fields"),
            ),
        };
        BadRow {
            kind,
            line,
            column: None,
            what,
        }
    }
}

/// Why a row is none.
enum Refused {
    Row(Wrong),
    TooManyBodies(u64),
}

/// A row that is wrong, its column by number from 0.
struct Wrong {
    kind: Bad,
    line: u64,
    column: Option<usize>,
    what: String,
}

/// The bodies of a log by their names.
#[derive(Default)]
struct Bodies {
    tracks: Vec<Track>,
    places: HashMap<Vec<u8>, usize>,
    /// The run that comes first, whose bodies have their names alone.
    first_run: Option<Vec<u8>>,
    last: usize,
    key: Vec<u8>,
}

impl Bodies {
    /// The place of a body; in many logs they follow each other in the same order.
    #[inline]
    fn place(&mut self, cells: &impl Cells, plan: &Plan, line: u64) -> Result<usize, Refused> {
        let Some(column) = plan.body else {
            return self.run_of(cells, plan, NAMELESS.as_bytes(), line);
        };
        let name = cells.text(column);
        if name.is_empty() {
            return Err(Refused::Row(Wrong {
                kind: Bad::Missing,
                line,
                column: Some(column),
                what: "is empty: whose row is it?".to_owned(),
            }));
        }
        self.run_of(cells, plan, &name, line)
    }

    #[inline]
    fn run_of(
        &mut self,
        cells: &impl Cells,
        plan: &Plan,
        name: &[u8],
        line: u64,
    ) -> Result<usize, Refused> {
        self.key.clear();
        if let Some(run) = plan.run {
            self.key.extend_from_slice(&cells.text(run));
            self.key.push(0);
        }
        self.key.extend_from_slice(name);
        let guesses = [self.last, self.last + 1, 0];
        let is_it = |k: &&usize| self.tracks.get(**k).is_some_and(|t| t.key == self.key);
        if let Some(&place) = guesses.iter().find(is_it) {
            self.last = place;
            return Ok(place);
        }
        if let Some(&place) = self.places.get(&self.key) {
            self.last = place;
            return Ok(place);
        }
        if self.tracks.len() >= MOST_BODIES {
            return Err(Refused::TooManyBodies(line));
        }
        let run = plan
            .run
            .map(|_| self.key[..self.key.len() - name.len() - 1].to_vec());
        let mut shown = shown(&String::from_utf8_lossy(name));
        if let Some(run) = run {
            let first = self.first_run.get_or_insert_with(|| run.clone());
            if *first != run {
                shown += &format!(
                    "@{}",
                    String::from_utf8_lossy(&run).replace(char::is_control, " ")
                );
            }
        }
        self.last = self.tracks.len();
        self.places.insert(self.key.clone(), self.last);
        self.tracks.push(Track::new(self.key.clone(), shown));
        Ok(self.last)
    }
}

/// The numbers of one row, checked against the row of its body before.
#[inline]
fn take(
    cells: &impl Cells,
    line: u64,
    plan: &Plan,
    origin: &mut Origin,
    bodies: &mut Bodies,
    beginning: &mut Beginning,
) -> Result<Raw, Refused> {
    beginning.take(cells);
    let wrong = |kind, column: usize, what: String| {
        Refused::Row(Wrong {
            kind,
            line,
            column: Some(column),
            what,
        })
    };
    let number = |column: usize| match cells.number(column) {
        Number::Is(x) => Ok(Some(x)),
        Number::Nothing => Ok(None),
        Number::NotFinite => {
            let text = shown(&String::from_utf8_lossy(&cells.text(column)));
            Err(wrong(
                Bad::NotFinite,
                column,
                format!("`{text}` is not finite"),
            ))
        }
        Number::Wrong => {
            let text = shown(&String::from_utf8_lossy(&cells.text(column)));
            let comma = text.contains(',') && text.replace(',', ".").parse::<f64>().is_ok();
            let why = if comma {
                ": it has a comma for a point"
            } else {
                ""
            };
            Err(wrong(
                Bad::NotANumber,
                column,
                format!("`{text}` is no number{why}"),
            ))
        }
    };
    let missing = |column: usize, beside: usize| {
        let what = format!("is empty where column {} is not", beside + 1);
        wrong(Bad::Missing, column, what)
    };
    let time = time(cells, plan, origin, number, wrong)?;
    let mut attitude = None;
    if let Some(columns) = plan.attitude {
        let [x, y, z, w] = columns.map(number);
        attitude = match (x?, y?, z?, w?) {
            (Some(x), Some(y), Some(z), Some(w)) => Some([x, y, z, w]),
            (None, None, None, None) => None,
            (x, y, z, w) => {
                let (empty, full) = part([x, y, z, w]);
                return Err(missing(columns[empty], columns[full]));
            }
        };
        if attitude.is_some_and(|q| q.iter().all(|x| x.abs() < 1e-9)) {
            let what = "the quaternion is zero, which is no attitude".to_owned();
            return Err(wrong(Bad::ZeroQuaternion, columns[0], what));
        }
    }
    let mut vectors = [None; 6];
    for (slot, vector) in vectors.iter_mut().zip(&plan.vectors) {
        let Some(vector) = vector else { continue };
        let [x, y, z] = vector.columns.map(number);
        let si = |k: usize, x: f64| vector.units[k].map_or(x, |unit: &Unit| unit.to_si(x));
        *slot = match (x?, y?, z?) {
            (Some(x), Some(y), Some(z)) => {
                let read = [si(0, x), si(1, y), si(2, z)];
                if let Some(k) = read.iter().position(|x| !x.is_finite()) {
                    let what = "is too large in its unit to be a number".to_owned();
                    return Err(wrong(Bad::NotFinite, vector.columns[k], what));
                }
                Some(read)
            }
            (None, None, None) => None,
            (x, y, z) => {
                let (empty, full) = part([x, y, z]);
                return Err(missing(vector.columns[empty], vector.columns[full]));
            }
        };
    }
    let body = bodies.place(cells, plan, line)?;
    let mut raw = Raw {
        body,
        line,
        time,
        again: false,
        attitude,
        vectors,
    };
    match bodies.tracks[body].take(&mut raw, &plan.declared) {
        Ok(()) => Ok(raw),
        Err(what) => Err(wrong(Bad::TimeBack, plan.time[0].unwrap_or(0), what)),
    }
}

/// The first that is empty, and the first that is not.
fn part<const N: usize>(numbers: [Option<f64>; N]) -> (usize, usize) {
    let first = |empty: bool| numbers.iter().position(|x| x.is_none() == empty);
    (first(true).unwrap_or(0), first(false).unwrap_or(0))
}

/// s, from the log's origin.
#[inline]
fn time(
    cells: &impl Cells,
    plan: &Plan,
    origin: &mut Origin,
    number: impl Fn(usize) -> Result<Option<f64>, Refused>,
    wrong: impl Fn(Bad, usize, String) -> Refused,
) -> Result<f64, Refused> {
    let column = plan.time[0].unwrap_or(0);
    let nothing = |column| {
        wrong(
            Bad::Missing,
            column,
            "is empty: a row has a time".to_owned(),
        )
    };
    let read = number(column)?.ok_or_else(|| nothing(column))?;
    let mut seconds = plan.clock.map_or(read, |unit| unit.to_si(read));
    if let Some(rest) = plan.time[1] {
        seconds += number(rest)?.ok_or_else(|| nothing(rest))? / 1e9;
    }
    let beyond = || {
        let what = "is too large in its unit to be a time".to_owned();
        wrong(Bad::NotFinite, column, what)
    };
    if !seconds.is_finite() {
        return Err(beyond());
    }
    if *origin == Origin::Zero {
        return Ok(seconds);
    }
    let exact = || {
        let digits = plan.clock.map_or(0, Unit::digits);
        let whole = fixed(&cells.text(column), digits)?;
        match plan.time[1] {
            None => Some(whole),
            Some(rest) => whole.checked_add(fixed(&cells.text(rest), 9)?),
        }
    };
    if *origin == Origin::Open {
        *origin = match (seconds.abs() < LARGE, exact()) {
            (true, _) => Origin::Zero,
            (false, Some(exact)) => Origin::Exact(exact),
            (false, None) => Origin::Rounded(seconds),
        };
    }
    let counted = match (*origin, exact()) {
        (Origin::Open | Origin::Zero, _) => seconds,
        (Origin::Exact(first), Some(exact)) => exact.saturating_sub(first) as f64 / 1e12,
        (Origin::Exact(first), None) => seconds - first as f64 / 1e12,
        (Origin::Rounded(first), _) => seconds - first,
    };
    match counted.is_finite() {
        true => Ok(counted),
        false => Err(beyond()),
    }
}

impl Plan {
    /// A row in the crate's conventions.
    #[inline]
    fn turned(&self, raw: Raw, conventions: &Conventions) -> Row {
        let attitude = raw.attitude.map(|read| conventions.attitude(read));
        let mut vectors = raw.vectors;
        if let Some(omega) = &mut vectors[OMEGA]
            && conventions.omega.factor != 1.0
        {
            *omega = omega.map(|x| x * conventions.omega.factor);
        }
        let position = vectors[0];
        for (k, slot) in vectors.iter_mut().enumerate() {
            let frame = match k {
                OMEGA => conventions.frame,
                _ => self.vectors[k].map_or(Frame::World, |vector| vector.frame),
            };
            if frame == Frame::World {
                continue;
            }
            // Without an attitude there is no knowing where it points.
            *slot = slot.zip(attitude).map(|(v, [x, y, z, w])| {
                let q = Quaternion::new(w, x, y, z).normalize();
                turned(q, Vector3::from(v)).into()
            });
            if k == POINT {
                // A point of the body, from the position.
                *slot = slot
                    .zip(position)
                    .map(|(v, p)| [v[0] + p[0], v[1] + p[1], v[2] + p[2]]);
            }
        }
        let [position, omega, velocity, torque, force, point] = vectors;
        Row {
            body: raw.body,
            line: raw.line,
            time: raw.time * conventions.time.factor,
            again: raw.again,
            position,
            attitude,
            omega,
            velocity,
            torque,
            force,
            point,
        }
    }
}
