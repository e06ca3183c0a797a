//! The motion in closed form, at any time at once, of a body that no torque turns.
//!
//! ```text
//! s = (1 - e^{-ct})/c   attitude: the free body's at time s    ω = e^{-ct} ω_free(s)
//! r = (1 - e^{-kt})/k   v = v0 e^{-kt} + a r                   x = x0 + v0 r + a (t - r)/k
//! ```
//!
//! c and k damp the angular and the linear velocity; without them s = r = t and (t - r)/k = t²/2. The free
//! body is [`FreeMotion`], in Euler's equations the elliptic one; in the tutorial's model, where ω stays,
//! the rotation `exp(ω s/2) q0`, whose angle is reduced in double-double.
//!
//! Nothing is stepped: errors do not grow with the number of steps, and only instants that are asked for
//! cost anything.
//!
//! Damping: τ = -c I ω makes dL/dt = -c L; with L = e^{-ct} M and ds = e^{-ct} dt, M and q obey the undamped
//! equations in s.

use super::{Accepts, Cost, Damping, Interval, Kind, Method, MethodInfo, Step, Stepper, Work};
use crate::body::{Inertial, State, StateBlock};
use crate::effect::Decay;
use crate::exact::FreeMotion;
use nalgebra::{Quaternion, Vector3};

pub struct ClosedForm;

const INFO: MethodInfo = MethodInfo {
    name: "closed-form",
    engines: &[],
    kind: Kind::Closed,
    order: 0,
    accepts: Accepts::Free,
    damping: Damping::Exact("by the time change s = (1 - e^{-ct})/c: exact"),
    reversible: true,
    keeps_momentum: true,
    preserves: "everything a free body keeps, to rounding, at any time",
    cost: Cost {
        evaluations: 0,
        weight: 4.0,
    },
    citation: "van Zon & Schofield, J. Comput. Phys. 225 (2007); Celledoni, Fassò, Säfström & Zanna, SIAM J. Sci. Comput. 30 (2008)",
};

impl Method for ClosedForm {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn start(&self, interval: Interval, t: f64, state: &StateBlock) -> Box<dyn Stepper> {
        let wrench = interval.load.wrench(t, &interval.inertial, state);
        let path = |lane: usize| {
            let body = interval.inertial.get(lane);
            let force_w = wrench.as_ref().map(|w| w.get(lane).force_w);
            let a_w = force_w.unwrap_or_default() * body.inv_mass;
            let turning = Turning::new(interval.load.gyroscopic(), &body, &state.get(lane));
            Path {
                start: state.get(lane),
                a_w,
                turning,
            }
        };
        Box::new(Run {
            paths: (0..interval.bodies).map(path).collect(),
            decay: interval.load.decay().copied(),
            empty: *state,
            from: t,
            now: t,
            instants: 0,
        })
    }
}

#[derive(Clone)]
struct Run {
    paths: Vec<Path>,
    decay: Option<Decay>,
    /// What the lanes without a body hold.
    empty: StateBlock,
    /// s.
    from: f64,
    now: f64,
    instants: u64,
}

/// How one body moves.
#[derive(Clone)]
struct Path {
    start: State,
    /// Constant, m/s².
    a_w: Vector3<f64>,
    turning: Turning,
}

/// How it turns, undamped.
#[derive(Clone)]
enum Turning {
    /// L stays.
    Euler(FreeMotion),
    /// ω stays: what the world turns the starting attitude by.
    Steady(FreeMotion),
}

/// Elapsed time as the motion counts it, with damping at some rate.
#[derive(Clone, Copy)]
struct Elapsed {
    /// `e^{-kt}`.
    factor: f64,
    /// `(1 - e^{-kt})/k`, s: what a velocity that decays counts.
    first: f64,
    /// `(t - (1 - e^{-kt})/k)/k`, s²: what a constant acceleration counts.
    second: f64,
}

impl Stepper for Run {
    fn advance(&mut self, steps: &[Step], kept: &mut Vec<StateBlock>) {
        for step in steps {
            self.now = step.to;
            if step.keep {
                kept.push(self.state());
                self.instants += 1;
            }
        }
    }

