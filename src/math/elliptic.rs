//! Jacobi's elliptic functions, and Legendre's integrals in terms of them.
//!
//! Everywhere the complementary parameter `k'² = 1 - k²` is given rather than k: it is what decides
//! near the separatrix, where k rounds to 1.

use super::carlson::{rf, rj};
use super::{Real, agm};

/// Quarter period `K = π / 2 agm(1, k')`; ∞ for k' = 0.
pub fn quarter_period<T: Real>(kc2: T) -> T {
    T::PI * 0.5 / agm(T::real(1.0), kc2.sqrt())
}

/// `(sn, cn, dn)` of u for `0 ≤ k'² ≤ 1`.
///
/// Gauss's transformation down the AGM `(a, b)` from (1, k'): with `C = a cs(a u, b/a)` and
/// `D = dn(a u, b/a)`, each level from the next one is
/// `C ← C D`, `D ← √((C² + b²)/(C² + a²))`, and at the bottom `C = a cot(a u)`, `D = 1`
/// (DLMF 22.7.2; Bulirsch, Numer. Math. 7, 1965). No term is a difference.
pub fn jacobi<T: Real>(u: T, kc2: T) -> (T, T, T) {
    let (zero, one) = (T::real(0.0), T::real(1.0));
    if kc2 <= zero {
        return hyperbolic(u);
    }
    let mut levels = [(one, one); 24];
    let (mut a, mut b) = (one, kc2.sqrt());
    let mut depth = 0;
    for level in &mut levels {
        *level = (a, b);
        depth += 1;
        let gap = (a - b).abs().to_f64();
        (a, b) = ((a + b) * 0.5, (a * b).sqrt());
        // k of the next level but one is gap²/16a²; its square is what the functions feel.
        if gap * gap <= T::EPSILON * a.to_f64() * a.to_f64() {
            break;
        }
    }
    let (sin, cos) = (a * u).sin_cos();
    // cs overflows, and sn is its argument.
    if sin.to_f64().abs() < 1e-100 {
        let side = if cos < zero { -one } else { one };
        return (sin / a, side, one);
    }
    let (mut c, mut d) = (a * cos / sin, one);
    for &(a, b) in levels[..depth].iter().rev() {
        c = c * d;
        let c2 = c * c;
        d = ((c2 + b * b) / (c2 + a * a)).sqrt();
    }
    let mut sn = one / (c * c + one).sqrt();
    if sin < zero {
        sn = -sn;
    }
    (sn, c * sn, d)
}

/// k = 1: `(tanh u, sech u, sech u)`.
fn hyperbolic<T: Real>(u: T) -> (T, T, T) {
    let two = T::real(2.0);
    let size = u.abs();
    let fall = (size * -2.0).exp_m1();
    let tanh = -fall / (two + fall);
    let sech = two * (-size).exp() / (two + fall);
    let tanh = if u < T::real(0.0) { -tanh } else { tanh };
    (tanh, sech, sech)
}

/// Legendre's first kind, `F = ∫₀^φ dθ/√(1 - k² sin²θ)`, by `sin φ`, `cos φ`, `Δ = √(1 - k² sin²φ)`,
/// for φ in [-π/2, π/2] (DLMF 19.25.5).
pub fn first_kind<T: Real>(sin: T, cos: T, delta: T) -> T {
    sin * rf(cos * cos, delta * delta, T::real(1.0))
}

/// What the third kind is more than the first:
/// `Π(n; φ, k) - F(φ, k) = n/3 sin³φ R_J(cos²φ, Δ², 1, p)` with `p = 1 - n sin²φ` (DLMF 19.25.14).
pub fn third_kind_excess<T: Real>(n: T, sin: T, cos: T, delta: T, p: T) -> T {
    let integral = rj(cos * cos, delta * delta, T::real(1.0), p);
    n * sin * sin * sin * integral / T::real(3.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Dd;
    use crate::math::oracle::{relative, rows};

    /// `k'`, and sn, cn, dn by mpmath; the error against the phase's own rounding.
    #[test]
    fn jacobis_functions_by_outside_digits() {
        type One<T> = fn((T, T, T)) -> T;
        let pick: [(&str, One<f64>, One<Dd>); 3] = [
            ("sn", |f| f.0, |f| f.0),
            ("cn", |f| f.1, |f| f.1),
            ("dn", |f| f.2, |f| f.2),
        ];
        for (name, plain, double) in pick {
            let (mut worst, mut worst_dd) = (0.0_f64, 0.0_f64);
            for ([u, kc2, ..], want) in rows(name) {
                // The argument of the sine is u π/2K: it rounds by half an ulp of itself.
                let room = 1.0 + u.abs();
                let off = (Dd::new(plain(jacobi(u, kc2))) - want).to_f64().abs() / room;
                let off_dd = (double(jacobi(Dd::new(u), Dd::new(kc2))) - want)
                    .to_f64()
                    .abs()
                    / room;
                assert!(off < 5e-16, "{name}({u}, {kc2:e}): {off:e}");
                assert!(off_dd < 1e-31, "{name}({u}, {kc2:e}): {off_dd:e}");
                (worst, worst_dd) = (worst.max(off), worst_dd.max(off_dd));
            }
            println!("{name}: {worst:.1e}, {worst_dd:.1e}");
        }
    }

    #[test]
    fn quarter_periods_by_outside_digits() {
        for ([kc2, ..], want) in rows("k") {
            assert!(
                relative(Dd::new(quarter_period(kc2)), want) < 6e-16,
                "{kc2:e}"
            );
            assert!(
                relative(quarter_period(Dd::new(kc2)), want) < 2e-30,
                "{kc2:e}"
            );
        }
    }

    #[test]
    fn legendres_third_kind_by_outside_digits() {
        for ([n, phi, k2, _], want) in rows("pi") {
            let (sin, cos) = Dd::new(phi).sin_cos();
            let (n, k2) = (Dd::new(n), Dd::new(k2));
            let one = Dd::ONE;
            let delta = (one - k2 * sin * sin).sqrt();
            let p = one - n * sin * sin;
            let got = first_kind(sin, cos, delta) + third_kind_excess(n, sin, cos, delta, p);
            // For large negative n the two parts cancel to the inverse root of n.
            let room = 1.0 + n.hi.abs().sqrt();
            assert!(relative(got, want) < 4e-30 * room, "{n:?} {phi} {k2:?}");
        }
    }

    #[test]
    fn known_values() {
        // sn, cn, dn of (25, k = ½) and sn of (1.25, k = 1 - 2⁻⁹): the tests of Boost.Math.
        let (sn, cn, dn) = jacobi(25.0, 0.75);
        // The phase is 25 π/2K = 23.3: half an ulp of it is 2e-15.
        for (got, digits) in [
            (sn, -0.969_223_071_486_651_6),
            (cn, -0.246_184_154_035_106_45),
            (dn, 0.874_729_477_852_721_8),
        ] {
            assert!((got - digits).abs() < 4e-15, "{got} {digits}");
        }
        let below = 2.0_f64.powi(-9);
        let sn = jacobi(1.25, below * (2.0 - below)).0;
        assert!((sn - 0.848_768_940_045_053_3).abs() < 3e-16, "{sn}");
    }
}
