//! ```text
//! I = Iᵀ,   λ₁ > 0,   λ₁ + λ₂ ≥ λ₃,   √(λ₃/m) ≤ half the diagonal of the body's box
//! ```

use super::{Cause, Judge};
use crate::diagnose::case::Case;
use crate::diagnose::verdict::{Found, Said};
use crate::math::symmetric_eigen;

pub(super) const NOT_PHYSICAL: Cause = Cause {
    id: "inertia-not-physical",
    symptom: "refused at load; or wild spins about one axis and none about another",
    test: "the mass is positive, the declared tensor is symmetric, its moments are positive, none exceeds the sum of the others, and the radius of gyration is within the body",
    does: "takes an inertia that no arrangement of mass has",
    formula: "I = Σ m (r² 1 - r rᵀ): λ₁ + λ₂ ≥ λ₃ > 0, and λ₃ ≤ m (half the diagonal)²",
    remedy: "take the inertia of the shape and the mass (`torquescope mass`), in kg m²; look for mixed-up units, or a tensor about another point",
    example: "moments (1, 1, 3) kg m²",
    judge: Judge::First(judge),
};

fn judge(case: &Case) -> Said {
    let Some(declared) = &case.logged.declared else {
        return Said::Pass;
    };
    let i = declared.inertia_b;
    let found = |why: String| Found::of(NOT_PHYSICAL.id, why).sure(0.99);
    if !i.iter().all(|x| x.is_finite()) {
        return Said::Fault(found("the inertia is no number".to_owned()));
    }
    let size = i.norm();
    let skew = (i - i.transpose()).norm();
    // Six digits in a file are 1e-6.
    if skew > 1e-5 * size {
        return Said::Fault(found("the tensor is not symmetric".to_owned()).with(
            "asymmetry",
            skew / size,
            "",
        ));
    }
    let (_, values) = symmetric_eigen(&i);
    let mut l = [values.x, values.y, values.z];
    l.sort_by(f64::total_cmp);
    if l[0] <= 0.0 {
        return Said::Fault(
            found("a moment of inertia is not positive".to_owned()).with("moment", l[0], "kg m²"),
        );
    }
    if l[0] + l[1] < l[2] * (1.0 - 1e-6) {
        return Said::Fault(
            found(format!(
                "a moment exceeds the sum of the others: {:.6} > {:.6} + {:.6}",
                l[2], l[0], l[1]
            ))
            .with("excess", l[2] / (l[0] + l[1]), ""),
        );
    }
    if let Some(mass) = declared.mass
        && (mass.is_nan() || mass <= 0.0)
    {
        return Said::Fault(found("the mass is not positive".to_owned()).with("mass", mass, "kg"));
    }
    if let (Some(size), Some(mass)) = (declared.size, declared.mass) {
        // A hundredth for sizes that are rounded.
        let (gyration, half) = ((l[2] / mass).sqrt(), 0.5 * size.norm());
        if gyration > 1.01 * half && half > 0.0 {
            return Said::Fault(
                found(format!(
                    "the radius of gyration, {gyration:.4} m, is beyond the body, {half:.4} m"
                ))
                .with("radius_of_gyration", gyration, "m")
                .with("half_diagonal", half, "m"),
            );
        }
    }
    Said::Pass
}
