//! What an engine may take for Euler's equation, and how well each fits the steps that were logged.
//!
//! ```text
//! right        α_b = I⁻¹ (τ_b - ω_b × I ω_b)
//! measured     a_k = (ω_b,k+1 - ω_b,k) / h
//! midpoint     ω_m = ½ (ω_k + ω_{k+1}) - (a_{k+1} - a_k) / 8        a: the gradient of ω_b per row, clean data only
//! stage        α = α_m + κ (α_k - α_{k+1})       κ ½: explicit; -½: implicit; over the number of sub-steps
//! restored     α = α_m + λ (α_r - α_m)           α_r: an explicit step, then |L| put back
//! residual     rms Σφ (a - α) / max(rms Σφ a, rms Σφ α)
//! ```
//!
//! φ is Hann's window. The torque is held in the world during a step, and turned by the attitude half way.

use super::motion::{Motion, hann};
use super::squares::Squares;
use nalgebra::{Matrix3, Vector1, Vector3};
use std::f64::consts::PI;

/// Which tensor stands for I in the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Map {
    /// `R I Rᵀ`.
    Right,
    /// `I`.
    NotRotated,
    /// `Rᵀ I R`.
    Backwards,
    /// `α = I_w (τ - ω × I_w ω)`.
    NotInverted,
}

/// What becomes of the torque.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Torque {
    Right,
    /// `R τ`: taken for one in body axes.
    TakenForBody,
    /// `Rᵀ τ`: a world torque that is turned to the body, and used in the world.
    LeftInBody,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gyroscopic {
    On,
    Off,
    Reversed,
    /// `ω × diag(I) ω`.
    DiagonalOnly,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Inertia {
    Declared,
    /// Off-diagonals times -1.
    Negated,
    /// Off-diagonals zero.
    Dropped,
    /// `I⁻¹` everywhere.
    Inverse,
    Given(Matrix3<f64>),
}

/// From where a force's lever goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lever {
    Centre,
    /// Where the centre of mass was at the first row.
    FirstCentre,
    WorldOrigin,
    BodyOrigin,
}

/// How long what acts goes on acting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Life {
    Step,
    /// It is never cleared: all that ever acted.
    Ever,
    /// It is cleared a step late.
    TwoSteps,
    /// What acted last goes on where nothing acts.
    UntilNext,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    pub map: Map,
    pub torque: Torque,
    pub gyroscopic: Gyroscopic,
    pub inertia: Inertia,
    pub lever: Lever,
    pub life: Life,
}

impl Law {
    pub const RIGHT: Self = Self {
        map: Map::Right,
        torque: Torque::Right,
        gyroscopic: Gyroscopic::On,
        inertia: Inertia::Declared,
        lever: Lever::Centre,
        life: Life::Step,
    };

    pub const fn gyroscopic(self, gyroscopic: Gyroscopic) -> Self {
        Self { gyroscopic, ..self }
    }

    pub const fn map(self, map: Map) -> Self {
        Self { map, ..self }
    }

    pub const fn torque(self, torque: Torque) -> Self {
        Self { torque, ..self }
    }

    pub const fn inertia(self, inertia: Inertia) -> Self {
        Self { inertia, ..self }
    }

    pub const fn lever(self, lever: Lever) -> Self {
        Self { lever, ..self }
    }

    pub const fn life(self, life: Life) -> Self {
        Self { life, ..self }
    }

    /// In how many ways it is not the right one.
    pub fn faults(&self) -> usize {
        let right = Self::RIGHT;
        usize::from(self.map != right.map)
            + usize::from(self.torque != right.torque)
            + usize::from(self.gyroscopic != right.gyroscopic)
            + usize::from(self.inertia != right.inertia)
            + usize::from(self.lever != right.lever)
            + usize::from(self.life != right.life)
    }

    pub fn tensor(&self, declared: &Matrix3<f64>) -> Matrix3<f64> {
        let off = |s: f64| Matrix3::from_fn(|i, j| declared[(i, j)] * if i == j { 1.0 } else { s });
        match self.inertia {
            Inertia::Declared => *declared,
            Inertia::Negated => off(-1.0),
            Inertia::Dropped => off(0.0),
            Inertia::Inverse => declared.try_inverse().unwrap_or(*declared),
            Inertia::Given(j) => j,
        }
    }
}

