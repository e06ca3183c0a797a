//! The cone's numbers, from the tutorial's corrected example, and the scenes that ship.

use nalgebra::Vector3;
use std::ops::Range;
use std::path::Path;
use torquescope::cost::Plan;
use torquescope::scene::{Scene, Stepping};
use torquescope::sim::{Outcome, Simulation};
use torquescope::trace::{Instant, Note, Sample, Sink, SinkError, Subject, Track};

/// Keeps everything that is delivered: samples by body, instants of the first body's states.
#[derive(Default)]
struct Memory {
    samples: Vec<(Instant, usize, Sample)>,
    states: Vec<Instant>,
    notes: Vec<(Instant, Note)>,
}

impl Sink for Memory {
    fn motions(&mut self, track: &Track<'_>) -> Result<(), SinkError> {
        if track.bodies.start == 0 {
            self.states.extend(track.instants);
        }
        Ok(())
    }

    fn samples(
        &mut self,
        at: Instant,
        bodies: Range<usize>,
        samples: &[Sample],
    ) -> Result<(), SinkError> {
        let rows = bodies.zip(samples);
        self.samples
            .extend(rows.map(|(body, sample)| (at, body, sample.clone())));
        Ok(())
    }

    fn note(&mut self, at: Instant, note: &Note) -> Result<(), SinkError> {
        self.notes.push((at, note.clone()));
        Ok(())
    }
}

fn load(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenes")
        .join(name);
    Scene::load(&path).unwrap_or_else(|error| panic!("{error}"))
}

fn run(scene: &Scene) -> (Vec<Subject>, Outcome, Memory) {
    let simulation = Simulation::new(scene);
    let subjects = simulation.subjects().to_vec();
    let mut memory = Memory::default();
    let (outcome, done) = match scene.stepping {
        Stepping::Method { .. } => simulation.run(&mut memory),
        Stepping::Accuracy(_) => {
            let plan = Plan::of(scene).unwrap_or_else(|error| panic!("{error}"));
            simulation.run_by(&mut plan.chooser(), &mut memory)
        }
    };
    done.unwrap();
    (subjects, outcome, memory)
}

#[track_caller]
fn near(got: Vector3<f64>, want: [f64; 3], bound: f64) {
    assert!(
        (got - Vector3::from(want)).amax() <= bound,
        "{got:?} is not {want:?}"
    );
}

/// Torque and angular acceleration of each reading, by arithmetic done by hand:
/// `A: τ = (0, 1, 0) × (-10, 0, 0)`, `B: τ = (1, 0, 0) × (-10/√2, 0, 10/√2)`, about the centre of
/// mass with a quarter less of height; moments 3/20 + 3/80·… as in docs/physics.md.
#[test]
fn the_cones_numbers_in_all_three_readings() {
    let (subjects, outcome, _) = run(&load("cone.toml"));
    let s = 10.0 / 2.0_f64.sqrt();
    let (base, apex, free, axis) = (0.25, 0.75, 0.1875, 0.3);
    let expected = [
        ("free-A", [0.0, 0.0, 7.5], [0.0, 0.0, 7.5 / free]),
        ("base-A", [0.0, 0.0, 10.0], [0.0, 0.0, 10.0 / base]),
        ("apex-A", [0.0, 0.0, 10.0], [0.0, 0.0, 10.0 / apex]),
        (
            "free-B",
            [-s / 4.0, -s, -s / 4.0],
            [-s / 4.0 / free, -s / axis, -s / 4.0 / free],
        ),
        ("base-B", [0.0, -s, 0.0], [0.0, -s / axis, 0.0]),
        ("apex-B", [0.0, -s, 0.0], [0.0, -s / axis, 0.0]),
    ];
    assert_eq!(outcome.blows.len(), expected.len());
    for ((blow, subject), (name, torque, alpha)) in
        outcome.blows.iter().zip(&subjects).zip(expected)
    {
        assert_eq!(subject.name, name);
        near(blow.sample.tau_w, torque, 1e-12);
        near(blow.sample.alpha_w, alpha, 1e-12);
    }
    // And the printed digits of the tutorial, to the three or five it gives.
    near(outcome.blows[1].sample.alpha_w, [0.0, 0.0, 40.0], 1e-12);
    near(outcome.blows[2].sample.alpha_w, [0.0, 0.0, 13.333], 5e-4);
    near(outcome.blows[4].sample.alpha_w, [0.0, -23.570, 0.0], 5e-4);
    near(
        outcome.blows[3].sample.alpha_w,
        [-9.428, -23.570, -9.428],
        5e-4,
    );
}

