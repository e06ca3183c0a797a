//! A run that can be halted at any step, taken up again, set back to where it was, and carried over to a scene
//! in which more happens from there on.
//!
//! The motion is deterministic: what is stored at one step and stepped on is the motion there was, to the last
//! bit. So a few stored states suffice to go back anywhere.

use super::group::Group;
use super::schedule::{Parked, Position, Schedule, slack};
use super::script::Acting;
use super::sources;
use super::truth::Truth;
use super::watch::Watch;
use super::{Blow, Choose, Outcome, Parts, SimError, Simulation};
use crate::mass::ray::Ray;
use crate::scene::Scene;
use crate::scene::pick::{self, Picked};
use crate::trace::{Instant, Sample, Sink, SinkError, Subject};
use nalgebra::Vector3;
use std::cell::RefCell;
use std::sync::Arc;

/// A scene being stepped on demand.
pub struct Run {
    scene: Arc<Scene>,
    parts: Parts,
    clock: Parked,
    opened: bool,
    /// Why it goes no further.
    failed: Option<String>,
    blows: Vec<Blow>,
}

/// What hands do, as a body's torques are told apart.
const EXPECTED: [&str; 2] = ["push", "torque"];

/// How far to go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// Steps of the clock at most; a step that an event divides is two.
    pub steps: u64,
    /// Not beyond, s. No step is cut for it: the last instant of the clock until then.
    pub until: Option<f64>,
}

impl Limit {
    pub fn steps(steps: u64) -> Self {
        Self { steps, until: None }
    }

    pub fn time(until: f64) -> Self {
        Self {
            steps: u64::MAX,
            until: Some(until),
        }
    }
}

/// All that changes while a scene is stepped, at a step.
#[derive(Clone)]
pub struct Checkpoint {
    groups: Vec<Group>,
    acting: Acting,
    noted: usize,
    truths: Vec<RefCell<Truth>>,
    watches: Vec<RefCell<Watch>>,
    position: Position,
}

impl Checkpoint {
    pub fn at(&self) -> Instant {
        self.position.instant()
    }

    /// Bytes it takes, but for what allocators add.
    pub fn bytes(&self) -> usize {
        let groups: usize = self.groups.iter().map(Group::bytes).sum();
        let truths = self.truths.iter().map(|truth| truth.borrow().bytes());
        let watches = size_of_val(self.watches.as_slice());
        let acting = size_of_val(self.acting.events.as_slice()) + self.acting.on.len();
        size_of::<Self>()
            + groups
            + truths.sum::<usize>()
            + watches
            + acting
            + self.position.bytes()
    }
}

impl Run {
    /// A scene before its start: nothing has happened.
    pub fn new(scene: Arc<Scene>) -> Self {
        let parts = Simulation::new(&scene).parts;
        let clock = Schedule::new(&scene).park();
        Self {
            scene,
            parts,
            clock,
            opened: false,
            failed: None,
            blows: Vec::new(),
        }
    }

    /// The run of a scene from where another was, of which it has the first `known` events, and in which only more
    /// happens, from there on: bit by bit what a run of it from the start would be there. What is new there
    /// happens with the next step, or with [`Self::go`] of none.
    /// `None` where bodies go in other groups there.
    pub fn carried(scene: Arc<Scene>, checkpoint: &Checkpoint, known: usize) -> Option<Self> {
        let mut run = Self::new(Arc::clone(&scene));
        let members = |group: &Group| group.members.clone();
        let (own, stored) = (&run.parts.groups, &checkpoint.groups);
        if !own.iter().map(members).eq(stored.iter().map(members)) {
            return None;
        }
        run.clock.set_before(&checkpoint.position, known);
        run.put(checkpoint);
        run.opened = true;
        let parts = &mut run.parts;
        // What is new, there or here, is off until something switches it on.
        let on = scene.on_at_start();
        parts.acting.on.truncate(on.len());
        parts
            .acting
            .on
            .extend_from_slice(&on[parts.acting.on.len()..]);
        for group in &mut parts.groups {
            group.watch(&parts.subjects[group.members.clone()]);
            group.load(&scene, &parts.acting);
        }
        Some(run)
    }

    /// Tells torques apart, where a stream does, as if each body were pushed and turned at some time; or as the scene
    /// says.
    pub fn expect_pushes(&mut self, expected: bool) {
        let parts = &mut self.parts;
        if expected && self.scene.record.streams.contains("sources") {
            let outside = parts.outside_swarms;
            sources::tell_apart(&self.scene, &mut parts.subjects[..outside], &EXPECTED);
            for group in &mut parts.groups {
                group.watch(&parts.subjects[group.members.clone()]);
            }
        }
    }

    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// The bodies, as the trace names them.
    pub fn subjects(&self) -> &[Subject] {
        &self.parts.subjects
    }

    /// Bodies that are in no swarm: the first.
    pub fn outside_swarms(&self) -> usize {
        self.parts.outside_swarms
    }

    pub fn now(&self) -> Instant {
        self.clock.position().instant()
    }

    /// Whether it is at the end of the scene.
    pub fn is_over(&self) -> bool {
        self.opened && self.clock.is_over()
    }

    /// Why it goes no further, where a state was lost.
    pub fn failure(&self) -> Option<&str> {
        self.failed.as_deref()
    }

