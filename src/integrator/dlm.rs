//! The splitting of Dullweber, Leimkuhler and McLachlan: kinetic energy in three parts `m_i²/2I_i`, each of
//! which turns the body about one principal axis; kicks at both ends.
//!
//! ```text
//! L += h/2 τ(t, x, q)    R1(h/2) R2(h/2) R3(h) R2(h/2) R1(h/2)    L += h/2 τ(t + h, x', q')
//! R_i(h): q ← q (e_i s, c), tan of its angle = θ/2 + (θ/2)³/3, θ = h m_i/I_i; m turns back by it
//! ```
//!
//! Order 2, explicit, reversible; m = Rᵀ L, and L itself is kept in the world.
//! A turn about an axis by any odd function of `h m_i/I_i` is as symplectic as by θ/2 itself, and only the
//! accuracy differs. The Cayley form (θ/2 alone) makes errors of the order of the splitting's own; with
//! the cube the error is that of exact turns, without a sine, so that eight bodies are turned at once.
//! With damping the turns are those of `s = (1 - e^{-ch})/c` and L decays exactly.
//!
//! Dullweber, Leimkuhler & McLachlan, J. Chem. Phys. 107 (1997) 5840; Hairer, Lubich & Wanner, Geometric
//! Numerical Integration, VII.5.

use super::coast::{Passage, omega_w};
use super::{
    Accepts, Cost, Damping, Interval, Kind, Method, MethodInfo, Models, Step, Stepper, Work,
};
use crate::body::{InertialBlock, LANES, StateBlock, Vector3Lanes};
use crate::effect::WrenchBlock;
use crate::math::turned;
use multiversion::multiversion;
use nalgebra::{Quaternion, Vector3};
use std::sync::Arc;

pub struct Dlm;

const INFO: MethodInfo = MethodInfo {
    name: "dlm",
    engines: &[],
    kind: Kind::Fixed,
    order: 2,
    weak_orders: None,
    accepts: Accepts::Place,
    models: Models::Gyroscopic,
    damping: Damping::Exact("exact on L, order 2 in attitude"),
    reversible: true,
    keeps_momentum: true,
    exact_free: false,
    preserves: "angular momentum to rounding; symplectic: energy stays within bounds",
    cost: Cost {
        evaluations: Some(1),
        weight: 0.67,
    },
    citation: "Dullweber, Leimkuhler & McLachlan, J. Chem. Phys. 107 (1997) 5840",
};

impl Method for Dlm {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn set_out(&self, interval: Interval, t: f64, state: &StateBlock) -> Box<dyn Stepper> {
        let mut momentum_w = Vector3Lanes::default();
        for lane in interval.lanes() {
            let body = interval.inertial.get(lane);
            momentum_w.set(lane, body.momentum_w(&state.get(lane)));
        }
        Box::new(Run {
            asked: interval.load.wrench(t, &interval.inertial, state),
            interval: interval.into(),
            momentum_w,
            block: *state,
            steps: 0,
        })
    }
}

#[derive(Clone)]
struct Run {
    interval: Arc<Interval>,
    /// World, kg m²/s.
    momentum_w: Vector3Lanes,
    /// ω is out of date.
    block: StateBlock,
    /// Forces here and now.
    asked: Option<WrenchBlock>,
    steps: u64,
}

impl Run {
    fn step(&mut self, step: &Step) {
        let interval = Arc::clone(&self.interval);
        let Interval { load, inertial, .. } = &*interval;
        let by = Passage::of(step.h, load.decay());
        self.kick(0.5 * step.h);
        drift(&by, inertial, &mut self.momentum_w, &mut self.block);
        self.asked = load.wrench(step.to, inertial, &self.block);
        self.kick(0.5 * step.h);
        self.steps += 1;
    }

    fn kick(&mut self, s: f64) {
        if let Some(wrench) = &self.asked {
            let inertial = &self.interval.inertial;
            kick(s, wrench, inertial, &mut self.momentum_w, &mut self.block);
        }
    }
}

/// `v += s F/m`, `L += s τ`.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn kick(
    s: f64,
    wrench: &WrenchBlock,
    inertial: &InertialBlock,
    momentum_w: &mut Vector3Lanes,
    block: &mut StateBlock,
) {
    for lane in 0..LANES {
        let (wrench, mut state) = (wrench.get(lane), block.get(lane));
        state.v_w += wrench.force_w * (inertial.get(lane).inv_mass * s);
        block.set(lane, state);
        momentum_w.add(lane, wrench.tau_w * s);
    }
}