/// The blow follows the body, so a cone that turns about a fixed principal axis has constant
/// torque: ω = α·0.1 s at the end, and kinetic energy ½ I ω².
#[test]
fn after_the_blow_the_fixed_cones_keep_what_it_gave() {
    let (subjects, outcome, _) = run(&load("cone.toml"));
    let s = 10.0 / 2.0_f64.sqrt();
    let expected = [
        (1, [0.0, 0.0, 4.0], 0.25),
        (2, [0.0, 0.0, 4.0 / 3.0], 0.75),
        (4, [0.0, -s / 3.0, 0.0], 0.3),
    ];
    for (k, omega, inertia) in expected {
        // 100 additions of α h, a rounding each, of numbers up to 4.
        near(outcome.end[k].motion.omega_w, omega, 1e-13);
        let energy = 0.5 * inertia * Vector3::from(omega).norm_squared();
        assert!((subjects[k].energy(&outcome.end[k].motion) - energy).abs() < 1e-12);
    }
}

/// With r = h the base centre is the centre of percussion of a blow at the apex.
#[test]
fn the_base_of_the_free_cone_has_no_acceleration_at_the_blow() {
    let (_, outcome, _) = run(&load("cone.toml"));
    let blow = &outcome.blows[0];
    let force = blow.sample.pushes[0].force_w;
    let to_base = Vector3::new(0.0, -0.25, 0.0);
    let acceleration = force / 1.0 + blow.sample.alpha_w.cross(&to_base);
    // F/m = -10, α × r = 40 · 0.25 = 10: one rounding.
    assert!(acceleration.norm() < 1e-14, "{acceleration}");
}

#[test]
fn the_pivots_stay_where_they_are() {
    let (subjects, _, memory) = run(&load("cone.toml"));
    for (_, body, sample) in &memory.samples {
        let subject = &subjects[*body];
        if let Some(pivot) = subject.pivot_w {
            // The pose is given at the centre of mass, a metre away: roundings of size 4.
            assert!((sample.reference_w(subject) - pivot).norm() < 4e-15);
        }
    }
}

#[test]
fn every_shipped_scene_runs_and_says_what_to_look_at() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut seen = 0;
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let scene = Scene::load(&entry.path()).unwrap_or_else(|error| panic!("{error}"));
        assert!(
            scene.notes.len() > 100,
            "{} opens without saying what it shows",
            scene.name
        );
        let (subjects, outcome, memory) = run(&scene);
        assert_eq!(outcome.end.len(), subjects.len());
        assert!(
            outcome
                .blows
                .iter()
                .all(|blow| blow.sample.alpha_w.norm().is_finite())
        );
        let happens = scene.events.len();
        assert!(memory.notes.len() >= happens, "{}", scene.name);
        seen += 1;
    }
    assert_eq!(seen, 9);
}

#[test]
fn pushed_off_its_centre_the_pen_slides_as_fast_and_turns_besides() {
    let (_, outcome, _) = run(&load("push_at_a_and_b.toml"));
    let [centre, off] = [&outcome.end[0], &outcome.end[1]];
    // The same F t/m = 0.5 m/s for both, exactly: the force keeps its direction.
    near(centre.motion.velocity_w, [0.0, 0.0, -0.5], 1e-13);
    near(off.motion.velocity_w, [0.0, 0.0, -0.5], 1e-13);
    assert_eq!(centre.motion.omega_w, Vector3::zeros());
    assert!(off.motion.omega_w.y > 1.0);
}

#[test]
fn the_shell_turns_up_at_three_fifths_of_the_solid_sphere() {
    let (_, outcome, _) = run(&load("spheres.toml"));
    let alpha = |k: usize| outcome.blows[k].sample.alpha_w.y;
    // 0.3 / (2/5 · 0.25) = 3 and 0.3 / (2/3 · 0.25) = 1.8.
    assert!((alpha(0) - 3.0).abs() < 1e-15 * 4.0);
    assert!((alpha(1) - 1.8).abs() < 1e-15 * 4.0);
}

#[test]
fn the_wheels_motor_acts_in_its_own_axes_and_damping_takes_the_spin() {
    let scene = load("wheel.toml");
    let (_, outcome, memory) = run(&scene);
    let (sin, cos) = (30.0_f64.to_radians().sin(), 30.0_f64.to_radians().cos());
    near(
        outcome.blows[0].sample.tau_w,
        [-0.5 * sin, 0.5 * cos, 0.0],
        1e-15,
    );
    // I dω/dt = τ - c I ω about the axle: ω = τ/(c I) (1 - e^{-ct}) to t = 2 s, then e^{-c(t-2)}.
    let (c, tau, inertia) = (0.5_f64, 0.5, 0.25);
    let at_end = tau / (c * inertia) * (1.0 - (-c * 2.0).exp()) * (-c * 3.0).exp();
    let (_, _, last) = memory.samples.last().unwrap();
    // Integrating-factor RK4 with h = 1e-3: error below (c h)⁴, plus 5,000 roundings.
    assert!((last.motion.omega_w.norm() - at_end).abs() < 1e-11);
}

