//! What happens when, and how the log says it.

use super::Jump;
use crate::scene::{Event, Scene};
use crate::trace::{Note, NoteKind, Sample, Subject, short_vector};
use nalgebra::Vector3;

/// The begin or the end of an event, by its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Happening {
    Ends(usize),
    Begins(usize),
}

impl Happening {
    /// Index of the event.
    pub fn event(self) -> usize {
        let (Self::Ends(k) | Self::Begins(k)) = self;
        k
    }
}

/// The events that begin with the scene.
pub fn at_start(scene: &Scene) -> Vec<Happening> {
    let begins = |(k, event): (usize, &Event)| (event.at == 0.0).then_some(Happening::Begins(k));
    scene.events.iter().enumerate().filter_map(begins).collect()
}

/// Everything later, in order of time; at one instant ends come before begins.
pub fn after_start(scene: &Scene) -> Vec<(f64, Happening)> {
    let mut all = Vec::new();
    for (k, event) in scene.events.iter().enumerate() {
        if event.at > 0.0 {
            all.push((event.at, Happening::Begins(k)));
        }
        if event.action.lasts() > 0.0 {
            all.push((event.at + event.action.lasts(), Happening::Ends(k)));
        }
    }
    let rank = |happening: &Happening| matches!(happening, Happening::Begins(_));
    all.sort_by(|(t, a), (u, b)| t.total_cmp(u).then(rank(a).cmp(&rank(b))));
    all
}

pub fn begin_note(
    event: &Event,
    subject: &Subject,
    (tau_w, sample): (Vector3<f64>, &Sample),
    jump: Option<Jump>,
) -> Note {
    let what = format!("{} on {}", event.action.noun(), subject.name);
    let (text, kind) = match jump {
        Some(jump) => (
            format!(
                "{what}: ΔL = {} N·m·s about the {}, Δω = {} rad/s",
                short_vector(jump.angular_impulse_w),
                subject.reference(),
                short_vector(jump.omega_w)
            ),
            NoteKind::Instant,
        ),
        None => (
            format!(
                "{what} begins: τ = {} N·m; the body's α = {} rad/s²",
                short_vector(tau_w),
                short_vector(sample.alpha_w)
            ),
            NoteKind::Begins,
        ),
    };
    Note {
        body: event.body,
        text,
        kind,
        strike: jump.and_then(|jump| jump.strike),
    }
}

pub fn end_note(event: &Event, subject: &Subject, sample: &Sample) -> Note {
    let omega = short_vector(sample.motion.omega_w);
    let what = format!("{} on {}", event.action.noun(), subject.name);
    Note {
        body: event.body,
        text: format!("{what} ends: ω = {omega} rad/s"),
        kind: NoteKind::Ends,
        strike: None,
    }
}
