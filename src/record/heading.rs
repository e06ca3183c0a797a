//! What a recording says of itself, besides its trace.

use super::provenance::Provenance;
use super::scale::Scales;
use crate::cost::Cost;
use crate::scene::{Rate, Scene};
use crate::sim::Simulation;
use crate::trace::StreamSet;

/// Title, notes and how it opens.
pub struct Heading {
    pub title: String,
    /// What tells it from other recordings of the scene: `damping = 0.1`.
    pub variant: Option<String>,
    /// Whether it is one of several in a file, among which a viewer is to choose.
    pub one_of_several: bool,
    /// What it is made from, where it can be run again from that.
    pub provenance: Option<Provenance>,
    /// Simulated seconds a second at which it opens; by the shortest event where nothing is said.
    pub speed: Option<f64>,
    /// Markdown: what the scene shows and what to look for.
    pub notes: String,
    /// Tells recordings apart in a viewer; the same for the same scene.
    pub id: String,
    /// s.
    pub duration: f64,
    /// Of the derived streams that have none of their own, 1/s.
    pub rate: f64,
    /// Of those that last, s.
    pub shortest_event: Option<f64>,
    pub has_pushes: bool,
    pub has_impulses: bool,
    pub streams: StreamSet,
    /// The same in sets that are due together, each with how often that is, 1/s.
    pub bands: Vec<(f64, StreamSet)>,
    /// What accuracy costs on the scene, where that is what the recording is about.
    pub price: Option<Cost>,
    pub(super) scales: Scales,
}

impl Heading {
    pub fn of(scene: &Scene, simulation: &Simulation<'_>) -> Self {
        let lasting = scene
            .events
            .iter()
            .map(|event| event.action.lasts())
            .filter(|&s| s > 0.0);
        let bands = scene.record.bands().into_iter();
        let steps = 1.0 / scene.step;
        let per_second = |rate| match rate {
            Rate::EveryStep => steps,
            Rate::PerSecond(rate) => steps.min(rate),
        };
        Self {
            title: scene.title.clone(),
            variant: scene.variant.clone(),
            one_of_several: false,
            provenance: None,
            speed: None,
            notes: scene.notes.clone(),
            id: format!("{}-{:016x}", scene.name, scene.fingerprint),
            duration: scene.duration,
            rate: scene.record.rate,
            shortest_event: lasting.min_by(f64::total_cmp),
            has_pushes: scene.events.iter().any(|event| event.action.pushes()),
            has_impulses: scene.events.iter().any(|event| event.action.strikes()),
            streams: scene.record.streams,
            bands: bands
                .map(|(rate, streams)| (per_second(rate), streams))
                .collect(),
            price: None,
            scales: Scales::new(simulation.subjects(), &simulation.expected()),
        }
    }

    /// Draws several recordings on one scale, so that arrows can be compared by their lengths.
    pub fn share_scales(headings: &mut [Self]) {
        let scales = headings.iter().map(|heading| heading.scales.clone());
        let Some(shared) = scales.reduce(Scales::smaller) else {
            return;
        };
        for heading in headings {
            heading.scales = shared.clone();
        }
    }

    /// As a viewer lists it: what tells it from others first.
    pub fn name(&self) -> String {
        match &self.variant {
            None => self.title.clone(),
            Some(variant) => format!("{variant} · {}", self.title),
        }
    }

    /// How large the bodies are, m.
    pub fn size(&self) -> f64 {
        self.scales.size
    }

    /// How long the arrow of an impulse stays, s: a quarter of a second, less in a short scene.
    pub fn impulse_shown_for(&self) -> f64 {
        (self.duration / 8.0).min(0.25)
    }
}
