//! What effects are made of, for methods that must know more of a torque than its value.

use super::{Frame, Wrench};
use crate::body::State;

/// A constant force at a point, or a constant torque, on one lane of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Term {
    /// `F` at `point`; the torque is `(p - x) × F`.
    Force {
        lane: usize,
        /// N.
        force: Frame,
        /// m.
        point: Frame,
    },
    Torque {
        lane: usize,
        /// N·m.
        torque: Frame,
    },
}

impl Term {
    pub fn lane(&self) -> usize {
        match *self {
            Self::Force { lane, .. } | Self::Torque { lane, .. } => lane,
        }
    }

    /// What it does to its body in this state.
    pub fn wrench(&self, state: &State) -> Wrench {
        match self {
            Self::Force { force, point, .. } => {
                let force_w = force.vector_w(state);
                let arm_w = match *point {
                    Frame::World(p) => p - state.x_w,
                    Frame::Principal(p) => state.to_world(p),
                };
                Wrench {
                    force_w,
                    tau_w: arm_w.cross(&force_w),
                }
            }
            Self::Torque { torque, .. } => Wrench {
                tau_w: torque.vector_w(state),
                ..Wrench::default()
            },
        }
    }

    /// A force fixed in the world at the reference point is constant and turns nothing; a torque
    /// fixed in the world is constant; all else changes as the body moves or turns.
    pub fn depends(&self) -> Depends {
        match self {
            Self::Force {
                force: Frame::World(_),
                point: Frame::Principal(p),
                ..
            } if p.norm_squared() == 0.0 => Depends::NOTHING,
            Self::Force { .. }
            | Self::Torque {
                torque: Frame::Principal(_),
                ..
            } => Depends {
                torque: true,
                place: true,
                ..Depends::NOTHING
            },
            Self::Torque {
                torque: Frame::World(_),
                ..
            } => Depends {
                torque: true,
                ..Depends::NOTHING
            },
        }
    }
}

/// What forces and torques depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Depends {
    /// There is a torque.
    pub torque: bool,
    /// A force or torque changes with time.
    pub time: bool,
    /// With place or attitude.
    pub place: bool,
    /// With velocity or angular velocity.
    pub velocity: bool,
}

impl Depends {
    /// No torque, and forces that are constant.
    pub const NOTHING: Self = Self {
        torque: false,
        time: false,
        place: false,
        velocity: false,
    };
    pub const EVERYTHING: Self = Self {
        torque: true,
        time: true,
        place: true,
        velocity: true,
    };

    /// Whether the sum of the forces and torques stays as it is.
    pub fn is_constant(self) -> bool {
        !(self.time || self.place || self.velocity)
    }

    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            torque: self.torque || other.torque,
            time: self.time || other.time,
            place: self.place || other.place,
            velocity: self.velocity || other.velocity,
        }
    }
}

impl FromIterator<Self> for Depends {
    fn from_iter<T: IntoIterator<Item = Self>>(all: T) -> Self {
        all.into_iter().fold(Self::NOTHING, Self::or)
    }
}
