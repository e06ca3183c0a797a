//! Ten thousand bodies by every method that takes the steps it is given, and the tutorial's step
//! beside the same step in other hands.

use crate::bodies::{Acting, BLOCKS, Block, Body, H, STEPS, blocks, bodies, steps};
use crate::by_hand::{intrinsics, one_after_another, without_load};
use crate::measure::{Contestant, Timing, contestant, race};
use crate::report::Report;
use torquescope::body::{LANES, State};
use torquescope::integrator::{Interval, Kind, METHODS, Method, Stepper, find};

const UNIT: &str = "ns/body-step";
const BODY_STEPS: usize = BLOCKS * LANES * STEPS;

pub fn set_out(method: &dyn Method, blocks: &[Block]) -> Vec<Box<dyn Stepper>> {
    let start = |block: &Block| method.start(block.interval.clone(), 0.0, &block.state);
    blocks.iter().map(start).collect()
}

/// Methods that are exact on what acts here take none.
fn takes_steps(method: &dyn Method, block: &Block) -> bool {
    let mut stepper = method.start(block.interval.clone(), 0.0, &block.state);
    stepper.advance(&steps(1, H, false), &mut Vec::new());
    stepper.work().evaluations > 0
}

/// Each block through all its steps before the next.
fn by_method<'a>(method: &dyn Method, blocks: &[Block]) -> Contestant<'a> {
    let started = set_out(method, blocks);
    let steps = steps(STEPS, H, false);
    contestant(
        move || started.clone(),
        move |steppers| {
            for stepper in steppers {
                stepper.advance(&steps, &mut Vec::new());
            }
        },
    )
}

pub fn methods(report: &mut Report, repeats: usize) {
    let bodies = bodies(BLOCKS * LANES);
    let fixed = METHODS
        .iter()
        .filter(|method| method.info().kind == Kind::Fixed);
    let mut names = Vec::new();
    let mut contestants = Vec::new();
    for (acting, what) in [
        (Acting::Gyroscopic, "free, gyroscopic"),
        (Acting::Nothing, "free, tutorial's model"),
        (Acting::Torques, "torque on each, tutorial's model"),
    ] {
        let blocks = blocks(&bodies, acting);
        for method in fixed.clone() {
            let Interval { load, inertial, .. } = &blocks[0].interval;
            let takes = method.info().refuses(load, inertial).is_none();
            if takes && takes_steps(*method, &blocks[0]) {
                names.push(format!("{}, {what}", method.info().name));
                contestants.push(by_method(*method, &blocks));
            }
        }
    }
    let times = race(&mut contestants, repeats);
    report.section(
        "methods",
        format!(
            "{} bodies, blocks of {LANES}, {STEPS} steps a block before the next",
            BLOCKS * LANES
        ),
    );
    for (name, time) in names.into_iter().zip(times) {
        report.time(name, time.per(BODY_STEPS), UNIT, "");
    }
}

/// Multiplications and additions of the tutorial's step: see `by_hand`. Doubling is an addition, and
/// the product with (ω, 0) needs no terms for the 0.
const MULTIPLICATIONS: usize = 72;
/// State and what acts: read 13 + 4 + 6 numbers, written 13.
const BYTES: usize = 8 * (23 + 13);

