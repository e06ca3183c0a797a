//! Parts of a body's state made what a scene says; the others stay as they are.
//!
//! The angular velocity stays what it is in the world where the orientation alone is set. A body that a pivot
//! holds keeps its pivot: its place follows from its orientation.

use super::super::body;
use super::super::problem::Problems;
use super::read::Reading;
use super::{Action, Target};
use nalgebra::{UnitQuaternion, Vector3};

/// What becomes of a state; `None` stays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Change {
    /// Of the centre of mass, world, m.
    pub position_w: Option<Vector3<f64>>,
    /// Of the centre of mass, world, m/s.
    pub velocity_w: Option<Vector3<f64>>,
    pub q_wb: Option<UnitQuaternion<f64>>,
    /// World, rad/s.
    pub omega_w: Option<Vector3<f64>>,
}

impl Change {
    /// Whether it says all that a motion goes by from there on, but for where it is.
    pub fn says_all(&self, held: bool) -> bool {
        self.q_wb.is_some() && self.omega_w.is_some() && (held || self.velocity_w.is_some())
    }
}

pub(super) fn read(reading: Reading<'_, '_>, problems: &mut Problems) -> Option<(Target, Action)> {
    let index = reading.body(problems);
    let body = index.and_then(|index| reading.context.bodies.valid.get(index)?.as_ref());
    let is_held = body.is_some_and(|body| body.pivot_b.is_some());
    let empty = reading.node.is_empty_table();
    if empty {
        reading.node.problem(
            "sets nothing; name position, velocity, orientation or angular_velocity",
            problems,
        );
    }
    let table = reading.node.table("set = {…}".to_owned(), problems)?;
    let mut right = !empty;
    let mut vector = |key, unit, moves: bool| {
        let node = table.get(key)?;
        if is_held && moves {
            node.problem(
                "on a body that a pivot holds; its place follows from its orientation",
                problems,
            );
            right = false;
        }
        let vector = node.vector(unit, problems);
        right &= vector.is_some();
        vector
    };
    let position_w = vector("position", "m", true);
    let velocity_w = vector("velocity", "m/s", true);
    let omega_w = vector("angular_velocity", "rad/s", false);
    let q_wb = match table.get("orientation") {
        None => None,
        Some(node) => {
            let q_wb = body::orientation_of(node, problems);
            right &= q_wb.is_some();
            q_wb
        }
    };
    table.check_keys(problems);
    let change = Change {
        position_w,
        velocity_w,
        q_wb,
        omega_w,
    };
    right.then_some((Target::Body(index?), Action::Set(change)))
}
