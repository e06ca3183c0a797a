//! Chunks that differ only in their numbers, written without being built each time.
//!
//! What stands in a message of a chunk is an Arrow stream:
//!
//! ```text
//! schema (the chunk's id and entity are in it) | head of the batch | row ids, times, offsets, values | end
//! ```
//!
//! Of chunks that have the same columns, as many rows and as many values, all of it but ids, entity, times, offsets and values
//! is the same, byte for byte. So the first of a form is built and packed by Rerun and Arrow, and of their bytes a stencil is
//! cut, through which all later ones go: a few copies in place of a hundred microseconds. A stencil that does not give its own
//! chunk again, to the last byte, is thrown away.

use super::columns::{Column, SIM_TIME, STEP, Times, Values};
use rerun::ComponentDescriptor;
use rerun::external::arrow::array::RecordBatch;
use rerun::external::arrow::datatypes::{DataType, Schema};
use rerun::external::arrow::ipc::root_as_message;
use rerun::external::arrow::ipc::writer::StreamWriter;
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
    path: usize,
    rows: usize,
    /// Whether the times never go back: that is told in the schema.
    sorted: [bool; 2],
    columns: Vec<ColumnForm>,
}

#[derive(Clone, PartialEq, Eq, Hash)]
struct ColumnForm {
    descriptor: ComponentDescriptor,
    /// Which kind, and how many components a value has.
    kind: (u8, i32),
    values: usize,
    strips: usize,
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
    body: Vec<Piece>,
    end: Vec<u8>,
}

struct Piece {
    holds: Holds,
    /// Bytes with what pads it.
    length: usize,
}

#[derive(Clone, PartialEq)]
enum Holds {
    /// Which values there are: all.
    Same(Vec<u8>),
    Ids,
    Nanoseconds,
    Steps,
    Offsets(usize),
    Strips(usize),
    Values(usize),
}

