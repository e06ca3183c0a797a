//! What a file of recordings holds, whoever made it: entities, clocks, what it says of itself.

use super::provenance::{Parts, Provenance};
use super::read::{self, ReadError};
use super::rrd::APPLICATION;
use rerun::external::arrow::array::{Array as _, StringArray};
use rerun::external::re_log_types::{StoreId, TimeType};
use rerun::log::Chunk;
use std::collections::BTreeMap;
use std::path::Path;

/// A file that was looked through.
#[derive(Clone, Debug)]
pub struct Survey {
    /// In the order of the file; at least one.
    pub recordings: Vec<Recording>,
    /// Why there is less than was meant to be, where that is so.
    pub cut: Option<String>,
}

/// One recording of a file.
#[derive(Clone, Debug)]
pub struct Recording {
    pub(super) store: StoreId,
    pub name: Option<String>,
    /// Where this program made it from a scene.
    pub provenance: Option<Provenance>,
    pub clocks: Vec<Clock>,
    pub entities: Vec<Entity>,
}

/// A timeline.
#[derive(Clone, Debug, PartialEq)]
pub struct Clock {
    pub name: String,
    pub unit: TimeUnit,
    /// In its own whole units.
    pub first: i64,
    pub last: i64,
    pub rows: u64,
}

/// What a timeline counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimeUnit {
    /// Steps or frames.
    Count,
    /// Nanoseconds.
    Duration,
    /// Nanoseconds since 1970.
    Timestamp,
}

/// Anything with data.
#[derive(Clone, Debug, PartialEq)]
pub struct Entity {
    pub path: String,
    /// Rows that have a time.
    pub rows: u64,
    /// Rows that have none.
    pub statics: u64,
    /// What it has, as Rerun calls it.
    pub columns: Vec<String>,
}

/// Why there is nothing to tell.
#[derive(Debug, thiserror::Error)]
pub enum InspectError {
    #[error(transparent)]
    Read(#[from] ReadError),
    #[error("{path}: holds no recording{why}; there is nothing in it to look at")]
    Nothing { path: String, why: String },
    #[error("{path}: {why}")]
    NotThere { path: String, why: String },
    #[error(
        "{path}: has more than {most} MB of numbers to be held at once; choose some with {how}"
    )]
    TooMuch {
        path: String,
        most: usize,
        how: &'static str,
    },
}

impl TimeUnit {
    /// s, or a count.
    pub fn number(self, time: i64) -> f64 {
        match self {
            Self::Count => time as f64,
            Self::Duration | Self::Timestamp => time as f64 / 1e9,
        }
    }

    pub fn time(self, number: f64) -> i64 {
        let scaled = match self {
            Self::Count => number,
            Self::Duration | Self::Timestamp => number * 1e9,
        };
        // Saturates; static data has the least.
        (scaled.round() as i64).max(i64::MIN + 1)
    }

    pub fn symbol(self) -> &'static str {
        match self {
            Self::Count => "",
            Self::Duration | Self::Timestamp => "s",
        }
    }
}

impl Recording {
    pub fn application(&self) -> &str {
        self.store.application_id().as_str()
    }

    pub fn id(&self) -> &str {
        self.store.recording_id().as_str()
    }

    pub fn is_own(&self) -> bool {
        self.application() == APPLICATION
    }

    /// The clock of that name; or else simulated time, or the fullest that is no clock of the logging.
    pub fn clock(&self, name: Option<&str>) -> Option<&Clock> {
        let named = |name: &str| self.clocks.iter().find(|clock| clock.name == name);
        if let Some(name) = name {
            return named(name);
        }
        let logging = |clock: &&Clock| !["log_time", "log_tick"].contains(&clock.name.as_str());
        let own = self.clocks.iter().filter(logging);
        named("sim_time")
            .or_else(|| own.max_by_key(|clock| (clock.unit != TimeUnit::Count, clock.rows)))
            .or_else(|| named("log_time"))
            .or_else(|| self.clocks.first())
    }
}

/// What is known of a recording so far.
struct Found {
    store: StoreId,
    name: Option<String>,
    parts: Parts,
    clocks: Vec<Clock>,
    entities: Vec<Entity>,
    places: BTreeMap<String, usize>,
}

