//! Level 5: the loop. Land on event times, step, sample, deliver.

mod choose;
mod group;
mod pace;
mod resume;
mod schedule;
mod script;
mod sizes;
mod sources;
mod truth;
mod watch;

pub use choose::{Choice, Choose, Setting, Stated};
pub use resume::{Checkpoint, Limit, Run};
pub use sizes::Sizes;
pub use sources::GYROSCOPIC;
pub use watch::{Drifts, Warning};

use crate::body::LANES;
use crate::integrator::{Kind, Step, Work};
use crate::scene::pick::{self, Picked};
use crate::scene::{Action, Click, Event, Scene, Stepping, Target};
use crate::trace::{
    Instant, Motion, Note, NoteKind, PointForce, Sample, Sink, SinkError, StreamSet, Subject,
    Track, short,
};
use group::Group;
use nalgebra::Vector3;
use pace::Pace;
use schedule::{Schedule, Stretch};
use script::{Acting, Applied, Done, Happening, Lasting};
use std::cell::RefCell;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use truth::Truth;
use watch::{Made, Watch};

/// A scene being stepped.
pub struct Simulation<'s> {
    scene: &'s Scene,
    parts: Parts,
    /// How long a stretch may be.
    pace: Pace,
    /// Set by who wants the run to end.
    stop: Option<&'s AtomicBool>,
}

/// A simulation without its scene; by default none.
#[derive(Default)]
struct Parts {
    subjects: Vec<Subject>,
    groups: Vec<Group>,
    /// Bodies that are in no swarm: the first. Of the others nothing is derived.
    outside_swarms: usize,
    /// By body: the group it is in.
    home: Vec<usize>,
    acting: Acting,
    /// The scene's notes by their times (s), and how many have been written.
    notes: Vec<(f64, Note)>,
    noted: usize,
    threads: usize,
    /// By body outside swarms.
    truths: Vec<RefCell<Truth>>,
    watches: Vec<RefCell<Watch>>,
    /// Whether a stream compares with the truth.
    compared: bool,
    /// The streams that tell torques apart, and those that say how far it is from the truth.
    apart: StreamSet,
    judged: StreamSet,
    /// Whether steps are timed.
    timed: bool,
    /// Mean wall time of the last stretch's steps of a group, s.
    step_time: Option<f64>,
}

/// Steps of a block from which on a thread is worth its start (some 40 µs): about ten times that.
const WORTH_A_THREAD: usize = 8192;

/// Anything but 0, which an all-zero state would not move.
const HASH_START: u64 = 0xcbf2_9ce4_8422_2325;

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
    pub body: usize,
    /// Just after the event began, under everything that acts.
    pub sample: Sample,
    /// What this event alone applies, at its peak: the torque about the reference point, world, N·m.
    pub tau_w: Vector3<f64>,
    /// Of a push: its force at its peak, and where it acts.
    pub push: Option<PointForce>,
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
    #[error("stopped at t = {time} s, step {step}")]
    Stopped { time: f64, step: u64 },
    #[error(transparent)]
    Sink(#[from] SinkError),
}

/// Why numbers end, where it is not a method's doing.
const BEYOND: &str = "a force, an impulse, a speed, a mass or a ratio of moments is too large or too small for 64-bit numbers, or for this method at this step; look at the events and the start";

impl<'s> Simulation<'s> {
    /// Eight bodies that have one model and method go together. Where a scene states an accuracy each goes alone, so
    /// that each has the method it needs.
    pub fn new(scene: &'s Scene) -> Self {
        let width = match scene.stepping {
            Stepping::Method { .. } => LANES,
            Stepping::Accuracy(_) => 1,
        };
        Self::in_groups(scene, width)
    }

    /// The same, ended at the next stretch of steps once `stop` is set.
    pub fn until_set(self, stop: &'s AtomicBool) -> Self {
        Self {
            stop: Some(stop),
            ..self
        }
    }

