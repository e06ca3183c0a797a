//! The constants of a motion: moduli, rates and phases, from one AGM loop in double-double.
//!
//! With a = |I1 - I2| I3, b = |I2 - I3| I1, c = |I1 - I3| I2, V = I1 I2 I3 and s = m²:
//!
//! ```text
//! d1 = c s1 + b s2   d3 = a s2 + c s3   λ = √(b d3)/V   k² = a d1/b d3   k'² = c (b s3 - a s1)/b d3
//! Λ  = M(√(b d3), √(c (b s3 - a s1)))/V = λ π/2K          Λ' = M(√(b d3), √(a d1))/V = λ π/2K'
//! Ω  = (G I2 I3 - σ (½ G a S + V Λ))/V, and G/I2 on the separatrix         (p = √(c d3))
//!    = (G I1 I2 + σ d1 S/2G)/V                                             (p = √(b c) G)
//! t0 = σ m2 R_F(c d3 s1, c d1 s3, d1 d3) V                 u = λ (t + t0)
//! κ  = e^{-2ΛT_w}   T_w = R_F(b d1, c d1, b c G²) V        ε = e^{-2ΛT_a}   T_a = R_F(a d3, c d3, a c G²) V
//! ```
//!
//! S is [`Mean::with_sum`]'s, a complete integral of the third kind of characteristic n = -A/B or
//! k²/n (DLMF 19.8.6), whose sum is known (DLMF 19.7.8 at π/2): hence two forms of Ω. b c G² is at most
//! (c/a) b d3, c d3 is (c/b) b d3, and c = a + b: from the lesser p the sum takes four rounds or five,
//! for a thin rod too. The R_F are of the kinds that [`Mean`] takes down to an arsinh or arctan: √κ and √ε need neither.

use super::Time;
use super::branch::Branch;
use super::means::Mean;
use super::series::{Complementary, Complex, Nome};
use crate::math::{Dd, exp_falling};

/// Above this k² the series in the complementary nome converge faster.
const COMPLEMENTARY: f64 = 0.9;

/// A motion's rates and phases (in turns: ν/2π and Ωt/4π), and its series.
pub struct Constants {
    /// Ω/4π, 1/s.
    pub turns: Dd,
    pub form: Form,
}

/// Each evaluates α and β, and what comes to their common phase, in turns.
#[derive(Clone, Debug)]
pub enum Form {
    Nome(ByNome),
    Complementary(ByComplement),
    Separatrix(OnSeparatrix),
}

pub trait Pair {
    fn pair(&self, t: impl Time) -> (Complex, Complex, f64);
}

/// Away from the separatrix; ν = σΛ(t + t0).
#[derive(Clone, Debug)]
pub struct ByNome {
    rate: Dd,
    offset: Dd,
    series: Nome,
}

/// Near it, by the same ν, in half turns: less a whole number of them, it is small where the motion
/// is fast, and y, which is many times as large, is right there too.
#[derive(Clone, Debug)]
pub struct ByComplement {
    rate: Dd,
    offset: Dd,
    /// What y = Λ'ν/2Λ and the common phase Λ'T_a ν/π (turns) come to in half a turn of ν.
    y: f64,
    phase: f64,
    series: Complementary,
}

/// On it: y = σΛ'(t + t0)/2.
#[derive(Clone, Debug)]
pub struct OnSeparatrix {
    rate: Dd,
    offset: Dd,
    series: Complementary,
}

impl Pair for ByNome {
    #[inline(always)]
    fn pair(&self, t: impl Time) -> (Complex, Complex, f64) {
        let nu = t.gone(self.rate).from(self.offset).reduced();
        let (alpha, beta) = self.series.at(nu);
        (alpha, beta, 0.0)
    }
}

impl Pair for ByComplement {
    #[inline(always)]
    fn pair(&self, t: impl Time) -> (Complex, Complex, f64) {
        let (halves, odd) = t.gone(self.rate).from(self.offset).parted();
        let (alpha, (re, im)) = self.series.at(self.y, halves);
        let signed = |x: f64| f64::from_bits(x.to_bits() ^ odd << 63);
        (alpha, (signed(re), signed(im)), self.phase * halves)
    }
}

impl Pair for OnSeparatrix {
    #[inline(always)]
    fn pair(&self, t: impl Time) -> (Complex, Complex, f64) {
        let y = t.gone(self.rate).from(self.offset);
        let (alpha, beta) = self.series.on_separatrix(y.turns + y.rest);
        (alpha, beta, 0.0)
    }
}

/// Double-double: 1/4π, 1/2π.
pub const OVER_FOUR_PI: Dd = Dd {
    hi: 0.079_577_471_545_947_67,
    lo: -4.919_669_168_795_621_5e-18,
};
const OVER_TWO_PI: Dd = Dd {
    hi: 0.159_154_943_091_895_35,
    lo: -9.839_338_337_591_243e-18,
};

/// What the forms are made of.
struct Parts<'b> {
    branch: &'b Branch,
    d1: Dd,
    d3: Dd,
    g: Dd,
    /// V λ.
    alpha: Dd,
    /// 1/V times the unit of the rates.
    over_v: Dd,
}

