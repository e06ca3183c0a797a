//! An `.rrd` file written by whole chunks, every write error returned at once.
//!
//! The SDK's own sink hides errors until a flush and numbers rows by the clock. Here rows and
//! chunks are numbered in order, so that two runs of a scene give the same file.

use super::RecordError;
use super::columns::{Column, Times};
use super::compare::{Comparison, Verdict};
use super::destination::{Destination, Output};
use super::frames::Frames;
use super::stencil::Rows;
use rerun::external::re_log_types::{
    BlueprintActivationCommand, LogMsg, SetStoreInfo, StoreId, StoreInfo, StoreKind, StoreSource,
};
use rerun::log::{Chunk, ChunkId, RowId};
use rerun::{AsComponents, ComponentIdentifier, EntityPath, TimePoint};
use std::collections::{BTreeSet, HashMap};
use std::time::{Duration, Instant};

/// What recordings of this program call themselves; blueprints apply to recordings of one name.
pub const APPLICATION: &str = "torquescope";

/// A recording being written.
pub struct RrdFile {
    /// What errors call it.
    name: String,
    frames: Frames,
    recording: StoreId,
    blueprint: StoreId,
    next: u64,
    rows: u64,
    /// Whether any were ever written ahead of time.
    ahead: bool,
    /// What the recording is held against.
    comparison: Option<Comparison>,
    /// Messages that are not settled, while they are gathered.
    tail: Option<Tail>,
    /// Which of them waits for which columns to be settled.
    waiting: HashMap<Columns, usize>,
    /// When everything was last in the file, and how long that may be ago.
    kept_up: Instant,
    keeps_up: Duration,
    /// How long it took to put everything there.
    took: Duration,
}

/// Of many bodies much waits: writing it ahead of time takes at most a tenth of the time.
const SELDOM: u32 = 10;

/// Messages that stand behind those that are settled until others take their place.
#[derive(Default)]
struct Tail {
    messages: Vec<Vec<u8>>,
    waiting: HashMap<Columns, usize>,
    /// Its numbers are its own: what is settled is numbered as if it had never been.
    next: u64,
}

/// Rows of the same columns wait together: a chunk that is settled holds all of them that did.
type Columns = (String, BTreeSet<ComponentIdentifier>);

/// Which of a file's two stores a chunk belongs to.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Store {
    Blueprint,
    Recording,
}

/// Upper halves of ids, where the SDK puts the clock: constant here.
const SETTLED: u128 = 1 << 64;
const UNSETTLED: u128 = 3 << 64;

impl RrdFile {
    /// Creates the file, so that what cannot be written is known before anything is computed.
    pub fn create(to: &Destination, recording_id: &str) -> Result<Self, RecordError> {
        let name = to.path.display().to_string();
        let mut file = Self::into_output(name, Output::open(to)?, recording_id)?;
        file.keeps_up = to.keeps_up;
        Ok(file)
    }

    /// Writes to nowhere, to learn how many bytes a recording takes.
    pub fn nowhere(recording_id: &str) -> Result<Self, RecordError> {
        let name = "a recording to nowhere".to_owned();
        Self::into_output(name, Output::nowhere(), recording_id)
    }

    fn into_output(name: String, output: Output, recording_id: &str) -> Result<Self, RecordError> {
        let frames = Frames::new(output).map_err(|why| RecordError::Create {
            path: name.clone(),
            why,
        })?;
        let blueprint_id = format!("{recording_id}-blueprint");
        let mut file = Self {
            name,
            frames,
            recording: StoreId::new(StoreKind::Recording, APPLICATION, recording_id),
            blueprint: StoreId::new(StoreKind::Blueprint, APPLICATION, blueprint_id),
            next: 1,
            rows: 0,
            ahead: false,
            comparison: None,
            tail: None,
            waiting: HashMap::new(),
            kept_up: Instant::now(),
            keeps_up: Duration::MAX,
            took: Duration::ZERO,
        };
        file.open(Store::Blueprint)?;
        Ok(file)
    }

