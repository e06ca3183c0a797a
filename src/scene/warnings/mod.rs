//! What is legal and probably wrong. One function a warning, one line in [`WARNINGS`].
//!
//! Warnings are looked for in scenes that are right, and only where somebody asks
//! ([`super::Script::judge`]). A scene that means it says so: `allow = ["gyroscopic-off"]`.

mod events;
mod model;
mod motion;
mod record;
mod size;

use super::pairing::are_alike;
use super::problem::{At, Problems};
use super::table::{Node, Table};
use super::{Action, Body, Event, Framed, Scene, Target, lasting};
use crate::body::{Inertial, InertialBlock, State, StateBlock};
use crate::effect::{Load, Term, Wrench};
use crate::math::axis_angle;
use motion::Motion;
use nalgebra::{Unit, UnitQuaternion, Vector3};
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
    warning("slow-limit", "a speed limit is below the speed at which a body starts", model::slow_limit),
    warning("immovable", "an event acts on what cannot move: infinite mass, or a held axis", events::immovable),
    warning("idle-event", "an event does nothing: it is zero, or a force goes through the pivot", events::idle),
    warning("cut-event", "an event lasts beyond the end of the scene", events::cut),
    warning("far-pivot", "a pivot is far outside the body", size::far_pivot),
    warning("odd-inertia", "an inertia is hundreds of times too large or small for the shape and mass", size::odd_inertia),
    warning("odd-density", "a mass is far too large or small for the shape's volume", size::odd_density),
    warning("quaternion-order", "an orientation is [1, 0, 0, 0], half a turn about x", size::quaternion_order),
    warning("quaternion-length", "an orientation of four numbers is far from unit length", size::quaternion_length),
    warning("rate-above-steps", "more is to be recorded than there are steps", record::rate_above_steps),
    warning("unrecorded-rate", "a stream that is not recorded has a rate", record::unrecorded_rate),
    warning(UNUSED, "a warning is allowed that there is no reason for", |_, _| {}),
];

const UNUSED: &str = "unused-allow";

/// Of one kind that are told; a swarm has thousands.
const MOST: usize = 3;

