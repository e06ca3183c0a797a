//! Carlson's symmetric elliptic integrals,
//!
//! ```text
//! R_F(x, y, z)    = ½   ∫₀^∞ dt / √((t+x)(t+y)(t+z))
//! R_C(x, y)       = R_F(x, y, y)
//! R_J(x, y, z, p) = 3/2 ∫₀^∞ dt / ((t+p) √((t+x)(t+y)(t+z)))
//! R_D(x, y, z)    = R_J(x, y, z, z)
//! ```
//!
//! by duplication, `x ← (x+λ)/4` with `λ = √x√y + √x√z + √y√z`, which takes a factor of four off
//! the spread of the arguments each time, and a series of seventh order in the spread that is left
//! (Carlson, Numer. Algorithms 10, 1995; DLMF 19.36). One text for f64 and double-double.
//!
//! Arguments are not negative, but for y of R_C and p of R_J, where the value is Cauchy's principal
//! one. Where an integral diverges it is ∞.

use super::Real;

/// `R_F`, to a few roundings; ∞ for two zeros.
pub fn rf<T: Real>(mut x: T, mut y: T, mut z: T) -> T {
    if zeros([x, y, z]) > 1 {
        return T::real(f64::INFINITY);
    }
    let mut a = (x + y + z) / T::real(3.0);
    while spread(a, [x, y, z]) > T::SPREAD * a.to_f64() {
        let lambda = lambda(x.sqrt(), y.sqrt(), z.sqrt());
        (x, y, z) = (
            (x + lambda) * 0.25,
            (y + lambda) * 0.25,
            (z + lambda) * 0.25,
        );
        a = (a + lambda) * 0.25;
    }
    let (dx, dy) = ((a - x) / a, (a - y) / a);
    let dz = -(dx + dy);
    let e2 = dx * dy - dz * dz;
    let e3 = dx * dy * dz;
    let series = T::real(1.0) - over(e2, 10.0) + over(e3, 14.0) + over(e2 * e2, 24.0)
        - over(e2 * e3 * 3.0, 44.0)
        - over(e2 * e2 * e2 * 5.0, 208.0)
        + over(e3 * e3 * 3.0, 104.0)
        + e2 * e2 * e3 * 0.0625;
    series / a.sqrt()
}

/// `R_C`, to a few roundings; ∞ for y = 0; for y < 0 the principal value,
/// `√(x/(x-y)) R_C(x-y, -y)` (DLMF 19.2.20).
pub fn rc<T: Real>(mut x: T, mut y: T) -> T {
    let zero = T::real(0.0);
    if y == zero {
        return T::real(f64::INFINITY);
    }
    let mut factor = T::real(1.0);
    if y < zero {
        factor = (x / (x - y)).sqrt();
        (x, y) = (x - y, -y);
    }
    let mut a = (x + y * 2.0) / T::real(3.0);
    while spread(a, [x, y, y]) > NEARER * T::SPREAD * a.to_f64() {
        let lambda = x.sqrt() * y.sqrt() * 2.0 + y;
        (x, y) = ((x + lambda) * 0.25, (y + lambda) * 0.25);
        a = (a + lambda) * 0.25;
    }
    let s = (y - a) / a;
    // 1 + 3/10 s² + 1/7 s³ + 3/8 s⁴ + 9/22 s⁵ + 159/208 s⁶ + 9/8 s⁷
    let ratio = |p: f64, q: f64| over(T::real(p), q);
    let tail =
        ratio(3.0, 8.0) + s * (ratio(9.0, 22.0) + s * (ratio(159.0, 208.0) + s * ratio(9.0, 8.0)));
    let series = T::real(1.0) + s * s * (ratio(3.0, 10.0) + s * (ratio(1.0, 7.0) + s * tail));
    factor * series / a.sqrt()
}

/// `R_D`, to a few roundings; symmetric in x and y; ∞ for z = 0 or x = y = 0.
pub fn rd<T: Real>(mut x: T, mut y: T, mut z: T) -> T {
    if zeros([x, y]) == 2 || zeros([z]) == 1 {
        return T::real(f64::INFINITY);
    }
    let mut a = (x + y + z * 3.0) / T::real(5.0);
    let (mut sum, mut quarter) = (T::real(0.0), 1.0);
    while spread(a, [x, y, z]) > NEARER * T::SPREAD * a.to_f64() {
        let rz = z.sqrt();
        let lambda = lambda(x.sqrt(), y.sqrt(), rz);
        sum = sum + T::real(quarter) / (rz * (z + lambda));
        quarter *= 0.25;
        (x, y, z) = (
            (x + lambda) * 0.25,
            (y + lambda) * 0.25,
            (z + lambda) * 0.25,
        );
        a = (a + lambda) * 0.25;
    }
    third_tail(a, [x, y, z, z]) * quarter + sum * 3.0
}

