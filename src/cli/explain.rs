//! How a scene was stepped: the plan, as a table or as data.

use super::print;
use crate::cost::{self, Plan, Planned};
use crate::integrator::Kind;
use crate::trace::{Subject, short};
use serde::Serialize;

/// The plan and what it came to.
pub fn table(plan: &Plan, subjects: &[Subject]) -> String {
    let header = [
        "bodies",
        "from (s)",
        "to (s)",
        "active",
        "method",
        "its step",
        "expected error (rad)",
    ];
    let rows = plan.intervals.iter().map(|planned| row(planned, subjects));
    let mut text = "\n\nHow each interval was stepped\n".to_owned();
    text += &print::table(&header, rows.collect());
    let asked = match plan.accuracy {
        Some(asked) => format!("asked for {asked:e} rad; "),
        None => String::new(),
    };
    let with = match plan.checked_by.is_empty() {
        true => format!("the exact motion ({})", plan.by.join(", ")),
        false => format!(
            "{}, checked by {}",
            plan.by.join(", "),
            plan.checked_by.join(", ")
        ),
    };
    text += &format!(
        "\n{asked}largest error: {:.1e} rad, against {with}, which is good to {:.1e} rad",
        plan.achieved, plan.uncertainty
    );
    text
}

fn row(planned: &Planned, subjects: &[Subject]) -> Vec<String> {
    let names = subjects[planned.members.clone()]
        .iter()
        .map(|s| s.name.as_str());
    let names: Vec<&str> = names.collect();
    let active = match planned.effects.is_empty() {
        true => "nothing".to_owned(),
        false => planned.effects.join(", "),
    };
    vec![
        names.join(", "),
        short(planned.from),
        short(planned.until),
        active,
        planned.choice.method.info().name.to_owned(),
        match planned.step {
            Some(step) => cost::time(step),
            None => own_way(planned),
        },
        planned
            .expected
            .map_or("–".to_owned(), |error| format!("{error:.1e}")),
    ]
}

/// How a method gets through time that is given no step.
fn own_way(planned: &Planned) -> String {
    match planned.choice.method.info().kind {
        Kind::Adaptive => format!("its own, by tolerance {:.0e}", planned.choice.tolerance),
        kind => kind.describe().to_owned(),
    }
}

/// The same as data.
#[derive(Serialize)]
pub struct Report {
    intervals: Vec<Interval>,
    accuracy: Option<f64>,
    achieved: f64,
    uncertainty: f64,
    reference: Vec<&'static str>,
    checked_by: Vec<&'static str>,
}

#[derive(Serialize)]
struct Interval {
    bodies: Vec<String>,
    from: f64,
    until: f64,
    active: Vec<String>,
    method: &'static str,
    step: Option<f64>,
    /// Of a method with steps of its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    tolerance: Option<f64>,
    expected: Option<f64>,
}

pub fn report(plan: &Plan, subjects: &[Subject]) -> Report {
    let interval = |planned: &Planned| Interval {
        bodies: subjects[planned.members.clone()]
            .iter()
            .map(|s| s.name.clone())
            .collect(),
        from: planned.from,
        until: planned.until,
        active: planned.effects.clone(),
        method: planned.choice.method.info().name,
        step: planned.step,
        tolerance: (planned.choice.method.info().kind == Kind::Adaptive)
            .then_some(planned.choice.tolerance),
        expected: planned.expected,
    };
    Report {
        intervals: plan.intervals.iter().map(interval).collect(),
        accuracy: plan.accuracy,
        achieved: plan.achieved,
        uncertainty: plan.uncertainty,
        reference: plan.by.clone(),
        checked_by: plan.checked_by.clone(),
    }
}
