//! Where a ray first meets a surface: `p(t) = o + t d`, t ≥ 0.
//!
//! Everything is in the surface's own axes; t counts in lengths of d. An eye inside a body meets its wall
//! from within. A ray that grazes an edge to within rounding meets it, so that no seam between two
//! pieces of a surface lets one through.

use super::solids::{Placed, ProfilePoint, Surface};
use nalgebra::{UnitQuaternion, Vector3};

/// A half line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// m.
    pub origin: Vector3<f64>,
    /// Not zero; of any length.
    pub direction: Vector3<f64>,
}

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// In lengths of the ray's direction.
    pub t: f64,
    /// Unit, outward; of a triangle as its corners go round.
    pub normal: Vector3<f64>,
}

/// Roundings of the sizes at hand within which a point still lies on a piece of surface.
const SLACK: f64 = 16.0 * f64::EPSILON;

impl Ray {
    pub fn at(&self, t: f64) -> Vector3<f64> {
        self.origin + self.direction * t
    }

    /// The same line from where it is nearest to the origin of the axes, and how far that is along it:
    /// squares of a distant eye's place would drown what is looked at.
    fn approached(&self) -> (Self, f64) {
        let t = -self.origin.dot(&self.direction) / self.direction.norm_squared();
        let ray = Self {
            origin: self.at(t),
            ..*self
        };
        (ray, t)
    }

    /// What lies at `position`, turned by `orientation`: in its own axes.
    pub fn meets_placed(
        &self,
        position: Vector3<f64>,
        orientation: UnitQuaternion<f64>,
        meets: impl Fn(&Self) -> Option<Hit>,
    ) -> Option<Hit> {
        let own = Self {
            origin: orientation.inverse() * (self.origin - position),
            direction: orientation.inverse() * self.direction,
        };
        meets(&own).map(|hit| Hit {
            normal: orientation * hit.normal,
            ..hit
        })
    }

    /// A sphere about the origin.
    pub fn meets_sphere(&self, radius: f64) -> Option<Hit> {
        self.meets_ellipsoid(Vector3::repeat(radius))
    }

    /// An ellipsoid about the origin: a unit sphere in lengths of its half axes.
    /// With o nearest to the centre, `t² d² = 1 - o²`.
    pub fn meets_ellipsoid(&self, half_axes: Vector3<f64>) -> Option<Hit> {
        self.ends_in_ellipsoid(half_axes)
            .into_iter()
            .flatten()
            .next()
    }

    /// Where it goes into a sphere about the origin and where it comes out, of both what is not behind.
    pub fn ends_in_sphere(&self, radius: f64) -> [Option<Hit>; 2] {
        self.ends_in_ellipsoid(Vector3::repeat(radius))
    }

    fn ends_in_ellipsoid(&self, half_axes: Vector3<f64>) -> [Option<Hit>; 2] {
        let scaled = Self {
            origin: self.origin.component_div(&half_axes),
            direction: self.direction.component_div(&half_axes),
        };
        let (ray, nearest) = scaled.approached();
        let off = 1.0 - ray.origin.norm_squared();
        if off.is_nan() || off < -SLACK {
            return [None, None];
        }
        let half_chord = (off.max(0.0) / ray.direction.norm_squared()).sqrt();
        [nearest - half_chord, nearest + half_chord].map(|t| {
            let normal = scaled.at(t).component_div(&half_axes);
            (t >= 0.0).then(|| Hit {
                t,
                normal: normal.normalize(),
            })
        })
    }

