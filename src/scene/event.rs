//! `[[event]]`: what happens to a body, and when.

use super::body::{self, Bodies, Body};
use super::problem::Problems;
use super::table::{Node, Table};
use crate::body::Inertial;
use crate::effect::{Couple, Effect, Frame, Push};
use nalgebra::{UnitQuaternion, Vector3};
use std::sync::Arc;

/// Something done to a body at an exact time.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Event {
    /// s.
    pub at: f64,
    /// Index of the body.
    pub body: usize,
    pub action: Action,
}

/// What is done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// A force (N) at a point (m) for a time (s).
    Push {
        force: Framed,
        point: Framed,
        lasts: f64,
    },
    /// A torque (N·m) for a time (s).
    Torque { torque: Framed, lasts: f64 },
    /// An instantaneous impulse (N·s) at a point (m).
    Impulse { impulse: Framed, point: Framed },
    /// An instantaneous angular impulse (N·m·s).
    AngularImpulse { impulse: Framed },
}

impl Action {
    /// What it is called in messages and in the log.
    pub fn noun(&self) -> &'static str {
        match self {
            Self::Push { .. } => "push",
            Self::Torque { .. } => "torque",
            Self::Impulse { .. } => "impulse",
            Self::AngularImpulse { .. } => "angular impulse",
        }
    }

    /// How long it lasts, s; 0 for an instant.
    pub fn lasts(&self) -> f64 {
        match *self {
            Action::Push { lasts, .. } | Action::Torque { lasts, .. } => lasts,
            Action::Impulse { .. } | Action::AngularImpulse { .. } => 0.0,
        }
    }
}

impl Event {
    /// The push that acts while the event lasts, on a lane of a block.
    pub fn push(
        &self,
        lane: usize,
        inertial: &Inertial,
        q_pb: UnitQuaternion<f64>,
    ) -> Option<Push> {
        match self.action {
            Action::Push { force, point, .. } => Some(Push {
                lane,
                force: force.direction(q_pb),
                point: point.point(inertial, q_pb),
            }),
            _ => None,
        }
    }

    /// What acts while the event lasts; nothing where it is an instant.
    pub fn effect(
        &self,
        lane: usize,
        inertial: &Inertial,
        q_pb: UnitQuaternion<f64>,
    ) -> Option<Arc<dyn Effect>> {
        match self.action {
            Action::Push { .. } => {
                let push = self.push(lane, inertial, q_pb)?;
                Some(Arc::new(push))
            }
            Action::Torque { torque, .. } => Some(Arc::new(Couple {
                lane,
                torque: torque.direction(q_pb),
            })),
            Action::Impulse { .. } | Action::AngularImpulse { .. } => None,
        }
    }
}

/// A vector, or a point, and the axes it is given in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Framed {
    World(Vector3<f64>),
    /// Body axes; a point counts from the centre of mass.
    Body(Vector3<f64>),
}

impl Framed {
    /// As a direction in world or principal axes.
    pub fn direction(self, q_pb: UnitQuaternion<f64>) -> Frame {
        match self {
            Self::World(v) => Frame::World(v),
            Self::Body(v) => Frame::Principal(q_pb * v),
        }
    }

    /// As a point in the world, or from the reference point in principal axes.
    pub fn point(self, inertial: &Inertial, q_pb: UnitQuaternion<f64>) -> Frame {
        match self {
            Self::World(p) => Frame::World(p),
            Self::Body(p) => Frame::Principal(q_pb * p + inertial.centre_p),
        }
    }
}

/// The scene's times, as far as they are right: s.
#[derive(Clone, Copy)]
pub(super) struct Clock {
    pub duration: Option<f64>,
    pub step: Option<f64>,
}

