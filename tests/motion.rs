//! Whole motions against closed forms, outside digits, and the same motion written differently.

mod common;

use common::Nowhere;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use torquescope::scene::Scene;
use torquescope::sim::{Outcome, Simulation};
use torquescope::trace::{Sample, Subject};

fn run(source: &str) -> (Vec<Subject>, Outcome) {
    let scene = Scene::parse("inline", "inline", source).unwrap_or_else(|error| panic!("{error}"));
    let simulation = Simulation::new(&scene);
    let subjects = simulation.subjects().to_vec();
    let (outcome, done) = simulation.run(&mut Nowhere);
    done.unwrap();
    (subjects, outcome)
}

fn list(v: &[f64]) -> String {
    let numbers: Vec<String> = v.iter().map(|x| format!("{x:?}")).collect();
    format!("[{}]", numbers.join(", "))
}

fn rows(m: &Matrix3<f64>) -> String {
    let rows: Vec<String> = m.row_iter().map(|r| list(&[r[0], r[1], r[2]])).collect();
    format!("[{}]", rows.join(", "))
}

fn coords(q: &UnitQuaternion<f64>) -> String {
    list(q.coords.as_slice())
}

/// The heavy asymmetric top of an outside reference (Taylor integration in 40 digits): pivot at
/// the origin, gravity along -z, moments about the pivot (1, 1.6, 2.1), m g c = (0.3, 0.2, 1) in the
/// body, attitude at t = 100.
#[test]
fn the_heavy_asymmetric_top() {
    let q0 = UnitQuaternion::new_normalize(Quaternion::new(0.86_f64.sqrt(), 0.1, 0.3, -0.2));
    let reference = Quaternion::new(
        -0.071_524_906_474_226_4,
        -0.051_812_189_728_397_3,
        -0.229_010_135_522_556_6,
        -0.969_409_120_332_801_6,
    );
    // m = 10 and g = 1, so c = (0.03, 0.02, 0.1): about the centre of mass the tensor is not
    // diagonal, and the principal axes about the pivot are found by the program.
    let (mass, c) = (10.0, Vector3::new(0.03, 0.02, 0.1));
    let about_pivot = Matrix3::from_diagonal(&Vector3::new(1.0, 1.6, 2.1));
    let shift = (Matrix3::identity() * c.norm_squared() - c * c.transpose()) * mass;
    let error = |step: f64| {
        let source = format!(
            "duration = 100.0\n[stepping]\nmethod = \"rk4\"\nstep = {step}\n[record]\nstate = 1\nrate = 1\n[effects]\ngyroscopic = true\ngravity = [0.0, 0.0, -1.0]\n[[body]]\nname = \"top\"\nmass = {mass}\ninertia = {}\nposition = {}\norientation = {}\nangular_velocity = {}\npivot = {}\n",
            rows(&(about_pivot - shift)),
            list((q0 * c).as_slice()),
            coords(&q0),
            list((q0 * Vector3::new(0.5, -0.8, 2.0)).as_slice()),
            list((-c).as_slice()),
        );
        let (_, outcome) = run(&source);
        let d = outcome.end[0].motion.q_wb.conjugate().into_inner() * reference;
        2.0 * d.imag().norm().atan2(d.w.abs())
    };
    let (coarse, fine) = (error(5e-3), error(2.5e-3));
    // Measured 6e-9 at 2.5e-3; fourth order: halving the step divides by 16.
    assert!(fine < 2e-8, "{fine:e}");
    let ratio = coarse / fine;
    assert!(
        (12.0..22.0).contains(&ratio),
        "{coarse:e} / {fine:e} = {ratio}"
    );
}

