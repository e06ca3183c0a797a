//! What is left of Euler's equation is `-k₁ ω`, `-k₂ |ω| ω`, or `-c I⁻¹ ω` of a torque `-c ω`.

use super::{Cause, Judge};
use crate::diagnose::dynamics::{Dynamics, Explained};
use crate::diagnose::law::{Gyroscopic, Law, fit};

pub(super) const DAMPING: Cause = Cause {
    id: "damping-explicit",
    symptom: "a spin fades though nothing slows it; how fast varies with the tick rate; or it never quite stops",
    test: "what is left of Euler's equation is -k₁ ω (or -k₂ |ω| ω, or -c I⁻¹ ω), the coefficient above eight standard errors",
    does: "ω ← ω (1 - c h) at every step, often by default",
    formula: "ω ← ω e^{-c h}: the same at every rate; and damping that is logged as a torque",
    remedy: "set the damping to zero or apply it exactly; log it as a torque",
    example: "a body that tumbles freely for some seconds",
    judge: Judge::Fitted(judge),
};

fn judge(d: &Dynamics) -> Option<Explained> {
    let linear = d.steps.of_omega(|w| -w);
    let square = d.steps.of_omega(|w| -w * w.norm());
    let inverse = d.inertia.try_inverse()?;
    let torque = d.steps.of_omega(|w| -inverse * w);
    let features = [
        (&linear, "k1", "1/s"),
        (&square, "k2", ""),
        (&torque, "c", "N m s"),
    ];
    let mut best: Option<Explained> = None;
    for law in [Law::RIGHT, Law::RIGHT.gyroscopic(Gyroscopic::Off)] {
        for base in d.staged(law) {
            for (feature, name, unit) in features {
                let fit = fit(
                    &d.steps.measured,
                    &base,
                    Some((feature, [0.0, 1e6])),
                    &d.kept,
                );
                // Windows overlap by half: half as much again as the standard error.
                if fit.coefficient > 8.0 * 1.5 * fit.error
                    && best.as_ref().is_none_or(|b| fit.left < b.fit.left)
                {
                    let (k, error) = (fit.coefficient, fit.error);
                    best = Some(
                        Explained::new(DAMPING.id, fit)
                            .faults(1 + law.faults())
                            .with(name, k, unit)
                            .with("error", error, unit),
                    );
                }
            }
        }
    }
    best
}
