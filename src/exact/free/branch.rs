//! Which side of the separatrix a motion is on, decided exactly, and its axes in order.

use super::power_of_two;
use crate::math::{Dd, Expansion};
use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

/// The axes in the order that makes 1 and 3 the ones of the branch, signs with ω1, ω3 ≥ 0.
pub struct Branch {
    /// Moments and angular velocity along axes 1, 2, 3.
    pub i: [f64; 3],
    pub w: [f64; 3],
    /// +1 where the momentum circles the axis of the largest moment, -1 for the smallest.
    pub sigma: f64,
    /// √|G² - 2 E I2| in double-double, the difference exact where it is a small one.
    pub gap: Dd,
    /// Old axes → new axes.
    pub permutation: Quaternion<f64>,
}

impl Branch {
    pub fn choose(i: Vector3<f64>, w: Vector3<f64>) -> Self {
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| i[a].total_cmp(&i[b]));
        let [min, mid, max] = order;
        // ω of the outer axes near 1, by a power of two: near the middle axis their squares vanish.
        let scale = power_of_two(w[min].abs().max(w[max].abs()));
        let e2 = separatrix_distance(i, w / scale, order);
        let (order, sigma) = if e2.hi >= 0.0 {
            ([min, mid, max], 1.0)
        } else {
            ([max, mid, min], -1.0)
        };
        // Axes 1 and 3 point along ω; 2 takes the sign that makes the change of axes a rotation.
        let sign = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
        let mut matrix = Matrix3::zeros();
        for (row, &axis) in order.iter().enumerate() {
            matrix[(row, axis)] = sign(w[axis]);
        }
        matrix[(1, order[1])] *= matrix.determinant();
        let rotation = Rotation3::from_matrix_unchecked(matrix);
        let w = matrix * w;
        Self {
            i: order.map(|axis| i[axis]),
            w: w.into(),
            sigma,
            gap: e2.abs().sqrt().scaled(scale),
            permutation: UnitQuaternion::from_rotation_matrix(&rotation).into_inner(),
        }
    }
}

/// `(Imax - Imid) Imax ωmax² - (Imid - Imin) Imin ωmin² = G² - 2 E Imid`.
fn separatrix_distance(i: Vector3<f64>, w: Vector3<f64>, [min, mid, max]: [usize; 3]) -> Dd {
    let high = Dd::difference(i[max], i[mid]) * i[max] * Dd::product(w[max], w[max]);
    let low = Dd::difference(i[mid], i[min]) * i[min] * Dd::product(w[min], w[min]);
    let rough = high - low;
    if rough.hi.abs() >= 1e-8 * high.hi {
        return rough;
    }
    let term = |a: usize, b: usize, of: usize| {
        Expansion::difference(i[a], i[b])
            .times(i[of])
            .times(w[of])
            .times(w[of])
    };
    term(max, mid, max).minus(&term(mid, min, min)).to_dd()
}
