//! How large quantities get, as far as can be told before the first step.

use super::sources::GYROSCOPIC;
use crate::trace::{Sample, Subject};

/// The largest magnitude of each quantity that a picture draws; 0 where there is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sizes {
    /// Of a push, N.
    pub force: f64,
    /// Of an impulse, N·s.
    pub impulse: f64,
    /// N·m.
    pub torque: f64,
    /// rad/s².
    pub alpha: f64,
    /// rad/s.
    pub omega: f64,
    /// kg m²/s.
    pub momentum: f64,
}

impl Sizes {
    pub fn count_force(&mut self, size: f64) {
        if size.is_finite() {
            self.force = self.force.max(size);
        }
    }

    pub fn count_impulse(&mut self, size: f64) {
        if size.is_finite() {
            self.impulse = self.impulse.max(size);
        }
    }

    /// Counts a body as it is, and as it would be after `lasts` seconds of the same torque.
    pub fn count(&mut self, subject: &Subject, sample: &Sample, lasts: f64) {
        let (tau, alpha) = (sample.tau_w.norm(), sample.alpha_w.norm());
        let momentum = subject.momentum_w(&sample.motion).norm();
        let grow = |size: &mut f64, x: f64| {
            if x.is_finite() {
                *size = size.max(x);
            }
        };
        for push in &sample.pushes {
            grow(&mut self.force, push.force_w.norm());
        }
        grow(&mut self.torque, tau);
        // Drawn at the scale of their sum, so that they compare.
        let sources = subject.sources.iter().zip(&sample.sources);
        for (_, source) in sources.filter(|(name, _)| *name != GYROSCOPIC) {
            grow(&mut self.torque, source.norm());
        }
        grow(&mut self.alpha, alpha);
        grow(
            &mut self.omega,
            sample.motion.omega_w.norm() + alpha * lasts,
        );
        grow(&mut self.momentum, momentum + tau * lasts);
    }
}
