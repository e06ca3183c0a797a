//! How long an arrow is drawn: metres per unit, one stated factor per quantity.
//!
//! The factor is a round number, the largest at which the largest value to be expected is drawn no
//! longer than its reach in radii of a typical body. What to expect comes from the events on the
//! bodies as they start, so that the factor stands before the first step.

use super::mesh;
use super::picture::{DRAWN, Drawn};
use crate::sim::Sizes;
use crate::trace::{Subject, short};

/// Longest arrow of an impulse, in radii of a typical body.
const IMPULSE_REACH: f64 = 1.6;

/// Metres per unit of each quantity that is drawn.
#[derive(Clone, Debug)]
pub struct Scales {
    /// In the order of [`DRAWN`].
    factors: Vec<f64>,
    /// Of an impulse, m per N·s.
    pub impulse: f64,
    /// A typical body's radius, m: what the scales and the camera go by.
    pub size: f64,
}

impl Scales {
    pub fn new(subjects: &[Subject], expected: &Sizes) -> Self {
        // Bodies of a swarm are alike: one of them is measured.
        let size = typical(subjects.chunk_by(Subject::is_like).flat_map(|alike| {
            let radius = mesh::radius(&alike[0]);
            std::iter::repeat_n(radius, alike.len())
        }));
        let factor = |drawn: &Drawn| nice(drawn.reach * size / (drawn.size)(expected));
        Self {
            factors: DRAWN.iter().map(factor).collect(),
            impulse: nice(IMPULSE_REACH * size / expected.impulse),
            size,
        }
    }

    /// Those at which what either is for is drawn no longer than it should be.
    pub fn smaller(self, other: Self) -> Self {
        let pairs = self.factors.iter().zip(&other.factors);
        Self {
            factors: pairs.map(|(a, b)| a.min(*b)).collect(),
            impulse: self.impulse.min(other.impulse),
            size: self.size.max(other.size),
        }
    }

    /// Metres per unit.
    pub fn of(&self, drawn: &Drawn) -> f64 {
        self.of_stream(drawn.stream)
    }

    /// Of the stream's arrows, metres per unit.
    pub fn of_stream(&self, stream: &str) -> f64 {
        let index = DRAWN.iter().position(|drawn| drawn.stream == stream);
        index.map_or(1.0, |index| self.factors[index])
    }

    /// `1 N = 0.15 m`.
    pub fn sentence(&self, drawn: &Drawn) -> String {
        format!("1 {} = {} m", drawn.unit, short(self.of(drawn)))
    }
}

/// The median, 1 where there is nothing.
fn typical(sizes: impl Iterator<Item = f64>) -> f64 {
    let mut sizes: Vec<f64> = sizes
        .filter(|size| size.is_finite() && *size > 0.0)
        .collect();
    sizes.sort_by(f64::total_cmp);
    sizes.get(sizes.len() / 2).copied().unwrap_or(1.0)
}

const DIGITS: [f64; 8] = [8.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.5, 1.0];

/// The largest round number (one of [`DIGITS`] times a power of ten) not above `x`; 1 for what is
/// not usable.
pub fn nice(x: f64) -> f64 {
    if !(x.is_finite() && x > 0.0) {
        return 1.0;
    }
    let power = x.log10().floor();
    let base = 10_f64.powf(power);
    let digit = DIGITS.into_iter().find(|d| d * base <= x * (1.0 + 1e-12));
    // Through text, so that the factor is the decimal number it says it is.
    format!("{}e{power}", digit.unwrap_or(1.0))
        .parse()
        .unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::nice;

    #[test]
    fn factors_are_round_numbers_not_above_what_fits() {
        for (x, want) in [
            (0.26, 0.2),
            (0.5, 0.5),
            (0.049, 0.04),
            (7.0, 6.0),
            (1e-9, 1e-9),
        ] {
            assert_eq!(nice(x), want);
        }
        assert_eq!(nice(f64::INFINITY), 1.0);
    }
}
