//! Each source's own torque: the parts, found one by one from the scene, add up to what turns the body.

mod common;

use common::Memory;
use nalgebra::Vector3;
use torquescope::scene::Scene;
use torquescope::trace::{Sample, Subject};

fn run(source: &str) -> (Vec<Subject>, Memory) {
    let scene = Scene::parse("inline", "inline", source).unwrap_or_else(|error| panic!("{error}"));
    let (subjects, _, memory) = common::run(&scene);
    (subjects, memory)
}

const BODIES: &str = r#"
[[body]]
name = "top"
shape = { cone = { radius = 0.5, height = 1.0 } }
mass = 2.0
pivot = "apex"
orientation = { axis = [1, 0, 0], degrees = 150 }
angular_velocity = [0.3, 9.0, 0.5]

[[body]]
name = "free"
shape = { cuboid = { x = 0.3, y = 0.5, z = 0.9 } }
mass = 2.0
position = [5, 0, 0]
angular_velocity = [2.0, 3.0, -1.0]

[[event]]
at = 0.2
for = 0.5
body = "top"
force = [3.0, 0.0, 1.0]
point = "base"

[[event]]
at = 0.4
for = 0.2
body = "top"
torque = [0.0, 0.0, 0.7]
frame = "body"

[[event]]
at = 0.3
for = 0.4
body = "free"
torque = [0.1, 0.2, 0.7]
"#;

fn scene(effects: &str) -> String {
    format!("duration = 1.0\n[record]\nrate = 50\n[effects]\n{effects}\n{BODIES}")
}

fn close(a: Vector3<f64>, b: Vector3<f64>) -> bool {
    // A few roundings of products of a few numbers.
    (a - b).norm() <= 1e-14 * (1.0 + a.norm().max(b.norm()))
}

/// `I α`, with α as the model has it and I as the trace says.
fn inertial_torque(subject: &Subject, sample: &Sample) -> Vector3<f64> {
    let q = sample.motion.q_wb;
    q * (subject.inertia_b * (q.inverse() * sample.alpha_w))
}

fn names(subject: &Subject) -> Vec<&str> {
    subject.sources.iter().map(String::as_str).collect()
}

#[test]
fn the_parts_add_up_to_what_turns_the_body() {
    let effects = "gyroscopic = true\ngravity = [0.0, -9.81, 0.0]\ndamping = { angular = 0.3 }";
    let (subjects, kept) = run(&scene(effects));
    assert_eq!(
        names(&subjects[0]),
        ["gravity", "damping", "gyroscopic", "push", "torque"]
    );
    // The weight of a free body turns nothing.
    assert_eq!(names(&subjects[1]), ["damping", "gyroscopic", "torque"]);
    let mut seen = 0;
    for (at, body, sample) in &kept.samples {
        let subject = &subjects[*body];
        assert_eq!(sample.sources.len(), subject.sources.len());
        let sum: Vector3<f64> = sample.sources.iter().sum();
        assert!(
            close(sum, inertial_torque(subject, sample)),
            "{} {body}",
            at.time
        );
        let named = |name: &str| {
            let place = names(subject).into_iter().position(|n| n == name);
            place.map_or(Vector3::zeros(), |place| sample.sources[place])
        };
        let momentum_w = subject.momentum_w(&sample.motion);
        let gyroscopic = momentum_w.cross(&sample.motion.omega_w);
        assert!(close(named("gyroscopic"), gyroscopic));
        assert!(close(named("damping"), momentum_w * -0.3));
        assert!(close(sum - named("gyroscopic"), sample.tau_w));
        if *body == 0 {
            let arm_w = sample.motion.position_w - sample.reference_w(subject);
            let weight = arm_w.cross(&Vector3::new(0.0, -2.0 * 9.81, 0.0));
            assert!(close(named("gravity"), weight));
            let acts = sample.pushes.first();
            let push = acts.map_or(Vector3::zeros(), |push| {
                (push.point_w - sample.reference_w(subject)).cross(&push.force_w)
            });
            assert!(close(named("push"), push));
            seen += usize::from(push.norm() > 0.0);
        }
    }
    assert!(seen > 20, "the push was seen at {seen} instants");
}

#[test]
fn in_the_tutorials_model_there_is_no_gyroscopic_part() {
    let (subjects, kept) = run(&scene("gravity = [0.0, -9.81, 0.0]"));
    assert_eq!(names(&subjects[0]), ["gravity", "push", "torque"]);
    for (_, _, sample) in kept.samples.iter().filter(|(_, body, _)| *body == 0) {
        let sum: Vector3<f64> = sample.sources.iter().sum();
        assert!(close(sum, sample.tau_w));
        assert!(close(sum, inertial_torque(&subjects[0], sample)));
    }
}

#[test]
fn what_is_not_called_for_or_says_nothing_new_is_absent() {
    let alone = "duration = 1.0\n[effects]\ngyroscopic = true\n[[body]]\nname = \"b\"\nmass = 1.0\ninertia = [1, 2, 2.5]\nangular_velocity = [1, 1, 1]\n";
    let (subjects, kept) = run(alone);
    assert!(subjects[0].sources.is_empty());
    assert!(kept.samples.iter().all(|(_, _, s)| s.sources.is_empty()));
    let source = scene("gyroscopic = true\ngravity = [0.0, -9.81, 0.0]")
        .replace("rate = 50", "rate = 50\nstreams = [\"torque\"]");
    let (subjects, kept) = run(&source);
    assert!(subjects.iter().all(|s| s.sources.is_empty()));
    assert!(kept.samples.iter().all(|(_, _, s)| s.sources.is_empty()));
}
