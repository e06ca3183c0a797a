//! Taylor coefficients of q, ω and u_d, order by order.
//!
//! ```text
//! q' = ½ q (ω, 0)     u' = u × ω     I ω' = (I_j - I_k) ω_j ω_k + τ_0 + Σ_d A_d u_d - c I ω
//! (x y)_k = Σ_{j=0..k} x_j y_{k-j}     (y')_k = (k + 1) y_{k+1}
//! ```
//!
//! All products are of rows of four, lane by lane, so that no lane ever waits for another; for that each
//! coefficient is kept in the arrangements in which it is a factor:
//!
//! ```text
//! q' = ½ ((w, w, w, -x) (p, q, r, p) + (y, z, x, -y) (r, p, q, q) - (z, x, y, z) (q, r, p, r))
//! u' =                                 (y, z, x)     (r, p, q)    - (z, x, y)    (q, r, p)
//! ω_j ω_k =                                          (r, p, q)                   (q, r, p)
//! ```
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

/// Four numbers that go through arithmetic together.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(32))]
pub struct Four(pub [f64; 4]);

/// The rows of an order: q as (x, y, z, w) and as arranged above, ω as (p, q, r, 0) and likewise, then
/// u as (x, y, z, 0) and likewise for each direction.
pub const Q: usize = 0;
const Q_W: usize = 1;
const Q_AHEAD: usize = 2;
const Q_BEHIND: usize = 3;
pub const OMEGA: usize = 4;
const PLAIN: usize = 5;
const AHEAD: usize = 6;
const BEHIND: usize = 7;
const DIRECTIONS: usize = 8;
/// Of a direction, from its first on.
const U_AHEAD: usize = 1;
const U_BEHIND: usize = 2;
const ROWS_OF_U: usize = 3;

/// Rows an order has with so many directions.
pub const fn rows(directions: usize) -> usize {
    DIRECTIONS + ROWS_OF_U * directions
}

/// All coefficients of one order.
pub type Order<const ROWS: usize> = [Four; ROWS];

#[inline(always)]
pub fn set_attitude<const ROWS: usize>(order: &mut Order<ROWS>, q: [f64; 4]) {
    let [x, y, z, w] = q;
    order[Q] = Four(q);
    order[Q_W] = signed([w, w, w, x]);
    order[Q_AHEAD] = signed([y, z, x, y]);
    order[Q_BEHIND] = Four([z, x, y, z]);
}

/// The last with its sign turned: as a product, so that all four stay together.
#[inline(always)]
fn signed(mut row: [f64; 4]) -> Four {
    for (c, sign) in row.iter_mut().zip([1.0, 1.0, 1.0, -1.0]) {
        *c *= sign;
    }
    Four(row)
}

#[inline(always)]
pub fn set_spin<const ROWS: usize>(order: &mut Order<ROWS>, omega: [f64; 4]) {
    let [p, q, r, _] = omega;
    order[OMEGA] = Four(omega);
    order[PLAIN] = Four([p, q, r, p]);
    order[AHEAD] = Four([q, r, p, r]);
    order[BEHIND] = Four([r, p, q, q]);
}

#[inline(always)]
pub fn set_direction<const ROWS: usize>(order: &mut Order<ROWS>, d: usize, u: [f64; 4]) {
    let [x, y, z, none] = u;
    let rows = &mut order[rows(d)..];
    rows[0] = Four(u);
    rows[U_AHEAD] = Four([y, z, x, none]);
    rows[U_BEHIND] = Four([z, x, y, none]);
}

/// u_d.
#[inline(always)]
pub fn direction<const ROWS: usize>(order: &Order<ROWS>, d: usize) -> [f64; 3] {
    let Four([x, y, z, _]) = order[rows(d)];
    [x, y, z]
}

/// Torque that is not linear in the directions.
pub trait Levers<const ROWS: usize> {
    /// Its coefficient `k`, orders 0 to k being known: principal axes, N·m.
    fn torque(&mut self, k: usize, orders: &[Order<ROWS>]) -> [f64; 4];
}

/// There is none.
pub struct NoLevers;

