//! Level 7: a scene that is stepped, pushed, set back and changed while one watches; no terminal, no network.
//!
//! A [`Session`] owns a scene's text and steps it on demand. Going back is going to the nearest stored state and
//! stepping again: the motion is deterministic, so the bits are those of the first time. A change goes into the
//! text, as an event at that time or an effect switched to, and nowhere else: what one sees is what the text says,
//! from its start, to the last bit. Where there is a later already it makes a [`Branch`]. [`Console`] is the same by
//! lines of text, at the pace of a clock.

mod breaks;
mod console;
mod gate;
mod hand;
mod numbers;
mod pace;
pub mod protocol;
mod store;
mod ways;

pub use breaks::{Break, Broke};
pub use console::{Console, IntoFolder, Said, Saver};
pub use hand::{NEAREST, Place, Push, Pushed, What};
pub use numbers::Numbers;
pub use pace::{Clock, Pace, Pacing, SystemClock};
pub use store::{EVERY, MEMORY};

use crate::integrator;
use crate::mass::ray::Ray;
use crate::scene::pick::Picked;
use crate::scene::{Entry, Scene, Script, Stepping};
use crate::sim::{Blow, Checkpoint, Limit, Run};
use crate::trace::{Condition, Instant, Sample, Sink, SinkError, Subject, nearest};
use breaks::Breaks;
use gate::{From, Gate};
use nalgebra::Vector3;
use std::sync::Arc;
use store::Store;
use ways::Ways;

/// A scene being played with.
pub struct Session {
    branches: Vec<Branch>,
    /// The branch that is played.
    here: usize,
    run: Run,
    ways: Ways,
    store: Store,
    breaks: Breaks,
    /// A breakpoint that a change has brought about, still to be told.
    due: Option<Broke>,
    pushed: Option<Push>,
    settings: Settings,
}

#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Bytes of stored states at most.
    pub memory: usize,
    /// Whether torques are told apart, where a stream does, as if each body were pushed at some time: so that the
    /// sources do not change with the first push.
    pub expect_pushes: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            memory: MEMORY,
            expect_pushes: true,
        }
    }
}

/// One way that the scene went.
pub struct Branch {
    pub name: String,
    /// The branch that it comes from, and what it shares with it.
    pub parent: Option<Parent>,
    /// What made it so, in order.
    pub changes: Vec<String>,
    /// As far as it was stepped.
    pub head: Instant,
    script: Script,
    /// Rows up to there have been delivered, s.
    delivered: Option<f64>,
}

#[derive(Clone, Copy, Debug)]
pub struct Parent {
    /// Its place in [`Session::branches`].
    pub branch: usize,
    /// Up to there both are the same.
    pub at: Instant,
    /// Whether it was changed from the start on, and nothing is the same.
    pub from_start: bool,
    /// Events that both have.
    events: usize,
}

/// Why nothing was done.
#[derive(Debug, thiserror::Error)]
pub enum SessionError {
    #[error("{0}")]
    Refused(String),
    #[error(transparent)]
    Sink(#[from] SinkError),
}

/// Why it stopped before it was to.
#[derive(Clone, Debug, PartialEq)]
pub enum Stop {
    Broke(Broke),
    /// The scene is over.
    End,
    /// A state is no longer finite.
    Lost(String),
}

/// Branches at most: each holds a text.
const MOST_BRANCHES: usize = 1000;

type Done<T> = Result<T, SessionError>;

fn refused<T>(why: impl Into<String>) -> Done<T> {
    Err(SessionError::Refused(why.into()))
}

impl Session {
    /// A scene as it stands, its sweep left aside, at its start.
    pub fn open(mut script: Script, settings: Settings, sink: &mut dyn Sink) -> Done<Self> {
        script.drop_sweep();
        let (script, scene, ways) = read(script)?;
        let mut session = Self {
            run: fresh(&scene, settings),
            branches: vec![Branch {
                name: "main".to_owned(),
                parent: None,
                changes: Vec::new(),
                head: START,
                script,
                delivered: None,
            }],
            here: 0,
            ways,
            store: Store::new(settings.memory),
            breaks: Breaks::default(),
            due: None,
            pushed: None,
            settings,
        };
        session.go(Limit::steps(0), From::Start, sink)?;
        Ok(session)
    }

    pub fn now(&self) -> Instant {
        self.run.now()
    }

