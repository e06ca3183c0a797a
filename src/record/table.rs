//! The numbers of a recording, by body and quantity.
//!
//! Of recordings of this program: the f64 columns of `/numbers`; where a quantity has none there, the state of `/bodies/NAME`,
//! which is there at every step: the pose of the picture, f32, and the angular velocity, f64. Of others: transforms and
//! scalars, by entity, as they were logged: relative to the parent.

use super::read;
use super::survey::{InspectError, STATIC, Survey, times};
use crate::trace::{Quantity, STREAMS, Shape, Term, Vocabulary};
use rerun::external::arrow::array::{
    Array as _, ArrayRef, FixedSizeListArray, Float32Array, Float64Array, ListArray, StructArray,
};
use rerun::log::Chunk;
use std::collections::BTreeMap;
use std::path::Path;

/// One quantity of one body, row by row.
#[derive(Clone, Debug)]
pub struct Series {
    /// Index of the recording.
    pub recording: usize,
    /// A body, or of recordings of others an entity.
    pub body: String,
    pub term: Term,
    pub origin: Origin,
    pub times: Vec<i64>,
    /// Where the numbers of each row end.
    pub(super) ends: Vec<usize>,
    pub(super) values: Vec<f64>,
}

/// Where numbers were found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Origin {
    /// f64, among the numbers.
    Numbers,
    /// f64, at every step.
    State,
    /// f32: of a picture.
    Picture,
}

/// Some rows of one quantity of one body.
pub(super) struct Cells {
    pub recording: usize,
    pub body: String,
    pub term: Term,
    pub origin: Origin,
    pub times: Vec<i64>,
    ends: Vec<usize>,
    values: Vec<f64>,
}

impl Cells {
    pub fn rows(&self) -> impl Iterator<Item = (i64, &[f64])> {
        rows(&self.times, &self.ends, &self.values)
    }
}

fn rows<'a>(
    times: &'a [i64],
    ends: &'a [usize],
    values: &'a [f64],
) -> impl Iterator<Item = (i64, &'a [f64])> {
    let starts = std::iter::once(0).chain(ends.iter().copied());
    let rows = times.iter().zip(starts.zip(ends));
    rows.map(|(&time, (start, &end))| (time, &values[start..end]))
}

impl Series {
    pub fn row(&self, index: usize) -> &[f64] {
        let start = index.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.values[start..self.ends[index]]
    }

    pub fn rows(&self) -> impl Iterator<Item = (i64, &[f64])> {
        rows(&self.times, &self.ends, &self.values)
    }

    /// The rows of one instant, or else of the last one before.
    pub fn at(&self, time: i64) -> std::ops::Range<usize> {
        let end = self.times.partition_point(|&t| t <= time);
        match end.checked_sub(1).map(|last| self.times[last]) {
            Some(last) => self.times.partition_point(|&t| t < last)..end,
            None => 0..0,
        }
    }

    pub(super) fn new(recording: usize, body: &str, term: Term, origin: Origin) -> Self {
        Self {
            recording,
            body: body.to_owned(),
            term,
            origin,
            times: Vec::new(),
            ends: Vec::new(),
            values: Vec::new(),
        }
    }

    pub(super) fn push(&mut self, time: i64, values: &[f64]) {
        self.times.push(time);
        self.values.extend_from_slice(values);
        self.ends.push(self.values.len());
    }

    /// Puts rows in the order of time; those of one instant stay as they came.
    fn put_in_order(&mut self) {
        if self.times.is_sorted() {
            return;
        }
        let mut order: Vec<usize> = (0..self.times.len()).collect();
        order.sort_by_key(|&row| self.times[row]);
        let mut sorted = Self::new(self.recording, &self.body, self.term.clone(), self.origin);
        for row in order {
            sorted.push(self.times[row], self.row(row));
        }
        *self = sorted;
    }
}

