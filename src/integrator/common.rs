//! What several kernels share: states as vectors, accelerations, damping.

use super::{Interval, Step};
use crate::body::{Inertial, LANES, State, StateBlock};
use crate::effect::{Decay, Load, WrenchBlock};
use multiversion::multiversion;
use nalgebra::Vector3;

/// Calls a kernel with the [`Forces`] that a load has at one time and state: `wrench` is an
/// `Option<&WrenchBlock>`.
macro_rules! with_forces {
    ($load:expr, $wrench:expr, |$forces:ident| $work:expr) => {
        match ($wrench, $load.gyroscopic()) {
            (None, false) => {
                let $forces = $crate::integrator::common::Coasting::<false>;
                $work
            }
            (None, true) => {
                let $forces = $crate::integrator::common::Coasting::<true>;
                $work
            }
            (Some(wrench), false) => {
                let $forces = $crate::integrator::common::Applied::<false>(wrench);
                $work
            }
            (Some(wrench), true) => {
                let $forces = $crate::integrator::common::Applied::<true>(wrench);
                $work
            }
        }
    };
}
pub(super) use with_forces;

/// Does the same for every lane that holds a body: for one body alone, else for all eight, which is as
/// many rounds as the compiler knows beforehand, so that it makes vector code of them.
macro_rules! each_lane {
    ($bodies:expr, |$lane:ident| $work:block) => {
        if $bodies == 1 {
            let $lane = 0;
            $work
        } else {
            for $lane in 0..$crate::body::LANES $work
        }
    };
}
pub(super) use each_lane;

/// A rate of change has the components of a state: x', v', q', ω'.
pub type Rate = State;
pub type RateBlock = StateBlock;

/// What a body's velocities change by, world, m/s² and rad/s².
#[derive(Clone, Copy, Debug)]
pub struct Acceleration {
    pub a_w: Vector3<f64>,
    pub alpha_w: Vector3<f64>,
}

/// Where a kernel takes accelerations from. A type, so that a block on which nothing acts runs a
/// loop that has never heard of forces.
pub trait Forces: Copy {
    fn acceleration(self, lane: usize, body: &Inertial, s: &State) -> Acceleration;

    /// What is applied alone: `m⁻¹ F`, world, m/s², and `I⁻¹ τ`, principal axes, rad/s², where `to_principal`
    /// takes a vector there from the world. Both are +0 on a lane on which nothing acts, whatever else does.
    fn applied(
        self,
        lane: usize,
        body: &Inertial,
        to_principal: impl Fn(Vector3<f64>) -> Vector3<f64>,
    ) -> (Vector3<f64>, Vector3<f64>);

    /// Whether the gyroscopic term is in the model.
    const GYROSCOPIC: bool;
}

/// Nothing is applied. `GYROSCOPIC`: angular momentum stays, else angular velocity.
#[derive(Clone, Copy)]
pub struct Coasting<const GYROSCOPIC: bool>;

/// These forces and torques are applied.
#[derive(Clone, Copy)]
pub struct Applied<'w, const GYROSCOPIC: bool>(pub &'w WrenchBlock);

impl<const GYROSCOPIC: bool> Forces for Coasting<GYROSCOPIC> {
    const GYROSCOPIC: bool = GYROSCOPIC;

    #[inline(always)]
    fn applied(
        self,
        _: usize,
        _: &Inertial,
        _: impl Fn(Vector3<f64>) -> Vector3<f64>,
    ) -> (Vector3<f64>, Vector3<f64>) {
        (Vector3::zeros(), Vector3::zeros())
    }

    #[inline(always)]
    fn acceleration(self, _: usize, body: &Inertial, s: &State) -> Acceleration {
        Acceleration {
            a_w: Vector3::zeros(),
            alpha_w: match GYROSCOPIC {
                true => body.gyroscopic_acceleration(s),
                false => Vector3::zeros(),
            },
        }
    }
}

impl<const GYROSCOPIC: bool> Forces for Applied<'_, GYROSCOPIC> {
    const GYROSCOPIC: bool = GYROSCOPIC;

    #[inline(always)]
    fn applied(
        self,
        lane: usize,
        body: &Inertial,
        to_principal: impl Fn(Vector3<f64>) -> Vector3<f64>,
    ) -> (Vector3<f64>, Vector3<f64>) {
        let wrench = self.0.get(lane);
        let tau_p = to_principal(wrench.tau_w);
        // + 0 makes +0 of -0, as which a rotated 0 may come.
        (
            wrench.force_w * body.inv_mass,
            body.inv_moments.component_mul(&tau_p).add_scalar(0.0),
        )
    }

    #[inline(always)]
    fn acceleration(self, lane: usize, body: &Inertial, s: &State) -> Acceleration {
        let wrench = self.0.get(lane);
        Acceleration {
            a_w: wrench.force_w * body.inv_mass,
            alpha_w: match GYROSCOPIC {
                true => body.gyroscopic_response(s, wrench.tau_w),
                false => body.angular_response(s, wrench.tau_w),
            },
        }
    }
}

