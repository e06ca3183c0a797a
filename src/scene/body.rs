//! `[[body]]`: shape, mass, inertia, pose, pivot.

use super::problem::Problems;
use super::table::{Node, Table, nearest};
use crate::mass::solids::{SOLIDS, Solid, SolidKind};
use crate::mass::{MassProperties, UnphysicalMass};
use crate::math::axis_angle;
use nalgebra::{Matrix3, Quaternion, Unit, UnitQuaternion, Vector3};
use std::collections::HashMap;
use std::sync::Arc;

/// A body as a scene describes it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Body {
    pub name: String,
    /// What the picture calls it.
    pub label: String,
    pub properties: MassProperties,
    pub solid: Option<Arc<dyn Solid>>,
    /// A point of the body that stays where it is: body axes, from the centre of mass, m.
    pub pivot_b: Option<Vector3<f64>>,
    /// Of the centre of mass, world, m.
    pub position_w: Vector3<f64>,
    /// Of the centre of mass, world, m/s.
    pub velocity_w: Vector3<f64>,
    pub q_wb: UnitQuaternion<f64>,
    /// World, rad/s.
    pub omega_w: Vector3<f64>,
}

impl Body {
    /// A point given from the shape's origin, counted from the centre of mass instead.
    pub(super) fn relative_to_centre(&self, point_b: Vector3<f64>) -> Vector3<f64> {
        point_b
            - self
                .solid
                .as_ref()
                .map_or_else(Vector3::zeros, |s| s.centre())
    }

    /// The points of the body that have a name, from the shape's origin.
    pub(super) fn points(&self) -> Vec<(&'static str, Vector3<f64>)> {
        match &self.solid {
            Some(solid) => solid.points(),
            None => vec![("centre", Vector3::zeros())],
        }
    }
}

/// The bodies read; events refer to them by name even where one of them is wrong.
pub(super) struct Bodies {
    pub declared: usize,
    pub valid: Vec<Option<Body>>,
    pub index: HashMap<String, usize>,
}

impl Bodies {
    pub fn into_valid(self) -> Option<Vec<Body>> {
        self.valid.into_iter().collect()
    }

    /// The index of a body named by an event.
    pub fn find(&self, node: &Node<'_>, problems: &mut Problems) -> Option<usize> {
        let name = node.str(problems)?;
        let found = self.index.get(name).copied();
        // Of many wrong names only the first are told, and comparing takes its time.
        if found.is_none() && problems.is_full() {
            problems.add(&node.span, "");
        } else if found.is_none() {
            let mut names: Vec<&str> = self.index.keys().map(String::as_str).collect();
            names.sort_unstable();
            let remedy = nearest(name, &names);
            node.problem(format!("names no body of the scene; {remedy}"), problems);
        }
        found
    }
}

pub(super) fn read_all(tables: &[Table<'_>], gyroscopic: bool, problems: &mut Problems) -> Bodies {
    let mut bodies = Bodies {
        declared: tables.len(),
        valid: Vec::new(),
        index: HashMap::new(),
    };
    for (k, table) in tables.iter().enumerate() {
        // A name that will not do still names its body to the events.
        if let Some(node) = table.require("name", "a name for it", problems)
            && let Some(name) = name(&node, problems)
            && bodies.index.insert(name.to_owned(), k).is_some()
        {
            node.problem(
                "is the name of an earlier body too; give each its own",
                problems,
            );
        }
        if let Some(node) = table.get("immovable")
            && gyroscopic
        {
            node.problem(
                "with gyroscopic = true has no meaning yet: a held axis is the tutorial's, whose model has no gyroscopic term; use a pivot, or switch one of them off",
                problems,
            );
        }
        bodies.valid.push(read(table, problems));
        table.check_keys(problems);
    }
    bodies
}

/// Bytes of a name, and of a label: what a picture can show.
const LONGEST_NAME: usize = 64;

/// Names become paths of the recording, so they hold nothing that a path would read otherwise.
fn name<'d>(node: &Node<'d>, problems: &mut Problems) -> Option<&'d str> {
    let name = node.str(problems)?;
    let plain = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    if name.is_empty() || name.len() > LONGEST_NAME || !name.chars().all(plain) {
        node.problem(
            format!("is no name: it may hold up to {LONGEST_NAME} letters, digits, - and _ (a label may hold anything)"),
            problems,
        );
    }
    Some(name)
}

