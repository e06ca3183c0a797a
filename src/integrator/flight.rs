//! The reference point under a constant acceleration, with linear drag or without, at any time.
//!
//! ```text
//! r = (1 - e^{-kt})/k   v = v0 e^{-kt} + a r   x = x0 + v0 r + a (t - r)/k;   k = 0: r = t, (t - r)/k = t²/2
//! ```

use crate::body::State;
use crate::effect::Elapsed;
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
    pub fn at(&self, over: &Elapsed) -> (Vector3<f64>, Vector3<f64>) {
        let x_w = self.x_w + self.v_w * over.time + self.a_w * over.fall();
        (x_w, self.v_w * over.factor + self.a_w * over.time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrator::tests::damped;

    #[test]
    fn a_body_thrown_through_a_linear_drag() {
        // mpmath, 40 digits: k = 0.7, t = 2.5, and v' = a - k v.
        let flight = Flight {
            x_w: Vector3::new(1.0, -2.0, 0.5),
            v_w: Vector3::new(3.0, 0.25, -1.0),
            a_w: Vector3::new(0.0, -9.8125, 0.125),
        };
        let load = damped(0.7);
        let (x_w, v_w) = flight.at(&load.decay().unwrap().linear(2.5));
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
