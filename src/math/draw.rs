//! Numbers as good as random, the same on every machine: SplitMix64 by its counter.
//!
//! ```text
//! z = seed + (n + 1) γ        γ = 2⁶⁴/φ, odd
//! z ← (z ⊕ z >> 30) a,  z ← (z ⊕ z >> 27) b,  z ⊕ z >> 31
//! ```
//!
//! (Steele, Lea & Flood, Fast splittable pseudorandom number generators, OOPSLA 2014; the multipliers
//! are Stafford's.) The n-th number needs no other before it: body k of a swarm is the same however
//! many there are.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use std::f64::consts::TAU;

/// The `n`-th number of a seed: 64 even bits.
pub fn bits(seed: u64, n: u64) -> u64 {
    let z = seed.wrapping_add(n.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The `n`-th number of a seed as one in [0, 1): its 53 upper bits.
pub fn unit(seed: u64, n: u64) -> f64 {
    (bits(seed, n) >> 11) as f64 / 9_007_199_254_740_992.0
}

/// A point of the cube from -1 to 1, of three numbers in [0, 1).
pub fn in_cube(u: [f64; 3]) -> Vector3<f64> {
    Vector3::from(u).map(|u| 2.0 * u - 1.0)
}

/// A point of the unit ball, evenly by volume: a height (Archimedes), an angle, and `∛u` of the radius.
pub fn in_ball([a, b, c]: [f64; 3]) -> Vector3<f64> {
    let y = 2.0 * a - 1.0;
    let (sin, cos) = libm::sincos(TAU * b);
    let across = (1.0 - y * y).sqrt();
    Vector3::new(across * cos, y, across * sin) * libm::cbrt(c)
}

/// An attitude, evenly over all of them (Shoemake, Uniform random rotations, Graphics Gems III, 1992).
pub fn attitude([a, b, c]: [f64; 3]) -> UnitQuaternion<f64> {
    let ((s1, c1), (s2, c2)) = (libm::sincos(TAU * b), libm::sincos(TAU * c));
    let (r1, r2) = ((1.0 - a).sqrt(), a.sqrt());
    UnitQuaternion::new_normalize(Quaternion::new(r2 * c2, r1 * s1, r1 * c1, r2 * s2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_are_those_of_the_published_generator() {
        // The first of seed 0, and of the seed with which other implementations are compared.
        assert_eq!(bits(0, 0), 0xe220_a839_7b1d_cdaf);
        assert_eq!(bits(0, 1), 0x6e78_9e6a_a1b9_65f4);
        assert_eq!(bits(0, 2), 0x06c4_5d18_8009_454f);
        assert_eq!(bits(1_234_567, 0), 6_457_827_717_110_365_317);
        assert_eq!(bits(1_234_567, 1), 3_203_168_211_198_807_973);
    }

    /// Means over 3 · 10,000 numbers of what is even by symmetry: six deviations of the mean.
    #[test]
    fn attitudes_and_points_of_the_ball_are_even() {
        const MANY: u64 = 10_000;
        let six = 6.0 / (MANY as f64).sqrt();
        let three = |k: u64, from: u64| std::array::from_fn(|j| unit(7, 16 * k + from + j as u64));
        let mean = |f: &dyn Fn(u64) -> f64| (0..MANY).map(f).sum::<f64>() / MANY as f64;
        for axis in 0..3 {
            let turned = |k: u64| (attitude(three(k, 0)) * Vector3::y())[axis];
            assert!(mean(&turned).abs() < six);
            // <n_i²> = 1/3 over a sphere, with a deviation below 1.
            assert!((mean(&|k| turned(k) * turned(k)) - 1.0 / 3.0).abs() < six);
            let ball = |k: u64| in_ball(three(k, 3))[axis];
            assert!(mean(&ball).abs() < six);
            // <x²> = 1/5 over a ball.
            assert!((mean(&|k| ball(k) * ball(k)) - 0.2).abs() < six);
        }
        // The angle of an even rotation has the density (1 - cos θ)/π: its mean is π/2 + 2/π.
        let angle = mean(&|k| attitude(three(k, 0)).angle());
        let expected = std::f64::consts::FRAC_PI_2 + std::f64::consts::FRAC_2_PI;
        assert!((angle - expected).abs() < six, "{angle}");
    }
}
