//! Level 0: the mathematics of rotation, with no notion of a body.

pub mod carlson;
pub mod dd;
mod eigen;
pub mod expansion;
mod quaternion;

pub use dd::Dd;
pub use eigen::symmetric_eigen;
pub use expansion::Expansion;
pub use quaternion::{axis_angle, exponential, spin_rate, turned};
