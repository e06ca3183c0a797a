//! Properties that hold for every body, attitude and push.

mod common;

use common::Nowhere;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use proptest::prelude::*;
use torquescope::body::{Inertial, State};
use torquescope::mass::tensor::{check_held, check_physical, parallel_axis, turned};
use torquescope::mass::{MassProperties, solids::SOLIDS};
use torquescope::math::symmetric_eigen;
use torquescope::scene::{Scene, Script};

fn vector(size: f64) -> impl Strategy<Value = Vector3<f64>> {
    [-size..size, -size..size, -size..size].prop_map(Vector3::from)
}

fn attitude() -> impl Strategy<Value = UnitQuaternion<f64>> {
    [-1.0..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0_f64]
        .prop_filter("a direction", |q| {
            q.iter().map(|x| x * x).sum::<f64>() > 1e-2
        })
        .prop_map(|[x, y, z, w]| UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)))
}

/// A tensor some body has: of three to eight point masses, so in general position.
fn inertia() -> impl Strategy<Value = Matrix3<f64>> {
    prop::collection::vec((0.1..2.0_f64, vector(1.0)), 3..8)
        .prop_map(|points| {
            points.iter().fold(Matrix3::zeros(), |sum, (mass, at)| {
                sum + parallel_axis(&Matrix3::zeros(), *mass, *at)
            })
        })
        .prop_filter("thick enough to invert", |tensor| {
            symmetric_eigen(tensor).1.min() > 1e-3
        })
}

fn world(tensor_b: &Matrix3<f64>, q: &UnitQuaternion<f64>) -> Matrix3<f64> {
    turned(tensor_b, q.to_rotation_matrix().matrix())
}

fn at(inertial_q: UnitQuaternion<f64>, omega_w: Vector3<f64>) -> State {
    State {
        x_w: Vector3::zeros(),
        v_w: Vector3::zeros(),
        q_wp: inertial_q.into_inner(),
        omega_w,
    }
}

proptest! {
    #[test]
    fn the_world_tensor_is_symmetric_with_the_bodys_eigenvalues(tensor in inertia(), q in attitude()) {
        let turned = world(&tensor, &q);
        let scale = tensor.norm();
        prop_assert_eq!(turned, turned.transpose());
        // nalgebra's own solver is the second opinion.
        let mut own: Vec<f64> = symmetric_eigen(&tensor).1.iter().copied().collect();
        let mut other: Vec<f64> = turned.symmetric_eigenvalues().iter().copied().collect();
        own.sort_by(f64::total_cmp);
        other.sort_by(f64::total_cmp);
        for (a, b) in own.iter().zip(&other) {
            // Rounding of two solvers and of two matrix products.
            prop_assert!((a - b).abs() < 2e-14 * scale, "{a} {b}");
        }
    }

    #[test]
    fn alpha_is_the_same_in_every_frame(tensor in inertia(), q in attitude(), other in attitude(), tau in vector(10.0)) {
        let properties = MassProperties::new(1.0, tensor, [false; 3]).unwrap();
        let (inertial, q_bp) = Inertial::new(&properties, None);
        let alpha = |q: UnitQuaternion<f64>, tau| inertial.angular_response(&at(q * q_bp, Vector3::zeros()), tau);
        let here = alpha(q, tau);
        let there = alpha(other * q, other * tau);
        // By way of principal axes against a plain inverse of the world tensor.
        let plain = world(&tensor, &q).try_inverse().unwrap() * tau;
        let condition = symmetric_eigen(&tensor).1.max() / symmetric_eigen(&tensor).1.min();
        let bound = 1e-14 * condition * (1.0 + here.norm());
        prop_assert!((other * here - there).norm() < bound);
        prop_assert!((here - plain).norm() < bound, "{here} {plain}");
    }

    #[test]
    fn momentum_and_response_undo_each_other(tensor in inertia(), q in attitude(), omega in vector(5.0)) {
        let properties = MassProperties::new(1.0, tensor, [false; 3]).unwrap();
        let (inertial, q_bp) = Inertial::new(&properties, None);
        let state = at(q * q_bp, omega);
        let back = inertial.angular_response(&state, inertial.momentum_w(&state));
        let condition = inertial.moments.max() / inertial.moments.min();
        prop_assert!((back - omega).norm() < 1e-14 * condition * (1.0 + omega.norm()));
    }

    #[test]
    fn a_push_through_the_centre_gives_no_torque(q in attitude(), at in vector(50.0), force in vector(100.0)) {
        let source = |point: &str| format!(
            "duration = 0.001\n[[body]]\nname = \"b\"\nshape = {{ cone = {{ radius = 1.0, height = 2.0 }} }}\nmass = 1.0\nposition = [{}, {}, {}]\norientation = [{}, {}, {}, {}]\n[[event]]\nat = 0.0\nfor = 0.001\nbody = \"b\"\nforce = [{}, {}, {}]\npoint = {point}\n",
            at.x, at.y, at.z, q.i, q.j, q.k, q.w, force.x, force.y, force.z
        );
        for point in ["\"centre\"".to_owned(), format!("[{}, {}, {}]", at.x, at.y, at.z)] {
            let scene = torquescope::scene::Scene::parse("p", "p", &source(&point)).unwrap();
            let (outcome, _) = torquescope::sim::Simulation::new(&scene).run(&mut Nowhere);
            let tau = outcome.blows[0].sample.tau_w;
            prop_assert_eq!(tau, Vector3::zeros());
        }
    }

    #[test]
    fn the_parallel_axis_leads_there_and_back(tensor in inertia(), mass in 0.1..10.0_f64, d in vector(5.0)) {
        let there = parallel_axis(&tensor, mass, d);
        prop_assert!(check_physical(&there).is_ok());
        let back = parallel_axis(&there, -mass, d);
        // A rounding or two at the size of what was added.
        prop_assert!((back - tensor).norm() < 4.0 * f64::EPSILON * there.norm());
    }

    #[test]
    fn point_masses_always_make_a_physical_tensor(tensor in inertia()) {
        prop_assert!(check_physical(&tensor).is_ok());
    }

    #[test]
    fn solids_obey_the_triangle_inequality_and_scale_with_mass(
        lengths in [0.01..100.0_f64, 0.01..100.0, 0.01..100.0], mass in 0.01..100.0_f64
    ) {
        for kind in SOLIDS {
            let mut lengths = lengths[..kind.parameters.len()].to_vec();
            // What is inside is smaller.
            if ["hollow_sphere", "tube", "torus"].contains(&kind.name) {
                lengths[1] = lengths[0] * 0.9;
            }
            let solid = (kind.make)(&lengths).unwrap();
            let moments = solid.moments(mass);
            // A rod may not turn about itself.
            let held = [false, kind.name == "rod", false];
            let checked = check_held(&Matrix3::from_diagonal(&moments), held);
            prop_assert!(checked.is_ok(), "{}", kind.name);
            let twice = solid.moments(2.0 * mass);
            prop_assert!((twice - moments * 2.0).norm() <= 1e-15 * twice.norm());
        }
    }
}

