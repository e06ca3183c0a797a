//! Level 4: scenes, from a TOML file to something valid and complete.
//!
//! A [`Scene`] comes only from [`Scene::parse`] and is right in every respect: nothing downstream
//! checks again. Units are SI and radians; degrees exist only in the file.

mod body;
pub mod carried;
mod event;
mod finding;
pub mod keys;
#[cfg(test)]
mod keys_tests;
mod pairing;
mod problem;
mod read;
mod source;
mod table;
mod warnings;

pub use body::Body;
pub use event::{Action, Event, Framed};
pub use finding::{Finding, Place, Severity};
pub(crate) use pairing::lasting;
pub use problem::Problems;
pub use source::Source;
pub use warnings::{WARNINGS, Warning};

use crate::effect::Called;
use crate::integrator::Method;
use crate::trace::StreamSet;
use std::path::Path;

/// A scripted run.
#[derive(Clone)]
#[non_exhaustive]
pub struct Scene {
    /// The file's name without its ending; recordings are called after it.
    pub name: String,
    pub title: String,
    /// The comment that opens the file, as Markdown: what to look at.
    pub notes: String,
    /// Of the file's text: the same for the same scene.
    pub fingerprint: u64,
    /// s.
    pub duration: f64,
    pub stepping: Stepping,
    /// Of the clock, s: what a method of fixed steps takes, and how often a state can be recorded.
    pub step: f64,
    pub record: Record,
    /// The effects that are called for; those switched off are not here.
    pub effects: Vec<(&'static str, Called)>,
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
    pub state: StateRate,
    pub streams: StreamSet,
}

impl Record {
    /// The highest rate that is asked for, 1/s; every step counts as the derived streams' rate.
    fn fastest(&self) -> f64 {
        match self.state {
            StateRate::EveryStep => self.rate,
            StateRate::PerSecond(rate) => rate.max(self.rate),
        }
    }
}

/// How often the state (pose and angular velocity) is recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StateRate {
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
                ..Finding::at(file, "", &(0..0))
            }],
        }
    }
}

impl Scene {
    /// Reads and checks a scene file.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        Ok(Source::read(path)?.scene()?)
    }

    /// Why the scene's method does not take the torques it has; a scene that was parsed has no such
    /// reason, one that was given another method may.
    pub fn refusal(&self) -> Option<String> {
        pairing::refusal(self)
    }

    /// Checks the text of a scene; `file` is how messages call it.
    pub fn parse(file: &str, name: &str, source: &str) -> Result<Self, Problems> {
        Ok(read::scene((file, name, source), false)?.0)
    }

    /// Checks the text of a scene and judges it: beside the scene what is legal and probably wrong, but
    /// for what the scene says is meant.
    pub fn judge(file: &str, name: &str, source: &str) -> Result<(Self, Vec<Finding>), Problems> {
        read::scene((file, name, source), true)
    }
}
