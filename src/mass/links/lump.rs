//! A body of which nothing is known but mass, centre and tensor: drawn as the box that has them.

use super::Inertial;
use crate::mass::solids::{NamedPoint, Solid, Surface, Triangles};
use crate::math::symmetric_eigen;
use nalgebra::{Matrix3, Vector3};

/// What an inertial says, as a solid whose origin is the link's.
#[derive(Clone, Debug)]
pub struct Lump {
    centre: Vector3<f64>,
    /// Of 1 kg, about the centre, along the link's axes, m².
    tensor: Matrix3<f64>,
}

impl Lump {
    /// For an inertial that a rigid body can have ([`Inertial::properties`]).
    pub fn new(inertial: &Inertial) -> Self {
        Self {
            centre: inertial.centre,
            tensor: inertial.tensor_in_link() / inertial.mass,
        }
    }

    /// The uniform box of the same inertia: its axes, and half edges `h_i² = 3/2 (I_j + I_k - I_i)/m` along them.
    fn as_box(&self) -> (Matrix3<f64>, Vector3<f64>) {
        let (axes, moments) = symmetric_eigen(&self.tensor);
        let half = moments.map(|i| (1.5 * (moments.sum() - 2.0 * i)).max(0.0).sqrt());
        (axes, half)
    }

    fn faces(&self) -> Triangles {
        let (axes, half) = self.as_box();
        let corner = |k: usize| {
            let sign = |bit: usize| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
            let p = Vector3::new(sign(0), sign(1), sign(2)).component_mul(&half);
            self.centre + axes * p
        };
        let quads = [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
        ];
        let triangles = quads
            .iter()
            .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        Triangles::new((0..8).map(corner).collect(), triangles.collect())
    }
}

impl Solid for Lump {
    /// Principal moments; their axes are not the link's: see [`Solid::inertia`].
    fn moments(&self, mass: f64) -> Vector3<f64> {
        symmetric_eigen(&self.inertia(mass)).1
    }

    fn inertia(&self, mass: f64) -> Matrix3<f64> {
        self.tensor * mass
    }

    fn volume(&self) -> Option<f64> {
        None
    }

    fn centre(&self) -> Vector3<f64> {
        self.centre
    }

    fn contains(&self, point: Vector3<f64>) -> bool {
        let (axes, half) = self.as_box();
        let along = axes.transpose() * (point - self.centre);
        (0..3).all(|k| along[k].abs() <= half[k])
    }

    fn points(&self) -> Vec<NamedPoint> {
        vec![
            ("centre".into(), self.centre),
            ("origin".into(), Vector3::zeros()),
        ]
    }

    fn surface(&self) -> Surface {
        Surface::Mesh(self.faces())
    }
}
