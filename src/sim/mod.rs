//! Level 5: the loop. Land on event times, step, sample, deliver.

mod choose;
mod group;
mod schedule;
mod script;
mod sizes;
mod sources;
mod truth;
mod watch;

pub use choose::{Choice, Choose, Setting, Stated};
pub use sizes::Sizes;
pub use sources::GYROSCOPIC;
pub use watch::{Drifts, Warning};

use crate::body::LANES;
use crate::integrator::{Kind, Step, Work};
use crate::scene::{Action, Event, Scene, Stepping};
use crate::trace::{
    Instant, Motion, Note, NoteKind, PointForce, Sample, Sink, SinkError, Subject, Track, short,
};
use group::Group;
use nalgebra::Vector3;
use schedule::{Schedule, Stretch};
use script::Happening;
use std::cell::RefCell;
use truth::Truth;
use watch::{Made, Watch};

/// A scene being stepped.
pub struct Simulation<'s> {
    scene: &'s Scene,
    subjects: Vec<Subject>,
    groups: Vec<Group>,
    /// Bodies in a group.
    width: usize,
    /// Indices of the events that act now.
    active: Vec<usize>,
    threads: usize,
    /// By body.
    truths: Vec<RefCell<Truth>>,
    watches: Vec<RefCell<Watch>>,
    /// Whether a stream compares with the truth.
    compared: bool,
    /// Whether steps are timed.
    timed: bool,
    /// Mean wall time of the last stretch's steps of a group, s.
    step_time: Option<f64>,
}

/// Steps of a block from which on a thread is worth its start (some 40 µs): about ten times that.
const WORTH_A_THREAD: usize = 8192;

/// What a run leaves besides its trace.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    pub steps: u64,
    /// Every event as it struck.
    pub blows: Vec<Blow>,
    /// What the method did, over all blocks of eight bodies.
    pub work: Work,
    /// All bodies at the end, or where the run stopped.
    pub end: Vec<Sample>,
    /// What drifted beyond what is to be expected of the method.
    pub warnings: Vec<Warning>,
}

/// A body at the instant an event began.
#[derive(Clone, Debug)]
pub struct Blow {
    pub at: Instant,
    /// Index of the event.
    pub event: usize,
    /// Just after the event began, under everything that acts.
    pub sample: Sample,
    /// What this event alone applies: the torque about the reference point, world, N·m.
    pub tau_w: Vector3<f64>,
    /// For an impulse.
    pub jump: Option<Jump>,
}

/// What an impulse does to a body, world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// About the reference point, N·m·s.
    pub angular_impulse_w: Vector3<f64>,
    /// Δω, rad/s.
    pub omega_w: Vector3<f64>,
    /// The impulse (N·s in place of N) and where it struck; none for an angular impulse.
    pub strike: Option<PointForce>,
}

/// Why a run stopped before its end.
#[derive(Debug, thiserror::Error)]
pub enum SimError {
    #[error("{body} is no longer finite at t = {time} s, step {step}{by}: {cause}")]
    NotFinite {
        body: String,
        time: f64,
        step: u64,
        /// `, by METHOD`, once one has set out.
        by: String,
        cause: String,
    },
    #[error("the scene states an accuracy and no method: it has to be planned first")]
    Undecided,
    #[error(transparent)]
    Sink(#[from] SinkError),
}

/// Why numbers end, where it is not a method's doing.
const BEYOND: &str = "a force, an impulse, a speed, a mass or a ratio of moments is too large or too small for 64-bit numbers, or for this method at this step; look at the events and the start";

impl<'s> Simulation<'s> {
    /// Eight bodies go together by one method. Where a scene states an accuracy each goes alone, so
    /// that each has the method it needs.
    pub fn new(scene: &'s Scene) -> Self {
        let width = match scene.stepping {
            Stepping::Method { .. } => LANES,
            Stepping::Accuracy(_) => 1,
        };
        Self::in_groups(scene, width)
    }

    /// Each body goes alone, by the way that is chosen for it.
    pub fn one_by_one(scene: &'s Scene) -> Self {
        Self::in_groups(scene, 1)
    }

