//! `[[body]]`: shape, mass, inertia, pose, pivot.

use super::files::Files;
use super::inertia::{self, Given};
use super::inertial;
use super::parts::{self, Filling};
use super::problem::Problems;
use super::read;
use super::swarm::{self, Spread};
use super::table::{Node, Table, nearest};
use crate::body::{Inertial, State};
use crate::effect::Member;
use crate::integrator::Method;
use crate::mass::solids::{NamedPoint, SOLIDS, Solid, SolidKind};
use crate::mass::{MassProperties, UnphysicalMass};
use crate::math::axis_angle;
use nalgebra::{Matrix3, Quaternion, Unit, UnitQuaternion, Vector3};
use std::collections::HashMap;
use std::ops::Range;
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
    /// By which it goes in place of the scene's.
    pub method: Option<OwnMethod>,
    /// The swarm it is one of, if any; those that are in none come first.
    pub swarm: Option<Arc<str>>,
}

impl Body {
    /// As effects find it in a lane of a block.
    pub(crate) fn member(&self, lane: usize) -> Member<'_> {
        let (inertial, q_bp) = Inertial::new(&self.properties, self.pivot_b);
        Member {
            lane,
            inertial,
            q_pb: q_bp.inverse(),
            body: self,
        }
    }

    /// How it starts: about its reference point, in its principal axes. What a pivot holds stays.
    pub(crate) fn start(&self, q_pb: UnitQuaternion<f64>) -> State {
        let (x_w, v_w) = match self.pivot_b {
            Some(pivot_b) => (self.position_w + self.q_wb * pivot_b, Vector3::zeros()),
            None => (self.position_w, self.velocity_w),
        };
        State {
            x_w,
            v_w,
            q_wp: (self.q_wb * q_pb.inverse()).into_inner(),
            omega_w: self.omega_w,
        }
    }
}

/// A method for one body.
#[derive(Clone, Copy)]
pub struct OwnMethod {
    pub method: &'static dyn Method,
    /// For a method with steps of its own, as [`super::Stepping::Method`] has it.
    pub tolerance: f64,
}

impl PartialEq for OwnMethod {
    fn eq(&self, other: &Self) -> bool {
        let name = |own: &Self| own.method.info().name;
        name(self) == name(other) && self.tolerance == other.tolerance
    }
}

impl std::fmt::Debug for OwnMethod {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} ({:e})", self.method.info().name, self.tolerance)
    }
}

impl Body {
    /// Gives the centre of mass the velocity that it has about a pivot, where there is one.
    pub(super) fn follow_pivot(&mut self) {
        if let Some(pivot_b) = self.pivot_b {
            self.velocity_w = self.omega_w.cross(&(self.q_wb * -pivot_b));
        }
    }
}

/// The centre of mass from the shape's origin.
pub(super) fn centre(solid: Option<&dyn Solid>) -> Vector3<f64> {
    solid.map_or_else(Vector3::zeros, Solid::centre)
}

/// The points that have a name, from the shape's origin.
pub(super) fn points(solid: Option<&dyn Solid>) -> Vec<NamedPoint> {
    match solid {
        Some(solid) => solid.points(),
        None => vec![("centre".into(), Vector3::zeros())],
    }
}

/// The bodies read; events refer to them by name even where one of them is wrong.
#[derive(Default)]
pub(super) struct Bodies {
    pub valid: Vec<Option<Body>>,
    /// Bodies and swarms.
    names: HashMap<String, Named>,
}

/// What a name stands for. The bodies of a swarm have no entries of their own.
struct Named {
    first: usize,
    /// Of a swarm.
    count: Option<usize>,
}

impl Bodies {
    pub fn into_valid(self) -> Option<Vec<Body>> {
        self.valid.into_iter().collect()
    }

    /// Right or wrong.
    pub fn declared(&self) -> usize {
        self.valid.len()
    }

    /// The index of a body named by an event.
    pub fn find(&self, node: &Node<'_>, problems: &mut Problems) -> Option<usize> {
        let name = node.str(problems)?;
        let found = self.index(name);
        if found.is_none() {
            // The names may be many, and so may the events that miss them.
            let remedy = match problems.is_full() {
                true => String::new(),
                false => self.remedy(name),
            };
            node.problem(format!("names no body of the scene; {remedy}"), problems);
        }
        found
    }

