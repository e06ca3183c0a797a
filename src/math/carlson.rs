//! Carlson's symmetric elliptic integral of the first kind,
//! `R_F(x, y, z) = ½ ∫₀^∞ dt / √((t+x)(t+y)(t+z))`,
//! by duplication with the seventh-order tail (Carlson, Numer. Algorithms 10, 1995; DLMF 19.36.1).

/// `R_F` of non-negative arguments of which at most one is 0, to a few roundings; ∞ for two zeros.
pub fn rf(x: f64, y: f64, z: f64) -> f64 {
    let zeros = [x, y, z].iter().filter(|&&v| v == 0.0).count();
    if zeros > 1 {
        return f64::INFINITY;
    }
    let (mut x, mut y, mut z) = (x, y, z);
    let mut a = (x + y + z) / 3.0;
    // The tail's first term left out is about 0.1 q⁸: below rounding for q ≤ 0.008.
    const SPREAD: f64 = 8e-3;
    let mut spread = (a - x).abs().max((a - y).abs()).max((a - z).abs());
    while spread > SPREAD * a.abs() {
        let (rx, ry, rz) = (x.sqrt(), y.sqrt(), z.sqrt());
        let lambda = rx * (ry + rz) + ry * rz;
        x = 0.25 * (x + lambda);
        y = 0.25 * (y + lambda);
        z = 0.25 * (z + lambda);
        a = 0.25 * (a + lambda);
        spread = (a - x).abs().max((a - y).abs()).max((a - z).abs());
    }
    let (dx, dy) = ((a - x) / a, (a - y) / a);
    let dz = -(dx + dy);
    let e2 = dx * dy - dz * dz;
    let e3 = dx * dy * dz;
    let series = 1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0
        - 3.0 / 44.0 * e2 * e3
        - 5.0 / 208.0 * e2 * e2 * e2
        + 3.0 / 104.0 * e3 * e3
        + e2 * e2 * e3 / 16.0;
    series / a.sqrt()
}

#[cfg(test)]
mod tests {
    use super::rf;

    #[test]
    fn carlsons_own_digits() {
        // Carlson, Numer. Algorithms 10 (1995), given to 14 digits.
        for ([x, y, z], digits) in [
            ([1.0, 2.0, 0.0], 1.311_028_777_146_1),
            ([0.5, 1.0, 0.0], 1.854_074_677_301_4),
            ([2.0, 3.0, 4.0], 0.584_082_841_677_15),
        ] {
            assert!((rf(x, y, z) - digits).abs() < 5e-14, "{x} {y} {z}");
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
    fn two_zeros_diverge() {
        assert_eq!(rf(0.0, 0.0, 1.0), f64::INFINITY);
    }
}
