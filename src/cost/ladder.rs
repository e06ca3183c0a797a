//! A scene run by every method over a ladder of steps or tolerances: the error of each run against
//! the truest motion, and what it took.

use super::check::{self, bare};
use super::reference::Reference;
use crate::integrator::{DEFAULT_METHOD, Kind, Method};
use crate::scene::{Record, Scene, Stepping};
use crate::sim::{Choice, Choose, SimError, Stated};
use crate::trace::short;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// What to run, and how long.
pub struct Ladder {
    pub methods: Vec<&'static dyn Method>,
    /// Runs of each rung at least; more where a run is short.
    pub repeats: usize,
    /// A rung that would take longer than this is not climbed to.
    pub longest: Duration,
}

/// One method at one step or tolerance.
#[derive(Clone, Debug)]
pub struct Rung {
    pub method: &'static str,
    /// s, for a method of fixed steps.
    pub step: Option<f64>,
    /// For a method that chooses its own.
    pub tolerance: Option<f64>,
    /// The largest distance from the true motion at the instants compared, rad ([`super::apart`]),
    /// and not less than that is known to; infinite where a state was lost.
    pub error: f64,
    /// The largest difference from the true kinetic energy, as a part of its largest.
    pub energy_drift: f64,
    /// The same of angular momentum.
    pub momentum_drift: f64,
    /// Wall time a simulated second, s.
    pub time: Spread,
    /// Per simulated second: evaluations of the equations of motion, a block of eight counting once.
    pub evaluations: f64,
    /// Per simulated second: of the method's own.
    pub steps: f64,
    /// Of the whole recording with a state at every step of the clock.
    pub bytes: Option<u64>,
    /// No cheaper rung is as true.
    pub on_front: bool,
    /// The method and step that the scene itself states.
    pub own: bool,
}

/// Of repeated measurements.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spread {
    pub least: f64,
    pub median: f64,
    pub most: f64,
}

/// All of it.
#[derive(Clone, Debug)]
pub struct Cost {
    pub rungs: Vec<Rung>,
    /// Methods that do not take the scene's torques, and why.
    pub refused: Vec<(&'static str, String)>,
    pub uncertainty: f64,
    pub by: Vec<&'static str>,
    pub checked_by: Vec<&'static str>,
    /// Instants at which attitudes were compared.
    pub instants: usize,
    pub duration: f64,
}

/// How far it is.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    pub method: &'static str,
    /// Methods done, of how many.
    pub done: usize,
    pub of: usize,
}

/// Measures the bytes of a scene's recording.
pub type Weigh<'a> = &'a dyn Fn(&Scene, &mut dyn Choose) -> Option<u64>;

/// Instants compared.
const INSTANTS: f64 = 50.0;
/// Time spent on repeating a rung.
const ENOUGH: Duration = Duration::from_millis(20);
const LOOSEST: f64 = 1e-3;
const TIGHTEST: f64 = 1e-16;
/// More steps than this between two instants are not climbed to.
const MOST_PIECES: u64 = 10_000_000;

impl Ladder {
    /// Measures; `watch` sees how far it is and can stop it, and what is done by then is returned.
    pub fn measure(
        &self,
        scene: &Scene,
        weigh: Weigh<'_>,
        watch: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Cost, SimError> {
        let between = scene.duration / INSTANTS;
        let record = &scene.record;
        let stated = (scene.stepping, scene.step);
        let scene = bare(scene, between, 1.0 / between);
        let reference = Reference::of(&scene)?;
        let mut cost = Cost {
            rungs: Vec::new(),
            refused: Vec::new(),
            uncertainty: reference.uncertainty,
            by: reference.by.clone(),
            checked_by: reference.checked_by.clone(),
            instants: reference.run.kept.len(),
            duration: scene.duration,
        };
        for (done, method) in self.methods.iter().enumerate() {
            let mut stopped = false;
            let mut watch = || {
                let progress = Progress {
                    method: method.info().name,
                    done,
                    of: self.methods.len(),
                };
                stopped |= watch(progress).is_break();
                stopped
            };
            if let Some(why) = refusal(&scene, *method) {
                cost.refused.push((method.info().name, why));
            } else {
                let climb = Climb {
                    ladder: self,
                    scene: &scene,
                    reference: &reference,
                    method: *method,
                    record,
                    weigh,
                };
                climb.rungs(&mut cost.rungs, &mut watch);
                climb.own_rung(stated, &mut cost.rungs);
            }
            if watch() {
                break;
            }
        }
        mark_front(&mut cost.rungs);
        Ok(cost)
    }
}

/// Why a method does not take a scene.
pub(super) fn refusal(scene: &Scene, method: &'static dyn Method) -> Option<String> {
    let mut scene = scene.clone();
    scene.stepping = Stepping::Method {
        method,
        tolerance: LOOSEST,
    };
    scene.refusal()
}

/// The rungs of one method.
struct Climb<'a> {
    ladder: &'a Ladder,
    scene: &'a Scene,
    reference: &'a Reference,
    method: &'static dyn Method,
    /// What the scene itself records.
    record: &'a Record,
    weigh: Weigh<'a>,
}

