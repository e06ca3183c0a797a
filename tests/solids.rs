//! Every solid's mass properties against quadrature over its own surface, against little cubes that ask
//! only what is inside, and, where it is thin, against points spread over it; compounds against
//! arithmetic done by hand.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;
use torquescope::mass::solids::{SOLIDS, Solid, Surface};
use torquescope::mass::tensor::parallel_axis;
use torquescope::mass::{Compound, Part};
use torquescope::math::draw;

/// Volume, height of the centre of mass and moments about it (unit density) of what a profile
/// encloses: discs of radius r(y), by the midpoint rule over y. Knows nothing of the formulas.
fn by_discs(profile: &[Vec<torquescope::mass::solids::ProfilePoint>]) -> (f64, f64, Vector3<f64>) {
    let points: Vec<[f64; 2]> = profile.iter().flatten().map(|p| p.at).collect();
    let (mut v, mut vy, mut vyy, mut spin) = (0.0, 0.0, 0.0, 0.0);
    const PIECES: usize = 4_000;
    for pair in points.windows(2) {
        let ([r0, y0], [r1, y1]) = (pair[0], pair[1]);
        for k in 0..PIECES {
            let s = (k as f64 + 0.5) / PIECES as f64;
            let (r, y) = (r0 + (r1 - r0) * s, y0 + (y1 - y0) * s);
            let disc = std::f64::consts::PI * r * r * (y0 - y1) / PIECES as f64;
            v += disc;
            vy += disc * y;
            vyy += disc * y * y;
            spin += disc * r * r / 2.0;
        }
    }
    let centre = vy / v;
    let across = spin / 2.0 + vyy - v * centre * centre;
    (v, centre, Vector3::new(across, spin, across))
}

fn solid(name: &str, lengths: &[f64]) -> Box<dyn Solid> {
    let kind = SOLIDS.iter().find(|kind| kind.name == name).unwrap();
    (kind.make)(lengths).unwrap()
}

#[test]
fn moments_volumes_and_centres_agree_with_quadrature() {
    // A sphere is drawn as a polygon of 24 pieces, inside it: its volume is 0.43% short, its moments
    // 0.71%; likewise the tube of a torus, by 2.3% of a small part, and a capsule's ends. Cone, cylinder
    // and tube are exact but for the midpoint rule, 1/4000² = 6e-8.
    for (name, lengths, bound) in [
        ("sphere", &[0.7][..], 5e-3),
        ("capsule", &[0.6, 1.7], 5e-3),
        ("torus", &[1.0, 0.2], 1.2e-2),
        ("tube", &[0.6, 0.5, 1.7], 1e-6),
        ("cylinder", &[0.6, 1.7], 1e-6),
        ("cone", &[1.0, 1.0], 1e-6),
        ("cone", &[0.3, 2.0], 1e-6),
    ] {
        let solid = solid(name, lengths);
        let Surface::Revolution(profile) = solid.surface() else {
            panic!("{name} is no solid of revolution");
        };
        let (volume, centre, moments) = by_discs(&profile);
        assert!(
            (solid.volume().unwrap() / volume - 1.0).abs() < bound,
            "{name}"
        );
        assert!((solid.centre().y - centre).abs() < bound, "{name}");
        let unit_density = solid.moments(solid.volume().unwrap());
        assert!(
            (unit_density - moments).norm() < 1.6 * bound * moments.norm(),
            "{name}: {unit_density} {moments}"
        );
    }
}

#[test]
fn a_thick_shell_is_a_sphere_less_a_sphere() {
    let (outer, inner) = (solid("sphere", &[1.0]), solid("sphere", &[0.8]));
    let shell = solid("hollow_sphere", &[1.0, 0.8]);
    let volume = shell.volume().unwrap();
    let difference =
        outer.moments(outer.volume().unwrap()) - inner.moments(inner.volume().unwrap());
    // Roundings of numbers of size 2.
    assert!((shell.moments(volume) - difference).norm() < 4e-15);
}

