//! What the scene reader makes of bodies at the edge of what there is, and principal frames that nothing fixes.

use crate::free::list;
use nalgebra::{Matrix3, Rotation3, Vector3};
use torquescope::body::Inertial;
use torquescope::mass::MassProperties;
use torquescope::scene::Scene;

fn with_moments(moments: [f64; 3]) -> Result<Scene, String> {
    let text = format!(
        "duration = 1.0\n[effects]\ngyroscopic = true\n[[body]]\nname = \"hard\"\nmass = 1.0\ninertia = {}\n",
        list(&moments)
    );
    Scene::parse("hard.toml", "hard", &text).map_err(|problems| problems.to_string())
}

/// The words of each refusal, and where the edge lies.
#[test]
fn moments_that_no_rigid_body_has_are_refused_and_those_beside_them_are_not() {
    const NOTHING: &str = "its smallest principal moment is nothing beside its largest";
    let refused = [
        ([0.0, 1.0, 1.0], NOTHING),
        ([-1e-300, 1.0, 1.0], NOTHING),
        ([-1e-9, 1.0, 1.0], "is not above zero"),
        // Below four roundings of the largest a moment is what rounding left of 0.
        ([8e-16, 1.0, 1.0], NOTHING),
        ([1.0, 2.0, 3.00001], "3.00001 > 1 + 2"),
        ([1.0, 2.0, 3.0 * (1.0 + 2e-9)], "> 1 + 2"),
        ([1e-151, 1e-151, 1e-151], "is outside 1e-150 to 1e150"),
        ([1e151, 1e151, 1e151], "is outside 1e-150 to 1e150"),
        (
            [f64::MIN_POSITIVE, 1e-308, 1e-308],
            "is outside 1e-150 to 1e150",
        ),
    ];
    for (moments, words) in refused {
        let said = with_moments(moments)
            .err()
            .unwrap_or_else(|| panic!("{moments:?} is accepted"));
        assert!(said.starts_with("hard.toml:7:11: inertia = "), "{said}");
        assert!(said.contains(words), "{moments:?}: {said}");
    }
    let accepted = [
        [9e-16, 1.0, 1.0],
        [1.0, 2.0, 3.0],
        // A plate written to ten digits.
        [1.0, 2.0, 3.0 * (1.0 + 3e-10)],
        [1e-150, 1e-150, 1e-150],
        [1e150, 1e150, 1e150],
    ];
    for moments in accepted {
        assert!(with_moments(moments).is_ok(), "{moments:?}");
    }
}

/// Attitudes of tensors: some turn about every axis.
fn rotations() -> impl Iterator<Item = Rotation3<f64>> {
    (0..200).map(|k| {
        let k = f64::from(k);
        Rotation3::from_euler_angles(0.1 + 0.37 * k, -0.7 + 0.61 * k, 0.3 + 0.83 * k)
    })
}

/// The neighbours of a symmetric tensor: each entry up or down by a rounding of the largest.
fn neighbours(tensor: &Matrix3<f64>) -> Vec<Matrix3<f64>> {
    let ulp = f64::EPSILON * tensor.amax();
    let mut all = Vec::new();
    for (i, j) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)] {
        for by in [-ulp, ulp] {
            let mut near = *tensor;
            near[(i, j)] += by;
            near[(j, i)] = near[(i, j)];
            all.push(near);
        }
    }
    all
}

fn frame(tensor: Matrix3<f64>) -> (nalgebra::UnitQuaternion<f64>, Vector3<f64>) {
    let properties = MassProperties::new(1.0, tensor, [false; 3])
        .unwrap_or_else(|why| panic!("{why}: {tensor}"));
    let (inertial, q_bp) = Inertial::new(&properties, None);
    (q_bp, inertial.moments)
}

fn turned(moments: Vector3<f64>, r: &Rotation3<f64>) -> Matrix3<f64> {
    let tensor = r.matrix() * Matrix3::from_diagonal(&moments) * r.matrix().transpose();
    (tensor + tensor.transpose()) * 0.5
}

/// Of a ball every frame is principal. Rounding must not choose one: it stays that of the body.
#[test]
fn a_ball_that_rounding_turned_keeps_the_bodys_own_axes() {
    for r in rotations() {
        for moment in [1.0, 0.1, 3e40, 7e-40] {
            let tensor = turned(Vector3::repeat(moment), &r);
            for near in neighbours(&tensor) {
                let (q_bp, moments) = frame(near);
                assert_eq!(q_bp.angle(), 0.0, "{near}");
                assert!(
                    (moments / moment - Vector3::repeat(1.0)).amax() < 2e-15,
                    "{moments}"
                );
            }
        }
    }
}

/// Two equal moments: the frame is free to turn about the third axis, and must not be moved by an ulp.
#[test]
fn the_frame_of_two_equal_moments_does_not_jitter() {
    let mut worst = 0.0_f64;
    for moments in [
        Vector3::new(1.0, 1.0, 1.5),
        Vector3::new(1.0, 2.0, 2.0),
        Vector3::new(1e-3, 1.0, 1.0),
    ] {
        for r in rotations() {
            let tensor = turned(moments, &r);
            let (q_bp, _) = frame(tensor);
            for near in neighbours(&tensor) {
                worst = worst.max(q_bp.angle_to(&frame(near).0));
            }
        }
    }
    // An ulp of an entry turns an axis by an ulp over the gap of the moments, and the two that are free turn by
    // that over the tilt of the third from an axis of the body, at least 0.01 here: measured, 2e-12 rad.
    assert!(worst < 1e-11, "{worst:e} rad");
}
