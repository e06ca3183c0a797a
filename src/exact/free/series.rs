//! The two theta series (α, β) whose quotient is the attitude about L.

use crate::math::{exp_falling, sin_cos_turns};

pub type Complex = (f64, f64);

/// The series by the nome q = κ ε, alternating in e^{iν}:
///
/// ```text
/// α = 1 + Σ_{j=1..3} (-1)^j [q^{j(2j-1)} κ^j e^{2ijν} + q^{2j²} ε^j e^{-2ijν}]
/// β = -i Σ_{j=0..2} (-1)^j [q^{j(2j+1)} κ^{j+½} e^{i(2j+1)ν} - q^{2j²+2j+½} ε^{j+½} e^{-i(2j+1)ν}]
/// ```
///
/// as polynomials in c = cos 2ν: `Re α = P(c)`, `Im α = sin 2ν R(c)`, `Re β = sin ν U(c)`,
/// `Im β = -cos ν V(c)`. At k² = 0.9 q is 0.14 and the first terms left out at most 1.3e-18.
#[derive(Clone, Debug)]
pub struct Nome {
    p: [f64; 4],
    r: [f64; 3],
    u: [f64; 3],
    v: [f64; 3],
}

impl Nome {
    /// From √κ and √ε, apart so that a symmetric body (one of them 0) is no 0/0.
    pub fn new(root_k: f64, root_e: f64) -> Self {
        let (k, e) = (root_k * root_k, root_e * root_e);
        let (root_q, q) = (root_k * root_e, k * e);
        let (q2, ke, ee) = (q * q, k * k, e * e);
        let (q4, q6) = (q2 * q2, q2 * q2 * q2);
        let q8 = q4 * q4;
        let pair = |up: f64, down: f64| (up + down, up - down);
        // Before cos and sin of 2jν in α, before sin and -cos of (2j+1)ν in β: what comes by κ and
        // what comes by ε.
        let (a1, d1) = pair(-q * k, -q2 * e);
        let (a2, d2) = pair(q6 * ke, q8 * ee);
        let (a3, d3) = pair(-q8 * q6 * q * ke * k, -q8 * q8 * q2 * ee * e);
        let (b0, e0) = pair(root_k, root_q * root_e);
        let (b1, e1) = pair(-q2 * q * k * root_k, -q4 * root_q * e * root_e);
        let (b2, e2) = pair(q8 * q2 * ke * root_k, q8 * q4 * root_q * ee * root_e);
        Self {
            // cos 4ν = 2c² - 1, cos 6ν = 4c³ - 3c; sin 4ν = 2c sin 2ν, sin 6ν = (4c² - 1) sin 2ν.
            p: [1.0 - a2, a1 - 3.0 * a3, 2.0 * a2, 4.0 * a3],
            r: [d1 - d3, 2.0 * d2, 4.0 * d3],
            // sin 3ν = (2c + 1) sin ν, sin 5ν = (4c² + 2c - 1) sin ν; cosines with -2c.
            u: [b0 + b1 - b2, 2.0 * (b1 + b2), 4.0 * b2],
            v: [e0 - e1 - e2, 2.0 * (e1 - e2), 4.0 * e2],
        }
    }

    /// α and β at ν, in turns.
    #[inline(always)]
    pub fn at(&self, turns: f64) -> (Complex, Complex) {
        let (sin, cos) = sin_cos_turns(turns);
        let (c, s) = ((cos - sin) * (cos + sin), 2.0 * sin * cos);
        let [p0, p1, p2, p3] = self.p;
        let quadratic = |[x0, x1, x2]: [f64; 3]| x0 + c * (x1 + c * x2);
        (
            ((p0 + c * p1) + c * c * (p2 + c * p3), s * quadratic(self.r)),
            (sin * quadratic(self.u), -cos * quadratic(self.v)),
        )
    }
}

/// The series in the complementary nome `Q' = e^{-πK/2K'}`, over s = 2j+1, j = 0..3:
///
/// ```text
/// α = Σ Q'^{j²+j} [cos sA0 cosh sy - i sin sA0 sinh sy]
/// β = Σ (-1)^j Q'^{j²+j} [cos sA0 sinh sy - i sin sA0 cosh sy]
/// ```
///
/// with e^{|y|}/2 taken out: d = e^{-2|y|}, g = Q' e^{2|y|} ≤ 1, and what stands before g^j and
/// `d (Q' d)^j` is `Q'^{j²}` times cosine and sine of sA0.
#[derive(Clone, Debug)]
pub struct Complementary {
    nome: f64,
    cos: [f64; 4],
    sin: [f64; 4],
}

impl Complementary {
    /// Q' is at most 0.081 (k² = 0.9), and the term after these, Q'¹⁶, at most 4e-18. `double` is
    /// cosine and sine of 2A0, in [0, π/2].
    pub fn new(nome: f64, double: Complex) -> Self {
        let cos = (0.5 + 0.5 * double.0).sqrt();
        let mut turn = (cos, 0.5 * double.1 / cos);
        let mut terms = Self {
            nome,
            cos: [0.0; 4],
            sin: [0.0; 4],
        };
        let n3 = nome * nome * nome;
        for (j, weight) in [1.0, nome, n3 * nome, n3 * n3 * n3].into_iter().enumerate() {
            (terms.cos[j], terms.sin[j]) = (weight * turn.0, weight * turn.1);
            turn = times(turn, double);
        }
        terms
    }

    /// α and β where y is `largest` times x, |x| at most ½, and `e^{-largest}` is Q'.
    #[inline(always)]
    pub fn at(&self, largest: f64, x: f64) -> (Complex, Complex) {
        // 2|y|, and how far it is from the most it can be: e^{-2|y|} and Q' e^{2|y|} multiply to Q',
        // and by the larger of them neither is lost where Q' underflows.
        let twice = 2.0 * x.abs();
        let (gone, left) = (twice * largest, (1.0 - twice) * largest);
        let near = gone <= left;
        let large = exp_falling(if near { gone } else { left });
        let small = self.nome / large;
        let (d, g) = if near { (large, small) } else { (small, large) };
        let side = 1.0_f64.copysign(x);
        let (h, gg) = (self.nome * d, g * g);
        let hh = h * h;
        let halves = |[t0, t1, t2, t3]: [f64; 4]| {
            let growing = (t0 + t2 * gg, g * (t1 + t3 * gg));
            let falling = (d * (t0 + t2 * hh), d * (h * (t1 + t3 * hh)));
            (growing, falling)
        };
        let ((c0, c1), (dc0, dc1)) = halves(self.cos);
        let ((s0, s1), (ds0, ds1)) = halves(self.sin);
        (
            ((c0 + c1) + (dc0 + dc1), -side * ((s0 + s1) - (ds0 + ds1))),
            (side * ((c0 - c1) - (dc0 - dc1)), -((s0 - s1) + (ds0 - ds1))),
        )
    }

    /// The same on the separatrix, Q' = 0: the first term alone, at any y.
    #[inline(always)]
    pub fn on_separatrix(&self, y: f64) -> (Complex, Complex) {
        let d = exp_falling(2.0 * y.abs());
        let (cos, sin) = (self.cos[0], self.sin[0]);
        let (plus, minus) = (1.0 + d, (1.0 - d).copysign(y));
        ((cos * plus, -sin * minus), (cos * minus, -sin * plus))
    }
}

/// The product of two complex numbers.
#[inline(always)]
pub fn times((a, b): Complex, (c, d): Complex) -> Complex {
    (a * c - b * d, a * d + b * c)
}
