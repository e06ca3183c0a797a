//! Conformance: what every method in [`METHODS`] must do, and the order each declares.

use super::*;
use crate::body::{Inertial, State};
use crate::effect::{Called, Couple, EFFECTS, Frame, Value};
use crate::exact::FreeMotion;
use crate::mass::MassProperties;
use crate::math::axis_angle;
use nalgebra::{Matrix3, Quaternion, Unit, UnitQuaternion, Vector3};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::Arc;

pub(super) fn effect(name: &str, value: Value, load: &mut Load) {
    let kind = EFFECTS.iter().find(|kind| kind.name == name).unwrap();
    match (kind.make)(&value, 1.0).unwrap() {
        Called::Load(effect) => load.push(effect),
        Called::Decay(decay) => load.set_decay(decay),
        Called::Gyroscopic => load.set_gyroscopic(),
        Called::Off => panic!("{name} is off"),
    }
}

pub(super) fn gyroscopic() -> Load {
    let mut load = Load::default();
    effect("gyroscopic", Value::Switch(true), &mut load);
    load
}

pub(super) fn damped(rate: f64) -> Load {
    let mut load = Load::default();
    let rates = vec![Some(rate), Some(rate), None, None];
    effect("damping", Value::Table(rates), &mut load);
    load
}

pub(super) fn block(inertia: Vector3<f64>, state: State) -> (InertialBlock, StateBlock) {
    let properties =
        MassProperties::new(1.0, Matrix3::from_diagonal(&inertia), [false; 3]).unwrap();
    let (inertial, _) = Inertial::new(&properties, None);
    let mut inertials = InertialBlock::default();
    let mut states = StateBlock::default();
    inertials.set(0, inertial);
    states.set(0, state);
    (inertials, states)
}

pub(super) fn spinning(q: UnitQuaternion<f64>, omega_w: Vector3<f64>) -> State {
    State {
        x_w: Vector3::zeros(),
        v_w: Vector3::zeros(),
        q_wp: q.into_inner(),
        omega_w,
    }
}

/// `n` equal steps to `t`.
pub(super) fn steps(t: f64, n: u32) -> Vec<Step> {
    let h = t / f64::from(n);
    let step = |k: u32| Step {
        from: f64::from(k) * h,
        h,
        to: f64::from(k + 1) * h,
        keep: false,
    };
    (0..n).map(step).collect()
}

pub(super) fn interval(load: &Load, inertial: InertialBlock, until: f64) -> Interval {
    Interval {
        load: load.clone(),
        inertial,
        bodies: 1,
        until,
        tolerance: 1e-15,
    }
}

fn advance_block(
    method: &dyn Method,
    interval: Interval,
    state: &StateBlock,
    steps: &[Step],
) -> StateBlock {
    let mut stepper = method.start(interval, 0.0, state);
    stepper.advance(steps, &mut Vec::new());
    stepper.state()
}

pub(super) fn advance(
    method: &dyn Method,
    load: &Load,
    bodies: &(InertialBlock, StateBlock),
    t: f64,
    n: u32,
) -> State {
    let interval = interval(load, bodies.0, t);
    advance_block(method, interval, &bodies.1, &steps(t, n)).get(0)
}

/// Angle between two attitudes, rad.
pub(super) fn angle(a: Quaternion<f64>, b: Quaternion<f64>) -> f64 {
    let d = a.conjugate() * b;
    2.0 * d.imag().norm().atan2(d.w.abs())
}

/// Least-squares slope of log(error) over log(h).
pub(super) fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let logs = points.iter().map(|(h, error)| (h.ln(), error.ln()));
    let (mx, my) = logs
        .clone()
        .fold((0.0, 0.0), |(a, b), p| (a + p.0 / n, b + p.1 / n));
    let (sxy, sxx) = logs.fold((0.0, 0.0), |(a, b), p| {
        (a + (p.0 - mx) * (p.1 - my), b + (p.0 - mx) * (p.0 - mx))
    });
    sxy / sxx
}

