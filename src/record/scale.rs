//! How long an arrow is drawn: metres per unit, one stated factor per quantity.
//!
//! The factor is a round number, the largest at which the largest value to be expected is drawn no
//! longer than its reach in radii of a typical body: long enough to stick out of a solid mesh.
//! What to expect comes from the events on the bodies as they start, so that the factor stands
//! before the first step.

use super::mesh;
use crate::trace::{Moment, Subject};

/// Longest arrows, in radii of a typical body. Angular acceleration reaches further than torque:
/// where both lie along one axis, both heads are seen.
const FORCE_REACH: f64 = 1.6;
const TORQUE_REACH: f64 = 1.8;
const ALPHA_REACH: f64 = 2.4;

/// Metres per N, N·m, rad/s², rad/s and kg m²/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    pub force: f64,
    pub torque: f64,
    pub alpha: f64,
    pub omega: f64,
    pub momentum: f64,
    /// A typical body's radius, m: what the scales and the camera go by.
    pub size: f64,
}

impl Scales {
    /// From what the events would do at the start; `expected` holds every body once per event.
    pub fn new(subjects: &[Subject], expected: &[Moment], reach: f64) -> Self {
        let size = typical(subjects.iter().map(mesh::radius));
        let bodies = || expected.iter().zip(subjects.iter().cycle());
        let largest = |value: &dyn Fn(&Moment, &Subject) -> f64| {
            bodies()
                .map(|(m, s)| value(m, s))
                .filter(|x| x.is_finite())
                .fold(0.0, f64::max)
        };
        let force = largest(&|m, _| {
            m.pushes
                .iter()
                .map(|p| p.force_w.norm())
                .fold(0.0, f64::max)
        });
        let torque = largest(&|m, _| m.tau_w.norm());
        let alpha = largest(&|m, _| m.alpha_w.norm());
        // What the velocities reach: the start, and the longest event at its first acceleration.
        let omega = largest(&|m, _| m.motion.omega_w.norm() + m.alpha_w.norm() * reach);
        let momentum = largest(&|m, s| s.momentum_w(&m.motion).norm() + m.tau_w.norm() * reach);
        let factor = |largest: f64, reach: f64| nice(reach * size / largest);
        Self {
            force: factor(force, FORCE_REACH),
            torque: factor(torque, TORQUE_REACH),
            alpha: factor(alpha, ALPHA_REACH),
            omega: factor(omega, ALPHA_REACH),
            momentum: factor(momentum, TORQUE_REACH),
            size,
        }
    }

    /// `1 N is drawn 0.1 m long`, for each quantity.
    pub fn sentences(&self) -> Vec<(&'static str, String)> {
        let say = |unit: &str, factor: f64| format!("1 {unit} = {} m", crate::trace::short(factor));
        vec![
            ("force", say("N", self.force)),
            ("torque", say("N·m", self.torque)),
            ("alpha", say("rad/s²", self.alpha)),
            ("omega", say("rad/s", self.omega)),
            ("momentum", say("kg m²/s", self.momentum)),
        ]
    }
}

/// The median, 1 where there is nothing.
fn typical(sizes: impl Iterator<Item = f64>) -> f64 {
    let mut sizes: Vec<f64> = sizes
        .filter(|size| size.is_finite() && *size > 0.0)
        .collect();
    sizes.sort_by(f64::total_cmp);
    sizes.get(sizes.len() / 2).copied().unwrap_or(1.0)
}

/// The largest round number (one of [`DIGITS`] times a power of ten) not above `x`; 1 for what is
/// not usable.
pub fn nice(x: f64) -> f64 {
    if !(x.is_finite() && x > 0.0) {
        return 1.0;
    }
    let power = x.log10().floor();
    let base = 10_f64.powf(power);
    let digit = DIGITS.into_iter().find(|d| d * base <= x * (1.0 + 1e-12));
    // Through text, so that the factor is the decimal number it says it is.
    format!("{}e{power}", digit.unwrap_or(1.0))
        .parse()
        .unwrap_or(1.0)
}

const DIGITS: [f64; 8] = [8.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.5, 1.0];

#[cfg(test)]
mod tests {
    use super::nice;

    #[test]
    fn factors_are_round_numbers_not_above_what_fits() {
        for (x, want) in [
            (0.26, 0.2),
            (0.5, 0.5),
            (0.049, 0.04),
            (7.0, 6.0),
            (1e-9, 1e-9),
        ] {
            assert_eq!(nice(x), want);
        }
        assert_eq!(nice(f64::INFINITY), 1.0);
    }
}
