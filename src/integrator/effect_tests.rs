//! What every method makes of the effects: its order, or a refusal; against outside digits and closed forms.

use super::tests::{
    advance, angle, block, effect, fixed_methods, gyroscopic, interval, methods_of_own_steps,
    slope, steps,
};
use super::*;
use crate::body::{Inertial, State};
use crate::effect::{BodyPoint, Value};
use crate::math::axis_angle;
use nalgebra::{Quaternion, Unit, UnitQuaternion, Vector3};
use std::f64::consts::TAU;

type Bodies = (InertialBlock, StateBlock);

fn v(x: f64, y: f64, z: f64) -> Vector3<f64> {
    Vector3::new(x, y, z)
}

fn number(key: &'static str, x: f64) -> (&'static str, Value) {
    (key, Value::Number(x))
}

/// The cases of tests/oracles/effects.py.
fn case(name: &str) -> (Load, Bodies) {
    let mut load = gyroscopic();
    let spring = |damping: f64| {
        Value::Table(vec![
            ("anchor", Value::Vector(v(0.2, 1.0, -0.1))),
            ("point", Value::Point(BodyPoint::At(v(0.3, -0.2, 0.4)))),
            number("stiffness", 4.0),
            number("rest_length", 0.5),
            number("damping", damping),
        ])
    };
    let rest = Vector3::zeros();
    let slow = v(0.1, 0.0, 0.2);
    let (kind, value, x_w, v_w) = match name {
        "spring" => ("spring", spring(0.0), rest, slow),
        "spring_damped" => ("spring", spring(0.3), rest, slow),
        "motor" => {
            let sine = [
                number("amplitude", 0.7),
                number("frequency", 0.35),
                number("phase", 0.4),
            ];
            let value = Value::Table(vec![
                ("axis", Value::Vector(v(1.0, 2.0, -1.0))),
                ("frame", Value::Word("body")),
                ("sine", Value::Table(sine.to_vec())),
            ]);
            ("motor", value, rest, rest)
        }
        "hold" => {
            let target = axis_angle(Unit::new_normalize(v(1.0, 1.0, 0.0)), 1.0);
            let value = Value::Table(vec![
                ("orientation", Value::Attitude(target)),
                number("stiffness", 3.0),
                number("damping", 0.5),
            ]);
            ("motor", value, rest, rest)
        }
        "drag" => {
            let value = Value::numbers(&[
                ("linear", 0.2),
                ("quadratic", 0.1),
                ("angular_linear", 0.15),
                ("angular_quadratic", 0.05),
            ]);
            ("drag", value, v(0.3, 0.0, 0.0), v(2.0, -0.5, 1.0))
        }
        "orbit" => {
            let value = Value::Table(vec![number("mu", 4.0), ("orbit", Value::Switch(true))]);
            (
                "gravity_gradient",
                value,
                v(2.0, 0.0, 0.0),
                v(0.0, 1.4, 0.1),
            )
        }
        _ => panic!("no case {name}"),
    };
    effect(kind, value, &mut load);
    let moments = v(0.6, 0.8, 1.0);
    let start = State {
        x_w,
        v_w,
        q_wp: Quaternion::identity(),
        omega_w: v(1.8, 0.4, -0.9).component_div(&moments),
    };
    let body = Inertial {
        mass: 1.3,
        inv_mass: 1.0 / 1.3,
        moments,
        inv_moments: moments.map(f64::recip),
        centre_p: Vector3::zeros(),
    };
    let (mut inertials, mut states) = (InertialBlock::default(), StateBlock::default());
    inertials.set(0, body);
    states.set(0, start);
    (load, (inertials, states))
}

/// When its reference is, s.
const END: f64 = 3.0;

fn reference(name: &str) -> State {
    let rows = include_str!("../../tests/oracles/effects.csv").lines();
    let row = rows.filter_map(|row| row.split_once(','));
    let (_, row) = row.into_iter().find(|(case, _)| *case == name).unwrap();
    let n: Vec<f64> = row.split(',').map(|x| x.parse().unwrap()).collect();
    assert_eq!(n[0], END);
    State {
        x_w: v(n[1], n[2], n[3]),
        v_w: v(n[4], n[5], n[6]),
        q_wp: Quaternion::new(n[10], n[7], n[8], n[9]),
        omega_w: v(n[11], n[12], n[13]),
    }
}

