//! The hollow sphere, outer radius b, inner radius a: `I = 2/5 m (b⁵ - a⁵)/(b³ - a³)`;
//! its limit a → b, the thin shell: `I = 2/3 m r²`.

use super::{
    NamedPoint, Parameter, ProfilePoint, Solid, SolidKind, Surface, ends, length, positive,
};
use crate::mass::ray::{Hit, Ray};
use nalgebra::Vector3;
use std::f64::consts::PI;

pub const KIND: SolidKind = SolidKind {
    name: "hollow_sphere",
    parameters: &[
        length("radius"),
        // Absent: NaN, which stands for a shell without thickness.
        Parameter {
            name: "inner_radius",
            default: Some(f64::NAN),
        },
    ],
    about: "I = 2/5 m (b⁵ - a⁵)/(b³ - a³), b radius, a inner_radius; without it a thin shell, 2/3 m r²",
    make: |p| {
        let (radius, inner) = (p[0], p[1]);
        positive(&[("radius", radius)])?;
        if inner.is_nan() {
            return Ok(Box::new(HollowSphere {
                radius,
                inner: None,
            }));
        }
        if !(0.0..radius).contains(&inner) {
            return Err(format!(
                "inner_radius = {inner} m must lie from 0 to below the radius, {radius} m; for a thin \
                 shell leave it out"
            ));
        }
        Ok(Box::new(HollowSphere {
            radius,
            inner: Some(inner),
        }))
    },
};

#[derive(Debug)]
struct HollowSphere {
    radius: f64,
    /// `None`: a shell without thickness.
    inner: Option<f64>,
}

impl Solid for HollowSphere {
    fn moments(&self, mass: f64) -> Vector3<f64> {
        let b = self.radius;
        // With r = a/b, (b⁵ - a⁵)/(b³ - a³) = b² (1+r+r²+r³+r⁴)/(1+r+r²): nothing cancels, and
        // r = 1 gives 5/3 b², the thin shell.
        let r = self.inner.map_or(1.0, |a| a / b);
        let ratio = (1.0 + r * (1.0 + r * (1.0 + r * (1.0 + r)))) / (1.0 + r * (1.0 + r));
        Vector3::repeat(0.4 * mass * b * b * ratio)
    }

    fn volume(&self) -> Option<f64> {
        let a = self.inner?;
        // b³ - a³ by its factors, so that nothing cancels in a thin wall.
        let b = self.radius;
        Some(4.0 / 3.0 * PI * (b - a) * (b * b + b * a + a * a))
    }

    fn contains(&self, p: Vector3<f64>) -> bool {
        let inside = |a: f64| (a * a..=self.radius * self.radius).contains(&p.norm_squared());
        self.inner.is_some_and(inside)
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
