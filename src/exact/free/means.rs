//! Arithmetic-geometric means, and the integrals that come down to them.
//!
//! ```text
//! α ← (α + γ)/2   γ ← √(αγ)   and the half gap (α - γ)/2 by itself: c ← c²/4α, c0² = α0² - γ0²
//! ```
//!
//! α is double-double. The integrals R_F of this room have arguments whose differences are the α²,
//! γ², c² of such a mean, so that Gauss's and Landen's transformations of them (DLMF 19.22) take
//! one root a round:
//!
//! ```text
//! x ≤ y, y² - x² = c²:            x ← (x + y)/2, y ← √(x² + c²);               at the end y = x
//! x ≤ y ≤ z, z² - y² = c²:        z ← (y + z)/2, y ← √(z² - c²), x ← x z/y;    at the end y = z
//!
//! Λ R_F(x², y², x² + α²) = arsinh(Λ/x)         Λ R_F(x², x² + γ², x² + α²) = arctan(Λ/x)
//! ```

use crate::math::Dd;

/// A mean, and the half gaps c1, c2, ... on the way to it.
pub struct Mean {
    pub limit: Dd,
    gaps: [f64; MOST],
    count: usize,
}

/// From a ratio of 1e-300 the gap is half of α for ten rounds, and then takes 5 to go.
const MOST: usize = 20;

/// Where α and γ differ so little, a series ends the mean.
const NEAR: f64 = 1e-4;

impl Mean {
    fn starting() -> Self {
        Self {
            limit: Dd::ZERO,
            gaps: [0.0; MOST],
            count: 0,
        }
    }

    /// Of two numbers above zero, α ≥ γ, and `c0² = α² - γ²`.
    #[inline]
    pub fn of(mut alpha: Dd, mut gamma: Dd, square: f64) -> Self {
        let (mut mean, mut square, mut half_gap) = (Self::starting(), square, Dd::ZERO);
        for _ in 0..MOST {
            let product = alpha * gamma;
            half_gap = (alpha - gamma).scaled(0.5);
            alpha = alpha.plus(gamma).scaled(0.5);
            if mean.note(&mut square, alpha.hi) <= NEAR {
                break;
            }
            gamma = product.sqrt();
        }
        mean.limit = limit(alpha, half_gap);
        // The series needs no more gaps, but an x far below α may feel the next.
        mean.note(&mut square, alpha.hi);
        mean
    }

    /// The same, and the sum that the precession takes,
    ///
    /// ```text
    /// e = (p² - αγ)/(p² + αγ)   Q ← Q e/2   S ← S + Q   p ← (p + αγ/p)/2
    /// ```
    ///
    /// from S = Q = 1 on, for p ≥ α; right sides are the old values. e comes down quadratically once
    /// p² is of the size of αγ, and to that by halves.
    #[inline]
    pub fn with_sum(mut alpha: Dd, mut gamma: Dd, square: f64, mut p: Dd) -> (Self, Dd) {
        let (mut mean, mut square, mut half_gap) = (Self::starting(), square, Dd::ZERO);
        let (mut q, mut s) = (Dd::ONE, Dd::ONE);
        for _ in 0..MOST {
            let product = alpha * gamma;
            let other = product / p;
            let sum = p.plus(other);
            let e = (p - other) / sum;
            p = sum.scaled(0.5);
            q = (q * e).scaled(0.5);
            s = s.plus(q);
            half_gap = (alpha - gamma).scaled(0.5);
            alpha = alpha.plus(gamma).scaled(0.5);
            let x = mean.note(&mut square, alpha.hi);
            let (e, ee) = (e.hi, e.hi * e.hi);
            if x <= NEAR && e <= 2e-4 && q.hi * ee <= 4e-17 {
                // The next e exactly, γ/α = √(1 - x²): (√(1 - x²) - (1 - e²))/(√(1 - x²) + (1 - e²)).
                // Q after it is at most 1e-17, and the one after that 1e-17 e⁴/16 < 1e-33.
                let drop = x * x * (0.5 + 0.125 * x * x);
                let next = (ee - drop) / (2.0 - ee - drop);
                s = s.plus(Dd::new(0.5 * q.hi * next));
                break;
            }
            gamma = product.sqrt();
        }
        mean.limit = limit(alpha, half_gap);
        (mean, s)
    }

    /// Takes the next half gap down, `square` being the one before it, squared; returns it by α.
    #[inline]
    fn note(&mut self, square: &mut f64, alpha: f64) -> f64 {
        let gap = 0.25 * *square / alpha;
        *square = gap * gap;
        // What is smaller than that is felt nowhere.
        if gap > 1e-14 * alpha && self.count < MOST {
            self.gaps[self.count] = gap;
            self.count += 1;
        }
        gap / alpha
    }

    fn gaps(&self) -> &[f64] {
        &self.gaps[..self.count]
    }

    /// x at the end of the first transformation, for gaps `size` times as large.
    #[inline]
    pub fn rising(&self, mut x: f64, mut y: f64, size: f64) -> f64 {
        for gap in self.gaps() {
            let c = size * gap;
            x = 0.5 * (x + y);
            y = (x * x + c * c).sqrt();
        }
        0.5 * (x + y)
    }

    /// x at the end of the second.
    #[inline]
    pub fn falling(&self, mut x: f64, mut y: f64, mut z: f64, size: f64) -> f64 {
        for gap in self.gaps() {
            let c = size * gap;
            z = 0.5 * (y + z);
            y = ((z - c) * (z + c)).sqrt();
            x *= z / y;
        }
        x
    }
}

/// `M(α + c, α - c) = α (1 - x²/4 - 5x⁴/64 - 11x⁶/256 - ...)`, x = c/α: the next term is 3e-34 at
/// x = 1e-4.
#[inline]
fn limit(alpha: Dd, half_gap: Dd) -> Dd {
    let square = half_gap.square();
    let x2 = square.hi / (alpha.hi * alpha.hi);
    let rest = alpha.hi * x2 * x2 * (5.0 / 64.0 + 11.0 / 256.0 * x2);
    alpha - (square / alpha.scaled(4.0)).plus(Dd::new(rest))
}
