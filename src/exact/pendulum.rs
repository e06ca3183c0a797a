//! The physical pendulum about a fixed level axis: `I θ̈ = -M sin θ`, M = m g l, θ from hanging.
//!
//! ```text
//! swinging   sin(θ/2) = κ sn(ω0 t + v0, κ)        θ̇ = 2 ω0 κ cn      κ < 1
//! turning    sin(θ/2) =   sn(κ ω0 t + v0, 1/κ)    θ̇ = 2 ω0 κ dn      κ > 1
//! ω0² = M/I,  κ² = sin²(θ0/2) + (θ̇0/2ω0)²,  κ'² = cos²(θ0/2) - (θ̇0/2ω0)²
//! ```
//!
//! (Whittaker, Analytical Dynamics, §44; DLMF 22.19.1.) The phase is double-double and `1 - κ²` a
//! product of its own, so that neither long times nor the neighbourhood of the separatrix (κ = 1,
//! hyperbolic functions) cost digits.

use crate::math::Dd;
use crate::math::elliptic::{first_kind, jacobi, quarter_period};
use nalgebra::{Quaternion, Unit, Vector3};
use std::f64::consts::{PI, TAU};

/// A pendulum, set up once and evaluated at any time.
#[derive(Clone, Debug)]
pub struct Pendulum {
    kind: Kind,
    /// M < 0: the angle is counted from the top instead.
    inverted: bool,
}

#[derive(Clone, Debug)]
enum Kind {
    /// Without weight, or at rest in balance.
    Steady {
        angle: f64,
        rate: f64,
    },
    Elliptic(Elliptic),
}

#[derive(Clone, Debug)]
struct Elliptic {
    turning: bool,
    /// dv/dt, 1/s.
    speed: Dd,
    /// v at t = 0.
    start: Dd,
    /// The quarter period in v; ∞ on the separatrix.
    quarter: Dd,
    /// k'² of the elliptic functions.
    kc2: Dd,
    kappa: Dd,
    /// θ̇ where cn or dn is 1, rad/s.
    top_rate: f64,
    /// Half-turns of θ/2 taken off at t = 0.
    half_turns: f64,
}

/// `sin θ/2`, `cos θ/2`, the whole turns of θ that they do not show, and θ̇.
struct Pose {
    sin: f64,
    cos: f64,
    turns: f64,
    rate: f64,
}

impl Pendulum {
    /// From the moment of inertia about the axis (kg m², above zero), M = m g l (N m; below zero
    /// where θ is counted from standing), and θ (rad) and θ̇ (rad/s) at t = 0.
    pub fn new(inertia: f64, moment: f64, angle: f64, rate: f64) -> Self {
        let inverted = moment < 0.0;
        let (mut sin, mut cos) = Dd::new(0.5 * angle).sin_cos();
        let mut from_bottom = angle;
        if inverted {
            (sin, cos) = (cos, -sin);
            from_bottom += PI;
        }
        let omega0 = (Dd::new(moment.abs()) / Dd::new(inertia)).sqrt();
        let balanced = rate == 0.0 && (sin.hi == 0.0 || cos.hi == 0.0);
        let kind = if moment == 0.0 || balanced {
            Kind::Steady { angle, rate }
        } else {
            Kind::Elliptic(Elliptic::new(omega0, sin, cos, from_bottom, rate))
        };
        Self { kind, inverted }
    }

    /// θ (rad, not reduced) and θ̇ (rad/s) at `t` seconds, of either sign.
    pub fn at(&self, t: f64) -> (f64, f64) {
        match &self.kind {
            Kind::Steady { angle, rate } => (angle + rate * t, *rate),
            Kind::Elliptic(motion) => {
                let pose = motion.at(t);
                let angle = 2.0 * libm::atan2(pose.sin, pose.cos) + TAU * pose.turns;
                (if self.inverted { angle - PI } else { angle }, pose.rate)
            }
        }
    }

    /// The turn by θ about `axis`, fixed in body and world: body as it is now → body at θ = 0. No
    /// digits go into whole turns.
    pub fn attitude(&self, axis: Unit<Vector3<f64>>, t: f64) -> Quaternion<f64> {
        let (sin, cos) = match &self.kind {
            Kind::Steady { angle, rate } => libm::sincos(0.5 * (angle + rate * t)),
            Kind::Elliptic(motion) => {
                let pose = motion.at(t);
                // θ = 2π turns + the angle shown: half of it changes sign with each turn.
                let side = if libm::fmod(pose.turns, 2.0) == 0.0 {
                    1.0
                } else {
                    -1.0
                };
                let (sin, cos) = (side * pose.sin, side * pose.cos);
                if self.inverted {
                    (-cos, sin)
                } else {
                    (sin, cos)
                }
            }
        };
        Quaternion::from_parts(cos, axis.into_inner() * sin)
    }
}

impl Elliptic {
    fn new(omega0: Dd, sin: Dd, cos: Dd, angle: f64, rate: f64) -> Self {
        let r = Dd::new(0.5 * rate) / omega0;
        let kappa = (r.square() + sin.square()).sqrt();
        let below = (cos.abs() - r.abs()) * (cos.abs() + r.abs());
        // θ/2 within a quarter turn of 0, and the half-turns that takes.
        let side = if cos.hi < 0.0 { -1.0 } else { 1.0 };
        let (sin, cos) = (sin * side, cos.abs());
        let shown = 2.0 * libm::atan2(sin.to_f64(), cos.to_f64());
        let half_turns = ((angle - shown) / TAU).round();
        let turning = below.hi <= 0.0;
        let way = if rate < 0.0 { -1.0 } else { 1.0 };
        let (speed, kc2, start) = if turning {
            let start = first_kind(sin, cos, r.abs() / kappa);
            (omega0 * kappa * way, -below / kappa.square(), start)
        } else {
            let start = first_kind(sin / kappa, r / kappa, cos);
            (omega0, below, start)
        };
        let quarter = if kc2.hi == 0.0 {
            Dd::new(f64::INFINITY)
        } else {
            quarter_period(kc2)
        };
        let falling_back = !turning && way < 0.0;
        Self {
            turning,
            speed,
            start: if falling_back {
                quarter * 2.0 - start
            } else {
                start
            },
            quarter,
            kc2,
            kappa,
            top_rate: (omega0 * kappa * 2.0).to_f64() * if turning { way } else { 1.0 },
            half_turns,
        }
    }

    fn at(&self, t: f64) -> Pose {
        let v = self.speed * t + self.start;
        let (rest, halves) = if self.quarter.hi == f64::INFINITY {
            (v, 0.0)
        } else {
            let period = self.quarter * 2.0;
            let (_, halves) = (v / period).fraction();
            (v - period * halves, halves)
        };
        let (sn, cn, dn) = jacobi(rest, self.kc2);
        let f = Dd::to_f64;
        if self.turning {
            return Pose {
                sin: f(sn),
                cos: f(cn),
                turns: self.half_turns + halves,
                rate: self.top_rate * f(dn),
            };
        }
        let side = if libm::fmod(halves, 2.0) == 0.0 {
            1.0
        } else {
            -1.0
        };
        Pose {
            sin: side * f(self.kappa * sn),
            cos: f(dn),
            turns: self.half_turns,
            rate: side * self.top_rate * f(cn),
        }
    }
}
