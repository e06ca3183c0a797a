//! `shape = { parts = […] }`: one body of several solids.
//!
//! Each part weighs what its own `mass` or `density` says, or is filled at the body's density. With
//! a mass for the whole the parts are in proportion: by what they say of themselves, or, where none
//! says anything, by volume.

use super::body::{name, orientation, solid, vector};
use super::files::Files;
use super::problem::Problems;
use super::table::{Node, Table};
use crate::mass::solids::Solid;
use crate::mass::{Compound, Part};
use std::sync::Arc;

/// What the body's own keys say its parts are made of.
#[derive(Clone, Copy)]
pub(super) struct Filling<'t, 'd> {
    body: &'t Table<'d>,
}

/// What a part weighs.
enum Weight {
    /// kg, by its own account.
    Own(f64),
    /// m³, to be filled.
    Volume(f64),
}

impl<'t, 'd> Filling<'t, 'd> {
    pub fn of(body: &'t Table<'d>) -> Self {
        Self { body }
    }
}

pub(super) fn read(
    node: &Node<'_>,
    filling: Filling<'_, '_>,
    files: &Files<'_>,
    problems: &mut Problems,
) -> Option<Arc<dyn Solid>> {
    let tables = node.tables("a part", problems)?;
    if tables.is_empty() {
        node.problem(
            "has no part; a part is { shape = {…}, position = [x, y, z] }",
            problems,
        );
        return None;
    }
    let read: Vec<Option<(Part, Weight)>> = tables
        .iter()
        .map(|table| part(table, files, problems))
        .collect();
    let unique = names_differ(&tables, problems);
    let parts: Option<Vec<(Part, Weight)>> = read.into_iter().collect();
    let parts = parts.filter(|_| unique)?;
    weighed(&tables, parts, filling, problems).map(|compound| Arc::new(compound) as Arc<dyn Solid>)
}

/// A part, its mass still open.
fn part(table: &Table<'_>, files: &Files<'_>, problems: &mut Problems) -> Option<(Part, Weight)> {
    let name = match table.get("name") {
        None => Some(None),
        Some(node) => name(&node, problems).map(|name| Some(name.to_owned())),
    };
    let solid = table
        .require(
            "shape",
            "its solid, as in { sphere = { radius = 0.5 } }",
            problems,
        )
        .and_then(|node| solid(&node, None, files, problems));
    let position = vector(table, "position", "m", problems);
    let orientation = orientation(table, problems);
    let mass = table.get("mass");
    let density = table.get("density");
    let weight = solid
        .as_ref()
        .and_then(|solid| weight(table, &**solid, (mass, density), problems));
    table.check_keys(problems);
    let part = Part {
        name: name?,
        solid: solid?,
        mass: 0.0,
        position: position?,
        orientation: orientation?,
    };
    Some((part, weight?))
}

fn weight(
    table: &Table<'_>,
    solid: &dyn Solid,
    (mass, density): (Option<Node<'_>>, Option<Node<'_>>),
    problems: &mut Problems,
) -> Option<Weight> {
    match (mass, density) {
        (Some(_), Some(node)) => {
            node.problem(
                "beside a mass says the same thing twice; keep one",
                problems,
            );
            None
        }
        (Some(node), None) => node.positive("kg", problems).map(Weight::Own),
        (None, Some(node)) => {
            let density = node.positive("kg/m³", problems)?;
            let Some(volume) = solid.volume() else {
                node.problem(
                    "needs a volume, and a thin part has none; give its mass",
                    problems,
                );
                return None;
            };
            Some(Weight::Own(density * volume))
        }
        (None, None) => {
            let Some(volume) = solid.volume() else {
                let message = format!(
                    "{} has no thickness to fill; give it a mass = … (kg)",
                    table.name()
                );
                problems.add(table.span(), message);
                return None;
            };
            Some(Weight::Volume(volume))
        }
    }
}

/// Whether no two parts have the same name; a point would have two places.
fn names_differ(tables: &[Table<'_>], problems: &mut Problems) -> bool {
    let mut seen = std::collections::HashSet::new();
    let mut unique = true;
    for node in tables.iter().filter_map(|table| table.get("name")) {
        if let Some(name) = node.quiet_str()
            && !seen.insert(name)
        {
            node.problem(
                "is the name of an earlier part too; give each its own",
                problems,
            );
            unique = false;
        }
    }
    unique
}

fn weighed(
    tables: &[Table<'_>],
    parts: Vec<(Part, Weight)>,
    Filling { body }: Filling<'_, '_>,
    problems: &mut Problems,
) -> Option<Compound> {
    let own = |weight: &Weight| matches!(weight, Weight::Own(_));
    let owning = parts.iter().filter(|(_, weight)| own(weight)).count();
    let density = match body.get("density") {
        Some(node) if owning == parts.len() => {
            node.problem(
                "has no part to fill: every part says what it weighs; leave it out",
                problems,
            );
            return None;
        }
        Some(node) => Some(node.positive("kg/m³", problems)?),
        None => None,
    };
    if owning > 0 && owning < parts.len() && density.is_none() {
        for (table, _) in tables.iter().zip(&parts).filter(|(_, (_, w))| !own(w)) {
            let message = format!(
                "{} says not what it weighs, and others do; give it a mass (kg) or a density (kg/m³), or give the body a density for all that lack one",
                table.name()
            );
            problems.add(table.span(), message);
        }
        return None;
    }
    let fill = |(part, weight): (Part, Weight)| Part {
        mass: match weight {
            Weight::Own(mass) => mass,
            Weight::Volume(volume) => volume * density.unwrap_or(1.0),
        },
        ..part
    };
    let known = owning > 0 || density.is_some();
    let parts = parts.into_iter().map(fill).collect();
    Some(match known {
        true => Compound::of_masses(parts),
        false => Compound::in_proportion(parts),
    })
}
