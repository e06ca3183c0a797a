//! The constants of a motion: moduli, rates and phases, from one AGM loop in double-double.

use super::branch::Branch;
use super::series::{Complementary, Nome, Series};
use crate::math::carlson::rf;
use crate::math::{Dd, agm};
use std::f64::consts::PI;

/// Above this k² the series in the complementary nome converge faster.
const COMPLEMENTARY: f64 = 0.9;

/// The constants of a motion, once its axes are in order.
pub struct Constants {
    a: Dd,
    b: Dd,
    c: Dd,
    d1: Dd,
    d3: Dd,
    g2: Dd,
    /// Λ = λ π / 2K, 1/s.
    pub lambda: Dd,
    k2: f64,
    /// Ω, the precession about L, 1/s.
    pub omega: Dd,
    /// The time since the motion passed u = 0, s.
    pub t0: Dd,
    sigma: f64,
}

impl Constants {
    pub fn new(branch: &Branch) -> Self {
        let [i1, i2, i3] = branch.i;
        let over = |p: f64, q: f64| Dd::difference(p, q).abs() / Dd::product(p, q);
        let (a, b, c) = (over(i1, i2), over(i2, i3), over(i1, i3));
        let m: [Dd; 3] = std::array::from_fn(|k| Dd::product(branch.i[k], branch.w[k]));
        let [s1, s2, s3] = m.map(Dd::square);
        let d1 = c * s1 + b * s2;
        let d3 = a * s2 + c * s3;
        let g2 = s1 + s2 + s3;
        let gap = branch.gap * (c / Dd::new(i2)).sqrt();
        let (lambda, s) = agm_and_sum((b * d3).sqrt(), gap, (c * d3).sqrt());
        let g = g2.sqrt();
        let omega = if lambda.hi == 0.0 {
            g / Dd::new(i2)
        } else {
            g / Dd::new(i1) - (g * a * s * 0.5 + lambda) * branch.sigma
        };
        let k2 = (a * d1).to_f64() / (b * d3).to_f64();
        let f = Dd::to_f64;
        // Near the separatrix λ t0 is many radians, and an f64 would round them.
        let since = if k2 > COMPLEMENTARY {
            rf_of_squares(
                (c * d3).sqrt() * m[0],
                (c * d1).sqrt() * m[2],
                (d1 * d3).sqrt(),
            )
        } else {
            Dd::new(rf(f(c * d3 * s1), f(c * d1 * s3), f(d1 * d3)))
        };
        let t0 = m[1] * since * branch.sigma;
        Self {
            a,
            b,
            c,
            d1,
            d3,
            g2,
            lambda,
            k2,
            omega,
            t0,
            sigma: branch.sigma,
        }
    }

    pub fn series(&self) -> Series {
        let f = Dd::to_f64;
        let (b, c, g2) = (self.b, self.c, self.g2);
        let t_a = rf(f(self.a * self.d3), f(c * self.d3), f(self.a * c * g2));
        let lambda = self.lambda.to_f64();
        if self.k2 <= COMPLEMENTARY {
            let t_w = rf(f(b * self.d1), f(c * self.d1), f(b * c * g2));
            let kappa = libm::exp(-2.0 * lambda * t_w);
            let epsilon = libm::exp(-2.0 * lambda * t_a);
            return Series::Nome(Nome::new(kappa, epsilon));
        }
        // Λ': the AGM of √(B D3) and √(A D1).
        let (start, end) = ((b * self.d3).sqrt(), (self.a * self.d1).sqrt());
        let dual = agm(start, end).to_f64();
        let a0 = 0.5 * dual * t_a;
        if lambda == 0.0 {
            let rate = 0.5 * self.sigma * dual;
            return Series::Separatrix {
                terms: Complementary::new(f64::INFINITY, a0),
                rate,
                y0: rate * self.t0.to_f64(),
            };
        }
        Series::Complementary {
            terms: Complementary::new(0.5 * PI * dual / lambda, a0),
            y_per: 0.5 * dual / lambda,
            turns_per: 0.5 * dual * t_a / (PI * PI),
        }
    }
}

/// `R_F(x², y², z²)`, the first duplication taken before a square can underflow.
fn rf_of_squares(x: Dd, y: Dd, z: Dd) -> Dd {
    let lambda = x * (y + z) + y * z;
    let [x, y, z] = [x, y, z].map(|root| root.square() + lambda);
    rf(x, y, z) * 2.0
}

/// `lim α`, and the sum S that the precession takes: right sides are the old values.
fn agm_and_sum(mut alpha: Dd, mut gamma: Dd, mut p: Dd) -> (Dd, Dd) {
    let mut q = Dd::ONE;
    let mut s = Dd::ONE;
    if gamma.hi == 0.0 {
        return (Dd::ZERO, s);
    }
    // α and γ meet quadratically, within 8 rounds even from a ratio of 1e-150; p comes down to them
    // by halves first, in log2 √(C/B) rounds: 25 for a rod of a ten-millionth of its length.
    for _ in 0..512 {
        let (p2, ag) = (p.square(), alpha * gamma);
        let e = (p2 - ag) / (p2 + ag);
        q = q * e * 0.5;
        s = s + q;
        p = (p2 + ag) / (p * 2.0);
        let next = (alpha + gamma) * 0.5;
        gamma = (alpha * gamma).sqrt();
        alpha = next;
        if (alpha - gamma).hi.abs() <= 1e-31 * alpha.hi && q.hi.abs() <= 1e-33 {
            break;
        }
    }
    (alpha, s)
}
