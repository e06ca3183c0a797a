//! What kicks alone have: the figures of the heavy top, the drift, merged steps, refusals.

use super::*;
use crate::body::{InertialBlock, LANES, LaneSet};
use crate::effect::{Depends, Effect, Load, Value};
use crate::exact::FreeMotion;
use crate::integrator::preprocessed::Preprocessed;
use crate::integrator::tests::{
    advance, angle, effect, free_triaxial, gyroscopic, heavy_top, heavy_top_at, interval, steps,
};
use crate::integrator::{Work, find};
use nalgebra::Quaternion;

const ALL: [&Composition; 6] = [&STRANG, &RKN4, &RKN6, &ORDER8, &ABA864, &ABA1064];

#[test]
fn coefficients_are_palindromes_that_sum_to_one_and_end_in_the_published_digits() {
    for c in ALL {
        for list in [c.a, c.b] {
            let sum: f64 = list.iter().sum();
            // Sixteen roundings of numbers below 1.
            assert!((sum - 1.0).abs() < 1e-15, "{}", c.info.name);
            assert!(list.iter().eq(list.iter().rev()), "{}", c.info.name);
        }
        let drifts = match c.first {
            First::Drift => c.b.len() + 1,
            First::Kick => c.b.len() - 1,
        };
        assert_eq!(c.a.len(), drifts, "{}", c.info.name);
    }
    // The middle entries, which the tables leave to the sum, as published.
    let close = |x: f64, published: f64| assert!((x - published).abs() < 1e-15, "{x} {published}");
    close(ORDER8.b[7], -0.796_887_939_352_916_4);
    close(ABA864.a[3], -0.333_698_616_227_678);
    close(ABA864.b[3], 0.065_396_142_282_373_42);
    close(ABA1064.a[4], -0.653_861_225_832_786_7);
    close(ABA1064.b[3], -0.017_375_381_959_065_093);
}

#[test]
fn aba1064_meets_its_conditions_of_orders_ten() {
    // Σ b_i c_i^k = 1/(k + 1), k = 0..9, c_i the time of kick i: no motion needed.
    let plan = Plan::of(&ABA1064);
    for k in 0..10 {
        let sum: f64 = plan.stages.iter().map(|s| s.kick * s.when.powi(k)).sum();
        // Eight roundings.
        assert!((sum - 1.0 / f64::from(k + 1)).abs() < 5e-16, "{k}: {sum}");
    }
    let next: f64 = plan.stages.iter().map(|s| s.kick * s.when.powi(10)).sum();
    assert!((next - 1.0 / 11.0).abs() > 1e-7);
}

#[test]
fn the_heavy_top_is_as_near_as_the_methods_are_known_to_bring_it() {
    // Errors at t = 10 for 400 and 1600 kicks, from an independent computation with the closed form
    // as drift and these compositions; two digits are given, kicks are rounded to whole steps.
    let known = [
        (&STRANG, 1.2e-4, 7.6e-6),
        (&RKN4, 2.8e-8, 1.3e-10),
        (&RKN6, 3.7e-9, 9e-13),
        (&ORDER8, 2.8e-8, 4.6e-13),
        (&ABA864, 2e-8, 6e-11),
        (&ABA1064, 2.4e-8, 7e-11),
    ];
    let (bodies, load, reference) = heavy_top();
    for (c, coarse, fine) in known {
        for (kicks, error) in [(400.0, coarse), (1600.0, fine)] {
            let n = (kicks / f64::from(c.info.cost.evaluations.unwrap())).round() as u32;
            let end = advance(&Kicks(c), &load, &bodies, 10.0, n);
            let seen = angle(end.q_wp, reference);
            assert!(
                seen < 1.15 * error && seen > 0.85 * error,
                "{}: {seen} {error}",
                c.info.name
            );
        }
    }
}

#[test]
fn the_heavy_top_after_a_hundred_seconds() {
    let (bodies, load, _) = heavy_top();
    for (c, n) in [(&RKN6, 4_000), (&ORDER8, 4_000), (&ABA864, 20_000)] {
        let end = advance(&Kicks(c), &load, &bodies, 100.0, n);
        let gap = angle(end.q_wp, heavy_top_at(100));
        assert!(gap < 1e-12, "{}: {gap}", c.info.name);
    }
}

#[test]
fn momentum_about_the_vertical_is_exact_under_gravity() {
    let (bodies, load, _) = heavy_top();
    let body = bodies.0.get(0);
    let before = body.momentum_w(&bodies.1.get(0)).z;
    for c in ALL {
        let end = advance(&Kicks(c), &load, &bodies, 100.0, 10_000);
        // No kick has a component along z: L_z has the bits it began with; ω and back round.
        let gap = (body.momentum_w(&end).z - before).abs();
        assert!(gap < 4e-15, "{}: {gap}", c.info.name);
    }
}

