//! The free body of Moser and Veselov, discrete in time and integrable, with the moments that make its
//! steps those of the real body to order 2, 4, 6, 8 or 10 ([`preprocessed`]):
//!
//! ```text
//! a = ½ h m / Ĩ    c = (1 + |c|²) a + ((Ĩ2 - Ĩ3)/Ĩ1 c2 c3, …)    q' = q (1 + c), normalised
//! ```
//!
//! m = Rᵀ L, and L stays in the world. Time-reversible; momentum, energy and the surfaces the motion lies
//! on are kept exactly (to rounding), so that only the phase drifts, as h^p t.
//! With damping: the same at `s = (1 - e^{-ch})/c` in place of h, exactly, with `L = e^{-ct} L0`.
//! Place and velocity under constant forces: in closed form.
//!
//! Moser & Veselov, Commun. Math. Phys. 139 (1991) 217; McLachlan & Zanna, Found. Comput. Math. 5 (2005) 87;
//! Hairer & Vilmart, J. Phys. A 39 (2006) 13225.

mod preprocessed;

pub use preprocessed::Preprocessed;

use super::coast::{Passage, coasting, omega_w};
use super::flight::Flight;
use super::own_steps::nowhere;
use super::{
    Accepts, Cost, Damping, Interval, Kind, Method, MethodInfo, Models, Step, Stepper, Work,
};
use crate::body::{Inertial, LANES, State, StateBlock};
use crate::effect::Decay;
use nalgebra::{Quaternion, Vector3};

/// One of the orders.
pub struct Dmv(&'static MethodInfo);

const INFO: [MethodInfo; 5] = [
    info("dmv2", 2, 0.91),
    info("dmv4", 4, 1.0),
    info("dmv6", 6, 1.05),
    info("dmv8", 8, 1.05),
    info("dmv10", 10, 1.1),
];

pub const DMV2: Dmv = Dmv(&INFO[0]);
pub const DMV4: Dmv = Dmv(&INFO[1]);
pub const DMV6: Dmv = Dmv(&INFO[2]);
pub const DMV8: Dmv = Dmv(&INFO[3]);
pub const DMV10: Dmv = Dmv(&INFO[4]);

const fn info(name: &'static str, order: u32, weight: f64) -> MethodInfo {
    MethodInfo {
        name,
        engines: &[],
        kind: Kind::Fixed,
        order,
        accepts: Accepts::Free,
        models: Models::Gyroscopic,
        damping: Damping::Exact("exact: the undamped motion at a slower time"),
        reversible: true,
        keeps_momentum: true,
        exact_free: false,
        preserves: "angular momentum and energy to rounding; only the phase drifts",
        cost: Cost {
            evaluations: 1,
            weight,
        },
        citation: "Moser & Veselov, Commun. Math. Phys. 139 (1991) 217; Hairer & Vilmart, J. Phys. A 39 (2006) 13225, section 4",
    }
}

impl Method for Dmv {
    fn info(&self) -> &'static MethodInfo {
        self.0
    }

    fn start(&self, interval: Interval, t: f64, state: &StateBlock) -> Box<dyn Stepper> {
        // A body for which it has no motion shall not be taken for one.
        let refused = self.0.refuses(&interval).is_some();
        let forces = coasting(&interval.load, &interval.inertial);
        let bodies = (0..interval.bodies.min(LANES)).map(|lane| {
            let body = interval.inertial.get(lane);
            let start = if refused { nowhere() } else { state.get(lane) };
            Body {
                inertial: body,
                start,
                momentum_w: body.momentum_w(&start),
                a_w: forces[lane].unwrap_or_default(),
                moments: Preprocessed::new(body.moments, self.0.order),
                q_wp: start.q_wp,
            }
        });
        Box::new(Run {
            bodies: bodies.collect(),
            decay: interval.load.decay().copied(),
            set_out: t,
            now: t,
            steps: 0,
        })
    }
}

#[derive(Clone)]
struct Body {
    inertial: Inertial,
    start: State,
    /// At the start, world, kg m²/s.
    momentum_w: Vector3<f64>,
    /// m/s².
    a_w: Vector3<f64>,
    moments: Preprocessed,
    /// Now.
    q_wp: Quaternion<f64>,
}

#[derive(Clone)]
struct Run {
    bodies: Vec<Body>,
    decay: Option<Decay>,
    /// s.
    set_out: f64,
    now: f64,
    steps: u64,
}

impl Run {
    fn step(&mut self, step: &Step) {
        let decay = self.decay.as_ref();
        let left = decay.map_or(1.0, |decay| decay.angular_factor(step.from - self.set_out));
        let s = decay.map_or(step.h, |decay| decay.angular(step.h).time);
        for body in &mut self.bodies {
            body.q_wp = (body.moments).attitude(s, body.q_wp, body.momentum_w * left);
        }
        self.now = step.to;
    }
}

impl Body {
    /// `t` seconds after the start.
    fn state(&self, t: f64, decay: Option<&Decay>) -> State {
        let gone = Passage::of(t, decay);
        let (x_w, v_w) = Flight::new(&self.start, self.a_w).at(&gone.linear);
        State {
            x_w,
            v_w,
            q_wp: self.q_wp,
            omega_w: omega_w(
                &self.inertial,
                self.q_wp,
                self.momentum_w * gone.angular.factor,
            ),
        }
    }
}

impl Stepper for Run {
    fn advance(&mut self, steps: &[Step], kept: &mut Vec<StateBlock>) {
        for step in steps {
            self.step(step);
            if step.keep {
                kept.push(self.state());
            }
        }
        self.steps += steps.len() as u64;
    }

    fn state(&self) -> StateBlock {
        let mut states = StateBlock::default();
        for (lane, body) in self.bodies.iter().enumerate() {
            let t = self.now - self.set_out;
            states.set(lane, body.state(t, self.decay.as_ref()));
        }
        states
    }

    fn work(&self) -> Work {
        Work {
            steps: self.steps,
            evaluations: self.steps,
        }
    }

    fn boxed_clone(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests;
