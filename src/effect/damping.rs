//! Damping: the velocities decay, `dω/dt = -c ω`, `dv/dt = -k v`, exactly in time.
//!
//! Over a step h the factor is `e^{-c h}`: from 0 to 1 whatever c h is, so it never turns a
//! velocity round. The tutorial's form, a factor per frame, is the rate `c = -ln(factor)/h` at
//! the scene's step h; a method that damps once a step applies its factor as it was written.

use super::{Argument, Called, EffectKind};

pub const KIND: EffectKind = EffectKind {
    name: "damping",
    argument: Argument::Table(&[
        ("linear", Argument::Number("1/s")),
        ("angular", Argument::Number("1/s")),
        ("linear_factor", Argument::Number("per step")),
        ("angular_factor", Argument::Number("per step")),
    ]),
    equation: "dω/dt = -c ω, dv/dt = -k v",
    about: "a rate (linear, angular) or, as the tutorial does it, a factor per step (linear_factor, angular_factor); exact in time",
    make: |value, step| {
        let get = |key: &str| value.number(key);
        let linear = Rate::new("linear", get("linear"), get("linear_factor"), step)?;
        let angular = Rate::new("angular", get("angular"), get("angular_factor"), step)?;
        Ok(match (linear, angular) {
            (Rate::NONE, Rate::NONE) => Called::Off,
            (linear, angular) => Called::Decay(Decay { linear, angular }),
        })
    },
};

/// Decay of the linear and the angular velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decay {
    linear: Rate,
    angular: Rate,
}

impl Decay {
    /// Whether it was written as a factor per step.
    pub fn is_per_step(&self) -> bool {
        self.linear.written.is_some() || self.angular.written.is_some()
    }

    /// Both at once: rates add, factors multiply.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            linear: self.linear.and(other.linear),
            angular: self.angular.and(other.angular),
        }
    }

    /// 1/s.
    pub fn linear_rate(&self) -> f64 {
        self.linear.rate
    }

    /// 1/s.
    pub fn angular_rate(&self) -> f64 {
        self.angular.rate
    }

    /// By what the linear velocity shrinks over `h` seconds.
    pub fn linear_factor(&self, h: f64) -> f64 {
        self.linear.factor(h)
    }

    /// By what the angular velocity shrinks over `h` seconds.
    pub fn angular_factor(&self, h: f64) -> f64 {
        self.angular.factor(h)
    }

    /// `h` seconds, as the linear velocity counts them.
    #[inline]
    pub fn linear(&self, h: f64) -> Elapsed {
        self.linear.over(h)
    }

    /// `h` seconds, as the angular velocity counts them.
    #[inline]
    pub fn angular(&self, h: f64) -> Elapsed {
        self.angular.over(h)
    }
}

/// A stretch of time, of either sign, as a velocity that decays at the rate k counts it. (Of a free body
/// `L = e^{-ct} L0` slows the same motion down: it turns in h seconds as far as undamped in [`Elapsed::time`].)
#[derive(Clone, Copy, Debug)]
pub struct Elapsed {
    /// 1/s.
    rate: f64,
    /// s.
    h: f64,
    /// `e^{-k h}`: what is left of the velocity.
    pub factor: f64,
    /// `T = (1 - e^{-k h})/k`, s: how far a velocity that was 1 gets.
    pub time: f64,
}

impl Elapsed {
    /// Where nothing decays.
    #[inline]
    pub fn undamped(h: f64) -> Self {
        Self {
            rate: 0.0,
            h,
            factor: 1.0,
            time: h,
        }
    }

