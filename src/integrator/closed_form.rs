//! The motion in closed form, at any time at once, of a body that no torque turns.
//!
//! ```text
//! s = (1 - e^{-ct})/c   attitude: the free body's at time s    ω = e^{-ct} ω_free(s)
//! r = (1 - e^{-kt})/k   v = v0 e^{-kt} + a r                   x = x0 + v0 r + a (t - r)/k
//! ```
//!
//! c and k damp the angular and the linear velocity; without them s = r = t and (t - r)/k = t²/2. The free
//! body is [`Coast`], in Euler's equations the elliptic one; in the tutorial's model, where ω stays,
//! the rotation `exp(ω s/2) q0`, whose angle is reduced in double-double.
//!
//! Nothing is stepped: errors do not grow with the number of steps, and only instants that are asked for
//! cost anything.
//!
//! Damping: τ = -c I ω makes dL/dt = -c L; with L = e^{-ct} M and ds = e^{-ct} dt, M and q obey the undamped
//! equations in s.

use super::coast::{Coast, Passage, constant_accelerations};
use super::{
    Accepts, Cost, Damping, Interval, Kind, Method, MethodInfo, Models, Step, Stepper, Work,
};
use crate::body::StateBlock;
use crate::effect::Decay;

pub struct ClosedForm;

const INFO: MethodInfo = MethodInfo {
    name: "closed-form",
    engines: &[],
    kind: Kind::Closed,
    order: 0,
    weak_orders: None,
    models: Models::Both,
    accepts: Accepts::Free,
    damping: Damping::Exact("by the time change s = (1 - e^{-ct})/c: exact"),
    reversible: true,
    keeps_momentum: true,
    exact_free: true,
    preserves: "everything a free body keeps, to rounding, at any time",
    cost: Cost {
        evaluations: Some(0),
        weight: 2.7,
    },
    citation: "van Zon & Schofield, J. Comput. Phys. 225 (2007); Celledoni, Fassò, Säfström & Zanna, SIAM J. Sci. Comput. 30 (2008)",
};

impl Method for ClosedForm {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn set_out(&self, interval: Interval, t: f64, state: &StateBlock) -> Box<dyn Stepper> {
        let gyroscopic = interval.load.gyroscopic();
        let accelerations = constant_accelerations(&interval, t, state);
        let coast = |lane: usize| {
            let inertial = interval.inertial.get(lane);
            Coast::new(inertial, gyroscopic, &state.get(lane), accelerations[lane])
        };
        Box::new(Run {
            bodies: interval.lanes().map(coast).collect(),
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
    bodies: Vec<Coast>,
    decay: Option<Decay>,
    /// What the lanes without a body hold.
    empty: StateBlock,
    /// s.
    from: f64,
    now: f64,
    instants: u64,
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
        let gone = Passage::of(self.now - self.from, self.decay.as_ref());
        let mut block = self.empty;
        for (lane, body) in self.bodies.iter().enumerate() {
            block.set(lane, body.at(&gone));
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

    fn bytes(&self) -> usize {
        size_of_val(self) + size_of_val(self.bodies.as_slice())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::State;
    use nalgebra::{Quaternion, Vector3};

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
        let coast = Coast::new(body, false, &start, Vector3::zeros());
        let end = coast.at(&Passage::of(t, None));
        let (sin, cos) = libm::sincos(0.5 * omega * t);
        let exact = Quaternion::new(cos, 0.0, sin, 0.0) * q0;
        // Sine, cosine and a product, each rounded.
        assert!((end.q_wp - exact).norm() < 1e-15);
        assert_eq!(end.omega_w, start.omega_w);
    }
}
