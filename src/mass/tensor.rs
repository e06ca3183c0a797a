//! Inertia tensors as 3×3 matrices: moved, turned, inverted, judged.

use crate::math::symmetric_eigen;
use nalgebra::{Matrix3, Vector3};

/// The parallel-axis theorem: `I_p = I_c + m (|d|² 1 - d dᵀ)`, `d` from the centre of mass to p.
///
/// The way back is the same with `-mass`.
pub fn parallel_axis(inertia_c: &Matrix3<f64>, mass: f64, d: Vector3<f64>) -> Matrix3<f64> {
    inertia_c + (Matrix3::identity() * d.norm_squared() - d * d.transpose()) * mass
}

/// `R I Rᵀ`, symmetric bit for bit.
pub fn turned(inertia: &Matrix3<f64>, r: &Matrix3<f64>) -> Matrix3<f64> {
    let turned = r * inertia * r.transpose();
    (turned + turned.transpose()) * 0.5
}

/// The inverse tensor of a body that some of its own axes hold: zero rows and columns for those,
/// the inverse of the remaining block for the others.
///
/// For a held axis n this is the limit of the inverse as `k n nᵀ` is added to the tensor, k → ∞.
pub fn inverse_with_immovable(inertia: &Matrix3<f64>, immovable: [bool; 3]) -> Matrix3<f64> {
    let free: Vec<usize> = (0..3).filter(|&i| !immovable[i]).collect();
    let mut inverse = Matrix3::zeros();
    match free[..] {
        [i] => inverse[(i, i)] = 1.0 / inertia[(i, i)],
        [i, j] => {
            let (a, b, d) = (inertia[(i, i)], inertia[(i, j)], inertia[(j, j)]);
            if b == 0.0 {
                inverse[(i, i)] = 1.0 / a;
                inverse[(j, j)] = 1.0 / d;
            } else {
                let det = a * d - b * b;
                inverse[(i, i)] = d / det;
                inverse[(j, j)] = a / det;
                inverse[(i, j)] = -b / det;
                inverse[(j, i)] = -b / det;
            }
        }
        [_, _, _] => {
            // Through the principal axes: symmetric bit for bit, and exact where I is diagonal.
            let (v, moments) = symmetric_eigen(inertia);
            inverse = turned(&Matrix3::from_diagonal(&moments.map(f64::recip)), &v);
        }
        _ => {}
    }
    inverse
}

/// Why a matrix is no rigid body's inertia tensor.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Unphysical {
    #[error("not every entry is finite")]
    NotFinite,
    #[error("it is not symmetric: entry [{0}][{1}] is {2} and [{1}][{0}] is {3}")]
    NotSymmetric(usize, usize, f64, f64),
    #[error("its principal moment {0} is not above zero; a moment of inertia is a sum of m r²")]
    NotPositive(f64),
    #[error(
        "its smallest principal moment is nothing beside its largest, {0} kg m²; give a thin body some thickness, or hold that axis (immovable)"
    )]
    TooThin(f64),
    #[error(
        "its principal moment {0:e} kg m² is outside 1e-150 to 1e150, beyond which 64-bit products fail"
    )]
    OutOfRange(f64),
    #[error(
        "{largest} > {small} + {middle}; the largest moment may not exceed the sum of the others"
    )]
    Triangle {
        small: f64,
        middle: f64,
        largest: f64,
    },
}

/// The triangle inequality is judged with this relative slack: moments of a thin plate, which
/// meet it with equality, are often written to ten digits.
const TRIANGLE_SLACK: f64 = 1e-9;

/// Moments from 1/RANGE to RANGE kg m²: products of two, and of one with squares of speeds, stay
/// well inside what an f64 holds. Planets have 1e38, grains of a nanometre 1e-42.
const RANGE: f64 = 1e150;

/// Accepts the tensors that some rigid body has: finite, symmetric, positive, and no principal
/// moment larger than the sum of the other two (each is `∫ (y² + z²) dm` and so on).
pub fn check_physical(inertia: &Matrix3<f64>) -> Result<(), Unphysical> {
    check_held(inertia, [false; 3])
}

