//! Do attitudes turn as ω says? If not: read how do they?
//!
//! ```text
//! δ = s M P ω̄,   ω̄ = ½ (ω_k + ω_{k+1})
//! M ∈ {1, R, Rᵀ}      P one of 48 signed permutations of axes      s ∈ {1, 2, ½, π/180, 180/π, 1/h, h}
//! q as logged, (w, x, y, z) taken for (x, y, z, w), conjugated, or both
//! ```
//!
//! Both sides are smoothed by Hann's window; what is left over, over what there is, is the residual. `P` and `M` are told apart
//! because `M⁻¹ δ` is smoothed, not δ. Euler's rates are tried for each of six orders: `ω = α̇ a + R_a β̇ b + R_a R_b γ̇ c`.

use super::motion::{Motion, hann};
use crate::log::Rows;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::PI;

/// Rows of a window.
pub const WINDOW: usize = 12;
/// cos 0.25: nearer to the singular pitch rows are left out.
const COS_NEAR: f64 = 0.968_912_421_710_644_8;
/// Windows that the search looks at.
const LOOKED_AT: usize = 64;

/// In which frame ω is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    World,
    Body,
    /// `ω = R δ`: turned once too often.
    Beyond,
}

/// How the log is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    pub w_first: bool,
    pub conjugated: bool,
    pub frame: Frame,
    pub axes: Matrix3<f64>,
    pub scale: Scale,
    /// What is left unexplained.
    pub residual: f64,
}

/// A factor on ω.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scale {
    One,
    /// 2 or ½.
    Half(f64),
    /// 180/π or π/180.
    Degrees(f64),
    /// 1/h or h.
    Rate(f64),
}

impl Scale {
    fn factor(self) -> f64 {
        match self {
            Self::One => 1.0,
            Self::Half(s) | Self::Degrees(s) | Self::Rate(s) => s,
        }
    }
}

impl Reading {
    /// In how many ways it is not as it should be.
    pub fn oddities(&self) -> usize {
        usize::from(self.w_first)
            + usize::from(self.conjugated)
            + usize::from(self.frame != Frame::World)
            + usize::from(self.axes != Matrix3::identity())
            + usize::from(self.scale != Scale::One)
    }
}

/// `(q[3], q[0], q[1], q[2])`: what was written w first, put right.
pub fn w_first([w, x, y, z]: [f64; 4]) -> [f64; 4] {
    [x, y, z, w]
}

pub fn conjugated([x, y, z, w]: [f64; 4]) -> [f64; 4] {
    [-x, -y, -z, w]
}

/// What attitudes and ω leave of each other as they are logged, over all rows: windows one after the other, the worst tenth of
/// them left out (knocks, jumps). 0 where nothing turns.
pub fn as_logged(m: &Motion) -> f64 {
    let weights = hann(WINDOW);
    let (mut left, mut whole, mut inside) = (Vector3::zeros(), Vector3::zeros(), 0);
    let mut found = Vec::with_capacity(m.len() / WINDOW);
    for k in 0..m.usable.len() {
        if !m.usable[k] {
            inside = 0;
            (left, whole) = (Vector3::zeros(), Vector3::zeros());
            continue;
        }
        let (delta, omega) = (m.delta(k), (m.omega_w[k] + m.omega_w[k + 1]) * 0.5);
        let weight = weights[inside];
        left += (delta - omega) * weight;
        whole += delta * weight;
        inside += 1;
        if inside == WINDOW {
            found.push((left.norm_squared(), whole.norm_squared()));
            inside = 0;
            (left, whole) = (Vector3::zeros(), Vector3::zeros());
        }
    }
    found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    found.truncate(found.len() - found.len() / 10);
    let sum = |of: fn(&(f64, f64)) -> f64| found.iter().map(of).sum::<f64>();
    let size = sum(|f| f.1).max(m.speed * m.speed * found.len() as f64 * 1e-6);
    if size > 0.0 {
        (sum(|f| f.0) / size).sqrt()
    } else {
        0.0
    }
}

/// What noise alone leaves, by what was measured of it.
pub fn floor(m: &Motion) -> f64 {
    if m.speed == 0.0 || m.h == 0.0 {
        return 0.0;
    }
    let w = WINDOW as f64;
    let attitudes = m.sigma_q / m.h * (2.0 * PI * PI / (w * w * w)).sqrt();
    let rates = m.sigma * (1.5 / w).sqrt();
    (3.0 * (attitudes * attitudes + rates * rates)).sqrt() / m.speed
}

/// All readings tried, the best first; of equally good ones the plainest.
pub fn search(rows: &Rows, m: &Motion) -> Vec<Reading> {
    let mut all = Vec::new();
    let scales = [
        Scale::One,
        Scale::Half(2.0),
        Scale::Half(0.5),
        Scale::Degrees(PI / 180.0),
        Scale::Degrees(180.0 / PI),
        Scale::Rate(1.0 / m.h),
        Scale::Rate(m.h),
    ];
    for (first, turned_round) in [(false, false), (true, false), (false, true), (true, true)] {
        let change = |q| {
            let q = if first { w_first(q) } else { q };
            if turned_round { conjugated(q) } else { q }
        };
        let Some(m) = Motion::read(rows, change) else {
            continue;
        };
        for frame in [Frame::World, Frame::Body, Frame::Beyond] {
            let pairs = smoothed(&m, frame);
            for axes in signed_permutations() {
                for scale in scales {
                    all.push(Reading {
                        w_first: first,
                        conjugated: turned_round,
                        frame,
                        axes,
                        scale,
                        residual: residual(&pairs, &(axes * scale.factor())),
                    });
                }
            }
        }
    }
    all.retain(|r| r.residual.is_finite());
    all.sort_by(|a, b| (a.residual.total_cmp(&b.residual)).then(a.oddities().cmp(&b.oddities())));
    all
}

