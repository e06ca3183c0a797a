//! The thin disc of radius r about y: `I_y = ½ m r²`, `I_x = I_z = ¼ m r²`.

use super::{
    DRAWN_THICKNESS, NamedPoint, Solid, SolidKind, Surface, along_y, cylinder, length, positive,
};
use nalgebra::Vector3;

pub const KIND: SolidKind = SolidKind {
    name: "disc",
    parameters: &[length("radius")],
    about: "thin, about y; I_y = 1/2 m r², I_x = I_z = 1/4 m r²",
    make: |p| {
        positive(&[("radius", p[0])])?;
        Ok(Box::new(Disc { radius: p[0] }))
    },
};

#[derive(Debug)]
struct Disc {
    radius: f64,
}

impl Solid for Disc {
    fn moments(&self, mass: f64) -> Vector3<f64> {
        let r2 = self.radius * self.radius;
        along_y(0.5 * mass * r2, 0.25 * mass * r2)
    }

    fn volume(&self) -> Option<f64> {
        None
    }

    fn contains(&self, _: Vector3<f64>) -> bool {
        false
    }

    fn points(&self) -> Vec<NamedPoint> {
        let rim = Vector3::x() * self.radius;
        vec![("centre".into(), Vector3::zeros()), ("rim".into(), rim)]
    }

    fn surface(&self) -> Surface {
        cylinder::profile(self.radius, 0.5 * DRAWN_THICKNESS * self.radius)
    }
}