    fn in_groups(scene: &'s Scene, width: usize) -> Self {
        let mut simulation = Self {
            scene,
            subjects: scene.bodies.iter().map(group::subject).collect(),
            groups: group::groups(&scene.bodies, width),
            width,
            active: Vec::new(),
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            truths: truths(scene),
            watches: vec![RefCell::default(); scene.bodies.len()],
            compared: is_compared(scene),
            timed: scene.record.streams.contains("step_time"),
            step_time: None,
        };
        if scene.record.streams.contains("sources") {
            sources::tell_apart(scene, &mut simulation.subjects);
        }
        for group in &mut simulation.groups {
            group.watch(&simulation.subjects[group.members.clone()]);
            group.load(scene, &[]);
        }
        simulation
    }

    /// Steps on at most so many threads; as many as the machine has where nothing is said. The
    /// motion is the same, to the last bit, on any number.
    #[must_use]
    pub fn on_threads(mut self, threads: usize) -> Self {
        self.threads = threads.max(1);
        self
    }

    /// The bodies, as the trace names them.
    pub fn subjects(&self) -> &[Subject] {
        &self.subjects
    }

    /// The largest of each quantity to be expected, from every event on its body as it starts.
    pub fn expected(&self) -> Sizes {
        let mut sizes = Sizes::default();
        for (subject, sample) in self.subjects.iter().zip(self.samples(0.0)) {
            sizes.count(subject, &sample, 0.0);
        }
        for (k, event) in self.scene.events.iter().enumerate() {
            let subject = &self.subjects[event.body];
            let mut group = self.group_of(event.body).clone();
            if let Some(strike) = begin(&mut group, self.scene, k).and_then(|jump| jump.strike) {
                sizes.count_impulse(strike.force_w.norm());
            }
            group.load(self.scene, &[k]);
            sizes.count(
                subject,
                &group.sample(event.body, event.at),
                event.action.lasts(),
            );
        }
        sizes
    }

    /// Steps the scene from its start to its end by the method that it states. The outcome tells
    /// what there was until it ended or stopped.
    pub fn run(self, sink: &mut dyn Sink) -> (Outcome, Result<(), SimError>) {
        match Stated::of(self.scene) {
            Some(mut stated) => self.run_by(&mut stated, sink),
            None => (Outcome::default(), Err(SimError::Undecided)),
        }
    }

    /// The same by the ways that `chooser` chooses.
    pub fn run_by(
        mut self,
        chooser: &mut dyn Choose,
        sink: &mut dyn Sink,
    ) -> (Outcome, Result<(), SimError>) {
        let mut outcome = Outcome::default();
        let mut schedule = Schedule::new(self.scene);
        let done = self.play(&mut schedule, chooser, &mut outcome, sink);
        let now = schedule.now();
        outcome.steps = now.step;
        let works = self.groups.iter().map(Group::work);
        outcome.work = works.fold(Work::default(), |a, b| a + b);
        outcome.end = self.samples(now.time);
        let watches = self.watches.iter().map(RefCell::borrow);
        outcome.warnings = watches
            .flat_map(|watch| watch.told().cloned().collect::<Vec<_>>())
            .collect();
        (outcome, done)
    }

    fn play(
        &mut self,
        schedule: &mut Schedule<'_>,
        chooser: &mut dyn Choose,
        outcome: &mut Outcome,
        sink: &mut dyn Sink,
    ) -> Result<(), SimError> {
        let start = schedule.now();
        self.happen(start, &script::at_start(self.scene), outcome, sink)?;
        self.deliver_motions(start, sink)?;
        let all: Vec<usize> = (0..self.subjects.len()).collect();
        self.must_be_finite(start, &all, sink)?;
        self.set_out(&all, schedule, chooser);
        self.deliver(0, start, self.samples(start.time), sink)?;
        loop {
            let first = schedule.now();
            let Some(stretch) = schedule.next_stretch() else {
                return Ok(());
            };
            if let Some((at, body)) = self.stretch(&stretch, first, sink)? {
                schedule.stop_at(at);
                return Err(self.not_finite(at, body, self.cause(body), sink));
            }
            if stretch.happenings.is_empty() {
                continue;
            }
            let now = schedule.now();
            let touched = self.touched(&stretch.happenings);
            if !stretch.kept.last().is_some_and(|last| last.display) {
                self.deliver_bodies(now, &touched, sink)?;
            }
            let jumped = self.happen(now, &stretch.happenings, outcome, sink)?;
            if jumped {
                self.deliver_motions(now, sink)?;
            }
            self.deliver_bodies(now, &touched, sink)?;
            self.must_be_finite(now, &touched, sink)?;
            self.set_out(&touched, schedule, chooser);
        }
    }

