//! A body that no torque turns and that constant forces push, in closed form from where it set out:
//!
//! ```text
//! v = e^{-kt} v0 + T a    x = x0 + T v0 + P a    T = (1 - e^{-kt})/k   P = (t - T)/k
//! q = free motion at s = (1 - e^{-ct})/c         L = e^{-ct} L0  (the tutorial's model: ω = e^{-ct} ω0)
//! ```
//!
//! Undamped T = s = t and P = t²/2. Nothing accumulates: errors do not grow with the number of steps.

use super::Interval;
use super::flight::Flight;
use crate::body::{Inertial, InertialBlock, LANES, State, StateBlock};
use crate::effect::{Decay, Depends, Elapsed, Frame, Load, Term};
use crate::exact::FreeMotion;
use crate::math::turned;
use nalgebra::{Quaternion, Vector3};

/// Constant forces on each lane of a block, as accelerations, m/s²; `None` for a lane that
/// something else acts on.
pub fn coasting(load: &Load, inertial: &InertialBlock) -> [Option<Vector3<f64>>; LANES] {
    if !load.applies() {
        return [Some(Vector3::zeros()); LANES];
    }
    std::array::from_fn(|lane| {
        let inv_mass = inertial.get(lane).inv_mass;
        let mut sum = Vector3::zeros();
        for term in load.terms_of(lane, inertial)? {
            match term {
                Term::Force {
                    force: Frame::World(force_w),
                    ..
                } if term.depends() == Depends::NOTHING => sum += force_w * inv_mass,
                _ => return None,
            }
        }
        Some(sum)
    })
}

/// The accelerations (m/s²) of the bodies of a block on which nothing acts but forces that are constant.
pub fn constant_accelerations(
    interval: &Interval,
    t: f64,
    state: &StateBlock,
) -> [Vector3<f64>; LANES] {
    let wrench = interval.load.wrench(t, &interval.inertial, state);
    let wrench = wrench.unwrap_or_default();
    std::array::from_fn(|lane| wrench.get(lane).force_w * interval.inertial.get(lane).inv_mass)
}

/// How a body goes that no torque turns and a constant force pushes, but for its attitude.
#[derive(Clone, Debug)]
pub struct Course {
    inertial: Inertial,
    flight: Flight,
    /// At the start, kg m²/s.
    momentum_w: Vector3<f64>,
}

impl Course {
    /// From a start, under a constant acceleration, m/s².
    pub fn new(inertial: Inertial, start: &State, a_w: Vector3<f64>) -> Self {
        Self {
            flight: Flight::new(start, a_w),
            momentum_w: inertial.momentum_w(start),
            inertial,
        }
    }

    /// L (world, kg m²/s) when `left` of it, `e^{-ct}`, is left.
    pub fn momentum_w(&self, left: f64) -> Vector3<f64> {
        self.momentum_w * left
    }

    /// Where it is by now with that attitude, `ω = R I⁻¹ Rᵀ L`.
    pub fn at(&self, gone: &Passage, q_wp: Quaternion<f64>) -> State {
        let (x_w, v_w) = self.flight.at(&gone.linear);
        State {
            x_w,
            v_w,
            q_wp,
            omega_w: omega_w(&self.inertial, q_wp, self.momentum_w(gone.angular.factor)),
        }
    }
}

/// A body on its way, at any time at once.
#[derive(Clone, Debug)]
pub struct Coast {
    course: Course,
    turning: Turning,
}

/// How it turns, undamped.
#[derive(Clone, Debug)]
enum Turning {
    /// L stays.
    Euler(FreeMotion),
    /// ω stays: what the world turns the starting attitude by.
    Steady {
        turn: FreeMotion,
        q_wp: Quaternion<f64>,
        omega_w: Vector3<f64>,
    },
}

impl Coast {
    pub fn new(inertial: Inertial, gyroscopic: bool, start: &State, a_w: Vector3<f64>) -> Self {
        let State { q_wp, omega_w, .. } = *start;
        let turning = if gyroscopic {
            let omega_p = start.to_principal(omega_w);
            Turning::Euler(FreeMotion::new(inertial.moments, q_wp, omega_p))
        } else {
            // A body with equal moments turns steadily.
            let (sphere, upright) = (Vector3::repeat(1.0), Quaternion::identity());
            Turning::Steady {
                turn: FreeMotion::new(sphere, upright, omega_w),
                q_wp,
                omega_w,
            }
        };
        Self {
            course: Course::new(inertial, start, a_w),
            turning,
        }
    }

    /// The state by now.
    pub fn at(&self, gone: &Passage) -> State {
        let s = gone.angular.time;
        match &self.turning {
            Turning::Euler(motion) => self.course.at(gone, motion.attitude(s)),
            Turning::Steady {
                turn,
                q_wp,
                omega_w,
            } => State {
                omega_w: omega_w * gone.angular.factor,
                ..self.course.at(gone, turn.attitude(s) * q_wp)
            },
        }
    }
}

/// A stretch of time as either velocity counts it.
#[derive(Clone, Copy, Debug)]
pub struct Passage {
    pub linear: Elapsed,
    pub angular: Elapsed,
}

impl Passage {
    #[inline]
    pub fn of(h: f64, decay: Option<&Decay>) -> Self {
        let undamped = Elapsed::undamped(h);
        Self {
            linear: decay.map_or(undamped, |decay| decay.linear(h)),
            angular: decay.map_or(undamped, |decay| decay.angular(h)),
        }
    }

    /// The state after it where no force acts, but for what turns.
    #[inline(always)]
    pub fn translated(&self, s: State) -> State {
        State {
            x_w: s.x_w + s.v_w * self.linear.time,
            v_w: s.v_w * self.linear.factor,
            ..s
        }
    }
}

/// `ω = R I⁻¹ Rᵀ L`, world.
#[inline(always)]
pub fn omega_w(body: &Inertial, q_wp: Quaternion<f64>, momentum_w: Vector3<f64>) -> Vector3<f64> {
    let momentum_p = turned(q_wp.conjugate(), momentum_w);
    turned(q_wp, body.inv_moments.component_mul(&momentum_p))
}
