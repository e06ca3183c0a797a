//! The capsule along y: a cylinder of radius r and height h between two half spheres.
//!
//! The cylinder has the part `h / (h + 4/3 r)` of the mass, c, and the half spheres together the
//! rest, s; a half sphere's centre of mass lies 3/8 r beyond its base. By the parallel axis
//!
//! ```text
//! I_y       = c ½ r² + s 2/5 r²
//! I_x = I_z = c (¼ r² + 1/12 h²) + s (2/5 r² + ¼ h² + 3/8 r h)
//! ```

use super::{NamedPoint, ProfilePoint, Solid, SolidKind, Surface, along_y, ends, length, positive};
use crate::mass::ray::{Hit, Ray, nearest};
use nalgebra::Vector3;
use std::f64::consts::PI;

pub const KIND: SolidKind = SolidKind {
    name: "capsule",
    parameters: &[length("radius"), length("height")],
    about: "along y, h of the cylinder alone, its part c = m h/(h + 4/3 r), of the half spheres s = m - c; I_y = 1/2 c r² + 2/5 s r², I_x = I_z = c (r²/4 + h²/12) + s (2/5 r² + h²/4 + 3/8 r h)",
    make: |p| {
        positive(&[("radius", p[0]), ("height", p[1])])?;
        Ok(Box::new(Capsule {
            radius: p[0],
            height: p[1],
        }))
    },
};

#[derive(Debug)]
struct Capsule {
    radius: f64,
    height: f64,
}

impl Solid for Capsule {
    fn moments(&self, mass: f64) -> Vector3<f64> {
        let (r, h) = (self.radius, self.height);
        let length = h + 4.0 / 3.0 * r;
        let (c, s) = (mass * (h / length), mass * (4.0 / 3.0 * r / length));
        along_y(
            (0.5 * c + 0.4 * s) * r * r,
            c * (0.25 * r * r + h * h / 12.0) + s * (0.4 * r * r + 0.25 * h * h + 0.375 * r * h),
        )
    }

    fn volume(&self) -> Option<f64> {
        Some(PI * self.radius * self.radius * (self.height + 4.0 / 3.0 * self.radius))
    }

    fn contains(&self, p: Vector3<f64>) -> bool {
        let beyond = (p.y.abs() - 0.5 * self.height).max(0.0);
        p.x * p.x + p.z * p.z + beyond * beyond <= self.radius * self.radius
    }

    fn points(&self) -> Vec<NamedPoint> {
        ends(0.5 * self.height + self.radius)
    }

    /// The cylinder's side, and of each sphere about an end of its axis the half beyond.
    fn ray(&self, ray: &Ray) -> Option<Hit> {
        let half = 0.5 * self.height;
        let side = ray.meets_turned([self.radius, half], [self.radius, -half]);
        let caps = [1.0, -1.0].into_iter().flat_map(|end| {
            let own = Ray {
                origin: ray.origin - Vector3::y() * (end * half),
                ..*ray
            };
            let hits = own.ends_in_sphere(self.radius);
            hits.into_iter()
                .flatten()
                .filter(move |hit| end * hit.normal.y >= 0.0)
        });
        nearest(caps.chain(side))
    }

    fn surface(&self) -> Surface {
        let (above, below) = ProfilePoint::quarter_circles(self.radius);
        let raised = |point: ProfilePoint, y: f64| ProfilePoint {
            at: [point.at[0], point.at[1] + y],
            ..point
        };
        let y = 0.5 * self.height;
        let above = above.into_iter().map(|point| raised(point, y));
        let below = below.into_iter().map(|point| raised(point, -y));
        Surface::Revolution(vec![above.chain(below).collect()])
    }
}
