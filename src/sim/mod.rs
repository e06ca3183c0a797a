//! Level 5: the loop. Land on event times, step, sample, deliver.

mod group;
mod schedule;
mod script;

use crate::scene::{Action, Scene, StateRate};
use crate::trace::{Instant, Moment, Motion, Note, NoteKind, Sink, SinkError, Subject, Track};
use group::Group;
use nalgebra::Vector3;
use schedule::{Mark, Schedule, Step};
use script::Happening;

/// A scene being stepped.
pub struct Simulation<'s> {
    scene: &'s Scene,
    subjects: Vec<Subject>,
    groups: Vec<Group>,
    /// Indices of the events that act now.
    active: Vec<usize>,
}

/// What a run leaves besides its trace.
#[derive(Clone, Debug)]
pub struct Outcome {
    pub steps: u64,
    /// Every event as it struck.
    pub blows: Vec<Blow>,
    /// All bodies at the end.
    pub end: Vec<Moment>,
}

/// A body at the instant an event began.
#[derive(Clone, Debug)]
pub struct Blow {
    pub at: Instant,
    /// Index of the event.
    pub event: usize,
    /// Just after the event began.
    pub moment: Moment,
    /// For an impulse: the angular impulse about the reference point (N·m·s) and the jump of the
    /// angular velocity (rad/s), world.
    pub jump: Option<(Vector3<f64>, Vector3<f64>)>,
}

/// Why a run stopped before its end.
#[derive(Debug, thiserror::Error)]
pub enum SimError {
    #[error(
        "{body} is no longer finite at t = {time} s, step {step}, by {method}: {cause}; the recording holds everything up to that instant"
    )]
    NotFinite {
        body: String,
        time: f64,
        step: u64,
        method: &'static str,
        cause: String,
    },
    #[error(transparent)]
    Sink(#[from] SinkError),
}

impl<'s> Simulation<'s> {
    pub fn new(scene: &'s Scene) -> Self {
        Self {
            scene,
            subjects: scene.bodies.iter().map(group::subject).collect(),
            groups: group::groups(&scene.bodies),
            active: Vec::new(),
        }
    }

    /// The bodies, as the trace names them.
    pub fn subjects(&self) -> &[Subject] {
        &self.subjects
    }

    /// What every event would do to the bodies as they start out: the sizes to expect.
    pub fn expected(&mut self) -> Vec<Moment> {
        let mut expected = Vec::new();
        for k in 0..self.scene.events.len() {
            self.active = vec![k];
            self.load();
            expected.extend(self.moments(0.0));
        }
        self.active.clear();
        self.load();
        expected.extend(self.moments(0.0));
        expected
    }

    /// Steps the scene from its start to its end.
    pub fn run(mut self, sink: &mut dyn Sink) -> Result<Outcome, SimError> {
        let mut schedule = Schedule::new(self.scene);
        let mut blows = Vec::new();
        self.load();
        let start = schedule.now();
        self.deliver_motions(start, sink)?;
        self.happen(start, &script::at_start(self.scene), &mut blows, sink)?;
        while let Some((steps, mark)) = schedule.next_stretch() {
            self.stretch(&steps, sink)?;
            let now = schedule.now();
            match mark {
                Mark::None => {}
                Mark::Display => sink.moments(now, &self.moments(now.time))?,
                Mark::Events(happenings) => {
                    sink.moments(now, &self.moments(now.time))?;
                    self.happen(now, &happenings, &mut blows, sink)?;
                }
            }
        }
        let now = schedule.now();
        Ok(Outcome {
            steps: now.step,
            blows,
            end: self.moments(now.time),
        })
    }

    /// Takes every group through a stretch without events, one group after another.
    fn stretch(&mut self, steps: &[Step], sink: &mut dyn Sink) -> Result<(), SimError> {
        let mut broken: Option<(Instant, usize)> = None;
        for group in &mut self.groups {
            let mut instants = Vec::with_capacity(steps.len());
            let mut motions = Vec::with_capacity(steps.len() * group.members.len());
            for step in steps {
                group.step(self.scene.method, step.from, step.h);
                let lost = group.first_not_finite();
                if step.keep || lost.is_some() {
                    instants.push(step.after);
                    motions.extend(group.motions());
                }
                if let Some(body) = lost {
                    if broken.is_none_or(|(at, _)| step.after.step < at.step) {
                        broken = Some((step.after, body));
                    }
                    break;
                }
            }
            sink.motions(&Track {
                bodies: group.members.clone(),
                instants: &instants,
                motions: &motions,
            })?;
        }
        match broken {
            None => Ok(()),
            Some((at, body)) => Err(self.not_finite(at, body, sink)),
        }
    }

