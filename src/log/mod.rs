//! Level 4: what somebody else's engine did, row by row, as it was logged.
//!
//! Nothing here is put right: a quaternion is what was written, an inertia may belong to no body. A torque or a force acts
//! during the step that follows its row, and they add up.

pub mod bodies;
pub mod columns;
pub mod conventions;
pub mod mapping;
pub mod read;
pub mod spellings;
pub mod units;

pub use mapping::Mapping;
pub use read::{LogError, Options, Reader, Reading, Report, Row};

use nalgebra::{Matrix3, Vector3};

/// The log of an engine.
#[derive(Clone, Debug, Default)]
pub struct Log {
    /// In the order in which they first appear.
    pub bodies: Vec<Logged>,
}

/// A body of a log.
#[derive(Clone, Debug, Default)]
pub struct Logged {
    pub name: String,
    /// What is said of it, where anything is.
    pub declared: Option<Declared>,
    pub rows: Rows,
}

/// What is said of a body: about its centre of mass, body axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Declared {
    /// kg.
    pub mass: Option<f64>,
    /// kg m²; as declared, possible or not.
    pub inertia_b: Matrix3<f64>,
    /// From the logged position to the centre of mass, m.
    pub centre_of_mass_b: Vector3<f64>,
    /// Full extents, m.
    pub size: Option<Vector3<f64>>,
}

/// Rows of a body, one for each step that was logged. A quantity is there for all rows, or was not logged and is empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    /// s, growing.
    pub times: Vec<f64>,
    /// World, m.
    pub positions: Vec<[f64; 3]>,
    /// (x, y, z, w), body to world.
    pub attitudes: Vec<[f64; 4]>,
    /// Angular velocity, world, rad/s.
    pub omegas: Vec<[f64; 3]>,
    /// World, m/s.
    pub velocities: Vec<[f64; 3]>,
    /// About the centre of mass, world, N m.
    pub torques: Vec<[f64; 3]>,
    /// World, N.
    pub forces: Vec<[f64; 3]>,
    /// Where the forces act, world, m; empty where no force was logged.
    pub points: Vec<[f64; 3]>,
}

impl Rows {
    pub fn len(&self) -> usize {
        self.times.len()
    }

    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }
}
