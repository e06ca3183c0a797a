//! Level 2: what acts on bodies. One file per effect, one line in [`EFFECTS`].
//!
//! An effect that a scene does not name is absent from the run: the list that a method asks for
//! forces simply does not hold it.

mod couple;
mod damping;
mod gravity;
mod gyroscopic;
mod load;
mod pulse;
mod push;
mod term;

pub use couple::Couple;
pub use damping::{Decay, Elapsed};
pub use load::{Frame, Load, Wrench, WrenchBlock};
pub use pulse::{PROFILES, Profile, Pulse, Pulsed};
pub use push::Push;
pub use term::{Depends, Term};

use crate::body::{InertialBlock, StateBlock};
use nalgebra::Vector3;
use std::fmt::Debug;
use std::sync::Arc;

/// A source of force and torque on a block of bodies.
pub trait Effect: Debug + Send + Sync {
    /// As people call it.
    fn name(&self) -> &'static str;

    /// Adds this effect's force (N) and torque about the reference point (N·m), world axes,
    /// at time `t` (s) and the given states.
    fn add(&self, t: f64, inertial: &InertialBlock, state: &StateBlock, wrench: &mut WrenchBlock);

    /// The effect as constant forces at points and constant torques, where it is nothing else: what
    /// methods with recurrences of their own take it from.
    fn terms(&self, inertial: &InertialBlock) -> Option<Vec<Term>> {
        let _ = inertial;
        None
    }

    /// The only lane of the block it acts on, where it is an event's; `None` is any.
    fn lane(&self) -> Option<usize> {
        None
    }

    /// What it depends on: methods that would lose their order by it are refused. An effect that
    /// does not say is taken to depend on everything.
    fn depends(&self, inertial: &InertialBlock) -> Depends {
        match self.terms(inertial) {
            Some(terms) => terms.iter().map(Term::depends).collect(),
            None => Depends::EVERYTHING,
        }
    }
}

/// A named effect as a scene calls for it.
#[derive(Clone, Debug)]
pub enum Called {
    /// A force or torque, on every body.
    Load(Arc<dyn Effect>),
    /// Euler's equations in place of the tutorial's model.
    Gyroscopic,
    /// Exponential decay of the velocities, on every body.
    Decay(Decay),
    /// Named, but switched off.
    Off,
}

/// What a scene writes for an effect.
#[derive(Clone, Copy, Debug)]
pub enum Argument {
    /// `true` or `false`.
    Switch,
    /// Three numbers, in the unit named.
    Vector(&'static str),
    /// A table of numbers, each with its unit; one that is absent is `None`.
    Table(&'static [(&'static str, &'static str)]),
}

/// An argument, read.
#[derive(Clone, Debug)]
pub enum Value {
    Switch(bool),
    Vector(Vector3<f64>),
    Table(Vec<Option<f64>>),
}

/// How scenes name an effect and what it takes.
pub struct EffectKind {
    pub name: &'static str,
    pub argument: Argument,
    /// Its equation.
    pub equation: &'static str,
    /// What it does, in a sentence.
    pub about: &'static str,
    /// From the argument and the nominal step (s); the error says what is wrong with it.
    pub make: fn(&Value, f64) -> Result<Called, String>,
}

/// Every effect that a scene's `[effects]` can name, in the order of the lists.
pub const EFFECTS: &[&EffectKind] = &[&gravity::KIND, &damping::KIND, &gyroscopic::KIND];
