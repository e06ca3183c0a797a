//! Level 2: motions in closed form, at any time, with no step.
//!
//! Sees `math` alone: an oracle that shares code with a stepper shares its bugs.

mod free;

pub use free::FreeMotion;
