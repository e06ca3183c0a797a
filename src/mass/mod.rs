//! Level 1: from solids, meshes and descriptions to mass, centre of mass and inertia.

mod compound;
pub mod equivalent;
pub mod links;
pub mod mesh;
mod properties;
pub mod ray;
pub mod solids;
pub mod tensor;

pub use compound::{Compound, Part};
pub use properties::{MassProperties, UnphysicalMass};
