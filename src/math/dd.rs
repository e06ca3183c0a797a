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
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Dd {
    pub hi: f64,
    pub lo: f64,
}

/// `a + b = s + e` exactly.
#[inline(always)]
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let t = s - a;
    (s, (a - (s - t)) + (b - t))
}

/// `a + b = s + e` exactly, for `|a| ≥ |b|` or `a = 0`.
#[inline(always)]
fn fast_two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    (s, b - (s - a))
}

/// `a b = p + e` exactly, unless something over- or underflows.
#[inline(always)]
pub fn two_prod(a: f64, b: f64) -> (f64, f64) {
    let p = a * b;
    let (ah, al) = split(a);
    let (bh, bl) = split(b);
    (p, ((ah * bh - p) + ah * bl + al * bh) + al * bl)
}

/// `a² = p + e` exactly, on the same terms.
#[inline(always)]
pub fn two_square(a: f64) -> (f64, f64) {
    let p = a * a;
    let (h, l) = split(a);
    (p, ((h * h - p) + 2.0 * h * l) + l * l)
}

/// The nearest whole number, by two additions: `round` is a library call on processors compiled for
/// without SSE4.1. Halves go to the even one.
#[inline]
pub fn nearest(x: f64) -> f64 {
    // From 2⁵¹ on the sum would not round to whole numbers; from 2⁵² on there are no others.
    if x.abs() < 2_251_799_813_685_248.0 {
        (x + MAGIC) - MAGIC
    } else {
        x.round()
    }
}

/// 1.5 · 2⁵²: what is added to it and is below 2⁵¹ is rounded to a whole number, which stands in the
/// last bits.
pub const MAGIC: f64 = 6_755_399_441_055_744.0;

