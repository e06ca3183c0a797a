//! `accuracy = 1e-9` in place of a method and a step: for every body and every interval between
//! events the cheapest way that keeps to it.
//!
//! The closed form where the active effects allow one. Else candidates are run over the first part
//! of the interval and compared with the truest motion there; the cheapest that keeps its share of
//! the error is taken. What all of it comes to is measured over the whole scene, and where that is
//! too much the shares are made smaller.
//!
//! Costs are counted (steps times what a step costs, [`crate::integrator::Cost`]), not timed: the
//! same scene has the same plan on every machine.

use super::check::{self, Pose, apart, largest, radius_of_gyration};
use super::reference::{Reference, by_truth, exact_to, truest};
use crate::body::{Inertial, State, StateBlock};
use crate::integrator::{Kind, Method, Step};
use crate::scene::{Scene, Stepping};
use crate::sim::{Choice, Choose, Setting, SimError, Stated};
use crate::trace::short;
use nalgebra::{UnitQuaternion, Vector3};
use std::collections::HashMap;
use std::ops::Range;

/// What was chosen for some bodies between two events.
#[derive(Clone)]
pub struct Planned {
    /// Indices of the bodies.
    pub members: Range<usize>,
    /// s.
    pub from: f64,
    pub until: f64,
    /// What is active, by name.
    pub effects: Vec<String>,
    pub choice: Choice,
    /// Of the method's own step, s; none where it has none.
    pub step: Option<f64>,
    /// Of this interval, rad, where it was measured: that of its first part, growing with time.
    pub expected: Option<f64>,
}

/// A way through a whole scene.
pub struct Plan {
    pub intervals: Vec<Planned>,
    /// Asked for, rad.
    pub accuracy: Option<f64>,
    /// The largest error there was in a run by this plan, rad, at the instants compared.
    pub achieved: f64,
    /// How far the motion it was compared with can be believed, rad.
    pub uncertainty: f64,
    /// By which methods that motion was had, and checked.
    pub by: Vec<&'static str>,
    pub checked_by: Vec<&'static str>,
}

/// Why there is no plan.
#[derive(Debug, thiserror::Error)]
pub enum PlanError {
    #[error(
        "accuracy = {} rad cannot be had in this scene: with 64-bit numbers its end is known to {} rad; {}",
        short(*.asked), short(*.had),
        if *.had < 0.1 { "ask for no less than that" } else { "its errors grow too fast: make it shorter" }
    )]
    BeyondReach {
        asked: f64,
        /// rad, rounded up.
        had: f64,
    },
    #[error(transparent)]
    Sim(#[from] SimError),
}

/// Times the shares are made smaller before it is given up.
const ATTEMPTS: usize = 10;

impl Plan {
    /// Plans a scene that states an accuracy; measures one that states a method.
    pub fn of(scene: &Scene) -> Result<Self, PlanError> {
        let reference = Reference::of(scene)?;
        match scene.stepping {
            Stepping::Method { method, tolerance } => {
                let usual = Choice {
                    method,
                    pieces: 1,
                    tolerance,
                };
                let stated = Stated::of(scene);
                let stated = stated.unwrap_or_else(|| Stated::where_none_is_own(scene, usual));
                Self::by_method(scene, &reference, stated)
            }
            Stepping::Accuracy(asked) => {
                let reference = match reference.uncertainty < asked {
                    true => reference,
                    false => reference.finer(scene)?,
                };
                Self::by_accuracy(scene, &reference, asked)
            }
        }
    }

    fn by_method(scene: &Scene, reference: &Reference, stated: Stated) -> Result<Self, PlanError> {
        let mut planner = Planner {
            clock: scene.step,
            duration: scene.duration,
            way: Way::Stated(stated),
            log: Vec::new(),
            last: HashMap::new(),
        };
        let achieved = check::run(scene, &mut planner)?.apart(&reference.run);
        Ok(Self::new(planner.log, None, achieved, reference))
    }

    fn by_accuracy(scene: &Scene, reference: &Reference, asked: f64) -> Result<Self, PlanError> {
        let beyond = |had: f64| PlanError::BeyondReach {
            asked,
            had: rounded_up(had),
        };
        if reference.uncertainty >= asked {
            return Err(beyond(reference.uncertainty));
        }
        // Half for what is measured, half for how errors grow.
        let mut share = 0.5 * asked;
        let mut before: Option<Vec<Planned>> = None;
        for attempt in 0..=ATTEMPTS {
            let way = match attempt {
                // What the reference itself was had by, which is known to do.
                ATTEMPTS => Way::Truest,
                _ => Way::Cheapest { share },
            };
            let mut planner = Planner {
                clock: scene.step,
                duration: scene.duration,
                way,
                log: Vec::new(),
                last: HashMap::new(),
            };
            let achieved = match check::run(scene, &mut planner) {
                Ok(run) => run.apart(&reference.run),
                Err(SimError::NotFinite { .. }) => f64::INFINITY,
                Err(error) => return Err(error.into()),
            };
            if achieved + reference.uncertainty <= asked || attempt == ATTEMPTS {
                return Ok(Self::new(planner.log, Some(asked), achieved, reference));
            }
            // Errors grow by more than their time: allow the less for it. Where that changes nothing
            // yet, a good deal less.
            let same = before
                .as_ref()
                .is_some_and(|log| same_choices(log, &planner.log));
            share *= match same {
                true => 1e-3,
                false => (0.5 * asked / achieved).clamp(1e-6, 0.5),
            };
            before = Some(planner.log);
        }
        Err(beyond(reference.uncertainty))
    }

