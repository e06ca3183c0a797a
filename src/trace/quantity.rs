//! Every number that a trace can hold, with its unit and frame, and how it is computed.

use super::instant::{Sample, Subject};
use crate::mass::tensor;
use nalgebra::{Matrix3, Vector3};

/// How many numbers, and what they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    Scalar,
    /// x, y, z.
    Vector,
    /// x, y, z, w.
    Quaternion,
    /// Three rows of three.
    Matrix,
    /// x, y, z of each push that acts; none where there is none.
    VectorPerPush,
    /// A scalar, none where it is not known.
    ScalarWhereKnown,
}

impl Shape {
    /// What its numbers are called; of each push's. None where it is one number.
    pub fn components(self) -> &'static [&'static str] {
        match self {
            Self::Scalar | Self::ScalarWhereKnown => &[],
            Self::Vector | Self::VectorPerPush => &["x", "y", "z"],
            Self::Quaternion => &["x", "y", "z", "w"],
            Self::Matrix => &["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"],
        }
    }

    /// Its name in lists.
    pub fn describe(self) -> &'static str {
        match self {
            Self::Scalar => "1",
            Self::Vector => "x y z",
            Self::Quaternion => "x y z w",
            Self::Matrix => "3×3, by rows",
            Self::VectorPerPush => "x y z a push",
            Self::ScalarWhereKnown => "1 where known",
        }
    }
}

/// A number, or a few that belong together.
pub struct Quantity {
    /// The component's name in a recording.
    pub name: &'static str,
    pub symbol: &'static str,
    pub unit: &'static str,
    pub frame: &'static str,
    pub shape: Shape,
    /// Appends the numbers of one body at one instant.
    pub write: fn(&Subject, &Sample, &mut Vec<f64>),
}

macro_rules! quantity {
    ($id:ident, $name:literal, $symbol:literal, $unit:literal, $frame:literal, $shape:ident, $write:expr) => {
        pub(super) const $id: Quantity = Quantity {
            name: $name,
            symbol: $symbol,
            unit: $unit,
            frame: $frame,
            shape: Shape::$shape,
            write: $write,
        };
    };
}

quantity!(
    POSITION,
    "position",
    "x",
    "m",
    "world",
    Vector,
    |_, m, out| { vector(m.motion.position_w, out) }
);
quantity!(
    ORIENTATION,
    "orientation",
    "q",
    "1",
    "body→world",
    Quaternion,
    |_, m, out| { out.extend_from_slice(m.motion.q_wb.coords.as_slice()) }
);
quantity!(
    VELOCITY,
    "velocity",
    "v",
    "m/s",
    "world",
    Vector,
    |_, m, out| { vector(m.motion.velocity_w, out) }
);
quantity!(
    VELOCITY_NORM,
    "velocity_norm",
    "|v|",
    "m/s",
    "–",
    Scalar,
    |_, m, out| out.push(m.motion.velocity_w.norm())
);
quantity!(
    OMEGA,
    "angular_velocity",
    "ω",
    "rad/s",
    "world",
    Vector,
    |_, m, out| { vector(m.motion.omega_w, out) }
);
quantity!(
    OMEGA_NORM,
    "angular_velocity_norm",
    "|ω|",
    "rad/s",
    "–",
    Scalar,
    |_, m, out| { out.push(m.motion.omega_w.norm()) }
);
quantity!(
    FORCE,
    "force",
    "F",
    "N",
    "world",
    VectorPerPush,
    |_, m, out| { m.pushes.iter().for_each(|push| vector(push.force_w, out)) }
);
quantity!(
    FORCE_POINT,
    "force_point",
    "p",
    "m",
    "world",
    VectorPerPush,
    |_, m, out| { m.pushes.iter().for_each(|push| vector(push.point_w, out)) }
);
quantity!(
    TORQUE,
    "torque",
    "τ",
    "N·m",
    "world",
    Vector,
    |_, m, out| vector(m.tau_w, out)
);
quantity!(
    TORQUE_NORM,
    "torque_norm",
    "|τ|",
    "N·m",
    "–",
    Scalar,
    |_, m, out| { out.push(m.tau_w.norm()) }
);
quantity!(
    ALPHA,
    "angular_acceleration",
    "α",
    "rad/s²",
    "world",
    Vector,
    |_, m, out| { vector(m.alpha_w, out) }
);
quantity!(
    ALPHA_NORM,
    "angular_acceleration_norm",
    "|α|",
    "rad/s²",
    "–",
    Scalar,
    |_, m, out| { out.push(m.alpha_w.norm()) }
);
quantity!(
    MOMENTUM,
    "angular_momentum",
    "L",
    "kg m²/s",
    "world",
    Vector,
    |s, m, out| { vector(s.momentum_w(&m.motion), out) }
);
quantity!(
    INERTIA,
    "inertia",
    "I",
    "kg m²",
    "world",
    Matrix,
    |s, m, out| { matrix(turned(&s.inertia_b, m), out) }
);
quantity!(
    INVERSE_INERTIA,
    "inverse_inertia",
    "I⁻¹",
    "1/(kg m²)",
    "world",
    Matrix,
    |s, m, out| { matrix(turned(&s.inverse_inertia_b, m), out) }
);
quantity!(
    ENERGY,
    "kinetic_energy",
    "E",
    "J",
    "–",
    Scalar,
    |s, m, out| { out.push(s.energy(&m.motion)) }
);

quantity!(
    ATTITUDE_ERROR,
    "attitude_error",
    "δ",
    "rad",
    "–",
    ScalarWhereKnown,
    |_, m, out| out.extend(m.deviation.attitude)
);
quantity!(
    ENERGY_DRIFT,
    "energy_drift",
    "ΔE/E",
    "1",
    "–",
    ScalarWhereKnown,
    |_, m, out| out.extend(m.deviation.energy)
);
quantity!(
    MOMENTUM_DRIFT,
    "angular_momentum_drift",
    "|ΔL|/|L|",
    "1",
    "–",
    ScalarWhereKnown,
    |_, m, out| out.extend(m.deviation.momentum)
);
quantity!(
    STEP_TIME,
    "step_time",
    "t_step",
    "s",
    "–",
    ScalarWhereKnown,
    |_, m, out| out.extend(m.step_time)
);

/// `R I_b Rᵀ`.
pub(crate) fn turned(tensor_b: &Matrix3<f64>, sample: &Sample) -> Matrix3<f64> {
    let r = sample.motion.q_wb.to_rotation_matrix();
    tensor::turned(tensor_b, r.matrix())
}

fn vector(v: Vector3<f64>, out: &mut Vec<f64>) {
    out.extend_from_slice(v.as_slice());
}

fn matrix(m: Matrix3<f64>, out: &mut Vec<f64>) {
    // nalgebra stores columns; the tensor is symmetric, so rows read the same.
    out.extend_from_slice(m.as_slice());
}
