//! The shipped scenes keep what their texts promise; predictions come from formulas, not from runs.

mod common;

use common::{Memory, load, run};
use nalgebra::Vector3;
use torquescope::trace::{Sample, Subject};

/// The samples of one body, with their times.
fn of<'m>(
    subjects: &[Subject],
    memory: &'m Memory,
    name: &str,
) -> impl Iterator<Item = (f64, &'m Sample)> + use<'m> {
    let index = subjects.iter().position(|s| s.name == name);
    let index = index.unwrap_or_else(|| panic!("no body {name}"));
    let samples = memory
        .samples
        .iter()
        .filter(move |(_, body, _)| *body == index);
    samples.map(|(at, _, sample)| (at.time, sample))
}

fn extremes(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (low.min(x), high.max(x))
    })
}

/// Degrees that an axis of the body leans from the world's vertical.
fn lean(sample: &Sample, axis_b: Vector3<f64>) -> f64 {
    let axis_w = sample.motion.q_wb * axis_b;
    axis_w.xz().norm().atan2(axis_w.y).to_degrees()
}

/// Times at which the values cross zero, by straight lines between samples.
fn crossings(values: &[(f64, f64)]) -> Vec<f64> {
    let pairs = values.windows(2).filter(|w| w[0].1 * w[1].1 < 0.0);
    pairs
        .map(|w| {
            let ((t0, y0), (t1, y1)) = (w[0], w[1]);
            t0 + (t1 - t0) * y0 / (y0 - y1)
        })
        .collect()
}

#[test]
fn tops_are_steady_nodding_asleep_and_too_slow() {
    let (subjects, _, memory) = run(&load("tops.toml"));
    let leans = |name: &str| {
        let up = -Vector3::y();
        extremes(of(&subjects, &memory, name).map(|(_, sample)| lean(sample, up)))
    };
    // Steady: the start has 16 digits, the run 1e-9 rad.
    let (low, high) = leans("steady");
    assert!(
        (low - 30.0).abs() < 1e-6 && (high - 30.0).abs() < 1e-6,
        "{low} {high}"
    );
    // Nodding, with u = cos θ: let go at u0, energy and both components of L give
    // `2 a (1 - u²) = b² (u0 - u)` at the other turning point, a = m g l / I1, b = I3 ω / I1.
    let (i1, i3, mgl, spin) = (0.1335_f64, 0.075, 9.81 * 0.3, 30.0);
    let u0 = 30_f64.to_radians().cos();
    let (a, b) = (mgl / i1, i3 * spin / i1);
    // 2 a u² - b² u + (b² u0 - 2 a) = 0
    let root = (b * b - (b.powi(4) - 8.0 * a * (b * b * u0 - 2.0 * a)).sqrt()) / (4.0 * a);
    let lowest = root.acos().to_degrees();
    let (low, high) = leans("nodding");
    // Sampled 60 times a second, so the turn itself is met to (ν/60)²/8 of the nod, ν = b its rate.
    let missed = (lowest - 30.0) * (b / 60.0).powi(2) / 8.0;
    assert!((low - 30.0).abs() < 2.0 * missed, "{low}");
    assert!(
        high < lowest + 1e-6 && high > lowest - 2.0 * missed,
        "{high} {lowest}"
    );
    // Asleep: stable, so it stays within a few times its first lean; too slow: it does not.
    let (_, high) = leans("asleep");
    assert!(high < 2.0, "{high}");
    let (_, high) = leans("too-slow");
    assert!(high > 45.0, "{high}");
}

#[test]
fn the_gyroscope_goes_round_as_its_weight_says() {
    let (subjects, _, memory) = run(&load("gyroscope.toml"));
    let rate = 9.81 * 0.4 * 2.0 / (0.5 * 2.0 * 0.09 * 150.0);
    let azimuth = |sample: &Sample| {
        let axle_w = sample.motion.q_wb * Vector3::y();
        (-axle_w.z).atan2(axle_w.x)
    };
    for (t, sample) in of(&subjects, &memory, "guided") {
        // The formula neglects nothing for a level axle: both roots' equation loses its square.
        let off = (azimuth(sample) - rate * t + 3.0).rem_euclid(std::f64::consts::TAU) - 3.0;
        assert!(off.abs() < 1e-7, "{t}: {off}");
        assert!((lean(sample, Vector3::y()) - 90.0).abs() < 1e-6);
    }
    let (low, high) =
        extremes(of(&subjects, &memory, "let-go").map(|(_, s)| lean(s, Vector3::y())));
    // 2 m g l I1 / (I3 ω)², the fast top's nod.
    let i1 = 2.0 * (3.0 * 0.09 + 0.0064) / 12.0 + 2.0 * 0.16;
    let nod = (2.0 * 9.81 * 0.4 * 2.0 * i1 / (0.5 * 2.0 * 0.09 * 150.0_f64).powi(2)).to_degrees();
    assert!((low - 90.0).abs() < 1e-3, "{low}");
    // Of first order in the nod: 0.03 rad of it.
    assert!((high - 90.0 - nod).abs() < 0.05 * nod, "{high} {nod}");
    assert!((nod - 1.8).abs() < 0.05, "the text says 1.8 degrees: {nod}");
}

