use super::*;
use crate::integrator::tests::{
    angle, block, damped, gyroscopic, interval, slope, spinning, steps,
};
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

#[test]
fn a_rod_takes_no_more_steps_than_another_body() {
    // With L for a variable its equations swing at |L|/I_min, and a rod of 1e-3 takes ten times as many.
    let taken = |moments: Vector3<f64>| {
        let omega = Vector3::new(1.5, 0.8, -0.6);
        let (inertial, state) = block(moments, spinning(UnitQuaternion::identity(), omega));
        let mut interval = interval(&gyroscopic(), inertial, 10.0);
        interval.tolerance = 1e-12;
        let mut stepper = Dop853.start(interval, 0.0, &state);
        stepper.advance(&steps(10.0, 10), &mut Vec::new());
        stepper.work().steps
    };
    let usual = taken(Vector3::new(1.0, 2.0, 2.5));
    for thin in [1e-3, 1e-6, 1e-12] {
        let rod = taken(Vector3::new(thin, 1.0, 1.0 + 0.5 * thin));
        assert!(rod < 2 * usual, "{thin:e}: {rod}, {usual}");
    }
}

#[test]
fn what_damping_has_brought_to_rest_takes_one_step() {
    let mut load = damped(1e5);
    load.set_gyroscopic();
    let omega = Vector3::new(1.5, 0.8, -0.6);
    let (inertial, state) = block(
        Vector3::new(1.0, 2.0, 2.5),
        spinning(UnitQuaternion::identity(), omega),
    );
    let mut stepper = Dop853.start(interval(&load, inertial, 10.0), 0.0, &state);
    let mut kept = Vec::new();
    let mut all = steps(10.0, 10);
    all.iter_mut().for_each(|step| step.keep = true);
    stepper.advance(&all, &mut kept);
    // Some 30 steps until e^{-ct} is 0, and not c t / 30.
    assert!(stepper.work().steps < 200, "{}", stepper.work().steps);
    let end = stepper.state().get(0);
    assert!(end.omega_w.norm() == 0.0 && end.is_finite());
    assert!(kept.iter().all(|block| block.get(0) == end));
}
