//! Triangles with shared corners, for drawing and for rays; cheap to clone.

use nalgebra::Vector3;
use std::sync::Arc;

/// Flat faces from a solid's origin, along its axes, m.
#[derive(Clone, Debug, PartialEq)]
pub struct Triangles {
    pub points: Arc<[Vector3<f64>]>,
    /// Of each face, indices into `points`: counter-clockwise from outside.
    indices: Arc<[[u32; 3]]>,
}

impl Triangles {
    /// Faces that name a point there is none of are left out.
    pub(crate) fn new(points: Vec<Vector3<f64>>, indices: Vec<[u32; 3]>) -> Self {
        let mut indices = indices;
        indices.retain(|face| face.iter().all(|&k| (k as usize) < points.len()));
        Self {
            points: points.into(),
            indices: indices.into(),
        }
    }

    pub fn len(&self) -> usize {
        self.indices.len()
    }

    pub fn is_empty(&self) -> bool {
        self.indices.is_empty()
    }

    /// The corners of a face.
    ///
    /// # Panics
    ///
    /// Where there is no face of that number.
    pub fn face(&self, k: usize) -> [Vector3<f64>; 3] {
        self.indices[k].map(|index| self.points[index as usize])
    }

    /// The corners of every face.
    pub fn corners(&self) -> impl Iterator<Item = [Vector3<f64>; 3]> + '_ {
        let corner = |index: u32| self.points[index as usize];
        self.indices.iter().map(move |face| face.map(corner))
    }

    /// The box about all points, lowest and highest corner.
    pub fn bounds(&self) -> (Vector3<f64>, Vector3<f64>) {
        let start = (
            Vector3::repeat(f64::INFINITY),
            Vector3::repeat(f64::NEG_INFINITY),
        );
        let points = self.points.iter();
        points.fold(start, |(low, high), p| (low.inf(p), high.sup(p)))
    }
}
