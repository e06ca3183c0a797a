//! What the equations of motion need to know of a body, about its reference point.

use super::lanes::{Lanes, Vector3Lanes};
use super::state::State;
use crate::mass::MassProperties;
use crate::math::symmetric_eigen;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

/// A body's inertia about its reference point, in the principal axes through it.
///
/// Inverses are stored, so that 0 means immovable: a held body has `inv_mass = 0`, an axis that
/// no torque turns has an inverse moment of 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertial {
    /// What the body weighs, kg; 0 where its mass is infinite (gravity does not move it).
    pub mass: f64,
    /// 1/kg; 0 where the reference point is immovable.
    pub inv_mass: f64,
    /// Principal moments about the reference point, kg m²; 0 about an immovable axis, so that
    /// momentum and energy count the axes that can move.
    pub moments: Vector3<f64>,
    /// Inverse principal moments, 1/(kg m²).
    pub inv_moments: Vector3<f64>,
    /// From the reference point to the centre of mass, principal axes, m; 0 for a free body.
    pub centre_p: Vector3<f64>,
}

impl Inertial {
    /// The inertial properties about the centre of mass (`pivot_b` absent) or about a pivot
    /// (body axes, from the centre of mass, m), and the attitude `q_bp` of the principal axes.
    pub fn new(
        properties: &MassProperties,
        pivot_b: Option<Vector3<f64>>,
    ) -> (Self, UnitQuaternion<f64>) {
        let (axes, moments, inv_moments) = principal(properties, pivot_b.unwrap_or_default());
        let q_bp = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
        let mass = properties.mass().unwrap_or(0.0);
        let free = pivot_b.is_none() && mass > 0.0;
        let inertial = Self {
            mass,
            inv_mass: if free { 1.0 / mass } else { 0.0 },
            moments,
            inv_moments,
            centre_p: q_bp.inverse() * -pivot_b.unwrap_or_default(),
        };
        (inertial, q_bp)
    }

    /// `L_w = R I Rᵀ ω_w`, about the reference point, kg m²/s.
    #[inline(always)]
    pub fn momentum_w(&self, state: &State) -> Vector3<f64> {
        let omega_p = state.to_principal(state.omega_w);
        state.to_world(self.moments.component_mul(&omega_p))
    }

    /// `I_w⁻¹ τ_w = R I⁻¹ Rᵀ τ_w`, rad/s²: the factored form, cheaper than building the matrix.
    #[inline(always)]
    pub fn angular_response(&self, state: &State, tau_w: Vector3<f64>) -> Vector3<f64> {
        let tau_p = state.to_principal(tau_w);
        state.to_world(self.inv_moments.component_mul(&tau_p))
    }

    /// `I_w⁻¹ (τ_w - ω × I_w ω)`, rad/s², in principal axes throughout.
    #[inline(always)]
    pub fn gyroscopic_response(&self, state: &State, tau_w: Vector3<f64>) -> Vector3<f64> {
        let tau_p = state.to_principal(tau_w) + self.gyroscopic_p(state);
        state.to_world(self.inv_moments.component_mul(&tau_p))
    }

    /// The same without a torque: `-I_w⁻¹ (ω × I_w ω)`.
    #[inline(always)]
    pub fn gyroscopic_acceleration(&self, state: &State) -> Vector3<f64> {
        state.to_world(self.inv_moments.component_mul(&self.gyroscopic_p(state)))
    }

    #[inline(always)]
    fn gyroscopic_p(&self, state: &State) -> Vector3<f64> {
        self.gyroscopic_torque_p(state.to_principal(state.omega_w))
    }

    /// `-ω × I ω`, all in principal axes, N·m: `((I2 - I3) ω2 ω3, …)`. By the differences of the moments, because
    /// about the axis of a thin rod what is left is divided by a moment far below the two that almost cancel.
    #[inline(always)]
    pub fn gyroscopic_torque_p(&self, omega_p: Vector3<f64>) -> Vector3<f64> {
        let (i, w) = (self.moments, omega_p);
        Vector3::new(
            (i.y - i.z) * (w.y * w.z),
            (i.z - i.x) * (w.z * w.x),
            (i.x - i.y) * (w.x * w.y),
        )
    }
}

/// Principal axes (columns, body coordinates), moments and inverse moments about `pivot_b`.
fn principal(
    properties: &MassProperties,
    pivot_b: Vector3<f64>,
) -> (Matrix3<f64>, Vector3<f64>, Vector3<f64>) {
    let invert = |x: f64| if x == 0.0 { 0.0 } else { 1.0 / x };
    if properties.is_movable_about_every_axis() {
        let (axes, moments) = symmetric_eigen(&properties.inertia_about(pivot_b));
        (axes, moments, moments.map(invert))
    } else {
        let (axes, inverse) = symmetric_eigen(&properties.inverse_inertia_about(pivot_b));
        (axes, inverse.map(invert), inverse)
    }
}

/// The inertial properties of eight bodies. Lanes without a body are immovable.
#[derive(Clone, Copy, Debug, Default)]
pub struct InertialBlock {
    mass: Lanes,
    inv_mass: Lanes,
    moments: Vector3Lanes,
    inv_moments: Vector3Lanes,
    centre_p: Vector3Lanes,
}

impl InertialBlock {
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Inertial {
        Inertial {
            mass: self.mass.0[lane],
            inv_mass: self.inv_mass.0[lane],
            moments: self.moments.get(lane),
            inv_moments: self.inv_moments.get(lane),
            centre_p: self.centre_p.get(lane),
        }
    }

    #[inline(always)]
    pub fn set(&mut self, lane: usize, inertial: Inertial) {
        self.mass.0[lane] = inertial.mass;
        self.inv_mass.0[lane] = inertial.inv_mass;
        self.moments.set(lane, inertial.moments);
        self.inv_moments.set(lane, inertial.inv_moments);
        self.centre_p.set(lane, inertial.centre_p);
    }
}
