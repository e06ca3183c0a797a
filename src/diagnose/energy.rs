//! Where does the energy go?
//!
//! ```text
//! E = ½ ω_b · I ω_b,      W = Σ h τ_b · ω_m
//! drift   slope of E - W against time, times the time that was logged, over the mean of E; its error from means of blocks
//! η = Σ (ΔE - h τ_b·ω_m) / Σ ½ h² (I α_g)·α      +1 explicit Euler, -1 implicit Euler, over the number of sub-steps
//! ```
//!
//! Never from the two ends: one noisy row would decide. What falls fast and then stays has no steady slope, but its blocks go down one
//! after the other: of 39 differences 34 of one sign come by chance once in 300,000 times.

use super::motion::Motion;
use super::squares::Squares;
use nalgebra::{Matrix3, Vector2, Vector3};

#[derive(Clone, Copy, Debug)]
pub struct Drift {
    /// Of the mean of E, over the whole time.
    pub part: f64,
    /// Its standard error.
    pub error: f64,
    /// What the torques moved to and fro, Σ |h τ·ω|, over the mean of E.
    pub flow: f64,
    /// The energy coefficient, step by step; 0 where nothing is to be seen.
    pub eta: f64,
    /// The same from the drift as a whole, which noise leaves alone, and its error.
    pub eta_of_drift: (f64, f64),
}

/// None where steps are missing, or too few.
pub fn drift(m: &Motion, inertia: &Matrix3<f64>, tau_w: &[Vector3<f64>]) -> Option<Drift> {
    let steps = m.usable.len();
    if steps < 40 || tau_w.len() != m.len() || m.usable.iter().any(|u| !u) {
        return None;
    }
    let inverse = inertia.try_inverse()?;
    let energy = |w: &Vector3<f64>| 0.5 * w.dot(&(inertia * w));
    let blocks = 40;
    let length = steps / blocks;
    let (mut work, mut sum, mut time, mut inside, mut mean) = (0.0, 0.0, 0.0, 0, 0.0);
    let (mut gained, mut explicit, mut flow) = (0.0, 0.0, 0.0);
    let mut squares = Squares::<2>::new();
    let mut means: Vec<f64> = Vec::with_capacity(blocks + 1);
    let span = m.times[steps] - m.times[0];
    for (k, tau_w) in tau_w.iter().enumerate().take(steps) {
        let (a, b) = (&m.omega_b[k], &m.omega_b[k + 1]);
        let e = energy(a);
        sum += e - work;
        time += (m.times[k] - m.times[0]) / span;
        mean += e / steps as f64;
        inside += 1;
        if inside == length {
            let n = length as f64;
            squares.add(&Vector2::new(1.0, time / n), sum / n);
            means.push(sum / n);
            (sum, time, inside) = (0.0, 0.0, 0);
        }
        let h = m.step(k);
        let tau = super::kinematics::half_way(m, k).inverse_transform_vector(tau_w);
        let mid = (a + b) * 0.5;
        let done = h * tau.dot(&mid);
        work += done;
        flow += done.abs();
        gained += energy(b) - e - done;
        let turning = -mid.cross(&(inertia * mid));
        explicit += 0.5 * h * h * turning.dot(&(inverse * (turning + tau)));
    }
    let solution = squares.solve()?;
    let (mut part, mut error) = (solution.x[1] / mean, solution.error[1] / mean);
    let falls = means.windows(2).filter(|w| w[1] < w[0]).count();
    if 20 * falls.max(means.len() - 1 - falls) >= 17 * (means.len() - 1) {
        let ends = (means[means.len() - 1] - means[0]) / mean;
        if part.abs() < 5.0 * error && ends.abs() > part.abs() {
            (part, error) = (ends, 0.1 * ends.abs());
        }
    }
    let over = |x: f64| if explicit > 0.0 { x / explicit } else { 0.0 };
    (mean > 0.0 && mean.is_finite()).then_some(Drift {
        part,
        error,
        flow: flow / mean,
        eta: over(gained),
        eta_of_drift: (over(solution.x[1]), over(solution.error[1])),
    })
}
