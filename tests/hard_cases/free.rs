//! Free bodies: their ends are known in 60 digits (tests/oracles/hard_free.py).

use crate::cells::*;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use torquescope::integrator::Damping;
use torquescope::math::angle_between;

/// A row of the oracle's.
pub struct Reference {
    pub step: f64,
    pub t: f64,
    pub moments: [f64; 3],
    pub omega: [f64; 3],
    pub damping: f64,
    pub attitude: UnitQuaternion<f64>,
}

pub fn reference(name: &str) -> Reference {
    let text = include_str!("../oracles/hard_free.csv");
    let line = text
        .lines()
        .find(|line| line.split(',').next() == Some(name));
    let fields: Vec<&str> = line
        .unwrap_or_else(|| panic!("no {name}"))
        .split(',')
        .collect();
    let hex = |k: usize| hexadecimal(fields[k]);
    let decimal = |k: usize| fields[k].parse::<f64>().unwrap();
    let q = Quaternion::new(decimal(13), decimal(10), decimal(11), decimal(12));
    Reference {
        step: hex(1),
        t: hex(2),
        moments: [hex(3), hex(4), hex(5)],
        omega: [hex(6), hex(7), hex(8)],
        damping: hex(9),
        attitude: UnitQuaternion::new_unchecked(q),
    }
}

/// A C99 hexadecimal float, as Python's `float.hex` writes it; exact, denormal ones too.
fn hexadecimal(text: &str) -> f64 {
    let (sign, text) = match text.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, text),
    };
    let (digits, exponent) = text.strip_prefix("0x").unwrap().split_once('p').unwrap();
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let mut value = u64::from_str_radix(&format!("{whole}{fraction}"), 16).unwrap() as f64;
    let exponent = exponent.parse::<i32>().unwrap() - 4 * fraction.len() as i32;
    let factor = if exponent < 0 { 0.5 } else { 2.0 };
    for _ in 0..exponent.unsigned_abs() {
        value *= factor;
    }
    sign * value
}

/// A TOML array of numbers with all their digits.
pub fn list(numbers: &[f64]) -> String {
    let each: Vec<String> = numbers.iter().map(|x| format!("{x:e}")).collect();
    format!("[{}]", each.join(", "))
}

fn scene(r: &Reference, mass: f64, more: &str, omega_w: &[f64]) -> String {
    let damping = match r.damping {
        0.0 => String::new(),
        c => format!("damping = {{ angular = {c:e} }}"),
    };
    format!(
        "duration = {:e}\n[stepping]\nSTEPPING\n[record]\nstate = {rate:e}\nrate = {rate:e}\n[effects]\n\
         gyroscopic = true\n{damping}\n[[body]]\nname = \"hard\"\nmass = {mass:e}\ninertia = {}\nangular_velocity = {}\n{more}\n",
        r.t,
        list(&r.moments),
        list(omega_w),
        rate = 20.0 / r.t,
    )
}

/// A free body of the oracle's table.
pub fn free(name: &str, hard: &'static str, cells: Vec<Cell>) -> Case {
    varied(name, name, hard, 1.0, "", cells)
}

fn varied(
    name: &str,
    reference_name: &str,
    hard: &'static str,
    mass: f64,
    more: &str,
    cells: Vec<Cell>,
) -> Case {
    let r = reference(reference_name);
    let scene = scene(&r, mass, more, &r.omega);
    let attitude = r.attitude;
    problem(name, hard, r, scene, cells, move |q| {
        angle_between(attitude, q)
    })
}

fn problem(
    name: &str,
    hard: &'static str,
    r: Reference,
    scene: String,
    cells: Vec<Cell>,
    off: impl Fn(UnitQuaternion<f64>) -> f64 + Send + Sync + 'static,
) -> Case {
    Case {
        name: name.to_owned(),
        hard,
        problem: Problem {
            scene,
            step: r.step,
            steps: (r.t / r.step).round(),
            rate: Vector3::from(r.omega).norm(),
            thin: {
                let (i, w) = (Vector3::from(r.moments), Vector3::from(r.omega));
                // In units of the smallest, so that squares of moments of 1e149 stay numbers.
                (i / i.min()).component_mul(&w).norm()
            },
            free: true,
            off: Box::new(move |end| off(end.motion.q_wb)),
        },
        cells,
    }
}

