//! Solids of uniform density: one file each, one line in [`SOLIDS`].
//!
//! A solid has an origin and axes of its own, in which its points are given. For all but the
//! cone the origin is the centre of mass; for the cone it is the centre of its base.

mod cone;
mod cuboid;
mod cylinder;
mod hollow_sphere;
mod sphere;

use super::ray::{Hit, Ray};
use nalgebra::Vector3;
use std::fmt::Debug;

/// A body of uniform density whose mass properties are known in closed form.
pub trait Solid: Debug + Send + Sync {
    /// Principal moments about the centre of mass, along the solid's axes, kg m².
    fn moments(&self, mass: f64) -> Vector3<f64>;

    /// m³; `None` for a surface without thickness, which has no density.
    fn volume(&self) -> Option<f64>;

    /// The centre of mass, from the solid's origin, m.
    fn centre(&self) -> Vector3<f64> {
        Vector3::zeros()
    }

    /// Points that have a name, from the solid's origin, m.
    fn points(&self) -> Vec<(&'static str, Vector3<f64>)> {
        vec![("centre", self.centre())]
    }

    /// Its shape, for drawing, from the solid's origin.
    fn surface(&self) -> Surface;

    /// Where a ray (the solid's axes, from its origin) first meets it. What is drawn of flat, cylindrical
    /// and conical pieces is exact; a solid that is drawn in facets says itself where it is met.
    fn ray(&self, ray: &Ray) -> Option<Hit> {
        self.surface().meets(ray)
    }
}

/// The outer surface of a solid.
#[derive(Clone, Debug, PartialEq)]
pub enum Surface {
    /// A box of these full extents about the origin, m.
    Cuboid(Vector3<f64>),
    /// A profile turned about the y axis: polylines of (radius, y), m, from top to bottom.
    /// Each polyline is smooth, with normals that vary along it; between two is an edge.
    Revolution(Vec<Vec<ProfilePoint>>),
}

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
        const PIECES: usize = 24;
        (0..=PIECES)
            .map(|k| {
                let (sin, cos) = libm::sincos(std::f64::consts::PI * k as f64 / PIECES as f64);
                Self {
                    at: [radius * sin, radius * cos],
                    normal: [sin, cos],
                }
            })
            .collect()
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
    &cone::KIND,
];

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