impl<const ROWS: usize> Levers<ROWS> for NoLevers {
    #[inline(always)]
    fn torque(&mut self, _: usize, _: &[Order<ROWS>]) -> [f64; 4] {
        [0.0; 4]
    }
}

/// Fills orders 1 and up from order 0, in powers of time over `unit`.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
pub fn expand<const ROWS: usize, L: Levers<ROWS>>(
    law: &Turning,
    unit: f64,
    orders: &mut [Order<ROWS>],
    levers: &mut L,
) {
    for k in 0..orders.len() - 1 {
        let extra = levers.torque(k, orders);
        let step = unit * INVERSE[k + 1];
        let sums = convolve(&orders[..=k]);
        let omega = spun(law, k, &orders[k], &sums, extra, step);
        let next = &mut orders[k + 1];
        set_spin(next, omega);
        set_attitude(next, sums.q.map(|c| c * (0.5 * step)));
        for d in 0..directions::<ROWS>() {
            set_direction(next, d, sums.u[d].map(|c| c * step));
        }
    }
}

const fn directions<const ROWS: usize>() -> usize {
    (ROWS - DIRECTIONS) / ROWS_OF_U
}

/// Coefficient k of 2 q', of `ω_j ω_k`, and of u'.
#[derive(Default)]
struct Sums {
    q: [f64; 4],
    products: [f64; 4],
    u: [[f64; 4]; 3],
}

/// From orders 0 to k.
#[inline(always)]
fn convolve<const ROWS: usize>(orders: &[Order<ROWS>]) -> Sums {
    let mut sums = Sums::default();
    if let [first, middle @ .., last] = orders {
        for (spin, order) in middle.iter().zip(middle.iter().rev()) {
            sums.add(spin, order);
        }
        sums.add(last, first);
        sums.add(first, last);
    } else if let [only] = orders {
        sums.add(only, only);
    }
    sums
}

impl Sums {
    /// ω of one order times everything of the other.
    #[inline(always)]
    fn add<const ROWS: usize>(&mut self, spin: &Order<ROWS>, order: &Order<ROWS>) {
        let [plain, ahead, behind] = [spin[PLAIN].0, spin[AHEAD].0, spin[BEHIND].0];
        let [w, q_ahead, q_behind] = [order[Q_W].0, order[Q_AHEAD].0, order[Q_BEHIND].0];
        for lane in 0..4 {
            self.q[lane] += w[lane] * plain[lane]
                + (q_ahead[lane] * behind[lane] - q_behind[lane] * ahead[lane]);
        }
        for lane in 0..4 {
            self.products[lane] += ahead[lane] * order[BEHIND].0[lane];
        }
        for d in 0..directions::<ROWS>() {
            let u_ahead = order[rows(d) + U_AHEAD].0;
            let u_behind = order[rows(d) + U_BEHIND].0;
            for lane in 0..4 {
                self.u[d][lane] += u_ahead[lane] * behind[lane] - u_behind[lane] * ahead[lane];
            }
        }
    }
}

/// Coefficient k + 1 of ω, `step` being unit/(k + 1).
#[inline(always)]
fn spun<const ROWS: usize>(
    law: &Turning,
    k: usize,
    order: &Order<ROWS>,
    sums: &Sums,
    extra: [f64; 4],
    step: f64,
) -> [f64; 4] {
    let mut torque = extra;
    if k == 0 {
        for lane in 0..4 {
            torque[lane] += law.constant[lane];
        }
    }
    for (d, map) in law.maps.iter().enumerate().take(directions::<ROWS>()) {
        let [x, y, z] = direction(order, d);
        for lane in 0..4 {
            torque[lane] += map[0][lane] * x + map[1][lane] * y + map[2][lane] * z;
        }
    }
    let mut next = [0.0; 4];
    for lane in 0..4 {
        let turning = law.spread[lane] * sums.products[lane]
            + (torque[lane] - law.drag[lane] * order[OMEGA].0[lane]);
        next[lane] = (turning * law.inverse[lane] + turning * law.rest[lane]) * step;
    }
    next
}
