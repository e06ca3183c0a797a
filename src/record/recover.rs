//! Makes a recording whole again that was cut off, or in which bytes were changed.

use super::destination::{Destination, Output, PARTIAL, is_at, partial_name};
use super::frames::{Frames, is_checksums};
use super::messages::{Messages, quietly};
use super::{MAGIC, RecordError, is_recording};
use rerun::external::re_log_types::{LogMsg, StoreId};
use rerun::log::Chunk;
use std::fs::{File, TryLockError};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// What a recording was made whole from.
#[derive(Debug)]
pub struct Recovered {
    /// What was wrong with it; nothing, where it is whole and nothing was written.
    pub flaw: Option<String>,
    /// Whether all it lacked was its name, which it has got.
    pub named: bool,
    /// Chunks and rows of its recordings, and their latest time, s.
    pub chunks: u64,
    pub rows: u64,
    pub until: f64,
    /// Messages that were left out, of whichever store: their bytes are not those that were written.
    pub left_out: u64,
    /// Bytes that have lost their checksums, so that it is not known whether they are those that were written.
    pub unchecked: u64,
    /// Bytes at its end that are no message.
    pub cut: u64,
    /// Whether there may be more in it: it could not be read beyond some place, or what is cut is longer than what one
    /// write leaves.
    pub more: bool,
    /// Nobody writes where it was read.
    held: File,
}

impl Recovered {
    /// Whether all that was recorded is in the new one, as it was written.
    pub fn is_all(&self) -> bool {
        self.left_out == 0 && self.unchecked == 0 && !self.more
    }

    /// Takes what was recovered away, unless it has become another's.
    pub fn take_away(self, path: &Path) -> std::io::Result<()> {
        match is_at(&self.held, path) {
            true => std::fs::remove_file(path),
            false => Ok(()),
        }
    }
}

/// A message is seldom longer, and what was being written when a program was killed is at most one.
const ONE_WRITE: u64 = 1 << 20;

/// Why there is nothing to be had.
#[derive(Debug, thiserror::Error)]
pub enum RecoverError {
    #[error("{path}: cannot be read: {why}")]
    Unreadable { path: String, why: String },
    #[error("{path}: is no Rerun recording")]
    NoRecording { path: String },
    #[error(
        "{path}: there is nothing in it yet that was simulated; the next run to that name writes over it"
    )]
    Empty { path: String },
    #[error(
        "{path}: nothing that was simulated can be read of it: {why}; it stays as it is, and `run --force` writes over it"
    )]
    Lost { path: String, why: String },
    #[error("{path}: is being written by another torquescope, which will make it whole")]
    Busy { path: String },
    #[error(transparent)]
    Record(#[from] RecordError),
}

/// The name that a recovered recording gets where none is said.
pub fn recovered_name(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    match name.strip_suffix(PARTIAL) {
        Some(whole) => path.with_file_name(format!("{whole}.rrd")),
        None => {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            path.with_file_name(format!("{stem}-recovered.rrd"))
        }
    }
}

/// What there is under the name of a recording that is not whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Left {
    /// No file, or nothing in it that was simulated.
    Nothing,
    /// What can be recovered, or what is not known to be nothing.
    Rows,
    /// No recording.
    Other,
}

/// Reads no further than to the first row.
pub fn left(path: &Path) -> Left {
    let Ok(data) = std::fs::metadata(path) else {
        return Left::Nothing;
    };
    // The first bytes of a head are the beginning of none.
    let short = data.len() < MAGIC.len() as u64;
    if short && std::fs::read(path).is_ok_and(|bytes| MAGIC.starts_with(&bytes)) {
        return Left::Nothing;
    }
    if !is_recording(path) {
        return Left::Other;
    }
    let Ok(messages) = Messages::open(path) else {
        return Left::Rows;
    };
    let mut messages = messages.going_on();
    while let Some((_, chunk)) = messages.next_chunk() {
        if last_time(&chunk).is_some() {
            return Left::Rows;
        }
    }
    let whole = messages.flaw().is_none();
    match whole || !messages.damaged().is_empty() || is_more(&messages) {
        true => Left::Rows,
        false => Left::Nothing,
    }
}

