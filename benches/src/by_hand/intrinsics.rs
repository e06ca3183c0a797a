//! The tutorial's step in AVX2 intrinsics: four bodies a register, the operations of the crate's kernel
//! in its order.

use crate::bodies::{Body, H};
use nalgebra::{Quaternion, Vector3};
use std::arch::x86_64::*;
use torquescope::body::{LANES, State};

type Lanes = [f64; LANES];

/// Eight bodies side by side, as the crate has them.
#[derive(Clone, Default)]
#[repr(align(64))]
pub struct Block {
    x: [Lanes; 3],
    v: [Lanes; 3],
    /// x, y, z, w.
    q: [Lanes; 4],
    omega: [Lanes; 3],
    inv_mass: Lanes,
    inv_moments: [Lanes; 3],
    force: [Lanes; 3],
    tau: [Lanes; 3],
}

impl Block {
    pub fn of(bodies: &[Body]) -> Self {
        let mut block = Self::default();
        for (lane, body) in bodies.iter().enumerate() {
            let s = &body.state;
            for k in 0..3 {
                block.x[k][lane] = s.x_w[k];
                block.v[k][lane] = s.v_w[k];
                block.omega[k][lane] = s.omega_w[k];
                block.inv_moments[k][lane] = body.inertial.inv_moments[k];
                block.tau[k][lane] = body.tau_w[k];
            }
            for k in 0..4 {
                block.q[k][lane] = s.q_wp.coords[k];
            }
            block.inv_mass[lane] = body.inertial.inv_mass;
        }
        block
    }

    pub fn state(&self, lane: usize) -> State {
        let vector = |v: &[Lanes; 3]| Vector3::new(v[0][lane], v[1][lane], v[2][lane]);
        let [x, y, z, w] = self.q.map(|c| c[lane]);
        State {
            x_w: vector(&self.x),
            v_w: vector(&self.v),
            q_wp: Quaternion::new(w, x, y, z),
            omega_w: vector(&self.omega),
        }
    }
}

pub fn available() -> bool {
    is_x86_feature_detected!("avx2")
}

/// `n` steps of a block.
///
/// # Safety
/// The processor must have AVX2.
#[target_feature(enable = "avx2")]
pub unsafe fn steps(n: usize, block: &mut Block) {
    for _ in 0..n {
        for half in [0, 4] {
            // SAFETY: 0 and 4 leave room for four lanes in a row of eight, and rows are aligned.
            unsafe { step(half, block) };
        }
    }
}

type Vector = [__m256d; 3];

#[inline]
#[target_feature(enable = "avx2")]
unsafe fn load<const N: usize>(rows: &[Lanes; N], at: usize) -> [__m256d; N] {
    std::array::from_fn(|k| unsafe { _mm256_load_pd(rows[k].as_ptr().add(at)) })
}

#[inline]
#[target_feature(enable = "avx2")]
unsafe fn store<const N: usize>(rows: &mut [Lanes; N], at: usize, from: [__m256d; N]) {
    for (row, lanes) in rows.iter_mut().zip(from) {
        unsafe { _mm256_store_pd(row.as_mut_ptr().add(at), lanes) };
    }
}

#[inline]
#[target_feature(enable = "avx2")]
fn cross(a: Vector, b: Vector) -> Vector {
    let part =
        |i: usize, j: usize| _mm256_sub_pd(_mm256_mul_pd(a[i], b[j]), _mm256_mul_pd(a[j], b[i]));
    [part(1, 2), part(2, 0), part(0, 1)]
}

#[inline]
#[target_feature(enable = "avx2")]
fn scaled(a: Vector, s: __m256d) -> Vector {
    a.map(|a| _mm256_mul_pd(a, s))
}

#[inline]
#[target_feature(enable = "avx2")]
fn sum(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|k| _mm256_add_pd(a[k], b[k]))
}

