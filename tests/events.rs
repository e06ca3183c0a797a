//! What a scene scripts: profiles, clicks, states set, effects switched, notes, repeats.

mod common;

use common::{Memory, Nowhere};
use nalgebra::{Vector3, Vector4};
use std::f64::consts::PI;
use torquescope::cost::{Plan, Race};
use torquescope::integrator;
use torquescope::math::angle_between;
use torquescope::scene::{Scene, Stepping};
use torquescope::sim::{Outcome, Simulation};
use torquescope::trace::{NoteKind, Sample};

fn parse(source: &str) -> Scene {
    Scene::parse("inline", "inline", source).unwrap_or_else(|error| panic!("{error}\n{source}"))
}

fn wrong(source: &str) -> String {
    match Scene::parse("inline", "inline", source) {
        Ok(_) => panic!("right: {source}"),
        Err(problems) => lines(&problems),
    }
}

/// The problems, a line each, without the pictures below them.
fn lines(problems: &torquescope::scene::Problems) -> String {
    let findings = problems.findings();
    let lines: Vec<String> = findings.iter().map(|finding| finding.line()).collect();
    lines.join("\n")
}

fn run(scene: &Scene) -> (Outcome, Memory) {
    let mut memory = Memory::default();
    let (outcome, done) = Simulation::new(scene).run(&mut memory);
    done.unwrap_or_else(|error| panic!("{error}"));
    (outcome, memory)
}

fn end(source: &str) -> Vec<Sample> {
    run(&parse(source)).0.end
}

#[track_caller]
fn near(a: Vector3<f64>, b: Vector3<f64>, bound: f64) {
    assert!((a - b).norm() < bound, "{a} is not {b}");
}

/// A torque about a fixed axis: `ω(T) = p τ T/I`, `θ(T) = s τ T²/I`, p the mean of the profile and s
/// that of its integral.
#[test]
fn a_profile_gives_its_integral() {
    let (tau, lasts, inertia) = (3.0, 0.3217, 0.8);
    let source = |method: &str, what: &str| {
        format!(
            "duration = 0.5\n[stepping]\n{method}\n[record]\nrate = 1\nstate = 1\n[[body]]\nname = \"b\"\nmass = 2.0\ninertia = [0.5, {inertia}, 0.6]\n[[body]]\nname = \"other\"\nmass = 2.0\ninertia = [1, 1, 1]\n[[event]]\nat = 0.1009\nfor = {lasts}\nbody = \"b\"\n{what}\n[[event]]\nat = 0.2003\nfor = 0.07\nbody = \"other\"\ntorque = [0, 1, 0]\n"
        )
    };
    let torque = "torque = [0.0, 3.0, 0.0]";
    // The same by a force at an arm of two metres on a body held at its centre, which turns with it.
    let push = "force = [0.0, 0.0, -1.5]\npoint = { body = [2.0, 0.0, 0.0] }\nframe = \"body\"";
    let cases = [
        ("box", 1.0, 0.5),
        ("half_sine", 2.0 / PI, 1.0 / PI),
        ("ramp", 0.5, 1.0 / 6.0),
    ];
    for (profile, mean, of_integral) in cases {
        let omega = mean * tau * lasts / inertia;
        let angle = of_integral * tau * lasts * lasts / inertia;
        for what in [torque, push] {
            let what = format!("{what}\nprofile = \"{profile}\"");
            for method in [
                "method = \"dop853\"\ntolerance = 1e-15\nstep = 0.01",
                // Simpson's rule for half a sine, in steps that the other body's torque cuts: its error is
                // (π h/T)⁴/2880, below a rounding; what is left are the roundings of 10⁴ additions.
                "method = \"rk4\"\nstep = 5e-5",
            ] {
                let sample = &end(&source(method, &what))[0];
                near(sample.motion.omega_w, Vector3::new(0.0, omega, 0.0), 1e-12);
                // It goes on turning until 0.5 s.
                let after = 0.5 - (0.1009 + lasts);
                let turned = 2.0 * sample.motion.q_wb.j.atan2(sample.motion.q_wb.w);
                let want = angle + omega * after;
                assert!((turned - want).abs() < 1e-12, "{profile}: {turned} {want}");
            }
        }
    }
}

