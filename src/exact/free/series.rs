//! The two theta series (α, β) whose quotient is the attitude about L.

use crate::math::power;

#[derive(Clone, Debug)]
pub enum Series {
    /// Alternating series in e^{iν}, by the nome.
    Nome(Nome),
    /// In the complementary nome, for motions that come near the separatrix.
    Complementary {
        terms: Complementary,
        /// y per ν: Λ'/2Λ.
        y_per: f64,
        /// Turns of the common phase per ν: Λ'T_a/2π².
        turns_per: f64,
    },
    /// On the separatrix: hyperbolic functions of y = σ rate t + y0, one term.
    Separatrix {
        terms: Complementary,
        rate: f64,
        y0: f64,
    },
}

pub type Complex = (f64, f64);

/// What stands before `cos` and `sin` of `2jν` in α, j = 1, 2, 3, and before `sin` and `-cos` of
/// `(2j+1)ν` in β, j = 0, 1, 2: sum and difference of what comes by κ and what comes by ε.
#[derive(Clone, Debug)]
pub struct Nome {
    alpha: [(f64, f64); 3],
    beta: [(f64, f64); 3],
}

impl Nome {
    /// In the nome q = κ ε, κ and ε apart so that a symmetric body (one of them 0) is no 0/0.
    pub fn new(kappa: f64, epsilon: f64) -> Self {
        let q = kappa * epsilon;
        let (root_k, root_e, root_q) = (kappa.sqrt(), epsilon.sqrt(), q.sqrt());
        let pair = |up: f64, down: f64| (up + down, up - down);
        let alternate = |j: i32| if j % 2 == 0 { 1.0 } else { -1.0 };
        Self {
            alpha: [1, 2, 3].map(|j| {
                let sign = alternate(j);
                pair(
                    sign * power(q, j * (2 * j - 1)) * power(kappa, j),
                    sign * power(q, 2 * j * j) * power(epsilon, j),
                )
            }),
            beta: [0, 1, 2].map(|j| {
                let sign = alternate(j);
                pair(
                    sign * power(q, j * (2 * j + 1)) * power(kappa, j) * root_k,
                    sign * power(q, 2 * j * j + 2 * j) * root_q * power(epsilon, j) * root_e,
                )
            }),
        }
    }

    /// α and β; `odd` where an odd number of π was taken off ν.
    pub fn at(&self, nu: f64, odd: bool) -> (Complex, Complex) {
        let (sin1, cos1) = libm::sincos(nu);
        let twice = ((cos1 - sin1) * (cos1 + sin1), 2.0 * sin1 * cos1);
        let (mut re, mut im) = (1.0, 0.0);
        let mut turn = (1.0, 0.0);
        for &(sum, difference) in &self.alpha {
            turn = times(turn, twice);
            re += sum * turn.0;
            im += difference * turn.1;
        }
        let (mut br, mut bi) = (0.0, 0.0);
        turn = (cos1, sin1);
        for &(sum, difference) in &self.beta {
            // -i (up e^{iν'} - down e^{-iν'}) = (up + down) sin ν' - i (up - down) cos ν'.
            br += sum * turn.1;
            bi -= difference * turn.0;
            turn = times(turn, twice);
        }
        if odd {
            (br, bi) = (-br, -bi);
        }
        ((re, im), (br, bi))
    }
}

/// The series in the complementary nome `Q' = e^{-exponent}`; exponent ∞ on the separatrix, where
/// one term is left.
#[derive(Clone, Debug)]
pub struct Complementary {
    exponent: f64,
    /// `Q'^{j²}` times cosine and sine of `(2j+1) A0`. Q' = e^{-πK/2K'} is at most 0.081 (k² = 0.9),
    /// and the term after these, Q'¹⁶, at most 4e-18.
    terms: [Complex; 4],
}

impl Complementary {
    pub fn new(exponent: f64, a0: f64) -> Self {
        let nome = libm::exp(-exponent);
        Self {
            exponent,
            terms: [0, 1, 2, 3].map(|j| {
                let (sin, cos) = libm::sincos(f64::from(2 * j + 1) * a0);
                let weight = power(nome, j * j);
                (weight * cos, weight * sin)
            }),
        }
    }

    /// α and β, e^{|y|} taken out; `odd` as above.
    pub fn at(&self, y: f64, odd: bool) -> (Complex, Complex) {
        let (size, side) = (y.abs(), if y < 0.0 { -1.0 } else { 1.0 });
        // Q' e^{2|y|} by its exponent: apart, the one underflows where the other overflows.
        let grown = libm::exp(2.0 * size - self.exponent);
        let fall = libm::expm1(-2.0 * size);
        // With d = e^{-2|y|}: 2 cosh is 1 + d^s, 2 sinh is 1 - d^s = (1 - d)(1 + d + ... + d^{s-1}).
        let d = 1.0 + fall;
        let d2 = d * d;
        let (mut rest, mut chain, mut weight) = (d, 1.0, 1.0);
        let (mut ar, mut ai, mut br, mut bi) = (0.0, 0.0, 0.0, 0.0);
        let mut sign = 1.0;
        for &(cos, sin) in &self.terms {
            let cosh = weight * (1.0 + rest);
            let sinh = -weight * side * fall * chain;
            ar += cos * cosh;
            ai -= sin * sinh;
            br += sign * cos * sinh;
            bi -= sign * sin * cosh;
            chain += rest * (1.0 + d);
            rest *= d2;
            weight *= grown;
            sign = -sign;
        }
        if odd {
            (br, bi) = (-br, -bi);
        }
        ((ar, ai), (br, bi))
    }
}

/// The product of two complex numbers.
pub fn times((a, b): Complex, (c, d): Complex) -> Complex {
    (a * c - b * d, a * d + b * c)
}
