//! MuJoCo's RK4 since 4.0: the classical Runge-Kutta method as a Runge-Kutta-Munthe-Kaas method, ω in body
//! axes, attitudes by exponentials from the right.
//!
//! ```text
//! q' = ½ q (ω, 0)        ω' = I⁻¹ (Rᵀ τ - ω × I ω)        principal axes
//! k1 = ω    u_i = h a_i k_{i-1}    Q_i = q exp(u_i)    Ω_i = ω + h a_i ω'_{i-1}    a = ½, ½, 1
//! k_i = dexp⁻¹(Ω_i) = Ω_i + ½ u × Ω_i + g u × (u × Ω_i)    g = (1 - |u|/2 cot |u|/2) / |u|²,  u = u_i
//! q ← q exp(h/6 (k1 + 2 k2 + 2 k3 + k4))    ω += h/6 (ω'1 + 2 ω'2 + 2 ω'3 + ω'4)    x, v likewise
//! ```
//!
//! Order 4. Up to version 3.17 MuJoCo took k_i = Ω_i, the mean of the stages' angular velocities, which is
//! order 2 in attitude.
//!
//! MuJoCo damps a free joint by torques, `-d_i ω_i` about each axis, inside the stages; the decay at rate c
//! is d_i = c I_i (and `-k m v`). So the decay of a velocity by itself is not exact: it is order 4 as
//! well, and c h must stay below 2.78.
//! Without the gyroscopic term, which MuJoCo cannot leave out, ω' = I⁻¹ Rᵀ τ.
//!
//! Munthe-Kaas, Applied Numerical Mathematics 29 (1999) 115-127; Hairer, Lubich & Wanner, Geometric
//! Numerical Integration, IV.8. MuJoCo 4.0: `mj_RungeKutta` (engine_forward.c).

use super::one_step::OneStep;
use super::scalar::each;
use super::{Accepts, Cost, Damping, Interval, Kind, MethodInfo, Models};
use crate::body::{Inertial, LANES, State, StateBlock};
use crate::effect::{Load, Wrench};
use crate::math::exponential;
use nalgebra::Vector3;

#[derive(Clone, Copy)]
pub struct Rkmk4;

const INFO: MethodInfo = MethodInfo {
    name: "mujoco-rk4",
    engines: &["mujoco-rk4"],
    kind: Kind::Fixed,
    order: 4,
    weak_orders: None,
    models: Models::Both,
    accepts: Accepts::Any,
    damping: Damping::Engine("torques -c I ω and forces -k m v inside the stages: order 4"),
    reversible: false,
    keeps_momentum: false,
    exact_free: false,
    preserves: "|q| by construction; energy and momentum drift as h⁴",
    cost: Cost {
        evaluations: Some(4),
        weight: 3.0,
    },
    citation: "Munthe-Kaas, Appl. Numer. Math. 29 (1999); MuJoCo 4.0, mj_RungeKutta in engine_forward.c",
};

/// How far into the step a stage lies, and the weight of its rates.
const STAGES: [(f64, f64); 4] = [
    (0.0, 1.0 / 6.0),
    (0.5, 1.0 / 3.0),
    (0.5, 1.0 / 3.0),
    (1.0, 1.0 / 6.0),
];

/// A body with ω in principal axes.
#[derive(Clone, Copy)]
struct Start {
    s: State,
    omega_p: Vector3<f64>,
}

/// Rates of change: x', v', that of the rotation vector u with `Q = q exp(u)`, ω'.
#[derive(Clone, Copy, Default)]
struct Rate {
    v_w: Vector3<f64>,
    a_w: Vector3<f64>,
    k_p: Vector3<f64>,
    alpha_p: Vector3<f64>,
}

