//! Level 1: from solids to mass, centre of mass and inertia.

mod properties;
pub mod solids;
pub mod tensor;

pub use properties::{MassProperties, UnphysicalMass};