    /// A box of these full extents about the origin: the last of the three slabs that it enters
    /// (Kay & Kajiya 1986).
    pub fn meets_cuboid(&self, extents: Vector3<f64>) -> Option<Hit> {
        let half = extents * 0.5;
        let (mut enters, mut leaves) = ((f64::NEG_INFINITY, 0), (f64::INFINITY, 0));
        for axis in 0..3 {
            let (o, d) = (self.origin[axis], self.direction[axis]);
            if d == 0.0 {
                if o.abs() > half[axis] {
                    return None;
                }
                continue;
            }
            let (a, b) = ((-half[axis] - o) / d, (half[axis] - o) / d);
            if a.min(b) > enters.0 {
                enters = (a.min(b), axis);
            }
            if a.max(b) < leaves.0 {
                leaves = (a.max(b), axis);
            }
        }
        if enters.0 > leaves.0 || leaves.0 < 0.0 {
            return None;
        }
        // Outward is against the ray where it enters, along it where it leaves.
        let ((t, axis), sense) = match enters.0 >= 0.0 {
            true => (enters, -1.0),
            false => (leaves, 1.0),
        };
        let mut normal = Vector3::zeros();
        normal[axis] = sense * self.direction[axis].signum();
        t.is_finite().then_some(Hit { t, normal })
    }

    /// A straight piece of profile turned about the y axis: a frustum, a piece of a cylinder, or a
    /// flat ring. Its points have `x² + z² = r(y)²`, r going from one end's radius to the other's.
    pub fn meets_turned(&self, [r0, y0]: [f64; 2], [r1, y1]: [f64; 2]) -> Option<Hit> {
        let slack = SLACK * r0.max(r1).max(y0.abs()).max(y1.abs());
        let outward = ProfilePoint::segment([r0, y0], [r1, y1])[0].normal;
        let hit = |t: f64| {
            let p = self.at(t);
            let radial = Vector3::new(p.x, 0.0, p.z);
            // On the axis, at an apex, no side is the outer one.
            let radial = radial.try_normalize(0.0).unwrap_or_default();
            let normal = radial * outward[0] + Vector3::y() * outward[1];
            Hit {
                t,
                normal: normal.try_normalize(0.0).unwrap_or(Vector3::y()),
            }
        };
        let (ray, nearest) = self.approached();
        let (o, d) = (ray.origin, ray.direction);
        if y0 == y1 {
            let t = nearest + (y0 - o.y) / d.y;
            let p = self.at(t);
            let radius = (p.x * p.x + p.z * p.z).sqrt();
            let on_it = radius >= r0.min(r1) - slack && radius <= r0.max(r1) + slack;
            return (t >= 0.0 && t.is_finite() && on_it).then(|| hit(t));
        }
        let slope = (r1 - r0) / (y1 - y0);
        let radius = r0 + slope * (o.y - y0);
        let a = d.x * d.x + d.z * d.z - slope * slope * d.y * d.y;
        let b = o.x * d.x + o.z * d.z - slope * radius * d.y;
        let c = o.x * o.x + o.z * o.z - radius * radius;
        let between = |t: &f64| {
            let y = o.y + *t * d.y;
            *t + nearest >= 0.0 && y >= y0.min(y1) - slack && y <= y0.max(y1) + slack
        };
        let t = quadratic(a, b, c).into_iter().flatten().find(between)?;
        Some(hit(nearest + t))
    }

    /// A triangle, from either side (Möller & Trumbore 1997): `o + t d = a + u (b - a) + v (c - a)`,
    /// u and v not negative and together not above 1.
    pub fn meets_triangle(&self, [a, b, c]: [Vector3<f64>; 3]) -> Option<Hit> {
        let (ab, ac) = (b - a, c - a);
        let across = self.direction.cross(&ac);
        let determinant = ab.dot(&across);
        let from_a = self.origin - a;
        let u = from_a.dot(&across) / determinant;
        let over = from_a.cross(&ab);
        let v = self.direction.dot(&over) / determinant;
        let t = ac.dot(&over) / determinant;
        // A determinant of zero leaves numbers that are none, or infinite.
        let inside = u >= -SLACK && v >= -SLACK && u + v <= 1.0 + SLACK;
        let normal = ab.cross(&ac).try_normalize(0.0)?;
        (inside && t >= 0.0 && t.is_finite()).then_some(Hit { t, normal })
    }
}

