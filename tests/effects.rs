//! Effects as scenes have them: on some bodies, off and absent, refused with the reason, planned; and a
//! satellite in the gravity gradient.

mod common;

use common::Nowhere;
use nalgebra::Vector3;
use std::fmt::Write as _;
use std::ops::Range;
use torquescope::cost::{Plan, Race};
use torquescope::integrator::find;
use torquescope::scene::{Scene, Stepping};
use torquescope::sim::{Outcome, Simulation};
use torquescope::trace::{Instant, Motion, Note, Sample, Sink, SinkError, Track};

fn scene(source: &str) -> Scene {
    Scene::parse("inline", "inline", source).unwrap_or_else(|error| panic!("{error}"))
}

fn end(source: &str) -> Vec<Sample> {
    let scene = scene(source);
    let (outcome, done): (Outcome, _) = Simulation::new(&scene).run(&mut Nowhere);
    done.unwrap_or_else(|error| panic!("{error}"));
    outcome.end
}

#[track_caller]
fn wrong(source: &str, parts: &[&str]) {
    let error = match Scene::parse("inline", "inline", source) {
        Ok(_) => panic!("{source} was taken"),
        Err(error) => error.to_string(),
    };
    for part in parts {
        assert!(error.contains(part), "{error}\nlacks {part}");
    }
}

/// A brick of that name, spinning and flying, with more keys.
fn brick(name: &str, more: &str) -> String {
    format!(
        r#"
        [[body]]
        name = "{name}"
        shape = {{ cuboid = {{ x = 1.0, y = 0.5, z = 0.2 }} }}
        mass = 2.0
        position = [0.3, 0.1, -0.2]
        velocity = [1.0, 0.5, -0.25]
        angular_velocity = [0.3, 2.0, -0.1]
        {more}
        "#
    )
}

/// Every effect on body `a` alone, by its short text.
const EFFECTS: [(&str, &str); 10] = [
    ("gravity", "gravity = [0.0, -9.81, 0.0]"),
    ("damping", "damping = { angular = 0.3, linear = 0.1 }"),
    ("gyroscopic", "gyroscopic = true"),
    (
        "motor",
        "motor = { axis = [1, 0, 0], sine = { amplitude = 0.5, frequency = 2.0 }, frame = \"body\" }",
    ),
    (
        "motor",
        "motor = { orientation = { axis = [0, 1, 0], degrees = 40 }, stiffness = 3.0, damping = 0.1, limit = 1.0 }",
    ),
    (
        "motor",
        "motor = { axis = [0, 1, 0], ramp = { to = 0.5, over = 0.3141 } }",
    ),
    (
        "spring",
        "spring = { anchor = [0, 1, 0], point = [0.5, 0, 0], stiffness = 4.0, damping = 0.1 }",
    ),
    ("drag", "drag = { quadratic = 0.4, angular_linear = 0.1 }"),
    (
        "gravity_gradient",
        "gravity_gradient = { mu = 2.0, orbit = true, centre = [3, 0, 0] }",
    ),
    ("speed_limit", "speed_limit = { angular = 1.0 }"),
];

#[test]
fn an_effect_on_some_bodies_is_absent_from_the_others_bit_for_bit() {
    let bodies = || -> String { ["a", "b", "c", "d"].map(|name| brick(name, "")).concat() };
    let plain = end(&format!("duration = 0.5\n{}", bodies()));
    for (_, text) in EFFECTS {
        let of = |keys: &str| {
            end(&format!(
                "duration = 0.5\n{}[[effect]]\n{text}\n{keys}",
                bodies()
            ))
        };
        let (some, all) = (of("bodies = [\"d\", \"b\"]"), of(""));
        for k in 0..4 {
            let wanted = if k % 2 == 1 { &all } else { &plain };
            assert_eq!(some[k].motion, wanted[k].motion, "{text}: body {k}");
        }
        assert_ne!(all[1].motion, plain[1].motion, "{text}");
        // Off: not there at all.
        assert_eq!(of("on = false"), plain, "{text}");
        assert_eq!(of("bodies = [\"b\"]\non = false"), plain, "{text}");
        // The short form is the same.
        let short = end(&format!("duration = 0.5\n[effects]\n{text}\n{}", bodies()));
        assert_eq!(short, all, "{text}");
    }
}

