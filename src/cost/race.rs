//! A scene in which one body is there many times, each by another method, beside the true one: how
//! their motions part can be watched.

use super::check;
use super::ladder::refusal;
use super::reference::truest;
use crate::effect::Called;
use crate::integrator::{Kind, Method};
use crate::math::angle_between;
use crate::scene::{Action, Event, Framed, Scene, SceneEffect, Target};
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
        for body in &mut alone.bodies {
            body.method = None;
            body.swarm = None;
        }
        alone.events.retain(|event| match &event.target {
            Target::Body(body) | Target::Log(Some(body)) => *body == 0,
            Target::Hit(_) | Target::All | Target::Log(None) => true,
        });
        for event in &mut alone.events {
            if let Target::Hit(bodies) = &mut event.target {
                *bodies = 0..1;
            }
        }
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
    // Wider than high, as screens are.
    let columns = (2.0 * runners.len() as f64).sqrt().ceil().max(1.0) as usize;
    let place = |k: usize| Vector3::new((k % columns) as f64, -((k / columns) as f64), 0.0) * apart;
    let places: Vec<Vector3<f64>> = (0..runners.len()).map(place).collect();
    let (effects, became) = effects_of_runners(alone, &places);
    scene.effects = effects;
    for (k, runner) in runners.iter().enumerate() {
        let shift_w = places[k];
        let name = runner.map_or("true", |choice| choice.method.info().name);
        for body in &alone.bodies {
            let mut body = body.clone();
            body.name = name.to_owned();
            body.label = name.to_owned();
            body.position_w += shift_w;
            scene.bodies.push(body);
        }
        let events = alone.events.iter().cloned();
        scene
            .events
            .extend(events.filter_map(|event| of_runner(event, k, shift_w)));
    }
    for event in &alone.events {
        if let Action::Switch { effect, on } = event.action {
            scene
                .events
                .extend(became[effect].clone().map(|effect| Event {
                    action: Action::Switch { effect, on },
                    ..event.clone()
                }));
        }
    }
    scene
}

/// The effects of the first body as all runners have them, and what each of the scene's effects became: of
/// what is fixed in the world each runner has its own.
fn effects_of_runners(
    alone: &Scene,
    places: &[Vector3<f64>],
) -> (Vec<SceneEffect>, Vec<Range<usize>>) {
    let mut effects = Vec::new();
    let became = alone.effects.iter().map(|effect| {
        let first = effects.len();
        if !effect.concerns(0) {
            return first..first;
        }
        match moved(effect, Vector3::zeros()) {
            None => effects.push(SceneEffect {
                bodies: None,
                ..effect.clone()
            }),
            Some(_) => effects.extend(places.iter().enumerate().filter_map(|(k, &place)| {
                Some(SceneEffect {
                    bodies: Some(vec![k]),
                    ..moved(effect, place)?
                })
            })),
        }
        first..effects.len()
    });
    let became = became.collect();
    (effects, became)
}

/// An event as it happens to the k-th runner; a note is written with the first.
fn of_runner(mut event: Event, k: usize, shift_w: Vector3<f64>) -> Option<Event> {
    event.target = match event.target {
        Target::Body(_) => Target::Body(k),
        Target::Hit(_) => Target::Hit(k..k + 1),
        Target::All => return None,
        target => return (k == 0).then_some(Event { target, ..event }),
    };
    match &mut event.action {
        Action::Push { point, .. } | Action::Impulse { point, .. } => {
            if let Framed::World(p) = point {
                *p += shift_w;
            }
        }
        Action::Click(click) => click.ray_w.origin += shift_w,
        Action::Set(change) => {
            if let Some(p) = &mut change.position_w {
                *p += shift_w;
            }
        }
        _ => {}
    }
    Some(event)
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
