//! Columns of numbers and texts, flat: one list of instances a row; and how they become Arrow's.

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
#[derive(Clone)]
pub struct Column {
    pub descriptor: ComponentDescriptor,
    pub values: Values,
    pub ends: Ends,
}

/// All values of a column, one after the other.
#[derive(Clone)]
pub enum Values {
    Numbers(Vec<f64>),
    Counts(Vec<u64>),
    /// Of so many components each.
    Vectors(Vec<f32>, i32),
    /// Points of three components, and where each strip ends.
    Strips(Vec<f32>, Ends),
    Texts(Vec<String>),
}

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

    pub fn nanoseconds(&self) -> &[i64] {
        &self.nanoseconds
    }

    pub fn steps(&self) -> &[i64] {
        &self.steps
    }

    pub fn columns(&self) -> [TimeColumn; 2] {
        [
            TimeColumn::new_duration_nanos(SIM_TIME, self.nanoseconds.iter().copied()),
            TimeColumn::new_sequence(STEP, self.steps.iter().copied()),
        ]
    }
}

/// The timelines, by name.
pub const SIM_TIME: &str = "sim_time";
pub const STEP: &str = "step";

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

    /// With the 0 at which the first begins.
    pub fn offsets(&self) -> &[i32] {
        &self.0
    }

    fn buffer(self) -> OffsetBuffer<i32> {
        OffsetBuffer::new(ScalarBuffer::from(self.0))
    }
}

/// f64 numbers.
pub fn numbers(descriptor: ComponentDescriptor, values: Vec<f64>, ends: Ends) -> Column {
    Column {
        descriptor,
        values: Values::Numbers(values),
        ends,
    }
}

/// Whole numbers.
pub fn counts(descriptor: ComponentDescriptor, values: Vec<u64>, ends: Ends) -> Column {
    Column {
        descriptor,
        values: Values::Counts(values),
        ends,
    }
}

/// f32 vectors of `width` components.
pub fn vectors(
    descriptor: ComponentDescriptor,
    values: Vec<f32>,
    width: i32,
    ends: Ends,
) -> Column {
    Column {
        descriptor,
        values: Values::Vectors(values, width),
        ends,
    }
}

/// f32 polylines: `points` ends each strip (in points), `ends` each row (in strips).
pub fn strips(
    descriptor: ComponentDescriptor,
    values: Vec<f32>,
    points: Ends,
    ends: Ends,
) -> Column {
    Column {
        descriptor,
        values: Values::Strips(values, points),
        ends,
    }
}

/// Texts.
pub fn texts(descriptor: ComponentDescriptor, values: Vec<String>, ends: Ends) -> Column {
    Column {
        descriptor,
        values: Values::Texts(values),
        ends,
    }
}

impl Values {
    /// Values; of strips how many of them.
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(values) => values.len(),
            Self::Counts(values) => values.len(),
            Self::Vectors(values, width) => values.len() / *width as usize,
            Self::Strips(_, ends) => ends.0.len() - 1,
            Self::Texts(texts) => texts.len(),
        }
    }

    /// The numbers that they are made of; texts of none.
    pub fn numbers(&self) -> usize {
        match self {
            Self::Vectors(values, _) | Self::Strips(values, _) => values.len(),
            Self::Texts(_) => 0,
            Self::Numbers(_) | Self::Counts(_) => self.len(),
        }
    }
}

impl Column {
    pub fn into_arrow(self) -> (ComponentDescriptor, ListArray) {
        let values: ArrayRef = match self.values {
            Values::Numbers(values) => Arc::new(Float64Array::new(values.into(), None)),
            Values::Counts(values) => Arc::new(UInt64Array::from(values)),
            Values::Vectors(values, width) => fixed(values, width),
            Values::Strips(values, points) => {
                let item = fixed(values, 3);
                let field = Field::new("item", item.data_type().clone(), false);
                let strips = ListArray::new(Arc::new(field), points.buffer(), item, None);
                Arc::new(strips)
            }
            Values::Texts(values) => Arc::new(StringArray::from(values)),
        };
        let field = Field::new("item", values.data_type().clone(), true);
        let list = ListArray::new(Arc::new(field), self.ends.buffer(), values, None);
        (self.descriptor, list)
    }
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
