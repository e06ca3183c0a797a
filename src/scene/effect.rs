//! `[effects]` and `[[effect]]`: what acts, on whom, and whether from the start.

use super::Scene;
use super::body::{self, Bodies, Body};
use super::problem::Problems;
use super::table::{Node, Table, nearest};
use crate::effect::{
    Argument, BodyPoint, Called, Described, EFFECTS, EffectKind, Load, Member, Value,
};
use nalgebra::Vector3;
use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

/// An effect as a scene calls for it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SceneEffect {
    /// No other has it.
    pub name: Arc<str>,
    /// What [`EFFECTS`] calls it.
    pub kind: &'static str,
    pub called: Called,
    /// Indices of the bodies it acts on, in order; `None`: all of them.
    pub bodies: Option<Vec<usize>>,
    /// Whether it acts from the start.
    pub on: bool,
}

impl SceneEffect {
    pub fn concerns(&self, body: usize) -> bool {
        let some = self.bodies.as_ref();
        some.is_none_or(|bodies| bodies.binary_search(&body).is_ok())
    }

    /// Whether it concerns any of these.
    pub fn concerns_any(&self, members: &Range<usize>) -> bool {
        let Some(bodies) = &self.bodies else {
            return true;
        };
        let first = bodies.partition_point(|&body| body < members.start);
        bodies.get(first).is_some_and(|&body| body < members.end)
    }
}

impl Scene {
    /// Which of the effects are on as the scene starts, in their order.
    pub fn on_at_start(&self) -> Vec<bool> {
        self.effects.iter().map(|effect| effect.on).collect()
    }

    /// Whether two bodies are stepped by the same model (whatever is on) and method, so that they can be
    /// in one block.
    pub fn go_together(&self, a: usize, b: usize) -> bool {
        let mut terms = self.effects.iter().filter(|e| e.called.is_model_term());
        let alike = |effect: &SceneEffect| effect.concerns(a) == effect.concerns(b);
        terms.all(alike) && self.bodies[a].method == self.bodies[b].method
    }
}

/// What acts on some bodies of one block, of the effects that are on. A member's body has the index `first` and
/// its lane.
pub(crate) fn lasting(scene: &Scene, first: usize, members: &[Member<'_>], on: &[bool]) -> Load {
    let mut load = Load::default();
    let all = first..first + members.len();
    for (effect, _) in scene.effects.iter().zip(on).filter(|(_, on)| **on) {
        if !effect.concerns_any(&all) {
            continue;
        }
        let concerned = members.iter().copied();
        let concerned = concerned.filter(|member| effect.concerns(first + member.lane));
        load.call(&effect.name, &effect.called, &concerned.collect::<Vec<_>>());
    }
    load
}

/// Effects that have been read, before it is known which bodies there are.
pub(super) struct Written<'d> {
    effects: Vec<Entry<'d>>,
}

struct Entry<'d> {
    effect: SceneEffect,
    /// Where its argument is, and how the file has it.
    value: Node<'d>,
    /// The names of its bodies; `None`: all.
    bodies: Option<Vec<Node<'d>>>,
}

impl<'d> Written<'d> {
    /// Reads `[effects]` and every `[[effect]]`; `step` is the nominal one, s.
    pub fn read(top: &Table<'d>, step: f64, problems: &mut Problems) -> Self {
        let mut effects = Vec::new();
        if let Some(table) = top.table("effects", problems) {
            for kind in EFFECTS {
                let Some(value) = table.get(kind.name) else {
                    continue;
                };
                if let Some(called) = called(kind, &value, step, problems) {
                    effects.push(Entry {
                        effect: SceneEffect {
                            name: kind.name.into(),
                            kind: kind.name,
                            called,
                            bodies: None,
                            on: true,
                        },
                        value,
                        bodies: None,
                    });
                }
            }
            table.check_keys(problems);
        }
        for table in top.tables("effect", problems) {
            let entry = long_form(&table, step, &effects, problems);
            table.check_keys(problems);
            effects.extend(entry);
        }
        Self { effects }
    }

