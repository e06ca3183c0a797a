//! Numbers that lie on a coarse grid: attitudes of 16 bits, positions of 32 bits far from the origin.
//!
//! ```text
//! on a grid of p bits:  |x - round_p(x)| ≤ 1/20 of the gap, for 99% of many distinct values
//! ```
//!
//! By chance a tenth of all values would be so near. Rows at rest are left out: they repeat whatever the precision.

use super::{Cause, Judge};
use crate::diagnose::case::Case;
use crate::diagnose::motion::median;
use crate::diagnose::verdict::{Found, Said};

pub(super) const PRECISION: Cause = Cause {
    id: "precision",
    symptom: "jitters far from the origin; turns in little jumps; NaN",
    test: "positions are f32 whose gap is a fair part of a row's move; or attitudes lie on a grid of 16 bits or less",
    does: "keeps positions or attitudes in too few bits",
    formula: "the gap of an f32 at x is 2⁻²³ |x|: 0.06 m at 10⁶ m; of an f16 below 1, up to 0.0005",
    remedy: "f64 for world positions, or an origin that follows; at least f32 for attitudes",
    example: "a body at 10⁶ m in f32",
    judge: Judge::First(judge),
};

fn judge(case: &Case) -> Said {
    attitudes(case)
        .or_else(|| positions(case))
        .map_or(Said::Pass, Said::Fault)
}

/// The gap between numbers of so many bits at x.
fn gap(x: f64, bits: i32) -> f64 {
    libm::exp2(libm::floor(libm::log2(x.abs())) - f64::from(bits - 1))
}

fn on_grid(x: f64, gap: f64) -> bool {
    let n = x / gap;
    (n - n.round()).abs() < 0.05
}

/// 0 and ±1 lie on any grid, and so do halves: a value that comes again says nothing new.
fn distinct(mut values: Vec<f64>) -> Vec<f64> {
    values.retain(|x| x.is_finite() && x.abs() > 1e-3 && x.abs() < 0.9999);
    values.sort_unstable_by(f64::total_cmp);
    values.dedup();
    values
}

fn attitudes(case: &Case) -> Option<Found> {
    let rows = case.rows();
    let apart = (rows.attitudes.len() / 2_000).max(1);
    let values = distinct(
        rows.attitudes
            .iter()
            .step_by(apart)
            .flatten()
            .copied()
            .collect(),
    );
    if values.len() < 60 {
        return None;
    }
    let share = |near: &dyn Fn(f64) -> bool| {
        values.iter().filter(|x| near(**x)).count() as f64 / values.len() as f64
    };
    let floating = share(&|x| on_grid(x, gap(x, 11)));
    // bfloat16, and signed fractions of 8, 10, 12 and 16 bits.
    let brain = share(&|x| on_grid(x, gap(x, 8)));
    if floating > 0.99 || brain > 0.99 {
        let bits = if brain > 0.99 { 8.0 } else { 11.0 };
        return Some(
            Found::of(
                PRECISION.id,
                format!("attitudes lie on the grid of a float with {bits} bits of precision"),
            )
            .sure(0.98)
            .with("share_on_grid", floating.max(brain), "")
            .with("bits", bits, ""),
        );
    }
    for steps in [127.0, 128.0, 511.0, 512.0, 2047.0, 2048.0, 32767.0, 32768.0] {
        let on = share(&|x| on_grid(x, 1.0 / steps));
        // In print a digit more would be as good; steps of a third of a milliradian are what a fast turn hides.
        if on > 0.99 {
            return Some(
                Found::of(
                    PRECISION.id,
                    format!("attitudes lie on a grid of 1/{steps}"),
                )
                .sure(0.95)
                .with("share_on_grid", on, "")
                .with("gap", 1.0 / steps, ""),
            );
        }
    }
    None
}

fn positions(case: &Case) -> Option<Found> {
    let rows = case.rows();
    let apart = (rows.positions.len() / 4_000).max(1);
    let mut worst: Option<Found> = None;
    for axis in 0..3 {
        let x: Vec<f64> = rows.positions.iter().map(|p| p[axis]).collect();
        let largest = x
            .iter()
            .filter(|x| x.is_finite())
            .fold(0.0_f64, |a, x| a.max(x.abs()));
        if largest < 1.0 || x.len() < 60 {
            continue;
        }
        let some = x.iter().step_by(apart);
        let near = some
            .clone()
            .filter(|x| **x == 0.0 || on_grid(**x, gap(**x, 24)))
            .count();
        if (near as f64) < 0.99 * some.count() as f64 {
            continue;
        }
        let gap = gap(largest, 24);
        let moves: Vec<f64> = x
            .windows(2)
            .map(|w| (w[1] - w[0]).abs())
            .filter(|d| d.is_finite())
            .collect();
        let went = moves.iter().sum::<f64>();
        let still = moves.iter().filter(|d| **d == 0.0).count();
        let mut jumps: Vec<f64> = moves.iter().copied().filter(|d| *d > 0.0).collect();
        // It moves in jumps of a gap or two, and stands in between.
        if jumps.is_empty() || went < gap {
            continue;
        }
        let jump = median(&mut jumps);
        let mean = went / moves.len() as f64;
        if jump < 4.5 * gap && (still as f64) > 0.1 * moves.len() as f64 && gap > 0.05 * mean {
            let found = Found::of(
                PRECISION.id,
                format!("at {largest:.3e} m from the origin an f32 moves in jumps of {gap:.1e} m"),
            )
            .sure(0.97)
            .with("distance", largest, "m")
            .with("gap", gap, "m")
            .with("mean_move", mean, "m");
            worst.get_or_insert(found);
        }
    }
    worst
}