/// Which numbers are wanted.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Index of the recording; all where nothing is said.
    pub recording: Option<usize>,
    pub body: Option<String>,
    pub quantities: Option<Vec<String>>,
    /// By which clock.
    pub clock: Option<String>,
    /// Of the angular velocity what stands among the other numbers, though it is there at every step.
    pub at_one_rate: bool,
}

impl Wanted {
    fn takes(&self, body: &str, term: &Term) -> bool {
        let one = self.body.as_ref().is_none_or(|own| own == body);
        let quantities = self.quantities.as_ref();
        one && quantities.is_none_or(|names| names.contains(&term.name))
    }
}

/// Hands on everything wanted in the order of the file.
pub(super) fn read_cells(
    path: &Path,
    survey: &Survey,
    wanted: &Wanted,
    mut take: impl FnMut(Cells) -> Result<(), InspectError>,
) -> Result<(), InspectError> {
    let mut messages = read::open(path)?;
    let clocks: Vec<Option<String>> = survey
        .recordings
        .iter()
        .map(|recording| recording.clock(wanted.clock.as_deref()))
        .map(|clock| clock.map(|clock| clock.name.clone()))
        .collect();
    while let Some((store, chunk)) = messages.next_chunk() {
        let mut stores = survey.recordings.iter();
        let Some(index) = stores.position(|recording| recording.store == store) else {
            continue;
        };
        if wanted.recording.is_some_and(|only| only != index) {
            continue;
        }
        let clock = clocks[index].as_deref().unwrap_or_default();
        let Some(times) = times(&chunk, clock) else {
            continue;
        };
        let found = match survey.recordings[index].is_own() {
            true => own_columns(&chunk),
            false => columns_of_others(&chunk),
        };
        for column in found {
            if !wanted.takes(&column.body, &column.term) {
                continue;
            }
            take(column.cells(index, &times))?;
        }
    }
    Ok(())
}

/// A column of a chunk that has numbers.
struct Column {
    body: String,
    term: Term,
    origin: Origin,
    numbers: Numbers,
}

/// Lists of numbers, one a row.
struct Numbers {
    ends: Vec<usize>,
    values: Vec<f64>,
}

impl Column {
    fn cells(self, recording: usize, times: &[i64]) -> Cells {
        let Numbers { mut ends, values } = self.numbers;
        // Chunks are as long as they say; what is read may be anything.
        let rows = times.len().min(ends.len());
        ends.truncate(rows);
        Cells {
            recording,
            body: self.body,
            term: self.term,
            origin: self.origin,
            times: times[..rows].to_vec(),
            ends,
            values,
        }
    }
}

fn term(name: &str, unit: &'static str, shape: Shape) -> Term {
    Term {
        name: name.to_owned(),
        unit,
        shape,
    }
}

fn quantity(name: &str) -> Option<&'static Quantity> {
    let mut all = STREAMS.iter().flat_map(|stream| stream.quantities);
    all.find(|quantity| quantity.name == name).copied()
}

/// As `torquescope streams` has it; of what this version does not know, as it is.
fn term_called(name: &str) -> Term {
    match quantity(name) {
        Some(quantity) => Term::of(quantity),
        None => term(name, "", Shape::Scalar),
    }
}

