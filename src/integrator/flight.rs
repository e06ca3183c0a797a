//! The reference point under a constant acceleration, with linear drag or without, at any time.
//!
//! ```text
//! r = (1 - e^{-kt})/k   v = v0 e^{-kt} + a r   x = x0 + v0 r + a (t - r)/k;   k = 0: r = t, (t - r)/k = t²/2
//! ```

use crate::body::State;
use crate::effect::Decay;
use nalgebra::Vector3;

/// A point on its way.
#[derive(Clone, Copy, Debug)]
pub struct Flight {
    pub x_w: Vector3<f64>,
    pub v_w: Vector3<f64>,
    /// m/s².
    pub a_w: Vector3<f64>,
}

impl Flight {
    pub fn new(start: &State, a_w: Vector3<f64>) -> Self {
        Self {
            x_w: start.x_w,
            v_w: start.v_w,
            a_w,
        }
    }

    /// x and v.
    pub fn at(&self, elapsed: Elapsed) -> (Vector3<f64>, Vector3<f64>) {
        let x_w = self.x_w + self.v_w * elapsed.first + self.a_w * elapsed.second;
        (x_w, self.v_w * elapsed.factor + self.a_w * elapsed.first)
    }
}

/// Elapsed time as a motion damped at the rate k counts it.
#[derive(Clone, Copy, Debug)]
pub struct Elapsed {
    /// `e^{-kt}`.
    pub factor: f64,
    /// `(1 - e^{-kt})/k`, s: what a velocity that decays counts.
    pub first: f64,
    /// `(t - (1 - e^{-kt})/k)/k`, s²: what a constant acceleration counts.
    pub second: f64,
}

impl Elapsed {
    /// For the linear velocity.
    pub fn linear(decay: Option<&Decay>, t: f64) -> Self {
        decay.map_or(Self::undamped(t), |decay| {
            Self::damped(t, decay.linear_rate(), decay.linear_factor(t))
        })
    }

    /// For the angular velocity.
    pub fn angular(decay: Option<&Decay>, t: f64) -> Self {
        decay.map_or(Self::undamped(t), |decay| {
            Self::damped(t, decay.angular_rate(), decay.angular_factor(t))
        })
    }

    fn undamped(t: f64) -> Self {
        Self {
            factor: 1.0,
            first: t,
            second: 0.5 * t * t,
        }
    }

    fn damped(t: f64, rate: f64, factor: f64) -> Self {
        if rate == 0.0 {
            return Self::undamped(t);
        }
        let z = -rate * t;
        Self {
            factor,
            first: -libm::expm1(z) / rate,
            second: t * t * phi_2(z),
        }
    }
}

/// `(e^z - 1 - z)/z²` for z ≤ 0, without the cancellation near 0.
fn phi_2(z: f64) -> f64 {
    if z < -1.0 {
        return (libm::expm1(z) - z) / (z * z);
    }
    // 1/2 + z/3! + z²/4! + ..., the last term 1/20!.
    let nested = |sum: f64, n: i32| 1.0 + sum * z / f64::from(n);
    (3..=20).rev().fold(1.0, nested) / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phi_2_has_all_its_digits() {
        // mpmath, 40 digits, at the f64 nearest to each z.
        for (z, exact) in [
            (0.0, 0.5),
            (-1e-9, 0.499_999_999_833_333_3),
            (-0.3, 0.453_535_785_352_420_74),
            (-1.0, 0.367_879_441_171_442_32),
            (-1.000_000_1, 0.367_879_430_807_610_2),
            (-3.7, 0.199_030_206_462_406_08),
            (-40.0, 0.024_375),
            (-1e5, 9.999_9e-6),
        ] {
            // A division and a dozen roundings that each count less than the one before; below -1 a
            // difference that loses less than a bit.
            assert!((phi_2(z) / exact - 1.0).abs() < 4e-16, "{z}");
        }
    }

    #[test]
    fn a_body_thrown_through_a_linear_drag() {
        // mpmath, 40 digits: k = 0.7, t = 2.5, and v' = a - k v.
        let flight = Flight {
            x_w: Vector3::new(1.0, -2.0, 0.5),
            v_w: Vector3::new(3.0, 0.25, -1.0),
            a_w: Vector3::new(0.0, -9.8125, 0.125),
        };
        let (k, t) = (0.7_f64, 2.5_f64);
        let (x_w, v_w) = flight.at(Elapsed::damped(t, k, libm::exp(-k * t)));
        let x = Vector3::new(
            4.540_968_813_783_807,
            -20.203_963_796_349_634,
            -0.444_666_319_700_781_2,
        );
        let v = Vector3::new(
            0.521_321_830_351_335_4,
            -11.538_475_342_555_257,
            -0.026_233_576_209_453_2,
        );
        // Three roundings of numbers up to 20, and k t's.
        assert!((x_w - x).amax() < 1e-14, "{}", x_w);
        assert!((v_w - v).amax() < 1e-14, "{}", v_w);
    }
}
