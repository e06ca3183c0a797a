//! A session goes back and on by the same bits, and its saved scene plays back to them.

use nalgebra::Vector3;
use serde_json::Value;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::{Arc, Mutex};
use torquescope::mass::ray::Ray;
use torquescope::scene::{Scene, Script};
use torquescope::session::{
    Clock, Console, Place, Push, Saver, Session, SessionError, Settings, Stop, What,
};
use torquescope::sim::{Limit, Run, Simulation, Stated};
use torquescope::trace::{Condition, Instant, Note, Sample, Sink, SinkError, Track, Vocabulary};

/// A top that is damped, and a plate; a push and a switch on the way. Methods are put in.
const SCENE: &str = "duration = 1.0\n[stepping]\nmethod = \"METHOD\"\nstep = 0.002\n[record]\nrate = 50\n\
    [effects]\ngyroscopic = true\ngravity = [0, -9.81, 0]\ndamping = { angular = 0.1, linear = 0.2 }\n\
    [[body]]\nname = \"cone\"\nshape = { cone = { radius = 1.0, height = 1.0 } }\nmass = 1.0\norientation = { axis = [0, 0, 1], degrees = 30 }\nangular_velocity = [0, 8, 0]\npivot = \"base\"\n\
    [[body]]\nname = \"plate\"\nshape = { cuboid = { x = 0.4, y = 0.02, z = 0.3 } }\nmass = 0.5\nposition = [3, 0, 0]\nangular_velocity = [1, 2, 0.1]\n\
    [[event]]\nat = 0.3011\nfor = 0.05\nbody = \"plate\"\nforce = [0, 0, -3]\npoint = { body = [0.1, 0, 0] }\n\
    [[event]]\nat = 0.7\nswitch = { effect = \"gravity\", on = false }\n";

fn script(method: &str) -> Script {
    Script::new("s", "s", &SCENE.replace("METHOD", method))
}

/// Counts rows, and keeps the last hash of every step.
#[derive(Default)]
struct Rows {
    states: usize,
    samples: BTreeMap<(u64, usize), usize>,
    hashes: BTreeMap<u64, u64>,
}

impl Sink for Rows {
    fn motions(&mut self, track: &Track<'_>) -> Result<(), SinkError> {
        self.states += track.motions.len();
        Ok(())
    }
    fn samples(
        &mut self,
        at: Instant,
        bodies: Range<usize>,
        _: &[Sample],
    ) -> Result<(), SinkError> {
        *self.samples.entry((at.step, bodies.start)).or_default() += 1;
        Ok(())
    }
    fn note(&mut self, _: Instant, _: &Note) -> Result<(), SinkError> {
        Ok(())
    }
    fn wants_fingerprints(&self) -> bool {
        true
    }
    fn fingerprint(&mut self, at: Instant, hash: u64) -> Result<(), SinkError> {
        self.hashes.insert(at.step, hash);
        Ok(())
    }
}

fn open(method: &str) -> Session {
    Session::open(script(method), Settings::default(), &mut Rows::default()).unwrap()
}

/// Hashes at every step of a text run from start to end.
fn straight(text: &str) -> Vec<u64> {
    let scene =
        Arc::new(Scene::parse("s", "s", text).unwrap_or_else(|why| panic!("{why}\n{text}")));
    let mut stated = Stated::of(&scene).unwrap();
    let mut run = Run::new(scene);
    let mut sink = Rows::default();
    let mut hashes = Vec::new();
    run.go(Limit::steps(0), &mut stated, &mut sink).unwrap();
    hashes.push(run.fingerprint());
    while !run.is_over() {
        assert!(run.failure().is_none(), "{:?}", run.failure());
        run.go(Limit::steps(1), &mut stated, &mut sink).unwrap();
        hashes.push(run.fingerprint());
    }
    hashes
}

const METHODS: [&str; 5] = ["semi-implicit", "rk4", "dop853", "taylor", "jolt"];

fn push(body: &str, lasts: Option<f64>) -> Push {
    Push {
        body: body.to_owned(),
        what: What::Force {
            // A blow weaker than a push, so that nothing turns too fast for any method.
            force: Vector3::new(0.1, 0.2, -3.0) * if lasts.is_some() { 1.0 } else { 0.01 },
            at: Place::Body(Vector3::new(0.1, 0.3, 0.0)),
        },
        in_body: false,
        lasts,
    }
}