    pub fn scene(&self) -> &Scene {
        self.run.scene()
    }

    /// The bodies. They are the same in every branch, but for what is told apart of their torques where an effect was
    /// added.
    pub fn subjects(&self) -> &[Subject] {
        self.run.subjects()
    }

    pub fn is_over(&self) -> bool {
        self.run.is_over()
    }

    /// Why it goes no further, where a state was lost.
    pub fn failure(&self) -> Option<&str> {
        self.run.failure()
    }

    /// A hash of every bit of all bodies' states, as recordings hold it.
    pub fn fingerprint(&self) -> u64 {
        self.run.fingerprint()
    }

    pub fn branches(&self) -> &[Branch] {
        &self.branches
    }

    /// The branch that is played.
    pub fn branch(&self) -> &Branch {
        &self.branches[self.here]
    }

    /// Stored states and their bytes.
    pub fn stored(&self) -> (usize, usize) {
        (self.store.len(), self.store.bytes())
    }

    /// The scene that makes this branch, as a file would hold it.
    pub fn text(&self) -> &str {
        &self.scene().text
    }

    /// A body by its name.
    pub fn find(&self, body: &str) -> Done<usize> {
        let subjects = self.subjects();
        if let Some(k) = subjects.iter().position(|subject| subject.name == body) {
            return Ok(k);
        }
        let names: Vec<&str> = subjects.iter().map(|subject| &*subject.name).collect();
        refused(format!(
            "no body is called `{body}`; {}",
            nearest(body, &names)
        ))
    }

    fn known(&self, body: &str) -> Done<(usize, Sample)> {
        let k = self.find(body)?;
        match self.run.sample(k) {
            Some(sample) => Ok((k, sample)),
            None => refused(format!("no body is called `{body}`")),
        }
    }

    /// A body's numbers as it is.
    pub fn numbers(&self, body: &str) -> Done<Numbers> {
        let (k, sample) = self.known(body)?;
        Ok(Numbers::of(&self.run, k, sample))
    }

    /// The first body on a ray (world).
    pub fn pick(&self, ray_w: &Ray) -> Option<(usize, Picked)> {
        self.run.pick(ray_w)
    }

    /// Steps on, at most as far as that; stops at the first step at which a breakpoint's condition begins to hold.
    pub fn advance(&mut self, limit: Limit, sink: &mut dyn Sink) -> Done<Option<Stop>> {
        if let Some(broke) = self.due.take() {
            return Ok(Some(Stop::Broke(broke)));
        }
        let goal = self.now().step.saturating_add(limit.steps);
        loop {
            let before = self.now();
            if let Some(why) = self.run.failure() {
                return Ok(Some(Stop::Lost(why.to_owned())));
            }
            if self.run.is_over() {
                return Ok(Some(Stop::End));
            }
            let left = goal.saturating_sub(before.step);
            if left == 0 {
                return Ok(None);
            }
            let steps = match self.breaks.is_empty() {
                true => EVERY - before.step % EVERY,
                false => 1,
            };
            let limit = Limit {
                steps: steps.min(left),
                until: limit.until,
            };
            self.go(limit, self.fresh_rows(), sink)?;
            if self.now() == before && self.run.failure().is_none() {
                return Ok(None);
            }
            if let Some(broke) = self.look() {
                return Ok(Some(Stop::Broke(broke)));
            }
        }
    }

    fn look(&mut self) -> Option<Broke> {
        if self.breaks.is_empty() {
            return None;
        }
        let samples = self.run.samples();
        self.breaks
            .look(self.run.now(), self.run.subjects(), &samples)
    }

    /// What has not been delivered of this branch.
    fn fresh_rows(&self) -> From {
        self.branch().delivered.map_or(From::Start, From::After)
    }

    /// Goes on in the run, delivers what passes, and stores the state where one is due.
    fn go(&mut self, limit: Limit, from: From, sink: &mut dyn Sink) -> Result<(), SinkError> {
        let mut gate = Gate { inner: sink, from };
        let went = self.run.go(limit, &mut self.ways, &mut gate);
        let (now, here) = (self.run.now(), self.here);
        let branch = &mut self.branches[here];
        if now.step > branch.head.step {
            branch.head = now;
        }
        if from != From::Never {
            let delivered = branch.delivered.unwrap_or(0.0);
            branch.delivered = Some(delivered.max(now.time));
        }
        let own = branch
            .parent
            .is_none_or(|parent| now.step > parent.at.step || parent.from_start);
        let due = now.step > 0 && now.step.is_multiple_of(EVERY) && own;
        if due && self.run.failure().is_none() && !self.store.has(here, now.step) {
            let known = self.scene().events.len();
            self.store.put(here, self.run.checkpoint(), known);
        }
        went
    }

