//! Moments for which the discrete body of Moser and Veselov moves as the real one does, to order 10.
//!
//! `1/Ĩ_i = S/I_i + D`, S = 1 + Σ s, D = Σ d: polynomials in N = ½ h² |m|² and H = ½ h² Σ m_i²/I_i,
//! which the free motion leaves constant; their coefficients are rational in the moments.
//!
//! Hairer & Vilmart, J. Phys. A 39 (2006) 13225, section 4; their formulas, checked by the slopes.

use crate::math::{power, turned};
use nalgebra::{Matrix3, Quaternion, Vector3};

/// `N, H; N², NH, H²; N³, …; N⁴, …, H⁴`: the terms of orders 4, 6, 8 and 10.
const TERMS: usize = 14;

/// A body's coefficients.
#[derive(Clone, Debug)]
pub struct Preprocessed {
    /// Moments in units of `scale`, a power of two near the largest.
    inverse: Vector3<f64>,
    /// `1/I3 - 1/I2` and cyclic.
    gaps: Vector3<f64>,
    scale: f64,
    /// How many of the terms the order takes.
    terms: usize,
    s: [f64; TERMS],
    d: [f64; TERMS],
}

impl Preprocessed {
    /// For principal moments above zero (kg m²) and an order of 2, 4, 6, 8 or 10.
    pub fn new(moments: Vector3<f64>, order: u32) -> Self {
        let scale = libm::exp2(libm::floor(libm::log2(moments.amax())));
        let i = moments / scale;
        let (s, d) = coefficients(i);
        let gap = |j: usize, k: usize| (i[j] - i[k]) / (i[j] * i[k]);
        Self {
            inverse: i.map(f64::recip),
            gaps: Vector3::new(gap(1, 2), gap(2, 0), gap(0, 1)),
            scale: scale.recip(),
            terms: match order {
                2 => 0,
                4 => 2,
                6 => 5,
                8 => 9,
                _ => TERMS,
            },
            s,
            d,
        }
    }

    /// The attitude `h` seconds on; L (world, kg m²/s) stays. Not a number where `h |ω|` is too
    /// large for the discrete body to have a next attitude.
    #[inline]
    pub fn attitude(
        &self,
        h: f64,
        q: Quaternion<f64>,
        momentum_w: Vector3<f64>,
    ) -> Quaternion<f64> {
        let m = turned(q.conjugate(), momentum_w) * self.scale;
        let squares = m.component_mul(&m);
        let half_h2 = 0.5 * h * h;
        let (s, d) = self.factors(
            half_h2 * squares.sum(),
            half_h2 * squares.dot(&self.inverse),
        );
        let inverse = self.inverse * s + Vector3::repeat(d);
        // (Ĩ2 - Ĩ3)/Ĩ1 = S (1/I3 - 1/I2) Ĩ2 Ĩ3/Ĩ1 and cyclic: 0 exactly for equal moments.
        let volume = s / (inverse.x * inverse.y * inverse.z);
        let f = self.gaps.component_mul(&inverse.component_mul(&inverse)) * volume;
        let c = rotation(m.component_mul(&inverse) * (0.5 * h), f);
        let turned = q * Quaternion::from_parts(1.0, c);
        turned * (1.0 / turned.norm())
    }

    /// S and D.
    #[inline]
    fn factors(&self, n: f64, h: f64) -> (f64, f64) {
        let (n2, nh, h2) = (n * n, n * h, h * h);
        let powers = [
            n,
            h,
            n2,
            nh,
            h2,
            n2 * n,
            n2 * h,
            n * h2,
            h2 * h,
            n2 * n2,
            n2 * nh,
            n2 * h2,
            nh * h2,
            h2 * h2,
        ];
        let (mut s, mut d) = (0.0, 0.0);
        for (k, power) in powers.iter().enumerate().take(self.terms) {
            s += self.s[k] * power;
            d += self.d[k] * power;
        }
        (1.0 + s, d)
    }
}

/// Solves `c = (1 + |c|²) a + f ∘ (c2 c3, c3 c1, c1 c2)` by Newton's iteration from c = a: the step
/// is the rotation `1 + c`.
#[inline]
fn rotation(a: Vector3<f64>, f: Vector3<f64>) -> Vector3<f64> {
    let mut c = a;
    for _ in 0..16 {
        let g = Vector3::new(f.x * c.y * c.z, f.y * c.z * c.x, f.z * c.x * c.y);
        let residual = c - a * (1.0 + c.norm_squared()) - g;
        let coupling = Matrix3::new(
            0.0,
            f.x * c.z,
            f.x * c.y, //
            f.y * c.z,
            0.0,
            f.y * c.x, //
            f.z * c.y,
            f.z * c.x,
            0.0,
        );
        let slope = Matrix3::identity() - a * c.transpose() * 2.0 - coupling;
        let step = solve(&slope, residual);
        c -= step;
        // Quadratic: the error left is below the square of this step.
        if step.norm_squared() <= 1e-18 * c.norm() {
            return c;
        }
    }
    Vector3::repeat(f64::NAN)
}

