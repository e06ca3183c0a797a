//! What every method with steps of its own must do: error follows the tolerance, instants in a step are
//! as good as its end, nothing depends on the clock, and what cannot be followed ends.

use crate::body::{Inertial, InertialBlock, LaneSet, State, StateBlock};
use crate::effect::{Couple, Effect, Frame, Load, Push, Value, WrenchBlock};
use crate::exact::FreeMotion;
use crate::integrator::tests::{angle, block, damped, effect, gyroscopic, slope, spinning};
use crate::integrator::{Interval, Kind, METHODS, Method, Step};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use std::sync::Arc;

type Bodies = (InertialBlock, StateBlock);

fn methods() -> impl Iterator<Item = &'static dyn Method> {
    let all = METHODS.iter().copied();
    all.filter(|method| method.info().kind == Kind::Adaptive)
}

/// The methods that take this load.
fn methods_for(load: &Load, bodies: &Bodies) -> impl Iterator<Item = &'static dyn Method> {
    methods().filter(move |method| method.info().refuses(load, &bodies.0).is_none())
}

fn interval(load: &Load, bodies: &Bodies, until: f64, tolerance: f64) -> Interval {
    Interval {
        load: load.clone(),
        inertial: bodies.0,
        bodies: 1,
        until,
        tolerance,
    }
}

/// A clock of `n` steps to `t`, all kept.
fn clock(t: f64, n: u32) -> Vec<Step> {
    let instant = |k: u32| t * (f64::from(k) / f64::from(n));
    let step = |k: u32| Step {
        from: instant(k),
        h: t / f64::from(n),
        to: instant(k + 1),
        keep: true,
    };
    (0..n).map(step).collect()
}

fn end(method: &dyn Method, load: &Load, bodies: &Bodies, t: f64, tolerance: f64) -> State {
    let interval = interval(load, bodies, t, tolerance);
    let mut stepper = method.start(interval, 0.0, &bodies.1);
    stepper.advance(&clock(t, 1), &mut Vec::new());
    stepper.state().get(0)
}

/// A body of any moments, also ones that no distribution of mass has.
fn euler_body(moments: Vector3<f64>, state: State) -> Bodies {
    let mut bodies = block(Vector3::repeat(1.0), state);
    let inertial = Inertial {
        moments,
        inv_moments: moments.map(|i| 1.0 / i),
        ..bodies.0.get(0)
    };
    bodies.0.set(0, inertial);
    bodies
}

/// A heavy top on a pivot at the origin, gravity 1 along -z, mass 1.
fn top(
    moments: [f64; 3],
    centre: [f64; 3],
    q0: Quaternion<f64>,
    omega: [f64; 3],
) -> (Load, Bodies) {
    let (mut bodies, mut load) = (euler_body(moments.into(), rest()), gyroscopic());
    let pivoted = Inertial {
        inv_mass: 0.0,
        centre_p: centre.into(),
        ..bodies.0.get(0)
    };
    bodies.0.set(0, pivoted);
    let mut state = State {
        q_wp: q0.normalize(),
        ..rest()
    };
    state.omega_w = state.to_world(omega.into());
    bodies.1.set(0, state);
    effect(
        "gravity",
        Value::Vector(Vector3::new(0.0, 0.0, -1.0)),
        &mut load,
    );
    (load, bodies)
}

fn rest() -> State {
    spinning(UnitQuaternion::identity(), Vector3::zeros())
}

/// Its attitude at t = 100 in 20 digits (mpmath, Taylor integration in 60 digits).
fn asymmetric_top() -> (Load, Bodies, Quaternion<f64>) {
    let q0 = Quaternion::new(0.86_f64.sqrt(), 0.1, 0.3, -0.2);
    let (load, bodies) = top([1.0, 1.6, 2.1], [0.3, 0.2, 1.0], q0, [0.5, -0.8, 2.0]);
    let end = Quaternion::new(
        -0.071_524_906_424_772_6,
        -0.051_812_189_728_397_31,
        -0.229_010_135_522_556_63,
        -0.969_409_120_332_801_6,
    );
    (load, bodies, end)
}

