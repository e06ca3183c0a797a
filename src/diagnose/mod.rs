//! Level 5: what is wrong with an engine's rotation, by what it logged.
//!
//! ```text
//! dL/dt = τ,   L = R I Rᵀ ω,   q̇ = ½ (ω, 0) q
//! ```
//!
//! One of three answers: this is wrong, nothing is wrong, this recording cannot tell. Tests work on windows (weak form: both sides of
//! an equation smoothed by Hann's window), never on differences of single noisy steps. They go from what everything else rests on to
//! what rests on it: lengths of quaternions, the declared inertia, whether attitudes turn as ω says, sleep, precision, the point
//! about which the body turns, then the law that ω obeys. Where one fails, what follows has no ground, and the verdict says so. A
//! wrong accusation is worse than none.
//!
//! [`CAUSES`] has every cause with its test and its remedy (docs/causes.md is made from it).
//!
//! # Example
//!
//! An engine that keeps ω where nothing acts, which a body with unequal moments does not do:
//!
//! ```
//! use nalgebra::{Matrix3, Vector3};
//! use torquescope::diagnose::{Answer, diagnose};
//! use torquescope::log::{Declared, Logged, Rows};
//!
//! let mut rows = Rows::default();
//! let omega = [1.0, 2.0, 3.0_f64];
//! let speed = 14.0_f64.sqrt();
//! for k in 0..500 {
//!     let t = 0.01 * f64::from(k);
//!     let (sin, cos) = (0.5 * speed * t).sin_cos();
//!     rows.times.push(t);
//!     rows.omegas.push(omega);
//!     rows.attitudes.push([omega[0] / speed * sin, omega[1] / speed * sin, omega[2] / speed * sin, cos]);
//! }
//! let logged = Logged {
//!     name: "box".to_owned(),
//!     declared: Some(Declared {
//!         mass: Some(1.0),
//!         inertia_b: Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.5)),
//!         centre_of_mass_b: Vector3::zeros(),
//!         size: None,
//!     }),
//!     rows,
//! };
//! let verdict = diagnose(&logged);
//! // ω never leaves one axis of the body here, but that axis is none of its principal ones.
//! assert_eq!(verdict.answer, Answer::Fault);
//! assert_eq!(verdict.cause, "gyroscopic-missing");
//! ```

mod case;
mod causes;
mod centre;
mod dynamics;
mod energy;
mod inertia;
mod kinematics;
mod law;
mod motion;
mod squares;
mod surprises;
#[cfg(test)]
mod tests;
mod verdict;

pub use causes::{CAUSES, Cause, cause};
pub use verdict::{Answer, Evidence, LeftOut, RunnerUp, Verdict};

use crate::log::Logged;
use case::Case;
use causes::Judge;
use dynamics::Outcome;
use verdict::{Found, Said};

/// What is wrong with a body of a log.
pub fn diagnose(logged: &Logged) -> Verdict {
    let case = Case::new(logged);
    let mut verdict = Verdict::new(&logged.name);
    let mut grounded = false;
    for cause in CAUSES {
        let Judge::First(judge) = cause.judge else {
            continue;
        };
        // The first two ask nothing of the motion.
        if !grounded && !matches!(cause.id, "norm-drift" | "inertia-not-physical") {
            if let Some((why, remedy)) = groundless(&case) {
                return cannot_tell(verdict, why, remedy);
            }
            grounded = true;
        }
        match judge(&case) {
            Said::Pass => {}
            Said::Fault(found) => {
                verdict.untested.push(format!(
                    "whatever comes after this test ({}): it would stand on what is wrong",
                    what_follows(cause.id)
                ));
                return accuse(verdict, found);
            }
            Said::Void(why, remedy) => return cannot_tell(verdict, why, remedy),
        }
    }
    by_dynamics(&case, verdict)
}

fn by_dynamics(case: &Case, mut verdict: Verdict) -> Verdict {
    let Some(m) = case.motion() else {
        return cannot_tell(verdict, "there are no attitudes".to_owned(), String::new());
    };
    if m.derived {
        verdict.untested.push("ω was not logged: it is derived from the attitudes, whose turning cannot be held against it".to_owned());
    }
    let judged = dynamics::judge(case, m);
    verdict.left_out = judged.left_out;
    verdict.untested.extend(judged.untested);
    match judged.outcome {
        Outcome::Fault(found) => accuse(verdict, found),
        Outcome::CannotTell(why, remedy) => cannot_tell(verdict, why, remedy),
        Outcome::Fine { evidence, drift } => {
            if let Some(found) = causes::long_way(case, m) {
                return accuse(verdict, found);
            }
            let left = evidence.first().map_or(0.0, |e| e.value);
            verdict.answer = Answer::NoFault;
            verdict.cause = if m.flips.is_empty() {
                "none"
            } else {
                "double-cover"
            };
            verdict.confidence = (1.0 - left.abs().sqrt()).clamp(0.5, 0.99);
            verdict.why = format!(
                "Euler's equation holds as declared: {left:.1e} of the acceleration is left"
            );
            verdict.evidence = evidence;
            verdict.surprises = surprises::surprises(case, m, drift);
            verdict
        }
    }
}

/// Why nothing can be said of the motion, and what to record instead.
fn groundless(case: &Case) -> Option<(String, String)> {
    let rows = case.rows();
    let say = |why: &str, remedy: &str| Some((why.to_owned(), remedy.to_owned()));
    if rows.len() < 16 {
        return Some((
            format!("{} rows are too few for windows", rows.len()),
            "record some seconds, every step of them".to_owned(),
        ));
    }
    let Some(m) = case.motion() else {
        return say(
            "there are no attitudes: ω alone does not say how the body lies",
            "log the quaternion beside ω",
        );
    };
    let usable = m.usable.iter().filter(|u| **u).count();
    if m.h <= 0.0 || usable < 15 {
        return say(
            "times do not go on, or too many rows are no numbers",
            "log one row for each step, with the time of the simulation",
        );
    }
    if m.turn > 1.6 {
        return Some((
            format!(
                "the body turns by {:.2} rad from row to row: turns of more than half a turn look like slower ones the other way",
                m.turn
            ),
            "log every step, or spin slower: below 0.3 rad a row".to_owned(),
        ));
    }
    if m.speed == 0.0 {
        return say(
            "nothing turns",
            "spin the body off its axes, by some radians per second",
        );
    }
    None
}

fn what_follows(id: &str) -> String {
    let mut rest = CAUSES.iter().skip_while(|c| c.id != id).skip(1);
    let mut names: Vec<&str> = Vec::new();
    for cause in rest.by_ref() {
        if !matches!(cause.judge, Judge::Along) {
            names.push(cause.id);
        }
    }
    names.join(", ")
}

fn cannot_tell(mut verdict: Verdict, why: String, remedy: String) -> Verdict {
    verdict.answer = Answer::CannotTell;
    verdict.cause = "cannot-tell";
    verdict.why = why;
    verdict.remedy = remedy;
    verdict
}

fn accuse(mut verdict: Verdict, found: Found) -> Verdict {
    let first = found.causes.first().copied().unwrap_or("cannot-tell");
    verdict.answer = Answer::Fault;
    verdict.cause = first;
    verdict.confidence = found.confidence;
    verdict.runner_up = found.runner_up;
    verdict.evidence = found.evidence;
    verdict.why = found.why;
    if let Some(cause) = cause(first) {
        verdict.does = cause.does;
        verdict.formula = cause.formula;
        verdict.remedy = cause.remedy.to_owned();
    }
    if found.causes.len() > 1 {
        verdict.one_of = found.causes;
    }
    verdict
}
