//! What a step of one body costs by each method, in steps of rk4: what `Cost::weight` declares. Of a body that a
//! torque turns, where a method takes one: a free one goes in closed form wherever the program may choose.

use crate::bodies::steps;
use crate::measure::{Timing, contestant, race};
use crate::problems::{Problem, T, free, top};
use crate::report::Report;
use torquescope::integrator::{Interval, Kind, METHODS, Method, Step, find};

const STEPS: usize = 4_096;

pub fn weights(report: &mut Report, repeats: usize) {
    let (top, free) = (top(), free());
    let takes = |method: &&dyn Method| {
        let Interval { load, inertial, .. } = &top.interval;
        method.info().refuses(load, inertial).is_none()
    };
    let (on_top, on_free): (Vec<&dyn Method>, Vec<&dyn Method>) =
        METHODS.iter().copied().partition(takes);
    report.section(
        "weights",
        "a step of a heavy top; of an adaptive method one of its own steps, to 1e-12",
    );
    rows(report, on_top, &top, repeats);
    report.section(
        "weights of what takes no torque",
        "a step of one free body; of a closed form an instant",
    );
    rows(report, on_free, &free, repeats);
}

/// Each in steps of rk4, which goes along.
fn rows(report: &mut Report, methods: Vec<&dyn Method>, problem: &Problem, repeats: usize) {
    let rk4 = find("rk4").expect("rk4");
    let others = methods.into_iter().filter(|m| m.info().name != "rk4");
    let methods: Vec<&dyn Method> = [rk4].into_iter().chain(others).collect();
    let times = measured(&methods, problem, repeats);
    for (method, time) in methods.iter().zip(&times) {
        row(report, *method, *time, times[0]);
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

/// Time of a step.
fn measured(methods: &[&dyn Method], problem: &Problem, repeats: usize) -> Vec<Timing> {
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
        .map(|(time, work)| time.per(work.steps as usize))
        .collect()
}