#[test]
fn the_damped_box_goes_where_the_undamped_one_went() {
    let scene = load("damped_tumble.toml");
    let (subjects, outcome, memory) = run(&scene);
    let (first, last) = (&memory.samples[0].2, &outcome.end[0]);
    let (l0, l1) = (
        subjects[0].momentum_w(&first.motion),
        subjects[0].momentum_w(&last.motion),
    );
    // e^{-c t}: a rounding or two beside what the plan asks for.
    let left = (-0.25 * scene.duration).exp();
    assert!((l1 - l0 * left).norm() < 1e-9 * l1.norm());
    // The same box undamped, after (1 - e^{-ct})/c.
    let mut undamped = scene.clone();
    undamped
        .effects
        .retain(|effect| effect.kind == "gyroscopic");
    undamped.duration = (1.0 - left) / 0.25;
    let (_, there, _) = run(&undamped);
    let angle = last.motion.q_wb.angle_to(&there.end[0].motion.q_wb);
    // Two runs at 1e-10 rad.
    assert!(angle < 2e-10, "{angle}");
}

#[test]
fn the_thin_rod_turns_about_its_momentum() {
    let (subjects, _, memory) = run(&load("thin_rod.toml"));
    let axis_0 = Vector3::y();
    let first = memory.samples[0].2.clone();
    let momentum_w = subjects[0].momentum_w(&first.motion);
    let n = momentum_w.normalize();
    let rate = momentum_w.norm() / (1.0 / 3.0 + 0.25 * 0.005 * 0.005);
    for (t, sample) in of(&subjects, &memory, "rod") {
        let axis_w = sample.motion.q_wb * Vector3::y();
        // Rodrigues: the axis turned about L by the rate times t.
        let (sin, cos) = (rate * t).sin_cos();
        let want = axis_0 * cos + n.cross(&axis_0) * sin + n * (n.dot(&axis_0) * (1.0 - cos));
        assert!((axis_w - want).norm() < 2e-9, "{t}: {axis_w:?} {want:?}");
    }
}

#[test]
fn one_of_the_look_alikes_flips() {
    let (subjects, _, memory) = run(&load("look_alikes.toml"));
    let spin = |name: &str| -> Vec<(f64, f64)> {
        let samples = of(&subjects, &memory, name);
        let along = |s: &Sample| (s.motion.q_wb.inverse() * s.motion.omega_w).x;
        samples.map(|(t, s)| (t, along(s))).collect()
    };
    assert!(crossings(&spin("square")).is_empty());
    let flips = crossings(&spin("nearly-square"));
    // Half a period of the elliptic functions between flips: 2 K(k)/λ.
    let moments = [
        (1.0 + 0.01) / 12.0,
        (0.9409 + 0.01) / 12.0,
        (0.9409 + 1.0) / 12.0,
    ];
    let omega = [5.0, 0.01, 0.01];
    let half = half_period(moments, omega);
    assert!(flips.len() >= 2, "{flips:?}");
    let between = flips[1] - flips[0];
    // Sampled 60 times a second; straight lines between samples cross to 1e-4 s.
    assert!((between - half).abs() < 1e-3, "{between} {half}");
    assert!(
        (flips[0] - 6.6).abs() < 0.05,
        "the text says after 6.6 s: {flips:?}"
    );
}

/// Half the period in which ω about the middle axis comes back, by the arithmetic-geometric mean.
fn half_period(i: [f64; 3], w: [f64; 3]) -> f64 {
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| i[a].total_cmp(&i[b]));
    let [i1, i2, i3] = order.map(|k| i[k]);
    let [w1, w2, w3] = order.map(|k| w[k]);
    let energy = i1 * w1 * w1 + i2 * w2 * w2 + i3 * w3 * w3;
    let g2 = (i1 * w1).powi(2) + (i2 * w2).powi(2) + (i3 * w3).powi(2);
    let (i1, i3) = if g2 > energy * i2 { (i1, i3) } else { (i3, i1) };
    let lambda = ((i3 - i2) * (g2 - energy * i1) / (i1 * i2 * i3)).sqrt();
    let m = (i2 - i1) * (energy * i3 - g2) / ((i3 - i2) * (g2 - energy * i1));
    let (mut a, mut b) = (1.0, (1.0 - m).sqrt());
    for _ in 0..8 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    std::f64::consts::PI / a / lambda
}