    fn new(
        intervals: Vec<Planned>,
        accuracy: Option<f64>,
        achieved: f64,
        reference: &Reference,
    ) -> Self {
        Self {
            intervals,
            accuracy,
            achieved,
            uncertainty: reference.uncertainty,
            by: reference.by.clone(),
            checked_by: reference.checked_by.clone(),
        }
    }

    /// What chooses as planned.
    pub fn chooser(&self) -> impl Choose + use<> {
        let planned = self.intervals.iter();
        Replay(
            planned
                .map(|planned| (place(&planned.members, planned.from), planned.choice))
                .collect(),
        )
    }
}

fn same_choices(a: &[Planned], b: &[Planned]) -> bool {
    let same = |(a, b): (&Planned, &Planned)| {
        let (a, b) = (&a.choice, &b.choice);
        a.method.info().name == b.method.info().name
            && a.pieces == b.pieces
            && a.tolerance == b.tolerance
    };
    a.len() == b.len() && a.iter().zip(b).all(same)
}

/// Two digits, upwards.
fn rounded_up(x: f64) -> f64 {
    let unit = libm::pow(10.0, libm::floor(libm::log10(x)) - 1.0);
    (x / unit).ceil() * unit
}

/// Where an interval begins: with whom, and when.
type Place = (usize, u64);

fn place(members: &Range<usize>, from: f64) -> Place {
    (members.start, from.to_bits())
}

struct Replay(HashMap<Place, Choice>);

impl Choose for Replay {
    fn choose(&mut self, setting: &Setting<'_>) -> Choice {
        let choice = self.0.get(&place(&setting.members, setting.from));
        let taken = choice.filter(|choice| {
            let info = choice.method.info();
            (info.refuses(&setting.interval.load, &setting.interval.inertial)).is_none()
        });
        // Intervals begin where they began when the scene was planned, but for a click so near an edge
        // that it hits by one way and not by another: then the truest there is.
        taken.map_or_else(|| truest(setting.interval, 0), |&choice| choice)
    }
}

enum Way {
    Stated(Stated),
    Truest,
    Cheapest {
        /// Of the whole scene's error, rad.
        share: f64,
    },
}

/// Chooses, and keeps what it chose.
struct Planner {
    clock: f64,
    duration: f64,
    way: Way,
    log: Vec<Planned>,
    /// By first body of a group: its last interval in the log.
    last: HashMap<usize, usize>,
}

impl Choose for Planner {
    fn choose(&mut self, setting: &Setting<'_>) -> Choice {
        let (choice, expected) = match &mut self.way {
            Way::Stated(stated) => (stated.choose(setting), None),
            Way::Truest => (truest(setting.interval, 0), None),
            &mut Way::Cheapest { share } => self.cheapest(setting, share),
        };
        let step = match choice.method.info().kind {
            Kind::Fixed => {
                let whole = setting.interval.until - setting.from;
                Some((self.clock / f64::from(choice.pieces)).min(whole))
            }
            Kind::Adaptive | Kind::Closed => None,
        };
        // A click that hits ends an interval before it was to end.
        let last = self.last.insert(setting.members.start, self.log.len());
        if let Some(before) = last.and_then(|last| self.log.get_mut(last)) {
            before.until = before.until.min(setting.from);
        }
        self.log.push(Planned {
            members: setting.members.clone(),
            from: setting.from,
            until: setting.interval.until,
            effects: setting.interval.load.names(),
            choice,
            step,
            expected,
        });
        choice
    }
}

/// Clock steps over which candidates are compared.
const WINDOW: usize = 48;
/// Pieces of a clock step at most.
const MOST_PIECES: u32 = 1 << 12;
/// Below this an error that halving the step does not lessen by a third is rounding, rad.
const ROUNDING: f64 = 1e-9;
/// Tolerances that are tried, each a tenth of the last.
const LOOSEST: f64 = 1e-5;
const TIGHTEST: f64 = 1e-16;