/// I = (2, 1, 2/3), L = (cos 1.1, 0, sin 1.1), at t = 100.
fn long_free() -> (Load, Bodies, Quaternion<f64>) {
    let inertia = Vector3::new(2.0, 1.0, 2.0 / 3.0);
    let momentum = Vector3::new(1.1_f64.cos(), 0.0, 1.1_f64.sin());
    let omega = momentum.component_div(&inertia);
    let bodies = euler_body(inertia, spinning(UnitQuaternion::identity(), omega));
    let end = Quaternion::new(
        0.887_094_310_264_289_1,
        -0.261_678_695_032_792_3,
        0.225_839_107_427_755_07,
        0.305_916_071_527_624_96,
    );
    (gyroscopic(), bodies, end)
}

#[test]
fn error_follows_the_tolerance() {
    for (what, (load, bodies, exact)) in [("top", asymmetric_top()), ("free", long_free())] {
        for method in methods_for(&load, &bodies) {
            let mut points = Vec::new();
            for power in 6..=15 {
                let tolerance = 10.0_f64.powi(-power);
                let end = end(method, &load, &bodies, 100.0, tolerance);
                let error = angle(end.q_wp, exact);
                // Some two to six steps a second err by up to the tolerance each, an error of ω
                // turns on for the rest of the time; and roundings of 200 rad, likewise.
                let bound = 10.0 * tolerance * 100.0 + 5e-13;
                let name = method.info().name;
                assert!(error < bound, "{name} {what} {tolerance:e}: {error:e}");
                if power <= 12 {
                    points.push((tolerance, error));
                }
            }
            // Proportional, but for the phase that an error happens to have at the end.
            let slope = slope(&points);
            let name = method.info().name;
            assert!(
                (0.85..1.25).contains(&slope),
                "{name} {what}: slope {slope}: {points:?}"
            );
        }
    }
}

#[test]
fn detest_b5() {
    // y' = (y2 y3, -y1 y3, -0.51 y1 y2), y(0) = (0, 1, 1), at t = 20: Euler's equations of
    // I = (2, 3, 1) with y = s ω, s3 = 1/√3, s2 = 1/√0.51, s1 = s2 s3. Digits from mpmath.
    let (s2, s3) = (1.0 / 0.51_f64.sqrt(), 1.0 / 3.0_f64.sqrt());
    let scale = Vector3::new(s2 * s3, s2, s3);
    let omega = Vector3::new(0.0, 1.0, 1.0).component_div(&scale);
    let bodies = block(
        Vector3::new(2.0, 3.0, 1.0),
        spinning(UnitQuaternion::identity(), omega),
    );
    let exact = Vector3::new(
        -0.939_657_079_872_920_4,
        -0.342_117_775_400_074_93,
        0.741_412_659_619_995_3,
    );
    for method in METHODS.iter().filter(|m| m.info().kind != Kind::Fixed) {
        let end = end(*method, &gyroscopic(), &bodies, 20.0, 1e-15);
        let y = end.to_principal(end.omega_w).component_mul(&scale);
        // Roundings of ω at the start alone shift the phase by 20 · 2e-16 · some units.
        assert!((y - exact).amax() < 3e-14, "{}: {y}", method.info().name);
    }
}

#[test]
fn the_kovalevskaya_top() {
    let (load, bodies) = top(
        [2.0, 2.0, 1.0],
        [1.0, 0.0, 0.0],
        Quaternion::new(0.9, 0.1, 0.2, 0.3),
        [0.5, -0.4, 1.2],
    );
    let exact = Vector3::new(
        0.027_482_343_162_850_168,
        -2.090_334_845_874_25,
        0.120_449_628_615_289_1,
    );
    for method in methods_for(&load, &bodies) {
        let end = end(method, &load, &bodies, 10.0, 1e-15);
        let momentum_p = Vector3::new(2.0, 2.0, 1.0).component_mul(&end.to_principal(end.omega_w));
        assert!(
            (momentum_p - exact).amax() < 5e-14,
            "{}: {momentum_p}",
            method.info().name
        );
    }
}

