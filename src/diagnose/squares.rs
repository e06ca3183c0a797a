//! Least squares in a few unknowns: `min |A x - b|²` by the normal equations, `AᵀA x = Aᵀb`.
//!
//! Rows come one at a time, so nothing is kept but sums; columns are scaled to unit length before the equations are solved.

use nalgebra::{SMatrix, SVector};

/// Sums of the normal equations.
#[derive(Clone, Debug)]
pub struct Squares<const N: usize> {
    ata: SMatrix<f64, N, N>,
    atb: SVector<f64, N>,
    btb: f64,
    rows: usize,
}

/// A solution.
#[derive(Clone, Debug)]
pub struct Solution<const N: usize> {
    pub x: SVector<f64, N>,
    /// Standard errors, as if the rows' errors were independent.
    pub error: SVector<f64, N>,
    /// `|A x - b|²`.
    pub left: f64,
}

impl<const N: usize> Squares<N> {
    pub fn new() -> Self {
        Self {
            ata: SMatrix::zeros(),
            atb: SVector::zeros(),
            btb: 0.0,
            rows: 0,
        }
    }

    pub fn add(&mut self, a: &SVector<f64, N>, b: f64) {
        self.ata += a * a.transpose();
        self.atb += a * b;
        self.btb += b * b;
        self.rows += 1;
    }

    /// None where the columns depend on each other to a relative 1e-10, or there are too few rows.
    pub fn solve(&self) -> Option<Solution<N>> {
        if self.rows < N {
            return None;
        }
        let scale = SVector::<f64, N>::from_fn(|i, _| self.ata[(i, i)].sqrt());
        if scale
            .iter()
            .any(|s| s.is_nan() || *s <= 0.0 || s.is_infinite())
        {
            return None;
        }
        let gram = SMatrix::<f64, N, N>::from_fn(|i, j| self.ata[(i, j)] / (scale[i] * scale[j]));
        let right = self.atb.component_div(&scale);
        let (inverse, x) = invert(gram, right)?;
        let left = (self.btb - x.dot(&right)).max(0.0);
        let spread = left / (self.rows - N).max(1) as f64;
        Some(Solution {
            error: SVector::from_fn(|i, _| (inverse[(i, i)].max(0.0) * spread).sqrt() / scale[i]),
            x: x.component_div(&scale),
            left,
        })
    }
}

/// `(G⁻¹, G⁻¹ b)` of a symmetric matrix with ones on its diagonal, by Gauss and Jordan with pivots on the diagonal.
fn invert<const N: usize>(
    mut g: SMatrix<f64, N, N>,
    b: SVector<f64, N>,
) -> Option<(SMatrix<f64, N, N>, SVector<f64, N>)> {
    let mut inverse = SMatrix::<f64, N, N>::identity();
    let mut done = [false; N];
    for _ in 0..N {
        let p = (0..N)
            .filter(|&i| !done[i])
            .max_by(|&i, &j| g[(i, i)].total_cmp(&g[(j, j)]))?;
        let pivot = g[(p, p)];
        if pivot.is_nan() || pivot < 1e-10 {
            return None;
        }
        done[p] = true;
        for j in 0..N {
            g[(p, j)] /= pivot;
            inverse[(p, j)] /= pivot;
        }
        for i in (0..N).filter(|&i| i != p) {
            let factor = g[(i, p)];
            for j in 0..N {
                g[(i, j)] -= factor * g[(p, j)];
                inverse[(i, j)] -= factor * inverse[(p, j)];
            }
        }
    }
    let x = inverse * b;
    x.iter().all(|v| v.is_finite()).then_some((inverse, x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn a_parabola_through_noise_and_a_column_twice() {
        let mut squares = Squares::<3>::new();
        let mut double = Squares::<3>::new();
        for k in 0..100 {
            let t = 0.01 * f64::from(k);
            // ±1e-3, alternating.
            let off = if k % 2 == 0 { 1e-3 } else { -1e-3 };
            squares.add(
                &Vector3::new(1.0, t, t * t),
                2.0 - 3.0 * t + 0.5 * t * t + off,
            );
            double.add(&Vector3::new(1.0, t, 2.0 * t), t);
        }
        let found = squares.solve().unwrap();
        for (i, want) in [2.0, -3.0, 0.5].into_iter().enumerate() {
            assert!((found.x[i] - want).abs() < 3.0 * found.error[i], "{i}");
        }
        // 100 errors of 1e-3.
        assert!((found.left / 1e-4 - 1.0).abs() < 0.05, "{}", found.left);
        assert!(double.solve().is_none());
    }
}
