//! Pushes, torques and impulses: a vector, its axes, and a point where one is needed.

use super::super::body::{self, Body};
use super::super::problem::Problems;
use super::super::table::{Node, Table};
use super::read::Reading;
use super::{Action, Framed, Target};

type Done = Option<(Target, Action)>;

/// A force at a point: for a time, or an impulse.
pub(super) fn force(reading: Reading<'_, '_>, problems: &mut Problems) -> Done {
    let unit = match reading.lasts {
        Some(_) => "N",
        None => "N·s",
    };
    at_a_point(reading, unit, problems)
}

pub(super) fn impulse(reading: Reading<'_, '_>, problems: &mut Problems) -> Done {
    at_a_point(reading, "N·s", problems)
}

/// A torque for a time, or an angular impulse.
pub(super) fn torque(reading: Reading<'_, '_>, problems: &mut Problems) -> Done {
    let unit = match reading.lasts {
        Some(_) => "N·m",
        None => "N·m·s",
    };
    turning(reading, unit, problems)
}

pub(super) fn angular_impulse(reading: Reading<'_, '_>, problems: &mut Problems) -> Done {
    turning(reading, "N·m·s", problems)
}

fn at_a_point(reading: Reading<'_, '_>, unit: &str, problems: &mut Problems) -> Done {
    let body = reading.body(problems);
    let in_body = in_body_axes(reading.table, problems);
    let vector = vector(&reading, in_body, unit, problems);
    let Some(node) = reading.table.get("point") else {
        let message = format!(
            "{} lacks `point`, where the {} acts; add point = \"centre\" or three numbers (m)",
            reading.table.name(),
            reading.node.key
        );
        problems.add(reading.table.span(), message);
        return None;
    };
    let index = body?;
    let body = reading.context.bodies.valid.get(index)?.as_ref()?;
    let point = point(&node, body, in_body?, problems)?;
    let action = match reading.lasts {
        Some((lasts, profile)) => Action::Push {
            force: vector?,
            point,
            lasts,
            profile,
        },
        None => Action::Impulse {
            impulse: vector?,
            point,
        },
    };
    Some((Target::Body(index), action))
}

fn turning(reading: Reading<'_, '_>, unit: &str, problems: &mut Problems) -> Done {
    let body = reading.body(problems);
    let in_body = in_body_axes(reading.table, problems);
    let vector = vector(&reading, in_body, unit, problems)?;
    let action = match reading.lasts {
        Some((lasts, profile)) => Action::Torque {
            torque: vector,
            lasts,
            profile,
        },
        None => Action::AngularImpulse { impulse: vector },
    };
    Some((Target::Body(body?), action))
}

fn vector(
    reading: &Reading<'_, '_>,
    in_body: Option<bool>,
    unit: &str,
    problems: &mut Problems,
) -> Option<Framed> {
    let vector = reading.node.vector(unit, problems)?;
    Some(match in_body? {
        true => Framed::Body(vector),
        false => Framed::World(vector),
    })
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
