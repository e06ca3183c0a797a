//! The closed form against digits from mpmath (tests/oracles/free_body.py, 60 digits, Legendre form,
//! itself checked there against a Taylor integration).

use nalgebra::{Quaternion, Vector3};
use std::collections::BTreeMap;
use torquescope::exact::FreeMotion;

const REFERENCE: &str = include_str!("oracles/free_body.csv");

struct Case {
    kind: &'static str,
    moments: Vector3<f64>,
    omega: Vector3<f64>,
    t: f64,
    attitude: Quaternion<f64>,
    omega_t: Vector3<f64>,
}

fn cases() -> Vec<Case> {
    let case = |line: &'static str| {
        let fields: Vec<&str> = line.split(',').collect();
        let hex = |k: usize| hexadecimal(fields[k]);
        let decimal = |k: usize| fields[k].parse::<f64>().unwrap();
        Case {
            kind: fields[0],
            moments: Vector3::new(hex(1), hex(2), hex(3)),
            omega: Vector3::new(hex(4), hex(5), hex(6)),
            t: hex(7),
            attitude: Quaternion::new(decimal(11), decimal(8), decimal(9), decimal(10)),
            omega_t: Vector3::new(decimal(12), decimal(13), decimal(14)),
        }
    };
    REFERENCE.lines().skip(1).map(case).collect()
}

/// A C99 hexadecimal float, as Python's `float.hex` writes it; exact.
fn hexadecimal(text: &str) -> f64 {
    let (sign, text) = match text.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, text),
    };
    let (digits, exponent) = text.strip_prefix("0x").unwrap().split_once('p').unwrap();
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let mantissa = u64::from_str_radix(&format!("{whole}{fraction}"), 16).unwrap() as f64;
    let exponent = exponent.parse::<i32>().unwrap() - 4 * fraction.len() as i32;
    sign * mantissa * 2.0_f64.powi(exponent)
}

fn angle(a: Quaternion<f64>, b: Quaternion<f64>) -> f64 {
    let d = a.conjugate() * b;
    2.0 * d.imag().norm().atan2(d.w.abs())
}

#[test]
fn attitudes_agree_with_outside_digits_at_any_time_and_in_hard_cases() {
    let mut worst: BTreeMap<&str, (f64, f64, usize)> = BTreeMap::new();
    for case in cases() {
        let motion = FreeMotion::new(case.moments, Quaternion::identity(), case.omega);
        let (q, omega) = motion.at(case.t);
        let off = angle(q, case.attitude);
        let momentum = |w: Vector3<f64>| case.moments.component_mul(&w);
        let size = momentum(case.omega_t).norm();
        let drift = momentum(omega - case.omega_t).norm() / size;
        let entry = worst.entry(case.kind).or_default();
        *entry = (entry.0.max(off), entry.1.max(drift), entry.2 + 1);
        // Measured: at most 1.4e-15 rad over all of them. A few roundings of unit quaternions,
        // whatever the time and the body.
        let bound = 4e-15;
        assert!(off < bound, "{}: {off:e} rad at t = {}", case.kind, case.t);
        assert!(drift < 2.0 * bound, "{}: L off by {drift:e}", case.kind);
    }
    for (kind, (off, drift, count)) in &worst {
        println!("{kind:20} {count:3} cases: {off:.1e} rad, {drift:.1e} of |L|");
    }
    assert!(worst.len() >= 9);
}

/// Angular velocities and attitudes that other programs' tests use.
#[test]
fn known_motions() {
    let identity = Quaternion::identity();
    // Near the middle axis: 6.5 flips in 10 s.
    let moments = Vector3::new(1.0, 2.0, 3.0);
    let motion = FreeMotion::new(moments, identity, Vector3::new(0.01, 10.0, 0.01));
    let reference = Vector3::new(
        4.469_607_977_065_771,
        8.945_541_041_845_934,
        2.580_542_285_944_952,
    );
    // The rounding of 0.01 in the input is already in the reference: roundings of size 10 remain.
    assert!((motion.at(10.0).1 - reference).norm() < 1e-14);
    // Basilisk's spacecraft test, in modified Rodrigues parameters.
    let moments = Vector3::new(500.0, 200.0, 300.0);
    let motion = FreeMotion::new(moments, identity, Vector3::new(0.5, -0.4, 0.7));
    let q = motion.attitude(10.0);
    let q = if q.w < 0.0 { -q } else { q };
    let mrp = q.imag() / (1.0 + q.w);
    let reference = Vector3::new(
        0.373_034_284_890_467,
        -0.002_395_644_131_346_16,
        0.208_570_797_155_28,
    );
    // The quoted digits end at 1e-15.
    assert!((mrp - reference).norm() < 2e-15, "{mrp}");
}

