//! Whether a rigid body can have what is written, and whether the one meant has it.

use super::Inertial;
use crate::mass::tensor::check_physical;
use crate::mass::{MassProperties, UnphysicalMass};
use crate::math::symmetric_eigen;
use nalgebra::{Matrix3, Vector3};

/// An inertia this many times that of a uniform box of the same size and mass, or as many times less, is
/// in other units: grams make it a thousand times, and what is solid has at least 0.6 of its box (a ball).
const IMPLAUSIBLE: f64 = 400.0;

/// What there is to say of an inertial.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// Principal moments, ascending, kg m²; not where the tensor is beyond what an f64 computes with.
    pub moments: Vec<f64>,
    /// Why no rigid body has it; empty where one can.
    pub impossible: Vec<String>,
    /// Why it is hardly meant, where the size of the body is known.
    pub implausible: Option<String>,
    /// Largest moment over that of a uniform box of the body's size and mass, where that is known.
    pub beside_box: Option<f64>,
}

impl Verdict {
    /// Of an inertial, and of the full extents (m) of the box about the body where they are known.
    pub fn of(inertial: &Inertial, extents: Option<Vector3<f64>>) -> Self {
        let mut impossible = Vec::new();
        // Each by itself: a mass that will do beside the tensor, a tensor that will do beside the mass.
        if let Err(UnphysicalMass::Mass(mass)) =
            MassProperties::new(inertial.mass, Matrix3::identity(), [false; 3])
        {
            impossible.push(match mass <= 0.0 {
                true => format!("a mass of {mass} kg is not above zero"),
                false => UnphysicalMass::Mass(mass).to_string(),
            });
        }
        if let Err(why) = check_physical(&inertial.tensor) {
            impossible.push(why.to_string());
        }
        let (_, moments) = symmetric_eigen(&inertial.tensor);
        let mut moments: Vec<f64> = moments.iter().copied().collect();
        moments.sort_by(f64::total_cmp);
        moments.retain(|x| x.is_finite());
        let beside_box = match impossible.is_empty() {
            true => extents.and_then(|size| beside_box(inertial.mass, *moments.last()?, size)),
            false => None,
        };
        Self {
            implausible: beside_box.and_then(|ratio| implausible(ratio, extents?)),
            moments,
            impossible,
            beside_box,
        }
    }

    /// In a word: "possible", "implausible" or "impossible".
    pub fn word(&self) -> &'static str {
        match (self.impossible.is_empty(), &self.implausible) {
            (false, _) => "impossible",
            (true, Some(_)) => "implausible",
            (true, None) => "possible",
        }
    }

    /// Why it is not simply possible; empty where it is.
    pub fn why(&self) -> String {
        match &self.implausible {
            Some(why) if self.impossible.is_empty() => why.clone(),
            _ => self.impossible.join("; and "),
        }
    }
}

/// `m/12 (a² + b²)` of the two longer edges is the largest moment of a uniform box.
fn beside_box(mass: f64, largest: f64, size: Vector3<f64>) -> Option<f64> {
    let shortest = size.min();
    let of_box = mass / 12.0 * (size.norm_squared() - shortest * shortest);
    let ratio = largest / of_box;
    (of_box > 0.0 && ratio.is_finite() && ratio > 0.0).then_some(ratio)
}

fn implausible(ratio: f64, size: Vector3<f64>) -> Option<String> {
    let (times, way, units) = if ratio > IMPLAUSIBLE {
        let units = match ratio {
            r if r > 3e7 => "g mm² in place of kg m²?",
            r if r > 3e4 => "kg mm² in place of kg m²?",
            _ => "g m² in place of kg m², or a mass in tonnes?",
        };
        (ratio, "more", units)
    } else if ratio < 1.0 / IMPLAUSIBLE {
        let units = "a size in mm, or a mass in g?";
        (1.0 / ratio, "less", units)
    } else {
        return None;
    };
    // Four digits say which size is meant.
    let digits = |x: f64| format!("{x:.3e}").parse().unwrap_or(x);
    let [x, y, z]: [f64; 3] = size.map(digits).into();
    Some(format!(
        "its largest moment is {times:.1e} times {way} than that of a uniform box of its size ({x} × {y} × {z} m) and mass: {units}"
    ))
}
