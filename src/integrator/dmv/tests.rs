//! What the discrete body alone has: energy, refusals, and where its steps end.

use super::*;
use crate::body::State;
use crate::effect::{Couple, Frame, Load};
use crate::integrator::METHODS;
use crate::integrator::tests::{advance, angle, block, free_triaxial, gyroscopic, spinning};
use nalgebra::{UnitQuaternion, Vector3};
use std::sync::Arc;

const ALL: [Dmv; 5] = [DMV2, DMV4, DMV6, DMV8, DMV10];

#[test]
fn energy_is_kept_over_a_hundred_thousand_coarse_steps() {
    let (bodies, _) = free_triaxial();
    let energy = |s: State| {
        let body = bodies.0.get(0);
        0.5 * s.omega_w.dot(&body.momentum_w(&s))
    };
    let before = energy(bodies.1.get(0));
    for method in ALL {
        // h |ω| = 0.3: 1.6e-2 rad of error for order 2, and yet no energy is lost.
        let end = advance(&method, &gyroscopic(), &bodies, 1e4, 100_000);
        // Roundings of q in 100,000 steps, 1e-16 each, as a random walk: 3e-14.
        let gap = (energy(end) / before - 1.0).abs();
        assert!(gap < 3e-13, "{}: {gap}", method.info().name);
    }
}

#[test]
fn a_sphere_and_a_spin_about_an_axis_are_turned_too_far_by_the_declared_order_alone() {
    // Steady rotations: what is left of the error is of the phase.
    let omega = Vector3::new(0.4, -0.3, 1.2);
    let (t, n) = (10.0, 1_000);
    for (inertia, omega) in [
        (Vector3::repeat(0.7), omega),
        (Vector3::new(0.3, 0.5, 0.6), Vector3::y() * 1.3),
    ] {
        let bodies = block(inertia, spinning(UnitQuaternion::identity(), omega));
        let end = advance(&DMV10, &gyroscopic(), &bodies, t, n);
        // 1,000 roundings of 1e-16 in one direction at worst.
        let exact = crate::math::exponential(omega * t);
        assert!(angle(end.q_wp, exact) < 1e-13);
    }
}

#[test]
fn the_tutorials_model_and_any_torque_are_refused() {
    let (bodies, _) = free_triaxial();
    let mut turned = gyroscopic();
    turned.push(Arc::new(Couple {
        lane: 0,
        torque: Frame::World(Vector3::x()),
    }));
    for method in ALL {
        let why = |load: &Load| method.info().refuses(load, &bodies.0);
        assert!(why(&gyroscopic()).is_none());
        let model = why(&Load::default()).unwrap().0;
        assert!(model.contains("gyroscopic = true"), "{model}");
        let torque = why(&turned).unwrap().0;
        assert!(torque.contains("a torque acts"), "{torque}");
    }
    assert!(METHODS.iter().any(|method| method.info().name == "dmv10"));
}

#[test]
fn a_step_that_turns_too_far_has_no_next_attitude_and_says_so() {
    let (bodies, _) = free_triaxial();
    for method in ALL {
        let end = advance(&method, &gyroscopic(), &bodies, 1e9, 10);
        assert!(!end.is_finite(), "{}", method.info().name);
    }
}
