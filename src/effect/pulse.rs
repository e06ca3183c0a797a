//! A force or torque that swells and ends: `p(t) F` with p from 0 to 1 while it lasts.
//!
//! With s = (t - t₀)/T: a box is 1; half a sine is `sin π s`, of mean 2/π; a ramp is s, of mean ½. s
//! counts from the event's own begin, so steps that something else cuts change nothing. Before and after
//! it keeps the value at its ends: methods ask at those instants, and rounding may set them beyond.

use super::{Depends, Effect, Term, WrenchBlock};
use crate::body::{InertialBlock, LaneSet, StateBlock};
use std::f64::consts::PI;

/// How what lasts goes through its time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Profile {
    /// All of it from begin to end.
    #[default]
    Box,
    /// Up and down again as half a sine.
    HalfSine,
    /// From nothing evenly up to all of it, where it breaks off.
    Ramp,
}

/// Every profile, as scenes name it.
pub const PROFILES: [(&str, Profile); 3] = [
    ("box", Profile::Box),
    ("half_sine", Profile::HalfSine),
    ("ramp", Profile::Ramp),
];

impl Profile {
    pub fn name(self) -> &'static str {
        let known = PROFILES.iter().find(|(_, profile)| *profile == self);
        known.map_or("", |(name, _)| name)
    }
}

/// A profile at its place in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulse {
    pub profile: Profile,
    /// s.
    pub begins: f64,
    /// s.
    pub lasts: f64,
}

impl Pulse {
    /// The part of its peak at time `t` (s).
    pub fn part(&self, t: f64) -> f64 {
        let s = || ((t - self.begins) / self.lasts).clamp(0.0, 1.0);
        match self.profile {
            Profile::Box => 1.0,
            Profile::HalfSine => libm::sin(PI * s()),
            Profile::Ramp => s(),
        }
    }
}

/// A constant force or torque times a pulse, on one lane of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulsed {
    /// At its peak.
    pub peak: Term,
    pub pulse: Pulse,
}

impl Effect for Pulsed {
    fn name(&self) -> &'static str {
        match self.peak {
            Term::Force { .. } => "push",
            Term::Torque { .. } => "torque",
        }
    }

    fn add(&self, t: f64, _: &InertialBlock, state: &StateBlock, wrench: &mut WrenchBlock) {
        let lane = self.peak.lane();
        let (peak, part) = (self.peak.wrench(&state.get(lane)), self.pulse.part(t));
        wrench.add(lane, peak.force_w * part, peak.tau_w * part);
    }

    fn lanes(&self) -> LaneSet {
        LaneSet::one(self.peak.lane())
    }

    fn depends(&self, _: &InertialBlock) -> Depends {
        Depends {
            time: true,
            ..self.peak.depends()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_what_their_names_say() {
        let at = |profile, t| {
            let (begins, lasts) = (0.5, 0.25);
            let pulse = Pulse {
                profile,
                begins,
                lasts,
            };
            pulse.part(t)
        };
        for (profile, [start, third, half, end]) in [
            (Profile::Box, [1.0, 1.0, 1.0, 1.0]),
            (Profile::HalfSine, [0.0, 0.75_f64.sqrt(), 1.0, 0.0]),
            (Profile::Ramp, [0.0, 1.0 / 3.0, 0.5, 1.0]),
        ] {
            let want = [
                (0.5, start),
                (0.5 + 0.25 / 3.0, third),
                (0.625, half),
                (0.75, end),
            ];
            for (t, want) in want {
                // π and the third are rounded.
                assert!((at(profile, t) - want).abs() < 1e-15, "{profile:?} at {t}");
            }
            // Beyond its ends by a rounding, what it is there.
            assert_eq!(at(profile, 0.5 - 1e-16), at(profile, 0.5));
            assert_eq!(at(profile, 0.75 + 1e-15), at(profile, 0.75));
        }
    }
}
