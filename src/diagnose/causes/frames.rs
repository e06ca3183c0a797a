//! Attitudes and ω that do not belong together: by the kinematic search (`kinematics`).
//!
//! Accused only where as logged more than 0.02 is left and the best reading leaves less than 0.3 of that. ω logged in body axes
//! and a product on the wrong side share `δ = R ω`: there the dynamics decide, where they can.

use super::{Cause, Judge};
use crate::diagnose::case::Case;
use crate::diagnose::kinematics::{Frame, Reading, Scale};
use crate::diagnose::verdict::{Found, RunnerUp, Said};

pub(super) const OMEGA_IN_BODY: Cause = Cause {
    id: "angular-velocity-in-body-frame",
    symptom: "fine until the body is tilted; it \"rotates with its own coordinate system\"",
    test: "the attitudes turn by R ω, not by ω, and ω obeys Euler's equation in body axes",
    does: "writes ω in body axes where world axes are meant, or reads it so",
    formula: "ω_w = R ω_b",
    remedy: "turn ω by the attitude before it is logged or used as a world vector",
    example: "a tumbling box, ω from a gyroscope",
    judge: Judge::First(judge),
};

pub(super) const WRONG_SIDE: Cause = Cause {
    id: "quaternion-multiplied-on-wrong-side",
    symptom: "opposite or strange turns as soon as the body is tilted",
    test: "the attitudes turn by R ω, not by ω, while ω obeys Euler's equation in the world",
    does: "q ← q exp(h ω_w / 2): multiplies a world ω on the right",
    formula: "world ω on the left, q ← exp(h ω_w / 2) q; body ω on the right, q ← q exp(h ω_b / 2)",
    remedy: "swap the factors, or turn ω into body axes",
    example: "a tumbling box",
    judge: Judge::Along,
};

pub(super) const ORDER: Cause = Cause {
    id: "quaternion-order",
    symptom: "no correlation between two tools that read the same attitude",
    test: "(w, x, y, z) read as (x, y, z, w) makes attitudes that do not turn by ω; put right they do",
    does: "takes w first where it comes last, or the other way",
    formula: "(x, y, z, w) here; w = cos θ/2",
    remedy: "name the components instead of counting them",
    example: "any tumbling body",
    judge: Judge::Along,
};

pub(super) const CONJUGATED: Cause = Cause {
    id: "quaternion-conjugated",
    symptom: "turns the opposite way; right for small or single turns only",
    test: "the conjugates of the attitudes turn by ω, the attitudes as logged do not",
    does: "writes world to body where body to world is meant",
    formula: "v_w = q v_b q⁻¹",
    remedy: "conjugate, or transpose the matrix that it is made of",
    example: "any tumbling body",
    judge: Judge::Along,
};

pub(super) const HALF_FACTOR: Cause = Cause {
    id: "half-factor",
    symptom: "turns twice the angle, or half of it",
    test: "the attitudes turn by 2 ω or by ½ ω",
    does: "forgets the ½ of q̇ = ½ ω q, or puts it twice",
    formula: "q̇ = ½ (ω, 0) q",
    remedy: "one factor of ½, there and nowhere else",
    example: "any spin",
    judge: Judge::Along,
};

pub(super) const DEGREES: Cause = Cause {
    id: "degrees",
    symptom: "57 times too fast or too slow",
    test: "the attitudes turn by π/180 ω or by 180/π ω",
    does: "mixes degrees and radians",
    formula: "1 rad = 180/π degrees",
    remedy: "radians inside, degrees only where somebody reads them",
    example: "any spin",
    judge: Judge::Along,
};

pub(super) const HANDEDNESS: Cause = Cause {
    id: "handedness",
    symptom: "one or two axes turn the wrong way, or axes are swapped",
    test: "the attitudes turn by P ω with a signed permutation P of the axes; a mirror takes ω, a pseudovector, to -S ω",
    does: "converts between left- and right-handed axes (or y up and z up) as if ω were a vector, or converts only one of attitude and ω",
    formula: "mirrored by S, det S = -1: v' = S v, ω' = -S ω, q' = (-S u, w)",
    remedy: "convert attitude and ω together, ω with the sign of det S",
    example: "any tumbling body",
    judge: Judge::Along,
};

