//! The motion in closed form, at any time at once, of a body that no torque turns.
//!
//! ```text
//! s = (1 - e^{-ct})/c   attitude: the free body's at time s    ω = e^{-ct} ω_free(s)
//! r = (1 - e^{-kt})/k   v = v0 e^{-kt} + a r                   x = x0 + v0 r + a (t - r)/k
//! ```
//!
//! c and k damp the angular and the linear velocity; without them s = r = t and (t - r)/k = t²/2. The free
//! body is [`FreeMotion`], in Euler's equations the elliptic one; in the tutorial's model, where ω stays,
//! the rotation `exp(ω s/2) q0`, whose angle is reduced in double-double.
//!
//! Nothing is stepped: errors do not grow with the number of steps, and only instants that are asked for
//! cost anything.
//!
//! Damping: τ = -c I ω makes dL/dt = -c L; with L = e^{-ct} M and ds = e^{-ct} dt, M and q obey the undamped
//! equations in s.

use super::coast::Passage;
use super::flight::Flight;
use super::own_steps::nowhere;
use super::{
    Accepts, Cost, Damping, Interval, Kind, Method, MethodInfo, Models, Step, Stepper, Work,
};
use crate::body::{Inertial, State, StateBlock};
use crate::effect::Decay;
use crate::exact::FreeMotion;
use nalgebra::{Quaternion, Vector3};

pub struct ClosedForm;

const INFO: MethodInfo = MethodInfo {
    name: "closed-form",
    engines: &[],
    kind: Kind::Closed,
    order: 0,
    models: Models::Both,
    accepts: Accepts::Free,
    damping: Damping::Exact("by the time change s = (1 - e^{-ct})/c: exact"),
    reversible: true,
    keeps_momentum: true,
    exact_free: true,
    preserves: "everything a free body keeps, to rounding, at any time",
    cost: Cost {
        evaluations: 0,
        weight: 2.3,
    },
    citation: "van Zon & Schofield, J. Comput. Phys. 225 (2007); Celledoni, Fassò, Säfström & Zanna, SIAM J. Sci. Comput. 30 (2008)",
};

impl Method for ClosedForm {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn start(&self, interval: Interval, t: f64, state: &StateBlock) -> Box<dyn Stepper> {
        // What is refused has no closed form here; nobody shall take the free motion for it.
        let refused = INFO.refuses(&interval).is_some();
        let wrench = interval.load.wrench(t, &interval.inertial, state);
        let path = |lane: usize| {
            let body = interval.inertial.get(lane);
            let force_w = wrench.as_ref().map(|w| w.get(lane).force_w);
            let a_w = force_w.unwrap_or_default() * body.inv_mass;
            let turning = Turning::new(interval.load.gyroscopic(), &body, &state.get(lane));
            Path {
                start: state.get(lane),
                flight: Flight::new(&state.get(lane), a_w),
                turning,
            }
        };
        Box::new(Run {
            paths: (0..interval.bodies).map(path).collect(),
            refused,
            decay: interval.load.decay().copied(),
            empty: *state,
            from: t,
            now: t,
            instants: 0,
        })
    }
}

#[derive(Clone)]
struct Run {
    paths: Vec<Path>,
    refused: bool,
    decay: Option<Decay>,
    /// What the lanes without a body hold.
    empty: StateBlock,
    /// s.
    from: f64,
    now: f64,
    instants: u64,
}

/// How one body moves.
#[derive(Clone)]
struct Path {
    start: State,
    flight: Flight,
    turning: Turning,
}

/// How it turns, undamped.
#[derive(Clone)]
enum Turning {
    /// L stays.
    Euler(FreeMotion),
    /// ω stays: what the world turns the starting attitude by.
    Steady(FreeMotion),
}

impl Stepper for Run {
    fn advance(&mut self, steps: &[Step], kept: &mut Vec<StateBlock>) {
        for step in steps {
            self.now = step.to;
            if step.keep {
                kept.push(self.state());
                self.instants += 1;
            }
        }
    }

    fn state(&self) -> StateBlock {
        let t = self.now - self.from;
        let gone = Passage::of(t, self.decay.as_ref());
        let mut block = self.empty;
        for (lane, path) in self.paths.iter().enumerate() {
            let state = match self.refused {
                true => nowhere(),
                false => path.at(&gone),
            };
            block.set(lane, state);
        }
        block
    }

    fn work(&self) -> Work {
        Work {
            steps: self.instants,
            evaluations: 0,
        }
    }

    fn boxed_clone(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}

impl Path {
    fn at(&self, gone: &Passage) -> State {
        let (x_w, v_w) = self.flight.at(&gone.linear);
        let (q_wp, omega_w) = self.turning.at(gone.angular.time, &self.start);
        State {
            x_w,
            v_w,
            q_wp,
            omega_w: omega_w * gone.angular.factor,
        }
    }
}

impl Turning {
    fn new(gyroscopic: bool, body: &Inertial, start: &State) -> Self {
        if gyroscopic {
            let omega_p = start.to_principal(start.omega_w);
            return Self::Euler(FreeMotion::new(body.moments, start.q_wp, omega_p));
        }
        // A body with equal moments turns steadily.
        let (sphere, upright) = (Vector3::repeat(1.0), Quaternion::identity());
        Self::Steady(FreeMotion::new(sphere, upright, start.omega_w))
    }

    /// Attitude and world angular velocity.
    fn at(&self, s: f64, start: &State) -> (Quaternion<f64>, Vector3<f64>) {
        match self {
            Self::Euler(motion) => {
                let (q_wp, omega_p) = motion.at(s);
                (q_wp, State { q_wp, ..*start }.to_world(omega_p))
            }
            Self::Steady(turn) => (turn.attitude(s) * start.q_wp, start.omega_w),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn in_the_tutorials_model_a_long_rotation_keeps_its_phase() {
        // 786,432 rad, exactly, of which libm takes off whole turns exactly.
        let (omega, t) = (0.75, 1_048_576.0);
        let q0 = Quaternion::new(0.5, -0.5, 0.5, 0.5);
        let start = State {
            x_w: Vector3::zeros(),
            v_w: Vector3::zeros(),
            q_wp: q0,
            omega_w: Vector3::new(0.0, omega, 0.0),
        };
        let body = crate::body::InertialBlock::default().get(0);
        let path = Path {
            start,
            flight: Flight::new(&start, Vector3::zeros()),
            turning: Turning::new(false, &body, &start),
        };
        let end = path.at(&Passage::of(t, None));
        let (sin, cos) = libm::sincos(0.5 * omega * t);
        let exact = Quaternion::new(cos, 0.0, sin, 0.0) * q0;
        // Sine, cosine and a product, each rounded.
        assert!((end.q_wp - exact).norm() < 1e-15);
        assert_eq!(end.omega_w, start.omega_w);
    }
}