/// `y' = f(t, y)` of a body under these forces.
#[inline(always)]
pub fn rate(lane: usize, forces: impl Forces, body: &Inertial, s: State) -> Rate {
    let Acceleration { a_w, alpha_w } = forces.acceleration(lane, body, &s);
    Rate {
        x_w: s.v_w,
        v_w: a_w,
        q_wp: crate::math::spin_rate(s.omega_w, s.q_wp),
        omega_w: alpha_w,
    }
}

/// `y + h k`.
#[inline(always)]
pub fn along(y: State, h: f64, k: Rate) -> State {
    State {
        x_w: y.x_w + k.x_w * h,
        v_w: y.v_w + k.v_w * h,
        q_wp: y.q_wp + k.q_wp * h,
        omega_w: y.omega_w + k.omega_w * h,
    }
}

/// The velocities times a factor each; position and attitude do not decay.
#[inline(always)]
pub fn decayed(y: State, linear: f64, angular: f64) -> State {
    State {
        v_w: y.v_w * linear,
        omega_w: y.omega_w * angular,
        ..y
    }
}

/// Factors on v and ω over some time, for methods with an integrating factor.
#[derive(Clone, Copy)]
pub struct DecayFactors {
    pub linear: f64,
    pub angular: f64,
}

impl DecayFactors {
    /// Over `h` seconds; `None` where nothing decays.
    pub fn of(load: &Load, h: f64) -> Option<Self> {
        load.decay().map(|decay| Self {
            linear: decay.linear_factor(h),
            angular: decay.angular_factor(h),
        })
    }

    /// Over that time so many times: none, one or two.
    pub fn times(self, times: u8) -> Self {
        let power = |factor: f64| match times {
            0 => 1.0,
            1 => factor,
            _ => factor * factor,
        };
        Self {
            linear: power(self.linear),
            angular: power(self.angular),
        }
    }

    #[inline(always)]
    pub fn on(self, y: State) -> State {
        decayed(y, self.linear, self.angular)
    }
}

/// The same state with an attitude of unit length.
#[inline(always)]
pub fn normalised(y: State) -> State {
    State {
        q_wp: y.q_wp * (1.0 / y.q_wp.norm()),
        ..y
    }
}

/// A step of one body under forces that are asked for once.
pub trait Kernel: Copy {
    fn stepped(self, h: f64, lane: usize, forces: impl Forces, body: &Inertial, s: State) -> State;
}

/// Takes steps by a kernel: forces as they are at the start of each, decay after it.
pub fn march<K: Kernel>(
    kernel: K,
    steps: &[Step],
    interval: &Interval,
    state: &mut StateBlock,
    kept: &mut Vec<StateBlock>,
) {
    let load = &interval.load;
    if !load.varies() {
        with_forces!(load, load.constant(), |forces| stretch(
            kernel, steps, forces, interval, state, kept
        ));
        return;
    }
    let mut room = None;
    for step in steps.chunks(1) {
        let wrench = load.wrench_in(&mut room, step[0].from, &interval.inertial, state);
        with_forces!(load, wrench, |forces| stretch(
            kernel, step, forces, interval, state, kept
        ));
    }
}

/// Takes steps under forces that stay: all of them in code that was chosen once for the processor.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn stretch<K: Kernel, F: Forces>(
    kernel: K,
    steps: &[Step],
    forces: F,
    interval: &Interval,
    state: &mut StateBlock,
    kept: &mut Vec<StateBlock>,
) {
    let inertial = &interval.inertial;
    let mut decay = Decaying::new(interval.load.decay());
    for step in steps {
        each_lane!(interval.bodies, |lane| {
            let (body, s) = (inertial.get(lane), state.get(lane));
            state.set(lane, kernel.stepped(step.h, lane, forces, &body, s));
        });
        if let Some((linear, angular)) = decay.factors(step.h) {
            for lane in 0..LANES {
                state.set(lane, decayed(state.get(lane), linear, angular));
            }
        }
        if step.keep {
            kept.push(*state);
        }
    }
}

/// The factors of a decay over a step, which are those of the step before where it is as long.
struct Decaying<'d> {
    decay: Option<&'d Decay>,
    h: f64,
    factors: (f64, f64),
}

impl<'d> Decaying<'d> {
    fn new(decay: Option<&'d Decay>) -> Self {
        Self {
            decay,
            h: 0.0,
            factors: (1.0, 1.0),
        }
    }

    fn factors(&mut self, h: f64) -> Option<(f64, f64)> {
        let decay = self.decay?;
        if h != self.h {
            self.h = h;
            self.factors = (decay.linear_factor(h), decay.angular_factor(h));
        }
        Some(self.factors)
    }
}

/// Damps the velocities for `h` seconds.
pub fn damp(decay: &Decay, h: f64, state: &mut StateBlock) {
    let (linear, angular) = (decay.linear_factor(h), decay.angular_factor(h));
    for lane in 0..LANES {
        state.set(lane, decayed(state.get(lane), linear, angular));
    }
}
