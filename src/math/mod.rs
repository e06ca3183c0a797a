//! Level 0: the mathematics of rotation, with no notion of a body.

mod eigen;
mod quaternion;

pub use eigen::symmetric_eigen;
pub use quaternion::{axis_angle, spin_rate};