#[test]
fn what_is_kept_on_the_way_changes_nothing_and_a_step_costs_the_kicks_it_says() {
    let (bodies, load, _) = heavy_top();
    for c in ALL {
        let run = |keep: bool, stretch: usize| {
            let mut taken = steps(10.0, 300);
            for step in &mut taken {
                step.keep = keep;
            }
            let mut kept = Vec::new();
            let mut stepper = Kicks(c).start(interval(&load, bodies.0, 10.0), 0.0, &bodies.1);
            for part in taken.chunks(stretch) {
                stepper.advance(part, &mut kept);
                let _ = stepper.state();
            }
            (stepper.state().get(0), stepper.work(), kept)
        };
        let (plain, work, _) = run(false, 300);
        let (same, _, kept) = run(true, 7);
        assert_eq!(plain, same, "{}", c.info.name);
        assert_eq!(kept.last().map(|block| block.get(0)), Some(plain));
        // With kicks outside, the first of all has none before it.
        let first = u64::from(c.first == First::Kick);
        let evaluations = c.info.cost.evaluations_in(300) + first;
        assert_eq!(
            work,
            Work {
                steps: 300,
                evaluations
            },
            "{}",
            c.info.name
        );
    }
}

#[test]
fn a_body_that_nothing_turns_takes_no_kicks() {
    let (bodies, _) = free_triaxial();
    let mut stepper = Kicks(&RKN6).start(interval(&gyroscopic(), bodies.0, 1.0), 0.0, &bodies.1);
    stepper.advance(&steps(1.0, 10), &mut Vec::new());
    assert_eq!(
        stepper.work(),
        Work {
            steps: 10,
            evaluations: 0
        }
    );
}

/// A torque that says it depends on velocity.
#[derive(Debug)]
struct Drag;

impl Effect for Drag {
    fn name(&self) -> &'static str {
        "drag"
    }

    fn lanes(&self) -> LaneSet {
        LaneSet::ALL
    }

    fn add(&self, _: f64, inertial: &InertialBlock, state: &StateBlock, wrench: &mut WrenchBlock) {
        for lane in 0..LANES {
            let s = state.get(lane);
            wrench.add_torque(lane, inertial.get(lane).momentum_w(&s) * -0.1);
        }
    }

    fn depends(&self, _: &InertialBlock) -> Depends {
        Depends {
            torque: true,
            velocity: true,
            ..Depends::NOTHING
        }
    }
}

#[test]
fn a_torque_that_depends_on_velocity_is_refused() {
    let (bodies, weight, _) = heavy_top();
    let mut load = Load::default();
    load.push(Arc::new(Drag));
    for c in ALL {
        let why = c.info.refuses(&load, &bodies.0).unwrap().0;
        assert!(why.contains("depends on velocity"), "{why}");
        assert!(c.info.refuses(&weight, &bodies.0).is_none());
    }
}

/// The heavy top, damped, in either model: the order declared, against another method's fine steps.
#[test]
fn damping_and_the_tutorials_model_cost_no_order_beside_a_torque() {
    let ((inertials, states), weight, _) = heavy_top();
    for gyro in [true, false] {
        let mut load = if gyro {
            weight.clone()
        } else {
            Load::default()
        };
        if !gyro {
            effect("gravity", Value::Vector(-Vector3::z()), &mut load);
        }
        let rates = Value::numbers(&[("linear", 0.1), ("angular", 0.3)]);
        effect("damping", rates, &mut load);
        let bodies = (inertials, states);
        // Long enough for small steps to be needed.
        let t = 10.0;
        // (h ω)⁴ = 1e-13 and less, and as much rounding.
        let reference = advance(find("rk4").unwrap(), &load, &bodies, t, 50_000).q_wp;
        // Steps so fine that the leading term leads and so coarse that the reference is exact beside them.
        for (c, n) in ALL.into_iter().zip([400, 250, 45, 45, 250, 250]) {
            let error = |n| angle(advance(&Kicks(c), &load, &bodies, t, n).q_wp, reference);
            let (coarse, fine) = (error(n), error(2 * n));
            let slope = (coarse / fine).log2();
            let declared = f64::from(c.info.order);
            // Palindromes have even orders: a lost order shows as 2 less.
            assert!(
                (slope - declared).abs() < 0.5,
                "{}: {slope}, {coarse} {fine}",
                c.info.name
            );
        }
    }
}

