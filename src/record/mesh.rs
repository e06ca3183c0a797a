//! Surfaces as triangle meshes with normals, striped so that every turn is seen.

use super::look::{self, Colour};
use crate::mass::equivalent;
use crate::mass::solids::{Placed, ProfilePoint, Surface, Triangles};
use crate::trace::Subject;
use nalgebra::{UnitQuaternion, Vector3};
use rerun::archetypes::Mesh3D;

/// Pieces round the axis, and stripes among them: a cone that spins about its own axis would
/// look still in one colour.
const ROUND: usize = 48;
const STRIPES: usize = 8;

/// A mesh in body axes about the centre of mass.
pub fn mesh(subject: &Subject, colour: Colour) -> Mesh3D {
    let faces = faces(subject, colour);
    Mesh3D::new(faces.points)
        .with_triangle_indices(faces.triangles)
        .with_vertex_normals(faces.normals)
        .with_vertex_colors(faces.colours)
}

/// The height of the body's lowest point as it starts, m.
pub fn lowest(subject: &Subject) -> f64 {
    let points = faces(subject, 0).points;
    let up_b = subject.start.q_wb.inverse() * Vector3::y();
    let height = |p: [f32; 3]| up_b.dot(&Vector3::from(p.map(f64::from)));
    let low = points.into_iter().map(height).fold(f64::INFINITY, f64::min);
    subject.start.position_w.y + low
}

fn faces(subject: &Subject, colour: Colour) -> Faces {
    let (surface, shift, turn) = match &subject.solid {
        Some(solid) => (solid.surface(), -solid.centre(), UnitQuaternion::identity()),
        None => {
            let (extents, turn) = equivalent_box(subject);
            (Surface::Cuboid(extents), Vector3::zeros(), turn)
        }
    };
    let mut faces = Faces {
        shift,
        turn,
        ..Faces::default()
    };
    faces.surface(&surface, colour);
    faces
}

/// The distance from the centre of mass to the farthest point, m.
pub fn radius(subject: &Subject) -> f64 {
    match &subject.solid {
        None => 0.5 * equivalent_box(subject).0.norm(),
        Some(solid) => reach(&solid.surface(), solid.centre()),
    }
}

/// The distance from a point to the farthest one of a surface, m; of an ellipsoid, a bound.
fn reach(surface: &Surface, from: Vector3<f64>) -> f64 {
    let farthest = |distances: &mut dyn Iterator<Item = f64>| distances.fold(0.0, f64::max);
    match surface {
        Surface::Cuboid(extents) => (extents * 0.5 + from.abs()).norm(),
        Surface::Ellipsoid(half) => half.max() + from.norm(),
        Surface::Revolution(profile) => {
            let across = from.x.hypot(from.z);
            let distance = |p: &ProfilePoint| (p.at[0] + across).hypot(p.at[1] - from.y);
            farthest(&mut profile.iter().flatten().map(distance))
        }
        Surface::Mesh(triangles) => {
            let distance = |point: &Vector3<f64>| (point - from).norm();
            farthest(&mut triangles.points.iter().map(distance))
        }
        Surface::Parts(parts) => {
            let distance = |part: &Placed| {
                let from = part.orientation.inverse() * (from - part.position);
                reach(&part.surface, from)
            };
            farthest(&mut parts.iter().map(distance))
        }
    }
}

/// The ellipsoid of the same mass and inertia: half axes, and its attitude in the body.
pub fn equivalent_ellipsoid(subject: &Subject) -> Option<(Vector3<f64>, UnitQuaternion<f64>)> {
    let mass = subject.mass?;
    Some(equivalent::ellipsoid(mass, &subject.inertia_c))
}

/// Full extents of the cuboid of the same inertia, for a body without a shape, and its attitude in
/// the body.
fn equivalent_box(subject: &Subject) -> (Vector3<f64>, UnitQuaternion<f64>) {
    equivalent::cuboid(subject.mass, &subject.inertia_c)
}

#[derive(Default)]
struct Faces {
    /// Where what is added lies, and how it is turned.
    shift: Vector3<f64>,
    turn: UnitQuaternion<f64>,
    points: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    colours: Vec<u32>,
    triangles: Vec<[u32; 3]>,
}