/// Place and velocity exactly, the attitude by the five turns.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn drift(
    by: &Passage,
    inertial: &InertialBlock,
    momentum_w: &mut Vector3Lanes,
    block: &mut StateBlock,
) {
    for lane in 0..LANES {
        let (mut state, l) = (block.get(lane), momentum_w.get(lane));
        let rates = inertial.get(lane).inv_moments * by.angular.time;
        state = by.translated(state);
        state.q_wp = five_turns(rates, state.q_wp, l);
        block.set(lane, state);
        momentum_w.set(lane, l * by.angular.factor);
    }
}

/// `rates` = h/I.
#[inline(always)]
fn five_turns(rates: Vector3<f64>, q: Quaternion<f64>, l: Vector3<f64>) -> Quaternion<f64> {
    let (mut q, mut m) = (q, turned(q.conjugate(), l));
    let half = rates * 0.5;
    turn::<0, 1, 2>(half.x, &mut q, &mut m);
    turn::<1, 2, 0>(half.y, &mut q, &mut m);
    turn::<2, 0, 1>(rates.z, &mut q, &mut m);
    turn::<1, 2, 0>(half.y, &mut q, &mut m);
    turn::<0, 1, 2>(half.x, &mut q, &mut m);
    q * (1.0 / q.norm())
}

/// R_i: q, not yet of unit length, about body axis I; m back by the same angle.
#[inline(always)]
fn turn<const I: usize, const J: usize, const K: usize>(
    rate: f64,
    q: &mut Quaternion<f64>,
    m: &mut Vector3<f64>,
) {
    let half = 0.5 * rate * m[I];
    let tan = half + half * half * half * (1.0 / 3.0);
    // cos and sin of the whole angle, by the tangent of its half.
    let scale = 1.0 / (1.0 + tan * tan);
    let (cos, sin) = ((1.0 - tan * tan) * scale, 2.0 * tan * scale);
    (m[J], m[K]) = (cos * m[J] + sin * m[K], cos * m[K] - sin * m[J]);
    let (i, j, k, w) = (q.coords[I], q.coords[J], q.coords[K], q.w);
    // q (e_I tan, 1).
    q.coords[I] = i + tan * w;
    q.coords[J] = j + tan * k;
    q.coords[K] = k - tan * j;
    q.coords.w = w - tan * i;
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
        let mut states = self.block;
        for lane in self.interval.lanes() {
            let mut state = states.get(lane);
            let body = self.interval.inertial.get(lane);
            state.omega_w = omega_w(&body, state.q_wp, self.momentum_w.get(lane));
            states.set(lane, state);
        }
        states
    }

    fn work(&self) -> Work {
        Work {
            steps: self.steps,
            evaluations: self.steps + u64::from(self.asked.is_some()),
        }
    }

    fn boxed_clone(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effect::Load;
    use crate::integrator::tests::{advance, angle, free_triaxial, gyroscopic, heavy_top};

    #[test]
    fn turns_are_as_good_as_exact_ones() {
        // Errors at t = 10 in 1,000 steps with turns by the exact angle; by Cayley's form they are
        // 4.2e-4 and 6.3e-4.
        let (free, reference) = free_triaxial();
        let end = advance(&Dlm, &gyroscopic(), &free, 10.0, 1_000);
        assert!((angle(end.q_wp, reference) / 1.432e-4 - 1.0).abs() < 1e-3);
        let (top, load, reference) = heavy_top();
        let end = advance(&Dlm, &load, &top, 10.0, 1_000);
        assert!((angle(end.q_wp, reference) / 3.459e-5 - 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_top_keeps_its_energy_within_bounds_and_its_momentum_about_the_vertical_exactly() {
        let (bodies, load, _) = heavy_top();
        let body = bodies.0.get(0);
        let energy = |s: &crate::body::State| {
            0.5 * s.omega_w.dot(&body.momentum_w(s)) + s.to_world(body.centre_p).z
        };
        let start = bodies.1.get(0);
        let (e, l_z) = (energy(&start), body.momentum_w(&start).z);
        // 4,000 s are a thousand turns; the excursion of a step of 0.01 s is 1e-5 of the energy, and a
        // drift that begins at this size would be ten thousandfold by the end.
        for t in [10.0, 4_000.0] {
            let end = advance(&Dlm, &load, &bodies, t, (t * 100.0) as u32);
            let gap = (energy(&end) / e - 1.0).abs();
            assert!(gap < 3e-5, "{t}: {gap}");
            // No kick has a component along z; ω and back round.
            assert!((body.momentum_w(&end).z - l_z).abs() < 4e-15);
        }
    }

    #[test]
    fn the_tutorials_model_is_refused_with_the_reason() {
        let (bodies, _) = free_triaxial();
        let why = INFO.refuses(&Load::default(), &bodies.0);
        assert!(why.unwrap().0.contains("gyroscopic = true"));
    }
}
