//! Level 1: from solids to mass, centre of mass and inertia.

pub mod equivalent;
mod properties;
pub mod ray;
pub mod solids;
pub mod tensor;

pub use properties::{MassProperties, UnphysicalMass};
