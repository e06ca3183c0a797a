//! `inertia`: three moments or a tensor, about the centre of mass or another point of the body.
//!
//! About a point p the tensor is `I_p = I_c + m (|d|² 1 - d dᵀ)`, d from the centre of mass to p; so
//! `I_c = I_p - m (|d|² 1 - d dᵀ)`.

use super::body::{Shape, point_of};
use super::problem::Problems;
use super::table::Node;
use crate::mass::tensor;
use nalgebra::{Matrix3, Vector3};

/// As the scene gives it.
pub(super) struct Given {
    /// Body axes, kg m².
    tensor: Matrix3<f64>,
    /// What it is about: body axes, from the centre of mass, m.
    about: Vector3<f64>,
}

impl Given {
    /// About the centre of mass of a body of this mass, kg m².
    pub fn about_centre(&self, mass: f64) -> Matrix3<f64> {
        match self.is_about_centre() {
            true => self.tensor,
            false => tensor::parallel_axis(&self.tensor, -mass, self.about),
        }
    }

    fn is_about_centre(&self) -> bool {
        self.about == Vector3::zeros()
    }

    /// Says why no rigid body has it.
    pub fn refuse(&self, node: &Node<'_>, why: tensor::Unphysical, problems: &mut Problems) {
        let message = match self.is_about_centre() {
            true => format!("cannot belong to a rigid body: {why}"),
            false => format!(
                "cannot belong to a rigid body: taken to the centre of mass, {} m away, {why}",
                self.about.norm()
            ),
        };
        node.problem(message, problems);
    }
}

pub(super) fn read(node: &Node<'_>, shape: Shape<'_>, problems: &mut Problems) -> Option<Given> {
    if !node.is_table() {
        return Some(Given {
            tensor: moments_or_rows(node, problems)?,
            about: Vector3::zeros(),
        });
    }
    let table = node.clone().table("inertia = {…}".to_owned(), problems)?;
    let about = match table.get("about") {
        None => Some(Vector3::zeros()),
        Some(node) => shape
            .known()
            .and_then(|solid| point_of(&node, solid, problems)),
    };
    let tensor = match (table.get("moments"), table.get("tensor")) {
        (Some(node), None) => node.vector("kg m²", problems).map(diagonal),
        (None, Some(node)) => node.matrix("kg m²", problems),
        (Some(_), Some(node)) => {
            node.problem(
                "beside moments says the same thing twice; keep one",
                problems,
            );
            None
        }
        (None, None) => {
            let message = format!(
                "{} lacks its numbers; add moments = [x, y, z] or tensor = three rows of three (kg m²)",
                table.name()
            );
            problems.add(table.span(), message);
            None
        }
    };
    table.check_keys(problems);
    Some(Given {
        tensor: tensor?,
        about: about?,
    })
}

fn moments_or_rows(node: &Node<'_>, problems: &mut Problems) -> Option<Matrix3<f64>> {
    if node.is_array_of_arrays() {
        return node.matrix("kg m²", problems);
    }
    if node.array_length() != Some(3) {
        node.problem("must be three moments or three rows of three (kg m², about the centre of mass, body axes), or { about = a point, moments = […] }", problems);
        return None;
    }
    node.vector("kg m²", problems).map(diagonal)
}

fn diagonal(moments: Vector3<f64>) -> Matrix3<f64> {
    Matrix3::from_diagonal(&moments)
}