/// The same of a body that some of its own axes hold. There may be no moment about them: a thin rod
/// that does not turn about itself.
pub fn check_held(inertia: &Matrix3<f64>, immovable: [bool; 3]) -> Result<(), Unphysical> {
    if !inertia.iter().all(|x| x.is_finite()) {
        return Err(Unphysical::NotFinite);
    }
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        let (a, b) = (inertia[(i, j)], inertia[(j, i)]);
        if a != b {
            return Err(Unphysical::NotSymmetric(i, j, a, b));
        }
    }
    // Judged by the entries first: beyond the range the eigenvalues themselves fail.
    let size = inertia.amax();
    if size > RANGE {
        return Err(Unphysical::OutOfRange(size));
    }
    let (_, moments) = symmetric_eigen(inertia);
    let mut sorted: [f64; 3] = moments.into();
    sorted.sort_by(f64::total_cmp);
    let [small, middle, largest] = sorted;
    // What rounding leaves of a moment that is really zero.
    let nothing = 4.0 * f64::EPSILON * largest;
    if largest <= 0.0 || small < -nothing {
        return Err(Unphysical::NotPositive(small));
    }
    if immovable != [true; 3] {
        let least = least_free(inertia, immovable, largest);
        if least < nothing {
            return Err(Unphysical::TooThin(largest));
        }
        if least < 1.0 / RANGE {
            return Err(Unphysical::OutOfRange(least));
        }
    }
    if largest > (small + middle) * (1.0 + TRIANGLE_SLACK) {
        return Err(Unphysical::Triangle {
            small,
            middle,
            largest,
        });
    }
    Ok(())
}

/// The least principal moment of what is left to turn about: of the tensor's block without the held
/// axes, in whose place stands the `largest`, which no moment of a block exceeds.
fn least_free(inertia: &Matrix3<f64>, immovable: [bool; 3], largest: f64) -> f64 {
    let mut block = *inertia;
    for axis in (0..3).filter(|&axis| immovable[axis]) {
        block.row_mut(axis).fill(0.0);
        block.column_mut(axis).fill(0.0);
        block[(axis, axis)] = largest;
    }
    symmetric_eigen(&block).1.min()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_held_axis_is_the_limit_of_a_huge_moment_about_it() {
        let inertia = Matrix3::new(2.0, 0.3, 0.1, 0.3, 2.5, -0.2, 0.1, -0.2, 1.8);
        let mut heavy = inertia;
        heavy[(1, 1)] += 1e12;
        let limit = heavy.try_inverse().unwrap();
        let held = inverse_with_immovable(&inertia, [false, true, false]);
        // The limit is reached as 1/k = 1e-12.
        assert!((limit - held).norm() < 1e-11, "{limit} {held}");
        assert_eq!(held.row(1).norm(), 0.0);
    }

    #[test]
    fn the_inverse_of_a_diagonal_tensor_is_exact() {
        let inertia = Matrix3::from_diagonal(&Vector3::new(0.25, 0.3, 0.75));
        let inverse = inverse_with_immovable(&inertia, [false; 3]);
        assert_eq!(inverse.diagonal(), Vector3::new(4.0, 1.0 / 0.3, 1.0 / 0.75));
    }

    #[test]
    fn impossible_tensors_are_named() {
        let diagonal = |x, y, z| Matrix3::from_diagonal(&Vector3::new(x, y, z));
        assert!(check_physical(&diagonal(1.0, 1.0, 2.0)).is_ok());
        assert!(matches!(
            check_physical(&diagonal(1.0, 1.0, 3.0)),
            Err(Unphysical::Triangle { .. })
        ));
        assert!(matches!(
            check_physical(&diagonal(1.0, -1.0, 1.0)),
            Err(Unphysical::NotPositive(_))
        ));
        let mut skew = diagonal(1.0, 1.0, 1.0);
        skew[(0, 1)] = 0.1;
        assert!(matches!(
            check_physical(&skew),
            Err(Unphysical::NotSymmetric(0, 1, ..))
        ));
    }

    #[test]
    fn a_rod_is_a_body_where_it_cannot_turn_about_itself() {
        let rod = Matrix3::from_diagonal(&Vector3::new(1.0, 0.0, 1.0));
        let thin = Err(Unphysical::TooThin(1.0));
        assert_eq!(check_held(&rod, [false, true, false]), Ok(()));
        assert_eq!(check_held(&rod, [false; 3]), thin);
        assert_eq!(check_held(&rod, [true, false, true]), thin);
        // Askew, about an axis that is not its own, it has a moment: those that are left decide.
        let s = 0.5_f64.sqrt();
        let eighth = Matrix3::new(s, -s, 0.0, s, s, 0.0, 0.0, 0.0, 1.0);
        let askew = turned(&rod, &eighth);
        assert!(check_held(&askew, [false, true, false]).is_ok());
        assert!(check_held(&askew, [false, false, true]).is_err());
        // A negative moment is none, held or not.
        let negative = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, 1.0));
        assert!(check_held(&negative, [false, true, false]).is_err());
    }
}
