//! Kovalevskaya's invariant: the fourth integral of a heavy top with I1 = I2 = 2 I3 whose centre of
//! mass lies in the plane of axes 1 and 2.

use nalgebra::Vector3;

/// `|(ω1 + iω2)² - (r1 + ir2)(u1 + iu2)/I3|²`, constant along the motion, 1/s⁴.
///
/// Convention: `I ω̇ = I ω × ω + u × r`, `u̇ = u × ω`, all in principal axes; u is the upward
/// vertical, `r = m g c` (N m) the weight times the centre of mass c from the pivot, r3 = 0, and I3
/// (kg m²) the smallest moment. With `z = ω1 + iω2` and `ξ = u1 + iu2` these give
/// `2ż = -iω3 z + i (r/I3) u3` and `ξ̇ = -iω3 ξ + iu3 z`, hence
/// `d/dt (z² - rξ/I3) = -iω3 (z² - rξ/I3)` (Kovalevskaya, Acta Math. 12, 1889).
pub fn kovalevskaya(i3: f64, r_p: Vector3<f64>, u_p: Vector3<f64>, omega_p: Vector3<f64>) -> f64 {
    let square = (
        (omega_p.x - omega_p.y) * (omega_p.x + omega_p.y),
        2.0 * omega_p.x * omega_p.y,
    );
    let pull = (
        (r_p.x * u_p.x - r_p.y * u_p.y) / i3,
        (r_p.x * u_p.y + r_p.y * u_p.x) / i3,
    );
    let (re, im) = (square.0 - pull.0, square.1 - pull.1);
    re * re + im * im
}