    /// Each body goes alone, by the way that is chosen for it.
    pub fn one_by_one(scene: &'s Scene) -> Self {
        Self::in_groups(scene, 1)
    }

    fn in_groups(scene: &'s Scene, width: usize) -> Self {
        let groups = group::groups(scene, width);
        let homes = groups.iter().enumerate();
        let mut parts = Parts {
            subjects: scene.bodies.iter().map(group::subject).collect(),
            outside_swarms: scene.outside_swarms(),
            home: homes
                .flat_map(|(k, group)| group.members.clone().map(move |_| k))
                .collect(),
            groups,
            acting: Acting::at_start(scene),
            notes: script::notes(scene),
            noted: 0,
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            truths: truths(scene),
            watches: vec![RefCell::default(); scene.outside_swarms()],
            compared: is_compared(scene),
            apart: streams(&["sources", "numbers"]),
            judged: streams(&["error", "drift", "numbers"]),
            timed: scene.record.streams.contains("step_time"),
            step_time: None,
        };
        if scene.record.streams.contains("sources") {
            let outside = parts.outside_swarms;
            sources::tell_apart(scene, &mut parts.subjects[..outside], &[]);
        }
        for group in &mut parts.groups {
            group.watch(&parts.subjects[group.members.clone()]);
            group.load(scene, &parts.acting);
        }
        Self::of(scene, parts)
    }

    /// From where the parts are; how long a stretch may be is counted anew.
    fn of(scene: &'s Scene, parts: Parts) -> Self {
        Self {
            scene,
            parts,
            pace: Pace::default(),
            stop: None,
        }
    }

    /// Steps on at most so many threads; as many as the machine has where nothing is said. The
    /// motion is the same, to the last bit, on any number.
    #[must_use]
    pub fn on_threads(mut self, threads: usize) -> Self {
        self.parts.threads = threads.max(1);
        self
    }

    /// The bodies, as the trace names them.
    pub fn subjects(&self) -> &[Subject] {
        &self.parts.subjects
    }

    /// The largest of each quantity to be expected, from every event on its body as it starts.
    pub fn expected(&self) -> Sizes {
        let mut sizes = Sizes::default();
        for (subject, sample) in self.parts.subjects.iter().zip(self.samples(0.0)) {
            sizes.count(subject, &sample, 0.0);
        }
        let mut entry = None;
        for event in &self.scene.events {
            // Its repeats are alike.
            if entry.replace((event.entry, &event.target)) != Some((event.entry, &event.target)) {
                self.expect(event, &mut sizes);
            }
        }
        sizes
    }

    /// Counts what an event makes of its body as the body starts.
    fn expect(&self, event: &Event, sizes: &mut Sizes) {
        let peak = event.at_peak();
        match (&event.target, &event.action) {
            (Target::Body(body), _) => self.expect_on(*body, peak, sizes),
            (Target::Hit(bodies), Action::Click(click)) => match self.pick(bodies, click) {
                Some((body, picked)) => {
                    let event = peak.on(body, click.at(picked.point_b)).at_peak();
                    self.expect_on(body, event, sizes);
                }
                None if click.lasts > 0.0 => sizes.count_force(click.force.abs()),
                None => sizes.count_impulse(click.force.abs()),
            },
            (Target::All, Action::Switch { effect, on }) => {
                let mut acting = self.parts.acting.clone();
                acting.on[*effect] = *on;
                for group in &self.parts.groups {
                    let mut group = group.clone();
                    group.load(self.scene, &acting);
                    for (body, sample) in group.members.clone().zip(group.samples(event.at)) {
                        sizes.count(&self.parts.subjects[body], &sample, 0.0);
                    }
                }
            }
            _ => {}
        }
    }

