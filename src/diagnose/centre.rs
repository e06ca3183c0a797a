//! About which point does the body turn? Least squares in position:
//!
//! ```text
//! x = c₀ + v t + ½ g t² + s ∬ f/m - R r
//! ```
//!
//! r goes from the logged position to the point that moves as a centre of mass does; s is the part of the force that acts. Columns
//! whose size is nothing (no force, no turning) are left out.

use super::motion::Motion;
use super::squares::Squares;
use nalgebra::{SVector, Vector3};

/// What was found.
#[derive(Clone, Debug)]
pub struct Centre {
    /// Body, m.
    pub r: Vector3<f64>,
    /// Of its components, m.
    pub error: f64,
    /// The part of the force that acts, where a force was logged, and its standard error.
    pub part: Option<(f64, f64)>,
    /// Root of the mean of the squares that are left, m.
    pub left: f64,
}

impl Centre {
    /// The body turns about another point than this one (body frame, from the logged position), by a fair part of its size: a joint, or
    /// another centre of mass.
    pub fn is_not(&self, c: &Vector3<f64>, size: f64) -> bool {
        let off = (self.r - c).norm();
        self.left < 0.1 * size && off > 0.1 * size && off > 10.0 * self.error
    }
}

/// None where positions are missing, too few, or where nothing turns.
///
/// `force` is over the mass, m/s²; empty where none was logged.
pub fn centre(m: &Motion, positions: &[[f64; 3]], force: &[Vector3<f64>]) -> Option<Centre> {
    let n = m.len();
    if positions.len() != n || n < 30 || m.h <= 0.0 {
        return None;
    }
    let pushes = push(m, force);
    let span = m.times[n - 1] - m.times[0];
    let pushed = pushes
        .as_ref()
        .map_or(0.0, |p| p.last().map_or(0.0, Vector3::norm));
    // A column of nothing would make the equations singular: it is replaced by one that no row has.
    let has_force = pushed > 1e-9 * span * span;
    let mut squares = Squares::<13>::new();
    let apart = (n / 4_000).max(1);
    let first = Vector3::from(positions[0]);
    for k in (0..n).step_by(apart) {
        let x = Vector3::from(positions[k]) - first;
        if !x.iter().all(|x| x.is_finite()) {
            continue;
        }
        let t = (m.times[k] - m.times[0]) / span;
        let r = m.q[k].to_rotation_matrix();
        for axis in 0..3 {
            let mut row = SVector::<f64, 13>::zeros();
            row[axis] = 1.0;
            row[3 + axis] = t;
            row[6 + axis] = t * t;
            for j in 0..3 {
                row[9 + j] = -r.matrix()[(axis, j)];
            }
            match (&pushes, has_force) {
                (Some(p), true) => row[12] = p[k][axis],
                _ => row[12] = 0.0,
            }
            squares.add(&row, x[axis]);
        }
    }
    // A dummy, so that what is absent comes out as zero.
    if !has_force {
        let mut dummy = SVector::zeros();
        dummy[12] = 1.0;
        squares.add(&dummy, 0.0);
    }
    let solution = squares.solve()?;
    let rows = (3 * n.div_ceil(apart)) as f64;
    Some(Centre {
        r: Vector3::new(solution.x[9], solution.x[10], solution.x[11]),
        error: solution.error[9]
            .max(solution.error[10])
            .max(solution.error[11]),
        part: has_force.then_some((solution.x[12], solution.error[12])),
        left: (solution.left / rows).sqrt(),
    })
}

/// `∬ f/m`, as held during each step.
fn push(m: &Motion, force: &[Vector3<f64>]) -> Option<Vec<Vector3<f64>>> {
    if force.len() != m.len() {
        return None;
    }
    let (mut v, mut x) = (Vector3::zeros(), Vector3::zeros());
    let mut all = Vec::with_capacity(m.len());
    for (k, f) in force.iter().enumerate() {
        all.push(x);
        if k + 1 < m.len() {
            let h = m.step(k);
            // Half way between x += h v before and after: engines differ.
            x += (v + f * (0.5 * h)) * h;
            v += f * h;
        }
    }
    all.iter()
        .all(|x| x.iter().all(|x| x.is_finite()))
        .then_some(all)
}