/// A body is the same body whatever axes its description uses: turned by R, with the inertia, the
/// points and the body vectors turned along and the orientation turned back.
#[test]
fn the_same_motion_from_another_choice_of_body_axes() {
    let r = UnitQuaternion::from_euler_angles(0.4, -1.1, 2.3);
    let q0 = UnitQuaternion::from_euler_angles(-0.7, 0.2, 0.9);
    let inertia = Matrix3::from_diagonal(&Vector3::new(0.5, 0.8, 1.1));
    let source = |turn: &UnitQuaternion<f64>, pivot: bool, gyroscopic: bool| {
        let m = turn.to_rotation_matrix();
        let body = |v: [f64; 3]| list((turn * Vector3::from(v)).as_slice());
        let hold = match pivot {
            true => format!("pivot = {}\n", body([0.1, -0.3, 0.2])),
            false => "velocity = [0.1, 0.2, 0.3]\n".to_owned(),
        };
        format!(
            "duration = 2.0\n[stepping]\nmethod = \"rk4\"\nstep = 0.002\n[effects]\ngyroscopic = {gyroscopic}\ngravity = [1.0, -9.0, 0.5]\ndamping = {{ angular = 0.3, linear = 0.2 }}\n[[body]]\nname = \"b\"\nmass = 2.0\ninertia = {}\norientation = {}\nangular_velocity = [0.3, -1.0, 0.7]\nposition = [1.0, 2.0, 3.0]\n{hold}[[event]]\nat = 0.1003\nfor = 0.3\nbody = \"b\"\nforce = {}\npoint = {}\nframe = \"body\"\n[[event]]\nat = 0.25\nfor = 0.5\nbody = \"b\"\nforce = [1.0, 2.0, -3.0]\npoint = {{ body = {} }}\n[[event]]\nat = 0.5\nfor = 0.4\nbody = \"b\"\ntorque = {}\nframe = \"body\"\n[[event]]\nat = 0.7777\nbody = \"b\"\nimpulse = {}\npoint = {}\nframe = \"body\"\n[[event]]\nat = 1.1\nbody = \"b\"\nangular_impulse = {}\nframe = \"body\"\n",
            rows(&(m.matrix() * inertia * m.matrix().transpose()).symmetric_part()),
            coords(&(q0 * turn.inverse())),
            body([1.0, -2.0, 0.5]),
            body([0.2, 0.5, -0.4]),
            body([-0.3, 0.1, 0.6]),
            body([0.7, -0.4, 0.2]),
            body([0.5, 0.5, -0.2]),
            body([0.0, 0.4, 0.1]),
            body([-0.2, 0.3, 0.1]),
        )
    };
    for (pivot, gyroscopic) in [(false, false), (false, true), (true, false), (true, true)] {
        let (one_subject, one) = run(&source(&UnitQuaternion::identity(), pivot, gyroscopic));
        let (other_subject, other) = run(&source(&r, pivot, gyroscopic));
        let (a, b) = (&one.end[0], &other.end[0]);
        // A thousand steps of numbers of size 10, rounded differently.
        let bound = 1e-12;
        assert!((a.motion.position_w - b.motion.position_w).norm() < bound);
        assert!((a.motion.velocity_w - b.motion.velocity_w).norm() < bound);
        assert!((a.motion.omega_w - b.motion.omega_w).norm() < bound);
        assert!(a.motion.q_wb.angle_to(&(b.motion.q_wb * r)) < bound);
        assert!((a.tau_w - b.tau_w).norm() < bound && (a.alpha_w - b.alpha_w).norm() < bound);
        let momentum = |s: &Subject, sample: &Sample| s.momentum_w(&sample.motion);
        let (la, lb) = (momentum(&one_subject[0], a), momentum(&other_subject[0], b));
        assert!((la - lb).norm() < bound);
        if !pivot {
            // And it did move: gravity for two seconds.
            assert!(a.motion.position_w.y < -5.0);
        }
    }
}

/// `Δv = J/m`, `Δω = I⁻¹ (r × J)`, by hand.
#[test]
fn an_impulse_on_a_free_body_and_on_a_held_one() {
    let source = |pivot: &str| {
        format!(
            "duration = 0.5\n[[body]]\nname = \"b\"\nmass = 2.0\ninertia = [0.5, 0.8, 1.1]\n{pivot}[[event]]\nat = 0.5\nbody = \"b\"\nimpulse = [0.0, 3.0, 0.0]\npoint = [0.4, 0.0, 0.0]\n"
        )
    };
    let (subjects, free) = run(&source(""));
    let end = &free.end[0].motion;
    assert_eq!(end.velocity_w, Vector3::new(0.0, 1.5, 0.0));
    // r × J = (0.4, 0, 0) × (0, 3, 0) = (0, 0, 1.2); over 1.1.
    assert!((end.omega_w - Vector3::new(0.0, 0.0, 1.2 / 1.1)).norm() < 1e-15);
    // ½·2·1.5² + ½·1.1·(1.2/1.1)².
    let energy = 2.25 + 0.5 * 1.2 * 1.2 / 1.1;
    assert!((subjects[0].energy(end) - energy).abs() < 1e-15 * 4.0);
    assert!((free.blows[0].jump.unwrap().angular_impulse_w.z - 1.2).abs() < 1e-15);

    let (subjects, held) = run(&source("pivot = [-0.6, 0.0, 0.0]\n"));
    let end = &held.end[0].motion;
    // Arm 1 m; I about the pivot 1.1 + 2·0.36 = 1.82.
    let omega = 3.0 / 1.82;
    assert!((end.omega_w - Vector3::new(0.0, 0.0, omega)).norm() < 1e-15 * 4.0);
    // The centre of mass, 0.6 m from the pivot, moves along.
    assert!((end.velocity_w - Vector3::new(0.0, 0.6 * omega, 0.0)).norm() < 1e-15 * 4.0);
    assert!((subjects[0].energy(end) - 0.5 * 1.82 * omega * omega).abs() < 1e-15 * 8.0);
}