    fn expect_on(&self, body: usize, event: Event, sizes: &mut Sizes) {
        let mut group = self.parts.group_of(body).clone();
        let (at, lasts) = (event.at, event.action.lasts());
        if let Action::Set(change) = &event.action {
            group.set(body, change);
        }
        if let Some(strike) = strike(&mut group, body, &event).and_then(|jump| jump.strike) {
            sizes.count_impulse(strike.force_w.norm());
        }
        let mut acting = self.parts.acting.clone();
        acting.events.push(Lasting {
            index: 0,
            body,
            event,
        });
        group.load(self.scene, &acting);
        sizes.count(&self.parts.subjects[body], &group.sample(body, at), lasts);
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
        let works = self.parts.groups.iter().map(Group::work);
        outcome.work = works.fold(Work::default(), |a, b| a + b);
        outcome.end = self.samples(now.time);
        let watches = self.parts.watches.iter().map(RefCell::borrow);
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
        self.open(schedule, chooser, outcome, sink)?;
        self.go_on(schedule, chooser, outcome, sink)
    }

    /// What happens at the start.
    fn open(
        &mut self,
        schedule: &mut Schedule<'_>,
        chooser: &mut dyn Choose,
        outcome: &mut Outcome,
        sink: &mut dyn Sink,
    ) -> Result<(), SimError> {
        let start = schedule.now();
        self.write_notes(&[], start, start.time, sink)?;
        let applied = self.apply(start, &script::at_start(self.scene), schedule);
        self.log(start, &applied, outcome, sink)?;
        self.parts.deliver_motions(start, sink)?;
        let all: Vec<usize> = (0..self.parts.subjects.len()).collect();
        self.must_be_finite(start, &all, sink)?;
        self.set_out(&all, schedule, chooser);
        let samples = self
            .parts
            .samples_outside_swarms(|group| group.samples(start.time));
        self.deliver(0, start, (samples, self.scene.record.streams), sink)?;
        self.deliver_fingerprint(start, sink)?;
        Ok(())
    }

    /// Stretch by stretch, to the end of the scene or where the clock is to halt.
    fn go_on(
        &mut self,
        schedule: &mut Schedule<'_>,
        chooser: &mut dyn Choose,
        outcome: &mut Outcome,
        sink: &mut dyn Sink,
    ) -> Result<(), SimError> {
        loop {
            let first = schedule.now();
            if self.stop.is_some_and(|stop| stop.load(Ordering::Relaxed)) {
                let Instant { time, step } = first;
                return Err(SimError::Stopped { time, step });
            }
            let most = self.pace.steps(&self.parts.groups, self.scene.step);
            let Some(stretch) = schedule.next_stretch(most) else {
                if schedule.is_over() {
                    self.write_notes(&[], first, f64::INFINITY, sink)?;
                }
                return Ok(());
            };
            sink.caught_up()?;
            let lost = match stretch.steps.is_empty() {
                // Something happens where it stands.
                true => None,
                false => {
                    self.pace.take(stretch.steps.len(), &self.parts.groups);
                    self.stretch(&stretch, first, sink)?
                }
            };
            let until = lost.map_or(schedule.now(), |(at, _)| at);
            self.write_notes(&stretch.steps, first, until.time, sink)?;
            if let Some((at, body)) = lost {
                schedule.stop_at(at);
                return Err(self.not_finite(at, body, self.cause(body), sink));
            }
            if !stretch.happenings.is_empty() {
                let now = schedule.now();
                let before = self.before(now, &stretch);
                let applied = self.apply(now, &stretch.happenings, schedule);
                let touched = self.touched(&applied);
                for Before { body, sample, news } in &before {
                    if touched.binary_search(body).is_ok() {
                        let sample = std::slice::from_ref(sample);
                        sink.samples(now, *body..body + 1, sample)?;
                    }
                    warn(now, news, sink)?;
                }
                if self.log(now, &applied, outcome, sink)? {
                    self.parts.deliver_motions(now, sink)?;
                }
                self.deliver_bodies(now, &touched, sink)?;
                self.must_be_finite(now, &touched, sink)?;
                self.deliver_fingerprint(now, sink)?;
                self.set_out(&touched, schedule, chooser);
            }
        }
    }

