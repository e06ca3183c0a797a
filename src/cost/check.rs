//! Runs kept at a few instants, to be compared.

use crate::math::angle_between;
use crate::scene::{Rate, Scene};
use crate::sim::{Choose, Outcome, SimError, Simulation};
use crate::trace::{Instant, Note, Sample, Sink, SinkError, StreamSet, Subject, Track};
use nalgebra::{UnitQuaternion, Vector3};
use std::ops::Range;
use std::time::Duration;

/// Where a body is, as far as errors go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    pub q_wb: UnitQuaternion<f64>,
    /// The centre of mass of a free body in its radii of gyration, `√(tr I / 2m)`, world; nothing for
    /// a held one, whose attitude says where it is.
    pub place: Vector3<f64>,
}

/// What is compared of a body at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checked {
    pub pose: Pose,
    /// About the reference point, world, kg m²/s.
    pub momentum_w: Vector3<f64>,
    /// Kinetic, J.
    pub energy: f64,
}

impl Checked {
    pub fn of(subject: &Subject, sample: &Sample) -> Self {
        Self {
            pose: Pose {
                q_wb: sample.motion.q_wb,
                place: match (subject.pivot_b, subject.mass) {
                    (None, Some(mass)) => {
                        let radius = radius_of_gyration(subject.inertia_c.trace(), mass);
                        sample.motion.position_w / radius
                    }
                    _ => Vector3::zeros(),
                },
            },
            momentum_w: subject.momentum_w(&sample.motion),
            energy: subject.energy(&sample.motion),
        }
    }
}

/// `√(tr I / 2m)`, m: `∫ r² dm` is half the trace.
pub fn radius_of_gyration(trace: f64, mass: f64) -> f64 {
    (0.5 * trace / mass).sqrt()
}

/// How far two poses of a body are apart, rad: the angle between the attitudes, or the distance
/// between the places in radii of gyration, whichever is more. (A point of the body moves by about
/// that part of its size either way.)
pub fn apart(a: &Pose, b: &Pose) -> f64 {
    let (turned, moved) = (angle_between(a.q_wb, b.q_wb), (a.place - b.place).norm());
    // Not f64::max, which would hide what is not a number.
    if moved.is_nan() || moved > turned {
        moved
    } else {
        turned
    }
}

/// Keeps all bodies at some instants of the display rate.
pub struct Checks {
    subjects: Vec<Subject>,
    /// Every how manieth instant.
    every: usize,
    seen: usize,
    last: f64,
    pub kept: Vec<(Instant, Vec<Checked>)>,
}

/// Instants compared at most, over a run.
const MOST: f64 = 512.0;

impl Checks {
    fn new(scene: &Scene, subjects: &[Subject]) -> Self {
        let instants = scene.duration * scene.record.rate.min(1.0 / scene.step);
        Self {
            subjects: subjects.to_vec(),
            every: (instants / MOST).ceil().max(1.0) as usize,
            seen: 0,
            last: f64::NEG_INFINITY,
            kept: Vec::new(),
        }
    }
}

impl Sink for Checks {
    fn motions(&mut self, _: &Track<'_>) -> Result<(), SinkError> {
        Ok(())
    }

    fn samples(
        &mut self,
        at: Instant,
        bodies: Range<usize>,
        samples: &[Sample],
    ) -> Result<(), SinkError> {
        // Rows of single bodies stand on either side of an event and are passed over; where there is
        // one body they are compared as well, the first of the two: events are at the same instants
        // in every run.
        if bodies.len() != self.subjects.len() || at.time == self.last {
            return Ok(());
        }
        self.last = at.time;
        if self.seen.is_multiple_of(self.every) {
            let checked = self.subjects.iter().zip(samples);
            let checked = checked.map(|(s, m)| Checked::of(s, m)).collect();
            self.kept.push((at, checked));
        }
        self.seen += 1;
        Ok(())
    }

    fn note(&mut self, _: Instant, _: &Note) -> Result<(), SinkError> {
        Ok(())
    }
}

