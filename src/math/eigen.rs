//! Eigenvectors of a symmetric 3×3 matrix by Jacobi's rotations.
//!
//! `V ← V J`, `A ← Jᵀ A J`, each J turning one plane so that one off-diagonal entry vanishes;
//! quadratically convergent, and V is a product of rotations, hence right-handed
//! (Golub & Van Loan, Matrix Computations, 8.5).
//!
//! Jacobi is chosen because a matrix that is already diagonal comes back untouched, in its own
//! order and bit for bit, and a nearly diagonal one with axes that barely turn.

use nalgebra::{Matrix3, Vector3};

/// Sweeps allowed. Quadratic convergence needs 4 to 6 in f64; the rest is reserve.
const SWEEPS: usize = 16;

/// An entry below this part of the two eigenvalues beside it is what rounding leaves of a tensor that somebody
/// turned (up to three ulps), and moves neither eigenvalue by more. Where they are equal, to follow it would be to
/// turn their axes by any angle whatever: the frame of a ball, or of a body of revolution, would jitter.
const NEGLIGIBLE: f64 = 4.0 * f64::EPSILON;

/// `(V, λ)` with `A = V diag(λ) Vᵀ`, V a rotation whose columns are the eigenvectors.
///
/// Only the upper triangle of `a` is read. The order of λ is that of the axes V came from,
/// not sorted.
pub fn symmetric_eigen(a: &Matrix3<f64>) -> (Matrix3<f64>, Vector3<f64>) {
    let mut a = Matrix3::new(
        a.m11, a.m12, a.m13, a.m12, a.m22, a.m23, a.m13, a.m23, a.m33,
    );
    let mut v = Matrix3::identity();
    for _ in 0..SWEEPS {
        let mut turned = false;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            turned |= rotate(&mut a, &mut v, p, q);
        }
        if !turned {
            break;
        }
    }
    (v, a.diagonal())
}

/// Turns the (p, q) plane until `a[p, q]` vanishes; false where it is already negligible.
fn rotate(a: &mut Matrix3<f64>, v: &mut Matrix3<f64>, p: usize, q: usize) -> bool {
    let off = a[(p, q)];
    let negligible = NEGLIGIBLE * a[(p, p)].abs().sqrt() * a[(q, q)].abs().sqrt();
    if off == 0.0 || off.abs() <= negligible {
        a[(p, q)] = 0.0;
        a[(q, p)] = 0.0;
        return false;
    }
    let theta = 0.5 * (a[(q, q)] - a[(p, p)]) / off;
    // Square roots rather than `hypot`, which differs from platform to platform; where θ² is
    // infinite t is rightly 0.
    let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    a[(p, p)] -= t * off;
    a[(q, q)] += t * off;
    a[(p, q)] = 0.0;
    a[(q, p)] = 0.0;
    let r = 3 - p - q;
    let (arp, arq) = (a[(r, p)], a[(r, q)]);
    a[(r, p)] = c * arp - s * arq;
    a[(r, q)] = s * arp + c * arq;
    a[(p, r)] = a[(r, p)];
    a[(q, r)] = a[(r, q)];
    for k in 0..3 {
        let (vkp, vkq) = (v[(k, p)], v[(k, q)]);
        v[(k, p)] = c * vkp - s * vkq;
        v[(k, q)] = s * vkp + c * vkq;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_diagonal_matrix_comes_back_untouched() {
        let a = Matrix3::from_diagonal(&Vector3::new(3.0, 1.0, 2.0));
        assert_eq!(
            symmetric_eigen(&a),
            (Matrix3::identity(), Vector3::new(3.0, 1.0, 2.0))
        );
    }

    #[test]
    fn known_eigenvalues() {
        // [[2, 1, 0], [1, 2, 1], [0, 1, 2]] has 2 and 2 ± √2 (the discrete Laplacian).
        let a = Matrix3::new(2.0, 1.0, 0.0, 1.0, 2.0, 1.0, 0.0, 1.0, 2.0);
        let (v, lambda) = symmetric_eigen(&a);
        let mut sorted: Vec<f64> = lambda.iter().copied().collect();
        sorted.sort_by(f64::total_cmp);
        let root = std::f64::consts::SQRT_2;
        for (got, want) in sorted.iter().zip([2.0 - root, 2.0, 2.0 + root]) {
            // A few roundings of numbers of size 4.
            assert!((got - want).abs() < 4e-15, "{got} {want}");
        }
        assert!((v.determinant() - 1.0).abs() < 4e-15);
        assert!((v * Matrix3::from_diagonal(&lambda) * v.transpose() - a).norm() < 1e-14);
    }
}
