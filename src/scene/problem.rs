//! What is wrong with a scene: where, what, why and the remedy, all of it at once.

use super::finding::{Finding, Severity};
use std::fmt;
use std::ops::Range;

/// One thing wrong.
#[derive(Clone, Debug, PartialEq)]
struct Problem {
    at: At,
    code: &'static str,
    message: String,
}

/// Where something is that there is to say something of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum At {
    /// In an argument, as it was written.
    Argument(String),
    /// At these bytes of the source.
    File(Range<usize>),
}

impl At {
    /// Arguments first, then the file from its start.
    pub fn order(&self) -> (Option<usize>, &str) {
        match self {
            Self::Argument(argument) => (None, argument),
            Self::File(span) => (Some(span.start), ""),
        }
    }

    /// Whether both are in one place.
    pub fn is(&self, other: &Self) -> bool {
        self.order() == other.order()
    }
}

/// Everything wrong with one scene; printed in the order of the file, each with its line below.
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
    pub(crate) fn new(file: &str, source: &str) -> Self {
        Self {
            file: file.to_owned(),
            source: source.to_owned(),
            list: Vec::new(),
            more: 0,
        }
    }

    /// Notes a problem at a place of the source. The message is one line: what and why, and after its
    /// last semicolon the remedy.
    pub(crate) fn add(&mut self, span: &Range<usize>, message: impl Into<String>) {
        self.add_as("invalid", span, message);
    }

    /// The same, of a kind that has a name.
    pub(crate) fn add_as(
        &mut self,
        code: &'static str,
        span: &Range<usize>,
        message: impl Into<String>,
    ) {
        self.add_to(At::File(span.clone()), code, message.into());
    }

    /// The same at a place that may be outside the source.
    pub(super) fn add_at(&mut self, at: At, message: impl Into<String>) {
        self.add_to(at, "invalid", message.into());
    }

    fn add_to(&mut self, at: At, code: &'static str, message: String) {
        let problem = Problem {
            at: match at {
                At::File(span) => {
                    let start = span.start.min(self.source.len());
                    At::File(start..span.end.clamp(start, self.source.len()))
                }
                argument => argument,
            },
            code,
            // One line, whatever the file or its keys hold.
            message: message.replace(char::is_control, " "),
        };
        let same = |p: &Problem| p.at.is(&problem.at) && p.message == problem.message;
        if self.list.iter().any(same) {
            return;
        }
        match self.is_full() {
            false => self.list.push(problem),
            true => self.more += 1,
        }
    }

    /// Adds the problems of a text that was made from this source; `at` says where its bytes came from.
    pub(super) fn take_from(&mut self, other: Self, at: impl Fn(&Range<usize>) -> At) {
        for problem in other.list {
            let place = match &problem.at {
                At::File(span) => at(span),
                argument @ At::Argument(_) => argument.clone(),
            };
            self.add_to(place, problem.code, problem.message);
        }
        self.more += other.more;
    }

    /// Adds the problems of the same source that are not there yet.
    pub(super) fn merge(&mut self, other: Self) {
        for problem in other.list {
            self.add_to(problem.at, problem.code, problem.message);
        }
        self.more += other.more;
    }

    /// Whether further problems are only counted: their messages are not worth much thought.
    pub(super) fn is_full(&self) -> bool {
        self.list.len() >= MOST
    }

    /// The text at a place, on one line and not too long to read.
    pub(super) fn text(&self, span: &Range<usize>) -> String {
        const LONGEST: usize = 60;
        let text = self.source.get(span.clone()).unwrap_or_default();
        // A character has four bytes at most, and what is between words is cut too.
        let mut line = String::new();
        for word in text.split_whitespace() {
            if !line.is_empty() {
                line.push(' ');
            }
            line.extend(word.chars().take(LONGEST + 1));
            if line.len() > 4 * LONGEST {
                break;
            }
        }
        match line.char_indices().nth(LONGEST) {
            Some((cut, _)) => format!("{}…", &line[..cut]),
            None => line,
        }
    }

    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// The problems, those of arguments first, then in the order of the file.
    pub fn findings(&self) -> Vec<Finding> {
        let mut sorted: Vec<&Problem> = self.list.iter().collect();
        sorted.sort_by(|a, b| a.at.order().cmp(&b.at.order()));
        let finding = |problem: &Problem| {
            Finding::at(&self.file, &self.source, &problem.at).saying(
                Severity::Error,
                problem.code,
                &problem.message,
            )
        };
        sorted.into_iter().map(finding).collect()
    }
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, finding) in self.findings().into_iter().enumerate() {
            if k > 0 {
                writeln!(f)?;
            }
            write!(f, "{finding}")?;
        }
        if self.more > 0 {
            write!(f, "\n{}: and {} problems more", self.file, self.more)?;
        }
        Ok(())
    }
}

impl std::error::Error for Problems {}
