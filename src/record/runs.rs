//! Runs to be compared: recordings read back, scenes that are run into memory.

use super::provenance::Provenance;
use super::survey::{InspectError, Survey, TimeUnit, survey};
use super::table::{Origin, Series, Table, Wanted};
use crate::scene::Script;
use crate::sim::Simulation;
use crate::trace::{
    Instant, Note, Quantity, Sample, Sink, SinkError, StreamSet, Subject, Term, Track,
};
use std::ops::Range;
use std::path::Path;

/// One of those that are compared.
#[derive(Clone, Debug)]
pub struct Run {
    pub label: String,
    /// What it holds, as its recording 0.
    pub table: Table,
    /// Where the scene is known.
    pub subjects: Vec<Subject>,
    /// Why there is less than was meant to be, where that is so.
    pub cut: Option<String>,
}

impl Run {
    /// Every recording of a file; times by simulated time, or else by the fullest clock.
    pub fn read(path: &Path) -> Result<Vec<Self>, InspectError> {
        let found = survey(path)?;
        let file = path.display().to_string();
        let runs = (0..found.recordings.len()).map(|k| Self::of(path, &file, &found, k));
        runs.collect()
    }

    fn of(path: &Path, file: &str, found: &Survey, k: usize) -> Result<Self, InspectError> {
        let recording = &found.recordings[k];
        let not_there = |why: &str| InspectError::NotThere {
            path: file.to_owned(),
            why: why.to_owned(),
        };
        let clock = recording
            .clock(None)
            .ok_or_else(|| not_there("has nothing in time to compare"))?;
        if clock.unit == TimeUnit::Count {
            let why =
                "counts frames and has no clock in seconds; there is nothing to line it up by";
            return Err(not_there(why));
        }
        let mut table = Table::read(
            path,
            found,
            &Wanted {
                recording: Some(k),
                at_one_rate: true,
                ..Wanted::default()
            },
        )?;
        for series in &mut table.series {
            series.recording = 0;
        }
        let from = recording.provenance.as_ref();
        let variant = from.and_then(|from| from.fact("variant"));
        Ok(Self {
            label: match (found.recordings.len(), variant) {
                (1, _) => file.to_owned(),
                (_, Some(variant)) => format!("{file}, {variant}"),
                (_, None) => format!("{file}, {}", k + 1),
            },
            table,
            subjects: from.map(subjects).unwrap_or_default(),
            cut: found.cut.clone(),
        })
    }

    /// What was collected of a scene's run.
    pub fn collected(label: String, collector: Collector) -> Self {
        Self {
            label,
            table: Table::of(collector.series, true),
            subjects: collector.subjects,
            cut: None,
        }
    }

    pub fn subject(&self, body: &str) -> Option<&Subject> {
        self.subjects.iter().find(|subject| subject.name == body)
    }

    /// Bodies that have an attitude or a place.
    pub fn bodies(&self) -> Vec<&str> {
        let mut bodies = self.table.bodies(0);
        bodies.retain(|body| {
            ["orientation", "position"]
                .iter()
                .any(|q| self.series(body, q).is_some())
        });
        bodies
    }

    pub fn series(&self, body: &str, quantity: &str) -> Option<&Series> {
        self.table.find(0, body, quantity)
    }
}

/// The bodies of the scene that a recording was made from, where this version can read it.
fn subjects(from: &Provenance) -> Vec<Subject> {
    let script = Script::new("", "", &from.text).with_files(from.files.clone());
    let scenes = script.of_variant(from.fact("variant")).scenes();
    let scene = scenes.ok().and_then(|scenes| scenes.into_iter().next());
    scene.map_or(Vec::new(), |scene| {
        Simulation::new(&scene).subjects().to_vec()
    })
}

/// Takes down what a run delivers, at the rate of the derived streams.
pub struct Collector {
    subjects: Vec<Subject>,
    quantities: Vec<&'static Quantity>,
    /// Body by body, quantity by quantity.
    series: Vec<Series>,
}

impl Collector {
    pub fn new(subjects: &[Subject], streams: StreamSet) -> Self {
        let alone = subjects.partition_point(|subject| subject.swarm.is_none());
        let subjects = subjects[..alone].to_vec();
        let quantities = streams.quantities();
        let of_body = |subject: &Subject| {
            let series =
                |q: &&Quantity| Series::new(0, &subject.name, Term::of(q), Origin::Numbers);
            quantities.iter().map(series).collect::<Vec<_>>()
        };
        Self {
            series: subjects.iter().flat_map(of_body).collect(),
            subjects,
            quantities,
        }
    }
}

impl Sink for Collector {
    fn motions(&mut self, _: &Track<'_>) -> Result<(), SinkError> {
        Ok(())
    }

    fn samples(
        &mut self,
        at: Instant,
        bodies: Range<usize>,
        samples: &[Sample],
    ) -> Result<(), SinkError> {
        let width = self.quantities.len();
        let mut values = Vec::new();
        for (body, sample) in bodies.zip(samples) {
            let Some(subject) = self.subjects.get(body) else {
                continue;
            };
            for (k, quantity) in self.quantities.iter().enumerate() {
                values.clear();
                (quantity.write)(subject, sample, &mut values);
                self.series[body * width + k].push(at.nanoseconds(), &values);
            }
        }
        Ok(())
    }

    fn note(&mut self, _: Instant, _: &Note) -> Result<(), SinkError> {
        Ok(())
    }
}
