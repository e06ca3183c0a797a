//! What is right and surprises, with its numbers.

use super::case::Case;
use super::energy::Drift;
use super::motion::Motion;
use crate::math::symmetric_eigen;
use nalgebra::Vector3;

/// Said of a body with which nothing is wrong.
pub fn surprises(case: &Case, m: &Motion, drift: Option<Drift>) -> Vec<String> {
    let mut all = Vec::new();
    let flips = m.flips.len();
    if flips > 0 {
        all.push(format!(
            "the sign of the quaternion flips {flips} times (first at {} s): q and -q are the same attitude",
            m.times[m.flips[0]]
        ));
    }
    let Some(inertia) = case.inertia() else {
        return all;
    };
    let n = m.len();
    let apart = (n / 5_000).max(1);
    let rows: Vec<usize> = (0..n).step_by(apart).collect();
    let acts = (0..n).any(|k| case.acts_at(k));
    let mean = |of: &dyn Fn(usize) -> Vector3<f64>| {
        rows.iter().map(|&k| of(k)).sum::<Vector3<f64>>() / rows.len() as f64
    };
    let spread = |of: &dyn Fn(usize) -> Vector3<f64>| {
        let middle = mean(of);
        let square = rows
            .iter()
            .map(|&k| (of(k) - middle).norm_squared())
            .sum::<f64>()
            / rows.len() as f64;
        square.sqrt() / middle.norm().max(1e-300)
    };
    let momentum = |k: usize| m.q[k].transform_vector(&(inertia * m.omega_b[k]));
    let omega = |k: usize| m.omega_w[k];
    if !acts {
        let (l, w) = (spread(&momentum), spread(&omega));
        if w > 0.05 && l < 0.05 {
            all.push(format!(
                "ω wanders by {:.0}% in the world though nothing acts, because the moments differ; L is constant to {l:.1e}",
                100.0 * w
            ));
        }
    } else {
        let turned = turned_by_torque(case, m, &rows);
        if let Some(degrees) = turned {
            all.push(format!(
                "α points up to {degrees:.0}° away from the torque: I⁻¹ turns it, and the gyroscopic term adds to it"
            ));
        }
    }
    let (axes, moments) = symmetric_eigen(&inertia);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| moments[a].total_cmp(&moments[b]));
    let [small, middle, large] = order;
    let close = |a: f64, b: f64| (a - b).abs() < 0.02 * a.max(b);
    if close(moments[small], moments[middle]) || close(moments[middle], moments[large]) {
        let axis = if close(moments[small], moments[middle]) {
            large
        } else {
            small
        };
        let about = axes.column(axis).into_owned();
        let tilt = mean(&|k| {
            let w = m.omega_b[k];
            Vector3::new(w.dot(&about).abs() / w.norm().max(1e-300), 0.0, 0.0)
        });
        if tilt.x < 0.995 {
            all.push("it wobbles: a body of revolution that spins off its axis precesses about L, freely and for ever".to_owned());
        }
    } else {
        // The spin about the middle axis turns over.
        let (mut turns, mut sign) = (0, 0.0);
        for &k in &rows {
            let w = m.omega_b[k];
            let along = w.dot(&axes.column(middle)) / w.norm().max(1e-300);
            if along.abs() > 0.7 {
                if sign * along < 0.0 {
                    turns += 1;
                }
                sign = along.signum();
            }
        }
        if turns > 0 {
            all.push(format!(
                "it turns over {turns} times: a spin about the middle axis is unstable (Dzhanibekov, the tennis racket)"
            ));
        }
    }
    if let Some(drift) = drift
        && drift.part.abs() < 0.005
    {
        all.push(format!(
            "E less the work of the torques is constant to {:.1e}",
            drift.part.abs().max(drift.error)
        ));
    }
    all
}

/// The largest angle between the torque and dω/h, smoothed over a few rows, in degrees; None where that is little.
fn turned_by_torque(case: &Case, m: &Motion, rows: &[usize]) -> Option<f64> {
    let tau = case.torque_about_centre(m)?;
    let largest = rows.iter().map(|&k| tau[k].norm()).fold(0.0, f64::max);
    let mut worst = 0.0_f64;
    for &k in rows {
        let next = (k + 8).min(m.len() - 1);
        if tau[k].norm() < 0.3 * largest || next <= k {
            continue;
        }
        let alpha = m.omega_w[next] - m.omega_w[k];
        let (a, t) = (alpha.norm(), tau[k].norm());
        if a > 0.05 * m.speed * 0.1 {
            let cos = (alpha.dot(&tau[k]) / (a * t)).clamp(-1.0, 1.0);
            worst = worst.max(libm::acos(cos).to_degrees());
        }
    }
    (worst > 20.0).then_some(worst)
}
