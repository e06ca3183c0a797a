//! The frames of an `.rrd` file: a head, messages one after another, a footer that says where each chunk is.
//!
//! Written here and not by the SDK's encoder, for three reasons: the footer's manifests are in one order, so that two
//! runs give the same file; every error is returned at once; and between the messages stand checksums:
//!
//! ```text
//! head | message … message | checksums of each so far | message … message | checksums of each since | … | footer
//! ```
//!
//! They are a message like any other, a chunk of no time at an entity that viewers do not show, so that every reader of the
//! format reads the file. The footer has a checksum of its own. Whenever bytes are given to the system, messages that
//! wait are behind those that are settled, and behind all of them checksums of what has none: whatever the moment at
//! which a program is killed.

use super::MAGIC;
use super::columns::{Ends, counts};
use super::destination::{Behind, Output};
use super::manifest::{Columns, Manifest, Place};
use super::stencil::{Form, Rows, Stencils};
use re_protos::common::v1alpha1::Compression as Packing;
use re_protos::log_msg::v1alpha1::log_msg::Msg;
use re_protos::log_msg::v1alpha1::{Encoding, RrdFooter};
use rerun::ComponentDescriptor;
use rerun::external::arrow::array::RecordBatch;
use rerun::external::re_chunk_store::external::re_chunk::Span;
use rerun::external::re_log_encoding::{
    Compression, CrateVersion, Encodable as _, EncodingOptions, MessageHeader, MessageKind,
    RrdManifestBuilder, StreamFooter, StreamHeader, ToTransport as _,
};
use rerun::external::re_log_types::{ArrowMsg, LogMsg, StoreId};
use rerun::log::{Chunk, ChunkId, RowId};
use std::ops::Range;

/// Writes an `.rrd` file.
pub struct Frames {
    output: Output,
    /// Bytes so far.
    bytes: u64,
    /// Where the last checksums began, and those of the messages since.
    checked: u64,
    checksums: Vec<u64>,
    /// How often there were some.
    checks: u64,
    /// What the footer will say, by store.
    manifests: Vec<(StoreId, Manifest)>,
    stencils: Stencils,
    packer: Packer,
    /// Room for a chunk, and for a message.
    stream: Vec<u8>,
    scratch: Vec<u8>,
    /// The store of the last chunk.
    store: Option<StoreId>,
    /// Messages that wait to be settled with others, empty once they are.
    waiting: Vec<Vec<u8>>,
    /// Whether the footer was written.
    ended: bool,
}

/// Bytes between checksums at least.
const CHECKED_EVERY: u64 = 1 << 20;

/// Where checksums are: no viewer shows what begins like this.
const CHECKSUMS: &str = "/__torquescope/checksum";
/// The upper half of their ids, where the SDK puts the clock.
const CHECKSUMS_OF: u128 = 2 << 64;

pub fn is_checksums(chunk: &ArrowMsg) -> bool {
    chunk.chunk_id.as_u128() >> 64 == CHECKSUMS_OF >> 64
}

impl Frames {
    pub fn new(output: Output) -> Result<Self, String> {
        let mut frames = Self {
            output,
            bytes: 0,
            checked: 0,
            checksums: Vec::new(),
            checks: 0,
            manifests: Vec::new(),
            stencils: Stencils::default(),
            packer: Packer::default(),
            stream: Vec::new(),
            scratch: Vec::new(),
            store: None,
            waiting: Vec::new(),
            ended: false,
        };
        let head = StreamHeader {
            fourcc: *MAGIC,
            version: CrateVersion::LOCAL.to_bytes(),
            options: EncodingOptions::PROTOBUF_COMPRESSED,
        };
        head.to_rrd_bytes(&mut frames.scratch).map_err(said)?;
        frames.put()?;
        Ok(frames)
    }

    pub fn output(&mut self) -> &mut Output {
        &mut self.output
    }

    pub fn message(&mut self, message: &LogMsg) -> Result<(), String> {
        encode(message, &mut self.scratch)?;
        self.put()?;
        Ok(())
    }

    /// Writes a chunk of a store, and checksums where they are due.
    pub fn chunk(&mut self, store: &StoreId, chunk: &Chunk) -> Result<(), String> {
        self.put_chunk(store, chunk)?;
        self.check(store)
    }

    fn check(&mut self, store: &StoreId) -> Result<(), String> {
        if self.store.as_ref() != Some(store) {
            self.store = Some(store.clone());
        }
        match self.bytes - self.checked >= CHECKED_EVERY {
            true => self.put_checksums(store),
            false => Ok(()),
        }
    }

    fn put_chunk(&mut self, store: &StoreId, chunk: &Chunk) -> Result<(), String> {
        self.put_built(store, chunk, None).map(|_| ())
    }

    /// Writes rows of an entity, with checksums where they are due.
    pub fn rows(&mut self, store: &StoreId, rows: &Rows<'_>) -> Result<(), String> {
        self.put_rows(store, rows, rows.form())?;
        self.check(store)
    }