impl OneStep for Rkmk4 {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn step(&self, t: f64, h: f64, interval: &Interval, state: &mut StateBlock) {
        let (load, inertial) = (&interval.load, &interval.inertial);
        let start: [Start; LANES] = std::array::from_fn(|lane| Start::new(state.get(lane)));
        let mut last = [Rate::default(); LANES];
        let mut mean = [Rate::default(); LANES];
        for (fraction, weight) in STAGES {
            let ahead = h * fraction;
            let at = each(interval, |lane| start[lane].along(ahead, &last[lane]).s);
            let wrench = load.wrench(t + ahead, inertial, &at);
            for lane in interval.lanes() {
                let wrench = wrench
                    .as_ref()
                    .map_or_else(Wrench::default, |w| w.get(lane));
                let stage = start[lane].along(ahead, &last[lane]);
                let u = last[lane].k_p * ahead;
                last[lane] = rate(load, &inertial.get(lane), &stage, u, &wrench);
                mean[lane] = mean[lane].plus(weight, &last[lane]);
            }
        }
        *state = each(interval, |lane| start[lane].along(h, &mean[lane]).s);
    }
}

impl Start {
    fn new(s: State) -> Self {
        let omega_p = s.to_principal(s.omega_w);
        Self { s, omega_p }
    }

    /// `h` seconds on, at these rates.
    fn along(&self, h: f64, k: &Rate) -> Self {
        let omega_p = self.omega_p + k.alpha_p * h;
        let q = self.s.q_wp * exponential(k.k_p * h);
        let turned = State {
            x_w: self.s.x_w + k.v_w * h,
            v_w: self.s.v_w + k.a_w * h,
            q_wp: q * (1.0 / q.norm()),
            omega_w: Vector3::zeros(),
        };
        let omega_w = turned.to_world(omega_p);
        Self {
            s: State { omega_w, ..turned },
            omega_p,
        }
    }
}

impl Rate {
    fn plus(&self, weight: f64, k: &Self) -> Self {
        Self {
            v_w: self.v_w + k.v_w * weight,
            a_w: self.a_w + k.a_w * weight,
            k_p: self.k_p + k.k_p * weight,
            alpha_p: self.alpha_p + k.alpha_p * weight,
        }
    }
}

/// The rates in a stage that lies the rotation `u` (principal axes) from the start.
fn rate(load: &Load, body: &Inertial, stage: &Start, u: Vector3<f64>, wrench: &Wrench) -> Rate {
    let (s, omega) = (&stage.s, stage.omega_p);
    let (linear, angular) = match load.decay() {
        None => (0.0, 0.0),
        Some(decay) => (decay.linear_rate(), decay.angular_rate()),
    };
    let mut torque = s.to_principal(wrench.tau_w);
    if load.gyroscopic() {
        torque -= omega.cross(&body.moments.component_mul(&omega));
    }
    Rate {
        v_w: s.v_w,
        a_w: wrench.force_w * body.inv_mass - s.v_w * linear,
        k_p: rotation_rate(u, omega),
        alpha_p: body.inv_moments.component_mul(&torque) - omega * angular,
    }
}

/// `u'` of `Q = q exp(u)` that turns at ω in its own axes: the inverse of dexp.
fn rotation_rate(u: Vector3<f64>, omega: Vector3<f64>) -> Vector3<f64> {
    let square = u.norm_squared();
    // Below, two terms of the series: the next is u⁴/30240 of the term, 3e-9 of a term that is 1e-5.
    let g = if square > 1e-4 {
        let half = 0.5 * square.sqrt();
        (1.0 - half / libm::tan(half)) / square
    } else {
        1.0 / 12.0 + square / 720.0
    };
    let cross = u.cross(&omega);
    omega + cross * 0.5 + u.cross(&cross) * g
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_of_the_rotation_vector_turns_the_attitude_at_omega() {
        let (axis, omega) = (Vector3::new(0.48, -0.6, 0.64), Vector3::new(0.3, 1.1, -0.7));
        // On both sides of where the series ends, and up to most of a turn.
        for angle in [0.0, 1e-5, 0.009_9, 0.010_1, 0.5, 3.0, 5.5] {
            let u = axis * angle;
            let k = rotation_rate(u, omega);
            let h = 1e-5;
            // exp(u + h u') = exp(u) exp(h ω), by a central difference.
            let moved = |t: f64| exponential(u).conjugate() * exponential(u + k * t);
            let rate = (moved(h) - moved(-h)).imag() / h;
            // h² |u'|³ ≈ 1e-8 at the last, where |u'| is 5, and rounding, 1e-16 / h.
            assert!((rate - omega).norm() < 1e-8, "{angle}: {rate}");
        }
    }
}
