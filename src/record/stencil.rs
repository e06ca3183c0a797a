//! Chunks that differ only in their numbers and texts, written without being built each time.
//!
//! What stands in a message of a chunk is an Arrow stream:
//!
//! ```text
//! schema (the chunk's id and entity are in it) | head of the batch (how much there is of what) | buffers | end
//! ```
//!
//! Of chunks with the same columns all but these is the same, byte for byte. So the first of a form is built and packed by Rerun and
//! Arrow, of the bytes of the second a stencil is cut, and all later ones go through it: a few copies in place of a hundred
//! microseconds. A stencil that does not give its own chunk again, to the last byte, is thrown away.

use super::columns::{Column, SIM_TIME, STEP, Times, Values};
use rerun::ComponentDescriptor;
use rerun::external::arrow;
use rerun::external::arrow::datatypes::Schema;
use rerun::external::arrow::ipc::writer::StreamWriter;
use rerun::external::arrow::ipc::{Message, RecordBatch, root_as_message};
use rerun::log::{Chunk, ChunkId, RowId};
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

/// Rows that go into a chunk: what is said of one entity at some instants.
pub struct Rows<'a> {
    pub path: &'a str,
    pub chunk: u128,
    /// Number of the first row; the others count on.
    pub first: u128,
    pub times: &'a Times,
    pub columns: &'a [Column],
}

/// What two chunks that go through one stencil have in common.
#[derive(Clone, PartialEq, Eq, Hash)]
pub struct Form {
    /// Bytes of the entity's path.
    path: usize,
    columns: u64,
    kinds: Vec<(ComponentDescriptor, u8, i32)>,
}

/// The stencils that were cut, by form.
#[derive(Default)]
pub struct Stencils(HashMap<Form, Known>);

enum Known {
    /// Of a form that comes but once none is cut.
    Once,
    Cut(Box<Stencil>),
    Never,
}

/// Forms that are remembered at most: some megabytes.
const MOST: usize = 1024;

struct Stencil {
    schema: Vec<u8>,
    /// Where in it the chunk's id begins, and the entity's path.
    id_at: usize,
    path_at: usize,
    batch: Vec<u8>,
    /// Where in it numbers are: bytes of all buffers, rows, how long each array is, where each buffer is.
    length_at: usize,
    rows_at: usize,
    arrays_at: usize,
    buffers_at: usize,
    arrays: Vec<Held>,
    end: Vec<u8>,
}

/// An array of a batch, those of lists before their items.
struct Held {
    counts: Counts,
    buffers: Vec<Holds>,
}

/// How long an array is.
#[derive(Clone, Copy)]
enum Counts {
    Rows,
    /// Values of a column, or strips.
    Items(usize),
    /// Points of strips.
    Points(usize),
    /// Numbers of vectors or points.
    Numbers(usize),
}

#[derive(Clone, Copy)]
enum Holds {
    /// Which items are not there: none, of which nothing is said.
    Missing,
    Ids,
    Nanoseconds,
    Steps,
    Ends(usize),
    EndsOfStrips(usize),
    EndsOfTexts(usize),
    Values(usize),
}

impl Rows<'_> {
    /// What they have in common with others.
    pub fn form(&self) -> Form {
        let mut hasher = DefaultHasher::new();
        for column in self.columns {
            (&column.descriptor, column.values.len() == 0).hash(&mut hasher);
        }
        // The schema says whether times never go back.
        self.times.nanoseconds().is_sorted().hash(&mut hasher);
        self.times.steps().is_sorted().hash(&mut hasher);
        let kinds = self.columns.iter().map(|column| {
            let (kind, width) = match &column.values {
                Values::Numbers(_) => (0, 1),
                Values::Counts(_) => (1, 1),
                Values::Vectors(_, width) => (2, *width),
                Values::Strips(..) => (3, 3),
                Values::Texts(_) => (4, 1),
            };
            (column.descriptor.clone(), kind, width)
        });
        Form {
            path: self.path.len(),
            columns: hasher.finish(),
            kinds: kinds.collect(),
        }
    }

    /// The chunk, as Rerun builds it.
    pub fn chunk(&self) -> Result<Chunk, String> {
        let ids = (0..self.times.len() as u128).map(|k| RowId::from_u128(self.first + k));
        let ids: Vec<RowId> = ids.collect();
        let timelines = self.times.columns();
        let columns = self.columns.iter().cloned().map(Column::into_arrow);
        let chunk = Chunk::from_native_row_ids(
            ChunkId::from_u128(self.chunk),
            self.path.into(),
            Some(true),
            &ids,
            timelines
                .into_iter()
                .map(|column| (*column.timeline().name(), column))
                .collect(),
            columns.collect(),
        );
        chunk.map_err(|error| error.to_string())
    }
}

impl Form {
    /// Which columns there are, which of them are empty, and whether times go back, as a hash: chunks of one entity that have
    /// the same are alike in the footer.
    pub fn columns(&self) -> u64 {
        self.columns
    }
}