#[test]
fn instants_in_a_step_are_as_good_as_its_end() {
    let (load, bodies, _) = long_free();
    let (body, start) = (bodies.0.get(0), bodies.1.get(0));
    let motion = FreeMotion::new(body.moments, start.q_wp, start.to_principal(start.omega_w));
    for method in methods() {
        for tolerance in [1e-6, 1e-9, 1e-12] {
            let interval = interval(&load, &bodies, 50.0, tolerance);
            let mut stepper = method.start(interval, 0.0, &bodies.1);
            let (steps, mut kept) = (clock(50.0, 1_777), Vec::new());
            stepper.advance(&steps, &mut kept);
            let error = |k: usize| angle(kept[k].get(0).q_wp, motion.attitude(steps[k].to));
            // The error grows with time, so its envelope so far is what a step's end has; a
            // polynomial's own error is a step's, a small part of that after a few steps.
            let worst = (0..kept.len()).map(error).fold(0.0, f64::max);
            let last = (kept.len() - 200..kept.len())
                .map(error)
                .fold(0.0, f64::max);
            assert!(worst <= last * 1.5, "{}: {worst:e}", method.info().name);
            assert!(worst < 50.0 * 100.0 * tolerance, "{worst:e}");
            for block in &kept {
                assert!((block.get(0).q_wp.norm() - 1.0).abs() < 5e-16);
            }
        }
    }
}

#[test]
fn nothing_depends_on_how_the_clock_cuts_the_time() {
    let (mut load, bodies, _) = asymmetric_top();
    for decaying in [false, true] {
        if decaying {
            effect(
                "damping",
                Value::numbers(&[("linear", 0.1), ("angular", 0.2)]),
                &mut load,
            );
        }
        for method in methods_for(&load, &bodies) {
            let run = |cuts: usize, n: u32| {
                let interval = interval(&load, &bodies, 10.0, 1e-10);
                let mut stepper = method.start(interval, 0.0, &bodies.1);
                let (steps, mut kept) = (clock(10.0, n), Vec::new());
                for piece in steps.chunks(cuts) {
                    stepper = stepper.boxed_clone();
                    stepper.advance(piece, &mut kept);
                }
                (kept, stepper.state().get(0), stepper.work())
            };
            let (all, end, work) = run(1_000, 1_000);
            let (pieces, piecewise, pieces_work) = run(7, 1_000);
            assert_eq!(end, piecewise);
            assert_eq!(work.steps, pieces_work.steps);
            for (a, b) in all.iter().zip(&pieces) {
                assert_eq!(a.get(0), b.get(0));
            }
            // Twice as coarse a clock: the same polynomials at every other instant.
            let (coarse, end_of_coarse, _) = run(500, 500);
            assert_eq!(end, end_of_coarse);
            for (a, b) in all.iter().skip(1).step_by(2).zip(&coarse) {
                assert_eq!(a.get(0), b.get(0));
            }
        }
    }
}

/// Grows without bound in a finite time: v' = v³ along x.
#[derive(Debug)]
struct Runaway;

impl Effect for Runaway {
    fn name(&self) -> &'static str {
        "runaway"
    }

    fn lanes(&self) -> LaneSet {
        LaneSet::ALL
    }

    fn add(&self, _: f64, _: &InertialBlock, state: &StateBlock, wrench: &mut WrenchBlock) {
        let v = state.get(0).v_w;
        wrench.add(0, v * v.norm_squared(), Vector3::zeros());
    }
}

#[test]
fn what_cannot_be_followed_ends_as_not_a_number() {
    // v = (1 - 2t)^(-1/2): at t = ½ there is no more.
    let state = State {
        v_w: Vector3::x(),
        ..rest()
    };
    let bodies = block(Vector3::repeat(1.0), state);
    let mut load = Load::default();
    load.push(Arc::new(Runaway));
    for method in methods_for(&load, &bodies) {
        let interval = interval(&load, &bodies, 1.0, 1e-9);
        let mut stepper = method.start(interval, 0.0, &bodies.1);
        let mut kept = Vec::new();
        stepper.advance(&clock(1.0, 10), &mut kept);
        // v to 1e-9 relative at t = 0.4, where an error has grown as (1 - 2t)^(-3/2) = 11.
        let v = kept[3].get(0).v_w.x;
        assert!((v / 0.2_f64.powf(-0.5) - 1.0).abs() < 1e-7, "{v}");
        assert!(!stepper.state().get(0).is_finite());
        assert!(!kept[5].get(0).is_finite());
    }
}

