//! A very long time: what is run, and what is inferred.

use crate::cells::{Case, EXACT};
use crate::free::free;
use crate::page::coarse;
use crate::run::{Seen, see};
use crate::{infos, run};
use std::fmt::Write as _;
use std::sync::OnceLock;
use torquescope::integrator::MethodInfo;

/// Errors after 1e3, 1e4 and 1e5 steps of 0.01 s, all run; infinite where a run stopped before.
struct Growth {
    info: &'static MethodInfo,
    errors: [f64; 3],
}

impl Growth {
    fn of(info: &'static MethodInfo) -> Self {
        let error = |name: &str| match see(&free(name, "", Vec::new()), info) {
            Seen::Off { off, .. } => off,
            Seen::Lost { .. } => f64::INFINITY,
            other => panic!("{}: {other:?}", info.name),
        };
        Self {
            info,
            errors: ["steps-1e3", "steps-1e4", "steps-1e5"].map(error),
        }
    }

    /// The power of the time that the error grows by; none where it has grown to be any angle.
    fn power(&self) -> Option<f64> {
        let [_, before, after] = self.errors;
        (after < 0.3).then(|| libm::log10(after / before))
    }

    /// After 1e9 steps, if it goes on as it did from 1e4 to 1e5.
    fn inferred(&self) -> Option<f64> {
        let power = self.power()?;
        Some(self.errors[2] * libm::pow(10.0, 4.0 * power.max(0.0)))
    }

    fn is_exact(&self) -> bool {
        EXACT.contains(&self.info.name)
    }
}

fn growths() -> &'static [Growth] {
    static GROWTHS: OnceLock<Vec<Growth>> = OnceLock::new();
    GROWTHS.get_or_init(|| infos().map(Growth::of).collect())
}

/// At t = 1e7 s, 1e9 steps of 0.01 s, and at 1e9 s, through 1,000 instants each: what has no steps is run.
fn exact() -> [f64; 2] {
    static EXACT: OnceLock<[f64; 2]> = OnceLock::new();
    let last = |name: &str| {
        let mut case: Case = free(name, "", Vec::new());
        case.problem.step = case.problem.step * case.problem.steps / 1000.0;
        let each = infos().filter(|info| self::EXACT.contains(&info.name));
        let errors = each.map(|info| match see(&case, info) {
            Seen::Off { off, .. } => off,
            other => panic!("{name}, {}: {other:?}", info.name),
        });
        errors.fold(0.0, f64::max)
    };
    *EXACT.get_or_init(|| ["steps-1e9", "seconds-1e9"].map(last))
}

pub fn section() -> String {
    let [steps, seconds] = exact();
    let mut text = format!(
        "\n## A very long time\n\nI = (1, 2, 2.5), ω = (1.5, 0.8, -0.6) rad/s, steps of 0.01 s; error of the attitude, rad, against 60 digits. 1e3, 1e4 and \
         1e5 steps are run by every method. What 1e9 steps come to is run for those that are exact on a free body, which take no steps: \
         the worst of the seven is {} rad at 1e9 steps (t = 1e7 s) and {} rad at t = 1e9 s, looked at at 1,000 instants each. For the \
         others it is inferred: the error goes on growing as it did from 1e4 to 1e5 steps. Time itself does not drift: a clock's \
         node is a whole number of steps, and the 1e12th of 1 ms is 1e9 s to the last bit (src/sim/schedule.rs).\n\n\
         | method | 1e3 steps | 1e4 | 1e5 | grows as | 1e9, inferred |\n| --- | --: | --: | --: | --: | --: |\n",
        coarse(steps),
        coarse(seconds)
    );
    for growth in growths() {
        let [a, b, c] = growth.errors.map(|off| match off.is_finite() {
            true => coarse(off),
            false => "lost".to_owned(),
        });
        let (power, inferred) = match (growth.is_exact(), growth.power(), growth.inferred()) {
            (true, ..) => ("–".to_owned(), format!("{}, run", coarse(steps))),
            (_, Some(power), Some(x)) if x < 0.3 => (format!("t^{power:.1}"), coarse(x)),
            (_, Some(power), _) => (format!("t^{power:.1}"), "any angle".to_owned()),
            _ => ("–".to_owned(), "any angle".to_owned()),
        };
        let _ = writeln!(
            text,
            "| {} | {a} | {b} | {c} | {power} | {inferred} |",
            growth.info.name
        );
    }
    text
}

#[test]
fn errors_grow_no_faster_than_they_must_and_where_there_are_no_steps_not_at_all() {
    let [steps, seconds] = exact();
    assert!(steps < 4e-15 && seconds < 4e-15, "{steps:e} {seconds:e}");
    for growth in growths() {
        let bound = if growth.is_exact() { 4e-15 } else { 3.2 };
        assert!(
            growth
                .errors
                .iter()
                .all(|off| *off <= bound || (growth.info.order == 1 && off.is_infinite())),
            "{}: {:?}",
            growth.info.name,
            growth.errors
        );
        // A phase that is off at a rate grows as t, a rate that drifts makes it t²: and rounding wobbles.
        if let Some(power) = growth.power() {
            assert!(power < 2.2, "{}: {power}", growth.info.name);
        }
    }
}

/// Where a clock starts does not matter to a method of fixed steps: at 1e9 s, where a time has ulps of 1e-7 s, it
/// takes the same steps, to the bit.
#[test]
fn a_late_start_changes_no_bit_of_fixed_steps() {
    use torquescope::body::{InertialBlock, State, StateBlock};
    use torquescope::effect::Load;
    use torquescope::integrator::{Interval, Kind, METHODS, Step};
    let mut load = Load::default();
    load.set_gyroscopic();
    let (mut inertial, mut block) = (InertialBlock::default(), StateBlock::default());
    inertial.set(0, run::body([1.0, 2.0, 2.5]));
    let start = State {
        omega_w: nalgebra::Vector3::new(1.5, 0.8, -0.6),
        ..block.get(0)
    };
    block.set(0, start);
    for method in METHODS {
        let info = method.info();
        // What needs no steps reads the clock, and is off by no more than the clock's own ulp.
        if info.kind != Kind::Fixed || info.exact_free {
            continue;
        }
        let end = |t: f64| {
            let interval = Interval {
                load: load.clone(),
                inertial,
                bodies: 1,
                until: t + 1.0,
                tolerance: 1e-12,
            };
            let at = |k: u32| t + 1e-3 * f64::from(k);
            let steps: Vec<Step> = (0..1000)
                .map(|k| Step {
                    from: at(k),
                    h: 1e-3,
                    to: at(k + 1),
                    keep: false,
                })
                .collect();
            let mut stepper = method.start(interval, t, &block);
            stepper.advance(&steps, &mut Vec::new());
            stepper.state().get(0)
        };
        assert_eq!(end(0.0), end(1e9), "{}", info.name);
    }
}
