//! What is wrong with a scene: where, what, why and the remedy, all of it at once.

use std::fmt;
use std::ops::Range;

/// One thing wrong.
#[derive(Clone, Debug, PartialEq)]
struct Problem {
    place: Place,
    /// Where what it is about ends, if it is in the source.
    end: usize,
    message: String,
}

/// Where a problem is.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Place {
    /// In an argument, as it was written.
    Argument(String),
    /// At a byte offset of the source.
    File(usize),
}

/// Everything wrong with one scene; printed one line each, in the order of the file.
#[derive(Clone, Debug)]
pub struct Problems {
    file: String,
    source: String,
    list: Vec<Problem>,
    /// Problems beyond [`MOST`].
    more: usize,
}

/// Problems told one by one; a file with more is wrong as a whole.
const MOST: usize = 50;

impl Problems {
    pub(super) fn new(file: &str, source: &str) -> Self {
        Self {
            file: file.to_owned(),
            source: source.to_owned(),
            list: Vec::new(),
            more: 0,
        }
    }

    /// Notes a problem at a place of the source. The message is one line.
    pub(super) fn add(&mut self, span: &Range<usize>, message: impl Into<String>) {
        self.add_to(Place::File(span.start), span.end, message);
    }

    /// The same at a place that may be outside the source.
    pub(super) fn add_at(&mut self, place: Place, message: impl Into<String>) {
        self.add_to(place, 0, message);
    }

    fn add_to(&mut self, place: Place, end: usize, message: impl Into<String>) {
        let problem = Problem {
            end,
            place: match place {
                Place::File(offset) => Place::File(offset.min(self.source.len())),
                argument => argument,
            },
            // One line, whatever the file or its keys hold.
            message: message.into().replace(char::is_control, " "),
        };
        let same =
            |other: &Problem| (&other.place, &other.message) == (&problem.place, &problem.message);
        if self.list.iter().any(same) {
            return;
        }
        match self.list.len() < MOST {
            true => self.list.push(problem),
            false => self.more += 1,
        }
    }

    /// Adds the problems of a text that was made from this source; `place` says where its bytes came
    /// from.
    pub(super) fn take_from(&mut self, other: Self, place: impl Fn(Range<usize>) -> Place) {
        for problem in other.list {
            let place = match problem.place {
                Place::File(start) => place(start..problem.end),
                argument => argument,
            };
            self.add_at(place, problem.message);
        }
        self.more += other.more;
    }

    /// Adds the problems of the same source that are not there yet.
    pub(super) fn merge(&mut self, other: Self) {
        for problem in other.list {
            self.add_at(problem.place, problem.message);
        }
        self.more += other.more;
    }

    /// The text at a place, on one line and not too long to read.
    pub(super) fn text(&self, span: &Range<usize>) -> String {
        const LONGEST: usize = 60;
        let text = self.source.get(span.clone()).unwrap_or_default();
        let words: Vec<&str> = text.split_whitespace().collect();
        let line = words.join(" ");
        match line.char_indices().nth(LONGEST) {
            Some((cut, _)) => format!("{}…", &line[..cut]),
            None => line,
        }
    }

    /// Whether what comes now is only counted: its message is not worth much thought.
    pub(super) fn is_full(&self) -> bool {
        self.list.len() >= MOST
    }

    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Line and column, both from 1, the column in characters.
    fn position(&self, offset: usize) -> (usize, usize) {
        let mut start = offset;
        while !self.source.is_char_boundary(start) {
            start -= 1;
        }
        let before = &self.source[..start];
        let line = before.matches('\n').count() + 1;
        let column = before.chars().rev().take_while(|&c| c != '\n').count() + 1;
        (line, column)
    }
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut sorted: Vec<&Problem> = self.list.iter().collect();
        sorted.sort_by_key(|problem| &problem.place);
        for (k, problem) in sorted.into_iter().enumerate() {
            if k > 0 {
                writeln!(f)?;
            }
            match &problem.place {
                Place::Argument(argument) => write!(f, "{argument}: ")?,
                Place::File(offset) => {
                    let (line, column) = self.position(*offset);
                    write!(f, "{}:{line}:{column}: ", self.file)?;
                }
            }
            write!(f, "{}", problem.message)?;
        }
        if self.more > 0 {
            write!(f, "\n{}: and {} problems more", self.file, self.more)?;
        }
        Ok(())
    }
}

impl std::error::Error for Problems {}
