//! What a file's footer says of its chunks: a line each, of which entity, when, where in the file.
//!
//! Rerun's builder takes a chunk apart to write its line, and keeps some kilobytes. Of chunks of one entity with the same
//! columns it is given the first; lines of later ones are a few numbers here, and at the end are that first one's with their
//! own numbers put in.

use super::columns::{SIM_TIME, STEP, Times};
use rerun::external::arrow::array::{
    Array, ArrayRef, FixedSizeBinaryArray, Int64Array, RecordBatch, UInt32Array, UInt64Array,
};
use rerun::external::arrow::compute::{cast, take};
use rerun::external::arrow::datatypes::{DataType, Field, Schema};
use rerun::external::re_log_encoding::{RawRrdManifest, RrdManifestBuilder};
use rerun::external::re_log_types::{StoreId, TimeInt, TimeType};
use std::collections::HashMap;
use std::sync::Arc;

/// The lines of one store.
#[derive(Default)]
pub struct Manifest {
    /// With the lines that are taken apart.
    exemplars: RrdManifestBuilder,
    count: Exemplar,
    /// By entity and columns: which line they have there.
    known: HashMap<String, Vec<(Columns, Exemplar)>>,
    lines: Vec<Line>,
}

/// Which columns a chunk has, as a hash: chunks of one entity that have the same are alike in the footer.
pub type Columns = u64;

/// A line that others are like, by number.
pub type Exemplar = u32;

/// Where in the file a chunk is, without the head of its message.
#[derive(Clone, Copy)]
pub struct Place {
    pub start: u64,
    pub length: u64,
    pub unpacked: u64,
}

struct Line {
    exemplar: Exemplar,
    /// Of a chunk that only resembles it.
    own: Option<Own>,
}

struct Own {
    chunk: u128,
    rows: u64,
    place: Place,
    sim_time: (i64, i64),
    step: (i64, i64),
}

impl Manifest {
    /// The line of the chunk that was taken apart with these columns of this entity, if one was.
    pub fn find(&self, (path, columns): (&str, Columns)) -> Option<Exemplar> {
        let known = self.known.get(path)?.iter();
        let mut found = known.filter(|(other, _)| *other == columns);
        found.next().map(|(_, line)| *line)
    }

    /// A line of a chunk that is taken apart, which `add` does; `like` says what others like it have.
    pub fn append(
        &mut self,
        like: Option<(&str, Columns)>,
        add: impl FnOnce(&mut RrdManifestBuilder) -> Result<(), String>,
    ) -> Result<(), String> {
        add(&mut self.exemplars)?;
        if let Some((path, columns)) = like {
            let known = self.known.entry(path.to_owned()).or_default();
            known.push((columns, self.count));
        }
        self.lines.push(Line {
            exemplar: self.count,
            own: None,
        });
        self.count += 1;
        Ok(())
    }

    /// A line of a chunk like one that was taken apart.
    pub fn append_like(&mut self, exemplar: Exemplar, chunk: u128, times: &Times, place: Place) {
        self.lines.push(Line {
            exemplar,
            own: Some(Own {
                chunk,
                rows: times.len() as u64,
                place,
                sim_time: range(times.nanoseconds()),
                step: range(times.steps()),
            }),
        });
    }

    pub fn build(self, store: StoreId) -> Result<RawRrdManifest, String> {
        let mut manifest = self.exemplars.build(store).map_err(|e| e.to_string())?;
        in_order(&mut manifest.sorbet_schema);
        if self.lines.iter().any(|line| line.own.is_some()) {
            let whole = all_lines(&manifest.data, &self.lines);
            manifest.data = whole.map_err(|error| error.to_string())?;
        }
        Ok(manifest)
    }
}

fn range(times: &[i64]) -> (i64, i64) {
    let first = times.iter().min().copied();
    let last = times.iter().max().copied();
    (first.unwrap_or_default(), last.unwrap_or_default())
}

/// Sorts the columns that a manifest lists, which come in the order of a hash: what is no component first.
fn in_order(schema: &mut Schema) {
    let mut fields = schema.fields().to_vec();
    fields.sort_by_cached_key(|field| {
        let kind = field.metadata().get("rerun:kind").cloned();
        (kind, field.name().clone())
    });
    schema.fields = fields.into();
}

type ArrowError = rerun::external::arrow::error::ArrowError;

