//! Which of a body's torques did this? One colour, one arrow and one line a source.
//!
//! Numbers are at `/numbers/NAME/torque/SOURCE`, component by component, so that a plot can show how
//! the parts add up along an axis; their sum, `I α`, is at `/numbers/NAME/torque/sum`. Arrows are at
//! `/sources/SOURCE/NAME`, at the scale of the torque.

use super::RecordError;
use super::columns::{Ends, Times, numbers};
use super::look::{self, Colour};
use super::picture::{Picture as _, Shown, VectorPicture};
use super::recorder::number_descriptor;
use super::rrd::RrdFile;
use super::scale::Scales;
use crate::trace::{Instant, Sample, Subject};
use nalgebra::Vector3;
use std::sync::Arc;

/// The components of a torque, and its length.
pub const PARTS: [&str; 4] = ["x", "y", "z", "length"];

/// What the sum of all parts is called.
pub const SUM: &str = "sum";

/// Every source of any body, each once: its place is its colour.
pub fn all_names(subjects: &[Subject]) -> Vec<&str> {
    let mut all: Vec<&str> = Vec::new();
    for name in subjects.iter().flat_map(|subject| &subject.sources) {
        if !all.contains(&name.as_str()) {
            all.push(name);
        }
    }
    all
}

/// The colour of a source among all.
pub fn colour(name: &str, all: &[&str]) -> Colour {
    let place = all.iter().position(|other| *other == name).unwrap_or(0);
    look::SOURCES[place % look::SOURCES.len()]
}

/// Where the numbers of a source are.
pub fn numbers_path(subject: &Subject, source: &str) -> String {
    format!("/numbers/{}/torque/{source}", subject.name)
}

/// The sources of one body, on their way into a file.
#[derive(Clone)]
pub struct Sources {
    times: Times,
    /// The parts of each source, and of the sum of all.
    values: Vec<[Vec<f64>; 4]>,
    pictures: Vec<VectorPicture>,
}

impl Sources {
    /// None where a body's torques are not told apart.
    pub fn of(subject: &Subject, all: &[&str], scales: &Scales) -> Option<Self> {
        if subject.sources.is_empty() {
            return None;
        }
        let picture = |(k, name): (usize, &String)| {
            let shown = Shown {
                stream: format!("sources/{name}"),
                symbol: name.clone(),
                unit: "N·m",
                colour: colour(name, all),
                scale: scales.of_stream("torque"),
                value: Arc::new(move |_, sample| {
                    sample.sources.get(k).copied().unwrap_or_default()
                }),
            };
            VectorPicture::new(shown).turning()
        };
        Some(Self {
            times: Times::default(),
            values: vec![Default::default(); subject.sources.len() + 1],
            pictures: subject.sources.iter().enumerate().map(picture).collect(),
        })
    }

    pub fn statics(&self, file: &mut RrdFile, subject: &Subject) -> Result<(), RecordError> {
        let mut pictures = self.pictures.iter();
        pictures.try_for_each(|picture| picture.statics(file, subject))
    }

    pub fn row(&mut self, at: Instant, subject: &Subject, sample: &Sample) {
        self.times.push(at);
        let sum: Vector3<f64> = sample.sources.iter().sum();
        for (values, torque) in self
            .values
            .iter_mut()
            .zip(sample.sources.iter().chain([&sum]))
        {
            let parts = [torque.x, torque.y, torque.z, torque.norm()];
            for (column, part) in values.iter_mut().zip(parts) {
                column.push(part);
            }
        }
        let pictures = self.pictures.iter_mut().filter(|_| sample.shown);
        pictures.for_each(|picture| picture.row(at, subject, sample));
    }

    /// Writes what has so many rows, of numbers and of pictures.
    pub fn flush_from(
        &mut self,
        (numbers, pictures): (usize, usize),
        file: &mut RrdFile,
        subject: &Subject,
    ) -> Result<(), RecordError> {
        if self.times.len() >= numbers {
            self.flush_numbers(file, subject)?;
        }
        for picture in &mut self.pictures {
            if picture.rows() >= pictures {
                picture.flush(file, subject)?;
            }
        }
        Ok(())
    }

    fn flush_numbers(&mut self, file: &mut RrdFile, subject: &Subject) -> Result<(), RecordError> {
        let times = std::mem::take(&mut self.times);
        let ends = Ends::uniform(times.len(), 1);
        let names = subject.sources.iter().map(String::as_str).chain([SUM]);
        for (name, values) in names.zip(&mut self.values) {
            let columns = PARTS.into_iter().zip(std::mem::take(values));
            let columns = columns
                .map(|(part, values)| numbers(number_descriptor(part), values, ends.clone()));
            file.columns(numbers_path(subject, name), &times, columns.collect())?;
        }
        Ok(())
    }
}