impl Stencils {
    /// Writes the Arrow stream of a chunk; whether there is a stencil for it.
    pub fn write(&self, form: &Form, rows: &Rows<'_>, into: &mut Vec<u8>) -> bool {
        let Some(Known::Cut(stencil)) = self.0.get(form) else {
            return false;
        };
        stencil.write(rows, into);
        true
    }

    /// Learns from a chunk that Rerun has built: the second of a form gives a stencil.
    pub fn learn(&mut self, form: Form, rows: &Rows<'_>, batch: &arrow::array::RecordBatch) {
        if self.0.len() >= MOST {
            self.0.clear();
        }
        match self.0.entry(form) {
            Entry::Vacant(entry) => {
                entry.insert(Known::Once);
            }
            Entry::Occupied(mut entry) => {
                if matches!(entry.get(), Known::Once) {
                    let stencil = cut(rows, batch).map(|stencil| Known::Cut(Box::new(stencil)));
                    entry.insert(stencil.unwrap_or(Known::Never));
                }
            }
        }
    }
}

/// A stencil that gives its own chunk again.
fn cut(rows: &Rows<'_>, batch: &arrow::array::RecordBatch) -> Option<Stencil> {
    let stream = packed(batch)?;
    let stencil = Stencil::cut(&stream, rows, batch.schema_ref())?;
    let mut again = Vec::with_capacity(stream.len());
    stencil.write(rows, &mut again);
    (again == stream).then_some(stencil)
}

/// The Arrow stream of a batch, as Rerun packs it.
fn packed(batch: &arrow::array::RecordBatch) -> Option<Vec<u8>> {
    let mut stream = Vec::new();
    let mut writer = StreamWriter::try_new(&mut stream, batch.schema_ref()).ok()?;
    writer.write(batch).ok()?;
    writer.finish().ok()?;
    drop(writer);
    Some(stream)
}

impl Stencil {
    fn cut(stream: &[u8], rows: &Rows<'_>, schema: &Schema) -> Option<Self> {
        let (first, rest) = message(stream)?;
        let head = root_as_message(&first[FRAME..]).ok()?;
        let told = head.header_as_schema()?.custom_metadata()?;
        let at = |part: &[u8], whole: &[u8]| part.as_ptr() as usize - whole.as_ptr() as usize;
        let place = |key: &str, expected: &str| {
            let entry = told.iter().find(|entry| entry.key() == Some(key))?;
            let value = entry.value().filter(|value| *value == expected)?;
            Some(at(value.as_bytes(), first))
        };
        let id_at = place("rerun:id", &ChunkId::from_u128(rows.chunk).to_string())?;
        let path_at = place("rerun:entity_path", rows.path)?;
        let (second, rest) = message(rest)?;
        let head = root_as_message(&second[FRAME..]).ok()?;
        let batch = head.header_as_record_batch()?;
        let (whole, inner) = (head._tab, batch._tab);
        let length_field = whole.vtable().get(Message::VT_BODYLENGTH);
        let rows_field = inner.vtable().get(RecordBatch::VT_LENGTH);
        let length = usize::try_from(head.bodyLength()).ok()?;
        Some(Self {
            schema: first.to_vec(),
            id_at,
            path_at,
            length_at: FRAME + whole.loc() + usize::from(length_field),
            rows_at: FRAME + inner.loc() + usize::from(rows_field),
            arrays_at: at(batch.nodes()?.bytes(), second),
            buffers_at: at(batch.buffers()?.bytes(), second),
            batch: second.to_vec(),
            arrays: held(schema, rows)?,
            end: rest.get(length..)?.to_vec(),
        })
    }

    fn write(&self, rows: &Rows<'_>, into: &mut Vec<u8>) {
        let schema = into.len();
        into.extend_from_slice(&self.schema);
        let id = ChunkId::from_u128(rows.chunk).to_string();
        put(into, schema + self.id_at, id.as_bytes());
        put(into, schema + self.path_at, rows.path.as_bytes());
        let batch = into.len();
        into.extend_from_slice(&self.batch);
        put_count(into, batch + self.rows_at, rows.times.len());
        let body = into.len();
        let mut buffer_at = batch + self.buffers_at;
        for (k, array) in self.arrays.iter().enumerate() {
            let count = array.counts.of(rows);
            // How many, and how many of them are not there.
            put_count(into, batch + self.arrays_at + 16 * k, count);
            for holds in &array.buffers {
                let start = into.len();
                holds.write(rows, count, into);
                put_count(into, buffer_at, start - body);
                let length = into.len() - start;
                put_count(into, buffer_at + 8, length);
                buffer_at += 16;
                into.resize(start + length.next_multiple_of(ALIGNED), 0);
            }
        }
        let length = into.len() - body;
        put_count(into, batch + self.length_at, length);
        into.extend_from_slice(&self.end);
    }
}

/// Bytes of which every buffer begins at a multiple.
const ALIGNED: usize = 64;