#[test]
fn seeking_and_going_back_have_the_bits_of_the_straight_run() {
    for method in METHODS {
        let want = straight(&SCENE.replace("METHOD", method));
        let mut session = open(method);
        let mut sink = Rows::default();
        assert_eq!(
            session.advance(Limit::steps(u64::MAX), &mut sink).unwrap(),
            Some(Stop::End)
        );
        assert_eq!(session.now().step as usize, want.len() - 1);
        assert_eq!(session.fingerprint(), want[want.len() - 1], "{method}");
        for step in [0, 1, 63, 64, 65, 151, 152, 153, 400, 177, 178, 300, 501, 2] {
            session.seek_step(step, &mut sink).unwrap();
            assert_eq!(session.now().step, step);
            assert_eq!(
                session.fingerprint(),
                want[step as usize],
                "{method} at {step}"
            );
        }
        for n in [1_u64, 5, 64, 200] {
            session.seek_step(300, &mut sink).unwrap();
            session.back(n, &mut sink).unwrap();
            assert_eq!(
                session.fingerprint(),
                want[300 - n as usize],
                "{method} back {n}"
            );
            session.advance(Limit::steps(n), &mut sink).unwrap();
            assert_eq!(session.fingerprint(), want[300], "{method} on {n}");
        }
        session.back(1000, &mut sink).unwrap();
        assert_eq!((session.now().step, session.fingerprint()), (0, want[0]));
        session.seek(0.5, &mut sink).unwrap();
        // Two ends of the push divided a step each.
        assert_eq!((session.now().step, session.now().time), (252, 0.5));
        assert_eq!(session.fingerprint(), want[252]);
        // Nobody made a branch.
        assert_eq!(session.branches().len(), 1);
    }
}

#[test]
fn little_memory_costs_steps_and_no_bit() {
    let want = straight(&SCENE.replace("METHOD", "rk4"));
    let settings = Settings {
        memory: 40_000,
        ..Settings::default()
    };
    let mut sink = Rows::default();
    let mut session = Session::open(script("rk4"), settings, &mut sink).unwrap();
    session.advance(Limit::steps(u64::MAX), &mut sink).unwrap();
    let (states, bytes) = session.stored();
    assert!(
        bytes <= 40_000 && (1..7).contains(&states),
        "{states} {bytes}"
    );
    for step in [499, 450, 3, 200, 64] {
        session.seek_step(step, &mut sink).unwrap();
        assert_eq!(session.fingerprint(), want[step as usize], "{step}");
        assert!(session.stored().1 <= 40_000);
    }
}

#[test]
fn rows_are_delivered_once() {
    let text = SCENE.replace("METHOD", "rk4");
    let mut want = Rows::default();
    let scene = Scene::parse("s", "s", &text).unwrap();
    Simulation::new(&scene).run(&mut want).1.unwrap();
    let mut got = Rows::default();
    let mut session = Session::open(script("rk4"), Settings::default(), &mut got).unwrap();
    session.advance(Limit::steps(100), &mut got).unwrap();
    session.back(70, &mut got).unwrap();
    session.advance(Limit::steps(3), &mut got).unwrap();
    session.seek(0.4, &mut got).unwrap();
    session.reset(&mut got).unwrap();
    session.seek(0.1, &mut got).unwrap();
    session.advance(Limit::steps(u64::MAX), &mut got).unwrap();
    assert_eq!(got.states, want.states);
    assert_eq!(got.samples, want.samples);
    assert_eq!(got.hashes, want.hashes);
}

#[test]
fn a_played_session_is_a_scene_that_plays_back_to_the_same_bits() {
    for method in METHODS {
        let mut session = open(method);
        let mut sink = Rows::default();
        let mut live = BTreeMap::new();
        let mut steps = |session: &mut Session, n: u64| {
            // After whatever was done to it here.
            live.insert(session.now().step, session.fingerprint());
            for _ in 0..n {
                session
                    .advance(Limit::steps(1), &mut Rows::default())
                    .unwrap();
                live.insert(session.now().step, session.fingerprint());
            }
        };
        steps(&mut session, 37);
        session
            .push(push("cone", Some(0.0333)), "push", &mut sink)
            .unwrap();
        steps(&mut session, 20);
        session
            .push_giving(2.5, push("plate", None), "spin", &mut sink)
            .unwrap();
        steps(&mut session, 77);
        session
            .set("damping.angular", "0.7", "set", &mut sink)
            .unwrap();
        steps(&mut session, 18);
        // In the step that an event of the scene divides, and at that event.
        assert_eq!(session.now().time, 0.3011, "{method}");
        session.again("again", &mut sink).unwrap();
        session.switch("damping", false, "off", &mut sink).unwrap();
        steps(&mut session, 50);
        session.switch("damping", true, "on", &mut sink).unwrap();
        session
            .set("damping", "{ angular = 0.3 }", "set", &mut sink)
            .unwrap();
        session
            .set(
                "plate.angular_velocity",
                "[0.1, 0.2, 0.3]",
                "set",
                &mut sink,
            )
            .unwrap();
        steps(&mut session, 30);
        let other = if method == "rk4" { "dop853" } else { "rk4" };
        session.method(other, None, "method", &mut sink).unwrap();
        steps(&mut session, 40);
        session
            .set("drag.quadratic", "0.05", "set", &mut sink)
            .unwrap();
        while !session.is_over() {
            steps(&mut session, 1);
        }
        assert_eq!(session.branches().len(), 1, "{method}");
        let want = straight(session.text());
        assert_eq!(want.len(), live.len(), "{method}");
        for (step, hash) in &live {
            assert_eq!(
                *hash,
                want[*step as usize],
                "{method} at {step}\n{}",
                session.text()
            );
        }
        // And back there, through all that was added.
        for step in [400, 36, 37, 38, 57, 134, 153, 203, 233, 234, 273] {
            session.seek_step(step, &mut sink).unwrap();
            assert_eq!(
                session.fingerprint(),
                want[step as usize],
                "{method} seek {step}"
            );
        }
        assert!(
            session
                .text()
                .contains("name = \"damping_3\"\ndamping = { angular = 0.3 }")
        );
    }
}

