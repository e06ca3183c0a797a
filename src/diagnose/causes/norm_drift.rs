//! `max |mean over a window of |q| - 1| > 1e-3`. Means, because noise on the components is no drift.

use super::{Cause, Judge};
use crate::diagnose::case::Case;
use crate::diagnose::verdict::{Found, Said};

pub(super) const NORM_DRIFT: Cause = Cause {
    id: "norm-drift",
    symptom: "bodies grow, shear or shrink slowly; after a while NaN",
    test: "the length of the quaternion, averaged over 16 rows, is off 1 by more than 0.001",
    does: "adds ½ h ω q to q and never divides by its length",
    formula: "q ← q + ½ h (ω, 0) q, then q ← q / |q|; or q ← exp(h ω / 2) q",
    remedy: "normalise the quaternion after every step",
    example: "any spin: the length grows by (|ω| h)² / 8 a step",
    judge: Judge::First(judge),
};

const ROWS: usize = 16;
/// A recording prints at least four digits, and an engine of f32 keeps 1e-7.
const OFF: f64 = 1e-3;

fn judge(case: &Case) -> Said {
    let (mut sum, mut inside, mut worst, mut at) = (0.0, 0, 0.0_f64, 0.0);
    for (q, t) in case.rows().attitudes.iter().zip(&case.rows().times) {
        let length = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]).sqrt();
        if !(length > 1e-6 && length < 1e6) {
            continue;
        }
        sum += length - 1.0;
        inside += 1;
        if inside == ROWS {
            let mean = sum / ROWS as f64;
            if mean.abs() > worst.abs() {
                (worst, at) = (mean, *t);
            }
            (sum, inside) = (0.0, 0);
        }
    }
    if worst.abs() <= OFF {
        return Said::Pass;
    }
    Said::Fault(
        Found::of(
            NORM_DRIFT.id,
            format!("the quaternion's length is off 1 by {worst:.2e} at {at} s"),
        )
        .sure(0.99)
        .with("length_minus_1", worst, "")
        .with("at", at, "s"),
    )
}
