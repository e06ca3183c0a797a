//! Whether the method a scene names takes the torques that the scene has.

use super::problem::Problems;
use super::table::Table;
use super::{Body, Event, Scene, Stepping};
use crate::body::{Inertial, InertialBlock};
use crate::effect::{Called, Load};
use std::sync::Arc;

/// Why a scene's method does not take it, and which event it is, if it is one.
struct Unpaired {
    why: String,
    event: Option<usize>,
}

/// Reports each body's first effect or event that would cost the method its order.
pub(super) fn check(scene: &Scene, top: &Table<'_>, problems: &mut Problems) {
    let unpaired = unpaired(scene);
    if unpaired.is_empty() {
        return;
    }
    let events = top.tables("event", problems);
    // The key `method`: the usual one takes every load, so a method that refuses was named.
    let named = top
        .table("stepping", problems)
        .and_then(|t| t.get("method"));
    for Unpaired { why, event } in unpaired {
        let table = event.and_then(|k| events.get(k));
        let span = match table {
            Some(table) => table.span().clone(),
            None => named.as_ref().map_or(0..0, |node| node.span.clone()),
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
    let mut events: Vec<Vec<usize>> = vec![Vec::new(); scene.bodies.len()];
    for (index, event) in scene.events.iter().enumerate() {
        events[event.body].push(index);
    }
    for (k, body) in scene.bodies.iter().enumerate() {
        let (inertial, q_bp) = Inertial::new(&body.properties, body.pivot_b);
        let mut block = InertialBlock::default();
        block.set(0, inertial);
        let refuses = |load: Load| method.info().refuses(&load, &block);
        if let Some(refusal) = refuses(lasting(scene)) {
            let why = format!("{}: {refusal}", body.name);
            found.push(Unpaired { why, event: None });
            continue;
        }
        for &index in &events[k] {
            let event = &scene.events[index];
            let mut load = lasting(scene);
            if let Some(effect) = event.effect(0, &inertial, q_bp.inverse()) {
                load.push(effect);
            }
            if let Some(refusal) = refuses(load) {
                let why = reason(body, event, &refusal.0);
                found.push(Unpaired {
                    why,
                    event: Some(index),
                });
            }
        }
    }
    found
}

fn reason(body: &Body, event: &Event, why: &str) -> String {
    let what = event.action.noun();
    format!("a {what} on {}: {why}", body.name)
}

/// What acts on every body as long as the scene lasts.
pub(crate) fn lasting(scene: &Scene) -> Load {
    let mut load = Load::default();
    for (_, effect) in &scene.effects {
        match effect {
            Called::Load(effect) => load.push(Arc::clone(effect)),
            Called::Decay(decay) => load.set_decay(*decay),
            Called::Gyroscopic => load.set_gyroscopic(),
            Called::Off => {}
        }
    }
    load
}
