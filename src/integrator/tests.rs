//! Conformance: what every method in [`METHODS`] must do, and the order each declares.

use super::*;
use crate::body::{Inertial, State};
use crate::effect::{Called, Couple, Depends, EFFECTS, Frame, Member, Value};
use crate::exact::FreeMotion;
use crate::mass::MassProperties;
use crate::math::axis_angle;
use nalgebra::{Matrix3, Quaternion, Unit, UnitQuaternion, Vector3};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Adds an effect on all eight lanes, of bodies that are free.
pub(super) fn effect(name: &str, value: Value, load: &mut Load) {
    let kind = EFFECTS.iter().find(|kind| kind.name == name).unwrap();
    let called = (kind.make)(&value, 1.0).unwrap();
    assert!(!matches!(called, Called::Off), "{name} is off");
    let inertial = InertialBlock::default();
    let members = (0..LANES).map(|lane| Member::plain(lane, inertial.get(lane)));
    load.call(&name.into(), &called, &members.collect::<Vec<_>>());
}

pub(super) fn gyroscopic() -> Load {
    let mut load = Load::default();
    effect("gyroscopic", Value::Switch(true), &mut load);
    load
}

pub(super) fn damped(rate: f64) -> Load {
    let mut load = Load::default();
    let rates = Value::numbers(&[("linear", rate), ("angular", rate)]);
    effect("damping", rates, &mut load);
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

pub(super) fn advance_block(
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

/// The method's errors over a ladder of step counts, each √2 times the last (or a root of it, for high
/// orders, whose errors fall so fast): five from where its leading term leads, none where rounding shows.
pub(super) fn ladder(info: &MethodInfo, error: impl Fn(u32) -> f64) -> Vec<(f64, f64)> {
    // By trial: slopes between two neighbours have settled below these.
    let leading = match info.order {
        1 => 2e-2,
        2 | 3 => 1e-4,
        4 if info.weak_orders.is_some() => 2e-10,
        4 => 1e-7,
        5 => 1e-6,
        6..=8 => 1e-8,
        _ => 3e-12,
    };
    // Of some thousand steps; high orders are there in a hundred.
    let rounding = if info.order > 6 { 5e-14 } else { 2e-12 };
    let halving = match info.order {
        4 if info.weak_orders.is_some() => 4.0,
        0..=5 => 2.0,
        6..=8 => 4.0,
        _ => 8.0,
    };
    let rung = libm::exp2(1.0 / halving);
    let mut points = Vec::new();
    let mut n = 16.0;
    while points.len() < 5 && n < 4e5 {
        let error = error(n as u32);
        if error < rounding {
            break;
        }
        if error < leading {
            points.push((1.0 / f64::from(n as u32), error));
        }
        n *= rung;
    }
    points
}

/// The methods of fixed steps that take this load.
pub(super) fn fixed_methods(
    load: &Load,
    bodies: &(InertialBlock, StateBlock),
) -> impl Iterator<Item = &'static dyn Method> {
    METHODS.iter().copied().filter(move |method| {
        let info = method.info();
        info.kind == Kind::Fixed && info.refuses(load, &bodies.0).is_none()
    })
}

/// The methods that take this load and choose their own steps, or need none; with the
/// tolerances to try.
pub(super) fn methods_of_own_steps(
    load: &Load,
    bodies: &(InertialBlock, StateBlock),
) -> impl Iterator<Item = (&'static dyn Method, &'static [f64])> {
    METHODS.iter().copied().filter_map(move |method| {
        let info = method.info();
        let tolerances: &[f64] = match info.kind {
            Kind::Fixed => return None,
            Kind::Adaptive => &[1e-6, 1e-9, 1e-12, 1e-15],
            Kind::Closed => &[0.0],
        };
        let takes = info.refuses(load, &bodies.0).is_none();
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

#[test]
fn evaluations_are_declared_where_their_number_is_fixed() {
    for info in METHODS.iter().map(|method| method.info()) {
        let declared = info.cost.evaluations;
        let fits = match info.kind {
            Kind::Fixed => declared.is_some_and(|each| each > 0),
            Kind::Adaptive => declared.is_none(),
            Kind::Closed => declared == Some(0),
        };
        assert!(fits, "{}: {declared:?}", info.name);
        let order = info.weak_orders.map_or(info.order, |[_, _, order]| order);
        assert_eq!(order, info.order, "{}", info.name);
    }
}

#[track_caller]
pub(super) fn has_order(method: &dyn Method, what: &str, error: impl Fn(u32) -> f64) {
    let info = method.info();
    let points = ladder(info, error);
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

/// Of a body on which nothing acts: the order declared, or nothing but rounding at any step.
#[track_caller]
fn is_exact_or_has_order(method: &dyn Method, what: &str, error: impl Fn(u32) -> f64) {
    if !method.info().exact_free {
        return has_order(method, what, error);
    }
    for n in [1, 7, 100, 10_000] {
        // Rounding of the closed form, and of an attitude of a few turns.
        let error = error(n);
        assert!(error < 5e-15, "{}: {what}: {error}", method.info().name);
    }
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
        is_exact_or_has_order(method, "attitude", |n| {
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
    let rates = Value::numbers(&[("linear", c), ("angular", c)]);
    effect("damping", rates, &mut load);
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
    let rates = Value::numbers(&[("linear", c), ("angular", c)]);
    effect("damping", rates, &mut load);
    for method in fixed_methods(&load, &bodies) {
        is_exact_or_has_order(method, "damped attitude", |n| {
            angle(advance(method, &load, &bodies, t, n).q_wp, exact)
        });
    }
}

/// `m x'' = m (f cos wt - k x - d x')` and, about the fixed axis y, `I ω' = I (a cos bt - c ω)`:
/// forces and torques that depend on time, place and velocities, with a closed form.
#[derive(Debug)]
struct Driven {
    /// What drags: d and c, 1/s.
    d: f64,
    c: f64,
}

const F: Vector3<f64> = Vector3::new(1.0, -0.5, 0.25);
const X0: Vector3<f64> = Vector3::new(0.3, 0.2, -0.4);
const V0: Vector3<f64> = Vector3::new(-0.1, 0.5, 0.3);
const OMEGA0: f64 = 0.4;
const K: f64 = 2.0;
const W: f64 = 1.3;
const A: f64 = 1.5;
const B: f64 = 1.7;

impl crate::effect::Effect for Driven {
    fn name(&self) -> &'static str {
        "driven"
    }

    fn lanes(&self) -> crate::body::LaneSet {
        crate::body::LaneSet::ALL
    }

    fn add(
        &self,
        t: f64,
        inertial: &InertialBlock,
        state: &StateBlock,
        wrench: &mut crate::effect::WrenchBlock,
    ) {
        let (body, s) = (inertial.get(0), state.get(0));
        let force = (F * (W * t).cos() - s.x_w * K - s.v_w * self.d) * body.mass;
        let torque = body.moments.y * (A * (B * t).cos() - self.c * s.omega_w.y);
        wrench.add(0, force, Vector3::y() * torque);
    }

    fn depends(&self, _: &InertialBlock) -> Depends {
        Depends {
            velocity: self.d != 0.0 || self.c != 0.0,
            ..Depends::EVERYTHING
        }
    }
}

impl Driven {
    /// x and v: the steady oscillation and what decays.
    fn place(&self, t: f64) -> (Vector3<f64>, Vector3<f64>) {
        let d = self.d;
        let denominator = (K - W * W).powi(2) + (d * W).powi(2);
        let (p, q) = (F * ((K - W * W) / denominator), F * (d * W / denominator));
        let rate = (K - 0.25 * d * d).sqrt();
        let amplitude = X0 - p;
        let s = (V0 + amplitude * (0.5 * d) - q * W) / rate;
        let (decay, (sin, cos)) = ((-0.5 * d * t).exp(), (rate * t).sin_cos());
        let ((ws, wc), free) = ((W * t).sin_cos(), (amplitude * cos + s * sin) * decay);
        let x = p * wc + q * ws + free;
        let v =
            (q * wc - p * ws) * W - free * (0.5 * d) + (s * cos - amplitude * sin) * (rate * decay);
        (x, v)
    }

    /// ω and the angle turned about y.
    fn turn(&self, t: f64) -> (f64, f64) {
        let c = self.c;
        let (p, q) = (A * c / (c * c + B * B), A * B / (c * c + B * B));
        let ((sin, cos), decay) = ((B * t).sin_cos(), (-c * t).exp());
        // (1 - e^{-ct})/c.
        let slowed = if c == 0.0 { t } else { (1.0 - decay) / c };
        let omega = p * cos + q * sin + (OMEGA0 - p) * decay;
        let angle = (p * sin + q * (1.0 - cos)) / B + (OMEGA0 - p) * slowed;
        (omega, angle)
    }
}

#[test]
fn every_method_has_its_order_in_place_and_velocities_under_a_driven_load() {
    // Not to 4: there the h² term of Heun's error in attitude passes through zero.
    has_its_order_driven(Driven { d: 0.3, c: 0.6 }, 3.0);
}

#[test]
fn and_under_one_that_depends_on_time_and_place_alone() {
    // Where neither cosine nor sine of the torque is near where it began: errors of order 1 are its
    // difference, of order 2 its rate's.
    has_its_order_driven(Driven { d: 0.0, c: 0.0 }, 5.0);
}

#[track_caller]
fn has_its_order_driven(driven: Driven, t: f64) {
    let ((x, v), (omega, turned)) = (driven.place(t), driven.turn(t));
    let start = State {
        x_w: X0,
        v_w: V0,
        ..spinning(UnitQuaternion::identity(), Vector3::y() * OMEGA0)
    };
    let bodies = block(Vector3::new(0.3, 0.5, 0.6), start);
    let mut load = Load::default();
    load.push(Arc::new(driven));
    let q = axis_angle(Unit::new_unchecked(Vector3::y()), turned).into_inner();
    for method in fixed_methods(&load, &bodies) {
        let ends = RefCell::new(BTreeMap::new());
        let end = |n| -> State {
            let mut ends = ends.borrow_mut();
            *(ends.entry(n)).or_insert_with(|| advance(method, &load, &bodies, t, n))
        };
        has_order(method, "place", |n| (end(n).x_w - x).norm());
        has_order(method, "velocity", |n| (end(n).v_w - v).norm());
        if let Some([alone, _, _]) = method.info().weak_orders {
            // That is their order for a torque of time alone, 8 and 10: a hundred steps leave rounding.
            assert!(alone >= 8);
            let end = end(100);
            assert!((end.omega_w.y - omega).abs() < 1e-13 && angle(end.q_wp, q) < 1e-13);
            continue;
        }
        has_order(method, "angular velocity", |n| {
            (end(n).omega_w.y - omega).abs()
        });
        has_order(method, "attitude", |n| angle(end(n).q_wp, q));
    }
}

#[test]
fn methods_with_steps_of_their_own_follow_a_driven_load() {
    let start = State {
        x_w: X0,
        v_w: V0,
        ..spinning(UnitQuaternion::identity(), Vector3::y() * OMEGA0)
    };
    let bodies = block(Vector3::new(0.3, 0.5, 0.6), start);
    let mut load = Load::default();
    let driven = Driven { d: 0.3, c: 0.6 };
    let t = 4.0;
    let ((x, v), (omega, turned)) = (driven.place(t), driven.turn(t));
    load.push(Arc::new(driven));
    let q = axis_angle(Unit::new_unchecked(Vector3::y()), turned).into_inner();
    for (method, tolerances) in methods_of_own_steps(&load, &bodies) {
        for &tolerance in tolerances {
            let (end, bound) = by_tolerance(method, tolerance, &load, &bodies, t);
            let what = format!("{} at {tolerance:e}", method.info().name);
            assert!((end.x_w - x).norm() < bound, "{what}: place");
            assert!((end.v_w - v).norm() < bound, "{what}: velocity");
            assert!((end.omega_w.y - omega).abs() < bound, "{what}: ω");
            assert!(angle(end.q_wp, q) < bound, "{what}: attitude");
        }
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

/// A free body, one under a torque that stays, one under a torque that turns with it; the states of each of
/// the first two, with the second's and the third's torque as asked, kept every so many steps.
fn three_side_by_side(
    method: &dyn Method,
    mut load: Load,
    torques: usize,
    every: usize,
) -> [Vec<State>; 2] {
    let (mut inertial, mut states) = (InertialBlock::default(), StateBlock::default());
    // Zeros of both signs, and what is not about an axis.
    let omega = [
        Vector3::new(-0.0, 2.0, 0.0),
        Vector3::new(0.9, -3.0, 2.1),
        Vector3::new(0.1, 1.0, -0.2),
    ];
    for (lane, omega) in omega.into_iter().enumerate() {
        let start = State {
            v_w: Vector3::new(-0.0, 0.5, 0.0),
            ..spinning(UnitQuaternion::identity(), omega)
        };
        let one = block(Vector3::new(0.5, 0.8, 1.1), start);
        inertial.set(lane, one.0.get(0));
        states.set(lane, one.1.get(0));
    }
    let torque = Vector3::new(0.3, -0.1, 0.2);
    let acting = [Frame::World(torque), Frame::Principal(torque)];
    for (k, torque) in acting.into_iter().take(torques).enumerate() {
        let lane = k + 1;
        load.push(Arc::new(Couple { lane, torque }));
    }
    let interval = Interval {
        bodies: 3,
        ..interval(&load, inertial, 1.0)
    };
    let mut steps = steps(1.0, 160);
    for (k, step) in steps.iter_mut().enumerate() {
        step.keep = (k + 1) % every == 0;
    }
    let mut kept = Vec::new();
    method
        .start(interval, 0.0, &states)
        .advance(&steps, &mut kept);
    let sixteenth = kept.iter().skip(16 / every - 1).step_by(16 / every);
    let states = |lane| sixteenth.clone().map(move |at: &StateBlock| at.get(lane));
    [0, 1].map(|lane| states(lane).collect())
}

/// Each of the two bodies as `see` sees it must be the same in all company and however often kept.
#[track_caller]
fn goes_as_alone<T: PartialEq + std::fmt::Debug>(
    method: &dyn Method,
    load: &Load,
    see: impl Fn(&State) -> T,
) {
    let run = |torques, every| {
        let states = three_side_by_side(method, load.clone(), torques, every);
        states.map(|states| states.iter().map(&see).collect::<Vec<T>>())
    };
    let [free, _] = run(0, 1);
    let [_, pushed] = run(1, 1);
    assert_eq!(free.len(), 10);
    for every in [1, 16] {
        let name = method.info().name;
        assert_eq!(run(0, every)[0], free, "{name}");
        for torques in [1, 2] {
            let [beside, own] = run(torques, every);
            assert_eq!(beside, free, "{name}, {torques} torques");
            assert_eq!(own, pushed, "{name}, {torques} torques");
        }
    }
}

#[test]
fn a_body_goes_its_way_whatever_acts_beside_it_and_however_often_it_is_kept() {
    let mut seen = 0;
    for load in [gyroscopic(), Load::default()] {
        let mut all = load.clone();
        let torque = Frame::Principal(Vector3::x());
        all.push(Arc::new(Couple { lane: 0, torque }));
        let bodies = (InertialBlock::default(), StateBlock::default());
        for method in fixed_methods(&all, &bodies) {
            goes_as_alone(method, &load, |state| *state);
            seen += 1;
        }
        // One of two ways through a step, by what acts in the block: the signs of zeros are the same too.
        goes_as_alone(find("rk4").unwrap(), &load, |state| state.hash_into(0));
    }
    assert!(seen > 12);
}

/// A spring to the origin, N/m per kg.
#[derive(Debug)]
struct Spring(f64);

impl crate::effect::Effect for Spring {
    fn name(&self) -> &'static str {
        "spring"
    }

    fn lanes(&self) -> crate::body::LaneSet {
        crate::body::LaneSet::ALL
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

/// A heavy asymmetric top, digits from outside: I = (1, 1.6, 2.1) about the pivot, weight times lever
/// (0.3, 0.2, 1) in principal axes, gravity along -z; its attitude at t = 10
/// (tests/oracles/asymmetric_top.py, 50 digits).
pub(super) fn heavy_top() -> ((InertialBlock, StateBlock), Load, Quaternion<f64>) {
    let moments = Vector3::new(1.0, 1.6, 2.1);
    let body = Inertial {
        mass: 1.0,
        inv_mass: 0.0,
        moments,
        inv_moments: moments.map(f64::recip),
        centre_p: Vector3::new(0.3, 0.2, 1.0),
    };
    let q = Quaternion::new(0.86_f64.sqrt(), 0.1, 0.3, -0.2);
    let start = State {
        x_w: Vector3::zeros(),
        v_w: Vector3::zeros(),
        q_wp: q,
        omega_w: crate::math::turned(q, Vector3::new(0.5, -0.8, 2.0)),
    };
    let mut inertials = InertialBlock::default();
    let mut states = StateBlock::default();
    inertials.set(0, body);
    states.set(0, start);
    let mut load = gyroscopic();
    effect("gravity", Value::Vector(-Vector3::z()), &mut load);
    ((inertials, states), load, heavy_top_at(10))
}

/// Its attitude at 10 or 100 s.
pub(super) fn heavy_top_at(t: u32) -> Quaternion<f64> {
    let rows = include_str!("../../tests/oracles/asymmetric_top.csv").lines();
    let row = rows.skip(1).find_map(|row| {
        let numbers: Vec<f64> = row.split(',').map(|x| x.parse().unwrap()).collect();
        (numbers[0] == f64::from(t)).then_some(numbers)
    });
    let row = row.unwrap();
    Quaternion::new(row[4], row[1], row[2], row[3])
}

#[test]
fn every_method_shows_the_order_it_declares_on_a_heavy_top() {
    let (bodies, load, reference) = heavy_top();
    let mut seen = 0;
    for method in fixed_methods(&load, &bodies) {
        has_order(method, "heavy top", |n| {
            angle(advance(method, &load, &bodies, 10.0, n).q_wp, reference)
        });
        seen += 1;
    }
    assert!(seen > 3);
}

/// There and back.
fn returned(
    method: &dyn Method,
    load: &Load,
    bodies: &(InertialBlock, StateBlock),
    t: f64,
    n: u32,
) -> State {
    let forth = steps(t, n);
    let back = forth.iter().rev().map(|step| Step {
        from: step.to,
        h: -step.h,
        to: step.from,
        keep: false,
    });
    let mut stepper = method.start(interval(load, bodies.0, t), 0.0, &bodies.1);
    stepper.advance(&forth, &mut Vec::new());
    stepper.advance(&back.collect::<Vec<_>>(), &mut Vec::new());
    stepper.state().get(0)
}

#[test]
fn methods_that_say_so_go_back_the_way_they_came_and_the_others_do_not() {
    let (top, weight, _) = heavy_top();
    let (free, _) = free_triaxial();
    let mut slowing = gyroscopic();
    let rates = Value::numbers(&[("linear", 0.1), ("angular", 0.2)]);
    effect("damping", rates, &mut slowing);
    for (bodies, load) in [(top, weight), (free, gyroscopic()), (free, slowing)] {
        for method in fixed_methods(&load, &bodies) {
            let end = returned(method, &load, &bodies, 10.0, 100);
            let start = bodies.1.get(0);
            let gap = angle(end.q_wp, start.q_wp) + (end.omega_w - start.omega_w).norm();
            let info = method.info();
            if info.reversible {
                // Roundings of 200 steps of some stages, carried along by the motion.
                assert!(gap < 1e-12, "{}: {gap}", info.name);
            } else {
                assert!(gap > 1e-9, "{}: {gap}", info.name);
            }
        }
    }
}

#[test]
fn methods_that_say_so_keep_the_momentum_of_a_free_body_over_a_million_steps() {
    let ((inertials, states), _) = free_triaxial();
    let load = gyroscopic();
    let bodies = (inertials, states);
    let before = inertials.get(0).momentum_w(&states.get(0));
    let mut seen = 0;
    for method in fixed_methods(&load, &bodies).filter(|method| method.info().keeps_momentum) {
        let end = advance(method, &load, &bodies, 1e4, 1_000_000);
        let after = inertials.get(0).momentum_w(&end);
        let gap = (after - before).norm() / before.norm();
        let name = method.info().name;
        // L is kept as it is; ω = R I⁻¹ Rᵀ L and back are four rotations by a q of unit length.
        assert!(gap < 5e-15, "{name}: {gap}");
        seen += 1;
    }
    assert!(seen > 4);
}