/// Looks through a file.
pub fn survey(path: &Path) -> Result<Survey, InspectError> {
    let mut messages = read::open(path)?;
    let mut found: Vec<Found> = Vec::new();
    while let Some((store, chunk)) = messages.next_chunk() {
        let known = found.iter().position(|known| known.store == store);
        let index = known.unwrap_or_else(|| {
            found.push(Found::new(store));
            found.len() - 1
        });
        found[index].take(&chunk);
    }
    let cut = messages.flaw();
    if found.is_empty() {
        let why = cut.map_or(String::new(), |why| format!(" ({why})"));
        let path = path.display().to_string();
        return Err(InspectError::Nothing { path, why });
    }
    Ok(Survey {
        recordings: found.into_iter().map(Found::whole).collect(),
        cut,
    })
}

impl Found {
    fn new(store: StoreId) -> Self {
        Self {
            store,
            name: None,
            parts: Parts::default(),
            clocks: Vec::new(),
            entities: Vec::new(),
            places: BTreeMap::new(),
        }
    }

    fn take(&mut self, chunk: &Chunk) {
        self.parts.read(chunk);
        let path = chunk.entity_path().to_string();
        if path == "/__properties" {
            self.name = name_of(chunk).or(self.name.take());
        }
        for column in chunk.timelines().values() {
            self.clock(column.name(), column.timeline().typ(), column.times_raw());
        }
        let place = *self.places.entry(path.clone()).or_insert_with(|| {
            self.entities.push(Entity {
                path,
                rows: 0,
                statics: 0,
                columns: Vec::new(),
            });
            self.entities.len() - 1
        });
        let entity = &mut self.entities[place];
        let rows = chunk.num_rows() as u64;
        match chunk.is_static() {
            true => entity.statics += rows,
            false => entity.rows += rows,
        }
        for column in chunk.components().values() {
            let name = column.descriptor.component.to_string();
            if let Err(at) = entity.columns.binary_search(&name) {
                entity.columns.insert(at, name);
            }
        }
    }

    fn clock(&mut self, name: &str, kind: TimeType, times: &[i64]) {
        let (Some(&first), Some(&last)) = (times.iter().min(), times.iter().max()) else {
            return;
        };
        let rows = times.len() as u64;
        if let Some(clock) = self.clocks.iter_mut().find(|clock| clock.name == name) {
            clock.first = clock.first.min(first);
            clock.last = clock.last.max(last);
            clock.rows += rows;
            return;
        }
        self.clocks.push(Clock {
            name: name.to_owned(),
            unit: match kind {
                TimeType::Sequence => TimeUnit::Count,
                TimeType::DurationNs => TimeUnit::Duration,
                TimeType::TimestampNs => TimeUnit::Timestamp,
            },
            first,
            last,
            rows,
        });
    }

    fn whole(mut self) -> Recording {
        self.clocks.sort_by(|a, b| a.name.cmp(&b.name));
        Recording {
            store: self.store,
            name: self.name,
            provenance: self.parts.whole(),
            clocks: self.clocks,
            entities: self.entities,
        }
    }
}

/// What a recording calls itself.
fn name_of(chunk: &Chunk) -> Option<String> {
    let mut columns = chunk.components().values();
    let column =
        columns.find(|column| column.descriptor.component.as_str() == "RecordingInfo:name")?;
    let first = (!column.list_array.is_empty()).then(|| column.list_array.value(0))?;
    let text = first.as_any().downcast_ref::<StringArray>()?;
    text.iter().flatten().next().map(str::to_owned)
}

/// The times of a chunk's rows by a clock; none where it has no such clock. Static rows have the least.
pub(super) fn times(chunk: &Chunk, clock: &str) -> Option<Vec<i64>> {
    if chunk.is_static() {
        return Some(vec![STATIC; chunk.num_rows()]);
    }
    let mut columns = chunk.timelines().values();
    let column = columns.find(|column| column.name() == clock)?;
    Some(column.times_raw().to_vec())
}

/// The time of what has none.
pub const STATIC: i64 = i64::MIN;
