//! The room's parts; the zoo (tests/zoo) tests the whole.

use super::case::Case;
use super::kinematics::{Frame, Scale};
use super::motion::Motion;
use super::{Answer, CAUSES, diagnose};
use crate::exact::FreeMotion;
use crate::log::{Declared, Logged, Rows};
use crate::math::{axis_angle, exponential};
use nalgebra::{Matrix3, Quaternion, Unit, UnitQuaternion, Vector3};
use proptest::prelude::*;

/// A turning that is no solution of anything, in closed form: q = exp(a(t)) exp(b(t)), so that ω is known exactly.
fn turning(rows: usize, h: f64) -> Rows {
    let (u, v) = (
        Unit::new_normalize(Vector3::new(1.0, 2.0, 3.0)),
        Unit::new_normalize(Vector3::new(-2.0, 1.0, 0.5)),
    );
    let mut log = Rows::default();
    for k in 0..rows {
        let t = h * k as f64;
        // Angles t² and 2t + sin t.
        let first = axis_angle(u, t * t * 0.3);
        let q = first * axis_angle(v, 2.0 * t + libm::sin(t));
        let omega = u.into_inner() * (0.6 * t) + first * (v.into_inner() * (2.0 + libm::cos(t)));
        log.times.push(t);
        log.attitudes.push([q.i, q.j, q.k, q.w]);
        log.omegas.push(omega.into());
    }
    log
}

fn logged(rows: Rows, moments: [f64; 3]) -> Logged {
    Logged {
        name: "body".to_owned(),
        declared: Some(Declared {
            mass: Some(2.0),
            inertia_b: Matrix3::from_diagonal(&Vector3::from(moments)),
            centre_of_mass_b: Vector3::zeros(),
            size: None,
        }),
        rows,
    }
}

/// Every reading of the search is found when the log is written so.
#[test]
fn the_search_finds_how_a_log_was_written() {
    let right = turning(600, 0.01);
    let m = Motion::new(&right).unwrap();
    // Half way between rows ω is off by h²/8 ω'', the δ by h²/12 of it or so: 1e-4 of ω.
    assert!(super::kinematics::as_logged(&m) < 1e-3);
    let permuted = Matrix3::new(0.0, -1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0);
    let minus = -Matrix3::identity();
    for (axes, frame, scale) in [
        (permuted, Frame::World, 1.0),
        (minus, Frame::World, 1.0),
        (Matrix3::identity(), Frame::Body, 1.0),
        (Matrix3::identity(), Frame::Beyond, 2.0),
        (permuted, Frame::Body, 0.5),
        (
            Matrix3::identity(),
            Frame::World,
            180.0 / std::f64::consts::PI,
        ),
    ] {
        let mut rows = right.clone();
        for (omega, q) in rows.omegas.iter_mut().zip(&m.q) {
            let there = Vector3::from(*omega);
            let there = match frame {
                Frame::World => there,
                Frame::Body => q.inverse_transform_vector(&there),
                Frame::Beyond => q.transform_vector(&there),
            };
            *omega = (axes.transpose() * there / scale).into();
        }
        let log = logged(rows, [1.0, 2.0, 2.5]);
        let case = Case::new(&log);
        let best = case.kinematics().unwrap().best.unwrap();
        assert!(best.residual < 1e-3, "{}", best.residual);
        assert_eq!((best.axes, best.frame), (axes, frame));
        let factor = match best.scale {
            Scale::One => 1.0,
            Scale::Half(s) | Scale::Degrees(s) | Scale::Rate(s) => s,
        };
        assert!((factor / scale - 1.0).abs() < 1e-12);
    }
}

