//! Two motions with known ends, for work against precision; the peers run the same ones.

#![expect(clippy::excessive_precision, reason = "digits as they were found")]

use nalgebra::{Quaternion, Vector3};
use torquescope::body::{Inertial, InertialBlock, LANES, State, StateBlock};
use torquescope::effect::{EFFECTS, Load, Member, Value};
use torquescope::integrator::{Interval, Method, Step, Stepper};

/// How long both take, s.
pub const T: f64 = 100.0;

/// A body, what acts on it, and where it is after [`T`].
pub struct Problem {
    pub interval: Interval,
    pub state: StateBlock,
    pub end: Quaternion<f64>,
}

/// A free body with three moments that starts beside its middle axis and flips.
pub fn free() -> Problem {
    let mut load = Load::default();
    load.set_gyroscopic();
    problem(
        load,
        Vector3::new(1.0, 2.0, 3.0),
        Vector3::zeros(),
        Quaternion::identity(),
        Vector3::new(0.1, 2.0, 0.1),
        // 60 digits, Legendre's form (tests/oracles/free_body.py).
        Quaternion::new(
            0.241_887_724_312_378_339,
            0.031_691_645_443_719_078,
            -0.954_876_513_149_810_834,
            -0.169_401_337_276_030_943,
        ),
    )
}

/// A heavy top with three moments, held at a pivot; gravity along -z, m g c = (0.3, 0.2, 1) N·m.
pub fn top() -> Problem {
    let mut load = Load::default();
    load.set_gyroscopic();
    let gravity = EFFECTS.iter().find(|effect| effect.name == "gravity");
    let down = Value::Vector(Vector3::new(0.0, 0.0, -1.0));
    if let Some(Ok(gravity)) = gravity.map(|gravity| (gravity.make)(&down, 1.0)) {
        let inertial = InertialBlock::default();
        let members = (0..LANES).map(|lane| Member::plain(lane, inertial.get(lane)));
        load.call(&"gravity".into(), &gravity, &members.collect::<Vec<_>>());
    }
    let moments = Vector3::new(1.0, 1.6, 2.1);
    let q0 = Quaternion::new(0.86_f64.sqrt(), 0.1, 0.3, -0.2);
    problem(
        load,
        moments,
        Vector3::new(0.3, 0.2, 1.0),
        q0,
        Vector3::new(0.5, -0.8, 2.0),
        // Two integrations in 40 digits and more.
        Quaternion::new(
            -0.071_524_906_424_772_612,
            -0.051_812_189_728_397_31,
            -0.229_010_135_522_556_628,
            -0.969_409_120_332_801_635,
        ),
    )
}

fn problem(
    load: Load,
    moments: Vector3<f64>,
    centre_p: Vector3<f64>,
    q0: Quaternion<f64>,
    omega_p: Vector3<f64>,
    end: Quaternion<f64>,
) -> Problem {
    let (mut inertial, mut state) = (InertialBlock::default(), StateBlock::default());
    inertial.set(
        0,
        Inertial {
            mass: 1.0,
            // What is not held at its centre is held at a pivot.
            inv_mass: if centre_p == Vector3::zeros() {
                1.0
            } else {
                0.0
            },
            moments,
            inv_moments: moments.map(|i| 1.0 / i),
            centre_p,
        },
    );
    let upright = State {
        x_w: Vector3::zeros(),
        v_w: Vector3::zeros(),
        q_wp: q0,
        omega_w: Vector3::zeros(),
    };
    let omega_w = upright.to_world(omega_p);
    state.set(0, State { omega_w, ..upright });
    let interval = Interval {
        load,
        inertial,
        bodies: 1,
        until: T,
        tolerance: 0.0,
    };
    Problem {
        interval,
        state,
        end,
    }
}

impl Problem {
    /// Sets out and goes to the end, keeping `instants` states on the way.
    pub fn solve(
        &self,
        method: &dyn Method,
        tolerance: f64,
        instants: usize,
    ) -> (Box<dyn Stepper>, Vec<StateBlock>) {
        let mut interval = self.interval.clone();
        interval.tolerance = tolerance;
        let mut kept = Vec::with_capacity(instants);
        let mut stepper = method.start(interval, 0.0, &self.state);
        stepper.advance(&self.clock(instants), &mut kept);
        (stepper, kept)
    }

    fn clock(&self, instants: usize) -> Vec<Step> {
        let n = instants.max(1);
        let at = |k: usize| T * k as f64 / n as f64;
        let step = |k: usize| Step {
            from: at(k),
            h: T / n as f64,
            to: at(k + 1),
            keep: instants > 0,
        };
        (0..n).map(step).collect()
    }

    /// How far an attitude is from the end, rad.
    pub fn error(&self, q: Quaternion<f64>) -> f64 {
        let d = q.conjugate() * self.end;
        2.0 * d.imag().norm().atan2(d.w.abs())
    }
}
