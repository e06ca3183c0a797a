//! Exact sums and products of f64 as expansions (Shewchuk, Discrete Comput. Geom. 18, 1997).
//!
//! An expansion is a list of f64 whose exact sum it stands for, nonoverlapping and in order of
//! growing magnitude. Exact unless something under- or overflows.

use super::dd::{Dd, two_prod, two_sum};

/// An exact number.
#[derive(Clone, Debug, PartialEq)]
pub struct Expansion(Vec<f64>);

impl Expansion {
    pub fn difference(a: f64, b: f64) -> Self {
        let (hi, lo) = two_sum(a, -b);
        Self(vec![lo, hi])
    }

    /// Shewchuk's SCALE-EXPANSION.
    pub fn times(&self, b: f64) -> Self {
        let mut parts = self.0.iter();
        let Some(&first) = parts.next() else {
            return Self(Vec::new());
        };
        let (mut q, low) = two_prod(first, b);
        let mut out = vec![low];
        for &part in parts {
            let (product, rest) = two_prod(part, b);
            let (sum, low) = two_sum(q, rest);
            out.push(low);
            let (sum, low) = two_sum(product, sum);
            out.push(low);
            q = sum;
        }
        out.push(q);
        Self(out).without_zeros()
    }

    /// `self - other`, by growing one part at a time.
    pub fn minus(&self, other: &Self) -> Self {
        let mut sum = self.clone();
        for &part in &other.0 {
            sum = sum.plus_part(-part);
        }
        sum
    }

    fn plus_part(&self, b: f64) -> Self {
        let mut q = b;
        let mut out = Vec::with_capacity(self.0.len() + 1);
        for &part in &self.0 {
            let (sum, low) = two_sum(q, part);
            out.push(low);
            q = sum;
        }
        out.push(q);
        Self(out).without_zeros()
    }

    fn without_zeros(mut self) -> Self {
        self.0.retain(|&part| part != 0.0);
        self
    }

    /// The nearest double-double: exact in sign, good to 2⁻¹⁰⁰.
    pub fn to_dd(&self) -> Dd {
        self.0
            .iter()
            .rev()
            .fold(Dd::ZERO, |sum, &part| sum + Dd::new(part))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_of_products_that_cancel_but_for_their_last_bit() {
        // (1 + 2⁻⁵²)³ - (1 + 3·2⁻⁵²) = 3·2⁻¹⁰⁴ + 2⁻¹⁵⁶: nothing of it is seen in f64.
        let x = 1.0 + f64::EPSILON;
        let one = Expansion::difference(x, 0.0);
        let cube = one.times(x).times(x);
        let line = Expansion::difference(1.0 + 2.0 * f64::EPSILON, -f64::EPSILON);
        let rest = cube.minus(&line).to_dd();
        assert_eq!(rest.hi, 3.0 * 2.0_f64.powi(-104) + 2.0_f64.powi(-156));
    }
}