/// A run, and its end, kept for comparison.
pub struct Run {
    pub outcome: Outcome,
    /// Wall time from the first step to the last, looking at the instants included.
    pub took: Duration,
    pub kept: Vec<(Instant, Vec<Checked>)>,
    pub end: Vec<Checked>,
}

pub fn run(scene: &Scene, chooser: &mut dyn Choose) -> Result<Run, SimError> {
    let simulation = Simulation::new(scene).on_threads(1);
    let subjects = simulation.subjects().to_vec();
    let mut checks = Checks::new(scene, &subjects);
    let start = std::time::Instant::now();
    let (outcome, done) = simulation.run_by(chooser, &mut checks);
    let took = start.elapsed();
    done?;
    let ends = subjects.iter().zip(&outcome.end);
    let end = ends.map(|(s, m)| Checked::of(s, m)).collect();
    Ok(Run {
        outcome,
        took,
        kept: checks.kept,
        end,
    })
}

/// The same scene with nothing recorded but the instants to compare, `rate` a second, and no body with a
/// method of its own.
pub fn bare(scene: &Scene, step: f64, rate: f64) -> Scene {
    let mut scene = scene.clone();
    scene.step = step;
    scene.record.rate = rate;
    scene.record.state = Rate::PerSecond(rate);
    scene.record.streams = StreamSet::none();
    scene.record.rates.clear();
    for body in &mut scene.bodies {
        body.method = None;
    }
    scene
}

impl Run {
    /// All instants of a body at which it is compared, the end last.
    fn of(&self, body: usize) -> impl Iterator<Item = &Checked> {
        let kept = self.kept.iter().map(move |(_, bodies)| &bodies[body]);
        kept.chain(std::iter::once(&self.end[body]))
    }

    fn is_at_the_instants_of(&self, other: &Self) -> bool {
        // `k h` and `(k n) (h / n)` may differ by a rounding or two.
        let same = |(a, b): (f64, f64)| (a - b).abs() <= 1e-12 * (1.0 + a.abs());
        let mine = self.kept.iter().map(|(at, _)| at.time);
        let others = other.kept.iter().map(|(at, _)| at.time);
        self.kept.len() == other.kept.len() && mine.zip(others).all(same)
    }

    fn bodies(&self) -> usize {
        self.end.len()
    }

    /// The largest distance [`apart`] of two runs over the same instants, rad.
    pub fn apart(&self, other: &Self) -> f64 {
        debug_assert!(self.is_at_the_instants_of(other));
        let bodies = (0..self.bodies()).map(|k| {
            let pairs = self.of(k).zip(other.of(k));
            largest(pairs.map(|(a, b)| apart(&a.pose, &b.pose)))
        });
        largest(bodies)
    }

    /// The largest difference in kinetic energy, as a part of the largest energy in `truth`.
    pub fn energy_drift(&self, truth: &Self) -> f64 {
        self.part(
            truth,
            |a| a.energy.abs(),
            |a, b| (a.energy - b.energy).abs(),
        )
    }

    /// The largest difference in angular momentum, as a part of the largest in `truth`.
    pub fn momentum_drift(&self, truth: &Self) -> f64 {
        let size = |a: &Checked| a.momentum_w.norm();
        self.part(truth, size, |a, b| (a.momentum_w - b.momentum_w).norm())
    }

    fn part(
        &self,
        truth: &Self,
        size: impl Fn(&Checked) -> f64,
        difference: impl Fn(&Checked, &Checked) -> f64,
    ) -> f64 {
        let bodies = (0..self.bodies()).map(|k| {
            let of = largest(truth.of(k).map(&size));
            let pairs = self.of(k).zip(truth.of(k));
            let off = largest(pairs.map(|(a, b)| difference(a, b)));
            if off == 0.0 { 0.0 } else { off / of }
        });
        largest(bodies)
    }
}

/// The largest, a number that is none being the largest of all.
pub fn largest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(
        0.0,
        |a: f64, b| if b.is_nan() { f64::INFINITY } else { a.max(b) },
    )
}