#[test]
fn a_change_in_the_past_makes_a_branch_and_leaves_the_old_one() {
    for method in METHODS {
        let mut session = open(method);
        let mut sink = Rows::default();
        let plain = straight(session.text());
        session.advance(Limit::steps(300), &mut sink).unwrap();
        session
            .push(push("plate", None), "push plate", &mut sink)
            .unwrap();
        assert_eq!(session.branches().len(), 1);
        session.advance(Limit::steps(50), &mut sink).unwrap();
        let main = straight(session.text());
        assert_eq!(main[299], plain[299]);
        assert_ne!(main[300], plain[300]);

        session.back(150, &mut sink).unwrap();
        let at = session.now();
        let before = session.text().to_owned();
        session
            .push(push("cone", Some(0.1)), "push cone", &mut sink)
            .unwrap();
        assert_eq!(session.branch().name, "branch-1");
        let parent = session.branch().parent.unwrap();
        assert_eq!(
            (parent.branch, parent.at, parent.from_start),
            (0, at, false)
        );
        // The old text, and the push at that very time.
        let added = session.text().strip_prefix(&before).unwrap();
        assert!(added.contains(&format!("at = {:?}", at.time)), "{added}");
        let one = straight(session.text());
        session.advance(Limit::steps(200), &mut sink).unwrap();
        assert_eq!(session.fingerprint(), one[400]);

        // A branch of the branch, before the place where that left.
        session.seek_step(130, &mut sink).unwrap();
        assert_eq!(session.fingerprint(), main[130]);
        session
            .set("gravity", "[0, -1.62, 0]", "set gravity", &mut sink)
            .unwrap();
        assert_eq!(session.branch().name, "branch-2");
        let two = straight(session.text());
        session.advance(Limit::steps(100), &mut sink).unwrap();
        assert_eq!(session.fingerprint(), two[230]);

        // What is added to the old one later is not in those.
        session.enter("main", &mut sink).unwrap();
        assert_eq!(session.fingerprint(), main[230], "{method}");
        session.seek_step(350, &mut sink).unwrap();
        session
            .push(push("plate", None), "push plate", &mut sink)
            .unwrap();
        session.seek_step(10, &mut sink).unwrap();
        session.seek_step(380, &mut sink).unwrap();
        let more = straight(session.text());
        assert_eq!(session.fingerprint(), more[380]);
        session.enter("branch-1", &mut sink).unwrap();
        for step in [380, 199, 200, 201, 64, 128, 330] {
            session.seek_step(step, &mut sink).unwrap();
            assert_eq!(session.fingerprint(), one[step as usize], "{method} {step}");
        }
        session.enter("branch-2", &mut sink).unwrap();
        for step in [131, 130, 129, 400, 64, 200] {
            session.seek_step(step, &mut sink).unwrap();
            assert_eq!(session.fingerprint(), two[step as usize], "{method} {step}");
        }
        assert!(session.enter("brunch-1", &mut sink).is_err());
    }
}