impl Climb<'_> {
    fn rungs(&self, rungs: &mut Vec<Rung>, stopped: &mut dyn FnMut() -> bool) {
        let between = self.scene.step;
        match self.method.info().kind {
            Kind::Closed => rungs.extend(self.rung(between, None)),
            Kind::Adaptive => {
                let mut tolerance = LOOSEST;
                while tolerance >= TIGHTEST && !stopped() {
                    rungs.extend(self.rung(between, Some(tolerance)));
                    tolerance *= 0.1;
                }
            }
            Kind::Fixed => {
                let mut last: Option<Rung> = None;
                for pieces in one_two_five().take_while(|&pieces| pieces <= MOST_PIECES) {
                    if stopped() || self.is_as_far_as_it_goes(last.as_ref(), rungs) {
                        break;
                    }
                    last = self.rung(between / pieces as f64, None);
                    rungs.extend(last.clone());
                }
            }
        }
    }

    /// The rung of the scene's own step (the nearest that meets the instants) or tolerance.
    fn own_rung(&self, (stepping, step): (Stepping, f64), rungs: &mut Vec<Rung>) {
        let Stepping::Method { method, tolerance } = stepping else {
            return;
        };
        if method.info().name != self.method.info().name {
            return;
        }
        let between = self.scene.step;
        let own = match method.info().kind {
            Kind::Closed => None,
            Kind::Adaptive => self.rung(between, Some(tolerance)),
            Kind::Fixed => self.rung(between / (between / step).round().max(1.0), None),
        };
        rungs.extend(own.map(|rung| Rung { own: true, ..rung }));
    }

    /// The next rung would take too long, or rounding has taken over.
    fn is_as_far_as_it_goes(&self, last: Option<&Rung>, rungs: &[Rung]) -> bool {
        let Some(last) = last else {
            return false;
        };
        let run = last.time.median * self.scene.duration;
        if 2.5 * run > self.ladder.longest.as_secs_f64() {
            return true;
        }
        let mut own = rungs.iter().rev().filter(|rung| rung.method == last.method);
        let before = own.nth(1).map_or(f64::INFINITY, |rung| rung.error);
        // Below this no method of fixed steps that is still gaining gains so little.
        last.error < 1e-10 && last.error > 0.8 * before
    }

    fn rung(&self, step: f64, tolerance: Option<f64>) -> Option<Rung> {
        let mut scene = self.scene.clone();
        scene.step = step;
        let choice = Choice {
            method: self.method,
            pieces: 1,
            tolerance: tolerance.unwrap_or(TIGHTEST),
        };
        let mut times = Vec::new();
        let mut spent = Duration::ZERO;
        let mut run = None;
        while times.len() < self.ladder.repeats || (spent < ENOUGH && times.len() < 50) {
            let start = Instant::now();
            let once = check::run(&scene, &mut Stated::by(choice));
            let took = once
                .as_ref()
                .map_or_else(|_| start.elapsed(), |run| run.took);
            spent += took;
            times.push(took.as_secs_f64() / scene.duration);
            let lost = once.is_err();
            run = Some(once);
            if lost || spent > self.ladder.longest {
                break;
            }
        }
        let (error, energy_drift, momentum_drift, work) = match run? {
            Ok(run) => {
                let truth = &self.reference.run;
                (
                    // What is nearer to the reference than that is to the truth is not nearer to
                    // the truth for it.
                    run.apart(truth).max(self.reference.uncertainty),
                    run.energy_drift(truth),
                    run.momentum_drift(truth),
                    run.outcome.work,
                )
            }
            Err(_) => (
                f64::INFINITY,
                f64::INFINITY,
                f64::INFINITY,
                Default::default(),
            ),
        };
        let fixed = self.method.info().kind == Kind::Fixed;
        Some(Rung {
            method: self.method.info().name,
            step: fixed.then_some(step),
            tolerance,
            error,
            energy_drift,
            momentum_drift,
            time: Spread::of(times),
            evaluations: work.evaluations as f64 / scene.duration,
            steps: work.steps as f64 / scene.duration,
            bytes: {
                scene.record = self.record.clone();
                (self.weigh)(&scene, &mut Stated::by(choice))
            },
            on_front: false,
            own: false,
        })
    }
}

