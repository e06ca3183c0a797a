//! The closed form against digits from mpmath (tests/oracles/free_body.py, 60 digits, Legendre form,
//! itself checked there against a Taylor integration).

use nalgebra::{Quaternion, Vector3};
use std::collections::BTreeMap;
use torquescope::exact::{DampedFreeMotion, FreeMotion, LagrangeTop, Pendulum, kovalevskaya};

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

struct HeavyTop {
    kind: &'static str,
    moments: Vector3<f64>,
    /// m g times the centre of mass, principal axes, N m.
    arm: Vector3<f64>,
    q0: Quaternion<f64>,
    omega: Vector3<f64>,
    t: f64,
    attitude: Quaternion<f64>,
    omega_t: Vector3<f64>,
}

fn heavy_tops() -> Vec<HeavyTop> {
    let read = |line: &'static str| {
        let fields: Vec<&str> = line.split(',').collect();
        let hex = |k: usize| hexadecimal(fields[k]);
        let decimal = |k: usize| fields[k].parse::<f64>().unwrap();
        HeavyTop {
            kind: fields[0],
            moments: Vector3::new(hex(1), hex(2), hex(3)),
            arm: Vector3::new(hex(4), hex(5), hex(6)),
            q0: Quaternion::new(hex(10), hex(7), hex(8), hex(9)),
            omega: Vector3::new(hex(11), hex(12), hex(13)),
            t: hex(14),
            attitude: Quaternion::new(decimal(18), decimal(15), decimal(16), decimal(17)),
            omega_t: Vector3::new(decimal(19), decimal(20), decimal(21)),
        }
    };
    include_str!("oracles/heavy_top.csv")
        .lines()
        .skip(1)
        .map(read)
        .collect()
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
    assert_eq!(worst.len(), 10);
}

/// Against tests/oracles/free_damped.py: a Taylor integration in 50 digits that knows no change of
/// time, and for phases of up to 1e9 rad Legendre's form.
#[test]
fn damped_motions_agree_with_outside_digits() {
    let mut worst: BTreeMap<&str, (f64, f64)> = BTreeMap::new();
    for line in include_str!("oracles/free_damped.csv").lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let hex = |k: usize| hexadecimal(fields[k]);
        let decimal = |k: usize| fields[k].parse::<f64>().unwrap();
        let moments = Vector3::new(hex(1), hex(2), hex(3));
        let omega = Vector3::new(hex(4), hex(5), hex(6));
        let (rate, t) = (hex(7), hex(8));
        let attitude = Quaternion::new(decimal(12), decimal(9), decimal(10), decimal(11));
        let omega_t = Vector3::new(decimal(13), decimal(14), decimal(15));
        let motion = DampedFreeMotion::new(moments, Quaternion::identity(), omega, rate);
        let (q, w) = motion.at(t);
        let off = angle(q, attitude);
        let momentum = |w: Vector3<f64>| moments.component_mul(&w);
        let drift = momentum(w - omega_t).norm() / momentum(omega_t).norm();
        let entry = worst.entry(fields[0]).or_default();
        *entry = (entry.0.max(off), entry.1.max(drift));
        // As for the free body, and one rounding more for the decay.
        assert!(off < 4e-15, "{line}: {off:e} rad");
        assert!(drift < 9e-15, "{line}: L off by {drift:e}");
    }
    for (kind, (off, drift)) in &worst {
        println!("{kind:20}: {off:.1e} rad, {drift:.1e} of |L|");
    }
    assert_eq!(worst.len(), 8);
}

#[test]
fn damping_has_its_limits() {
    let (moments, q0) = (Vector3::new(1.0, 2.0, 3.0), Quaternion::identity());
    let omega = Vector3::new(0.4, 1.0, 0.3);
    let free = FreeMotion::new(moments, q0, omega);
    let damped = |rate| DampedFreeMotion::new(moments, q0, omega, rate);
    // Without damping, and with none to speak of, it is the free motion to the bit.
    for rate in [0.0, 1e-300, -5e-324] {
        assert_eq!(damped(rate).at(3.0), free.at(3.0));
    }
    // In the end it has gone as far as the free motion in 1/c, and stands.
    assert_eq!(
        damped(0.25).at(1e300),
        (free.attitude(4.0), Vector3::zeros())
    );
    let stiff = damped(1e308).at(1.0);
    assert!(angle(stiff.0, q0) < 1e-15 && stiff.1 == Vector3::zeros());
}