fn own_columns(chunk: &Chunk) -> Vec<Column> {
    let path = chunk.entity_path().to_string();
    let parts: Vec<&str> = path.split('/').filter(|part| !part.is_empty()).collect();
    let one = |body: &str, column: &str, name: &str, origin| {
        let term = term_called(name);
        let numbers = numbers(chunk, column, term.shape)?;
        let body = body.to_owned();
        Some(Column {
            body,
            term,
            origin,
            numbers,
        })
    };
    match parts.as_slice() {
        ["numbers", body] => {
            let names = chunk.components().values();
            let mut names: Vec<String> = names
                .map(|column| column.descriptor.component.to_string())
                .collect();
            names.sort_by_key(|name| {
                let all = STREAMS.iter().flat_map(|stream| stream.quantities);
                all.map(|q| q.name).position(|known| known == name)
            });
            let columns = names.iter();
            columns
                .filter_map(|name| one(body, name, name, Origin::Numbers))
                .collect()
        }
        ["numbers", body, "torque", source] => by_source(chunk, body, source).into_iter().collect(),
        // In a recording of ghosts place and turn are apart.
        ["bodies", body] | ["bodies", body, "spin"] => {
            let columns = [
                one(body, TRANSLATION, "position", Origin::Picture),
                one(body, QUATERNION, "orientation", Origin::Picture),
                one(body, "angular_velocity", "angular_velocity", Origin::State),
            ];
            columns.into_iter().flatten().collect()
        }
        _ => Vec::new(),
    }
}

const TRANSLATION: &str = "Transform3D:translation";
const QUATERNION: &str = "Transform3D:quaternion";

/// The torque of one source is recorded component by component.
fn by_source(chunk: &Chunk, body: &str, source: &str) -> Option<Column> {
    let axis = |name| numbers(chunk, name, Shape::Scalar);
    let (x, y, z) = (axis("x")?, axis("y")?, axis("z")?);
    let rows = chunk.num_rows();
    if [&x, &y, &z].iter().any(|axis| axis.values.len() != rows) {
        return None;
    }
    let values = (0..rows).flat_map(|k| [x.values[k], y.values[k], z.values[k]]);
    let numbers = Numbers {
        ends: (1..=rows).map(|row| 3 * row).collect(),
        values: values.collect(),
    };
    Some(Column {
        body: body.to_owned(),
        term: Term::of_source(source),
        origin: Origin::Numbers,
        numbers,
    })
}

fn columns_of_others(chunk: &Chunk) -> Vec<Column> {
    let entity = chunk.entity_path().to_string();
    if entity.starts_with("/__properties") {
        return Vec::new();
    }
    let column = |column: &str, term: Term| {
        let numbers = match column {
            AXIS_ANGLE => axis_angles(chunk),
            column => numbers(chunk, column, term.shape),
        }?;
        let body = entity.clone();
        let origin = match column {
            SCALARS => Origin::Numbers,
            _ => Origin::Picture,
        };
        Some(Column {
            body,
            term,
            origin,
            numbers,
        })
    };
    let all = [
        (TRANSLATION, term_called("position")),
        (QUATERNION, term_called("orientation")),
        (AXIS_ANGLE, term_called("orientation")),
        ("Transform3D:mat3x3", term("mat3x3", "1", Shape::Matrix)),
        ("Transform3D:scale", term("scale", "1", Shape::Vector)),
        (SCALARS, term("scalars", "", Shape::Scalar)),
    ];
    all.into_iter()
        .filter_map(|(name, term)| column(name, term))
        .collect()
}

const AXIS_ANGLE: &str = "Transform3D:rotation_axis_angle";
const SCALARS: &str = "Scalars:scalars";

fn list<'c>(chunk: &'c Chunk, name: &str) -> Option<&'c ListArray> {
    let mut columns = chunk.components().values();
    let column = columns.find(|column| column.descriptor.component.as_str() == name)?;
    Some(&column.list_array)
}

/// The numbers of a column, where it has any. A row that does not have as many as its shape says has none.
fn numbers(chunk: &Chunk, name: &str, shape: Shape) -> Option<Numbers> {
    let list = list(chunk, name)?;
    let width = shape.components().len().max(1);
    let several = matches!(shape, Shape::VectorPerPush | Shape::Scalar);
    let mut found = Numbers {
        ends: Vec::with_capacity(list.len()),
        values: Vec::new(),
    };
    flat(list.values()).map(|_| ())?;
    for row in 0..list.len() {
        if list.is_valid(row) {
            let before = found.values.len();
            found.values.extend(flat(&list.value(row))?);
            let count = found.values.len() - before;
            let fits = count == width || several && count.is_multiple_of(width);
            if !fits {
                found.values.truncate(before);
            }
        }
        found.ends.push(found.values.len());
    }
    Some(found)
}

