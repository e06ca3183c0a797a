//! The two theta series (α, β) whose quotient is the attitude about L.

#[derive(Clone, Debug)]
pub enum Series {
    /// In the nome q = κ ε, κ and ε apart so that a symmetric body (one of them 0) is no 0/0.
    Nome { q: f64, kappa: f64, epsilon: f64 },
    /// In the complementary nome, for motions that come near the separatrix.
    Complementary {
        /// -ln Q'.
        exponent: f64,
        /// A0.
        a0: f64,
        /// y per ν: Λ'/2Λ.
        y_per: f64,
        /// The common phase per ν.
        phase_per: f64,
    },
    /// On the separatrix: hyperbolic functions of y = σ rate t + y0.
    Separatrix { a0: f64, rate: f64, y0: f64 },
}

pub type Complex = (f64, f64);

/// α and β by the nome: alternating theta series in e^{iν}.
pub fn nome_series(q: f64, kappa: f64, epsilon: f64, nu: f64, odd: bool) -> (Complex, Complex) {
    let (sin1, cos1) = libm::sincos(nu);
    let (sin2, cos2) = (2.0 * sin1 * cos1, (cos1 - sin1) * (cos1 + sin1));
    let (mut re, mut im) = (1.0, 0.0);
    let (mut sin, mut cos) = (0.0, 1.0);
    for j in 1..=3_i32 {
        (cos, sin) = times((cos, sin), (cos2, sin2));
        let sign = if j % 2 == 0 { 1.0 } else { -1.0 };
        let up = sign * q.powi(j * (2 * j - 1)) * kappa.powi(j);
        let down = sign * q.powi(2 * j * j) * epsilon.powi(j);
        re += (up + down) * cos;
        im += (up - down) * sin;
    }
    let alpha = (re, im);
    let (rk, re_, rq) = (kappa.sqrt(), epsilon.sqrt(), q.sqrt());
    let (mut br, mut bi) = (0.0, 0.0);
    (sin, cos) = (sin1, cos1);
    for j in 0..=2_i32 {
        let sign = if j % 2 == 0 { 1.0 } else { -1.0 };
        let up = sign * q.powi(j * (2 * j + 1)) * kappa.powi(j) * rk;
        let down = sign * q.powi(2 * j * j + 2 * j) * rq * epsilon.powi(j) * re_;
        // -i (up e^{iν'} - down e^{-iν'}) = (up + down) sin ν' - i (up - down) cos ν'.
        br += (up + down) * sin;
        bi -= (up - down) * cos;
        (cos, sin) = times((cos, sin), (cos2, sin2));
    }
    if odd {
        (br, bi) = (-br, -bi);
    }
    (alpha, (br, bi))
}

/// α and β by the complementary nome Q' = e^{-exponent}, e^{|y|} taken out; exponent ∞ on the
/// separatrix, where one term is left.
pub fn complementary_series(exponent: f64, a0: f64, y: f64, odd: bool) -> (Complex, Complex) {
    let (size, side) = (y.abs(), if y < 0.0 { -1.0 } else { 1.0 });
    // Q' e^{2|y|} by its exponent: apart, the one underflows where the other overflows.
    let (nome, grown) = (libm::exp(-exponent), libm::exp(2.0 * size - exponent));
    let (mut ar, mut ai, mut br, mut bi) = (0.0, 0.0, 0.0, 0.0);
    for j in 0..=3_i32 {
        let s = f64::from(2 * j + 1);
        let weight = nome.powi(j * j) * grown.powi(j);
        if weight == 0.0 {
            break;
        }
        let decay = libm::exp(-2.0 * s * size);
        let (cosh, sinh) = (
            weight * (1.0 + decay),
            -weight * side * libm::expm1(-2.0 * s * size),
        );
        let (sin, cos) = libm::sincos(s * a0);
        let sign = if j % 2 == 0 { 1.0 } else { -1.0 };
        ar += cos * cosh;
        ai -= sin * sinh;
        br += sign * cos * sinh;
        bi -= sign * sin * cosh;
    }
    if odd {
        (br, bi) = (-br, -bi);
    }
    ((ar, ai), (br, bi))
}

/// The product of two complex numbers.
pub fn times((a, b): (f64, f64), (c, d): (f64, f64)) -> (f64, f64) {
    (a * c - b * d, a * d + b * c)
}
