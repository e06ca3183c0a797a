//! What is legal and probably wrong. One function a warning, one line in [`WARNINGS`].
//!
//! Warnings are looked for in scenes that are right, and only where somebody asks ([`Scene::judge`]). A scene
//! that means it says so: `allow = ["gyroscopic-off"]`.

mod events;
mod model;
mod motion;
mod record;
mod size;

use super::finding::{Finding, Severity};
use super::problem::Problems;
use super::table::{Node, Table};
use super::{Action, Body, Event, Framed, Scene, lasting};
use crate::body::{Inertial, InertialBlock, State, StateBlock};
use crate::effect::{Load, Term, Wrench};
use crate::math::axis_angle;
use motion::Motions;
use nalgebra::{Unit, UnitQuaternion, Vector3};
use std::collections::HashMap;
use std::ops::Range;

/// Something that is legal and probably wrong.
pub struct Warning {
    /// What `allow` calls it.
    pub code: &'static str,
    /// In a sentence.
    pub about: &'static str,
    find: fn(&Context<'_, '_>, &mut Found),
}

const fn warning(
    code: &'static str,
    about: &'static str,
    find: fn(&Context<'_, '_>, &mut Found),
) -> Warning {
    Warning { code, about, find }
}

/// Every warning, in the order of the lists.
#[rustfmt::skip]
pub const WARNINGS: &[Warning] = &[
    warning("gyroscopic-off", "a body with unequal moments turns about no principal axis, and the model is the tutorial's", model::gyroscopic_off),
    warning("coarse-step", "the step is above a tenth of the fastest period", model::coarse_step),
    warning("immovable", "an event acts on what cannot move: infinite mass, or a held axis", events::immovable),
    warning("idle-event", "an event does nothing: it is zero, or a force goes through the pivot", events::idle),
    warning("cut-event", "an event lasts beyond the end of the scene", events::cut),
    warning("far-pivot", "a pivot is far outside the body", size::far_pivot),
    warning("odd-inertia", "an inertia is hundreds of times too large or small for the shape and mass", size::odd_inertia),
    warning("odd-density", "a mass is far too large or small for the shape's volume", size::odd_density),
    warning("quaternion-order", "an orientation is [1, 0, 0, 0], half a turn about x", size::quaternion_order),
    warning("quaternion-length", "an orientation of four numbers is far from unit length", size::quaternion_length),
    warning("rate-above-steps", "more is to be recorded than there are steps", record::rate_above_steps),
    warning(UNUSED, "a warning is allowed that there is no reason for", |_, _| {}),
];

const UNUSED: &str = "unused-allow";

/// Of one kind that are told; a swarm has thousands.
const MOST: usize = 3;

/// What one warning found.
#[derive(Default)]
struct Found {
    list: Vec<(Range<usize>, String)>,
    /// Beyond [`MOST`].
    more: usize,
}

impl Found {
    /// The message is one line: what and why, and after its last semicolon the remedy.
    fn add(&mut self, span: Range<usize>, message: impl FnOnce() -> String) {
        match self.list.len() < MOST {
            true => self.list.push((span, message())),
            false => self.more += 1,
        }
    }
}

/// A scene, and the file it came from.
struct Context<'a, 'd> {
    scene: &'a Scene,
    top: &'a Table<'d>,
    bodies: Vec<Table<'d>>,
    events: Vec<Table<'d>>,
    /// Table of a body by its name.
    named: HashMap<String, usize>,
    load: Load,
    motions: Motions,
}

/// Everything probably wrong with a scene but what is allowed, in the order of the file.
pub(super) fn find(
    scene: &Scene,
    top: &Table<'_>,
    allowed: &[(Node<'_>, &'static str)],
    (file, source): (&str, &str),
) -> Vec<Finding> {
    let context = Context::new(scene, top);
    let mut all: Vec<(usize, Finding)> = Vec::new();
    let mut tell = |code: &'static str, found: Found| {
        let more = found.more;
        let last = found.list.len().saturating_sub(1);
        for (k, (span, message)) in found.list.into_iter().enumerate() {
            let (message, remedy) = match message.rsplit_once("; ") {
                Some((message, remedy)) => (message.to_owned(), Some(remedy.to_owned())),
                None => (message, None),
            };
            let message = match more {
                more if more > 0 && k == last => format!("{message} (and {more} more like it)"),
                _ => message,
            };
            let finding = Finding {
                severity: Severity::Warning,
                code,
                message: message.replace(char::is_control, " "),
                remedy,
                ..Finding::at(file, source, &span)
            };
            all.push((span.start, finding));
        }
    };
    for warning in WARNINGS {
        let mut found = Found::default();
        (warning.find)(&context, &mut found);
        let allowing = allowed.iter().find(|(_, code)| *code == warning.code);
        match allowing {
            None => tell(warning.code, found),
            Some((node, code)) if found.list.is_empty() && *code != UNUSED => {
                let silenced = allowed.iter().any(|(_, code)| *code == UNUSED);
                let mut unused = Found::default();
                unused.add(node.span.clone(), || {
                    format!(
                        "\"{code}\" is allowed, and there is no such warning here; leave it out"
                    )
                });
                if !silenced {
                    tell(UNUSED, unused);
                }
            }
            Some(_) => {}
        }
    }
    all.sort_by_key(|(start, _)| *start);
    all.into_iter().map(|(_, finding)| finding).collect()
}