impl Planner {
    /// The cheapest choice whose error over the window is its part of `share`.
    fn cheapest(&self, setting: &Setting<'_>, share: f64) -> (Choice, Option<f64>) {
        let interval = setting.interval;
        let best = truest(interval, 0);
        if best.method.info().kind == Kind::Closed {
            return (best, Some(exact_to(setting)));
        }
        let trial = Trial::new(setting, self.clock);
        let allowed = share * trial.length() / self.duration;
        let truth = trial.states(best);
        let mut winner: Option<(f64, Choice, f64)> = None;
        // The truest first: a way once found bounds what others may cost.
        for method in by_truth(interval) {
            if method.info().order < 2 {
                continue;
            }
            let cheaper = |cost: f64| winner.is_none_or(|(least, ..)| cost < least);
            if let Some(found) = trial.first_within(method, allowed, &truth, &cheaper) {
                winner = Some(found);
            }
        }
        match winner {
            Some((_, choice, error)) => {
                let whole = (interval.until - setting.from) / trial.length();
                (choice, Some(error * whole.max(1.0)))
            }
            None => (best, None),
        }
    }
}

/// The first steps of an interval, to try methods on.
struct Trial<'a> {
    setting: &'a Setting<'a>,
    steps: Vec<Step>,
}

impl<'a> Trial<'a> {
    fn new(setting: &'a Setting<'a>, clock: f64) -> Self {
        let (from, until) = (setting.from, setting.interval.until);
        let whole = ((until - from) / clock).ceil().max(1.0);
        let count = whole.min(WINDOW as f64) as usize;
        // An interval shorter than the window is tried whole, in even steps.
        let h = if whole <= WINDOW as f64 {
            (until - from) / count as f64
        } else {
            clock
        };
        let step = |k: usize| Step {
            from: from + h * k as f64,
            h,
            to: from + h * (k + 1) as f64,
            keep: true,
        };
        Self {
            setting,
            steps: (0..count).map(step).collect(),
        }
    }

    fn length(&self) -> f64 {
        self.steps.iter().map(|step| step.h).sum()
    }

    fn states(&self, choice: Choice) -> Vec<StateBlock> {
        self.run(choice).0
    }

    /// The states at the ends of the steps, and how many steps the method itself took.
    fn run(&self, choice: Choice) -> (Vec<StateBlock>, u64) {
        let Setting {
            interval,
            from,
            state,
            ..
        } = *self.setting;
        let mut stepper = choice.start(interval.clone(), from, state);
        let mut kept = Vec::with_capacity(self.steps.len());
        stepper.advance(&self.steps, &mut kept);
        (kept, stepper.work().steps)
    }

    /// The coarsest way by this method that keeps the error, as long as it is `cheaper`: its cost,
    /// the way, its error.
    fn first_within(
        &self,
        method: &'static dyn Method,
        allowed: f64,
        truth: &[StateBlock],
        cheaper: &impl Fn(f64) -> bool,
    ) -> Option<(f64, Choice, f64)> {
        let weight = method.info().cost.weight;
        let mut choice = Choice {
            method,
            pieces: 1,
            tolerance: LOOSEST,
        };
        let adaptive = method.info().kind == Kind::Adaptive;
        let mut before = f64::INFINITY;
        loop {
            let count = self.steps.len() as f64 * f64::from(choice.pieces);
            if !adaptive && !cheaper(count * weight) {
                return None;
            }
            let (states, steps) = self.run(choice);
            let cost = steps as f64 * weight;
            let error = self.error(&states, truth);
            if error <= allowed {
                return cheaper(cost).then_some((cost, choice, error));
            }
            if error < ROUNDING && error > 0.67 * before {
                return None;
            }
            before = error;
            if adaptive {
                choice.tolerance *= 0.1;
                if choice.tolerance < TIGHTEST {
                    return None;
                }
            } else {
                let order = f64::from(method.info().order);
                let left = f64::from(MOST_PIECES / choice.pieces);
                choice.pieces *= 2;
                // Not even the finest would do, by the order that the method has.
                if choice.pieces > MOST_PIECES || error * libm::pow(left, -order) > allowed {
                    return None;
                }
            }
        }
    }

    /// The largest error, rad; infinite where a state is lost.
    fn error(&self, states: &[StateBlock], truth: &[StateBlock]) -> f64 {
        let lanes = 0..self.setting.members.len();
        let each = lanes.flat_map(|lane| {
            let body = self.setting.interval.inertial.get(lane);
            let pose = move |block: &StateBlock| pose(&body, &block.get(lane));
            let pairs = states.iter().zip(truth);
            pairs.map(move |(a, b)| apart(&pose(a), &pose(b)))
        });
        largest(each)
    }
}

/// In principal axes.
fn pose(body: &Inertial, s: &State) -> Pose {
    let free = body.inv_mass > 0.0;
    let radius = radius_of_gyration(body.moments.sum(), body.mass);
    Pose {
        q_wb: UnitQuaternion::new_unchecked(s.q_wp),
        place: if free {
            s.x_w / radius
        } else {
            Vector3::zeros()
        },
    }
}
