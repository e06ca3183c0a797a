//! Makes a recording whole again that was cut off, or in which bytes were changed.

use super::destination::{Destination, Output, partial_name};
use super::frames::{Frames, is_checksums};
use super::messages::{Messages, quietly};
use super::{RecordError, is_recording};
use rerun::external::re_log_types::{LogMsg, StoreId};
use rerun::log::Chunk;
use std::fs::{File, TryLockError};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// What a recording was made whole from.
#[derive(Clone, Debug)]
pub struct Recovered {
    /// What was wrong with it; nothing, where it is whole and nothing was written.
    pub flaw: Option<String>,
    /// Chunks and rows of its recordings, and their latest time, s.
    pub chunks: u64,
    pub rows: u64,
    pub until: f64,
    /// Messages that were left out, of whichever store: their bytes are not those that were written.
    pub left_out: u64,
    /// Bytes at its end that are no message.
    pub cut: u64,
    /// Whether there may be more in it: it could not be read beyond some place, or what is cut is longer than what one
    /// write leaves.
    pub more: bool,
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
    #[error("{path}: there is nothing in it yet that was simulated")]
    Empty { path: String },
    #[error("{path}: is being written by another torquescope, which will make it whole")]
    Busy { path: String },
    #[error(transparent)]
    Record(#[from] RecordError),
}

/// The name that a recovered recording gets where none is said.
pub fn recovered_name(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    match name.strip_suffix(".partial.rrd") {
        Some(whole) => path.with_file_name(format!("{whole}.rrd")),
        None => {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            path.with_file_name(format!("{stem}-recovered.rrd"))
        }
    }
}

/// Writes what can be read of a recording to another place, whole.
pub fn recover(path: &Path, to: &Destination) -> Result<Recovered, RecoverError> {
    let shown = || path.display().to_string();
    let unreadable = |error: std::io::Error| RecoverError::Unreadable {
        path: shown(),
        why: error.to_string(),
    };
    let lock = File::open(path).map_err(unreadable)?;
    if !is_recording(path) {
        return Err(RecoverError::NoRecording { path: shown() });
    }
    if let Err(TryLockError::WouldBlock) = lock.try_lock_shared() {
        return Err(RecoverError::Busy { path: shown() });
    }
    let mut messages = Messages::open(path).map_err(unreadable)?.going_on();
    let (mut found, damaged) = survey(&mut messages);
    if found.flaw.is_none() {
        return Ok(found);
    }
    if found.rows == 0 {
        return Err(RecoverError::Empty { path: shown() });
    }
    let to = Destination {
        meanwhile: Some(partial_name(&recovered_name(&to.path))),
        ..to.clone()
    };
    let again = Messages::open(path).map_err(unreadable)?.going_on();
    let output = Output::open(&to)?;
    found.left_out = damaged.len() as u64;
    copy(again, &damaged, output).map_err(|why| RecordError::Write {
        path: to.path.display().to_string(),
        why,
        partial: None,
    })?;
    Ok(found)
}

/// What is in a file, and which of its bytes are not those that were written.
fn survey(messages: &mut Messages) -> (Recovered, Vec<Range<u64>>) {
    let mut found = Recovered {
        flaw: None,
        chunks: 0,
        rows: 0,
        until: 0.0,
        left_out: 0,
        cut: 0,
        more: false,
    };
    while let Some((_, chunk)) = messages.next_chunk() {
        found.chunks += 1;
        let Some(times) = chunk.timelines().get(&"sim_time".into()) else {
            continue;
        };
        found.rows += chunk.num_rows() as u64;
        let last = times.times_raw().iter().copied().max().unwrap_or(0);
        found.until = found.until.max(last as f64 / 1e9);
    }
    found.flaw = messages.flaw();
    found.cut = messages.unread();
    found.more = messages.is_stopped() || found.cut > ONE_WRITE;
    (found, messages.damaged().to_vec())
}

/// Copies messages but those that touch damaged bytes.
fn copy(mut messages: Messages, damaged: &[Range<u64>], output: Output) -> Result<(), String> {
    let mut frames = Frames::new(output)?;
    let mut last: Option<StoreId> = None;
    while let Some(message) = messages.next() {
        let place = messages.place();
        let touches = |range: &Range<u64>| place.start < range.end && range.start < place.end;
        match message {
            LogMsg::ArrowMsg(_, message) if is_checksums(&message) => {}
            // What opens a store says little, and without it nothing else can be read.
            LogMsg::ArrowMsg(..) if damaged.iter().any(touches) => {}
            LogMsg::ArrowMsg(store, message) => {
                let chunk = quietly(|| Chunk::from_arrow_msg(&message))?;
                let chunk = chunk.map_err(|error| error.to_string())?;
                frames.chunk(&store, &chunk)?;
                last = Some(store);
            }
            message => frames.message(&message)?,
        }
    }
    let store = last.ok_or("there is nothing left that is undamaged")?;
    frames.finish(&store)?;
    Ok(())
}
