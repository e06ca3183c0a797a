//! The classical Runge-Kutta method of order 4 on (x, v, q, ω), q normalised after the step:
//!
//! ```text
//! y' = f(t, y):   x' = v   v' = m⁻¹ F   q' = ½ (ω, 0) q   ω' = I_w⁻¹ τ
//! k1 = f(t, y)   k2 = f(t + h/2, y + h/2 k1)   k3 = f(t + h/2, y + h/2 k2)   k4 = f(t + h, y + h k3)
//! y += h/6 (k1 + 2 k2 + 2 k3 + k4)
//! ```
//!
//! With damping it is the integrating-factor (Lawson) form: with `E = e^{-c h/2}` on ω (and with
//! k on v) the stages start from `E y` and `E² y`, so that the decay of a velocity by itself is exact for any c h
//! (beside a torque, accuracy needs c h well below 1, as it needs ω h):
//!
//! ```text
//! Y2 = E (y + h/2 k1)   Y3 = E y + h/2 k2   Y4 = E² y + h E k3
//! y' = E² y + h/6 (E² k1 + 2 E (k2 + k3) + k4)
//! ```
//!
//! Where nothing is applied, all four stages of a lane are one kernel: no forces to ask for between
//! them. Stages are brought to unit q before f is taken there: the same method on the field f(y/|q|),
//! whose solutions are the same and of which |q| is an invariant. It keeps order 4, and the error is
//! several times smaller than with the rates of a q that is no rotation.
//!
//! Hairer, Nørsett & Wanner, Solving ODEs I, II.1; Lawson, SIAM J. Numer. Anal. 4 (1967).
//! Neither energy nor momentum is kept exactly: both drift as h⁴.

use super::common::{
    Forces, HalfDecay, Rate, RateBlock, along, decayed, normalised, rate, with_forces,
};
use super::one_step::OneStep;
use super::{Accepts, Cost, Damping, Interval, Kind, MethodInfo, Models};
use crate::body::{InertialBlock, LANES, State, StateBlock};
use multiversion::multiversion;

#[derive(Clone, Copy)]
pub struct Rk4;

const INFO: MethodInfo = MethodInfo {
    name: "rk4",
    engines: &[],
    kind: Kind::Fixed,
    order: 4,
    accepts: Accepts::Any,
    models: Models::Both,
    damping: Damping::Exact("integrating factor: exact by itself, order 4 with torques"),
    reversible: false,
    keeps_momentum: false,
    exact_free: false,
    preserves: "nothing exactly; energy and momentum drift as h⁴",
    cost: Cost {
        evaluations: 4,
        weight: 1.0,
    },
    citation: "Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, II.1; damping: Lawson 1967",
};

impl OneStep for Rk4 {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn step(&self, t: f64, h: f64, interval: &Interval, state: &mut StateBlock) {
        let (load, inertial) = (&interval.load, &interval.inertial);
        if !load.applies() && load.decay().is_none() {
            with_forces!(load, None, |forces| coast(h, forces, inertial, state));
            return;
        }
        let half = 0.5 * h;
        let start = *state;
        let decay = HalfDecay::of(load, half);
        let rate = |t: f64, at: &StateBlock| {
            let mut k = RateBlock::default();
            let wrench = load.wrench(t, inertial, at);
            with_forces!(load, wrench.as_ref(), |forces| rates(
                forces, inertial, at, &mut k
            ));
            k
        };
        let stage = |h: f64, k: &RateBlock, when: Stage| {
            let mut y = StateBlock::default();
            match decay {
                None => advance(h, &start, k, &mut y),
                Some(e) => advance_decaying(h, e, when, &start, k, &mut y),
            }
            y
        };
        let k1 = rate(t, &start);
        let k2 = rate(t + half, &stage(half, &k1, Stage::Second));
        let k3 = rate(t + half, &stage(half, &k2, Stage::Third));
        let k4 = rate(t + h, &stage(h, &k3, Stage::Fourth));
        match decay {
            None => combine(h, &start, [&k1, &k2, &k3, &k4], state),
            Some(e) => combine_decaying(h, e, &start, [&k1, &k2, &k3, &k4], state),
        }
    }
}

#[derive(Clone, Copy)]
enum Stage {
    Second,
    Third,
    Fourth,
}

/// A whole step of bodies on which nothing is applied.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn coast<F: Forces>(h: f64, forces: F, inertial: &InertialBlock, state: &mut StateBlock) {
    for lane in 0..LANES {
        let (body, y) = (inertial.get(lane), state.get(lane));
        let k1 = rate(lane, forces, &body, y);
        let k2 = rate(lane, forces, &body, normalised(along(y, 0.5 * h, k1)));
        let k3 = rate(lane, forces, &body, normalised(along(y, 0.5 * h, k2)));
        let k4 = rate(lane, forces, &body, normalised(along(y, h, k3)));
        state.set(lane, normalised(weighted(h, y, [k1, k2, k3, k4])));
    }
}

/// `y + h/6 (k1 + 2 k2 + 2 k3 + k4)`.
#[inline(always)]
fn weighted(h: f64, y: State, [k1, k2, k3, k4]: [Rate; 4]) -> State {
    along(
        along(along(along(y, h / 6.0, k1), h / 3.0, k2), h / 3.0, k3),
        h / 6.0,
        k4,
    )
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn rates<F: Forces>(forces: F, inertial: &InertialBlock, at: &StateBlock, out: &mut RateBlock) {
    for lane in 0..LANES {
        out.set(lane, rate(lane, forces, &inertial.get(lane), at.get(lane)));
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn advance(h: f64, start: &StateBlock, k: &RateBlock, out: &mut StateBlock) {
    for lane in 0..LANES {
        out.set(lane, normalised(along(start.get(lane), h, k.get(lane))));
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn combine(h: f64, start: &StateBlock, k: [&RateBlock; 4], out: &mut StateBlock) {
    for lane in 0..LANES {
        let k = [
            k[0].get(lane),
            k[1].get(lane),
            k[2].get(lane),
            k[3].get(lane),
        ];
        out.set(lane, normalised(weighted(h, start.get(lane), k)));
    }
}

fn advance_decaying(
    h: f64,
    e: HalfDecay,
    when: Stage,
    start: &StateBlock,
    k: &RateBlock,
    out: &mut StateBlock,
) {
    let (l, a) = (e.linear, e.angular);
    for lane in 0..LANES {
        let (y, k) = (start.get(lane), k.get(lane));
        let next = match when {
            Stage::Second => decayed(along(y, h, k), l, a),
            Stage::Third => along(decayed(y, l, a), h, k),
            Stage::Fourth => along(decayed(y, l * l, a * a), h, decayed(k, l, a)),
        };
        out.set(lane, normalised(next));
    }
}

fn combine_decaying(
    h: f64,
    e: HalfDecay,
    start: &StateBlock,
    k: [&RateBlock; 4],
    out: &mut StateBlock,
) {
    let (l, a) = (e.linear, e.angular);
    for lane in 0..LANES {
        let k = [
            decayed(k[0].get(lane), l * l, a * a),
            decayed(k[1].get(lane), l, a),
            decayed(k[2].get(lane), l, a),
            k[3].get(lane),
        ];
        let y = decayed(start.get(lane), l * l, a * a);
        out.set(lane, normalised(weighted(h, y, k)));
    }
}
