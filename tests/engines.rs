//! The engines' schemes against the engines: trajectories that each wrote itself
//! (tests/oracles/engines: the programs that ran them, and what came out).
//!
//! One body, I = (1, 2, 3), identity start, ω = (0.1, 2, 0.1), 1,000 steps of 0.01 s: `top` free,
//! `torque` under (0.3, 0, 0.2) N·m in the world, `damped` with the engine's own damping number 0.1,
//! `torquedamped` both, `fast` free at (60, 70, 20) rad/s. Columns: t, q (x, y, z, w), ω in the world.

use nalgebra::{Matrix3, Quaternion, Vector3};
use std::sync::Arc;
use torquescope::body::{Inertial, InertialBlock, LaneSet, State, StateBlock};
use torquescope::effect::{Couple, EFFECTS, Effect, Frame, Load, Value, WrenchBlock};
use torquescope::integrator::{Interval, Step, find};
use torquescope::mass::MassProperties;

const H: f64 = 0.01;

/// What an engine's number 0.1 for damping means.
#[derive(Clone, Copy)]
enum Damp {
    None,
    /// A rate, 1/s.
    Rate(f64),
    /// What is left after a second.
    Left(f64),
    /// N·m·s/rad, whatever the inertia.
    Torque(f64),
}

/// `τ = -d ω`.
#[derive(Debug)]
struct Viscous(f64);

impl Effect for Viscous {
    fn name(&self) -> &'static str {
        "viscous"
    }

    fn lanes(&self) -> LaneSet {
        LaneSet::ALL
    }

    fn add(&self, _: f64, _: &InertialBlock, state: &StateBlock, wrench: &mut WrenchBlock) {
        wrench.add_torque(0, state.get(0).omega_w * -self.0);
    }
}

fn effect(name: &str, value: &Value, load: &mut Load) {
    let kind = EFFECTS.iter().find(|kind| kind.name == name).unwrap();
    let called = (kind.make)(value, 1.0).unwrap();
    // Terms of the model, which act on all bodies of a block.
    assert!(called.is_model_term());
    load.call(&name.into(), &called, &[]);
}

fn load(gyroscopic: bool, torque: bool, damp: Damp) -> Load {
    let mut load = Load::default();
    if gyroscopic {
        effect("gyroscopic", &Value::Switch(true), &mut load);
    }
    if torque {
        load.push(Arc::new(Couple {
            lane: 0,
            torque: Frame::World(Vector3::new(0.3, 0.0, 0.2)),
        }));
    }
    match damp {
        Damp::None => {}
        Damp::Rate(c) => {
            let rates = Value::numbers(&[("angular", c)]);
            effect("damping", &rates, &mut load);
        }
        Damp::Left(part) => {
            let rates = Value::numbers(&[("angular_factor", part)]);
            effect("damping", &rates, &mut load);
        }
        Damp::Torque(d) => load.push(Arc::new(Viscous(d))),
    }
    load
}

fn body(moments: Vector3<f64>) -> (Inertial, InertialBlock) {
    let properties =
        MassProperties::new(1.0, Matrix3::from_diagonal(&moments), [false; 3]).unwrap();
    let (inertial, _) = Inertial::new(&properties, None);
    let mut block = InertialBlock::default();
    block.set(0, inertial);
    (inertial, block)
}

fn spinning(q_wp: Quaternion<f64>, omega_w: Vector3<f64>) -> State {
    State {
        x_w: Vector3::zeros(),
        v_w: Vector3::zeros(),
        q_wp,
        omega_w,
    }
}