#[test]
fn bodies_by_their_own_methods_and_models_have_the_bits_they_have_alone() {
    // Twenty, so that groups of eight would mix them.
    let methods = [
        "",
        "method = \"jolt\"",
        "method = \"dop853\"\ntolerance = 1e-9",
        "",
    ];
    let keys = |k: usize| methods[(k / 3) % 4];
    let mut source = "duration = 0.5\n[effects]\ngravity = [0, -1, 0]\n".to_owned();
    for k in 0..20 {
        source += &brick(&format!("b{k}"), keys(k));
    }
    let gyroscopic = |k: usize| k.is_multiple_of(2) || k > 12;
    let names: Vec<String> = (0..20)
        .filter(|&k| gyroscopic(k))
        .map(|k| format!("\"b{k}\""))
        .collect();
    let _ = write!(
        source,
        "[[effect]]\ngyroscopic = true\nbodies = [{}]\n[[effect]]\ndrag = {{ linear = 0.3 }}\nbodies = [\"b4\", \"b5\"]\n",
        names.join(", ")
    );
    let together = end(&source);
    for (k, together) in together.iter().enumerate() {
        let mut alone = "duration = 0.5\n[effects]\ngravity = [0, -1, 0]\n".to_owned();
        if gyroscopic(k) {
            alone += "gyroscopic = true\n";
        }
        if k == 4 || k == 5 {
            alone += "drag = { linear = 0.3 }\n";
        }
        alone += &brick("alone", "");
        let method = keys(k);
        if !method.is_empty() {
            alone += &format!("[stepping]\n{method}\n");
        }
        assert_eq!(&end(&alone)[0], together, "b{k}");
    }
}

#[test]
fn ten_thousand_bodies_under_one_drag_move_alike() {
    // And are read and stepped in a time that a test has.
    let mut source = "duration = 0.01\n[record]\nstate = 100\n[[effect]]\nname = \"air\"\ndrag = { linear = 0.5 }\n".to_owned();
    for k in 0..10_000 {
        let _ = write!(
            source,
            "[[body]]\nname = \"b{k}\"\nmass = 1.0\ninertia = [1, 1, 1]\nvelocity = [1, 0, 0]\n"
        );
    }
    let ends = end(&source);
    for body in &ends {
        assert_eq!(body.motion.velocity_w, ends[0].motion.velocity_w);
    }
    // e^{-0.5·0.01}, ten steps of rk4.
    assert!((ends[0].motion.velocity_w.x - (-0.005_f64).exp()).abs() < 1e-15);
}