/// Holds a method to the order it declares, by the last four rungs of a ladder of step counts before rounding
/// shows: these motions have sharper turns than those of the other tests, and their leading terms lead late.
#[track_caller]
fn shows_its_order(method: &dyn Method, what: &str, error: impl Fn(u32) -> f64) {
    const LAST: usize = 4;
    let info = method.info();
    let (rung, mut n) = match info.order {
        0..=5 => (2.0_f64.sqrt(), 8.0),
        _ => (2.0_f64.powf(0.25), 4.0),
    };
    let mut points = Vec::new();
    while n < 8e3 {
        let error = error(n as u32);
        // Some dozen roundings a step, of numbers of size 1.
        if error < 3e-13 + 3e-15 * n {
            break;
        }
        points.push((1.0 / f64::from(n as u32), error));
        n *= rung;
    }
    let last = &points[points.len().saturating_sub(LAST)..];
    assert!(last.len() == LAST, "{}: {what}: {points:?}", info.name);
    let (seen, declared) = (slope(last), f64::from(info.order));
    // A lost order shows as 1 less. More is no loss: where a method of high order meets rounding in some forty
    // steps, terms above the leading one still count, and some have a higher order for weak forces.
    let most = match (info.order, info.weak_orders) {
        (0..=5, None) => declared + 0.5,
        _ => f64::INFINITY,
    };
    assert!(
        (declared - 0.2..most).contains(&seen),
        "{}: {what} has slope {seen}, declared {declared}: {last:?}",
        info.name
    );
}

const CASES: [&str; 6] = ["spring", "spring_damped", "motor", "hold", "drag", "orbit"];

#[track_caller]
fn keeps_its_order(name: &str) {
    let ((load, bodies), truth) = (case(name), reference(name));
    let mut seen = 0;
    for method in fixed_methods(&load, &bodies) {
        shows_its_order(method, name, |n| {
            let end = advance(method, &load, &bodies, END, n);
            // All of it, so that no part that passes through zero passes for the whole.
            angle(end.q_wp, truth.q_wp)
                + (end.omega_w - truth.omega_w).norm()
                + (end.x_w - truth.x_w).norm()
                + (end.v_w - truth.v_w).norm()
        });
        seen += 1;
    }
    assert!(seen > 8, "{name}: {seen}");
}

#[test]
fn every_method_that_takes_a_spring_has_its_order_on_one() {
    keeps_its_order("spring");
}

#[test]
fn every_method_that_takes_a_damper_has_its_order_on_one() {
    keeps_its_order("spring_damped");
}

#[test]
fn every_method_that_takes_a_motor_in_the_body_has_its_order_on_one() {
    keeps_its_order("motor");
}

#[test]
fn every_method_that_takes_a_controller_has_its_order_on_one() {
    keeps_its_order("hold");
}

#[test]
fn every_method_that_takes_drag_has_its_order_on_it() {
    keeps_its_order("drag");
}

#[test]
fn every_method_that_takes_a_planet_has_its_order_in_an_orbit() {
    keeps_its_order("orbit");
}

#[test]
fn methods_with_steps_of_their_own_meet_outside_digits_under_the_effects() {
    for name in CASES {
        let ((load, bodies), truth) = (case(name), reference(name));
        let mut seen = 0;
        for (method, tolerances) in methods_of_own_steps(&load, &bodies) {
            for &tolerance in tolerances {
                let interval = Interval {
                    tolerance,
                    ..interval(&load, bodies.0, END)
                };
                let mut stepper = method.start(interval, 0.0, &bodies.1);
                stepper.advance(&steps(END, 7), &mut Vec::new());
                let end = stepper.state().get(0);
                // As in the conformance tests beside this: a hundred tolerances, and a few roundings, of
                // each of the ten radians it turns; places are of size 5.
                let bound = (100.0 * tolerance + 2e-15) * 10.0;
                let off = angle(end.q_wp, truth.q_wp);
                let away = (end.x_w - truth.x_w).norm();
                assert!(
                    off < bound,
                    "{} {name} at {tolerance:e}: {off:e}",
                    method.info().name
                );
                assert!(
                    away < bound,
                    "{} {name} at {tolerance:e}: {away:e}",
                    method.info().name
                );
                seen += 1;
            }
        }
        assert!(seen > 0, "{name}");
    }
}