impl Faces {
    fn surface(&mut self, surface: &Surface, colour: Colour) {
        match surface {
            Surface::Cuboid(extents) => self.cuboid(*extents, colour),
            Surface::Revolution(profile) => {
                for piece in profile {
                    self.revolve(piece, Vector3::repeat(1.0), colour);
                }
            }
            Surface::Ellipsoid(half) => {
                self.revolve(&ProfilePoint::half_circle(1.0), *half, colour);
            }
            Surface::Mesh(triangles) => self.flat(triangles, colour),
            Surface::Parts(parts) => {
                for part in parts {
                    self.part(part, colour);
                }
            }
        }
    }

    fn part(&mut self, part: &Placed, colour: Colour) {
        let (shift, turn) = (self.shift, self.turn);
        self.shift = shift + turn * part.position;
        self.turn = turn * part.orientation;
        self.surface(&part.surface, colour);
        (self.shift, self.turn) = (shift, turn);
    }

    /// Four corners, counter-clockwise from outside, each with its normal.
    fn quad(&mut self, corners: [(Vector3<f64>, Vector3<f64>); 4], colour: Colour) {
        let first = self.points.len() as u32;
        for (point, normal) in corners {
            let (point, normal) = (self.turn * point + self.shift, self.turn * normal);
            self.points.push(point.map(|x| x as f32).into());
            self.normals.push(normal.map(|x| x as f32).into());
            self.colours.push(colour);
        }
        self.triangles.push([first, first + 1, first + 2]);
        self.triangles.push([first, first + 2, first + 3]);
    }

    /// Each face in the shade of the side it looks to, as on a cuboid: a turn is seen on a round mesh too.
    fn flat(&mut self, triangles: &Triangles, colour: Colour) {
        for corners in triangles.corners() {
            let [a, b, c] = corners;
            // Three corners on a line are nothing to see.
            let Some(normal) = (b - a).cross(&(c - a)).try_normalize(0.0) else {
                continue;
            };
            let axis = normal.iamax();
            let side = if normal[axis] > 0.0 { 0.3 } else { 0.0 };
            let colour = look::lightened(colour, side + 0.1 * axis as f32);
            let first = self.points.len() as u32;
            let normal = self.turn * normal;
            for point in corners {
                let point = self.turn * point + self.shift;
                self.points.push(point.map(|x| x as f32).into());
                self.normals.push(normal.map(|x| x as f32).into());
                self.colours.push(colour);
            }
            self.triangles.push([first, first + 1, first + 2]);
        }
    }

    /// A profile turned about the y axis and stretched by `scale` along the axes.
    fn revolve(&mut self, profile: &[ProfilePoint], scale: Vector3<f64>, colour: Colour) {
        let light = look::lightened(colour, 0.35);
        let turned = |[radial, y]: [f64; 2], k: usize| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / ROUND as f64).sin_cos();
            Vector3::new(radial * cos, y, radial * sin)
        };
        for pair in profile.windows(2) {
            for k in 0..ROUND {
                let colour = if (k * STRIPES / ROUND).is_multiple_of(2) {
                    colour
                } else {
                    light
                };
                // A normal shrinks where the surface is stretched.
                let corner = |p: &ProfilePoint, k| {
                    let normal = turned(p.normal, k).component_div(&scale);
                    (turned(p.at, k).component_mul(&scale), normal.normalize())
                };
                let corners = [
                    corner(&pair[0], k),
                    corner(&pair[0], k + 1),
                    corner(&pair[1], k + 1),
                    corner(&pair[1], k),
                ];
                self.quad(corners, colour);
            }
        }
    }

    /// Each face in its own shade, so that a cuboid's attitude is plain.
    fn cuboid(&mut self, extents: Vector3<f64>, colour: Colour) {
        let half = extents * 0.5;
        for axis in 0..3 {
            for (side, shade) in [(1.0, 0.3), (-1.0, 0.0)] {
                let mut normal = Vector3::zeros();
                normal[axis] = side;
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let corner = |a: f64, b: f64| {
                    let mut point = normal * half[axis];
                    point[u] = a * half[u];
                    // Mirrored on the far side, which keeps the corners counter-clockwise.
                    point[v] = b * side * half[v];
                    (point, normal)
                };
                let corners = [
                    corner(-1.0, -1.0),
                    corner(1.0, -1.0),
                    corner(1.0, 1.0),
                    corner(-1.0, 1.0),
                ];
                self.quad(corners, look::lightened(colour, shade + 0.1 * axis as f32));
            }
        }
    }
}
