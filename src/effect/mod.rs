//! Level 2: what acts on bodies. One file per effect, one line in [`EFFECTS`].
//!
//! A scene's argument becomes a [`Spec`] once; of that, each block gets an [`Effect`] for those of its
//! bodies that are concerned. An effect that a scene does not name, or that concerns no body of a block,
//! is absent there: the list that a method asks for forces simply does not hold it.

mod argument;
mod couple;
mod damping;
mod drag;
mod gravity;
mod gravity_gradient;
mod gyroscopic;
mod load;
mod motor;
mod pulse;
mod push;
mod speed_limit;
mod spring;
mod term;
#[cfg(test)]
mod tests;

pub use argument::{Argument, BodyPoint, Value};
pub use couple::Couple;
pub use damping::{Decay, Elapsed};
pub use load::{Frame, Load, Wrench, WrenchBlock};
pub use pulse::{PROFILES, Profile, Pulse, Pulsed};
pub use push::Push;
pub use speed_limit::SpeedLimit;
pub use term::{Depends, Term};

use crate::body::{Inertial, InertialBlock, LaneSet, StateBlock};
use nalgebra::{UnitQuaternion, Vector3};
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

    /// The lanes of the block it acts on: what is asked of one body must not depend on its neighbours.
    fn lanes(&self) -> LaneSet;

    /// What it depends on: methods that would lose their order by it are refused. An effect that
    /// does not say is taken to depend on everything.
    fn depends(&self, inertial: &InertialBlock) -> Depends {
        match self.terms(inertial) {
            Some(terms) => terms.iter().map(Term::depends).collect(),
            None => Depends::EVERYTHING,
        }
    }
}

/// What is known of a body before it moves.
pub trait Described {
    fn name(&self) -> &str;
    /// A point of the body from its centre of mass, body axes, m; the error says that it has none of
    /// that name.
    fn place(&self, point: &BodyPoint) -> Result<Vector3<f64>, String>;
    /// The reference point at the start, world, m.
    fn reference_w(&self) -> Vector3<f64>;
    /// Whether a pivot holds it.
    fn is_held(&self) -> bool;
    /// Whether that pivot is somewhere else than its centre of mass.
    fn is_held_off_centre(&self) -> bool;
    /// Whether it has axes that no torque turns it about, and others that one does.
    fn has_immovable_axes(&self) -> bool;
}

/// A body as an effect finds it in a block.
#[derive(Clone, Copy)]
pub struct Member<'a> {
    pub lane: usize,
    pub inertial: Inertial,
    /// Body axes → principal axes.
    pub q_pb: UnitQuaternion<f64>,
    pub body: &'a dyn Described,
}

impl Member<'static> {
    /// A body of which no more is known than its inertia: its axes are the principal ones, and points
    /// count from its centre of mass.
    pub fn plain(lane: usize, inertial: Inertial) -> Self {
        Self {
            lane,
            inertial,
            q_pb: UnitQuaternion::identity(),
            body: &Plain,
        }
    }
}

struct Plain;

impl Described for Plain {
    fn name(&self) -> &str {
        "the body"
    }

    fn place(&self, point: &BodyPoint) -> Result<Vector3<f64>, String> {
        match point {
            BodyPoint::At(point) => Ok(*point),
            BodyPoint::Named(name) if name == "centre" => Ok(Vector3::zeros()),
            BodyPoint::Named(name) => Err(format!("it has no point \"{name}\"")),
        }
    }

    fn reference_w(&self) -> Vector3<f64> {
        Vector3::zeros()
    }

    fn is_held(&self) -> bool {
        false
    }

    fn is_held_off_centre(&self) -> bool {
        false
    }

    fn has_immovable_axes(&self) -> bool {
        false
    }
}

/// The lanes that these bodies are in.
pub fn lanes(members: &[Member<'_>]) -> LaneSet {
    members.iter().map(|member| member.lane).collect()
}

/// A force or torque as a scene calls for it, before it is known on whom.
pub trait Spec: Debug + Send + Sync {
    /// It, acting on these bodies of one block.
    fn on(&self, members: &[Member<'_>]) -> Arc<dyn Effect>;

    /// Why it cannot act on a body.
    fn check(&self, body: &dyn Described) -> Result<(), String> {
        let _ = body;
        Ok(())
    }

    /// The same with whatever it has that is fixed in the world moved by `by_w` (m); `None` where
    /// that is nothing.
    fn moved(&self, by_w: Vector3<f64>) -> Option<Arc<dyn Spec>> {
        let _ = by_w;
        None
    }
}

/// A named effect as a scene calls for it.
#[derive(Clone, Debug)]
pub enum Called {
    /// A force or torque.
    Load(Arc<dyn Spec>),
    /// Euler's equations in place of the tutorial's model.
    Gyroscopic,
    /// Exponential decay of the velocities.
    Decay(Decay),
    /// A clamp of the velocities after each step.
    Limit(SpeedLimit),
    /// Named, but it does nothing.
    Off,
}

impl Called {
    /// Whether it is part of the model that a block steps by, and not something applied to bodies.
    pub fn is_model_term(&self) -> bool {
        matches!(self, Self::Gyroscopic | Self::Decay(_) | Self::Limit(_))
    }
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

/// Every effect that a scene can name, in the order of the lists.
pub const EFFECTS: &[&EffectKind] = &[
    &gravity::KIND,
    &damping::KIND,
    &gyroscopic::KIND,
    &motor::KIND,
    &spring::KIND,
    &drag::KIND,
    &gravity_gradient::KIND,
    &speed_limit::KIND,
];
