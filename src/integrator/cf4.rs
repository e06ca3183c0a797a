//! The commutator-free Lie group method of order 4 built on the classical Runge-Kutta method: attitudes
//! by exponentials alone, world ω acting from the left; (x, v, ω) by the classical weights.
//!
//! ```text
//! q' = ½ (ω, 0) q        k_i = (v, a, α) at (t_i, Y_i)
//! Q1 = q                            Y1 = y
//! Q2 = exp(h/2 ω1) q                Y2 = y + h/2 k1
//! Q3 = exp(h/2 ω2) q                Y3 = y + h/2 k2
//! Q4 = exp(h (ω3 - ½ ω1)) Q2        Y4 = y + h k3
//! q' = exp(h/12 (-ω1 + 2 ω2 + 2 ω3 + 3 ω4)) exp(h/12 (3 ω1 + 2 ω2 + 2 ω3 - ω4)) q
//! y' = y + h/6 (k1 + 2 k2 + 2 k3 + k4)
//! ```
//!
//! Five exponentials and no commutator: the fourth stage starts from the second, and its two exponents
//! add up to h ω3, as the classical method has it. |q| = 1 by construction; a rotation at constant ω is
//! exact. With damping it is the integrating-factor form of rk4, ω_i being the decayed angular velocities.
//!
//! Celledoni, Marthinsen & Owren, Future Generation Computer Systems 19 (2003), 341-352.

use super::common::{DecayFactors, Rate, RateBlock, along, decayed};
use super::one_step::OneStep;
use super::scalar::{each, kept_unit, rates, turned};
use super::{Accepts, Cost, Damping, Interval, Kind, MethodInfo, Models};
use crate::body::{State, StateBlock};
use nalgebra::Vector3;

#[derive(Clone, Copy)]
pub struct Cf4;

const INFO: MethodInfo = MethodInfo {
    name: "cf4",
    engines: &[],
    kind: Kind::Fixed,
    order: 4,
    weak_orders: None,
    models: Models::Both,
    accepts: Accepts::Any,
    damping: Damping::Exact("integrating factor: exact by itself, order 4 with torques"),
    reversible: false,
    keeps_momentum: false,
    exact_free: false,
    preserves: "|q| by construction; rotation at constant ω exactly",
    cost: Cost {
        evaluations: Some(4),
        weight: 2.4,
    },
    citation: "Celledoni, Marthinsen & Owren, Commutator-free Lie group methods, FGCS 19 (2003), order 4 on the classical method; damping: Lawson 1967",
};

impl OneStep for Cf4 {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn step(&self, t: f64, h: f64, interval: &Interval, state: &mut StateBlock) {
        let half = 0.5 * h;
        let decay = DecayFactors::of(&interval.load, half);
        // E on the velocities, where they decay.
        let e = |y: State| decay.map_or(y, |e| decayed(y, e.linear, e.angular));
        let y1 = *state;
        let k1 = rates(t, interval, &y1);
        let y2 = each(interval, |i| {
            let (y, k) = (y1.get(i), k1.get(i));
            turned(y.omega_w * half, e(add(y, half, k)))
        });
        let k2 = rates(t + half, interval, &y2);
        let y3 = each(interval, |i| {
            let y = add(e(y1.get(i)), half, k2.get(i));
            turned(y2.get(i).omega_w * half, y)
        });
        let k3 = rates(t + half, interval, &y3);
        let y4 = each(interval, |i| {
            let y = add(e(e(y1.get(i))), h, e(k3.get(i)));
            let second = y2.get(i).q_wp;
            let omega = y3.get(i).omega_w - y1.get(i).omega_w * 0.5;
            turned(omega * h, State { q_wp: second, ..y })
        });
        let k4 = rates(t + h, interval, &y4);
        *state = each(interval, |i| {
            let k = [&k1, &k2, &k3, &k4].map(|k: &RateBlock| k.get(i));
            let omega = [&y1, &y2, &y3, &y4].map(|y: &StateBlock| y.get(i).omega_w);
            turned_twice(h, omega, weighted(h, e, y1.get(i), k))
        });
    }
}

/// `y + h k` in (x, v, ω); the attitude stays.
fn add(y: State, h: f64, k: Rate) -> State {
    let q_wp = y.q_wp;
    State {
        q_wp,
        ..along(y, h, k)
    }
}

/// `E² y + h/6 (E² k1 + 2 E (k2 + k3) + k4)`.
fn weighted(h: f64, e: impl Fn(State) -> State, y: State, [k1, k2, k3, k4]: [Rate; 4]) -> State {
    let y = e(add(y, h / 6.0, k1));
    let y = e(add(add(y, h / 3.0, k2), h / 3.0, k3));
    add(y, h / 6.0, k4)
}

/// The two exponentials of the last stage.
fn turned_twice(h: f64, [w1, w2, w3, w4]: [Vector3<f64>; 4], y: State) -> State {
    let both = (w2 + w3) * 2.0;
    let (first, second) = (w1 * 3.0 + both - w4, both - w1 + w4 * 3.0);
    kept_unit(turned(second * (h / 12.0), turned(first * (h / 12.0), y)))
}

#[cfg(test)]
mod tests {
    use super::super::tests::{advance, angle, block, free_triaxial, gyroscopic, spinning};
    use super::*;
    use crate::effect::Load;
    use crate::integrator::one_step::Stepped;
    use crate::math::exponential;
    use nalgebra::UnitQuaternion;

    #[test]
    fn a_rotation_at_constant_omega_is_exact_however_far_a_step_turns() {
        let omega = Vector3::new(3.0, -4.0, 12.0);
        let bodies = block(
            Vector3::new(0.3, 0.5, 0.6),
            spinning(UnitQuaternion::identity(), omega),
        );
        // 13 rad a step.
        let end = advance(&Stepped(Cf4), &Load::default(), &bodies, 10.0, 10);
        // A few roundings of phases of up to 13 rad, ten times.
        assert!(angle(end.q_wp, exponential(omega * 10.0)) < 1e-13);
    }

    #[test]
    fn the_attitude_is_one_without_being_made_one() {
        let (bodies, reference) = free_triaxial();
        let n = 10_000;
        let end = advance(&Stepped(Cf4), &gyroscopic(), &bodies, 10.0, n);
        // 20,000 products, each rounded to about 1e-16, at worst all the same way.
        let off = end.q_wp.norm() - 1.0;
        assert!(off.abs() < 2e-16 * f64::from(n), "{off:e}");
        // (h |ω|)⁴ = 1e-11 is far below what is left of 10,000 roundings.
        assert!(angle(end.q_wp, reference) < 2e-12);
    }
}