    /// `(h - T)/k`, s²: how far a constant acceleration of 1 gets from rest.
    #[inline]
    pub fn fall(&self) -> f64 {
        let (k, h) = (self.rate, self.h);
        if k == 0.0 {
            return 0.5 * h * h;
        }
        let z = k * h;
        if z.abs() > 1.0 {
            // A difference that loses a bit and a half at most.
            return (h - self.time) / k;
        }
        // h² (1/2! - z/3! + z²/4! - ...), where it would lose more; the last term is below 1/20!.
        let sum = (3..=20_u32)
            .rev()
            .fold(1.0, |sum, n| 1.0 - sum * z / f64::from(n));
        0.5 * h * h * sum
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Rate {
    /// 1/s.
    rate: f64,
    /// A step (s) and the factor written for it.
    written: Option<(f64, f64)>,
}

impl Rate {
    const NONE: Self = Self {
        rate: 0.0,
        written: None,
    };

    fn new(name: &str, rate: Option<f64>, factor: Option<f64>, step: f64) -> Result<Self, String> {
        match (rate, factor) {
            (None, None) => Ok(Self::NONE),
            (Some(_), Some(_)) => Err(format!(
                "{name} and {name}_factor say the same thing twice; keep one"
            )),
            (Some(rate), None) if rate >= 0.0 => Ok(Self {
                rate,
                written: None,
            }),
            (Some(rate), None) => Err(format!(
                "{name} = {rate} 1/s would make velocities grow; a damping rate is 0 or more"
            )),
            (None, Some(factor)) if factor > 0.0 && factor <= 1.0 => Ok(Self {
                rate: -libm::log(factor) / step,
                written: Some((step, factor)),
            }),
            (None, Some(factor)) => Err(format!(
                "{name}_factor = {factor} is not above 0 and at most 1; it multiplies the velocity \
                 at every step, 1 being no damping"
            )),
        }
    }

    fn and(self, other: Self) -> Self {
        let written = match (self.written, other.written) {
            (Some((step, a)), Some((same, b))) if step == same => Some((step, a * b)),
            (written, None) if other.rate == 0.0 => written,
            (None, written) if self.rate == 0.0 => written,
            _ => None,
        };
        Self {
            rate: self.rate + other.rate,
            written,
        }
    }

    fn factor(&self, h: f64) -> f64 {
        match self.written {
            Some((step, factor)) if step == h => factor,
            _ => libm::exp(-self.rate * h),
        }
    }

    fn over(&self, h: f64) -> Elapsed {
        if self.rate == 0.0 {
            return Elapsed::undamped(h);
        }
        Elapsed {
            rate: self.rate,
            h,
            factor: self.factor(h),
            time: -libm::expm1(-self.rate * h) / self.rate,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_falls_are_those_of_the_closed_form_at_any_rate_forth_and_back() {
        // T and (h - T)/k in 40 digits (mpmath); z = k h on both sides of the series' ends.
        let cases = [
            (0.0, 0.75, 0.75, 0.28125),
            (1e-9, 0.75, 0.749_999_999_718_75, 0.281_249_999_929_687_5),
            (0.6, 0.75, 0.603_953_080_630_377_8, 0.243_411_532_282_703_6),
            (1.3, 0.75, 0.479_082_804_951_417_8, 0.208_397_842_345_063_3),
            (1.35, 0.75, 0.471_622_541_215_547_2, 0.206_205_525_025_520_6),
            (
                40.0,
                0.75,
                0.024_999_999_999_997_66,
                0.018_125_000_000_000_058,
            ),
            (0.6, -0.75, -0.947_186_975_816_948, 0.328_644_959_694_913_37),
            (
                1.3,
                -0.75,
                -1.270_128_623_832_774_4,
                0.400_098_941_409_826_44,
            ),
            (
                1.35,
                -0.75,
                -1.298_128_596_083_040_3,
                0.406_021_182_283_733_5,
            ),
            (9.0, -0.75, -94.784_306_947_350_17, 10.448_256_327_483_353),
        ];
        for (k, h, time, fall) in cases {
            let rate = Rate::new("linear", Some(k), None, 1.0).unwrap();
            let decay = Decay {
                linear: rate,
                angular: rate,
            };
            // k h, an exponential, a quotient; and where the difference is taken, its bit and a half.
            for over in [decay.linear(h), decay.angular(h)] {
                assert!((over.time / time - 1.0).abs() < 6e-16, "{k} {h}");
                assert!((over.fall() / fall - 1.0).abs() < 1e-15, "{k} {h}");
            }
        }
    }
}
