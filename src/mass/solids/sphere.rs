//! The solid sphere: `I = 2/5 m r²` about every axis.

use super::{NamedPoint, ProfilePoint, Solid, SolidKind, Surface, ends, length, positive};
use crate::mass::ray::{Hit, Ray};
use nalgebra::Vector3;
use std::f64::consts::PI;

pub const KIND: SolidKind = SolidKind {
    name: "sphere",
    parameters: &[length("radius")],
    about: "I = 2/5 m r²",
    make: |p| {
        positive(&[("radius", p[0])])?;
        Ok(Box::new(Sphere { radius: p[0] }))
    },
};

#[derive(Debug)]
struct Sphere {
    radius: f64,
}

impl Solid for Sphere {
    fn moments(&self, mass: f64) -> Vector3<f64> {
        Vector3::repeat(0.4 * mass * self.radius * self.radius)
    }

    fn volume(&self) -> Option<f64> {
        Some(4.0 / 3.0 * PI * self.radius * self.radius * self.radius)
    }

    fn contains(&self, p: Vector3<f64>) -> bool {
        p.norm_squared() <= self.radius * self.radius
    }

    fn points(&self) -> Vec<NamedPoint> {
        ends(self.radius)
    }

    fn surface(&self) -> Surface {
        Surface::Revolution(vec![ProfilePoint::half_circle(self.radius)])
    }

    fn ray(&self, ray: &Ray) -> Option<Hit> {
        ray.meets_sphere(self.radius)
    }
}
