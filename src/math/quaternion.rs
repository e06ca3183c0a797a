//! Quaternions as attitudes: `q_wb` takes body coordinates to world coordinates.

use nalgebra::{Quaternion, Unit, UnitQuaternion, Vector3};

/// The rate of an attitude under a world angular velocity (rad/s): `q̇ = ½ (ω_w, 0) q`.
#[inline(always)]
pub fn spin_rate(omega_w: Vector3<f64>, q: Quaternion<f64>) -> Quaternion<f64> {
    // Written out, because the compiler must not leave out products with the 0.
    let (e, u, w) = (omega_w * 0.5, q.imag(), q.w);
    Quaternion::new(
        -(e.x * u.x) - e.y * u.y - e.z * u.z,
        e.x * w + e.y * u.z - e.z * u.y,
        e.y * w - e.x * u.z + e.z * u.x,
        e.x * u.y - e.y * u.x + e.z * w,
    )
}

/// `R(q) v = v + 2 u × (u × v + w v)`, q = (u, w) unit.
#[inline(always)]
pub fn turned(q: Quaternion<f64>, v: Vector3<f64>) -> Vector3<f64> {
    let u = q.imag();
    let t = u.cross(&v) * 2.0;
    v + t * q.w + u.cross(&t)
}

/// The rotation by `radians` about `axis`: `(n sin θ/2, cos θ/2)`.
///
/// Sine and cosine come from `libm`, so that a scene has the same bits on every processor.
pub fn axis_angle(axis: Unit<Vector3<f64>>, radians: f64) -> UnitQuaternion<f64> {
    let (sin, cos) = libm::sincos(0.5 * radians);
    UnitQuaternion::new_unchecked(Quaternion::from_parts(cos, axis.into_inner() * sin))
}

/// The rotation by a rotation vector (rad): `exp(v/2) = (v/|v| sin |v|/2, cos |v|/2)`.
pub fn exponential(v: Vector3<f64>) -> Quaternion<f64> {
    let half = 0.5 * v.norm();
    let (sin, cos) = libm::sincos(half);
    // sin(x)/2x of x = |v|/2; where |v| is too small to divide by, it is ½ to rounding.
    let factor = if half > 1e-100 { 0.5 * sin / half } else { 0.5 };
    Quaternion::from_parts(cos, v * factor)
}

/// Whether [`exponential_by_series`] serves: |v| ≤ 1 rad.
#[inline(always)]
pub fn is_short(v: Vector3<f64>) -> bool {
    v.norm_squared() <= 1.0
}

/// [`exponential`] of a vector that [`is_short`], by the series, without a branch: for lanes. The last
/// bits may differ.
///
/// ```text
/// z = |v/2|²    cos √z = Σ (-z)^k / (2k)!    sin √z / √z = Σ (-z)^k / (2k + 1)!
/// ```
///
/// At z = ¼ the first terms left out are 7e-19 and 4e-20 (k = 8).
#[inline(always)]
pub fn exponential_by_series(v: Vector3<f64>) -> Quaternion<f64> {
    let z = 0.25 * v.norm_squared();
    let [c0, c1, c2, c3, c4, c5, c6, c7] = COSINE;
    let [s0, s1, s2, s3, s4, s5, s6, s7] = SINE;
    let cos = c0 + z * (c1 + z * (c2 + z * (c3 + z * (c4 + z * (c5 + z * (c6 + z * c7))))));
    let sin = s0 + z * (s1 + z * (s2 + z * (s3 + z * (s4 + z * (s5 + z * (s6 + z * s7))))));
    Quaternion::from_parts(cos, v * (0.5 * sin))
}

/// `(-1)^k / (2k)!`.
const COSINE: [f64; 8] = [
    1.0,
    -1.0 / 2.0,
    1.0 / 24.0,
    -1.0 / 720.0,
    1.0 / 40_320.0,
    -1.0 / 3_628_800.0,
    1.0 / 479_001_600.0,
    -1.0 / 87_178_291_200.0,
];

/// `(-1)^k / (2k + 1)!`.
const SINE: [f64; 8] = [
    1.0,
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5_040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
];

/// The angle of the rotation from one attitude to another, rad: `2 atan2(|u|, |w|)` of `a⁻¹ b`,
/// good for angles as small as rounding.
pub fn angle_between(a: UnitQuaternion<f64>, b: UnitQuaternion<f64>) -> f64 {
    let d = a.conjugate().into_inner() * b.into_inner();
    2.0 * libm::atan2(d.imag().norm(), d.w.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_is_the_turn_about_its_axis() {
        let axis = Unit::new_normalize(Vector3::new(0.3, -0.5, 0.8));
        for angle in [0.0, 1e-200, 1e-9, 0.4, 3.1, 100.0] {
            let gap = exponential(axis.into_inner() * angle) - *axis_angle(axis, angle);
            // |axis · angle| is the angle but for a rounding of it.
            assert!(gap.norm() < 3e-16 * (1.0 + angle), "{angle}");
        }
    }

    #[test]
    fn the_series_give_what_libm_gives() {
        let axis = Vector3::new(0.48, -0.6, 0.64);
        for k in 0..=1_000 {
            let v = axis * (1e-3 * f64::from(k));
            let gap = exponential_by_series(v) - exponential(v);
            // Half a rounding of the last sum in each component, and libm's.
            assert!(gap.norm() < 2.5e-16, "{k}: {:e}", gap.norm());
        }
    }

    #[test]
    fn the_rate_turns_a_vector_as_omega_cross() {
        // d/dt (q v q*) = ω × v, by a central difference of the rotated vector.
        let q = axis_angle(Unit::new_normalize(Vector3::new(1.0, -2.0, 0.5)), 0.9);
        let omega_w = Vector3::new(0.3, 1.1, -0.7);
        let v_b = Vector3::new(0.2, -0.4, 1.3);
        let h = 1e-5;
        let v_w = |t: f64| {
            let q = UnitQuaternion::new_normalize(q.into_inner() + spin_rate(omega_w, *q) * t);
            q * v_b
        };
        let difference = (v_w(h) - v_w(-h)) / (2.0 * h);
        // The difference is good to h² |ω|³ ≈ 3e-10 and to rounding, 1e-16 / h = 1e-11.
        assert!((difference - omega_w.cross(&(q * v_b))).norm() < 1e-9);
        // The vector turned, by another route: some roundings of numbers up to 1.4.
        assert!((turned(*q, v_b) - q * v_b).norm() < 2e-15);
    }
}
