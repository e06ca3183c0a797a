//! Which side of the separatrix a motion is on, decided exactly, and its axes in order.

use super::power_of_two;
use crate::math::{Dd, Expansion};
use nalgebra::Vector3;

/// The axes in the order that makes 1 and 3 the ones of the branch, signs with ω1, ω3 ≥ 0.
pub struct Branch {
    /// The old axes that 1, 2, 3 lie along, and their directions, +1 or -1.
    pub order: [usize; 3],
    pub signs: [f64; 3],
    /// Moments and angular momenta along axes 1, 2, 3; those of 1 and 3 in units of `scale`.
    pub i: [f64; 3],
    pub m: [Dd; 3],
    /// Their squares.
    pub squares: [Dd; 3],
    pub scale: f64,
    /// +1 where the momentum circles the axis of the largest moment, -1 for the smallest.
    pub sigma: f64,
    /// `|I1 - I2| I3`, `|I2 - I3| I1`, `|I1 - I3| I2`; the third is the sum of the others.
    pub a: Dd,
    pub b: Dd,
    pub c: Dd,
    /// `b m3² - a m1²` ≥ 0 in units of `scale²`, to a relative rounding.
    pub gap: Dd,
}

impl Branch {
    pub fn choose(i: Vector3<f64>, w: Vector3<f64>) -> Self {
        let [min, mid, max] = ascending(i);
        // Near the middle axis the squares of the other rates vanish: they get a unit of their own.
        let outer = w[min].abs().max(w[max].abs());
        let scale = if outer < 1e-60 {
            power_of_two(outer)
        } else {
            1.0
        };
        let mut m = [Dd::ZERO; 3];
        m[min] = Dd::product(i[min], w[min] / scale);
        m[mid] = Dd::product(i[mid], w[mid]);
        m[max] = Dd::product(i[max], w[max] / scale);
        let squares = [m[0].square(), m[1].square(), m[2].square()];
        let by_min = Dd::difference(i[mid], i[min]) * i[max];
        let by_max = Dd::difference(i[max], i[mid]) * i[min];
        let high = by_max * squares[max];
        let mut gap = high - by_min * squares[min];
        if gap.hi.abs() < 1e-8 * high.hi {
            gap = small_gap(i, w / scale, [min, mid, max]);
        }
        let (order, sigma, a, b) = if gap.hi >= 0.0 {
            ([min, mid, max], 1.0, by_min, by_max)
        } else {
            ([max, mid, min], -1.0, by_max, by_min)
        };
        // Axes 1 and 3 point along ω; 2 takes the sign that makes the change of axes a rotation.
        let sign = |axis: usize| if w[axis] < 0.0 { -1.0 } else { 1.0 };
        let even = (order[1] + 3 - order[0]) % 3 == 1;
        let (first, third) = (sign(order[0]), sign(order[2]));
        let second = if even { first * third } else { -first * third };
        let signs = [first, second, third];
        let of = |k: usize| m[order[k]].scaled(signs[k]);
        Self {
            order,
            signs,
            i: [i[order[0]], i[order[1]], i[order[2]]],
            m: [of(0), of(1), of(2)],
            squares: [squares[order[0]], squares[order[1]], squares[order[2]]],
            scale,
            sigma,
            a,
            b,
            c: Dd::difference(i[max], i[min]) * i[mid],
            gap: gap.abs(),
        }
    }
}

impl Branch {
    /// a, b and c, rounded.
    pub fn arms(&self) -> [f64; 3] {
        [self.a.hi, self.b.hi, self.c.hi]
    }
}

/// The axes by ascending moments.
fn ascending(i: Vector3<f64>) -> [usize; 3] {
    let mut order = [0, 1, 2];
    for (j, k) in [(0, 1), (1, 2), (0, 1)] {
        if i[order[k]] < i[order[j]] {
            order.swap(j, k);
        }
    }
    order
}

/// `(Imax - Imid) Imin mmax² - (Imid - Imin) Imax mmin²` where the two are nearly equal:
/// Imin Imax times `(Imax - Imid) Imax ωmax² - (Imid - Imin) Imin ωmin²`, and that is taken exactly.
#[cold]
fn small_gap(i: Vector3<f64>, w: Vector3<f64>, [min, mid, max]: [usize; 3]) -> Dd {
    let term = |a: usize, b: usize, of: usize| {
        Expansion::difference(i[a], i[b])
            .times(i[of])
            .times(w[of])
            .times(w[of])
    };
    let gap = term(max, mid, max).minus(&term(mid, min, min)).to_dd();
    gap * i[min] * i[max]
}