#[test]
fn the_wing_nut_flips_when_jacobi_says() {
    let (subjects, _, memory) = run(&load("wing_nut.toml"));
    let samples = of(&subjects, &memory, "wing-nut");
    let along = |s: &Sample| (s.motion.q_wb.inverse() * s.motion.omega_w).y;
    let flips = crossings(&samples.map(|(t, s)| (t, along(s))).collect::<Vec<_>>());
    let half = half_period([1.0, 2.0, 3.0], [0.01, 10.0, 0.01]);
    assert!((half - 2.753).abs() < 5e-4, "the text says 2.753: {half}");
    assert!(flips.len() >= 6, "{flips:?}");
    for pair in flips.windows(2) {
        // Straight lines between 60 samples a second, where ω changes by some 10 rad/s in 0.3 s.
        assert!((pair[1] - pair[0] - half).abs() < 2e-3, "{flips:?}");
    }
}

#[test]
fn five_engines_drift_apart_from_the_truth_each_in_its_way() {
    let (subjects, outcome, memory) = run(&load("five_engines.toml"));
    let index = |name: &str| subjects.iter().position(|s| s.name == name).unwrap();
    let flips = |name: &str| {
        let samples = of(&subjects, &memory, name);
        let along = |s: &Sample| (s.motion.q_wb.inverse() * s.motion.omega_w).y;
        crossings(&samples.map(|(t, s)| (t, along(s))).collect::<Vec<_>>())
    };
    let energy = |name: &str| {
        let k = index(name);
        let start = subjects[k].energy(&memory.samples[k].2.motion);
        subjects[k].energy(&outcome.end[k].motion) / start
    };
    let half = half_period([1.0, 2.0, 3.0], [0.01, 10.0, 0.01]);
    let truly = flips("true");
    assert!((truly[1] - truly[0] - half).abs() < 2e-3, "{truly:?}");
    let later = |name: &str| {
        let flips = flips(name);
        let between: Vec<f64> = flips.windows(2).map(|w| w[1] - w[0]).collect();
        assert!(between.len() > 2, "{name}: {flips:?}");
        assert!(between[0] > 1.02 * half, "{name}: {between:?}");
        assert!(
            between.windows(2).all(|w| w[1] > w[0]),
            "{name}: {between:?}"
        );
    };
    later("jolt");
    later("rapier");
    assert!(energy("bullet") < 0.7, "{}", energy("bullet"));
    assert!(energy("tutorial") > 2.0, "{}", energy("tutorial"));
    let angle = |name: &str| {
        let end = |name: &str| outcome.end[index(name)].motion.q_wb;
        end(name).angle_to(&end("true"))
    };
    assert!(angle("mujoco") < 0.1, "{}", angle("mujoco"));
    assert!(angle("jolt") > 0.5 || angle("rapier") > 0.5);
}

#[test]
fn gravity_holds_one_satellite_swings_another_and_tips_the_third() {
    let (subjects, _, memory) = run(&load("satellite.toml"));
    // The angle between the long axis and the local vertical, in the plane of the orbit.
    let off = |name: &str| -> Vec<(f64, f64)> {
        let samples = of(&subjects, &memory, name);
        let angle = |s: &Sample| {
            let axis_w = s.motion.q_wb * Vector3::y();
            let up_w = s.motion.position_w.normalize();
            up_w.cross(&axis_w).z.atan2(up_w.dot(&axis_w))
        };
        samples.map(|(t, s)| (t, angle(s))).collect()
    };
    // A tolerance of 1e-11 a step, some thousand steps; the start has 15 digits.
    let upright = off("upright");
    assert!(upright.iter().all(|(_, a)| a.sin().abs() < 1e-7));
    // θ'' = -3/2 Ω² k sin 2θ, k = (I_roll - I_yaw)/I_pitch: a pendulum of 2θ, its quarter period by the
    // arithmetic-geometric mean.
    let (roll, yaw, pitch) = (1.44 + 0.04, 0.25 + 0.04, 0.25 + 1.44);
    let omega = (3.0_f64 * (roll - yaw) / pitch).sqrt();
    let (mut a, mut b) = (1.0, 25_f64.to_radians().cos());
    for _ in 0..8 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    let half = std::f64::consts::PI / omega / a;
    assert!(
        (2.0 * half - 4.5).abs() < 0.05,
        "the text says 4.5: {}",
        2.0 * half
    );
    let swing: Vec<(f64, f64)> = off("librating")
        .into_iter()
        .map(|(t, a)| (t, a.sin()))
        .collect();
    let through = crossings(&swing);
    assert!(through.len() >= 7, "{through:?}");
    for pair in through.windows(2) {
        // The swing pulls the orbit out of round by half a percent, e = 3/2 (tr I - 3 I_r)/m r² or so, and the
        // orbit swings the body by 2 e/(ω² - 1), 0.01 rad: 1 % of a half period at most, and what e adds.
        let off = pair[1] - pair[0] - half;
        assert!(off.abs() < 0.015 * half, "{through:?} {half}");
    }
    let lying = off("lying");
    assert!(
        lying.iter().any(|(_, a)| a.cos().abs() > 0.9),
        "it tips over"
    );
}

