//! An `.rrd` file written by whole chunks, every write error returned at once.
//!
//! The SDK's own sink hides errors until a flush and numbers rows by the clock. Here rows and
//! chunks are numbered in order, so that two runs of a scene give the same data.

use super::columns::{Column, Times};
use super::compare::{Comparison, Verdict};
use super::{MAGIC, RecordError};
use rerun::external::re_log_encoding::{CrateVersion, Encoder, EncodingOptions};
use rerun::external::re_log_types::{
    BlueprintActivationCommand, LogMsg, SetStoreInfo, StoreId, StoreInfo, StoreKind, StoreSource,
};
use rerun::log::{Chunk, ChunkId, RowId};
use rerun::{AsComponents, EntityPath, TimePoint};
use std::fs::File;
use std::io::{BufWriter, Read as _, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// What recordings of this program call themselves; blueprints apply to recordings of one name.
pub const APPLICATION: &str = "torquescope";

/// A recording being written.
pub struct RrdFile {
    path: PathBuf,
    encoder: Encoder<Counted>,
    bytes: Arc<AtomicU64>,
    recording: StoreId,
    blueprint: StoreId,
    next: u64,
    rows: u64,
    /// What the recording is held against.
    comparison: Option<Comparison>,
}

/// Which of a file's two stores a chunk belongs to.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Store {
    Blueprint,
    Recording,
}

impl RrdFile {
    /// Creates the file, so that what cannot be written is known before anything is computed.
    /// An earlier recording of that name is replaced; anything else there is left alone.
    pub fn create(path: &Path, recording_id: &str) -> Result<Self, RecordError> {
        must_not_be_lost(path)?;
        let fail = |why: String| RecordError::Create {
            path: path.display().to_string(),
            why,
        };
        let file = File::create(path).map_err(|error| fail(error.to_string()))?;
        let writer = BufWriter::with_capacity(1 << 20, file);
        Self::into_writer(path, Box::new(writer), recording_id)
    }

    /// Writes to nowhere, to learn how many bytes a recording takes.
    pub fn nowhere(recording_id: &str) -> Result<Self, RecordError> {
        let path = Path::new("a recording to nowhere");
        Self::into_writer(path, Box::new(std::io::sink()), recording_id)
    }

    fn into_writer(
        path: &Path,
        inner: Box<dyn Write + Send>,
        recording_id: &str,
    ) -> Result<Self, RecordError> {
        let bytes = Arc::new(AtomicU64::new(0));
        let writer = Counted {
            inner,
            bytes: Arc::clone(&bytes),
        };
        let options = EncodingOptions::PROTOBUF_COMPRESSED;
        let encoder = Encoder::new_eager(CrateVersion::LOCAL, options, writer);
        let encoder = encoder.map_err(|error| RecordError::Create {
            path: path.display().to_string(),
            why: error.to_string(),
        })?;
        let blueprint_id = format!("{recording_id}-blueprint");
        let mut file = Self {
            path: path.to_owned(),
            encoder,
            bytes,
            recording: StoreId::new(StoreKind::Recording, APPLICATION, recording_id),
            blueprint: StoreId::new(StoreKind::Blueprint, APPLICATION, blueprint_id),
            next: 1,
            rows: 0,
            comparison: None,
        };
        file.open(Store::Blueprint)?;
        Ok(file)
    }

    /// Ends the blueprint, which makes it the one shown, and begins the recording proper.
    pub fn begin_recording(&mut self) -> Result<(), RecordError> {
        self.append(&LogMsg::BlueprintActivationCommand(
            BlueprintActivationCommand {
                blueprint_id: self.blueprint.clone(),
                make_active: true,
                make_default: true,
            },
        ))?;
        self.open(Store::Recording)
    }

    /// Begins another recording, under the same blueprint.
    pub fn next_recording(&mut self, recording_id: &str) -> Result<(), RecordError> {
        self.recording = StoreId::new(StoreKind::Recording, APPLICATION, recording_id);
        self.open(Store::Recording)
    }

    /// Holds the recordings against others from here on.
    pub fn compare_with(&mut self, comparison: Comparison) {
        self.comparison = Some(comparison);
    }

    /// What that came to, of the recording that ends here.
    pub fn verdict(&mut self) -> Option<Verdict> {
        self.comparison.as_mut().map(Comparison::end)
    }

    /// Writes what is not part of what is compared.
    pub fn remark(
        &mut self,
        path: impl Into<EntityPath>,
        at: TimePoint,
        part: &dyn AsComponents,
    ) -> Result<(), RecordError> {
        let comparison = self.comparison.take();
        let done = self.row(Store::Recording, path, at, &[part]);
        self.comparison = comparison;
        done
    }

