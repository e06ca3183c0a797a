//! What happens when, and how the log says it.

use crate::scene::{Action, Event, Scene};
use crate::trace::{Moment, Note, NoteKind, Subject, short_vector};
use nalgebra::Vector3;

/// The begin or the end of an event, by its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Happening {
    Ends(usize),
    Begins(usize),
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
    subjects: &[Subject],
    moments: &[Moment],
    jump: Option<(Vector3<f64>, Vector3<f64>)>,
) -> Note {
    let name = &subjects[event.body].name;
    let moment = &moments[event.body];
    let (text, kind) = match (event.action, jump) {
        (_, Some((angular, turn))) => (
            format!(
                "{} on {name}: ΔL = {} N·m·s about the {}, Δω = {} rad/s",
                noun(&event.action),
                short_vector(angular),
                subjects[event.body].reference(),
                short_vector(turn)
            ),
            NoteKind::Instant,
        ),
        _ => (
            format!(
                "{} on {name} begins: τ = {} N·m, α = {} rad/s²",
                noun(&event.action),
                short_vector(moment.tau_w),
                short_vector(moment.alpha_w)
            ),
            NoteKind::Begins,
        ),
    };
    Note {
        body: event.body,
        text,
        kind,
    }
}

pub fn end_note(event: &Event, subjects: &[Subject], moments: &[Moment]) -> Note {
    let omega = short_vector(moments[event.body].motion.omega_w);
    Note {
        body: event.body,
        text: format!(
            "{} on {} ends: ω = {omega} rad/s",
            noun(&event.action),
            subjects[event.body].name
        ),
        kind: NoteKind::Ends,
    }
}

fn noun(action: &Action) -> &'static str {
    match action {
        Action::Push { .. } => "push",
        Action::Torque { .. } => "torque",
        Action::Impulse { .. } => "impulse",
        Action::AngularImpulse { .. } => "angular impulse",
    }
}