#[test]
fn damping_as_a_rate_and_as_the_tutorials_factor() {
    let source = |method: &str, damping: &str| {
        format!(
            "duration = 0.25\n[stepping]\nmethod = \"{method}\"\nstep = 0.0625\n[effects]\ndamping = {{ {damping} }}\n[[body]]\nname = \"b\"\nmass = 2.0\ninertia = [0.5, 0.8, 1.1]\nvelocity = [8.0, 0.0, 0.0]\nangular_velocity = [0.0, 16.0, 0.0]\n"
        )
    };
    // Four steps of a half, exactly; the tutorial moves with the velocity before it is damped.
    let (_, end) = run(&source(
        "semi-implicit",
        "angular_factor = 0.5, linear_factor = 0.5",
    ));
    let end = &end.end[0];
    assert_eq!(end.motion.omega_w, Vector3::new(0.0, 1.0, 0.0));
    assert_eq!(end.motion.velocity_w, Vector3::new(0.5, 0.0, 0.0));
    assert_eq!(
        end.motion.position_w.x,
        8.0 * 0.0625 * (1.0 + 0.5 + 0.25 + 0.125)
    );
    // A half a step is ln 2 / 0.0625 a second; torque and acceleration say so.
    let rate = 2.0_f64.ln() / 0.0625;
    assert!((end.alpha_w.y + rate).abs() < 1e-14);
    assert!((end.tau_w.y + 0.8 * rate).abs() < 1e-14);
    for method in ["semi-implicit", "rk4"] {
        let (_, end) = run(&source(method, "angular = 3.0, linear = 2.0"));
        let end = &end.end[0].motion;
        // Four factors, rounded.
        assert!((end.omega_w.y - 16.0 * (-0.75_f64).exp()).abs() < 1e-14);
        assert!((end.velocity_w.x - 8.0 * (-0.5_f64).exp()).abs() < 1e-14);
    }
    // x = v0 (1 - e^{-kt})/k, of which rk4 integrates the exponential: error (k h)⁴/120 or so.
    let (_, end) = run(&source("rk4", "linear = 2.0"));
    let exact = 4.0 * (1.0 - (-0.5_f64).exp());
    assert!((end.end[0].motion.position_w.x - exact).abs() < 1e-5);
}

#[test]
fn no_torque_turns_a_held_axis_and_the_others_turn_as_by_the_remaining_block() {
    let source = "duration = 0.001\n[stepping]\nmethod = \"semi-implicit\"\nstep = 0.001\n[[body]]\nname = \"b\"\nmass = 1.0\ninertia = [[1.0, 0.0, 0.3], [0.0, 1.5, 0.2], [0.3, 0.2, 2.0]]\nimmovable = [\"z\"]\norientation = { axis = [1, 0, 0], degrees = 90 }\n[[event]]\nat = 0.0\nfor = 1.0\nbody = \"b\"\ntorque = [0.5, 0.75, 4.0]\nframe = \"body\"\n";
    let (_, outcome) = run(source);
    // In body axes α = (0.5/1, 0.75/1.5, 0); turned by 90° about x, y goes to z.
    let alpha = outcome.blows[0].sample.alpha_w;
    assert!(
        (alpha - Vector3::new(0.5, 0.0, 0.5)).norm() < 1e-15 * 4.0,
        "{alpha}"
    );
}