#[test]
fn methods_that_kick_refuse_what_depends_on_velocity_and_the_closed_form_what_turns() {
    for name in CASES {
        let (load, bodies) = case(name);
        let refuses = |method: &str| find(method).unwrap().info().refuses(&load, &bodies.0);
        let velocity = ["spring_damped", "hold", "drag"].contains(&name);
        assert_eq!(refuses("strang").is_some(), velocity, "{name}");
        for method in ["closed-form", "dmv4", "taylor"] {
            assert!(refuses(method).is_some(), "{name} {method}");
        }
        for method in ["rk4", "dop853", "semi-implicit"] {
            assert!(refuses(method).is_none(), "{name} {method}");
        }
    }
}

/// About the body's z, which is tilted, so that a frame left out would show.
fn about_an_axis(omega: f64) -> (Bodies, UnitQuaternion<f64>) {
    let q0 = axis_angle(Unit::new_normalize(v(1.0, 0.3, -0.7)), 1.1);
    let start = State {
        x_w: Vector3::zeros(),
        v_w: v(3.0, 0.0, 4.0),
        q_wp: q0.into_inner(),
        omega_w: q0 * (Vector3::z() * omega),
    };
    // The mass is 1.
    (block(v(0.3, 0.5, 0.6), start), q0)
}

/// At `t` by the method of fixed steps that is the usual one, and by the one of its own: an angle about the
/// axis, the angular velocity, place and velocity, to 1e-11.
#[track_caller]
fn meets(load: &Load, bodies: &Bodies, q0: UnitQuaternion<f64>, t: f64, exact: Exact) {
    for (method, n) in [("rk4", 6_000), ("dop853", 7)] {
        let end = advance(find(method).unwrap(), load, bodies, t, n);
        let turned = q0 * axis_angle(Unit::new_unchecked(Vector3::z()), exact.turned);
        // rk4: (ω h)⁴ ω t/120 with ω h at most 2e-3: 2e-13; 6,000 roundings of numbers up to 10.
        let bound = 1e-11;
        let off = angle(end.q_wp, turned.into_inner());
        assert!(off < bound, "{method}: turned, {off:e}");
        let omega_w = q0 * (Vector3::z() * exact.omega);
        assert!(
            (end.omega_w - omega_w).norm() < bound,
            "{method}: ω {}",
            end.omega_w
        );
        let (way, direction) = (exact.way, v(0.6, 0.0, 0.8));
        assert!(
            (end.x_w - direction * way).norm() < bound,
            "{method}: x {}",
            end.x_w
        );
        assert!(
            (end.v_w - direction * exact.speed).norm() < bound,
            "{method}: v {}",
            end.v_w
        );
    }
}

/// About the axis (rad, rad/s), and along the way it goes (m, m/s).
struct Exact {
    turned: f64,
    omega: f64,
    way: f64,
    speed: f64,
}

const T: f64 = 3.0;
/// About z.
const I: f64 = 0.6;

#[test]
fn linear_drag_is_an_exponential_and_quadratic_drag_a_hyperbola() {
    let (bodies, q0) = about_an_axis(2.0);
    let (b, c) = (0.4, 0.3);
    let mut load = Load::default();
    let value = Value::numbers(&[("linear", b), ("angular_linear", c)]);
    effect("drag", value, &mut load);
    let left = |rate: f64| (-rate * T).exp();
    let exact = Exact {
        turned: 2.0 * (1.0 - left(c / I)) * I / c,
        omega: 2.0 * left(c / I),
        way: 5.0 * (1.0 - left(b)) / b,
        speed: 5.0 * left(b),
    };
    meets(&load, &bodies, q0, T, exact);
    let mut load = Load::default();
    let value = Value::numbers(&[("quadratic", b), ("angular_quadratic", c)]);
    effect("drag", value, &mut load);
    let slower = |k: f64, v: f64| 1.0 + k * v * T;
    let exact = Exact {
        turned: slower(c / I, 2.0).ln() * I / c,
        omega: 2.0 / slower(c / I, 2.0),
        way: slower(b, 5.0).ln() / b,
        speed: 5.0 / slower(b, 5.0),
    };
    meets(&load, &bodies, q0, T, exact);
}