/// Two halves of 26 bits each.
#[inline(always)]
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

    /// ln 2 to 107 bits.
    pub const LN_2: Self = Self {
        hi: std::f64::consts::LN_2,
        lo: 2.319_046_813_846_299_6e-17,
    };

    #[inline]
    pub const fn new(x: f64) -> Self {
        Self { hi: x, lo: 0.0 }
    }

    /// The difference of two f64, exactly.
    #[inline]
    pub fn difference(a: f64, b: f64) -> Self {
        let (hi, lo) = two_sum(a, -b);
        Self { hi, lo }
    }

    /// The product of two f64, exactly.
    #[inline]
    pub fn product(a: f64, b: f64) -> Self {
        let (hi, lo) = two_prod(a, b);
        Self { hi, lo }
    }

    #[inline]
    pub fn square(self) -> Self {
        let (p, e) = two_square(self.hi);
        let (hi, lo) = fast_two_sum(p, e + 2.0 * self.hi * self.lo);
        Self { hi, lo }
    }

    /// The sum of two numbers of one sign, in half the operations: 3 u² are lost, as in a sum
    /// (Joldes, Muller & Popescu 2017, "sloppy" addition, which is bad only where terms cancel).
    #[inline]
    pub fn plus(self, b: Self) -> Self {
        let (s, e) = two_sum(self.hi, b.hi);
        let (hi, lo) = fast_two_sum(s, e + (self.lo + b.lo));
        Self { hi, lo }
    }

    #[inline]
    pub fn abs(self) -> Self {
        if self.hi < 0.0 { -self } else { self }
    }

    /// By one Newton step from the f64 root; 0 for 0.
    #[inline]
    pub fn sqrt(self) -> Self {
        if self.hi <= 0.0 {
            return Self::ZERO;
        }
        let root = self.hi.sqrt();
        let (p, e) = two_square(root);
        // The first difference is exact.
        let rest = ((self.hi - p) - e) + self.lo;
        let (hi, lo) = fast_two_sum(root, rest * (0.5 / root));
        Self { hi, lo }
    }

    /// `x - round(x)`, in [-½, ½], to an absolute 1e-32 |x| or so; and `round(x)`.
    #[inline]
    pub fn fraction(self) -> (f64, f64) {
        let whole = nearest(self.hi);
        let rest = self - Self::new(whole);
        // A half is decided by what is beyond it.
        let more = if rest.hi.abs() == 0.5 {
            if rest.hi * rest.lo > 0.0 {
                2.0 * rest.hi
            } else {
                0.0
            }
        } else {
            nearest(rest.hi)
        };
        let rest = rest - Self::new(more);
        (rest.to_f64(), whole + more)
    }

    /// By Taylor's series once whole quarter turns are off: a relative rounding of x is what it costs,
    /// as long as x is below 1e15 or so.
    pub fn sin_cos(self) -> (Self, Self) {
        let quarters = (self.hi / std::f64::consts::FRAC_PI_2).round();
        let x = self - Self::PI.scaled(0.5) * quarters;
        let minus_x2 = -x.square();
        let (mut sin, mut cos) = (x, Self::ONE);
        let (mut odd, mut even) = (x, Self::ONE);
        // (π/4)²⁸/28! = 4e-33.
        for k in 1..=14 {
            let n = f64::from(2 * k);
            even = even * minus_x2 / Self::new(n * (n - 1.0));
            odd = odd * minus_x2 / Self::new(n * (n + 1.0));
            cos = cos + even;
            sin = sin + odd;
        }
        match libm::fmod(quarters, 4.0) {
            1.0 | -3.0 => (cos, -sin),
            2.0 | -2.0 => (-sin, -cos),
            3.0 | -1.0 => (-cos, sin),
            _ => (sin, cos),
        }
    }

    /// `e^x`: 0 below, ∞ above what an f64 holds.
    pub fn exp(self) -> Self {
        let (power, rest) = self.exponential();
        let (half, other) = halves(power);
        (rest + Self::ONE).scaled(half).scaled(other)
    }

    /// `e^x - 1`, to a relative rounding for small x.
    pub fn exp_m1(self) -> Self {
        match self.exponential() {
            (0.0, rest) => rest,
            _ => self.exp() - Self::ONE,
        }
    }

    /// `(n, r)` with `e^x = 2ⁿ (1 + r)`: Taylor's series of `e^y - 1` at a sixteenth, and
    /// `e^{2y} - 1 = (e^y - 1)² + 2 (e^y - 1)` back up.
    fn exponential(self) -> (f64, Self) {
        // Beyond ±800 the result is 0 or ∞ whatever the rest.
        let x = if self.hi.abs() >= 800.0 {
            Self::new(800.0_f64.copysign(self.hi))
        } else {
            self
        };
        let n = (x.hi / Self::LN_2.hi).round();
        let y = (x - Self::LN_2 * n).scaled(0.0625);
        let (mut rest, mut term) = (y, y);
        // (ln 2/32)¹⁶/16! = 1e-40 beside the first term.
        for k in 2..=16 {
            term = term * y / Self::new(f64::from(k));
            rest = rest + term;
        }
        for _ in 0..4 {
            rest = rest.square() + rest * 2.0;
        }
        (n, rest)
    }

    /// Exact: a power of two.
    #[inline]
    pub fn scaled(self, power: f64) -> Self {
        Self {
            hi: self.hi * power,
            lo: self.lo * power,
        }
    }

    #[inline]
    pub fn to_f64(self) -> f64 {
        self.hi + self.lo
    }
}

