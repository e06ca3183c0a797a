//! Who decides by which method bodies get through an interval.

use super::schedule::slack;
use crate::body::StateBlock;
use crate::integrator::{Interval, Method, Pieces, Stepper};
use crate::scene::{Action, Body, OwnMethod, Scene, Stepping};
use std::ops::Range;

/// A way through an interval.
#[derive(Clone, Copy)]
pub struct Choice {
    pub method: &'static dyn Method,
    /// Into how many equal pieces it takes a step of the clock.
    pub pieces: u32,
    /// For a method with steps of its own.
    pub tolerance: f64,
}

impl Choice {
    /// Sets out by it from `state` at time `t` (s); the tolerance is the choice's.
    pub fn start(&self, interval: Interval, t: f64, state: &StateBlock) -> Box<dyn Stepper> {
        let interval = Interval {
            tolerance: self.tolerance,
            ..interval
        };
        let stepper = self.method.start(interval, t, state);
        match self.pieces {
            1 => stepper,
            pieces => Box::new(Pieces::new(stepper, pieces)),
        }
    }
}

/// Where an interval lies, and with whom it begins.
#[derive(Clone, Debug)]
pub struct Setting<'a> {
    /// Indices of the bodies in the scene.
    pub members: Range<usize>,
    pub interval: &'a Interval,
    /// When it begins, s.
    pub from: f64,
    /// The bodies as it begins.
    pub state: &'a StateBlock,
}

/// Is asked at the start and whenever an event has touched some bodies.
pub trait Choose {
    fn choose(&mut self, setting: &Setting<'_>) -> Choice;
}

/// The methods that a scene states, throughout.
#[derive(Clone)]
pub struct Stated {
    usual: Choice,
    /// By body: those of bodies that have their own.
    own: Vec<Option<Choice>>,
    /// What takes the usual one's place, from when on (s), in order.
    later: Vec<(f64, Choice)>,
}

impl Stated {
    /// One for all.
    pub fn by(usual: Choice) -> Self {
        Self {
            usual,
            own: Vec::new(),
            later: Vec::new(),
        }
    }

    /// `usual` for all bodies of a scene that have none of their own.
    pub fn where_none_is_own(scene: &Scene, usual: Choice) -> Self {
        let own = |body: &Body| {
            body.method.map(|own| Choice {
                method: own.method,
                pieces: 1,
                tolerance: own.tolerance,
            })
        };
        Self {
            usual,
            own: scene.bodies.iter().map(own).collect(),
            later: Vec::new(),
        }
    }

    /// `None` where the scene states an accuracy instead.
    pub fn of(scene: &Scene) -> Option<Self> {
        match scene.stepping {
            Stepping::Method { method, tolerance } => {
                let usual = Choice {
                    method,
                    pieces: 1,
                    tolerance,
                };
                let mut stated = Self::where_none_is_own(scene, usual);
                stated.later = later(scene);
                Some(stated)
            }
            Stepping::Accuracy(_) => None,
        }
    }
}

impl Choose for Stated {
    /// Bodies that go together have one method.
    fn choose(&mut self, setting: &Setting<'_>) -> Choice {
        let own = self.own.get(setting.members.start).copied().flatten();
        own.unwrap_or_else(|| self.usual_at(setting.from))
    }
}

impl Stated {
    /// The usual way at a time, s.
    fn usual_at(&self, t: f64) -> Choice {
        let gone = self.later.partition_point(|(from, _)| *from <= t);
        match gone.checked_sub(1) {
            Some(last) => self.later[last].1,
            None => self.usual,
        }
    }
}

/// The methods that events change to, by when.
fn later(scene: &Scene) -> Vec<(f64, Choice)> {
    let changes = scene.events.iter().filter_map(|event| match event.action {
        Action::Method(OwnMethod { method, tolerance }) => Some((
            event.at - slack(event.at, scene.step),
            Choice {
                method,
                pieces: 1,
                tolerance,
            },
        )),
        _ => None,
    });
    let mut changes: Vec<(f64, Choice)> = changes.collect();
    changes.sort_by(|(t, _), (u, _)| t.total_cmp(u));
    changes
}