fn label<'d>(node: &Node<'d>, problems: &mut Problems) -> Option<&'d str> {
    let label = node.str(problems)?;
    if label.len() > LONGEST_NAME || label.contains(char::is_control) {
        node.problem(
            format!("is no label: one line of up to {LONGEST_NAME} bytes"),
            problems,
        );
    }
    Some(label)
}

fn read(table: &Table<'_>, problems: &mut Problems) -> Option<Body> {
    let name = table
        .get("name")
        .and_then(|node| node.str(&mut Problems::new("", "")));
    let label = table.get("label").and_then(|node| label(&node, problems));
    let shape = table.get("shape").map(|node| solid(&node, problems));
    let solid: Option<Arc<dyn Solid>> = shape.as_ref().and_then(Option::clone);
    let properties = properties(table, shape.as_ref(), problems);
    let position_w = vector(table, "position", "m", problems);
    let velocity = table.get("velocity");
    let pivot = table.get("pivot");
    let velocity_w = velocity.as_ref().map(|node| node.vector("m/s", problems));
    let omega_w = vector(table, "angular_velocity", "rad/s", problems);
    let q_wb = match table.get("orientation") {
        None => Some(UnitQuaternion::identity()),
        Some(node) => orientation(node, problems),
    };
    let mut body = Body {
        label: label.or(name).unwrap_or_default().to_owned(),
        name: name.unwrap_or_default().to_owned(),
        properties: properties?,
        solid,
        pivot_b: None,
        position_w: position_w?,
        velocity_w: velocity_w.unwrap_or(Some(Vector3::zeros()))?,
        q_wb: q_wb?,
        omega_w: omega_w?,
    };
    if let Some(node) = pivot {
        let pivot = point(&node, &body, problems)?;
        if let Err(why) = body.properties.check_about(pivot) {
            node.problem(format!("cannot be held there: {why}"), problems);
            return None;
        }
        body.pivot_b = Some(pivot);
        if let Some(velocity) = velocity
            && body.velocity_w != Vector3::zeros()
        {
            velocity.problem(
                "on a body that a pivot holds; leave it out, the pivot stays where it is",
                problems,
            );
        }
        body.velocity_w = body.omega_w.cross(&(body.q_wb * -pivot));
    }
    Some(body)
}

fn vector(
    table: &Table<'_>,
    key: &'static str,
    unit: &str,
    problems: &mut Problems,
) -> Option<Vector3<f64>> {
    match table.get(key) {
        None => Some(Vector3::zeros()),
        Some(node) => node.vector(unit, problems),
    }
}

/// A point of the body, by name or by three numbers in body axes from the shape's origin;
/// returned from the centre of mass.
pub(super) fn point(node: &Node<'_>, body: &Body, problems: &mut Problems) -> Option<Vector3<f64>> {
    if let Some(("body", inner)) = node.only_entry() {
        return point(&inner, body, problems);
    }
    if !node.is_text() {
        return Some(body.relative_to_centre(node.vector("m", problems)?));
    }
    let name = node.str(problems)?;
    let points = body.points();
    match points.iter().find(|(known, _)| *known == name) {
        Some(&(_, point)) => Some(body.relative_to_centre(point)),
        None => {
            let names: Vec<&str> = points.iter().map(|(name, _)| *name).collect();
            let message = format!(
                "is no named point of this body ({}); a point by numbers is {{ body = [x, y, z] }} in its axes, m",
                names.join(", ")
            );
            node.problem(message, problems);
            None
        }
    }
}

