//! Bodies from triangle meshes: read, checked to be closed, and integrated exactly.
//!
//! ```text
//! file → Soup (triangles as the file has them) → Polyhedron (closed, outward, with its integrals)
//! ```
//!
//! A [`Polyhedron`] comes only from [`Polyhedron::new`], which refuses what has no inside and says at
//! which edge. Several shells are fine, a cavity too: it is a shell that looks inwards inside one that
//! looks outwards.

mod closed;
mod crossing;
mod cubes;
mod glb;
mod integrals;
mod obj;
mod read;
mod stl;

pub use closed::{Edge, Flaw};
pub use cubes::{CubeRow, Cubes, mean_order, orders};
pub use integrals::Integrals;
pub use read::{Format, LARGEST, MeshError, parse, read};

use super::solids::{NamedPoint, Solid, Surface, Triangles};
use crate::math::symmetric_eigen;
use crossing::Crossing;
use nalgebra::{Matrix3, Vector3};

/// Triangles that one mesh may have: two million, which is 100 MB as binary STL.
pub const MOST_TRIANGLES: usize = 1 << 21;

/// Triangles as a file has them, nothing checked.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Soup {
    pub points: Vec<Vector3<f64>>,
    /// Corners, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
    /// What the file calls the face that each triangle is of: the number after [`Soup::counted`].
    pub faces: Vec<u32>,
    /// What `faces` counts: "line", "facet" or "triangle".
    pub counted: &'static str,
}

impl Soup {
    /// Triangles made by a program, counted from 1.
    pub fn new(points: Vec<Vector3<f64>>, triangles: Vec<[u32; 3]>) -> Self {
        let faces = (1..).take(triangles.len()).collect();
        Self {
            points,
            triangles,
            faces,
            counted: "triangle",
        }
    }

    fn push(&mut self, corners: [u32; 3], face: usize) {
        self.triangles.push(corners);
        self.faces.push(u32::try_from(face).unwrap_or(u32::MAX));
    }
}

/// A body of uniform density with flat faces: closed, outward, of some volume.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyhedron {
    triangles: Triangles,
    shells: usize,
    dropped: usize,
    integrals: Integrals,
}

impl Polyhedron {
    /// Welds corners at the same place, checks that the faces bound something, and integrates over it.
    /// `scale` takes the file's lengths to metres.
    pub fn new(soup: &Soup, scale: f64) -> Result<Self, MeshError> {
        let closed = closed::check(soup, scale)?;
        let integrals = Integrals::of(&closed.triangles);
        Ok(Self {
            triangles: closed.triangles,
            shells: closed.shells,
            dropped: closed.dropped,
            integrals,
        })
    }

    /// Its faces, in the mesh's axes, m.
    pub fn triangles(&self) -> &Triangles {
        &self.triangles
    }

    /// Closed surfaces that it is made of.
    pub fn shells(&self) -> usize {
        self.shells
    }

    /// Triangles of the file that had two corners at one place, and so no face: left out.
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    /// Volume, centre and tensor of unit density.
    pub fn integrals(&self) -> &Integrals {
        &self.integrals
    }
}

impl Solid for Polyhedron {
    /// Principal moments; their axes are not the mesh's: see [`Solid::inertia`].
    fn moments(&self, mass: f64) -> Vector3<f64> {
        symmetric_eigen(&self.inertia(mass)).1
    }

    fn inertia(&self, mass: f64) -> Matrix3<f64> {
        self.integrals.tensor * (mass / self.integrals.volume)
    }

    fn volume(&self) -> Option<f64> {
        Some(self.integrals.volume)
    }

    fn centre(&self) -> Vector3<f64> {
        self.integrals.centre
    }

    /// By the faces that a ray from the point along x goes through: inside where their number is odd.
    fn contains(&self, point: Vector3<f64>) -> bool {
        let beyond = |face: &[Vector3<f64>; 3]| {
            let met = Crossing::of(*face).x_at(point.y, point.z);
            met.is_some_and(|x| x > point.x)
        };
        self.triangles.corners().filter(beyond).count() % 2 == 1
    }

    fn points(&self) -> Vec<NamedPoint> {
        vec![
            ("centre".into(), self.centre()),
            ("origin".into(), Vector3::zeros()),
        ]
    }

    fn surface(&self) -> Surface {
        Surface::Mesh(self.triangles.clone())
    }
}