/// `R_J`, to a few roundings; symmetric in x, y, z; ∞ for p = 0 or two zeros among the others.
///
/// For p < 0 the principal value (DLMF 19.20.14), which has a zero: there only the error against
/// the terms is small.
pub fn rj<T: Real>(x: T, y: T, z: T, p: T) -> T {
    let zero = T::real(0.0);
    if zeros([x, y, z]) > 1 || p == zero {
        return T::real(f64::INFINITY);
    }
    if p > zero {
        return rj_positive(x, y, z, p);
    }
    let (x, y, z) = ascending(x, y, z);
    let q = -p;
    let p = (z * (x + y + q) - x * y) / (z + q);
    let (xy, pq) = (x * y, p * q);
    let circular = (xy * z / (xy + pq)).sqrt() * rc(xy + pq, pq);
    ((p - z) * rj_positive(x, y, z, p) - (rf(x, y, z) - circular) * 3.0) / (z + q)
}

fn rj_positive<T: Real>(mut x: T, mut y: T, mut z: T, mut p: T) -> T {
    let mut a = (x + y + z + p * 2.0) / T::real(5.0);
    let (mut sum, mut quarter) = (T::real(0.0), 1.0);
    while spread(a, [x, y, z, p]) > NEARER * T::SPREAD * a.to_f64() {
        let (rx, ry, rz, rp) = (x.sqrt(), y.sqrt(), z.sqrt(), p.sqrt());
        let lambda = lambda(rx, ry, rz);
        let d = (rp + rx) * (rp + ry) * (rp + rz);
        // Carlson's 1 + e, e = (√p-√x)(√p-√y)(√p-√z)/d: as one quotient of positive terms it
        // stays good where e nears -1, for small p.
        let one_and_e = rp * (p + lambda) * 2.0 / d;
        sum = sum + rc(T::real(1.0), one_and_e) / d * quarter;
        quarter *= 0.25;
        (x, y, z) = (
            (x + lambda) * 0.25,
            (y + lambda) * 0.25,
            (z + lambda) * 0.25,
        );
        p = (p + lambda) * 0.25;
        a = (a + lambda) * 0.25;
    }
    third_tail(a, [x, y, z, p]) * quarter + sum * 6.0
}

/// The series of R_J and R_D have larger coefficients than that of R_F.
const NEARER: f64 = 0.6;

/// `a^{-3/2}` times the series of R_J (DLMF 19.36.2), p counted twice.
fn third_tail<T: Real>(a: T, [x, y, z, _]: [T; 4]) -> T {
    let (x, y, z) = ((a - x) / a, (a - y) / a, (a - z) / a);
    let p = (x + y + z) * -0.5;
    let (xyz, p2) = (x * y * z, p * p);
    let e2 = x * y + x * z + y * z - p2 * 3.0;
    let e3 = xyz + e2 * p * 2.0 + p2 * p * 4.0;
    let e4 = (xyz * 2.0 + e2 * p + p2 * p * 3.0) * p;
    let e5 = xyz * p2;
    let series = T::real(1.0) - over(e2 * 3.0, 14.0) + over(e3, 6.0) + over(e2 * e2 * 9.0, 88.0)
        - over(e4 * 3.0, 22.0)
        - over(e2 * e3 * 9.0, 52.0)
        + over(e5 * 3.0, 26.0)
        - e2 * e2 * e2 * 0.0625
        + over(e3 * e3 * 3.0, 40.0)
        + over(e2 * e4 * 3.0, 20.0)
        + over(e2 * e2 * e3 * 45.0, 272.0)
        - over((e3 * e4 + e2 * e5) * 9.0, 68.0);
    series / (a * a.sqrt())
}

fn lambda<T: Real>(rx: T, ry: T, rz: T) -> T {
    rx * (ry + rz) + ry * rz
}

fn over<T: Real>(x: T, by: f64) -> T {
    x / T::real(by)
}

fn zeros<T: Real, const N: usize>(of: [T; N]) -> usize {
    of.iter().filter(|&&v| v == T::real(0.0)).count()
}

fn spread<T: Real, const N: usize>(a: T, of: [T; N]) -> f64 {
    of.iter()
        .map(|&v| (a - v).to_f64().abs())
        .fold(0.0, f64::max)
}

