//! A log made ready: attitudes of unit length and one sign, ω in both frames, which steps can be used, how much noise.
//!
//! ```text
//! δ_k = Log(q_{k+1} q_k⁻¹) / (t_{k+1} - t_k)          the measured rate, world
//! σ   = median |Δ⁵ ω| / (0.6745 √252)                 noise of ω per row and axis
//! σ_q = h median |Δ⁵ δ| / (0.6745 √924)               noise of the attitude, rad
//! ```
//!
//! Fifth differences of a smooth motion are `(|ω| h)⁵`, those of white noise of size σ have the variance `Σ C(5,i)² σ² = 252 σ²`,
//! those of differenced noise `924 σ²`; 0.6745 is the median of |x| of the normal distribution.

use crate::log::Rows;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// A log made ready. Rows keep their numbers; what cannot be used is marked.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    pub times: Vec<f64>,
    /// Unit, neighbours within half a turn of each other in sign.
    pub q: Vec<UnitQuaternion<f64>>,
    /// rad/s.
    pub omega_w: Vec<Vector3<f64>>,
    /// rad/s.
    pub omega_b: Vec<Vector3<f64>>,
    /// Whether step k, from row k to k + 1, can be used: finite rows, and times that go on as they mostly do.
    pub usable: Vec<bool>,
    /// Median time from row to row, s; 0 where there is none.
    pub h: f64,
    /// Noise of ω_b, rad/s.
    pub sigma: f64,
    /// Noise of attitudes, rad.
    pub sigma_q: f64,
    /// Root of the mean of |ω|², rad/s.
    pub speed: f64,
    /// Rows at which q as logged has the other sign than at the row before.
    pub flips: Vec<usize>,
    /// ω was not logged: it is made of δ.
    pub derived: bool,
    /// Median turn from row to row, rad.
    pub turn: f64,
}

impl Motion {
    /// None without attitudes.
    pub fn new(rows: &Rows) -> Option<Self> {
        Self::read(rows, |q| q)
    }

    /// With each quaternion changed first.
    pub fn read(rows: &Rows, change: impl Fn([f64; 4]) -> [f64; 4]) -> Option<Self> {
        let n = rows.len();
        if n == 0 || rows.attitudes.len() != n {
            return None;
        }
        let mut m = Self {
            times: rows.times.clone(),
            h: median_step(&rows.times),
            derived: rows.omegas.len() != n,
            ..Self::default()
        };
        let mut good = vec![true; n];
        m.q.reserve(n);
        for (k, &logged) in rows.attitudes.iter().enumerate() {
            let [x, y, z, w] = change(logged);
            let mut q = Quaternion::new(w, x, y, z);
            let length = q.norm();
            let before = m.q.last().map(|q: &UnitQuaternion<f64>| q.into_inner());
            if !(length > 1e-6 && length < 1e6) {
                good[k] = false;
                m.q.push(before.map_or(UnitQuaternion::identity(), UnitQuaternion::new_unchecked));
                continue;
            }
            q /= length;
            if let Some(before) = before
                && q.coords.dot(&before.coords) < 0.0
            {
                q = -q;
            }
            // The sign as logged against the sign as logged before.
            if k > 0 {
                let a = Quaternion::new(w, x, y, z).coords;
                let [x, y, z, w] = change(rows.attitudes[k - 1]);
                if a.dot(&Quaternion::new(w, x, y, z).coords) < 0.0 {
                    m.flips.push(k);
                }
            }
            m.q.push(UnitQuaternion::new_unchecked(q));
        }
        m.usable = (0..n.saturating_sub(1))
            .map(|k| {
                let h = m.times[k + 1] - m.times[k];
                good[k] && good[k + 1] && h > 0.2 * m.h && h < 3.0 * m.h
            })
            .collect();
        if m.derived {
            m.derive();
        } else {
            m.omega_w = rows.omegas.iter().map(|&v| Vector3::from(v)).collect();
        }
        for (k, omega) in m.omega_w.iter_mut().enumerate() {
            if !omega.iter().all(|x| x.is_finite() && x.abs() < 1e150) {
                *omega = Vector3::zeros();
                if let Some(step) = m.usable.get_mut(k) {
                    *step = false;
                }
                if k > 0 {
                    m.usable[k - 1] = false;
                }
            }
        }
        m.turn_to_body();
        Some(m)
    }

    /// ω_b, and what is measured of it.
    fn turn_to_body(&mut self) {
        self.omega_b = (self.q.iter().zip(&self.omega_w))
            .map(|(q, omega)| q.inverse_transform_vector(omega))
            .collect();
        let n = self.omega_w.len().max(1) as f64;
        self.speed = (self.omega_w.iter().map(Vector3::norm_squared).sum::<f64>() / n).sqrt();
        self.sigma = self.noise(|m, k| m.omega_b[k]) / 252.0_f64.sqrt();
        self.sigma_q = self.h * self.noise(Self::delta) / 924.0_f64.sqrt();
        let mut turns: Vec<f64> = (self.every(2_000))
            .filter(|&k| self.usable[k])
            .map(|k| self.delta(k).norm() * (self.times[k + 1] - self.times[k]))
            .collect();
        self.turn = median(&mut turns);
    }

