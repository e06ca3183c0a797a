//! Sines, cosines and exponentials of arguments that are reduced already, without a branch: for phases
//! that are kept in turns, one at a time or in lanes.
//!
//! `libm` takes radians of any size and has to find out which; a phase in turns is reduced by taking
//! off whole quarters, which is exact, and what is left goes into two polynomials.

use super::dd::{Dd, MAGIC, two_prod, two_sum};

/// `(sin 2πx, cos 2πx)` for |x| < 2⁴⁹, to 1.7 and 1 units in the last place.
///
/// ```text
/// k = round(4x)   r = x - k/4 (exact)   z = r² ≤ 1/64
/// sin 2πr = r (2π + z S(z))   cos 2πr = 1 - 2π² z + z² C(z)
/// ```
///
/// and k quarter turns swap them and change signs. S and C are Chebyshev interpolants on [0, 1/64], off
/// by 1.3e-17 of the sine and 5e-19 (tests/oracles/turns.py).
#[inline(always)]
pub fn sin_cos_turns(x: f64) -> (f64, f64) {
    let quarters = 4.0 * x + MAGIC;
    let r = x - 0.25 * (quarters - MAGIC);
    let z = r * r;
    let zz = z * z;
    let [s0, s1, s2, s3, s4, s5] = SINE;
    let [c0, c1, c2, c3, c4, c5] = COSINE;
    let s = (s0 + z * s1) + zz * ((s2 + z * s3) + zz * (s4 + z * s5));
    let c = (c0 + z * c1) + zz * ((c2 + z * c3) + zz * (c4 + z * c5));
    let sin = r * TAU + r * (z * s + TAU_LO);
    let drop = z * DROP;
    let rest = 1.0 - drop;
    // What the difference lost is put back: (1 - rest) - drop is exact.
    let cos = rest + (((1.0 - rest) - drop) + z * (z * c - DROP_LO));

    let k = quarters.to_bits();
    let (sin, cos) = (sin.to_bits(), cos.to_bits());
    let swap = (sin ^ cos) & 0_u64.wrapping_sub(k & 1);
    let (minus_sin, minus_cos) = ((k & 2) << 62, (k.wrapping_add(1) & 2) << 62);
    (
        f64::from_bits(sin ^ swap ^ minus_sin),
        f64::from_bits(cos ^ swap ^ minus_cos),
    )
}

/// 2π and what its f64 leaves out.
const TAU: f64 = std::f64::consts::TAU;
const TAU_LO: f64 = 2.449_293_598_294_706_4e-16;
/// 2π², the same.
const DROP: f64 = 19.739_208_802_178_716;
const DROP_LO: f64 = 1.253_059_101_747_942_3e-15;

const SINE: [f64; 6] = [
    -41.341_702_240_399_755,
    81.605_249_276_051_7,
    -76.705_859_735_620_93,
    42.058_689_180_885_12,
    -15.094_054_182_079_999,
    3.786_433_349_565_45,
];

const COSINE: [f64; 6] = [
    64.939_394_022_668_3,
    -85.456_817_206_684_55,
    60.244_641_365_022_78,
    -26.426_254_911_246_687,
    7.903_305_164_742_355,
    -1.701_221_523_203_635_2,
];

/// `e^{-x}` for x ≥ 0, to 1.1 units in the last place; from x = 708 on that of 708, 3e-308.
///
/// ```text
/// n = round(x / ln 2)   r = x - n ln 2, |r| ≤ ln 2/2   e^{-x} = 2⁻ⁿ (1 - r + r² E(r))
/// ```
///
/// E is a Chebyshev interpolant, off by 1.3e-17 of the result (tests/oracles/turns.py).
#[inline(always)]
pub fn exp_falling(x: f64) -> f64 {
    let x = if x > 708.0 { 708.0 } else { x };
    let shifted = x * std::f64::consts::LOG2_E + MAGIC;
    let n = shifted - MAGIC;
    // The upper part has 31 bits, n at most 10.
    let r = (x - n * LN_2_HI) - n * LN_2_LO;
    let [e0, e1, e2, e3, e4, e5, e6, e7, e8, e9] = FALL;
    let rr = r * r;
    let r4 = rr * rr;
    let low = (e0 + r * e1) + rr * (e2 + r * e3);
    let high = (e4 + r * e5) + rr * (e6 + r * e7) + r4 * (e8 + r * e9);
    let power = f64::from_bits(1023_u64.wrapping_sub(shifted.to_bits()) << 52);
    power * (1.0 - (r - rr * (low + r4 * high)))
}

const LN_2_HI: f64 = 0.693_147_180_136_293_2;
const LN_2_LO: f64 = 4.236_521_365_809_284e-10;

const FALL: [f64; 10] = [
    0.500_000_000_000_000_1,
    -0.166_666_666_666_666_69,
    0.041_666_666_666_623_824,
    -0.008_333_333_333_330_039,
    0.001_388_888_891_736_708_1,
    -0.000_198_412_698_631_715_57,
    2.480_152_105_786_820_4e-5,
    -2.755_726_827_690_569_6e-6,
    2.762_020_159_103_154_7e-7,
    -2.510_047_250_569_499_5e-8,
];

/// A phase in turns, as the f64 nearest to it and what that leaves out.
#[derive(Clone, Copy, Debug)]
pub struct Phase {
    pub turns: f64,
    pub rest: f64,
}

