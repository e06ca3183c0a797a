//! The state of bodies: what a method advances.

use super::lanes::{QuaternionLanes, Vector3Lanes};
use nalgebra::{Quaternion, Vector3, Vector4};

const NO_VECTOR: Vector3<f64> = Vector3::new(f64::NAN, f64::NAN, f64::NAN);

/// The state of one body.
///
/// The *reference point* is the centre of mass of a free body and the pivot of a held one: the
/// point about which torque and inertia are taken. The attitude is that of the *principal axes*
/// through that point, in which the inertia tensor is diagonal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Reference point, world, m.
    pub x_w: Vector3<f64>,
    /// Velocity of the reference point, world, m/s.
    pub v_w: Vector3<f64>,
    /// Attitude, principal axes → world, unit.
    pub q_wp: Quaternion<f64>,
    /// Angular velocity, world, rad/s.
    pub omega_w: Vector3<f64>,
}

impl State {
    /// Of a body that cannot be followed: no number, so that whoever asks can see it.
    pub const NOWHERE: Self = Self {
        x_w: NO_VECTOR,
        v_w: NO_VECTOR,
        q_wp: Quaternion {
            coords: Vector4::new(f64::NAN, f64::NAN, f64::NAN, f64::NAN),
        },
        omega_w: NO_VECTOR,
    };

    /// Takes a vector from principal axes to the world: `v + 2 u × (u × v + w v)`, q = (u, w) unit.
    #[inline(always)]
    pub fn to_world(&self, v_p: Vector3<f64>) -> Vector3<f64> {
        rotate(self.q_wp.imag(), self.q_wp.w, v_p)
    }

    /// Takes a vector from the world to principal axes: the same with the conjugate.
    #[inline(always)]
    pub fn to_principal(&self, v_w: Vector3<f64>) -> Vector3<f64> {
        rotate(-self.q_wp.imag(), self.q_wp.w, v_w)
    }

    /// Mixes every bit of the state into a hash: a word at a time, `h ← (h ⊕ w) k`, `h ← h ⊕ h/2³²`.
    /// Both are one to one, so two states that differ in one word never meet; others do once in
    /// some 2⁶⁴.
    pub fn hash_into(&self, hash: u64) -> u64 {
        /// Odd: 2⁶⁴ over the golden ratio, as Knuth multiplies (TAOCP 6.4).
        const K: u64 = 0x9e37_79b9_7f4a_7c15;
        let vectors = [self.x_w, self.v_w, self.omega_w];
        let words = vectors.iter().flatten().chain(&self.q_wp.coords);
        words.fold(hash, |hash, word| {
            let mixed = (hash ^ word.to_bits()).wrapping_mul(K);
            mixed ^ (mixed >> 32)
        })
    }

    /// True where every component is finite and the attitude is one.
    pub fn is_finite(&self) -> bool {
        let vectors = [self.x_w, self.v_w, self.omega_w];
        vectors.iter().flatten().all(|c| c.is_finite())
            // A length that overflowed leaves zeros, which are finite and no attitude.
            && self.q_wp.norm_squared() > 0.5
            && self.q_wp.coords.iter().all(|c| c.is_finite())
    }
}

#[inline(always)]
fn rotate(u: Vector3<f64>, w: f64, v: Vector3<f64>) -> Vector3<f64> {
    let t = u.cross(&v) * 2.0;
    v + t * w + u.cross(&t)
}

/// The states of eight bodies. Lanes without a body rest at the origin.
#[derive(Clone, Copy, Debug, Default)]
pub struct StateBlock {
    x_w: Vector3Lanes,
    v_w: Vector3Lanes,
    q_wp: QuaternionLanes,
    omega_w: Vector3Lanes,
}

impl StateBlock {
    #[inline(always)]
    pub fn get(&self, lane: usize) -> State {
        State {
            x_w: self.x_w.get(lane),
            v_w: self.v_w.get(lane),
            q_wp: self.q_wp.get(lane),
            omega_w: self.omega_w.get(lane),
        }
    }

    #[inline(always)]
    pub fn set(&mut self, lane: usize, state: State) {
        self.x_w.set(lane, state.x_w);
        self.v_w.set(lane, state.v_w);
        self.q_wp.set(lane, state.q_wp);
        self.omega_w.set(lane, state.omega_w);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_of_a_state_counts_in_its_hash() {
        let state = State {
            x_w: Vector3::new(0.0, -0.5, 3.0),
            v_w: Vector3::new(0.1, 0.0, 7e-30),
            q_wp: Quaternion::new(0.5, -0.5, 0.5, 0.5),
            omega_w: Vector3::new(1.0, -2.0, 0.0),
        };
        let hash = state.hash_into(1);
        let mut seen = std::collections::BTreeSet::from([hash]);
        for word in 0..13 {
            for bit in 0..64 {
                let mut other = state;
                let component = match word {
                    0..3 => &mut other.x_w[word],
                    3..6 => &mut other.v_w[word - 3],
                    6..9 => &mut other.omega_w[word - 6],
                    _ => &mut other.q_wp.coords[word - 9],
                };
                *component = f64::from_bits(component.to_bits() ^ (1 << bit));
                assert!(seen.insert(other.hash_into(1)), "word {word}, bit {bit}");
            }
        }
        // What came before counts too.
        assert!(seen.insert(state.hash_into(2)));
    }
}
