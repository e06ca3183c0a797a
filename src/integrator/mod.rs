//! Level 3: methods that advance bodies in time. One file each, one line in [`METHODS`].
//!
//! A method is one scalar kernel in nalgebra terms, called for the eight lanes of a block in a
//! loop that is compiled for the vector widths the processor has. A kernel has no branch on data.

mod common;
mod explicit_euler;
mod lie_midpoint;
mod rk4;
mod semi_implicit;

use crate::body::{InertialBlock, StateBlock};
use crate::effect::Load;

/// What a method promises and where it comes from.
#[derive(Clone, Copy, Debug)]
pub struct MethodInfo {
    /// As scenes and the command line name it.
    pub name: &'static str,
    /// Global order of accuracy in attitude, for smooth forces.
    pub order: u32,
    /// What it keeps for ever, to rounding.
    pub preserves: &'static str,
    /// Which torques it accepts.
    pub accepts: &'static str,
    /// How damping enters.
    pub damping: &'static str,
    pub citation: &'static str,
}

/// A one-step method.
pub trait Method: Sync {
    fn info(&self) -> &'static MethodInfo;

    /// Advances a block from `t` to `t + h` (s) under `load`.
    fn step(&self, t: f64, h: f64, load: &Load, inertial: &InertialBlock, state: &mut StateBlock);
}

/// Every method, in the order of the lists.
pub const METHODS: &[&dyn Method] = &[
    &semi_implicit::SemiImplicit,
    &explicit_euler::ExplicitEuler,
    &lie_midpoint::LieMidpoint,
    &rk4::Rk4,
];

/// The method used where a scene names none: the most accurate of those that take every load.
pub const DEFAULT_METHOD: &str = "rk4";

/// The method of that name.
pub fn find(name: &str) -> Option<&'static dyn Method> {
    METHODS.iter().copied().find(|m| m.info().name == name)
}

#[cfg(test)]
mod tests;