#[test]
fn gravity_turns_what_a_pivot_holds_and_moves_what_is_free() {
    let source = |pivot: &str| {
        format!(
            "duration = 1.0\n[effects]\ngravity = [0.0, -10.0, 0.0]\n[[body]]\nname = \"b\"\nmass = 2.0\ninertia = [0.5, 0.8, 1.0]\n{pivot}"
        )
    };
    let scene = Scene::parse("g", "g", &source("pivot = [-0.5, 0.0, 0.0]\n[[event]]\nat = 0.0\nfor = 0.5\nbody = \"b\"\ntorque = [0.0, 0.0, 0.0]\n")).unwrap();
    let (outcome, _) = Simulation::new(&scene).run(&mut Nowhere);
    // (0.5, 0, 0) × (0, -20, 0) = (0, 0, -10); I = 1 + 2·0.25 = 1.5.
    let first = &outcome.blows[0].sample;
    assert_eq!(first.tau_w, Vector3::new(0.0, 0.0, -10.0));
    assert!((first.alpha_w.z + 10.0 / 1.5).abs() < 1e-14);
    // What the event itself applies is nothing.
    assert_eq!(outcome.blows[0].tau_w, Vector3::zeros());
    let (_, free) = run(&source(""));
    let end = &free.end[0].motion;
    assert!((end.position_w.y + 5.0).abs() < 1e-12 && (end.velocity_w.y + 10.0).abs() < 1e-12);
    assert_eq!(end.omega_w, Vector3::zeros());
}

/// A change of the world's coordinates: a turn and a shift, or a mirror.
struct Coordinates {
    /// Of vectors and points: orthogonal, determinant ±1.
    m: Matrix3<f64>,
    shift_w: Vector3<f64>,
}

impl Coordinates {
    fn point(&self, p: Vector3<f64>) -> Vector3<f64> {
        self.m * p + self.shift_w
    }

    fn polar(&self, v: Vector3<f64>) -> Vector3<f64> {
        self.m * v
    }

    /// Torques, angular velocities, angular momenta.
    fn axial(&self, v: Vector3<f64>) -> Vector3<f64> {
        self.m * v * self.m.determinant()
    }
}