#[test]
fn events_lie_on_their_exact_instants_with_a_row_on_either_side() {
    let source = r#"
        duration = 0.1
        [stepping]
        method = "rk4"
        step = 0.004
        [record]
        rate = 3
        [[body]]
        name = "ball"
        shape = { sphere = { radius = 0.5 } }
        mass = 2.0
        [[event]]
        at = 0.0123
        for = 0.03101
        body = "ball"
        torque = [0.0, 1.0, 0.0]
        [[event]]
        at = 0.0777
        body = "ball"
        angular_impulse = [0.0, 0.0, 0.2]
    "#;
    let scene = Scene::parse("inline", "inline", source).unwrap();
    let (_, outcome, memory) = run(&scene);
    for time in [0.0123, 0.0123 + 0.03101, 0.0777] {
        let at_time = memory.samples.iter().filter(|(at, ..)| at.time == time);
        let rows: Vec<&Sample> = at_time.map(|(_, _, sample)| sample).collect();
        assert_eq!(rows.len(), 2, "at {time}");
        assert_ne!(rows[0], rows[1], "before and after differ at {time}");
    }
    // ω about y: τ t / I = 0.03101 / 0.2, whatever the grid; about z the impulse's 0.2 / 0.2.
    let omega = outcome.end[0].motion.omega_w;
    near(omega, [0.0, 0.03101 / 0.2, 1.0], 1e-15);
    // 25 grid steps, and one more for each instant that divides one.
    assert_eq!(outcome.steps, 25 + 3);
    // The state is recorded at the start, at every step, and again after the impulse.
    assert_eq!(memory.states.len(), 1 + 28 + 1);
}

#[test]
fn time_does_not_drift_and_a_rate_is_kept() {
    let source = r#"
        duration = 7.0
        [stepping]
        step = 0.0007
        [record]
        rate = 50
        state = 10
        [[body]]
        name = "ball"
        shape = { sphere = { radius = 0.5 } }
        mass = 2.0
    "#;
    let scene = Scene::parse("inline", "inline", source).unwrap();
    let (_, outcome, memory) = run(&scene);
    assert_eq!(outcome.steps, 10_000);
    assert_eq!(memory.samples.len(), 1 + 350);
    for (k, (at, ..)) in memory.samples.iter().enumerate() {
        // The first step at or after k/50 s, both rounded.
        assert!(
            (-1e-15..0.0007 + 1e-15).contains(&(at.time - k as f64 / 50.0)),
            "{k}: {}",
            at.time
        );
    }
    assert_eq!(memory.samples.last().unwrap().0.time, 7.0);
    // The start and 70 samples of the state, by its own rate.
    assert_eq!(memory.states.len(), 1 + 70);
}

#[test]
fn a_step_that_is_a_truncated_decimal_loses_no_sample() {
    // 1/120, 1/240 and so on with some digits cut off: sampling instants fall a rounding beside
    // the grid, now on one side, now on the other.
    let cases: [(f64, f64, f64); 6] = [
        (0.008_333_333_333_33, 60.0, 60.0),
        (0.004_166_666_666_6, 60.0, 60.0),
        (0.001_041_666_666_66, 60.0, 10.0),
        (0.016_666_666_666_6, 30.0, 60.0),
        (0.001, 1000.0, 1.0),
        (0.01, 1e9, 1.0),
    ];
    for (step, rate, duration) in cases {
        let source = format!(
            "duration = {duration}\n[stepping]\nstep = {step}\n[record]\nrate = {rate}\nstate = 1\n[[body]]\nname = \"a\"\nmass = 1.0\ninertia = [1, 1, 1]\n"
        );
        let (_, outcome, memory) = run(&Scene::parse("inline", "inline", &source).unwrap());
        // A sample an instant, but no more than a step each; the start; and the end, which a
        // truncated step may leave a step of its own.
        let wanted = (rate * duration).min((duration / step).round());
        let seen = memory.samples.len() as f64 - 1.0;
        assert!(
            (wanted..=wanted + 1.0).contains(&seen),
            "{step}: {seen} of {wanted}"
        );
        let gaps = memory.samples.windows(2).map(|w| w[1].0.time - w[0].0.time);
        let widest = gaps.fold(0.0, f64::max);
        assert!(
            widest < 1.0 / rate + 1.001 * step,
            "{step}: a gap of {widest} s"
        );
        let states = memory.states.len() as u64;
        assert!(
            (duration as u64 + 1..=duration as u64 + 2).contains(&states),
            "{step}: {states}"
        );
        assert!(outcome.steps > 0);
    }
}