    /// To the last instant of the clock that is not after a time (s), back or on. Breakpoints are passed by.
    pub fn seek(&mut self, time: f64, sink: &mut dyn Sink) -> Done<()> {
        if !time.is_finite() || time < 0.0 {
            return refused("a time is a number of seconds from 0 on");
        }
        if time < self.now().time || self.run.failure().is_some() {
            self.set_back(|checkpoint| checkpoint.at().time <= time, sink)?;
        }
        self.walk(Limit::time(time), sink)
    }

    /// To a step of the clock.
    pub fn seek_step(&mut self, step: u64, sink: &mut dyn Sink) -> Done<()> {
        if step < self.now().step || self.run.failure().is_some() {
            self.set_back(|checkpoint| checkpoint.at().step <= step, sink)?;
        }
        self.walk(Limit::steps(step.saturating_sub(self.now().step)), sink)
    }

    /// Goes back by so many steps, at most to the start.
    pub fn back(&mut self, steps: u64, sink: &mut dyn Sink) -> Done<()> {
        self.seek_step(self.now().step.saturating_sub(steps), sink)
    }

    /// To the start of this branch's scene.
    pub fn reset(&mut self, sink: &mut dyn Sink) -> Done<()> {
        self.seek_step(0, sink)
    }

    /// Steps without looking at breakpoints, storing states on the way.
    fn walk(&mut self, limit: Limit, sink: &mut dyn Sink) -> Done<()> {
        let goal = self.now().step.saturating_add(limit.steps);
        loop {
            let before = self.now();
            let left = goal.saturating_sub(before.step);
            let limit = Limit {
                steps: left.min(EVERY - before.step % EVERY),
                until: limit.until,
            };
            self.go(limit, self.fresh_rows(), sink)?;
            if self.now() == before || self.run.failure().is_some() {
                break;
            }
        }
        self.due = None;
        // What holds here has begun before.
        self.look();
        Ok(())
    }

    /// Back to the last stored state for which `is` is true, of this branch or of one that it comes from; or else to
    /// the start.
    fn set_back(&mut self, is: impl Fn(&Checkpoint) -> bool, sink: &mut dyn Sink) -> Done<()> {
        let scene = Arc::clone(self.run.scene());
        let (mut branch, mut last, mut known) = (self.here, u64::MAX, scene.events.len());
        let found = loop {
            let fits = |checkpoint: &Checkpoint| is(checkpoint) && checkpoint.at().step <= last;
            if let Some(stored) = self.store.last(branch, fits) {
                break Some(stored);
            }
            match self.branches[branch].parent {
                Some(parent) if !parent.from_start => {
                    last = last.min(parent.at.step);
                    known = known.min(parent.events);
                    branch = parent.branch;
                }
                _ => break None,
            }
        };
        match found {
            Some(stored) if branch == self.here && stored.known == scene.events.len() => {
                self.run.restore(&stored.checkpoint);
            }
            Some(stored) => {
                let carried = Run::carried(
                    Arc::clone(&scene),
                    &stored.checkpoint,
                    stored.known.min(known),
                );
                // Where bodies go in other groups now the start is still right.
                self.run = carried.unwrap_or_else(|| Run::new(Arc::clone(&scene)));
                self.run.expect_pushes(self.settings.expect_pushes);
            }
            None => self.run = fresh(&scene, self.settings),
        }
        self.go(Limit::steps(0), self.fresh_rows(), sink)?;
        Ok(())
    }

    /// Goes over to another branch, to the same time or as far as that was stepped.
    pub fn enter(&mut self, name: &str, sink: &mut dyn Sink) -> Done<()> {
        let names = self.branches.iter().map(|branch| &*branch.name);
        let names: Vec<&str> = names.collect();
        let Some(k) = names.iter().position(|known| *known == name) else {
            return refused(format!(
                "no branch is called `{name}`; {}",
                nearest(name, &names)
            ));
        };
        let time = self.now().time.min(self.branches[k].head.time);
        let (_, scene, ways) = read(self.branches[k].script.clone())?;
        self.here = k;
        self.ways = ways;
        self.run = fresh(&scene, self.settings);
        self.set_back(|checkpoint| checkpoint.at().time <= time, sink)?;
        self.walk(Limit::time(time), sink)
    }

