//! Volume, centre and inertia of a polyhedron, exact but for rounding.
//!
//! Each face (a, b, c) and a point o make a tetrahedron of signed volume `d/6`, `d = a · (b × c)`, corners
//! counted from o. Over it
//!
//! ```text
//! ∫ 1 = d/6    ∫ x = d/24 s    ∫ x xᵀ = d/120 (s sᵀ + a aᵀ + b bᵀ + c cᵀ)    s = a + b + c
//! ```
//!
//! (Tonon, J. Math. Stat. 1 (2005) 8-11; the same integrals by the divergence theorem are Mirtich's, J.
//! Graphics Tools 1 (1996) 31-50, and Eberly's, "Polyhedral Mass Properties (Revisited)", 2009). Faces that
//! look away from o count minus, so that what lies outside cancels. Then `I = tr(C) 1 - C`, `C = ∫ x xᵀ`.
//!
//! What cancels costs digits: with o a distance D from a body of size L, some (D/L)². So o is the mean of the
//! corners first, and in a second pass the centre of mass that the first one found; differences of coordinates
//! are rounded once each, however far from the origin the mesh lies.

use super::super::solids::Triangles;
use nalgebra::{Matrix3, Vector3};

/// Of unit density.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integrals {
    /// m³.
    pub volume: f64,
    /// From the mesh's origin, m.
    pub centre: Vector3<f64>,
    /// About the centre, along the mesh's axes, for a density of 1 kg/m³: kg m².
    pub tensor: Matrix3<f64>,
}

impl Integrals {
    /// Of what closed outward faces enclose.
    pub(super) fn of(triangles: &Triangles) -> Self {
        let first = Moments::about(mean(&triangles.points), triangles.corners());
        let o = first.centre();
        let moments = Moments::about(o, triangles.corners());
        let offset = moments.first / moments.volume;
        // About the centre itself: the offset is a rounding of the first pass.
        let second = moments.second - offset * offset.transpose() * moments.volume;
        let tensor = Matrix3::identity() * second.trace() - second;
        Self {
            volume: moments.volume,
            centre: o + offset,
            tensor: (tensor + tensor.transpose()) * 0.5,
        }
    }
}

/// Signed volume that some faces and a point enclose, and the sum of its parts' sizes, which bounds its
/// rounding.
pub(super) fn volume(
    o: Vector3<f64>,
    faces: impl Iterator<Item = [Vector3<f64>; 3]>,
) -> (f64, f64) {
    faces.fold((0.0, 0.0), |(sum, size), [a, b, c]| {
        let d = (a - o).dot(&(b - o).cross(&(c - o))) / 6.0;
        (sum + d, size + d.abs())
    })
}

pub(super) fn mean(points: &[Vector3<f64>]) -> Vector3<f64> {
    // Each divided first: the sum of what is finite stays finite.
    let n = points.len() as f64;
    points.iter().map(|p| p / n).sum()
}

/// Integrals of 1, x and x xᵀ over the enclosed, x from `about`.
struct Moments {
    about: Vector3<f64>,
    volume: f64,
    first: Vector3<f64>,
    second: Matrix3<f64>,
}

impl Moments {
    fn about(o: Vector3<f64>, faces: impl Iterator<Item = [Vector3<f64>; 3]>) -> Self {
        let mut sum = Self {
            about: o,
            volume: 0.0,
            first: Vector3::zeros(),
            second: Matrix3::zeros(),
        };
        for face in faces {
            let [a, b, c] = face.map(|corner| corner - o);
            let d = a.dot(&b.cross(&c));
            let s = a + b + c;
            let squares =
                s * s.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose();
            sum.volume += d / 6.0;
            sum.first += s * (d / 24.0);
            sum.second += squares * (d / 120.0);
        }
        sum
    }

    fn centre(&self) -> Vector3<f64> {
        self.about + self.first / self.volume
    }
}
