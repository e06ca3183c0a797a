//! Double-double arithmetic: a number as the unevaluated sum of two f64, about 32 digits.
//!
//! Error-free sums and products (Knuth; Dekker, Numer. Math. 18, 1971), combined as in Hida, Li &
//! Bailey, "Library for double-double and quad-double arithmetic" (2007) and judged by Joldes,
//! Muller & Popescu, ACM TOMS 44 (2017): relative errors of a few 2⁻¹⁰⁶ for +, × and ÷.
//!
//! Products are split by Veltkamp's constant rather than by `mul_add`, which is a library call
//! on processors compiled for without FMA. Splitting overflows above 2⁹⁹⁶.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// `hi + lo`, `|lo| ≤ ulp(hi)/2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dd {
    pub hi: f64,
    pub lo: f64,
}

/// `a + b = s + e` exactly.
#[inline]
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let t = s - a;
    (s, (a - (s - t)) + (b - t))
}

/// `a + b = s + e` exactly, for `|a| ≥ |b|` or `a = 0`.
#[inline]
fn fast_two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    (s, b - (s - a))
}

/// `a b = p + e` exactly, unless something over- or underflows.
#[inline]
pub fn two_prod(a: f64, b: f64) -> (f64, f64) {
    let p = a * b;
    let (ah, al) = split(a);
    let (bh, bl) = split(b);
    (p, ((ah * bh - p) + ah * bl + al * bh) + al * bl)
}

/// Two halves of 26 bits each.
#[inline]
fn split(a: f64) -> (f64, f64) {
    const VELTKAMP: f64 = 134_217_729.0; // 2²⁷ + 1
    let t = VELTKAMP * a;
    let hi = t - (t - a);
    (hi, a - hi)
}

impl Dd {
    pub const ZERO: Self = Self { hi: 0.0, lo: 0.0 };
    pub const ONE: Self = Self { hi: 1.0, lo: 0.0 };
    /// π to 107 bits.
    pub const PI: Self = Self {
        hi: std::f64::consts::PI,
        lo: 1.224_646_799_147_353_2e-16,
    };

    pub const fn new(x: f64) -> Self {
        Self { hi: x, lo: 0.0 }
    }

    /// The difference of two f64, exactly.
    pub fn difference(a: f64, b: f64) -> Self {
        let (hi, lo) = two_sum(a, -b);
        Self { hi, lo }
    }

    /// The product of two f64, exactly.
    pub fn product(a: f64, b: f64) -> Self {
        let (hi, lo) = two_prod(a, b);
        Self { hi, lo }
    }

    pub fn square(self) -> Self {
        self * self
    }

    pub fn abs(self) -> Self {
        if self.hi < 0.0 { -self } else { self }
    }

    /// By one Newton step from the f64 root; 0 for 0.
    pub fn sqrt(self) -> Self {
        if self.hi <= 0.0 {
            return Self::ZERO;
        }
        let root = self.hi.sqrt();
        let rest = self - Self::product(root, root);
        let (hi, lo) = fast_two_sum(root, rest.hi / (2.0 * root));
        Self { hi, lo }
    }

    /// `x - round(x)`, in [-½, ½], to an absolute 1e-32 |x| or so; and `round(x)`.
    pub fn fraction(self) -> (f64, f64) {
        let whole = self.hi.round();
        let rest = self - Self::new(whole);
        let more = rest.hi.round();
        let rest = rest - Self::new(more);
        (rest.to_f64(), whole + more)
    }

    /// Exact: a power of two.
    pub fn scaled(self, power: f64) -> Self {
        Self {
            hi: self.hi * power,
            lo: self.lo * power,
        }
    }

    pub fn to_f64(self) -> f64 {
        self.hi + self.lo
    }
}

impl Add for Dd {
    type Output = Self;
    #[inline]
    fn add(self, b: Self) -> Self {
        let (s, e) = two_sum(self.hi, b.hi);
        let (t, f) = two_sum(self.lo, b.lo);
        let (s, e) = fast_two_sum(s, e + t);
        let (hi, lo) = fast_two_sum(s, e + f);
        Self { hi, lo }
    }
}

impl Neg for Dd {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self {
            hi: -self.hi,
            lo: -self.lo,
        }
    }
}

impl Sub for Dd {
    type Output = Self;
    #[inline]
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl Mul for Dd {
    type Output = Self;
    #[inline]
    fn mul(self, b: Self) -> Self {
        let (p, e) = two_prod(self.hi, b.hi);
        let (hi, lo) = fast_two_sum(p, e + (self.hi * b.lo + self.lo * b.hi));
        Self { hi, lo }
    }
}

impl Mul<f64> for Dd {
    type Output = Self;
    #[inline]
    fn mul(self, b: f64) -> Self {
        let (p, e) = two_prod(self.hi, b);
        let (hi, lo) = fast_two_sum(p, e + self.lo * b);
        Self { hi, lo }
    }
}

impl Div for Dd {
    type Output = Self;
    #[inline]
    fn div(self, b: Self) -> Self {
        let q1 = self.hi / b.hi;
        let rest = self - b * q1;
        let q2 = rest.hi / b.hi;
        let rest = rest - b * q2;
        let q3 = rest.hi / b.hi;
        let (hi, lo) = fast_two_sum(q1, q2);
        Self { hi, lo } + Self::new(q3)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `a - b` where both are double-doubles that agree in most of their digits.
    fn gap(a: Dd, b: Dd) -> f64 {
        (a - b).to_f64()
    }

    #[test]
    fn errors_of_sums_and_products_are_exact() {
        // 2⁵³ + 1 and (1 + 2⁻³⁰)² do not fit an f64; what is missing is known.
        assert_eq!(
            two_sum(9_007_199_254_740_992.0, 1.0),
            (9_007_199_254_740_992.0, 1.0)
        );
        let x = 1.0 + 2.0_f64.powi(-30);
        assert_eq!(two_prod(x, x).1, 2.0_f64.powi(-60));
    }

    #[test]
    fn thirds_roots_and_pi() {
        let third = Dd::ONE / Dd::new(3.0);
        assert!(gap(third * 3.0, Dd::ONE).abs() < 1e-31);
        let root = Dd::new(2.0).sqrt();
        assert!(gap(root.square(), Dd::new(2.0)).abs() < 1e-31);
        // π² = 9.869604401089358618834490999876151135..., its f64 part and the rest (mpmath).
        let rest = 6.265295508739711e-16;
        let square = Dd {
            hi: 9.869_604_401_089_358,
            lo: rest,
        };
        assert!(
            gap(Dd::PI.square(), square).abs() < 1e-15 * 1e-15,
            "{:?}",
            Dd::PI.square()
        );
    }

    #[test]
    fn fractions_of_long_phases() {
        // 1e9 turns and a third: the third is kept to 1e-23, where an f64 keeps 1e-7.
        let third = Dd::ONE / Dd::new(3.0);
        let (part, whole) = (Dd::new(1e9) + third).fraction();
        assert_eq!(whole, 1e9);
        assert!((part - 1.0 / 3.0).abs() < 1e-16);
    }
}