#[test]
fn the_arrow_of_a_push_swells_as_it_does() {
    let scene = parse(
        "duration = 1.0\n[stepping]\nmethod = \"rk4\"\nstep = 0.01\n[record]\nrate = 100\n[[body]]\nname = \"b\"\nmass = 2.0\ninertia = [1, 1, 1]\n[[event]]\nat = 0.25\nfor = 0.5\nbody = \"b\"\nforce = [4.0, 0.0, 0.0]\npoint = \"centre\"\nprofile = \"half_sine\"\n",
    );
    let (outcome, memory) = run(&scene);
    let force = |t: f64, row: usize| {
        let rows = memory.at(0, t);
        rows[row].pushes.first().map(|push| push.force_w.x)
    };
    assert_eq!(force(0.25, 0), None);
    assert_eq!(force(0.25, 1), Some(0.0));
    assert_eq!(force(0.5, 0), Some(4.0));
    assert!(force(0.75, 0).unwrap().abs() < 1e-15);
    assert_eq!(force(0.75, 1), None);
    // What is told of the event is its peak.
    assert_eq!(
        outcome.blows[0].push.unwrap().force_w,
        Vector3::new(4.0, 0.0, 0.0)
    );
    assert!(
        memory.texts()[0].contains("peak of its half_sine"),
        "{:?}",
        memory.texts()
    );
    assert_eq!(Simulation::new(&scene).expected().force, 4.0);
}

/// The tutorial's cone, held at its base.
const CONE: &str = r#"
    duration = 1.0
    [stepping]
    METHOD
    [record]
    rate = 10
    [[body]]
    name = "cone"
    shape = { cone = { radius = 1.0, height = 1.0 } }
    mass = 1.0
    position = [0.0, 0.25, 0.0]
    pivot = "base"
"#;

fn cone(method: &str, events: &str) -> String {
    CONE.replace("METHOD", method) + events
}

const SEMI_IMPLICIT: &str = "method = \"semi-implicit\"\nstep = 0.001";

#[test]
fn a_click_is_a_push_where_it_hits() {
    // At half its height the cone's radius is ½.
    let click = "click = { from = [3.0, 0.5, 0.0], toward = [0.0, 0.5, 0.0], force = 10.0 }";
    let push = "body = \"cone\"\nforce = [-10.0, 0.0, 0.0]\npoint = { body = [0.5, 0.5, 0.0] }";
    for (lasts, profile) in [
        ("", ""),
        ("for = 0.1", ""),
        ("for = 0.1", "profile = \"ramp\""),
    ] {
        let scene = |what: &str| {
            let event = format!("[[event]]\nat = 0.0\n{lasts}\n{profile}\n{what}\n");
            run(&parse(&cone(SEMI_IMPLICIT, &event)))
        };
        let (clicked, memory) = scene(click);
        let (pushed, _) = scene(push);
        assert_eq!(clicked.end, pushed.end, "{lasts} {profile}");
        assert_eq!(clicked.blows[0].body, 0);
        let texts = memory.texts();
        assert!(
            texts[0].starts_with("click on cone at (0.5, 0.5, 0) m"),
            "{texts:?}"
        );
        assert_eq!(texts.len(), if lasts.is_empty() { 1 } else { 2 });
        if profile.is_empty() && !lasts.is_empty() {
            // By hand: (½, ½, 0) × (-10, 0, 0) = (0, 0, 5); over ¼.
            assert_eq!(clicked.blows[0].tau_w, Vector3::new(0.0, 0.0, 5.0));
            near(
                clicked.blows[0].sample.alpha_w,
                Vector3::new(0.0, 0.0, 20.0),
                1e-14,
            );
        }
    }
}

/// Two bodies in a row and a third beside; the shapeless one in front is met as the box it is drawn as.
const ROW: &str = r#"
    duration = 1.0
    [stepping]
    METHOD
    [record]
    rate = 10
    streams = ["torque", "error"]
    [effects]
    gyroscopic = true
    [[body]]
    name = "far"
    shape = { sphere = { radius = 0.5 } }
    mass = 1.0
    position = [0.0, 0.0, -2.0]
    angular_velocity = [0.3, 2.0, -0.1]
    [[body]]
    name = "box"
    mass = 12.0
    # m/12 (y² + z²) and so on: 1, ½ and 2 m.
    inertia = [[4.25, 0.0, 0.0], [0.0, 5.0, 0.0], [0.0, 0.0, 1.25]]
    angular_velocity = [0.0, 0.0, 0.7]
    [[body]]
    name = "beside"
    shape = { cuboid = { x = 1.0, y = 0.5, z = 0.2 } }
    mass = 1.0
    position = [5.0, 0.0, 0.0]
    angular_velocity = [0.3, 2.0, -0.1]
"#;

fn row(method: &str, events: &str) -> String {
    ROW.replace("METHOD", method) + events
}

