//! The law is right, and the energy goes where no work takes it (`energy`): by the method.

use super::{Cause, Judge};

pub(super) const GAINED: Cause = Cause {
    id: "energy-gained-by-integrator",
    symptom: "spins up by itself; blows up at long steps",
    test: "the law holds as an explicit step takes it, and E less the work of the torques rises by more than 0.5% and five standard errors",
    does: "takes the gyroscopic term at the beginning of the step (explicit Euler)",
    formula: "explicit Euler: ΔE = +½ h² (Iα)·α a step; right methods keep E to their order",
    remedy: "an implicit or momentum-keeping step, or smaller ones; better, a method of order 2 or more (`torquescope methods`)",
    example: "a body that tumbles freely for some turns",
    judge: Judge::Last,
};

pub(super) const LOST: Cause = Cause {
    id: "energy-lost-by-integrator",
    symptom: "a tumbling body drifts to a spin about its shortest axis; spins fade",
    test: "the law holds as an implicit step takes it, and E less the work of the torques falls by more than 0.5% and five standard errors",
    does: "takes the gyroscopic term at the end of the step (implicit Euler)",
    formula: "implicit Euler: ΔE = -½ h² (Iα)·α a step; right methods keep E to their order",
    remedy: "smaller steps, or a method of order 2 or more (`torquescope methods`)",
    example: "a body that tumbles freely for some turns",
    judge: Judge::Last,
};
