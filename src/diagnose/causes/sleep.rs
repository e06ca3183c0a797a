//! A slow spin that ends from one row to the next, with nothing that acts: ω is zero from then on, and the attitude stays.

use super::{Cause, Judge};
use crate::diagnose::case::Case;
use crate::diagnose::verdict::{Found, Said};

pub(super) const SLEEP: Cause = Cause {
    id: "sleep",
    symptom: "a slow spin stops abruptly; a body hangs still until it is touched",
    test: "|ω| below 1.5 rad/s drops to nothing within three rows, without a torque, and stays there with the attitude",
    does: "puts a body to sleep whose speed stays below a threshold",
    formula: "dL/dt = τ: without a torque a spin goes on",
    remedy: "lower the threshold, or forbid sleep for bodies that may turn slowly",
    example: "a body turning freely at 0.3 rad/s",
    judge: Judge::First(judge),
};

/// Engines' thresholds go up to about 1 rad/s; what stops above that was stopped by something.
const SLOW: f64 = 1.5;
/// Rows that must stay at rest.
const STILL: usize = 8;

fn judge(case: &Case) -> Said {
    let Some(m) = case.motion() else {
        return Said::Pass;
    };
    if m.derived || m.len() < 2 * STILL {
        return Said::Pass;
    }
    // Noise is not measured by fifth differences where most rows may be zeros.
    let quiet = m.sigma.max(0.01 * m.speed);
    let noisy = m.omega_w.iter().rev().take(STILL).any(|w| w.norm() > 1e-12);
    let still = if noisy { 5.0 * quiet } else { 1e-12 };
    let mut k = 0;
    while k < m.len() {
        let rest = m.omega_w[k..]
            .iter()
            .take_while(|w| w.norm() <= still)
            .count();
        if rest < STILL {
            k += rest.max(1);
            continue;
        }
        // Three rows before the rest, and the spin before those.
        let before = k.saturating_sub(3);
        let from = before.saturating_sub(STILL);
        if before > from {
            let rows = &m.omega_w[from..before];
            let mean = rows.iter().sum::<nalgebra::Vector3<f64>>() / rows.len() as f64;
            let speed = mean.norm();
            let wander = rows.iter().map(|w| (w - mean).norm()).fold(0.0, f64::max);
            let acted = (from..(k + 1).min(m.len())).any(|k| case.acts_at(k));
            let turned = crate::math::angle_between(m.q[k], m.q[k + rest - 1]);
            let would = speed * (m.times[k + rest - 1] - m.times[k]);
            let frozen = turned < 0.1 * would || turned < 6.0 * m.sigma_q.max(1e-9);
            if speed > 3.0 * still && speed < SLOW && wander < 0.3 * speed && !acted && frozen {
                return Said::Fault(
                    Found::of(
                        SLEEP.id,
                        format!(
                            "at {} s a spin of {speed:.3} rad/s ends at once, and nothing acts",
                            m.times[k]
                        ),
                    )
                    .sure(0.97)
                    .with("speed_before", speed, "rad/s")
                    .with("at", m.times[k], "s")
                    .with("rows_at_rest", rest as f64, ""),
                );
            }
        }
        k += rest;
    }
    Said::Pass
}