#[test]
fn wrong_effects_are_refused_with_place_reason_and_remedy() {
    let body = brick("a", "");
    let effect = |text: &str| format!("duration = 1.0\n{body}[[effect]]\n{text}");
    wrong(&effect(""), &["[[effect]] does nothing", "spring"]);
    wrong(
        &effect("gravity = [0, 1, 0]\ndrag = { linear = 1 }"),
        &["does several things"],
    );
    wrong(
        &effect("gravity = [0, 1, 0]\nbodies = [\"b\"]"),
        &["bodies = \"b\" names no body"],
    );
    wrong(
        &effect("gravity = [0, 1, 0]\nbodies = []"),
        &["names no body; leave"],
    );
    wrong(
        &effect("gravity = [0, 1, 0]\nbody = \"a\""),
        &["unknown key `body`", "known here: name, bodies"],
    );
    wrong(
        &effect("drag = { linear = 1 }\n[[effect]]\ndrag = { linear = 2 }"),
        &["a second drag lacks a name"],
    );
    wrong(
        &effect(
            "drag = { linear = 1 }\n[[effect]]\nname = \"drag\"\nspring = { anchor = [0, 0, 0], stiffness = 1 }",
        ),
        &["is the name of an earlier effect too (a drag)"],
    );
    wrong(
        &effect("name = \"push\"\ngravity = [0, 1, 0]"),
        &["something else is called"],
    );
    wrong(
        &effect("name = \"a/b\"\ngravity = [0, 1, 0]"),
        &["is no name"],
    );
    wrong(
        &effect("motor = { axis = [0, 1, 0], torqe = 1 }"),
        &["unknown key `torqe` in motor = {…}; did you mean `torque`?"],
    );
    wrong(
        &effect("motor = { axis = [0, 1, 0], torque = 1, frame = \"bdy\" }"),
        &["frame = \"bdy\" means nothing here; did you mean `body`?"],
    );
    wrong(
        &effect("motor = { axis = [0, 1, 0], sine = { amplitude = 1, frequency = true } }"),
        &["frequency = true is a boolean, not a number (Hz)"],
    );
    wrong(
        &effect("spring = { anchor = [0, 0, 0], point = \"apex\", stiffness = 1 }"),
        &["a has no point \"apex\" (it has centre"],
    );
    wrong(
        &effect("gravity_gradient = { mu = 1, centre = [0.3, 0.1, -0.2] }"),
        &["a is at the planet's centre"],
    );
    let held = brick("a", "pivot = [0.5, 0, 0]").replace("velocity = [1.0, 0.5, -0.25]", "");
    wrong(
        &format!("duration = 1.0\n{held}[effects]\ngravity_gradient = {{ mu = 1, orbit = true }}"),
        &["a pivot holds a, so it is in no orbit"],
    );
    wrong(
        &format!("duration = 1.0\n{held}[effects]\ngravity_gradient = {{ mu = 1 }}"),
        &["a pivot holds a off its centre of mass", "as gravity"],
    );
    let axes = brick("a", "immovable = [\"x\"]");
    wrong(
        &format!("duration = 1.0\n{axes}[effects]\ngravity_gradient = {{ mu = 1 }}"),
        &["immovable axes of a"],
    );
    wrong(
        &format!("duration = 1.0\n{axes}[[effect]]\ngyroscopic = true\nbodies = [\"a\"]"),
        &["with gyroscopic = true has no meaning yet"],
    );
    // Of another body it is no matter.
    let _ = scene(&format!(
        "duration = 1.0\n{axes}{}[[effect]]\ngyroscopic = true\nbodies = [\"b\"]",
        brick("b", "")
    ));
}

#[test]
fn methods_of_bodies_are_refused_as_those_of_scenes_are() {
    let own = |method: &str, rest: &str| format!("duration = 1.0\n{}{rest}", brick("a", method));
    wrong(
        &own("method = \"rk5\"", ""),
        &["is no method; did you mean"],
    );
    wrong(&own("tolerance = 1e-9", ""), &["name one, or leave it out"]);
    wrong(
        &own("method = \"rk4\"\ntolerance = 1e-9", ""),
        &["means nothing to rk4"],
    );
    wrong(
        &own("method = \"rk4\"", "[stepping]\naccuracy = 1e-6"),
        &["beside [stepping] accuracy"],
    );
    let drag = "[effects]\ngyroscopic = true\ndrag = { angular_linear = 1 }\n";
    wrong(
        &own("method = \"strang\"", drag),
        &["a: strang kicks by torques", "inline:"],
    );
    // On another body it is no matter.
    let _ = scene(&format!(
        "duration = 1.0\n{}{}[effects]\ngyroscopic = true\n[[effect]]\ndrag = {{ angular_linear = 1 }}\nbodies = [\"b\"]",
        brick("a", "method = \"strang\""),
        brick("b", "")
    ));
    let limit = "[effects]\nspeed_limit = { angular = 7 }\n";
    wrong(
        &own("method = \"dop853\"", limit),
        &["by no steps that it is given"],
    );
    wrong(
        &own("", &format!("{limit}[stepping]\naccuracy = 1e-6")),
        &["acts after each step, and with `accuracy`"],
    );
}

/// Keeps one body's angle about y at every instant.
#[derive(Default)]
struct Pitch {
    /// t, and the angle of the body's x from the local vertical.
    seen: Vec<(f64, f64)>,
}

