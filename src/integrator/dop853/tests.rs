use super::*;
use crate::integrator::tests::{angle, block, gyroscopic, slope, spinning};
use nalgebra::UnitQuaternion;

fn of(row: Row, value: impl Fn(usize) -> f64) -> f64 {
    row.iter().map(|&(stage, a)| a * value(stage)).sum()
}

#[test]
fn the_coefficients_meet_the_conditions_of_quadrature_and_of_the_rows() {
    // Σ_j a_ij = c_i, and Σ b_i c_i^(k-1) = 1/k for k = 1 to 8.
    for (stage, row) in A.iter().enumerate() {
        let sum = of(row, |_| 1.0);
        // A dozen terms up to 50, rounded.
        assert!((sum - C[stage]).abs() < 2e-14, "row {stage}: {sum}");
    }
    for k in 1..=8 {
        let sum = of(A[12], |stage| C[stage].powi(k - 1));
        assert!((sum - 1.0 / f64::from(k)).abs() < 4e-15, "order {k}: {sum}");
    }
    // Both estimators vanish on polynomials that both their methods integrate.
    for (row, order) in [(E5, 5), (E3, 3)] {
        for k in 1..=order {
            assert!(of(row, |stage| C[stage].powi(k - 1)).abs() < 4e-15);
        }
        let next = of(row, |stage| C[stage].powi(order));
        assert!(next.abs() > 1e-6, "nothing is left to estimate: {next}");
    }
}

/// Steps of equal length, whatever the error: the end, and the worst of instants within the steps.
fn equal_steps(n: u32, exact: impl Fn(f64) -> Quaternion<f64>) -> (f64, f64) {
    let inertia = Vector3::new(0.6, 0.8, 1.0);
    let omega = Vector3::new(1.8, 0.4, -0.9).component_div(&inertia);
    let bodies = block(inertia, spinning(UnitQuaternion::identity(), omega));
    let interval = Interval {
        load: gyroscopic(),
        inertial: bodies.0,
        bodies: 1,
        until: 10.0,
        tolerance: 1.0,
    };
    let mut body = Body::new(&interval, 0, 0.0, &bodies.1.get(0));
    let mut within = 0.0_f64;
    for k in 0..n {
        let to = 10.0 * f64::from(k + 1) / f64::from(n);
        let h = to - body.reached;
        body.attempt(&interval, h);
        body.accept(&interval, to, h);
        for part in [0.2, 0.5, 0.8] {
            let t = body.from + part * h;
            let state = body.at(&interval, t);
            within = within.max(angle(state.q_wp, exact(t)));
        }
    }
    (angle(body.at(&interval, 10.0).q_wp, exact(10.0)), within)
}

#[test]
fn the_step_is_of_order_8_and_instants_within_it_of_order_7() {
    let inertia = Vector3::new(0.6, 0.8, 1.0);
    let omega = Vector3::new(1.8, 0.4, -0.9).component_div(&inertia);
    let motion = crate::exact::FreeMotion::new(inertia, Quaternion::identity(), omega);
    let (mut ends, mut withins) = (Vec::new(), Vec::new());
    for n in [40, 56, 80, 113, 160] {
        let (end, within) = equal_steps(n, |t| motion.attitude(t));
        ends.push((1.0 / f64::from(n), end));
        withins.push((1.0 / f64::from(n), within));
    }
    let (end, within) = (slope(&ends), slope(&withins));
    assert!((end - 8.0).abs() < 0.3, "{end}: {ends:?}");
    // Of order 7 locally at least: 8, with the step's global 8.
    assert!(within > 7.5, "{within}: {withins:?}");
}
