//! What a step of one free body costs by each method, in steps of rk4: what `Cost::weight` declares.

use crate::bodies::{Acting, blocks, bodies, steps};
use crate::measure::{contestant, race};
use crate::report::Report;
use torquescope::integrator::{Kind, METHODS, Step};

/// s and steps.
const T: f64 = 100.0;
const STEPS: usize = 4_096;

pub fn weights(report: &mut Report, repeats: usize) {
    let block = blocks(&bodies(1), Acting::Gyroscopic).remove(0);
    let h = T / STEPS as f64;
    let mut counts = Vec::new();
    let mut contestants = Vec::new();
    for method in METHODS {
        // A step is the clock's, or the method's own, or an instant that is asked for.
        let (todo, keep) = match method.info().kind {
            Kind::Fixed => (steps(STEPS, h, false), 0),
            Kind::Adaptive => (
                vec![Step {
                    from: 0.0,
                    h: T,
                    to: T,
                    keep: false,
                }],
                0,
            ),
            Kind::Closed => (steps(STEPS, h, true), STEPS),
        };
        let start = method.start(block.interval.clone(), 0.0, &block.state);
        let mut trial = start.clone();
        trial.advance(&todo, &mut Vec::new());
        counts.push(trial.work().steps as usize);
        contestants.push(contestant(
            move || (start.clone(), Vec::with_capacity(keep)),
            move |(stepper, kept)| stepper.advance(&todo, kept),
        ));
    }
    let times = race(&mut contestants, repeats);
    let times: Vec<_> = times
        .into_iter()
        .zip(counts)
        .map(|(t, n)| t.per(n))
        .collect();
    let rk4 = METHODS
        .iter()
        .position(|m| m.info().name == "rk4")
        .expect("rk4");
    report.section("weights", "a step of one free body, gyroscopic; of an adaptive method one of its own steps, to 1e-12; of a closed form an instant");
    for (method, time) in METHODS.iter().zip(&times) {
        let info = method.info();
        let note = format!(
            "weight {:.2}, declared {}",
            time.ns / times[rk4].ns,
            info.cost.weight
        );
        report.time(info.name, *time, "ns/step", note);
    }
}