/// Deterministic numbers in 0..1 (Knuth's MMIX generator).
fn random(seed: &mut u64) -> f64 {
    *seed = (seed.wrapping_mul(6_364_136_223_846_793_005)).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

/// The largest angle between the discrete body and the real one after a step of `h |L| / I_min` = `size`,
/// over bodies nearly round, of any shape, thin, and flat.
fn worst_drift(size: f64) -> f64 {
    let mut seed = 7;
    let mut worst = 0.0_f64;
    for k in 0..8_000 {
        let mut next = || random(&mut seed);
        let moments = match k % 4 {
            0 => Vector3::new(1.0, 1.0 + next(), 1.5 + 0.5 * next()),
            1 => {
                let (a, b) = (next() + 1e-3, next() + 1e-3);
                Vector3::new(a, b, a + b - 2.0 * a.min(b) * next())
            }
            2 => {
                let thin = libm::exp(-7.0 * next());
                Vector3::new(thin, 1.0, 1.0 + thin * (2.0 * next() - 1.0))
            }
            _ => {
                let a = next().max(0.01);
                Vector3::new(a, 1.0, (1.0 + a) * 0.9999)
            }
        };
        let l = Vector3::new(next() - 0.5, next() - 0.5, next() - 0.5).normalize();
        let (h, q) = (size * moments.min(), Quaternion::identity());
        let exact = FreeMotion::new(moments, q, l.component_div(&moments)).attitude(h);
        worst = worst.max(angle(
            Preprocessed::new(moments, 10).attitude(h, q, l),
            exact,
        ));
    }
    worst
}

#[test]
fn the_drift_is_exact_to_rounding_where_the_discrete_body_stands_in() {
    // At 0.4 its own error shows, far above rounding; it grows as the 11th power.
    let (seen, growth) = (worst_drift(0.4), 0.4_f64 / turning::DISCRETE);
    assert!(seen > 1e-13, "{seen}");
    // Half a rounding of the attitude's unit length.
    assert!(seen / growth.powi(11) < 1.1e-16, "{seen}");
    assert!(worst_drift(0.6) / seen > 1.5_f64.powi(10));
    // Where it is used: roundings of either.
    let used = worst_drift(turning::DISCRETE);
    assert!(used < 1.5e-15, "{used}");
}

#[test]
fn a_load_that_was_refused_is_never_followed_in_silence() {
    let (bodies, _, _) = heavy_top();
    let mut dragged = gyroscopic();
    dragged.push(Arc::new(Drag));
    let refused: [(&dyn Method, &Load); 3] = [
        (&Kicks(&RKN4), &dragged),
        (&crate::integrator::dlm::Dlm, &Load::default()),
        (&crate::integrator::dmv::DMV4, &dragged),
    ];
    for (method, load) in refused {
        assert!(method.info().refuses(load, &bodies.0).is_some());
        let end = advance(method, load, &bodies, 1.0, 4);
        assert!(!end.is_finite(), "{}", method.info().name);
    }
}

/// The heavy top with weight ε in place of 1: which power of ε and of h leads, by step and by ε.
#[test]
fn errors_in_weak_forces_have_the_orders_declared() {
    let (bodies, _, _) = heavy_top();
    let error = |c, weight: f64, n| {
        let mut load = gyroscopic();
        effect("gravity", Value::Vector(Vector3::z() * -weight), &mut load);
        let exact = advance(find("taylor").unwrap(), &load, &bodies, 10.0, 1).q_wp;
        angle(advance(&Kicks(c), &load, &bodies, 10.0, n).q_wp, exact)
    };
    for c in [&ABA864, &ABA1064] {
        let name = c.info.name;
        let [_, second, third] = c.info.weak_orders.unwrap().map(f64::from);
        // ε h^a leads at steps so coarse that its slope has not settled (a is tested by a torque of time
        // alone): 9.97 and 9.34; ε² would make it 100.
        let first = error(c, 1e-3, 8) / error(c, 1e-4, 8);
        assert!((first - 10.0).abs() < 1.0, "{name}: {first}");
        // ε² h^b: 103 and 99.
        let twice = error(c, 0.1, 45) / error(c, 0.01, 45);
        assert!((twice - 100.0).abs() < 5.0, "{name}: {twice}");
        // 6.1 and 4.0, or nearly: orders are even, a lost one shows as 2 less.
        for (weight, n, order) in [(0.1, 45, second), (1.0, 128, third)] {
            let slope = (error(c, weight, n) / error(c, weight, 2 * n)).log2();
            assert!((slope - order).abs() < 0.4, "{name}: {slope}");
        }
    }
}
