//! Level 2: motions in closed form, at any time, with no step.
//!
//! Sees `math` alone: an oracle that shares code with a stepper shares its bugs.

mod damped;
mod free;
mod kovalevskaya;
mod pendulum;
mod top;

pub use damped::DampedFreeMotion;
pub use free::FreeMotion;
pub use kovalevskaya::kovalevskaya;
pub use pendulum::Pendulum;
pub use top::LagrangeTop;
