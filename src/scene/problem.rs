//! What is wrong with a scene: where, what, why and the remedy, all of it at once.

use super::finding::{Finding, Severity};
use std::fmt;
use std::ops::Range;

/// One thing wrong, at a place of the source.
#[derive(Clone, Debug, PartialEq)]
struct Problem {
    span: Range<usize>,
    code: &'static str,
    message: String,
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
    pub(super) fn new(file: &str, source: &str) -> Self {
        Self {
            file: file.to_owned(),
            source: source.to_owned(),
            list: Vec::new(),
            more: 0,
        }
    }

    /// Notes a problem at a place of the source. The message is one line: what and why, and after its
    /// last semicolon the remedy.
    pub(super) fn add(&mut self, span: &Range<usize>, message: impl Into<String>) {
        self.add_as("invalid", span, message);
    }

    /// The same, of a kind that has a name.
    pub(super) fn add_as(
        &mut self,
        code: &'static str,
        span: &Range<usize>,
        message: impl Into<String>,
    ) {
        if self.is_full() {
            self.more += 1;
            return;
        }
        let start = span.start.min(self.source.len());
        let problem = Problem {
            span: start..span.end.clamp(start, self.source.len()),
            code,
            // One line, whatever the file or its keys hold.
            message: message.into().replace(char::is_control, " "),
        };
        let same = |p: &Problem| p.span.start == start && p.message == problem.message;
        if !self.list.iter().any(same) {
            self.list.push(problem);
        }
    }

    /// Whether further problems are only counted: their messages need not be made.
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

    /// The problems in the order of the file.
    pub fn findings(&self) -> Vec<Finding> {
        let mut sorted: Vec<&Problem> = self.list.iter().collect();
        sorted.sort_by_key(|problem| problem.span.start);
        let finding = |problem: &Problem| {
            let (message, remedy) = match problem.message.rsplit_once("; ") {
                Some((message, remedy)) => (message, Some(remedy.to_owned())),
                None => (problem.message.as_str(), None),
            };
            Finding {
                severity: Severity::Error,
                code: problem.code,
                message: message.to_owned(),
                remedy,
                ..Finding::at(&self.file, &self.source, &problem.span)
            }
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