    /// Goes on, or sets out, delivering what a run from start to end would. Where a state is lost it stands there and
    /// goes no further, until it is set back.
    pub fn go(
        &mut self,
        limit: Limit,
        chooser: &mut dyn Choose,
        sink: &mut dyn Sink,
    ) -> Result<(), SinkError> {
        if self.failed.is_some() {
            return Ok(());
        }
        let scene = Arc::clone(&self.scene);
        let clock = std::mem::take(&mut self.clock);
        let parts = std::mem::take(&mut self.parts);
        let mut schedule = Schedule::unpark(&scene, clock);
        let mut simulation = Simulation::of(&scene, parts);
        let mut outcome = Outcome::default();
        let opened = match self.opened {
            true => Ok(()),
            false => simulation.open(&mut schedule, chooser, &mut outcome, sink),
        };
        self.opened = true;
        schedule.allow(limit.steps, limit.until);
        let done =
            opened.and_then(|()| simulation.go_on(&mut schedule, chooser, &mut outcome, sink));
        for group in &mut simulation.parts.groups {
            group.forget();
        }
        self.parts = simulation.parts;
        self.clock = schedule.park();
        self.blows.append(&mut outcome.blows);
        match done {
            Ok(()) => Ok(()),
            Err(SimError::Sink(error)) => Err(error),
            Err(error) => {
                self.failed = Some(error.to_string());
                Ok(())
            }
        }
    }

    /// What began or struck since this was asked last.
    pub fn take_blows(&mut self) -> Vec<Blow> {
        std::mem::take(&mut self.blows)
    }

    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            groups: self.parts.groups.clone(),
            acting: self.parts.acting.clone(),
            noted: self.parts.noted,
            truths: self.parts.truths.clone(),
            watches: self.parts.watches.clone(),
            position: self.clock.position().clone(),
        }
    }

    /// Back, or on, to where it was.
    pub fn restore(&mut self, checkpoint: &Checkpoint) {
        self.put(checkpoint);
        self.clock.set(&checkpoint.position);
        self.opened = true;
    }

    fn put(&mut self, checkpoint: &Checkpoint) {
        let parts = &mut self.parts;
        parts.groups.clone_from(&checkpoint.groups);
        parts.acting.clone_from(&checkpoint.acting);
        parts.noted = checkpoint.noted;
        parts.truths.clone_from(&checkpoint.truths);
        parts.watches.clone_from(&checkpoint.watches);
        self.failed = None;
        self.blows.clear();
    }

    /// A hash of every bit of all bodies' states, as recordings hold it.
    pub fn fingerprint(&self) -> u64 {
        self.parts.fingerprint()
    }

    /// The bodies that are in no swarm as they are, with how far they are from the truth.
    pub fn samples(&self) -> Vec<Sample> {
        let now = self.now().time;
        let mut samples = self
            .parts
            .samples_outside_swarms(|group| group.samples(now));
        for (body, sample) in samples.iter_mut().enumerate() {
            self.judge(body, sample, now);
        }
        samples
    }

    /// One of all bodies as it is; `None` of what is none. How far one of a swarm is from the truth is not known.
    pub fn sample(&self, body: usize) -> Option<Sample> {
        self.parts.subjects.get(body)?;
        let now = self.now().time;
        let mut sample = self.parts.group_of(body).sample(body, now);
        self.judge(body, &mut sample, now);
        Some(sample)
    }

    /// How far a body is from the truth, where that is known.
    fn judge(&self, body: usize, sample: &mut Sample, now: f64) {
        if let Some(truth) = self.parts.truths.get(body) {
            let subject = &self.parts.subjects[body];
            sample.deviation = truth.borrow_mut().peek(subject, sample, now);
        }
    }

    /// The first body on a ray (world), as they are.
    pub fn pick(&self, ray_w: &Ray) -> Option<(usize, Picked)> {
        let bodies = self.parts.subjects.iter().enumerate();
        let posed = bodies.map(|(k, subject)| (subject, self.parts.group_of(k).motion_of(k)));
        pick::first_hit(ray_w, posed)
    }

    /// Delivers the poses of all bodies as they are.
    pub fn show(&self, sink: &mut dyn Sink) -> Result<(), SinkError> {
        self.parts.deliver_motions(self.now(), sink)
    }

    /// What turns a body now, each by its name: what is applied, and the model's own terms; about the reference
    /// point, world, N·m.
    pub fn torques(&self, body: usize) -> Vec<(String, Vector3<f64>)> {
        match self.parts.home.get(body) {
            Some(&group) => self.parts.groups[group].torques(body, self.now().time),
            None => Vec::new(),
        }
    }

    /// The latest time that the scene has for what happens where the clock stands (s): what is to come after it in
    /// the list comes after it there.
    pub fn latest_here(&self) -> f64 {
        let now = self.now().time;
        let near = slack(now, self.scene.step);
        let times = self.scene.events.iter().flat_map(|event| {
            let over = event.at + event.action.lasts();
            [event.at, over]
        });
        times
            .filter(|time| (time - now).abs() <= near)
            .fold(now, f64::max)
    }

    /// By which method a body goes.
    pub fn method_of(&self, body: usize) -> &'static str {
        match self.parts.home.get(body) {
            Some(&group) => self.parts.groups[group].method,
            None => "",
        }
    }

    /// Which of the scene's effects are on, in their order.
    pub fn effects_on(&self) -> &[bool] {
        &self.parts.acting.on
    }
}