    /// Starts the method of the groups of these bodies, and what is known of their true motion:
    /// from now until an event touches them.
    fn set_out(&mut self, bodies: &[usize], schedule: &Schedule<'_>, chooser: &mut dyn Choose) {
        let mut groups: Vec<usize> = bodies.iter().map(|body| body / self.width).collect();
        groups.dedup();
        let now = schedule.now().time;
        for group in groups {
            let members = self.groups[group].members.clone();
            let touches =
                |happening: Happening| members.contains(&self.scene.events[happening.event()].body);
            let until = schedule.until(touches);
            self.groups[group].set_out(chooser, now, until);
        }
        for &body in bodies {
            let truth = &self.truths[body];
            let group = self.group_of(body);
            let sample = group.sample(body, now);
            let simulated = (&self.subjects[body], &sample, group, body);
            let touches = |happening: Happening| self.scene.events[happening.event()].body == body;
            let until = schedule.until(touches);
            truth
                .borrow_mut()
                .set_out((self.scene, &self.active), (now, until), simulated);
        }
    }

    /// Takes every group through a stretch without events, one group after another. Where a state
    /// is lost, all are taken to that step alike: when that is, and the body.
    fn stretch(
        &mut self,
        stretch: &Stretch,
        first: Instant,
        sink: &mut dyn Sink,
    ) -> Result<Option<(Instant, usize)>, SimError> {
        let start = self.timed.then(std::time::Instant::now);
        let lost = self.advance(&stretch.steps);
        self.step_time = start.map(|start| {
            let steps = stretch.steps.len() * self.groups.len();
            start.elapsed().as_secs_f64() / steps.max(1) as f64
        });
        let Some((taken, body)) = lost else {
            self.deliver_stretch(stretch, sink)?;
            return Ok(None);
        };
        let cut = stretch.cut(taken, first);
        for group in &mut self.groups {
            group.retake(&cut.steps);
        }
        self.deliver_stretch(&cut, sink)?;
        Ok(Some((cut.after(taken - 1, first), body)))
    }

    /// Steps all groups, each through all the steps, on as many threads as are allowed. Bodies do
    /// not act on each other, so it is all one in which order. The first loss of a state there is:
    /// the steps taken until then, and the body.
    fn advance(&mut self, steps: &[Step]) -> Option<(usize, usize)> {
        let enough = self.groups.len() * steps.len() >= WORTH_A_THREAD;
        let threads = if enough { self.threads } else { 1 };
        let share = self.groups.len().div_ceil(threads).max(1);
        let advance = |groups: &mut [Group]| {
            let losses = groups.iter_mut().filter_map(|group| group.advance(steps));
            losses.min()
        };
        if threads == 1 {
            return advance(&mut self.groups);
        }
        std::thread::scope(|scope| {
            let shares = self.groups.chunks_mut(share);
            let running: Vec<_> = shares.map(|share| scope.spawn(|| advance(share))).collect();
            let losses = running.into_iter().filter_map(|thread| {
                let joined = thread.join();
                // A panic there is one here: no group may be left half a stretch behind.
                joined.unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            });
            losses.min()
        })
    }

    /// Delivers what was kept of a stretch: the states group by group, then the derived streams.
    fn deliver_stretch(&self, stretch: &Stretch, sink: &mut dyn Sink) -> Result<(), SinkError> {
        let states = || {
            let kept = stretch.kept.iter().enumerate();
            kept.filter(|(_, kept)| kept.state)
        };
        let instants: Vec<Instant> = states().map(|(_, kept)| kept.at).collect();
        for group in &self.groups {
            let motions: Vec<Motion> = states().flat_map(|(k, _)| group.motions_kept(k)).collect();
            sink.motions(&Track {
                bodies: group.members.clone(),
                instants: &instants,
                motions: &motions,
            })?;
        }
        for (k, kept) in stretch.kept.iter().enumerate() {
            if kept.display {
                let groups = self.groups.iter();
                let samples: Vec<Sample> = groups
                    .flat_map(|group| group.samples_kept(k, kept.at.time))
                    .collect();
                self.deliver(0, kept.at, samples, sink)?;
            }
        }
        Ok(())
    }