/// The states after each of `n` steps of `h`, that at the start first.
fn run(
    method: &str,
    load: &Load,
    moments: Vector3<f64>,
    start: State,
    h: f64,
    n: usize,
) -> Vec<State> {
    let mut state = StateBlock::default();
    state.set(0, start);
    let interval = Interval {
        load: load.clone(),
        inertial: body(moments).1,
        bodies: 1,
        until: n as f64 * h,
        tolerance: 1e-12,
    };
    let step = |k: usize| Step {
        from: k as f64 * h,
        h,
        to: (k + 1) as f64 * h,
        keep: true,
    };
    let steps: Vec<Step> = (0..n).map(step).collect();
    let mut kept = vec![state];
    let method = find(method).unwrap();
    method
        .start(interval, 0.0, &state)
        .advance(&steps, &mut kept);
    kept.iter().map(|block| block.get(0)).collect()
}

struct Row {
    k: usize,
    q: Quaternion<f64>,
    omega_w: Vector3<f64>,
}

fn rows(text: &str) -> Vec<Row> {
    let row = |line: &str| {
        let n: Vec<f64> = line.split(',').map(|x| x.trim().parse().unwrap()).collect();
        let [t, x, y, z, w, a, b, c] = n[..] else {
            panic!("{line}")
        };
        Row {
            k: (t / H).round() as usize,
            q: Quaternion::new(w, x, y, z),
            omega_w: Vector3::new(a, b, c),
        }
    };
    text.lines().skip(1).map(row).collect()
}

/// The largest difference of any component of q (of either sign) and of ω, after the first step and over
/// all rows.
fn differences(rows: &[Row], states: &[State]) -> [f64; 2] {
    let off = |row: &Row| {
        let s = &states[row.k];
        let sign = row.q.coords.dot(&s.q_wp.coords).signum();
        let q = (s.q_wp.coords * sign - row.q.coords).amax();
        q.max((s.omega_w - row.omega_w).amax())
    };
    [off(&rows[1]), rows.iter().map(off).fold(0.0, f64::max)]
}

macro_rules! csv {
    ($name:literal) => {
        include_str!(concat!("oracles/engines/", $name, ".csv"))
    };
}

