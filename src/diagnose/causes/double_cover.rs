//! q and -q are one attitude. A flip of the sign from row to row is harmless, and named where all else is right; a controller that
//! multiplies by the sign goes the long way round: its torque flips along.

use super::{Cause, Judge};

pub(super) const DOUBLE_COVER: Cause = Cause {
    id: "double-cover",
    symptom: "a plot of q jumps from one sign to the other; or a controller turns 350° instead of 10°",
    test: "the sign of q flips from a row to the next. Nothing is wrong with that (verdict no-fault), unless a logged torque flips with it",
    does: "q and -q are the same attitude; some code keeps w ≥ 0, some goes on smoothly",
    formula: "the error of attitude is 2 sign(w) u",
    remedy: "compare attitudes by |q·p|; multiply a controller's error by the sign of w",
    example: "a recording with w kept positive",
    judge: Judge::Last,
};