#[test]
fn a_thinner_and_thinner_shell_tends_to_the_thin_one() {
    let thin = solid("hollow_sphere", &[1.0, f64::NAN]).moments(1.0);
    assert!((thin.x - 2.0 / 3.0).abs() < 2e-16);
    for gap in [1e-3, 1e-6, 1e-9, 1e-12] {
        let thick = solid("hollow_sphere", &[1.0, 1.0 - gap]).moments(1.0);
        // dI/da = 2/3 at a = b: off by 2/3 of the gap, and no cancellation however thin.
        assert!((thick.x - thin.x).abs() < gap, "{gap}");
    }
    let full = solid("hollow_sphere", &[1.0, 0.0]).moments(1.0);
    assert_eq!(full, solid("sphere", &[1.0]).moments(1.0));
}

#[test]
fn a_cuboid_is_eight_half_cuboids() {
    // The parallel axis composes eight octants into the whole.
    let (x, y, z, mass) = (1.0, 2.0, 3.5, 4.0);
    let octant = solid("cuboid", &[x / 2.0, y / 2.0, z / 2.0]).moments(mass / 8.0);
    let shift = Vector3::new(y * y + z * z, x * x + z * z, x * x + y * y) / 16.0;
    let whole = (octant + shift * (mass / 8.0)) * 8.0;
    assert!((solid("cuboid", &[x, y, z]).moments(mass) - whole).norm() < 1e-14);
}

/// Mass, centre of mass and tensor about it, of points with masses.
fn of_points(
    points: impl Iterator<Item = (Vector3<f64>, f64)>,
) -> (f64, Vector3<f64>, Matrix3<f64>) {
    let (mut mass, mut first, mut second) = (0.0, Vector3::zeros(), Matrix3::zeros());
    for (at, dm) in points {
        mass += dm;
        first += at * dm;
        second += at * at.transpose() * dm;
    }
    let centre = first / mass;
    let spread = second - centre * centre.transpose() * mass;
    let tensor = Matrix3::identity() * spread.trace() - spread;
    (mass, centre, tensor)
}

/// What little cubes say of a solid of density 1.
struct Counted {
    volume: f64,
    centre: Vector3<f64>,
    tensor: Matrix3<f64>,
    /// Five deviations of what chance makes of the volume, as a part of it.
    bound: f64,
}

/// Cubes, `side` along each side of a box, each taken whole if a point of it, drawn evenly, lies in the
/// solid. The draws differ from cube to cube, so that no symmetry makes all err alike, and those of
/// cubes on the surface alone can err: by at most half a cube each, independently.
fn cubes(solid: &dyn Solid, middle: Vector3<f64>, half: Vector3<f64>, side: usize) -> Counted {
    let size = half * (2.0 / side as f64);
    let inside = |i: usize| {
        let corner = Vector3::new(i % side, i / side % side, i / side / side);
        let within = |axis: usize| draw::unit(7, (3 * i + axis) as u64);
        let place = Vector3::from_fn(|axis, _| corner[axis] as f64 + within(axis));
        let at = middle - half + place.component_mul(&size);
        solid.contains(at).then_some(at)
    };
    let points: Vec<Option<Vector3<f64>>> = (0..side.pow(3)).map(inside).collect();
    let steps = [1, side, side * side];
    let differs = |&i: &usize| {
        let is = |i: usize| points.get(i).is_some_and(Option::is_some);
        steps.iter().any(|step| is(i) != is(i + step))
    };
    let on_surface = (0..points.len()).filter(differs).count();
    let cube = size.product();
    let filled = points.iter().flatten().count();
    let (volume, centre, tensor) = of_points(points.iter().flatten().map(|&at| (at, cube)));
    Counted {
        volume,
        centre,
        tensor,
        bound: 5.0 * 0.5 * (on_surface as f64).sqrt() / filled as f64,
    }
}