    /// Whether a body of this name keeps its angular momentum, or may when something is switched on.
    pub fn is_gyroscopic(&self, body: &str) -> bool {
        let named = |nodes: &Vec<Node<'_>>| {
            let mut names = nodes.iter().filter_map(Node::quiet_str);
            // A swarm, or one of its bodies: all of them are read as one.
            let swarm = |name: &str| {
                name.rsplit_once('_')
                    .is_some_and(|(swarm, _)| swarm == body)
            };
            names.any(|name| name == body || swarm(name))
        };
        let mut all = self.effects.iter();
        all.any(|entry| {
            let concerned = entry.bodies.as_ref().is_none_or(named);
            matches!(entry.effect.called, Called::Gyroscopic) && concerned
        })
    }

    /// What says nothing where the program chooses the step.
    pub fn nothing_per_step(&self, problems: &mut Problems) {
        for Entry { effect, value, .. } in &self.effects {
            let why = match &effect.called {
                Called::Decay(decay) if decay.is_per_step() => {
                    "is by a factor per step, and with `accuracy` there is no step it could be meant for; write a rate (1/s)"
                }
                Called::Limit(_) => {
                    "acts after each step, and with `accuracy` there is no step it could be meant for; name a method of fixed steps"
                }
                _ => continue,
            };
            value.problem(why, problems);
        }
    }

    /// Finds their bodies, and whether each can be acted on.
    pub fn on(self, bodies: &Bodies, problems: &mut Problems) -> Option<Vec<SceneEffect>> {
        let placed = self.effects.into_iter().map(|entry| {
            let mut effect = entry.effect;
            if let Some(names) = entry.bodies {
                let found = names.iter().map(|name| bodies.find_some(name, problems));
                let found: Vec<Option<Range<usize>>> = found.collect();
                let found: Option<Vec<Range<usize>>> = found.into_iter().collect();
                let found: BTreeSet<usize> = found?.into_iter().flatten().collect();
                effect.bodies = Some(found.into_iter().collect());
            }
            check(&effect, &entry.value, bodies, problems)?;
            Some(effect)
        });
        // All of them, so that all are looked at.
        let placed: Vec<Option<SceneEffect>> = placed.collect();
        placed.into_iter().collect()
    }
}

/// Reports the first body that it cannot act on.
fn check(
    effect: &SceneEffect,
    value: &Node<'_>,
    bodies: &Bodies,
    problems: &mut Problems,
) -> Option<()> {
    let Called::Load(spec) = &effect.called else {
        return Some(());
    };
    // A body that is itself wrong has been reported.
    let valid = bodies.valid.iter().enumerate();
    let concerned = valid.filter(|(k, _)| effect.concerns(*k));
    let mut concerned = concerned.filter_map(|(_, body)| body.as_ref());
    let Some(why) = concerned.find_map(|body: &Body| spec.check(body).err()) else {
        return Some(());
    };
    value.problem(format!("cannot act here: {why}"), problems);
    None
}

/// Names of torques that no effect of the list is the source of.
const TAKEN: [&str; 2] = ["push", "torque"];

fn long_form<'d>(
    table: &Table<'d>,
    step: f64,
    earlier: &[Entry<'d>],
    problems: &mut Problems,
) -> Option<Entry<'d>> {
    let name_node = table.get("name");
    let bodies = table.get("bodies").map(|node| {
        let names = node.texts(problems)?;
        if names.is_empty() {
            node.problem(
                "names no body; leave `bodies` out for all of them, or write on = false",
                problems,
            );
        }
        Some(names)
    });
    let on = table.get("on").map(|node| node.boolean(problems));
    let given = EFFECTS
        .iter()
        .filter_map(|&kind| Some((kind, table.get(kind.name)?)));
    let mut given: Vec<(&EffectKind, Node<'d>)> = given.collect();
    let (Some((kind, value)), true) = (given.pop(), given.is_empty()) else {
        let kinds: Vec<&str> = EFFECTS.iter().map(|kind| kind.name).collect();
        let message = match given.is_empty() {
            true => format!(
                "{} does nothing; add one of {}",
                table.name(),
                kinds.join(", ")
            ),
            false => format!(
                "{} does several things; give each an [[effect]] of its own",
                table.name()
            ),
        };
        problems.add(table.span(), message);
        return None;
    };
    let name = match &name_node {
        None => Some(kind.name),
        Some(node) => body::name(node, problems),
    };
    let called = called(kind, &value, step, problems);
    let name = name?;
    if let Some(entry) = earlier.iter().find(|entry| &*entry.effect.name == name) {
        let kind = entry.effect.kind;
        match &name_node {
            Some(node) => node.problem(
                format!("is the name of an earlier effect too (a {kind}); give each its own"),
                problems,
            ),
            None => problems.add(
                &value.span,
                format!(
                    "a second {kind} lacks a name; add name = \"…\", by which it can be told apart"
                ),
            ),
        }
        return None;
    }
    let other = EFFECTS
        .iter()
        .any(|k| k.name == name && k.name != kind.name);
    if let (Some(node), true) = (&name_node, other || TAKEN.contains(&name)) {
        node.problem("is what something else is called; choose another", problems);
        return None;
    }
    Some(Entry {
        effect: SceneEffect {
            name: name.into(),
            kind: kind.name,
            called: called?,
            bodies: None,
            on: on.unwrap_or(Some(true))?,
        },
        value,
        bodies: match bodies {
            None => None,
            Some(names) => Some(names?),
        },
    })
}