/// f64 or f32, or lists of a fixed length of them; nothing else.
fn flat(values: &ArrayRef) -> Option<Vec<f64>> {
    if let Some(values) = values.as_any().downcast_ref::<Float64Array>() {
        return Some(values.values().to_vec());
    }
    if let Some(values) = values.as_any().downcast_ref::<Float32Array>() {
        return Some(values.values().iter().map(|&x| f64::from(x)).collect());
    }
    let list = values.as_any().downcast_ref::<FixedSizeListArray>()?;
    let width = usize::try_from(list.value_length()).ok()?;
    let start = usize::try_from(list.value_offset(0)).ok()?;
    let inner = list.values();
    let length = list.len().checked_mul(width)?;
    let end = start.checked_add(length)?;
    (end <= inner.len()).then(|| flat(&inner.slice(start, length)))?
}

/// Attitudes that were logged as a turn about an axis: `(a sin φ/2, cos φ/2)`.
fn axis_angles(chunk: &Chunk) -> Option<Numbers> {
    let list = list(chunk, AXIS_ANGLE)?;
    let mut found = Numbers {
        ends: Vec::with_capacity(list.len()),
        values: Vec::new(),
    };
    for row in 0..list.len() {
        let turn = list.is_valid(row).then(|| list.value(row));
        if let Some([x, y, z, w]) = turn.as_ref().and_then(axis_angle) {
            found.values.extend([x, y, z, w]);
        }
        found.ends.push(found.values.len());
    }
    Some(found)
}

fn axis_angle(turn: &ArrayRef) -> Option<[f64; 4]> {
    let turn = turn.as_any().downcast_ref::<StructArray>()?;
    let field = |name| turn.column_by_name(name).and_then(flat);
    let (axis, angle) = (field("axis")?, field("angle")?);
    let ([x, y, z], [angle]) = (axis.as_slice(), angle.as_slice()) else {
        return None;
    };
    let length = (x * x + y * y + z * z).sqrt();
    if *angle == 0.0 {
        return Some([0.0, 0.0, 0.0, 1.0]);
    }
    let along = libm::sin(0.5 * angle) / length;
    Some([x * along, y * along, z * along, libm::cos(0.5 * angle)])
}

/// All numbers that are wanted, at once.
#[derive(Clone, Debug, Default)]
pub struct Table {
    pub series: Vec<Series>,
}

/// Bytes of numbers held at once, in MB.
const MOST: usize = 1_024;

impl Table {
    pub fn read(path: &Path, survey: &Survey, wanted: &Wanted) -> Result<Self, InspectError> {
        let mut places: BTreeMap<(usize, String, String, Origin), usize> = BTreeMap::new();
        let mut series: Vec<Series> = Vec::new();
        let mut bytes = 0;
        read_cells(path, survey, wanted, |cells| {
            bytes += 8 * cells.values.len() + 16 * cells.times.len();
            if bytes > MOST << 20 {
                return Err(InspectError::TooMuch {
                    path: path.display().to_string(),
                    most: MOST,
                    how: "--body NAME or --recording N",
                });
            }
            let name = cells.term.name.clone();
            let key = (cells.recording, cells.body.clone(), name, cells.origin);
            let place = *places.entry(key).or_insert_with(|| {
                let term = cells.term.clone();
                series.push(Series::new(
                    cells.recording,
                    &cells.body,
                    term,
                    cells.origin,
                ));
                series.len() - 1
            });
            let own = &mut series[place];
            for (time, values) in cells.rows() {
                own.push(time, values);
            }
            Ok(())
        })?;
        series.iter_mut().for_each(Series::put_in_order);
        Ok(Self::of(series, wanted.at_one_rate))
    }