type Case = (&'static str, &'static str, bool, bool, Damp, &'static str);

const CASES: &[Case] = &[
    (
        "rapier",
        "top",
        true,
        false,
        Damp::None,
        csv!("rapier_default_top"),
    ),
    (
        "rapier",
        "torque",
        true,
        true,
        Damp::None,
        csv!("rapier_default_torque"),
    ),
    (
        "rapier",
        "damped",
        true,
        false,
        Damp::Rate(0.1),
        csv!("rapier_default_damped"),
    ),
    (
        "rapier",
        "torquedamped",
        true,
        true,
        Damp::Rate(0.1),
        csv!("rapier_default_torquedamped"),
    ),
    (
        "rapier",
        "torquedamped, gyroscopic off",
        false,
        true,
        Damp::Rate(0.1),
        csv!("rapier_nogyro_torquedamped"),
    ),
    (
        "jolt",
        "top",
        true,
        false,
        Damp::None,
        csv!("jolt_gyro_top"),
    ),
    (
        "jolt",
        "torque",
        true,
        true,
        Damp::None,
        csv!("jolt_gyro_torque"),
    ),
    (
        "jolt",
        "damped",
        true,
        false,
        Damp::Rate(0.1),
        csv!("jolt_gyro_damped"),
    ),
    (
        "jolt",
        "torquedamped",
        true,
        true,
        Damp::Rate(0.1),
        csv!("jolt_gyro_torquedamped"),
    ),
    (
        "jolt",
        "torquedamped, gyroscopic off",
        false,
        true,
        Damp::Rate(0.1),
        csv!("jolt_default_torquedamped"),
    ),
    (
        "bullet",
        "top",
        true,
        false,
        Damp::None,
        csv!("bullet_rb_top"),
    ),
    (
        "bullet",
        "torque",
        true,
        true,
        Damp::None,
        csv!("bullet_rb_torque"),
    ),
    (
        "bullet",
        "damped",
        true,
        false,
        Damp::Left(0.9),
        csv!("bullet_rb_damped"),
    ),
    (
        "bullet",
        "torquedamped",
        true,
        true,
        Damp::Left(0.9),
        csv!("bullet_rb_torquedamped"),
    ),
    (
        "mujoco-rk4",
        "top",
        true,
        false,
        Damp::None,
        csv!("mujoco_RK4_top"),
    ),
    (
        "mujoco-rk4",
        "torque",
        true,
        true,
        Damp::None,
        csv!("mujoco_RK4_torque"),
    ),
    (
        "mujoco-rk4",
        "damped",
        true,
        false,
        Damp::Torque(0.1),
        csv!("mujoco_RK4_damped"),
    ),
    (
        "mujoco-rk4",
        "torquedamped",
        true,
        true,
        Damp::Torque(0.1),
        csv!("mujoco_RK4_torquedamped"),
    ),
    (
        "mujoco-rk4",
        "fast",
        true,
        false,
        Damp::None,
        csv!("mujoco_RK4_fast"),
    ),
];

/// The largest difference of any component of q and ω, wherever both are.
fn apart(a: &State, b: &State) -> f64 {
    let sign = a.q_wp.coords.dot(&b.q_wp.coords).signum();
    let q = (a.q_wp.coords * sign - b.q_wp.coords).amax();
    q.max((a.omega_w - b.omega_w).amax())
}

#[test]
fn the_schemes_are_what_the_engines_do() {
    let moments = Vector3::new(1.0, 2.0, 3.0);
    for &(method, case, gyroscopic, torque, damp, text) in CASES {
        let rows = rows(text);
        assert_eq!(rows.len(), 14, "{method} {case}");
        let start = spinning(rows[0].q, rows[0].omega_w);
        let load = load(gyroscopic, torque, damp);
        let states = |method, start| run(method, &load, moments, start, H, 1000);
        let ours = states(method, start);
        let [first, all] = differences(&rows, &ours);
        // Jolt computes in single precision, and we in double.
        let epsilon = match method {
            "jolt" => f64::from(f32::EPSILON),
            _ => f64::EPSILON,
        };
        let rounding = epsilon * start.omega_w.norm().max(1.0);
        // A few roundings for each of Rapier's four substeps, or of MuJoCo's four stages.
        assert!(first < 16.0 * rounding, "{method} {case}: {first:e}");
        // How much this motion enlarges what disturbs it, by the scheme itself: 1 to 178 times.
        let nudge = 1e-9;
        let nudged = State {
            omega_w: start.omega_w + Vector3::z() * nudge,
            ..start
        };
        let nudged = states(method, nudged);
        let growth = rows
            .iter()
            .map(|row| apart(&ours[row.k], &nudged[row.k]) / nudge);
        let growth = growth.fold(1.0, f64::max);
        // A rounding in each of 1,000 steps, at worst all the same way, and each enlarged.
        let bound = 1000.0 * rounding * growth;
        println!("{method} {case}: {first:.1e} after a step, {all:.1e} of {bound:.1e} over 1,000");
        assert!(all < bound, "{method} {case}: {all:e}, bound {bound:e}");
        // And it is this engine's scheme, not another's.
        for other in ["rapier", "jolt", "bullet", "mujoco-rk4"] {
            if other != method {
                let [_, off] = differences(&rows, &states(other, start));
                assert!(
                    off > 2.0 * bound,
                    "{method} {case}: {other} is off by {off:e}"
                );
            }
        }
    }
}

/// The wing nut: I = (1, 2, 3) about its middle axis, ω = (0.01, 10, 0.01), free, for a minute.
struct WingNut {
    /// The times at which ω about the middle axis changes sign, s.
    flips: Vec<f64>,
    /// What is left at the end, of 1.
    energy: f64,
    momentum: f64,
    /// The farthest that L pointed from where it must, degrees.
    wander: f64,
}

fn wing_nut(method: &str, hz: u32) -> WingNut {
    let moments = Vector3::new(1.0, 2.0, 3.0);
    let start = spinning(Quaternion::identity(), Vector3::new(0.01, 10.0, 0.01));
    let h = 1.0 / f64::from(hz);
    let free = load(true, false, Damp::None);
    let states = run(method, &free, moments, start, h, 60 * hz as usize);
    let end = &states[states.len() - 1];
    let body = body(moments).0;
    let energy = |s: &State| 0.5 * s.omega_w.dot(&body.momentum_w(s));
    let momentum = body.momentum_w(&start);
    let wander = states.iter().map(|s| body.momentum_w(s).angle(&momentum));
    WingNut {
        flips: flips(&states, h),
        energy: energy(end) / energy(&start),
        momentum: body.momentum_w(end).norm() / momentum.norm(),
        wander: wander.fold(0.0, f64::max).to_degrees(),
    }
}

fn flips(states: &[State], h: f64) -> Vec<f64> {
    let spin = |s: &State| s.to_principal(s.omega_w).y;
    let crossing = |(k, pair): (usize, &[State])| {
        let (a, b) = (spin(&pair[0]), spin(&pair[1]));
        (a * b < 0.0).then(|| h * (k as f64 + a / (a - b)))
    };
    states.windows(2).enumerate().filter_map(crossing).collect()
}

/// What a player sees of the schemes: how often a wing nut flips. In truth every 2.753084 s, half its
/// period of 5.506168 s (K(k) in 40 digits).
#[test]
fn how_often_a_wing_nut_flips() {
    let interval = |seen: &WingNut| {
        let n = seen.flips.len();
        (seen.flips[n - 1] - seen.flips[0]) / (n as f64 - 1.0)
    };
    // The figures were found with other programs of these schemes, to the digits given.
    for (method, hz, expected) in [
        ("mujoco-rk4", 60, 2.753),
        ("bullet", 60, 2.739),
        ("bullet", 240, 2.750),
        ("jolt", 60, 4.967),
        ("jolt", 240, 3.402),
        // Four substeps: at 60 Hz as the scheme is at 240.
        ("rapier", 60, 3.402),
    ] {
        let seen = wing_nut(method, hz);
        let every = interval(&seen);
        println!(
            "{method} at {hz} Hz: every {every:.3} s, E {:.3}, |L| {:.3}, L off by {:.1} degrees",
            seen.energy, seen.momentum, seen.wander
        );
        assert!((every - expected).abs() < 1e-3, "{method} {hz}: {every}");
        match method {
            // |L| is restored at every step (four times in Rapier's), and ω made of it: four roundings
            // each, and they do not cancel.
            "jolt" | "rapier" => {
                let times = 60.0 * f64::from(hz) * if method == "rapier" { 4.0 } else { 1.0 };
                let off = seen.momentum - 1.0;
                assert!(off.abs() < 4.0 * f64::EPSILON * times, "{method}: {off:e}");
                assert!(seen.wander > 1.0, "{method}: {}", seen.wander);
                assert!((seen.energy - 1.0).abs() < 1e-3, "{}", seen.energy);
            }
            "bullet" if hz == 60 => {
                assert!((seen.energy - 0.103).abs() < 1e-3, "{}", seen.energy);
            }
            _ => {}
        }
    }
}

/// The steps after which Rapier itself, 60 Hz, found that a body of I = (1, 2, 3), ω = (0.1, 2, 0.1) had
/// flipped (tests/oracles/engines/rapier, `wingnut`).
#[test]
fn rapier_flips_when_rapier_does() {
    let start = spinning(Quaternion::identity(), Vector3::new(0.1, 2.0, 0.1));
    let h = 1.0 / 60.0;
    let free = load(true, false, Damp::None);
    let states = run("rapier", &free, Vector3::new(1.0, 2.0, 3.0), start, h, 1800);
    let after = flips(&states, h)
        .iter()
        .map(|t| (t / h).ceil() as u32)
        .collect::<Vec<_>>();
    assert_eq!(after, [244, 665, 1088, 1513]);
}