/// What one warning found, by places of the text that was read.
#[derive(Default)]
pub(super) struct Found {
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

/// The code of a warning, and what it found.
pub(super) type Finds = (&'static str, Found);

/// Everything that was found in one scene, by the places where it came from.
pub(super) struct Told(Vec<One>);

/// What one warning found.
struct One {
    code: &'static str,
    list: Vec<(At, String)>,
    more: usize,
}

impl Told {
    pub fn new(found: Vec<Finds>, at: impl Fn(&Range<usize>) -> At) -> Self {
        let one = |(code, found): Finds| One {
            code,
            list: found
                .list
                .into_iter()
                .map(|(span, message)| (at(&span), message))
                .collect(),
            more: found.more,
        };
        Self(found.into_iter().map(one).collect())
    }

    fn of(&self, code: &str) -> impl Iterator<Item = &One> {
        self.0.iter().filter(move |one| one.code == code)
    }

    fn holds(&self, code: &str, at: &At) -> bool {
        self.of(code)
            .any(|one| one.list.iter().any(|(other, _)| other.is(at)))
    }
}

/// What was found in the scenes of one script, each place once: its code, where, and what to say.
pub(super) fn together(scenes: Vec<Told>) -> Vec<(&'static str, At, String)> {
    let mut all: Vec<(&'static str, At, String)> = Vec::new();
    for code in WARNINGS.iter().map(|warning| warning.code) {
        let mut list: Vec<(&At, &str)> = Vec::new();
        let mut more = 0;
        for one in scenes.iter().flat_map(|told| told.of(code)) {
            more = more.max(one.more);
            for (at, message) in &one.list {
                let known = list.iter().any(|(other, _)| other.is(at));
                // What one scene of a sweep has a reason for is allowed in all of them.
                let unused = code == UNUSED && !scenes.iter().all(|told| told.holds(code, at));
                if !known && !unused {
                    list.push((at, message));
                }
            }
        }
        more += list.len().saturating_sub(MOST);
        list.truncate(MOST);
        let last = list.len().saturating_sub(1);
        for (k, (at, message)) in list.into_iter().enumerate() {
            let message = match (k == last && more > 0, message.rsplit_once("; ")) {
                (false, _) => message.to_owned(),
                (true, None) => format!("{message} (and {more} more like it)"),
                (true, Some((what, remedy))) => {
                    format!("{what} (and {more} more like it); {remedy}")
                }
            };
            // One line, whatever the file or its keys hold.
            all.push((code, at.clone(), message.replace(char::is_control, " ")));
        }
    }
    all.sort_by(|(_, a, _), (_, b, _)| a.order().cmp(&b.order()));
    all
}

/// A scene, and the file it came from.
struct Context<'a, 'd> {
    scene: &'a Scene,
    top: &'a Table<'d>,
    /// Of the bodies, then of the swarms.
    tables: Vec<Table<'d>>,
    events: Vec<Table<'d>>,
    /// Which effects act at some time.
    ever_on: Vec<bool>,
    judged: Vec<Judged<'a>>,
}

/// A body that is looked at: for itself, or for those of its swarm that are like it.
struct Judged<'a> {
    body: &'a Body,
    /// Among the tables of bodies and swarms.
    table: usize,
    alone: Alone,
    motion: Motion,
}

/// Everything probably wrong with a scene but what is allowed.
pub(super) fn find(
    scene: &Scene,
    top: &Table<'_>,
    allowed: &[(Node<'_>, &'static str)],
) -> Vec<Finds> {
    let context = Context::new(scene, top);
    let mut all = Vec::new();
    for warning in WARNINGS {
        let mut found = Found::default();
        (warning.find)(&context, &mut found);
        let allowing = allowed.iter().find(|(_, code)| *code == warning.code);
        match allowing {
            None => all.push((warning.code, found)),
            Some((node, code)) if found.list.is_empty() && *code != UNUSED => {
                let silenced = allowed.iter().any(|(_, code)| *code == UNUSED);
                let mut unused = Found::default();
                unused.add(node.span.clone(), || {
                    format!(
                        "\"{code}\" is allowed, and there is no such warning here; leave it out"
                    )
                });
                if !silenced {
                    all.push((UNUSED, unused));
                }
            }
            Some(_) => {}
        }
    }
    all
}

impl<'a, 'd> Context<'a, 'd> {
    fn new(scene: &'a Scene, top: &'a Table<'d>) -> Self {
        // What is wrong with the tables has been told.
        let mut told = Problems::new("", "");
        let mut tables = top.tables("body", &mut told);
        let bodies = tables.len();
        tables.extend(top.tables("swarm", &mut told));
        let mut context = Self {
            scene,
            top,
            tables,
            events: top.tables("event", &mut told),
            ever_on: ever_on(scene),
            judged: Vec::new(),
        };
        // For each body, who is looked at for it.
        let mut for_whom = Vec::with_capacity(scene.bodies.len());
        for k in 0..bodies.min(scene.bodies.len()) {
            for_whom.push(context.judged.len());
            context.judge(k, k);
        }
        for table in bodies..context.tables.len() {
            let first = for_whom.len();
            let end = (first + context.count(table)).min(scene.bodies.len());
            let members: Vec<usize> = (first..end).collect();
            for alike in members.chunk_by(|a, b| are_alike(scene, *a, *b)) {
                // Of those alike the fastest.
                let speed = |k: &&usize| scene.bodies[**k].omega_w.norm_squared();
                let fastest = alike.iter().max_by(|a, b| speed(a).total_cmp(&speed(b)));
                for_whom.extend(alike.iter().map(|_| context.judged.len()));
                context.judge(*fastest.unwrap_or(&first), table);
            }
        }
        for event in first_of_each(scene) {
            if let Target::Body(body) = event.target
                && let Some(judged) = for_whom.get(body).and_then(|k| context.judged.get_mut(*k))
            {
                judged.motion.meets(event, &judged.alone);
            }
        }
        context
    }

    fn judge(&mut self, body: usize, table: usize) {
        let alone = Alone::new(self.scene, body, &self.ever_on);
        self.judged.push(Judged {
            body: &self.scene.bodies[body],
            table,
            motion: Motion::of(&alone),
            alone,
        });
    }

    /// How many bodies a swarm has.
    fn count(&self, table: usize) -> usize {
        let node = self.tables[table].get("count");
        let count = node.and_then(|n| n.number("", &mut Problems::new("", "")));
        count.unwrap_or(0.0) as usize
    }

    /// Where the first of these keys of a body stands, or else the body.
    fn place(&self, judged: &Judged<'_>, keys: &[&'static str]) -> Range<usize> {
        place(self.tables.get(judged.table), keys)
    }

    /// Where a key of an event stands, or else the event.
    fn event_place(&self, event: &Event, keys: &[&'static str]) -> Range<usize> {
        place(self.events.get(event.entry), keys)
    }
}

fn place(table: Option<&Table<'_>>, keys: &[&'static str]) -> Range<usize> {
    let Some(table) = table else {
        return 0..0;
    };
    let found = keys.iter().find_map(|key| table.get(key));
    found.map_or_else(|| table.span().clone(), |node| node.span)
}

/// Effects that act at some time: from the start, or switched on.
fn ever_on(scene: &Scene) -> Vec<bool> {
    let mut on = scene.on_at_start();
    for event in &scene.events {
        if let Action::Switch { effect, on: true } = event.action {
            on[effect] = true;
        }
    }
    on
}

/// Of the events that one `[[event]]` makes the first: its repeats are like it.
fn first_of_each(scene: &Scene) -> impl Iterator<Item = &Event> {
    let mut before = None;
    scene
        .events
        .iter()
        .filter(move |event| before.replace(event.entry) != Some(event.entry))
}

/// A body as the scene starts it, by itself in a block.
struct Alone {
    inertial: Inertial,
    /// Body axes → principal axes.
    q_pb: UnitQuaternion<f64>,
    state: State,
    /// The effects that act on it at some time.
    load: Load,
}

impl Alone {
    fn new(scene: &Scene, index: usize, on: &[bool]) -> Self {
        let body = &scene.bodies[index];
        let member = body.member(0);
        Self {
            inertial: member.inertial,
            q_pb: member.q_pb,
            state: body.start(member.q_pb),
            load: lasting(scene, index, &[member], on),
        }
    }