#[test]
fn states_that_are_no_numbers_and_numbers_too_large_end_too() {
    let torque = |size: f64| {
        let mut load = gyroscopic();
        load.push(Arc::new(Couple {
            lane: 0,
            torque: Frame::World(Vector3::new(size, 0.0, 0.0)),
        }) as Arc<dyn Effect>);
        load
    };
    let spin = |size: f64| spinning(UnitQuaternion::identity(), Vector3::new(size, size, 0.1));
    for (size, turn) in [(f64::NAN, 1.0), (1e300, 1.0), (1.0, f64::NAN), (1.0, 1e200)] {
        let (load, bodies) = (torque(size), block(Vector3::new(1.0, 2.0, 3.0), spin(turn)));
        for method in methods_for(&load, &bodies) {
            // A second of 1e200 rad: too many steps, or steps too short.
            let end = end(method, &load, &bodies, 1.0, 1e-6);
            assert!(!end.is_finite(), "{} {size} {turn}", method.info().name);
        }
    }
}

#[test]
fn a_load_that_was_refused_is_not_left_out_in_silence() {
    let bodies = block(Vector3::repeat(1.0), rest());
    let mut load = Load::default();
    load.push(Arc::new(Runaway));
    let refusing = METHODS.iter().filter(|method| {
        let info = method.info();
        info.kind != Kind::Fixed && info.refuses(&load, &bodies.0).is_some()
    });
    for method in refusing {
        let end = end(*method, &load, &bodies, 1.0, 1e-9);
        assert!(!end.is_finite(), "{}", method.info().name);
    }
}

#[test]
fn a_body_at_rest_stays_so_in_one_step() {
    let bodies = block(Vector3::new(1.0, 2.0, 3.0), rest());
    let load = gyroscopic();
    for method in methods() {
        let mut stepper = method.start(interval(&load, &bodies, 1e6, 1e-9), 0.0, &bodies.1);
        stepper.advance(&clock(1e6, 3), &mut Vec::new());
        assert_eq!(stepper.state().get(0), rest());
        assert!(stepper.work().steps < 20, "{}", method.info().name);
    }
}

#[test]
fn decay_alone_is_followed_at_any_rate() {
    let omega = Vector3::new(1.0, -2.0, 0.5);
    let state = State {
        v_w: Vector3::new(3.0, 1.0, -2.0),
        ..spinning(UnitQuaternion::identity(), omega)
    };
    for rate in [1e-3_f64, 1.0, 100.0] {
        for load in [damped(rate), {
            let mut load = damped(rate);
            load.set_gyroscopic();
            load
        }] {
            let bodies = block(Vector3::repeat(0.4), state);
            for method in methods() {
                let end = end(method, &load, &bodies, 1.0, 1e-12);
                let left = libm::exp(-rate);
                // Relative to what it was a step before, and so to what is left.
                let off = (end.omega_w - omega * left).norm() / (omega.norm() * left);
                assert!(
                    off < 1e-10 * (1.0 + rate),
                    "{}: {off:e}",
                    method.info().name
                );
                let off = (end.v_w - state.v_w * left).norm() / (state.v_w.norm() * left);
                assert!(
                    off < 1e-10 * (1.0 + rate),
                    "{}: {off:e}",
                    method.info().name
                );
                // |ω| (1 - e^{-ct})/c rad about ω.
                let turned = omega.norm() * -libm::expm1(-rate) / rate;
                let axis = omega.normalize() * (0.5 * turned).sin();
                let exact = Quaternion::from_parts((0.5 * turned).cos(), axis);
                assert!(angle(end.q_wp, exact) < 1e-10, "{}", method.info().name);
            }
        }
    }
}

