//! Eight bodies side by side.
//!
//! Every component of the state is an array of eight, so that a scalar kernel written with
//! nalgebra types and called in `for lane in 0..LANES` compiles to full-width vector code.
//! The same source serves one body and ten thousand, with the same bits.

use nalgebra::{Quaternion, Vector3};

/// Bodies in a block.
pub const LANES: usize = 8;

/// Some of the eight lanes of a block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LaneSet(u8);

impl LaneSet {
    pub const ALL: Self = Self(u8::MAX);

    pub fn one(lane: usize) -> Self {
        Self(1 << lane)
    }

    #[inline(always)]
    pub fn holds(self, lane: usize) -> bool {
        self.0 >> lane & 1 == 1
    }

    /// The lanes, in order.
    pub fn iter(self) -> impl Iterator<Item = usize> {
        (0..LANES).filter(move |&lane| self.holds(lane))
    }
}

impl FromIterator<usize> for LaneSet {
    fn from_iter<T: IntoIterator<Item = usize>>(lanes: T) -> Self {
        Self(lanes.into_iter().fold(0, |set, lane| set | 1 << lane))
    }
}

/// One number of each of the eight bodies.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
pub struct Lanes(pub [f64; LANES]);

/// A 3-vector of each of the eight bodies.
#[derive(Clone, Copy, Debug, Default)]
pub struct Vector3Lanes([Lanes; 3]);

impl Vector3Lanes {
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Vector3<f64> {
        let [x, y, z] = &self.0;
        Vector3::new(x.0[lane], y.0[lane], z.0[lane])
    }

    #[inline(always)]
    pub fn set(&mut self, lane: usize, v: Vector3<f64>) {
        let [x, y, z] = &mut self.0;
        x.0[lane] = v.x;
        y.0[lane] = v.y;
        z.0[lane] = v.z;
    }

    #[inline(always)]
    pub fn add(&mut self, lane: usize, v: Vector3<f64>) {
        self.set(lane, self.get(lane) + v);
    }
}

/// A quaternion of each of the eight bodies; identity in lanes never set.
#[derive(Clone, Copy, Debug)]
pub struct QuaternionLanes([Lanes; 4]);

impl Default for QuaternionLanes {
    fn default() -> Self {
        let zero = Lanes::default();
        Self([zero, zero, zero, Lanes([1.0; LANES])])
    }
}

impl QuaternionLanes {
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Quaternion<f64> {
        let [x, y, z, w] = &self.0;
        Quaternion::new(w.0[lane], x.0[lane], y.0[lane], z.0[lane])
    }

    #[inline(always)]
    pub fn set(&mut self, lane: usize, q: Quaternion<f64>) {
        let [x, y, z, w] = &mut self.0;
        x.0[lane] = q.i;
        y.0[lane] = q.j;
        z.0[lane] = q.k;
        w.0[lane] = q.w;
    }
}
