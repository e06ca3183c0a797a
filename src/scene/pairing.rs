//! Whether the method that steps a body takes the torques that it has.

use super::effect::{Off, lasting};
use super::problem::Problems;
use super::table::Table;
use super::{Body, Event, Scene, Stepping};
use crate::body::{Inertial, InertialBlock};
use crate::effect::{Load, Member};

/// Why a body's method does not take what acts on it, and which event it is, if it is one.
struct Unpaired {
    why: String,
    body: usize,
    event: Option<usize>,
}

/// Reports each body's first effect or event that would cost the method its order.
pub(super) fn check(scene: &Scene, top: &Table<'_>, problems: &mut Problems) {
    let unpaired = unpaired(scene);
    if unpaired.is_empty() {
        return;
    }
    let events = top.tables("event", problems);
    let bodies = top.tables("body", problems);
    // The key `method`: the usual one takes every load, so a method that refuses was named.
    let named = top
        .table("stepping", problems)
        .and_then(|t| t.get("method"));
    for Unpaired { why, body, event } in unpaired {
        let table = event.and_then(|k| events.get(k));
        let own = bodies.get(body).and_then(|table| table.get("method"));
        let span = match (table, own.as_ref().or(named.as_ref())) {
            (Some(table), _) => table.span().clone(),
            (None, node) => node.map_or(0..0, |node| node.span.clone()),
        };
        let remedy = "choose a method that takes it (`torquescope methods`), or state `accuracy` in place of a method";
        problems.add(&span, format!("{why}; {remedy}"));
    }
}

/// The first reason why the method does not take the scene.
pub(super) fn refusal(scene: &Scene) -> Option<String> {
    unpaired(scene).into_iter().next().map(|found| found.why)
}

fn unpaired(scene: &Scene) -> Vec<Unpaired> {
    let Stepping::Method { method, .. } = scene.stepping else {
        return Vec::new();
    };
    let mut found = Vec::new();
    for (k, body) in scene.bodies.iter().enumerate() {
        let info = body.method.map_or(method, |own| own.method).info();
        if info.takes_every_load() {
            continue;
        }
        let (inertial, q_bp) = Inertial::new(&body.properties, body.pivot_b);
        let member = Member {
            lane: 0,
            inertial,
            q_pb: q_bp.inverse(),
            body,
        };
        let mut block = InertialBlock::default();
        block.set(0, inertial);
        let refuses = |load: &Load| info.refuses(load, &block);
        let under = |off: &Off| lasting(scene, k, &[member], off);
        let switched = switched(scene).into_iter().find_map(|(event, off)| {
            let refusal = refuses(&under(&off))?;
            Some((event, refusal))
        });
        if let Some((event, refusal)) = switched {
            found.push(Unpaired {
                why: format!("{}: {refusal}", body.name),
                body: k,
                event,
            });
            continue;
        }
        let lasting = under(&scene.off_at_start());
        let events = scene.events.iter().enumerate();
        for (index, event) in events.filter(|(_, event)| event.body == k) {
            let mut load = lasting.clone();
            if let Some(effect) = event.effect(0, &inertial, q_bp.inverse()) {
                load.push(effect);
            }
            if let Some(refusal) = refuses(&load) {
                found.push(Unpaired {
                    why: reason(body, event, &refusal.0),
                    body: k,
                    event: Some(index),
                });
            }
        }
    }
    found
}

/// Which effects are off at first, and after every event that switches one.
fn switched(scene: &Scene) -> Vec<(Option<usize>, Off)> {
    vec![(None, scene.off_at_start())]
}

fn reason(body: &Body, event: &Event, why: &str) -> String {
    let what = event.action.noun();
    format!("a {what} on {}: {why}", body.name)
}
