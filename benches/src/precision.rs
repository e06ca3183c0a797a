//! What it costs to know where a body is after 100 s, and how well it is known then: the free body in
//! closed form, the heavy top by the methods that choose their own steps.

use crate::bodies::bodies;
use crate::measure::{Timing, contestant, race};
use crate::problems::{Problem, T, free, top};
use crate::report::Report;
use nalgebra::Quaternion;
use std::hint::black_box;
use torquescope::exact::FreeMotion;
use torquescope::integrator::find;

const INSTANTS: usize = 1_000;
/// Runs in one reading of the clock.
const RUNS: usize = 200;

/// The closed form by itself: setting up, and one instant.
pub fn exact(report: &mut Report, repeats: usize) {
    let bodies = bodies(1_000);
    let set_up = |k: usize| {
        let s = bodies[k].state;
        FreeMotion::new(
            bodies[k].inertial.moments,
            s.q_wp,
            s.to_principal(s.omega_w),
        )
    };
    let motions: Vec<FreeMotion> = (0..bodies.len()).map(set_up).collect();
    let times = race(
        &mut [
            contestant(
                || (),
                |()| {
                    for k in 0..bodies.len() {
                        black_box(set_up(k));
                    }
                },
            ),
            contestant(
                || (),
                |()| {
                    for (k, motion) in motions.iter().enumerate() {
                        black_box(motion.attitude(0.37 * k as f64));
                    }
                },
            ),
            contestant(
                || (),
                |()| {
                    for (k, motion) in motions.iter().enumerate() {
                        black_box(motion.at(0.37 * k as f64));
                    }
                },
            ),
        ],
        repeats,
    );
    report.section(
        "exact",
        "the free body in closed form: 1,000 bodies, each at an instant of its own",
    );
    for (name, time) in [
        "set-up",
        "attitude at an instant",
        "attitude and ω at an instant",
    ]
    .iter()
    .zip(times)
    {
        report.time(*name, time.per(bodies.len()), "ns", "");
    }
}

pub fn precision(report: &mut Report, repeats: usize) {
    report.section(
        "precision",
        format!("T = {T} s, one body, setting out counted; error of the attitude at the end"),
    );
    free_body(report, repeats);
    let top = top();
    for method in ["taylor", "dop853"] {
        for tolerance in [1e-10, 1e-12, 1e-15] {
            for instants in [0, INSTANTS] {
                by_method(report, repeats, ("top", &top), method, tolerance, instants);
            }
        }
    }
}

fn free_body(report: &mut Report, repeats: usize) {
    let problem = free();
    let (body, s) = (problem.interval.inertial.get(0), problem.state.get(0));
    let motion = || FreeMotion::new(black_box(body.moments), s.q_wp, s.omega_w);
    let at = |k: usize| T * (k + 1) as f64 / INSTANTS as f64;
    let times: Vec<f64> = (0..INSTANTS).map(at).collect();
    let mut took = race(
        &mut [
            contestant(
                || (),
                |()| (0..RUNS).for_each(|_| _ = black_box(motion().attitude(T))),
            ),
            contestant(
                || vec![Quaternion::identity(); INSTANTS],
                |instants: &mut Vec<Quaternion<f64>>| {
                    for _ in 0..RUNS {
                        let motion = motion();
                        motion.attitudes(&times, instants);
                        black_box(&instants);
                    }
                },
            ),
        ],
        repeats,
    )
    .into_iter();
    let error = format!("error {:.1e}", problem.error(motion().attitude(T)));
    for name in ["free, formula, end", "free, formula, 1000 instants"] {
        if let Some(time) = took.next() {
            report.time(name, microseconds(time.per(RUNS)), "us", error.clone());
        }
    }
    for instants in [0, INSTANTS] {
        by_method(
            report,
            repeats,
            ("free", &problem),
            "closed-form",
            0.0,
            instants,
        );
    }
    for tolerance in [1e-10, 1e-12, 1e-15] {
        by_method(report, repeats, ("free", &problem), "taylor", tolerance, 0);
    }
}

fn by_method(
    report: &mut Report,
    repeats: usize,
    (name, problem): (&str, &Problem),
    method: &str,
    tolerance: f64,
    instants: usize,
) {
    let Some(found) = find(method) else { return };
    let runs = RUNS / 20;
    let times = race(
        &mut [contestant(
            || (),
            |()| (0..runs).for_each(|_| drop(black_box(problem.solve(found, tolerance, instants)))),
        )],
        repeats,
    );
    let (stepper, _) = problem.solve(found, tolerance, instants);
    let error = problem.error(stepper.state().get(0).q_wp);
    let what = match instants {
        0 => "end".to_owned(),
        n => format!("{n} instants"),
    };
    let tolerance = match tolerance {
        0.0 => String::new(),
        tolerance => format!(" {tolerance:e}"),
    };
    report.time(
        format!("{name}, {method}{tolerance}, {what}"),
        microseconds(times[0].per(runs)),
        "us",
        format!("error {error:.1e}, {} steps", stepper.work().steps),
    );
}

fn microseconds(time: Timing) -> Timing {
    time.per(1_000)
}
