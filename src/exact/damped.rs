//! The free body under linear damping, `τ = -c I ω`, in closed form.
//!
//! ```text
//! L(t) = e^{-ct} L(0)
//! q(t) = q_free(s),  ω(t) = e^{-ct} ω_free(s),  s = (1 - e^{-ct})/c
//! ```
//!
//! The equations `dm/dt = m × I⁻¹m - c m`, `dq/dt = ½ q ω` become the undamped ones in
//! `m e^{ct}` and s, `ds = e^{-ct} dt`. s enters phases of up to a billion radians, so it is
//! double-double.

use super::FreeMotion;
use crate::math::Dd;
use nalgebra::{Quaternion, Vector3};

/// A free motion whose angular momentum decays, set up once and evaluated at any time.
#[derive(Clone, Debug)]
pub struct DampedFreeMotion {
    undamped: FreeMotion,
    /// c, 1/s.
    rate: f64,
    /// The power of two that brings c to [1, 2).
    unit: f64,
}

impl DampedFreeMotion {
    /// From principal moments (kg m², above zero), the attitude q0 (principal axes → world), the
    /// angular velocity in principal axes (rad/s) at t = 0, and the rate c (1/s; below 0 it drives).
    pub fn new(
        moments: Vector3<f64>,
        q0: Quaternion<f64>,
        omega_p: Vector3<f64>,
        rate: f64,
    ) -> Self {
        let unit = match rate.abs() {
            0.0 => 1.0,
            size => libm::exp2(libm::floor(libm::log2(size)).clamp(-1022.0, 1022.0)),
        };
        Self {
            undamped: FreeMotion::new(moments, q0, omega_p),
            rate,
            unit,
        }
    }

    /// The attitude (principal axes → world) at `t` seconds, of either sign: to rounding while the
    /// body has turned through less than 1e15 rad, which backwards in time comes soon.
    pub fn attitude(&self, t: f64) -> Quaternion<f64> {
        self.undamped.attitude_after(self.undamped_time(t))
    }

    /// Attitude and angular velocity in principal axes.
    pub fn at(&self, t: f64) -> (Quaternion<f64>, Vector3<f64>) {
        let (q, omega) = self.undamped.after(self.undamped_time(t));
        (q, omega * self.exponent(t).exp().to_f64())
    }

    /// `s = (1 - e^{-ct})/c = t (1 - ct/2 + ...)`.
    fn undamped_time(&self, t: f64) -> Dd {
        let exponent = self.exponent(t);
        if exponent.hi.abs() < 1e-33 {
            return Dd::new(t);
        }
        let s = -exponent.exp_m1() / Dd::new(self.rate / self.unit);
        s.scaled(1.0 / self.unit)
    }

    /// `-ct`, exactly.
    fn exponent(&self, t: f64) -> Dd {
        // Beyond this the exponential is 0 or ∞, and the splitting of a product might overflow.
        let t = (t * self.unit).clamp(-1e6, 1e6);
        -Dd::product(self.rate / self.unit, t)
    }
}
