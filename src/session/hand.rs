//! A push by hand: where, which way, how strong, and what it does.
//!
//! A force F along n̂ at a point p, with the lever arm r = p - x_ref, turns a body by
//!
//! ```text
//! τ = F r × n̂        α = I_w⁻¹ τ        |α| = F |I_w⁻¹ (r × n̂)|
//! ```
//!
//! So "S rad/s of spin", in a time T or at a blow, is
//!
//! ```text
//! F = S / (T |I_w⁻¹ (r × n̂)|)    N       J = S / |I_w⁻¹ (r × n̂)|    N·s
//! ```
//!
//! and a feather and a ship answer alike; a pure torque about n̂ has n̂ in place of r × n̂. It is what the push by itself
//! gives, as if the body did not turn in T. Where the line of the force passes nearer to the reference point than
//! [`NEAREST`] radii of gyration, or where held axes take all of it, no strength of a force is an answer: refused.

use crate::sim::Blow;
use crate::trace::{Instant, Sample, Subject, short};
use nalgebra::Vector3;

/// A push in numbers: exactly this again is the same push on the same state.
#[derive(Clone, Debug, PartialEq)]
pub struct Push {
    /// Name of the body.
    pub body: String,
    pub what: What,
    /// Whether the vector is in the body's axes, and turns with it.
    pub in_body: bool,
    /// s; absent: a blow, and N is N·s.
    pub lasts: Option<f64>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum What {
    /// N (N·s) at a point.
    Force { force: Vector3<f64>, at: Place },
    /// N·m (N·m·s).
    Torque(Vector3<f64>),
}

/// A point, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// It stays in the world.
    World(Vector3<f64>),
    /// From the shape's origin, body axes; it goes with the body.
    Body(Vector3<f64>),
}

/// What a push did as it began.
#[derive(Clone, Debug, PartialEq)]
pub struct Pushed {
    pub push: Push,
    pub at: Instant,
    /// World, m; none of a torque.
    pub point_w: Option<Vector3<f64>>,
    /// From the reference point to there, world, m.
    pub arm_w: Option<Vector3<f64>>,
    /// How far the force's line passes from the reference point, m.
    pub lever: Option<f64>,
    /// World, N (N·s).
    pub force_w: Option<Vector3<f64>>,
    /// About the reference point, world, N·m (N·m·s).
    pub torque_w: Vector3<f64>,
    /// What it gives by itself, world: α, rad/s²; of a blow Δω, rad/s.
    pub alpha_w: Vector3<f64>,
    /// The body's angular acceleration with all that acts, world, rad/s².
    pub total_alpha_w: Vector3<f64>,
}

/// Radii of gyration below which an arm is none.
pub const NEAREST: f64 = 1e-3;

impl Place {
    pub fn point_w(self, subject: &Subject, sample: &Sample) -> Vector3<f64> {
        match self {
            Self::World(point_w) => point_w,
            Self::Body(point) => {
                let motion = &sample.motion;
                motion.position_w + motion.q_wb * (point - centre(subject))
            }
        }
    }
}

/// The centre of mass from the shape's origin, body axes, m.
pub(super) fn centre(subject: &Subject) -> Vector3<f64> {
    let solid = subject.solid.as_ref();
    solid.map_or(Vector3::zeros(), |solid| solid.centre())
}

fn unit(v: Vector3<f64>) -> Result<Vector3<f64>, String> {
    let largest = v.amax();
    let unit = (v / largest).try_normalize(0.0);
    let unit = unit.filter(|_| largest > 0.0 && largest.is_finite());
    unit.ok_or_else(|| "it has no direction".to_owned())
}

impl Push {
    /// The same way, and so strong that by itself it gives `spin` rad/s.
    pub fn giving(mut self, spin: f64, subject: &Subject, sample: &Sample) -> Result<Self, String> {
        let in_body = self.in_body;
        let to_world = |v: Vector3<f64>| match in_body {
            true => sample.motion.q_wb * v,
            false => v,
        };
        let (direction, turning_w) = match &self.what {
            What::Torque(torque) => {
                let direction = unit(*torque)?;
                (direction, to_world(direction))
            }
            What::Force { force, at } => {
                let direction = unit(*force)?;
                let arm_w = at.point_w(subject, sample) - sample.reference_w(subject);
                let turning_w = arm_w.cross(&to_world(direction));
                near(turning_w.norm(), subject)?;
                (direction, turning_w)
            }
        };
        let answer = (sample.inverse_inertia_w(subject) * turning_w).norm();
        let strength = spin / (self.lasts.unwrap_or(1.0) * answer);
        if answer <= 0.0 || !strength.is_finite() {
            return Err(format!(
                "nothing turns {} that way; push it elsewhere, or say how strong",
                self.body
            ));
        }
        match &mut self.what {
            What::Torque(torque) => *torque = direction * strength,
            What::Force { force, .. } => *force = direction * strength,
        }
        Ok(self)
    }
}

fn near(lever: f64, subject: &Subject) -> Result<(), String> {
    let largest = subject.inertia_c.diagonal().amax();
    let radius = subject.mass.map_or(0.0, |mass| (largest / mass).sqrt());
    if lever > NEAREST * radius {
        return Ok(());
    }
    Err(format!(
        "the force's line passes {} m from the {} of {}, so it turns next to nothing, however strong; push beside it, or say how strong",
        short(lever),
        subject.reference(),
        subject.name
    ))
}

impl Pushed {
    pub(super) fn of(push: Push, blow: &Blow, subject: &Subject) -> Self {
        let sample = &blow.sample;
        let struck = blow.jump.and_then(|jump| jump.strike).or(blow.push);
        let arm = |point_w: Vector3<f64>| point_w - sample.reference_w(subject);
        let torque_w = blow.jump.map_or(blow.tau_w, |jump| jump.angular_impulse_w);
        let own_w = sample.inverse_inertia_w(subject) * torque_w;
        Self {
            push,
            at: blow.at,
            point_w: struck.map(|struck| struck.point_w),
            arm_w: struck.map(|struck| arm(struck.point_w)),
            lever: struck.map(|struck| {
                let force = struck.force_w.norm();
                match force > 0.0 {
                    true => arm(struck.point_w).cross(&struck.force_w).norm() / force,
                    false => 0.0,
                }
            }),
            force_w: struck.map(|struck| struck.force_w),
            torque_w,
            alpha_w: blow.jump.map_or(own_w, |jump| jump.omega_w),
            total_alpha_w: sample.alpha_w,
        }
    }
}
