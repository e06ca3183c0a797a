//! Damping: the velocities decay, `dω/dt = -c ω`, `dv/dt = -k v`, exactly in time.
//!
//! Over a step h the factor is `e^{-c h}`: from 0 to 1 whatever c h is, so it never turns a
//! velocity round. The tutorial's form, a factor per frame, is the rate `c = -ln(factor)/h` at
//! the scene's step h; a method that damps once a step applies its factor as it was written.

use super::{Argument, Called, EffectKind, Value};

pub const KIND: EffectKind = EffectKind {
    name: "damping",
    argument: Argument::Table(&[
        ("linear", "1/s"),
        ("angular", "1/s"),
        ("linear_factor", "per step"),
        ("angular_factor", "per step"),
    ]),
    equation: "dω/dt = -c ω, dv/dt = -k v",
    about: "a rate (linear, angular) or, as the tutorial does it, a factor per step (linear_factor, angular_factor); exact in time",
    make: |value, step| {
        let Value::Table(values) = value else {
            return Ok(Called::Off);
        };
        let &[linear, angular, linear_factor, angular_factor] = values.as_slice() else {
            return Ok(Called::Off);
        };
        let linear = Rate::new("linear", linear, linear_factor, step)?;
        let angular = Rate::new("angular", angular, angular_factor, step)?;
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

    /// `T = (1 - e^{-k h}) / k`, s: the undamped time in which a body alone goes as far as damped
    /// in `h` seconds.
    pub fn linear_time(&self, h: f64) -> f64 {
        self.linear.time(h)
    }

    /// `(h - T) / k`, s²: how far a constant acceleration of 1 moves a body from rest in `h` seconds.
    pub fn linear_fall(&self, h: f64) -> f64 {
        self.linear.fall(h)
    }

    /// `(1 - e^{-c h}) / c`, s: the undamped time in which a body that no torque turns, turns as far
    /// as damped in `h` seconds (`L = L0 e^{-ct}` slows the same motion down).
    pub fn angular_time(&self, h: f64) -> f64 {
        self.angular.time(h)
    }

    /// `(h - T) / c`, s², of that time: how far a constant angular acceleration of 1 turns a body
    /// from rest in `h` seconds.
    pub fn angular_fall(&self, h: f64) -> f64 {
        self.angular.fall(h)
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

    fn factor(&self, h: f64) -> f64 {
        match self.written {
            Some((step, factor)) if step == h => factor,
            _ => libm::exp(-self.rate * h),
        }
    }

    fn time(&self, h: f64) -> f64 {
        match self.rate {
            0.0 => h,
            rate => -libm::expm1(-rate * h) / rate,
        }
    }

    fn fall(&self, h: f64) -> f64 {
        let z = self.rate * h;
        if z.abs() > 0.5 {
            return (h - self.time(h)) / self.rate;
        }
        // h² Σ (-z)^j / (j + 2)!, where the difference would cancel: the 15th term is 0.5¹⁵/17! of h².
        let sum = (0..15_u32)
            .rev()
            .fold(0.0, |sum, j| (1.0 - z * sum) / f64::from(j + 2));
        h * h * sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_falls_are_those_of_the_closed_form_at_any_rate() {
        // T and (h - T)/k in 40 digits (mpmath), h = 0.75; z = k h on both sides of the series' end.
        let cases = [
            (0.0, 0.75, 0.28125),
            (1e-9, 0.749_999_999_718_75, 0.281_249_999_929_687_5),
            (0.6, 0.603_953_080_630_377_9, 0.243_411_532_282_703_6),
            (0.7, 0.583_492_336_618_835_6, 0.237_868_090_544_520_58),
            (40.0, 0.024_999_999_999_997_66, 0.018_125_000_000_000_058),
        ];
        for (k, time, fall) in cases {
            let rate = Rate::new("linear", Some(k), None, 1.0).unwrap();
            let decay = Decay {
                linear: rate,
                angular: rate,
            };
            // A few roundings.
            assert!((decay.linear_time(0.75) / time - 1.0).abs() < 1e-15, "{k}");
            assert!((decay.angular_time(0.75) / time - 1.0).abs() < 1e-15, "{k}");
            assert!((decay.linear_fall(0.75) / fall - 1.0).abs() < 1e-15, "{k}");
            assert!((decay.angular_fall(0.75) / fall - 1.0).abs() < 1e-15, "{k}");
        }
    }
}
