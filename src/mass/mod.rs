//! Level 1: from solids to mass, centre of mass and inertia.

mod compound;
mod properties;
pub mod solids;
pub mod tensor;

pub use compound::{Compound, Part};
pub use properties::{MassProperties, UnphysicalMass};