#[test]
fn steady_rotations_are_steady() {
    let identity = Quaternion::identity();
    for (moments, omega) in [
        (Vector3::new(1.0, 2.0, 3.0), Vector3::new(0.0, 0.7, 0.0)),
        (Vector3::new(2.0, 2.0, 2.0), Vector3::new(0.3, -0.4, 1.2)),
        (Vector3::new(2.0, 2.0, 3.0), Vector3::new(0.3, -0.4, 0.0)),
        (Vector3::new(1.0, 2.0, 3.0), Vector3::zeros()),
    ] {
        let motion = FreeMotion::new(moments, identity, omega);
        let t = 12.5;
        let (q, w) = motion.at(t);
        let half = 0.5 * omega.norm() * t;
        let axis = omega.try_normalize(0.0).unwrap_or_default();
        let exact = Quaternion::from_parts(half.cos(), axis * half.sin());
        assert!(angle(q, exact) < 4e-15);
        assert_eq!(w, omega);
    }
}

#[test]
fn nothing_is_lost_in_the_extremes() {
    let moments = Vector3::new(1.0, 2.0, 3.0);
    for a in [0.0, 1e-320, 1e-300, 1e-200, 1e-139, 1e-100] {
        for b in [0.0, 1e-300, 1e-139, 1e-60] {
            for scale in [1e-150, 1.0, 1e150] {
                let omega = Vector3::new(a, 1.0, b) * scale;
                let motion = FreeMotion::new(moments, Quaternion::identity(), omega);
                for turns in [0.0, 0.3, 7.0] {
                    let (q, w) = motion.at(turns / scale);
                    assert!((q.norm() - 1.0).abs() < 1e-15 * 2.0, "{omega} {turns}: {q}");
                    // So little beside the middle axis, so early: it still turns about that axis.
                    assert!(
                        (w / scale - Vector3::y()).norm() < 1e-15,
                        "{omega} {turns}: {w}"
                    );
                }
            }
        }
    }
}

/// `q(t) = exp(t L/2 I1) q0 exp(t (1 - I3/I1) ω3 e3/2)` for I1 = I2.
#[test]
fn the_axisymmetric_body() {
    let (i1, i3) = (1.3, 0.7);
    let moments = Vector3::new(i1, i1, i3);
    let omega = Vector3::new(0.6, -0.9, 2.1);
    let q0 = Quaternion::new(0.5, -0.5, 0.5, 0.5);
    let motion = FreeMotion::new(moments, q0, omega);
    let exponential = |v: Vector3<f64>| {
        let half = 0.5 * v.norm();
        Quaternion::from_parts(half.cos(), v.normalize() * half.sin())
    };
    let u = q0.imag();
    let l = moments.component_mul(&omega);
    let l_w = l + u.cross(&l) * (2.0 * q0.w) + u.cross(&(u.cross(&l))) * 2.0;
    for t in [0.0_f64, 0.1, 1.0, 30.0, -7.0] {
        let body = Vector3::z() * ((1.0 - i3 / i1) * omega.z * t);
        let exact = match t == 0.0 {
            true => q0,
            false => exponential(l_w * (t / i1)) * q0 * exponential(body),
        };
        // The reference itself is rounded: phases of up to 60 rad, 1e-16 of each.
        assert!(angle(motion.attitude(t), exact) < 2e-14, "{t}");
    }
}

/// Exactly on the separatrix, (I3-I2) I3 ω3² = (I2-I1) I1 ω1²: with moments (3, 4, 6) that is
/// 12 ω3² = 3 ω1², ω1 = 2 ω3.
#[test]
fn on_the_separatrix_the_motion_is_hyperbolic() {
    let moments = Vector3::new(3.0, 4.0, 6.0);
    let omega = Vector3::new(2.0, 0.0, 1.0);
    let motion = FreeMotion::new(moments, Quaternion::identity(), omega);
    // m2 = G tanh(λ t), from m2 = 0: ω2 = (G/4) tanh(λ t), λ² = (I2-I1)(I3-I2)/(I1 I3) (G/I2)².
    let g = (36.0_f64 + 36.0).sqrt();
    let lambda = (1.0 * 2.0 / 18.0_f64).sqrt() * g / 4.0;
    for t in [0.3_f64, 2.0, 10.0, 40.0, 1e3, 1e9, -1e9] {
        let (q, w) = motion.at(t);
        let size = g / 4.0 * (lambda * t).tanh().abs();
        assert!((w.y.abs() - size).abs() < 2e-14, "{t}: {} {size}", w.y);
        // L stays where it was.
        let u = q.imag();
        let l = moments.component_mul(&w);
        let l_w = l + u.cross(&l) * (2.0 * q.w) + u.cross(&(u.cross(&l))) * 2.0;
        assert!((l_w - moments.component_mul(&omega)).norm() < 2e-14);
    }
    // The same at a scale of its own: time runs faster by a power of two and a bit.
    let fast = FreeMotion::new(moments, Quaternion::identity(), omega * 1000.0);
    assert!(angle(fast.attitude(0.002), motion.attitude(2.0)) < 1e-14);
}