    /// The bodies of that name: of a swarm all.
    pub fn find_some(&self, node: &Node<'_>, problems: &mut Problems) -> Option<Range<usize>> {
        let named = node.quiet_str().and_then(|name| self.names.get(name));
        if let Some(&Named {
            first,
            count: Some(count),
        }) = named
        {
            return Some(first..first + count);
        }
        self.find(node, problems).map(|body| body..body + 1)
    }

    fn index(&self, name: &str) -> Option<usize> {
        match self.names.get(name) {
            Some(Named { first, count: None }) => Some(*first),
            _ => self.member(name),
        }
    }

    /// The index of a body of a swarm, `box_17`.
    fn member(&self, name: &str) -> Option<usize> {
        let (swarm, number) = name.rsplit_once('_')?;
        let &Named { first, count } = self.names.get(swarm)?;
        let k: usize = number.parse().ok()?;
        // Written as the swarm writes it: 17, not 017 or +17.
        (k < count? && number == k.to_string()).then_some(first + k)
    }

    fn remedy(&self, name: &str) -> String {
        let swarm = name.rsplit_once('_').map_or(name, |(swarm, _)| swarm);
        for swarm in [name, swarm] {
            if let Some(count) = self.names.get(swarm).and_then(|named| named.count) {
                let last = count.saturating_sub(1);
                return format!("the swarm {swarm} has {swarm}_0 to {swarm}_{last}");
            }
        }
        let mut names: Vec<&str> = self.names.keys().map(String::as_str).collect();
        names.sort_unstable();
        nearest(name, &names)
    }

    /// Enters a name; one that will not do still names its body to the events.
    fn declare(&mut self, table: &Table<'_>, count: Option<usize>, problems: &mut Problems) {
        let Some(node) = table.require("name", "a name for it", problems) else {
            return;
        };
        let Some(name) = name(&node, problems) else {
            return;
        };
        let named = Named {
            first: self.valid.len(),
            count,
        };
        if self.names.insert(name.to_owned(), named).is_some() {
            let earlier = "is the name of an earlier body too; give each its own";
            node.problem(earlier, problems);
        }
    }

    fn add(&mut self, table: &Table<'_>, context: Context<'_>, problems: &mut Problems) {
        self.declare(table, None, problems);
        self.valid.push(one(table, context, problems));
        table.check_keys(problems);
    }

    /// All bodies of a swarm.
    fn add_swarm(&mut self, table: &Table<'_>, context: Context<'_>, problems: &mut Problems) {
        let room = swarm::MOST.saturating_sub(self.valid.len() as u64);
        let count = swarm::count(table, room, problems);
        let bodies = count.unwrap_or(0) as usize;
        self.declare(table, Some(bodies), problems);
        let like = one(table, context, problems);
        let spread = Spread::read(table, count, problems);
        table.check_keys(problems);
        let Some((mut like, spread)) = like.zip(spread) else {
            self.valid.resize(self.valid.len() + bodies, None);
            return;
        };
        let name = std::mem::take(&mut like.name);
        like.swarm = Some(name.as_str().into());
        let label = std::mem::take(&mut like.label);
        let labelled = table.has("label");
        self.valid.extend((0..bodies).map(|k| {
            let mut body = spread.body(&like, k as u64);
            body.name = format!("{name}_{k}");
            body.label = match labelled {
                true => format!("{label} {k}"),
                false => body.name.clone(),
            };
            Some(body)
        }));
    }
}

/// What a body is read with.
#[derive(Clone, Copy)]
pub(super) struct Context<'a> {
    /// Whether a body of this name keeps its angular momentum.
    pub gyroscopic: &'a dyn Fn(&str) -> bool,
    pub files: &'a Files<'a>,
}

