//! The cuboid of full extents x, y, z: `I = m/12 (y²+z², x²+z², x²+y²)`.

use super::{NamedPoint, Solid, SolidKind, Surface, ends, length, positive};
use nalgebra::Vector3;

pub const KIND: SolidKind = SolidKind {
    name: "cuboid",
    parameters: &[length("x"), length("y"), length("z")],
    about: "full extents; I = m/12 (y² + z², x² + z², x² + y²)",
    make: |p| {
        positive(&[("x", p[0]), ("y", p[1]), ("z", p[2])])?;
        Ok(Box::new(Cuboid {
            extents: Vector3::new(p[0], p[1], p[2]),
        }))
    },
};

#[derive(Debug)]
struct Cuboid {
    extents: Vector3<f64>,
}

impl Solid for Cuboid {
    fn moments(&self, mass: f64) -> Vector3<f64> {
        let [x2, y2, z2]: [f64; 3] = self.extents.component_mul(&self.extents).into();
        Vector3::new(y2 + z2, x2 + z2, x2 + y2) * (mass / 12.0)
    }

    fn volume(&self) -> Option<f64> {
        Some(self.extents.product())
    }

    fn contains(&self, p: Vector3<f64>) -> bool {
        (0..3).all(|k| p[k].abs() <= 0.5 * self.extents[k])
    }

    fn points(&self) -> Vec<NamedPoint> {
        ends(0.5 * self.extents.y)
    }

    fn surface(&self) -> Surface {
        Surface::Cuboid(self.extents)
    }
}