#[test]
fn a_push_at_a_point_of_the_world_or_of_the_body_is_what_a_second_method_makes_of_it() {
    // Every kind of term at once and by itself, on a body that moves, turns and is damped or not:
    // the methods against each other and against rk4 by tiny steps.
    let inertia = Vector3::new(1.0, 1.6, 2.1);
    let state = State {
        x_w: Vector3::new(0.3, -0.4, 0.2),
        v_w: Vector3::new(0.5, 0.1, -0.3),
        ..spinning(UnitQuaternion::identity(), Vector3::new(0.5, -0.8, 2.0))
    };
    let bodies = block(inertia, state);
    let (f, g) = (Vector3::new(0.7, -0.2, 0.4), Vector3::new(-0.3, 0.5, 0.1));
    let (p, r) = (Vector3::new(0.2, 0.6, -0.5), Vector3::new(1.1, 0.3, 0.4));
    let push = |force, point| {
        Arc::new(Push {
            lane: 0,
            force,
            point,
        }) as Arc<dyn Effect>
    };
    let couple = |torque| Arc::new(Couple { lane: 0, torque }) as Arc<dyn Effect>;
    let cases: Vec<Vec<Arc<dyn Effect>>> = vec![
        vec![push(Frame::World(f), Frame::Principal(p))],
        vec![push(Frame::Principal(f), Frame::Principal(p))],
        vec![push(Frame::World(f), Frame::World(r))],
        vec![push(Frame::Principal(f), Frame::World(r))],
        vec![couple(Frame::World(f))],
        vec![couple(Frame::Principal(f))],
        vec![
            push(Frame::World(f), Frame::World(r)),
            push(Frame::World(g), Frame::Principal(p)),
            push(Frame::Principal(g), Frame::World(p)),
            push(Frame::Principal(f), Frame::Principal(r)),
            couple(Frame::World(g)),
            couple(Frame::Principal(f)),
        ],
    ];
    let rk4 = crate::integrator::find("rk4").unwrap();
    for (case, effects) in cases.iter().enumerate() {
        for (gyroscopic, decaying) in [(true, false), (true, true), (false, false), (false, true)] {
            let mut load = if decaying {
                damped(0.3)
            } else {
                Load::default()
            };
            if gyroscopic {
                load.set_gyroscopic();
            }
            effects.iter().for_each(|e| load.push(Arc::clone(e)));
            let t = 3.0;
            let mut stepper = rk4.start(interval(&load, &bodies, t, 0.0), 0.0, &bodies.1);
            stepper.advance(&clock(t, 6_000), &mut Vec::new());
            let reference = stepper.state().get(0);
            for method in methods_for(&load, &bodies) {
                let end = end(method, &load, &bodies, t, 1e-13);
                let name = method.info().name;
                let what = format!("{name} case {case} {gyroscopic} {decaying}");
                // rk4 errs by some (ω h)⁴/100 = 1e-14 a radian and by 6,000 roundings.
                assert!((end.x_w - reference.x_w).amax() < 3e-12, "{what}: x");
                assert!((end.v_w - reference.v_w).amax() < 3e-12, "{what}: v");
                assert!(
                    (end.omega_w - reference.omega_w).amax() < 1e-11,
                    "{what}: ω"
                );
                assert!(angle(end.q_wp, reference.q_wp) < 1e-11, "{what}: q");
            }
        }
    }
}

/// A body at rest at the origin that is pushed: what starts at zero has no size to be relative to.
#[test]
fn a_body_at_rest_can_be_pushed_at_the_tightest_tolerance() {
    let force_w = Vector3::new(1.0, 2.0, -3.0);
    let mut load = gyroscopic();
    load.push(Arc::new(Push {
        lane: 0,
        force: Frame::World(force_w),
        point: Frame::Principal(Vector3::new(0.2, 0.5, -0.4)),
    }) as Arc<dyn Effect>);
    // At rest, and next to it.
    for spin in [0.0, 1e-300, 1e-160] {
        let start = State {
            omega_w: Vector3::new(spin, 2.0 * spin, spin),
            ..rest()
        };
        pushed_from(block(Vector3::new(0.5, 0.8, 1.1), start), &load, force_w);
    }
}

#[track_caller]
fn pushed_from(bodies: Bodies, load: &Load, force_w: Vector3<f64>) {
    for method in methods_for(load, &bodies) {
        for tolerance in [1e-9, 1e-12, 1e-15, 1.2e-16] {
            let end = end(method, load, &bodies, 1.0, tolerance);
            // The force keeps its direction and the mass is 1: x = F t²/2, to roundings of a few
            // steps or to the tolerance.
            let gap = (end.x_w - force_w * 0.5).norm();
            assert!(gap < 1e-14 + tolerance, "{}: {gap:e}", method.info().name);
        }
    }
}