    /// Whether these bodies' states and accelerations can be computed with.
    fn must_be_finite(
        &self,
        now: Instant,
        bodies: &[usize],
        sink: &mut dyn Sink,
    ) -> Result<(), SimError> {
        let lost = |&body: &usize| {
            let group = self.group_of(body);
            let sample = group.sample(body, now.time);
            !(group.is_finite(body) && sample.alpha_w.iter().all(|x| x.is_finite()))
        };
        match bodies.iter().copied().find(lost) {
            None => Ok(()),
            Some(body) => Err(self.not_finite(now, body, BEYOND.to_owned(), sink)),
        }
    }

    /// Records the broken instant in full and says what happened.
    fn not_finite(&self, at: Instant, body: usize, cause: String, sink: &mut dyn Sink) -> SimError {
        let error = SimError::NotFinite {
            body: self.subjects[body].name.clone(),
            time: at.time,
            step: at.step,
            by: match self.group_of(body).method {
                "" => String::new(),
                method => format!(", by {method}"),
            },
            cause,
        };
        let note = Note {
            body,
            text: error.to_string(),
            kind: NoteKind::Failure,
            strike: None,
        };
        let written = sink
            .samples(at, 0..self.subjects.len(), &self.samples(at.time))
            .and_then(|()| sink.note(at, &note));
        match written {
            Ok(()) => error,
            Err(error) => error.into(),
        }
    }

    /// The likeliest reason for a state that a method lost.
    fn cause(&self, body: usize) -> String {
        /// Radians a step, beyond which a term of second order in ω h is no longer small.
        const FAR: f64 = 0.1;
        /// Radians a step of which a 64-bit number knows no part of a turn.
        const ABSURD: f64 = 1e16;
        let group = self.group_of(body);
        let turned = group.turn_in_a_step(body, self.scene.step);
        let absurd = turned.is_nan() || turned > ABSURD;
        if !absurd && group.steps == Some(Kind::Adaptive) {
            return "no step of its own was short enough to follow the motion; a force or torque there grows without bound, or the tolerance is below what 64-bit numbers resolve".to_owned();
        }
        let decays = group.decay_in_a_step(self.scene.step);
        if group.steps == Some(Kind::Fixed) && decays > 1.0 {
            let decays = short(decays);
            return format!(
                "damping of c h = {decays} a step is too fast for this method; take a smaller step or another method"
            );
        }
        if !absurd && group.steps == Some(Kind::Fixed) && group.is_gyroscopic() && turned > FAR {
            let turned = short(turned);
            return format!(
                "it turned {turned} rad a step, too far for the gyroscopic term; take a smaller step or another method"
            );
        }
        BEYOND.to_owned()
    }

    /// Ends and begins events and writes the log; true where a velocity jumped.
    fn happen(
        &mut self,
        now: Instant,
        happenings: &[Happening],
        outcome: &mut Outcome,
        sink: &mut dyn Sink,
    ) -> Result<bool, SimError> {
        let mut jumps = vec![None; happenings.len()];
        for (happening, jump) in happenings.iter().zip(&mut jumps) {
            match *happening {
                Happening::Ends(k) => self.active.retain(|&active| active != k),
                Happening::Begins(k) => {
                    let body = self.scene.events[k].body;
                    *jump = begin(&mut self.groups[body / self.width], self.scene, k);
                    if let (Some(_), Some(truth)) = (&jump, self.truths.get_mut(body)) {
                        strike(truth.get_mut(), &self.scene.events[k], now.time);
                    }
                    if jump.is_none() {
                        self.active.push(k);
                    }
                }
            }
        }
        for body in self.touched(happenings) {
            self.groups[body / self.width].load(self.scene, &self.active);
        }
        for (happening, &jump) in happenings.iter().zip(&jumps) {
            let event = &self.scene.events[happening.event()];
            let subject = &self.subjects[event.body];
            let group = self.group_of(event.body);
            let sample = group.sample(event.body, now.time);
            let tau_w = group.torque_of(event);
            let note = match *happening {
                Happening::Ends(_) => script::end_note(event, subject, &sample),
                Happening::Begins(k) => {
                    let note = script::begin_note(event, subject, (tau_w, &sample), jump);
                    outcome.blows.push(Blow {
                        at: now,
                        event: k,
                        sample,
                        tau_w,
                        jump,
                    });
                    note
                }
            };
            sink.note(now, &note)?;
        }
        Ok(jumps.iter().any(Option::is_some))
    }

