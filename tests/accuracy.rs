//! Accuracy asked for, measured, and shown: plans, prices, and the streams that compare with the truth.

mod common;

use common::Nowhere;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use std::ops::{ControlFlow, Range};
use std::time::Duration;
use torquescope::cost::{Ladder, Plan, PlanError};
use torquescope::exact::FreeMotion;
use torquescope::integrator::{self, Kind, METHODS};
use torquescope::math::angle_between;
use torquescope::scene::{Scene, Stepping};
use torquescope::sim::{Outcome, Simulation};
use torquescope::trace::{Instant, Note, Sample, Sink, SinkError, Track};

fn parse(source: &str) -> Scene {
    Scene::parse("inline", "inline", source).unwrap_or_else(|error| panic!("{error}\n{source}"))
}

/// A scene by the way it states, or by the plan for the accuracy it states.
fn end(scene: &Scene) -> (Outcome, Option<Plan>) {
    let simulation = Simulation::new(scene);
    let (plan, (outcome, done)) = match scene.stepping {
        Stepping::Method { .. } => (None, simulation.run(&mut Nowhere)),
        Stepping::Accuracy(_) => {
            let plan = Plan::of(scene).unwrap_or_else(|error| panic!("{error}"));
            let run = simulation.run_by(&mut plan.chooser(), &mut Nowhere);
            (Some(plan), run)
        }
    };
    done.unwrap_or_else(|error| panic!("{error}"));
    (outcome, plan)
}

/// The heavy asymmetric top of an outside reference (Taylor integration in 40 digits), as
/// tests/motion.rs has it, but with its moments about the pivot given as a diagonal tensor of a body
/// whose centre of mass is next to nothing off: m = 1e-9, g = 1e9.
const TOP: &str = r#"
    duration = 100.0
    [stepping]
    STEPPING
    [record]
    state = 10
    rate = 10
    [effects]
    gyroscopic = true
    gravity = [0.0, 0.0, -1e9]
    [[body]]
    name = "top"
    mass = 1e-9
    inertia = [0.99999999896, 1.59999999891, 2.09999999987]
    position = POSITION
    orientation = ORIENTATION
    angular_velocity = OMEGA
    pivot = [-0.3, -0.2, -1.0]
"#;

const TOP_AT_100: [f64; 4] = [
    -0.051_812_189_728_397_31,
    -0.229_010_135_522_556_6,
    -0.969_409_120_332_801_6,
    -0.071_524_906_424_772_6,
];

fn numbers(v: &[f64]) -> String {
    format!("{v:?}")
}

fn top(stepping: &str) -> Scene {
    let q0 = UnitQuaternion::new_normalize(Quaternion::new(0.86_f64.sqrt(), 0.1, 0.3, -0.2));
    let c = Vector3::new(0.3, 0.2, 1.0);
    // The tensor about the centre of mass lacks m (|c|² - c cᵀ), 1e-9 kg m²; its products of inertia
    // of the same size are left out, which moves the attitude by about 1e-9 · 100.
    let source = TOP
        .replace("STEPPING", stepping)
        .replace("POSITION", &numbers((q0 * c).as_slice()))
        .replace("ORIENTATION", &numbers(q0.coords.as_slice()))
        .replace(
            "OMEGA",
            &numbers((q0 * Vector3::new(0.5, -0.8, 2.0)).as_slice()),
        );
    parse(&source)
}

fn from_reference(outcome: &Outcome) -> f64 {
    let [x, y, z, w] = TOP_AT_100;
    let reference = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z));
    angle_between(outcome.end[0].motion.q_wb, reference)
}

#[test]
fn a_stated_accuracy_is_kept_to() {
    for accuracy in [1e-3, 1e-5, 1e-7] {
        let (outcome, plan) = end(&top(&format!("accuracy = {accuracy:e}")));
        let plan = plan.unwrap();
        assert!(plan.achieved <= accuracy, "{accuracy}: {}", plan.achieved);
        // Against digits from outside; what is left out of the tensor is worth 1e-7 at most.
        let off = from_reference(&outcome);
        assert!(off <= accuracy + 1e-7, "{accuracy}: {off}");
        assert!(plan.uncertainty < 1e-10, "{}", plan.uncertainty);
    }
}