/// `v + 2 u × (u × v + w v)`.
#[inline]
#[target_feature(enable = "avx2")]
fn rotated(u: Vector, w: __m256d, v: Vector) -> Vector {
    let t = cross(u, v);
    let t = sum(t, t);
    sum(sum(v, scaled(t, w)), cross(u, t))
}

#[inline]
#[target_feature(enable = "avx2")]
unsafe fn step(at: usize, b: &mut Block) {
    let h = _mm256_set1_pd(H);
    let q = unsafe { load(&b.q, at) };
    let [x, y, z, w] = q;
    let u = [x, y, z];
    let minus_u = u.map(|c| _mm256_xor_pd(c, _mm256_set1_pd(-0.0)));
    let tau_p = rotated(minus_u, w, unsafe { load(&b.tau, at) });
    let inv_moments: Vector = unsafe { load(&b.inv_moments, at) };
    let alpha_p = std::array::from_fn(|k| _mm256_mul_pd(inv_moments[k], tau_p[k]));
    let alpha = rotated(u, w, alpha_p);
    let omega = sum(unsafe { load(&b.omega, at) }, scaled(alpha, h));

    // ½ (ω, 0) q.
    let [a, b_, c] = scaled(omega, _mm256_set1_pd(0.5));
    let product = |p, q| _mm256_mul_pd(p, q);
    let add = |p, q| _mm256_add_pd(p, q);
    let sub = |p, q| _mm256_sub_pd(p, q);
    let rate = [
        sub(add(product(a, w), product(b_, z)), product(c, y)),
        add(sub(product(b_, w), product(a, z)), product(c, x)),
        add(sub(product(a, y), product(b_, x)), product(c, w)),
        sub(
            sub(
                _mm256_xor_pd(product(a, x), _mm256_set1_pd(-0.0)),
                product(b_, y),
            ),
            product(c, z),
        ),
    ];
    let q: [__m256d; 4] = std::array::from_fn(|k| add(q[k], product(rate[k], h)));
    // Summed as nalgebra sums four.
    let square = q.map(|c| product(c, c));
    let square = add(add(square[0], square[2]), add(square[1], square[3]));
    let inverse = _mm256_div_pd(_mm256_set1_pd(1.0), _mm256_sqrt_pd(square));

    let inv_mass = unsafe { load(std::array::from_ref(&b.inv_mass), at)[0] };
    let a_w = scaled(unsafe { load(&b.force, at) }, inv_mass);
    let v = sum(unsafe { load(&b.v, at) }, scaled(a_w, h));
    let x = sum(unsafe { load(&b.x, at) }, scaled(v, h));
    unsafe {
        store(&mut b.x, at, x);
        store(&mut b.v, at, v);
        store(&mut b.q, at, q.map(|c| product(c, inverse)));
        store(&mut b.omega, at, omega);
    }
}

/// So many multiplications and nothing else, as fast as the processor can: in ten chains, which hide
/// what one takes to end.
///
/// # Safety
/// The processor must have AVX2.
#[target_feature(enable = "avx2")]
pub unsafe fn multiplications(n: usize) {
    let by = std::hint::black_box(_mm256_set1_pd(1.0));
    let [mut a, mut b, mut c, mut d, mut e] = [by; 5];
    let [mut f, mut g, mut h, mut i, mut j] = [by; 5];
    for _ in 0..n / (4 * 10) {
        a = _mm256_mul_pd(a, by);
        b = _mm256_mul_pd(b, by);
        c = _mm256_mul_pd(c, by);
        d = _mm256_mul_pd(d, by);
        e = _mm256_mul_pd(e, by);
        f = _mm256_mul_pd(f, by);
        g = _mm256_mul_pd(g, by);
        h = _mm256_mul_pd(h, by);
        i = _mm256_mul_pd(i, by);
        j = _mm256_mul_pd(j, by);
    }
    std::hint::black_box([a, b, c, d, e, f, g, h, i, j]);
}
