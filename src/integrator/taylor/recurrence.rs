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

use super::four::Four;
use super::law::Turning;
use multiversion::multiversion;
use nalgebra::Vector3;

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
pub fn set_attitude<const ROWS: usize>(order: &mut Order<ROWS>, q: Four) {
    // A sign as a product, so that all four stay together.
    const SIGN: Four = Four([1.0, 1.0, 1.0, -1.0]);
    let [x, y, z, w] = q.0;
    order[Q] = q;
    order[Q_W] = Four([w, w, w, x]) * SIGN;
    order[Q_AHEAD] = Four([y, z, x, y]) * SIGN;
    order[Q_BEHIND] = Four([z, x, y, z]);
}

#[inline(always)]
pub fn set_spin<const ROWS: usize>(order: &mut Order<ROWS>, omega: Four) {
    let [p, q, r, _] = omega.0;
    order[OMEGA] = omega;
    order[PLAIN] = Four([p, q, r, p]);
    order[AHEAD] = Four([q, r, p, r]);
    order[BEHIND] = Four([r, p, q, q]);
}

#[inline(always)]
pub fn set_direction<const ROWS: usize>(order: &mut Order<ROWS>, d: usize, u: Four) {
    let [x, y, z, none] = u.0;
    let rows = &mut order[rows(d)..];
    rows[0] = u;
    rows[U_AHEAD] = Four([y, z, x, none]);
    rows[U_BEHIND] = Four([z, x, y, none]);
}

/// u_d.
#[inline(always)]
pub fn direction<const ROWS: usize>(order: &Order<ROWS>, d: usize) -> Vector3<f64> {
    order[rows(d)].vector()
}

/// Torque that is not linear in the directions.
pub trait Levers<const ROWS: usize> {
    /// Its coefficient `k`, orders 0 to k being known: principal axes, N·m.
    fn torque(&mut self, k: usize, orders: &[Order<ROWS>]) -> Four;
}

/// There is none.
pub struct NoLevers;

impl<const ROWS: usize> Levers<ROWS> for NoLevers {
    #[inline(always)]
    fn torque(&mut self, _: usize, _: &[Order<ROWS>]) -> Four {
        Four::default()
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
        set_attitude(next, sums.q * (0.5 * step));
        for d in 0..directions::<ROWS>() {
            set_direction(next, d, sums.u[d] * step);
        }
    }
}

const fn directions<const ROWS: usize>() -> usize {
    (ROWS - DIRECTIONS) / ROWS_OF_U
}

/// Coefficient k of 2 q', of `ω_j ω_k`, and of u'.
#[derive(Default)]
struct Sums {
    q: Four,
    products: Four,
    u: [Four; 3],
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
        let [plain, ahead, behind] = [spin[PLAIN], spin[AHEAD], spin[BEHIND]];
        self.q += order[Q_W] * plain + (order[Q_AHEAD] * behind - order[Q_BEHIND] * ahead);
        self.products += order[BEHIND] * ahead;
        for (d, u) in self.u.iter_mut().enumerate().take(directions::<ROWS>()) {
            *u += order[rows(d) + U_AHEAD] * behind - order[rows(d) + U_BEHIND] * ahead;
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
    extra: Four,
    step: f64,
) -> Four {
    let mut torque = if k == 0 { law.constant + extra } else { extra };
    for (d, map) in law.maps.iter().enumerate().take(directions::<ROWS>()) {
        let [x, y, z, _] = order[rows(d)].0;
        torque += map[0] * x + map[1] * y + map[2] * z;
    }
    let turning = law.spread * sums.products + torque;
    // The decay is of ω itself: of an axis that no torque turns as well.
    ((turning * law.inverse + turning * law.rest) - law.drag * order[OMEGA]) * step
}
