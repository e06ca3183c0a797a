//! Rows one by one, out of a table or out of lines of JSON, in bounded memory.

use csv::ByteRecord;
use serde_json::Value;
use std::collections::HashMap;
use std::fmt::Write as _;
use std::io::{self, BufRead, Read};

/// Bytes of one row at most.
pub(super) const LONGEST: usize = 1 << 20;

/// Passes bytes on, and stops where a row does not end.
pub(super) struct Guarded<R> {
    input: R,
    /// Bytes since the last row ended.
    since: usize,
}

impl<R: Read> Read for Guarded<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.since > LONGEST {
            return Err(io::Error::other(EndlessRow));
        }
        let read = self.input.read(buffer)?;
        self.since += read;
        Ok(read)
    }
}

/// A row that does not end.
#[derive(Debug, thiserror::Error)]
#[error("a row does not end")]
pub(super) struct EndlessRow;

/// A table of fields.
pub(super) struct Table<R> {
    reader: csv::Reader<Guarded<R>>,
    pub record: ByteRecord,
    /// Lines and bytes before the first row.
    before: (u64, u64),
    /// The line on which the next row begins, from 1, without the lines before.
    next: u64,
}

impl<R: Read> Table<R> {
    pub fn new(input: R, delimiter: u8, before: (u64, u64)) -> Self {
        let guarded = Guarded { input, since: 0 };
        let mut builder = csv::ReaderBuilder::new();
        builder
            .has_headers(false)
            .flexible(true)
            .delimiter(delimiter);
        Self {
            reader: builder.from_reader(guarded),
            record: ByteRecord::new(),
            before,
            next: 1,
        }
    }

    /// The next row into `record`; false at the end.
    #[inline]
    pub fn next(&mut self) -> io::Result<bool> {
        let more = self.reader.read_byte_record(&mut self.record);
        if more.is_ok() {
            self.next = self.reader.position().line();
        }
        self.reader.get_mut().since = 0;
        more.map_err(|error| match error.into_kind() {
            csv::ErrorKind::Io(error) => error,
            // Nothing else stops a reader of bytes in rows of any length.
            _ => io::Error::other("the table cannot be read"),
        })
    }

    /// The line on which the row begins, from 1.
    pub fn line(&self) -> u64 {
        let position = self.record.position();
        self.before.0 + position.map_or(0, csv::Position::line)
    }

    /// The line on which the row after this one begins, from 1.
    pub fn next_line(&self) -> u64 {
        self.before.0 + self.next
    }

    pub fn bytes(&self) -> u64 {
        self.before.1 + self.reader.position().byte()
    }

    /// Fields of a header.
    pub fn header(line: &[u8], delimiter: u8) -> Vec<String> {
        let mut builder = csv::ReaderBuilder::new();
        builder.has_headers(false).delimiter(delimiter);
        let mut record = ByteRecord::new();
        // A slice does not fail.
        let _ = builder.from_reader(line).read_byte_record(&mut record);
        let name = |field: &[u8]| String::from_utf8_lossy(field).trim().to_owned();
        record.iter().map(name).collect()
    }
}

/// Lines that are objects.
pub(super) struct Lines<R> {
    input: R,
    line: Vec<u8>,
    pub number: u64,
    pub bytes: u64,
    /// Paths of all fields that there have been.
    pub names: Vec<String>,
    places: HashMap<String, usize>,
    /// Of the row: by the place of its path.
    pub cells: Vec<Value>,
}

/// What a line was.
pub(super) enum Line {
    /// A row, and whether it has fields that no row before it had.
    Row {
        grown: bool,
    },
    /// No row; why, and where on the line, from 1.
    Wrong(WrongLine),
    End,
}

pub(super) enum WrongLine {
    TooLong,
    NotFinite(usize),
    NotJson(usize, String),
    TooManyFields,
}

impl<R: BufRead> Lines<R> {
    pub fn new(input: R) -> Self {
        Self {
            input,
            line: Vec::new(),
            number: 0,
            bytes: 0,
            names: Vec::new(),
            places: HashMap::new(),
            cells: Vec::new(),
        }
    }

