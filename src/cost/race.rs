//! A scene in which one body is there many times, each by another method, beside the true one: how
//! their motions part can be watched.

use super::check;
use super::ladder::refusal;
use super::reference::truest;
use crate::effect::Called;
use crate::integrator::{Kind, Method};
use crate::math::angle_between;
use crate::scene::{Action, Framed, Scene, SceneEffect};
use crate::sim::{Choice, Choose, Setting, SimError, Simulation};
use crate::trace::{Instant, Note, Sample, Sink, SinkError, Track};
use nalgebra::{UnitQuaternion, Vector3};
use std::ops::Range;

/// The scene of a race, and who runs in it.
pub struct Race {
    pub scene: Scene,
    /// By body; the first is the truth.
    runners: Vec<Option<Choice>>,
    /// Methods that lose the body before the end.
    pub lost: Vec<&'static str>,
}

/// Of methods that choose their own steps.
const TOLERANCE: f64 = 1e-6;

impl Race {
    /// Those of the methods that take the scene's torques and keep to the end, at steps of `step` s: of
    /// the body that is there first. `apart`: how far they stand from each other, m.
    pub fn new(
        scene: &Scene,
        methods: &[&'static dyn Method],
        step: f64,
        apart: f64,
    ) -> Result<Self, SimError> {
        let mut alone = scene.clone();
        alone.bodies.truncate(1);
        alone.bodies.iter_mut().for_each(|body| body.method = None);
        alone.effects.retain(|effect| effect.concerns(0));
        alone.effects.iter_mut().for_each(|e| e.bodies = None);
        alone.events.retain(|event| event.body == 0);
        alone.step = step.min(scene.duration);
        let mut runners = vec![None];
        let mut lost = Vec::new();
        for method in methods.iter().copied() {
            if method.info().kind == Kind::Closed || refusal(&alone, method).is_some() {
                continue;
            }
            match finishes(&alone, method)? {
                true => runners.push(Some(choice(method))),
                false => lost.push(method.info().name),
            }
        }
        let scene = lined_up(&alone, &runners, apart);
        Ok(Self {
            scene,
            runners,
            lost,
        })
    }

    /// Runs it into a sink.
    pub fn run(&self, sink: &mut dyn Sink) -> Result<(), SimError> {
        let simulation = Simulation::one_by_one(&self.scene);
        let mut judge = Judge { sink, truth: None };
        let (_, done) = simulation.run_by(&mut ByBody(&self.runners), &mut judge);
        done
    }
}

fn choice(method: &'static dyn Method) -> Choice {
    Choice {
        method,
        pieces: 1,
        tolerance: TOLERANCE,
    }
}

fn finishes(scene: &Scene, method: &'static dyn Method) -> Result<bool, SimError> {
    let runner = [Some(choice(method))];
    // With nothing to be compared on the way.
    let bare = check::bare(scene, scene.step, 1.0);
    match check::run(&bare, &mut ByBody(&runner)) {
        Ok(_) => Ok(true),
        Err(SimError::NotFinite { .. }) => Ok(false),
        Err(error) => Err(error),
    }
}

/// The body once for every runner, in rows one above the other, the truth at the upper left.
fn lined_up(alone: &Scene, runners: &[Option<Choice>], apart: f64) -> Scene {
    let mut scene = alone.clone();
    scene.bodies.clear();
    scene.events.clear();
    // What is fixed in the world each runner has its own of.
    let fixed = |effect: &SceneEffect| moved(effect, Vector3::zeros()).is_some();
    scene.effects.retain(|effect| !fixed(effect));
    // Wider than high, as screens are.
    let columns = (2.0 * runners.len() as f64).sqrt().ceil().max(1.0) as usize;
    for (k, runner) in runners.iter().enumerate() {
        let (row, column) = ((k / columns) as f64, (k % columns) as f64);
        let shift_w = Vector3::new(column, -row, 0.0) * apart;
        let name = runner.map_or("true", |choice| choice.method.info().name);
        for body in &alone.bodies {
            let mut body = body.clone();
            body.name = name.to_owned();
            body.label = name.to_owned();
            body.position_w += shift_w;
            scene.bodies.push(body);
        }
        let own = alone.effects.iter().filter_map(|e| moved(e, shift_w));
        scene.effects.extend(own.map(|mut effect| {
            effect.bodies = Some(vec![k]);
            effect
        }));
        for event in &alone.events {
            let mut event = event.clone();
            event.body = k;
            if let Action::Push { point, .. } | Action::Impulse { point, .. } = &mut event.action
                && let Framed::World(p) = point
            {
                *p += shift_w;
            }
            scene.events.push(event);
        }
    }
    scene
}

/// An effect that has something fixed in the world, with that elsewhere.
fn moved(effect: &SceneEffect, by_w: Vector3<f64>) -> Option<SceneEffect> {
    let Called::Load(spec) = &effect.called else {
        return None;
    };
    let mut effect = effect.clone();
    effect.called = Called::Load(spec.moved(by_w)?);
    Some(effect)
}

struct ByBody<'a>(&'a [Option<Choice>]);

impl Choose for ByBody<'_> {
    fn choose(&mut self, setting: &Setting<'_>) -> Choice {
        let runner = self.0.get(setting.members.start).copied().flatten();
        runner.unwrap_or_else(|| truest(setting.interval, 0))
    }
}

/// Compares every body with the first.
struct Judge<'a> {
    sink: &'a mut dyn Sink,
    /// The first body's attitude at the instant that is being delivered; it comes first.
    truth: Option<(Instant, UnitQuaternion<f64>)>,
}

impl Sink for Judge<'_> {
    fn motions(&mut self, track: &Track<'_>) -> Result<(), SinkError> {
        self.sink.motions(track)
    }

    fn samples(
        &mut self,
        at: Instant,
        bodies: Range<usize>,
        samples: &[Sample],
    ) -> Result<(), SinkError> {
        let mut samples = samples.to_vec();
        if let (0, Some(first)) = (bodies.start, samples.first()) {
            self.truth = Some((at, first.motion.q_wb));
        }
        let truth = self.truth.filter(|(when, _)| *when == at);
        for sample in &mut samples {
            let off = |(_, truth)| angle_between(truth, sample.motion.q_wb);
            sample.deviation.attitude = truth.map(off);
        }
        self.sink.samples(at, bodies, &samples)
    }

    fn note(&mut self, at: Instant, note: &Note) -> Result<(), SinkError> {
        self.sink.note(at, note)
    }
}
