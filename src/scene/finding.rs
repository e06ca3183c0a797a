//! Something said of a place in a scene, and how it is shown: a line that editors understand
//! (`file:line:column: …`), and below it the line of the scene with a caret under the place.
//!
//! ```text
//! top.toml:12:11: inertia = [1, 1, 3] cannot belong to a rigid body: 3 > 1 + 1; …
//!   12 | inertia = [1, 1, 3]
//!      |           ^^^^^^^^^
//! ```
//!
//! Drawn here and by no crate: what draws such pictures for compilers puts the place on a line of its
//! own, and takes the whole line; a scene may hold a line of megabytes, and anything in it.

use super::problem::At;
use std::fmt;
use std::ops::Range;
use unicode_width::UnicodeWidthChar;

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// There is no scene.
    Error,
    /// Legal, and probably wrong.
    Warning,
}

impl Severity {
    pub fn name(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
        }
    }
}

/// Line and column, both from 1, the column in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    pub line: usize,
    pub column: usize,
}

/// An error or a warning with its place.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Finding {
    /// As messages call it.
    pub file: String,
    /// The argument of the command line that it is about, as it was written; nothing where it is about
    /// the file.
    pub argument: Option<String>,
    /// In the file; of an argument nothing.
    pub from: Option<Place>,
    /// The first place behind it.
    pub to: Option<Place>,
    pub severity: Severity,
    /// Its kind; of a warning what `allow` calls it.
    pub code: &'static str,
    /// What, and why.
    pub message: String,
    pub remedy: Option<String>,
    /// The line, and the caret under it; nothing where it is about the file as a whole.
    pub picture: Option<String>,
}

impl Finding {
    /// About a place, with nothing said yet.
    pub(super) fn at(file: &str, source: &str, at: &At) -> Self {
        let mut finding = Self {
            file: file.to_owned(),
            argument: None,
            from: None,
            to: None,
            severity: Severity::Error,
            code: "",
            message: String::new(),
            remedy: None,
            picture: None,
        };
        match at {
            At::Argument(argument) => finding.argument = Some(argument.clone()),
            At::File(span) => {
                let span = whole_characters(source, span);
                finding.from = Some(place(source, span.start));
                finding.to = Some(place(source, span.end));
                finding.picture = (span != (0..0)).then(|| picture(source, &span));
            }
        }
        finding
    }

    /// A message is one line: what and why, and after its last semicolon the remedy.
    #[must_use]
    pub(super) fn saying(mut self, severity: Severity, code: &'static str, message: &str) -> Self {
        let (message, remedy) = match message.rsplit_once("; ") {
            Some((message, remedy)) => (message, Some(remedy.to_owned())),
            None => (message, None),
        };
        self.severity = severity;
        self.code = code;
        self.message = message.to_owned();
        self.remedy = remedy;
        self
    }

    /// All of it on one line.
    pub fn line(&self) -> String {
        let mut text = match (&self.argument, self.from) {
            (Some(argument), _) => format!("{argument}: "),
            (None, Some(Place { line, column })) => format!("{}:{line}:{column}: ", self.file),
            (None, None) => format!("{}: ", self.file),
        };
        if self.severity == Severity::Warning {
            text += "warning: ";
        }
        text += &self.message;
        if let Some(remedy) = &self.remedy {
            text += "; ";
            text += remedy;
        }
        if self.severity == Severity::Warning {
            text += &format!(" [{}]", self.code);
        }
        text
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.line())?;
        match &self.picture {
            Some(picture) => write!(f, "\n{picture}"),
            None => Ok(()),
        }
    }
}

/// The span, widened to whole characters and within the source.
fn whole_characters(source: &str, span: &Range<usize>) -> Range<usize> {
    let start = source.floor_char_boundary(span.start.min(source.len()));
    let end = source.ceil_char_boundary(span.end.clamp(start, source.len()));
    start..end
}

fn place(source: &str, offset: usize) -> Place {
    let before = &source[..offset];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    Place {
        line: before.bytes().filter(|&byte| byte == b'\n').count() + 1,
        column: before[line_start..].chars().count() + 1,
    }
}

/// Columns of a line that are shown.
const WIDTH: usize = 100;
/// And, of a longer line, columns from the place on.
const FROM_PLACE: usize = 60;

/// The line with its number, and carets under the part of the span that lies in it.
fn picture(source: &str, span: &Range<usize>) -> String {
    let start = source[..span.start].rfind('\n').map_or(0, |k| k + 1);
    let end = source[span.start..].find('\n');
    let end = end.map_or(source.len(), |k| span.start + k);
    let (before, rest) = (&source[start..span.start], &source[span.start..end]);
    let marked = &rest[..rest.len().min(span.end - span.start)];
    let after = rest[marked.len()..].trim_end();
    let marked = if after.is_empty() {
        marked.trim_end()
    } else {
        marked
    };

    let needed = Cells::of(marked.chars().chain(after.chars()), WIDTH).width;
    let before = Cells::of(before.chars().rev(), WIDTH - needed.min(FROM_PLACE));
    let room = WIDTH - before.width;
    let marked = Cells::of(marked.chars(), room);
    let after = Cells::of(after.chars(), room - marked.width);

    let indent = if before.cut { "…" } else { "" };
    let shown: String = before.text.chars().rev().collect();
    let cut = marked.cut || after.cut;
    let number = place(source, span.start).line.to_string();
    format!(
        "  {number} | {indent}{shown}{}{}{}\n  {:number_width$} | {:blank$}{}",
        marked.text,
        if marked.cut { "" } else { &after.text },
        if cut { "…" } else { "" },
        "",
        "",
        "^".repeat(marked.width.max(1)),
        number_width = number.len(),
        blank = before.width + indent.chars().count(),
    )
}