/// Compares a solid with the cubes that fill it.
fn compare(
    name: &str,
    solid: &dyn Solid,
    (middle, half): (Vector3<f64>, Vector3<f64>),
    side: usize,
) {
    let counted = cubes(solid, middle, half, side);
    let bound = counted.bound;
    assert!(bound < 7e-3, "{name}: {bound:e}");
    let volume = solid.volume().unwrap();
    let off = volume / counted.volume - 1.0;
    assert!(off.abs() < bound, "{name}: volume off by {off:e}");
    // A cube on the surface counts by its distance, which is within the box's half diagonal.
    let off = (solid.centre() - counted.centre).norm();
    assert!(off < bound * half.norm(), "{name}: centre off by {off:e}");
    // And by its square, which is some three times its mean over the solid.
    let exact = solid.inertia(volume);
    let off = (counted.tensor - exact).norm() / exact.norm();
    assert!(off < 3.0 * bound, "{name}: moments off by {off:e}");
}

/// The box around each solid of the table, by its lengths.
fn thick() -> Vec<(&'static str, Vec<f64>, [f64; 3])> {
    vec![
        ("sphere", vec![0.7], [0.7, 0.7, 0.7]),
        ("hollow_sphere", vec![0.7, 0.5], [0.7, 0.7, 0.7]),
        ("cuboid", vec![1.0, 2.0, 3.5], [0.5, 1.0, 1.75]),
        ("cylinder", vec![0.6, 1.7], [0.6, 0.85, 0.6]),
        ("tube", vec![0.6, 0.4, 1.7], [0.6, 0.85, 0.6]),
        ("capsule", vec![0.6, 1.7], [0.6, 1.45, 0.6]),
        ("cone", vec![0.6, 1.7], [0.6, 1.7, 0.6]),
        ("ellipsoid", vec![1.0, 0.4, 1.7], [0.5, 0.2, 0.85]),
        ("torus", vec![1.0, 0.3], [1.3, 0.3, 1.3]),
    ]
}

#[test]
fn every_solid_is_what_little_cubes_say_it_is() {
    let thin = ["rod", "disc"];
    let names: Vec<&str> = thick().iter().map(|(name, ..)| *name).collect();
    for kind in SOLIDS {
        assert!(names.contains(&kind.name) || thin.contains(&kind.name));
    }
    for (name, lengths, half) in thick() {
        let solid = solid(name, &lengths);
        compare(name, &*solid, (Vector3::zeros(), Vector3::from(half)), 64);
    }
}

/// Points of even density over what has no volume: a line, a spiral by equal areas (Vogel 1979), a
/// spiral by equal heights over a sphere (Archimedes).
fn thin(name: &str, length: f64) -> Vec<Vector3<f64>> {
    const MANY: usize = 100_000;
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let point = |k: usize| {
        let u = (k as f64 + 0.5) / MANY as f64;
        let (sin, cos) = (golden * k as f64).sin_cos();
        match name {
            "rod" => Vector3::y() * (length * (u - 0.5)),
            "disc" => Vector3::new(cos, 0.0, sin) * (length * u.sqrt()),
            _ => {
                let y = 2.0 * u - 1.0;
                let across = (1.0 - y * y).sqrt();
                Vector3::new(across * cos, y, across * sin) * length
            }
        }
    };
    (0..MANY).map(point).collect()
}

#[test]
fn what_is_thin_is_what_points_spread_over_it_say() {
    for (name, lengths) in [
        ("rod", &[1.7][..]),
        ("disc", &[0.6]),
        ("hollow_sphere", &[0.7, f64::NAN]),
    ] {
        let solid = solid(name, lengths);
        assert_eq!(solid.volume(), None, "{name}");
        assert!(!solid.contains(Vector3::zeros()), "{name}");
        let points = thin(name, lengths[0]);
        let (_, centre, tensor) = of_points(points.iter().map(|&p| (p, 1.0 / points.len() as f64)));
        let exact = Matrix3::from_diagonal(&solid.moments(1.0));
        // Spirals of 1e5 points leave some 1e-5 of unevenness round the axis.
        assert!(centre.norm() < 2e-5, "{name}: {centre}");
        assert!((tensor - exact).norm() < 2e-5, "{name}: {tensor}");
    }
}

