//! Bodies and what is known of them at an instant.

use super::streams::StreamSet;
use crate::mass::solids::Solid;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use std::sync::Arc;

/// A point in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// s.
    pub time: f64,
    /// Steps taken so far.
    pub step: u64,
}

impl Instant {
    /// Whole nanoseconds, as recordings count time.
    pub fn nanoseconds(&self) -> i64 {
        (self.time * 1e9).round() as i64
    }
}

/// What about a body does not change.
#[derive(Clone, Debug)]
pub struct Subject {
    /// Unique in a trace; letters, digits, - and _.
    pub name: String,
    pub label: String,
    /// kg; `None` is infinite.
    pub mass: Option<f64>,
    /// From the centre of mass to the fixed point, body axes, m; `None` for a free body.
    pub pivot_b: Option<Vector3<f64>>,
    /// Where that point stays, world, m.
    pub pivot_w: Option<Vector3<f64>>,
    /// Body axes x, y, z about which nothing turns it.
    pub held: [bool; 3],
    /// Inertia about the reference point (the pivot, or else the centre of mass), body axes,
    /// kg m², over the axes that can move: a held axis counts nothing.
    pub inertia_b: Matrix3<f64>,
    /// Its inverse there, 1/(kg m²), with zeros for held axes.
    pub inverse_inertia_b: Matrix3<f64>,
    /// Inertia about the centre of mass, body axes, kg m²: what is drawn.
    pub inertia_c: Matrix3<f64>,
    /// How it starts: what a camera looks at.
    pub start: Motion,
    /// What turns it, by name, where that is told apart: [`Sample::sources`] are in this order.
    pub sources: Vec<String>,
    /// The swarm that it is one of, if any: recorded as one, poses alone. All others come before.
    pub swarm: Option<Arc<str>>,
    /// What it looks like, where that is known.
    pub solid: Option<Arc<dyn Solid>>,
}

impl Subject {
    /// Whether both are of one swarm, and so alike but for how they start.
    pub fn is_like(&self, other: &Self) -> bool {
        self.swarm.is_some() && self.swarm == other.swarm
    }

    /// What torque, momentum and inertia are about, in words.
    pub fn reference(&self) -> &'static str {
        match self.pivot_b {
            Some(_) => "pivot",
            None => "centre of mass",
        }
    }

    /// `R I_b Rᵀ ω`: angular momentum about the reference point, world, kg m²/s.
    pub fn momentum_w(&self, motion: &Motion) -> Vector3<f64> {
        let omega_b = motion.q_wb.inverse() * motion.omega_w;
        motion.q_wb * (self.inertia_b * omega_b)
    }

    /// Kinetic energy, J: of the turning about the reference point, and of the centre of mass
    /// where that is the reference point.
    pub fn energy(&self, motion: &Motion) -> f64 {
        self.energy_with(motion, self.momentum_w(motion))
    }

    /// The same where its angular momentum is known (world, kg m²/s).
    pub fn energy_with(&self, motion: &Motion, momentum_w: Vector3<f64>) -> f64 {
        let turning = 0.5 * motion.omega_w.dot(&momentum_w);
        match (self.pivot_b, self.mass) {
            (None, Some(mass)) => turning + 0.5 * mass * motion.velocity_w.norm_squared(),
            _ => turning,
        }
    }
}

/// The state of a body at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Centre of mass, world, m.
    pub position_w: Vector3<f64>,
    /// Of the centre of mass, world, m/s.
    pub velocity_w: Vector3<f64>,
    pub q_wb: UnitQuaternion<f64>,
    /// World, rad/s.
    pub omega_w: Vector3<f64>,
}

/// A force and where it acts, world, N and m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointForce {
    pub force_w: Vector3<f64>,
    pub point_w: Vector3<f64>,
}

/// How far a body is from what is known of its model's true motion; `None` where it is not known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// The angle from the exact attitude, rad.
    pub attitude: Option<f64>,
    /// The error of the energy, as a part of the largest kinetic energy so far.
    pub energy: Option<f64>,
    /// The length of the error of the angular momentum, as a part of the largest so far.
    pub momentum: Option<f64>,
}

/// A body at an instant: its state and what the model says follows.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// The streams that are to be recorded of it. Sources and deviations are there only where these say them.
    pub due: StreamSet,
    /// Whether pictures are due: numbers may be wanted oftener than a screen shows anything.
    pub shown: bool,
    pub motion: Motion,
    /// Applied torque about the reference point, world, N·m: everything but the gyroscopic term.
    pub tau_w: Vector3<f64>,
    /// Angular acceleration by the model, world, rad/s², the gyroscopic term included where the
    /// model has it; never a difference of velocities.
    pub alpha_w: Vector3<f64>,
    /// The pushes that act.
    pub pushes: Vec<PointForce>,
    /// The torque of each of [`Subject::sources`] about the reference point, world, N·m; zero while
    /// it does not act. Their sum is `I α`, what a held axis takes included.
    pub sources: Vec<Vector3<f64>>,
    pub deviation: Deviation,
    /// Wall time a step took of late, s, where it is measured.
    pub step_time: Option<f64>,
}

impl Sample {
    /// `R I_b⁻¹ Rᵀ`: inverse inertia about the reference point, world, 1/(kg m²).
    pub fn inverse_inertia_w(&self, subject: &Subject) -> Matrix3<f64> {
        super::quantity::turned(&subject.inverse_inertia_b, self)
    }

    /// Where the reference point is in the world, m.
    pub fn reference_w(&self, subject: &Subject) -> Vector3<f64> {
        let arm_b = subject.pivot_b.unwrap_or_default();
        self.motion.position_w + self.motion.q_wb * arm_b
    }
}