#[test]
fn the_wheels_stop_the_tumbling_within_their_limit() {
    let (subjects, outcome, memory) = run(&load("detumble.toml"));
    let wheels = subjects[0]
        .sources
        .iter()
        .position(|name| name == "wheels")
        .unwrap();
    let momentum = |s: &Sample| subjects[0].momentum_w(&s.motion);
    let start = momentum(&memory.samples[0].2);
    let mut at_limit = 0;
    for (t, sample) in of(&subjects, &memory, "satellite") {
        let torque = sample.sources[wheels].norm();
        assert!(torque <= 0.4 * (1.0 + 1e-12), "{t}: {torque}");
        if t < 3.0 {
            // Free: by a tolerance of 1e-10 a step.
            assert!((momentum(sample) - start).norm() < 1e-8 * start.norm());
        }
        at_limit += usize::from(torque > 0.4 * (1.0 - 1e-9));
    }
    assert!(at_limit > 30, "{at_limit}");
    let end = &outcome.end[0].motion;
    assert!(
        end.omega_w.norm() < 0.02 && end.q_wb.angle() < 0.02,
        "{end:?}"
    );
}

#[test]
fn every_click_of_an_eye_gives_the_same_momentum() {
    let scene = load("click_storm.toml");
    let (subjects, outcome, _) = run(&scene);
    let mass = subjects[0].mass.unwrap();
    let total: Vector3<f64> = outcome.end.iter().map(|s| s.motion.velocity_w * mass).sum();
    let ray = |name: &str| match name {
        "from-the-front" => Vector3::new(0.0, 0.0, -1.0),
        "from-the-right" => Vector3::new(-6.0, 0.0, -0.9).normalize(),
        _ => Vector3::new(0.0, 6.0, -1.95).normalize(),
    };
    let struck = outcome.blows.iter().map(|blow| {
        let name = scene.events[blow.event].name.as_deref().unwrap_or_default();
        ray(name) * 0.4
    });
    let given: Vector3<f64> = struck.sum();
    // Some tens of additions of numbers up to 10.
    assert!((total - given).norm() < 1e-12, "{total:?} {given:?}");
    let met: std::collections::BTreeSet<usize> = outcome.blows.iter().map(|b| b.body).collect();
    assert!(met.len() >= 4, "clicks met {met:?}");
    // Others went by, once what they would have met was gone.
    assert!(outcome.blows.len() < scene.events.len());
}

#[test]
fn each_of_ten_thousand_keeps_its_momentum_and_energy() {
    let scene = load("swarm.toml");
    let (subjects, outcome, memory) = run(&scene);
    assert_eq!(subjects.len(), 10_000);
    assert!(memory.samples.is_empty(), "of a swarm nothing is derived");
    for (subject, sample) in subjects.iter().zip(&outcome.end) {
        let momentum = |motion| subject.momentum_w(motion);
        let (l0, l1) = (momentum(&subject.start), momentum(&sample.motion));
        // Rotations in sequence keep L to rounding, 300 steps of a few; the energy to second order in
        // ω h = 0.04 at most, without drift.
        assert!((l1 - l0).norm() < 1e-12 * l0.norm(), "{}", subject.name);
        let (e0, e1) = (
            subject.energy(&subject.start),
            subject.energy(&sample.motion),
        );
        assert!((e1 - e0).abs() < 2e-3 * e0, "{}: {e0} {e1}", subject.name);
    }
}

#[test]
fn the_gallery_shows_every_scene() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join("docs/gallery.md")).unwrap();
    for entry in std::fs::read_dir(root.join("scenes")).unwrap().flatten() {
        let path = entry.path();
        if path.extension().is_some_and(|ending| ending == "toml") {
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            let wanted = format!("gallery/{name}.png");
            assert!(page.contains(&wanted), "{name}: run docs/gallery.py");
            assert!(root.join("docs").join(wanted).is_file(), "{name}");
            let title = torquescope::scene::Scene::load(&path).unwrap().title;
            assert!(page.contains(&title), "{name}: run docs/gallery.py");
        }
    }
}
