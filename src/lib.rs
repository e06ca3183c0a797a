//! Torquescope: a live visual debugger for rigid-body rotation.
//!
//! Data flow from left to right, imports point the other way (docs/ARCHITECTURE.md):
//!
//! ```text
//! scene.toml → Scene → Simulation → Sample → Sink → recording
//! ```
//!
//! SI units and radians, right-handed, y up; quaternions (x, y, z, w), body to world. Frames are
//! in the names: `_w` world, `_b` body axes, `_p` principal axes.
//!
//! Without the default feature `cli` the crate is the numerics: no rerun, no clap.

pub mod body;
#[cfg(feature = "cli")]
pub mod cli;
pub mod cost;
pub mod diagnose;
pub mod effect;
pub mod exact;
pub mod integrator;
#[cfg(feature = "cli")]
pub mod live;
pub mod log;
pub mod mass;
pub mod math;
#[cfg(feature = "cli")]
pub mod record;
pub mod scene;
pub mod session;
pub mod sim;
pub mod trace;