    /// Ends the blueprint, which makes it the one shown, and begins the recording proper.
    pub fn begin_recording(&mut self) -> Result<(), RecordError> {
        self.message(&LogMsg::BlueprintActivationCommand(
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
        path: impl AsRef<str>,
        times: &Times,
        columns: Vec<Column>,
    ) -> Result<(), RecordError> {
        if times.is_empty() {
            return Ok(());
        }
        let rows = Rows {
            path: path.as_ref(),
            chunk: self.number(),
            first: self.numbers(times.len()),
            times,
            columns: &columns,
        };
        let done = match self.tail.is_some() {
            true => self.wait(&rows),
            false => self.settle(&rows),
        };
        done.map_err(|error| self.stopped(&error))
    }

    /// Adds rows to the tail.
    fn wait(&mut self, rows: &Rows<'_>) -> Result<(), String> {
        self.ahead = true;
        let message = self.frames.packed(&self.recording, rows)?;
        if let Some(tail) = &mut self.tail {
            tail.add(message, columns(rows));
        }
        Ok(())
    }

    fn settle(&mut self, rows: &Rows<'_>) -> Result<(), String> {
        if !self.waiting.is_empty()
            && let Some(waiting) = self.waiting.remove(&columns(rows))
        {
            self.frames.is_settled(waiting);
        }
        self.rows += rows.times.len() as u64;
        if let Some(comparison) = &mut self.comparison {
            comparison.take(&rows.chunk()?);
        }
        self.frames.rows(&self.recording, rows)
    }

    /// Writes the footer and everything buffered, and gives the file its name; returns the bytes of the
    /// file and its rows in time.
    pub fn finish(mut self) -> Result<(u64, u64), RecordError> {
        let done = self.frames.finish(&self.recording.clone());
        let bytes = done.map_err(|error| self.stopped(&error))?;
        Ok((bytes, self.rows))
    }

    /// Whether rows have waited in memory longer than they may.
    pub fn is_behind(&self) -> bool {
        let often = match self.keeps_up.is_zero() {
            // At once, whatever it costs.
            true => Duration::ZERO,
            false => self.keeps_up.max(SELDOM * self.took),
        };
        self.kept_up.elapsed() >= often
    }

    /// From here on what is written is not settled: it will be written again.
    pub fn begin_tail(&mut self) {
        self.kept_up = Instant::now();
        self.tail = Some(Tail::default());
    }

    /// Gives all that was settled, and what was not, to the system.
    pub fn end_tail(&mut self) -> Result<(), RecordError> {
        let tail = self.tail.take().unwrap_or_default();
        self.waiting = tail.waiting;
        let done = self.frames.keep_waiting(tail.messages);
        self.took = self.kept_up.elapsed();
        self.kept_up = Instant::now();
        done.map_err(|error| self.stopped(&error))
    }

    fn partial(&mut self) -> Option<String> {
        let partial = self.frames.output().partial();
        partial.map(|path| path.display().to_string())
    }

    fn stopped(&mut self, error: &dyn std::fmt::Display) -> RecordError {
        RecordError::Write {
            path: self.name.clone(),
            why: error.to_string(),
            partial: self.partial(),
        }
    }

    fn open(&mut self, store: Store) -> Result<(), RecordError> {
        let source = StoreSource::Other(format!("torquescope {}", env!("CARGO_PKG_VERSION")));
        let info = StoreInfo::new(self.id(store), source);
        let row_id = self.row_id();
        self.message(&LogMsg::SetStoreInfo(SetStoreInfo {
            row_id: row_id.as_tuid(),
            info,
        }))
    }

    fn chunk<E: std::fmt::Display>(
        &mut self,
        store: Store,
        chunk: Result<Chunk, E>,
    ) -> Result<(), RecordError> {
        let chunk = chunk.map_err(|error| self.stopped(&error))?;
        let id = self.id(store);
        if store == Store::Recording {
            if !chunk.is_static() {
                self.rows += chunk.num_rows() as u64;
            }
            if let Some(comparison) = &mut self.comparison {
                comparison.take(&chunk);
            }
        }
        let done = self.frames.chunk(&id, &chunk);
        done.map_err(|error| self.stopped(&error))
    }

    fn message(&mut self, message: &LogMsg) -> Result<(), RecordError> {
        let done = self.frames.message(message);
        done.map_err(|error| self.stopped(&error))
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

    fn number(&mut self) -> u128 {
        self.numbers(1)
    }

    /// The first of so many numbers.
    fn numbers(&mut self, count: usize) -> u128 {
        let (half, next) = match &mut self.tail {
            Some(tail) => (UNSETTLED, &mut tail.next),
            None => (SETTLED, &mut self.next),
        };
        let first = *next + 1;
        *next += count as u64;
        half | u128::from(first)
    }
}

impl Tail {
    fn add(&mut self, message: Vec<u8>, columns: Columns) {
        self.waiting.insert(columns, self.messages.len());
        self.messages.push(message);
    }
}

fn columns(rows: &Rows<'_>) -> Columns {
    let components = rows
        .columns
        .iter()
        .map(|column| column.descriptor.component);
    (rows.path.to_owned(), components.collect())
}

impl Drop for RrdFile {
    /// What is there of a recording is kept when it ends before its time; an empty one is not.
    fn drop(&mut self) {
        match self.rows > 0 || self.ahead {
            true => self.frames.keep(),
            false => self.frames.output().discard(),
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::columns::{Ends, numbers};
    use super::super::destination::partial_name;
    use super::super::messages::Messages;
    use super::*;
    use crate::math::draw;
    use crate::trace;
    use rerun::ComponentDescriptor;
    use std::ops::Range;
    use std::path::Path;

    /// Writes rows of a number that cannot be packed, a thousand a chunk.
    pub fn fill(file: &mut RrdFile, path: &str, rows: Range<u64>) {
        let rows: Vec<u64> = rows.collect();
        for rows in rows.chunks(1000) {
            let mut times = Times::default();
            for &step in rows {
                let time = step as f64 * 1e-3;
                times.push(trace::Instant { time, step });
            }
            let values = rows.iter().map(|&step| draw::unit(3, step)).collect();
            let ends = Ends::uniform(rows.len(), 1);
            let column = numbers(ComponentDescriptor::partial("x"), values, ends);
            file.columns(path, &times, vec![column]).unwrap();
        }
    }

    /// The rows of each entity in what a killed program would leave, and what is wrong with it.
    fn now(path: &Path) -> (HashMap<String, u64>, Messages) {
        let mut messages = Messages::open(&partial_name(path)).unwrap().going_on();
        let mut rows = HashMap::new();
        while let Some((_, chunk)) = messages.next_chunk() {
            *rows.entry(chunk.entity_path().to_string()).or_default() += chunk.num_rows() as u64;
        }
        (rows, messages)
    }

    #[test]
    fn what_waits_stays_in_the_file_while_more_is_settled() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        let mut file = RrdFile::create(&to, "a").unwrap();
        file.begin_recording().unwrap();
        fill(&mut file, "/fast", 0..1000);
        file.begin_tail();
        fill(&mut file, "/slow", 0..3);
        fill(&mut file, "/other", 0..4);
        file.end_tail().unwrap();
        // Some megabytes, in which nothing more is written ahead of time.
        fill(&mut file, "/fast", 1000..200_000);
        let (rows, messages) = now(&to.path);
        assert_eq!((rows["/slow"], rows["/other"]), (3, 4));
        assert!(rows["/fast"] > 100_000, "{rows:?}");
        assert_eq!((messages.unread(), messages.damaged()), (0, [].as_slice()));
        // Once they are settled they are there once.
        fill(&mut file, "/slow", 0..5);
        fill(&mut file, "/fast", 200_000..300_000);
        let (rows, _) = now(&to.path);
        assert_eq!((rows["/slow"], rows["/other"]), (5, 4));
        // And nothing of it when all is settled.
        fill(&mut file, "/other", 0..6);
        file.finish().unwrap();
        let mut same =
            RrdFile::create(&Destination::new(folder.path().join("b.rrd")), "a").unwrap();
        same.begin_recording().unwrap();
        fill(&mut same, "/fast", 0..200_000);
        fill(&mut same, "/slow", 0..5);
        fill(&mut same, "/fast", 200_000..300_000);
        fill(&mut same, "/other", 0..6);
        same.finish().unwrap();
        let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
        assert!(read("a.rrd") == read("b.rrd"));
    }

    /// What is in the file has checksums, however little it is and whether it waits or not.
    #[test]
    fn no_changed_byte_of_what_a_killed_program_leaves_passes() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        let mut file = RrdFile::create(&to, "a").unwrap();
        file.begin_recording().unwrap();
        fill(&mut file, "/settled", 0..100);
        file.begin_tail();
        fill(&mut file, "/waiting", 0..100);
        file.end_tail().unwrap();
        let partial = partial_name(&to.path);
        let bytes = std::fs::read(&partial).unwrap();
        let mut messages = Messages::open(&partial).unwrap();
        while messages.next().is_some() {}
        // The last checksums themselves have none.
        let end = messages.place().start;
        assert!(end > 2000 && messages.unread() == 0);
        for at in (12..end as usize).step_by(7) {
            let mut changed = bytes.clone();
            changed[at] ^= 1 << (at % 8);
            std::fs::write(&partial, &changed).unwrap();
            let (_, messages) = now(&to.path);
            let told = !messages.damaged().is_empty() || messages.is_stopped();
            assert!(told || messages.unread() > 0, "{at}");
        }
    }
}