fn ascending<T: Real>(x: T, y: T, z: T) -> (T, T, T) {
    let (x, y) = if y < x { (y, x) } else { (x, y) };
    let (y, z) = if z < y { (z, y) } else { (y, z) };
    if y < x { (y, x, z) } else { (x, y, z) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Dd;
    use crate::math::oracle::{relative, rows};

    /// Against mpmath, in both precisions. A dozen duplications, each right to a rounding or two,
    /// and what they hand on is quartered.
    #[test]
    fn digits_from_outside() {
        type Integral<T> = fn([T; 4]) -> T;
        let table: [(&str, Integral<f64>, Integral<Dd>); 4] = [
            ("rf", |[x, y, z, _]| rf(x, y, z), |[x, y, z, _]| rf(x, y, z)),
            ("rc", |[x, y, ..]| rc(x, y), |[x, y, ..]| rc(x, y)),
            ("rd", |[x, y, z, _]| rd(x, y, z), |[x, y, z, _]| rd(x, y, z)),
            (
                "rj",
                |[x, y, z, p]| rj(x, y, z, p),
                |[x, y, z, p]| rj(x, y, z, p),
            ),
        ];
        for (name, plain, double) in table {
            let (mut worst, mut worst_dd) = (0.0_f64, 0.0_f64);
            for (arguments, want) in rows(name) {
                let off = relative(Dd::new(plain(arguments)), want);
                let off_dd = relative(double(arguments.map(Dd::new)), want);
                assert!(off < 1.2e-15, "{name} {arguments:?}: {off:e}");
                assert!(off_dd < 2e-31, "{name} {arguments:?}: {off_dd:e}");
                (worst, worst_dd) = (worst.max(off), worst_dd.max(off_dd));
            }
            println!("{name}: {worst:.1e}, {worst_dd:.1e}");
        }
    }

    #[test]
    fn principal_values() {
        for ([x, y, z, p], want) in rows("rj_principal") {
            // The value is a difference; its terms are at most this large.
            let size = 3.0 * rf(x, y, z) / (x.max(y).max(z) - p) + want.hi.abs();
            let off = (Dd::new(rj(x, y, z, p)) - want).to_f64().abs() / size;
            assert!(off < 4e-15, "{x} {y} {z} {p}: {off:e}");
        }
    }

    #[test]
    fn carlsons_own_digits() {
        // Carlson, Numer. Algorithms 10 (1995), given to 14 digits.
        let ln2 = std::f64::consts::LN_2;
        for (got, digits) in [
            (rf(1.0, 2.0, 0.0), 1.311_028_777_146_1),
            (rf(0.5, 1.0, 0.0), 1.854_074_677_301_4),
            (rf(2.0, 3.0, 4.0), 0.584_082_841_677_15),
            (rj(0.0, 1.0, 2.0, 3.0), 0.776_886_237_785_82),
            (rj(2.0, 3.0, 4.0, 5.0), 0.142_975_796_671_57),
            (rd(0.0, 2.0, 1.0), 1.797_210_352_103_4),
            (rd(2.0, 3.0, 4.0), 0.165_105_272_942_61),
            (rc(0.0, 0.25), std::f64::consts::PI),
            (rc(2.25, 2.0), ln2),
            (rc(0.25, -2.0), ln2 / 3.0),
        ] {
            assert!((got / digits - 1.0).abs() < 5e-14, "{got} {digits}");
        }
    }

    #[test]
    fn elementary_cases_and_scaling() {
        // R_F(x, x, x) = x^{-1/2}; R_F(λx, λy, λz) = λ^{-1/2} R_F(x, y, z); symmetric.
        assert!((rf(4.0, 4.0, 4.0) - 0.5).abs() < 1e-16);
        let value = rf(0.3, 5.0, 1e-3);
        for scale in [1e-40, 1e-3, 1e40] {
            let scaled = rf(1e-3 * scale, 0.3 * scale, 5.0 * scale) * f64::sqrt(scale);
            // Rounding of each of a dozen duplications.
            assert!((scaled / value - 1.0).abs() < 2e-15, "{scale}");
        }
    }

    #[test]
    fn what_diverges_is_infinite() {
        assert_eq!(rf(0.0, 0.0, 1.0), f64::INFINITY);
        assert_eq!(rc(1.0, 0.0), f64::INFINITY);
        assert_eq!(rd(1.0, 2.0, 0.0), f64::INFINITY);
        assert_eq!(rj(1.0, 2.0, 3.0, 0.0), f64::INFINITY);
        assert_eq!(rj(0.0, 0.0, 3.0, 1.0), f64::INFINITY);
    }
}
