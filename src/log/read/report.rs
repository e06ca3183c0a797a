//! What a reader has to say of a log: rows that it left out, and what about the others is worth knowing.

use crate::log::columns::Columns;
use std::fmt;

/// Why a row is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Bad {
    /// Not as many fields as the header has.
    Fields,
    /// Not an object in JSON.
    NotJson,
    /// Longer than any row.
    TooLong,
    /// A field that is no number.
    NotANumber,
    /// NaN, or beyond the largest number.
    NotFinite,
    /// No time, no body, or a part of a quantity alone.
    Missing,
    /// Its time goes back.
    TimeBack,
    /// Its attitude is no attitude: four zeros.
    ZeroQuaternion,
}

impl Bad {
    pub const ALL: [Self; 8] = [
        Self::Fields,
        Self::NotJson,
        Self::TooLong,
        Self::NotANumber,
        Self::NotFinite,
        Self::Missing,
        Self::TimeBack,
        Self::ZeroQuaternion,
    ];

    /// Rows of a kind, told in their number: `3 rows with …`.
    pub fn about(self) -> &'static str {
        match self {
            Self::Fields => "with another number of fields than the header",
            Self::NotJson => "that are no JSON object",
            Self::TooLong => "longer than any row of numbers",
            Self::NotANumber => "with something that is no number",
            Self::NotFinite => "with a number that is not finite",
            Self::Missing => "with something missing",
            Self::TimeBack => "whose time goes back",
            Self::ZeroQuaternion => "whose quaternion is zero",
        }
    }

    pub fn remedy(self) -> &'static str {
        match self {
            Self::Fields => "write every row with all columns; a field with a comma goes in quotes",
            Self::NotJson => "write one object a line",
            Self::TooLong => "write a line a row",
            Self::NotANumber => "write digits with a point, such as -1.5e-3",
            Self::NotFinite => "look at what the engine did just before the first of them",
            Self::Missing => "write all parts of a quantity in a row, or none",
            Self::TimeBack => {
                "write rows in the order of time; where runs follow each other, add a column `run`"
            }
            Self::ZeroQuaternion => "no rotation is (0, 0, 0, 0): log after the body is made",
        }
    }
}

/// A row that was left out.
#[derive(Clone, Debug, PartialEq)]
pub struct BadRow {
    pub kind: Bad,
    /// From 1.
    pub line: u64,
    /// From 1, with its name.
    pub column: Option<(usize, String)>,
    pub what: String,
}

impl BadRow {
    pub fn told(&self, file: &str) -> String {
        match &self.column {
            Some((number, name)) => {
                format!(
                    "{file}:{}: column {number} ({name}): {}",
                    self.line, self.what
                )
            }
            None => format!("{file}:{}: {}", self.line, self.what),
        }
    }
}

/// Something that is worth knowing and leaves no row out.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// Its kind, for programs.
    pub code: &'static str,
    pub body: Option<String>,
    /// From 1; where it begins.
    pub line: Option<u64>,
    pub what: String,
    pub remedy: Option<String>,
}

impl Note {
    pub(in crate::log) fn new(code: &'static str, what: impl Into<String>) -> Self {
        Self {
            code,
            body: None,
            line: None,
            what: what.into(),
            remedy: None,
        }
    }

    pub(in crate::log) fn of(self, body: &str) -> Self {
        Self {
            body: Some(body.to_owned()),
            ..self
        }
    }

    pub(in crate::log) fn at(self, line: u64) -> Self {
        Self {
            line: Some(line),
            ..self
        }
    }

    pub(in crate::log) fn remedy(self, remedy: impl Into<String>) -> Self {
        Self {
            remedy: Some(remedy.into()),
            ..self
        }
    }

    pub fn told(&self, file: &str) -> String {
        let mut text = match self.line {
            Some(line) => format!("{file}:{line}: "),
            None => format!("{file}: "),
        };
        if let Some(body) = &self.body {
            text += &format!("{body}: ");
        }
        text += &self.what;
        if let Some(remedy) = &self.remedy {
            text += &format!("; {remedy}");
        }
        text
    }
}

/// All that a reader says of a log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    pub file: String,
    /// What was read as what.
    pub columns: Columns,
    /// Rows that were read.
    pub rows: u64,
    pub(super) bad: [u64; Bad::ALL.len()],
    /// The first of each kind.
    pub told: Vec<BadRow>,
    pub notes: Vec<Note>,
}

impl Report {
    /// Rows of a kind that are told one by one.
    pub const TOLD: u64 = 5;

    pub(super) fn bad(&mut self, row: BadRow) {
        let count = &mut self.bad[row.kind as usize];
        *count += 1;
        if *count <= Self::TOLD {
            self.told.push(row);
        }
    }

    /// How many rows of a kind were left out.
    pub fn count(&self, kind: Bad) -> u64 {
        self.bad[kind as usize]
    }

    /// How many were left out in all.
    pub fn left_out(&self) -> u64 {
        self.bad.iter().sum()
    }
}

/// Bad rows by kind with the first of each, then the notes; nothing where there is nothing to say.
impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut lines = Vec::new();
        for kind in Bad::ALL.into_iter().filter(|kind| self.count(*kind) > 0) {
            for row in self.told.iter().filter(|row| row.kind == kind) {
                lines.push(row.told(&self.file));
            }
            let (count, all) = (self.count(kind), self.rows + self.left_out());
            lines.push(format!(
                "{}: {count} of {all} rows {}: left out; {}",
                self.file,
                kind.about(),
                kind.remedy()
            ));
        }
        lines.extend(self.notes.iter().map(|note| note.told(&self.file)));
        f.write_str(&lines.join("\n"))
    }
}
