//! Each effect's force and torque by hand, on whom it acts, and what it refuses.

use super::*;
use crate::body::{LANES, State};
use crate::math::axis_angle;
use nalgebra::Unit;

fn kind(name: &str) -> &'static EffectKind {
    EFFECTS.iter().find(|kind| kind.name == name).unwrap()
}

fn called(name: &str, value: &Value) -> Result<Called, String> {
    (kind(name).make)(value, 0.01)
}

fn spec(name: &str, value: &Value) -> Arc<dyn Spec> {
    match called(name, value) {
        Ok(Called::Load(spec)) => spec,
        other => panic!("{name}: {other:?}"),
    }
}

/// A body of mass 2 and moments (1, 2, 2.5), its centre of mass at `centre_p` from the reference point.
fn inertial(centre_p: Vector3<f64>) -> Inertial {
    let moments = Vector3::new(1.0, 2.0, 2.5);
    Inertial {
        mass: 2.0,
        inv_mass: 0.5,
        moments,
        inv_moments: moments.map(f64::recip),
        centre_p,
    }
}

/// Turned by 90° about z: principal x points along the world's y.
fn quarter_turned() -> State {
    State {
        x_w: Vector3::new(1.0, -2.0, 0.5),
        v_w: Vector3::new(0.5, 0.0, 0.25),
        q_wp: axis_angle(
            Unit::new_unchecked(Vector3::z()),
            std::f64::consts::FRAC_PI_2,
        )
        .into_inner(),
        omega_w: Vector3::new(1.0, 2.0, -2.0),
    }
}

/// What an effect does to one body, in lane 3 of a block.
fn wrench(spec: &dyn Spec, t: f64, body: Inertial, state: State) -> Wrench {
    let (mut inertials, mut states) = (InertialBlock::default(), StateBlock::default());
    inertials.set(3, body);
    states.set(3, state);
    let mut block = WrenchBlock::default();
    let effect = spec.on(&[Member::plain(3, body)]);
    effect.add(t, &inertials, &states, &mut block);
    for lane in (0..LANES).filter(|&lane| lane != 3) {
        assert_eq!(block.get(lane), Wrench::default(), "{effect:?} {lane}");
    }
    // What it says it is must be what it does.
    if let Some(terms) = effect.terms(&inertials) {
        let mut sum = Wrench::default();
        for term in terms {
            assert_eq!(term.lane(), 3);
            let part = term.wrench(&state);
            sum.force_w += part.force_w;
            sum.tau_w += part.tau_w;
        }
        near(sum.force_w, block.get(3).force_w);
        near(sum.tau_w, block.get(3).tau_w);
    }
    block.get(3)
}

/// A few roundings of numbers of size 10.
#[track_caller]
fn near(got: Vector3<f64>, want: Vector3<f64>) {
    assert!((got - want).amax() < 1e-14, "{got:?} is not {want:?}");
}