impl Sink for Pitch {
    fn motions(&mut self, track: &Track<'_>) -> Result<(), SinkError> {
        for (at, motion) in track.instants.iter().zip(track.motions) {
            let (up, x) = (motion.position_w, motion.q_wb * Vector3::x());
            // In the plane of the orbit, x and z.
            let angle = up.cross(&x).y.atan2(up.dot(&x));
            self.seen.push((at.time, angle));
        }
        Ok(())
    }
    fn samples(&mut self, _: Instant, _: Range<usize>, _: &[Sample]) -> Result<(), SinkError> {
        Ok(())
    }
    fn note(&mut self, _: Instant, _: &Note) -> Result<(), SinkError> {
        Ok(())
    }
}

#[test]
fn a_satellite_librates_at_the_frequency_of_the_books() {
    // Hughes 1986, 9.1: pitch in a circular orbit has Ω √(3 (I_roll - I_yaw)/I_pitch). Ω = 1 (μ = 1, r = 1); the
    // body a ten-millionth of the orbit in size (its square, 1e-14, is how far the orbit is from a circle); its long axis, x, along the vertical; the pitch
    // axis is y. Turning from z towards x is positive about y, and so goes the orbit from x to -z.
    let source = r#"
        duration = 40.0
        [stepping]
        method = "dop853"
        tolerance = 1e-14
        step = 0.01
        [effects]
        gyroscopic = true
        gravity_gradient = { mu = 1.0, orbit = true }
        [[body]]
        name = "satellite"
        mass = 1.0
        inertia = [0.4e-14, 1.0e-14, 0.9e-14]
        position = [1.0, 0.0, 0.0]
        velocity = [0.0, 0.0, -1.0]
        angular_velocity = [0.0, 1.0, 0.0]
        orientation = { axis = [0, 1, 0], degrees = 0.01 }
    "#;
    let scene = scene(source);
    let mut pitch = Pitch::default();
    Simulation::new(&scene).run(&mut pitch).1.unwrap();
    let crossings: Vec<f64> = pitch
        .seen
        .windows(2)
        .filter(|w| w[0].1 > 0.0 && w[1].1 <= 0.0)
        .map(|w| w[0].0 + (w[1].0 - w[0].0) * w[0].1 / (w[0].1 - w[1].1))
        .collect();
    let periods = (crossings.len() - 1) as f64;
    let seen = (crossings[crossings.len() - 1] - crossings[0]) / periods;
    let wanted = std::f64::consts::TAU / (3.0 * (0.9 - 0.4) / 1.0_f64).sqrt();
    assert!(periods > 5.0);
    // The swing's θ²/16, 2e-9; a straight line between instants is (h Ω)³/16
    // of the swing off, at most 1e-7 s, over seven periods of 5 s.
    let off = seen / wanted - 1.0;
    assert!(off.abs() < 5e-8, "{seen} {wanted} {off:e}");
}

#[test]
fn an_orbit_keeps_energy_and_the_angular_momentum_of_all_of_it() {
    // A body half the size of its orbit, tumbling: force and torque are of one potential.
    let source = r#"
        duration = 20.0
        [stepping]
        method = "dop853"
        tolerance = 1e-14
        [record]
        state = 10
        [effects]
        gyroscopic = true
        gravity_gradient = { mu = 4.0, orbit = true, centre = [0.5, 0.0, 0.0] }
        [[body]]
        name = "satellite"
        mass = 1.3
        inertia = [0.6, 0.8, 1.0]
        position = [2.5, 0.0, 0.0]
        velocity = [0.0, 1.4, 0.1]
        angular_velocity = [0.5, 0.1, -0.7]
    "#;
    let scene = scene(source);
    let simulation = Simulation::new(&scene);
    let subject = simulation.subjects()[0].clone();
    let invariants = |motion: &Motion| {
        let (m, mu, r) = (1.3, 4.0, motion.position_w - Vector3::x() * 0.5);
        let r_b = motion.q_wb.inverse() * r;
        let (i, s) = (Vector3::new(0.6, 0.8, 1.0), r.norm());
        let about = r_b.dot(&i.component_mul(&r_b)) / (s * s);
        let potential = -mu * m / s - mu / (2.0 * s * s * s) * (i.sum() - 3.0 * about);
        let orbit = r.cross(&motion.velocity_w) * m;
        (
            subject.energy(motion) + potential,
            subject.momentum_w(motion) + orbit,
        )
    };
    let (energy, momentum) = invariants(&subject.start);
    let (outcome, done) = simulation.run(&mut Nowhere);
    done.unwrap();
    let (e, l) = invariants(&outcome.end[0].motion);
    // 20 s at 1e-14 a step of some hundredths, as a part of both.
    assert!((e / energy - 1.0).abs() < 1e-11, "{e} {energy}");
    assert!(
        (l - momentum).norm() < 1e-11 * momentum.norm(),
        "{l} {momentum}"
    );
}