/// Fifth differences of white noise: σ to some percent, whatever the smooth motion beneath it.
#[test]
fn noise_is_measured_beneath_a_motion() {
    let mut rows = turning(2_000, 0.01);
    for (n, omega) in rows.omegas.iter_mut().enumerate() {
        for (axis, x) in omega.iter_mut().enumerate() {
            // A sum of twelve even numbers has the variance one.
            let at = |i: u64| crate::math::draw::unit(7, 36 * n as u64 + 12 * axis as u64 + i);
            *x += 0.02 * ((0..12).map(at).sum::<f64>() - 6.0);
        }
    }
    let m = Motion::new(&rows).unwrap();
    // 4,500 differences, each five deep in its neighbours': some percent.
    assert!((m.sigma / 0.02 - 1.0).abs() < 0.1, "{}", m.sigma);
    assert!(m.noisy() && m.sigma_q < 1e-6);
}

/// A ball that turns steadily tells nothing; neither does a log of nothing.
#[test]
fn what_tells_nothing_is_not_judged() {
    let mut rows = Rows::default();
    assert_eq!(
        diagnose(&logged(rows.clone(), [1.0, 2.0, 2.5])).answer,
        Answer::CannotTell
    );
    let mut q = UnitQuaternion::identity();
    for k in 0..400 {
        rows.times.push(0.01 * f64::from(k));
        rows.omegas.push([1.0, 2.0, 0.5]);
        rows.attitudes.push([q.i, q.j, q.k, q.w]);
        q = UnitQuaternion::new_normalize(
            exponential(Vector3::new(1.0, 2.0, 0.5) * 0.01) * q.into_inner(),
        );
    }
    let ball = diagnose(&logged(rows.clone(), [1.0; 3]));
    assert_eq!(
        (ball.answer, ball.cause),
        (Answer::CannotTell, "cannot-tell")
    );
    assert!(!ball.remedy.is_empty() && !ball.why.is_empty());
    let brick = diagnose(&logged(rows, [1.0, 2.0, 2.5]));
    assert_eq!(brick.cause, "gyroscopic-missing");
    let json = brick.to_json();
    assert_eq!(json["verdict"], "fault");
    assert!(
        json["evidence"]["gyroscopic_coefficient"]["value"]
            .as_f64()
            .unwrap()
            .abs()
            < 1e-3
    );
}

#[test]
fn causes_are_named_once_and_say_everything() {
    for (k, cause) in CAUSES.iter().enumerate() {
        assert!(CAUSES[..k].iter().all(|c| c.id != cause.id), "{}", cause.id);
        for text in [
            cause.symptom,
            cause.test,
            cause.does,
            cause.formula,
            cause.remedy,
            cause.example,
        ] {
            assert!(
                !text.is_empty() && !text.contains('\n'),
                "{}: {text}",
                cause.id
            );
        }
    }
}

/// What a log may hold: mostly numbers, sometimes none.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        20 => -10.0..10.0_f64,
        2 => Just(0.0),
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => Just(1e300),
        1 => Just(-1e-300),
    ]
}

fn vectors(rows: usize) -> impl Strategy<Value = Vec<[f64; 3]>> {
    let some = proptest::collection::vec([number(), number(), number()], rows);
    let short = proptest::collection::vec([number(), number(), number()], 0..3);
    prop_oneof![5 => some, 2 => Just(Vec::new()), 1 => short]
}

/// Turns about z by angles a row, as logged and as they are.
fn about_z(rates: impl Iterator<Item = (f64, f64)>) -> Rows {
    let mut log = Rows::default();
    let mut angle: f64 = 0.0;
    for (k, (rate, logged)) in rates.enumerate() {
        let (sin, cos) = libm::sincos(0.5 * angle);
        log.times.push(0.01 * k as f64);
        log.attitudes.push([0.0, 0.0, sin, cos]);
        log.omegas.push([0.0, 0.0, logged]);
        angle += 0.01 * rate;
    }
    log
}

/// What is wrong in windows that the search left out is no reading of the others.
#[test]
fn a_log_that_is_off_here_and_there_has_a_verdict() {
    let burst = (0..1201).map(|k| if k < 1080 { (0.1, 0.11) } else { (20.0, 20.5) });
    let in_turn = (0..1921).map(|k| (2.0, if k / 12 % 2 == 0 { 2.0 } else { 3.0 }));
    for rows in [about_z(burst), about_z(in_turn)] {
        let verdict = diagnose(&logged(rows, [1.0, 2.0, 2.5]));
        assert_ne!(verdict.answer, Answer::NoFault, "{verdict:?}");
    }
}

