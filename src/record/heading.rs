//! What a recording says of itself, besides its trace.

use super::scale::Scales;
use crate::cost::Cost;
use crate::scene::Scene;
use crate::sim::Simulation;
use crate::trace::StreamSet;

/// Title, notes and how it opens.
pub struct Heading {
    pub title: String,
    /// Markdown: what the scene shows and what to look for.
    pub notes: String,
    /// Tells recordings apart in a viewer; the same for the same scene.
    pub id: String,
    /// s.
    pub duration: f64,
    /// Of the derived streams, 1/s.
    pub rate: f64,
    /// Of those that last, s.
    pub shortest_event: Option<f64>,
    pub has_pushes: bool,
    pub has_impulses: bool,
    pub streams: StreamSet,
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
        Self {
            title: scene.title.clone(),
            notes: scene.notes.clone(),
            id: format!("{}-{:016x}", scene.name, scene.fingerprint),
            duration: scene.duration,
            rate: scene.record.rate,
            shortest_event: lasting.min_by(f64::total_cmp),
            has_pushes: scene.events.iter().any(|event| event.action.pushes()),
            has_impulses: scene.events.iter().any(|event| event.action.strikes()),
            streams: scene.record.streams,
            price: None,
            scales: Scales::new(simulation.subjects(), &simulation.expected()),
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
