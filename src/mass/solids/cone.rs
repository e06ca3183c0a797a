//! The cone of base radius r and height h, apex up along y, its origin at the centre of the base.
//!
//! The centre of mass lies h/4 above the base. About it `I_y = 3/10 m r²` and
//! `I_x = I_z = 3/80 m (4r² + h²)`; the parallel axis gives `3/20 m r² + 1/10 m h²` about the base
//! centre and `3/20 m r² + 3/5 m h²` about the apex.

use super::{NamedPoint, ProfilePoint, Solid, SolidKind, Surface, along_y, length, positive};
use nalgebra::Vector3;
use std::f64::consts::PI;

pub const KIND: SolidKind = SolidKind {
    name: "cone",
    parameters: &[length("radius"), length("height")],
    about: "apex up, along y, origin at the base centre; I_y = 3/10 m r², I_x = I_z = 3/80 m (4 r² + h²)",
    make: |p| {
        positive(&[("radius", p[0]), ("height", p[1])])?;
        Ok(Box::new(Cone {
            radius: p[0],
            height: p[1],
        }))
    },
};

#[derive(Debug)]
struct Cone {
    radius: f64,
    height: f64,
}

impl Solid for Cone {
    fn moments(&self, mass: f64) -> Vector3<f64> {
        let (r2, h2) = (self.radius * self.radius, self.height * self.height);
        let across = 3.0 / 80.0 * mass * (4.0 * r2 + h2);
        along_y(0.3 * mass * r2, across)
    }

    fn volume(&self) -> Option<f64> {
        Some(PI / 3.0 * self.radius * self.radius * self.height)
    }

    fn centre(&self) -> Vector3<f64> {
        Vector3::y() * (0.25 * self.height)
    }

    fn contains(&self, p: Vector3<f64>) -> bool {
        let radius = self.radius * (1.0 - p.y / self.height);
        p.y >= 0.0 && radius >= 0.0 && p.x * p.x + p.z * p.z <= radius * radius
    }

    fn points(&self) -> Vec<NamedPoint> {
        vec![
            ("centre".into(), self.centre()),
            ("base".into(), Vector3::zeros()),
            ("apex".into(), Vector3::y() * self.height),
        ]
    }

    fn surface(&self) -> Surface {
        let (r, h) = (self.radius, self.height);
        Surface::Revolution(vec![
            ProfilePoint::segment([0.0, h], [r, 0.0]),
            ProfilePoint::segment([r, 0.0], [0.0, 0.0]),
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mass::tensor::parallel_axis;
    use nalgebra::Matrix3;

    #[test]
    fn about_its_base_and_its_apex() {
        let cone = Cone {
            radius: 1.0,
            height: 1.0,
        };
        let about = |point: Vector3<f64>| {
            let inertia = Matrix3::from_diagonal(&cone.moments(1.0));
            parallel_axis(&inertia, 1.0, point - cone.centre()).diagonal()
        };
        // The tutorial's numbers; one rounding each.
        assert!((about(Vector3::zeros()) - Vector3::new(0.25, 0.3, 0.25)).norm() < 1e-15);
        assert!((about(Vector3::y()) - Vector3::new(0.75, 0.3, 0.75)).norm() < 1e-15);
    }
}
