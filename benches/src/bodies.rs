//! Bodies to step: ten thousand, all different, the same ones in every run.

use nalgebra::{Quaternion, Vector3};
use std::sync::Arc;
use torquescope::body::{Inertial, InertialBlock, LANES, State, StateBlock};
use torquescope::effect::{Couple, Frame, Load};
use torquescope::integrator::{Interval, Step};

pub const BLOCKS: usize = 1_250;
/// Steps that a block takes before the next block has its turn.
pub const STEPS: usize = 64;
/// s.
pub const H: f64 = 1e-3;

#[derive(Clone, Copy)]
pub struct Body {
    pub inertial: Inertial,
    pub state: State,
    /// World, N·m.
    pub tau_w: Vector3<f64>,
}

/// `n` bodies by chance, from a fixed seed.
pub fn bodies(n: usize) -> Vec<Body> {
    let mut seed = 1_u64;
    let mut uniform = move |low: f64, high: f64| {
        // Knuth's generator; its upper bits are the random ones.
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut body = || {
        let mut vector = |low, high| Vector3::from_fn(|_, _| uniform(low, high));
        // Moments as masses on the axes have them, so that each is at most the sum of the others.
        let masses = vector(0.2, 1.0);
        let moments = Vector3::repeat(masses.sum()) - masses;
        let (u, v) = (vector(-1.0, 1.0), vector(-1.0, 1.0));
        Body {
            inertial: Inertial {
                mass: masses.sum(),
                inv_mass: 1.0 / masses.sum(),
                moments,
                inv_moments: moments.map(|i| 1.0 / i),
                centre_p: Vector3::zeros(),
            },
            state: State {
                x_w: vector(-10.0, 10.0),
                v_w: vector(-1.0, 1.0),
                q_wp: Quaternion::from_parts(1.0 + v.x, u).normalize(),
                omega_w: vector(-3.0, 3.0),
            },
            tau_w: vector(-0.5, 0.5),
        }
    };
    (0..n).map(|_| body()).collect()
}

/// What a method sets out with: a block of eight and what acts on it.
#[derive(Clone)]
pub struct Block {
    pub interval: Interval,
    pub state: StateBlock,
}

/// What acts on the bodies.
#[derive(Clone, Copy, PartialEq)]
pub enum Acting {
    /// Nothing, by Euler's equations.
    Gyroscopic,
    /// Nothing, in the tutorial's model.
    Nothing,
    /// A constant torque on each, in the tutorial's model.
    Torques,
}

pub fn blocks(bodies: &[Body], acting: Acting) -> Vec<Block> {
    let block = |bodies: &[Body]| {
        let mut load = Load::default();
        let (mut inertial, mut state) = (InertialBlock::default(), StateBlock::default());
        if acting == Acting::Gyroscopic {
            load.set_gyroscopic();
        }
        for (lane, body) in bodies.iter().enumerate() {
            inertial.set(lane, body.inertial);
            state.set(lane, body.state);
            if acting == Acting::Torques {
                let torque = Frame::World(body.tau_w);
                load.push(Arc::new(Couple { lane, torque }));
            }
        }
        let interval = Interval {
            load,
            inertial,
            bodies: bodies.len(),
            until: 1e9,
            tolerance: 1e-12,
        };
        Block { interval, state }
    };
    bodies.chunks(LANES).map(block).collect()
}

/// `n` steps of h seconds from 0 on.
pub fn steps(n: usize, h: f64, keep: bool) -> Vec<Step> {
    let step = |k: usize| Step {
        from: k as f64 * h,
        h,
        to: (k + 1) as f64 * h,
        keep,
    };
    (0..n).map(step).collect()
}
