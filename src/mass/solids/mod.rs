//! Solids of uniform density: one file each, one line in [`SOLIDS`].
//!
//! A solid has an origin and axes of its own, in which its points are given. For all but the
//! cone the origin is the centre of mass; for the cone it is the centre of its base. An axis of
//! symmetry is y.
//!
//! The moments are those of the tables of mechanics (Meriam & Kraige, Engineering Mechanics: Dynamics,
//! table D/4); what such a table lacks (tube, capsule) is put together from its rows, in the file.

mod capsule;
mod cone;
mod cuboid;
mod cylinder;
mod disc;
mod ellipsoid;
mod hollow_sphere;
mod rod;
mod sphere;
mod torus;
mod triangles;
mod tube;

pub use triangles::Triangles;

use super::ray::{Hit, Ray};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use std::borrow::Cow;
use std::fmt::Debug;

/// A shape whose mass properties are known.
pub trait Solid: Debug + Send + Sync {
    /// Moments about the solid's axes through its centre of mass, kg m².
    fn moments(&self, mass: f64) -> Vector3<f64>;

    /// The tensor about the centre of mass, along the solid's axes, kg m²: its moments, unless its
    /// principal axes are others. Those of a solid of the table [`SOLIDS`] are principal.
    fn inertia(&self, mass: f64) -> Matrix3<f64> {
        Matrix3::from_diagonal(&self.moments(mass))
    }

    /// m³; `None` for what has no thickness, and so no density.
    fn volume(&self) -> Option<f64>;

    /// kg, where the shape itself says what it weighs: parts with densities of their own.
    fn own_mass(&self) -> Option<f64> {
        None
    }

    /// Whether a point (from the solid's origin, m) lies in it; what has no thickness has no inside.
    fn contains(&self, point: Vector3<f64>) -> bool;

    /// The centre of mass, from the solid's origin, m.
    fn centre(&self) -> Vector3<f64> {
        Vector3::zeros()
    }

    /// Points that have a name, from the solid's origin, m.
    fn points(&self) -> Vec<NamedPoint>;

    /// Its shape, for drawing, from the solid's origin.
    fn surface(&self) -> Surface;

    /// Where a ray (the solid's axes, from its origin) first meets it. What is drawn of flat, cylindrical
    /// and conical pieces is exact; a solid that is drawn in facets says itself where it is met.
    fn ray(&self, ray: &Ray) -> Option<Hit> {
        self.surface().meets(ray)
    }
}

/// A point and what it is called.
pub type NamedPoint = (Cow<'static, str>, Vector3<f64>);

/// What of a solid is seen. What has no thickness is drawn with some.
#[derive(Clone, Debug, PartialEq)]
pub enum Surface {
    /// A box of these full extents about the origin, m.
    Cuboid(Vector3<f64>),
    /// A profile turned about the y axis: polylines of (radius, y), m, from top to bottom.
    /// Each polyline is smooth, with normals that vary along it; between two is an edge.
    Revolution(Vec<Vec<ProfilePoint>>),
    /// An ellipsoid of these half axes about the origin, m.
    Ellipsoid(Vector3<f64>),
    /// Flat faces.
    Mesh(Triangles),
    /// Several, each in its place.
    Parts(Vec<Placed>),
}

/// A surface, where its origin lies (m) and how its axes are turned.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    pub surface: Surface,
    pub position: Vector3<f64>,
    pub orientation: UnitQuaternion<f64>,
}

/// How thick a thin solid is drawn, beside its length.
const DRAWN_THICKNESS: f64 = 0.02;

/// Pieces of half a circle.
const PIECES: usize = 24;

/// A point of a profile and the outward normal there, both as (radial, y).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfilePoint {
    pub at: [f64; 2],
    pub normal: [f64; 2],
}

impl ProfilePoint {
    /// A straight piece of profile from one point to the next, going down the outside.
    pub fn segment(from: [f64; 2], to: [f64; 2]) -> Vec<Self> {
        let along = [to[0] - from[0], to[1] - from[1]];
        let length = along[0].hypot(along[1]);
        let normal = [-along[1] / length, along[0] / length];
        vec![Self { at: from, normal }, Self { at: to, normal }]
    }

    /// Half a circle about the origin, from the top pole to the bottom one.
    pub fn half_circle(radius: f64) -> Vec<Self> {
        (0..=PIECES).map(|k| Self::on_circle(radius, k)).collect()
    }

    /// The same in two halves that both hold the widest point.
    pub fn quarter_circles(radius: f64) -> (Vec<Self>, Vec<Self>) {
        let part = |pieces: std::ops::RangeInclusive<usize>| {
            pieces.map(|k| Self::on_circle(radius, k)).collect()
        };
        (part(0..=PIECES / 2), part(PIECES / 2..=PIECES))
    }

    fn on_circle(radius: f64, piece: usize) -> Self {
        let (sin, cos) = libm::sincos(std::f64::consts::PI * piece as f64 / PIECES as f64);
        Self {
            at: [radius * sin, radius * cos],
            normal: [sin, cos],
        }
    }
}

/// A parameter of a solid, in metres.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    pub name: &'static str,
    /// What it is when absent; `None` where it must be given.
    pub default: Option<f64>,
}

const fn length(name: &'static str) -> Parameter {
    Parameter {
        name,
        default: None,
    }
}

/// A solid of whatever kind.
pub type AnySolid = Box<dyn Solid>;

/// How scenes name a solid and what it takes.
pub struct SolidKind {
    pub name: &'static str,
    pub parameters: &'static [Parameter],
    /// The moments and the reference, for the lists.
    pub about: &'static str,
    /// From the parameters, in their order; the error says what is wrong with them.
    pub make: fn(&[f64]) -> Result<AnySolid, String>,
}

/// Every solid, in the order of the lists.
pub const SOLIDS: &[&SolidKind] = &[
    &sphere::KIND,
    &hollow_sphere::KIND,
    &cuboid::KIND,
    &cylinder::KIND,
    &tube::KIND,
    &capsule::KIND,
    &cone::KIND,
    &ellipsoid::KIND,
    &torus::KIND,
    &rod::KIND,
    &disc::KIND,
];

/// Moments of a solid with y as its axis of symmetry.
fn along_y(about_y: f64, across: f64) -> Vector3<f64> {
    Vector3::new(across, about_y, across)
}

/// The points of a solid about its own middle that the y axis leaves at this height.
fn ends(y: f64) -> Vec<NamedPoint> {
    let up = Vector3::y() * y;
    vec![
        ("centre".into(), Vector3::zeros()),
        ("top".into(), up),
        ("bottom".into(), -up),
    ]
}

/// Lengths of a solid must be above zero and finite.
fn positive(parameters: &[(&str, f64)]) -> Result<(), String> {
    match parameters
        .iter()
        .find(|(_, x)| !(x.is_finite() && *x > 0.0))
    {
        Some((name, x)) => Err(format!("{name} = {x} m is not above zero and finite")),
        None => Ok(()),
    }
}