/// The real roots of `a t² + 2 b t + c`, the smaller first: by `q = -b ∓ √(b² - ac)`, `q/a` and `c/q`,
/// so that nothing cancels. A discriminant below zero by no more than its rounding is a double root.
pub fn quadratic(a: f64, b: f64, c: f64) -> [Option<f64>; 2] {
    let (b2, ac) = (b * b, a * c);
    let discriminant = b2 - ac;
    if discriminant.is_nan() || discriminant < -SLACK * (b2 + ac.abs()) {
        return [None, None];
    }
    let q = -(b + discriminant.max(0.0).sqrt().copysign(b));
    let finite = |t: f64| t.is_finite().then_some(t);
    let (t, u) = (finite(q / a), finite(c / q));
    match (t, u) {
        (Some(t), Some(u)) => [Some(t.min(u)), Some(t.max(u))],
        // c = 0 and b = 0: 0/0 for what is twice 0.
        (Some(t), None) | (None, Some(t)) => [Some(t), None],
        (None, None) => [None, None],
    }
}

impl Surface {
    /// Where a ray first meets it, as it is drawn: exact for flat, cylindrical and conical pieces.
    pub fn meets(&self, ray: &Ray) -> Option<Hit> {
        match self {
            Self::Cuboid(extents) => ray.meets_cuboid(*extents),
            Self::Revolution(profile) => {
                let pieces = profile.iter().flat_map(|piece| piece.windows(2));
                let hits = pieces.filter_map(|ends| ray.meets_turned(ends[0].at, ends[1].at));
                nearest(hits)
            }
            Self::Ellipsoid(half) => ray.meets_ellipsoid(*half),
            Self::Mesh(triangles) => nearest(
                triangles
                    .corners()
                    .filter_map(|face| ray.meets_triangle(face)),
            ),
            Self::Parts(parts) => {
                let meets = |part: &Placed| {
                    ray.meets_placed(part.position, part.orientation, |ray| {
                        part.surface.meets(ray)
                    })
                };
                nearest(parts.iter().filter_map(meets))
            }
        }
    }
}

