//! Exact free motion with kicks. Of a step h the equations are split into
//!
//! ```text
//! A, free motion:  x' = v   v' = -k v   q' = ½ (ω, 0) q   L' = -c L   (the tutorial's model: ω' = -c ω)
//! B, kicks:        v' = F(t, x, q)/m    L' = τ(t, x, q)               (ω' = I_w⁻¹ τ)
//! ```
//!
//! and either is followed exactly, for lengths that [`Composition`]s make a whole step of:
//!
//! ```text
//! A(s): x += T v   v *= e^{-ks}   q along the free motion for (1 - e^{-cs})/c   L *= e^{-cs}   t += s
//! B(s): v += s F/m   L += s τ
//! ```
//!
//! L is kept in the world, where free motion leaves it alone: a torque along an axis leaves the component
//! of L across it exact. The last drift of a step and the first of the next are one drift, the kicks at
//! either side of a step's end ask for forces once; the states that are kept branch off and change nothing.
//! A body that no torque turns and that constant forces push needs no steps: it goes by its closed form.
//!
//! Compositions after Runge, Kutta and Nyström have their order for forces that do not depend on velocities,
//! as have all others where forces depend on time (time runs with A). Where a composition goes back
//! (negative lengths), damping grows: c h should be well below 1.
//!
//! Touma & Wisdom, Astron. J. 107 (1994) 1189; Hairer, Lubich & Wanner, Geometric Numerical Integration, VII.5;
//! Blanes & Casas, A Concise Introduction to Geometric Numerical Integration (2016), 3.

mod composition;
mod turning;

pub use composition::{ABA864, ABA1064, Composition, ORDER8, RKN4, RKN6, STRANG};

use super::coast::{Coast, Passage, coasting, omega_w};
use super::{Interval, Method, MethodInfo, Step, Stepper, Work};
use crate::body::{Inertial, State, StateBlock};
use crate::effect::WrenchBlock;
use composition::First;
use nalgebra::Vector3;
use std::sync::Arc;
use turning::Turning;

/// Free motion with kicks, by one of the compositions.
pub struct Kicks(pub &'static Composition);

impl Method for Kicks {
    fn info(&self) -> &'static MethodInfo {
        &self.0.info
    }

    fn set_out(&self, interval: Interval, t: f64, state: &StateBlock) -> Box<dyn Stepper> {
        let gyroscopic = interval.load.gyroscopic();
        let forces = coasting(&interval.load, &interval.inertial);
        let (mut coasting, mut kicked) = (Vec::new(), Vec::new());
        for lane in interval.lanes() {
            let (inertial, start) = (interval.inertial.get(lane), state.get(lane));
            match forces[lane] {
                Some(a_w) => coasting.push((lane, Coast::new(inertial, gyroscopic, &start, a_w))),
                None => kicked.push(Kicked {
                    lane,
                    inertial,
                    stays_w: match gyroscopic {
                        true => inertial.momentum_w(&start),
                        false => start.omega_w,
                    },
                    turning: Turning::new(&inertial, gyroscopic),
                }),
            }
        }
        Box::new(Run {
            plan: Plan::of(self.0).into(),
            interval: interval.into(),
            coasting: coasting.into(),
            set_out: t,
            kicked,
            block: *state,
            ahead: 0.0,
            now: t,
            asked: None,
            work: Work::default(),
        })
    }
}

/// A composition as a step takes it.
#[derive(Debug)]
struct Plan {
    stages: Vec<Stage>,
    /// The drift after the last kick, in steps.
    last: f64,
}

/// A drift and the kick after it.
#[derive(Debug)]
struct Stage {
    /// In steps.
    drift: f64,
    /// When the kick is, in steps from the start.
    when: f64,
    kick: f64,
}

impl Plan {
    fn of(composition: &Composition) -> Self {
        let mut drifts = composition.a.iter();
        let mut when = 0.0;
        let kicks = composition.b.iter().enumerate();
        let stages = kicks.map(|(k, &kick)| {
            let drift = match (k, composition.first) {
                (0, First::Kick) => 0.0,
                _ => drifts.next().copied().unwrap_or(0.0),
            };
            when += drift;
            Stage { drift, when, kick }
        });
        let mut stages: Vec<Stage> = stages.collect();
        let last = drifts.next().copied().unwrap_or(0.0);
        if let (First::Kick, Some(stage)) = (composition.first, stages.last_mut()) {
            // But for the rounding of the sum.
            stage.when = 1.0;
        }
        Self { stages, last }
    }
}