    /// The bodies that some events concern, each once.
    fn touched(&self, happenings: &[Happening]) -> Vec<usize> {
        let bodies = happenings
            .iter()
            .map(|happening| self.scene.events[happening.event()].body);
        let mut bodies: Vec<usize> = bodies.collect();
        bodies.sort_unstable();
        bodies.dedup();
        bodies
    }

    fn deliver_bodies(
        &self,
        now: Instant,
        bodies: &[usize],
        sink: &mut dyn Sink,
    ) -> Result<(), SinkError> {
        for &body in bodies {
            let sample = vec![self.group_of(body).sample(body, now.time)];
            self.deliver(body, now, sample, sink)?;
        }
        Ok(())
    }

    /// Delivers the samples of bodies from `first` on, with how far they are from the truth, where it is known and
    /// recorded, and what a step took; and then what drifts.
    fn deliver(
        &self,
        first: usize,
        at: Instant,
        mut samples: Vec<Sample>,
        sink: &mut dyn Sink,
    ) -> Result<(), SinkError> {
        let mut news = Vec::new();
        for (body, sample) in (first..).zip(&mut samples) {
            sample.step_time = self.step_time;
            let subject = &self.subjects[body];
            let mut truth = self.truths[body].borrow_mut();
            let deviation = truth.deviation(subject, sample, at.time);
            let group = self.group_of(body);
            if let Some(choice) = group.choice {
                let made = Made {
                    at,
                    body,
                    subject,
                    choice,
                    step: self.scene.step,
                    free: truth.is_exact(),
                };
                let mut watch = self.watches[body].borrow_mut();
                news.extend(watch.look(&made, sample, &deviation));
            }
            if self.compared {
                sample.deviation = deviation;
            }
        }
        sink.samples(at, first..first + samples.len(), &samples)?;
        for warning in news {
            let note = Note {
                body: warning.body,
                text: warning.to_string(),
                kind: NoteKind::Warning,
                strike: None,
            };
            sink.note(at, &note)?;
        }
        Ok(())
    }

    fn group_of(&self, body: usize) -> &Group {
        &self.groups[body / self.width]
    }

    fn samples(&self, t: f64) -> Vec<Sample> {
        self.groups
            .iter()
            .flat_map(|group| group.samples(t))
            .collect()
    }

    /// Delivers the poses of all bodies at one instant.
    fn deliver_motions(&self, now: Instant, sink: &mut dyn Sink) -> Result<(), SinkError> {
        for group in &self.groups {
            let motions: Vec<Motion> = group.motions().collect();
            sink.motions(&Track {
                bodies: group.members.clone(),
                instants: &[now],
                motions: &motions,
            })?;
        }
        Ok(())
    }
}

fn is_compared(scene: &Scene) -> bool {
    let compared = ["error", "drift"];
    let mut recorded = compared
        .iter()
        .map(|name| scene.record.streams.contains(name));
    recorded.any(|is| is)
}

/// The true motion of every body, where a stream compares with it; else what its model keeps.
fn truths(scene: &Scene) -> Vec<RefCell<Truth>> {
    if !is_compared(scene) {
        let alone = scene.bodies.iter().map(|_| Truth::kept_alone());
        return alone.map(RefCell::new).collect();
    }
    let alone = group::groups(&scene.bodies, 1);
    alone
        .into_iter()
        .map(|body| RefCell::new(Truth::new(body)))
        .collect()
}

/// Strikes the truth as [`begin`] strikes the simulated body.
fn strike(truth: &mut Truth, event: &Event, at: f64) {
    match event.action {
        Action::Push { .. } | Action::Torque { .. } => {}
        Action::Impulse { impulse, point } => truth.strike(event.body, impulse, Some(point), at),
        Action::AngularImpulse { impulse } => truth.strike(event.body, impulse, None, at),
    }
}

/// Starts event `k` on the group of its body. What lasts is left to [`Group::load`]; an impulse
/// acts at once.
fn begin(group: &mut Group, scene: &Scene, k: usize) -> Option<Jump> {
    let event = &scene.events[k];
    match event.action {
        Action::Push { .. } | Action::Torque { .. } => None,
        Action::Impulse { impulse, point } => Some(group.strike(event.body, impulse, Some(point))),
        Action::AngularImpulse { impulse } => Some(group.strike(event.body, impulse, None)),
    }
}