/// The nearest of some hits.
pub fn nearest(hits: impl Iterator<Item = Hit>) -> Option<Hit> {
    hits.min_by(|a, b| a.t.total_cmp(&b.t))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mass::solids::{AnySolid, SOLIDS};

    fn solid(name: &str, lengths: &[f64]) -> AnySolid {
        let kind = SOLIDS.iter().find(|kind| kind.name == name).unwrap();
        (kind.make)(lengths).unwrap()
    }

    fn ray(origin: [f64; 3], direction: [f64; 3]) -> Ray {
        Ray {
            origin: origin.into(),
            direction: direction.into(),
        }
    }

    #[track_caller]
    fn hits(hit: Option<Hit>, t: f64, normal: [f64; 3]) {
        let hit = hit.expect("a hit");
        // A few roundings of numbers near 10.
        assert!((hit.t - t).abs() < 1e-14, "t = {}", hit.t);
        assert!((hit.normal - Vector3::from(normal)).norm() < 1e-14);
    }

    #[test]
    fn solids_are_met_where_they_are_by_hand() {
        let (r2, r5) = (2.0_f64.sqrt(), 5.0_f64.sqrt());
        let sphere = solid("sphere", &[0.5]);
        hits(
            sphere.ray(&ray([-2.0, 0.3, 0.0], [1.0, 0.0, 0.0])),
            1.6,
            [-0.8, 0.6, 0.0],
        );
        // In lengths of the direction, and from inside.
        hits(
            sphere.ray(&ray([-2.0, 0.0, 0.0], [2.0, 0.0, 0.0])),
            0.75,
            [-1.0, 0.0, 0.0],
        );
        hits(
            sphere.ray(&ray([0.0; 3], [0.0, 1.0, 0.0])),
            0.5,
            [0.0, 1.0, 0.0],
        );
        let shell = solid("hollow_sphere", &[0.5, f64::NAN]);
        hits(
            shell.ray(&ray([-2.0, 0.3, 0.0], [1.0, 0.0, 0.0])),
            1.6,
            [-0.8, 0.6, 0.0],
        );
        let cuboid = solid("cuboid", &[2.0, 1.0, 4.0]);
        hits(
            cuboid.ray(&ray([0.5, 3.0, -1.5], [0.0, -1.0, 0.0])),
            2.5,
            [0.0, 1.0, 0.0],
        );
        hits(
            cuboid.ray(&ray([0.0; 3], [0.0, 0.0, -1.0])),
            2.0,
            [0.0, 0.0, -1.0],
        );
        let cylinder = solid("cylinder", &[0.5, 2.0]);
        hits(
            cylinder.ray(&ray([0.3, 0.2, 3.0], [0.0, 0.0, -1.0])),
            2.6,
            [0.6, 0.0, 0.8],
        );
        hits(
            cylinder.ray(&ray([0.3, 5.0, 0.0], [0.0, -1.0, 0.0])),
            4.0,
            [0.0, 1.0, 0.0],
        );
        hits(
            cylinder.ray(&ray([0.3, -5.0, 0.0], [0.0, 1.0, 0.0])),
            4.0,
            [0.0, -1.0, 0.0],
        );
        // The unit cone: at height y its radius is 1 - y.
        let cone = solid("cone", &[1.0, 1.0]);
        hits(
            cone.ray(&ray([3.0, 0.25, 0.0], [-1.0, 0.0, 0.0])),
            2.25,
            [1.0 / r2, 1.0 / r2, 0.0],
        );
        hits(
            cone.ray(&ray([0.0, 0.5, 3.0], [0.0, 0.0, -1.0])),
            2.5,
            [0.0, 1.0 / r2, 1.0 / r2],
        );
        hits(
            cone.ray(&ray([0.5, -2.0, 0.25], [0.0, 1.0, 0.0])),
            2.0,
            [0.0, -1.0, 0.0],
        );
        // Parallel to the opposite side: one root, not two.
        let sloping = ray([2.5, 2.0, 0.0], [-1.0, -1.0, 0.0]);
        hits(cone.ray(&sloping), 1.75, [1.0 / r2, 1.0 / r2, 0.0]);
        let tall = solid("cone", &[1.0, 2.0]);
        hits(
            tall.ray(&ray([3.0, 1.0, 0.0], [-1.0, 0.0, 0.0])),
            2.5,
            [2.0 / r5, 1.0 / r5, 0.0],
        );
    }

    /// Whether a point lies in a solid, from its definition.
    type Inside = fn(Vector3<f64>) -> bool;

    /// Numbers in (-1, 1) that look random (Park & Miller 1988).
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f64 {
            self.0 = self.0 * 48_271 % 2_147_483_647;
            2.0 * self.0 as f64 / 2_147_483_647.0 - 1.0
        }

        fn vector(&mut self) -> Vector3<f64> {
            Vector3::new(self.next(), self.next(), self.next())
        }
    }

    /// A second way: walk along the ray and ask of every point whether it is inside.
    #[test]
    fn a_ray_is_outside_until_it_hits_and_inside_after() {
        let cases: [(AnySolid, Inside); 4] = [
            (solid("sphere", &[0.7]), |p| p.norm() < 0.7),
            (solid("cuboid", &[1.0, 0.6, 1.4]), |p| {
                p.x.abs() < 0.5 && p.y.abs() < 0.3 && p.z.abs() < 0.7
            }),
            (solid("cylinder", &[0.5, 1.2]), |p| {
                p.x * p.x + p.z * p.z < 0.25 && p.y.abs() < 0.6
            }),
            (solid("cone", &[0.8, 1.1]), |p| {
                let r = 0.8 * (1.0 - p.y / 1.1);
                p.x * p.x + p.z * p.z < r * r && p.y > 0.0 && p.y < 1.1
            }),
        ];
        for (solid, inside) in &cases {
            let mut numbers = Numbers(7);
            let (mut hits, mut misses) = (0, 0);
            for _ in 0..2000 {
                let origin = numbers.vector().normalize() * 3.0;
                let ray = Ray {
                    origin,
                    direction: (numbers.vector() * 0.9 - origin).normalize(),
                };
                let hit = solid.ray(&ray);
                let until = hit.map_or(6.0, |hit| hit.t - 1e-9);
                let walked = (0..600).map(|k| until * f64::from(k) / 600.0);
                assert!(
                    walked.map(|t| ray.at(t)).all(|p| !inside(p)),
                    "{solid:?} {ray:?}"
                );
                match hit {
                    None => misses += 1,
                    Some(hit) => {
                        hits += 1;
                        // Into the solid by a nanometre: along the ray, and against the normal.
                        assert!(
                            inside(ray.at(hit.t) - hit.normal * 1e-9),
                            "{solid:?} {ray:?}"
                        );
                        assert!(!inside(ray.at(hit.t) + hit.normal * 1e-9));
                        assert!(hit.normal.dot(&ray.direction) < 0.0);
                    }
                }
            }
            assert!(hits > 300 && misses > 100, "{solid:?}: {hits} and {misses}");
        }
    }

    #[test]
    fn no_seam_lets_a_ray_through() {
        // Aimed at the rim of the cone's base, at its apex, at the edge of a cylinder, all round.
        let cone = solid("cone", &[1.0, 1.0]);
        let cylinder = solid("cylinder", &[1.0, 2.0]);
        for k in 0..360 {
            let (sin, cos) = libm::sincos(f64::from(k) * 0.1);
            let eye = Vector3::new(7.0 * cos, 3.0, 7.0 * sin);
            let rim = |y: f64| Vector3::new(cos, y, sin);
            for (solid, target) in [
                (&cone, rim(0.0)),
                (&cone, Vector3::y()),
                (&cylinder, rim(1.0)),
            ] {
                let ray = Ray {
                    origin: eye,
                    direction: target - eye,
                };
                let hit = solid.ray(&ray).expect("a hit");
                assert!((hit.t - 1.0).abs() < 1e-7, "{k}: {hit:?}");
            }
        }
    }

    #[test]
    fn a_distant_eye_sees_as_well() {
        // A million radii off, the place of the eye has roundings of 1e-10 m.
        let sphere = solid("sphere", &[1.0]);
        let hit = sphere.ray(&ray([1e6, 0.6, 0.0], [-1.0, 0.0, 0.0])).unwrap();
        assert!((hit.t - (1e6 - 0.8)).abs() < 3e-10, "{}", hit.t);
        let cone = solid("cone", &[1.0, 1.0]);
        let hit = cone.ray(&ray([1e6, 0.25, 0.0], [-1.0, 0.0, 0.0])).unwrap();
        assert!((hit.t - (1e6 - 0.75)).abs() < 3e-10, "{}", hit.t);
    }

    #[test]
    fn triangles_are_met_from_both_sides_and_at_their_edges() {
        let corners = [Vector3::zeros(), Vector3::x(), Vector3::y()];
        let at = |x: f64, y: f64, z: f64| {
            ray([x, y, z], [0.0, 0.0, -z.signum()]).meets_triangle(corners)
        };
        hits(at(0.25, 0.25, 2.0), 2.0, [0.0, 0.0, 1.0]);
        hits(at(0.25, 0.25, -2.0), 2.0, [0.0, 0.0, 1.0]);
        hits(at(0.5, 0.5, 2.0), 2.0, [0.0, 0.0, 1.0]);
        hits(at(0.0, 0.0, 2.0), 2.0, [0.0, 0.0, 1.0]);
        assert_eq!(at(0.51, 0.5, 2.0), None);
        assert_eq!(at(-0.01, 0.5, 2.0), None);
        // Behind the eye, and along the plane.
        assert_eq!(
            ray([0.2, 0.2, 1.0], [0.0, 0.0, 1.0]).meets_triangle(corners),
            None
        );
        assert_eq!(
            ray([-1.0, 0.2, 0.0], [1.0, 0.0, 0.0]).meets_triangle(corners),
            None
        );
    }

    #[test]
    fn ellipsoids_are_spheres_in_lengths_of_their_axes() {
        let half = Vector3::new(1.0, 2.0, 0.5);
        let hit = ray([5.0, 1.0, 0.0], [-1.0, 0.0, 0.0]).meets_ellipsoid(half);
        // x² = 1 - 1/4; the normal is along (x/1, y/4).
        let x = 0.75_f64.sqrt();
        let normal = Vector3::new(x, 0.25, 0.0).normalize();
        hits(hit, 5.0 - x, normal.into());
        assert_eq!(
            ray([5.0, 2.1, 0.0], [-1.0, 0.0, 0.0]).meets_ellipsoid(half),
            None
        );
    }

    /// `contains` shares no line with the rays: along a ray that the solid says it meets at t, what is just
    /// beyond is inside, and nothing before is; along one that it says it misses, nothing is.
    #[test]
    fn rays_meet_what_solids_contain() {
        use crate::math::draw;
        let cases: &[(&str, &[f64])] = &[
            ("sphere", &[0.7]),
            ("cuboid", &[1.0, 0.6, 1.4]),
            ("cylinder", &[0.5, 1.2]),
            ("tube", &[0.7, 0.4, 0.8]),
            ("capsule", &[0.4, 0.9]),
            ("cone", &[0.8, 1.1]),
            ("ellipsoid", &[1.2, 0.5, 0.9]),
            ("torus", &[0.7, 0.25]),
        ];
        for (name, lengths) in cases {
            let solid = solid(name, lengths);
            let mut met = 0;
            for k in 0..600_u64 {
                let u = |n: u64| [0, 1, 2].map(|j| draw::unit(7, 6 * k + 3 * n + j));
                let origin = draw::in_cube(u(0)).normalize() * 4.0;
                let ray = Ray {
                    origin,
                    direction: draw::in_cube(u(1)) - origin,
                };
                let hit = solid.ray(&ray);
                met += usize::from(hit.is_some());
                let inside = |t: f64| solid.contains(ray.at(t));
                let before = hit.as_ref().map_or(2.0, |hit| hit.t - 1e-9);
                let scan = (0..4000).map(|k| f64::from(k) * 5e-4);
                let first = scan.take_while(|&t| t < before).find(|&t| inside(t));
                assert_eq!(first, None, "{name} {k}: inside before {before}");
                if let Some(hit) = hit {
                    // However short the chord: a ray may cut a corner.
                    let beyond = (0..60).map(|k| hit.t + 1e-2 * 0.7_f64.powi(k));
                    assert!(
                        beyond.into_iter().any(inside),
                        "{name} {k}: nothing at {}",
                        hit.t
                    );
                    assert!(hit.normal.dot(&ray.direction) <= 0.0, "{name} {k}");
                }
            }
            assert!((60..570).contains(&met), "{name}: {met} rays met it");
        }
    }

    /// However far the eye, and at angles of a few degrees to the surface.
    #[test]
    fn a_torus_is_met_from_far_away_and_at_a_slant() {
        /// Some ten roundings of the way, there and back.
        const BOUND: f64 = 2e-15;
        let torus = solid("torus", &[1.0, 0.2]);
        for away in [1e2, 1e3, 1e6, 1e9] {
            let hit = torus.ray(&ray([away, 0.0, 0.0], [-1.0, 0.0, 0.0]));
            let hit = hit.unwrap_or_else(|| panic!("missed from {away} m"));
            let off = (hit.t - (away - 1.2)).abs();
            assert!(off < BOUND * away + 1e-12, "{away}: {off:e}");
        }
        let slant = ray(
            [
                -2.977_081_983_364_875,
                0.334_712_115_004_409_97,
                -0.157_957_793_076_344_9,
            ],
            [
                0.961_408_436_472_245,
                -0.052_662_917_311_768_316,
                -0.270_037_840_718_25,
            ],
        );
        // By steps of 1e-7 and bisection, elsewhere.
        assert!((torus.ray(&slant).unwrap().t - 2.559_899).abs() < 1e-5);
    }
}