    /// The message of rows that are not settled.
    pub fn packed(&mut self, store: &StoreId, rows: &Rows<'_>) -> Result<Vec<u8>, String> {
        let mut message = Vec::new();
        let form = rows.form();
        if self.through(store, rows, &form, &mut message)?.is_none() {
            let chunk = rows.chunk()?.to_arrow_msg().map_err(said)?;
            self.stencils.learn(form, rows, &chunk.batch);
            encode(&LogMsg::ArrowMsg(store.clone(), chunk), &mut message)?;
        }
        Ok(message)
    }

    /// Appends the message of rows by a stencil, where there is one; how many bytes it unpacks to.
    fn through(
        &mut self,
        store: &StoreId,
        rows: &Rows<'_>,
        form: &Form,
        into: &mut Vec<u8>,
    ) -> Result<Option<u64>, String> {
        self.stream.clear();
        if !self.stencils.write(form, rows, &mut self.stream) {
            return Ok(None);
        }
        self.packer.encode(store, rows.chunk, &self.stream, into)?;
        Ok(Some(self.stream.len() as u64))
    }

    /// Rows through a stencil, where there were others like them.
    fn put_rows(&mut self, store: &StoreId, rows: &Rows<'_>, form: Form) -> Result<(), String> {
        let like = (rows.path, form.columns());
        if let Some(exemplar) = self.manifest(store).find(like) {
            let mut message = std::mem::take(&mut self.scratch);
            let unpacked = self.through(store, rows, &form, &mut message)?;
            self.scratch = message;
            if let Some(unpacked) = unpacked {
                let place = self.put_placed(unpacked)?;
                let lines = self.manifest(store);
                lines.append_like(exemplar, rows.chunk, rows.times, place);
                return Ok(());
            }
        }
        let batch = self.put_built(store, &rows.chunk()?, Some(like))?;
        self.stencils.learn(form, rows, &batch);
        Ok(())
    }

    /// Writes a chunk that Rerun has built; `like` says what others like it have.
    fn put_built(
        &mut self,
        store: &StoreId,
        chunk: &Chunk,
        like: Option<(&str, Columns)>,
    ) -> Result<RecordBatch, String> {
        // The message and the footer's line are made of the same batch.
        let batch = chunk.to_chunk_batch().map_err(said)?;
        let message = ArrowMsg {
            chunk_id: chunk.id().as_tuid(),
            batch: batch.clone().into(),
            on_release: None,
        };
        let message = LogMsg::ArrowMsg(store.clone(), message);
        let unpacked = encode(&message, &mut self.scratch)?;
        let place = self.put_placed(unpacked)?;
        // A blueprint's chunks are looked up by nobody, and by their number they would be most of a footer.
        if store.is_recording() {
            let span = Span::from_start_len(place.start, place.length);
            let add = |lines: &mut RrdManifestBuilder| {
                lines.append(&batch, span, place.unpacked).map_err(said)
            };
            self.manifest(store).append(like, add)?;
        }
        Ok(batch.into())
    }

    fn manifest(&mut self, store: &StoreId) -> &mut Manifest {
        let known = self.manifests.iter().position(|(id, _)| id == store);
        let index = known.unwrap_or_else(|| {
            self.manifests.push((store.clone(), Manifest::default()));
            self.manifests.len() - 1
        });
        &mut self.manifests[index].1
    }

    /// Writes what is in `scratch`; where it is.
    fn put_placed(&mut self, unpacked: u64) -> Result<Place, String> {
        let head = MessageHeader::ENCODED_SIZE_BYTES as u64;
        let start = self.bytes + head;
        Ok(Place {
            start,
            length: self.put()? - head,
            unpacked,
        })
    }

    /// Gives everything to the system, and messages that are not settled, in place of others that were not.
    pub fn keep_waiting(&mut self, messages: Vec<Vec<u8>>) -> Result<(), String> {
        self.waiting = messages;
        self.settle()
    }

    /// One of those is settled by now, as part of another.
    pub fn is_settled(&mut self, waiting: usize) {
        if let Some(message) = self.waiting.get_mut(waiting) {
            *message = Vec::new();
        }
    }

    /// Gives what can still be given to the system, when no more will come.
    pub fn keep(&mut self) {
        if !self.ended {
            // It is said elsewhere why no more comes.
            let _ = self.settle();
        }
        self.output.keep();
    }

    fn settle(&mut self) -> Result<(), String> {
        let behind = self.behind()?;
        self.output.settle(behind).map_err(said)
    }

    /// What waits, and checksums of all that has none; those to come are as if there had been none.
    fn behind(&self) -> Result<Behind, String> {
        let waiting = self.waiting.iter().filter(|message| !message.is_empty());
        let mut sums = self.checksums.clone();
        let mut behind = Behind::default();
        for message in waiting {
            sums.push(crc32fast::hash(message).into());
            behind.bytes.extend_from_slice(message);
            behind.rows = true;
        }
        if let Some(store) = self.store.as_ref().filter(|_| self.output.is_partial()) {
            let end = self.bytes + behind.bytes.len() as u64;
            let chunk = checksums(self.checks + 1, self.checked..end, sums)?;
            let chunk = chunk.to_arrow_msg().map_err(said)?;
            encode(&LogMsg::ArrowMsg(store.clone(), chunk), &mut behind.bytes)?;
        }
        Ok(behind)
    }