/// An upright top too slow to stand: what it is off by grows e-fold by e-fold, and a plan's first
/// guesses fall short. What the reference allows is kept all the same.
#[test]
fn an_accuracy_is_kept_to_where_errors_grow() {
    let scene = |accuracy: &str| {
        parse(&format!(
            r#"
            duration = 12.0
            [stepping]
            accuracy = {accuracy}
            [effects]
            gyroscopic = true
            gravity = [0.0, 0.0, -1.0]
            [[body]]
            name = "top"
            mass = 1.0
            inertia = [0.5, 0.875, 1.25]
            position = [0.0, 0.0, 0.5]
            pivot = [0.0, 0.0, -0.5]
            angular_velocity = [9.5367431640625e-7, 0.0, 0.0]
            "#
        ))
    };
    for accuracy in ["1e-2", "2e-3", "1e-4", "1e-6"] {
        let (_, plan) = end(&scene(accuracy));
        let plan = plan.unwrap();
        let asked: f64 = accuracy.parse().unwrap();
        assert!(plan.achieved + plan.uncertainty <= asked, "{accuracy}");
    }
}

/// Damping is of velocities, and so of those about axes that nothing turns.
#[test]
fn held_axes_are_damped_by_every_way() {
    let source = |stepping: &str| {
        parse(&format!(
            r#"
            duration = 3.0
            [stepping]
            {stepping}
            [record]
            rate = 10
            state = 10
            [effects]
            damping = {{ angular = 1.0 }}
            [[body]]
            name = "b"
            mass = 1.0
            inertia = [0.5, 0.8, 1.1]
            immovable = ["x", "y", "z"]
            angular_velocity = [0.4, 1.0, 0.2]
            [[event]]
            at = 0.5
            for = 1.0
            body = "b"
            torque = [1.0, 2.0, 3.0]
            "#
        ))
    };
    let exact = Vector3::new(0.4, 1.0, 0.2) * (-3.0_f64).exp();
    for stepping in [
        "accuracy = 1e-9",
        "method = \"taylor\"\nstep = 0.1",
        "method = \"dop853\"\nstep = 0.1",
        "method = \"rk4\"\nstep = 0.001",
        "method = \"rkn6\"\nstep = 0.01",
    ] {
        let (outcome, _) = end(&source(stepping));
        let gap = (outcome.end[0].motion.omega_w - exact).norm();
        // Factors of e^{-c h} to rounding each, or the tolerance of 1e-12 a step.
        assert!(gap < 1e-11, "{stepping}: {gap:e}");
    }
}

/// A body that has all but come to rest, and is pushed: a reference must be able to set out from there.
#[test]
fn a_push_after_all_has_settled() {
    let source = |at: f64| {
        parse(&format!(
            r#"
            duration = 25.0
            [stepping]
            accuracy = 1e-6
            [record]
            rate = 10
            [effects]
            gyroscopic = true
            damping = {{ angular = 2.0, linear = 2.0 }}
            [[body]]
            name = "b"
            mass = 1.0
            inertia = [0.5, 0.8, 1.1]
            velocity = [1.0, 0.0, 0.0]
            angular_velocity = [1.0, 2.0, 0.5]
            [[event]]
            at = {at}
            for = 0.5
            body = "b"
            force = [1.0, 2.0, 0.0]
            point = {{ body = [0.1, 0.2, 0.3] }}
            "#
        ))
    };
    for at in [10.0, 17.0, 20.0, 24.0] {
        let (_, plan) = end(&source(at));
        assert!(plan.unwrap().achieved < 1e-6, "{at}");
    }
}

#[test]
fn less_accuracy_is_cheaper() {
    let pieces = |accuracy: f64| {
        let plan = Plan::of(&top(&format!("accuracy = {accuracy:e}"))).unwrap();
        let choice = plan.intervals[0].choice;
        let weight = choice.method.info().cost.weight;
        (choice.method.info().kind, f64::from(choice.pieces) * weight)
    };
    let ((loose_kind, loose), (tight_kind, tight)) = (pieces(1e-2), pieces(1e-8));
    // Methods with steps of their own are not comparable by pieces.
    if loose_kind == Kind::Fixed && tight_kind == Kind::Fixed {
        assert!(loose < tight, "{loose} {tight}");
    } else {
        assert_ne!(tight_kind, Kind::Closed);
    }
}