    pub fn next(&mut self) -> io::Result<Line> {
        loop {
            let Some(whole) = self.read_line()? else {
                return Ok(Line::End);
            };
            if !whole {
                return Ok(Line::Wrong(WrongLine::TooLong));
            }
            // A list of objects, one a line, is as good.
            let mut text = self.line.trim_ascii();
            text = text.strip_suffix(b",").unwrap_or(text).trim_ascii();
            text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
            if let Some(rest) = text.strip_prefix(b"[").map(<[u8]>::trim_ascii)
                && (rest.is_empty() || rest.starts_with(b"{"))
            {
                text = rest;
            }
            if text.ends_with(b"}]") || text == b"]" {
                text = text[..text.len() - 1].trim_ascii();
            }
            if text.is_empty() {
                continue;
            }
            let offset = text.as_ptr() as usize - self.line.as_ptr() as usize;
            let value = match serde_json::from_slice::<Value>(text) {
                Ok(value) => value,
                Err(error) => return Ok(Line::Wrong(wrong(text, offset, &error))),
            };
            if !value.is_object() {
                let what = "it is something else".to_owned();
                return Ok(Line::Wrong(WrongLine::NotJson(offset + 1, what)));
            }
            self.cells.iter_mut().for_each(|cell| *cell = Value::Null);
            let known = self.names.len();
            let mut path = String::new();
            return Ok(match self.flatten(value, &mut path) {
                true => Line::Row {
                    grown: self.names.len() > known,
                },
                false => {
                    // What it brought is none of the log's.
                    self.names.truncate(known);
                    self.cells.truncate(known);
                    self.places.retain(|_, place| *place < known);
                    Line::Wrong(WrongLine::TooManyFields)
                }
            });
        }
    }

    /// Takes the next line in; whether all of it, `None` at the end.
    fn read_line(&mut self) -> io::Result<Option<bool>> {
        self.line.clear();
        let (mut whole, mut any) = (true, false);
        loop {
            let buffer = match self.input.fill_buf() {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                buffer => buffer?,
            };
            if buffer.is_empty() {
                break;
            }
            any = true;
            let newline = buffer.iter().position(|b| *b == b'\n');
            let taken = newline.map_or(buffer.len(), |k| k + 1);
            whole &= self.line.len() + taken <= LONGEST;
            if whole {
                self.line.extend_from_slice(&buffer[..taken]);
            }
            self.input.consume(taken);
            self.bytes += taken as u64;
            if newline.is_some() {
                break;
            }
        }
        self.number += u64::from(any);
        Ok(any.then_some(whole))
    }

    /// Puts numbers and texts where their paths have their places; false where there are too many paths.
    fn flatten(&mut self, value: Value, path: &mut String) -> bool {
        let length = path.len();
        match value {
            Value::Object(map) => map.into_iter().all(|(key, value)| {
                if length > 0 {
                    path.push('.');
                }
                path.push_str(&key);
                let goes = self.flatten(value, path);
                path.truncate(length);
                goes
            }),
            Value::Array(items) => items.into_iter().enumerate().all(|(k, value)| {
                // Into a text it always goes.
                let _ = write!(path, "[{k}]");
                let goes = self.flatten(value, path);
                path.truncate(length);
                goes
            }),
            leaf => {
                let place = match self.places.get(path.as_str()) {
                    Some(&place) => place,
                    None if self.names.len() >= super::super::columns::MOST_COLUMNS => {
                        return false;
                    }
                    None => {
                        self.places.insert(path.clone(), self.names.len());
                        self.names.push(path.clone());
                        self.cells.push(Value::Null);
                        self.names.len() - 1
                    }
                };
                self.cells[place] = leaf;
                true
            }
        }
    }
}

/// What is wrong with a line that is no JSON.
fn wrong(text: &[u8], offset: usize, error: &serde_json::Error) -> WrongLine {
    let at = error.column().max(1);
    // Python writes NaN and Infinity, which JSON has not.
    let from = text.get(at.saturating_sub(2)..).unwrap_or_default();
    let near = &from[..from.len().min(12)];
    let begins = |word: &[u8]| near.windows(word.len()).any(|w| w == word);
    if begins(b"NaN") || begins(b"Infinity") {
        return WrongLine::NotFinite(offset + at);
    }
    // Its own line and column are those of the row.
    let what = error.to_string();
    let what = what.split(" at line ").next().unwrap_or_default();
    WrongLine::NotJson(offset + at, what.to_owned())
}