/// 2ⁿ as two factors that an f64 holds where it does not hold their product.
fn halves(n: f64) -> (f64, f64) {
    let half = (0.5 * n).round();
    (libm::exp2(half), libm::exp2(n - half))
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
    /// By one Newton step from the quotient of the upper halves.
    #[inline]
    fn div(self, b: Self) -> Self {
        let q = self.hi / b.hi;
        let (p, e) = two_prod(q, b.hi);
        // The first difference is exact; what it loses after that is a rounding of the rest.
        let rest = ((self.hi - p) - e) + (self.lo - q * b.lo);
        let (hi, lo) = fast_two_sum(q, rest * (1.0 / b.hi));
        Self { hi, lo }
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

    /// Every operation against mpmath, on arguments of full length.
    #[test]
    fn digits_from_outside() {
        type Operation = fn(Dd, Dd) -> Dd;
        // Joldes, Muller & Popescu (2017): 3 u² for the sum, 5 u² the product, 10 u² the quotient,
        // u = 2⁻⁵³, u² = 1.2e-32. The functions add a Taylor series of a dozen terms.
        let table: [(&str, Operation, f64); 8] = [
            ("dd_add", |a, b| a + b, 4e-32),
            ("dd_sub", |a, b| a - b, 4e-32),
            ("dd_mul", |a, b| a * b, 7e-32),
            ("dd_div", |a, b| a / b, 1.3e-31),
            ("dd_sqrt", |a, _| a.sqrt(), 1.3e-31),
            ("dd_exp", |a, _| a.exp(), 1e-31),
            ("dd_expm1", |a, _| a.exp_m1(), 1e-31),
            ("dd_sin", |a, _| a.sin_cos().0, 1e-31),
        ];
        for (name, operation, bound) in table {
            let mut worst = 0.0_f64;
            for ([ah, al, bh, bl], want) in crate::math::oracle::rows(name) {
                let (a, b) = (Dd { hi: ah, lo: al }, Dd { hi: bh, lo: bl });
                let mut off = crate::math::oracle::relative(operation(a, b), want);
                if matches!(name, "dd_exp" | "dd_expm1" | "dd_sin") {
                    // The argument is reduced to a rounding of itself.
                    off /= 1.0
                        + if ah.abs() < 0.3 {
                            0.0
                        } else {
                            ah.abs() / want.hi.abs().min(1.0)
                        };
                }
                assert!(off < bound, "{name} {a:?} {b:?}: {off:e}");
                worst = worst.max(off);
            }
            println!("{name}: {worst:.1e}");
        }
    }

    #[test]
    fn exponentials_at_the_ends() {
        assert_eq!(Dd::new(-1e9).exp(), Dd::ZERO);
        assert_eq!(Dd::new(-1e9).exp_m1(), -Dd::ONE);
        assert_eq!(Dd::new(1e9).exp().hi, f64::INFINITY);
        assert_eq!(Dd::ZERO.exp_m1(), Dd::ZERO);
    }

    #[test]
    fn the_nearest_whole_number() {
        let far = 2_251_799_813_685_248.0; // 2⁵¹
        for (x, want) in [
            (0.49999999999999994, 0.0),
            (0.5, 0.0),
            (-1.5, -2.0),
            (2.5000000000000004, 3.0),
            (far - 0.5, far),
            (far + 0.5, far + 1.0),
            (1e300, 1e300),
        ] {
            assert_eq!(nearest(x), want, "{x}");
        }
        assert!(nearest(f64::NAN).is_nan() && nearest(f64::INFINITY) == f64::INFINITY);
    }

    #[test]
    fn fractions_of_long_phases() {
        // 1e9 turns and a third: the third is kept to 1e-23, where an f64 keeps 1e-7.
        let third = Dd::ONE / Dd::new(3.0);
        let (part, whole) = (Dd::new(1e9) + third).fraction();
        assert_eq!(whole, 1e9);
        assert!((part - 1.0 / 3.0).abs() < 1e-16);
        // Halves and their neighbours, in either part.
        for lo in [-1e-20, 0.0, 1e-20] {
            for hi in [-2.5, -0.5, 0.5, 1.5, 1e15 + 0.5] {
                let x = Dd { hi, lo };
                let (part, whole) = x.fraction();
                assert!(part.abs() <= 0.5 && whole == whole.round(), "{x:?}");
                let rest = x - Dd::new(whole);
                assert!(
                    rest <= Dd::new(0.5) && rest >= Dd::new(-0.5),
                    "{x:?} {whole}"
                );
            }
        }
    }
}