    /// Adds to the scene what begins now. Where there is a later it makes a branch.
    fn amend(&mut self, entries: Vec<Entry>, words: &str, sink: &mut dyn Sink) -> Done<Vec<Blow>> {
        if let Some(why) = self.run.failure() {
            return refused(format!("{why}; go back before that"));
        }
        if let Stepping::Accuracy(_) = self.scene().stepping {
            return refused(
                "this scene states an accuracy, and its methods are planned for all that happens in it; name one first: `method dop853 from start`",
            );
        }
        let (now, events) = (self.now(), self.scene().events.len());
        let mut script = self.branch().script.clone();
        for entry in entries {
            script.add(entry, words);
        }
        let (script, scene, ways) = read(script)?;
        let run = match now.step {
            // Before the first step what begins at the start has still to begin.
            0 => Some(fresh(&scene, self.settings)),
            _ => Run::carried(Arc::clone(&scene), &self.run.checkpoint(), events),
        };
        if now.step < self.branch().head.step {
            self.grow(Branch {
                name: String::new(),
                parent: Some(Parent {
                    branch: self.here,
                    at: now,
                    from_start: false,
                    events,
                }),
                changes: Vec::new(),
                head: now,
                script,
                delivered: (now.step > 0).then_some(now.time),
            })?;
        } else {
            self.branches[self.here].script = script;
        }
        self.branches[self.here].changes.push(words.to_owned());
        self.ways = ways;
        match run {
            Some(mut run) => {
                run.expect_pushes(self.settings.expect_pushes);
                self.run = run;
            }
            None => {
                self.run = fresh(&scene, self.settings);
                self.go(Limit::steps(now.step), From::At(now.time), sink)?;
            }
        }
        if self.scene().record.state != crate::scene::Rate::EveryStep {
            self.run.show(sink)?;
        }
        self.go(Limit::steps(0), From::At(now.time), sink)?;
        let mut blows = self.run.take_blows();
        blows.retain(|blow| blow.event >= events);
        self.due = self.look();
        Ok(blows)
    }

    /// A branch by a change from the start on, and to its start.
    fn amend_from_start(&mut self, script: Script, words: &str, sink: &mut dyn Sink) -> Done<()> {
        let (script, scene, ways) = read(script)?;
        let changes = vec![format!("{words}, from the start")];
        self.grow(Branch {
            name: String::new(),
            parent: Some(Parent {
                branch: self.here,
                at: START,
                from_start: true,
                events: 0,
            }),
            changes,
            head: START,
            script,
            delivered: None,
        })?;
        self.ways = ways;
        self.run = fresh(&scene, self.settings);
        self.due = None;
        self.go(Limit::steps(0), From::Start, sink)?;
        self.look();
        Ok(())
    }

    fn grow(&mut self, mut branch: Branch) -> Done<()> {
        if self.branches.len() == MOST_BRANCHES {
            return refused(format!("there are {MOST_BRANCHES} branches already"));
        }
        branch.name = format!("branch-{}", self.branches.len());
        self.branches.push(branch);
        self.here = self.branches.len() - 1;
        Ok(())
    }

    fn event(&self) -> Entry {
        Entry::event(self.run.latest_here())
    }

    /// Pushes a body, now.
    pub fn push(&mut self, push: Push, words: &str, sink: &mut dyn Sink) -> Done<Pushed> {
        let body = self.find(&push.body)?;
        let mut entry = self.event().with_text("body", &push.body);
        entry = match &push.what {
            What::Torque(torque) => entry.with_vector("torque", *torque),
            What::Force { force, at } => {
                let (in_body, point) = match *at {
                    Place::World(point) => (false, point),
                    Place::Body(point) => (true, point),
                };
                entry
                    .with_vector("force", *force)
                    .with_point(in_body, point)
            }
        };
        if let Some(lasts) = push.lasts {
            entry = entry.with_number("for", lasts);
        }
        if push.in_body {
            entry = entry.with_text("frame", "body");
        }
        let blows = self.amend(vec![entry], words, sink)?;
        self.pushed = Some(push.clone());
        match blows.last() {
            Some(blow) => Ok(Pushed::of(push, blow, &self.subjects()[body])),
            None => refused("the push did not begin"),
        }
    }