impl Phase {
    /// `t rate`.
    #[inline(always)]
    pub fn gone(t: f64, rate: Dd) -> Self {
        let (turns, e) = two_prod(t, rate.hi);
        Self {
            turns,
            rest: e + t * rate.lo,
        }
    }

    #[inline(always)]
    pub fn from(self, offset: Dd) -> Self {
        let (turns, e) = two_sum(self.turns, offset.hi);
        Self {
            turns,
            rest: self.rest + (e + offset.lo),
        }
    }

    /// The phase less whole turns, to an absolute 1e-16 and 1e-32 of it; at most ½, and 1 from 2⁵¹
    /// turns on.
    #[inline(always)]
    pub fn reduced(self) -> f64 {
        let whole = |x: f64| (x + MAGIC) - MAGIC;
        (self.turns - whole(self.turns)) + (self.rest - whole(self.rest))
    }
    /// The phase less the whole turns nearest to it, to a relative 1e-16 and 1e-32 of it; and a number
    /// that is odd where they are (up to 2⁸⁰ of them).
    #[inline(always)]
    pub fn parted(self) -> (f64, u64) {
        // Multiples of 2³⁰ first, which are even: the last bit of the rest is then one of its sum.
        const FAR: f64 = MAGIC * 1_073_741_824.0;
        let near = self.turns - ((self.turns + FAR) - FAR);
        let of_rest = self.rest + MAGIC;
        let rest = self.rest - (of_rest - MAGIC);
        let of_both = (near + rest) + MAGIC;
        (
            (near - (of_both - MAGIC)) + rest,
            of_rest.to_bits() ^ of_both.to_bits(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against tests/oracles/turns.py, in units in the last place of the result: measured, at most 1.00,
    /// 0.97 and 0.78.
    #[test]
    fn digits_from_outside() {
        let mut worst = [0.0_f64; 3];
        for line in include_str!("../../tests/oracles/turns.csv")
            .lines()
            .skip(1)
        {
            let (name, rest) = line.split_once(',').unwrap();
            let [x, hi, lo] = [0, 1, 2].map(|k| rest.split(',').nth(k).unwrap().parse().unwrap());
            let (which, got, bound) = match name {
                "sin" => (0, sin_cos_turns(x).0, 1.1),
                "cos" => (1, sin_cos_turns(x).1, 1.1),
                _ => (2, exp_falling(x), 1.0),
            };
            let unit = f64::EPSILON * 2.0_f64.powf(f64::log2(f64::abs(hi)).floor());
            let off = match hi {
                0.0 => f64::abs(got) / f64::EPSILON,
                _ => ((got - hi) - lo).abs() / unit,
            };
            // Written so that a NaN fails.
            assert!(off <= bound, "{line}: {got:e} is off by {off} units");
            worst[which] = worst[which].max(off);
        }
        println!(
            "sin {:.2}, cos {:.2}, exp {:.2} units",
            worst[0], worst[1], worst[2]
        );
    }

    /// Beside libm over the whole range, where the two may each be off by a unit; and where it ends.
    #[test]
    fn beside_libm() {
        for k in -40_000..=40_000 {
            let x = f64::from(k) / 65_536.0;
            let (sin, cos) = sin_cos_turns(x);
            // libm's argument is rounded: 2πx is off by 4.4e-16 at most.
            let (s, c) = libm::sincos(std::f64::consts::TAU * x);
            assert!((sin - s).abs() < 8e-16 && (cos - c).abs() < 8e-16, "{x}");
            let fall = exp_falling(x.abs() * 1e3);
            let exact = libm::exp(-x.abs() * 1e3);
            assert!((fall - exact).abs() <= 4.5e-16 * exact.max(3.4e-308), "{x}");
        }
        assert_eq!(exp_falling(1e300), exp_falling(708.0));
        assert!(exp_falling(f64::NAN).is_nan() && sin_cos_turns(f64::NAN).0.is_nan());
    }

    #[test]
    fn phases_keep_what_is_left_of_them() {
        let third = Dd::ONE / Dd::new(3.0);
        // 3k + 1 times a third and offsets, near and far: the third is kept, and which number of turns
        // was taken off, even or odd.
        for k in [0.0, 1.0, 2.0, -7.0, 1e9, 1e15, 3e15, 7e15 + 1.0] {
            let t = 3.0 * k + 1.0;
            for offset in [0.0, -1e-3, 0.1] {
                let phase = Phase::gone(t, third).from(Dd::new(offset));
                let exact = 1.0 / 3.0 + offset;
                // 1e-32 of the phase, from the rate.
                let bound = 1.2e-16 + 2e-32 * t.abs();
                let off = phase.reduced() - exact;
                assert!((off - off.round()).abs() < bound, "{k} {offset}: {off}");
                let (part, odd) = phase.parted();
                assert!((part - exact).abs() < bound, "{k} {offset}: {part}");
                assert_eq!(odd & 1, (k.rem_euclid(2.0)) as u64, "{k}");
            }
        }
        // Near a whole number what is left is small, and kept to its own size.
        let phase = Phase::gone(3.0, third).from(Dd {
            hi: 1e-12,
            lo: 1e-29,
        });
        let (part, odd) = phase.parted();
        assert!((part - 1e-12).abs() < 1e-28 && odd & 1 == 1, "{part:e}");
    }
}