/// A body that is kicked.
#[derive(Clone)]
struct Kicked {
    lane: usize,
    inertial: Inertial,
    /// What stays in free motion, world: L (kg m²/s), or ω (rad/s) in the tutorial's model.
    stays_w: Vector3<f64>,
    turning: Turning,
}

impl Kicked {
    /// A: the body's state but for ω, which no kick looks at.
    #[inline]
    fn drift(&mut self, by: &Passage, s: &mut State) {
        *s = by.translated(*s);
        s.q_wp = (self.turning).attitude(by.angular.time, s.q_wp, self.stays_w);
        self.stays_w *= by.angular.factor;
    }

    fn omega_w(&self, s: &State) -> Vector3<f64> {
        match self.turning {
            Turning::Momentum { .. } => omega_w(&self.inertial, s.q_wp, self.stays_w),
            Turning::Velocity => self.stays_w,
        }
    }
}

#[derive(Clone)]
struct Run {
    plan: Arc<Plan>,
    interval: Arc<Interval>,
    /// Bodies that need no steps, by lane, from `set_out` (s) on.
    coasting: Arc<[(usize, Coast)]>,
    set_out: f64,
    kicked: Vec<Kicked>,
    /// States of the kicked bodies before the drift that is left to be done; ω is out of date.
    block: StateBlock,
    /// That drift, s.
    ahead: f64,
    /// Where the last step ended, s.
    now: f64,
    /// Forces at a time (s) and where the bodies now are.
    asked: Option<(f64, WrenchBlock)>,
    work: Work,
}

impl Run {
    fn step(&mut self, step: &Step) {
        if !self.kicked.is_empty() {
            let plan = Arc::clone(&self.plan);
            for stage in &plan.stages {
                self.drift(self.ahead + stage.drift * step.h);
                let when = match stage.when {
                    1.0 => step.to,
                    when => step.from + when * step.h,
                };
                self.ahead = 0.0;
                self.kick(when, stage.kick * step.h);
            }
            self.ahead = plan.last * step.h;
        }
        self.now = step.to;
        self.work.steps += 1;
    }

    /// A(s).
    fn drift(&mut self, s: f64) {
        if s == 0.0 {
            return;
        }
        let by = Passage::of(s, self.interval.load.decay());
        for body in &mut self.kicked {
            let mut state = self.block.get(body.lane);
            body.drift(&by, &mut state);
            self.block.set(body.lane, state);
        }
        self.asked = None;
    }

    /// B(s) at time `t`.
    fn kick(&mut self, t: f64, s: f64) {
        let wrench = match self.asked {
            Some((when, wrench)) if when == t => wrench,
            _ => {
                let Interval { load, inertial, .. } = &*self.interval;
                self.work.evaluations += 1;
                let wrench = load.wrench(t, inertial, &self.block).unwrap_or_default();
                self.asked = Some((t, wrench));
                wrench
            }
        };
        for body in &mut self.kicked {
            let mut state = self.block.get(body.lane);
            let wrench = wrench.get(body.lane);
            state.v_w += wrench.force_w * (body.inertial.inv_mass * s);
            body.stays_w += s * match body.turning {
                Turning::Momentum { .. } => wrench.tau_w,
                Turning::Velocity => body.inertial.angular_response(&state, wrench.tau_w),
            };
            self.block.set(body.lane, state);
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
    }

    fn state(&self) -> StateBlock {
        let decay = self.interval.load.decay();
        let mut states = self.block;
        let by = (self.ahead != 0.0).then(|| Passage::of(self.ahead, decay));
        for body in &self.kicked {
            let (mut body, mut state) = (body.clone(), states.get(body.lane));
            if let Some(by) = &by {
                body.drift(by, &mut state);
            }
            state.omega_w = body.omega_w(&state);
            states.set(body.lane, state);
        }
        let gone = Passage::of(self.now - self.set_out, decay);
        for (lane, coast) in self.coasting.iter() {
            states.set(*lane, coast.at(&gone));
        }
        states
    }

    fn work(&self) -> Work {
        self.work
    }

    fn boxed_clone(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }

    fn bytes(&self) -> usize {
        size_of_val(self) + size_of_val(self.kicked.as_slice())
    }
}

#[cfg(test)]
mod tests;