/// The method's errors over a ladder of step counts, each √2 times the last: five from where its
/// leading term leads, none where rounding shows.
pub(super) fn ladder(order: u32, error: impl Fn(u32) -> f64) -> Vec<(f64, f64)> {
    // Rounding of some thousand steps.
    const ROUNDING: f64 = 2e-12;
    // By trial: slopes between two neighbours have settled below these.
    let leading = match order {
        1 => 2e-2,
        2 | 3 => 1e-4,
        4 => 1e-7,
        _ => 1e-6,
    };
    let mut points = Vec::new();
    let mut n = 16.0;
    while points.len() < 5 && n < 4e5 {
        let error = error(n as u32);
        if error < ROUNDING {
            break;
        }
        if error < leading {
            points.push((1.0 / f64::from(n as u32), error));
        }
        n *= std::f64::consts::SQRT_2;
    }
    points
}

/// The methods of fixed steps that take this load.
fn fixed_methods(
    load: &Load,
    bodies: &(InertialBlock, StateBlock),
) -> impl Iterator<Item = &'static dyn Method> {
    let interval = interval(load, bodies.0, 1.0);
    METHODS.iter().copied().filter(move |method| {
        let info = method.info();
        info.kind == Kind::Fixed && info.refuses(&interval).is_none()
    })
}

/// The methods that take this load and choose their own steps, or need none; with the
/// tolerances to try.
fn methods_of_own_steps(
    load: &Load,
    bodies: &(InertialBlock, StateBlock),
) -> impl Iterator<Item = (&'static dyn Method, &'static [f64])> {
    let interval = interval(load, bodies.0, 1.0);
    METHODS.iter().copied().filter_map(move |method| {
        let info = method.info();
        let tolerances: &[f64] = match info.kind {
            Kind::Fixed => return None,
            Kind::Adaptive => &[1e-6, 1e-9, 1e-12, 1e-15],
            Kind::Closed => &[0.0],
        };
        let takes = info.refuses(&interval).is_none();
        takes.then_some((method, tolerances))
    })
}

/// The state at `t` of the methods of [`methods_of_own_steps`], and a bound on its error: a hundred
/// times the tolerance for every radian turned (a step turns half a radian or so, and errors of
/// phase grow as the square of the time), and a few roundings of each radian.
fn by_tolerance(
    method: &dyn Method,
    tolerance: f64,
    load: &Load,
    bodies: &(InertialBlock, StateBlock),
    t: f64,
) -> (State, f64) {
    let interval = Interval {
        tolerance,
        ..interval(load, bodies.0, t)
    };
    let end = advance_block(method, interval, &bodies.1, &steps(t, 7)).get(0);
    let radians = 1.0 + bodies.1.get(0).omega_w.norm() * t;
    (end, (100.0 * tolerance + 2e-15) * radians)
}

#[track_caller]
fn has_order(method: &dyn Method, what: &str, error: impl Fn(u32) -> f64) {
    let info = method.info();
    let points = ladder(info.order, error);
    assert!(points.len() >= 4, "{}: {what}: {points:?}", info.name);
    let seen = slope(&points);
    let declared = f64::from(info.order);
    // Neighbouring orders are 1 apart, a lost order shows as 1 less.
    assert!(
        (seen - declared).abs() < 0.1,
        "{}: {what} has slope {seen}, declared {declared}: {points:?}",
        info.name
    );
}

/// The free triaxial body of an outside reference: I = (0.6, 0.8, 1), L = (1.8, 0.4, -0.9),
/// identity start, and its attitude at t = 10 computed in 60 digits (mpmath, Legendre form and an
/// independent Taylor integration).
pub(super) fn free_triaxial() -> ((InertialBlock, StateBlock), Quaternion<f64>) {
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
    for method in fixed_methods(&load, &bodies) {
        has_order(method, "attitude", |n| {
            angle(advance(method, &load, &bodies, 10.0, n).q_wp, reference)
        });
    }
}