/// Writes what can be read of a recording to another place, whole; one that only lacks its name gets it.
pub fn recover(path: &Path, to: &Destination) -> Result<Recovered, RecoverError> {
    let shown = || path.display().to_string();
    let unreadable = |error: std::io::Error| RecoverError::Unreadable {
        path: shown(),
        why: error.to_string(),
    };
    let held = File::open(path).map_err(unreadable)?;
    if !is_recording(path) {
        return Err(RecoverError::NoRecording { path: shown() });
    }
    if let Err(TryLockError::WouldBlock) = held.try_lock_shared() {
        return Err(RecoverError::Busy { path: shown() });
    }
    let mut messages = Messages::open(path).map_err(unreadable)?.going_on();
    let (mut found, damaged) = survey(&mut messages, held);
    let Some(flaw) = &found.flaw else {
        if path.to_string_lossy().ends_with(PARTIAL) {
            to.give(path)?;
            found.named = true;
        }
        return Ok(found);
    };
    if found.rows == 0 {
        return Err(match damaged.is_empty() && !found.more {
            true => RecoverError::Empty { path: shown() },
            false => RecoverError::Lost {
                path: shown(),
                why: flaw.clone(),
            },
        });
    }
    let to = Destination {
        meanwhile: Some(partial_name(&recovered_name(&to.path))),
        ..to.clone()
    };
    let again = Messages::open(path).map_err(unreadable)?.going_on();
    let stopped = |why: String| RecordError::Write {
        path: to.path.display().to_string(),
        why,
        partial: None,
    };
    let mut frames = Frames::new(Output::open(&to)?).map_err(stopped)?;
    let passed_over = copy(again, &damaged, &mut frames).map_err(|why| {
        // All of it is still where it was.
        frames.output().discard();
        stopped(why)
    })?;
    found.left_out = damaged.len() as u64 + passed_over;
    Ok(found)
}

/// What is in a file, and which of its bytes are not those that were written.
fn survey(messages: &mut Messages, held: File) -> (Recovered, Vec<Range<u64>>) {
    let mut found = Recovered {
        flaw: None,
        named: false,
        chunks: 0,
        rows: 0,
        until: 0.0,
        left_out: 0,
        unchecked: 0,
        cut: 0,
        more: false,
        held,
    };
    while let Some((_, chunk)) = messages.next_chunk() {
        found.chunks += 1;
        if let Some(last) = last_time(&chunk) {
            found.rows += chunk.num_rows() as u64;
            found.until = found.until.max(last);
        }
    }
    found.flaw = messages.flaw();
    found.unchecked = messages.without_checksums();
    found.cut = messages.unread();
    found.more = is_more(messages);
    (found, messages.damaged().to_vec())
}

fn is_more(messages: &Messages) -> bool {
    messages.is_stopped() || messages.unread() > ONE_WRITE
}

/// The latest time in a chunk of what was simulated, s.
fn last_time(chunk: &Chunk) -> Option<f64> {
    let times = chunk.timelines().get(&"sim_time".into())?;
    let last = times.times_raw().iter().copied().max()?;
    Some(last as f64 / 1e9)
}

/// Copies messages but those that touch damaged bytes; how many others are none.
fn copy(
    mut messages: Messages,
    damaged: &[Range<u64>],
    frames: &mut Frames,
) -> Result<u64, String> {
    let mut passed_over = 0;
    let mut last: Option<StoreId> = None;
    while let Some(message) = messages.next() {
        let place = messages.place();
        let touches = |range: &Range<u64>| place.start < range.end && range.start < place.end;
        match message {
            LogMsg::ArrowMsg(_, message) if is_checksums(&message) => {}
            // What opens a store says little, and without it nothing else can be read.
            LogMsg::ArrowMsg(..) if damaged.iter().any(touches) => {}
            LogMsg::ArrowMsg(store, message) => {
                match quietly(|| Chunk::from_arrow_msg(&message)) {
                    Ok(Ok(chunk)) => frames.chunk(&store, &chunk)?,
                    _ => passed_over += 1,
                }
                last = Some(store);
            }
            message => frames.message(&message)?,
        }
    }
    let store = last.ok_or("there is nothing left that is undamaged")?;
    frames.finish(&store)?;
    Ok(passed_over)
}
