//! The tutorial's step, written three more times: what the crate's is compared with.
//!
//! ```text
//! α = R I⁻¹ Rᵀ τ    ω += α h    q += ½ h (ω, 0) q, normalised    v += h m⁻¹ F    x += h v
//! ```
//!
//! All give the bits that the crate gives, which the benchmark checks before it believes a time.

pub mod intrinsics;

use crate::bodies::{Body, H};
use multiversion::multiversion;
use nalgebra::Vector3;
use torquescope::body::{Inertial, LANES, State, StateBlock};
use torquescope::math::spin_rate;

/// One body.
#[inline(always)]
pub fn step(
    h: f64,
    body: &Inertial,
    force_w: Vector3<f64>,
    tau_w: Vector3<f64>,
    s: State,
) -> State {
    moved(
        h,
        force_w * body.inv_mass,
        body.angular_response(&s, tau_w),
        s,
    )
}

#[inline(always)]
fn moved(h: f64, a_w: Vector3<f64>, alpha_w: Vector3<f64>, s: State) -> State {
    let omega_w = s.omega_w + alpha_w * h;
    let q = s.q_wp + spin_rate(omega_w, s.q_wp) * h;
    let v_w = s.v_w + a_w * h;
    State {
        x_w: s.x_w + v_w * h,
        v_w,
        q_wp: q * (1.0 / q.norm()),
        omega_w,
    }
}

/// Eight bodies, one after another, `n` times.
#[inline(never)]
pub fn one_after_another(n: usize, bodies: &mut [Body]) {
    for _ in 0..n {
        for body in bodies.iter_mut() {
            body.state = step(H, &body.inertial, Vector3::zeros(), body.tau_w, body.state);
        }
    }
}

/// Bodies on which nothing acts, in the crate's layout, by a loop that was never given a load.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
pub fn without_load(state: &mut StateBlock) {
    for lane in 0..LANES {
        let s = state.get(lane);
        state.set(lane, moved(H, Vector3::zeros(), Vector3::zeros(), s));
    }
}
