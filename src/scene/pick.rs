//! Picking: which body a ray meets first, and where.

use crate::mass::equivalent;
use crate::mass::ray::Ray;
use crate::trace::{Motion, Subject};
use nalgebra::Vector3;

/// Where a ray meets a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picked {
    /// In lengths of the ray's direction: m where that has unit length.
    pub distance: f64,
    /// World, m.
    pub point_w: Vector3<f64>,
    /// The same point from the centre of mass, body axes, m.
    pub point_b: Vector3<f64>,
    /// Outward, unit, world.
    pub normal_w: Vector3<f64>,
}

/// The first body on a ray (world), by its place in the list; of two at one distance the earlier.
pub fn first_hit<'a>(
    ray_w: &Ray,
    bodies: impl Iterator<Item = (&'a Subject, Motion)>,
) -> Option<(usize, Picked)> {
    let hits = bodies.enumerate().filter_map(|(k, (subject, motion))| {
        let picked = hit(ray_w, subject, &motion)?;
        Some((k, picked))
    });
    hits.min_by(|(_, a), (_, b)| a.distance.total_cmp(&b.distance))
}

/// Where a ray (world) meets a body as it is posed; one without a shape is the box of the same inertia,
/// as it is drawn.
pub fn hit(ray_w: &Ray, subject: &Subject, motion: &Motion) -> Option<Picked> {
    let q_bw = motion.q_wb.inverse();
    let ray_b = Ray {
        origin: q_bw * (ray_w.origin - motion.position_w),
        direction: q_bw * ray_w.direction,
    };
    let (t, normal_b) = match &subject.solid {
        Some(solid) => {
            // A solid's axes are the body's, from an origin of its own.
            let ray = Ray {
                origin: ray_b.origin + solid.centre(),
                ..ray_b
            };
            let hit = solid.ray(&ray)?;
            (hit.t, hit.normal)
        }
        None => {
            let (extents, q_bp) = equivalent::cuboid(subject.mass, &subject.inertia_c);
            let ray = Ray {
                origin: q_bp.inverse() * ray_b.origin,
                direction: q_bp.inverse() * ray_b.direction,
            };
            let hit = ray.meets_cuboid(extents)?;
            (hit.t, q_bp * hit.normal)
        }
    };
    Some(Picked {
        distance: t,
        point_w: ray_w.at(t),
        point_b: ray_b.at(t),
        normal_w: motion.q_wb * normal_b,
    })
}
