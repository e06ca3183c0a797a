//! Level 0: the mathematics of rotation, with no notion of a body.

mod agm;
pub mod carlson;
pub mod dd;
pub mod draw;
mod eigen;
pub mod elliptic;
pub mod expansion;
#[cfg(test)]
mod oracle;
mod power;
mod quaternion;
mod real;
mod turns;

pub use agm::agm;
pub use dd::Dd;
pub use eigen::symmetric_eigen;
pub use expansion::Expansion;
pub use power::power;
pub use quaternion::{
    angle_between, axis_angle, exponential, exponential_by_series, is_short, spin_rate, turned,
};
pub use real::Real;
pub use turns::{Phase, exp_falling, sin_cos_turns};