impl Constants {
    /// In rates `unit` times as large as those of the branch.
    pub fn new(branch: &Branch, unit: f64) -> Self {
        let &Branch { a, b, c, scale, .. } = branch;
        let [i1, i2, i3] = branch.i;
        let [s1, s2, s3] = branch.squares;
        let (s1, s3) = (s1.scaled(scale * scale), s3.scaled(scale * scale));
        let d1 = (c * s1).plus(b * s2);
        let d3 = (a * s2).plus(c * s3);
        let g2 = s1.plus(s2).plus(s3);
        let alpha2 = b * d3;
        let parts = Parts {
            branch,
            d1,
            d3,
            g: g2.sqrt(),
            alpha: alpha2.sqrt(),
            over_v: (Dd::ONE / (Dd::product(i1, i2) * i3)).scaled(unit),
        };
        let gamma = (c * branch.gap).sqrt().scaled(scale);
        if gamma.hi == 0.0 {
            return parts.separatrix();
        }
        let g = parts.g;
        let product = a.hi * d1.hi;
        let bg2 = b * g2;
        let short = bg2.hi < d3.hi;
        let p = (c * if short { bg2 } else { d3 }).sqrt();
        let (mean, sum) = Mean::with_sum(parts.alpha, gamma, product, p);
        let turning = if short {
            Dd::product(i1, i2) * g + (d1 * sum / g).scaled(0.5 * branch.sigma)
        } else {
            let less = (g * a * sum).scaled(0.5).plus(mean.limit);
            Dd::product(i2, i3) * g - less * branch.sigma
        };
        Self {
            turns: turning * parts.over_v * OVER_FOUR_PI,
            form: if product > COMPLEMENTARY * alpha2.hi {
                parts.complementary(mean.limit, gamma.hi)
            } else {
                parts.nome(&mean)
            },
        }
    }
}

impl Parts<'_> {
    fn nome(&self, mean: &Mean) -> Form {
        let &Branch { m, .. } = self.branch;
        let [a, b, c] = self.branch.arms();
        let (d1, d3, g) = (self.d1.hi, self.d3.hi, self.g.hi);
        let lambda = mean.limit.hi;
        // e^{-arsinh Λ/x}
        let root = |x: f64| x / ((x * x + lambda * lambda).sqrt() + lambda);
        let root_k = root(mean.rising((b * d1).sqrt(), (c * d1).sqrt(), 1.0));
        let root_e = root(mean.rising((a * d3).sqrt(), (a * c).sqrt() * g, 1.0));
        // The R_F of t0 but for d1 in the second and third argument, which may be 0.
        let m2 = m[1].hi;
        let size = if d1 > 0.0 { m2.abs() / d1.sqrt() } else { 0.0 };
        let x = mean.falling(
            (c * d3).sqrt() * m[0].hi,
            c.sqrt() * m[2].hi,
            d3.sqrt(),
            size,
        );
        Form::Nome(ByNome {
            rate: self.rate(mean.limit),
            offset: Dd::new(libm::atan2(m2 * lambda, x) * OVER_TWO_PI.hi),
            series: Nome::new(root_k, root_e),
        })
    }

    fn complementary(&self, lambda: Dd, gamma: f64) -> Form {
        let dual = Mean::of(self.alpha, (self.branch.a * self.d1).sqrt(), gamma * gamma);
        let y = (Dd::PI * dual.limit / lambda).scaled(0.5);
        let (double, angle) = self.lean(&dual);
        Form::Complementary(ByComplement {
            rate: self.rate(lambda).scaled(2.0),
            offset: self.start(&dual) / y,
            y: y.hi,
            phase: angle * OVER_TWO_PI.hi,
            series: Complementary::new(exp_falling(y.hi), double),
        })
    }

    fn separatrix(&self) -> Constants {
        let dual = Mean::of(self.alpha, (self.branch.a * self.d1).sqrt(), 0.0);
        let [i1, _, i3] = self.branch.i;
        Constants {
            turns: self.g * Dd::product(i1, i3) * self.over_v * OVER_FOUR_PI,
            form: Form::Separatrix(OnSeparatrix {
                rate: (dual.limit * self.over_v).scaled(0.5 * self.branch.sigma),
                offset: self.start(&dual),
                series: Complementary::new(0.0, self.lean(&dual).0),
            }),
        }
    }

    /// σΛ/2π, turns a second.
    fn rate(&self, lambda: Dd) -> Dd {
        lambda * self.over_v * OVER_TWO_PI * self.branch.sigma
    }

    /// 2A0 = Λ'T_a in [0, π/2], and before it its cosine and sine.
    fn lean(&self, dual: &Mean) -> ((f64, f64), f64) {
        let [a, _, c] = self.branch.arms();
        let d3 = self.d3.hi;
        let x = dual.falling(
            (a * d3).sqrt(),
            (a * c).sqrt() * self.g.hi,
            (c * d3).sqrt(),
            1.0,
        );
        let limit = dual.limit.hi;
        let long = 1.0 / (x * x + limit * limit).sqrt();
        ((x * long, limit * long), libm::atan2(limit, x))
    }

    /// `y = σΛ't0/2 = ±½ arsinh(|m2| Λ'/x)` at the start, to an absolute 1e-16: it may be hundreds.
    fn start(&self, dual: &Mean) -> Dd {
        let &Branch { m, scale, .. } = self.branch;
        let [_, _, c] = self.branch.arms();
        let (m2, by_scale) = (m[1].hi.abs(), m[1].hi.abs() / scale);
        let x = dual.rising(
            (c * self.d3.hi).sqrt() * m[0].hi,
            (c * self.d1.hi).sqrt() * m[2].hi,
            by_scale,
        );
        let reach = m2 * dual.limit.hi;
        let real = scale * x;
        let ratio = ((real * real + reach * reach).sqrt() + reach) / x;
        // Whole powers of two of it have their logarithm in double-double.
        let (ratio, power) = libm::frexp(ratio);
        let power = f64::from(power) - libm::log2(scale);
        let log = Dd::LN_2 * power + Dd::new(libm::log(ratio));
        log.scaled(0.5_f64.copysign(m[1].hi))
    }
}