    /// ω at a row from the rates before and after it.
    fn derive(&mut self) {
        let n = self.q.len();
        self.omega_w = (0..n)
            .map(|k| {
                let before = (k > 0 && self.usable[k - 1]).then(|| self.delta(k - 1));
                let after = (k + 1 < n && self.usable[k]).then(|| self.delta(k));
                match (before, after) {
                    (Some(a), Some(b)) => (a + b) * 0.5,
                    (a, b) => a.or(b).unwrap_or_default(),
                }
            })
            .collect();
    }

    /// Takes this for ω, in the world.
    pub fn with_omega(&self, omega_w: Vec<Vector3<f64>>) -> Self {
        let mut m = Self {
            omega_w,
            ..self.clone()
        };
        m.turn_to_body();
        m
    }

    pub fn len(&self) -> usize {
        self.q.len()
    }

    pub fn step(&self, k: usize) -> f64 {
        self.times[k + 1] - self.times[k]
    }

    /// The measured rate over step k, world, rad/s.
    #[inline]
    pub fn delta(&self, k: usize) -> Vector3<f64> {
        let d = self.q[k + 1].into_inner() * self.q[k].into_inner().conjugate();
        rotation_vector(d) / self.step(k)
    }

    /// About so many steps, evenly.
    pub fn every(&self, about: usize) -> impl Iterator<Item = usize> + use<> {
        let steps = self.usable.len();
        (0..steps).step_by((steps / about).max(1))
    }

    /// Median |Δ⁵| of what is at rows k to k + 5, over 0.6745.
    fn noise(&self, of: impl Fn(&Self, usize) -> Vector3<f64>) -> f64 {
        let steps = self.usable.len();
        let mut found = Vec::new();
        for k in self.every(1_500) {
            // δ of the last takes one row more.
            if k + 6 > steps || !self.usable[k..k + 6].iter().all(|u| *u) {
                continue;
            }
            let v: [Vector3<f64>; 6] = std::array::from_fn(|i| of(self, k + i));
            let fifth = v[5] - v[0] + (v[1] - v[4]) * 5.0 + (v[3] - v[2]) * 10.0;
            found.extend(fifth.iter().map(|x| x.abs()));
        }
        median(&mut found) / 0.6745
    }

    /// Whether there is noise that differences would drown in.
    pub fn noisy(&self) -> bool {
        self.sigma > 1e-3 * self.speed
    }

    /// Windows of `length` usable steps in a row, a new one every `hop`: their first steps.
    pub fn windows(&self, length: usize, hop: usize) -> Vec<usize> {
        let mut found = Vec::new();
        let (mut from, mut run) = (0, 0);
        for (k, &usable) in self.usable.iter().enumerate() {
            run = if usable { run + 1 } else { 0 };
            if run == 0 {
                from = k + 1;
            } else if k + 1 - from >= length {
                found.push(from);
                from += hop;
                run = k + 1 - from;
            }
        }
        found
    }
}

/// Hann's window of so many weights, their sum 1: `(1 - cos 2π(j+½)/W) / W`.
pub fn hann(length: usize) -> Vec<f64> {
    let n = length as f64;
    (0..length)
        .map(|j| (1.0 - libm::cos(std::f64::consts::TAU * (j as f64 + 0.5) / n)) / n)
        .collect()
}

/// `2 (v/|v|) atan2(|v|, w)`, of the sign with w ≥ 0; by the series of asin where the turn is small.
#[inline]
pub fn rotation_vector(d: Quaternion<f64>) -> Vector3<f64> {
    let v = if d.w < 0.0 { -d.imag() } else { d.imag() };
    let s2 = v.norm_squared();
    if s2 < 0.0025 {
        // asin(s)/s; the next term is below 3e-13 here.
        return v
            * (2.0 + s2 * (1.0 / 3.0 + s2 * (0.15 + s2 * (5.0 / 56.0 + s2 * (35.0 / 576.0)))));
    }
    let s = s2.sqrt();
    v * (2.0 * libm::atan2(s, d.w.abs()) / s)
}

/// 0 of nothing.
pub fn median(of: &mut [f64]) -> f64 {
    if of.is_empty() {
        return 0.0;
    }
    let middle = of.len() / 2;
    *of.select_nth_unstable_by(middle, f64::total_cmp).1
}

fn median_step(times: &[f64]) -> f64 {
    let apart = (times.len() / 4_000).max(1);
    let mut steps: Vec<f64> = (times.windows(2).step_by(apart))
        .map(|t| t[1] - t[0])
        .filter(|h| *h > 0.0 && h.is_finite())
        .collect();
    median(&mut steps)
}