fn called(
    kind: &EffectKind,
    node: &Node<'_>,
    step: f64,
    problems: &mut Problems,
) -> Option<Called> {
    let value = value(kind.argument, node, problems)?;
    let called = (kind.make)(&value, step);
    called
        .map_err(|why| {
            let text = node.text(problems);
            problems.add(&node.span, format!("{text}: {why}"));
        })
        .ok()
}

fn value(argument: Argument, node: &Node<'_>, problems: &mut Problems) -> Option<Value> {
    Some(match argument {
        Argument::Switch => Value::Switch(node.boolean(problems)?),
        Argument::Number(unit) => Value::Number(node.number(unit, problems)?),
        Argument::Vector(unit) => Value::Vector(node.vector(unit, problems)?),
        Argument::Amount(unit) => match node.array_length() {
            Some(_) => Value::Vector(node.vector(unit, problems)?),
            None => Value::Number(node.number(unit, problems)?),
        },
        Argument::Word(words) => {
            let word = node.str(problems)?;
            match words.iter().find(|known| **known == word) {
                Some(word) => Value::Word(word),
                None => {
                    let remedy = nearest(word, words);
                    node.problem(format!("means nothing here; {remedy}"), problems);
                    return None;
                }
            }
        }
        Argument::Attitude => Value::Attitude(body::orientation_of(node.clone(), problems)?),
        Argument::Point => Value::Point(point(node, problems)?),
        Argument::Table(keys) => {
            let table = node
                .clone()
                .table(format!("{} = {{…}}", node.key), problems)?;
            let mut values = Vec::new();
            let mut wrong = false;
            for &(key, argument) in keys {
                if let Some(node) = table.get(key) {
                    match value(argument, &node, problems) {
                        Some(value) => values.push((key, value)),
                        None => wrong = true,
                    }
                }
            }
            wrong |= table.check_keys(problems);
            if wrong {
                return None;
            }
            Value::Table(values)
        }
    })
}

fn point(node: &Node<'_>, problems: &mut Problems) -> Option<BodyPoint> {
    if let Some(("body", inner)) = node.only_entry() {
        return point(&inner, problems);
    }
    if node.is_text() {
        return Some(BodyPoint::Named(node.str(problems)?.to_owned()));
    }
    Some(BodyPoint::At(node.vector("m", problems)?))
}

impl Described for Body {
    fn name(&self) -> &str {
        &self.name
    }

    fn place(&self, point: &BodyPoint) -> Result<Vector3<f64>, String> {
        let solid = self.solid.as_deref();
        let name = match point {
            BodyPoint::At(point_b) => return Ok(point_b - body::centre(solid)),
            BodyPoint::Named(name) => name,
        };
        let points = body::points(solid);
        match points.iter().find(|(known, _)| known == name) {
            Some((_, point_b)) => Ok(point_b - body::centre(solid)),
            None => {
                let names: Vec<&str> = points.iter().map(|(name, _)| name.as_ref()).collect();
                Err(format!(
                    "{} has no point \"{name}\" (it has {}); a point by numbers is [x, y, z] in its axes, m",
                    self.name,
                    names.join(", ")
                ))
            }
        }
    }

    fn reference_w(&self) -> Vector3<f64> {
        let pivot = self.pivot_b.map(|pivot_b| self.q_wb * pivot_b);
        self.position_w + pivot.unwrap_or_default()
    }

    fn is_held(&self) -> bool {
        self.pivot_b.is_some()
    }

    fn is_held_off_centre(&self) -> bool {
        self.pivot_b
            .is_some_and(|pivot_b| pivot_b != Vector3::zeros())
    }

    fn has_immovable_axes(&self) -> bool {
        self.properties.mass().is_some() && !self.properties.is_movable_about_every_axis()
    }
}
