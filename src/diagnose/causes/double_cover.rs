//! q and -q are one attitude. A flip of the sign from row to row is harmless, and named where all else is right; a controller that
//! multiplies by the sign goes the long way round: its torque flips along.

use super::{Cause, Judge};
use crate::diagnose::case::Case;
use crate::diagnose::motion::Motion;
use crate::diagnose::verdict::Found;
use nalgebra::Vector3;

pub(super) const DOUBLE_COVER: Cause = Cause {
    id: "double-cover",
    symptom: "a plot of q jumps from one sign to the other; or a controller turns 350° instead of 10°",
    test: "the sign of q flips from a row to the next. Nothing is wrong with that (verdict no-fault), unless a logged torque flips with it",
    does: "q and -q are the same attitude; some code keeps w ≥ 0, some goes on smoothly",
    formula: "the error of attitude is 2 sign(w) u",
    remedy: "compare attitudes by |q·p|; multiply a controller's error by the sign of w",
    example: "a recording with w kept positive",
    judge: Judge::Last,
};

/// The right law holds; but a torque that turns round where q does, without any other reason, is a controller's that takes q and -q for
/// two attitudes.
pub(in crate::diagnose) fn long_way(case: &Case, m: &Motion) -> Option<Found> {
    let torques = &case.rows().torques;
    if torques.len() != m.len() || m.flips.is_empty() {
        return None;
    }
    let tau = |k: usize| Vector3::from(torques[k]);
    let (mut turned, mut looked_at, mut by_chance, mut others) = (0, 0, 0, 0);
    for k in 1..m.len() {
        let (a, b) = (tau(k - 1), tau(k));
        let size = a.norm() * b.norm();
        if size.is_nan() || size <= 0.0 {
            continue;
        }
        // Turned round, and about as long.
        let round =
            a.dot(&b) < -0.5 * size && a.norm() < 2.0 * b.norm() && b.norm() < 2.0 * a.norm();
        if m.flips.binary_search(&k).is_ok() {
            looked_at += 1;
            turned += usize::from(round);
        } else {
            others += 1;
            by_chance += usize::from(round);
        }
    }
    // Most flips, and hardly any other row.
    if looked_at < 2 || 2 * turned < looked_at || 20 * by_chance > others {
        return None;
    }
    Some(
        Found::of(
            DOUBLE_COVER.id,
            format!("the torque turns round at {turned} of {looked_at} flips of the quaternion's sign, and nowhere else"),
        )
        .sure(turned as f64 / looked_at as f64 * 0.99)
        .with("flips", looked_at as f64, "")
        .with("torques_that_turn_round", turned as f64, ""),
    )
}
