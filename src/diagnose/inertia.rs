//! The inertia that the motion obeys: least squares over windows,
//!
//! ```text
//! Σφ [J dω_b/h + ω × J ω - τ_b] = 0        six unknowns, three equations a window
//! ```
//!
//! Without a torque J is known but for a factor: the vector of the smallest singular value. What J - I is like tells what was
//! done to the data: eigenvalues {0, md², md²}, another point; J = c I, another unit.

use super::law::Steps;
use crate::math::symmetric_eigen;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

/// What was found.
#[derive(Clone, Copy, Debug)]
pub struct Effective {
    /// kg m²; where `sized` is false, of the trace of what was declared.
    pub j: Matrix3<f64>,
    /// Its size is known: a torque acted.
    pub sized: bool,
}

/// The columns of `v ↦ J v` for (xx, yy, zz, xy, xz, yz).
fn columns(v: &Vector3<f64>) -> SMatrix<f64, 3, 6> {
    SMatrix::<f64, 3, 6>::from_row_slice(&[
        v.x, 0.0, 0.0, v.y, v.z, 0.0, //
        0.0, v.y, 0.0, v.x, 0.0, v.z, //
        0.0, 0.0, v.z, 0.0, v.x, v.y,
    ])
}

fn tensor(p: &SVector<f64, 6>) -> Matrix3<f64> {
    Matrix3::new(p[0], p[3], p[4], p[3], p[1], p[5], p[4], p[5], p[2])
}

/// None where the windows do not tell.
pub fn effective(
    steps: &Steps,
    tau_b: &[Vector3<f64>],
    declared: &Matrix3<f64>,
    kept: &[bool],
) -> Option<Effective> {
    let turning: Vec<SMatrix<f64, 3, 6>> = {
        // Σφ ω × J ω, column by column.
        let unit = |i: usize| {
            let mut p = SVector::<f64, 6>::zeros();
            p[i] = 1.0;
            tensor(&p)
        };
        let each: Vec<_> = (0..6)
            .map(|i| {
                let j = unit(i);
                steps.of_omega(move |w| w.cross(&(j * w)))
            })
            .collect();
        (0..steps.windows.len())
            .map(|w| SMatrix::from_fn(|a, i| each[i][w][a]))
            .collect()
    };
    let (mut ata, mut atb) = (SMatrix::<f64, 6, 6>::zeros(), SVector::<f64, 6>::zeros());
    let mut torque = 0.0;
    for w in (0..steps.windows.len()).filter(|&w| kept[w]) {
        let a = columns(&steps.measured[w]) + turning[w];
        ata += a.transpose() * a;
        atb += a.transpose() * tau_b[w];
        torque += tau_b[w].norm_squared();
    }
    let size = ata.trace();
    if !(size > 0.0 && size.is_finite()) {
        return None;
    }
    let eigen = ata.symmetric_eigen();
    let mut order: Vec<usize> = (0..6).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let j = if torque > 0.0 {
        // Directions of which nothing is known stay as declared.
        let least = eigen.eigenvalues[order[0]];
        if least <= 1e-9 * size {
            return None;
        }
        let mut p = SVector::<f64, 6>::zeros();
        for i in 0..6 {
            let v = eigen.eigenvectors.column(i);
            p += v * (v.dot(&atb) / eigen.eigenvalues[i]);
        }
        tensor(&p)
    } else {
        // One direction, and one only, may be free.
        if eigen.eigenvalues[order[1]] < 20.0 * eigen.eigenvalues[order[0]].max(0.0)
            || eigen.eigenvalues[order[1]] <= 1e-9 * size
        {
            return None;
        }
        let p: SVector<f64, 6> = eigen.eigenvectors.column(order[0]).into_owned();
        let j = tensor(&p);
        if j.trace().abs() < 1e-9 {
            return None;
        }
        j * (declared.trace() / j.trace())
    };
    j.iter().all(|x| x.is_finite()).then_some(Effective {
        j,
        sized: torque > 0.0,
    })
}

/// `J = I + m (d² 1 - d dᵀ)`: (m d², how far the eigenvalues of J - I are from {0, md², md²}, of md²).
pub fn about_another_point(
    found: &Effective,
    declared: &Matrix3<f64>,
) -> Option<(f64, f64, Matrix3<f64>)> {
    let judge = |j: Matrix3<f64>| {
        let (_, values) = symmetric_eigen(&(j - declared));
        let mut v = [values.x, values.y, values.z];
        v.sort_by(f64::total_cmp);
        let md2 = 0.5 * (v[1] + v[2]);
        let off = v[0].abs().max(0.5 * (v[2] - v[1])) / md2;
        (md2 > 0.0).then_some((md2, off, j))
    };
    if found.sized {
        return judge(found.j);
    }
    // Known but for a factor c: one eigenvalue of cJ - I must vanish.
    let l = declared.cholesky()?.l().try_inverse()?;
    let (_, ratios) = symmetric_eigen(&(l * found.j * l.transpose()));
    (ratios.iter())
        .filter(|r| **r > 0.0)
        .filter_map(|r| judge(found.j / *r))
        .min_by(|a, b| a.1.total_cmp(&b.1))
}
