//! The cylinder of radius r and height h along y: `I_y = ½ m r²`, `I_x = I_z = m/12 (3r² + h²)`.

use super::{NamedPoint, ProfilePoint, Solid, SolidKind, Surface, along_y, ends, length, positive};
use nalgebra::Vector3;
use std::f64::consts::PI;

pub const KIND: SolidKind = SolidKind {
    name: "cylinder",
    parameters: &[length("radius"), length("height")],
    about: "along y; I_y = 1/2 m r², I_x = I_z = m/12 (3 r² + h²)",
    make: |p| {
        positive(&[("radius", p[0]), ("height", p[1])])?;
        Ok(Box::new(Cylinder {
            radius: p[0],
            height: p[1],
        }))
    },
};

#[derive(Debug)]
struct Cylinder {
    radius: f64,
    height: f64,
}

impl Solid for Cylinder {
    fn moments(&self, mass: f64) -> Vector3<f64> {
        let (r2, h2) = (self.radius * self.radius, self.height * self.height);
        along_y(0.5 * mass * r2, mass / 12.0 * (3.0 * r2 + h2))
    }

    fn volume(&self) -> Option<f64> {
        Some(PI * self.radius * self.radius * self.height)
    }

    fn contains(&self, p: Vector3<f64>) -> bool {
        p.x * p.x + p.z * p.z <= self.radius * self.radius && p.y.abs() <= 0.5 * self.height
    }

    fn points(&self) -> Vec<NamedPoint> {
        ends(0.5 * self.height)
    }

    fn surface(&self) -> Surface {
        profile(self.radius, 0.5 * self.height)
    }
}

/// Of radius r, from y to -y.
pub fn profile(r: f64, y: f64) -> Surface {
    Surface::Revolution(vec![
        ProfilePoint::segment([0.0, y], [r, y]),
        ProfilePoint::segment([r, y], [r, -y]),
        ProfilePoint::segment([r, -y], [0.0, -y]),
    ])
}