#[test]
fn methods_with_steps_of_their_own_meet_outside_digits_within_their_tolerance() {
    let (bodies, reference) = free_triaxial();
    let load = gyroscopic();
    for (method, tolerances) in methods_of_own_steps(&load, &bodies) {
        for &tolerance in tolerances {
            let (end, bound) = by_tolerance(method, tolerance, &load, &bodies, 10.0);
            let error = angle(end.q_wp, reference);
            assert!(
                error < bound,
                "{} at {tolerance:e}: {error:e}",
                method.info().name
            );
        }
    }
}

#[test]
fn methods_with_steps_of_their_own_follow_a_damped_free_body() {
    let (c, t): (f64, f64) = (0.3, 4.0);
    let (bodies, exact) = damped_triaxial(c, t);
    let mut load = gyroscopic();
    let rates = vec![Some(c), Some(c), None, None];
    effect("damping", Value::Table(rates), &mut load);
    for (method, tolerances) in methods_of_own_steps(&load, &bodies) {
        for &tolerance in tolerances {
            let (end, bound) = by_tolerance(method, tolerance, &load, &bodies, t);
            let error = angle(end.q_wp, exact);
            assert!(
                error < bound,
                "{} at {tolerance:e}: {error:e}",
                method.info().name
            );
        }
    }
}

#[test]
fn the_order_test_can_fail() {
    // The tutorial's model (no gyroscopic term) is another motion: it must not converge to this.
    let (bodies, reference) = free_triaxial();
    let load = Load::default();
    for method in fixed_methods(&load, &bodies) {
        let end = advance(method, &load, &bodies, 10.0, 6_400);
        assert!(angle(end.q_wp, reference) > 0.1, "{}", method.info().name);
    }
}

/// The free triaxial body damped at rate c, and its attitude at t: the undamped one's at
/// `(1 - e^{-ct})/c`. The closed form shares no code with the methods that step, and has outside
/// digits of its own.
fn damped_triaxial(c: f64, t: f64) -> ((InertialBlock, StateBlock), Quaternion<f64>) {
    let (bodies, _) = free_triaxial();
    let (body, start) = (bodies.0.get(0), bodies.1.get(0));
    let motion = FreeMotion::new(body.moments, start.q_wp, start.to_principal(start.omega_w));
    let slow = (1.0 - (-c * t).exp()) / c;
    (bodies, motion.attitude(slow))
}

#[test]
fn a_damped_free_body_is_the_free_one_at_a_slower_time() {
    // τ = -c I ω: L decays as e^{-ct} and the motion is the undamped one at s = (1 - e^{-ct})/c.
    let (c, t): (f64, f64) = (0.3, 4.0);
    let (bodies, exact) = damped_triaxial(c, t);
    let mut load = gyroscopic();
    let rates = vec![Some(c), Some(c), None, None];
    effect("damping", Value::Table(rates), &mut load);
    for method in fixed_methods(&load, &bodies) {
        has_order(method, "damped attitude", |n| {
            angle(advance(method, &load, &bodies, t, n).q_wp, exact)
        });
    }
}

/// `m x'' = m (f cos wt - k x - d x')` and, about the fixed axis y, `I ω' = I (a cos bt - c ω)`:
/// forces and torques that depend on time, place and velocities, with a closed form.
#[derive(Debug)]
struct Driven;

const F: Vector3<f64> = Vector3::new(1.0, -0.5, 0.25);
const X0: Vector3<f64> = Vector3::new(0.3, 0.2, -0.4);
const V0: Vector3<f64> = Vector3::new(-0.1, 0.5, 0.3);
const OMEGA0: f64 = 0.4;
const K: f64 = 2.0;
const D: f64 = 0.3;
const W: f64 = 1.3;
const A: f64 = 1.5;
const B: f64 = 1.7;
const C: f64 = 0.6;

