//! Conformance: what every method in [`METHODS`] must do, and the order each declares.

use super::*;
use crate::body::{Inertial, State};
use crate::effect::{Called, Couple, EFFECTS, Frame, Value};
use crate::mass::MassProperties;
use crate::math::axis_angle;
use nalgebra::{Matrix3, Quaternion, Unit, UnitQuaternion, Vector3};
use std::sync::Arc;

fn effect(name: &str, value: Value, load: &mut Load) {
    let kind = EFFECTS.iter().find(|kind| kind.name == name).unwrap();
    match (kind.make)(&value, 1.0).unwrap() {
        Called::Load(effect) => load.push(effect),
        Called::Decay(decay) => load.set_decay(decay),
        Called::Off => panic!("{name} is off"),
    }
}

fn gyroscopic() -> Load {
    let mut load = Load::default();
    effect("gyroscopic", Value::Switch(true), &mut load);
    load
}

fn damped(rate: f64) -> Load {
    let mut load = Load::default();
    let rates = vec![Some(rate), Some(rate), None, None];
    effect("damping", Value::Table(rates), &mut load);
    load
}

fn block(inertia: Vector3<f64>, state: State) -> (InertialBlock, StateBlock) {
    let properties =
        MassProperties::new(1.0, Matrix3::from_diagonal(&inertia), [false; 3]).unwrap();
    let (inertial, _) = Inertial::new(&properties, None);
    let mut inertials = InertialBlock::default();
    let mut states = StateBlock::default();
    inertials.set(0, inertial);
    states.set(0, state);
    (inertials, states)
}

fn spinning(q: UnitQuaternion<f64>, omega_w: Vector3<f64>) -> State {
    State {
        x_w: Vector3::zeros(),
        v_w: Vector3::zeros(),
        q_wp: q.into_inner(),
        omega_w,
    }
}

fn advance(
    method: &dyn Method,
    load: &Load,
    bodies: &(InertialBlock, StateBlock),
    t: f64,
    n: u32,
) -> State {
    let h = t / f64::from(n);
    let mut state = bodies.1;
    for k in 0..n {
        method.step(f64::from(k) * h, h, load, &bodies.0, &mut state);
    }
    state.get(0)
}

/// Angle between two attitudes, rad.
fn angle(a: Quaternion<f64>, b: Quaternion<f64>) -> f64 {
    let d = a.conjugate() * b;
    2.0 * d.imag().norm().atan2(d.w.abs())
}

/// Least-squares slope of log(error) over log(h), over the step counts given.
fn slope(counts: &[u32], error: impl Fn(u32) -> f64) -> f64 {
    let points: Vec<(f64, f64)> = counts
        .iter()
        .map(|&n| (-f64::from(n).ln(), error(n).ln()))
        .collect();
    let n = points.len() as f64;
    let (mx, my) = points
        .iter()
        .fold((0.0, 0.0), |(a, b), p| (a + p.0 / n, b + p.1 / n));
    let (sxy, sxx) = points.iter().fold((0.0, 0.0), |(a, b), p| {
        (a + (p.0 - mx) * (p.1 - my), b + (p.0 - mx) * (p.0 - mx))
    });
    sxy / sxx
}

/// The free triaxial body of an outside reference: I = (0.6, 0.8, 1), L = (1.8, 0.4, -0.9),
/// identity start, and its attitude at t = 10 computed in 60 digits (mpmath, Legendre form and an
/// independent Taylor integration).
fn free_triaxial() -> ((InertialBlock, StateBlock), Quaternion<f64>) {
    let inertia = Vector3::new(0.6, 0.8, 1.0);
    let omega = Vector3::new(1.8, 0.4, -0.9).component_div(&inertia);
    let reference = Quaternion::new(
        -0.736_061_364_160_793_9,
        -0.570_786_951_240_350_7,
        -0.299_388_571_830_790_1,
        -0.206_839_086_104_673_2,
    );
    (
        block(inertia, spinning(UnitQuaternion::identity(), omega)),
        reference,
    )
}

#[test]
fn every_method_shows_the_order_it_declares_on_a_free_triaxial_body() {
    let (bodies, reference) = free_triaxial();
    let load = gyroscopic();
    for method in METHODS {
        let info = method.info();
        // Step counts where the error lies well above rounding and well below 1 rad.
        let counts: &[u32] = match info.order {
            1 => &[8_000, 16_000, 32_000, 64_000, 128_000],
            _ => &[200, 400, 800, 1_600, 3_200],
        };
        let error = |n| angle(advance(*method, &load, &bodies, 10.0, n).q_wp, reference);
        let seen = slope(counts, error);
        // Five halvings: a declared order p shows as p to about a tenth; an order lost shows as 1.
        let declared = f64::from(info.order);
        assert!(
            (seen - declared).abs() < 0.15,
            "{}: slope {seen}, declared {declared}",
            info.name
        );
    }
}

#[test]
fn the_order_test_can_fail() {
    // The tutorial's model (no gyroscopic term) is another motion: it must not converge to this.
    let (bodies, reference) = free_triaxial();
    for method in METHODS {
        let end = advance(*method, &Load::default(), &bodies, 10.0, 6_400);
        assert!(angle(end.q_wp, reference) > 0.1, "{}", method.info().name);
    }
}

