//! Level 3: methods that advance bodies in time. One file each, one line in [`METHODS`].
//!
//! A method sets out from a state under a load that stays ([`Method::start`]) and from then on is
//! asked for the states after some steps ([`Stepper::advance`]). What it prepares once, or carries
//! from step to step beside the state (a closed form's constants, a step size, a momentum), is its
//! own. A plain one-step method is a `OneStep`: a function from state to state.
//!
//! A kernel is written for one body in nalgebra's terms. Of those that never branch on data the loop over
//! the eight lanes of a block is compiled for the vector widths the processor has (`common`); the others,
//! with sines and iterations, go lane by lane over the bodies there are (`scalar`, `kicks`, `own_steps`).

mod buss;
mod cf4;
mod closed_form;
mod coast;
mod common;
mod dlm;
mod dmv;
mod dop853;
mod explicit_euler;
mod flight;
mod implicit_gyroscopic;
mod info;
mod kicks;
mod lie_midpoint;
mod limited;
mod momentum_restoring;
mod one_step;
mod own_steps;
mod pieces;
mod preprocessed;
mod refused;
mod rk4;
mod rkmk4;
mod scalar;
mod semi_implicit;
mod taylor;

pub use info::{Accepts, Cost, Damping, Kind, MethodInfo, Models, Refusal};
pub use pieces::Pieces;

use crate::body::{InertialBlock, LANES, StateBlock};
use crate::effect::Load;
use kicks::Kicks;
use limited::Limited;
use one_step::Stepped;
use refused::Refused;
use std::ops::Range;

/// A stretch of time in which nothing begins, ends or jumps.
#[derive(Clone, Debug)]
pub struct Interval {
    pub load: Load,
    pub inertial: InertialBlock,
    /// Bodies in the block; the lanes beyond are empty.
    pub bodies: usize,
    /// When it ends, s. A method may look ahead as far as this.
    pub until: f64,
    /// Error allowed by a method that chooses its own steps, relative to the state.
    pub tolerance: f64,
}

impl Interval {
    /// The lanes that hold a body.
    pub fn lanes(&self) -> Range<usize> {
        0..self.bodies.min(LANES)
    }
}

/// One step of the clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// s.
    pub from: f64,
    /// s.
    pub h: f64,
    /// Where it ends, s: `from + h`, but without its rounding.
    pub to: f64,
    /// Whether the state at its end is asked for.
    pub keep: bool,
}

impl Step {
    /// A step by itself, from `t` to `t + h` (s), whose end nobody keeps.
    fn alone(t: f64, h: f64) -> Self {
        Self {
            from: t,
            h,
            to: t + h,
            keep: false,
        }
    }
}

/// What was done so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Steps of the method itself.
    pub steps: u64,
    /// Times the equations of motion were evaluated, a block counting once.
    pub evaluations: u64,
}

impl std::ops::Add for Work {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            steps: self.steps + other.steps,
            evaluations: self.evaluations + other.evaluations,
        }
    }
}

/// A way to advance bodies.
pub trait Method: Sync {
    fn info(&self) -> &'static MethodInfo;

    /// Sets out from `state` at time `t` (s) under a load that is not refused.
    fn set_out(&self, interval: Interval, t: f64, state: &StateBlock) -> Box<dyn Stepper>;

    /// The same under any load. One that [`MethodInfo::refuses`] is followed nowhere: states that are no
    /// numbers, so that nobody takes some other motion for the one asked for. A limit of speeds is kept
    /// here, for every method of fixed steps alike.
    fn start(&self, interval: Interval, t: f64, state: &StateBlock) -> Box<dyn Stepper> {
        let info = self.info();
        if info.refuses(&interval.load, &interval.inertial).is_some() {
            return Box::new(Refused::new(&interval, state));
        }
        match (interval.load.limit(), find(info.name)) {
            (None, _) => self.set_out(interval, t, state),
            (Some(_), Some(method)) => Box::new(Limited::new(method, interval, t, state)),
            // One that is not in the list cannot be found again to set out anew.
            (Some(_), None) => Box::new(Refused::new(&interval, state)),
        }
    }
}

/// A method on its way through an interval.
pub trait Stepper: Send {
    /// Takes the steps, in order and without a gap from the last; appends the state after each
    /// that is kept.
    fn advance(&mut self, steps: &[Step], kept: &mut Vec<StateBlock>);

    /// Where it is: at the end of the last step.
    fn state(&self) -> StateBlock;

    fn work(&self) -> Work;

    fn boxed_clone(&self) -> Box<dyn Stepper>;

    /// Bytes it takes: its own, and what it holds elsewhere where that is more than a few.
    fn bytes(&self) -> usize {
        size_of_val(self)
    }
}

impl Clone for Box<dyn Stepper> {
    fn clone(&self) -> Self {
        self.boxed_clone()
    }
}

/// Every method, in the order of the lists.
pub const METHODS: &[&dyn Method] = &[
    // The tutorial's, and the one that shows why not.
    &Stepped(semi_implicit::SemiImplicit),
    &Stepped(explicit_euler::ExplicitEuler),
    // Engines'.
    &Stepped(momentum_restoring::Rapier),
    &Stepped(momentum_restoring::Jolt),
    &Stepped(implicit_gyroscopic::Bullet),
    &Stepped(rkmk4::Rkmk4),
    // On the rotation group.
    &Stepped(lie_midpoint::LieMidpoint),
    &buss::BUSS,
    &buss::BUSS3,
    &Stepped(cf4::Cf4),
    // General solvers.
    &Stepped(rk4::Rk4),
    &dop853::Dop853,
    &taylor::Taylor,
    // Free motion exact or nearly so, and kicks.
    &dlm::Dlm,
    &Kicks(&kicks::STRANG),
    &Kicks(&kicks::RKN4),
    &Kicks(&kicks::RKN6),
    &Kicks(&kicks::ORDER8),
    &Kicks(&kicks::ABA864),
    &Kicks(&kicks::ABA1064),
    // The free body alone.
    &dmv::DMV2,
    &dmv::DMV4,
    &dmv::DMV6,
    &dmv::DMV8,
    &dmv::DMV10,
    &closed_form::ClosedForm,
];

/// The method used where a scene names none: of fixed steps, the usual one; it takes every load.
pub const DEFAULT_METHOD: &str = "rk4";

/// The method of that name, or by which an engine's name is known.
pub fn find(name: &str) -> Option<&'static dyn Method> {
    let named = |method: &&dyn Method| {
        let info = method.info();
        info.name == name || info.engines.contains(&name)
    };
    METHODS.iter().copied().find(named)
}

#[cfg(test)]
mod effect_tests;
#[cfg(test)]
mod tests;
