//! The free body of Moser and Veselov, discrete in time and integrable, with the moments that make its
//! steps those of the real body to order 2, 4, 6, 8 or 10 ([`Preprocessed`]):
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

use super::coast::{Course, Passage, constant_accelerations};
use super::preprocessed::Preprocessed;
use super::{
    Accepts, Cost, Damping, Interval, Kind, Method, MethodInfo, Models, Step, Stepper, Work,
};
use crate::body::StateBlock;
use crate::effect::Decay;
use nalgebra::Quaternion;

/// One of the orders.
pub struct Dmv(&'static MethodInfo);

const INFO: [MethodInfo; 5] = [
    info("dmv2", 2, 1.55),
    info("dmv4", 4, 1.75),
    info("dmv6", 6, 1.8),
    info("dmv8", 8, 1.8),
    info("dmv10", 10, 1.9),
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
        weak_orders: None,
        accepts: Accepts::Free,
        models: Models::Gyroscopic,
        damping: Damping::Exact("exact: the undamped motion at a slower time"),
        reversible: true,
        keeps_momentum: true,
        exact_free: false,
        preserves: "angular momentum and energy to rounding; only the phase drifts",
        cost: Cost {
            evaluations: Some(1),
            weight,
        },
        citation: "Moser & Veselov, Commun. Math. Phys. 139 (1991) 217; Hairer & Vilmart, J. Phys. A 39 (2006) 13225, section 4",
    }
}

impl Method for Dmv {
    fn info(&self) -> &'static MethodInfo {
        self.0
    }

    fn set_out(&self, interval: Interval, t: f64, state: &StateBlock) -> Box<dyn Stepper> {
        let accelerations = constant_accelerations(&interval, t, state);
        let bodies = interval.lanes().map(|lane| {
            let (inertial, start) = (interval.inertial.get(lane), state.get(lane));
            Body {
                course: Course::new(inertial, &start, accelerations[lane]),
                discrete: Preprocessed::new(inertial.moments, self.0.order),
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
    course: Course,
    discrete: Preprocessed,
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
            let momentum_w = body.course.momentum_w(left);
            body.q_wp = body.discrete.attitude(s, body.q_wp, momentum_w);
        }
        self.now = step.to;
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
        let gone = Passage::of(self.now - self.set_out, self.decay.as_ref());
        for (lane, body) in self.bodies.iter().enumerate() {
            states.set(lane, body.course.at(&gone, body.q_wp));
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

    fn bytes(&self) -> usize {
        size_of_val(self) + size_of_val(self.bodies.as_slice())
    }
}

#[cfg(test)]
mod tests;