    fn state(&self) -> StateBlock {
        let t = self.now - self.from;
        let (linear, angular) = match &self.decay {
            None => (Elapsed::undamped(t), Elapsed::undamped(t)),
            Some(decay) => (
                Elapsed::damped(t, decay.linear_rate(), decay.linear_factor(t)),
                Elapsed::damped(t, decay.angular_rate(), decay.angular_factor(t)),
            ),
        };
        let mut block = self.empty;
        for (lane, path) in self.paths.iter().enumerate() {
            block.set(lane, path.at(linear, angular));
        }
        block
    }

    fn work(&self) -> Work {
        Work {
            steps: self.instants,
            evaluations: 0,
        }
    }

    fn boxed_clone(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}

impl Path {
    fn at(&self, linear: Elapsed, angular: Elapsed) -> State {
        let Self { start, a_w, .. } = self;
        let (q_wp, omega_w) = self.turning.at(angular.first, start);
        State {
            x_w: start.x_w + start.v_w * linear.first + a_w * linear.second,
            v_w: start.v_w * linear.factor + a_w * linear.first,
            q_wp,
            omega_w: omega_w * angular.factor,
        }
    }
}

impl Turning {
    fn new(gyroscopic: bool, body: &Inertial, start: &State) -> Self {
        if gyroscopic {
            let omega_p = start.to_principal(start.omega_w);
            return Self::Euler(FreeMotion::new(body.moments, start.q_wp, omega_p));
        }
        // A body with equal moments turns steadily.
        let (sphere, upright) = (Vector3::repeat(1.0), Quaternion::identity());
        Self::Steady(FreeMotion::new(sphere, upright, start.omega_w))
    }

    /// Attitude and world angular velocity.
    fn at(&self, s: f64, start: &State) -> (Quaternion<f64>, Vector3<f64>) {
        match self {
            Self::Euler(motion) => {
                let (q_wp, omega_p) = motion.at(s);
                (q_wp, State { q_wp, ..*start }.to_world(omega_p))
            }
            Self::Steady(turn) => (turn.attitude(s) * start.q_wp, start.omega_w),
        }
    }
}

impl Elapsed {
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
    (3..=20)
        .rev()
        .fold(1.0, |sum, n| 1.0 + sum * z / f64::from(n))
        / 2.0
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
        let path = Path {
            start: State {
                x_w: Vector3::new(1.0, -2.0, 0.5),
                v_w: Vector3::new(3.0, 0.25, -1.0),
                q_wp: Quaternion::identity(),
                omega_w: Vector3::zeros(),
            },
            a_w: Vector3::new(0.0, -9.8125, 0.125),
            turning: Turning::Steady(FreeMotion::new(
                Vector3::repeat(1.0),
                Quaternion::identity(),
                Vector3::zeros(),
            )),
        };
        let (k, t) = (0.7_f64, 2.5_f64);
        let state = path.at(
            Elapsed::damped(t, k, libm::exp(-k * t)),
            Elapsed::undamped(t),
        );
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
        assert!((state.x_w - x).amax() < 1e-14, "{}", state.x_w);
        assert!((state.v_w - v).amax() < 1e-14, "{}", state.v_w);
    }

    #[test]
    fn in_the_tutorials_model_a_long_rotation_keeps_its_phase() {
        // 786,432 rad, exactly, of which libm takes off whole turns exactly.
        let (omega, t) = (0.75, 1_048_576.0);
        let q0 = Quaternion::new(0.5, -0.5, 0.5, 0.5);
        let start = State {
            x_w: Vector3::zeros(),
            v_w: Vector3::zeros(),
            q_wp: q0,
            omega_w: Vector3::new(0.0, omega, 0.0),
        };
        let body = crate::body::InertialBlock::default().get(0);
        let path = Path {
            start,
            a_w: Vector3::zeros(),
            turning: Turning::new(false, &body, &start),
        };
        let end = path.at(Elapsed::undamped(t), Elapsed::undamped(t));
        let (sin, cos) = libm::sincos(0.5 * omega * t);
        let exact = Quaternion::new(cos, 0.0, sin, 0.0) * q0;
        // Sine, cosine and a product, each rounded.
        assert!((end.q_wp - exact).norm() < 1e-15);
        assert_eq!(end.omega_w, start.omega_w);
    }
}