#[test]
fn more_than_numbers_can_give_is_refused_with_what_can_be_had() {
    let Err(PlanError::BeyondReach { asked, had }) = Plan::of(&top("accuracy = 1e-17")).map(|_| ())
    else {
        panic!("an accuracy below rounding was promised");
    };
    assert_eq!(asked, 1e-17);
    // And what it says can be had can be had.
    assert!(had > 1e-16 && had < 1e-9, "{had}");
    let plan = Plan::of(&top(&format!("accuracy = {:e}", 2.0 * had))).unwrap();
    assert!(plan.achieved <= 2.0 * had);
}

#[test]
fn a_free_body_is_planned_in_closed_form() {
    let source = r#"
        duration = 1000.0
        [stepping]
        accuracy = 1e-11
        [record]
        rate = 1
        state = 1
        [effects]
        gyroscopic = true
        [[body]]
        name = "top"
        mass = 1.0
        inertia = [1.0, 2.0, 3.0]
        angular_velocity = [0.1, 2.0, 0.1]
        [[event]]
        at = 500.0
        body = "top"
        angular_impulse = [0.0, 0.3, 0.0]
    "#;
    let (_, plan) = end(&parse(source));
    let plan = plan.unwrap();
    assert_eq!(plan.intervals.len(), 2);
    for planned in &plan.intervals {
        assert_eq!(planned.choice.method.info().kind, Kind::Closed);
    }
}

/// Pushes at times that no step meets: every method keeps its order, because none falls inside a
/// step.
#[test]
fn pushes_at_awkward_times_cost_no_method_its_order() {
    pushes_cost_no_order("box");
}

/// Of other profiles too: their kinks are at their ends, which no step has inside it.
#[test]
fn nor_do_pushes_that_swell() {
    pushes_cost_no_order("half_sine");
    pushes_cost_no_order("ramp");
}

fn pushes_cost_no_order(profile: &str) {
    let scene = |stepping: &str| {
        parse(&format!(
            r#"
            duration = 2.0
            [stepping]
            {stepping}
            [record]
            rate = 1
            state = 1
            [effects]
            gyroscopic = true
            damping = {{ angular = 0.05 }}
            [[body]]
            name = "b"
            mass = 2.0
            inertia = [0.5, 0.8, 1.1]
            angular_velocity = [0.9, -3.0, 2.1]
            [[event]]
            at = 0.12345678
            for = 0.3333333
            profile = "{profile}"
            body = "b"
            force = [1.0, 2.0, -3.0]
            point = {{ body = [0.2, 0.5, -0.4] }}
            frame = "world"
            [[event]]
            at = 0.7071067
            for = 0.5
            profile = "{profile}"
            body = "b"
            torque = [0.5, -0.2, 0.1]
            frame = "body"
            [[event]]
            at = 1.4142135
            body = "b"
            angular_impulse = [0.2, 0.3, 0.1]
            "#
        ))
    };
    let attitude = |stepping: &str| end(&scene(stepping)).0.end[0].motion.q_wb;
    // DOP853 lands on the same instants, by steps of its own.
    let truth = attitude("method = \"dop853\"\ntolerance = 1e-15\nstep = 0.1");
    let mut seen = 0;
    for method in METHODS.iter().map(|method| method.info()) {
        let mut stated = scene("method = \"rk4\"");
        stated.stepping = Stepping::Method {
            method: integrator::find(method.name).unwrap(),
            tolerance: 1e-12,
        };
        // An order of 1 is what a step that an event cuts would have: there is none to lose.
        if method.kind != Kind::Fixed || method.order < 2 || stated.refusal().is_some() {
            continue;
        }
        seen += 1;
        let mut errors: Vec<(f64, f64)> = Vec::new();
        let mut step = 0.4;
        // From where the leading term leads to where rounding shows.
        while errors.len() < 6 && step > 2e-5 {
            stated.step = step;
            let off = angle_between(end(&stated).0.end[0].motion.q_wb, truth);
            if off < 1e-12 {
                break;
            }
            if off < 3e-3 {
                errors.push((step.ln(), off.ln()));
            }
            step *= 0.5;
        }
        if errors.len() < 3 {
            // Rounding after one or two halvings: only of high orders.
            assert!(method.order >= 6, "{}: {errors:?}", method.name);
            continue;
        }
        let last = &errors[errors.len().saturating_sub(4)..];
        let slope = (last[last.len() - 1].1 - last[0].1) / (last[last.len() - 1].0 - last[0].0);
        // A force that begins within a step leaves an error of order 1, whatever the method. The
        // remainders that the events leave differ from rung to rung, which moves a slope by some
        // tenths of itself.
        let order = f64::from(method.order);
        assert!(
            slope > 0.7 * order,
            "{profile}, {}: {slope} {errors:?}",
            method.name
        );
    }
    assert!(seen >= 8, "{seen}");
}

