//! Properties that hold for every body, attitude and push.

mod common;

use common::Nowhere;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use proptest::prelude::*;
use torquescope::body::{Inertial, State};
use torquescope::mass::tensor::{check_held, check_physical, parallel_axis, turned};
use torquescope::mass::{MassProperties, solids::SOLIDS};
use torquescope::math::symmetric_eigen;

fn vector(size: f64) -> impl Strategy<Value = Vector3<f64>> {
    [-size..size, -size..size, -size..size].prop_map(Vector3::from)
}

fn attitude() -> impl Strategy<Value = UnitQuaternion<f64>> {
    [-1.0..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0_f64]
        .prop_filter("a direction", |q| {
            q.iter().map(|x| x * x).sum::<f64>() > 1e-2
        })
        .prop_map(|[x, y, z, w]| UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)))
}

/// A tensor some body has: of three to eight point masses, so in general position.
fn inertia() -> impl Strategy<Value = Matrix3<f64>> {
    prop::collection::vec((0.1..2.0_f64, vector(1.0)), 3..8)
        .prop_map(|points| {
            points.iter().fold(Matrix3::zeros(), |sum, (mass, at)| {
                sum + parallel_axis(&Matrix3::zeros(), *mass, *at)
            })
        })
        .prop_filter("thick enough to invert", |tensor| {
            symmetric_eigen(tensor).1.min() > 1e-3
        })
}

fn world(tensor_b: &Matrix3<f64>, q: &UnitQuaternion<f64>) -> Matrix3<f64> {
    turned(tensor_b, q.to_rotation_matrix().matrix())
}

fn at(inertial_q: UnitQuaternion<f64>, omega_w: Vector3<f64>) -> State {
    State {
        x_w: Vector3::zeros(),
        v_w: Vector3::zeros(),
        q_wp: inertial_q.into_inner(),
        omega_w,
    }
}

proptest! {
    #[test]
    fn the_world_tensor_is_symmetric_with_the_bodys_eigenvalues(tensor in inertia(), q in attitude()) {
        let turned = world(&tensor, &q);
        let scale = tensor.norm();
        prop_assert_eq!(turned, turned.transpose());
        // nalgebra's own solver is the second opinion.
        let mut own: Vec<f64> = symmetric_eigen(&tensor).1.iter().copied().collect();
        let mut other: Vec<f64> = turned.symmetric_eigenvalues().iter().copied().collect();
        own.sort_by(f64::total_cmp);
        other.sort_by(f64::total_cmp);
        for (a, b) in own.iter().zip(&other) {
            // Rounding of two solvers and of two matrix products.
            prop_assert!((a - b).abs() < 2e-14 * scale, "{a} {b}");
        }
    }

    #[test]
    fn alpha_is_the_same_in_every_frame(tensor in inertia(), q in attitude(), other in attitude(), tau in vector(10.0)) {
        let properties = MassProperties::new(1.0, tensor, [false; 3]).unwrap();
        let (inertial, q_bp) = Inertial::new(&properties, None);
        let alpha = |q: UnitQuaternion<f64>, tau| inertial.angular_response(&at(q * q_bp, Vector3::zeros()), tau);
        let here = alpha(q, tau);
        let there = alpha(other * q, other * tau);
        // By way of principal axes against a plain inverse of the world tensor.
        let plain = world(&tensor, &q).try_inverse().unwrap() * tau;
        let condition = symmetric_eigen(&tensor).1.max() / symmetric_eigen(&tensor).1.min();
        let bound = 1e-14 * condition * (1.0 + here.norm());
        prop_assert!((other * here - there).norm() < bound);
        prop_assert!((here - plain).norm() < bound, "{here} {plain}");
    }

    #[test]
    fn momentum_and_response_undo_each_other(tensor in inertia(), q in attitude(), omega in vector(5.0)) {
        let properties = MassProperties::new(1.0, tensor, [false; 3]).unwrap();
        let (inertial, q_bp) = Inertial::new(&properties, None);
        let state = at(q * q_bp, omega);
        let back = inertial.angular_response(&state, inertial.momentum_w(&state));
        let condition = inertial.moments.max() / inertial.moments.min();
        prop_assert!((back - omega).norm() < 1e-14 * condition * (1.0 + omega.norm()));
    }

    #[test]
    fn a_push_through_the_centre_gives_no_torque(q in attitude(), at in vector(50.0), force in vector(100.0)) {
        let source = |point: &str| format!(
            "duration = 0.001\n[[body]]\nname = \"b\"\nshape = {{ cone = {{ radius = 1.0, height = 2.0 }} }}\nmass = 1.0\nposition = [{}, {}, {}]\norientation = [{}, {}, {}, {}]\n[[event]]\nat = 0.0\nfor = 0.001\nbody = \"b\"\nforce = [{}, {}, {}]\npoint = {point}\n",
            at.x, at.y, at.z, q.i, q.j, q.k, q.w, force.x, force.y, force.z
        );
        for point in ["\"centre\"".to_owned(), format!("[{}, {}, {}]", at.x, at.y, at.z)] {
            let scene = torquescope::scene::Scene::parse("p", "p", &source(&point)).unwrap();
            let (outcome, _) = torquescope::sim::Simulation::new(&scene).run(&mut Nowhere);
            let tau = outcome.blows[0].sample.tau_w;
            prop_assert_eq!(tau, Vector3::zeros());
        }
    }

    #[test]
    fn the_parallel_axis_leads_there_and_back(tensor in inertia(), mass in 0.1..10.0_f64, d in vector(5.0)) {
        let there = parallel_axis(&tensor, mass, d);
        prop_assert!(check_physical(&there).is_ok());
        let back = parallel_axis(&there, -mass, d);
        // A rounding or two at the size of what was added.
        prop_assert!((back - tensor).norm() < 4.0 * f64::EPSILON * there.norm());
    }

    #[test]
    fn point_masses_always_make_a_physical_tensor(tensor in inertia()) {
        prop_assert!(check_physical(&tensor).is_ok());
    }

    #[test]
    fn solids_obey_the_triangle_inequality_and_scale_with_mass(
        lengths in [0.01..100.0_f64, 0.01..100.0, 0.01..100.0], mass in 0.01..100.0_f64
    ) {
        for kind in SOLIDS {
            let mut lengths = lengths[..kind.parameters.len()].to_vec();
            // What is inside is smaller.
            if ["hollow_sphere", "tube", "torus"].contains(&kind.name) {
                lengths[1] = lengths[0] * 0.9;
            }
            let solid = (kind.make)(&lengths).unwrap();
            let moments = solid.moments(mass);
            // A rod may not turn about itself.
            let held = [false, kind.name == "rod", false];
            let checked = check_held(&Matrix3::from_diagonal(&moments), held);
            prop_assert!(checked.is_ok(), "{}", kind.name);
            let twice = solid.moments(2.0 * mass);
            prop_assert!((twice - moments * 2.0).norm() <= 1e-15 * twice.norm());
        }
    }
}
