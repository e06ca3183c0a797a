//! Level 4: scenes, from a TOML file to something valid and complete.
//!
//! A [`Scene`] comes only from [`Scene::parse`] and is right in every respect: nothing downstream
//! checks again. Units are SI and radians; degrees exist only in the file.

mod body;
mod edit;
mod effect;
mod event;
mod files;
mod inertia;
mod inertial;
mod pairing;
mod parts;
pub mod pick;
mod problem;
mod read;
mod script;
mod swarm;
mod table;

pub use body::{Body, OwnMethod, Swarm};
pub use effect::SceneEffect;
pub(crate) use effect::lasting;
pub use event::{Action, Change, Click, Event, Framed, Target};
pub use files::{Enclosure, Folder, Library};
pub use problem::Problems;
pub use script::Script;

use crate::integrator::Method;
use crate::trace::StreamSet;
use std::io::Read as _;
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
    /// Which of the bodies belong together.
    pub swarms: Vec<Swarm>,
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

impl Scene {
    /// Reads and checks a scene file.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        Ok(Script::load(path)?.scene()?)
    }

    /// Why the scene's method does not take the torques it has; a scene that was parsed has no such
    /// reason, one that was given another method may.
    pub fn refusal(&self) -> Option<String> {
        pairing::refusal(self)
    }

    /// Checks the text of a scene that names no other files; `file` is how messages call it.
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

/// What messages call a file, the name of its scene, and its text.
fn text_of(path: &Path) -> Result<(String, String, String), SceneError> {
    let file = path.display().to_string();
    let source = read_to_string(path).map_err(|error| SceneError::Unreadable {
        why: error.to_string(),
        remedy: remedy_for(path, &error),
        file: file.clone(),
    })?;
    let name = path.file_stem().map_or_else(
        || "scene".to_owned(),
        |stem| stem.to_string_lossy().into_owned(),
    );
    Ok((file, name, source))
}

/// A scene's bytes at most: 10,000 bodies take two million.
const LARGEST: u64 = 1 << 26;

fn read_to_string(path: &Path) -> std::io::Result<String> {
    let mut source = String::new();
    let file = std::fs::File::open(path)?;
    if file.take(LARGEST + 1).read_to_string(&mut source)? as u64 > LARGEST {
        let why = format!("it is larger than any scene ({LARGEST} bytes)");
        return Err(std::io::Error::other(why));
    }
    Ok(source)
}

fn remedy_for(path: &Path, error: &std::io::Error) -> String {
    if error.kind() == std::io::ErrorKind::InvalidData {
        return "a scene is a text in UTF-8".to_owned();
    }
    if path.is_dir() {
        return "name a scene file, not a folder".to_owned();
    }
    if error.kind() != std::io::ErrorKind::NotFound {
        return "a scene is a TOML file that you may read".to_owned();
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let scenes: Vec<String> = std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .filter(|name| name.ends_with(".toml") && name != "Cargo.toml")
        .collect();
    let wanted = path.file_name().unwrap_or_default().to_string_lossy();
    match scenes.iter().map(String::as_str).collect::<Vec<_>>() {
        names if names.is_empty() => "`torquescope scenes` lists the scenes there are".to_owned(),
        mut names => {
            names.sort_unstable();
            table::nearest(&wanted, &names)
        }
    }
}
