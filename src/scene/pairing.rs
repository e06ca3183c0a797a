//! Whether the method that steps a body takes the torques that it has.

use super::effect::lasting;
use super::problem::Problems;
use super::table::Table;
use super::{Action, Body, Scene, Stepping, Target};
use crate::body::InertialBlock;
use crate::effect::Load;
use crate::integrator::Method;
use nalgebra::Vector3;
use std::collections::{HashMap, HashSet};

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
        let entry = event.and_then(|k| scene.events.get(k)).map(|e| e.entry);
        let table = entry.and_then(|entry| events.get(entry));
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
    let times = Times::of(scene);
    let events = lasting_events(scene, &times);
    let mut found = Vec::new();
    for phase in phases(scene, method) {
        // A body with a method of its own is told once.
        let told = |new: &Unpaired| found.iter().any(|old: &Unpaired| old.why == new.why);
        let mut news = unpaired_in(scene, &phase, &times, &events);
        news.retain(|new| !told(new));
        found.append(&mut news);
    }
    found
}

/// From when to when (s) a method is the usual one.
struct Phase {
    from: f64,
    until: f64,
    method: &'static dyn Method,
    /// The event that made it so.
    by: Option<usize>,
}

/// The scene's method until the first event that changes it, and so on.
fn phases(scene: &Scene, method: &'static dyn Method) -> Vec<Phase> {
    let events = scene.events.iter().enumerate();
    let mut changes: Vec<(usize, f64, &'static dyn Method)> = events
        .filter_map(|(k, event)| match event.action {
            Action::Method(own) => Some((k, event.at, own.method)),
            _ => None,
        })
        .collect();
    changes.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut phases = vec![Phase {
        from: 0.0,
        until: f64::INFINITY,
        method,
        by: None,
    }];
    for (k, at, method) in changes {
        phases
            .last_mut()
            .into_iter()
            .for_each(|last| last.until = at);
        phases.push(Phase {
            from: at,
            until: f64::INFINITY,
            method,
            by: Some(k),
        });
    }
    // One that is changed at once steps nothing.
    phases.retain(|phase| phase.from < phase.until);
    phases
}

fn unpaired_in(scene: &Scene, phase: &Phase, times: &Times, events: &Lasting) -> Vec<Unpaired> {
    let mut found = Vec::new();
    let sets = times.during(phase.from, phase.until);
    // Of bodies alike one after another, as a swarm has them, what is true of one is true of all.
    let mut before: Option<(usize, bool)> = None;
    for (k, body) in scene.bodies.iter().enumerate() {
        let info = body.method.map_or(phase.method, |own| own.method).info();
        if info.takes_every_load() {
            continue;
        }
        let own = events.of_bodies.get(&k);
        let known = before.filter(|(other, _)| are_alike(scene, *other, k));
        if let Some((_, refused)) = known
            && (refused || own.is_none())
        {
            continue;
        }
        before = Some((k, false));
        let member = body.member(0);
        let mut block = InertialBlock::default();
        block.set(0, member.inertial);
        let refuses = |load: &Load| info.refuses(load, &block);
        let under = |on: &[bool]| lasting(scene, k, &[member], on);
        let refused = sets.iter().find_map(|&set| {
            let set = &times.sets[set];
            let refusal = refuses(&under(&set.on))?;
            Some((set.by, refusal))
        });
        if let Some((by, refusal)) = refused {
            // Of a switch and a method the later one is where it went wrong.
            let at = |event: Option<usize>| event.map_or(-1.0, |k| scene.events[k].at);
            let (by, after) = match at(phase.by) > at(by) {
                true => (phase.by, "with that method, "),
                false => (by, "after a switch, "),
            };
            let why = match by {
                None => format!("{}: {refusal}", body.name),
                Some(_) => format!("{after}{}: {refusal}", body.name),
            };
            found.push(Unpaired {
                why,
                body: k,
                event: by,
            });
            before = Some((k, true));
            continue;
        }
        let own = own.into_iter().flatten();
        for &(index, set) in own.chain(&events.clicks) {
            let event = &scene.events[index];
            let over = event.at + event.action.lasts();
            if !sets.contains(&set) || event.at >= phase.until || over <= phase.from {
                continue;
            }
            let event = match &event.action {
                // Wherever it hits: not at the centre of mass, where a force turns nothing.
                Action::Click(click) => &event.on(k, click.at(Vector3::x())),
                _ => event,
            };
            let mut load = under(&times.sets[set].on);
            if let Some(effect) = event.effect(0, &member.inertial, member.q_pb) {
                load.push(effect);
            }
            if let Some(refusal) = refuses(&load) {
                let noun = scene.events[index].action.noun();
                found.push(Unpaired {
                    why: reason(body, noun, &refusal.0),
                    body: k,
                    event: Some(index),
                });
            }
        }
    }
    found
}

/// Whether the same effects act on both bodies, and alike, and the same method steps them.
pub(super) fn are_alike(scene: &Scene, a: usize, b: usize) -> bool {
    let (one, other) = (&scene.bodies[a], &scene.bodies[b]);
    let mut effects = scene.effects.iter();
    one.properties == other.properties
        && one.pivot_b == other.pivot_b
        && one.method == other.method
        && effects.all(|effect| effect.concerns(a) == effect.concerns(b))
}

fn reason(body: &Body, noun: &str, why: &str) -> String {
    format!("a {noun} on {}: {why}", body.name)
}

/// Effects that are on together.
struct Set {
    on: Vec<bool>,
    /// The event that first made it so.
    by: Option<usize>,
}

/// Which effects are on, when.
struct Times {
    /// Every set there is, once.
    sets: Vec<Set>,
    /// From when on (s) which of them, in order of time.
    periods: Vec<(f64, usize)>,
}

impl Times {
    /// The sets of effects between two times (s), each once.
    fn during(&self, from: f64, until: f64) -> Vec<usize> {
        let begins = self.periods.partition_point(|(t, _)| *t <= from);
        let during = self.periods[begins.saturating_sub(1)..].iter();
        let mut sets: Vec<usize> = during
            .take_while(|(t, _)| *t < until)
            .map(|(_, set)| *set)
            .collect();
        sets.sort_unstable();
        sets.dedup();
        sets
    }

    fn of(scene: &Scene) -> Self {
        let events = scene.events.iter().enumerate();
        let mut switches: Vec<(usize, f64, usize, bool)> = events
            .filter_map(|(k, event)| match event.action {
                Action::Switch { effect, on } => Some((k, event.at, effect, on)),
                _ => None,
            })
            .collect();
        switches.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut on = scene.on_at_start();
        let mut times = Self {
            sets: Vec::new(),
            periods: Vec::new(),
        };
        let mut known = HashMap::new();
        let mut begins = |from: f64, on: &[bool], by: Option<usize>| {
            let set = *known.entry(on.to_vec()).or_insert(times.sets.len());
            if set == times.sets.len() {
                let on = on.to_vec();
                times.sets.push(Set { on, by });
            }
            times.periods.push((from, set));
        };
        if switches.first().is_none_or(|switch| switch.1 > 0.0) {
            begins(0.0, &on, None);
        }
        for together in switches.chunk_by(|a, b| a.1 == b.1) {
            for &(_, _, effect, to) in together {
                on[effect] = to;
            }
            begins(together[0].1, &on, Some(together[0].0));
        }
        times
    }
}

/// Events that last, by index, each beside a set of effects beside which it acts.
#[derive(Default)]
struct Lasting {
    of_bodies: HashMap<usize, Vec<(usize, usize)>>,
    clicks: Vec<(usize, usize)>,
}

/// One event of every entry of the file beside every set of effects: its repeats are alike.
fn lasting_events(scene: &Scene, times: &Times) -> Lasting {
    let mut found = Lasting::default();
    let mut seen: HashMap<(usize, &Target), HashSet<usize>> = HashMap::new();
    for (k, event) in scene.events.iter().enumerate() {
        let lasts = event.action.lasts();
        if lasts == 0.0 {
            continue;
        }
        let seen = seen.entry((event.entry, &event.target)).or_default();
        if seen.len() == times.sets.len() {
            continue;
        }
        let begins = times.periods.partition_point(|(from, _)| *from <= event.at);
        let during = times.periods[begins.saturating_sub(1)..].iter();
        let during = during.take_while(|(from, _)| *from < event.at + lasts);
        for &(_, set) in during {
            if seen.insert(set) {
                match event.target {
                    Target::Body(body) => found.of_bodies.entry(body).or_default().push((k, set)),
                    _ => found.clicks.push((k, set)),
                }
            }
        }
    }
    found
}
