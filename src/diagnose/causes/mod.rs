//! What can be wrong, one file per cause or tight family, one line in [`CAUSES`].

mod centre_ignored;
mod clamp;
mod damping;
mod double_cover;
mod euler_rates;
mod frames;
mod gyroscopic;
mod inertia_data;
mod integrator;
mod levers;
mod lifetime;
mod maps;
mod norm_drift;
mod not_physical;
mod precision;
mod sleep;
mod torque_frame;

use super::case::Case;
use super::dynamics::{Dynamics, Explained};
use super::law::Law;
use super::verdict::Said;

/// A cause: what people see, how it shows, what is right.
pub struct Cause {
    /// Its name in verdicts.
    pub id: &'static str,
    /// In users' words.
    pub symptom: &'static str,
    /// How a recording shows it.
    pub test: &'static str,
    /// What the code most likely does.
    pub does: &'static str,
    /// What is right.
    pub formula: &'static str,
    pub remedy: &'static str,
    /// A recording that shows it.
    pub example: &'static str,
    pub(super) judge: Judge,
}

/// How a cause is judged.
pub(super) enum Judge {
    /// By a test of its own, before the dynamics; where it fails, what follows is void.
    First(fn(&Case) -> Said),
    /// With the cause above it.
    Along,
    /// By laws that compete with the right one.
    Laws(&'static [Law]),
    /// By something that is fitted where no law fits.
    Fitted(fn(&Dynamics) -> Option<Explained>),
    /// By what is left when the law is right.
    Last,
}

/// Every cause, in the order of the tests.
#[rustfmt::skip]
pub const CAUSES: &[&Cause] = &[
    &norm_drift::NORM_DRIFT,
    &not_physical::NOT_PHYSICAL,
    &frames::OMEGA_IN_BODY,
    &frames::WRONG_SIDE,
    &frames::ORDER,
    &frames::CONJUGATED,
    &frames::HALF_FACTOR,
    &frames::DEGREES,
    &frames::HANDEDNESS,
    &euler_rates::EULER_RATES,
    &sleep::SLEEP,
    &precision::PRECISION,
    &centre_ignored::CENTRE_IGNORED,
    &gyroscopic::MISSING,
    &gyroscopic::SIGN,
    &gyroscopic::DIAGONAL_ONLY,
    &maps::NOT_ROTATED,
    &maps::BACKWARDS,
    &maps::NOT_INVERTED,
    &torque_frame::IN_BODY,
    &levers::STALE,
    &levers::FROM_ORIGIN,
    &inertia_data::PRODUCTS_SIGN,
    &inertia_data::PRODUCTS_DROPPED,
    &inertia_data::SCALE,
    &inertia_data::WRONG_POINT,
    &lifetime::LIFETIME,
    &damping::DAMPING,
    &clamp::CLAMP,
    &integrator::GAINED,
    &integrator::LOST,
    &double_cover::DOUBLE_COVER,
];

pub(super) use double_cover::long_way;

/// By its id.
pub fn cause(id: &str) -> Option<&'static Cause> {
    CAUSES.iter().find(|c| c.id == id).copied()
}