#[test]
fn the_first_body_on_the_ray_is_hit_and_no_other() {
    let method = "method = \"rk4\"\nstep = 0.01";
    let hit = |click: &str| {
        let event = format!("[[event]]\nat = 0.0\nclick = {click}\n");
        let (outcome, _) = run(&parse(&row(method, &event)));
        outcome
            .blows
            .iter()
            .map(|blow| blow.body)
            .collect::<Vec<_>>()
    };
    assert_eq!(
        hit("{ from = [0.1, 0.1, 9], toward = [0.1, 0.1, 0], force = 1 }"),
        [1]
    );
    assert_eq!(
        hit("{ from = [0.1, 0.1, -9], direction = [0, 0, 1], force = 1 }"),
        [0]
    );
    // Over the box (half a metre high), at the sphere behind it.
    assert_eq!(
        hit("{ from = [0, 0.3, 9], direction = [0, 0, -1], force = 1 }"),
        [0]
    );
    assert_eq!(
        hit("{ from = [5, 9, 0], direction = [0, -1, 0], force = 1 }"),
        [2]
    );
    assert!(hit("{ from = [5, 9, 0], direction = [0, 1, 0], force = 1 }").is_empty());
    // As posed at that instant: the box has turned by 0.7 rad about z, and its corner is up.
    let event = "[[event]]\nat = 1.0\nclick = { from = [0.2, 0.3, 9], direction = [0, 0, -1], force = 1 }\n";
    assert_eq!(run(&parse(&row(method, event))).0.blows[0].body, 1);
}

#[test]
fn a_click_that_misses_is_logged_and_changes_no_bit() {
    // On the grid of fixed steps; anywhere for methods that take their own, and for the closed form.
    let cases = [
        ("method = \"rk4\"\nstep = 0.01", 0.25, 0.5),
        ("method = \"s15\"\nstep = 0.01", 0.25, 0.5),
        ("method = \"taylor\"\nstep = 0.01", 0.2512, 0.3333),
        ("method = \"dop853\"\nstep = 0.01", 0.2512, 0.3333),
        ("method = \"closed-form\"\nstep = 0.01", 0.2512, 0.0),
    ];
    for (method, at, lasts) in cases {
        let lasts = match lasts > 0.0 {
            true => format!("for = {lasts}\n"),
            false => String::new(),
        };
        let miss = format!(
            "[[event]]\nat = {at}\n{lasts}click = {{ from = [0, 9, 0], toward = [0, 10, 0], force = 5 }}\n"
        );
        let plain = run(&parse(&row(method, ""))).0;
        // The closed form takes no push, so it is not asked for one that lasts.
        let (missed, memory) = run(&parse(&row(method, &miss)));
        assert_eq!(missed.end, plain.end, "{method}");
        assert!(missed.blows.is_empty());
        let [(when, note)] = memory.notes.as_slice() else {
            panic!("{:?}", memory.notes);
        };
        assert_eq!(
            (when.time, note.body, note.kind),
            (at, None, NoteKind::Remark)
        );
        assert_eq!(
            note.text,
            "click misses: the ray from (0, 9, 0) m along (0, 1, 0) hits nothing"
        );
    }
}

#[test]
fn repeats_are_at_exact_times() {
    let source = |more: &str| {
        format!(
            "duration = 3.0\n[stepping]\nmethod = \"rk4\"\nstep = 0.01\n[[body]]\nname = \"b\"\nmass = 1.0\ninertia = [1, 1, 1]\n[[event]]\nname = \"tick\"\nbody = \"b\"\nangular_impulse = [0.0, 0.25, 0.0]\n{more}\n"
        )
    };
    let times = |more: &str| {
        let (outcome, memory) = run(&parse(&source(more)));
        assert_eq!(memory.notes.len(), outcome.blows.len());
        assert!(memory.texts()[0].starts_with("tick (angular impulse) on b:"));
        let times: Vec<f64> = outcome.blows.iter().map(|blow| blow.at.time).collect();
        assert_eq!(outcome.end[0].motion.omega_w.y, 0.25 * times.len() as f64);
        times
    };
    // Summed up, thirty tenths are 2.9999999999999996.
    let thirty: Vec<f64> = (0..=30).map(|k| f64::from(k) * 0.1).collect();
    assert_eq!(times("at = 0.0\nevery = 0.1"), thirty);
    let five: Vec<f64> = (0..5).map(|k| 0.3 + f64::from(k) * 0.15).collect();
    assert_eq!(times("at = 0.3\nevery = 0.15\nuntil = 0.9")[..4], five[..4]);
    // 0.3 + 4 · 0.15 is 0.8999999999999999 or 0.9: counted, and not after it.
    assert_eq!(times("at = 0.3\nevery = 0.15\nuntil = 0.9").len(), 5);
    assert_eq!(times("at = 0.3\nevery = 0.15\nuntil = 0.89").len(), 4);
    assert_eq!(times("at = 2.0\nevery = 5.0"), [2.0]);
    assert_eq!(
        times("at = 1.0\nevery = 0.5\nuntil = 99"),
        [1.0, 1.5, 2.0, 2.5, 3.0]
    );
}