/// What a recording says of its own error, by a second way.
#[derive(Default)]
struct Deviations(Vec<(f64, Sample)>);

impl Sink for Deviations {
    fn motions(&mut self, _: &Track<'_>) -> Result<(), SinkError> {
        Ok(())
    }
    fn samples(&mut self, at: Instant, _: Range<usize>, s: &[Sample]) -> Result<(), SinkError> {
        self.0.push((at.time, s[0].clone()));
        Ok(())
    }
    fn note(&mut self, _: Instant, _: &Note) -> Result<(), SinkError> {
        Ok(())
    }
}

#[test]
fn the_error_in_a_recording_is_the_angle_from_the_exact_motion() {
    let source = r#"
        duration = 5.0
        [stepping]
        method = "rk4"
        step = 0.05
        [effects]
        gyroscopic = true
        [[body]]
        name = "top"
        mass = 1.0
        inertia = [1.0, 2.0, 3.0]
        angular_velocity = [0.1, 2.0, 0.1]
        [[event]]
        at = 2.02
        body = "top"
        angular_impulse = [0.0, 0.3, 0.0]
        [[event]]
        at = 4.0
        for = 0.5
        body = "top"
        torque = [0.0, 0.0, 0.1]
    "#;
    let mut deviations = Deviations::default();
    let (_, done) = Simulation::new(&parse(source)).run(&mut deviations);
    done.unwrap();
    let moments = Vector3::new(1.0, 2.0, 3.0);
    let q0 = Quaternion::identity();
    let before = FreeMotion::new(moments, q0, Vector3::new(0.1, 2.0, 0.1));
    // The exact body at the blow, struck: Δω = I⁻¹ Rᵀ J.
    let (q1, omega1) = before.at(2.02);
    let blow_p = UnitQuaternion::new_unchecked(q1).inverse() * Vector3::new(0.0, 0.3, 0.0);
    let after = FreeMotion::new(moments, q1, omega1 + blow_p.component_div(&moments));
    let (mut known, mut unknown, mut largest) = (0, 0, 0.0_f64);
    for (t, sample) in &deviations.0 {
        let off = sample.deviation.attitude;
        let exact = match *t {
            t if t < 2.02 => before.attitude(t),
            t if t > 2.02 && t < 4.0 => after.attitude(t - 2.02),
            t if t > 4.0 => {
                // A torque has acted: nothing exact is known from then on.
                assert_eq!(off, None, "{t}");
                unknown += 1;
                continue;
            }
            _ => continue,
        };
        let want = angle_between(sample.motion.q_wb, UnitQuaternion::new_normalize(exact));
        // Two attitudes of unit length to rounding, and a chain of two exact motions.
        assert!((off.unwrap() - want).abs() < 1e-14, "{t}: {off:?} {want}");
        largest = largest.max(want);
        known += 1;
    }
    assert!(known > 60 && unknown > 10, "{known} {unknown}");
    // rk4 at 50 ms is off by something that can be seen.
    assert!(largest > 1e-6, "{largest}");
}

/// E and L_z of the heavy top are kept by the model: what rk4 loses of them is in the drift.
#[test]
fn drift_under_gravity_is_that_of_the_whole_energy_and_the_upright_momentum() {
    let mut deviations = Deviations::default();
    let scene = top("method = \"rk4\"\nstep = 0.05");
    let simulation = Simulation::new(&scene);
    let subject = simulation.subjects()[0].clone();
    let (_, done) = simulation.run(&mut deviations);
    done.unwrap();
    let energy = |s: &Sample| subject.energy(&s.motion) + s.motion.position_w.z;
    let first = &deviations.0[0].1;
    let (e0, l0) = (energy(first), subject.momentum_w(&first.motion).z);
    let (mut kinetic, mut momentum) = (0.0_f64, 0.0_f64);
    let (mut energy_seen, mut momentum_seen) = (0.0_f64, 0.0_f64);
    for (t, sample) in &deviations.0 {
        let l_w = subject.momentum_w(&sample.motion);
        kinetic = kinetic.max(subject.energy(&sample.motion));
        momentum = momentum.max(l_w.norm());
        assert_eq!(sample.deviation.attitude, None);
        let (e, l) = (
            sample.deviation.energy.unwrap(),
            sample.deviation.momentum.unwrap(),
        );
        // m g c is 1 to the last bit of 1e-9 · 1e9; the rest are roundings of numbers of size 5.
        assert!(
            (e - (energy(sample) - e0) / kinetic).abs() < 1e-13,
            "{t}: {e}"
        );
        assert!(
            (l - (l_w.z - l0).abs() / momentum).abs() < 1e-13,
            "{t}: {l}"
        );
        energy_seen = energy_seen.max(e.abs());
        momentum_seen = momentum_seen.max(l);
    }
    // h⁴ of 50 ms, over 100 s: neither nothing nor much.
    assert!((1e-7..1e-2).contains(&energy_seen), "{energy_seen}");
    assert!((1e-9..1e-2).contains(&momentum_seen), "{momentum_seen}");
}