/// Against tests/oracles/heavy_top.py: a Taylor integration in 40 digits.
#[test]
fn lagrange_tops_agree_with_outside_digits() {
    let mut worst: BTreeMap<&str, (f64, f64)> = BTreeMap::new();
    for top in heavy_tops() {
        if top.kind == "kovalevskaya" {
            continue;
        }
        let (i, m) = (top.moments, top.arm.z);
        let motion = LagrangeTop::new(i.x, i.z, m, top.q0, top.omega);
        let (q, w) = motion.at(top.t);
        let off = angle(q, top.attitude);
        let drift = (w - top.omega_t).norm() / (top.omega_t.norm() + (m.abs() / i.x).sqrt());
        let entry = worst.entry(top.kind).or_default();
        *entry = (entry.0.max(off), entry.1.max(drift));
        // A few roundings of unit quaternions: all constants and phases are double-double.
        // Measured: at most 7.7e-16 rad. (Written so that a NaN fails.)
        assert!(off < 2e-15, "{}: {off:e} rad at t = {}", top.kind, top.t);
        assert!(drift < 2e-15, "{}: omega off by {drift:e}", top.kind);
    }
    for (kind, (off, drift)) in &worst {
        println!("{kind:16} {off:.1e} rad, {drift:.1e} of omega");
    }
    assert_eq!(worst.len(), 14);
}

/// Two closed forms, each by its own integrals, at times no integration reaches.
#[test]
fn a_top_without_weight_is_a_free_body_and_one_without_spin_a_pendulum() {
    for (k, t) in [1.0, 77.7, 1e4, 1e6, 1e9, -1e9].into_iter().enumerate() {
        let lean = 0.3 * k as f64;
        let (across, along) = (1.3, 0.4 + lean);
        let q0 = Quaternion::new(0.5, -0.5, 0.5, 0.5);
        let omega = Vector3::new(0.6, -0.9 + lean, 2.1);
        let top = LagrangeTop::new(across, along, 0.0, q0, omega);
        let free = FreeMotion::new(Vector3::new(across, across, along), q0, omega);
        let ((q, w), (q_free, w_free)) = (top.at(t), free.at(t));
        // 4e-15 rad is what the free body is bound by, and as much again for the top.
        assert!(angle(q, q_free) < 6e-15, "{t}: {:e}", angle(q, q_free));
        assert!((w - w_free).norm() < 1.2e-14, "{t}: {w} {w_free}");
        if t.abs() > 1e6 {
            continue;
        }

        // Turning about axis 1, level: from standing up by x, from hanging by π - x.
        let (moment, rate) = (0.8, [0.4, 3.0][k % 2]);
        let half = 1.1_f64 - lean;
        let q0 = Quaternion::new(half.cos(), half.sin(), 0.0, 0.0);
        let top = LagrangeTop::new(across, along, moment, q0, Vector3::x() * rate);
        // The angle of that quaternion as it is, not of the one it rounds.
        let standing = 2.0 * half.sin().atan2(half.cos());
        let pendulum = Pendulum::new(across, -moment, standing, rate);
        let ((q, w), exact) = (top.at(t), pendulum.attitude(Vector3::x_axis(), t));
        let (_, rate_t) = pendulum.at(t);
        // The angle is an f64: its rounding of 2e-16 changes the rate by as much, and that grows
        // with time.
        let room = 6e-15 + 4e-16 * t.abs();
        assert!(angle(q, exact) < room, "{t}: {:e}", angle(q, exact));
        assert!((w - Vector3::x() * rate_t).norm() < 2.0 * room, "{t}");
    }
}

/// a = b and energy of standing upright: I1 = M = 1, b = 1, β = 2, v = 1 - u3 obeys
/// `v̇² = v² (3 - 2v)`, `v = 3/2 sech²(√3/2 t + c)`. All the numbers are exact.
#[test]
fn a_top_on_its_separatrix_rises_and_stands() {
    let q0 = Quaternion::new(1.0, 1.0, 0.0, 0.0);
    let momentum = |q: Quaternion<f64>, w: Vector3<f64>| {
        let l = Quaternion::from_imag(Vector3::new(w.x, w.y, 0.5 * w.z));
        (q * l * q.conjugate()).imag()
    };
    for (w1, c) in [(-1.0, 1.0), (1.0, -1.0)] {
        let top = LagrangeTop::new(1.0, 0.5, 1.0, q0, Vector3::new(w1, 1.0, 2.0));
        // At t = 0 v = 1: cosh² c = 3/2; rising where u̇3 = -ω1 > 0.
        let c = c * (1.5_f64.sqrt() + 0.5_f64.sqrt()).ln();
        for t in [0.0, 0.7, -0.7, 3.0, -5.0, 20.0, 300.0, 1e3, -1e6] {
            let (q, w) = top.at(t);
            let v = 2.0 * (q.i * q.i + q.j * q.j);
            let exact = 1.5 / (0.75_f64.sqrt() * t + c).cosh().powi(2);
            assert!((v - exact).abs() < 4e-15, "{t}: {v} {exact}");
            // a and the energy, 2 E/I1 = β.
            let energy = w.x * w.x + w.y * w.y + 2.0 * (1.0 - v);
            assert!((momentum(q, w).z - 1.0).abs() < 4e-15, "{t}");
            assert!((energy - 2.0).abs() < 8e-15, "{t}: {energy}");
            // Its halves turn as they should: dq/dt = ½ q ω by a central difference, good to h².
            let h = 1e-4 * (1.0 + 1e-5 * t.abs());
            let rate = (top.attitude(t + h) - top.attitude(t - h)) / (2.0 * h);
            let expected = q * Quaternion::from_imag(w) * 0.5;
            assert!(
                (rate - expected).norm() < 1e-7 * (1.0 + 1e-4 * t.abs()),
                "{t}"
            );
        }
    }
    // Without spin it is the pendulum that just reaches the top.
    let hanging = Quaternion::new(0.0, 1.0, 0.0, 0.0);
    let top = LagrangeTop::new(1.0, 0.5, 1.0, hanging, Vector3::x() * 2.0);
    let pendulum = Pendulum::new(1.0, 1.0, 0.0, 2.0);
    for t in [0.3, -4.0, 15.0, 500.0, -1e5] {
        let exact = pendulum.attitude(Vector3::x_axis(), t) * hanging;
        let (q, w) = top.at(t);
        assert!(angle(q, exact) < 4e-15, "{t}: {q} {exact}");
        assert!(
            (w.x - pendulum.at(t).1).abs() < 4e-15 && w.y.abs() < 4e-15,
            "{t}: {w}"
        );
    }
}