/// Nothing is promised, and a line says why.
fn beyond(why: &'static str) -> Vec<Cell> {
    vec![
        cell(EXACT, Must::Hold(4e-15), "no step, no sum: a few roundings"),
        cell(REST, Must::RunOrBeLost, why),
    ]
}

const ENGINE_CROSS: &str = "L × ω of two moments that differ by 1e-12 is rounding, and is divided by the third, as in the engine";

fn thin() -> Vec<Cell> {
    vec![cell(
        &["mujoco-rk4"],
        Must::Degrade(1e-6, 1e-3),
        ENGINE_CROSS,
    )]
}

pub fn shapes() -> Group {
    Group {
        title: "Shapes",
        about: "Free bodies, 1,000 steps of 0.01 s, ω = (1.5, 0.8, -0.6) rad/s. The numbers are the attitude's error at \
                the end, rad, against 60 digits.",
        cases: vec![
            free("rod-1e-3", "I = (1e-3, 1, 1.0005)", vec![]),
            free("rod-1e-6", "I = (1e-6, 1, 1 + 5e-7)", vec![]),
            free(
                "rod-1e-12",
                "I = (1e-12, 1, 1 + 5e-13): L of a method that keeps it in the world is rounded by more than I1 ω1",
                thin(),
            ),
            free(
                "needle-1e-12",
                "I = (1e-12, 1, 1): the same, and two moments equal",
                vec![],
            ),
            free(
                "ratio-1e12",
                "I = (1e12, 1, 1e12): the ratio the other way round, about another axis",
                thin(),
            ),
            free("plate", "I = (1, 2, 3): I1 + I2 = I3", vec![]),
            free(
                "plate-rounded",
                "I = (0.1, 0.2, 0.1 + 0.2): the sum beyond I3 by a rounding",
                vec![],
            ),
            free(
                "strip",
                "I = (1e-6, 1, 1 + 1e-6): a plate and a rod",
                vec![],
            ),
            free("sphere", "equal moments: nothing to divide by", vec![]),
            free("sphere-1-ulp", "moments 1 ulp apart", vec![]),
            free("sphere-10-ulp", "moments 10 ulps apart", vec![]),
            free("round", "I = (1, 1, 1.5): two equal moments", vec![]),
            free("round-1-ulp", "two moments 1 ulp apart", vec![]),
            free("round-10-ulp", "two moments 10 ulps apart", vec![]),
        ],
    }
}

const RUNAWAY: &str = "a rounding beside the middle axis grows as e^{λt}, λ = 2/3 per s: after 55 s it is a flip of its own, 1000 s early";
const FLIPS: &str = "an error grows as e^{λt} until the body flips, here some 1e4 times and more";

pub fn separatrix() -> Group {
    Group {
        title: "The separatrix",
        about: "I = (1, 2, 2.25), on whose separatrix ω = (0.75, 1, 1) lies exactly. Error of the attitude at the end, rad.",
        cases: vec![
            free("on-separatrix", "Jacobi's functions have no period", vec![]),
            free(
                "separatrix-1-ulp-inside",
                "ω3 one ulp more: which side it is shows in the last bit",
                vec![],
            ),
            free("separatrix-1-ulp-outside", "ω1 one ulp more", vec![]),
            free(
                "separatrix-1e-300-inside",
                "ω = (0, 2, 1e-300): its square is no number; it flips after 1035 s. 30,000 steps of 0.05 s",
                beyond(RUNAWAY),
            ),
            free(
                "separatrix-1e-300-outside",
                "ω = (1e-300, 2, 0): the other side",
                beyond(RUNAWAY),
            ),
            free(
                "middle-axis-1e-9",
                "ω = (1e-9, 2, 1e-9), 6,000 steps: one flip, of which every error before it is a shift",
                vec![
                    cell(&["lie-midpoint", "buss"], Must::Degrade(1.0, 3.2), FLIPS),
                    cell(&["buss3"], Must::Degrade(0.1, 1.0), FLIPS),
                    cell(&["cf4"], Must::Degrade(5e-5, 1e-3), FLIPS),
                    cell(ADAPTIVE, Must::Degrade(1e-11, 1e-5), FLIPS),
                    cell(&["dmv8", "dmv10"], Must::Degrade(1e-9, 1e-7), FLIPS),
                ],
            ),
        ],
    }
}