fn solid(node: &Node<'_>, problems: &mut Problems) -> Option<Arc<dyn Solid>> {
    let names: Vec<&str> = SOLIDS.iter().map(|kind| kind.name).collect();
    let Some((name, name_span, inner)) = node.choice() else {
        let remedy = format!(
            "must name one solid and its lengths, as in {{ sphere = {{ radius = 0.5 }} }}; known: {}",
            names.join(", ")
        );
        node.problem(remedy, problems);
        return None;
    };
    let Some(kind) = SOLIDS.iter().find(|kind| kind.name == name) else {
        problems.add(
            &name_span,
            format!("`{name}` is no solid; {}", nearest(name, &names)),
        );
        return None;
    };
    let Some(entries) = inner.get_ref().as_table() else {
        let message = format!("{name} must be a table of lengths: {}", parameters(kind));
        problems.add(&inner.span(), message);
        return None;
    };
    let table = Table::new(entries, inner.span(), format!("{name} = {{…}}"));
    let mut lengths = Vec::new();
    for parameter in kind.parameters {
        let node = match parameter.default {
            Some(_) => table.get(parameter.name),
            None => table.require(parameter.name, "it, in metres", problems),
        };
        lengths.push(match node {
            Some(node) => node.number("m", problems),
            None => parameter.default,
        });
    }
    table.check_keys(problems);
    let lengths: Option<Vec<f64>> = lengths.into_iter().collect();
    match (kind.make)(&lengths?) {
        Ok(solid) => Some(Arc::from(solid)),
        Err(why) => {
            node.problem(format!("is no {name}: {why}"), problems);
            None
        }
    }
}

fn parameters(kind: &SolidKind) -> String {
    let names: Vec<&str> = kind.parameters.iter().map(|p| p.name).collect();
    names.join(", ")
}

/// Mass or density, inertia given or the shape's, axes that nothing turns.
fn properties(
    table: &Table<'_>,
    shape: Option<&Option<Arc<dyn Solid>>>,
    problems: &mut Problems,
) -> Option<MassProperties> {
    let (mass, density) = (table.get("mass"), table.get("density"));
    let explicit = table.get("inertia");
    let inertia = explicit.as_ref().map(|node| inertia(node, problems));
    let immovable = immovable(table, problems);
    if mass.as_ref().is_some_and(Node::is_text) {
        let node = mass?;
        if node.str(problems)? != "infinite" {
            node.problem("is neither a mass in kg nor \"infinite\"", problems);
            return None;
        }
        if let Some(node) = explicit {
            node.problem(
                "says nothing of a body of infinite mass; leave it out",
                problems,
            );
            return None;
        }
        if let Some(node) = density {
            node.problem(
                "says nothing of a body of infinite mass; leave it out",
                problems,
            );
            return None;
        }
        return Some(MassProperties::infinite());
    }
    let solid = shape.and_then(Option::as_ref);
    let mass_kg = match (&mass, &density) {
        (Some(_), Some(node)) => {
            node.problem(
                "beside a mass says the same thing twice; keep one",
                problems,
            );
            None
        }
        (Some(node), None) => node.positive("kg", problems),
        (None, Some(node)) => mass_of(node, shape, problems),
        (None, None) => {
            let message = format!(
                "{} lacks a mass; add mass = 1.0 (kg), density (kg/m³), or mass = \"infinite\"",
                table.name()
            );
            problems.add(table.span(), message);
            None
        }
    };
    let tensor = match (inertia, shape) {
        (Some(tensor), _) => tensor,
        (None, Some(_)) => mass_kg
            .zip(solid)
            .map(|(mass, solid)| Matrix3::from_diagonal(&solid.moments(mass))),
        (None, None) => {
            let message = format!(
                "{} has neither a shape nor an inertia; add one of them",
                table.name()
            );
            problems.add(table.span(), message);
            None
        }
    };
    checked(
        table,
        mass_kg?,
        tensor?,
        immovable?,
        explicit.as_ref(),
        problems,
    )
}

