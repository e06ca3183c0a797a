//! What kernels that go body by body share: the occupied lanes of a block, one after the other, and
//! the rates of change there.

use super::Interval;
use super::common::{Acceleration, Applied, Coasting, Forces, RateBlock, rate, with_forces};
use crate::body::{Inertial, State, StateBlock};
use crate::effect::WrenchBlock;
use nalgebra::Vector3;

/// The block of what `f` says of each body.
pub fn each(interval: &Interval, mut f: impl FnMut(usize) -> State) -> StateBlock {
    let mut block = StateBlock::default();
    for lane in interval.lanes() {
        block.set(lane, f(lane));
    }
    block
}

/// `y' = f(t, y)` of each body, without damping.
pub fn rates(t: f64, interval: &Interval, y: &StateBlock) -> RateBlock {
    let (load, inertial) = (&interval.load, &interval.inertial);
    let wrench = load.wrench(t, inertial, y);
    with_forces!(load, wrench.as_ref(), |forces| each(interval, |lane| rate(
        lane,
        forces,
        &inertial.get(lane),
        y.get(lane)
    )))
}

/// `m⁻¹ F` and `I_w⁻¹ τ` of what is applied alone, without the gyroscopic term.
pub fn applied(
    wrench: Option<&WrenchBlock>,
    lane: usize,
    body: &Inertial,
    s: &State,
) -> Acceleration {
    match wrench {
        None => Coasting::<false>.acceleration(lane, body, s),
        Some(wrench) => Applied::<false>(wrench).acceleration(lane, body, s),
    }
}

/// The state turned by the rotation vector `v` (world, rad): `q ← exp(v) q`.
pub fn turned(v: Vector3<f64>, s: State) -> State {
    State {
        q_wp: crate::math::exponential(v) * s.q_wp,
        ..s
    }
}

/// The state with `|q| = 1` again. A product of unit quaternions is one but for rounding; a step of
/// Newton's towards `1/|q|` takes that off, so that it does not add up over a million steps.
#[inline(always)]
pub fn kept_unit(s: State) -> State {
    State {
        q_wp: s.q_wp * (1.5 - 0.5 * s.q_wp.norm_squared()),
        ..s
    }
}