    /// Of each quantity the best series that there is, body by body.
    pub(super) fn of(series: Vec<Series>, at_one_rate: bool) -> Self {
        let keys = series.iter().map(|s| Key {
            recording: s.recording,
            body: s.body.as_str(),
            name: s.term.name.as_str(),
            origin: s.origin,
            rows: s.times.len() as u64,
        });
        let order = best(&keys.collect::<Vec<_>>(), at_one_rate);
        let mut slots: Vec<Option<Series>> = series.into_iter().map(Some).collect();
        let taken = order.into_iter().filter_map(|index| slots[index].take());
        Self {
            series: taken.collect(),
        }
    }

    pub fn find(&self, recording: usize, body: &str, name: &str) -> Option<&Series> {
        let mut all = self.series.iter();
        all.find(|s| s.recording == recording && s.body == body && s.term.name == name)
    }

    /// Names of bodies, each once, in the order of the file.
    pub fn bodies(&self, recording: usize) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for series in self.series.iter().filter(|s| s.recording == recording) {
            if names.last() != Some(&series.body.as_str()) {
                names.push(&series.body);
            }
        }
        names
    }

    /// Whether what there is has a time.
    pub fn is_timed(&self) -> bool {
        let mut times = self.series.iter().flat_map(|s| s.times.last());
        times.any(|&time| time != STATIC)
    }
}

/// What tells one series from another.
pub(super) struct Key<'a> {
    pub recording: usize,
    pub body: &'a str,
    pub name: &'a str,
    pub origin: Origin,
    pub rows: u64,
}

/// The places of the best series of each quantity, body by body in the order in which they come: numbers before pictures,
/// and of the
/// angular velocity what has more rows.
pub(super) fn best(keys: &[Key<'_>], at_one_rate: bool) -> Vec<usize> {
    let mut bodies: BTreeMap<(usize, &str), usize> = BTreeMap::new();
    let mut best: BTreeMap<(usize, &str, &str), usize> = BTreeMap::new();
    for (k, key) in keys.iter().enumerate() {
        bodies.entry((key.recording, key.body)).or_insert(k);
        let rank = |k: usize| {
            let key: &Key<'_> = &keys[k];
            let fuller = match key.origin {
                Origin::Picture => 0,
                Origin::State if at_one_rate => 0,
                Origin::Numbers | Origin::State => key.rows,
            };
            (
                key.origin != Origin::Picture,
                fuller,
                key.origin == Origin::Numbers,
            )
        };
        let own = best.entry((key.recording, key.body, key.name)).or_insert(k);
        if rank(k) > rank(*own) {
            *own = k;
        }
    }
    let place = |name: &str| {
        let all = STREAMS.iter().flat_map(|stream| stream.quantities);
        all.map(|q| q.name)
            .position(|known| known == name)
            .unwrap_or(usize::MAX)
    };
    let mut order: Vec<usize> = best.into_values().collect();
    order.sort_by_key(|&k| {
        let key = &keys[k];
        let body = bodies[&(key.recording, key.body)];
        (key.recording, body, place(key.name), k)
    });
    order
}

/// What can be asked of a file, or of one of its recordings.
pub fn vocabulary(
    path: &Path,
    survey: &Survey,
    wanted: &Wanted,
) -> Result<Vocabulary, InspectError> {
    let mut vocabulary = Vocabulary::default();
    let mut bodies = std::collections::BTreeSet::new();
    let mut names = std::collections::BTreeSet::new();
    read_cells(path, survey, wanted, |cells| {
        if names.insert(cells.term.name.clone()) {
            vocabulary.terms.push(cells.term);
        }
        if bodies.insert(cells.body.clone()) {
            vocabulary.bodies.push(cells.body);
        }
        Ok(())
    })?;
    Ok(vocabulary)
}