/// In the limit of a length, one solid is another whose formula is another file's.
#[test]
fn solids_pass_into_each_other() {
    let close = |a: (&str, &[f64]), b: (&str, &[f64]), bound: f64| {
        let (one, other) = (solid(a.0, a.1).moments(2.0), solid(b.0, b.1).moments(2.0));
        assert!((one - other).norm() < bound, "{a:?} {b:?}: {one} {other}");
    };
    // Roundings of numbers up to 1; a length of 1e-9 where it ought to be 0, in the first order or in
    // the second.
    close(("ellipsoid", &[1.4, 1.4, 1.4]), ("sphere", &[0.7]), 1e-15);
    close(("capsule", &[0.7, 1e-9]), ("sphere", &[0.7]), 2e-9);
    close(("capsule", &[1e-9, 1.7]), ("rod", &[1.7]), 2e-9);
    close(("cylinder", &[1e-9, 1.7]), ("rod", &[1.7]), 1e-15);
    close(("cylinder", &[0.7, 1e-9]), ("disc", &[0.7]), 1e-15);
    close(
        ("tube", &[0.7, 1e-9, 1.7]),
        ("cylinder", &[0.7, 1.7]),
        1e-15,
    );
    // A hoop: all mass at R.
    close(
        ("torus", &[0.7, 1e-9]),
        ("tube", &[0.7, 0.7 - 1e-9, 1e-9]),
        3e-9,
    );
    // An ellipsoid pressed flat has a fifth where a disc has a quarter.
    let flat = solid("ellipsoid", &[1.4, 1e-9, 1.4]).moments(2.0);
    assert!((flat / 0.2 - solid("disc", &[0.7]).moments(2.0) / 0.25).norm() < 1e-14);
}

#[test]
fn lengths_that_make_no_solid_are_errors() {
    for kind in SOLIDS {
        let right = vec![1.0; kind.parameters.len()];
        for k in 0..right.len() {
            for wrong in [0.0, -1.0, f64::INFINITY, f64::NAN] {
                if wrong.is_nan() && kind.parameters[k].default.is_some() {
                    continue;
                }
                let mut lengths = right.clone();
                lengths[k] = wrong;
                // A wall from the middle on is a solid sphere.
                let whole = kind.name == "hollow_sphere" && k == 1 && wrong == 0.0;
                let made = (kind.make)(&lengths);
                assert!(made.is_err() != whole, "{} {lengths:?}", kind.name);
            }
        }
    }
    let error = |name: &str, lengths: &[f64]| {
        let kind = SOLIDS.iter().find(|kind| kind.name == name).unwrap();
        (kind.make)(lengths).unwrap_err()
    };
    assert!(error("tube", &[0.5, 0.5, 1.0]).contains("must lie below the radius, 0.5 m"));
    assert!(error("hollow_sphere", &[0.5, 0.5]).contains("below the radius"));
    assert!(error("torus", &[0.2, 0.3]).contains("run into itself"));
}

#[test]
fn a_length_of_any_size_leaves_the_moments_in_proportion() {
    // No product of lengths on the way that the moments themselves do not have.
    for (name, lengths, _) in thick() {
        let one = solid(name, &lengths).moments(1.0);
        for scale in [1e-60, 1e60] {
            let scaled: Vec<f64> = lengths.iter().map(|x| x * scale).collect();
            let other = solid(name, &scaled).moments(1.0) / (scale * scale);
            assert!(
                (one - other).norm() < 4e-15 * one.norm(),
                "{name} {scale:e}"
            );
        }
    }
}