    /// The same, so strong that it gives `spin` rad/s by itself.
    pub fn push_giving(
        &mut self,
        spin: f64,
        push: Push,
        words: &str,
        sink: &mut dyn Sink,
    ) -> Done<Pushed> {
        let (body, sample) = self.known(&push.body)?;
        let push = push.giving(spin, &self.subjects()[body], &sample);
        self.push(push.map_err(SessionError::Refused)?, words, sink)
    }

    /// The torque of a push about the reference point, without its force.
    pub fn couple_of(&self, push: Push) -> Done<Push> {
        let (body, sample) = self.known(&push.body)?;
        let subject = &self.subjects()[body];
        let What::Force { force, at } = push.what else {
            return Ok(push);
        };
        let turned = |v: Vector3<f64>| sample.motion.q_wb * v;
        let force_w = if push.in_body { turned(force) } else { force };
        let arm_w = at.point_w(subject, &sample) - sample.reference_w(subject);
        Ok(Push {
            what: What::Torque(arm_w.cross(&force_w)),
            in_body: false,
            ..push
        })
    }

    /// The last push once more, with exactly its numbers.
    pub fn again(&mut self, words: &str, sink: &mut dyn Sink) -> Done<Pushed> {
        match self.pushed.clone() {
            Some(push) => self.push(push, words, sink),
            None => refused("nothing has been pushed yet"),
        }
    }

    /// A value of the scene from now on, where it is one that may change on the way: a body's position, velocity,
    /// orientation or angular velocity, or an effect's argument.
    pub fn set(&mut self, path: &str, value: &str, words: &str, sink: &mut dyn Sink) -> Done<()> {
        if let Some((body, key)) = path.rsplit_once('.')
            && let body = body.strip_prefix("body.").unwrap_or(body)
            && let Some(key) = STATE.iter().find(|known| **known == key)
            && self.find(body).is_ok()
        {
            let entry = self.event().with_text("body", body);
            let entry = entry.with_state(key, one_line(value)?);
            let entry = entry.map_err(SessionError::Refused)?;
            return self.amend(vec![entry], words, sink).map(drop);
        }
        let script = &self.branch().script;
        if !script.is_argument(path, value) {
            return refused(format!(
                "`{path}` cannot change on the way (what can: a body's {}, an effect's arguments; `method` and `effect` have commands); `set {path} {value} from start` makes a branch that has it from the start",
                STATE.join(", "),
            ));
        }
        let amended = script
            .amended(path, one_line(value)?)
            .map_err(SessionError::Refused)?;
        let mut entries = vec![amended.entry];
        let on: Vec<&String> = amended
            .instead_of
            .iter()
            .filter(|name| self.is_on(name))
            .collect();
        for name in &on {
            entries.push(self.event().with_switch(name, false));
        }
        // What is off stays off.
        if !on.is_empty() || amended.instead_of.is_empty() {
            entries.push(self.event().with_switch(&amended.name, true));
        }
        self.amend(entries, words, sink).map(drop)
    }

    /// The same from the start on, of anything that a scene says.
    pub fn set_from_start(
        &mut self,
        path: &str,
        value: &str,
        words: &str,
        sink: &mut dyn Sink,
    ) -> Done<()> {
        let mut script = self.branch().script.clone();
        let set = script.set(&format!("{path}={value}"), words);
        set.map_err(SessionError::Refused)?;
        self.amend_from_start(script, words, sink)
    }

    fn is_on(&self, effect: &str) -> bool {
        let effects = self.scene().effects.iter().zip(self.run.effects_on());
        let mut own = effects.filter(|(known, _)| &*known.name == effect);
        own.any(|(_, on)| *on)
    }

    /// An effect of the scene on or off from now on; of those that took each other's place the latest.
    pub fn switch(&mut self, effect: &str, on: bool, words: &str, sink: &mut dyn Sink) -> Done<()> {
        let alike = self.branch().script.effects_like(effect);
        let Some(latest) = alike.last() else {
            let effects = self.scene().effects.iter();
            let names: Vec<&str> = effects.map(|effect| &*effect.name).collect();
            let remedy = match names.is_empty() {
                true => "the scene has none; `set` adds one: set damping.angular 0.1".to_owned(),
                false => format!("{}; `set` adds another", nearest(effect, &names)),
            };
            return refused(format!("no effect is called `{effect}`; {remedy}"));
        };
        let active: Vec<&String> = alike.iter().filter(|name| self.is_on(name)).collect();
        if on != active.is_empty() {
            let which = if on { "on" } else { "off" };
            return refused(format!("{effect} is {which} already"));
        }
        let entries = match on {
            true => vec![self.event().with_switch(latest, true)],
            false => active
                .iter()
                .map(|name| self.event().with_switch(name, false))
                .collect(),
        };
        self.amend(entries, words, sink).map(drop)
    }

