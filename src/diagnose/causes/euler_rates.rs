//! `ω = α̇ a + R_a β̇ b + R_a R_b γ̇ c`: rates of angles are no components of ω. All six orders; intrinsic a b c is extrinsic c b a.

use super::{Cause, Judge};
use crate::diagnose::case::Case;
use crate::diagnose::verdict::{Found, RunnerUp, Said};

pub(super) const EULER_RATES: Cause = Cause {
    id: "euler-rates-as-omega",
    symptom: "fine near level; a spike near pitch 90°",
    test: "the attitudes turn by the ω that the logged numbers make as rates of roll, pitch and yaw, in one of six orders",
    does: "writes the derivatives of Euler's angles as ω",
    formula: "ω = α̇ a + R_a β̇ b + R_a R_b γ̇ c for R = R_a(α) R_b(β) R_c(γ)",
    remedy: "turn the rates into ω, or better: never leave ω for angles",
    example: "a tumbling body",
    judge: Judge::First(judge),
};

fn judge(case: &Case) -> Said {
    let Some(kinematics) = case.kinematics() else {
        return Said::Pass;
    };
    let (as_logged, Some((order, residual))) = (kinematics.as_logged, kinematics.euler) else {
        return Said::Pass;
    };
    let rigid = kinematics.best.map_or(f64::INFINITY, |b| b.residual);
    if as_logged <= kinematics.bound || residual > 0.3 * as_logged.min(rigid) || residual > 0.15 {
        return Said::Pass;
    }
    let order: Vec<&str> = order.iter().map(|&i| ["x", "y", "z"][i]).collect();
    let mut found = Found::of(
        EULER_RATES.id,
        format!(
            "as logged, {as_logged:.2} of the turning is left unexplained; as rates of angles about {} in turn, {residual:.1e}",
            order.join(", ")
        ),
    )
    .sure(1.0 - residual / as_logged.min(rigid))
    .with("residual_as_logged", as_logged, "")
    .with("residual", residual, "");
    found.runner_up = Some(RunnerUp {
        cause: "as-declared",
        behind: as_logged / residual.max(1e-9),
    });
    Said::Fault(found)
}