/// A law with its tensors, for one body.
struct Mind {
    law: Law,
    i: Matrix3<f64>,
    inverse: Matrix3<f64>,
    /// In the gyroscopic term.
    spun: Matrix3<f64>,
    sign: f64,
}

impl Mind {
    fn new(law: Law, declared: &Matrix3<f64>) -> Option<Self> {
        let i = law.tensor(declared);
        let inverse = match law.map {
            Map::NotInverted => i,
            _ => i.try_inverse()?,
        };
        let (spun, sign) = match law.gyroscopic {
            Gyroscopic::On => (i, 1.0),
            Gyroscopic::Off => (i, 0.0),
            Gyroscopic::Reversed => (i, -1.0),
            Gyroscopic::DiagonalOnly => (Matrix3::from_diagonal(&i.diagonal()), 1.0),
        };
        Some(Self {
            law,
            i,
            inverse,
            spun,
            sign,
        })
    }

    /// α in body axes.
    fn alpha(
        &self,
        r: &Matrix3<f64>,
        omega_b: &Vector3<f64>,
        tau_w: &Vector3<f64>,
    ) -> Vector3<f64> {
        let tau_w = match self.law.torque {
            Torque::Right => *tau_w,
            Torque::TakenForBody => r * tau_w,
            Torque::LeftInBody => r.tr_mul(tau_w),
        };
        match self.law.map {
            Map::Right | Map::NotInverted => {
                let gyroscopic = omega_b.cross(&(self.spun * omega_b)) * self.sign;
                self.inverse * (r.tr_mul(&tau_w) - gyroscopic)
            }
            Map::NotRotated => {
                let omega = r * omega_b;
                let gyroscopic = omega.cross(&(self.spun * omega)) * self.sign;
                r.tr_mul(&(self.inverse * (tau_w - gyroscopic)))
            }
            Map::Backwards => {
                let omega = r * omega_b;
                let turned = |m: &Matrix3<f64>, v: &Vector3<f64>| r.tr_mul(&(m * (r * v)));
                let gyroscopic = omega.cross(&turned(&self.spun, &omega)) * self.sign;
                r.tr_mul(&turned(&self.inverse, &(tau_w - gyroscopic)))
            }
        }
    }
}

/// A step that was logged.
#[derive(Clone, Debug)]
struct Step {
    row: usize,
    h: f64,
    r: [Matrix3<f64>; 3],
    omega_b: [Vector3<f64>; 3],
}

/// Smoothed, a vector for each window.
pub type Smoothed = Vec<Vector3<f64>>;

/// The steps that the dynamics are tested on, in windows.
pub struct Steps {
    steps: Vec<Step>,
    /// Where each window begins in `steps`.
    pub windows: Vec<usize>,
    pub length: usize,
    weights: Vec<f64>,
    /// (dω_b / h), smoothed.
    pub measured: Smoothed,
    /// What noise leaves of it, each axis, rad/s².
    pub noise: f64,
    pub noisy: bool,
}

/// At most so many steps are looked at, in blocks spread evenly: enough for errors of a part in a thousand.
const MOST: usize = 24_000;

impl Steps {
    /// None where there are not three windows.
    pub fn new(m: &Motion, keep: impl Fn(usize) -> bool) -> Option<Self> {
        Self::of_length(m, Self::window(m, m.noisy()), keep)
    }