impl Rows<'_> {
    /// What they have in common with others; `None` where values are of any length.
    pub fn form(&self) -> Option<Form> {
        let columns = self.columns.iter().map(|column| {
            let (kind, values, strips) = match &column.values {
                Values::Numbers(values) => ((0, 1), values.len(), 0),
                Values::Counts(values) => ((1, 1), values.len(), 0),
                Values::Vectors(values, width) => ((2, *width), values.len(), 0),
                Values::Strips(values, ends) => ((3, 3), values.len(), ends.offsets().len()),
                Values::Texts(_) => return None,
            };
            Some(ColumnForm {
                descriptor: column.descriptor.clone(),
                kind,
                values,
                strips,
            })
        });
        Some(Form {
            path: self.path.len(),
            rows: self.times.len(),
            sorted: [
                self.times.nanoseconds().is_sorted(),
                self.times.steps().is_sorted(),
            ],
            columns: columns.collect::<Option<_>>()?,
        })
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
    /// Which columns there are, and which of them are empty, as a hash: what the footer tells of a chunk.
    pub fn columns(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        for column in &self.columns {
            (&column.descriptor, column.values == 0).hash(&mut hasher);
        }
        self.sorted.hash(&mut hasher);
        hasher.finish()
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
    pub fn learn(&mut self, form: Form, rows: &Rows<'_>, batch: &RecordBatch) {
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
fn cut(rows: &Rows<'_>, batch: &RecordBatch) -> Option<Stencil> {
    let stream = packed(batch)?;
    let stencil = Stencil::cut(&stream, rows, batch.schema_ref())?;
    let mut again = Vec::with_capacity(stream.len());
    stencil.write(rows, &mut again);
    (again == stream).then_some(stencil)
}

/// The Arrow stream of a batch, as Rerun packs it.
fn packed(batch: &RecordBatch) -> Option<Vec<u8>> {
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
        let place = |key: &str, expected: &str| {
            let entry = told.iter().find(|entry| entry.key() == Some(key))?;
            let value = entry.value().filter(|value| *value == expected)?;
            Some(value.as_ptr() as usize - first.as_ptr() as usize)
        };
        let id_at = place("rerun:id", &ChunkId::from_u128(rows.chunk).to_string())?;
        let path_at = place("rerun:entity_path", rows.path)?;
        let (second, rest) = message(rest)?;
        let head = root_as_message(&second[FRAME..]).ok()?;
        let length = usize::try_from(head.bodyLength()).ok()?;
        let (body, end) = rest.split_at_checked(length)?;
        let buffers = head.header_as_record_batch()?.buffers()?;
        let held = held(schema, rows)?;
        if held.len() != buffers.len() {
            return None;
        }
        let starts: Vec<usize> = buffers.iter().map(|b| b.offset() as usize).collect();
        let mut pieces = Vec::new();
        for (k, holds) in held.into_iter().enumerate() {
            let next = starts.get(k + 1).copied().unwrap_or(length);
            let bytes = body.get(starts[k]..starts[k] + buffers.get(k).length() as usize)?;
            let holds = match holds {
                Holds::Same(_) => Holds::Same(bytes.to_vec()),
                other => other,
            };
            pieces.push(Piece {
                holds,
                length: next.checked_sub(starts[k])?,
            });
        }
        Some(Self {
            schema: first.to_vec(),
            id_at,
            path_at,
            batch: second.to_vec(),
            body: pieces,
            end: end.to_vec(),
        })
    }

    fn write(&self, rows: &Rows<'_>, into: &mut Vec<u8>) {
        let start = into.len();
        into.extend_from_slice(&self.schema);
        let mut put = |at: usize, text: &str| {
            let at = start + at;
            into[at..at + text.len()].copy_from_slice(text.as_bytes());
        };
        put(self.id_at, &ChunkId::from_u128(rows.chunk).to_string());
        put(self.path_at, rows.path);
        into.extend_from_slice(&self.batch);
        for piece in &self.body {
            let start = into.len();
            piece.holds.write(rows, into);
            into.resize(start + piece.length, 0);
        }
        into.extend_from_slice(&self.end);
    }
}

impl Holds {
    fn write(&self, rows: &Rows<'_>, into: &mut Vec<u8>) {
        let column = |k: usize| &rows.columns[k];
        match self {
            Self::Same(bytes) => into.extend_from_slice(bytes),
            Self::Ids => {
                let ids = (0..rows.times.len() as u128).map(|k| rows.first + k);
                into.extend(ids.flat_map(u128::to_be_bytes));
            }
            Self::Nanoseconds => into.extend_from_slice(bytes(rows.times.nanoseconds())),
            Self::Steps => into.extend_from_slice(bytes(rows.times.steps())),
            Self::Offsets(k) => into.extend_from_slice(bytes(column(*k).ends.offsets())),
            Self::Strips(k) => {
                if let Values::Strips(_, ends) = &column(*k).values {
                    into.extend_from_slice(bytes(ends.offsets()));
                }
            }
            Self::Values(k) => match &column(*k).values {
                Values::Numbers(values) => into.extend_from_slice(bytes(values)),
                Values::Counts(values) => into.extend_from_slice(bytes(values)),
                Values::Vectors(values, _) | Values::Strips(values, _) => {
                    into.extend_from_slice(bytes(values));
                }
                // They have no form.
                Values::Texts(_) => {}
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

/// What the buffers of a batch hold, in their order: which values there are, then the values, column by column.
fn held(schema: &Schema, rows: &Rows<'_>) -> Option<Vec<Holds>> {
    let mut all = Vec::new();
    for field in schema.fields() {
        all.push(Holds::Same(Vec::new()));
        let metadata = field.metadata();
        match metadata.get("rerun:kind").map(String::as_str) {
            Some("control") => all.push(Holds::Ids),
            Some("index") => all.push(match metadata.get("rerun:index_name")?.as_str() {
                SIM_TIME => Holds::Nanoseconds,
                STEP => Holds::Steps,
                _ => return None,
            }),
            Some("data") => {
                let component = metadata.get("rerun:component")?;
                let named = |column: &Column| column.descriptor.component.as_str() == component;
                let k = rows.columns.iter().position(named)?;
                all.push(Holds::Offsets(k));
                let DataType::List(item) = field.data_type() else {
                    return None;
                };
                push_values(item.data_type(), k, &mut all)?;
            }
            _ => return None,
        }
    }
    Some(all)
}

fn push_values(kind: &DataType, k: usize, all: &mut Vec<Holds>) -> Option<()> {
    all.push(Holds::Same(Vec::new()));
    match kind {
        DataType::Float64 | DataType::Float32 | DataType::UInt64 => all.push(Holds::Values(k)),
        DataType::FixedSizeList(item, _) => push_values(item.data_type(), k, all)?,
        DataType::List(item) => {
            all.push(Holds::Strips(k));
            push_values(item.data_type(), k, all)?;
        }
        _ => return None,
    }
    Some(())
}
