//! The watchdog: what a run lets drift.
//!
//! Of every sample that is made anyway four things are looked at: the errors of the energy, of the angular momentum and of
//! the attitude ([`Deviation`]), where they are known, and the length of the attitude. Each is allowed
//!
//! ```text
//! rounding                              what the method declares that it keeps, and |q| by any
//! 10 φ (h ω)^p + rounding               all else by fixed steps, over φ radians at the fastest rate so far
//! 100 tolerances a radian + rounding    steps by tolerance
//! ```
//!
//! but no more than a hundredth of what should stay, and half a radian: by then a motion is another one, whatever the
//! order. What goes beyond is told once, with when it began.

use super::choose::Choice;
use crate::integrator::Kind;
use crate::trace::{Deviation, Instant, Sample, Subject, brief, short};
use std::fmt;

/// Something that drifts.
#[derive(Clone, Debug, PartialEq)]
pub struct Warning {
    /// Index of the body.
    pub body: usize,
    /// Its name.
    pub name: String,
    pub drifts: Drifts,
    /// The first sample that showed it.
    pub began: Instant,
    /// What was allowed then, as a part of the largest so far; of an attitude, rad.
    pub allowed: f64,
    /// The largest until the run ended.
    pub worst: f64,
    /// By which method.
    pub method: &'static str,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drifts {
    Energy,
    Momentum,
    /// Beside the exact one.
    Attitude,
    /// |q|².
    Length,
}

impl Drifts {
    const ALL: [Self; 4] = [Self::Energy, Self::Momentum, Self::Attitude, Self::Length];

    pub fn describe(self) -> &'static str {
        match self {
            Self::Energy => "energy",
            Self::Momentum => "angular momentum",
            Self::Attitude => "the attitude",
            Self::Length => "the attitude's length",
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, what, method) = (&self.name, self.drifts.describe(), self.method);
        let (time, step) = (short(self.began.time), self.began.step);
        let (worst, allowed) = (brief(self.worst), brief(self.allowed));
        let of = match self.drifts {
            Drifts::Attitude => "rad",
            _ => "of itself",
        };
        write!(
            f,
            "{name}: {what} drifts by {method} from t = {time} s, step {step}: off by {worst} {of}, where {allowed} is to be expected; take a smaller step or another method (`torquescope cost SCENE` compares them)"
        )
    }
}

/// What is watched of one body.
#[derive(Clone, Debug, Default)]
pub struct Watch {
    /// The fastest it turned or was turned so far, rad/s.
    rate: f64,
    told: [Option<Warning>; 4],
}

/// Where and how a sample was made.
#[derive(Clone, Copy)]
pub struct Made<'a> {
    pub at: Instant,
    pub body: usize,
    pub subject: &'a Subject,
    pub choice: Choice,
    /// The clock's step, s.
    pub step: f64,
    /// No torque acts.
    pub free: bool,
}

/// Less is rounding of what is compared.
const FLOOR: f64 = 256.0 * f64::EPSILON;
/// A part of what is, that is another motion whatever the method.
const LARGE: f64 = 0.01;
/// And of an attitude, rad.
const FAR: f64 = 0.5;

impl Watch {
    /// Looks at a sample; what it tells for the first time.
    pub fn look(
        &mut self,
        made: &Made<'_>,
        sample: &Sample,
        deviation: &Deviation,
    ) -> Vec<Warning> {
        let alpha = sample.alpha_w.norm();
        self.rate = self
            .rate
            .max(sample.motion.omega_w.norm())
            .max(alpha.sqrt());
        let length = sample.motion.q_wb.coords.norm_squared() - 1.0;
        let mut news = Vec::new();
        for (k, drifts) in Drifts::ALL.into_iter().enumerate() {
            let off = match drifts {
                Drifts::Energy => deviation.energy,
                Drifts::Momentum => deviation.momentum,
                Drifts::Attitude => deviation.attitude,
                Drifts::Length => Some(length),
            };
            // What is not a number is no drift, but an end of its own.
            let Some(off) = off.map(f64::abs).filter(|off| off.is_finite()) else {
                continue;
            };
            if off <= FLOOR {
                continue;
            }
            if let Some(told) = &mut self.told[k] {
                told.worst = told.worst.max(off);
                continue;
            }
            let allowed = self.allowed(made, drifts);
            if off > allowed {
                let warning = Warning {
                    body: made.body,
                    name: made.subject.name.clone(),
                    drifts,
                    began: made.at,
                    allowed,
                    worst: off,
                    method: made.choice.method.info().name,
                };
                self.told[k] = Some(warning.clone());
                news.push(warning);
            }
        }
        news
    }

    /// What may be off by now, as a part of the whole.
    fn allowed(&self, made: &Made<'_>, drifts: Drifts) -> f64 {
        let info = made.choice.method.info();
        let steps = made.at.step as f64 * f64::from(made.choice.pieces);
        let radians = self.rate * made.at.time;
        let stages = f64::from(info.cost.evaluations.unwrap_or(1).max(1));
        // Some roundings a stage and a radian, all the same way; they seldom are.
        let rounding = FLOOR + 8.0 * f64::EPSILON * (stages * steps + radians);
        let fixed = info.kind == Kind::Fixed && made.free;
        let keeps = match drifts {
            Drifts::Length => true,
            Drifts::Momentum => fixed && info.keeps_momentum,
            Drifts::Energy | Drifts::Attitude => fixed && info.exact_free,
        };
        if keeps || info.kind == Kind::Closed {
            return rounding;
        }
        let h = made.step / f64::from(made.choice.pieces);
        let expected = match info.kind {
            Kind::Adaptive => 100.0 * made.choice.tolerance * (1.0 + radians),
            // Whole powers by products, so that the bits are the same everywhere.
            _ => (0..info.order).fold(10.0 * radians, |product, _| product * (h * self.rate)),
        };
        let most = match drifts {
            Drifts::Attitude => FAR,
            _ => LARGE,
        };
        expected.min(most) + rounding
    }

    /// What it told, as far as it got.
    pub fn told(&self) -> impl Iterator<Item = &Warning> {
        self.told.iter().flatten()
    }
}