#[test]
fn pushes_that_overlap_add() {
    // From 0 on, every half second, each for a second: one, then two at a time; 0.5 + 2.5 · 2 N s.
    let source = "duration = 3.0\n[[body]]\nname = \"b\"\nmass = 1.0\ninertia = [1, 1, 1]\n[[event]]\nat = 0.0\nevery = 0.5\nfor = 1.0\nbody = \"b\"\nforce = [1.0, 0.0, 0.0]\npoint = \"centre\"\n";
    let velocity = end(source)[0].motion.velocity_w;
    near(velocity, Vector3::new(5.5, 0.0, 0.0), 1e-12);
}

#[test]
fn a_set_changes_what_it_names_and_nothing_else() {
    let source = |set: &str| {
        format!(
            "duration = 1.0\n[stepping]\nmethod = \"rk4\"\nstep = 0.01\n[effects]\ngyroscopic = true\n[[body]]\nname = \"b\"\nmass = 2.0\ninertia = [[0.5, 0.1, 0.0], [0.1, 0.8, 0.0], [0.0, 0.0, 1.1]]\nvelocity = [1.0, 2.0, 3.0]\nangular_velocity = [0.9, -3.0, 2.1]\n[[event]]\nat = 0.5003\nbody = \"b\"\nset = {set}\n"
        )
    };
    let (x, v, w) = (
        Vector3::new(7.0, 8.0, 9.0),
        Vector3::new(-1.0, 0.0, 4.0),
        Vector3::new(0.1, 0.2, 0.3),
    );
    let all = "{ position = [7, 8, 9], velocity = [-1, 0, 4], orientation = [0.6, 0, 0, 0.8], angular_velocity = [0.1, 0.2, 0.3] }";
    for set in [
        "{ position = [7, 8, 9] }",
        "{ velocity = [-1, 0, 4] }",
        "{ orientation = [0.6, 0, 0, 0.8] }",
        "{ angular_velocity = [0.1, 0.2, 0.3] }",
        all,
    ] {
        let (_, memory) = run(&parse(&source(set)));
        let rows = memory.at(0, 0.5003);
        let (before, after) = (&rows[0].motion, &rows[1].motion);
        let named = |key: &str| set.contains(key);
        assert_eq!(
            after.position_w,
            if named("position") {
                x
            } else {
                before.position_w
            }
        );
        // "angular_velocity" holds the other's name.
        let velocity = named(" velocity") || named("{ velocity");
        assert_eq!(
            after.velocity_w,
            if velocity { v } else { before.velocity_w }
        );
        assert_eq!(
            after.omega_w,
            if named("angular") { w } else { before.omega_w }
        );
        match named("orientation") {
            // Through the principal axes and back: a rounding or two.
            true => assert!((after.q_wb.coords - Vector4::new(0.6, 0.0, 0.0, 0.8)).norm() < 1e-15),
            false => assert_eq!(after.q_wb, before.q_wb),
        }
        assert_eq!(memory.notes[0].1.kind, NoteKind::Set);
        assert!(
            memory.texts()[0].starts_with("set on b: "),
            "{:?}",
            memory.texts()
        );
    }
}

#[test]
fn what_a_pivot_holds_turns_about_it_when_set() {
    let event = "[[event]]\nat = 0.3\nbody = \"cone\"\nset = { orientation = { axis = [0, 0, 1], degrees = 90 } }\n";
    let (_, memory) = run(&parse(&cone(SEMI_IMPLICIT, event)));
    let rows = memory.at(0, 0.3);
    near(
        rows[0].motion.position_w,
        Vector3::new(0.0, 0.25, 0.0),
        1e-16,
    );
    // The base stays at the origin; the centre of mass, a quarter up, now points along -x.
    near(
        rows[1].motion.position_w,
        Vector3::new(-0.25, 0.0, 0.0),
        1e-16,
    );
}

