//! Bullet's rigid body: the gyroscopic term implicit, by one Newton step in body axes. In principal axes
//!
//! ```text
//! f(ω') = I (ω' - ω) + h ω' × I ω' = 0       ω' ← ω - J⁻¹ f(ω),  f(ω) = h ω × I ω
//! J = I + h ([ω]× I - [I ω]×)
//! ```
//!
//! The step around it:
//!
//! ```text
//! v *= e^{-k h}    ω *= e^{-c h}                    damping comes first
//! ω += h I_w⁻¹ τ + (ω' - ω)                         both of the damped ω, the attitude of the start
//! v += h m⁻¹ F     x += h v     q ← exp(h ω) q
//! ```
//!
//! Order 1. Energy and momentum are lost, the more the larger h ω is: of a wing nut at 10 rad/s and 60 Hz a
//! tenth of the energy is left after a minute (`tests/engines.rs`), while it flips about as often as it should. A Newton step that divides by
//! zero leaves a state that is not finite, which ends a run.
//!
//! Bullet's damping is the part d of a velocity lost a second, `(1 - d)^h`: exact, d = 1 - e^{-c}. Left out:
//! the bound |ω| h ≤ π/4 on how far a step turns a body. Bullet carries a matrix for the attitude, and where
//! it is built so, f32; here it is a quaternion of f64.
//!
//! Catto, Numerical Methods (GDC 2015); Bullet 3.25: `computeGyroscopicImpulseImplicit_Body`
//! (btRigidBody.cpp), `integrateTransform` (btTransformUtil.h).

use super::common::{decayed, normalised};
use super::one_step::OneStep;
use super::scalar::{applied, each, turned};
use super::{Accepts, Cost, Damping, Interval, Kind, MethodInfo, Models};
use crate::body::{Inertial, State, StateBlock};
use nalgebra::{Matrix3, Vector3};

#[derive(Clone, Copy)]
pub struct Bullet;

const INFO: MethodInfo = MethodInfo {
    name: "bullet",
    engines: &["bullet"],
    kind: Kind::Fixed,
    order: 1,
    weak_orders: None,
    models: Models::Both,
    accepts: Accepts::Any,
    damping: Damping::Exact("before the step, exact factor"),
    reversible: false,
    keeps_momentum: false,
    exact_free: false,
    preserves: "nothing; a free body loses energy and momentum",
    cost: Cost {
        evaluations: Some(1),
        weight: 0.58,
    },
    citation: "Catto, Numerical Methods, GDC 2015; Bullet 3.25, computeGyroscopicImpulseImplicit_Body in btRigidBody.cpp",
};

impl OneStep for Bullet {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn step(&self, t: f64, h: f64, interval: &Interval, state: &mut StateBlock) {
        let (load, inertial) = (&interval.load, &interval.inertial);
        let wrench = load.wrench(t, inertial, state);
        *state = each(interval, |lane| {
            let (body, mut s) = (inertial.get(lane), state.get(lane));
            if let Some(decay) = load.decay() {
                s = decayed(s, decay.linear_factor(h), decay.angular_factor(h));
            }
            let push = applied(wrench.as_ref(), lane, &body, &s);
            let gyroscopic = match load.gyroscopic() {
                true => newton_step(h, &body, &s),
                false => Vector3::zeros(),
            };
            s.omega_w += push.alpha_w * h + gyroscopic;
            s.v_w += push.a_w * h;
            s.x_w += s.v_w * h;
            normalised(turned(s.omega_w * h, s))
        });
    }
}

/// `ω' - ω`, world.
fn newton_step(h: f64, body: &Inertial, s: &State) -> Vector3<f64> {
    let omega_p = s.to_principal(s.omega_w);
    let momentum = body.moments.component_mul(&omega_p);
    let inertia = Matrix3::from_diagonal(&body.moments);
    let twist = omega_p.cross_matrix() * inertia - momentum.cross_matrix();
    let change = solved(&(inertia + twist * h), omega_p.cross(&momentum) * -h);
    s.to_world(change)
}

/// `J x = b` by Cramer's rule, as Bullet does it.
fn solved(j: &Matrix3<f64>, b: Vector3<f64>) -> Vector3<f64> {
    let (c0, c1, c2) = (
        j.column(0).into_owned(),
        j.column(1).into_owned(),
        j.column(2).into_owned(),
    );
    let determinant = c0.dot(&c1.cross(&c2));
    Vector3::new(
        b.dot(&c1.cross(&c2)),
        c0.dot(&b.cross(&c2)),
        c0.dot(&c1.cross(&b)),
    ) / determinant
}
