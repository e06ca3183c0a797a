//! A click: a ray from an eye; the first body it hits is pushed along the ray, there.
//!
//! The force keeps its direction in the world, the point goes with the body: what a mouse does that holds
//! on to the point it clicked.

use super::super::problem::Problems;
use super::super::table::Table;
use super::read::Reading;
use super::{Action, Framed, Target};
use crate::effect::Profile;
use crate::mass::ray::Ray;
use nalgebra::Vector3;

/// A ray and what is done where it hits.
#[derive(Clone, Debug, PartialEq)]
pub struct Click {
    /// World, m; its direction has unit length.
    pub ray_w: Ray,
    /// Along the ray, at its peak: N, or N·s where it lasts no time.
    pub force: f64,
    /// s; 0 for an instant.
    pub lasts: f64,
    pub profile: Profile,
}

impl Click {
    /// What it does to a body at a point of it (body axes, from the centre of mass, m).
    pub fn at(&self, point_b: Vector3<f64>) -> Action {
        let vector = Framed::World(self.ray_w.direction * self.force);
        let point = Framed::Body(point_b);
        match self.lasts > 0.0 {
            true => Action::Push {
                force: vector,
                point,
                lasts: self.lasts,
                profile: self.profile,
            },
            false => Action::Impulse {
                impulse: vector,
                point,
            },
        }
    }
}

pub(super) fn read(reading: Reading<'_, '_>, problems: &mut Problems) -> Option<(Target, Action)> {
    let everybody = 0..reading.context.bodies.valid.len();
    let unit = match reading.lasts {
        Some(_) => "N",
        None => "N·s",
    };
    let table = reading.node.table("click = {…}".to_owned(), problems)?;
    let eye = table.require("from", "the eye, three numbers (m)", problems);
    let eye = eye.and_then(|node| node.vector("m", problems));
    let direction = direction(&table, eye, problems);
    let force = table.require("force", "how hard it pushes along the ray", problems);
    let force = force.and_then(|node| node.number(unit, problems));
    table.check_keys(problems);
    let (lasts, profile) = reading.lasts.unwrap_or_default();
    let ray_w = Ray {
        origin: eye?,
        direction: direction?,
    };
    let click = Click {
        ray_w,
        force: force?,
        lasts,
        profile,
    };
    Some((Target::Hit(everybody), Action::Click(click)))
}

/// By a point to look at, or by itself; of unit length.
fn direction(
    table: &Table<'_>,
    eye: Option<Vector3<f64>>,
    problems: &mut Problems,
) -> Option<Vector3<f64>> {
    let (node, vector) = match (table.get("toward"), table.get("direction")) {
        (Some(node), None) => {
            let point = node.vector("m", problems)?;
            (node, point - eye?)
        }
        (None, Some(node)) => {
            let vector = node.vector("a direction", problems)?;
            (node, vector)
        }
        (Some(_), Some(node)) => {
            node.problem(
                "beside toward says the same thing twice; keep one",
                problems,
            );
            return None;
        }
        (None, None) => {
            let message = format!(
                "{} looks nowhere; add toward = […] (a point, m) or direction = […]",
                table.name()
            );
            problems.add(table.span(), message);
            return None;
        }
    };
    let largest = vector.amax();
    let unit = (vector / largest).try_normalize(0.0);
    let unit = unit.filter(|_| largest > 0.0 && largest.is_finite());
    if unit.is_none() {
        let why = match (node.key, largest > 0.0) {
            ("toward", false) => "is where the eye is, so it looks nowhere",
            ("toward", true) => "is farther from the eye than numbers reach",
            _ => "has no length, so it is no direction",
        };
        node.problem(why, problems);
    }
    unit
}