#[test]
fn a_damped_free_body_is_the_free_one_at_a_slower_time() {
    // τ = -c I ω: L decays as e^{-ct} and the motion is the undamped one at s = (1 - e^{-ct})/c.
    let (bodies, _) = free_triaxial();
    let (c, t): (f64, f64) = (0.3, 4.0);
    let slow = (1.0 - (-c * t).exp()) / c;
    let mut load = gyroscopic();
    let rates = vec![Some(c), Some(c), None, None];
    effect("damping", Value::Table(rates), &mut load);
    let rk4 = find("rk4").unwrap();
    let undamped = advance(rk4, &gyroscopic(), &bodies, slow, 20_000);
    let seen = slope(&[100, 200, 400, 800], |n| {
        angle(advance(rk4, &load, &bodies, t, n).q_wp, undamped.q_wp)
    });
    assert!((seen - 4.0).abs() < 0.15, "slope {seen}");
}

#[test]
fn decay_alone_is_exact_at_any_rate_and_never_turns_round() {
    let omega = Vector3::new(1.0, -2.0, 0.5);
    let bodies = block(
        Vector3::repeat(0.4),
        spinning(UnitQuaternion::identity(), omega),
    );
    for method in METHODS {
        for rate in [0.0_f64, 1e-3, 1.0, 1e3, 1e6] {
            let load = if rate == 0.0 {
                Load::default()
            } else {
                damped(rate)
            };
            let end = advance(*method, &load, &bodies, 1.0, 10).omega_w;
            let exact = omega * (-rate).exp();
            // Ten factors of e^{-c/10}, each rounded, and c h rounded before the exponential.
            let bound = 1e-15 * (10.0 + rate) * exact.norm();
            assert!(
                (end - exact).norm() <= bound,
                "{} {rate}: {end} {exact}",
                method.info().name
            );
        }
    }
}

#[test]
fn constant_torque_about_a_fixed_axis() {
    // θ = ½ α t², ω = α t about the axis, from rest.
    let (alpha, t) = (0.7, 3.0);
    let inertia = Vector3::new(0.3, 0.5, 0.6);
    let bodies = block(
        inertia,
        spinning(UnitQuaternion::identity(), Vector3::zeros()),
    );
    let mut load = Load::default();
    load.push(Arc::new(Couple {
        lane: 0,
        torque: Frame::Principal(Vector3::new(0.0, alpha * inertia.y, 0.0)),
    }));
    let exact = axis_angle(Unit::new_unchecked(Vector3::y()), 0.5 * alpha * t * t);
    for method in METHODS {
        let end = advance(*method, &load, &bodies, t, 3_000);
        // 3,000 additions of α h, a rounding each of numbers up to 2.1.
        assert!((end.omega_w - Vector3::y() * alpha * t).norm() < 1e-12);
        let bound = match method.info().order {
            // First order: ω h / 2 too far a step, ½ α h t in all = 1.05e-3 rad.
            1 => 1.1e-3,
            // q's error constant (ω h)⁵/7680 a step (h = 1e-3, ω ≤ 2.1): below rounding.
            _ => 1e-12,
        };
        assert!(
            angle(end.q_wp, exact.into_inner()) < bound,
            "{}",
            method.info().name
        );
    }
}

#[test]
fn the_tutorials_step_by_hand() {
    // One step of the corrected formulas, written out with plain arrays: an independent reading.
    let (h, i, w, tau) = (0.25, [0.5, 0.5, 1.0], [0.5, -1.0, 2.0], [1.0, 0.5, -0.25]);
    let mut load = Load::default();
    load.push(Arc::new(Couple {
        lane: 0,
        torque: Frame::World(tau.into()),
    }));
    let bodies = block(i.into(), spinning(UnitQuaternion::identity(), w.into()));
    let end = advance(find("semi-implicit").unwrap(), &load, &bodies, h, 1);
    let omega: [f64; 3] = std::array::from_fn(|k| w[k] + tau[k] / i[k] * h);
    let q = [
        0.5 * h * omega[0],
        0.5 * h * omega[1],
        0.5 * h * omega[2],
        1.0,
    ];
    let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    assert_eq!(end.omega_w, Vector3::from(omega));
    // Two roundings of numbers below 1.
    for (got, want) in end.q_wp.coords.iter().zip(q) {
        assert!((got - want / norm).abs() < 3e-16);
    }
}

#[test]
fn a_block_gives_every_body_the_bits_it_would_have_alone() {
    for method in METHODS {
        let mut load = gyroscopic();
        effect(
            "gravity",
            Value::Vector(Vector3::new(0.0, -9.81, 0.0)),
            &mut load,
        );
        let alone = |lane: usize| {
            let k = lane as f64;
            let omega = Vector3::new(1.0 + k, 0.1 * k, -0.3);
            let inertia = Vector3::new(0.3, 0.4 + 0.01 * k, 0.5);
            block(inertia, spinning(UnitQuaternion::identity(), omega))
        };
        let mut inertials = InertialBlock::default();
        let mut states = StateBlock::default();
        for lane in 0..crate::body::LANES {
            inertials.set(lane, alone(lane).0.get(0));
            states.set(lane, alone(lane).1.get(0));
        }
        for k in 0..100 {
            method.step(f64::from(k) * 0.01, 0.01, &load, &inertials, &mut states);
        }
        for lane in 0..crate::body::LANES {
            let lone = advance_with(*method, &load, alone(lane), 0.01, 100);
            assert_eq!(states.get(lane), lone, "{} lane {lane}", method.info().name);
        }
    }
}

fn advance_with(
    method: &dyn Method,
    load: &Load,
    mut bodies: (InertialBlock, StateBlock),
    h: f64,
    n: u32,
) -> State {
    for k in 0..n {
        method.step(f64::from(k) * h, h, load, &bodies.0, &mut bodies.1);
    }
    bodies.1.get(0)
}