#[test]
fn a_motor_that_swings_and_one_that_rises_follow_their_integrals() {
    let (bodies, q0) = about_an_axis(0.5);
    // θ'' = A/I sin(Ω t + φ).
    let (a, rate, phase) = (0.9, TAU * 0.4, 0.3);
    let axis = ("axis", Value::Vector(Vector3::z() * 7.0));
    let own = ("frame", Value::Word("body"));
    let sine = [
        number("amplitude", a),
        number("frequency", 0.4),
        number("phase", phase),
    ];
    let mut load = Load::default();
    let sine = ("sine", Value::Table(sine.to_vec()));
    effect(
        "motor",
        Value::Table(vec![axis.clone(), own.clone(), sine]),
        &mut load,
    );
    let (at, kick) = (rate * T + phase, a / (I * rate));
    let flying = |turned: f64, omega: f64| Exact {
        turned,
        omega,
        way: 5.0 * T,
        speed: 5.0,
    };
    let drift = 0.5 + kick * phase.cos();
    let turned = drift * T - kick / rate * (at.sin() - phase.sin());
    let exact = flying(turned, drift - kick * at.cos());
    meets(&load, &bodies, q0, T, exact);
    // From 0.2 to 1.1 N·m within 2 s, and 1.1 for one second more: a step of either ends there.
    let ramp = Value::numbers(&[("from", 0.2), ("to", 1.1), ("over", 2.0)]);
    let mut load = Load::default();
    effect(
        "motor",
        Value::Table(vec![axis, own, ("ramp", ramp)]),
        &mut load,
    );
    let after = 0.5 + (0.2 * 2.0 + 0.45 * 2.0) / I;
    let then = 0.5 * 2.0 + (0.2 * 2.0 + 0.45 * 4.0 / 3.0) / I;
    let exact = flying(then + after + 0.5 * 1.1 / I, after + 1.1 / I);
    let (end, by) = (T, find("rk4").unwrap());
    let got = advance(by, &load, &bodies, end, 6_000);
    let turned = q0 * axis_angle(Unit::new_unchecked(Vector3::z()), exact.turned);
    // rk4 as above; the corner lies at the end of step 4,000 but for a rounding.
    assert!(angle(got.q_wp, turned.into_inner()) < 1e-11);
    assert!((got.omega_w - q0 * (Vector3::z() * exact.omega)).norm() < 1e-11);
    // One that does not know of the corner finds it by its tolerance.
    let got = advance(find("dop853").unwrap(), &load, &bodies, end, 7);
    let off = angle(got.q_wp, turned.into_inner());
    assert!(off < 1e-9, "{off:e}");
}

#[test]
fn a_controller_about_a_fixed_axis_is_the_linear_oscillator() {
    let (bodies, q0) = about_an_axis(2.0);
    // I φ'' = -k φ - c φ', from φ = -0.5: under-damped, critically damped, over-damped.
    for c in [0.4, 2.4, 5.0] {
        let k = 2.4;
        let target = q0 * axis_angle(Unit::new_unchecked(Vector3::z()), 0.5);
        let value = Value::Table(vec![
            ("orientation", Value::Attitude(target)),
            number("stiffness", k),
            number("damping", c),
        ]);
        let mut load = gyroscopic();
        effect("motor", value, &mut load);
        let (half, phi0, omega0) = (0.5 * c / I, -0.5, 2.0);
        let inside = k / I - half * half;
        // e^{-half t} (φ0 C + (ω0 + half φ0) S), C' = -inside S, S' = C.
        let (cos, sin) = match inside {
            0.0 => (1.0, T),
            x if x > 0.0 => ((x.sqrt() * T).cos(), (x.sqrt() * T).sin() / x.sqrt()),
            x => (
                ((-x).sqrt() * T).cosh(),
                ((-x).sqrt() * T).sinh() / (-x).sqrt(),
            ),
        };
        let decay = (-half * T).exp();
        let lever = omega0 + half * phi0;
        let phi = decay * (phi0 * cos + lever * sin);
        let omega = decay * (-inside * phi0 * sin + lever * cos) - half * phi;
        let exact = Exact {
            turned: phi + 0.5,
            omega,
            way: 5.0 * T,
            speed: 5.0,
        };
        meets(&load, &bodies, q0, T, exact);
    }
}

