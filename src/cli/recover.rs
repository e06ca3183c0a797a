//! `recover FILE`: a whole recording from one that was cut off.

use super::{Told, Wrong, print};
use crate::record::{self, Destination, RecoverError, Recovered, recovered_name};
use crate::trace::short;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Make a whole recording of one that was cut off or damaged.
///
/// A run that was killed leaves NAME.partial.rrd: it opens, and lacks what tells where it ends. This writes what can be read of
/// it as NAME.rrd and takes the partial file away; where that is whole it gets its name. Where bytes are not those
/// that were written, what they belong to is left out; where it cannot be read further there may be more behind: the
/// file stays, and the exit code is 1.
#[derive(clap::Args)]
#[command(after_help = "Example: torquescope recover cone.partial.rrd")]
pub struct Arguments {
    /// The recording, an .rrd file.
    file: PathBuf,
    /// Where the whole one goes [default: of NAME.partial.rrd NAME.rrd, of others NAME-recovered.rrd].
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Replace a recording of that name.
    #[arg(long)]
    force: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report<'a> {
    recording: String,
    /// Null where the recording is whole as it is.
    recovered: Option<String>,
    flaw: Option<&'a str>,
    chunks: u64,
    rows: u64,
    /// The latest time in it, s.
    until: f64,
    /// Chunks that were left out, because their bytes are not those that were written.
    left_out: u64,
    /// Bytes of which it is not known whether they are those that were written: their checksums are lost.
    unchecked: u64,
    /// Bytes at its end that were cut within a message.
    cut: u64,
    /// Whether there may be more in it than could be read.
    more: bool,
}

pub fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let file = &arguments.file;
    let out = arguments.out.clone();
    let out = out.unwrap_or_else(|| recovered_name(file));
    if same_file::is_same_file(file, &out).unwrap_or(false) {
        let shown = out.display();
        return Err(Wrong(format!(
            "{shown} is what is recovered; choose another --out"
        ))
        .into());
    }
    let to = Destination::new(&out).replacing(arguments.force);
    let found = record::recover(file, &to).map_err(|error| match error {
        RecoverError::Record(error) => anyhow::Error::from(error),
        other => Wrong(other.to_string()).into(),
    })?;
    let all_there = found.is_all();
    let is_new = found.flaw.is_some() || found.named;
    if arguments.json {
        print::json(&Report {
            recording: file.display().to_string(),
            recovered: is_new.then(|| out.display().to_string()),
            flaw: found.flaw.as_deref(),
            chunks: found.chunks,
            rows: found.rows,
            until: found.until,
            left_out: found.left_out,
            unchecked: found.unchecked,
            cut: found.cut,
            more: found.more,
        })?;
    } else {
        print::out(&text(file, &out, &found))?;
    }
    let is_partial = file.to_string_lossy().ends_with(record::PARTIAL);
    if found.flaw.is_some() && all_there && is_partial {
        found.take_away(file)?;
    }
    match all_there {
        true => Ok(()),
        false => Err(Told(1).into()),
    }
}

fn text(file: &Path, out: &Path, found: &Recovered) -> String {
    let mut text = match &found.flaw {
        Some(flaw) => format!("{}: {flaw}\n", file.display()),
        None if found.named => format!("{}: is whole, and lacked only its name\n", file.display()),
        None => return format!("{}: is whole; there is nothing to recover", file.display()),
    };
    if found.cut > 0 {
        text += &format!(
            "its last {} bytes are part of something longer\n",
            found.cut
        );
    }
    if found.more {
        text += "there may be more in it than could be read; it stays as it is\n";
    }
    if found.left_out > 0 {
        text += &format!(
            "left out, because their bytes are not those that were written: {} of its chunks\n",
            found.left_out
        );
    }
    if found.unchecked > 0 {
        text += &format!(
            "taken as they are, because their checksums are lost: {} bytes; the file stays\n",
            found.unchecked
        );
    }
    let out = print::argument(out);
    text + &format!(
        "{out}: {} rows, up to t = {} s\nto open it: torquescope view {out}",
        found.rows,
        short(found.until)
    )
}