    /// Writes the checksums of what has none.
    fn put_checksums(&mut self, store: &StoreId) -> Result<(), String> {
        let sums = std::mem::take(&mut self.checksums);
        self.checks += 1;
        let chunk = checksums(self.checks, self.checked..self.bytes, sums)?;
        self.checked = self.bytes;
        self.put_chunk(store, &chunk)
    }

    /// Writes the last checksums, in this store, and the footer, and gives the file its name; its bytes.
    pub fn finish(&mut self, store: &StoreId) -> Result<u64, String> {
        self.put_checksums(store)?;
        let manifests = std::mem::take(&mut self.manifests).into_iter();
        let manifests = manifests.filter(|(store, _)| store.is_recording());
        let manifests = manifests.map(|(store, manifest)| {
            let manifest = manifest.build(store)?;
            manifest.to_transport(()).map_err(said)
        });
        let footer = RrdFooter {
            manifests: manifests.collect::<Result<_, String>>()?,
        };
        let mut encoded = Vec::new();
        footer.to_rrd_bytes(&mut encoded).map_err(said)?;
        let end = MessageHeader {
            kind: MessageKind::End,
            len: encoded.len() as u64,
        };
        self.scratch.clear();
        end.to_rrd_bytes(&mut self.scratch).map_err(said)?;
        let start = self.bytes + self.scratch.len() as u64;
        self.scratch.extend_from_slice(&encoded);
        let last = StreamFooter::from_rrd_footer_bytes(start, &encoded);
        last.to_rrd_bytes(&mut self.scratch).map_err(said)?;
        // Nothing ever stands behind it.
        self.ended = true;
        self.output.write(&self.scratch);
        self.bytes += self.scratch.len() as u64;
        self.output.finish().map_err(said)?;
        Ok(self.bytes)
    }

    /// Writes what is in `scratch`; how many bytes.
    fn put(&mut self) -> Result<u64, String> {
        self.output.write(&self.scratch);
        let length = self.scratch.len() as u64;
        self.checksums.push(crc32fast::hash(&self.scratch).into());
        self.bytes += length;
        self.scratch.clear();
        if self.output.is_full() {
            self.settle()?;
        }
        Ok(length)
    }
}

/// A chunk of checksums: from where, to where, and one of each message between.
fn checksums(count: u64, of: Range<u64>, mut sums: Vec<u64>) -> Result<Chunk, String> {
    let mut numbers = vec![of.start, of.end];
    numbers.append(&mut sums);
    let ends = Ends::uniform(1, numbers.len());
    let column = counts(ComponentDescriptor::partial("crc32"), numbers, ends);
    let id = CHECKSUMS_OF | u128::from(count);
    let chunk = Chunk::from_native_row_ids(
        ChunkId::from_u128(id),
        CHECKSUMS.into(),
        Some(true),
        &[RowId::from_u128(id)],
        Default::default(),
        std::iter::once(column.into_arrow()).collect(),
    );
    chunk.map_err(said)
}

/// Appends a message to some bytes; how many it unpacks to.
pub fn encode(message: &LogMsg, into: &mut Vec<u8>) -> Result<u64, String> {
    let packed = message.to_transport(Compression::LZ4).map_err(said)?;
    packed.to_rrd_bytes(into).map_err(said)?;
    Ok(packed.byte_size_uncompressed())
}

fn said(error: impl std::fmt::Display) -> String {
    error.to_string()
}

/// Puts Arrow streams into messages.
#[derive(Default)]
pub struct Packer {
    packed: Vec<u8>,
}

impl Packer {
    /// Appends the message of a chunk in time, as [`encode`] would.
    fn encode(
        &mut self,
        store: &StoreId,
        chunk: u128,
        stream: &[u8],
        into: &mut Vec<u8>,
    ) -> Result<(), String> {
        let most = lz4_flex::block::get_maximum_output_size(stream.len());
        self.packed.resize(most, 0);
        let length = lz4_flex::block::compress_into(stream, &mut self.packed).map_err(said)?;
        let message = re_protos::log_msg::v1alpha1::ArrowMsg {
            store_id: Some(store.clone().into()),
            chunk_id: Some(ChunkId::from_u128(chunk).as_tuid().into()),
            compression: Packing::Lz4 as i32,
            uncompressed_size: stream.len() as u64,
            encoding: Encoding::ArrowIpc as i32,
            payload: self.packed[..length].to_vec().into(),
            is_static: Some(false),
        };
        Msg::ArrowMsg(message).to_rrd_bytes(into).map_err(said)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests;