#[test]
fn from_the_start_everything_can_change() {
    let mut session = open("rk4");
    let mut sink = Rows::default();
    session.advance(Limit::steps(100), &mut sink).unwrap();
    let refused = |done: Result<(), SessionError>| match done {
        Err(SessionError::Refused(why)) => why,
        other => panic!("{other:?}"),
    };
    let why = refused(session.set("cone.mass", "3", "set cone.mass 3", &mut sink));
    assert!(why.contains("`set cone.mass 3 from start`"), "{why}");
    let why = refused(session.set("duration", "3", "set duration 3", &mut sink));
    assert!(why.contains("cannot change on the way"), "{why}");
    assert_eq!((session.branches().len(), session.now().step), (1, 100));

    session
        .set_from_start("cone.mass", "3", "set cone.mass 3", &mut sink)
        .unwrap();
    assert_eq!(
        (session.now().step, session.branch().name.as_str()),
        (0, "branch-1")
    );
    assert!(session.text().contains("mass = 3\n"));
    session
        .step_from_start(0.001, "step-size 0.001", &mut sink)
        .unwrap();
    session
        .method_from_start("taylor", Some(1e-9), "method", &mut sink)
        .unwrap();
    let want = straight(session.text());
    session.advance(Limit::steps(300), &mut sink).unwrap();
    assert_eq!(session.fingerprint(), want[300]);
    assert_eq!(session.now().time, 0.3);
    // What is wrong is told as the reader of scenes tells it, and nothing is changed.
    let why = refused(session.set_from_start(
        "cone.inertia",
        "[1, 1, 3]",
        "set cone.inertia [1, 1, 3]",
        &mut sink,
    ));
    assert!(
        why.contains("set cone.inertia [1, 1, 3]: ") && why.contains("3 > 1 + 1"),
        "{why}"
    );
    let why = refused(session.method("closed-form", None, "method closed-form", &mut sink));
    assert!(why.contains("is for bodies that no torque turns"), "{why}");
    let why = refused(session.set(
        "speed_limit.angular",
        "3",
        "set speed_limit.angular 3",
        &mut sink,
    ));
    assert!(why.contains("speed limit"), "{why}");
    assert_eq!(session.fingerprint(), want[300]);
    assert_eq!(session.branches().len(), 4);
}

#[test]
fn a_feather_and_a_ship_answer_alike() {
    let text = |mass: f64, size: f64| {
        format!(
            "duration = 1\n[effects]\ngyroscopic = true\n[[body]]\nname = \"b\"\nmass = {mass}\nshape = {{ cuboid = {{ x = {size}, y = {}, z = {} }} }}\norientation = {{ axis = [1, 2, 3], degrees = 50 }}\n",
            0.3 * size,
            0.1 * size
        )
    };
    for (mass, size) in [(1e-3, 0.05), (1.0, 1.0), (1e8, 200.0)] {
        for lasts in [None, Some(0.01)] {
            let script = Script::new("s", "s", &text(mass, size));
            let mut sink = Rows::default();
            let mut session = Session::open(script, Settings::default(), &mut sink).unwrap();
            session.advance(Limit::steps(10), &mut sink).unwrap();
            let push = Push {
                body: "b".to_owned(),
                what: What::Force {
                    force: Vector3::new(0.3, -0.2, 1.0),
                    at: Place::Body(Vector3::new(0.4, 0.1, 0.02) * size),
                },
                in_body: true,
                lasts,
            };
            let pushed = session.push_giving(2.0, push, "spin", &mut sink).unwrap();
            // By what it says of itself: of a blow Δω, else α T.
            let spin = pushed.alpha_w.norm() * lasts.unwrap_or(1.0);
            assert!((spin - 2.0).abs() < 1e-13, "{mass}: {spin}");
            // And by what becomes of the body: at rest it gets just that from a blow, and nearly from a short push.
            session.advance(Limit::steps(10), &mut sink).unwrap();
            let omega = session.numbers("b").unwrap().sample.motion.omega_w.norm();
            let off = if lasts.is_some() { 1e-3 } else { 0.05 };
            assert!((omega - 2.0).abs() < off, "{mass}: {omega}");
            let arm = pushed.arm_w.unwrap();
            let force = pushed.force_w.unwrap();
            assert!((arm.cross(&force) - pushed.torque_w).norm() <= 1e-14 * pushed.torque_w.norm());
            assert!(
                (pushed.lever.unwrap() * force.norm() / pushed.torque_w.norm() - 1.0).abs() < 1e-14
            );
        }
    }
    // Through the centre of mass nothing turns, however strong.
    let mut sink = Rows::default();
    let mut session = Session::open(
        Script::new("s", "s", &text(1.0, 1.0)),
        Settings::default(),
        &mut sink,
    )
    .unwrap();
    let mut push = push("b", None);
    push.what = What::Force {
        force: Vector3::x(),
        at: Place::World(Vector3::new(-3.0, 1e-5, 0.0)),
    };
    let why = session
        .push_giving(1.0, push.clone(), "spin", &mut sink)
        .unwrap_err()
        .to_string();
    assert!(
        why.contains("passes 1e-5 m from the centre of mass of b"),
        "{why}"
    );
    // In newtons it is a push like another.
    assert!(session.push(push, "push", &mut sink).is_ok());
}

