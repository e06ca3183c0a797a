//! Attitude along the free motion: the drift of a composition.

use crate::body::Inertial;
use crate::exact::FreeMotion;
use crate::integrator::preprocessed::Preprocessed;
use crate::math::{exponential, turned};
use nalgebra::{Quaternion, Vector3};
use std::sync::Arc;

/// Up to this `h |L| / I_min` (rad; no less than h |ω|) the discrete body of order 10 is the real one
/// to rounding: its error, which grows as the 11th power, is below 6e-17 rad for every kind of body
/// (measured in the tests), and its rounding is that of the closed form, at a fraction of the cost.
pub const DISCRETE: f64 = 0.16;

/// How a body turns by itself, prepared once.
#[derive(Clone, Debug)]
pub enum Turning {
    /// Euler's equations: L stays.
    Momentum {
        moments: Vector3<f64>,
        least: f64,
        discrete: Arc<Preprocessed>,
    },
    /// The tutorial's model: ω stays.
    Velocity,
}

impl Turning {
    pub fn new(body: &Inertial, gyroscopic: bool) -> Self {
        match gyroscopic {
            true => Self::Momentum {
                moments: body.moments,
                least: body.moments.min(),
                discrete: Arc::new(Preprocessed::new(body.moments, 10)),
            },
            false => Self::Velocity,
        }
    }

    /// The attitude `h` seconds on (s, of either sign).
    #[inline]
    pub fn attitude(
        &self,
        h: f64,
        q: Quaternion<f64>,
        constant_w: Vector3<f64>,
    ) -> Quaternion<f64> {
        match self {
            Self::Velocity => {
                let q = exponential(constant_w * h) * q;
                q * (1.0 / q.norm())
            }
            Self::Momentum {
                moments,
                least,
                discrete,
            } => {
                if h.abs() * constant_w.norm() <= DISCRETE * least {
                    return discrete.attitude(h, q, constant_w);
                }
                let omega_p = turned(q.conjugate(), constant_w).component_div(moments);
                let q = FreeMotion::new(*moments, q, omega_p).attitude(h);
                q * (1.0 / q.norm())
            }
        }
    }
}