/// Characters as a terminal shows them.
struct Cells {
    text: String,
    /// Columns.
    width: usize,
    /// Whether some were left out.
    cut: bool,
}

impl Cells {
    /// As many characters as fit into `room` columns.
    fn of(characters: impl Iterator<Item = char>, room: usize) -> Self {
        /// What has no width of its own may pile up; no line needs more.
        const MOST: usize = 4 * WIDTH;
        let mut cells = Self {
            text: String::new(),
            width: 0,
            cut: false,
        };
        for (k, c) in characters.enumerate() {
            let (shown, width) = shown(c);
            if cells.width + width > room || k >= MOST {
                cells.cut = true;
                break;
            }
            cells.text += shown.unwrap_or(c.encode_utf8(&mut [0; 4]));
            cells.width += width;
        }
        cells
    }
}

/// What is shown in place of a character, and its columns. Nothing that moves a terminal's cursor
/// or turns the direction of writing gets through.
fn shown(c: char) -> (Option<&'static str>, usize) {
    match c {
        '\t' => (Some("    "), 4),
        '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{200e}' | '\u{200f}' => {
            (Some("\u{fffd}"), 1)
        }
        c if c.is_control() => (Some("\u{fffd}"), 1),
        c => (None, c.width().unwrap_or(0)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(source: &str, marked: &str) -> String {
        let start = source.find(marked).unwrap();
        let span = start..start + marked.len();
        Finding::at("f", source, &At::File(span)).picture.unwrap()
    }

    #[test]
    fn the_caret_stands_under_the_place() {
        assert_eq!(
            drawn("a = 1\nmass = -1.0 # kg\n", "-1.0"),
            "  2 | mass = -1.0 # kg\n    |        ^^^^"
        );
        // Tabs are four columns, wide characters two, accents none.
        assert_eq!(drawn("\tx = 3", "3"), "  1 |     x = 3\n    |         ^");
        assert_eq!(
            drawn("\"質量\" = 3", "3"),
            "  1 | \"質量\" = 3\n    |          ^"
        );
        assert_eq!(
            drawn("e\u{301} = 3", "3"),
            "  1 | e\u{301} = 3\n    |     ^"
        );
        assert_eq!(
            drawn("x = \"\u{1b}[2J\u{202e}\" 3", "3"),
            "  1 | x = \"\u{fffd}[2J\u{fffd}\" 3\n    |             ^"
        );
    }

    #[test]
    fn what_goes_over_several_lines_is_marked_on_its_first() {
        assert_eq!(
            drawn("p = [1,  \r\n2]\n", "[1,  \r\n2]"),
            "  1 | p = [1,\n    |     ^^^"
        );
        // The end of a file has a place too.
        let end = Finding::at("f", "a = [\n", &At::File(6..6));
        assert_eq!(end.picture.unwrap(), "  2 | \n    | ^");
        assert_eq!(end.from, Some(Place { line: 2, column: 1 }));
    }

    #[test]
    fn long_lines_are_cut_around_the_place() {
        let zeros = "0,".repeat(100_000);
        for source in [
            format!("[{zeros} X, {zeros}]"),
            format!("[{zeros} X]"),
            format!("[X, {zeros}]"),
            format!("[X{zeros}]"),
        ] {
            let text = drawn(&source, "X");
            let lines: Vec<&str> = text.lines().collect();
            let widest = lines.iter().map(|l| l.chars().count()).max().unwrap();
            assert!(widest <= 6 + WIDTH + 2, "{widest}\n{text}");
            let caret = lines[1].chars().position(|c| c == '^').unwrap();
            assert_eq!(lines[0].chars().nth(caret), Some('X'), "{text}");
        }
        let long = "x".repeat(3000);
        let text = drawn(&format!("a = {long} b"), &long);
        assert!(text.lines().all(|l| l.chars().count() <= 6 + WIDTH + 1));
        assert!(text.contains("x…\n") && text.ends_with("^^^"));
    }

    #[test]
    fn any_span_of_any_text_is_drawn() {
        let source = "é\t質\u{301}\r\n\u{0}x\n\n";
        for start in 0..=source.len() + 2 {
            for end in 0..=source.len() + 2 {
                let finding = Finding::at("f", source, &At::File(start..end));
                assert!(finding.from.unwrap().line >= 1 && finding.to.unwrap().column >= 1);
            }
        }
    }
}