impl crate::effect::Effect for Driven {
    fn name(&self) -> &'static str {
        "driven"
    }

    fn add(
        &self,
        t: f64,
        inertial: &InertialBlock,
        state: &StateBlock,
        wrench: &mut crate::effect::WrenchBlock,
    ) {
        let (body, s) = (inertial.get(0), state.get(0));
        let force = (F * (W * t).cos() - s.x_w * K - s.v_w * D) * body.mass;
        let torque = body.moments.y * (A * (B * t).cos() - C * s.omega_w.y);
        wrench.add(0, force, Vector3::y() * torque);
    }
}

impl Driven {
    /// x and v: the steady oscillation and what decays.
    fn place(t: f64) -> (Vector3<f64>, Vector3<f64>) {
        let denominator = (K - W * W).powi(2) + (D * W).powi(2);
        let (p, q) = (F * ((K - W * W) / denominator), F * (D * W / denominator));
        let rate = (K - 0.25 * D * D).sqrt();
        let c = X0 - p;
        let s = (V0 + c * (0.5 * D) - q * W) / rate;
        let (decay, (sin, cos)) = ((-0.5 * D * t).exp(), (rate * t).sin_cos());
        let ((ws, wc), free) = ((W * t).sin_cos(), (c * cos + s * sin) * decay);
        let x = p * wc + q * ws + free;
        let v = (q * wc - p * ws) * W - free * (0.5 * D) + (s * cos - c * sin) * (rate * decay);
        (x, v)
    }

    /// ω and the angle turned about y.
    fn turn(t: f64) -> (f64, f64) {
        let (p, q) = (A * C / (C * C + B * B), A * B / (C * C + B * B));
        let ((sin, cos), decay) = ((B * t).sin_cos(), (-C * t).exp());
        let omega = p * cos + q * sin + (OMEGA0 - p) * decay;
        let angle = (p * sin + q * (1.0 - cos)) / B + (OMEGA0 - p) * (1.0 - decay) / C;
        (omega, angle)
    }
}

#[test]
fn every_method_has_its_order_in_place_and_velocities_under_a_driven_load() {
    let start = State {
        x_w: X0,
        v_w: V0,
        ..spinning(UnitQuaternion::identity(), Vector3::y() * OMEGA0)
    };
    let bodies = block(Vector3::new(0.3, 0.5, 0.6), start);
    let mut load = Load::default();
    load.push(Arc::new(Driven));
    // Not 4: there the h² term of Heun's error in attitude passes through zero.
    let t = 3.0;
    let (x, v) = Driven::place(t);
    let (omega, turned) = Driven::turn(t);
    let q = axis_angle(Unit::new_unchecked(Vector3::y()), turned).into_inner();
    for method in fixed_methods(&load, &bodies) {
        let ends = RefCell::new(BTreeMap::new());
        let end = |n| -> State {
            let mut ends = ends.borrow_mut();
            *(ends.entry(n)).or_insert_with(|| advance(method, &load, &bodies, t, n))
        };
        has_order(method, "place", |n| (end(n).x_w - x).norm());
        has_order(method, "velocity", |n| (end(n).v_w - v).norm());
        has_order(method, "angular velocity", |n| {
            (end(n).omega_w.y - omega).abs()
        });
        has_order(method, "attitude", |n| angle(end(n).q_wp, q));
    }
}