pub(super) fn read_all(
    tables: &[Table<'_>],
    swarms: &[Table<'_>],
    context: Context<'_>,
    problems: &mut Problems,
) -> Bodies {
    let mut bodies = Bodies::default();
    for table in tables {
        bodies.add(table, context, problems);
    }
    for table in swarms {
        bodies.add_swarm(table, context, problems);
    }
    for table in tables {
        if let Some(node) = table.get("name")
            && let Some(name) = node.quiet_str()
            && bodies.member(name).is_some()
        {
            node.problem(
                "is the name of a body of a swarm too; give each its own",
                problems,
            );
        }
    }
    bodies
}

/// A body by its table.
fn one(table: &Table<'_>, context: Context<'_>, problems: &mut Problems) -> Option<Body> {
    let name = table.get("name").and_then(|node| node.quiet_str());
    if let Some(node) = table.get("immovable")
        && (context.gyroscopic)(name.unwrap_or_default())
    {
        node.problem(
            "with gyroscopic = true has no meaning yet: a held axis is the tutorial's, whose model has no gyroscopic term; use a pivot, or switch one of them off",
            problems,
        );
    }
    read(table, context.files, problems)
}

/// Bytes of a name, and of a label: what a picture can show.
pub(super) const LONGEST_NAME: usize = 64;

/// Names become paths of the recording, so they hold nothing that a path would read otherwise.
pub(super) fn is_name(name: &str) -> bool {
    let plain = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    !name.is_empty() && name.len() <= LONGEST_NAME && name.chars().all(plain)
}

pub(super) fn name<'d>(node: &Node<'d>, problems: &mut Problems) -> Option<&'d str> {
    let name = node.str(problems)?;
    if !is_name(name) {
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

fn read(table: &Table<'_>, files: &Files<'_>, problems: &mut Problems) -> Option<Body> {
    let name = table.get("name").and_then(|node| node.quiet_str());
    let label = table.get("label").and_then(|node| label(&node, problems));
    let (solid, properties) = match table.get("inertial") {
        Some(node) => {
            let immovable = immovable(table, problems);
            let described = inertial::read(node, table, immovable, files, problems);
            let (properties, lump) = described.unzip();
            (lump.map(|lump| lump as Arc<dyn Solid>), properties)
        }
        None => {
            let filling = Filling::of(table);
            let shape = table
                .get("shape")
                .map(|node| solid(&node, Some(filling), files, problems));
            let properties = properties(table, Shape(shape.as_ref()), problems);
            (shape.flatten(), properties)
        }
    };
    let position_w = vector(table, "position", "m", problems);
    let velocity = table.get("velocity");
    let pivot = table.get("pivot");
    let velocity_w = velocity.as_ref().map(|node| node.vector("m/s", problems));
    let omega_w = vector(table, "angular_velocity", "rad/s", problems);
    let q_wb = orientation(table, problems);
    let method = own_method(table, problems);
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
        method: method?,
        swarm: None,
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
        body.follow_pivot();
    }
    Some(body)
}

/// The body's own method, if it has one; `None` where what is written is wrong.
fn own_method(table: &Table<'_>, problems: &mut Problems) -> Option<Option<OwnMethod>> {
    let (node, tolerance) = (table.get("method"), table.get("tolerance"));
    let Some(node) = node else {
        if let Some(node) = tolerance {
            node.problem(
                "is for a method of the body's own; name one, or leave it out",
                problems,
            );
            return None;
        }
        return Some(None);
    };
    let method = read::method(&node, problems)?;
    let tolerance = match tolerance {
        None => read::DEFAULT_TOLERANCE,
        Some(node) => read::tolerance(&node, Some(method), problems)?,
    };
    Some(Some(OwnMethod { method, tolerance }))
}

pub(super) fn vector(
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
    point_of(node, body.solid.as_deref(), problems)
}

pub(super) fn point_of(
    node: &Node<'_>,
    solid: Option<&dyn Solid>,
    problems: &mut Problems,
) -> Option<Vector3<f64>> {
    if let Some(("body", inner)) = node.only_entry() {
        return point_of(&inner, solid, problems);
    }
    if !node.is_text() {
        return Some(node.vector("m", problems)? - centre(solid));
    }
    let name = node.str(problems)?;
    let points = points(solid);
    match points.iter().find(|(known, _)| *known == name) {
        Some((_, point)) => Some(point - centre(solid)),
        None => {
            let names: Vec<&str> = points.iter().map(|(name, _)| &**name).collect();
            let message = format!(
                "is no named point of this body ({}); a point by numbers is {{ body = [x, y, z] }} in its axes, m",
                names.join(", ")
            );
            node.problem(message, problems);
            None
        }
    }
}

/// A shape. `filling` is what its parts are made of, where it may have parts.
pub(super) fn solid(
    node: &Node<'_>,
    filling: Option<Filling<'_, '_>>,
    files: &Files<'_>,
    problems: &mut Problems,
) -> Option<Arc<dyn Solid>> {
    if let Some(("mesh", mesh)) = node.only_entry() {
        return Some(files.mesh(mesh, problems)?);
    }
    if let Some(("parts", inner)) = node.only_entry() {
        if filling.is_none() {
            node.problem(
                "holds parts of a part; put them all into one list",
                problems,
            );
        }
        return parts::read(&inner, filling?, files, problems);
    }
    let names = SOLIDS.iter().map(|kind| kind.name);
    let names: Vec<&str> = names.chain(["mesh", "parts"]).collect();
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

/// A body's shape: none, one that is wrong, or a solid.
#[derive(Clone, Copy)]
pub(super) struct Shape<'s>(Option<&'s Option<Arc<dyn Solid>>>);

impl<'s> Shape<'s> {
    /// Whether there is a solid; nothing where the shape is wrong.
    pub fn known(self) -> Option<Option<&'s dyn Solid>> {
        match self.0 {
            None => Some(None),
            Some(solid) => solid.as_deref().map(Some),
        }
    }

    fn solid(self) -> Option<&'s dyn Solid> {
        self.known().flatten()
    }
}

