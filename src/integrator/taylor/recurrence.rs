//! Taylor coefficients of q, ω and u_d, order by order.
//!
//! ```text
//! q' = ½ q (ω, 0)     u' = u × ω     I ω' = (I_j - I_k) ω_j ω_k + τ_0 + Σ_d A_d u_d - c I ω
//! (x y)_k = Σ_{j=0..k} x_j y_{k-j}     (y')_k = (k + 1) y_{k+1}
//! ```
//!
//! Rows of four numbers: q = (x, y, z, w) and u_d = (x, y, z, 0) under the same product, for q (ω, 0) has
//! q × ω for its vector part where w = 0. Each row is convolved with the three components of ω, which gives
//! every product that both need; which of them are added is settled once an order.
//!
//! The terms with the newest coefficients come last: all others can be summed before those are known.

use super::law::Turning;
use multiversion::multiversion;

/// Coefficients beyond which none are taken: tolerance 1e-16 asks for 20.
pub const HIGHEST: usize = 24;

/// 1/k; a multiplication in place of a division that everything waits for.
pub const INVERSE: [f64; HIGHEST + 1] = {
    let mut inverse = [0.0; HIGHEST + 1];
    let mut k = 1;
    while k <= HIGHEST {
        inverse[k] = 1.0 / k as f64;
        k += 1;
    }
    inverse
};

/// A coefficient of ω, and turned round twice: the two factors of `ω_j ω_k`.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(32))]
pub struct Spin {
    pub omega: [f64; 4],
    ahead: [f64; 4],
    behind: [f64; 4],
}

impl Spin {
    #[inline(always)]
    pub fn new(omega: [f64; 4]) -> Self {
        let [p, q, r, _] = omega;
        Self {
            omega,
            ahead: [q, r, p, 0.0],
            behind: [r, p, q, 0.0],
        }
    }
}

/// Torque that is not linear in the rows.
pub trait Levers<const W: usize> {
    /// Its coefficient `k`, rows 0 to k being known: principal axes, N·m.
    fn torque(&mut self, k: usize, rows: &[[f64; W]]) -> [f64; 4];
}

/// There is none.
pub struct NoLevers;

impl<const W: usize> Levers<W> for NoLevers {
    #[inline(always)]
    fn torque(&mut self, _: usize, _: &[[f64; W]]) -> [f64; 4] {
        [0.0; 4]
    }
}

/// Fills coefficients 1 to `order` from those of order 0, in powers of t/`unit`.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
pub fn expand<const W: usize, L: Levers<W>>(
    law: &Turning,
    unit: f64,
    order: usize,
    rows: &mut [[f64; W]],
    spins: &mut [Spin],
    levers: &mut L,
) {
    for k in 0..order {
        let sums = convolve(k, rows, spins);
        let step = unit * INVERSE[k + 1];
        rows[k + 1] = turned(&sums, step);
        let extra = levers.torque(k, rows);
        spins[k + 1] = Spin::new(spun(law, k, &sums, extra, &rows[k], &spins[k], step));
    }
}

/// Coefficient k of the rows times each component of ω, and of the products `ω_j ω_k`.
struct Sums<const W: usize> {
    p: [f64; W],
    q: [f64; W],
    r: [f64; W],
    products: [f64; 4],
}

#[inline(always)]
fn convolve<const W: usize>(k: usize, rows: &[[f64; W]], spins: &[Spin]) -> Sums<W> {
    let mut sums = Sums {
        p: [0.0; W],
        q: [0.0; W],
        r: [0.0; W],
        products: [0.0; 4],
    };
    if k > 1 {
        let (rows, spins) = (&rows[1..k], &spins[1..k]);
        for ((spin, row), mirrored) in spins.iter().zip(rows.iter().rev()).zip(spins.iter().rev()) {
            sums.add(spin, row, mirrored);
        }
    }
    if k > 0 {
        sums.add(&spins[k], &rows[0], &spins[0]);
    }
    sums.add(&spins[0], &rows[k], &spins[k]);
    sums
}

impl<const W: usize> Sums<W> {
    #[inline(always)]
    fn add(&mut self, spin: &Spin, row: &[f64; W], mirrored: &Spin) {
        let [p, q, r, _] = spin.omega;
        for lane in 0..W {
            self.p[lane] += p * row[lane];
            self.q[lane] += q * row[lane];
            self.r[lane] += r * row[lane];
        }
        for lane in 0..4 {
            self.products[lane] += spin.ahead[lane] * mirrored.behind[lane];
        }
    }
}

/// `½ q (ω, 0)` in the first row, `u × ω` in the others.
#[inline(always)]
fn turned<const W: usize>(sums: &Sums<W>, step: f64) -> [f64; W] {
    let Sums { p, q, r, .. } = sums;
    let mut next = [0.0; W];
    for row in 0..W / 4 {
        let [x, y, z, w] = [4 * row, 4 * row + 1, 4 * row + 2, 4 * row + 3];
        let factor = if row == 0 { 0.5 * step } else { step };
        next[x] = factor * (p[w] + r[y] - q[z]);
        next[y] = factor * (q[w] + p[z] - r[x]);
        next[z] = factor * (r[w] + q[x] - p[y]);
        if row == 0 {
            next[w] = -factor * (p[x] + q[y] + r[z]);
        }
    }
    next
}

#[inline(always)]
fn spun<const W: usize>(
    law: &Turning,
    k: usize,
    sums: &Sums<W>,
    extra: [f64; 4],
    row: &[f64; W],
    spin: &Spin,
    step: f64,
) -> [f64; 4] {
    let mut torque = extra;
    if k == 0 {
        torque = law.constant;
        for lane in 0..4 {
            torque[lane] += extra[lane];
        }
    }
    for (d, map) in law.maps.iter().enumerate().take(W / 4 - 1) {
        let u = &row[4 * (d + 1)..];
        for lane in 0..4 {
            torque[lane] += map[0][lane] * u[0] + map[1][lane] * u[1] + map[2][lane] * u[2];
        }
    }
    let mut next = [0.0; 4];
    for lane in 0..4 {
        let n = law.spread[lane] * sums.products[lane] + torque[lane];
        let alpha = n * law.inverse[lane] + n * law.rest[lane];
        next[lane] = step * (alpha - law.drag * spin.omega[lane]);
    }
    next
}
