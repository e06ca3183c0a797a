//! A plateau of |ω| that the law would leave, with the error against ω.
//!
//! |ω| has plateaus of its own under pulses; there nothing is left of Euler's equation.

use super::{Cause, Judge};
use crate::diagnose::dynamics::{Dynamics, Explained};
use crate::diagnose::law::{Law, fit, rms};

pub(super) const CLAMP: Cause = Cause {
    id: "speed-clamp",
    symptom: "stuck at 47 rad/s (or another number), however hard it is driven",
    test: "|ω| stays at its largest value for at least 5 rows (20 noisy ones) while the law would raise it: what is left points against ω",
    does: "limits |ω| to a maximum",
    formula: "no limit; where one is needed, |ω| h < ½",
    remedy: "raise the limit, or take smaller steps",
    example: "a torque that drives a body up",
    judge: Judge::Fitted(judge),
};

fn judge(d: &Dynamics) -> Option<Explained> {
    let m = d.motion;
    let speeds: Vec<f64> = m.omega_w.iter().map(nalgebra::Vector3::norm).collect();
    let noisy = d.steps.noisy;
    let top = if noisy {
        // The mean of what is near the top.
        let mut sorted = speeds.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        sorted[sorted.len() - 1 - sorted.len() / 50] - m.sigma
    } else {
        speeds.iter().copied().fold(0.0, f64::max)
    };
    let near = if noisy { 3.0 * m.sigma } else { 1e-6 * top };
    let at_top: Vec<bool> = speeds.iter().map(|s| (s - top).abs() <= near).collect();
    let rows = longest(&at_top);
    let (whole_noise, others) = (d.noise(), d.steps.windows.len());
    // Windows that fit into the plateau.
    let shorter;
    let d = if noisy && d.steps.length > rows / 3 {
        shorter = d.in_windows_of((rows / 3).max(8))?;
        &shorter
    } else {
        d
    };
    let predicted = d.predict(Law::RIGHT, false)?;
    let n = d.steps.windows.len();
    // Long runs at the top are plateaus; single rows there are chance.
    let plateau = runs(&at_top, if noisy { (rows / 4).max(8) } else { 3 });
    let (mut on, mut off) = (vec![false; n], vec![false; n]);
    for w in 0..n {
        let (from, until) = d.steps.rows(w);
        let inside = plateau[from..=until].iter().filter(|a| **a).count();
        // Steps that lead onto it are half clamped.
        let near = plateau[from.saturating_sub(3)..(until + 4).min(plateau.len())].contains(&true);
        on[w] = d.kept[w] && inside == until - from + 1;
        off[w] = d.kept[w] && !near;
    }
    // The law must hold off the plateau, as far as there is such a time, and be broken on it, against ω.
    let (ons, offs) = (
        on.iter().filter(|o| **o).count(),
        off.iter().filter(|o| **o).count(),
    );
    if ons < 2 {
        return None;
    }
    if offs < 3 {
        return None;
    }
    // Where it is clamped for a row or two now and then, the law does not hold either.
    let each = fit(&d.steps.measured, &predicted, None, &off);
    let holds: Vec<bool> = (0..n)
        .map(|w| off[w] && each.each[w].sqrt() <= 2.0 * d.bound(&each))
        .collect();
    if 3 * holds.iter().filter(|h| **h).count() < 2 * offs {
        return None;
    }
    let free = fit(&d.steps.measured, &predicted, None, &holds);
    let omega = d.steps.of_omega(|w| *w);
    let (mut against, mut whole, mut broken) = (0.0, 0.0, 0);
    let scale = rms(&d.steps.measured, &d.kept);
    for w in (0..n).filter(|&w| on[w]) {
        let left = d.steps.measured[w] - predicted[w];
        if left.norm() > (4.0 * d.noise()).max(0.01 * scale) {
            against -= left.dot(&omega[w]) / omega[w].norm();
            whole += left.norm();
            broken += 1;
        }
    }
    if broken < 2 || whole.is_nan() || against < if noisy { 0.8 } else { 0.95 } * whole {
        return None;
    }
    // As if its windows were as long as those of the others, which keep less noise.
    let mut free = free;
    if d.noise() > 0.0 {
        free.left *= whole_noise / d.noise();
    }
    free.each = vec![free.left * free.left; others];
    Some(
        Explained::new(CLAMP.id, free)
            .with("speed", top, "rad/s")
            .with("rows", rows as f64, "")
            .with("against_omega", against / whole, ""),
    )
}

fn longest(of: &[bool]) -> usize {
    let (mut longest, mut run) = (0, 0);
    for &at in of {
        run = if at { run + 1 } else { 0 };
        longest = longest.max(run);
    }
    longest
}

/// Those of the rows that lie in runs of at least so many.
fn runs(of: &[bool], least: usize) -> Vec<bool> {
    let mut found = vec![false; of.len()];
    let mut from = 0;
    for until in 0..=of.len() {
        if until == of.len() || !of[until] {
            if until - from >= least {
                found[from..until].fill(true);
            }
            from = until + 1;
        }
    }
    found
}