#[test]
fn a_ray_finds_its_body() {
    let session = open("rk4");
    let ray = Ray {
        origin: Vector3::new(3.1, 5.0, 0.05),
        direction: Vector3::new(0.0, -2.0, 0.0),
    };
    let (body, picked) = session.pick(&ray).unwrap();
    assert_eq!(session.subjects()[body].name, "plate");
    assert!((picked.point_w - Vector3::new(3.1, 0.01, 0.05)).norm() < 1e-14);
    assert!((picked.normal_w - Vector3::y()).norm() < 1e-14);
}

/// The plate turns faster than a bound, rad/s.
fn faster(session: &Session, bound: f64) -> Condition {
    let vocabulary = Vocabulary::of(session.subjects());
    Condition::parse(&format!("angular_velocity.plate > {bound}"), &vocabulary).unwrap()
}

#[test]
fn a_breakpoint_stops_at_the_very_step() {
    let mut session = open("rk4");
    let mut sink = Rows::default();
    // By a second way: step by step.
    let mut speeds = Vec::new();
    while !session.is_over() {
        let numbers = session.numbers("plate").unwrap();
        speeds.push(numbers.sample.motion.omega_w.norm());
        session.advance(Limit::steps(1), &mut sink).unwrap();
    }
    session.reset(&mut sink).unwrap();
    // What only the plate's push brings about.
    let bound = 2.6;
    let want = speeds.iter().position(|x| *x > bound).unwrap();
    assert!(want > 100, "{want}");
    let (id, holds) = session.break_when(faster(&session, bound)).unwrap();
    assert!(!holds);
    let stop = session.advance(Limit::time(0.9), &mut sink).unwrap();
    let Some(Stop::Broke(broke)) = stop else {
        panic!("{stop:?}");
    };
    assert_eq!(
        (broke.at.step as usize, session.now().step as usize),
        (want, want)
    );
    assert_eq!((broke.id, broke.met.value), (id, speeds[want]));
    // It goes on, for it is no beginning any more; and stops again coming from before.
    assert_eq!(session.advance(Limit::steps(1), &mut sink).unwrap(), None);
    session.back(5, &mut sink).unwrap();
    assert!(matches!(
        session.advance(Limit::steps(100), &mut sink).unwrap(),
        Some(Stop::Broke(_))
    ));
    assert_eq!(session.now().step as usize, want);
    session.clear_break(id).unwrap();
    assert!(session.clear_break(id).is_err());
    // What holds by a push has begun with it.
    session.back(20, &mut sink).unwrap();
    session.break_when(faster(&session, 1000.0)).unwrap();
    let (step, strong) = (session.now().step, push("plate", None));
    session
        .push_giving(2000.0, strong, "spin", &mut sink)
        .unwrap();
    let stop = session.advance(Limit::steps(100), &mut sink).unwrap();
    assert!(matches!(stop, Some(Stop::Broke(broke)) if broke.at.step == step));
}

#[test]
fn a_lost_state_is_told_and_one_can_go_back() {
    let text = "duration = 1\n[stepping]\nmethod = \"explicit-euler\"\nstep = 0.01\n[effects]\ngyroscopic = true\n[[body]]\nname = \"b\"\nmass = 1.0\ninertia = [1, 2, 2.9]\nangular_velocity = [300, 40, 5]\n";
    let mut sink = Rows::default();
    let mut session =
        Session::open(Script::new("s", "s", text), Settings::default(), &mut sink).unwrap();
    let stop = session.advance(Limit::steps(u64::MAX), &mut sink).unwrap();
    assert!(
        matches!(&stop, Some(Stop::Lost(why)) if why.contains("b is no longer finite")),
        "{stop:?}"
    );
    let at = session.now();
    assert!(session.push(push("b", None), "push", &mut sink).is_err());
    assert!(matches!(
        session.advance(Limit::steps(1), &mut sink).unwrap(),
        Some(Stop::Lost(_))
    ));
    session.back(2, &mut sink).unwrap();
    assert!(session.failure().is_none());
    assert_eq!(session.now().step, at.step - 2);
    session.push(push("b", None), "push", &mut sink).unwrap();
    session.reset(&mut sink).unwrap();
    session
        .method_from_start("buss", None, "method buss from start", &mut sink)
        .unwrap();
    assert_eq!(
        session.advance(Limit::steps(u64::MAX), &mut sink).unwrap(),
        Some(Stop::End)
    );
}

