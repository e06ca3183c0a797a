//! A body that no torque turns and that constant forces push, in closed form from where it set out:
//!
//! ```text
//! v = e^{-kt} v0 + T a    x = x0 + T v0 + P a    T = (1 - e^{-kt})/k   P = (t - T)/k
//! q = free motion at s = (1 - e^{-ct})/c         L = e^{-ct} L0  (the tutorial's model: ω = e^{-ct} ω0)
//! ```
//!
//! Undamped T = s = t and P = t²/2. Nothing accumulates: errors do not grow with the number of steps.

use super::flight::Flight;
use crate::body::{Inertial, InertialBlock, LANES, State};
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
    let Some(terms) = load.terms(inertial) else {
        return [None; LANES];
    };
    let mut accelerations = [Some(Vector3::zeros()); LANES];
    for term in terms {
        let lane = term.lane();
        accelerations[lane] = match (accelerations[lane], term) {
            (
                Some(sum),
                Term::Force {
                    force: Frame::World(force_w),
                    ..
                },
            ) if term.depends() == Depends::NOTHING => {
                Some(sum + force_w * inertial.get(lane).inv_mass)
            }
            _ => None,
        };
    }
    accelerations
}

/// A body on its way.
#[derive(Clone, Debug)]
pub struct Coast {
    body: Inertial,
    gyroscopic: bool,
    start: State,
    momentum_w: Vector3<f64>,
    /// m/s².
    a_w: Vector3<f64>,
    turning: FreeMotion,
}

impl Coast {
    pub fn new(body: Inertial, gyroscopic: bool, start: State, a_w: Vector3<f64>) -> Self {
        // Constant ω is how a sphere turns, whatever its size.
        let moments = match gyroscopic {
            true => body.moments,
            false => Vector3::repeat(1.0),
        };
        let omega_p = start.to_principal(start.omega_w);
        Self {
            gyroscopic,
            momentum_w: body.momentum_w(&start),
            start,
            a_w,
            turning: FreeMotion::new(moments, start.q_wp, omega_p),
            body,
        }
    }

    /// `t` seconds after it set out.
    pub fn at(&self, t: f64, decay: Option<&Decay>) -> State {
        let gone = Passage::of(t, decay);
        let (x_w, v_w) = Flight::new(&self.start, self.a_w).at(&gone.linear);
        let left = gone.angular.factor;
        let q_wp = self.turning.attitude(gone.angular.time);
        let omega_w = match self.gyroscopic {
            true => omega_w(&self.body, q_wp, self.momentum_w * left),
            false => self.start.omega_w * left,
        };
        State {
            x_w,
            v_w,
            q_wp,
            omega_w,
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
