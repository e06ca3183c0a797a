//! What is wrong with a scene: where, what, why and the remedy, all of it at once.

use std::fmt;
use std::ops::Range;

/// One thing wrong, at a byte offset of the source.
#[derive(Clone, Debug, PartialEq)]
struct Problem {
    offset: usize,
    message: String,
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
        let problem = Problem {
            offset: span.start.min(self.source.len()),
            // One line, whatever the file or its keys hold.
            message: message.into().replace(char::is_control, " "),
        };
        if self.list.contains(&problem) {
            return;
        }
        match self.list.len() < MOST {
            true => self.list.push(problem),
            false => self.more += 1,
        }
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
        sorted.sort_by_key(|problem| problem.offset);
        for (k, problem) in sorted.into_iter().enumerate() {
            let (line, column) = self.position(problem.offset);
            if k > 0 {
                writeln!(f)?;
            }
            write!(f, "{}:{line}:{column}: {}", self.file, problem.message)?;
        }
        if self.more > 0 {
            write!(f, "\n{}: and {} problems more", self.file, self.more)?;
        }
        Ok(())
    }
}

impl std::error::Error for Problems {}
