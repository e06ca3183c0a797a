//! Mass, and inertia about the centre of mass, of one rigid body.

use super::tensor::{self, Unphysical};
use nalgebra::{Matrix3, Vector3};

/// Why mass properties belong to no rigid body.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum UnphysicalMass {
    #[error("a mass of {0:e} kg is not above zero, finite and within 1e-150 to 1e150")]
    Mass(f64),
    #[error(transparent)]
    Inertia(#[from] Unphysical),
}

/// Mass properties that a rigid body can have, checked when made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// kg; `None` is infinite: nothing moves the body or turns it.
    mass: Option<f64>,
    /// About the centre of mass, body axes, kg m².
    inertia_c: Matrix3<f64>,
    /// Body axes about which no torque turns it.
    immovable: [bool; 3],
}

impl MassProperties {
    /// A body of finite mass (kg), its inertia (kg m²) about the centre of mass in body axes.
    pub fn new(
        mass: f64,
        inertia_c: Matrix3<f64>,
        immovable: [bool; 3],
    ) -> Result<Self, UnphysicalMass> {
        if !(1e-150..=1e150).contains(&mass) {
            return Err(UnphysicalMass::Mass(mass));
        }
        tensor::check_held(&inertia_c, immovable)?;
        Ok(Self {
            mass: Some(mass),
            inertia_c,
            immovable,
        })
    }

    /// A body that no force moves and no torque turns.
    pub fn infinite() -> Self {
        Self {
            mass: None,
            inertia_c: Matrix3::zeros(),
            immovable: [true; 3],
        }
    }

    /// Whether the body can be held at a point (body axes, from the centre of mass, m): its inertia
    /// about it must stay within what an f64 computes with.
    pub fn check_about(&self, point_b: Vector3<f64>) -> Result<(), Unphysical> {
        match self.mass {
            Some(_) => tensor::check_held(&self.inertia_about(point_b), self.immovable),
            None => Ok(()),
        }
    }

    /// kg; `None` is infinite.
    pub fn mass(&self) -> Option<f64> {
        self.mass
    }

    /// The body axes about which nothing turns it.
    pub fn immovable(&self) -> [bool; 3] {
        self.immovable
    }

    pub fn is_movable_about_every_axis(&self) -> bool {
        self.immovable == [false; 3]
    }

    /// The tensor about a point (body axes, from the centre of mass, m), kg m²: that of the mass
    /// alone, as if no axis were held.
    pub fn inertia_about(&self, point_b: Vector3<f64>) -> Matrix3<f64> {
        tensor::parallel_axis(&self.inertia_c, self.mass.unwrap_or(0.0), point_b)
    }

    /// The inverse tensor about a point, 1/(kg m²), with zeros for immovable axes.
    pub fn inverse_inertia_about(&self, point_b: Vector3<f64>) -> Matrix3<f64> {
        tensor::inverse_with_immovable(&self.inertia_about(point_b), self.immovable)
    }
}
