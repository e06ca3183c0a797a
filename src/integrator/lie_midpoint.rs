//! The explicit midpoint rule on the rotation group: attitudes by the exponential map, never by adding
//! quaternions.
//!
//! ```text
//! half:  v½ = v + h/2 a(t, y)         ω½ = ω + h/2 α(t, y)         q½ = exp(h/2 ω) q      x½ = x + h/2 v
//! whole: v' = v + h a(t + h/2, y½)    ω' = ω + h α(t + h/2, y½)    q' = exp(h ω½) q       x' = x + h v½
//! ```
//!
//! Order 2; |q| = 1 by construction. With damping it is the integrating-factor form: with
//! `E = e^{-c h/2}`, `ω½ = E (ω + h/2 α)` and `ω' = E² ω + h E α½`, likewise v.
//! A rotation at constant ω is exact, however far a step turns.
//!
//! Hairer, Lubich & Wanner, Geometric Numerical Integration, IV.8 (Runge-Kutta-Munthe-Kaas, s = 2).

use super::common::{Acceleration, DecayFactors, Forces, damp, each_lane, with_forces};
use super::one_step::OneStep;
use super::scalar::kept_unit;
use super::{Accepts, Cost, Damping, Interval, Kind, MethodInfo, Models};
use crate::body::{LANES, QuaternionLanes, State, StateBlock};
use crate::math::{exponential, exponential_by_series, is_short};
use multiversion::multiversion;
use nalgebra::Quaternion;

#[derive(Clone, Copy)]
pub struct LieMidpoint;

const INFO: MethodInfo = MethodInfo {
    name: "lie-midpoint",
    engines: &[],
    kind: Kind::Fixed,
    order: 2,
    weak_orders: None,
    accepts: Accepts::Any,
    models: Models::Both,
    damping: Damping::Exact("integrating factor: exact by itself, order 2 with torques"),
    reversible: false,
    keeps_momentum: false,
    exact_free: false,
    preserves: "|q| by construction; rotation at constant ω exactly",
    cost: Cost {
        evaluations: Some(2),
        weight: 0.53,
    },
    citation: "Hairer, Lubich & Wanner, Geometric Numerical Integration, IV.8; damping: Lawson 1967",
};

impl OneStep for LieMidpoint {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn step(&self, t: f64, h: f64, interval: &Interval, state: &mut StateBlock) {
        let (load, inertial) = (&interval.load, &interval.inertial);
        let half = 0.5 * h;
        let decay = DecayFactors::of(load, half);
        let start = *state;
        let mut middle = start;
        let mut room = None;
        let wrench = load.wrench_in(&mut room, t, inertial, &start);
        with_forces!(load, wrench, |forces| advance(
            half,
            decay,
            forces,
            interval,
            &start,
            &mut middle
        ));
        let wrench = load.wrench_in(&mut room, t + half, inertial, &middle);
        // E² y + h E k = E (E y + h k).
        if let Some(decay) = load.decay() {
            damp(decay, half, state);
        }
        with_forces!(load, wrench, |forces| advance(
            h, decay, forces, interval, &middle, state
        ));
    }
}

/// Takes `state` `h` seconds on with the velocities and accelerations of `at`, then E.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn advance<F: Forces>(
    h: f64,
    decay: Option<DecayFactors>,
    forces: F,
    interval: &Interval,
    at: &StateBlock,
    state: &mut StateBlock,
) {
    let turns = turns(h, interval.bodies, at);
    each_lane!(interval.bodies, |lane| {
        let at = at.get(lane);
        let acceleration = forces.acceleration(lane, &interval.inertial.get(lane), &at);
        let moved = kernel(h, acceleration, &at, turns.get(lane), state.get(lane));
        let moved = match decay {
            None => moved,
            Some(e) => e.on(moved),
        };
        state.set(lane, moved);
    });
}

/// `exp(h ω)`: of all lanes by the series, then again of those that turn too far for it. A lane's
/// bits depend on its own turn alone.
#[inline(always)]
fn turns(h: f64, bodies: usize, at: &StateBlock) -> QuaternionLanes {
    let mut turns = QuaternionLanes::default();
    let mut short = true;
    each_lane!(bodies, |lane| {
        let v = at.get(lane).omega_w * h;
        short &= is_short(v);
        turns.set(lane, exponential_by_series(v));
    });
    if !short {
        for lane in 0..LANES {
            let v = at.get(lane).omega_w * h;
            if !is_short(v) {
                turns.set(lane, exponential(v));
            }
        }
    }
    turns
}

#[inline(always)]
fn kernel(
    h: f64,
    acceleration: Acceleration,
    at: &State,
    turn: Quaternion<f64>,
    s: State,
) -> State {
    kept_unit(State {
        x_w: s.x_w + at.v_w * h,
        v_w: s.v_w + acceleration.a_w * h,
        q_wp: turn * s.q_wp,
        omega_w: s.omega_w + acceleration.alpha_w * h,
    })
}

#[cfg(test)]
mod tests {
    use super::super::tests::{advance, advance_block, angle, block, interval, spinning, steps};
    use super::*;
    use crate::body::InertialBlock;
    use crate::effect::Load;
    use crate::integrator::one_step::Stepped;
    use nalgebra::{UnitQuaternion, Vector3};

    #[test]
    fn bodies_that_turn_far_and_near_side_by_side_are_exact_with_the_bits_they_have_alone() {
        let load = Load::default();
        // 0.13 to 13 rad a step: some by the series, some not.
        let omega = |lane: usize| Vector3::new(3.0, -4.0, 12.0) * (0.01 + 0.14 * lane as f64);
        let alone = |lane: usize| {
            let start = spinning(UnitQuaternion::identity(), omega(lane));
            block(Vector3::new(0.3, 0.5, 0.6), start)
        };
        let (mut inertial, mut states) = (InertialBlock::default(), StateBlock::default());
        for lane in 0..LANES {
            inertial.set(lane, alone(lane).0.get(0));
            states.set(lane, alone(lane).1.get(0));
        }
        let all = Interval {
            bodies: LANES,
            ..interval(&load, inertial, 10.0)
        };
        let method = Stepped(LieMidpoint);
        let states = advance_block(&method, all, &states, &steps(10.0, 10));
        for lane in 0..LANES {
            let lone = advance(&method, &load, &alone(lane), 10.0, 10);
            assert_eq!(states.get(lane), lone, "lane {lane}");
            // A few roundings of phases of up to 13 rad, ten times.
            assert!(angle(lone.q_wp, exponential(omega(lane) * 10.0)) < 1e-13);
        }
    }
}
