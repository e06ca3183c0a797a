//! Where a ray along x goes through a face.
//!
//! A ray at (y, z) meets the face if that point lies in its projection: if an odd number of its edges
//! cross the half line from there towards +z. An edge is computed from its lower end by (y, z), whichever
//! face asks; so of two faces that share it exactly one is met, and through a closed surface every ray
//! goes an even number of times, corners and edges included.

use nalgebra::Vector3;

/// A face, as rays along x see it.
pub(super) struct Crossing([Vector3<f64>; 3]);

impl Crossing {
    pub fn of(face: [Vector3<f64>; 3]) -> Self {
        Self(face)
    }

    /// The x at which the ray at (y, z) meets the face.
    pub fn x_at(&self, y: f64, z: f64) -> Option<f64> {
        let [a, b, c] = self.0;
        let met = passes(a, b, y, z) ^ passes(b, c, y, z) ^ passes(c, a, y, z);
        if !met {
            return None;
        }
        let (low, high) = (a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
        let n = (b - a).cross(&(c - a));
        let x = a.x - (n.y * (y - a.y) + n.z * (z - a.z)) / n.x;
        // A face seen edge-on is met by rounding alone, anywhere between its corners.
        Some(if x.is_nan() { low } else { x.clamp(low, high) })
    }
}

/// Whether an edge crosses the half line from (y, z) towards +z.
fn passes(p: Vector3<f64>, q: Vector3<f64>, y: f64, z: f64) -> bool {
    if (p.y > y) == (q.y > y) {
        return false;
    }
    let (p, q) = if (p.y, p.z) <= (q.y, q.z) {
        (p, q)
    } else {
        (q, p)
    };
    z < p.z + (y - p.y) / (q.y - p.y) * (q.z - p.z)
}
