//! Level 4: scenes, from a TOML file to something valid and complete.
//!
//! A [`Scene`] comes only from [`Scene::parse`] and is right in every respect: nothing downstream
//! checks again. Units are SI and radians; degrees exist only in the file.

mod amend;
mod body;
pub mod carried;
mod edit;
mod effect;
mod event;
mod files;
mod finding;
mod inertia;
mod inertial;
pub mod keys;
#[cfg(test)]
mod keys_tests;
mod pairing;
mod parts;
pub mod pick;
mod problem;
pub(crate) mod read;
mod script;
mod swarm;
pub(crate) mod table;
mod warnings;

pub use amend::{Amended, Entry};
pub use body::{Body, OwnMethod};
pub use effect::SceneEffect;
pub(crate) use effect::lasting;
pub use event::{Action, Change, Click, Event, Framed, Target};
pub use files::{Enclosure, Folder, Library};
pub use finding::{Finding, Place, Severity};
pub use problem::Problems;
pub use script::Script;
pub use warnings::{WARNINGS, Warning};

use crate::integrator::Method;
use crate::trace::StreamSet;
use std::path::Path;
use std::sync::Arc;

/// A scripted run.
#[derive(Clone)]
#[non_exhaustive]
pub struct Scene {
    /// The file's name without its ending; recordings are called after it.
    pub name: String,
    pub title: String,
    /// The comment that opens the file, as Markdown: what to look at.
    pub notes: String,
    /// The text that it was read from, values put in by arguments or by a sweep included.
    pub text: Arc<str>,
    /// Of that text and of the files it names: the same for the same scene.
    pub fingerprint: u64,
    /// The values that tell it from the others of its sweep: `damping = 0.1`.
    pub variant: Option<String>,
    /// The files it names, as they were read: with its text, all there is to it.
    pub enclosures: Vec<Enclosure>,
    /// s.
    pub duration: f64,
    pub stepping: Stepping,
    /// Of the clock, s: what a method of fixed steps takes, and how often a state can be recorded.
    pub step: f64,
    pub record: Record,
    /// The effects that are called for, those that are off at first too.
    pub effects: Vec<SceneEffect>,
    pub bodies: Vec<Body>,
    pub events: Vec<Event>,
}

/// How bodies get through time.
#[derive(Clone, Copy)]
pub enum Stepping {
    /// By this method.
    Method {
        method: &'static dyn Method,
        /// Error a step that a method with steps of its own may make, relative to the state.
        tolerance: f64,
    },
    /// By whatever is cheapest of what keeps attitudes this true, rad.
    Accuracy(f64),
}

impl Stepping {
    /// In a word.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Method { method, .. } => method.info().name,
            Self::Accuracy(_) => "chosen by accuracy",
        }
    }
}

/// What is recorded, and how often.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Record {
    /// Derived streams: samples per simulated second. Events always.
    pub rate: f64,
    pub state: Rate,
    pub streams: StreamSet,
    /// Streams that go at a rate of their own, each once.
    pub rates: Vec<(StreamSet, Rate)>,
}

impl Record {
    /// The highest rate that is asked for, 1/s; every step counts as the derived streams' rate.
    fn fastest(&self) -> f64 {
        let own = self.rates.iter().map(|(_, rate)| *rate);
        own.chain([self.state])
            .filter_map(|rate| match rate {
                Rate::EveryStep => None,
                Rate::PerSecond(rate) => Some(rate),
            })
            .fold(self.rate, f64::max)
    }

    /// The streams by how often they are due: those at `rate` first, whether there are any or not.
    pub fn bands(&self) -> Vec<(Rate, StreamSet)> {
        let mut bands = vec![(Rate::PerSecond(self.rate), self.streams)];
        for &(stream, rate) in &self.rates {
            let stream = stream.and(self.streams);
            if stream.is_empty() {
                continue;
            }
            bands[0].1 = bands[0].1.without(stream);
            match bands.iter_mut().find(|(known, _)| *known == rate) {
                Some((_, band)) => *band = band.with(stream),
                None => bands.push((rate, stream)),
            }
        }
        bands
    }
}

/// How often something is recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rate {
    EveryStep,
    /// Samples per simulated second.
    PerSecond(f64),
}

/// Why there is no scene.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    #[error("{file}: cannot be read: {why}; {remedy}")]
    Unreadable {
        file: String,
        why: String,
        remedy: String,
    },
    #[error(transparent)]
    Wrong(#[from] Problems),
}

impl SceneError {
    /// What is wrong, each with its place.
    pub fn findings(&self) -> Vec<Finding> {
        match self {
            Self::Wrong(problems) => problems.findings(),
            Self::Unreadable { file, why, remedy } => vec![Finding {
                code: "unreadable",
                message: format!("cannot be read: {why}"),
                remedy: Some(remedy.clone()),
                ..Finding::at(file, "", &problem::At::File(0..0))
            }],
        }
    }
}

/// A scene's bytes at most: 10,000 bodies take two million, more are made by a swarm; and while it is read
/// each byte takes a hundred.
const LARGEST: u64 = 1 << 23;

impl Scene {
    /// Bodies that are in no swarm: the first.
    pub fn outside_swarms(&self) -> usize {
        self.bodies.partition_point(|body| body.swarm.is_none())
    }

    /// Reads and checks a scene file, or a scene that the program carries, such as `@cone`.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        Ok(Script::load(path)?.scene()?)
    }

    /// Why the scene's method does not take the torques it has; a scene that was parsed has no such
    /// reason, one that was given another method may.
    pub fn refusal(&self) -> Option<String> {
        pairing::refusal(self)
    }

    /// Checks the text of a scene that names no other files ([`Script::with_files`] is for one that does,
    /// [`Script::judge`] tells what about it is probably wrong too); `file` is how messages call it.
    pub fn parse(file: &str, name: &str, source: &str) -> Result<Self, Problems> {
        Script::new(file, name, source).scene()
    }

    /// Checks the text of a scene; the files that it names (meshes, robots) come from a library: a
    /// [`Folder`], or the [`Enclosure`]s of an earlier reading.
    pub fn parse_with(
        file: &str,
        name: &str,
        source: &str,
        library: impl Library + 'static,
    ) -> Result<Self, Problems> {
        Script::new(file, name, source).with_files(library).scene()
    }
}