#[test]
fn an_accuracy_is_kept_under_every_effect_that_has_a_law_of_motion() {
    for (name, text) in EFFECTS {
        if name == "speed_limit" {
            continue;
        }
        let gyroscopic = if name == "gyroscopic" {
            ""
        } else {
            "gyroscopic = true\n"
        };
        let source = format!(
            "duration = 1.5\n[stepping]\naccuracy = 1e-8\n[record]\nrate = 30\nstate = 30\n[effects]\n{gyroscopic}{text}\n{}",
            brick("a", "")
        );
        let planned = scene(&source);
        let plan = Plan::of(&planned).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert!(
            plan.achieved + plan.uncertainty <= 1e-8,
            "{text}: {:e}",
            plan.achieved
        );
        // And beside a method that the plan did not choose by: rk4 at 3e-5 s, (ω h)⁴ = 1e-17 and roundings
        // of 50,000 steps.
        let mut stated = scene(&source.replace("accuracy = 1e-8", "method = \"rk4\"\nstep = 3e-5"));
        stated.record.rate = 1.0;
        let truth = Simulation::new(&stated).run(&mut Nowhere).0.end;
        assert!(matches!(stated.stepping, Stepping::Method { .. }));
        let simulation = Simulation::new(&planned);
        let ours = simulation.run_by(&mut plan.chooser(), &mut Nowhere).0.end;
        let off = torquescope::math::angle_between(ours[0].motion.q_wb, truth[0].motion.q_wb);
        assert!(off < 1e-8, "{text}: {off:e}");
    }
}

/// The largest angle from the first body of a race.
struct Farthest(f64);

impl Sink for Farthest {
    fn motions(&mut self, _: &Track<'_>) -> Result<(), SinkError> {
        Ok(())
    }
    fn samples(&mut self, _: Instant, _: Range<usize>, all: &[Sample]) -> Result<(), SinkError> {
        let off = all.iter().filter_map(|sample| sample.deviation.attitude);
        self.0 = off.fold(self.0, f64::max);
        Ok(())
    }
    fn note(&mut self, _: Instant, _: &Note) -> Result<(), SinkError> {
        Ok(())
    }
}

#[test]
fn in_a_race_every_runner_has_the_anchor_and_the_planet_where_the_first_has_them() {
    for text in [
        "spring = { anchor = [0, 1, 0], point = [0.5, 0, 0], stiffness = 4.0 }",
        "gravity_gradient = { mu = 2.0, orbit = true, centre = [3, 0, 0] }",
        "motor = { torque = [0.1, 0.2, 0.3] }",
    ] {
        let source = format!(
            "duration = 1.0\n{}{}[[effect]]\n{text}\nbodies = [\"a\"]\n[[effect]]\nname = \"air\"\ndrag = {{ quadratic = 1 }}\nbodies = [\"b\"]\n",
            brick("a", "method = \"jolt\""),
            brick("b", "")
        );
        let methods = ["rk4", "dop853"].map(|name| find(name).unwrap());
        let race = Race::new(&scene(&source), &methods, 1e-3, 5.0).unwrap();
        assert_eq!(race.scene.bodies.len(), 3);
        let mut farthest = Farthest(0.0);
        race.run(&mut farthest).unwrap();
        // rk4 at 1e-3 s, dop853 at the race's tolerance of 1e-6; an anchor left behind is metres off.
        assert!(
            farthest.0 > 0.0 && farthest.0 < 1e-5,
            "{text}: {:e}",
            farthest.0
        );
    }
}