#[test]
fn a_spring_of_no_length_is_the_harmonic_oscillator_in_every_method_that_takes_it() {
    // x'' = -k x/m about the anchor, from x0 and v0: the place has the order of the method.
    let (k, anchor) = (2.5, v(0.4, -0.3, 0.2));
    let (bodies, _) = about_an_axis(0.0);
    let mut load = Load::default();
    let value = Value::Table(vec![
        ("anchor", Value::Vector(anchor)),
        number("stiffness", k),
    ]);
    effect("spring", value, &mut load);
    let rate = k.sqrt();
    let (sin, cos) = (rate * T).sin_cos();
    let x = anchor - anchor * cos + v(3.0, 0.0, 4.0) * (sin / rate);
    let mut seen = 0;
    for method in fixed_methods(&load, &bodies) {
        shows_its_order(method, "spring", |n| {
            (advance(method, &load, &bodies, T, n).x_w - x).norm()
        });
        seen += 1;
    }
    assert!(seen > 8);
}

#[test]
fn a_limit_that_is_met_holds_the_speed_and_one_that_is_not_changes_no_bit() {
    let (bodies, q0) = about_an_axis(0.5);
    let motor = Value::Table(vec![
        ("axis", Value::Vector(Vector3::z())),
        ("frame", Value::Word("body")),
        number("torque", 1.2),
    ]);
    let load = |limit: Option<f64>| {
        let mut load = gyroscopic();
        effect("motor", motor.clone(), &mut load);
        if let Some(limit) = limit {
            let value = Value::numbers(&[("angular", limit), ("linear", 1e3)]);
            effect("speed_limit", value, &mut load);
        }
        load
    };
    // 2 rad/s²: from ½ to 4 rad/s in 1.75 s, 1,000 steps a second; and 5 rad and more after that.
    let (free, cut, never) = (load(None), load(Some(4.0)), load(Some(100.0)));
    let mut seen = 0;
    for method in fixed_methods(&free, &bodies) {
        let name = method.info().name;
        let end = advance(method, &cut, &bodies, T, 3_000);
        let omega_w = q0 * (Vector3::z() * 4.0);
        // Clamped at the last step, to a rounding of a length; the axis wanders by the methods' own.
        assert!(
            (end.omega_w.norm() - 4.0).abs() < 2e-15,
            "{name}: {}",
            end.omega_w
        );
        assert!(
            (end.omega_w - omega_w).norm() < 1e-9,
            "{name}: {}",
            end.omega_w
        );
        // ½·1.75 + 1.75² and 4·1.25; a step that is clamped turns by up to 2 h² more: 2.5e-3 in all,
        // and by the methods of order 1, h 4 rad/s off by up to a half, 1.8e-3.
        let turned = 0.5 * 1.75 + 1.75 * 1.75 + 4.0 * 1.25;
        let exact = q0 * axis_angle(Unit::new_unchecked(Vector3::z()), turned);
        let off = angle(end.q_wp, exact.into_inner());
        assert!(off < 4.3e-3, "{name}: {off:e}");
        let (a, b) = (
            advance(method, &free, &bodies, T, 300),
            advance(method, &never, &bodies, T, 300),
        );
        assert_eq!(a, b, "{name}");
        seen += 1;
    }
    assert!(seen > 8);
    for method in METHODS.iter().filter(|m| m.info().kind != Kind::Fixed) {
        let why = method.info().refuses(&cut, &bodies.0).unwrap().0;
        assert!(why.contains(method.info().name), "{why}");
        let end = advance(*method, &cut, &bodies, T, 3);
        assert!(!end.is_finite());
    }
}
