//! Printing: tables, and a pipe that closes early is no error.

use crate::record::Destination;
use comfy_table::{CellAlignment, ContentArrangement, Table, presets};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::Write;
use std::time::Duration;

/// Prints to stdout. A reader that has seen enough (`| head`) is not a failure.
pub fn out(text: &str) -> anyhow::Result<()> {
    let mut stdout = std::io::stdout().lock();
    let written = stdout
        .write_all(text.as_bytes())
        .and_then(|()| stdout.write_all(b"\n"))
        .and_then(|()| stdout.flush());
    match written {
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(anyhow::anyhow!(
            "standard output: cannot be written: {error}; send it elsewhere"
        )),
        Ok(()) => Ok(()),
    }
}

/// Prints a line to stderr; where there is nobody to read it, that is no failure.
pub fn err(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// Says what a killed run has left that is about to be written over.
pub fn written_over(to: &Destination) {
    if let Some(path) = to.writes_over() {
        err(&format!(
            "{} was left by a run that was killed; --force writes over it",
            path.display()
        ));
    }
}

pub fn json(value: &impl serde::Serialize) -> anyhow::Result<()> {
    out(&serde_json::to_string_pretty(value)?)
}

/// A table framed by lines.
pub fn table(header: &[&str], rows: Vec<Vec<String>>) -> String {
    framed(header, rows, ContentArrangement::Disabled)
}

/// A table of texts, wrapped to be read.
pub fn wrapped(header: &[&str], rows: Vec<Vec<String>>) -> String {
    framed(header, rows, ContentArrangement::Dynamic)
}

/// Columns of characters that a text is wrapped to.
const WIDTH: u16 = 110;

fn framed(header: &[&str], rows: Vec<Vec<String>>, arrangement: ContentArrangement) -> String {
    let mut table = Table::new();
    table
        .load_preset(presets::UTF8_BORDERS_ONLY)
        .set_content_arrangement(arrangement)
        .set_width(WIDTH)
        .set_header(header.to_vec());
    for row in rows {
        table.add_row(row);
    }
    for column in table.column_iter_mut() {
        column.set_cell_alignment(CellAlignment::Left);
    }
    table.to_string()
}

/// Says on a terminal what is being waited for, and how long.
pub fn spinner(message: &'static str) -> ProgressBar {
    let spinner = ProgressBar::new_spinner().with_message(message);
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}, {elapsed}") {
        spinner.set_style(style);
    }
    spinner.enable_steady_tick(Duration::from_millis(200));
    spinner
}

/// How much of a file has been read; without an end where that is not known. Silent where there is no terminal.
pub fn bytes(length: Option<u64>) -> ProgressBar {
    let bar = length.map_or_else(ProgressBar::no_length, ProgressBar::new);
    let template = match length {
        Some(_) => "{wide_bar} {bytes} of {total_bytes}, {eta} left",
        None => "{spinner} {bytes} read",
    };
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar
}

/// A path as one types it to a shell.
pub fn argument(path: &std::path::Path) -> String {
    let text = path.display().to_string();
    let plain = |c: char| c.is_alphanumeric() || "-_./".contains(c);
    match text.chars().all(plain) {
        true => text,
        false => format!("'{}'", text.replace('\'', r"'\''")),
    }
}
