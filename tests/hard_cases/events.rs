//! Torques and impulses far larger than the state, held axes, drag beside a torque.

use crate::cells::*;
use crate::heavy::turn;
use nalgebra::{UnitQuaternion, Vector3};
use torquescope::math::angle_between;

const H: f64 = 0.01;

fn case(
    name: &str,
    hard: &'static str,
    (steps, rate): (f64, f64),
    (effects, body, events): (&str, &str, &str),
    truth: UnitQuaternion<f64>,
    cells: Vec<Cell>,
) -> Case {
    let t = steps * H;
    let scene = format!(
        "duration = {t:e}\n[stepping]\nSTEPPING\n[record]\nstate = {rate:e}\nrate = {rate:e}\n[effects]\n{effects}\n\
         [[body]]\nname = \"hard\"\n{body}\n{events}",
        rate = 10.0 / t
    );
    Case {
        name: name.to_owned(),
        hard,
        problem: Problem {
            scene,
            step: H,
            steps,
            rate,
            thin: 0.0,
            free: false,
            off: Box::new(move |end| angle_between(truth, end.motion.q_wb)),
        },
        cells,
    }
}

const BODY: &str = "mass = 1.0\ninertia = [1.0, 2.0, 2.5]";

/// From 1e-3 rad/s about z by a torque about z that adds α h² radians a step and step.
fn torque(name: &str, alpha_h2: f64, steps: f64, hard: &'static str) -> Case {
    let (t, alpha, omega) = (steps * H, alpha_h2 / (H * H), 1e-3);
    let events = format!(
        "[[event]]\nat = 0.0\nfor = {t:e}\nbody = \"hard\"\ntorque = [0, 0, {:e}]\n",
        2.5 * alpha
    );
    let body = format!("{BODY}\nangular_velocity = [0, 0, {omega:e}]");
    let truth = turn(Vector3::z_axis(), omega * t + 0.5 * alpha * t * t);
    let cells = vec![torque_is_refused()];
    case(
        name,
        hard,
        (steps, omega + alpha * t),
        ("gyroscopic = true", &body, &events),
        truth,
        cells,
    )
}

/// A constant torque against a drag of the rate c = ch/h, 1 rad/s in the end: φ = t - (1 - e^{-ct})/c.
fn driven(name: &str, ch: f64, steps: f64, hard: &'static str) -> Case {
    let c = ch / H;
    let t = steps * H;
    let effects = format!("gyroscopic = true\ndamping = {{ angular = {c:e} }}");
    let events = format!(
        "[[event]]\nat = 0.0\nfor = {t:e}\nbody = \"hard\"\ntorque = [0, 0, {:e}]\n",
        2.5 * c
    );
    let truth = turn(Vector3::z_axis(), t + libm::expm1(-c * t) / c);
    let mut cells = vec![torque_is_refused()];
    if ch > 1e5 {
        cells.push(cell(&["dop853"], Must::NotRun, "explicit stages follow a decay of 1e8/s by steps of 1e-8 s: a million a step of the clock"));
    }
    // What a step must resolve is the decay, for all but those that have it exactly beside a constant torque.
    case(
        name,
        hard,
        (steps, c.max(1.0)),
        (&effects, BODY, &events),
        truth,
        cells,
    )
}

fn impulses(list: &[(&str, &str, &str)]) -> String {
    let each = list.iter().map(|(at, impulse, point)| {
        format!("[[event]]\nat = {at}\nbody = \"hard\"\nimpulse = {impulse}\npoint = {point}\n")
    });
    each.collect()
}