fn judge(case: &Case) -> Said {
    let Some(kinematics) = case.kinematics() else {
        return Said::Pass;
    };
    let as_logged = kinematics.as_logged;
    if as_logged <= kinematics.bound {
        return Said::Pass;
    }
    let Some(best) = kinematics.best else {
        return Said::Pass;
    };
    let euler = kinematics.euler.map_or(f64::INFINITY, |e| e.1);
    let limit = (0.3 * as_logged).min(0.15);
    if best.residual > limit {
        return if euler > limit && as_logged > 0.1 {
            Said::Void(
                format!(
                    "attitudes and ω do not belong together ({as_logged:.2} of the turning is left unexplained), and no \
                     reading that is known explains it ({:.2} is left by the best)",
                    best.residual
                ),
                "log both at the same instant of the same step; derive nothing from rendered poses"
                    .to_owned(),
            )
        } else {
            Said::Pass
        };
    }
    if euler < 0.3 * best.residual {
        return Said::Pass;
    }
    if let Scale::Rate(s) = best.scale {
        return Said::Void(
            format!(
                "ω is off by a factor of {s:.6}, the row interval or its inverse: an angle per row?"
            ),
            "log ω in radians per second".to_owned(),
        );
    }
    let mut causes = causes(case, &best);
    for other in &kinematics.others {
        for cause in self::causes(case, other) {
            if !causes.contains(&cause) && other.scale == best.scale {
                causes.push(cause);
            }
        }
    }
    // By windows that were left out above the log may be as it should.
    let Some(&first) = causes.first() else {
        return Said::Pass;
    };
    let runner_up = kinematics.runner_up.map(|r| RunnerUp {
        cause: name(&r),
        behind: r.residual / best.residual.max(1e-9),
    });
    let mut found = Found::of(
        first,
        format!(
            "as logged, {as_logged:.2} of the turning is left unexplained; {} leaves {:.1e}",
            said(&best),
            best.residual
        ),
    )
    .sure(1.0 - best.residual / as_logged)
    .with("residual_as_logged", as_logged, "")
    .with("residual", best.residual, "");
    found.causes = causes;
    found.runner_up = runner_up;
    Said::Fault(found)
}

fn name(r: &Reading) -> &'static str {
    if r.oddities() == 0 {
        "as-declared"
    } else if r.w_first {
        ORDER.id
    } else if r.conjugated {
        CONJUGATED.id
    } else if r.axes != nalgebra::Matrix3::identity() {
        HANDEDNESS.id
    } else if let Scale::Degrees(_) = r.scale {
        DEGREES.id
    } else if let Scale::Half(_) = r.scale {
        HALF_FACTOR.id
    } else if r.frame == Frame::World {
        "as-declared"
    } else {
        OMEGA_IN_BODY.id
    }
}

fn causes(case: &Case, r: &Reading) -> Vec<&'static str> {
    let first = name(r);
    if first == OMEGA_IN_BODY.id && r.frame == Frame::Body {
        // By which of the two the dynamics hold.
        return match case.body_or_side() {
            Some(true) => vec![OMEGA_IN_BODY.id],
            Some(false) => vec![WRONG_SIDE.id],
            None => vec![OMEGA_IN_BODY.id, WRONG_SIDE.id],
        };
    }
    if first == "as-declared" {
        Vec::new()
    } else {
        vec![first]
    }
}

fn said(r: &Reading) -> String {
    let mut parts = Vec::new();
    if r.w_first {
        parts.push("w first".to_owned());
    }
    if r.conjugated {
        parts.push("the conjugate".to_owned());
    }
    match r.frame {
        Frame::World => {}
        Frame::Body => parts.push("ω in body axes".to_owned()),
        Frame::Beyond => parts.push("ω turned once too often".to_owned()),
    }
    if r.axes != nalgebra::Matrix3::identity() {
        let row = |i: usize| {
            let j = (0..3).find(|&j| r.axes[(i, j)] != 0.0).unwrap_or(i);
            format!(
                "{}{}",
                if r.axes[(i, j)] < 0.0 { "-" } else { "" },
                ["x", "y", "z"][j]
            )
        };
        parts.push(format!(
            "ω's axes read ({}, {}, {})",
            row(0),
            row(1),
            row(2)
        ));
    }
    match r.scale {
        Scale::One => {}
        Scale::Half(s) | Scale::Degrees(s) | Scale::Rate(s) => {
            parts.push(format!("ω times {s:.6}"))
        }
    }
    parts.join(", ")
}