    /// Starts the method of the groups of these bodies, and what is known of their true motion:
    /// from now until an event touches them.
    fn set_out(&mut self, bodies: &[usize], schedule: &Schedule<'_>, chooser: &mut dyn Choose) {
        let mut groups: Vec<usize> = bodies.iter().map(|&body| self.parts.home[body]).collect();
        groups.dedup();
        if !groups.is_empty() {
            self.pace.set_out();
        }
        let now = schedule.now().time;
        for group in groups {
            let members = self.parts.groups[group].members.clone();
            let touches = |happening| self.parts.acting.touches(self.scene, happening, &members);
            let until = schedule.until(touches);
            self.parts.groups[group].set_out(chooser, now, until);
        }
        for &body in bodies
            .iter()
            .take_while(|body| **body < self.parts.outside_swarms)
        {
            let truth = &self.parts.truths[body];
            let group = self.parts.group_of(body);
            let sample = group.sample(body, now);
            let simulated = (&self.parts.subjects[body], &sample, group, body);
            let alone = body..body + 1;
            let touches = |happening| self.parts.acting.touches(self.scene, happening, &alone);
            let until = schedule.until(touches);
            truth
                .borrow_mut()
                .set_out((self.scene, &self.parts.acting), (now, until), simulated);
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
        let start = self.parts.timed.then(std::time::Instant::now);
        let lost = self.advance(&stretch.steps);
        self.parts.step_time = start.map(|start| {
            let steps = stretch.steps.len() * self.parts.groups.len();
            start.elapsed().as_secs_f64() / steps.max(1) as f64
        });
        let Some((taken, body)) = lost else {
            self.deliver_stretch(stretch, sink)?;
            return Ok(None);
        };
        let cut = stretch.cut(taken, first);
        for group in &mut self.parts.groups {
            group.retake(&cut.steps);
        }
        self.deliver_stretch(&cut, sink)?;
        Ok(Some((cut.after(taken - 1, first), body)))
    }

    /// Steps all groups, each through all the steps, on as many threads as are allowed. Bodies do
    /// not act on each other, so it is all one in which order. The first loss of a state there is:
    /// the steps taken until then, and the body.
    fn advance(&mut self, steps: &[Step]) -> Option<(usize, usize)> {
        let enough = self.parts.groups.len() * steps.len() >= WORTH_A_THREAD;
        let threads = if enough { self.parts.threads } else { 1 };
        let share = self.parts.groups.len().div_ceil(threads).max(1);
        let advance = |groups: &mut [Group]| {
            let losses = groups.iter_mut().filter_map(|group| group.advance(steps));
            losses.min()
        };
        if threads == 1 {
            return advance(&mut self.parts.groups);
        }
        std::thread::scope(|scope| {
            let shares = self.parts.groups.chunks_mut(share);
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
        let kept = stretch.kept.iter().enumerate();
        let states = kept.filter(|(_, kept)| kept.state);
        let (states, instants): (Vec<usize>, Vec<Instant>) =
            states.map(|(k, kept)| (k, kept.at)).unzip();
        let (states, instants) = (states.into(), instants.into());
        for group in &self.parts.groups {
            sink.poses(group.poses_kept(&states, &instants))?;
        }
        for (k, kept) in stretch.kept.iter().enumerate() {
            if kept.display || !kept.due.is_empty() {
                let (time, apart) = (kept.at.time, kept.due.meets(self.parts.apart));
                let samples = self
                    .parts
                    .samples_outside_swarms(|group| group.samples_kept(k, time, apart));
                self.deliver_when(0, kept.at, (samples, kept.due), kept.display, sink)?;
            }
            if kept.display && sink.wants_fingerprints() {
                let mix = |hash, group: &Group| group.hash_kept_into(k, hash);
                sink.fingerprint(kept.at, self.parts.groups.iter().fold(HASH_START, mix))?;
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
            let group = self.parts.group_of(body);
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
            body: self.parts.subjects[body].name.clone(),
            time: at.time,
            step: at.step,
            by: match self.parts.group_of(body).method {
                "" => String::new(),
                method => format!(", by {method}"),
            },
            cause,
        };
        let note = Note {
            body: Some(body),
            text: error.to_string(),
            kind: NoteKind::Failure,
            strike: None,
        };
        let mut samples = self
            .parts
            .samples_outside_swarms(|group| group.samples(at.time));
        for sample in &mut samples {
            sample.due = self.scene.record.streams;
        }
        let written = sink
            .samples(at, 0..samples.len(), &samples)
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
        let group = self.parts.group_of(body);
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

    /// Writes the notes up to a time (s), each at its own, counting the steps from `first` on.
    fn write_notes(
        &mut self,
        steps: &[Step],
        first: Instant,
        until: f64,
        sink: &mut dyn Sink,
    ) -> Result<(), SinkError> {
        while let Some((time, note)) = self.parts.notes.get(self.parts.noted)
            && *time <= until
        {
            let taken = steps.partition_point(|step| step.to <= *time);
            let at = Instant {
                time: *time,
                step: first.step + taken as u64,
            };
            sink.note(at, note)?;
            self.parts.noted += 1;
        }
        Ok(())
    }

    /// The bodies that the happenings at a stretch's end may touch, as they are before; where some streams have
    /// been recorded there the others.
    fn before(&self, now: Instant, stretch: &Stretch) -> Vec<Before> {
        let all = self.scene.record.streams;
        let (shown, due) = match stretch.kept.last() {
            Some(last) => (last.display, all.without(last.due)),
            None => (false, all),
        };
        if shown && due.is_empty() {
            return Vec::new();
        }
        let happenings = &stretch.happenings;
        let mut bodies: Vec<usize> = Vec::new();
        let event = |happening: &Happening| &self.scene.events[happening.event()];
        let sets = |happening| matches!(event(happening).action, Action::Set(_));
        let moved = happenings.iter().any(sets);
        for happening in happenings {
            let event = event(happening);
            match (&event.target, happening, &event.action) {
                (Target::Body(body), ..) => bodies.push(*body),
                (Target::Hit(_), Happening::Ends(index), _) => {
                    let acting = self.parts.acting.events.iter();
                    let hit = acting.filter(|acting| acting.index == *index);
                    bodies.extend(hit.map(|acting| acting.body));
                }
                // Where nothing is set first, it is known whom a ray will hit.
                (Target::Hit(range), _, Action::Click(click)) if !moved => {
                    bodies.extend(self.pick(range, click).map(|(body, _)| body));
                }
                (Target::Hit(range), ..) => bodies.extend(range.clone()),
                (Target::All, ..) => bodies.extend(0..self.parts.subjects.len()),
                (Target::Log(_), ..) => {}
            }
        }
        bodies.retain(|body| *body < self.parts.outside_swarms);
        bodies.sort_unstable();
        bodies.dedup();
        let before = |body| {
            let mut sample = self.parts.group_of(body).sample(body, now.time);
            sample.due = due;
            sample.step_time = self.parts.step_time;
            let news = self.judge(body, &mut sample, now);
            Before { body, sample, news }
        };
        bodies.into_iter().map(before).collect()
    }

    /// Ends and begins events, in their order: what lasts is put among what acts, an instant is done at
    /// once.
    fn apply(
        &mut self,
        now: Instant,
        happenings: &[Happening],
        schedule: &mut Schedule<'_>,
    ) -> Vec<Applied> {
        let mut all = Vec::with_capacity(happenings.len());
        for &happening in happenings {
            let index = happening.event();
            let (picked, done) = match happening {
                Happening::Ends(_) => (None, self.end(index)),
                Happening::Begins(_) => self.begin(index, now.time),
            };
            if let Some(Done::Missed) = done {
                schedule.cancel(Happening::Ends(index));
            }
            all.extend(done.map(|done| Applied {
                index,
                picked,
                done,
            }));
        }
        let mut groups = self.touched(&all);
        groups
            .iter_mut()
            .for_each(|body| *body = self.parts.home[*body]);
        groups.dedup();
        for group in groups {
            self.parts.groups[group].load(self.scene, &self.parts.acting);
        }
        all
    }

    fn end(&mut self, index: usize) -> Option<Done> {
        let events = &mut self.parts.acting.events;
        let acting = events.iter().position(|acting| acting.index == index)?;
        Some(Done::Ended(events.remove(acting).body))
    }

    fn begin(&mut self, index: usize, at: f64) -> (Option<Picked>, Option<Done>) {
        let event = &self.scene.events[index];
        match (&event.action, &event.target) {
            (Action::Switch { effect, on }, _) => {
                self.parts.acting.on[*effect] = *on;
                (None, Some(Done::Switched))
            }
            // What it is the chooser knows.
            (Action::Method(_), _) => (None, Some(Done::Changed)),
            (Action::Set(change), Target::Body(body)) => {
                let body = *body;
                let group = &mut self.parts.groups[self.parts.home[body]];
                group.set(body, change);
                let held = self.scene.bodies[body].pivot_b.is_some();
                match self.parts.truths.get_mut(body).map(RefCell::get_mut) {
                    // What was lost is known again.
                    Some(truth) if self.parts.compared && change.says_all(held) => {
                        truth.restart(group.alone(body), at);
                    }
                    Some(truth) => truth.set(body, change, at),
                    None => {}
                }
                (None, Some(Done::Set(body)))
            }
            (Action::Click(click), Target::Hit(bodies)) => match self.pick(bodies, click) {
                None => (None, Some(Done::Missed)),
                Some((body, picked)) => {
                    let event = event.on(body, click.at(picked.point_b));
                    (Some(picked), Some(self.act(index, body, event, at)))
                }
            },
            (
                Action::Push { .. }
                | Action::Torque { .. }
                | Action::Impulse { .. }
                | Action::AngularImpulse { .. },
                Target::Body(body),
            ) => {
                let done = self.act(index, *body, event.clone(), at);
                (None, Some(done))
            }
            // Notes are written by their times. No other action comes with another target.
            (Action::Note(_), _)
            | (
                Action::Push { .. }
                | Action::Torque { .. }
                | Action::Impulse { .. }
                | Action::AngularImpulse { .. }
                | Action::Set(_)
                | Action::Click(_),
                _,
            ) => (None, None),
        }
    }

    /// Strikes a body, or begins to push it.
    fn act(&mut self, index: usize, body: usize, event: Event, at: f64) -> Done {
        let group = &mut self.parts.groups[self.parts.home[body]];
        if let Some(jump) = strike(group, body, &event) {
            if let Some(truth) = self.parts.truths.get_mut(body) {
                strike_truth(truth.get_mut(), body, &event, at);
            }
            return Done::Struck(body, jump);
        }
        let lasting = Lasting { index, body, event };
        self.parts.acting.events.push(lasting.clone());
        Done::Begun(lasting)
    }

    /// The first of some bodies that a click's ray hits, as they are now.
    fn pick(&self, bodies: &Range<usize>, click: &Click) -> Option<(usize, Picked)> {
        let motion = |body: usize| self.parts.group_of(body).motion_of(body);
        let posed = bodies
            .clone()
            .map(|body| (&self.parts.subjects[body], motion(body)));
        let (k, picked) = pick::first_hit(&click.ray_w, posed)?;
        Some((bodies.start + k, picked))
    }

    /// Writes the log; true where a state jumped.
    fn log(
        &self,
        now: Instant,
        applied: &[Applied],
        outcome: &mut Outcome,
        sink: &mut dyn Sink,
    ) -> Result<bool, SinkError> {
        let mut jumped = false;
        for Applied {
            index,
            picked,
            done,
        } in applied
        {
            let event = &self.scene.events[*index];
            let picked = picked.as_ref();
            let named = |body: usize| (body, &self.parts.subjects[body]);
            let mut blow = |body: usize, sample: Sample, own: script::Own, jump| {
                outcome.blows.push(Blow {
                    at: now,
                    event: *index,
                    body,
                    sample,
                    tau_w: own.tau_w,
                    push: own.push,
                    jump,
                });
            };
            let note = match done {
                Done::Begun(Lasting {
                    body, event: acts, ..
                }) => {
                    let group = self.parts.group_of(*body);
                    let (own, sample) = (group.own(*body, acts), group.sample(*body, now.time));
                    let note = script::begin_note((event, picked), named(*body), (&own, &sample));
                    blow(*body, sample, own, None);
                    note
                }
                Done::Struck(body, jump) => {
                    jumped = true;
                    let sample = self.parts.group_of(*body).sample(*body, now.time);
                    blow(*body, sample, script::Own::default(), Some(*jump));
                    script::strike_note((event, picked), named(*body), *jump)
                }
                Done::Ended(body) => {
                    let sample = self.parts.group_of(*body).sample(*body, now.time);
                    script::end_note(event, named(*body), &sample)
                }
                Done::Set(body) => {
                    jumped = true;
                    script::set_note(event, named(*body))
                }
                Done::Switched => script::switch_note(event, self.scene),
                Done::Changed => script::method_note(event),
                Done::Missed => script::miss_note(event),
            };
            sink.note(now, &note)?;
        }
        Ok(jumped)
    }

    /// The bodies whose motion goes on otherwise, each once.
    fn touched(&self, applied: &[Applied]) -> Vec<usize> {
        let mut bodies: Vec<usize> = Vec::new();
        for Applied { done, .. } in applied {
            match done {
                Done::Begun(lasting) => bodies.push(lasting.body),
                Done::Ended(body) | Done::Struck(body, _) | Done::Set(body) => bodies.push(*body),
                Done::Switched | Done::Changed => bodies.extend(0..self.parts.subjects.len()),
                Done::Missed => {}
            }
        }
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
        for &body in bodies
            .iter()
            .take_while(|body| **body < self.parts.outside_swarms)
        {
            let sample = vec![self.parts.group_of(body).sample(body, now.time)];
            self.deliver(body, now, (sample, self.scene.record.streams), sink)?;
        }
        Ok(())
    }

    /// Delivers the samples of bodies from `first` on, with how far they are from the truth; and then what
    /// drifts.
    fn deliver(
        &self,
        first: usize,
        at: Instant,
        samples: (Vec<Sample>, StreamSet),
        sink: &mut dyn Sink,
    ) -> Result<(), SinkError> {
        self.deliver_when(first, at, samples, true, sink)
    }

    /// The same; at an instant that is not shown they are looked for drift only where a stream that is due says it.
    fn deliver_when(
        &self,
        first: usize,
        at: Instant,
        (mut samples, due): (Vec<Sample>, StreamSet),
        shown: bool,
        sink: &mut dyn Sink,
    ) -> Result<(), SinkError> {
        let mut news = Vec::new();
        for (body, sample) in (first..).zip(&mut samples) {
            sample.due = due;
            sample.shown = shown;
            sample.step_time = self.parts.step_time;
            if shown || due.meets(self.parts.judged) {
                news.extend(self.judge(body, sample, at));
            }
        }
        sink.samples(at, first..first + samples.len(), &samples)?;
        warn(at, &news, sink)
    }

    /// Adds to a sample how far it is from the truth, where that is known and recorded; what is found to drift.
    fn judge(&self, body: usize, sample: &mut Sample, at: Instant) -> Vec<Warning> {
        let subject = &self.parts.subjects[body];
        let mut truth = self.parts.truths[body].borrow_mut();
        let deviation = truth.deviation(subject, sample, at.time);
        let news = self.parts.group_of(body).choice.map(|choice| {
            let made = Made {
                at,
                body,
                subject,
                choice,
                step: self.scene.step,
                free: truth.is_exact(),
            };
            let mut watch = self.parts.watches[body].borrow_mut();
            watch.look(&made, sample, &deviation)
        });
        if self.parts.compared {
            sample.deviation = deviation;
        }
        news.unwrap_or_default()
    }

    fn samples(&self, t: f64) -> Vec<Sample> {
        self.parts
            .groups
            .iter()
            .flat_map(|group| group.samples(t))
            .collect()
    }

    /// Delivers the hash of all states as they are now.
    fn deliver_fingerprint(&self, now: Instant, sink: &mut dyn Sink) -> Result<(), SinkError> {
        if !sink.wants_fingerprints() {
            return Ok(());
        }
        sink.fingerprint(now, self.parts.fingerprint())
    }
}

impl Parts {
    fn group_of(&self, body: usize) -> &Group {
        &self.groups[self.home[body]]
    }

    /// Of the bodies that are in no swarm.
    fn samples_outside_swarms(&self, of: impl Fn(&Group) -> Vec<Sample>) -> Vec<Sample> {
        let groups = self.groups.iter();
        let groups = groups.take_while(|group| group.members.start < self.outside_swarms);
        let mut samples: Vec<Sample> = groups.flat_map(of).collect();
        samples.truncate(self.outside_swarms);
        samples
    }

    /// A hash of all states.
    fn fingerprint(&self) -> u64 {
        let groups = self.groups.iter();
        groups.fold(HASH_START, |hash, group| group.hash_into(hash))
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

fn streams(names: &[&str]) -> StreamSet {
    let sets = names.iter().filter_map(|name| StreamSet::of(name));
    sets.fold(StreamSet::none(), StreamSet::with)
}

fn is_compared(scene: &Scene) -> bool {
    let compared = ["error", "drift"];
    let mut recorded = compared
        .iter()
        .map(|name| scene.record.streams.contains(name));
    recorded.any(|is| is)
}

/// A body just before something happens to it.
struct Before {
    body: usize,
    sample: Sample,
    news: Vec<Warning>,
}

fn warn(at: Instant, news: &[Warning], sink: &mut dyn Sink) -> Result<(), SinkError> {
    for warning in news {
        let note = Note {
            body: Some(warning.body),
            text: warning.to_string(),
            kind: NoteKind::Warning,
            strike: None,
        };
        sink.note(at, &note)?;
    }
    Ok(())
}

/// The true motion of every body, where a stream compares with it; else what its model keeps.
fn truths(scene: &Scene) -> Vec<RefCell<Truth>> {
    if !is_compared(scene) {
        let unknown = (0..scene.outside_swarms()).map(|_| Truth::unknown());
        return unknown.map(RefCell::new).collect();
    }
    let each = group::groups(scene, 1);
    each.into_iter()
        .take(scene.outside_swarms())
        .map(|body| RefCell::new(Truth::new(body)))
        .collect()
}

/// Strikes the truth as [`strike`] strikes the simulated body.
fn strike_truth(truth: &mut Truth, body: usize, event: &Event, at: f64) {
    match event.action {
        Action::Impulse { impulse, point } => truth.strike(body, impulse, Some(point), at),
        Action::AngularImpulse { impulse } => truth.strike(body, impulse, None, at),
        _ => {}
    }
}

/// What an impulse does, at once; `None` of what is none.
fn strike(group: &mut Group, body: usize, event: &Event) -> Option<Jump> {
    match event.action {
        Action::Impulse { impulse, point } => Some(group.strike(body, impulse, Some(point))),
        Action::AngularImpulse { impulse } => Some(group.strike(body, impulse, None)),
        _ => None,
    }
}
