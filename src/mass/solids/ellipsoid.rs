//! The ellipsoid of full lengths x, y, z: `I = m/20 (y²+z², x²+z², x²+y²)`.
//!
//! In half axes a, b, c it is the familiar `m/5 (b²+c²)`: a sphere's `∫ x² dm = m r²/5`, stretched.

use super::{NamedPoint, Solid, SolidKind, Surface, ends, length, positive};
use nalgebra::Vector3;
use std::f64::consts::PI;

pub const KIND: SolidKind = SolidKind {
    name: "ellipsoid",
    parameters: &[length("x"), length("y"), length("z")],
    about: "full lengths; I = m/20 (y² + z², x² + z², x² + y²)",
    make: |p| {
        positive(&[("x", p[0]), ("y", p[1]), ("z", p[2])])?;
        Ok(Box::new(Ellipsoid {
            half: Vector3::new(p[0], p[1], p[2]) * 0.5,
        }))
    },
};

#[derive(Debug)]
struct Ellipsoid {
    half: Vector3<f64>,
}

impl Solid for Ellipsoid {
    fn moments(&self, mass: f64) -> Vector3<f64> {
        let [a2, b2, c2]: [f64; 3] = self.half.component_mul(&self.half).into();
        Vector3::new(b2 + c2, a2 + c2, a2 + b2) * (0.2 * mass)
    }

    fn volume(&self) -> Option<f64> {
        Some(4.0 / 3.0 * PI * self.half.product())
    }

    fn contains(&self, p: Vector3<f64>) -> bool {
        p.component_div(&self.half).norm_squared() <= 1.0
    }

    fn points(&self) -> Vec<NamedPoint> {
        ends(self.half.y)
    }

    fn surface(&self) -> Surface {
        Surface::Ellipsoid(self.half)
    }
}