pub fn group() -> Group {
    let still = UnitQuaternion::identity();
    let held = |torque: &str| {
        format!("[[event]]\nat = 0.0\nfor = 1.0\nbody = \"hard\"\ntorque = {torque}\n")
    };
    let blow = impulses(&[("0.05", "[0, 0, 1e308]", "[1, 0, 0]")]);
    let far = impulses(&[("0.05", "[0, 0, 1e308]", "[1e10, 0, 0]")]);
    let pair = impulses(&[
        ("0.05", "[0, 0, 1e308]", "[1, 0, 0]"),
        ("0.05", "[0, 0, -1e308]", "[1, 0, 0]"),
    ]);
    let least = impulses(&[("0.05", "[0, 0, 5e-324]", "[1, 0, 0]")]);
    let gyro = "gyroscopic = true";
    let tutorial = || vec![tutorial_is_refused(), torque_is_refused()];
    let lost = || {
        vec![cell(
            REST,
            Must::BeLost("an impulse"),
            "no number is left of the next step, and that is said",
        )]
    };
    let lost_or_refused = || [vec![tutorial_is_refused()], lost()].concat();
    let one = (100.0, 0.0);
    let held_x = format!("{BODY}\nimmovable = [\"x\"]");
    let held_xz = format!("{BODY}\nimmovable = [\"x\", \"z\"]");
    let infinite = "mass = \"infinite\"\nangular_velocity = [0, 0, 1]";
    let y = turn(Vector3::y_axis(), 0.75);
    let z = turn(Vector3::z_axis(), 1.0);
    Group {
        title: "Torques and blows",
        about: "Steps of 0.01 s, 100 of them where nothing else is said. Error of the attitude at the end, rad, against closed forms.",
        cases: vec![
            torque(
                "torque-1e-2",
                1e-2,
                100.0,
                "from 1e-3 rad/s by 100 rad/s²: α h² = 0.01, and h ω = 1 in the end",
            ),
            torque(
                "torque-1",
                1.0,
                100.0,
                "α h² = 1: 1e7 times the state's own, h ω = 100 in the end",
            ),
            torque("torque-1e4", 1e4, 3.0, "α h² = 1e4; 3 steps"),
            driven(
                "driven-0.1",
                0.1,
                1000.0,
                "a torque against damping, c h = 0.1; 1,000 steps",
            ),
            driven(
                "driven-1",
                1.0,
                1000.0,
                "c h = 1: beside a torque damping is exact for few; 1,000 steps",
            ),
            driven("driven-1e3", 1e3, 10.0, "c h = 1000: stiff; 10 steps"),
            driven("driven-1e6", 1e6, 3.0, "c h = 1e6; 3 steps"),
            case(
                "held-axis",
                "1e6 N·m about a held axis: it must not move",
                one,
                ("", &held_x, &held("[1e6, 0, 0]")),
                still,
                tutorial(),
            ),
            case(
                "two-held-axes",
                "1e6 N·m about two held axes, 3 N·m about the third",
                (100.0, 1.5),
                ("", &held_xz, &held("[1e6, 3, -1e6]")),
                y,
                tutorial(),
            ),
            case(
                "infinite-mass",
                "infinite mass, turning, 1e6 N·m about every axis",
                (100.0, 1.0),
                ("", infinite, &held("[1e6, 1e6, 1e6]")),
                z,
                tutorial(),
            ),
            case(
                "impulse-1e308",
                "1e308 N·s at 1 m",
                one,
                (gyro, BODY, &blow),
                still,
                lost(),
            ),
            case(
                "impulse-1e308-tutorial",
                "the same in the tutorial's model",
                one,
                ("", BODY, &blow),
                still,
                lost_or_refused(),
            ),
            case(
                "impulse-1e308-far",
                "at 1e10 m: its moment is no number",
                one,
                (gyro, BODY, &far),
                still,
                lost(),
            ),
            case(
                "impulse-1e308-undone",
                "two opposite ones at one instant: nothing is left of them",
                one,
                (gyro, BODY, &pair),
                still,
                vec![],
            ),
            case(
                "impulse-5e-324",
                "the smallest there is",
                one,
                (gyro, BODY, &least),
                still,
                vec![],
            ),
        ],
    }
}