    /// Records the broken instant in full and says what happened.
    fn not_finite(&self, at: Instant, body: usize, sink: &mut dyn Sink) -> SimError {
        let method = self.scene.method.info().name;
        let error = SimError::NotFinite {
            body: self.subjects[body].name.clone(),
            time: at.time,
            step: at.step,
            method,
            cause: self.cause(body),
        };
        let note = Note {
            body,
            text: error.to_string(),
            kind: NoteKind::Failure,
        };
        let written = sink
            .moments(at, &self.moments(at.time))
            .and_then(|()| sink.note(at, &note));
        match written {
            Ok(()) => error,
            Err(error) => error.into(),
        }
    }

    /// The likeliest reason for a state that is not finite.
    fn cause(&self, body: usize) -> String {
        let group = &self.groups[body / crate::body::LANES];
        let turned = group.turn_before_loss(body, self.scene.step);
        let gyroscopic = self
            .scene
            .effects
            .iter()
            .any(|(name, _)| *name == "gyroscopic");
        if gyroscopic && turned > 0.1 {
            format!(
                "it turned {turned:.3} rad in the step before, too far for the gyroscopic term; take a smaller step or another method"
            )
        } else {
            "a force, an impulse or a speed is too large for 64-bit numbers; look at the events and the initial state".to_owned()
        }
    }

    /// Ends and begins events, delivers all bodies as they are just after, and writes the log.
    fn happen(
        &mut self,
        now: Instant,
        happenings: &[Happening],
        blows: &mut Vec<Blow>,
        sink: &mut dyn Sink,
    ) -> Result<(), SimError> {
        let mut jumps = Vec::new();
        for happening in happenings {
            match *happening {
                Happening::Ends(k) => self.active.retain(|&active| active != k),
                Happening::Begins(k) => {
                    let jump = self.begin(k);
                    jumps.push((k, jump));
                }
            }
        }
        self.load();
        if jumps.iter().any(|(_, jump)| jump.is_some()) {
            self.deliver_motions(now, sink)?;
        }
        let moments = self.moments(now.time);
        sink.moments(now, &moments)?;
        for happening in happenings {
            let note = match *happening {
                Happening::Ends(k) => {
                    script::end_note(&self.scene.events[k], &self.subjects, &moments)
                }
                Happening::Begins(k) => {
                    let jump = jumps
                        .iter()
                        .find(|(event, _)| *event == k)
                        .and_then(|(_, j)| *j);
                    let event = &self.scene.events[k];
                    blows.push(Blow {
                        at: now,
                        event: k,
                        moment: moments[event.body].clone(),
                        jump,
                    });
                    script::begin_note(event, &self.subjects, &moments, jump)
                }
            };
            sink.note(now, &note)?;
        }
        match self.groups.iter().find_map(Group::first_not_finite) {
            None => Ok(()),
            Some(body) => Err(self.not_finite(now, body, sink)),
        }
    }

    /// Starts an event. An impulse acts at once: angular impulse and jump of ω are returned.
    fn begin(&mut self, k: usize) -> Option<(Vector3<f64>, Vector3<f64>)> {
        let event = &self.scene.events[k];
        let group = &mut self.groups[event.body / crate::body::LANES];
        match event.action {
            Action::Push { .. } | Action::Torque { .. } => {
                self.active.push(k);
                None
            }
            Action::Impulse { impulse, point } => {
                Some(group.strike(event.body, impulse, Some(point)))
            }
            Action::AngularImpulse { impulse } => Some(group.strike(event.body, impulse, None)),
        }
    }

    /// Rebuilds what acts on each group: the scene's effects, then the events that act now.
    fn load(&mut self) {
        for group in &mut self.groups {
            group.load(self.scene, &self.active);
        }
    }

    fn moments(&self, t: f64) -> Vec<Moment> {
        self.groups
            .iter()
            .flat_map(|group| group.moments(t))
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

/// Steps between two recorded states, as a period in steps; 1 for every step.
fn keeps(scene: &Scene, grid_before: u64, grid_after: u64) -> bool {
    match scene.record.state {
        StateRate::EveryStep => true,
        StateRate::PerSecond(rate) => {
            schedule::ticks(grid_after, scene.step, rate)
                > schedule::ticks(grid_before, scene.step, rate)
        }
    }
}
