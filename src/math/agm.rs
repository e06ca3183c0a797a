//! The arithmetic-geometric mean: `a ← (a+b)/2`, `b ← √(ab)` until they meet (Gauss; DLMF 19.8.1).
//!
//! `K(k) = π / 2 agm(1, k')`. The number of right digits doubles every round.

use super::Real;

/// The mean of two numbers of one sign, to a few roundings; 0 where one of them is 0.
pub fn agm<T: Real>(mut a: T, mut b: T) -> T {
    if a.to_f64() == 0.0 || b.to_f64() == 0.0 {
        return T::real(0.0);
    }
    // From a ratio r the first rounds take log2 ln r steps: 10 from 1e±300, then 6 to double-double.
    for _ in 0..24 {
        let gap = (a - b).abs().to_f64();
        let mean = (a + b) * 0.5;
        b = (a * b).sqrt();
        a = mean;
        // The next gap is gap²/8a, and only its half would still be felt.
        if gap * gap <= T::EPSILON * a.to_f64() * a.to_f64() {
            break;
        }
    }
    a
}

#[cfg(test)]
mod tests {
    use super::agm;
    use crate::math::Dd;
    use crate::math::oracle::{relative, rows};

    #[test]
    fn digits_from_outside() {
        for ([x, y, ..], want) in rows("agm") {
            // Each round is right to a rounding, and the errors of the early ones are halved on.
            let off = relative(Dd::new(agm(x, y)), want);
            assert!(off < 4e-16, "{x:e} {y:e}: {off:e}");
            let off = relative(agm(Dd::new(x), Dd::new(y)), want);
            assert!(off < 1e-31, "{x:e} {y:e}: {off:e}");
        }
    }

    #[test]
    fn gausss_constant_and_zero() {
        // agm(1, √2) = 1.19814023473559220743992249228...: Gauss, 30 May 1799, to eleven places.
        assert!((agm(1.0, std::f64::consts::SQRT_2) - 1.198_140_234_735_592_2).abs() < 3e-16);
        assert_eq!(agm(1.0, 0.0), 0.0);
    }
}