/// A torque loses the exact motion; a set that says all of the state has it again.
#[test]
fn the_truth_starts_again_from_a_set_state() {
    let source = |set: &str| {
        format!(
            "duration = 1.0\n[stepping]\nmethod = \"rk4\"\nstep = 0.01\n[record]\nrate = 10\n[effects]\ngyroscopic = true\n[[body]]\nname = \"b\"\nmass = 2.0\ninertia = [0.5, 0.8, 1.1]\nangular_velocity = [0.9, -3.0, 2.1]\n[[event]]\nat = 0.2\nfor = 0.1\nbody = \"b\"\ntorque = [1.0, 0.0, 0.0]\n[[event]]\nat = 0.5\nbody = \"b\"\nset = {set}\n"
        )
    };
    let error = |set: &str, t: f64| {
        let (_, memory) = run(&parse(&source(set)));
        memory.at(0, t).last().unwrap().deviation.attitude
    };
    let whole =
        "{ velocity = [0, 0, 0], orientation = [0, 0, 0, 1], angular_velocity = [0.1, 3.0, 0.4] }";
    let part = "{ angular_velocity = [0.1, 3.0, 0.4] }";
    assert!(error(part, 0.1).unwrap() > 0.0);
    assert_eq!(error(part, 0.4), None);
    assert_eq!(error(part, 0.9), None);
    assert_eq!(error(whole, 0.4), None);
    assert_eq!(error(whole, 0.5), Some(0.0));
    // rk4 at 3 rad/s in steps of 0.01: (ω h)⁴ and some; and an error there is.
    let off = error(whole, 0.9).unwrap();
    assert!(off > 1e-12 && off < 1e-6, "{off:e}");
    // A part of a state that is known is set in the known one.
    let known = source(part).replace("torque = [1.0, 0.0, 0.0]", "torque = [0.0, 0.0, 0.0]");
    let known = known.replace("at = 0.2\nfor = 0.1", "at = 0.95\nfor = 0.01");
    let (_, memory) = run(&parse(&known));
    let off = memory
        .at(0, 0.9)
        .last()
        .unwrap()
        .deviation
        .attitude
        .unwrap();
    assert!(off > 1e-12 && off < 1e-6, "{off:e}");
}

/// A run with an effect switched is one with it until then, and one without it from then on.
#[test]
fn a_switch_parts_a_run_in_two() {
    let source = |effects: &str, events: &str| {
        format!(
            "duration = 1.0\n[stepping]\nmethod = \"rk4\"\nstep = 0.0078125\n[effects]\n{effects}\n[[body]]\nname = \"a\"\nmass = 2.0\ninertia = [0.5, 0.8, 1.1]\nangular_velocity = [0.9, -3.0, 2.1]\npivot = [0.0, -0.5, 0.0]\n[[body]]\nname = \"b\"\nmass = 2.0\ninertia = [0.5, 0.8, 1.1]\nangular_velocity = [0.1, 1.0, 0.1]\n{events}\n"
        )
    };
    let all = "gyroscopic = true\ngravity = [0.0, -9.81, 0.0]\ndamping = { angular = 0.3 }";
    for (effect, without) in [
        ("gravity", "gyroscopic = true\ndamping = { angular = 0.3 }"),
        ("damping", "gyroscopic = true\ngravity = [0.0, -9.81, 0.0]"),
        (
            "gyroscopic",
            "gravity = [0.0, -9.81, 0.0]\ndamping = { angular = 0.3 }",
        ),
    ] {
        // A step is a power of two, so that half a run starts on the same numbers.
        let off =
            format!("[[event]]\nat = 0.5\nswitch = {{ effect = \"{effect}\", on = false }}\n");
        let on = format!(
            "[[event]]\nat = 0.0\nswitch = {{ effect = \"{effect}\", on = false }}\n[[event]]\nat = 0.5\nswitch = {{ effect = \"{effect}\", on = true }}\n"
        );
        for (events, first, second) in [(off, all, without), (on, without, all)] {
            let (switched, memory) = run(&parse(&source(all, &events)));
            let half = source(first, "").replace("duration = 1.0", "duration = 0.5");
            let half = end(&half);
            let mut rest = parse(&source(second, "").replace("duration = 1.0", "duration = 0.5"));
            for (body, sample) in rest.bodies.iter_mut().zip(&half) {
                body.position_w = sample.motion.position_w;
                body.velocity_w = sample.motion.velocity_w;
                body.q_wb = sample.motion.q_wb;
                body.omega_w = sample.motion.omega_w;
            }
            let (rest, _) = run(&rest);
            // The held one's pivot is found anew from its centre of mass, by a rounding.
            near(
                switched.end[0].motion.position_w,
                rest.end[0].motion.position_w,
                1e-15,
            );
            for (a, b) in switched.end.iter().zip(&rest.end) {
                assert_eq!(a.motion.q_wb, b.motion.q_wb, "{effect}");
                assert_eq!(a.motion.omega_w, b.motion.omega_w, "{effect}");
                assert_eq!((a.tau_w, a.alpha_w), (b.tau_w, b.alpha_w), "{effect}");
            }
            assert_eq!(switched.end[1].motion, rest.end[1].motion, "{effect}");
            let last = memory.texts().pop().unwrap();
            assert!(last.starts_with(&format!("switch: {effect} o")), "{last}");
            // Rows on either side, for every body.
            assert_eq!(memory.at(0, 0.5).len().min(memory.at(1, 0.5).len()), 2);
        }
    }
}

