//! The tube along y, outer radius b, inner radius a, height h: `I_y = m/2 (a² + b²)`,
//! `I_x = I_z = m/12 (3 (a² + b²) + h²)`: a cylinder less a cylinder.

use super::{NamedPoint, ProfilePoint, Solid, SolidKind, Surface, along_y, ends, length, positive};
use nalgebra::Vector3;
use std::f64::consts::PI;

pub const KIND: SolidKind = SolidKind {
    name: "tube",
    parameters: &[length("radius"), length("inner_radius"), length("height")],
    about: "along y, b radius, a inner radius; I_y = m/2 (a² + b²), I_x = I_z = m/12 (3 (a² + b²) + h²)",
    make: |p| {
        let (radius, inner, height) = (p[0], p[1], p[2]);
        positive(&[
            ("radius", radius),
            ("inner_radius", inner),
            ("height", height),
        ])?;
        if inner >= radius {
            return Err(format!(
                "inner_radius = {inner} m must lie below the radius, {radius} m"
            ));
        }
        Ok(Box::new(Tube {
            radius,
            inner,
            height,
        }))
    },
};

#[derive(Debug)]
struct Tube {
    radius: f64,
    inner: f64,
    height: f64,
}

impl Solid for Tube {
    fn moments(&self, mass: f64) -> Vector3<f64> {
        let radii2 = self.inner * self.inner + self.radius * self.radius;
        let h2 = self.height * self.height;
        along_y(0.5 * mass * radii2, mass / 12.0 * (3.0 * radii2 + h2))
    }

    fn volume(&self) -> Option<f64> {
        // b² - a² by its factors, so that nothing cancels in a thin wall.
        let (a, b) = (self.inner, self.radius);
        Some(PI * (b - a) * (b + a) * self.height)
    }

    fn contains(&self, p: Vector3<f64>) -> bool {
        let r2 = p.x * p.x + p.z * p.z;
        let wall = self.inner * self.inner..=self.radius * self.radius;
        wall.contains(&r2) && p.y.abs() <= 0.5 * self.height
    }

    fn points(&self) -> Vec<NamedPoint> {
        ends(0.5 * self.height)
    }

    fn surface(&self) -> Surface {
        let (a, b, y) = (self.inner, self.radius, 0.5 * self.height);
        Surface::Revolution(vec![
            ProfilePoint::segment([a, y], [b, y]),
            ProfilePoint::segment([b, y], [b, -y]),
            ProfilePoint::segment([b, -y], [a, -y]),
            ProfilePoint::segment([a, -y], [a, y]),
        ])
    }
}