#[test]
fn events_that_a_rounding_parts_are_one_instant() {
    let source = r#"
        duration = 0.6
        [stepping]
        step = 0.0007
        [[body]]
        name = "ball"
        mass = 1.0
        inertia = [0.2, 0.2, 0.2]
        [[event]]
        at = 0.1
        for = 0.2
        body = "ball"
        torque = [0.0, 1.0, 0.0]
        [[event]]
        at = 0.3
        for = 0.1
        body = "ball"
        torque = [0.0, 1.0, 0.0]
    "#;
    // 0.1 + 0.2 is not 0.3 in binary; the torque must not vanish between the two.
    let (_, outcome, memory) = run(&Scene::parse("inline", "inline", source).unwrap());
    let at_seam = memory
        .samples
        .iter()
        .filter(|(at, ..)| (at.time - 0.3).abs() < 1e-9);
    let torques: Vec<f64> = at_seam.map(|(_, _, sample)| sample.tau_w.y).collect();
    assert_eq!(torques, [1.0, 1.0]);
    // 857.1 steps of the grid, and one more at each of the instants 0.1, 0.3 and 0.4.
    assert_eq!(outcome.steps, 858 + 3);
}

#[test]
fn what_is_off_is_absent_bit_for_bit() {
    let scene = |effects: &str| {
        let source = format!(
            r#"
            duration = 1.0
            [effects]
            {effects}
            [[body]]
            name = "brick"
            shape = {{ cuboid = {{ x = 1.0, y = 0.5, z = 0.2 }} }}
            mass = 2.0
            angular_velocity = [0.3, 2.0, -0.1]
            "#
        );
        let scene = Scene::parse("inline", "inline", &source).unwrap();
        run(&scene).1.end
    };
    let plain = scene("");
    assert_eq!(
        plain,
        scene("gyroscopic = false\ngravity = [0.0, 0.0, 0.0]\ndamping = {}")
    );
    assert_ne!(plain, scene("gyroscopic = true"));
    assert_ne!(plain, scene("damping = { angular = 0.1 }"));
}

#[test]
fn a_state_that_is_lost_is_recorded_and_named() {
    let source = r#"
        duration = 10.0
        [stepping]
        method = "semi-implicit"
        step = 0.01
        [effects]
        gyroscopic = true
        [[body]]
        name = "top"
        shape = { cuboid = { x = 2.0, y = 0.5, z = 0.2 } }
        mass = 2.0
        angular_velocity = [300.0, 20.0, -100.0]
    "#;
    let scene = Scene::parse("inline", "inline", source).unwrap();
    let simulation = Simulation::new(&scene);
    let mut memory = Memory::default();
    let (outcome, done) = simulation.run(&mut memory);
    let error = done.unwrap_err().to_string();
    assert!(
        error.starts_with("top is no longer finite at t = "),
        "{error}"
    );
    assert!(
        error.contains("semi-implicit") && error.contains("smaller step"),
        "{error}"
    );
    assert!(error.len() < 300, "{error}");
    let (at, _, last) = memory.samples.last().unwrap();
    assert!(!last.motion.omega_w.norm().is_finite());
    assert_eq!(at.step, outcome.steps);
    assert_eq!(
        memory.notes.last().unwrap().1.kind,
        torquescope::trace::NoteKind::Failure
    );
}

#[test]
fn when_one_body_is_lost_the_others_are_recorded_where_they_were() {
    // The ninth body is in another group than the first, which must not run on to the end of the
    // stretch before the loss is noticed.
    let mut source = String::from(
        "duration = 10.0\n[stepping]\nmethod = \"semi-implicit\"\nstep = 0.01\n[record]\nrate = 0.5\n[effects]\ngyroscopic = true\n",
    );
    for k in 0..8 {
        source += &format!(
            "[[body]]\nname = \"calm-{k}\"\nmass = 1.0\ninertia = [1, 1, 1]\nvelocity = [1, 0, 0]\n"
        );
    }
    source += "[[body]]\nname = \"wild\"\nmass = 1.0\ninertia = [1, 2, 2.5]\nangular_velocity = [300, 20, -100]\n";
    let scene = Scene::parse("inline", "inline", &source).unwrap();
    let mut memory = Memory::default();
    let (outcome, done) = Simulation::new(&scene).run(&mut memory);
    assert!(done.unwrap_err().to_string().starts_with("wild is"));
    let (at, ..) = memory.samples.last().unwrap();
    assert!(at.time < 2.0);
    let calm = memory
        .samples
        .iter()
        .rfind(|(_, body, _)| *body == 0)
        .unwrap();
    assert!((calm.2.motion.position_w.x - at.time).abs() < 1e-12);
    assert_eq!(memory.states.last().unwrap().step, outcome.steps);
}