pub fn spins() -> Group {
    let spins = [
        (
            "1e-12",
            "h |ω| = 1e-12: what a step adds is below an ulp of 1",
        ),
        ("1e-08", "h |ω| = 1e-8: its square is below an ulp of 1"),
        ("0.0001", "h |ω| = 1e-4"),
        ("0.01", "h |ω| = 0.01"),
        ("0.1", "h |ω| = 0.1"),
        ("1", "h |ω| = 1: a sixth of a turn a step"),
        ("10", "h |ω| = 10: more than a turn a step; 100 steps"),
        ("100", "h |ω| = 100; 30 steps"),
        ("10000", "h |ω| = 1e4: 1,600 turns a step; 3 steps"),
    ];
    let cells = |n: &str| match n {
        "10000" => vec![cell(
            &["dop853"],
            Must::Degrade(1e-6, 1e-4),
            "its phase is off by the tolerance times the square of 3e4 rad, or some of it",
        )],
        _ => vec![],
    };
    let mut cases: Vec<Case> = spins
        .iter()
        .map(|(n, hard)| free(&format!("spin-{n}"), hard, cells(n)))
        .collect();
    cases.push(free("still", "ω = 0", vec![]));
    cases.push(free(
        "denormal",
        "ω = (5e-324, 1e-310, -3e-320): products are 0, quotients are not",
        vec![],
    ));
    Group {
        title: "Spin",
        about: "I = (1, 2, 2.5), 1,000 steps of 0.01 s where nothing else is said. Error of the attitude at the end, rad.",
        cases,
    }
}

const UNDERFLOW: &str = "its determinant of moments is their product, beyond 64-bit numbers; the engine's, in 32 bits, fails far sooner";

pub fn sizes() -> Group {
    let bullet = || {
        vec![cell(
            &["bullet"],
            Must::BeLost("a mass or a ratio of moments"),
            UNDERFLOW,
        )]
    };
    let mut cases = vec![
        varied(
            "mass-1e-30",
            "mass-1e-30",
            "1e-30 kg, moments as small",
            1e-30,
            "",
            vec![],
        ),
        varied("mass-1e30", "mass-1e30", "1e30 kg", 1e30, "", vec![]),
        varied(
            "nanometre",
            "nanometre",
            "a grain: 1e-24 kg, moments of 1e-42, 1e7 rad/s, 1,000 steps of 1e-9 s",
            1e-24,
            "",
            vec![],
        ),
        varied(
            "planet",
            "planet",
            "6e24 kg, moments of 8e37 that differ by 1e-3, 7.3e-5 rad/s, 1,000 steps of 100 s",
            5.97e24,
            "",
            vec![],
        ),
        free(
            "moments-1e-149",
            "at the edge of what is accepted; squares are denormal",
            bullet(),
        ),
        free("moments-1e149", "at the other edge", bullet()),
    ];
    let r = reference("pivot-kilometre");
    let about_centre = Reference {
        moments: [1.0, 2.0, 2.5],
        ..reference("pivot-kilometre")
    };
    let text = scene(&about_centre, 1.0, "pivot = [0.0, -1000.0, 0.0]", &r.omega);
    let attitude = r.attitude;
    let hard = "1 kg, I = (1, 2, 2.5), on a pivot 1 km away, no weight: a rod of 1e6";
    cases.push(problem(
        "pivot-kilometre",
        hard,
        r,
        text,
        vec![],
        move |q| angle_between(attitude, q),
    ));
    // The attitude (1, 1, 1, 1)/2 takes x to y, y to z and z to x without a rounding.
    let handed = [
        (
            "unnormalised-1e300",
            "1e300",
            "orientation = [1e300, 1e300, 1e300, 1e300]: its square is no number",
        ),
        ("unnormalised-1e-300", "1e-300", "its square is 0"),
        (
            "unnormalised-5e-324",
            "5e-324",
            "the smallest number there is, four times",
        ),
    ];
    for (name, size, hard) in handed {
        let r = reference("plate");
        let [x, y, z] = r.omega;
        let text = scene(
            &r,
            1.0,
            &format!("orientation = [{size}, {size}, {size}, {size}]"),
            &[z, x, y],
        );
        let half = UnitQuaternion::new_unchecked(Quaternion::new(0.5, 0.5, 0.5, 0.5));
        let attitude = half * r.attitude;
        cases.push(problem(name, hard, r, text, vec![], move |q| {
            angle_between(attitude, q)
        }));
    }
    Group {
        title: "Sizes",
        about: "1,000 steps of 0.01 s where nothing else is said. Error of the attitude at the end, rad.",
        cases,
    }
}

