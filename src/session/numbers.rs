//! A body's numbers at an instant, for a table beside its picture.

use crate::sim::Run;
use crate::trace::{Instant, Sample};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use serde_json::{Value, json};

/// All that is known of a body at an instant; world axes, SI, radians.
#[derive(Clone, Debug, PartialEq)]
pub struct Numbers {
    pub body: String,
    pub at: Instant,
    /// What torque, momentum and inertia are about.
    pub about: &'static str,
    /// By which it is stepped.
    pub method: &'static str,
    pub sample: Sample,
    /// Roll, pitch and yaw: `R = Rz(yaw) Ry(pitch) Rx(roll)`, rad.
    pub euler: [f64; 3],
    /// kg m²/s.
    pub momentum_w: Vector3<f64>,
    /// kg m².
    pub inertia_w: Matrix3<f64>,
    /// Kinetic, J.
    pub energy: f64,
    /// What turns it, by name, N·m: what is applied, and the model's own terms.
    pub torques_w: Vec<(String, Vector3<f64>)>,
}

/// How the three angles make the attitude.
pub const EULER: &str = "R = Rz(yaw) Ry(pitch) Rx(roll), body to world, rad";

impl Numbers {
    pub(super) fn of(run: &Run, body: usize, sample: Sample) -> Self {
        let subject = &run.subjects()[body];
        let motion = &sample.motion;
        let r = motion.q_wb.to_rotation_matrix();
        Self {
            body: subject.name.clone(),
            at: run.now(),
            about: subject.reference(),
            method: run.method_of(body),
            euler: euler(motion.q_wb),
            momentum_w: subject.momentum_w(motion),
            inertia_w: r.matrix() * subject.inertia_b * r.matrix().transpose(),
            energy: subject.energy(motion),
            torques_w: run.torques(body),
            sample,
        }
    }

    pub fn json(&self) -> Value {
        let (sample, motion) = (&self.sample, &self.sample.motion);
        let [roll, pitch, yaw] = self.euler;
        let torques = self.torques_w.iter();
        let torques: serde_json::Map<String, Value> = torques
            .map(|(name, torque)| (name.clone(), vector(*torque)))
            .collect();
        let rows = self.inertia_w.row_iter();
        let rows: Vec<Vec<f64>> = rows.map(|row| row.iter().copied().collect()).collect();
        json!({
            "body": self.body,
            "about": self.about,
            "method": self.method,
            "position": vector(motion.position_w),
            "velocity": vector(motion.velocity_w),
            "orientation": motion.q_wb.coords.as_slice(),
            "euler": { "roll": roll, "pitch": pitch, "yaw": yaw, "convention": EULER },
            "angular_velocity": vector(motion.omega_w),
            "angular_momentum": vector(self.momentum_w),
            "torque": vector(sample.tau_w),
            "torque_by_source": torques,
            "angular_acceleration": vector(sample.alpha_w),
            "inertia": rows,
            "kinetic_energy": self.energy,
            "attitude_error": sample.deviation.attitude,
            "energy_drift": sample.deviation.energy,
            "angular_momentum_drift": sample.deviation.momentum,
        })
    }
}

pub(super) fn vector(v: Vector3<f64>) -> Value {
    json!([v.x, v.y, v.z])
}

/// Roll, pitch, yaw. Where the pitch is a right angle only yaw - roll (or yaw + roll) is known: the roll is 0 there.
fn euler(q: UnitQuaternion<f64>) -> [f64; 3] {
    let r = q.to_rotation_matrix();
    let r = r.matrix();
    let sine = (-r[(2, 0)]).clamp(-1.0, 1.0);
    // By both legs, because near a right angle the sine alone loses half the digits.
    let cosine = (r[(0, 0)] * r[(0, 0)] + r[(1, 0)] * r[(1, 0)]).sqrt();
    let pitch = libm::atan2(sine, cosine);
    // A few roundings of a rotation matrix: below that it says nothing.
    if cosine <= 8.0 * f64::EPSILON {
        return [0.0, pitch, libm::atan2(-r[(0, 1)], r[(1, 1)])];
    }
    let roll = libm::atan2(r[(2, 1)], r[(2, 2)]);
    [roll, pitch, libm::atan2(r[(1, 0)], r[(0, 0)])]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_angles_make_the_attitude() {
        let turn = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
        let (x, y, z) = (Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis());
        let right = std::f64::consts::FRAC_PI_2;
        for [roll, pitch, yaw] in [
            [0.0, 0.0, 0.0],
            [0.3, -0.7, 2.9],
            [-3.0, 1.5, -0.1],
            [0.4, right, 1.0],
            [0.4, -right, 1.0],
            [0.4, right - 1e-9, 1.0],
        ] {
            let q = turn(z, yaw) * turn(y, pitch) * turn(x, roll);
            let [a, b, c] = euler(q);
            let again = turn(z, c) * turn(y, b) * turn(x, a);
            // Some roundings; at 1e-9 from a right angle roll and yaw are known to 1e-7, their sum to rounding.
            let off = q.angle_to(&again);
            assert!(off < 1e-7, "{roll} {pitch} {yaw}: {off}");
            if pitch.abs() < 1.5 {
                assert!((a - roll).abs() + (b - pitch).abs() + (c - yaw).abs() < 1e-13);
            }
        }
    }
}