pub(super) fn read_all(
    tables: &[Table<'_>],
    bodies: &Bodies,
    clock: Clock,
    problems: &mut Problems,
) -> Vec<Event> {
    let mut events = Vec::new();
    for table in tables {
        events.extend(read(table, bodies, clock, problems));
        table.check_keys(problems);
    }
    events
}

/// What an event can do: its key, its unit with a duration, its unit in an instant.
const ACTIONS: [(&str, &str, &str); 4] = [
    ("force", "N", "N·s"),
    ("impulse", "", "N·s"),
    ("torque", "N·m", "N·m·s"),
    ("angular_impulse", "", "N·m·s"),
];

fn read(
    table: &Table<'_>,
    bodies: &Bodies,
    clock: Clock,
    problems: &mut Problems,
) -> Option<Event> {
    let at = time(table, clock.duration, problems);
    let lasts = table
        .get("for")
        .map(|node| lasts(&node, at, clock, problems));
    let index = table.require("body", "the name of the body it acts on", problems);
    let index = index.and_then(|node| bodies.find(&node, problems));
    let in_body = in_body_axes(table, problems);
    let what = action(table, lasts.is_some(), problems);
    let point_node = table.get("point");
    let (key, vector) = what?;
    let (in_body, lasts) = (in_body?, lasts.unwrap_or(Some(0.0))?);
    let axes = |v| {
        if in_body {
            Framed::Body(v)
        } else {
            Framed::World(v)
        }
    };
    let index = index?;
    // A body that is itself wrong has been reported; its events cannot be judged.
    let body = bodies.valid.get(index)?.as_ref()?;
    let needs_point = matches!(key, "force" | "impulse");
    let point = match (&point_node, needs_point) {
        (Some(node), true) => Some(point(node, body, in_body, problems)?),
        (Some(node), false) => {
            node.problem(
                format!("says nothing of {}; leave it out", article(key)),
                problems,
            );
            return None;
        }
        (None, true) => {
            let message = format!(
                "{} lacks `point`, where the {key} acts; add point = \"centre\" or three numbers (m)",
                table.name()
            );
            problems.add(table.span(), message);
            return None;
        }
        (None, false) => None,
    };
    let vector = axes(vector);
    let action = match (point, lasts > 0.0) {
        (Some(point), true) => Action::Push {
            force: vector,
            point,
            lasts,
        },
        (Some(point), false) => Action::Impulse {
            impulse: vector,
            point,
        },
        (None, true) => Action::Torque {
            torque: vector,
            lasts,
        },
        (None, false) => Action::AngularImpulse { impulse: vector },
    };
    Some(Event {
        at: at?,
        body: index,
        action,
    })
}

fn time(table: &Table<'_>, duration: Option<f64>, problems: &mut Problems) -> Option<f64> {
    let node = table.require("at", "the time it happens, in seconds", problems)?;
    let at = node.number("s", problems)?;
    if at < 0.0 {
        node.problem("is before the scene begins, at 0 s", problems);
        return None;
    }
    if let Some(end) = duration
        && at > end
    {
        node.problem(format!("is after the scene ends, at {end} s"), problems);
        return None;
    }
    Some(at)
}

/// How long it lasts; what the clock cannot tell from an instant is refused, lest it vanish.
fn lasts(node: &Node<'_>, at: Option<f64>, clock: Clock, problems: &mut Problems) -> Option<f64> {
    let lasts = node.positive("s", problems)?;
    let step = clock.step.unwrap_or(0.0);
    let finest = (1e-8 * step)
        .max(8.0 * f64::EPSILON * at.unwrap_or(0.0))
        .max(1e-9);
    if lasts < finest {
        node.problem(
            format!("is shorter than the clock tells apart here ({finest:e} s); write an impulse instead"),
            problems,
        );
        return None;
    }
    Some(lasts)
}

fn in_body_axes(table: &Table<'_>, problems: &mut Problems) -> Option<bool> {
    let Some(node) = table.get("frame") else {
        return Some(false);
    };
    match node.str(problems)? {
        "world" => Some(false),
        "body" => Some(true),
        _ => {
            node.problem("is neither \"world\" nor \"body\"", problems);
            None
        }
    }
}

/// The one thing an event does: its key and its vector.
fn action(
    table: &Table<'_>,
    has_duration: bool,
    problems: &mut Problems,
) -> Option<(&'static str, Vector3<f64>)> {
    let given: Vec<(Node<'_>, &str, &str)> = ACTIONS
        .iter()
        .filter_map(|&(key, lasting, instant)| Some((table.get(key)?, lasting, instant)))
        .collect();
    let [(node, lasting, instant)] = given.as_slice() else {
        let keys = ACTIONS.map(|(key, ..)| key).join(", ");
        let message = match given.is_empty() {
            true => format!("{} does nothing; add one of {keys}", table.name()),
            false => format!(
                "{} does several things; give each an event of its own ({keys})",
                table.name()
            ),
        };
        problems.add(table.span(), message);
        return None;
    };
    if has_duration && lasting.is_empty() {
        let lasting_key = if node.key == "impulse" {
            "force"
        } else {
            "torque"
        };
        node.problem(
            format!("happens in an instant, so `for` has no meaning; for a push that lasts write {lasting_key}"),
            problems,
        );
        return None;
    }
    let unit = if has_duration { lasting } else { instant };
    Some((node.key, node.vector(unit, problems)?))
}

fn point(node: &Node<'_>, body: &Body, in_body: bool, problems: &mut Problems) -> Option<Framed> {
    if let Some((frame, inner)) = node.only_entry() {
        return match frame {
            "body" => point(&inner, body, true, problems),
            "world" => point(&inner, body, false, problems),
            _ => {
                node.problem(
                    "names neither `body` nor `world`, as in { body = [0, 1, 0] }",
                    problems,
                );
                None
            }
        };
    }
    // A named point belongs to the body whatever axes the force is given in.
    if in_body || node.is_text() {
        return Some(Framed::Body(body::point(node, body, problems)?));
    }
    Some(Framed::World(node.vector("m", problems)?))
}

fn article(key: &str) -> String {
    match key {
        "angular_impulse" => "an angular_impulse".to_owned(),
        _ => format!("a {key}"),
    }
}