pub fn damping() -> Group {
    let stages = "a stage at the start of a step still has all of ω: h ω/6 too far, once";
    let grows = "its damping is a torque inside explicit stages, which grow beyond c h = 2.8";
    let cases = ["0", "0.001", "0.1", "1", "3", "1000", "1e+06"].map(|n| {
        let mut cells = Vec::new();
        if ["3", "1000", "1e+06"].contains(&n) {
            cells.push(cell(
                &["mujoco-rk4"],
                Must::BeLost("too fast for this method"),
                grows,
            ));
            cells.push(cell(&["cf4", "rk4"], Must::Degrade(1e-5, 4e-3), stages));
        }
        let hard = match n {
            "0" => "c = 0: nothing to divide by",
            "1000" => "velocities are 0 after one step",
            "1e+06" => "e^{-ch} is 0 where a rate over it would be infinite",
            _ => "c h is in the name",
        };
        free(&format!("damping-{n}"), hard, cells)
    });
    Group {
        title: "Damping",
        about: "I = (1, 2, 2.5), damped at c, 1,000 steps of 0.01 s; c h is in the name. Error of the attitude at the end, rad.",
        cases: cases.into(),
    }
}

/// Whatever c h is, damping turns no velocity round and lets none grow, step by step.
#[test]
fn damping_never_turns_round_and_never_grows() {
    use crate::{infos, run};
    for ch in [0.0, 1e-12, 1e-3, 0.5, 1.0, 2.0, 3.0, 10.0, 1e3, 1e6] {
        for info in infos() {
            // A sphere: nothing but damping changes ω.
            let text = format!(
                "duration = 0.5\n[stepping]\nmethod = \"{}\"\nstep = 0.01\n[effects]\ngyroscopic = true\n\
                 damping = {{ angular = {c:e}, linear = {c:e} }}\n[[body]]\nname = \"hard\"\nmass = 1.0\n\
                 inertia = [1, 1, 1]\nangular_velocity = [0.3, 0.4, 0.5]\nvelocity = [0.3, 0.4, 0.5]\n",
                info.name,
                c = ch / 0.01
            );
            let (motions, done) = run::motions(&text);
            // Explicit stages on dv/dt = -c v: 1 - z + z²/2 - z³/6 + z⁴/24 is above 1 from z = 2.785.
            let may_grow = info.name == "mujoco-rk4" && ch > 2.7;
            assert!(done.is_ok() || may_grow, "{} at {ch}: {done:?}", info.name);
            if may_grow {
                continue;
            }
            for pair in motions.windows(2) {
                // By a series it is within the tolerance of what there was, 0.7 rad/s, of either sign.
                let slack = match info.damping {
                    Damping::Within(_) => TOLERANCE,
                    _ => 0.0,
                };
                for (before, after) in [
                    (pair[0].omega_w, pair[1].omega_w),
                    (pair[0].velocity_w, pair[1].velocity_w),
                ] {
                    // As long as before but for the rounding of what keeps L and not ω.
                    assert!(
                        after.norm() <= before.norm() * (1.0 + 4e-15) + slack,
                        "{} at {ch}: grows",
                        info.name
                    );
                    assert!(
                        after.dot(&before) >= 0.0 || after.norm() <= slack,
                        "{} at {ch}: turns round",
                        info.name
                    );
                }
            }
        }
    }
}
