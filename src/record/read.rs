//! Recordings read back: what they were made from.

use super::MAGIC;
use super::messages::Messages;
use super::provenance::{Parts, Provenance};
use super::rrd::APPLICATION;
use rerun::external::re_log_types::StoreId;
use std::fs::File;
use std::io::Read as _;
use std::path::Path;

/// A file of recordings that this program made.
#[derive(Clone, Debug)]
pub struct Made {
    /// In the order of the file.
    pub recordings: Vec<Provenance>,
    pub(super) stores: Vec<StoreId>,
    /// Why there is less than was meant to be, or other than was written, where that is so.
    pub cut: Option<String>,
}

/// Why a file is not read as recordings of this program.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    #[error("{path}: cannot be read: {why}; `torquescope run SCENE` makes recordings")]
    Unreadable { path: String, why: String },
    #[error("{path}: is no Rerun recording; `torquescope run SCENE` makes one from a scene")]
    NoRecording { path: String },
    #[error("{path}: is cut or broken before its scene: {why}; there is nothing in it to run")]
    Cut { path: String, why: String },
    #[error(
        "{path}: was made by {by}, not by torquescope: there is no scene in it to run; `torquescope view` opens it"
    )]
    Foreign { path: String, by: String },
    #[error(
        "{path}: holds no scene: `torquescope cost` made it, or a version that stored none; there is nothing in it to run"
    )]
    NoScene { path: String },
}

/// What a file begins with tells a recording.
pub fn is_recording(path: &Path) -> bool {
    let mut magic = [0; MAGIC.len()];
    let read = File::open(path).and_then(|mut file| file.read_exact(&mut magic));
    read.is_ok() && &magic == MAGIC
}

/// The messages of a file that is a recording.
pub(super) fn open(path: &Path) -> Result<Messages, ReadError> {
    let name = || path.display().to_string();
    let unreadable = |error: std::io::Error| ReadError::Unreadable {
        path: name(),
        why: error.to_string(),
    };
    std::fs::metadata(path).map_err(unreadable)?;
    match is_recording(path) {
        true => Messages::open(path).map_err(unreadable),
        false => Err(ReadError::NoRecording { path: name() }),
    }
}

/// Reads what the recordings of a file were made from.
pub fn read(path: &Path) -> Result<Made, ReadError> {
    let name = || path.display().to_string();
    let mut messages = open(path)?;
    let mut found: Vec<(StoreId, Parts)> = Vec::new();
    while let Some((store, chunk)) = messages.next_chunk() {
        let known = found.iter().position(|(known, _)| *known == store);
        let index = known.unwrap_or_else(|| {
            found.push((store, Parts::default()));
            found.len() - 1
        });
        found[index].1.read(&chunk);
    }
    let cut = messages.flaw();
    let (own, foreign): (Vec<_>, Vec<_>) = found
        .into_iter()
        .partition(|(store, _)| store.application_id().as_str() == APPLICATION);
    if let ([], Some((other, _))) = (own.as_slice(), foreign.first()) {
        let by = format!("`{}`", other.application_id());
        return Err(ReadError::Foreign { path: name(), by });
    }
    let whole = |(store, parts): (StoreId, Parts)| Some((store, parts.whole()?));
    let (stores, recordings): (Vec<_>, Vec<_>) = own.into_iter().filter_map(whole).unzip();
    match (recordings.is_empty(), cut) {
        (true, Some(why)) => Err(ReadError::Cut { path: name(), why }),
        (true, None) => Err(ReadError::NoScene { path: name() }),
        (false, cut) => Ok(Made {
            recordings,
            stores,
            cut,
        }),
    }
}