#[test]
fn decay_alone_is_exact_at_any_rate_and_never_turns_round() {
    let omega = Vector3::new(1.0, -2.0, 0.5);
    let bodies = block(
        Vector3::repeat(0.4),
        spinning(UnitQuaternion::identity(), omega),
    );
    for rate in [0.0_f64, 1e-3, 1.0, 1e3, 1e6] {
        let load = if rate == 0.0 {
            Load::default()
        } else {
            damped(rate)
        };
        let exact = |method: &&dyn Method| matches!(method.info().damping, Damping::Exact(_));
        for method in fixed_methods(&load, &bodies).filter(exact) {
            let end = advance(method, &load, &bodies, 1.0, 10).omega_w;
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
    // Tilted, so that a frame left out would show.
    let q0 = axis_angle(Unit::new_normalize(Vector3::new(1.0, 0.3, -0.7)), 1.1);
    let axis = q0 * Vector3::y();
    let bodies = block(inertia, spinning(q0, Vector3::zeros()));
    let mut load = Load::default();
    load.push(Arc::new(Couple {
        lane: 0,
        torque: Frame::Principal(Vector3::new(0.0, alpha * inertia.y, 0.0)),
    }));
    let exact = q0 * axis_angle(Unit::new_unchecked(Vector3::y()), 0.5 * alpha * t * t);
    for method in fixed_methods(&load, &bodies) {
        let end = advance(method, &load, &bodies, t, 3_000);
        // 3,000 additions of α h, a rounding each of numbers up to 2.1.
        assert!((end.omega_w - axis * alpha * t).norm() < 1e-12);
        let bound = match method.info().order {
            // First order: ½ α h² too far a step, ½ α h t in all = 1.05e-3 rad.
            1 => 1.1e-3,
            // ω³ h² / 24 a second at most, over 3 s: 1.2e-6.
            2 | 3 => 1.2e-6,
            // (ω h)⁵/1920 a step, ω h ≤ 2.1e-3: 2e-17; what is left is rounding.
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
    let mut load = gyroscopic();
    effect(
        "gravity",
        Value::Vector(Vector3::new(0.0, -9.81, 0.0)),
        &mut load,
    );
    for method in METHODS {
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
        let all = Interval {
            bodies: crate::body::LANES,
            ..interval(&load, inertials, 1.0)
        };
        let states = advance_block(*method, all, &states, &steps(1.0, 100));
        for lane in 0..crate::body::LANES {
            let lone = advance(*method, &load, &alone(lane), 1.0, 100);
            assert_eq!(states.get(lane), lone, "{} lane {lane}", method.info().name);
        }
    }
}

/// A spring to the origin, N/m per kg.
#[derive(Debug)]
struct Spring(f64);

impl crate::effect::Effect for Spring {
    fn name(&self) -> &'static str {
        "spring"
    }

    fn add(
        &self,
        _: f64,
        _: &InertialBlock,
        state: &StateBlock,
        wrench: &mut crate::effect::WrenchBlock,
    ) {
        wrench.add(0, state.get(0).x_w * -self.0, Vector3::zeros());
    }
}

#[test]
fn explicit_euler_pumps_an_oscillation_and_the_others_do_not() {
    let (stiffness, h, n) = (4.0, 0.01, 10_000);
    let start = State {
        x_w: Vector3::x(),
        ..spinning(UnitQuaternion::identity(), Vector3::zeros())
    };
    let bodies = block(Vector3::repeat(1.0), start);
    let mut load = Load::default();
    load.push(Arc::new(Spring(stiffness)));
    let energy = |s: State| 0.5 * s.v_w.norm_squared() + 0.5 * stiffness * s.x_w.norm_squared();
    for method in fixed_methods(&load, &bodies) {
        let end = advance(method, &load, &bodies, h * f64::from(n), n);
        let growth = energy(end) / energy(start);
        match method.info().name {
            // By 1 + (hΩ)² at each of 10,000 steps: 54-fold, exactly.
            "explicit-euler" => {
                let exact = (1.0 + h * h * stiffness).powi(n as i32);
                assert!((growth / exact - 1.0).abs() < 1e-10, "{growth} {exact}");
            }
            // By 1 + 3/8 (hΩ)² a step: one force for four substeps is, x being 5/8 h² of it on, the
            // map of that determinant; within the cycle as bounded as semi-implicit.
            "rapier" => {
                let exact = (1.0 + 0.375 * h * h * stiffness).powi(n as i32);
                assert!((growth / exact - 1.0).abs() < 0.011, "{growth} {exact}");
            }
            // Bounded for semi-implicit (by hΩ/2 = 1%); (hΩ)⁴ t Ω/8 for the midpoint rule,
            // (hΩ)⁵ t Ω/72 for rk4.
            name => assert!((growth - 1.0).abs() < 0.011, "{name}: {growth}"),
        }
    }
}