#[test]
fn a_note_is_written_at_its_time_and_moves_nothing() {
    for method in [
        "method = \"rk4\"\nstep = 0.01",
        "method = \"dop853\"\nstep = 0.01",
    ] {
        let notes = "[[event]]\nat = 0.0\nnote = \"it begins\"\n[[event]]\nat = 0.12345\nevery = 0.25\nnote = \"look at the box\"\nbody = \"box\"\n[[event]]\nat = 1.0\nnote = \"it ends\"\n";
        let plain = run(&parse(&row(method, "")));
        let noted = run(&parse(&row(method, notes)));
        assert_eq!(plain.0.end, noted.0.end);
        assert_eq!(plain.0.steps, noted.0.steps);
        assert_eq!(plain.1.samples, noted.1.samples);
        let lines: Vec<(f64, u64, Option<usize>)> = noted
            .1
            .notes
            .iter()
            .map(|(at, note)| (at.time, at.step, note.body))
            .collect();
        let every = |k: u32| 0.12345 + f64::from(k) * 0.25;
        assert_eq!(
            lines,
            [
                (0.0, 0, None),
                (every(0), 12, Some(1)),
                (every(1), 37, Some(1)),
                (every(2), 62, Some(1)),
                (every(3), 87, Some(1)),
                (1.0, 100, None),
            ]
        );
    }
}

/// At one instant: ends, then begins as the file has them; a click sees what was set before it.
#[test]
fn at_one_instant_the_order_is_that_of_the_file() {
    let click =
        "[[event]]\nat = 0.5\nclick = { from = [0, 9, 0], direction = [0, 1, 0], force = 1 }\n";
    let set = "[[event]]\nat = 0.5\nbody = \"beside\"\nset = { position = [0, 20, 0] }\n";
    let method = "method = \"rk4\"\nstep = 0.01";
    let hits = |events: String| run(&parse(&row(method, &events))).0.blows.len();
    assert_eq!(hits(format!("{click}{set}")), 0);
    assert_eq!(hits(format!("{set}{click}")), 1);
}

/// Everything at once under a stated accuracy, against the tightest tolerance there is.
#[test]
fn a_plan_keeps_to_its_accuracy_through_every_kind_of_event() {
    let source = |stepping: &str| {
        format!(
            r#"
            duration = 2.0
            [stepping]
            {stepping}
            [record]
            rate = 50
            state = 50
            [effects]
            gyroscopic = true
            gravity = [0.0, -9.81, 0.0]
            damping = {{ angular = 0.2 }}
            [[body]]
            name = "top"
            mass = 1.0
            inertia = [0.5, 0.875, 1.25]
            pivot = [0.0, -0.5, 0.0]
            angular_velocity = [0.4, 3.0, 0.3]
            [[body]]
            name = "brick"
            shape = {{ cuboid = {{ x = 1.0, y = 0.5, z = 0.2 }} }}
            mass = 2.0
            position = [5.0, 0.0, 0.0]
            angular_velocity = [0.3, 2.0, -0.1]
            [[event]]
            at = 0.1234
            for = 0.3
            profile = "half_sine"
            body = "brick"
            torque = [0.3, 0.1, -0.2]
            frame = "body"
            [[event]]
            at = 0.2
            for = 0.5
            profile = "ramp"
            body = "top"
            force = [1.0, 0.5, 0.0]
            point = {{ body = [0.1, 0.4, 0.2] }}
            [[event]]
            at = 0.3333
            switch = {{ effect = "gravity", on = false }}
            [[event]]
            at = 0.4
            for = 0.05
            profile = "half_sine"
            click = {{ from = [0.1, 0.05, 9.0], direction = [0.0, 0.0, -1.0], force = 20.0 }}
            [[event]]
            at = 0.45
            click = {{ from = [0.0, 50.0, 9.0], direction = [0.0, 0.0, 1.0], force = 20.0 }}
            [[event]]
            at = 0.9001
            body = "brick"
            set = {{ orientation = [0.1, 0.2, 0.3, 0.9], angular_velocity = [1.0, -2.0, 0.5] }}
            [[event]]
            at = 1.25
            switch = {{ effect = "damping", on = false }}
            [[event]]
            at = 1.3
            every = 0.2
            body = "brick"
            angular_impulse = [0.1, 0.0, 0.05]
            "#
        )
    };
    let truth = end(&source(
        "method = \"dop853\"\ntolerance = 1e-15\nstep = 0.1",
    ));
    for accuracy in [1e-4, 1e-8] {
        let scene = parse(&source(&format!("accuracy = {accuracy:e}")));
        assert!(matches!(scene.stepping, Stepping::Accuracy(_)));
        let plan = Plan::of(&scene).unwrap_or_else(|error| panic!("{error}"));
        let (outcome, done) = Simulation::new(&scene).run_by(&mut plan.chooser(), &mut Nowhere);
        done.unwrap();
        assert_eq!(
            outcome.blows.iter().filter(|blow| blow.event == 3).count(),
            1
        );
        for (a, b) in outcome.end.iter().zip(&truth) {
            let off = angle_between(a.motion.q_wb, b.motion.q_wb);
            assert!(off <= accuracy, "{accuracy:e}: {off:e}");
        }
        // Every body's intervals follow one another, the one that a click ended too.
        for body in 0..2 {
            let own = plan.intervals.iter().filter(|i| i.members.contains(&body));
            let own: Vec<(f64, f64)> = own.map(|i| (i.from, i.until)).collect();
            assert!(own.windows(2).all(|w| w[0].1 == w[1].0), "{own:?}");
            assert_eq!(own.first().map(|i| i.0), Some(0.0));
            assert_eq!(own.last().map(|i| i.1), Some(2.0));
        }
        // Between the impulses nothing acts on the brick: there it goes in closed form.
        let last = plan
            .intervals
            .iter()
            .rfind(|i| i.members.contains(&1))
            .unwrap();
        assert_eq!(last.choice.method.info().name, "closed-form");
    }
}