#[test]
fn a_planned_scene_can_be_watched_and_takes_a_method() {
    let text = SCENE
        .replace(
            "[stepping]\nmethod = \"METHOD\"\nstep = 0.002\n",
            "[stepping]\naccuracy = 1e-6\n",
        )
        .replace("duration = 1.0", "duration = 0.4")
        .split("[[event]]\nat = 0.7")
        .next()
        .unwrap()
        .to_owned();
    let mut sink = Rows::default();
    let mut session =
        Session::open(Script::new("s", "s", &text), Settings::default(), &mut sink).unwrap();
    session.advance(Limit::steps(10), &mut sink).unwrap();
    let there = session.fingerprint();
    session.back(4, &mut sink).unwrap();
    session.advance(Limit::steps(4), &mut sink).unwrap();
    assert_eq!(session.fingerprint(), there);
    let why = session
        .push(push("plate", None), "push", &mut sink)
        .unwrap_err()
        .to_string();
    assert!(why.contains("`method dop853 from start`"), "{why}");
    session
        .method_from_start("dop853", None, "method dop853", &mut sink)
        .unwrap();
    session.advance(Limit::steps(10), &mut sink).unwrap();
    session
        .push(push("plate", None), "push", &mut sink)
        .unwrap();
}

/// A clock that is set, and goes on by a bit with every look.
struct Hand {
    now: Cell<f64>,
    look: f64,
}

impl Clock for Hand {
    fn seconds(&self) -> f64 {
        let now = self.now.get();
        self.now.set(now + self.look);
        now
    }
}

#[derive(Default, Clone)]
struct Shelf(Arc<Mutex<Vec<(String, String)>>>);

impl Saver for Shelf {
    fn save(&mut self, name: &str, text: &str) -> Result<String, String> {
        self.0
            .lock()
            .unwrap()
            .push((name.to_owned(), text.to_owned()));
        Ok(name.to_owned())
    }
}

fn console() -> (Console, Shelf, Hand) {
    let shelf = Shelf::default();
    let clock = Hand {
        now: Cell::new(50.0),
        look: 0.0,
    };
    (Console::new(open("rk4"), shelf.clone()), shelf, clock)
}

fn say(console: &mut Console, clock: &Hand, line: &str) -> Value {
    let answer = console.obey(line, clock, &mut Rows::default()).unwrap();
    assert!(!answer.contains('\n'));
    serde_json::from_str(&answer).unwrap()
}

#[test]
fn lines_drive_it_and_what_they_save_plays_back() {
    let (mut console, shelf, clock) = console();
    let mut say = |line: &str| {
        let answer = say(&mut console, &clock, line);
        assert_eq!(answer["ok"], true, "{line}: {answer}");
        answer
    };
    assert_eq!(say("step 10")["step"], 10);
    let pushed = &say("push cone 0 1 0  -10 0 0 for 0.1 body")["pushed"];
    // The arm of a push at the apex of a cone that turns about its base is its height: 10 N m.
    assert!(
        (pushed["lever_arm"].as_f64().unwrap() - 1.0).abs() < 1e-12,
        "{pushed}"
    );
    assert_eq!(pushed["for"], 0.1);
    say("step 30");
    let hit = say("click 3.1 5 0.05  0 -1 0 force 2 blow");
    assert_eq!(hit["pushed"]["body"], "plate");
    assert!(say("click 0 50 0  0 1 0")["hit"].is_null());
    say("step");
    say("twist plate 0 1 0 3 for 0.05");
    say("again");
    say("step 20");
    say("set damping.angular 0.4");
    say("effect gravity off");
    say("method cf4");
    say("step 100");
    say("effect gravity on");
    let end = say("step 150");
    let hash = console.session().fingerprint();
    let mut say = |line: &str| self::say(&mut console, &clock, line);
    assert_eq!(say("save pushes.toml")["saved"], "pushes.toml");
    let saved = shelf.0.lock().unwrap()[0].1.clone();
    let want = straight(&saved);
    assert_eq!(hash, want[end["step"].as_u64().unwrap() as usize]);

    let state = say("state cone");
    let state = &state["state"];
    for key in [
        "orientation",
        "euler",
        "angular_velocity",
        "angular_momentum",
        "torque",
        "torque_by_source",
        "angular_acceleration",
        "inertia",
        "kinetic_energy",
    ] {
        assert!(!state[key].is_null(), "{key}: {state}");
    }
    // Each source's torque, and all of them are I α.
    let sources = state["torque_by_source"].as_object().unwrap();
    assert_eq!(
        sources.keys().collect::<Vec<_>>(),
        ["damping_2", "gravity", "gyroscopic"]
    );
    let number = |value: &Value, k: usize| value[k].as_f64().unwrap();
    for k in 0..3 {
        let sum: f64 = sources.values().map(|torque| number(torque, k)).sum();
        let alpha = (0..3)
            .map(|i| number(&state["inertia"][k], i) * number(&state["angular_acceleration"], i));
        let alpha: f64 = alpha.sum();
        assert!((sum - alpha).abs() < 1e-10, "{k}: {sum} {alpha}");
    }

    say("back 50");
    say("push plate 3 0 0 0 0 1");
    let branches = say("branches");
    assert_eq!(branches["branches"][1]["parent"]["branch"], "main");
    assert_eq!(
        branches["branches"][1]["changes"][0],
        "push plate 3 0 0 0 0 1"
    );
    assert_eq!(say("branch main")["branch"], "main");
    assert_eq!(say("seek 0.25")["time"], 0.25);
    assert_eq!(say("where")["speed"], 1.0);
    assert_eq!(say("help push")["command"]["command"], "push");
    assert_eq!(say("quit")["ok"], true);
    assert!(console.has_quit());
}