/// Mass or density, inertia given or the shape's, axes that nothing turns.
fn properties(
    table: &Table<'_>,
    shape: Shape<'_>,
    problems: &mut Problems,
) -> Option<MassProperties> {
    let (mass, density) = (table.get("mass"), table.get("density"));
    let explicit = table.get("inertia");
    let given = explicit
        .as_ref()
        .map(|node| inertia::read(node, shape, problems));
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
    let own_mass = shape.solid().and_then(Solid::own_mass);
    let mass_kg = match (&mass, &density) {
        (Some(_), Some(node)) => {
            node.problem(
                "beside a mass says the same thing twice; keep one",
                problems,
            );
            None
        }
        (Some(node), None) => node.positive("kg", problems),
        (None, _) if own_mass.is_some() => own_mass,
        (None, Some(node)) => mass_of(node, shape, problems),
        // What its parts weigh is known once they are right.
        (None, None) if shape.known().is_none() && has_parts(table) => None,
        (None, None) => {
            let message = format!(
                "{} lacks a mass; add mass = 1.0 (kg), density (kg/m³), or mass = \"infinite\"",
                table.name()
            );
            problems.add(table.span(), message);
            None
        }
    };
    let given = match given {
        // It is there and wrong.
        Some(None) => return None,
        Some(given) => given,
        None => None,
    };
    let tensor = match (&given, shape.known()) {
        (Some(given), _) => mass_kg.map(|mass| given.about_centre(mass)),
        (None, None) => None,
        (None, Some(Some(solid))) => mass_kg.map(|mass| solid.inertia(mass)),
        (None, Some(None)) => {
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
        explicit.as_ref().zip(given.as_ref()),
        problems,
    )
}

fn has_parts(table: &Table<'_>) -> bool {
    let shape = table.get("shape");
    shape.is_some_and(|node| matches!(node.only_entry(), Some(("parts", _))))
}

fn checked(
    table: &Table<'_>,
    mass: f64,
    tensor: Matrix3<f64>,
    immovable: [bool; 3],
    explicit: Option<(&Node<'_>, &Given)>,
    problems: &mut Problems,
) -> Option<MassProperties> {
    match (MassProperties::new(mass, tensor, immovable), explicit) {
        (Ok(properties), _) => Some(properties),
        (Err(UnphysicalMass::Inertia(why)), Some((node, given))) => {
            given.refuse(node, why, problems);
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

fn mass_of(density: &Node<'_>, shape: Shape<'_>, problems: &mut Problems) -> Option<f64> {
    let value = density.positive("kg/m³", problems)?;
    match shape.known()? {
        None => {
            density.problem("needs a shape to fill; add one, or give the mass", problems);
            None
        }
        Some(solid) => match solid.volume() {
            Some(volume) => Some(value * volume),
            None => {
                density.problem(
                    "needs a volume, and what is thin has none; give the mass",
                    problems,
                );
                None
            }
        },
    }
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

/// Of the body or the part that the table describes.
pub(super) fn orientation(
    table: &Table<'_>,
    problems: &mut Problems,
) -> Option<UnitQuaternion<f64>> {
    match table.get("orientation") {
        Some(node) => orientation_of(node, problems),
        None => Some(UnitQuaternion::identity()),
    }
}

pub(super) fn orientation_of(
    node: Node<'_>,
    problems: &mut Problems,
) -> Option<UnitQuaternion<f64>> {
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