fn part(name: &str, solid: Box<dyn Solid>, mass: f64, position: [f64; 3]) -> Part {
    Part {
        name: Some(name.to_owned()),
        solid: Arc::from(solid),
        mass,
        position: Vector3::from(position),
        orientation: UnitQuaternion::identity(),
    }
}

/// A bar of length b and radius r along x with a stem of length s hanging from its middle, as
/// textbooks take it together:
///
/// ```text
/// c_y  = -m_s (r + s/2) / m
/// I_xx = m_b r²/2          + m_s (r²/4 + s²/12) + μ (r + s/2)²      μ = m_b m_s / m
/// I_yy = m_b (r²/4 + b²/12) + m_s r²/2
/// I_zz = m_b (r²/4 + b²/12) + m_s (r²/4 + s²/12) + μ (r + s/2)²
/// ```
#[test]
fn a_t_handle_of_two_cylinders() {
    let (b, s, r) = (0.12, 0.2, 0.01);
    let (steel, wood) = (7800.0, 600.0);
    let (m_b, m_s) = (steel * PI * r * r * b, wood * PI * r * r * s);
    let mut bar = part("bar", solid("cylinder", &[r, b]), m_b, [0.0; 3]);
    bar.orientation = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), FRAC_PI_2);
    let stem = part(
        "stem",
        solid("cylinder", &[r, s]),
        m_s,
        [0.0, -r - s / 2.0, 0.0],
    );
    let handle = Compound::of_masses(vec![bar, stem]);

    let m = m_b + m_s;
    assert!((handle.own_mass().unwrap() - m).abs() < 1e-16);
    let centre = Vector3::y() * (-m_s * (r + s / 2.0) / m);
    assert!((handle.centre() - centre).norm() < 1e-17);
    let reduced = m_b * m_s / m * (r + s / 2.0) * (r + s / 2.0);
    let across = |m: f64, length: f64| m * (r * r / 4.0 + length * length / 12.0);
    let by_hand = Vector3::new(
        m_b * r * r / 2.0 + across(m_s, s) + reduced,
        across(m_b, b) + m_s * r * r / 2.0,
        across(m_b, b) + across(m_s, s) + reduced,
    );
    let off = handle.inertia(m) - Matrix3::from_diagonal(&by_hand);
    // Some roundings of numbers up to 7e-4, and the sine of a right angle.
    assert!(off.norm() < 1e-18, "{off}");
    // Twice the mass, twice the tensor.
    assert_eq!(handle.inertia(2.0 * m), handle.inertia(m) * 2.0);

    // The top of the bar's cylinder has gone to where -x was.
    let points = handle.points();
    let point = |name: &str| points.iter().find(|(n, _)| n == name).unwrap().1;
    assert!((point("bar.top") - Vector3::new(-b / 2.0, 0.0, 0.0)).norm() < 1e-16);
    assert!((point("stem.bottom") - Vector3::new(0.0, -r - s, 0.0)).norm() < 1e-16);
    assert_eq!(point("centre"), handle.centre());
}