#[test]
fn a_method_is_held_to_every_effect_that_a_switch_brings() {
    let source = |method: &str, events: &str| {
        format!(
            "duration = 1.0\n[stepping]\nmethod = \"{method}\"\nstep = 0.01\n[effects]\ngyroscopic = true\ngravity = [0.0, -9.81, 0.0]\n[[body]]\nname = \"top\"\nmass = 1.0\ninertia = [0.5, 0.8, 1.1]\npivot = [0.0, -0.5, 0.0]\n{events}"
        )
    };
    let off = "[[event]]\nat = 0.0\nswitch = { effect = \"gravity\", on = false }\n";
    let on = "[[event]]\nat = 0.5\nswitch = { effect = \"gravity\", on = true }\n";
    let told = wrong(&source("closed-form", ""));
    assert!(
        told.contains("top: closed-form is for bodies that no torque turns"),
        "{told}"
    );
    parse(&source("closed-form", off));
    let told = wrong(&source("closed-form", &format!("{off}{on}")));
    assert!(
        told.starts_with("inline:16:1: after a switch, top: closed-form"),
        "{told}"
    );
    // A profile is no constant torque.
    let push = "[[event]]\nat = 0.1\nfor = 0.1\nprofile = \"half_sine\"\nbody = \"top\"\ntorque = [1, 0, 0]\n";
    let told = wrong(&source("taylor", push));
    assert!(
        told.contains("a torque on top: taylor knows the recurrences of constant"),
        "{told}"
    );
    parse(&source("taylor", &push.replace("half_sine", "box")));
    // A click may hit any body.
    let click = "[[event]]\nat = 0.1\nfor = 0.1\nclick = { from = [0, 0, 9], direction = [0, 0, -1], force = 1 }\n";
    let told = wrong(&source("closed-form", &format!("{off}{click}")));
    assert!(told.contains("a click on top: closed-form"), "{told}");
    parse(&source(
        "closed-form",
        &format!("{off}{}", click.replace("for = 0.1\n", "")),
    ));
}

#[test]
fn more_events_than_a_scene_holds_are_refused() {
    let source = |every: &str| {
        format!(
            "duration = 1000.0\n[stepping]\nstep = 0.1\n[record]\nstate = 1\n[[body]]\nname = \"b\"\nmass = 1.0\ninertia = [1, 1, 1]\n[[event]]\nat = 0.0\nevery = {every}\nbody = \"b\"\nangular_impulse = [0, 1, 0]\n"
        )
    };
    assert_eq!(parse(&source("0.0100001")).events.len(), 100_000);
    let told = wrong(&source("0.001"));
    assert_eq!(
        told,
        "inline:12:9: every = 0.001 makes 1000001 events; a scene holds at most 100000: repeat it less often, or end it by `until`"
    );
    assert!(wrong(&source("1e-300")).contains("below a nanosecond"));
    // Together as well.
    let two = source("0.015") + "[[event]]\nat = 0.0\nevery = 0.02\nnote = \"tick\"\n";
    assert!(wrong(&two).contains("every = 0.02 makes 50001 events"));
}

