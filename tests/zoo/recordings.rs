//! The recordings of the zoo: every fault over bodies, spins, rates, noise and missing columns; what is right and looks
//! wrong; and what cannot tell.

use super::engine::*;
use super::turn::*;
use nalgebra::{Matrix3, Vector3};
use torquescope::log::{Declared, Logged, Rows};

/// What the answer must be.
#[derive(Clone, Debug, PartialEq)]
pub enum Want {
    /// This cause, or, where a recording cannot tell some apart, a set with this one in it.
    Fault(&'static str),
    Fine,
    CannotTell,
}

pub struct Recording {
    /// What it is of, and its number.
    pub name: String,
    pub want: Want,
    pub noisy: bool,
    pub logged: Logged,
}

/// How it is written down.
#[derive(Clone, Copy, Default)]
struct Pen {
    noisy: bool,
    no_omega: bool,
    no_attitude: bool,
    no_position: bool,
    no_torque: bool,
    no_bodies: bool,
    /// Every so many rows.
    every: usize,
    /// Numbers are printed with so many digits; 0: all.
    digits: i32,
    /// Numbers are f32.
    single: bool,
    /// Some rows are missing, some hold what is no number.
    holes: bool,
    /// The body turns about a joint: its centre of mass is at this place from it.
    joint: Option<V>,
    /// ω is another body's.
    stranger: bool,
}

fn written(run: &Run, pen: Pen, name: &str, draw: &mut Draw) -> Logged {
    let steps = run.rows();
    let speed = {
        let sum: f64 = steps.iter().map(|r| dot(r.omega, r.omega)).sum();
        (sum / steps.len() as f64).sqrt()
    };
    let mut rows = Rows::default();
    let mut flip = 1.0;
    for (k, row) in steps.iter().step_by(pen.every.max(1)).enumerate() {
        if pen.holes && k % 97 == 90 {
            continue;
        }
        let r = matrix(row.q);
        let centre = pen.joint.map_or(row.x, |d| apply(&r, d));
        let mut x = sub(centre, apply(&r, run.body.centre));
        let (mut q, mut omega) = (row.q, row.omega);
        match run.fault {
            Fault::OmegaInBody => omega = apply(&transposed(&r), omega),
            Fault::EulerRates(order) => omega = euler_rates(&r, omega, order),
            Fault::Degrees(s) => omega = scaled(omega, s),
            Fault::Axes(axes) => omega = axes.map(|(sign, axis)| sign * omega[axis]),
            _ => {}
        }
        if pen.noisy {
            omega = add(omega, scaled(draw.normals(), 0.01 * speed));
            q = times(turn(scaled(draw.normals(), 0.2_f64.to_radians())), q);
        }
        match run.fault {
            Fault::QuaternionOrder => q = [q[3], q[0], q[1], q[2]],
            Fault::QuaternionConjugated => q = conjugate(q),
            Fault::CoarseAttitude => q = q.map(half),
            Fault::FarAway => x = x.map(|x| f64::from(x as f32)),
            Fault::DoubleCover => {
                if draw.unit() < 0.05 {
                    flip = -flip;
                }
                q = q.map(|x| x * flip);
            }
            _ => {}
        }
        if pen.stranger {
            let t = row.t;
            omega = [
                2.0 * libm::sin(3.0 * t),
                1.0 + libm::cos(2.0 * t),
                3.0 * libm::sin(t + 1.0),
            ];
        }
        let print = |x: f64| {
            if pen.single {
                f64::from(x as f32)
            } else if pen.digits > 0 && x != 0.0 {
                let unit =
                    libm::exp10(libm::floor(libm::log10(x.abs())) + 1.0 - f64::from(pen.digits));
                (x / unit).round() * unit
            } else {
                x
            }
        };
        (x, q, omega) = (x.map(print), q.map(print), omega.map(print));
        if pen.holes && k % 131 == 50 {
            omega[1] = f64::NAN;
        }
        if pen.holes && k % 151 == 70 {
            q = [0.0; 4];
        }
        rows.times.push(row.t);
        if !pen.no_position {
            rows.positions.push(x);
        }
        if !pen.no_attitude {
            rows.attitudes.push(q);
        }
        if !pen.no_omega {
            rows.omegas.push(omega);
        }
        if (run.torque.is_some() || run.fault == Fault::LongWay) && !pen.no_torque {
            rows.torques.push(row.torque);
        }
        if run.force.is_some() {
            rows.forces.push(row.force);
            rows.points.push(row.point);
        }
    }
    let i = run.body.inertia;
    Logged {
        name: name.to_owned(),
        declared: (!pen.no_bodies).then(|| Declared {
            mass: Some(run.body.mass),
            inertia_b: Matrix3::from_fn(|a, b| i[a][b]),
            centre_of_mass_b: Vector3::from(run.body.centre),
            size: run.body.size.map(Vector3::from),
        }),
        rows,
    }
}

/// To the nearest number of 11 bits, as IEEE's half precision has.
fn half(x: f64) -> f64 {
    if x == 0.0 {
        return 0.0;
    }
    let grid = libm::exp2(libm::floor(libm::log2(x.abs())).max(-14.0) - 10.0);
    (x / grid).round() * grid
}

/// The rates of the angles of `R = R_a(α) R_b(β) R_c(γ)`, each in the slot of its axis: `ω = α̇ a + R_a β̇ b + R_a R_b γ̇ c`.
fn euler_rates(r: &M, omega: V, [a, b, c]: [usize; 3]) -> V {
    let axis = |i: usize| {
        let mut v = [0.0; 3];
        v[i] = 1.0;
        v
    };
    let sign = if (a + 1) % 3 == b { 1.0 } else { -1.0 };
    // R_a R_b R_c e_c = R_a R_b e_c; its a-component is ± sin β, its b- and c-components turn with α.
    let third = apply(r, axis(c));
    let alpha = libm::atan2(-sign * third[b], third[c]);
    let second = apply(&matrix(turn(scaled(axis(a), alpha))), axis(b));
    let columns = transposed(&[axis(a), second, third]);
    let rates = apply(&inverse(&columns), omega);
    let mut slots = [0.0; 3];
    for (slot, rate) in [a, b, c].into_iter().zip(rates) {
        slots[slot] = rate;
    }
    slots
}

/// A box of some size whose moments are well apart, and its size.
fn solid(draw: &mut Draw) -> (f64, V, V) {
    loop {
        let size = [
            draw.between(0.2, 1.2),
            draw.between(0.2, 1.2),
            draw.between(0.2, 1.2),
        ];
        let mass = draw.between(0.5, 12.0);
        let [a, b, c] = size.map(|s| s * s * mass / 12.0);
        let moments = [b + c, a + c, a + b];
        let mut sorted = moments;
        sorted.sort_by(f64::total_cmp);
        if sorted[1] > 1.25 * sorted[0] && sorted[2] > 1.15 * sorted[1] {
            return (mass, moments, size);
        }
    }
}

#[derive(Clone, Copy, PartialEq)]
pub enum Loads {
    None,
    Torque,
    Force,
}

/// A rich recording: unequal moments, a spin off the axes, loads in many directions.
fn rich(draw: &mut Draw, loads: Loads, tilted: bool, offset: bool) -> Run {
    let (mass, moments, size) = solid(draw);
    let turned = matrix(draw.attitude());
    let inertia = if tilted {
        carried(&turned, &diagonal(moments))
    } else {
        diagonal(moments)
    };
    let speed = draw.between(2.0, 7.0);
    // Off the axes: each component in the body has at least a fifth of it.
    let spin_p = loop {
        let d = draw.direction();
        if d.iter().all(|x| x.abs() > 0.25) {
            break scaled(d, speed);
        }
    };
    let q = draw.attitude();
    let r = matrix(q);
    let spin_b = if tilted {
        apply(&turned, spin_p)
    } else {
        spin_p
    };
    let rate = draw.of(&[100.0, 120.0, 240.0, 500.0]);
    let seconds = draw.between(3.0, 6.0);
    let middle = {
        let mut m = moments;
        m.sort_by(f64::total_cmp);
        m[1]
    };
    let tau = middle * speed * speed * draw.between(0.3, 0.7);
    let waves = |draw: &mut Draw, size: f64| Waves {
        amplitude: scaled([1.0, draw.between(0.6, 1.0), draw.between(0.6, 1.0)], size),
        frequency: [
            draw.between(0.4, 1.2),
            draw.between(0.4, 1.2),
            draw.between(0.4, 1.2),
        ],
        phase: [
            draw.between(0.0, 6.0),
            draw.between(0.0, 6.0),
            draw.between(0.0, 6.0),
        ],
        span: (0.0, f64::INFINITY),
        beat: 0.0,
    };
    let centre = if offset {
        scaled(draw.direction(), draw.between(0.08, 0.3))
    } else {
        [0.0; 3]
    };
    let arm = scaled(draw.direction(), 0.4 * size[0].max(size[1]).max(size[2]));
    let force = waves(draw, tau / norm(arm));
    let torque = waves(draw, tau);
    Run {
        fault: Fault::None,
        gyroscopic: true,
        stepping: Stepping::Fine(4),
        body: Body {
            mass,
            inertia,
            centre,
            size: (!tilted).then_some(size),
        },
        q,
        omega: apply(&r, spin_b),
        x: [
            draw.between(1.0, 3.0),
            draw.between(-2.0, -0.5),
            draw.between(0.5, 2.0),
        ],
        v: scaled(draw.direction(), draw.between(0.2, 1.0)),
        gravity: draw.of(&[[0.0; 3], [0.0, -9.81, 0.0], [0.0, 0.0, -9.81]]),
        torque: (loads == Loads::Torque).then_some(torque),
        force: (loads == Loads::Force).then_some((force, arm)),
        rate,
        rows: (seconds * rate) as usize,
        knocks: 0,
        contact: (0.0, 0.0),
        unlogged: None,
    }
}

/// E of a row, about the centre of mass.
fn energy(row: &Row, inertia: &M) -> f64 {
    let omega_b = apply(&transposed(&matrix(row.q)), row.omega);
    0.5 * dot(omega_b, apply(inertia, omega_b))
}

/// By how much of itself the energy goes off, torque-free.
fn energy_off(run: &Run) -> f64 {
    let rows = run.rows();
    let (first, last) = (&rows[0], &rows[rows.len() - 1]);
    energy(last, &run.body.inertia) / energy(first, &run.body.inertia) - 1.0
}

fn fastest(run: &Run) -> f64 {
    run.rows().iter().map(|r| norm(r.omega)).fold(0.0, f64::max)
}

/// Every recording of a seed, `each` for every fault.
pub fn zoo(seed: u64, each: usize) -> Vec<Recording> {
    let mut all = Vec::new();
    for (kind, (cause, _)) in FAULTS.iter().enumerate() {
        for i in 0..each {
            let mut draw = Draw::new(seed.wrapping_mul(1_000_003) + (kind * 1_000 + i) as u64);
            let (run, pen) = faulty(cause, i, &mut draw);
            let name = format!("{cause} {i}");
            all.push(Recording {
                want: Want::Fault(cause),
                noisy: pen.noisy,
                logged: written(&run, pen, &name, &mut draw),
                name,
            });
        }
    }
    for (kind, control) in CONTROLS.iter().enumerate() {
        for i in 0..each.div_ceil(2) {
            let mut draw = Draw::new(seed.wrapping_mul(7_000_003) + (kind * 1_000 + i) as u64);
            let (run, pen) = right(control, i, &mut draw);
            let name = format!("right: {control} {i}");
            all.push(Recording {
                want: Want::Fine,
                noisy: pen.noisy,
                logged: written(&run, pen, &name, &mut draw),
                name,
            });
        }
    }
    for (kind, blind) in BLIND.iter().enumerate() {
        for i in 0..each.div_ceil(3) {
            let mut draw = Draw::new(seed.wrapping_mul(11_000_003) + (kind * 1_000 + i) as u64);
            let (run, pen) = hidden(blind, i, &mut draw);
            let name = format!("blind: {blind} {i}");
            all.push(Recording {
                want: Want::CannotTell,
                noisy: pen.noisy,
                logged: written(&run, pen, &name, &mut draw),
                name,
            });
        }
    }
    all
}

/// Every fault, and the loads that it takes to see it: none, a torque, a force; or any.
pub const FAULTS: &[(&str, Option<Loads>)] = &[
    ("gyroscopic-missing", None),
    ("gyroscopic-sign", None),
    ("gyroscopic-diagonal-only", None),
    ("energy-gained-by-integrator", Some(Loads::None)),
    ("energy-lost-by-integrator", Some(Loads::None)),
    ("inertia-not-rotated", Some(Loads::Torque)),
    ("inertia-rotated-backwards", Some(Loads::Torque)),
    ("inertia-not-inverted", Some(Loads::Torque)),
    ("torque-in-body-frame", Some(Loads::Torque)),
    ("angular-velocity-in-body-frame", None),
    ("euler-rates-as-omega", None),
    ("quaternion-order", None),
    ("quaternion-conjugated", None),
    ("quaternion-multiplied-on-wrong-side", None),
    ("half-factor", None),
    ("degrees", None),
    ("handedness", None),
    ("centre-of-mass-ignored", None),
    ("lever-point-stale", Some(Loads::Force)),
    ("lever-from-origin", Some(Loads::Force)),
    ("inertia-about-wrong-point", Some(Loads::Torque)),
    ("products-of-inertia-sign", None),
    ("products-of-inertia-dropped", None),
    ("inertia-scale", Some(Loads::Torque)),
    ("inertia-not-physical", None),
    ("force-lifetime", Some(Loads::Force)),
    ("damping-explicit", None),
    ("speed-clamp", Some(Loads::Torque)),
    ("sleep", Some(Loads::None)),
    ("precision", None),
    ("norm-drift", None),
    ("double-cover", Some(Loads::None)),
];

fn faulty(cause: &str, i: usize, draw: &mut Draw) -> (Run, Pen) {
    let needs = FAULTS.iter().find(|f| f.0 == cause).and_then(|f| f.1);
    let loads = needs.unwrap_or_else(|| [Loads::None, Loads::Torque, Loads::Force][i % 3]);
    let products = cause.contains("products") || cause.contains("diagonal");
    let tilted = products || (i % 4 == 1 && cause != "inertia-not-physical");
    let offset = cause == "centre-of-mass-ignored" || i % 3 == 1;
    let mut pen = Pen {
        noisy: i % 3 == 2,
        no_position: i % 5 == 3 && loads != Loads::Force && cause != "centre-of-mass-ignored",
        ..Pen::default()
    };
    if pen.no_position && cause == "precision" {
        pen.no_position = false;
    }
    let mut run = rich(draw, loads, tilted, offset);
    // Faults that are in the law are seen whichever way it is stepped, as long as that is right.
    if i % 4 == 3 {
        run.stepping = Stepping::Fine(1);
    }
    run.fault = match cause {
        "gyroscopic-missing" => {
            run.stepping = [
                Stepping::SemiImplicit(1),
                Stepping::SemiImplicit(4),
                Stepping::Fine(2),
            ][i % 3];
            Fault::GyroscopicMissing
        }
        "gyroscopic-sign" => Fault::GyroscopicSign,
        "gyroscopic-diagonal-only" => Fault::GyroscopicDiagonalOnly,
        "energy-gained-by-integrator" | "energy-lost-by-integrator" => {
            let gained = cause.contains("gained");
            let parts = [1, 2, 1, 4][i % 4];
            run.stepping = if gained {
                Stepping::SemiImplicit(parts)
            } else {
                Stepping::Implicit(parts)
            };
            run.rate = [60.0, 100.0, 120.0][i % 3];
            // As fast as it takes to go off by some percent in these seconds.
            for _ in 0..20 {
                run.rows = (6.0 * run.rate) as usize;
                if energy_off(&run).abs() > 0.03 {
                    break;
                }
                run.omega = scaled(run.omega, 1.15);
            }
            Fault::None
        }
        "inertia-not-rotated" => Fault::InertiaNotRotated,
        "inertia-rotated-backwards" => Fault::InertiaRotatedBackwards,
        "inertia-not-inverted" => {
            // With moments of some hundredths or tens α would be off by thousands, and nothing else could be seen.
            let m = run.body.inertia;
            let s = 1.0 / (m[0][0] + m[1][1] + m[2][2]) * 3.0 * draw.between(0.7, 1.4);
            run.body.inertia = m.map(|row| row.map(|x| x * s));
            run.body.mass *= s;
            let tau = &mut run.torque.as_mut().unwrap().amplitude;
            *tau = scaled(*tau, s);
            Fault::InertiaNotInverted
        }
        "torque-in-body-frame" => [Fault::TorqueInBodyFrame, Fault::TorqueTurnedBack][i % 2],
        "angular-velocity-in-body-frame" => Fault::OmegaInBody,
        "euler-rates-as-omega" => Fault::EulerRates(draw.of(&[
            [0, 1, 2],
            [0, 2, 1],
            [1, 0, 2],
            [1, 2, 0],
            [2, 0, 1],
            [2, 1, 0],
        ])),
        "quaternion-order" => Fault::QuaternionOrder,
        "quaternion-conjugated" => Fault::QuaternionConjugated,
        "quaternion-multiplied-on-wrong-side" => Fault::WrongSide,
        "half-factor" => Fault::Factor([2.0, 0.5][i % 2]),
        "degrees" => {
            Fault::Degrees([180.0 / std::f64::consts::PI, std::f64::consts::PI / 180.0][i % 4 / 3])
        }
        "handedness" => Fault::Axes(
            [
                [(-1.0, 0), (-1.0, 1), (-1.0, 2)],
                [(-1.0, 0), (-1.0, 1), (1.0, 2)],
                [(-1.0, 0), (-1.0, 2), (-1.0, 1)],
                [(1.0, 0), (1.0, 1), (-1.0, 2)],
            ][i % 4],
        ),
        "centre-of-mass-ignored" => Fault::CentreIgnored,
        "lever-point-stale" => Fault::LeverStale,
        "lever-from-origin" => {
            if i % 3 == 1 {
                Fault::LeverFromBodyOrigin
            } else {
                Fault::LeverFromOrigin
            }
        }
        "inertia-about-wrong-point" => {
            let gyration = (run.body.inertia[0][0] / run.body.mass).sqrt();
            Fault::InertiaAbout(scaled(draw.direction(), gyration * draw.between(0.7, 1.5)))
        }
        "products-of-inertia-sign" => Fault::ProductsSign,
        "products-of-inertia-dropped" => Fault::ProductsDropped,
        "inertia-scale" => Fault::InertiaScale([1000.0, 0.5, 2.5, 1e-2, 10.0, 0.1][i % 6]),
        "inertia-not-physical" => {
            let mut m = [
                run.body.inertia[0][0],
                run.body.inertia[1][1],
                run.body.inertia[2][2],
            ];
            m.sort_by(f64::total_cmp);
            m[2] = (m[0] + m[1]) * draw.between(1.1, 1.6);
            run.body.inertia = diagonal(m);
            Fault::None
        }
        "force-lifetime" => [
            Fault::ForPart(0.5),
            Fault::NeverCleared,
            Fault::ForPart(0.25),
            Fault::ClearedLate,
        ][i % 4],
        "damping-explicit" => Fault::Damping(draw.between(0.15, 0.6)),
        "speed-clamp" => Fault::Clamp(1.05 * norm(run.omega)),
        "sleep" => {
            run.omega = scaled(run.omega, 0.3 / norm(run.omega));
            run.rate = 60.0;
            run.rows = 420;
            Fault::Sleep(0.5, draw.between(2.0, 4.0))
        }
        "precision" => [Fault::CoarseAttitude, Fault::FarAway][i % 2],
        "norm-drift" => {
            run.rate = [60.0, 100.0][i % 2];
            run.rows = (4.0 * run.rate) as usize;
            Fault::NotNormalised
        }
        "double-cover" => {
            run.rate = 100.0;
            run.rows = 600;
            Fault::LongWay
        }
        _ => unreachable!("{cause}"),
    };
    if i % 7 == 4 && cause != "norm-drift" {
        pen.digits = 7;
    }
    // Many an engine leaves the gyroscopic term out besides.
    let besides = matches!(
        cause,
        "inertia-not-rotated"
            | "inertia-rotated-backwards"
            | "inertia-not-inverted"
            | "torque-in-body-frame"
            | "lever-point-stale"
            | "lever-from-origin"
            | "inertia-scale"
            | "force-lifetime"
    );
    if besides && i % 4 == 2 {
        run.gyroscopic = false;
        run.stepping = Stepping::SemiImplicit(1);
    } else if (cause.starts_with("products") || cause.starts_with("gyroscopic") || besides)
        && i % 8 == 5
        && cause != "force-lifetime"
    {
        run.stepping = Stepping::SemiImplicit(2);
    }
    if i == 6 && (besides || cause.starts_with("gyroscopic") || cause.starts_with("products")) {
        pen.no_omega = true;
    }
    match run.fault {
        Fault::LeverStale | Fault::LeverFromOrigin => {
            // Levers of metres: forces that do not throw the body about.
            let (waves, _) = run.force.as_mut().unwrap();
            waves.amplitude = scaled(waves.amplitude, 0.15);
            // None that spins it up without end.
            while fastest(&run) > 0.3 * run.rate {
                let (waves, _) = run.force.as_mut().unwrap();
                waves.amplitude = scaled(waves.amplitude, 0.6);
            }
        }
        Fault::NeverCleared | Fault::ClearedLate => {
            let (waves, _) = run.force.as_mut().unwrap();
            waves.beat = 0.8;
            if run.fault == Fault::NeverCleared {
                waves.amplitude = scaled(waves.amplitude, 0.02);
            }
        }
        Fault::InertiaScale(s) => {
            let waves = run.torque.as_mut().unwrap();
            waves.amplitude = scaled(waves.amplitude, s.clamp(0.05, 20.0));
        }
        Fault::InertiaAbout(_) => {
            let waves = run.torque.as_mut().unwrap();
            waves.amplitude = scaled(waves.amplitude, 2.0);
        }
        Fault::FarAway => {
            run.x = scaled(draw.direction(), draw.of(&[1e6, 4e6, 2e7]));
            run.gravity = [0.0; 3];
            if loads == Loads::Force {
                run.force = None;
            }
        }
        _ => {}
    }
    (run, pen)
}

/// What is right, and looks odd.
pub const CONTROLS: &[&str] = &[
    "tumbling freely",
    "under a torque",
    "under a force at a point",
    "flips of the middle axis",
    "wobble of a body of revolution",
    "precession under a torque",
    "an offset centre of mass",
    "signs of q that flip",
    "products of inertia",
    "every fourth step logged",
    "small steps of first order",
    "knocks between free flights",
    "no omega",
    "no positions",
    "pulses of torque",
    "far from the origin",
    "fast",
    "slow",
    "printed with six digits",
    "single precision",
    "a while on the floor",
    "rows lost, and numbers that are none",
    "a controller that minds the sign",
];

fn right(control: &str, i: usize, draw: &mut Draw) -> (Run, Pen) {
    let loads = match control {
        "under a torque" | "precession under a torque" | "pulses of torque" => Loads::Torque,
        "under a force at a point" => Loads::Force,
        "an offset centre of mass" | "every fourth step logged" | "far from the origin" => {
            [Loads::None, Loads::Torque, Loads::Force][i % 3]
        }
        "a controller that minds the sign" => Loads::Torque,
        "signs of q that flip" | "no positions" | "products of inertia" => {
            [Loads::None, Loads::Torque][i % 2]
        }
        _ => Loads::None,
    };
    let mut run = rich(
        draw,
        loads,
        control == "products of inertia" || i % 4 == 1,
        control == "an offset centre of mass" || i % 2 == 1,
    );
    let mut pen = Pen {
        noisy: i % 3 == 2,
        ..Pen::default()
    };
    let speed = norm(run.omega);
    match control {
        "flips of the middle axis" => {
            let (mass, moments, size) = solid(draw);
            run.body = Body {
                mass,
                inertia: diagonal(moments),
                centre: [0.0; 3],
                size: Some(size),
            };
            let mut order = [0, 1, 2];
            order.sort_by(|&a, &b| moments[a].total_cmp(&moments[b]));
            let mut spin = [0.0; 3];
            spin[order[1]] = 6.0;
            spin[order[0]] = 0.15;
            spin[order[2]] = 0.1;
            run.omega = apply(&matrix(run.q), spin);
            run.rows = (8.0 * run.rate) as usize;
        }
        "wobble of a body of revolution" => {
            let (a, c) = (draw.between(0.1, 0.3), draw.between(0.35, 0.5));
            run.body.inertia = diagonal([a, a, c.min(1.9 * a)]);
            run.body.size = None;
            run.body.mass = 3.0;
            let tilt = draw.between(0.4, 1.0);
            let spin = [speed * libm::sin(tilt), 0.0, speed * libm::cos(tilt)];
            run.omega = apply(&matrix(run.q), spin);
        }
        "precession under a torque" => {
            let (a, c) = (draw.between(0.1, 0.3), draw.between(0.35, 0.5));
            run.body.inertia = diagonal([a, a, c.min(1.9 * a)]);
            run.body.size = None;
            run.body.mass = 3.0;
            run.omega = apply(&matrix(run.q), [1.5, 0.5, 7.0]);
            let torque = run.torque.as_mut().unwrap();
            torque.amplitude = [1.0, 0.2, 0.6];
            torque.frequency = [0.0; 3];
            torque.phase = [1.5; 3];
        }
        "signs of q that flip" | "a controller that minds the sign" => {
            run.fault = Fault::DoubleCover
        }
        "every fourth step logged" => {
            run.rate = 960.0;
            run.rows = 4_000;
            pen.every = if loads == Loads::None { 4 } else { 1 };
        }
        "small steps of first order" => {
            run.stepping = [Stepping::SemiImplicit(8), Stepping::Restored(2)][i % 2];
            run.rate = 500.0;
            run.rows = 1_500;
            for _ in 0..40 {
                if energy_off(&run).abs() < 0.0015 {
                    break;
                }
                run.omega = scaled(run.omega, 0.85);
            }
        }
        "knocks between free flights" => run.knocks = 2 + i % 2,
        "no omega" => pen.no_omega = true,
        "no positions" => pen.no_position = true,
        "pulses of torque" => run.torque.as_mut().unwrap().beat = 0.9,
        "far from the origin" => run.x = [2e3, -1e3, 1e3],
        "fast" => {
            run.omega = scaled(run.omega, 25.0 / speed);
            run.rate = 500.0;
            run.rows = 1_500;
        }
        "printed with six digits" => pen.digits = 6,
        "single precision" => pen.single = true,
        "a while on the floor" => {
            let end = run.rows as f64 / run.rate;
            run.contact = (0.3 * end, 0.55 * end);
        }
        "rows lost, and numbers that are none" => pen.holes = true,
        "slow" => {
            run.omega = scaled(run.omega, 0.4 / speed);
            run.rate = 60.0;
            run.rows = 1_200;
        }
        _ => {}
    }
    (run, pen)
}

/// What cannot tell, whatever the engine does: half of them are of faulty ones.
pub const BLIND: &[&str] = &[
    "a ball",
    "a cube",
    "a spin about one axis",
    "at rest",
    "one row",
    "a few rows",
    "turns of half a turn a row",
    "no bodies file",
    "no attitudes",
    "a torque that nobody wrote down",
    "a cube under a torque about the axis of its spin",
    "the omega of another body",
    "on a joint",
];

fn hidden(blind: &str, i: usize, draw: &mut Draw) -> (Run, Pen) {
    let mut run = rich(draw, Loads::None, false, false);
    let mut pen = Pen {
        noisy: i % 3 == 2,
        ..Pen::default()
    };
    if i % 2 == 1 {
        run.fault = Fault::GyroscopicMissing;
    }
    match blind {
        "a ball" | "a cube" => {
            run.body.inertia = diagonal([0.3; 3]);
            run.body.mass = 4.0;
            run.body.size = None;
        }
        "a spin about one axis" => run.omega = apply(&matrix(run.q), [0.0, 4.0, 0.0]),
        "at rest" => run.omega = [0.0; 3],
        "one row" => run.rows = 1,
        "a few rows" => run.rows = 4,
        "turns of half a turn a row" => {
            run.omega = scaled(run.omega, 60.0 / norm(run.omega));
            run.rate = 20.0;
            run.stepping = Stepping::Fine(100);
            run.rows = 200;
        }
        "no bodies file" => pen.no_bodies = true,
        "on a joint" => {
            let gyration = (run.body.inertia[0][0] / run.body.mass).sqrt();
            let d = scaled(draw.direction(), 1.2 * gyration);
            run.fault = Fault::InertiaAbout(d);
            pen.joint = Some(d);
        }
        "the omega of another body" => pen.stranger = true,
        "no attitudes" => pen.no_attitude = true,
        "a torque that nobody wrote down" => {
            let more = rich(draw, Loads::Torque, false, false);
            let mut waves = more.torque.unwrap();
            let tau = norm(waves.amplitude);
            let i = run.body.inertia;
            let want = 0.5 * (i[0][0] + i[1][1] + i[2][2]) / 3.0 * dot(run.omega, run.omega);
            waves.amplitude = scaled(waves.amplitude, want / tau);
            run.unlogged = Some(waves);
        }
        "a cube under a torque about the axis of its spin" => {
            run.body.inertia = diagonal([0.3; 3]);
            run.body.mass = 4.0;
            run.body.size = None;
            run.q = [0.0, 0.0, 0.0, 1.0];
            run.omega = [0.0, 3.0, 0.0];
            let more = rich(draw, Loads::Torque, false, false);
            let mut waves = more.torque.unwrap();
            waves.amplitude = [0.0, 0.8, 0.0];
            run.torque = Some(waves);
        }
        _ => unreachable!("{blind}"),
    }
    (run, pen)
}
