//! Level 1: bodies as plain data in blocks of eight lanes, frames in the names.
//!
//! `_w` world, `_b` the body's own axes as the scene gives them, `_p` its principal axes;
//! `q_wb` takes body coordinates to world coordinates.

mod inertial;
mod lanes;
mod state;

pub use inertial::{Inertial, InertialBlock};
pub use lanes::{LANES, LaneSet, Lanes, QuaternionLanes, Vector3Lanes};
pub use state::{State, StateBlock};
