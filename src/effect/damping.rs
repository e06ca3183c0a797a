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
}
