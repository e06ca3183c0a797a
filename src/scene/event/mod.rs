//! `[[event]]`: what happens, to which body, and when.

mod click;
mod method;
mod note;
mod push;
mod read;
mod set;
mod switch;

pub use click::Click;
pub(super) use read::{Clock, Context, read_all};
pub use set::Change;

use super::body::OwnMethod;
use crate::body::Inertial;
use crate::effect::{Couple, Effect, Frame, Profile, Pulse, Pulsed, Push, Term};
use nalgebra::{UnitQuaternion, Vector3};
use std::ops::Range;
use std::sync::Arc;

/// Something done at an exact time.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Event {
    pub name: Option<Arc<str>>,
    /// Which of the file's `[[event]]` makes it, from 0: repeats are made by one.
    pub entry: usize,
    /// s.
    pub at: f64,
    /// Whether no method looks ahead to it: nothing before it depends on its coming.
    pub unforeseen: bool,
    pub target: Target,
    pub action: Action,
}

/// Whom an event concerns.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    /// A body, by its index.
    Body(usize),
    /// The first of these that a ray hits: known when it happens.
    Hit(Range<usize>),
    /// Every body.
    All,
    /// Nobody's motion: a line in the log, about a body where it names one.
    Log(Option<usize>),
}

/// What is done.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// A force (N) at a point (m) for a time (s).
    Push {
        /// At its peak.
        force: Framed,
        point: Framed,
        lasts: f64,
        profile: Profile,
    },
    /// A torque (N·m) for a time (s).
    Torque {
        /// At its peak.
        torque: Framed,
        lasts: f64,
        profile: Profile,
    },
    /// An instantaneous impulse (N·s) at a point (m).
    Impulse { impulse: Framed, point: Framed },
    /// An instantaneous angular impulse (N·m·s).
    AngularImpulse { impulse: Framed },
    /// A ray, and a push or an impulse along it where it hits a body.
    Click(Click),
    /// Parts of the state made what they are not.
    Set(Change),
    /// An effect of the scene, by its index, on or off.
    Switch { effect: usize, on: bool },
    /// Another method from here on, for all bodies that have none of their own.
    Method(OwnMethod),
    /// A line in the log.
    Note(Arc<str>),
}

impl Action {
    /// What it is called in messages and in the log.
    pub fn noun(&self) -> &'static str {
        match self {
            Self::Push { .. } => "push",
            Self::Torque { .. } => "torque",
            Self::Impulse { .. } => "impulse",
            Self::AngularImpulse { .. } => "angular impulse",
            Self::Click(_) => "click",
            Self::Set(_) => "set",
            Self::Switch { .. } => "switch",
            Self::Method(_) => "method",
            Self::Note(_) => "note",
        }
    }

    /// How long it lasts, s; 0 for an instant.
    pub fn lasts(&self) -> f64 {
        match self {
            Self::Push { lasts, .. } | Self::Torque { lasts, .. } => *lasts,
            Self::Click(click) => click.lasts,
            _ => 0.0,
        }
    }

    /// How it goes through its time.
    pub fn profile(&self) -> Profile {
        match self {
            Self::Push { profile, .. } | Self::Torque { profile, .. } => *profile,
            Self::Click(click) => click.profile,
            _ => Profile::Box,
        }
    }

    /// Whether it may push a body for a time.
    pub fn pushes(&self) -> bool {
        matches!(self, Self::Push { .. } | Self::Click(_)) && self.lasts() > 0.0
    }

    /// Whether it may strike a body at a point.
    pub fn strikes(&self) -> bool {
        matches!(self, Self::Impulse { .. } | Self::Click(_)) && self.lasts() == 0.0
    }
}

impl Event {
    /// The same, on a body: what a click comes to where it hits.
    pub fn on(&self, body: usize, action: Action) -> Self {
        Self {
            target: Target::Body(body),
            action,
            ..self.clone()
        }
    }

    /// The same with all of its force from the start.
    pub fn at_peak(&self) -> Self {
        let mut event = self.clone();
        match &mut event.action {
            Action::Push { profile, .. } | Action::Torque { profile, .. } => {
                *profile = Profile::Box;
            }
            Action::Click(click) => click.profile = Profile::Box,
            _ => {}
        }
        event
    }

    /// When what lasts is how strong.
    pub fn pulse(&self) -> Pulse {
        Pulse {
            profile: self.action.profile(),
            begins: self.at,
            lasts: self.action.lasts(),
        }
    }

    /// The push that acts while the event lasts, at its peak, on a lane of a block.
    pub fn push(
        &self,
        lane: usize,
        inertial: &Inertial,
        q_pb: UnitQuaternion<f64>,
    ) -> Option<Push> {
        match self.action {
            Action::Push { force, point, .. } => Some(Push {
                lane,
                force: force.direction(q_pb),
                point: point.point(inertial, q_pb),
            }),
            _ => None,
        }
    }

    /// What acts while the event lasts; nothing where it is an instant.
    pub fn effect(
        &self,
        lane: usize,
        inertial: &Inertial,
        q_pb: UnitQuaternion<f64>,
    ) -> Option<Arc<dyn Effect>> {
        let pulse = self.pulse();
        let pulsed =
            |peak: Term| -> Option<Arc<dyn Effect>> { Some(Arc::new(Pulsed { peak, pulse })) };
        let constant = pulse.profile == Profile::Box;
        match self.action {
            Action::Push { .. } => {
                let push = self.push(lane, inertial, q_pb)?;
                match constant {
                    true => Some(Arc::new(push)),
                    false => pulsed(Term::Force {
                        lane,
                        force: push.force,
                        point: push.point,
                    }),
                }
            }
            Action::Torque { torque, .. } => {
                let torque = torque.direction(q_pb);
                match constant {
                    true => Some(Arc::new(Couple { lane, torque })),
                    false => pulsed(Term::Torque { lane, torque }),
                }
            }
            _ => None,
        }
    }
}

/// A vector, or a point, and the axes it is given in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Framed {
    World(Vector3<f64>),
    /// Body axes; a point counts from the centre of mass.
    Body(Vector3<f64>),
}

impl Framed {
    /// As a direction in world or principal axes.
    pub fn direction(self, q_pb: UnitQuaternion<f64>) -> Frame {
        match self {
            Self::World(v) => Frame::World(v),
            Self::Body(v) => Frame::Principal(q_pb * v),
        }
    }

    /// As a point in the world, or from the reference point in principal axes.
    pub fn point(self, inertial: &Inertial, q_pb: UnitQuaternion<f64>) -> Frame {
        match self {
            Self::World(p) => Frame::World(p),
            Self::Body(p) => Frame::Principal(q_pb * p + inertial.centre_p),
        }
    }
}