    /// In windows of so many steps.
    pub fn of_length(m: &Motion, length: usize, keep: impl Fn(usize) -> bool) -> Option<Self> {
        let noisy = m.noisy();
        let mut m_used = m.usable.clone();
        for (k, usable) in m_used.iter_mut().enumerate() {
            *usable &= keep(k);
        }
        let hop = (length / 2).max(1);
        let narrowed = Motion {
            usable: m_used,
            ..Motion::default()
        };
        let mut starts = narrowed.windows(length, hop);
        let apart = (starts.len() * hop / MOST).max(1);
        if apart > 1 {
            starts = starts.into_iter().step_by(apart).collect();
        }
        if starts.len() < 3 {
            return None;
        }
        let usable = |k: usize| narrowed.usable.get(k).copied().unwrap_or(false);
        let mut steps: Vec<Step> = Vec::new();
        let mut windows = Vec::new();
        for start in starts {
            // Windows that overlap share their steps.
            let have = steps.last().map_or(0, |s| s.row + 1);
            if have < start || steps.is_empty() {
                windows.push(steps.len());
                steps.extend((start..start + length).map(|k| step(m, k, noisy, &usable)));
            } else {
                windows.push(steps.len() - (have - start));
                steps.extend((have..start + length).map(|k| step(m, k, noisy, &usable)));
            }
        }
        let w = length as f64;
        let mut s = Self {
            steps,
            windows,
            length,
            weights: hann(length),
            measured: Vec::new(),
            noise: if m.derived {
                // ω is a difference of attitudes, dω/h a second one.
                m.sigma_q / (m.h * m.h) * (8.0 * PI.powi(4) / w.powi(5)).sqrt()
            } else {
                m.sigma / m.h * (2.0 * PI.powi(2) / w.powi(3)).sqrt()
            },
            noisy,
        };
        s.measured = s.smooth(|step| (step.omega_b[1] - step.omega_b[0]) / step.h);
        Some(s)
    }

    /// Eight rows of clean data; of noisy ones 30, or as many as two radians take, so that little noise is left.
    fn window(m: &Motion, noisy: bool) -> usize {
        // Of the longest stretch without a hole, where there are several.
        let (mut all, mut longest, mut run) = (0, 0, 0);
        for step in &m.usable {
            run = if *step { run + 1 } else { 0 };
            longest = longest.max(run);
            all += usize::from(*step);
        }
        let usable = all.min(4 * longest);
        if !noisy {
            return 8.min(usable / 4).max(4);
        }
        let two_radians = 2.0 / (m.speed * m.h).max(1e-6);
        let most = (usable / 8).max(8);
        (two_radians.min(1e6) as usize).clamp(30.min(most), most.min(400).max(30.min(most)))
    }

    fn smooth(&self, of: impl Fn(&Step) -> Vector3<f64>) -> Smoothed {
        let each: Vec<Vector3<f64>> = self.steps.iter().map(of).collect();
        self.windows
            .iter()
            .map(|&from| {
                (each[from..from + self.length].iter().zip(&self.weights))
                    .map(|(v, weight)| v * *weight)
                    .sum()
            })
            .collect()
    }

    /// A window's first and last row.
    pub fn rows(&self, window: usize) -> (usize, usize) {
        let from = self.windows[window];
        (
            self.steps[from].row,
            self.steps[from + self.length - 1].row + 1,
        )
    }

    /// Σφ α of a law half way, and Σφ (α_k - α_{k+1}). None where the law has no inverse inertia.
    pub fn predict(
        &self,
        law: Law,
        declared: &Matrix3<f64>,
        tau_w: &[Vector3<f64>],
    ) -> Option<Predicted> {
        let mind = Mind::new(law, declared)?;
        let at = |s: &Step, i: usize| mind.alpha(&s.r[i], &s.omega_b[i], &tau_w[s.row]);
        Some(Predicted {
            mid: self.smooth(|s| at(s, 2)),
            stage: self.smooth(|s| at(s, 0) - at(s, 1)),
        })
    }

    /// Σφ (α_r - α_m) of an explicit step after which |L| is put back to what the torque alone makes of it.
    pub fn restored(&self, declared: &Matrix3<f64>, tau_w: &[Vector3<f64>]) -> Smoothed {
        let Some(mind) = Mind::new(Law::RIGHT, declared) else {
            return vec![Vector3::zeros(); self.windows.len()];
        };
        self.smooth(|s| {
            let tau = &tau_w[s.row];
            let explicit = s.omega_b[0] + mind.alpha(&s.r[0], &s.omega_b[0], tau) * s.h;
            let kept = (mind.i * s.omega_b[0] + s.r[0].tr_mul(tau) * s.h).norm();
            let length = (mind.i * explicit).norm();
            let next = if length > 0.0 {
                explicit * (kept / length)
            } else {
                explicit
            };
            (next - s.omega_b[0]) / s.h - mind.alpha(&s.r[2], &s.omega_b[2], tau)
        })
    }

    /// Σφ Rᵀ dω_w/h: α as the world sees it, in body axes. The same as what is measured, where attitudes turn by ω.
    pub fn measured_in_world(&self) -> Smoothed {
        self.smooth(|s| s.r[2].tr_mul(&(s.r[1] * s.omega_b[1] - s.r[0] * s.omega_b[0])) / s.h)
    }