#[test]
fn a_mass_that_is_none_is_not_physical() {
    for mass in [0.0, -3.0, f64::NAN] {
        let mut log = logged(turning(400, 0.01), [1.0, 2.0, 2.5]);
        log.declared.as_mut().unwrap().mass = Some(mass);
        let verdict = diagnose(&log);
        assert_eq!(verdict.cause, "inertia-not-physical", "{mass}");
    }
}

/// A torque that no number can be computed with spoils its own rows and no more.
#[test]
fn one_absurd_row_is_left_out() {
    let moments = [1.0, 2.0, 2.5];
    let mut rows = tumbling(moments, 400);
    rows.torques = vec![[0.0; 3]; 400];
    rows.torques[100] = [1e300, 0.0, 0.0];
    let verdict = diagnose(&logged(rows, moments));
    assert_eq!(verdict.answer, Answer::NoFault, "{verdict:?}");
    let around = |left: &crate::diagnose::LeftOut| left.from <= 1.0 && 1.0 <= left.until;
    assert!(verdict.left_out.iter().any(around), "{verdict:?}");
}

/// A free body that tumbles, in closed form.
fn tumbling(moments: [f64; 3], count: usize) -> Rows {
    let start = Vector3::new(0.4, 3.0, 0.7);
    let motion = FreeMotion::new(moments.into(), Quaternion::identity(), start);
    let mut log = Rows::default();
    for k in 0..count {
        let t = 0.01 * k as f64;
        let (q, omega_b) = motion.at(t);
        let omega = UnitQuaternion::new_normalize(q) * omega_b;
        log.times.push(t);
        log.attitudes.push([q.i, q.j, q.k, q.w]);
        log.omegas.push(omega.into());
    }
    log
}

prop_compose! {
    /// A right motion of some length of which parts are overwritten, or nothing but numbers.
    fn any_log()(rows in 0..120_usize)(
        times in proptest::collection::vec(number(), rows),
        attitudes in proptest::collection::vec([number(), number(), number(), number()], rows),
        positions in vectors(rows),
        omegas in vectors(rows),
        torques in vectors(rows),
        forces in vectors(rows),
        points in vectors(rows),
        spoilt in proptest::collection::vec(0..100_u8, rows),
        share in 0..110_u8,
        inertia in proptest::collection::vec(number(), 9),
        diagonal in any::<bool>(),
        mass in number(),
        centre in [number(), number(), number()],
        declared in any::<bool>(),
        no_attitudes in 0..10_u8,
    ) -> Logged {
        let rows = times.len();
        let mut log = turning(rows, 0.01);
        let has_omega = omegas.len() == rows;
        for k in 0..rows {
            if spoilt[k] < share {
                log.times[k] = times[k];
                log.attitudes[k] = attitudes[k];
                if has_omega {
                    log.omegas[k] = omegas[k];
                }
            }
        }
        if !has_omega {
            log.omegas = omegas;
        }
        if no_attitudes == 0 {
            log.attitudes.clear();
        }
        (log.positions, log.torques, log.forces, log.points) = (positions, torques, forces, points);
        let inertia_b = if diagonal {
            Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.5))
        } else {
            Matrix3::from_row_slice(&inertia)
        };
        Logged {
            name: "any".to_owned(),
            declared: declared.then(|| Declared {
                mass: Some(mass),
                inertia_b,
                centre_of_mass_b: Vector3::from(centre),
                size: Some(Vector3::new(mass, 1.0, 1.0)),
            }),
            rows: log,
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Whatever a log holds, there is a verdict, and it can be written down.
    #[test]
    fn any_log_has_a_verdict(log in any_log()) {
        let verdict = diagnose(&log);
        prop_assert!(verdict.confidence.is_finite());
        prop_assert!(!verdict.to_json().to_string().is_empty());
    }
}
