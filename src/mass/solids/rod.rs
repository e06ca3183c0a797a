//! The thin rod of length l along y: `I_x = I_z = m/12 l²`, and nothing about itself.

use super::{
    DRAWN_THICKNESS, NamedPoint, Solid, SolidKind, Surface, along_y, cylinder, ends, length,
    positive,
};
use nalgebra::Vector3;

pub const KIND: SolidKind = SolidKind {
    name: "rod",
    parameters: &[length("length")],
    about: "thin, along y; I_x = I_z = m/12 l², I_y = 0: by itself it needs immovable = [\"y\"]",
    make: |p| {
        positive(&[("length", p[0])])?;
        Ok(Box::new(Rod { length: p[0] }))
    },
};

#[derive(Debug)]
struct Rod {
    length: f64,
}

impl Solid for Rod {
    fn moments(&self, mass: f64) -> Vector3<f64> {
        along_y(0.0, mass / 12.0 * self.length * self.length)
    }

    fn volume(&self) -> Option<f64> {
        None
    }

    fn contains(&self, _: Vector3<f64>) -> bool {
        false
    }

    fn points(&self) -> Vec<NamedPoint> {
        ends(0.5 * self.length)
    }

    fn surface(&self) -> Surface {
        cylinder::profile(0.5 * DRAWN_THICKNESS * self.length, 0.5 * self.length)
    }
}