    /// Another method from now on, for all bodies that have none of their own.
    pub fn method(
        &mut self,
        name: &str,
        tolerance: Option<f64>,
        words: &str,
        sink: &mut dyn Sink,
    ) -> Done<()> {
        self.must_be_method(name)?;
        let mut entry = self.event().with_text("method", name);
        if let Some(tolerance) = tolerance {
            entry = entry.with_number("tolerance", tolerance);
        }
        self.amend(vec![entry], words, sink).map(drop)
    }

    /// The same from the start on.
    pub fn method_from_start(
        &mut self,
        name: &str,
        tolerance: Option<f64>,
        words: &str,
        sink: &mut dyn Sink,
    ) -> Done<()> {
        self.must_be_method(name)?;
        let mut script = self.branch().script.clone();
        script.set_method(name, words);
        if let Some(tolerance) = tolerance {
            let set = script.set(&format!("stepping.tolerance={tolerance:?}"), words);
            set.map_err(SessionError::Refused)?;
        }
        self.amend_from_start(script, words, sink)
    }

    fn must_be_method(&self, name: &str) -> Done<()> {
        if integrator::find(name).is_some() {
            return Ok(());
        }
        let names = integrator::METHODS.iter().flat_map(|method| {
            let info = method.info();
            std::iter::once(info.name).chain(info.other_names())
        });
        let names: Vec<&str> = names.collect();
        refused(format!("`{name}` is no method; {}", nearest(name, &names)))
    }

    /// Another step of the clock (s), from the start on: all instants of the clock are multiples of it.
    pub fn step_from_start(&mut self, step: f64, words: &str, sink: &mut dyn Sink) -> Done<()> {
        let mut script = self.branch().script.clone();
        script.set_step(step, words);
        self.amend_from_start(script, words, sink)
    }

    pub fn breaks(&self) -> &[Break] {
        self.breaks.all()
    }

    /// A breakpoint, and whether its condition holds here already: then it is the next time that it begins to.
    pub fn break_when(&mut self, condition: Condition) -> Done<(u64, bool)> {
        let id = self.breaks.add(condition).map_err(SessionError::Refused)?;
        let due = self.due.take();
        let holds = self.look().is_some_and(|broke| broke.id == id);
        self.due = due;
        Ok((id, holds))
    }

    pub fn clear_break(&mut self, id: u64) -> Done<()> {
        match self.breaks.clear(id) {
            true => Ok(()),
            false => refused(format!("there is no breakpoint {id}; `breaks` lists them")),
        }
    }
}

const START: Instant = Instant { time: 0.0, step: 0 };

/// What of a body a scene may set on the way.
const STATE: [&str; 4] = ["position", "velocity", "orientation", "angular_velocity"];

/// A text from a command goes into the scene on its line.
fn one_line(value: &str) -> Done<&str> {
    match value.contains(['\n', '#']) {
        true => refused("a value is on one line, without a comment"),
        false => Ok(value.trim()),
    }
}

fn fresh(scene: &Arc<Scene>, settings: Settings) -> Run {
    let mut run = Run::new(Arc::clone(scene));
    run.expect_pushes(settings.expect_pushes);
    run
}

/// The scene of a script; the script as it is with all its changes done, so that they are done once; its ways.
fn read(script: Script) -> Done<(Script, Arc<Scene>, Ways)> {
    let scene = script.scene();
    let scene = scene.map_err(|why| SessionError::Refused(why.to_string()))?;
    let ways = Ways::of(&scene).map_err(SessionError::Refused)?;
    let script = script.settled(&scene.text, scene.enclosures.clone());
    Ok((script, Arc::new(scene), ways))
}

/// From a point of a picked body as a [`Push`] has it.
pub(crate) fn place_of(subject: &Subject, point_b: Vector3<f64>) -> Place {
    Place::Body(point_b + hand::centre(subject))
}