    /// What its effects do to it in a state, at the start.
    fn wrench(&self, state: &State) -> Wrench {
        let (mut inertial, mut states) = (InertialBlock::default(), StateBlock::default());
        inertial.set(0, self.inertial);
        states.set(0, *state);
        self.load
            .wrench(0.0, &inertial, &states)
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

/// What an event does to a body in a state: force and torque, or their impulses; `None` where it is no
/// event of that kind.
fn struck(event: &Event, body: &Alone, state: &State) -> Option<Wrench> {
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
        Action::Click(_)
        | Action::Set(_)
        | Action::Switch { .. }
        | Action::Method(_)
        | Action::Note(_) => return None,
    };
    Some(term.wrench(state))
}

/// Whether an event's force or torque is nothing.
fn is_zero(event: &Event) -> bool {
    match &event.action {
        Action::Push { force: v, .. }
        | Action::Impulse { impulse: v, .. }
        | Action::Torque { torque: v, .. }
        | Action::AngularImpulse { impulse: v } => {
            let (Framed::World(v) | Framed::Body(v)) = v;
            *v == Vector3::zeros()
        }
        Action::Click(click) => click.force == 0.0,
        Action::Set(_) | Action::Switch { .. } | Action::Method(_) | Action::Note(_) => false,
    }
}
