//! The body turns about the wrong point: `centre` finds r, the declared offset is c.
//!
//! Accused only where r goes less than a quarter of the way to c, and c is many errors long.

use super::{Cause, Judge};
use crate::diagnose::case::Case;
use crate::diagnose::verdict::{Found, RunnerUp, Said};

pub(super) const CENTRE_IGNORED: Cause = Cause {
    id: "centre-of-mass-ignored",
    symptom: "\"starts to spin wildly\"; a hammer that turns about the end of its handle",
    test: "least squares in position find the point about which the body turns: at the origin, not at the declared centre of mass",
    does: "moves and turns the body about its origin as if the mass were there",
    formula: "x_origin = x_c - R c; the centre of mass x_c moves as the forces say, and levers go from it",
    remedy: "integrate the centre of mass, and place the origin from it",
    example: "a tumbling body with an offset of its centre of mass, positions logged",
    judge: Judge::First(judge),
};

fn judge(case: &Case) -> Said {
    let (Some(declared), Some(centre)) = (&case.logged.declared, case.centre()) else {
        return Said::Pass;
    };
    let c = declared.centre_of_mass_b;
    let length = c.norm();
    if length == 0.0 {
        return Said::Pass;
    }
    // What is left must be far below the offset, and so the error of r.
    if centre.left > 0.1 * length || centre.error > 0.05 * length {
        return Said::Pass;
    }
    let along = centre.r.dot(&c) / (length * length);
    let off = centre.r.norm() / length;
    if along.abs() > 0.25 || off > 0.35 {
        return Said::Pass;
    }
    let mut found = Found::of(
        CENTRE_IGNORED.id,
        format!(
            "the centre of mass is declared {length:.4} m from the origin, and the body turns about a point {:.1e} m from it",
            centre.r.norm()
        ),
    )
    .sure(0.98)
    .with("declared_offset", length, "m")
    .with("found_offset_of_declared", along, "")
    .with("left", centre.left, "m");
    found.runner_up = Some(RunnerUp {
        cause: "as-declared",
        behind: (centre.r - c).norm() / centre.r.norm().max(centre.error).max(1e-12),
    });
    Said::Fault(found)
}