/// `(M⁻¹ δ, ω̄)` smoothed, in some windows.
fn smoothed(m: &Motion, frame: Frame) -> Vec<(Vector3<f64>, Vector3<f64>)> {
    let weights = hann(WINDOW);
    let windows = m.windows(WINDOW, WINDOW);
    let apart = (windows.len() / LOOKED_AT).max(1);
    (windows.iter().step_by(apart))
        .map(|&from| {
            let (mut d, mut w) = (Vector3::zeros(), Vector3::zeros());
            for (j, weight) in weights.iter().enumerate() {
                let k = from + j;
                let delta = m.delta(k);
                // The attitude half way.
                let mid = half_way(m, k);
                let delta = match frame {
                    Frame::World => delta,
                    Frame::Body => mid.inverse_transform_vector(&delta),
                    Frame::Beyond => mid.transform_vector(&delta),
                };
                d += delta * *weight;
                w += (m.omega_w[k] + m.omega_w[k + 1]) * (0.5 * weight);
            }
            (d, w)
        })
        .collect()
}

pub fn half_way(m: &Motion, k: usize) -> nalgebra::UnitQuaternion<f64> {
    nalgebra::UnitQuaternion::new_normalize(m.q[k].into_inner() + m.q[k + 1].into_inner())
}

/// Over the larger of both sides, so that a tiny ω does not explain a tiny δ; the worst tenth of windows left out.
fn residual(pairs: &[(Vector3<f64>, Vector3<f64>)], map: &Matrix3<f64>) -> f64 {
    let mut errors = [0.0; 2 * LOOKED_AT];
    let (mut n, mut delta, mut omega) = (0, 0.0, 0.0);
    for (d, w) in pairs.iter().take(2 * LOOKED_AT) {
        let w = map * w;
        errors[n] = (d - w).norm_squared();
        delta += d.norm_squared();
        omega += w.norm_squared();
        n += 1;
    }
    let errors = &mut errors[..n];
    errors.sort_unstable_by(f64::total_cmp);
    let kept = n - n / 10;
    let mean = errors[..kept].iter().sum::<f64>() / kept as f64;
    (mean * n as f64 / delta.max(omega)).sqrt()
}

fn signed_permutations() -> Vec<Matrix3<f64>> {
    let orders = [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
    ];
    let mut all = Vec::with_capacity(48);
    for order in orders {
        for signs in 0..8 {
            let mut p = Matrix3::zeros();
            for (row, column) in order.into_iter().enumerate() {
                p[(row, column)] = if signs >> row & 1 == 1 { -1.0 } else { 1.0 };
            }
            all.push(p);
        }
    }
    all
}

/// The order of Euler's angles whose rates ω is, and what that leaves; the best of six.
pub fn euler(m: &Motion) -> Option<([usize; 3], f64)> {
    let orders = [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
    ];
    let weights = hann(WINDOW);
    let windows = m.windows(WINDOW, WINDOW);
    let apart = (windows.len() / LOOKED_AT / 2).max(1);
    let mut best: Option<([usize; 3], f64)> = None;
    for order in orders {
        let (mut left, mut whole, mut used) = (Vec::new(), 0.0, 0);
        'windows: for &from in windows.iter().step_by(apart) {
            let (mut error, mut size) = (Vector3::zeros(), Vector3::zeros());
            for (j, weight) in weights.iter().enumerate() {
                let k = from + j;
                let Some(axes) = euler_axes(&half_way(m, k), order) else {
                    continue 'windows;
                };
                let delta = m.delta(k);
                error += (delta - axes * (m.omega_w[k] + m.omega_w[k + 1]) * 0.5) * *weight;
                size += delta * *weight;
            }
            left.push(error.norm_squared());
            whole += size.norm_squared();
            used += 1;
        }
        if used < 4 || whole == 0.0 {
            continue;
        }
        left.sort_unstable_by(f64::total_cmp);
        left.truncate(used - used / 10);
        let residual = (left.iter().sum::<f64>() / whole).sqrt();
        if best.is_none_or(|b| residual < b.1) {
            best = Some((order, residual));
        }
    }
    best
}

/// The matrix that makes ω of the rates of `R = R_a(α) R_b(β) R_c(γ)`, each in the slot of its axis; none within 0.25 rad of the
/// pitch at which two of its columns fall together.
fn euler_axes(q: &nalgebra::UnitQuaternion<f64>, [a, b, c]: [usize; 3]) -> Option<Matrix3<f64>> {
    let unit = |i: usize| Vector3::ith(i, 1.0);
    let third = q.transform_vector(&unit(c));
    // |sin β| of the middle angle.
    if third[a].abs() > COS_NEAR {
        return None;
    }
    // R_a e_b is square to both a and the third axis.
    let sign = if (a + 1) % 3 == b { 1.0 } else { -1.0 };
    let second = third.cross(&unit(a)) * sign;
    let mut axes = Matrix3::zeros();
    axes.set_column(a, &unit(a));
    axes.set_column(b, &second.try_normalize(1e-9)?);
    axes.set_column(c, &third);
    Some(axes)
}