/// 1, 2, 5, 10, 20, 50, …
fn one_two_five() -> impl Iterator<Item = u64> {
    (0..=7).flat_map(|k| [1, 2, 5].map(|n| n * 10_u64.pow(k)))
}

impl Spread {
    fn of(mut times: Vec<f64>) -> Self {
        times.sort_by(f64::total_cmp);
        match (times.first(), times.get(times.len() / 2), times.last()) {
            (Some(&least), Some(&median), Some(&most)) => Self {
                least,
                median,
                most,
            },
            _ => Self::default(),
        }
    }
}

/// An attitude more than this off (rad) says nothing about a motion.
pub const LOST: f64 = 1.0;

/// Marks the rungs to which no other is both cheaper and truer.
fn mark_front(rungs: &mut [Rung]) {
    let mut order: Vec<usize> = (0..rungs.len()).collect();
    order.sort_by(|&a, &b| rungs[a].time.median.total_cmp(&rungs[b].time.median));
    let mut truest = LOST;
    for k in order {
        if rungs[k].error < truest {
            truest = rungs[k].error;
            rungs[k].on_front = true;
        }
    }
}

/// Times nearer than this are the same.
const TIE: f64 = 1.25;

/// What to do, for an accuracy.
pub struct Advice<'a> {
    /// rad.
    pub accuracy: f64,
    /// The cheapest that keeps to it.
    pub best: Option<&'a Rung>,
    /// The cheapest of the usual method, where it keeps to it at all.
    pub usual: Option<&'a Rung>,
}

impl Cost {
    /// The cheapest rung of some kind that is off by at most `accuracy` rad; among those as cheap,
    /// but for what the clock tells apart, one that needs no step.
    pub fn cheapest(&self, accuracy: f64, of: impl Fn(&Rung) -> bool) -> Option<&Rung> {
        let mut good = self.rungs.iter().filter(|r| r.error <= accuracy && of(r));
        let time = |rung: &&Rung| rung.time.median;
        let least = good.clone().min_by(|a, b| time(a).total_cmp(&time(b)))?;
        let stepless = good.find(|rung| rung.step.is_none() && rung.tolerance.is_none());
        let as_cheap = stepless.filter(|rung| rung.time.median <= TIE * least.time.median);
        Some(as_cheap.unwrap_or(least))
    }

    pub fn advice(&self, accuracy: f64) -> Advice<'_> {
        Advice {
            accuracy,
            best: self.cheapest(accuracy, |_| true),
            usual: self.cheapest(accuracy, |rung| rung.method == DEFAULT_METHOD),
        }
    }

    /// The rung of the scene's own method and step.
    pub fn own(&self) -> Option<&Rung> {
        self.rungs.iter().find(|rung| rung.own)
    }

    /// The least error of all rungs, rad.
    pub fn truest(&self) -> f64 {
        let errors = self.rungs.iter().map(|rung| rung.error);
        errors.fold(f64::INFINITY, f64::min)
    }
}

impl Rung {
    /// The method and how it was set, such as `rk4 at 0.5 ms`.
    pub fn setting(&self) -> String {
        match (self.step, self.tolerance) {
            (Some(step), _) => format!("{} at {}", self.method, time(step)),
            (None, Some(tolerance)) => format!("{} at tolerance {tolerance:.0e}", self.method),
            (None, None) => self.method.to_owned(),
        }
    }
}

/// A time with the unit that suits it.
pub fn time(seconds: f64) -> String {
    let units = [("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)];
    let (unit, size) = units
        .into_iter()
        .find(|&(_, size)| seconds >= 0.9995 * size)
        .unwrap_or(("ns", 1e-9));
    format!("{} {unit}", short3(seconds / size))
}

/// Three significant digits.
fn short3(x: f64) -> String {
    let rounded: f64 = format!("{x:.2e}").parse().unwrap_or(x);
    short(rounded)
}

impl std::fmt::Display for Advice<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "for {:e} rad: ", self.accuracy)?;
        let Some(best) = self.best else {
            return write!(f, "no method that was measured comes so near");
        };
        write!(f, "{}", best.setting())?;
        match self.usual {
            None => write!(f, "; {DEFAULT_METHOD} did not come so near"),
            Some(usual) if std::ptr::eq(usual, best) => Ok(()),
            Some(usual) => {
                let times = usual.time.median / best.time.median;
                write!(f, ", {}× cheaper than {}", short3(times), usual.setting())
            }
        }
    }
}
