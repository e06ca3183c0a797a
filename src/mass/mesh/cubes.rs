//! "Slice it into little cubes": mass, centre and inertia by counting.
//!
//! The box about the mesh is cut into n × n × n equal blocks (cubes, where the box is one). A block counts
//! wholly if its middle lies inside: on the ray through a row of middles, behind an odd number of faces. So
//!
//! ```text
//! m = Σ dm    c = Σ x dm / m    I = Σ (|x - c|² 1 - (x - c)(x - c)ᵀ) dm + each block's own
//! ```
//!
//! What is wrong is the blocks at the surface, counted wholly or not at all: n² of n³ blocks, with errors of
//! either sign. So the tensor tends to the exact one as 1/n at worst, between 1/n and 1/n² where the signs
//! are mixed, and not smoothly: for a face that lies along the blocks it depends on where between two
//! layers it falls.

use super::crossing::Crossing;
use super::{Integrals, Polyhedron};
use nalgebra::{Matrix3, Vector3};

/// A body in n³ blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cubes {
    /// Blocks along each edge of the box about the mesh.
    pub n: usize,
    /// Blocks whose middle is inside.
    pub inside: u64,
    /// Of those, at unit density; `None` where there are none.
    pub integrals: Option<Integrals>,
}

/// A row of the table: blocks beside the exact body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CubeRow {
    pub cubes: Cubes,
    /// `|I_n - I| / |I|`, Frobenius norms, both about their own centres.
    pub difference: Option<f64>,
    /// log₂ of the previous row's difference over this one's, where n doubles: the order observed.
    pub order: Option<f64>,
}

impl Cubes {
    /// Blocks along an edge: a bit each, 2 MB at most.
    pub const MOST: usize = 256;

    /// Slices a body into n³ blocks, n from 1 to [`Cubes::MOST`] (beyond, the nearest of these).
    pub fn of(body: &Polyhedron, n: usize) -> Self {
        let n = n.clamp(1, Self::MOST);
        let grid = Grid::about(body, n);
        let flips = grid.flips(body);
        grid.sum(&flips)
    }
}

/// A difference below this is rounding: what fills its own box is cut without a remainder.
const ROUNDING: f64 = 1e-13;

/// The order over all rows: how fast the difference falls with n, as the slope of the line that fits best
/// through the logarithms of both. Steadier than the orders of single rows.
pub fn mean_order(rows: &[CubeRow]) -> Option<f64> {
    let points = rows.iter().filter_map(|row| {
        let difference = row.difference.filter(|&x| x > ROUNDING)?;
        Some((libm::log2(row.cubes.n as f64), libm::log2(difference)))
    });
    let points: Vec<(f64, f64)> = points.collect();
    let count = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let xx: f64 = points.iter().map(|p| (p.0 - x) * (p.0 - x)).sum();
    let xy: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    (xx > 0.0).then_some(-xy / xx)
}

/// Blocks of ever smaller size beside the exact body; each n twice the one before has an order.
pub fn orders(body: &Polyhedron, ns: &[usize]) -> Vec<CubeRow> {
    let exact = body.integrals().tensor;
    let mut rows: Vec<CubeRow> = Vec::new();
    for &n in ns {
        let cubes = Cubes::of(body, n);
        let difference = cubes
            .integrals
            .map(|sum| (sum.tensor - exact).norm() / exact.norm());
        let order = rows.last().and_then(|before| {
            let ratio = before.difference? / difference.filter(|&x| x > ROUNDING)?;
            let doubled = 2 * before.cubes.n == cubes.n;
            (doubled && ratio.is_finite() && ratio > 0.0).then(|| libm::log2(ratio))
        });
        rows.push(CubeRow {
            cubes,
            difference,
            order,
        });
    }
    rows
}

/// n³ blocks over the box about a body.
struct Grid {
    n: usize,
    low: Vector3<f64>,
    /// Of a block.
    size: Vector3<f64>,
}

impl Grid {
    fn about(body: &Polyhedron, n: usize) -> Self {
        let (low, high) = body.triangles().bounds();
        Self {
            n,
            low,
            size: (high - low) / n as f64,
        }
    }

    fn middle(&self, axis: usize, k: usize) -> f64 {
        self.low[axis] + (k as f64 + 0.5) * self.size[axis]
    }

    /// The first block along an axis whose middle lies beyond x; n where none does.
    fn beyond(&self, axis: usize, x: f64) -> usize {
        let k = ((x - self.low[axis]) / self.size[axis] + 0.5).floor();
        // Clamped; what is no number counts as 0.
        (k.max(0.0) as usize).min(self.n)
    }

    /// A bit for each block of each row along x: whether the ray through the middles goes through an odd
    /// number of faces just before it.
    fn flips(&self, body: &Polyhedron) -> Vec<bool> {
        let n = self.n;
        let mut flips = vec![false; n * n * n];
        for face in body.triangles().corners() {
            let crossing = Crossing::of(face);
            // One block more on either side: the faces themselves say which rays they meet.
            let range = |axis: usize| {
                let [a, b, c] = face.map(|p| p[axis]);
                let low = self.beyond(axis, a.min(b).min(c)).saturating_sub(1);
                low..(self.beyond(axis, a.max(b).max(c)) + 1).min(n)
            };
            for k in range(2) {
                for j in range(1) {
                    let x = crossing.x_at(self.middle(1, j), self.middle(2, k));
                    if let Some(i) = x.map(|x| self.beyond(0, x))
                        && i < n
                    {
                        flips[(k * n + j) * n + i] ^= true;
                    }
                }
            }
        }
        flips
    }

    fn sum(&self, flips: &[bool]) -> Cubes {
        let n = self.n;
        // From the middle of the box, in blocks, where coordinates are halves of whole numbers and sums of
        // them exact.
        let place = |k: usize| k as f64 + 0.5 - 0.5 * n as f64;
        let mut count = 0_u64;
        let (mut first, mut second) = (Vector3::zeros(), Matrix3::zeros());
        for (row, flips) in flips.chunks_exact(n).enumerate() {
            let (y, z) = (place(row % n), place(row / n));
            let (mut inside, mut in_row, mut x1, mut x2) = (false, 0_u64, 0.0, 0.0);
            for (i, &flip) in flips.iter().enumerate() {
                inside ^= flip;
                if inside {
                    let x = place(i);
                    in_row += 1;
                    x1 += x;
                    x2 += x * x;
                }
            }
            let c = in_row as f64;
            count += in_row;
            first += Vector3::new(x1, c * y, c * z);
            second += Matrix3::new(
                x2,
                x1 * y,
                x1 * z,
                x1 * y,
                c * y * y,
                c * y * z,
                x1 * z,
                c * y * z,
                c * z * z,
            );
        }
        Cubes {
            n,
            inside: count,
            integrals: (count > 0).then(|| self.integrals(count as f64, first, second)),
        }
    }

    /// In metres, about the centre; each block adds its own `∫ x² = size²/12` along each axis.
    fn integrals(&self, count: f64, first: Vector3<f64>, second: Matrix3<f64>) -> Integrals {
        let block = self.size.product();
        let mean = first / count;
        let own = Matrix3::from_diagonal_element(count / 12.0);
        let about_mean = second - mean * mean.transpose() * count + own;
        let size = Matrix3::from_diagonal(&self.size);
        let second = size * about_mean * size * block;
        Integrals {
            volume: count * block,
            centre: self.low
                + self
                    .size
                    .component_mul(&mean.add_scalar(0.5 * self.n as f64)),
            tensor: Matrix3::identity() * second.trace() - second,
        }
    }
}