/// The world turned and shifted leaves the body's axes alone; in a mirror they are mirrored too.
#[test]
fn the_same_motion_in_turned_shifted_and_mirrored_coordinates() {
    let inertia = Matrix3::new(0.5, 0.02, -0.03, 0.02, 0.8, 0.05, -0.03, 0.05, 1.1);
    let q0 = UnitQuaternion::from_euler_angles(-0.7, 0.2, 0.9);
    let turn = UnitQuaternion::from_euler_angles(0.4, -1.1, 2.3);
    let source = |method: &str, c: &Coordinates| {
        let mirrored = c.m.determinant() < 0.0;
        // Body axes: turned with the world, or seen in the same mirror.
        let (body, attitude) = match mirrored {
            false => (Matrix3::identity(), turn * q0),
            true => {
                let [x, y, z, w] = q0.coords.into();
                // M R M of a rotation about n is one about the axial image of n.
                (
                    c.m,
                    UnitQuaternion::new_unchecked(Quaternion::new(w, x, -y, -z)),
                )
            }
        };
        let polar_b = |v: [f64; 3]| list((body * Vector3::from(v)).as_slice());
        let world = |v: Vector3<f64>| list(v.as_slice());
        let v = |x, y, z| Vector3::new(x, y, z);
        format!(
            "duration = 2.0\n[stepping]\nmethod = \"{method}\"\nstep = 0.002\n[effects]\ngyroscopic = true\ngravity = {}\ndamping = {{ angular = 0.3, linear = 0.2 }}\n[[body]]\nname = \"b\"\nmass = 2.0\ninertia = {}\norientation = {}\nangular_velocity = {}\nposition = {}\nvelocity = {}\n[[event]]\nat = 0.1003\nfor = 0.3\nbody = \"b\"\nforce = {}\npoint = {{ body = {} }}\n[[event]]\nat = 0.5\nfor = 0.4\nbody = \"b\"\nforce = {}\npoint = {}\n[[event]]\nat = 1.1\nbody = \"b\"\nangular_impulse = {}\n",
            world(c.polar(v(1.0, -9.0, 0.5))),
            rows(&(body * inertia * body.transpose()).symmetric_part()),
            coords(&attitude),
            world(c.axial(v(0.3, -1.0, 0.7))),
            world(c.point(v(1.0, 2.0, 3.0))),
            world(c.polar(v(0.1, 0.2, 0.3))),
            world(c.polar(v(1.0, 2.0, -3.0))),
            polar_b([0.2, 0.5, -0.4]),
            world(c.polar(v(-0.5, 0.4, 0.2))),
            world(c.point(v(1.3, 0.5, 2.8))),
            world(c.axial(v(0.0, 0.4, 0.1))),
        )
    };
    let here = Coordinates {
        m: Matrix3::identity(),
        shift_w: Vector3::zeros(),
    };
    let turned = Coordinates {
        m: turn.to_rotation_matrix().into_inner(),
        shift_w: Vector3::new(3.0, -2.0, 7.0),
    };
    let mirror = Coordinates {
        m: Matrix3::from_diagonal(&Vector3::new(-1.0, 1.0, 1.0)),
        shift_w: Vector3::zeros(),
    };
    for method in [
        "rk4",
        "lie-midpoint",
        "cf4",
        "buss",
        "dlm",
        "strang",
        "rkn6",
        "aba1064",
        "taylor",
        "dop853",
        "bullet",
        "mujoco-rk4",
    ] {
        // The plain world is the turned one turned back: there the attitude is q0 alone.
        let plain = source(method, &here).replace(&coords(&(turn * q0)), &coords(&q0));
        let (subjects, one) = run(&plain);
        let a = &one.end[0];
        for c in [&turned, &mirror] {
            let (others, other) = run(&source(method, c));
            let b = &other.end[0];
            // A thousand steps of numbers of size 10, rounded differently; steps of a method's own
            // end elsewhere where an error estimate is rounded differently.
            let bound = 1e-11;
            let near = |got: Vector3<f64>, want: Vector3<f64>| (got - want).norm() < bound;
            assert!(
                near(b.motion.position_w, c.point(a.motion.position_w)),
                "{method}"
            );
            assert!(
                near(b.motion.velocity_w, c.polar(a.motion.velocity_w)),
                "{method}"
            );
            assert!(
                near(b.motion.omega_w, c.axial(a.motion.omega_w)),
                "{method}"
            );
            assert!(near(b.alpha_w, c.axial(a.alpha_w)), "{method}");
            let (la, lb) = (
                subjects[0].momentum_w(&a.motion),
                others[0].momentum_w(&b.motion),
            );
            assert!(near(lb, c.axial(la)), "{method}");
            let (ea, eb) = (subjects[0].energy(&a.motion), others[0].energy(&b.motion));
            // E is some 100 J here.
            assert!((ea - eb).abs() < 1e-9, "{method}: {ea} {eb}");
        }
        assert!(a.motion.position_w.y < -5.0);
    }
}

/// Two forces along different lines keep no component of the angular momentum, but the energy: what the
/// method adds to it is known all the same.
#[test]
fn energy_is_watched_where_no_momentum_is_kept() {
    let drifts = |force: &str| {
        let source = format!(
            "duration = 1.0\n[effects]\ngyroscopic = true\ngravity = [0, -9.81, 0]\n[[body]]\nname = \"a\"\nmass = 1.0\nshape = {{ cylinder = {{ radius = 0.1, height = 0.6 }} }}\npivot = \"top\"\norientation = {{ axis = [1, 0, 0], degrees = 40 }}\n[[event]]\nat = 0.0\nfor = 1.0\nbody = \"a\"\nforce = {force}\npoint = \"bottom\"\n"
        );
        let scene = Scene::parse("s", "s", &source).unwrap_or_else(|error| panic!("{error}"));
        let (_, _, mut memory) = common::run(&scene);
        memory.samples.pop().unwrap().2.deviation
    };
    let askew = drifts("[2.0, 0.0, 0.0]");
    // rk4 in steps of a millisecond.
    assert!(askew.energy.unwrap().abs() < 1e-9, "{askew:?}");
    assert_eq!(askew.momentum, None);
    let parallel = drifts("[0.0, -2.0, 0.0]");
    assert!(parallel.energy.unwrap().abs() < 1e-9 && parallel.momentum.unwrap() < 1e-9);
}
