//! The law is right, the tensor is not the one declared. Signs of products are laws to try; the rest is the inertia that the motion
//! obeys (`inertia`), and what J - I looks like.

use super::{Cause, Judge};
use crate::diagnose::dynamics::{Dynamics, Explained};
use crate::diagnose::inertia::{about_another_point, effective};
use crate::diagnose::law::{Gyroscopic, Inertia, Law, fit};
use crate::diagnose::verdict::Evidence;

pub(super) const PRODUCTS_SIGN: Cause = Cause {
    id: "products-of-inertia-sign",
    symptom: "subtle: a body with a skew shape wobbles about other axes than it should",
    test: "ω obeys Euler's equation with the off-diagonal entries negated",
    does: "takes products ∫xy dm for entries of the tensor, which are -∫xy dm (or the other way)",
    formula: "I_xy = -∫ x y dm",
    remedy: "negate the products; some CAD tools print them positive",
    example: "a body with products of inertia that tumbles",
    judge: Judge::Laws(&[Law::RIGHT.inertia(Inertia::Negated)]),
};

pub(super) const PRODUCTS_DROPPED: Cause = Cause {
    id: "products-of-inertia-dropped",
    symptom: "subtle: a body with a skew shape turns as if it were a box",
    test: "ω obeys Euler's equation with the off-diagonal entries zero",
    does: "keeps the diagonal of the tensor only",
    formula: "all six entries, or the principal moments with their axes",
    remedy: "diagonalise and keep the axes' rotation, or keep the whole tensor",
    example: "a body with products of inertia that tumbles",
    judge: Judge::Laws(&[Law::RIGHT.inertia(Inertia::Dropped)]),
};

pub(super) const SCALE: Cause = Cause {
    id: "inertia-scale",
    symptom: "far too fast, or sluggish",
    test: "torques act as on an inertia c I with one number c; forces accelerate the body as they should",
    does: "has the inertia in other units (g cm², mm), or of another mass",
    formula: "I in kg m²: 1 g cm² = 1e-7 kg m², 1 kg mm² = 1e-6 kg m²",
    remedy: "convert; scale the inertia with the mass",
    example: "a body under a torque",
    judge: Judge::Fitted(scale),
};

pub(super) const WRONG_POINT: Cause = Cause {
    id: "inertia-about-wrong-point",
    symptom: "subtle: sluggish, and wobbling about other axes than it should",
    test: "the inertia that the motion obeys is I + m (d² 1 - d dᵀ): J - I has the eigenvalues {0, md², md²}",
    does: "uses an inertia about a corner, a joint or the origin, and not about the centre of mass",
    formula: "I_c = I_p - m (d² 1 - d dᵀ)",
    remedy: "move the tensor to the centre of mass by the parallel axis theorem",
    example: "a tumbling body, best under a torque",
    judge: Judge::Fitted(wrong_point),
};

/// α = α_g + s α_τ, s = 1/c: the gyroscopic term does not depend on c.
fn scale(d: &Dynamics) -> Option<Explained> {
    d.torque_alone()?;
    let without = d.staged(Law::RIGHT.gyroscopic(Gyroscopic::Off));
    let with = d.staged(Law::RIGHT);
    let mut best: Option<Explained> = None;
    for (torque, whole) in without.iter().zip(&with) {
        let gyroscopic: Vec<_> = whole.iter().zip(torque).map(|(w, t)| w - t).collect();
        for (base, faults) in [(gyroscopic, 1), (d.nothing(), 2)] {
            let fit = fit(
                &d.steps.measured,
                &base,
                Some((torque, [1e-12, 1e12])),
                &d.kept,
            );
            let s = fit.coefficient;
            if s <= 0.0 || fit.error > 0.02 * s {
                continue;
            }
            if best.as_ref().is_none_or(|b| fit.left < b.fit.left) {
                best = Some(Explained::new(SCALE.id, fit).faults(faults).with(
                    "inertia_scale",
                    1.0 / s,
                    "",
                ));
            }
        }
    }
    let mut found = best?;
    let c = found.evidence[0].value;
    // A part of the force's life and a scaled inertia are one and the same from torque alone.
    let part = 1.0 / c;
    let n = c.round();
    let like_sub_steps = (2.0..=64.0).contains(&n) && (c / n - 1.0).abs() < 0.02;
    let late = (part - 2.0).abs() < 0.02;
    match d.linear_part() {
        Some((s, error)) => {
            found.evidence.push(Evidence {
                name: "part_of_force",
                value: s,
                unit: "",
            });
            if error < 0.05
                && (s - part).abs() < 0.1 * part.min(1.0) + 3.0 * error
                && (s - 1.0).abs() > 0.1
            {
                found.causes = vec![super::lifetime::LIFETIME.id];
            } else if !(error < 0.05 && (s - 1.0).abs() < 0.1) && (like_sub_steps || late) {
                found.causes.push(super::lifetime::LIFETIME.id);
            }
        }
        None if like_sub_steps || late => found.causes.push(super::lifetime::LIFETIME.id),
        None => {}
    }
    Some(found)
}

fn wrong_point(d: &Dynamics) -> Option<Explained> {
    // About a joint it is the inertia about the joint that is right.
    if d.case.turns_elsewhere().is_some() {
        return None;
    }
    let found = effective(&d.steps, &d.tau_b(), &d.inertia, &d.kept)?;
    let (md2, off, j) = about_another_point(&found, &d.inertia)?;
    // J is good to 0.0002 of the trace in clean data, 0.003 in noisy ones (ten times that for what is derived from it).
    if md2 < 0.02 * d.inertia.trace() || off > if d.steps.noisy { 0.25 } else { 0.1 } {
        return None;
    }
    let fit = d.fit(Law::RIGHT.inertia(Inertia::Given(j)))?;
    // Six numbers were fitted: a law that fits as well without any is plainer.
    let mut found = Explained::new(WRONG_POINT.id, fit)
        .faults(2)
        .with("m_d2", md2, "kg m²")
        .with("off_parallel_axis", off, "");
    if let Some(mass) = d.mass {
        found = found.with("distance", (md2 / mass).sqrt(), "m");
    }
    Some(found)
}
