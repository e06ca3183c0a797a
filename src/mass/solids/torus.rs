//! The ring about y, from its middle to the middle of its tube R, the tube's radius c:
//! `I_y = m (R² + 3/4 c²)`, `I_x = I_z = m (1/2 R² + 5/8 c²)`.
//!
//! `∫ r² dm` over a circle of radius c at R is `m (R² + 3/4 c²)` by the weight 2πr of Pappus;
//! `∫ y² dm = m c²/4`; across it is half the first and the second.

use super::{NamedPoint, ProfilePoint, Solid, SolidKind, Surface, along_y, length, positive};
use crate::mass::ray::{Hit, Ray};
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

pub const KIND: SolidKind = SolidKind {
    name: "torus",
    parameters: &[length("radius"), length("tube_radius")],
    about: "about y, R to the middle of the tube, c of the tube; I_y = m (R² + 3/4 c²), I_x = I_z = m (R²/2 + 5/8 c²)",
    make: |p| {
        let (radius, tube) = (p[0], p[1]);
        positive(&[("radius", radius), ("tube_radius", tube)])?;
        if tube > radius {
            return Err(format!(
                "tube_radius = {tube} m must not be above the radius, {radius} m: the tube would \
                 run into itself"
            ));
        }
        Ok(Box::new(Torus { radius, tube }))
    },
};

#[derive(Debug)]
struct Torus {
    radius: f64,
    tube: f64,
}

impl Solid for Torus {
    fn moments(&self, mass: f64) -> Vector3<f64> {
        let (r2, c2) = (self.radius * self.radius, self.tube * self.tube);
        along_y(mass * (r2 + 0.75 * c2), mass * (0.5 * r2 + 5.0 / 8.0 * c2))
    }

    fn volume(&self) -> Option<f64> {
        Some(2.0 * PI * PI * self.radius * self.tube * self.tube)
    }

    fn contains(&self, p: Vector3<f64>) -> bool {
        let from_middle = (p.x * p.x + p.z * p.z).sqrt() - self.radius;
        from_middle * from_middle + p.y * p.y <= self.tube * self.tube
    }

    fn points(&self) -> Vec<NamedPoint> {
        let rim = Vector3::x() * (self.radius + self.tube);
        vec![("centre".into(), Vector3::zeros()), ("rim".into(), rim)]
    }

    /// By steps as long as the nearest point of the tube is away (Hart 1996), which never go through it.
    fn ray(&self, ray: &Ray) -> Option<Hit> {
        /// Each step leaves 1 - sin of the angle to the surface of the way: enough for half a degree.
        const STEPS: usize = 4096;
        let size = self.radius + self.tube;
        let speed = ray.direction.norm();
        let near = 1e-13 * size;
        // From where the ray enters the sphere about it all, counted from there: far away t has not the
        // digits. From the eye, where that is inside.
        let entry = match ray.origin.norm() <= size {
            true => 0.0,
            // A little before: rounded, the place may be inside the tube already.
            false => (ray.meets_sphere(size)?.t * (1.0 - 1e-12) - 1e-6 * size / speed).max(0.0),
        };
        let ray = Ray {
            origin: ray.at(entry),
            ..*ray
        };
        let mut t = 0.0;
        for _ in 0..STEPS {
            let p = ray.at(t);
            let radial = (p.x * p.x + p.z * p.z).sqrt();
            let out = radial - self.radius;
            let from_middle = (out * out + p.y * p.y).sqrt();
            let away = (from_middle - self.tube).abs();
            if away <= near {
                let along = Vector3::new(p.x, 0.0, p.z) * (out / radial);
                let normal = (along + Vector3::y() * p.y) / from_middle;
                return Some(Hit {
                    t: entry + t,
                    normal,
                });
            }
            // Past the sphere on the way out there is nothing more.
            if p.norm() > size * (1.0 + 1e-9) && p.dot(&ray.direction) > 0.0 {
                return None;
            }
            t += away / speed;
        }
        None
    }

    fn surface(&self) -> Surface {
        const PIECES: usize = 24;
        // From the inside over the top, so that the outside is gone down.
        let point = |k: usize| {
            let (sin, cos) = libm::sincos(TAU * k as f64 / PIECES as f64);
            ProfilePoint {
                at: [self.radius - self.tube * cos, self.tube * sin],
                normal: [-cos, sin],
            }
        };
        Surface::Revolution(vec![(0..=PIECES).map(point).collect()])
    }
}