/// By Cramer's rule: the matrix is near the identity.
#[inline]
fn solve(m: &Matrix3<f64>, b: Vector3<f64>) -> Vector3<f64> {
    let (x, y, z) = (m.column(0), m.column(1), m.column(2));
    let yz = y.cross(&z);
    Vector3::new(yz.dot(&b), z.cross(&x).dot(&b), x.cross(&y).dot(&b)) / yz.dot(&x)
}

/// The coefficients of S and of D for moments of about 1.
#[rustfmt::skip]
fn coefficients(i: Vector3<f64>) -> ([f64; TERMS], [f64; TERMS]) {
    let p = |n: i32| i.iter().map(|&x| power(x, n)).sum::<f64>();
    let s = |up: i32, down: i32| {
        let cyclic = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];
        cyclic.map(|[a, b, c]| (power(i[a], up) + power(i[b], up)) / power(i[c], down)).iter().sum::<f64>()
    };
    let x = i.x * i.y * i.z;
    let (x2, x3, x4) = (x * x, x * x * x, x * x * x * x);
    let (p1, p2, p3, p4) = (p(1), p(2), p(3), p(4));
    let (n1, n2, n3, n4) = (p(-1), p(-2), p(-3), p(-4));
    let (s11, s12, s13, s21, s22, s31) = (s(1, 1), s(1, 2), s(1, 3), s(2, 1), s(2, 2), s(3, 1));
    let of_s = [
        p1 / (6.0 * x),
        -n1 / 3.0,

        (p2 / x - n1) / (30.0 * x),
        (1.0 - s11) / (30.0 * x),
        (3.0 * p1 / x + 2.0 * n2) / 60.0,

        (4.0 * x + 17.0 * p3 - 15.0 * x * s11) / (2520.0 * x3),
        (9.0 * p1 + 10.0 * x * n2 - 6.0 * s21) / (420.0 * x2),
        ((6.0 * s12 - 100.0 * n1) * x + 53.0 * p2) / (2520.0 * x2),
        (15.0 - x * n3 - 2.0 * s11) / (630.0 * x),

        (62.0 * p4 - 94.0 * x * s21 + 66.0 * x2 * n2 + 81.0 * x * p1) / (45360.0 * x4),
        (-77.0 * s31 + 75.0 * x * s12 + 214.0 * p2 - 240.0 * x * n1) / (22680.0 * x3),
        (26.0 * x * s22 + 55.0 * p3 + 204.0 * x - 50.0 * x2 * n3 - 59.0 * x * s11) / (7560.0 * x3),
        (137.0 * x * n2 - x * s13 + 3.0 * p1 - 69.0 * s21) / (11340.0 * x2),
        (2.0 * x2 * n4 + 5.0 * x * s12 - 171.0 * x * n1 + 159.0 * p2) / (45360.0 * x2),
    ];
    let of_d = [
        -1.0 / (3.0 * x),
        p1 / (6.0 * x),

        -p1 / (60.0 * x2),
        n1 / (10.0 * x) - p2 / (60.0 * x2),
        -(9.0 + s11) / (60.0 * x),

        (34.0 * x * n1 - 19.0 * p2) / (2520.0 * x3),
        (p3 + 2.0 * x * s11 - 85.0 * x) / (1260.0 * x3),
        (47.0 * p1 + 13.0 * s21 - 38.0 * x * n2) / (2520.0 * x2),
        (9.0 * x * n1 + x * s12 - 11.0 * p2) / (1260.0 * x2),

        (60.0 * x * s11 - 61.0 * p3 - 247.0 * x) / (45360.0 * x4),
        (54.0 * x * p1 - p4 + 218.0 * x * s21 - 426.0 * x2 * n2) / (45360.0 * x4),
        (125.0 * x * n1 - 5.0 * s31 - 130.0 * p2 + 4.0 * x * s12) / (7560.0 * x3),
        (67.0 * p3 - 735.0 * x - 15.0 * x * s22 + 87.0 * x * s11 + 34.0 * x2 * n3) / (22680.0 * x3),
        (165.0 * p1 - x * s13 - 9.0 * s21 - 145.0 * x * n2) / (45360.0 * x2),
    ];
    (of_s, of_d)
}