#[test]
fn kovalevskayas_invariant_is_one() {
    let mut count = 0;
    for top in heavy_tops() {
        if top.kind != "kovalevskaya" {
            continue;
        }
        // u = Rᵀ e_z; q0 is as drawn, not normalised.
        let up = |q: Quaternion<f64>| {
            let q = q / q.norm();
            (q.conjugate() * Quaternion::new(0.0, 0.0, 0.0, 1.0) * q).imag()
        };
        let invariant = |q, w| kovalevskaya(top.moments.z, top.arm, up(q), w);
        let (before, after) = (
            invariant(top.q0, top.omega),
            invariant(top.attitude, top.omega_t),
        );
        // Roundings of the squares that it is the difference of, squared.
        let size = |w: Vector3<f64>| w.norm_squared() + top.arm.norm() / top.moments.z;
        let room = size(top.omega).max(size(top.omega_t)).powi(2);
        let off = (after - before).abs();
        assert!(off < 4e-15 * room, "{before} {after}");
        // It is no constant of every motion: half the spin, and it is another.
        let other = invariant(top.q0, top.omega * 0.5);
        assert!((other - before).abs() > 1e-3 * before);
        count += 1;
    }
    assert_eq!(count, 6);
}

/// Against tests/oracles/pendulum.py: a Taylor integration in 40 digits.
#[test]
fn pendulums_agree_with_outside_digits() {
    let mut worst: BTreeMap<&str, (f64, f64, f64)> = BTreeMap::new();
    for line in include_str!("oracles/pendulum.csv").lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let hex = |k: usize| hexadecimal(fields[k]);
        let [inertia, moment, angle0, rate0, t] = [1, 2, 3, 4, 5].map(hex);
        let [angle_t, rate_t] = [6, 7].map(|k| fields[k].parse::<f64>().unwrap());
        let motion = Pendulum::new(inertia, moment, angle0, rate0);
        let (theta, rate) = motion.at(t);
        let omega0 = (moment.abs() / inertia).sqrt();
        let off = (theta - angle_t).abs() / (1.0 + angle_t.abs());
        let drift = (rate - rate_t).abs() / (rate_t.abs() + omega0);
        let axis = Vector3::y_axis();
        let exact = Quaternion::from_parts((0.5 * angle_t).cos(), *axis * (0.5 * angle_t).sin());
        // The reference angle is itself rounded.
        let turned = angle(motion.attitude(axis, t), exact) / (1.0 + angle_t.abs());
        let entry = worst.entry(fields[0]).or_default();
        *entry = (entry.0.max(off), entry.1.max(drift), entry.2.max(turned));
        // One phase in double-double, a few roundings after it.
        assert!(off < 8e-16, "{line}: {theta}");
        assert!(drift < 8e-16, "{line}: {rate}");
        assert!(turned < 8e-16, "{line}: {turned:e}");
    }
    for (kind, (off, drift, turned)) in &worst {
        println!("{kind:16} {off:.1e} of the angle, {drift:.1e} of the rate, {turned:.1e} rad");
    }
    assert_eq!(worst.len(), 10);
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
    // Two motions in twenty digits from elsewhere; their decimals round on the way into an f64, by
    // 1e-16 of phases of 40 and 200 rad.
    let motion = FreeMotion::new(
        Vector3::new(0.6, 0.8, 1.0),
        identity,
        Vector3::new(3.0, 0.5, -0.9),
    );
    let reference = Quaternion::new(
        -0.736_061_364_160_794,
        -0.570_786_951_240_350_7,
        -0.299_388_571_830_790_1,
        -0.206_839_086_104_673_2,
    );
    assert!(angle(motion.attitude(10.0), reference) < 1e-14);
    let motion = FreeMotion::new(
        Vector3::new(2.0, 1.0, 2.0 / 3.0),
        identity,
        Vector3::new(1.1_f64.cos() / 2.0, 0.0, 1.1_f64.sin() * 1.5),
    );
    let reference = Quaternion::new(
        0.887_094_310_264_289_1,
        -0.261_678_695_032_792_3,
        0.225_839_107_427_755_07,
        0.305_916_071_527_624_96,
    );
    assert!(angle(motion.attitude(100.0), reference) < 4e-14);
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
