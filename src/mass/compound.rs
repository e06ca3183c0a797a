//! Several solids as one rigid body, each with a mass of its own.
//!
//! With masses m_k, centres of mass c_k, attitudes R_k and tensors I_k about them,
//!
//! ```text
//! m = Σ m_k        c = Σ m_k c_k / m
//! I = Σ [ R_k I_k R_kᵀ + m_k (|d_k|² 1 - d_k d_kᵀ) ]        d_k = c_k - c
//! ```
//!
//! What two parts share counts twice.

use super::ray::{Hit, Ray, nearest};
use super::solids::{NamedPoint, Placed, Solid, Surface};
use super::tensor::{parallel_axis, turned};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use std::sync::Arc;

/// A solid in its place.
#[derive(Clone, Debug)]
pub struct Part {
    /// Opens the names of its points: `handle` has a `handle.top`.
    pub name: Option<String>,
    pub solid: Arc<dyn Solid>,
    /// kg; or, of every part alike, what its mass is in proportion to.
    pub mass: f64,
    /// Of its origin, in the compound's axes from the compound's origin, m.
    pub position: Vector3<f64>,
    /// Its axes → the compound's.
    pub orientation: UnitQuaternion<f64>,
}

impl Part {
    fn place(&self, point: Vector3<f64>) -> Vector3<f64> {
        self.position + self.orientation * point
    }
}

/// The parts together.
#[derive(Debug)]
pub struct Compound {
    parts: Vec<Part>,
    /// kg, where the parts have masses and not only proportions.
    mass: Option<f64>,
    centre: Vector3<f64>,
    /// About the centre, of a compound of 1 kg, m².
    unit_inertia: Matrix3<f64>,
}

impl Compound {
    /// Of parts with masses in kg.
    pub fn of_masses(parts: Vec<Part>) -> Self {
        let mass = parts.iter().map(|part| part.mass).sum();
        Self {
            mass: Some(mass),
            ..Self::in_proportion(parts)
        }
    }

    /// Of parts whose masses say only how they compare: what it weighs is not known.
    pub fn in_proportion(parts: Vec<Part>) -> Self {
        let whole: f64 = parts.iter().map(|part| part.mass).sum();
        let weighed = || parts.iter().map(|part| (part, part.mass / whole));
        let centre = weighed()
            .map(|(part, share)| part.place(part.solid.centre()) * share)
            .sum();
        let about_centre = |(part, share): (&Part, f64)| {
            let axes = part.orientation.to_rotation_matrix();
            let own = turned(&part.solid.inertia(share), axes.matrix());
            parallel_axis(&own, share, part.place(part.solid.centre()) - centre)
        };
        Self {
            unit_inertia: weighed().map(about_centre).sum(),
            mass: None,
            centre,
            parts,
        }
    }
}

impl Solid for Compound {
    fn moments(&self, mass: f64) -> Vector3<f64> {
        self.inertia(mass).diagonal()
    }

    fn inertia(&self, mass: f64) -> Matrix3<f64> {
        self.unit_inertia * mass
    }

    /// The parts' volumes added up.
    fn volume(&self) -> Option<f64> {
        self.parts.iter().map(|part| part.solid.volume()).sum()
    }

    fn own_mass(&self) -> Option<f64> {
        self.mass
    }

    fn contains(&self, point: Vector3<f64>) -> bool {
        let within = |part: &Part| {
            let from_origin = point - part.position;
            let point = part.orientation.inverse_transform_vector(&from_origin);
            part.solid.contains(point)
        };
        self.parts.iter().any(within)
    }

    fn centre(&self) -> Vector3<f64> {
        self.centre
    }

    /// `centre`, and those of the parts that have a name.
    fn points(&self) -> Vec<NamedPoint> {
        let mut points: Vec<NamedPoint> = vec![("centre".into(), self.centre)];
        for part in &self.parts {
            if let Some(name) = &part.name {
                let own = part.solid.points().into_iter();
                points
                    .extend(own.map(|(own, at)| (format!("{name}.{own}").into(), part.place(at))));
            }
        }
        points
    }

    fn ray(&self, ray: &Ray) -> Option<Hit> {
        let meets = |part: &Part| {
            ray.meets_placed(part.position, part.orientation, |ray| part.solid.ray(ray))
        };
        nearest(self.parts.iter().filter_map(meets))
    }

    fn surface(&self) -> Surface {
        let placed = |part: &Part| Placed {
            surface: part.solid.surface(),
            position: part.position,
            orientation: part.orientation,
        };
        Surface::Parts(self.parts.iter().map(placed).collect())
    }
}