fn put(into: &mut [u8], at: usize, bytes: &[u8]) {
    if let Some(place) = into.get_mut(at..at + bytes.len()) {
        place.copy_from_slice(bytes);
    }
}

fn put_count(into: &mut [u8], at: usize, count: usize) {
    put(into, at, &(count as u64).to_le_bytes());
}

impl Counts {
    fn of(self, rows: &Rows<'_>) -> usize {
        let values = |k: usize| &rows.columns[k].values;
        match self {
            Self::Rows => rows.times.len(),
            Self::Items(k) => values(k).len(),
            Self::Points(k) => values(k).numbers() / 3,
            Self::Numbers(k) => values(k).numbers(),
        }
    }
}

impl Holds {
    fn write(self, rows: &Rows<'_>, count: usize, into: &mut Vec<u8>) {
        let column = |k: usize| &rows.columns[k];
        match self {
            Self::Missing => {}
            Self::Ids => {
                for k in 0..count as u128 {
                    into.extend_from_slice(&(rows.first + k).to_be_bytes());
                }
            }
            Self::Nanoseconds => into.extend_from_slice(bytes(rows.times.nanoseconds())),
            Self::Steps => into.extend_from_slice(bytes(rows.times.steps())),
            Self::Ends(k) => into.extend_from_slice(bytes(column(k).ends.offsets())),
            Self::EndsOfStrips(k) => {
                if let Values::Strips(_, ends) = &column(k).values {
                    into.extend_from_slice(bytes(ends.offsets()));
                }
            }
            Self::EndsOfTexts(k) => {
                if let Values::Texts(texts) = &column(k).values {
                    let mut end = 0;
                    into.extend_from_slice(&i32::to_le_bytes(end));
                    for text in texts {
                        end += text.len() as i32;
                        into.extend_from_slice(&end.to_le_bytes());
                    }
                }
            }
            Self::Values(k) => match &column(k).values {
                Values::Numbers(values) => into.extend_from_slice(bytes(values)),
                Values::Counts(values) => into.extend_from_slice(bytes(values)),
                Values::Vectors(values, _) | Values::Strips(values, _) => {
                    into.extend_from_slice(bytes(values));
                }
                Values::Texts(texts) => {
                    for text in texts {
                        into.extend_from_slice(text.as_bytes());
                    }
                }
            },
        }
    }
}

/// As Arrow holds them: the lowest byte first.
fn bytes<T: bytemuck::NoUninit>(values: &[T]) -> &[u8] {
    const { assert!(cfg!(target_endian = "little")) };
    bytemuck::cast_slice(values)
}

/// Bytes of a message before its own: what goes on, and how many.
const FRAME: usize = 8;

/// The head of the first message of a stream, frame and all, and what comes after it.
fn message(stream: &[u8]) -> Option<(&[u8], &[u8])> {
    let marker = stream.get(..4)?;
    let length = u32::from_le_bytes(stream.get(4..FRAME)?.try_into().ok()?);
    (marker == [0xff; 4]).then_some(())?;
    stream.split_at_checked(FRAME + length as usize)
}

/// The arrays of a batch and what their buffers hold, in their order.
fn held(schema: &Schema, rows: &Rows<'_>) -> Option<Vec<Held>> {
    let mut all = Vec::new();
    let mut push = |counts, holds| {
        all.push(Held {
            counts,
            buffers: std::iter::once(Holds::Missing).chain(holds).collect(),
        });
    };
    for field in schema.fields() {
        let metadata = field.metadata();
        match metadata.get("rerun:kind").map(String::as_str) {
            Some("control") => push(Counts::Rows, vec![Holds::Ids]),
            Some("index") => {
                let times = match metadata.get("rerun:index_name")?.as_str() {
                    SIM_TIME => Holds::Nanoseconds,
                    STEP => Holds::Steps,
                    _ => return None,
                };
                push(Counts::Rows, vec![times]);
            }
            Some("data") => {
                let component = metadata.get("rerun:component")?;
                let named = |column: &Column| column.descriptor.component.as_str() == component;
                let k = rows.columns.iter().position(named)?;
                push(Counts::Rows, vec![Holds::Ends(k)]);
                match &rows.columns[k].values {
                    Values::Numbers(_) | Values::Counts(_) => {
                        push(Counts::Items(k), vec![Holds::Values(k)]);
                    }
                    Values::Vectors(..) => {
                        push(Counts::Items(k), vec![]);
                        push(Counts::Numbers(k), vec![Holds::Values(k)]);
                    }
                    Values::Strips(..) => {
                        push(Counts::Items(k), vec![Holds::EndsOfStrips(k)]);
                        push(Counts::Points(k), vec![]);
                        push(Counts::Numbers(k), vec![Holds::Values(k)]);
                    }
                    Values::Texts(_) => {
                        push(
                            Counts::Items(k),
                            vec![Holds::EndsOfTexts(k), Holds::Values(k)],
                        );
                    }
                }
            }
            _ => return None,
        }
    }
    Some(all)
}