impl<'a, 'd> Context<'a, 'd> {
    fn new(scene: &'a Scene, top: &'a Table<'d>) -> Self {
        // What is wrong with the tables has been told.
        let mut told = Problems::new("", "");
        let bodies = top.tables("body", &mut told);
        let name = |(k, table): (usize, &Table<'_>)| {
            let name = table.get("name")?.str(&mut Problems::new("", ""))?;
            Some((name.to_owned(), k))
        };
        let named = bodies.iter().enumerate().filter_map(name).collect();
        let load = lasting(scene);
        Self {
            scene,
            top,
            named,
            bodies,
            events: top.tables("event", &mut told),
            motions: Motions::of(scene, &load),
            load,
        }
    }

    /// The table of a body.
    fn body(&self, body: &Body) -> Option<&Table<'d>> {
        self.bodies.get(*self.named.get(&body.name)?)
    }

    /// Where the first of these keys of a body stands, or else the body.
    fn place(&self, body: &Body, keys: &[&'static str]) -> Range<usize> {
        let Some(table) = self.body(body) else {
            return 0..0;
        };
        let found = keys.iter().find_map(|key| table.get(key));
        found.map_or_else(|| table.span().clone(), |node| node.span)
    }

    /// Where a key of an event stands, or else the event.
    fn event_place(&self, index: usize, keys: &[&'static str]) -> Range<usize> {
        let Some(table) = self.events.get(index) else {
            return 0..0;
        };
        let found = keys.iter().find_map(|key| table.get(key));
        found.map_or_else(|| table.span().clone(), |node| node.span)
    }
}

/// A body as the scene starts it, by itself in a block.
struct Alone {
    inertial: Inertial,
    /// Body axes → principal axes.
    q_pb: UnitQuaternion<f64>,
    state: State,
}

impl Alone {
    fn new(body: &Body) -> Self {
        let (inertial, q_bp) = Inertial::new(&body.properties, body.pivot_b);
        let (x_w, v_w) = match body.pivot_b {
            Some(pivot_b) => (body.position_w + body.q_wb * pivot_b, Vector3::zeros()),
            None => (body.position_w, body.velocity_w),
        };
        Self {
            inertial,
            q_pb: q_bp.inverse(),
            state: State {
                x_w,
                v_w,
                q_wp: (body.q_wb * q_bp).into_inner(),
                omega_w: body.omega_w,
            },
        }
    }

    /// What a load does to it in a state, at the start.
    fn wrench(&self, load: &Load, state: &State) -> Wrench {
        let (mut inertial, mut states) = (InertialBlock::default(), StateBlock::default());
        inertial.set(0, self.inertial);
        states.set(0, *state);
        load.wrench(0.0, &inertial, &states)
            .map_or_else(Wrench::default, |block| block.get(0))
    }

    /// The state, and some of those to which turns about the axes that are not held may bring it.
    fn attitudes(&self) -> Vec<State> {
        let mut all = vec![self.state];
        for (k, inv_moment) in self.inertial.inv_moments.iter().enumerate() {
            if *inv_moment > 0.0 {
                let axis_p = Vector3::ith(k, 1.0);
                let turned = |state: &State| turned(state, state.to_world(axis_p), 1.0);
                let more: Vec<State> = all.iter().map(turned).collect();
                all.extend(more);
            }
        }
        all
    }
}

/// Turned by an angle (rad) about an axis of the world of length 1.
fn turned(state: &State, axis_w: Vector3<f64>, angle: f64) -> State {
    let turn: UnitQuaternion<f64> = axis_angle(Unit::new_unchecked(axis_w), angle);
    State {
        q_wp: turn.into_inner() * state.q_wp,
        ..*state
    }
}

/// What an event does to a body in a state: force and torque, or their impulses.
fn struck(event: &Event, body: &Alone, state: &State) -> Wrench {
    let term = match event.action {
        Action::Push { force, point, .. }
        | Action::Impulse {
            impulse: force,
            point,
        } => Term::Force {
            lane: 0,
            force: force.direction(body.q_pb),
            point: point.point(&body.inertial, body.q_pb),
        },
        Action::Torque { torque, .. } | Action::AngularImpulse { impulse: torque } => {
            Term::Torque {
                lane: 0,
                torque: torque.direction(body.q_pb),
            }
        }
    };
    term.wrench(state)
}

/// Whether an event's force or torque is nothing.
fn is_zero(event: &Event) -> bool {
    let (Action::Push { force: v, .. }
    | Action::Impulse { impulse: v, .. }
    | Action::Torque { torque: v, .. }
    | Action::AngularImpulse { impulse: v }) = event.action;
    let (Framed::World(v) | Framed::Body(v)) = v;
    v == Vector3::zeros()
}
