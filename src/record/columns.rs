//! Arrow columns built straight from flat numbers: one list of instances a row.

use crate::trace::Instant;
use rerun::external::arrow::array::{
    Array as _, ArrayRef, FixedSizeListArray, Float32Array, Float64Array, ListArray, StringArray,
    UInt64Array,
};
use rerun::external::arrow::buffer::{OffsetBuffer, ScalarBuffer};
use rerun::external::arrow::datatypes::Field;
use rerun::{ComponentDescriptor, TimeColumn};
use std::sync::Arc;

/// A component and its values, a list a row.
pub type Column = (ComponentDescriptor, ListArray);

/// When the rows of a chunk happened.
#[derive(Clone, Default)]
pub struct Times {
    nanoseconds: Vec<i64>,
    steps: Vec<i64>,
}

impl Times {
    pub fn push(&mut self, at: Instant) {
        self.nanoseconds.push(at.nanoseconds());
        self.steps.push(at.step as i64);
    }

    /// Only the first so many.
    pub fn truncate(&mut self, len: usize) {
        self.nanoseconds.truncate(len);
        self.steps.truncate(len);
    }

    pub fn len(&self) -> usize {
        self.steps.len()
    }

    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    pub fn columns(&self) -> [TimeColumn; 2] {
        [
            TimeColumn::new_duration_nanos("sim_time", self.nanoseconds.iter().copied()),
            TimeColumn::new_sequence("step", self.steps.iter().copied()),
        ]
    }
}

/// Where the list of each row ends.
#[derive(Clone)]
pub struct Ends(Vec<i32>);

impl Default for Ends {
    fn default() -> Self {
        Self(vec![0])
    }
}

impl Ends {
    /// Ends a row that holds `count` more instances.
    pub fn push(&mut self, count: usize) {
        let last = self.0.last().copied().unwrap_or(0);
        self.0.push(last + count as i32);
    }

    /// `per` instances in each of `rows` rows.
    pub fn uniform(rows: usize, per: usize) -> Self {
        Self((0..=rows).map(|row| (row * per) as i32).collect())
    }

    fn buffer(self) -> OffsetBuffer<i32> {
        OffsetBuffer::new(ScalarBuffer::from(self.0))
    }
}

/// f64 numbers.
pub fn numbers(descriptor: ComponentDescriptor, values: Vec<f64>, ends: Ends) -> Column {
    let values = Arc::new(Float64Array::new(ScalarBuffer::from(values), None));
    (descriptor, list(values, ends))
}

/// Whole numbers.
pub fn counts(descriptor: ComponentDescriptor, values: Vec<u64>, ends: Ends) -> Column {
    (descriptor, list(Arc::new(UInt64Array::from(values)), ends))
}

/// f32 vectors of `width` components.
pub fn vectors(
    descriptor: ComponentDescriptor,
    values: Vec<f32>,
    width: i32,
    ends: Ends,
) -> Column {
    (descriptor, list(fixed(values, width), ends))
}

/// f32 polylines: `points` ends each strip (in points), `ends` each row (in strips).
pub fn strips(
    descriptor: ComponentDescriptor,
    values: Vec<f32>,
    points: Ends,
    ends: Ends,
) -> Column {
    let item = fixed(values, 3);
    let field = Field::new("item", item.data_type().clone(), false);
    let strips = ListArray::new(Arc::new(field), points.buffer(), item, None);
    (descriptor, list(Arc::new(strips), ends))
}

/// Texts.
pub fn texts(descriptor: ComponentDescriptor, values: Vec<String>, ends: Ends) -> Column {
    (descriptor, list(Arc::new(StringArray::from(values)), ends))
}

fn fixed(values: Vec<f32>, width: i32) -> ArrayRef {
    let values = Arc::new(Float32Array::new(ScalarBuffer::from(values), None));
    let field = Field::new("item", values.data_type().clone(), false);
    Arc::new(FixedSizeListArray::new(
        Arc::new(field),
        width,
        values,
        None,
    ))
}

fn list(values: ArrayRef, ends: Ends) -> ListArray {
    let field = Field::new("item", values.data_type().clone(), true);
    ListArray::new(Arc::new(field), ends.buffer(), values, None)
}