#[test]
fn what_is_wrong_is_answered_and_changes_nothing() {
    let (mut console, _, clock) = console();
    say(&mut console, &clock, "step 20");
    let hash = console.session().fingerprint();
    for (line, column, why) in [
        ("stpe", Some(1), "did you mean `step`?"),
        ("push cone 0 1 0 a 0 0", Some(17), "no number"),
        ("push cuone 0 1 0 1 0 0", None, "did you mean `cone`?"),
        ("break when angular velocity > 3x", Some(31), "3x"),
        ("step-size 1e-3", None, "`step-size 0.001 from start`"),
        ("step 99999999999", None, "which one command takes at most"),
        ("seek 1e300", None, "which one command takes at most"),
        ("set damping.angular x y", None, "is a string, not a number"),
        ("set cone.angular_velocity [1, 2]", None, "angular_velocity"),
        (
            "set cone.angular_velocity [0, 0, 0] }, b = { c = 1",
            None,
            "the value is not TOML",
        ),
        ("set cone.position [1, 2, 3]", None, "pivot"),
        ("effect gravtiy off", None, "did you mean `gravity`?"),
        ("effect gravity on", None, "is on already"),
        ("method rk44", None, "rk4"),
        ("clear 7", None, "no breakpoint 7"),
        (
            "spin cone 0 0 0  1 0 0  3 body",
            None,
            "turns next to nothing",
        ),
        ("twist cone 0 0 0 3", None, "no direction"),
        ("state nobody", None, "known here: cone, plate"),
    ] {
        let answer = say(&mut console, &clock, line);
        assert_eq!(answer["ok"], false, "{line}: {answer}");
        assert!(
            answer["error"].as_str().unwrap().contains(why),
            "{line}: {answer}"
        );
        assert_eq!(answer["column"].as_u64(), column, "{line}: {answer}");
    }
    assert_eq!(console.session().fingerprint(), hash);
    assert_eq!(console.session().branches().len(), 1);
    assert!(console.session().branch().changes.is_empty());
}

#[test]
fn it_keeps_pace_with_a_clock() {
    let (mut console, _, clock) = console();
    let mut sink = Rows::default();
    say(&mut console, &clock, "speed 0.5");
    say(&mut console, &clock, "play");
    for k in 1..=60 {
        clock.now.set(50.0 + f64::from(k) / 60.0);
        let pacing = console.turn(&clock, &mut sink).unwrap().pacing.unwrap();
        // What is due, but for the step that is not over.
        let late = pacing.due - pacing.reached;
        // The clock takes what is nearer than 1e-9 steps for one instant.
        assert!((-2e-12..=0.002 + 2e-12).contains(&late), "{pacing:?}");
        assert_eq!(pacing.lost, 0.0);
    }
    assert_eq!(console.session().now().time, 0.5);
    // Standing costs no time.
    say(&mut console, &clock, "pause");
    clock.now.set(99.0);
    assert!(console.turn(&clock, &mut sink).unwrap().pacing.is_none());
    say(&mut console, &clock, "loop on");
    say(&mut console, &clock, "play");
    // The end after a second at half speed, and then again from the start without a gap.
    let mut looped = 0;
    for k in 1..=295 {
        clock.now.set(99.0 + f64::from(k) / 100.0);
        let said = console.turn(&clock, &mut sink).unwrap();
        looped += said
            .lines
            .iter()
            .filter(|line| line.contains("looped"))
            .count();
    }
    assert_eq!(looped, 1);
    let now = console.session().now().time;
    // 2.95 s at half speed from 0.5 s on, less the 1 s of the first time.
    assert!(console.is_playing() && (now - 0.975).abs() < 0.003, "{now}");
}

