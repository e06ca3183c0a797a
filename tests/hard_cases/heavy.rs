//! Bodies held at a point under their weight: closed forms of the pendulum and of Lagrange's top.

use crate::cells::*;
use crate::free::list;
use nalgebra::{Quaternion, Unit, UnitQuaternion, Vector3};
use torquescope::exact::{LagrangeTop, Pendulum};
use torquescope::math::angle_between;

const H: f64 = 0.01;

/// 1 kg whose centre of mass hangs 1 m below a pivot, let go at half a radian: `Ω² = m g l / I`.
fn pendulum(name: &str, (omega_h, t): (f64, f64), hard: &'static str, cells: Vec<Cell>) -> Case {
    let (inertia, angle) = (1.5, 0.5);
    let omega = omega_h / H;
    let weight = inertia * omega * omega;
    let (sin, cos) = libm::sincos(0.5 * angle);
    let motion = Pendulum::new(inertia, weight, angle, 0.0);
    let truth = UnitQuaternion::new_unchecked(motion.attitude(Vector3::z_axis(), t));
    let scene = format!(
        "duration = {t}\n[stepping]\nSTEPPING\n[record]\nstate = {rate}\nrate = {rate}\n[effects]\ngyroscopic = true\n\
         gravity = [0.0, {:e}, 0.0]\n[[body]]\nname = \"hard\"\nmass = 1.0\ninertia = [0.5, 0.5, 0.5]\n\
         pivot = [0.0, 1.0, 0.0]\norientation = {}\n",
        -weight,
        list(&[0.0, 0.0, sin, cos]),
        rate = 20.0 / t,
    );
    Case {
        name: name.to_owned(),
        hard,
        problem: Problem {
            scene,
            step: H,
            steps: t / H,
            rate: omega,
            thin: 0.0,
            free: false,
            off: Box::new(move |end| angle_between(truth, end.motion.q_wb)),
        },
        cells,
    }
}

pub fn stiff() -> Group {
    let each = [
        (0.01, 10.0, "h Ω = 0.01, Ω the rate of small swings"),
        (0.1, 10.0, "h Ω = 0.1"),
        (1.0, 10.0, "h Ω = 1: six steps a swing"),
        (
            1.9,
            10.0,
            "h Ω = 1.9: just below where symplectic Euler and Strang stop being stable",
        ),
        (2.1, 10.0, "h Ω = 2.1: just beyond"),
        (10.0, 1.0, "h Ω = 10; 100 steps"),
        (1000.0, 0.05, "h Ω = 1000, a weight of 1.5e10 N; 5 steps"),
    ];
    let case = |(oh, t, hard)| {
        pendulum(
            &format!("pendulum-{oh}"),
            (oh, t),
            hard,
            vec![torque_is_refused()],
        )
    };
    Group {
        title: "Stiff",
        about: "A pendulum of ever more weight, let go at half a radian, 1,000 steps of 0.01 s where nothing else is said. \
                Error of the attitude at the end, rad, against Jacobi's functions.",
        cases: each.into_iter().map(case).collect(),
    }
}

/// A top of 1 kg, centre of mass 1 m from the pivot, moments (1.5, 1.5, 0.6) about it, its axis level.
/// The attitude (1, 1, 1, 1)/2 takes x to y, y to z and z to x without a rounding.
fn top(
    name: &str,
    (spin, gravity): (f64, f64),
    t: f64,
    hard: &'static str,
    cells: Vec<Cell>,
) -> Case {
    let q0 = Quaternion::new(0.5, 0.5, 0.5, 0.5);
    let motion = LagrangeTop::new(1.5, 0.6, gravity, q0, Vector3::new(0.0, 0.0, spin));
    let truth = UnitQuaternion::new_unchecked(motion.attitude(t));
    let scene = format!(
        "duration = {t}\n[stepping]\nSTEPPING\n[record]\nstate = 2\nrate = 2\n[effects]\ngyroscopic = true\n\
         gravity = [0.0, 0.0, {:e}]\n[[body]]\nname = \"hard\"\nmass = 1.0\ninertia = [0.5, 0.5, 0.6]\n\
         pivot = [0.0, 0.0, -1.0]\norientation = [1, 1, 1, 1]\nangular_velocity = {}\n",
        -gravity,
        list(&[spin, 0.0, 0.0]),
    );
    Case {
        name: name.to_owned(),
        hard,
        problem: Problem {
            scene,
            step: H,
            steps: t / H,
            rate: spin,
            thin: 0.0,
            free: false,
            off: Box::new(move |end| angle_between(truth, end.motion.q_wb)),
        },
        cells,
    }
}

pub fn tops() -> Group {
    // Free motion exact: only the kick's place counts, and that a fast top averages.
    let swift = || {
        vec![
            torque_is_refused(),
            cell(
                EXACT,
                Must::Hold(3e-5),
                "the spin is exact; a weight this small beside it is a weak kick, whatever the step",
            ),
        ]
    };
    let each = vec![
        (
            "top-0.1",
            (25.0, 1.0),
            10.0,
            "nutation h Ω = 0.1; spin 25 rad/s",
            vec![torque_is_refused()],
        ),
        ("top-1", (250.0, 1.0), 10.0, "nutation h Ω = 1", swift()),
        (
            "top-10",
            (2500.0, 1.0),
            3.0,
            "nutation faster than the step, h Ω = 10; 300 steps",
            swift(),
        ),
        (
            "top-100",
            (25000.0, 1.0),
            1.0,
            "nutation h Ω = 100; 100 steps",
            swift(),
        ),
        (
            "top-precession",
            (250.0, 1e4),
            3.0,
            "precession of 67 rad/s, 0.67 rad a step, by a weight of 1e4 N; 300 steps",
            vec![torque_is_refused()],
        ),
    ];
    let case = |(name, of, t, hard, cells)| top(name, of, t, hard, cells);
    Group {
        title: "Fast tops",
        about: "A top on a pivot, its axis level, steps of 0.01 s. Error of the attitude at the end, rad, against Lagrange's top.",
        cases: each.into_iter().map(case).collect(),
    }
}

/// A turn about an axis.
pub fn turn(axis: Unit<Vector3<f64>>, angle: f64) -> UnitQuaternion<f64> {
    let (sin, cos) = libm::sincos(0.5 * angle);
    UnitQuaternion::new_unchecked(Quaternion::from_parts(cos, axis.into_inner() * sin))
}