/// A pulse on one body leaves the bits of another, in the same block of eight, as they are.
#[test]
fn a_neighbours_pulse_changes_no_bit() {
    let source = |method: &str, events: &str| {
        format!(
            "duration = 1.0\n[stepping]\nmethod = \"{method}\"\nstep = 0.01\n[effects]\ngyroscopic = true\ngravity = [0.0, -9.81, 0.0]\n[[body]]\nname = \"top\"\nmass = 1.0\ninertia = [0.5, 0.8, 1.1]\nposition = [0.3, 0.1, -0.7]\npivot = [0.1, -0.5, 0.2]\nangular_velocity = [0.4, 3.0, 0.3]\n[[body]]\nname = \"b\"\nmass = 1.0\ninertia = [0.5, 0.8, 1.1]\n[[event]]\nat = 0.0\nfor = 1.0\nbody = \"top\"\nforce = [0.1, 0.2, 0.3]\npoint = {{ body = [0.3, 0.2, 0.1] }}\n{events}"
        )
    };
    let pulse = "[[event]]\nat = 0.25\nfor = 0.5\nprofile = \"half_sine\"\nbody = \"b\"\ntorque = [0.3, 0.1, -0.2]\n";
    for method in ["dop853", "rk4", "cf4", "rkn6", "buss", "dlm", "s15"] {
        let boxed = end(&source(method, &pulse.replace("half_sine", "box")));
        let pulsed = end(&source(method, pulse));
        assert_eq!(boxed[0], pulsed[0], "{method}");
        assert_ne!(boxed[1], pulsed[1], "{method}");
    }
}

/// In a race every runner is clicked at its own place, and what happens to all happens once.
#[test]
fn a_race_has_the_scenes_events() {
    let events = "[[event]]\nat = 0.2\nclick = { from = [0.1, 0.1, 9], direction = [0, 0, -1], force = 0.3 }\n[[event]]\nat = 0.3\nnote = \"struck\"\n[[event]]\nat = 0.5\nbody = \"far\"\nset = { position = [0, 0, 1] }\n[[event]]\nat = 0.6\nswitch = { effect = \"gyroscopic\", on = false }\n";
    let scene = parse(&row("method = \"rk4\"\nstep = 0.01", events));
    let methods: Vec<_> = ["rk4", "cf4"]
        .into_iter()
        .filter_map(integrator::find)
        .collect();
    let race = Race::new(&scene, &methods, 0.01, 3.0).unwrap();
    let mut memory = Memory::default();
    race.run(&mut memory).unwrap();
    let count = |start: &str| {
        memory
            .texts()
            .iter()
            .filter(|text| text.starts_with(start))
            .count()
    };
    let runners = race.scene.bodies.len();
    assert_eq!(runners, 3);
    assert_eq!(count("click on "), runners);
    assert_eq!((count("struck"), count("switch: ")), (1, 1));
    let place = |body: usize, time: f64| memory.at(body, time).last().unwrap().motion.position_w;
    for body in 0..runners {
        let start = race.scene.bodies[body].position_w;
        let shift_w = start - scene.bodies[0].position_w;
        near(place(body, 0.5), shift_w + Vector3::z(), 1e-15);
    }
}

/// What rests, far from the start of the clock, under a force that begins at nothing: the finest tolerance
/// follows it, though the time itself has roundings.
#[test]
fn a_pulse_late_on_a_body_at_rest_is_followed() {
    for profile in ["half_sine", "ramp"] {
        let source = format!(
            "duration = 2000.0\n[stepping]\nmethod = \"dop853\"\ntolerance = 1e-16\nstep = 1.0\n[effects]\ngyroscopic = true\n[[body]]\nname = \"b\"\nmass = 2.0\ninertia = [0.5, 0.8, 0.6]\n[[event]]\nat = 1999.3\nfor = 0.5\nprofile = \"{profile}\"\nbody = \"b\"\ntorque = [0.0, 2.0, 0.0]\n"
        );
        let mean = if profile == "ramp" { 0.5 } else { 2.0 / PI };
        // The clock's own roundings there are 2e-13 s.
        let omega = end(&source)[0].motion.omega_w;
        near(omega, Vector3::new(0.0, mean * 2.0 * 0.5 / 0.8, 0.0), 2e-12);
    }
}