#[test]
fn a_slow_machine_slows_it_and_a_breakpoint_pauses_it() {
    let (mut console, _, clock) = console();
    // Every look at the clock costs 10 ms: that of a machine that is far too slow.
    let clock = Hand {
        look: 0.01,
        ..clock
    };
    let mut sink = Rows::default();
    say(&mut console, &clock, "speed 10");
    say(&mut console, &clock, "play");
    let mut last = None;
    for _ in 0..20 {
        let before = console.session().now().step;
        last = console.turn(&clock, &mut sink).unwrap().pacing.or(last);
        // No more at a time than two looks' worth.
        assert!(console.session().now().step - before <= 4);
    }
    let pacing = last.unwrap();
    assert!(pacing.lost > 0.1 && pacing.behind > 0.2, "{pacing:?}");
    let (mut console, _, clock) = self::console();
    say(
        &mut console,
        &clock,
        "break when angular_velocity.plate > 2.6",
    );
    say(&mut console, &clock, "speed max");
    say(&mut console, &clock, "play");
    let mut lines = Vec::new();
    while console.is_playing() {
        lines.extend(console.turn(&clock, &mut sink).unwrap().lines);
    }
    assert_eq!(lines.len(), 1);
    let told: Value = serde_json::from_str(&lines[0]).unwrap();
    assert_eq!(told["stopped"]["why"], "break", "{told}");
    assert_eq!(told["stopped"]["condition"], "angular_velocity.plate > 2.6");
    assert_eq!(told["stopped"]["step"], told["step"]);
}

#[test]
fn the_page_lists_the_commands() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/live.md");
    let page = std::fs::read_to_string(path).unwrap();
    let table = torquescope::session::protocol::table();
    assert!(page.contains(&table), "docs/live.md lacks:\n{table}");
}

mod any_session {
    use super::*;
    use proptest::prelude::*;

    /// Lines of every kind, right and wrong, some on what others make.
    fn line() -> impl Strategy<Value = String> {
        let number = prop_oneof![Just(0.0), -2.0..2.0_f64, Just(1e300), Just(-1e-300)];
        prop_oneof![
            (1..90_u64).prop_map(|n| format!("step {n}")),
            (1..200_u64).prop_map(|n| format!("back {n}")),
            (0.0..0.3_f64).prop_map(|t| format!("seek {t}")),
            (number.clone(), 0.0..0.05_f64)
                .prop_map(|(x, t)| format!("push plate 3 0.1 0 {x} 0.1 -0.2 for {t}")),
            number
                .clone()
                .prop_map(|x| format!("torque cone 0.1 {x} 0 body")),
            number.prop_map(|x| format!("spin plate 0.1 0 0.1 0 1 0 {x} body for 0.01")),
            (0.1..2.0_f64).prop_map(|x| format!("set damping.angular {x}")),
            (-1.0..1.0_f64).prop_map(|x| format!("set plate.velocity [{x}, 0, 0]")),
            prop_oneof![
                Just("again"),
                Just("reset"),
                Just("click 3.1 5 0.05  0 -1 0"),
                Just("effect gravity off"),
                Just("effect gravity on"),
                Just("effect damping off"),
                Just("method taylor"),
                Just("method cf4"),
                Just("branch main"),
                Just("branch branch-1"),
                Just("break when angular velocity > 3"),
                Just("method dop853 from start"),
                Just("set cone.mass 2 from start"),
                Just("state plate"),
                Just("branches"),
                Just("step-size 1e-3"),
                Just("nonsense é"),
            ]
            .prop_map(str::to_owned),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

        /// Whatever is said, what one sees is what the text plays back.
        #[test]
        fn is_what_its_text_plays_back(lines in proptest::collection::vec(line(), 1..25)) {
            let (mut console, _, clock) = console();
            for line in &lines {
                let answer = say(&mut console, &clock, line);
                prop_assert!(answer["ok"].is_boolean(), "{line}: {answer}");
            }
            let session = console.session();
            if session.failure().is_none() {
                let scene = Arc::new(Scene::parse("s", "s", session.text()).unwrap());
                let mut stated = Stated::of(&scene).unwrap();
                let mut run = Run::new(scene);
                let limit = Limit::steps(session.now().step);
                run.go(limit, &mut stated, &mut Rows::default()).unwrap();
                prop_assert_eq!(run.fingerprint(), session.fingerprint(), "{:?}", lines);
            }
        }
    }
}
