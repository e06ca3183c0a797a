//! Simple solids of the same inertia: what stands for a body of which no shape is known.

use crate::math::symmetric_eigen;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

/// The ellipsoid of uniform density with a body's mass (kg) and inertia about its centre of mass (kg m²):
/// half axes `a_i² = 5/(2m) (I_j + I_k - I_i)`, m, and its attitude in the body.
pub fn ellipsoid(mass: f64, inertia_c: &Matrix3<f64>) -> (Vector3<f64>, UnitQuaternion<f64>) {
    let (axes, moments) = symmetric_eigen(inertia_c);
    let squares = moments.map(|i| 2.5 / mass * (moments.sum() - 2.0 * i));
    let rotation = Rotation3::from_matrix_unchecked(axes);
    let half = squares.map(|square| square.max(0.0).sqrt());
    (half, UnitQuaternion::from_rotation_matrix(&rotation))
}

/// Full extents, m, of the cuboid of the same inertia, and its attitude in the body: the ellipsoid's
/// half axes times `2 √(3/5)`; a cube of half a metre where the mass is infinite.
pub fn cuboid(mass: Option<f64>, inertia_c: &Matrix3<f64>) -> (Vector3<f64>, UnitQuaternion<f64>) {
    let Some(mass) = mass else {
        return (Vector3::repeat(0.5), UnitQuaternion::identity());
    };
    let (half, q_bp) = ellipsoid(mass, inertia_c);
    (half * (2.0 * 0.6_f64.sqrt()), q_bp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mass::tensor;

    #[test]
    fn a_cuboid_gives_itself_in_whatever_axes() {
        let extents = Vector3::new(1.0, 0.5, 0.2);
        let [x2, y2, z2]: [f64; 3] = extents.component_mul(&extents).into();
        let moments = Vector3::new(y2 + z2, x2 + z2, x2 + y2) * (3.0 / 12.0);
        let turn = UnitQuaternion::from_euler_angles(0.4, -1.1, 2.3);
        let diagonal = Matrix3::from_diagonal(&moments);
        let turned = tensor::turned(&diagonal, turn.to_rotation_matrix().matrix());
        let (plain, _) = cuboid(Some(3.0), &diagonal);
        // Square roots of differences of moments: some roundings.
        assert!((plain - extents).norm() < 1e-14);
        let (half, q) = cuboid(Some(3.0), &turned);
        for axis in 0..3 {
            // Each of its axes is one of the body's, of the same extent.
            let along_b = turn.inverse() * (q * Vector3::ith(axis, 1.0));
            let same = along_b.iamax();
            assert!((along_b[same].abs() - 1.0).abs() < 1e-12);
            assert!((half[axis] - extents[same]).abs() < 1e-13);
        }
    }
}