fn table(entries: &[(&'static str, Value)]) -> Value {
    Value::Table(entries.to_vec())
}

fn v(x: f64, y: f64, z: f64) -> Vector3<f64> {
    Vector3::new(x, y, z)
}

#[test]
fn motors_by_hand() {
    let (body, s) = (inertial(Vector3::zeros()), quarter_turned());
    let axis = ("axis", Value::Vector(v(0.0, 0.0, -3.0)));
    let motor = |entries: &[(&'static str, Value)]| spec("motor", &table(entries));
    let constant = motor(&[axis.clone(), ("torque", Value::Number(2.0))]);
    near(wrench(&*constant, 7.0, body, s).tau_w, v(0.0, 0.0, -2.0));
    // The body's x is the world's y.
    let own = motor(&[
        ("torque", Value::Vector(v(1.5, 0.0, 0.0))),
        ("frame", Value::Word("body")),
    ]);
    near(wrench(&*own, 7.0, body, s).tau_w, v(0.0, 1.5, 0.0));
    let world = motor(&[
        ("torque", Value::Vector(v(1.5, 0.0, 0.0))),
        ("frame", Value::Word("world")),
    ]);
    near(wrench(&*world, 7.0, body, s).tau_w, v(1.5, 0.0, 0.0));
    // A quarter of a period after a phase of a sixth of a turn: sin(90° + 30°) would be cos 30°.
    let sine = motor(&[
        axis.clone(),
        (
            "sine",
            Value::numbers(&[
                ("amplitude", 4.0),
                ("frequency", 0.5),
                ("phase", std::f64::consts::FRAC_PI_6),
            ]),
        ),
    ]);
    let at = |t: f64| wrench(&*sine, t, body, s).tau_w;
    near(at(0.0), v(0.0, 0.0, -2.0));
    near(at(0.5), v(0.0, 0.0, -4.0 * 0.75_f64.sqrt()));
    let ramp = motor(&[
        axis,
        (
            "ramp",
            Value::numbers(&[("from", 1.0), ("to", 3.0), ("over", 2.0)]),
        ),
    ]);
    for (t, torque) in [(-1.0, 1.0), (0.0, 1.0), (0.5, 1.5), (2.0, 3.0), (9.0, 3.0)] {
        near(wrench(&*ramp, t, body, s).tau_w, v(0.0, 0.0, -torque));
    }
}

#[test]
fn a_motor_turns_to_its_orientation_the_short_way_and_no_harder_than_its_limit() {
    let body = inertial(Vector3::zeros());
    let target = axis_angle(Unit::new_unchecked(Vector3::x()), 0.7);
    let hold = |limit: Option<f64>| {
        let mut entries = vec![
            ("orientation", Value::Attitude(target)),
            ("stiffness", Value::Number(3.0)),
            ("damping", Value::Number(0.5)),
        ];
        entries.extend(limit.map(|limit| ("limit", Value::Number(limit))));
        spec("motor", &table(&entries))
    };
    let off_by = |axis: Vector3<f64>, angle: f64, sign: f64, omega_w: Vector3<f64>| {
        let error = axis_angle(Unit::new_normalize(axis), angle);
        State {
            q_wp: (error * target).into_inner() * sign,
            omega_w,
            ..quarter_turned()
        }
    };
    let rest = Vector3::zeros();
    let axis = v(1.0, 2.0, -2.0);
    for sign in [1.0, -1.0] {
        // Whichever of the two quaternions an attitude has.
        let s = off_by(axis, 0.9, sign, v(0.1, 0.0, -0.4));
        let want = axis / 3.0 * (-3.0 * 0.9) - v(0.05, 0.0, -0.2);
        near(wrench(&*hold(None), 0.0, body, s).tau_w, want);
        // 200° one way is 160° the other.
        let s = off_by(axis, 200.0_f64.to_radians(), sign, rest);
        let want = axis / 3.0 * (3.0 * 160.0_f64.to_radians());
        near(wrench(&*hold(None), 0.0, body, s).tau_w, want);
        // And as the limit has it.
        near(wrench(&*hold(Some(0.6)), 0.0, body, s).tau_w, axis * 0.2);
    }
    // At the target, and so near that its square is no number: no division by nothing.
    for angle in [0.0, 1e-170, 1e-9] {
        let s = off_by(Vector3::y(), angle, 1.0, rest);
        let tau_w = wrench(&*hold(None), 0.0, body, s).tau_w;
        // The attitude itself is a rounding or two off.
        assert!(
            (tau_w + Vector3::y() * (3.0 * angle)).norm() < 2e-15,
            "{tau_w}"
        );
    }
    // Half a turn: some way round, but all of it.
    let tau_w = wrench(
        &*hold(None),
        0.0,
        body,
        off_by(axis, std::f64::consts::PI, 1.0, rest),
    )
    .tau_w;
    assert!((tau_w.norm() - 3.0 * std::f64::consts::PI).abs() < 1e-14);
}

#[test]
fn springs_by_hand() {
    let (body, s) = (inertial(v(0.0, 0.25, 0.0)), quarter_turned());
    let spring = |entries: &[(&'static str, Value)]| {
        let mut all = vec![("anchor", Value::Vector(v(1.0, -2.0, -1.5)))];
        all.extend_from_slice(entries);
        spec("spring", &table(&all))
    };
    let number = |key: &'static str, x: f64| (key, Value::Number(x));
    // The point is 0.5 along the body's x, and a quarter along its y from the reference point: in the
    // world 0.5 along y and -0.25 along x.
    let point = ("point", Value::Point(BodyPoint::At(v(0.5, 0.0, 0.0))));
    let arm = v(-0.25, 0.5, 0.0);
    let d = arm + v(0.0, 0.0, 2.0);
    let velocity = s.v_w + s.omega_w.cross(&arm);
    let got = wrench(
        &*spring(&[
            point.clone(),
            number("stiffness", 4.0),
            number("damping", 0.5),
        ]),
        0.0,
        body,
        s,
    );
    let force = d * -4.0 - velocity * 0.5;
    near(got.force_w, force);
    near(got.tau_w, arm.cross(&force));
    let got = wrench(
        &*spring(&[
            point,
            number("stiffness", 4.0),
            number("damping", 0.5),
            number("rest_length", 3.0),
        ]),
        0.0,
        body,
        s,
    );
    let u = d.normalize();
    // Shorter than it would be: it pushes away.
    let force = u * -(4.0 * (d.norm() - 3.0) + 0.5 * velocity.dot(&u));
    assert!(force.dot(&d) > 0.0);
    near(got.force_w, force);
    near(got.tau_w, arm.cross(&force));
    // At its anchor: nothing that is no number.
    let at = State {
        x_w: v(1.0, -2.0, -1.5),
        ..s
    };
    let free = inertial(Vector3::zeros());
    let still = spring(&[number("stiffness", 4.0), number("rest_length", 1.0)]);
    assert_eq!(wrench(&*still, 0.0, free, at), Wrench::default());
    let linear = spring(&[number("stiffness", 4.0), number("damping", 0.5)]);
    near(wrench(&*linear, 0.0, free, at).force_w, s.v_w * -0.5);
}

#[test]
fn drag_by_hand() {
    let drag = spec(
        "drag",
        &Value::numbers(&[
            ("linear", 0.5),
            ("quadratic", 0.25),
            ("angular_linear", 0.1),
            ("angular_quadratic", 0.2),
        ]),
    );
    let s = quarter_turned();
    let got = wrench(&*drag, 0.0, inertial(Vector3::zeros()), s);
    // |ω| = 3.
    near(got.tau_w, s.omega_w * -(0.1 + 0.2 * 3.0));
    near(got.force_w, s.v_w * -(0.5 + 0.25 * s.v_w.norm()));
    // Held a metre from its centre of mass, which is along the body's y: the world's -x.
    let got = wrench(&*drag, 0.0, inertial(Vector3::y()), s);
    let arm = -Vector3::x();
    let velocity = s.v_w + s.omega_w.cross(&arm);
    let force = velocity * -(0.5 + 0.25 * velocity.norm());
    near(got.force_w, force);
    near(got.tau_w, arm.cross(&force) - s.omega_w * 0.7);
}

#[test]
fn a_planet_by_hand() {
    let planet = |orbit: bool| {
        let entries = [
            ("mu", Value::Number(3.0)),
            ("centre", Value::Vector(v(1.0, -2.0, -1.5))),
            ("orbit", Value::Switch(orbit)),
        ];
        spec("gravity_gradient", &table(&entries))
    };
    // Two metres above the planet along z; tilted by 45° about the body's x (z of the world is (0, 1, 1)/√2).
    let q = axis_angle(
        Unit::new_unchecked(Vector3::x()),
        std::f64::consts::FRAC_PI_4,
    );
    let s = State {
        q_wp: q.into_inner(),
        ..quarter_turned()
    };
    let body = inertial(Vector3::zeros());
    // 3 μ/r³ u × (I u), u = (0, 1, 1)/√2: (I_z - I_y)/2 about x.
    let tau = v(3.0 * 3.0 / 8.0 * 0.25, 0.0, 0.0);
    let got = wrench(&*planet(false), 0.0, body, s);
    near(got.tau_w, tau);
    assert_eq!(got.force_w, Vector3::zeros());
    let got = wrench(&*planet(true), 0.0, body, s);
    near(got.tau_w, tau);
    // u·I u = 2.25, tr I = 5.5; I u = (0, 2, 2.5)/√2 in the body, which is (0, -¼, 2¼) in the world.
    let shape = v(0.0, -0.25, 2.25 + 0.5 * (5.5 - 5.0 * 2.25));
    near(
        got.force_w,
        v(0.0, 0.0, -3.0 * 2.0 / 4.0) - shape * (3.0 * 3.0 / 16.0),
    );
    // A sphere of infinite mass is not pulled.
    let nothing = InertialBlock::default().get(0);
    assert_eq!(wrench(&*planet(true), 0.0, nothing, s), Wrench::default());
}

#[test]
fn on_some_lanes_an_effect_adds_to_those_alone_and_the_same_bits_as_on_all() {
    let (mut inertials, mut states) = (InertialBlock::default(), StateBlock::default());
    for lane in 0..LANES {
        inertials.set(lane, inertial(v(0.1, 0.2, 0.3) * lane as f64));
        states.set(
            lane,
            State {
                omega_w: v(1.0, 0.3 * lane as f64, -2.0),
                ..quarter_turned()
            },
        );
    }
    let specs = [
        spec("gravity", &Value::Vector(v(0.1, -9.81, 0.3))),
        spec(
            "drag",
            &Value::numbers(&[("quadratic", 0.3), ("angular_linear", 0.1)]),
        ),
        spec("gravity_gradient", &Value::numbers(&[("mu", 2.0)])),
        spec(
            "motor",
            &table(&[("torque", Value::Vector(v(1.0, 0.3, 0.2)))]),
        ),
        spec(
            "spring",
            &table(&[
                ("anchor", Value::Vector(v(1.0, 0.3, 0.2))),
                ("stiffness", Value::Number(2.0)),
            ]),
        ),
    ];
    for spec in specs {
        let member = |lane: usize| Member::plain(lane, inertials.get(lane));
        let of = |lanes: &[usize]| {
            let members: Vec<Member<'_>> = lanes.iter().map(|&lane| member(lane)).collect();
            let effect = spec.on(&members);
            let mut wrench = WrenchBlock::default();
            effect.add(0.5, &inertials, &states, &mut wrench);
            wrench
        };
        let (some, all) = (of(&[0, 2, 7]), of(&[0, 1, 2, 3, 4, 5, 6, 7]));
        for lane in 0..LANES {
            let want = match [0, 2, 7].contains(&lane) {
                true => all.get(lane),
                false => Wrench::default(),
            };
            assert_eq!(some.get(lane), want, "{spec:?} {lane}");
        }
    }
}

#[test]
fn what_is_written_as_nothing_is_off() {
    let zero = Value::Number(0.0);
    let axis = ("axis", Value::Vector(Vector3::x()));
    let off = [
        ("gravity", Value::Vector(Vector3::zeros())),
        ("damping", table(&[])),
        ("gyroscopic", Value::Switch(false)),
        ("drag", Value::numbers(&[("linear", 0.0)])),
        ("gravity_gradient", Value::numbers(&[("mu", 0.0)])),
        ("speed_limit", table(&[])),
        ("motor", table(&[axis.clone(), ("torque", zero.clone())])),
        (
            "motor",
            table(&[
                axis.clone(),
                (
                    "sine",
                    Value::numbers(&[("amplitude", 0.0), ("frequency", 1.0)]),
                ),
            ]),
        ),
        (
            "motor",
            table(&[
                axis,
                ("ramp", Value::numbers(&[("to", 0.0), ("over", 1.0)])),
            ]),
        ),
        (
            "motor",
            table(&[
                ("orientation", Value::Attitude(UnitQuaternion::identity())),
                ("stiffness", zero.clone()),
            ]),
        ),
        (
            "spring",
            table(&[("anchor", Value::Vector(Vector3::x())), ("stiffness", zero)]),
        ),
    ];
    for (name, value) in off {
        let called = called(name, &value);
        assert!(
            matches!(called, Ok(Called::Off)),
            "{name} {value:?}: {called:?}"
        );
    }
}

#[test]
fn what_says_too_much_too_little_or_the_wrong_thing_is_refused_with_the_remedy() {
    let axis = || ("axis", Value::Vector(Vector3::x()));
    let torque = || ("torque", Value::Number(1.0));
    let ramp = |over: f64| ("ramp", Value::numbers(&[("to", 1.0), ("over", over)]));
    let target = || ("orientation", Value::Attitude(UnitQuaternion::identity()));
    let number = |key, x| (key, Value::Number(x));
    let wrong = [
        ("motor", table(&[]), "neither torque, sine or ramp"),
        ("motor", table(&[torque()]), "lacks its axis"),
        ("motor", table(&[axis()]), "neither torque"),
        ("motor", table(&[axis(), torque(), ramp(1.0)]), "keep one"),
        ("motor", table(&[axis(), ramp(0.0)]), "a time above 0"),
        (
            "motor",
            table(&[axis(), ("ramp", table(&[]))]),
            "ramp takes",
        ),
        (
            "motor",
            table(&[axis(), ("sine", table(&[]))]),
            "sine takes",
        ),
        (
            "motor",
            table(&[("axis", Value::Vector(Vector3::zeros())), torque()]),
            "no length",
        ),
        (
            "motor",
            table(&[axis(), ("torque", Value::Vector(Vector3::x()))]),
            "has its own axis",
        ),
        (
            "motor",
            table(&[axis(), torque(), number("limit", 1.0)]),
            "limit says nothing",
        ),
        ("motor", table(&[target()]), "lacks stiffness"),
        (
            "motor",
            table(&[target(), number("stiffness", -1.0)]),
            "below 0",
        ),
        (
            "motor",
            table(&[target(), number("stiffness", 1.0), number("limit", 0.0)]),
            "leaves no torque",
        ),
        (
            "motor",
            table(&[target(), number("stiffness", 1.0), axis()]),
            "axis says nothing",
        ),
        ("spring", table(&[number("stiffness", 1.0)]), "lacks anchor"),
        (
            "spring",
            table(&[("anchor", Value::Vector(Vector3::x()))]),
            "neither stiffness",
        ),
        (
            "spring",
            table(&[
                ("anchor", Value::Vector(Vector3::x())),
                number("rest_length", -1.0),
            ]),
            "below 0",
        ),
        ("drag", Value::numbers(&[("quadratic", -1.0)]), "below 0"),
        ("gravity_gradient", table(&[]), "lacks mu"),
        (
            "gravity_gradient",
            Value::numbers(&[("mu", -1.0)]),
            "push away",
        ),
        (
            "speed_limit",
            Value::numbers(&[("angular", 0.0)]),
            "let nothing move",
        ),
    ];
    for (name, value, why) in wrong {
        match called(name, &value) {
            Err(error) => assert!(error.contains(why), "{name} {value:?}: {error}"),
            other => panic!("{name} {value:?}: {other:?}"),
        }
    }
}

#[test]
fn a_limit_cuts_lengths_and_nothing_else() {
    let limit =
        |entries: &[(&'static str, f64)]| match called("speed_limit", &Value::numbers(entries)) {
            Ok(Called::Limit(limit)) => limit,
            other => panic!("{other:?}"),
        };
    let s = quarter_turned();
    let both = limit(&[("angular", 1.5), ("linear", 0.1)])
        .clamped(&s)
        .unwrap();
    // |ω| = 3.
    near(both.omega_w, s.omega_w * 0.5);
    near(both.v_w, s.v_w.normalize() * 0.1);
    assert_eq!((both.x_w, both.q_wp), (s.x_w, s.q_wp));
    assert_eq!(limit(&[("angular", 3.0)]).clamped(&s), None);
    let lower = limit(&[("angular", 2.0)]).and(limit(&[("angular", 1.5), ("linear", 0.1)]));
    assert_eq!(lower.clamped(&s), Some(both));
    // What is no number is not hidden.
    let lost = State {
        omega_w: v(f64::NAN, 0.0, 0.0),
        ..s
    };
    assert_eq!(limit(&[("angular", 2.0)]).clamped(&lost), None);
}

#[test]
fn two_dampings_are_the_sum_of_their_rates_and_the_product_of_their_factors() {
    let decay = |entries: &[(&'static str, f64)]| match called("damping", &Value::numbers(entries))
    {
        Ok(Called::Decay(decay)) => decay,
        other => panic!("{other:?}"),
    };
    let rates = decay(&[("angular", 0.5)]).and(decay(&[("angular", 0.25), ("linear", 1.0)]));
    assert_eq!((rates.angular_rate(), rates.linear_rate()), (0.75, 1.0));
    let factors = decay(&[("angular_factor", 0.5)]).and(decay(&[("angular_factor", 0.25)]));
    // By the factors as written, at the step they are meant for; else to a rounding.
    assert_eq!(factors.angular_factor(0.01), 0.125);
    assert!((factors.angular_factor(0.02) - 0.125 * 0.125).abs() < 1e-16);
    let mixed = decay(&[("angular_factor", 0.5)]).and(decay(&[("linear", 1.0)]));
    assert_eq!(mixed.angular_factor(0.01), 0.5);
    assert!(mixed.is_per_step());
    // Half and half as much again.
    let both = decay(&[("angular_factor", 0.5)]).and(decay(&[("angular", 100.0)]));
    let want = 0.5 * libm::exp(-1.0);
    assert!((both.angular_factor(0.01) / want - 1.0).abs() < 1e-15);
}

#[test]
fn what_effects_depend_on_is_what_they_say() {
    let block = InertialBlock::default();
    let depends = |spec: Arc<dyn Spec>, body: Inertial| {
        let mut block = block;
        block.set(0, body);
        spec.on(&[Member::plain(0, body)]).depends(&block)
    };
    let (free, held) = (inertial(Vector3::zeros()), inertial(Vector3::x()));
    let is = |torque, time, place, velocity| Depends {
        torque,
        time,
        place,
        velocity,
    };
    let axis = || ("axis", Value::Vector(Vector3::x()));
    let sine = (
        "sine",
        Value::numbers(&[("amplitude", 1.0), ("frequency", 1.0)]),
    );
    let own = ("frame", Value::Word("body"));
    let anchor = ("anchor", Value::Vector(Vector3::x()));
    let number = |key, x| (key, Value::Number(x));
    let target = ("orientation", Value::Attitude(UnitQuaternion::identity()));
    let motor = |entries: &[(&'static str, Value)]| spec("motor", &table(entries));
    let cases = [
        (
            motor(&[axis(), number("torque", 1.0)]),
            free,
            is(true, false, false, false),
        ),
        (
            motor(&[axis(), number("torque", 1.0), own.clone()]),
            free,
            is(true, false, true, false),
        ),
        (
            motor(&[axis(), sine.clone()]),
            free,
            is(true, true, false, false),
        ),
        (
            motor(&[axis(), sine, own]),
            free,
            is(true, true, true, false),
        ),
        (
            motor(&[target.clone(), number("stiffness", 1.0)]),
            free,
            is(true, false, true, false),
        ),
        (
            motor(&[target, number("stiffness", 0.0), number("damping", 1.0)]),
            free,
            is(true, false, false, true),
        ),
        (
            spec(
                "spring",
                &table(&[anchor.clone(), number("stiffness", 1.0)]),
            ),
            free,
            is(false, false, true, false),
        ),
        (
            spec(
                "spring",
                &table(&[anchor, number("stiffness", 1.0), number("damping", 1.0)]),
            ),
            held,
            is(true, false, true, true),
        ),
        (
            spec("drag", &Value::numbers(&[("linear", 1.0)])),
            free,
            is(false, false, false, true),
        ),
        (
            spec("drag", &Value::numbers(&[("linear", 1.0)])),
            held,
            is(true, false, true, true),
        ),
        (
            spec("drag", &Value::numbers(&[("angular_linear", 1.0)])),
            free,
            is(true, false, false, true),
        ),
        (
            spec("gravity_gradient", &Value::numbers(&[("mu", 1.0)])),
            free,
            is(true, false, true, false),
        ),
    ];
    for (spec, body, want) in cases {
        let text = format!("{spec:?}");
        assert_eq!(depends(spec, body), want, "{text}");
    }
}

#[test]
fn a_load_tells_what_each_effect_does_by_name() {
    let (mut inertials, mut states) = (InertialBlock::default(), StateBlock::default());
    inertials.set(0, inertial(Vector3::x()));
    states.set(0, quarter_turned());
    let member = Member::plain(0, inertials.get(0));
    let mut load = Load::default();
    let gravity = called("gravity", &Value::Vector(v(0.0, -9.81, 0.0))).unwrap();
    let wheel = called(
        "motor",
        &table(&[("torque", Value::Vector(v(0.0, 0.0, 1.0)))]),
    )
    .unwrap();
    load.call(&"gravity".into(), &gravity, &[member]);
    load.call(&"wheel".into(), &wheel, &[member]);
    load.call(&"gyroscopic".into(), &Called::Gyroscopic, &[member]);
    assert_eq!(load.names(), ["gyroscopic", "gravity", "wheel"]);
    let mut sum = Vector3::zeros();
    for (name, effect) in load.effects() {
        let mut wrench = WrenchBlock::default();
        effect.add(0.0, &inertials, &states, &mut wrench);
        if name == "wheel" {
            assert_eq!(wrench.get(0).tau_w, v(0.0, 0.0, 1.0));
        }
        sum += wrench.get(0).tau_w;
    }
    let total = load.wrench(0.0, &inertials, &states).unwrap().get(0).tau_w;
    assert_eq!(sum, total);
}