fn checked(
    table: &Table<'_>,
    mass: f64,
    tensor: Matrix3<f64>,
    immovable: [bool; 3],
    explicit: Option<&Node<'_>>,
    problems: &mut Problems,
) -> Option<MassProperties> {
    match (MassProperties::new(mass, tensor, immovable), explicit) {
        (Ok(properties), _) => Some(properties),
        (Err(UnphysicalMass::Inertia(why)), Some(node)) => {
            node.problem(format!("cannot belong to a rigid body: {why}"), problems);
            None
        }
        (Err(why), _) => {
            // Sizes or masses so extreme that moments leave the range of an f64.
            let message = format!("{} has no usable mass properties: {why}", table.name());
            problems.add(table.span(), message);
            None
        }
    }
}

fn mass_of(
    density: &Node<'_>,
    shape: Option<&Option<Arc<dyn Solid>>>,
    problems: &mut Problems,
) -> Option<f64> {
    let value = density.positive("kg/m³", problems)?;
    match shape {
        None => {
            density.problem("needs a shape to fill; add one, or give the mass", problems);
            None
        }
        Some(None) => None,
        Some(Some(solid)) => match solid.volume() {
            Some(volume) => Some(value * volume),
            None => {
                density.problem(
                    "needs a volume, and a thin shell has none; give the mass",
                    problems,
                );
                None
            }
        },
    }
}

fn inertia(node: &Node<'_>, problems: &mut Problems) -> Option<Matrix3<f64>> {
    if node.is_array_of_arrays() {
        return node.matrix("kg m²", problems);
    }
    if node.array_length() != Some(3) {
        node.problem("must be three moments or three rows of three (kg m², about the centre of mass, body axes)", problems);
        return None;
    }
    Some(Matrix3::from_diagonal(&node.vector("kg m²", problems)?))
}

fn immovable(table: &Table<'_>, problems: &mut Problems) -> Option<[bool; 3]> {
    let mut held = [false; 3];
    let Some(node) = table.get("immovable") else {
        return Some(held);
    };
    for axis in node.texts(problems)? {
        match axis.str(problems)? {
            "x" => held[0] = true,
            "y" => held[1] = true,
            "z" => held[2] = true,
            other => {
                let message =
                    format!("\"{other}\" is no body axis; the axes are \"x\", \"y\" and \"z\"");
                problems.add(&axis.span, message);
                return None;
            }
        }
    }
    Some(held)
}

fn orientation(node: Node<'_>, problems: &mut Problems) -> Option<UnitQuaternion<f64>> {
    if !node.is_table() {
        let [x, y, z, w] = node.numbers::<4>("a quaternion x, y, z, w, body to world", problems)?;
        let largest = [x, y, z, w]
            .into_iter()
            .fold(0.0_f64, |a, b| a.max(b.abs()));
        let q = Quaternion::new(w / largest, x / largest, y / largest, z / largest);
        let q = UnitQuaternion::try_new(q, 0.0).filter(|_| largest > 0.0);
        if q.is_none() {
            node.problem(
                "has no length; a rotation by nothing is [0, 0, 0, 1]",
                problems,
            );
        }
        return q;
    }
    let table = node.table("orientation = {…}".to_owned(), problems)?;
    let axis = table.require("axis", "the axis turned about, such as [0, 0, 1]", problems);
    let degrees = table.require("degrees", "the angle in degrees", problems);
    let axis = axis.and_then(|node| {
        let axis = node.vector("a direction", problems)?;
        let axis = Unit::try_new(axis / axis.amax(), 0.0).filter(|_| axis.amax() > 0.0);
        if axis.is_none() {
            node.problem("has no length, so it is no axis", problems);
        }
        axis
    });
    let degrees = degrees.and_then(|node| node.number("degrees", problems));
    table.check_keys(problems);
    Some(axis_angle(axis?, degrees?.to_radians()))
}