    /// Σφ of a function of ω_b half way.
    pub fn of_omega(&self, of: impl Fn(&Vector3<f64>) -> Vector3<f64>) -> Smoothed {
        self.smooth(|s| of(&s.omega_b[2]))
    }

    /// Σφ of the torque half way, in body axes.
    pub fn tau_b(&self, tau_w: &[Vector3<f64>]) -> Smoothed {
        self.smooth(|s| s.r[2].tr_mul(&tau_w[s.row]))
    }
}

fn step(m: &Motion, k: usize, noisy: bool, usable: &impl Fn(usize) -> bool) -> Step {
    let matrix = |q: &nalgebra::UnitQuaternion<f64>| *q.to_rotation_matrix().matrix();
    let (a, b) = (m.omega_b[k], m.omega_b[k + 1]);
    let mut mid = (a + b) * 0.5;
    if !noisy && k > 0 && usable(k - 1) && usable(k + 1) {
        let gradient = |k: usize| (m.omega_b[k + 1] - m.omega_b[k - 1]) * 0.5;
        mid -= (gradient(k + 1) - gradient(k)) / 8.0;
    }
    Step {
        row: k,
        h: m.step(k),
        r: [
            matrix(&m.q[k]),
            matrix(&m.q[k + 1]),
            matrix(&super::kinematics::half_way(m, k)),
        ],
        omega_b: [a, b, mid],
    }
}

/// What a law makes of the steps.
#[derive(Clone, Debug)]
pub struct Predicted {
    pub mid: Smoothed,
    pub stage: Smoothed,
}

/// How well something explains the windows.
#[derive(Clone, Debug)]
pub struct Fit {
    /// `left / scale`.
    pub residual: f64,
    /// rms of what is left, rad/s².
    pub left: f64,
    /// The larger of rms of measured and predicted, rad/s².
    pub scale: f64,
    /// The coefficient that was fitted, and its standard error.
    pub coefficient: f64,
    pub error: f64,
    /// |error|² of each window.
    pub each: Vec<f64>,
}

/// `measured - base - c feature`, c within limits; c = 0 without a feature. Windows that are not `kept` do not count.
pub fn fit(
    measured: &[Vector3<f64>],
    base: &[Vector3<f64>],
    feature: Option<(&[Vector3<f64>], [f64; 2])>,
    kept: &[bool],
) -> Fit {
    let (mut coefficient, mut error) = (0.0, f64::INFINITY);
    if let Some((feature, [low, high])) = feature {
        let mut squares = Squares::<1>::new();
        for i in (0..measured.len()).filter(|&i| kept[i]) {
            for axis in 0..3 {
                squares.add(
                    &Vector1::new(feature[i][axis]),
                    measured[i][axis] - base[i][axis],
                );
            }
        }
        if let Some(solution) = squares.solve() {
            coefficient = solution.x[0].clamp(low, high);
            error = solution.error[0];
        }
    }
    let (mut left, mut size, mut model) = (0.0, 0.0, 0.0);
    let n = kept.iter().filter(|k| **k).count().max(1) as f64;
    let each: Vec<f64> = (0..measured.len())
        .map(|i| {
            let mut predicted = base[i];
            if let Some((feature, _)) = feature {
                predicted += feature[i] * coefficient;
            }
            let e = (measured[i] - predicted).norm_squared();
            if kept[i] {
                left += e;
                size += measured[i].norm_squared();
                model += predicted.norm_squared();
            }
            e
        })
        .collect();
    let whole = size.max(model);
    Fit {
        residual: if whole > 0.0 {
            (left / whole).sqrt()
        } else {
            0.0
        },
        left: (left / n).sqrt(),
        scale: (whole / n).sqrt(),
        coefficient,
        error,
        each,
    }
}

/// √ of the mean of |v|², of the windows that are kept.
pub fn rms(of: &[Vector3<f64>], kept: &[bool]) -> f64 {
    let n = kept.iter().filter(|k| **k).count().max(1) as f64;
    let sum: f64 = (of.iter().zip(kept))
        .filter(|(_, k)| **k)
        .map(|(v, _)| v.norm_squared())
        .sum();
    (sum / n).sqrt()
}