pub fn tutorial(report: &mut Report, repeats: usize) {
    let bodies = bodies(BLOCKS * LANES);
    let method = find("semi-implicit").expect("the tutorial's method");
    let (loaded, empty) = (
        blocks(&bodies, Acting::Torques),
        blocks(&bodies, Acting::Nothing),
    );
    let by_hand: Vec<intrinsics::Block> = bodies.chunks(LANES).map(intrinsics::Block::of).collect();
    let has_avx2 = intrinsics::available();
    check(method, &loaded, &bodies);

    let mut contestants = vec![
        by_method(method, &loaded),
        contestant(
            || bodies.clone(),
            |bodies| {
                for block in bodies.chunks_mut(LANES) {
                    one_after_another(STEPS, block);
                }
            },
        ),
        by_method(method, &empty),
        contestant(
            || empty.clone(),
            |blocks| {
                for block in blocks {
                    for _ in 0..STEPS {
                        without_load(&mut block.state);
                    }
                }
            },
        ),
        contestant(
            || by_hand.clone(),
            |blocks| {
                for block in blocks.iter_mut().filter(|_| has_avx2) {
                    // SAFETY: AVX2 is there.
                    unsafe { intrinsics::steps(STEPS, block) };
                }
            },
        ),
        contestant(
            || (),
            |()| {
                if has_avx2 {
                    // SAFETY: AVX2 is there.
                    unsafe { intrinsics::multiplications(BODY_STEPS * MULTIPLICATIONS) };
                }
            },
        ),
    ];
    let times = race(&mut contestants, repeats);
    let [lanes, scalar, empty, bare, by_hand, limit]: [Timing; 6] =
        std::array::from_fn(|k| times[k].per(BODY_STEPS));

    report.section(
        "tutorial",
        "semi-implicit, a constant torque on each body; the same operations, the same bits",
    );
    report.time("lane loop, as the crate steps", lanes, UNIT, "");
    report.time("one body after another", scalar, UNIT, "");
    report.number(
        "  one after another / lane loop",
        scalar.ns / lanes.ns,
        "x",
        "",
    );
    if has_avx2 {
        report.time("AVX2 intrinsics", by_hand, UNIT, "");
        report.number(
            "  lane loop / intrinsics",
            lanes.ns / by_hand.ns,
            "x",
            "goal 1.25 or less",
        );
        report.time(
            "limit: its multiplications alone",
            limit,
            UNIT,
            format!("{MULTIPLICATIONS} a body-step"),
        );
        report.number("  intrinsics / limit", by_hand.ns / limit.ns, "x", "");
        report.number("  lane loop / limit", lanes.ns / limit.ns, "x", "");
    }
    report.number(
        "memory",
        BYTES as f64,
        "B/body-step",
        "in cache after the first step",
    );

    report.section(
        "absent",
        "what a load that holds nothing costs: semi-implicit, nothing acts",
    );
    report.time("with an empty load", empty, UNIT, "");
    report.time("the kernel without a load", bare, UNIT, "");
    report.number(
        "  with / without",
        empty.ns / bare.ns,
        "x",
        "goal 1, to the spread",
    );
}

/// That all ways give the same bits, or a panic.
fn check(method: &dyn Method, blocks: &[Block], bodies: &[Body]) {
    let steps = steps(STEPS, H, false);
    for (block, bodies) in blocks.iter().zip(bodies.chunks(LANES)) {
        let mut stepper = method.start(block.interval.clone(), 0.0, &block.state);
        stepper.advance(&steps, &mut Vec::new());
        let state = stepper.state();
        let mut scalar = bodies.to_vec();
        one_after_another(STEPS, &mut scalar);
        let mut by_hand = intrinsics::Block::of(bodies);
        if intrinsics::available() {
            // SAFETY: AVX2 is there.
            unsafe { intrinsics::steps(STEPS, &mut by_hand) };
        }
        for (lane, body) in scalar.iter().enumerate() {
            assert_eq!(
                bits(&state.get(lane)),
                bits(&body.state),
                "one after another"
            );
            if intrinsics::available() {
                assert_eq!(
                    bits(&state.get(lane)),
                    bits(&by_hand.state(lane)),
                    "intrinsics"
                );
            }
        }
    }
}

fn bits(s: &State) -> Vec<u64> {
    let vectors = [s.x_w, s.v_w, s.omega_w];
    let numbers = vectors.iter().flatten().chain(s.q_wp.coords.iter());
    numbers.map(|x| x.to_bits()).collect()
}