#[test]
fn the_same_bits_on_any_number_of_threads() {
    let mut source = String::from(
        "duration = 2.0\n[stepping]\nmethod = \"rk4\"\nstep = 0.001\n[record]\nrate = 1\nstate = 1\n[effects]\ngyroscopic = true\ngravity = [0.0, -9.81, 0.0]\n",
    );
    for k in 0..203 {
        let (a, b) = (0.1 + 0.001 * f64::from(k), 0.3 - 0.001 * f64::from(k));
        source += &format!(
            "[[body]]\nname = \"b{k}\"\nmass = 1.0\ninertia = [0.5, 0.8, 1.1]\nangular_velocity = [{a}, 2.0, {b}]\n"
        );
    }
    source += "[[event]]\nat = 0.70003\nfor = 0.1\nbody = \"b77\"\nforce = [1.0, 0.0, 0.0]\npoint = [0.0, 0.3, 0.1]\n";
    let scene = parse(&source);
    let on = |threads: usize| {
        let (outcome, done) = Simulation::new(&scene)
            .on_threads(threads)
            .run(&mut Nowhere);
        done.unwrap();
        outcome.end
    };
    let alone = on(1);
    for threads in [2, 3, 7] {
        assert_eq!(on(threads), alone, "{threads} threads");
    }
}

#[test]
fn what_accuracy_costs() {
    let mut scene = top("method = \"rk4\"\nstep = 0.01");
    scene.duration = 5.0;
    let methods = ["semi-implicit", "rk4", "dop853", "closed-form"];
    let ladder = Ladder {
        methods: methods.map(|name| integrator::find(name).unwrap()).to_vec(),
        repeats: 1,
        longest: Duration::from_millis(100),
    };
    let mut seen = Vec::new();
    let mut watch = |progress: torquescope::cost::Progress| {
        seen.push(progress.method);
        ControlFlow::Continue(())
    };
    let cost = ladder.measure(&scene, &|_, _| None, &mut watch).unwrap();
    // A torque acts: no closed form, and the reason is given.
    assert_eq!(cost.refused.len(), 1);
    assert_eq!(cost.refused[0].0, "closed-form");
    assert!(
        cost.refused[0].1.contains("torque"),
        "{}",
        cost.refused[0].1
    );
    assert!(cost.instants >= 50, "{}", cost.instants);
    assert!(cost.uncertainty < 1e-11, "{}", cost.uncertainty);
    for method in &methods[..3] {
        let errors: Vec<f64> = cost
            .rungs
            .iter()
            .filter(|rung| rung.method == *method)
            .map(|rung| rung.error)
            .collect();
        let least = errors.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(errors.len() >= 3, "{method}: {errors:?}");
        assert!(least < errors[0], "{method}: {errors:?}");
    }
    // The front: each point truer than every cheaper one, whatever the clock said.
    let mut front: Vec<_> = cost.rungs.iter().filter(|rung| rung.on_front).collect();
    front.sort_by(|a, b| a.time.median.total_cmp(&b.time.median));
    assert!(front.windows(2).all(|pair| pair[1].error < pair[0].error));
    let advice = cost.advice(1e-9).to_string();
    assert!(advice.starts_with("for 1e-9 rad: "), "{advice}");
    assert_eq!(
        cost.advice(1e-30).to_string(),
        "for 1e-30 rad: no method that was measured comes so near"
    );
    // Stopped at once, it still gives what there is.
    let stopped = ladder
        .measure(&scene, &|_, _| None, &mut |_| ControlFlow::Break(()))
        .unwrap();
    assert!(stopped.rungs.len() < cost.rungs.len());
}
