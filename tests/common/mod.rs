//! What several suites share. Each takes what it needs.
#![allow(dead_code)]

use std::ops::Range;
use std::path::Path;
use torquescope::cost::Plan;
use torquescope::scene::{Scene, Stepping};
use torquescope::sim::{Outcome, Simulation};
use torquescope::trace::{Instant, Note, Sample, Sink, SinkError, Subject, Track};

/// A sink that keeps nothing.
pub struct Nowhere;

impl Sink for Nowhere {
    fn motions(&mut self, _: &Track<'_>) -> Result<(), SinkError> {
        Ok(())
    }
    fn samples(&mut self, _: Instant, _: Range<usize>, _: &[Sample]) -> Result<(), SinkError> {
        Ok(())
    }
    fn note(&mut self, _: Instant, _: &Note) -> Result<(), SinkError> {
        Ok(())
    }
}

/// Keeps everything that is delivered: samples by body, instants of the first body's states.
#[derive(Default)]
pub struct Memory {
    pub samples: Vec<(Instant, usize, Sample)>,
    pub states: Vec<Instant>,
    pub notes: Vec<(Instant, Note)>,
}

impl Sink for Memory {
    fn motions(&mut self, track: &Track<'_>) -> Result<(), SinkError> {
        if track.bodies.start == 0 {
            self.states.extend(track.instants);
        }
        Ok(())
    }

    fn samples(
        &mut self,
        at: Instant,
        bodies: Range<usize>,
        samples: &[Sample],
    ) -> Result<(), SinkError> {
        let rows = bodies.zip(samples);
        self.samples
            .extend(rows.map(|(body, sample)| (at, body, sample.clone())));
        Ok(())
    }

    fn note(&mut self, at: Instant, note: &Note) -> Result<(), SinkError> {
        self.notes.push((at, note.clone()));
        Ok(())
    }
}

impl Memory {
    /// What the log says, line by line.
    pub fn texts(&self) -> Vec<&str> {
        self.notes.iter().map(|(_, note)| &*note.text).collect()
    }

    /// The rows of a body at a time, in order.
    pub fn at(&self, body: usize, time: f64) -> Vec<&Sample> {
        let rows = self.samples.iter();
        rows.filter(|(at, b, _)| at.time == time && *b == body)
            .map(|(_, _, sample)| sample)
            .collect()
    }
}

/// A shipped scene.
pub fn load(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenes")
        .join(name);
    Scene::load(&path).unwrap_or_else(|error| panic!("{error}"))
}

/// Runs a scene the way it says.
pub fn run(scene: &Scene) -> (Vec<Subject>, Outcome, Memory) {
    let simulation = Simulation::new(scene);
    let subjects = simulation.subjects().to_vec();
    let mut memory = Memory::default();
    let (outcome, done) = match scene.stepping {
        Stepping::Method { .. } => simulation.run(&mut memory),
        Stepping::Accuracy(_) => {
            let plan = Plan::of(scene).unwrap_or_else(|error| panic!("{error}"));
            simulation.run_by(&mut plan.chooser(), &mut memory)
        }
    };
    done.unwrap();
    (subjects, outcome, memory)
}