/// Scenes to be maltreated: those that ship, and ways of writing that they do not use.
fn texts() -> Vec<String> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let files = std::fs::read_dir(folder).unwrap().flatten();
    let mut texts: Vec<String> = files
        .map(|file| std::fs::read_to_string(file.path()).unwrap())
        .collect();
    let body = "mass = 1, inertia = [1, 1, 1]";
    texts.push(format!("duration = 1\neffects.damping.angular = 1\nbody = [{{ name = \"a\", {body} }}, {{ name = \"b\", {body} }}]\nevent = [{{ at = 0.5, body = \"a\", torque = [1, 0, 0], for = 0.1 }}]\nsweep = {{ step = [0.1, 0.2] }}"));
    texts.push(format!("# Notes.\r\nduration = 1\r\n[effects.damping] # ä\r\nangular = 1\r\n[[body]]\r\nname = \"a\"\r\n{}\r\n[sweep.body.a]\r\nmass = [\r\n  1, # one\r\n  2\r\n]", body.replace(", i", "\r\ni")));
    texts
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Whatever the text and whatever is set in it: scenes or reasons, and a scene is what its text says.
    #[test]
    fn values_put_into_any_text(
        which in 0..64_usize,
        cut in (0..4000_usize, 0..40_usize),
        paths in prop::collection::vec((0..16_usize, 0..9_usize), 0..3),
        until in prop::option::of(0.0..3.0_f64),
    ) {
        const PATHS: [&str; 16] = ["duration", "step", "damping", "effects.damping.linear", "gravity", "gyroscopic", "method", "a.mass", "body.0.shape.cone.radius", "event.0.at", "event.0.force.x", "sweep.step", "effects", "record.streams", "\"a.b\".c", "stepping.tolerance"];
        const VALUES: [&str; 9] = ["0.01", "[0, 1, 2]", "jolt", "true", "{ a = 1 }", "\"ä\"", "[\n1 # one\n]", "-1e400", "[{}"];
        let texts = texts();
        let text = &texts[which % texts.len()];
        let floor = |mut at: usize| {
            at = at.min(text.len());
            while !text.is_char_boundary(at) { at -= 1; }
            at
        };
        let (from, to) = (floor(cut.0), floor(cut.0 + cut.1));
        let text = format!("{}{}", &text[..from], &text[to..]);
        let mut script = Script::new("s.toml", "s", &text);
        for (path, value) in paths {
            let set = format!("{}={}", PATHS[path], VALUES[value]);
            let _ = script.set(&set, &format!("--set {set}"));
        }
        if let Some(end) = until {
            script.end_at(end, "--until");
        }
        match script.scenes() {
            Err(problems) => prop_assert!(!problems.to_string().is_empty()),
            Ok(scenes) => for scene in scenes {
                let again = Scene::parse("again", "s", &scene.text).map_err(|why| TestCaseError::fail(format!("{why}\n{}", scene.text)))?;
                prop_assert_eq!(again.fingerprint, scene.fingerprint);
            },
        }
    }
}