/// The exemplars' lines, each as often as there is one like it, with its own numbers.
fn all_lines(exemplars: &RecordBatch, lines: &[Line]) -> Result<RecordBatch, ArrowError> {
    let which = UInt32Array::from_iter_values(lines.iter().map(|line| line.exemplar));
    let schema = exemplars.schema();
    let columns = schema.fields().iter().zip(exemplars.columns());
    let columns = columns.map(|(field, column)| own(field, take(column, &which, None)?, lines));
    RecordBatch::try_new(schema.clone(), columns.collect::<Result<_, _>>()?)
}

/// A column of the manifest with the numbers that are the lines' own.
fn own(field: &Field, column: ArrayRef, lines: &[Line]) -> Result<ArrayRef, ArrowError> {
    let name = field.name().as_str();
    let is = |other: Field| other.name() == name;
    if is(RawRrdManifest::field_chunk_id()) {
        return ids(&column, lines);
    }
    let count = |number: fn(&Own) -> u64| counts(&column, lines, number);
    if is(RawRrdManifest::field_chunk_num_rows()) {
        return count(|own| own.rows);
    }
    if is(RawRrdManifest::field_chunk_byte_offset()) {
        return count(|own| own.place.start);
    }
    if is(RawRrdManifest::field_chunk_byte_size()) {
        return count(|own| own.place.length);
    }
    if is(RawRrdManifest::field_chunk_byte_size_uncompressed()) {
        return count(|own| own.place.unpacked);
    }
    // What is told of a timeline, or of a component on it: their names end so.
    let about = name.rsplit(':').next().unwrap_or_default();
    match (RawRrdManifest::get_index_name(field), about) {
        (Some(SIM_TIME | STEP), "num_rows") => count(|own| own.rows),
        (Some(SIM_TIME), "start") => bounds(&column, lines, |own| own.sim_time.0),
        (Some(SIM_TIME), "end") => bounds(&column, lines, |own| own.sim_time.1),
        (Some(STEP), "start") => bounds(&column, lines, |own| own.step.0),
        (Some(STEP), "end") => bounds(&column, lines, |own| own.step.1),
        _ => Ok(column),
    }
}

fn ids(column: &ArrayRef, lines: &[Line]) -> Result<ArrayRef, ArrowError> {
    let taken = column.as_any().downcast_ref::<FixedSizeBinaryArray>();
    let taken = taken.ok_or_else(|| unexpected(column))?;
    let ids = lines.iter().enumerate().map(|(k, line)| match &line.own {
        Some(own) => own.chunk.to_be_bytes().to_vec(),
        None => taken.value(k).to_vec(),
    });
    Ok(Arc::new(FixedSizeBinaryArray::try_from_iter(ids)?))
}

/// Counts, which are 0 and not null where a line has none.
fn counts(
    column: &ArrayRef,
    lines: &[Line],
    number: impl Fn(&Own) -> u64,
) -> Result<ArrayRef, ArrowError> {
    let taken = column.as_any().downcast_ref::<UInt64Array>();
    let taken = taken.ok_or_else(|| unexpected(column))?.values();
    let values = taken.iter().zip(lines).map(|(&taken, line)| {
        let taken = Some(taken).filter(|taken| *taken > 0);
        replaced(taken, line, &number).unwrap_or_default()
    });
    Ok(Arc::new(UInt64Array::from_iter_values(values)))
}

/// Times, of whatever timeline.
fn bounds(
    column: &ArrayRef,
    lines: &[Line],
    number: impl Fn(&Own) -> i64,
) -> Result<ArrayRef, ArrowError> {
    let taken = cast(column, &DataType::Int64)?;
    let taken = taken.as_any().downcast_ref::<Int64Array>();
    let taken = taken.ok_or_else(|| unexpected(column))?;
    let times = taken.iter().zip(lines).map(|(taken, line)| {
        replaced(taken, line, &number).map_or(TimeInt::STATIC, TimeInt::new_temporal)
    });
    let kind = match column.data_type() {
        DataType::Int64 => TimeType::Sequence,
        _ => TimeType::DurationNs,
    };
    Ok(kind.make_arrow_array_from_time_ints(times))
}

/// A line's own number, where its exemplar has one.
fn replaced<T: Copy>(taken: Option<T>, line: &Line, number: impl Fn(&Own) -> T) -> Option<T> {
    taken.map(|taken| line.own.as_ref().map_or(taken, number))
}

fn unexpected(column: &ArrayRef) -> ArrowError {
    ArrowError::SchemaError(format!(
        "a column of the footer is of type {}",
        column.data_type()
    ))
}
