//! What a step of one body costs by each method, in steps of rk4: what `Cost::weight` declares.

use crate::bodies::steps;
use crate::measure::{Timing, contestant, race};
use crate::problems::{Problem, T, free, top};
use crate::report::Report;
use torquescope::integrator::{Kind, METHODS, Method, Step, Work};

const STEPS: usize = 4_096;

pub fn weights(report: &mut Report, repeats: usize) {
    let all: Vec<&dyn Method> = METHODS.to_vec();
    let on_free = measured(&all, &free(), repeats);
    // Methods that are exact on a free body take no steps there.
    let exact = |k: usize| all[k].info().kind == Kind::Fixed && on_free[k].1.evaluations == 0;
    let (kicked, stepped): (Vec<_>, Vec<_>) = (0..all.len()).partition(|&k| exact(k));
    let rk4 = all
        .iter()
        .position(|m| m.info().name == "rk4")
        .expect("rk4");
    report.section(
        "weights",
        "a step of one free body; of an adaptive method one of its own steps, to 1e-12; of a closed form an instant",
    );
    for k in stepped {
        row(report, all[k], on_free[k].0, on_free[rk4].0);
    }
    let tops: Vec<&dyn Method> = [rk4].into_iter().chain(kicked).map(|k| all[k]).collect();
    let on_top = measured(&tops, &top(), repeats);
    report.section(
        "weights of kicks",
        "a step of a heavy top, for methods that are exact on a free body",
    );
    for (method, (time, _)) in tops.iter().zip(&on_top) {
        row(report, *method, *time, on_top[0].0);
    }
}

fn row(report: &mut Report, method: &dyn Method, time: Timing, rk4: Timing) {
    let info = method.info();
    let note = format!(
        "weight {:.2}, declared {}",
        time.ns / rk4.ns,
        info.cost.weight
    );
    report.time(info.name, time, "ns/step", note);
}

/// Time of a step, and what was done.
fn measured(methods: &[&dyn Method], problem: &Problem, repeats: usize) -> Vec<(Timing, Work)> {
    let mut interval = problem.interval.clone();
    interval.tolerance = 1e-12;
    let mut works = Vec::new();
    let mut contestants = Vec::new();
    for method in methods {
        let whole = Step {
            from: 0.0,
            h: T,
            to: T,
            keep: false,
        };
        let (todo, keep) = match method.info().kind {
            Kind::Fixed => (steps(STEPS, T / STEPS as f64, false), 0),
            Kind::Adaptive => (vec![whole], 0),
            Kind::Closed => (steps(STEPS, T / STEPS as f64, true), STEPS),
        };
        let start = method.start(interval.clone(), 0.0, &problem.state);
        let mut trial = start.clone();
        trial.advance(&todo, &mut Vec::new());
        works.push(trial.work());
        contestants.push(contestant(
            move || (start.clone(), Vec::with_capacity(keep)),
            move |(stepper, kept)| stepper.advance(&todo, kept),
        ));
    }
    let times = race(&mut contestants, repeats).into_iter().zip(works);
    times
        .map(|(time, work)| (time.per(work.steps as usize), work))
        .collect()
}