/// Parts that tile a solid are that solid.
#[test]
fn a_solid_cut_into_parts_is_the_solid() {
    // A sphere inside a shell that fits; and a block of eight askew, put together about a corner.
    let inner = part("core", solid("sphere", &[0.5]), 0.125, [3.0, -1.0, 2.0]);
    let outer = part(
        "coat",
        solid("hollow_sphere", &[1.0, 0.5]),
        0.875,
        [3.0, -1.0, 2.0],
    );
    let both = Compound::of_masses(vec![inner, outer]);
    let whole = Matrix3::identity() * 0.4;
    assert!((both.centre() - Vector3::new(3.0, -1.0, 2.0)).norm() < 1e-15);
    assert!((both.inertia(1.0) - whole).norm() < 1e-15);
    assert!(both.contains(Vector3::new(3.0, -0.1, 2.0)) && !both.contains(Vector3::zeros()));

    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.7, -0.3, 0.5));
    let octants = (0..8).map(|k| {
        let sign = |bit: usize| if k >> bit & 1 == 0 { -1.0 } else { 1.0 };
        let at = Vector3::new(0.25 * sign(0), 0.5 * sign(1), 0.875 * sign(2));
        Part {
            name: None,
            solid: Arc::from(solid("cuboid", &[0.5, 1.0, 1.75])),
            // Only how they compare matters.
            mass: 17.0,
            position: turn * at,
            orientation: turn,
        }
    });
    let block = Compound::in_proportion(octants.collect());
    let r = turn.to_rotation_matrix();
    let moments = Matrix3::from_diagonal(&solid("cuboid", &[1.0, 2.0, 3.5]).moments(4.0));
    let whole = r.matrix() * moments * r.matrix().transpose();
    assert_eq!(block.own_mass(), None);
    assert!((block.volume().unwrap() - 7.0).abs() < 1e-15);
    assert!((block.inertia(4.0) - whole).norm() < 1e-14);
    assert_eq!(block.inertia(4.0), block.inertia(4.0).transpose());
}

#[test]
fn a_compound_askew_is_what_little_cubes_say_it_is() {
    let mut tube = part(
        "tube",
        solid("tube", &[0.5, 0.2, 1.2]),
        0.0,
        [0.2, 0.1, -0.1],
    );
    tube.orientation = UnitQuaternion::from_scaled_axis(Vector3::new(0.4, 0.2, -0.9));
    let cone = part("cone", solid("cone", &[0.4, 0.6]), 0.0, [-0.3, 1.1, 0.2]);
    let parts = [tube, cone].map(|part| Part {
        mass: part.solid.volume().unwrap(),
        ..part
    });
    let compound = Compound::of_masses(parts.to_vec());
    let within = (Vector3::new(0.1, 0.5, 0.0), Vector3::new(0.9, 1.25, 0.9));
    compare("compound", &compound, within, 96);
    // And about a corner: the parallel axis there and back.
    let tensor = compound.inertia(2.0);
    let there = parallel_axis(&tensor, 2.0, Vector3::new(0.3, -1.0, 2.0));
    let back = parallel_axis(&there, -2.0, Vector3::new(0.3, -1.0, 2.0));
    assert!((back - tensor).norm() < 1e-14);
}

/// What is drawn of a solid of revolution faces outwards: its area times its normals encloses the
/// volume (Gauss), `V = 1/3 ∮ p · n dA`, to what its polygons leave out.
#[test]
fn surfaces_face_outwards_and_enclose_the_volume() {
    for (name, lengths, _) in thick() {
        let solid = solid(name, &lengths);
        let Surface::Revolution(profile) = solid.surface() else {
            continue;
        };
        let mut enclosed = 0.0;
        for piece in &profile {
            for pair in piece.windows(2) {
                let ([r0, y0], [r1, y1]) = (pair[0].at, pair[1].at);
                // n dA of a band, from the way it is gone; p · n is the same all along it.
                let n_da = |r: f64, y: f64| r * (y0 - y1) + y * (r1 - r0);
                enclosed += TAU / 3.0 * 0.5 * (r0 + r1) * n_da(r0, y0);
                let along = [pair[1].at[0] - r0, pair[1].at[1] - y0];
                let outward = -along[1] * pair[0].normal[0] + along[0] * pair[0].normal[1];
                assert!(outward > 0.0, "{name}: a normal faces inwards");
            }
        }
        // A shell is drawn by its outside.
        let hollow = if name == "hollow_sphere" {
            0.343 / (0.343 - 0.125)
        } else {
            1.0
        };
        let volume = solid.volume().unwrap() * hollow;
        assert!(
            (enclosed / volume - 1.0).abs() < 1.2e-2,
            "{name}: {enclosed} {volume}"
        );
    }
}
