//! The derived streams of a body that are due together, on their way into a file: one clock for all of them.

use super::RecordError;
use super::columns::{self, Ends, Times, numbers};
use super::heading::Heading;
use super::page;
use super::picture::{Picture, pictures};
use super::recorder::number_descriptor;
use super::rrd::RrdFile;
use super::sources::Sources;
use crate::trace::{Instant, Quantity, Sample, StreamSet, Subject};
use rerun::archetypes::TextDocument;
use rerun::components::MediaType;

#[derive(Clone)]
pub struct Band {
    pub streams: StreamSet,
    /// Rows of a chunk: of numbers, and of what is drawn or read.
    rows: (usize, usize),
    times: Times,
    /// Each with its numbers, row by row.
    quantities: Vec<(&'static Quantity, Vec<f64>, Ends)>,
    pictures: Vec<Box<dyn Picture>>,
    /// Where its torques are told apart.
    pub sources: Option<Sources>,
    pub pages: Option<Pages>,
}

/// Pages to read, with the numbers of all streams.
#[derive(Clone)]
pub struct Pages {
    quantities: Vec<&'static Quantity>,
    times: Times,
    texts: Vec<String>,
}

impl Pages {
    pub fn of(streams: StreamSet) -> Self {
        Self {
            quantities: streams.quantities(),
            times: Times::default(),
            texts: Vec::new(),
        }
    }
}

impl Band {
    pub fn new(streams: StreamSet, heading: &Heading, rows: (usize, usize)) -> Self {
        let quantities = streams.quantities().into_iter();
        Self {
            streams,
            rows,
            times: Times::default(),
            quantities: quantities
                .map(|quantity| (quantity, Vec::new(), Ends::default()))
                .collect(),
            pictures: pictures(streams, &heading.scales),
            sources: None,
            pages: None,
        }
    }

    pub fn statics(&self, file: &mut RrdFile, subject: &Subject) -> Result<(), RecordError> {
        for picture in &self.pictures {
            picture.statics(file, subject)?;
        }
        if let Some(sources) = &self.sources {
            sources.statics(file, subject)?;
        }
        if self.pages.is_some() {
            let markdown = TextDocument::update_fields().with_media_type(MediaType::markdown());
            file.statics(format!("/pages/{}", subject.name), &[&markdown])?;
        }
        Ok(())
    }

    /// Adds a row.
    pub fn sample(&mut self, at: Instant, subject: &Subject, sample: &Sample) {
        self.times.push(at);
        for (quantity, values, ends) in &mut self.quantities {
            let before = values.len();
            (quantity.write)(subject, sample, values);
            ends.push(values.len() - before);
        }
        let pictures = self.pictures.iter_mut().filter(|_| sample.shown);
        pictures.for_each(|picture| picture.row(at, subject, sample));
        if let Some(sources) = &mut self.sources {
            sources.row(at, subject, sample);
        }
        if let Some(pages) = &mut self.pages {
            let page = page::page(subject, at, sample, &pages.quantities);
            pages.times.push(at);
            pages.texts.push(page);
        }
    }

    /// Writes what fills a chunk.
    pub fn flush_full(&mut self, file: &mut RrdFile, subject: &Subject) -> Result<(), RecordError> {
        self.flush_from(self.rows, file, subject)
    }

    /// Writes what was added.
    pub fn flush(&mut self, file: &mut RrdFile, subject: &Subject) -> Result<(), RecordError> {
        self.flush_from((1, 1), file, subject)
    }

    /// Writes what has so many rows.
    fn flush_from(
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
        if let Some(sources) = &mut self.sources {
            sources.flush_from((numbers, pictures), file, subject)?;
        }
        if let Some(pages) = &mut self.pages
            && pages.texts.len() >= pictures
        {
            let (times, texts) = (
                std::mem::take(&mut pages.times),
                std::mem::take(&mut pages.texts),
            );
            let ends = Ends::uniform(texts.len(), 1);
            let text = columns::texts(TextDocument::descriptor_text(), texts, ends);
            file.columns(format!("/pages/{}", subject.name), &times, vec![text])?;
        }
        Ok(())
    }

    fn flush_numbers(&mut self, file: &mut RrdFile, subject: &Subject) -> Result<(), RecordError> {
        let times = std::mem::take(&mut self.times);
        let columns = self.quantities.iter_mut().map(|(quantity, values, ends)| {
            let (values, ends) = (std::mem::take(values), std::mem::take(ends));
            numbers(number_descriptor(quantity.name), values, ends)
        });
        let columns: Vec<_> = columns.collect();
        match columns.is_empty() {
            true => Ok(()),
            false => file.columns(format!("/numbers/{}", subject.name), &times, columns),
        }
    }
}