    /// Writes what does not change with time.
    pub fn statics(
        &mut self,
        path: impl Into<EntityPath>,
        parts: &[&dyn AsComponents],
    ) -> Result<(), RecordError> {
        self.row(Store::Recording, path, TimePoint::default(), parts)
    }

    /// Writes one row.
    pub fn row(
        &mut self,
        store: Store,
        path: impl Into<EntityPath>,
        at: TimePoint,
        parts: &[&dyn AsComponents],
    ) -> Result<(), RecordError> {
        self.rows += u64::from(store == Store::Recording && !at.is_static());
        let (chunk, row) = (self.chunk_id(), self.row_id());
        let batches = parts.iter().flat_map(|part| part.as_serialized_batches());
        let chunk = Chunk::builder_with_id(chunk, path)
            .with_serialized_batches(row, at, batches)
            .build();
        self.chunk(store, chunk)
    }

    /// Writes columns: a row per time.
    pub fn columns(
        &mut self,
        path: impl Into<EntityPath>,
        times: &Times,
        columns: Vec<Column>,
    ) -> Result<(), RecordError> {
        if times.is_empty() {
            return Ok(());
        }
        let id = self.chunk_id();
        let rows: Vec<RowId> = (0..times.len()).map(|_| self.row_id()).collect();
        let timelines = times.columns();
        let chunk = Chunk::from_native_row_ids(
            id,
            path.into(),
            Some(true),
            &rows,
            timelines
                .into_iter()
                .map(|c| (*c.timeline().name(), c))
                .collect(),
            columns.into_iter().collect(),
        );
        self.rows += times.len() as u64;
        self.chunk(Store::Recording, chunk)
    }

    /// Writes the footer and everything buffered; returns the bytes of the file and its rows in time.
    pub fn finish(mut self) -> Result<(u64, u64), RecordError> {
        let done = self
            .encoder
            .finish()
            .and_then(|()| self.encoder.flush_blocking());
        done.map_err(|error| self.stopped(&error))?;
        Ok((self.bytes.load(Ordering::Relaxed), self.rows))
    }

    fn stopped(&self, error: &dyn std::fmt::Display) -> RecordError {
        RecordError::Write {
            path: self.path.display().to_string(),
            why: error.to_string(),
        }
    }

    fn open(&mut self, store: Store) -> Result<(), RecordError> {
        let source = StoreSource::Other(format!("torquescope {}", env!("CARGO_PKG_VERSION")));
        let info = StoreInfo::new(self.id(store), source);
        let row_id = self.row_id();
        self.append(&LogMsg::SetStoreInfo(SetStoreInfo {
            row_id: row_id.as_tuid(),
            info,
        }))
    }

    fn chunk<E: std::fmt::Display>(
        &mut self,
        store: Store,
        chunk: Result<Chunk, E>,
    ) -> Result<(), RecordError> {
        let fail = |error: &dyn std::fmt::Display| self.stopped(error);
        let chunk = chunk.map_err(|error| fail(&error))?;
        let message = chunk.to_arrow_msg().map_err(|error| fail(&error))?;
        if let (Some(comparison), Store::Recording) = (&mut self.comparison, store) {
            comparison.take(&chunk);
        }
        self.append(&LogMsg::ArrowMsg(self.id(store), message))
    }

    fn append(&mut self, message: &LogMsg) -> Result<(), RecordError> {
        match self.encoder.append(message) {
            Ok(_) => Ok(()),
            Err(error) => Err(self.stopped(&error)),
        }
    }

    fn id(&self, store: Store) -> StoreId {
        match store {
            Store::Blueprint => self.blueprint.clone(),
            Store::Recording => self.recording.clone(),
        }
    }

    fn row_id(&mut self) -> RowId {
        RowId::from_u128(self.number())
    }

    fn chunk_id(&mut self) -> ChunkId {
        ChunkId::from_u128(self.number())
    }

    /// The next number. The upper half is where the SDK puts the clock: constant here.
    fn number(&mut self) -> u128 {
        self.next += 1;
        (1 << 64) | u128::from(self.next)
    }
}

/// Counts the bytes that go through.
struct Counted {
    inner: Box<dyn Write + Send>,
    bytes: Arc<AtomicU64>,
}

impl Write for Counted {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.bytes.fetch_add(written as u64, Ordering::Relaxed);
        Ok(written)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.inner.flush()
    }
}

/// A file that is there and is no recording was put there for something else.
fn must_not_be_lost(path: &Path) -> Result<(), RecordError> {
    let is_file = std::fs::metadata(path).is_ok_and(|data| data.is_file() && data.len() > 0);
    let mut magic = [0; MAGIC.len()];
    let mut read = || File::open(path).and_then(|mut file| file.read_exact(&mut magic));
    if is_file && (read().is_err() || &magic != MAGIC) {
        return Err(RecordError::Occupied {
            path: path.display().to_string(),
        });
    }
    Ok(())
}
