//! What happens when, what acts now, and how the log says it.

use super::Jump;
use crate::effect::Profile;
use crate::scene::pick::Picked;
use crate::scene::{Action, Change, Event, Scene, Target};
use crate::trace::{Note, NoteKind, PointForce, Sample, Subject, short_numbers, short_vector};
use nalgebra::Vector3;
use std::ops::Range;

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

/// A note moves nothing: it is written when its time has come, and the clock does not stop for it.
fn stops_the_clock(event: &Event) -> bool {
    !matches!(event.target, Target::Log(_))
}

/// The events that begin with the scene.
pub fn at_start(scene: &Scene) -> Vec<Happening> {
    let begins = |(k, event): (usize, &Event)| {
        (event.at == 0.0 && stops_the_clock(event)).then_some(Happening::Begins(k))
    };
    scene.events.iter().enumerate().filter_map(begins).collect()
}

/// Everything later, in order of time; at one instant ends come before begins, and begins in the order
/// of the file.
pub fn after_start(scene: &Scene) -> Vec<(f64, Happening)> {
    let mut all = Vec::new();
    let events = scene.events.iter().enumerate();
    for (k, event) in events.filter(|(_, event)| stops_the_clock(event)) {
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

/// The scene's notes by their times.
pub fn notes(scene: &Scene) -> Vec<(f64, Note)> {
    let note = |event: &Event| match (&event.target, &event.action) {
        (Target::Log(body), Action::Note(text)) => Some((
            event.at,
            Note {
                body: *body,
                text: text.to_string(),
                kind: NoteKind::Remark,
                strike: None,
            },
        )),
        _ => None,
    };
    let mut notes: Vec<(f64, Note)> = scene.events.iter().filter_map(note).collect();
    notes.sort_by(|(t, _), (u, _)| t.total_cmp(u));
    notes
}

/// What acts besides the bodies' own inertia.
#[derive(Clone, Debug, Default)]
pub struct Acting {
    /// Which of the scene's effects are on, in their order.
    pub on: Vec<bool>,
    /// The events that last and act now, in the order in which they began.
    pub events: Vec<Lasting>,
}

/// An event that lasts, on its body: a click as the push that it came to.
#[derive(Clone, Debug)]
pub struct Lasting {
    /// Of the scene's event.
    pub index: usize,
    pub body: usize,
    pub event: Event,
}

impl Acting {
    /// As a scene starts, before its events.
    pub fn at_start(scene: &Scene) -> Self {
        Self {
            on: scene.on_at_start(),
            events: Vec::new(),
        }
    }

    /// Whether a happening is known to touch one of these bodies. Whom a ray will hit is not known
    /// before, nor what is unforeseen.
    pub fn touches(&self, scene: &Scene, happening: Happening, bodies: &Range<usize>) -> bool {
        let index = happening.event();
        let event = &scene.events[index];
        let acts = || {
            let acting = self.events.iter().find(|acting| acting.index == index);
            acting.is_some_and(|acting| bodies.contains(&acting.body))
        };
        if event.unforeseen {
            return matches!(happening, Happening::Ends(_)) && acts();
        }
        match &event.target {
            Target::Body(body) => bodies.contains(body),
            Target::All => true,
            Target::Log(_) => false,
            Target::Hit(_) => match happening {
                Happening::Begins(_) => false,
                Happening::Ends(_) => acts(),
            },
        }
    }
}

/// What came of a happening.
pub struct Applied {
    /// Of the scene's event.
    pub index: usize,
    /// Where a ray hit.
    pub picked: Option<Picked>,
    pub done: Done,
}

pub enum Done {
    /// What lasts acts from here on.
    Begun(Lasting),
    Ended(usize),
    Struck(usize, Jump),
    Set(usize),
    Switched,
    /// Another method from here on.
    Changed,
    /// A ray that hit nothing.
    Missed,
}

/// What a scene's event is called, with its name where it has one.
pub fn called(event: &Event) -> String {
    match &event.name {
        Some(name) => format!("{name} ({})", event.action.noun()),
        None => event.action.noun().to_owned(),
    }
}

/// `push on NAME`, or of a click where it hit.
fn on_body(event: &Event, subject: &Subject, picked: Option<&Picked>) -> String {
    let at = picked.map_or_else(String::new, |picked| {
        format!(" at {} m", short_vector(picked.point_w))
    });
    format!("{} on {}{at}", called(event), subject.name)
}

/// What an event does as it begins: by itself, at its peak.
#[derive(Default)]
pub struct Own {
    /// About the reference point, world, N·m.
    pub tau_w: Vector3<f64>,
    pub push: Option<PointForce>,
}

pub fn begin_note(
    (event, picked): (&Event, Option<&Picked>),
    (body, subject): (usize, &Subject),
    (own, sample): (&Own, &Sample),
) -> Note {
    let what = on_body(event, subject, picked);
    let tau = short_vector(own.tau_w);
    let text = match event.action.profile() {
        Profile::Box => format!(
            "{what} begins: τ = {tau} N·m; the body's α = {} rad/s²",
            short_vector(sample.alpha_w)
        ),
        profile => format!(
            "{what} begins: τ = {tau} N·m at the peak of its {}",
            profile.name()
        ),
    };
    Note {
        body: Some(body),
        text,
        kind: NoteKind::Begins,
        strike: None,
    }
}

pub fn strike_note(
    (event, picked): (&Event, Option<&Picked>),
    (body, subject): (usize, &Subject),
    jump: Jump,
) -> Note {
    let text = format!(
        "{}: ΔL = {} N·m·s about the {}, Δω = {} rad/s",
        on_body(event, subject, picked),
        short_vector(jump.angular_impulse_w),
        subject.reference(),
        short_vector(jump.omega_w)
    );
    Note {
        body: Some(body),
        text,
        kind: NoteKind::Instant,
        strike: jump.strike,
    }
}

pub fn end_note(event: &Event, (body, subject): (usize, &Subject), sample: &Sample) -> Note {
    let omega = short_vector(sample.motion.omega_w);
    let what = on_body(event, subject, None);
    Note {
        body: Some(body),
        text: format!("{what} ends: ω = {omega} rad/s"),
        kind: NoteKind::Ends,
        strike: None,
    }
}

pub fn set_note(event: &Event, (body, subject): (usize, &Subject)) -> Note {
    let change = match event.action {
        Action::Set(change) => change,
        _ => Change::default(),
    };
    let vectors = [
        ("position", change.position_w, "m"),
        ("velocity", change.velocity_w, "m/s"),
        ("ω", change.omega_w, "rad/s"),
    ];
    let vectors = vectors.into_iter().filter_map(|(name, vector, unit)| {
        Some(format!("{name} = {} {unit}", short_vector(vector?)))
    });
    let attitude = change.q_wb.map(|q| {
        let numbers = short_numbers(q.coords.as_slice());
        format!("orientation = ({})", numbers.join(", "))
    });
    let all: Vec<String> = vectors.chain(attitude).collect();
    Note {
        body: Some(body),
        text: format!("{}: {}", on_body(event, subject, None), all.join(", ")),
        kind: NoteKind::Set,
        strike: None,
    }
}

pub fn switch_note(event: &Event, scene: &Scene) -> Note {
    let text = match event.action {
        Action::Switch { effect, on } => {
            let name = scene.effects.get(effect).map_or("", |effect| &*effect.name);
            format!(
                "{}: {name} {}",
                called(event),
                if on { "on" } else { "off" }
            )
        }
        _ => called(event),
    };
    remark(text)
}

pub fn method_note(event: &Event) -> Note {
    let by = match &event.action {
        Action::Method(own) => own.method.info().name,
        _ => "",
    };
    remark(format!("{}: {by} from here on", called(event)))
}

pub fn miss_note(event: &Event) -> Note {
    let ray = match &event.action {
        Action::Click(click) => format!(
            ": the ray from {} m along {} hits nothing",
            short_vector(click.ray_w.origin),
            short_vector(click.ray_w.direction)
        ),
        _ => String::new(),
    };
    remark(format!("{} misses{ray}", called(event)))
}

fn remark(text: String) -> Note {
    Note {
        body: None,
        text,
        kind: NoteKind::Remark,
        strike: None,
    }
}
