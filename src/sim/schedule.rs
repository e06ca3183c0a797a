//! When to step and when to look: a grid of whole steps, and the events between them.
//!
//! A node is a whole number of steps and a remainder, so time never drifts by adding steps up:
//! `t = k h + r`. A step that an event divides is taken in two pieces.

use super::script::Happening;
use crate::scene::{Scene, StateRate};
use crate::trace::Instant;

/// A place on the clock.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Node {
    /// Whole steps.
    grid: u64,
    /// s beyond them, in [0, h).
    rest: f64,
    /// s; for an event exactly the number the scene has.
    time: f64,
}

/// One step of a method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// s.
    pub from: f64,
    /// s.
    pub h: f64,
    pub after: Instant,
    /// Whether the state after it is recorded.
    pub keep: bool,
}

/// Why a stretch of steps ends where it does.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// Only so that a stretch does not become too long.
    None,
    /// The derived streams are due.
    Display,
    Events {
        happenings: Vec<Happening>,
        /// Whether the derived streams are due as well.
        display: bool,
    },
}

/// Steps in a stretch at most: what is buffered between two deliveries.
const LONGEST_STRETCH: u64 = 1024;

pub struct Schedule<'s> {
    scene: &'s Scene,
    now: Node,
    steps: u64,
    /// Sampling instants of the derived streams that have been delivered.
    shown: f64,
    /// Begins and ends after the start, in order of time.
    happenings: std::iter::Peekable<std::vec::IntoIter<(Node, Vec<Happening>)>>,
    end: Node,
}

impl<'s> Schedule<'s> {
    pub fn new(scene: &'s Scene) -> Self {
        let end = node(scene.duration, scene.step);
        let mut nodes: Vec<(Node, Vec<Happening>)> = Vec::new();
        for (time, happening) in super::script::after_start(scene) {
            let at = node(time, scene.step);
            match nodes.last_mut() {
                Some((last, group)) if close(*last, at, scene.step) => group.push(happening),
                _ => nodes.push((at, vec![happening])),
            }
        }
        for (_, group) in &mut nodes {
            group.sort_by_key(|happening| matches!(happening, Happening::Begins(_)));
        }
        nodes.retain(|(at, _)| !before(end, *at));
        Self {
            scene,
            now: Node {
                grid: 0,
                rest: 0.0,
                time: 0.0,
            },
            steps: 0,
            shown: 0.0,
            happenings: nodes.into_iter().peekable(),
            end,
        }
    }

    pub fn now(&self) -> Instant {
        Instant {
            time: self.now.time,
            step: self.steps,
        }
    }

    /// The steps up to the next mark, and the mark; `None` at the end of the scene.
    pub fn next_stretch(&mut self) -> Option<(Vec<Step>, Mark)> {
        if !before(self.now, self.end) {
            return None;
        }
        let target = self.target();
        let mut steps = Vec::new();
        while before(self.now, target) {
            steps.push(self.step_towards(target));
        }
        Some((steps, self.mark()))
    }

    /// The earliest of: the next event, the next display sample, the end, the longest stretch.
    fn target(&mut self) -> Node {
        let h = self.scene.step;
        let due = self.next_tick();
        let on_grid = due.min(self.now.grid + LONGEST_STRETCH);
        let mut target = Node {
            grid: on_grid,
            rest: 0.0,
            time: on_grid as f64 * h,
        };
        for candidate in [Some(self.end), self.happenings.peek().map(|(at, _)| *at)] {
            if let Some(at) = candidate
                && !before(target, at)
            {
                target = at;
            }
        }
        target
    }

    /// The grid node at which the derived streams are due next. [`ticks`] alone says which nodes
    /// count a new instant; the division only finds the neighbourhood.
    fn next_tick(&self) -> u64 {
        let (h, rate) = (self.scene.step, self.scene.record.rate);
        let counts = |grid: u64| ticks(grid, h, rate) > self.shown;
        let first = self.now.grid + 1;
        let mut due = grid_of_tick(self.shown + 1.0, h, rate).max(first);
        while due > first && counts(due - 1) {
            due -= 1;
        }
        // Within a node or two, by rounding; a rate beyond all counting has no next instant.
        for _ in 0..4 {
            if counts(due) {
                break;
            }
            due = due.saturating_add(1);
        }
        due
    }

    fn step_towards(&mut self, target: Node) -> Step {
        let h = self.scene.step;
        let (from, old) = (self.now, self.now.grid);
        let next = Node {
            grid: old + 1,
            rest: 0.0,
            time: (old + 1) as f64 * h,
        };
        let (to, length) = if before(next, target) || same(next, target) {
            let to = if same(next, target) { target } else { next };
            (to, if from.rest == 0.0 { h } else { h - from.rest })
        } else {
            (target, target.rest - from.rest)
        };
        self.now = to;
        self.steps += 1;
        let at_event = self.happenings.peek().is_some_and(|(at, _)| same(*at, to));
        Step {
            from: from.time,
            h: length,
            after: self.now(),
            keep: at_event || !before(to, self.end) || self.state_is_due(from, to),
        }
    }

    fn mark(&mut self) -> Mark {
        let here = self.now;
        let ticks = ticks(here.grid, self.scene.step, self.scene.record.rate);
        let due = here.rest == 0.0 && ticks > self.shown;
        if due {
            self.shown = ticks;
        }
        let display = due || !before(here, self.end);
        if let Some((_, happenings)) = self.happenings.next_if(|(at, _)| same(*at, here)) {
            return Mark::Events {
                happenings,
                display,
            };
        }
        if display { Mark::Display } else { Mark::None }
    }

    /// Whether a sampling instant of the state lies in a step.
    fn state_is_due(&self, from: Node, to: Node) -> bool {
        let h = self.scene.step;
        match self.scene.record.state {
            StateRate::EveryStep => true,
            StateRate::PerSecond(rate) => ticks(to.grid, h, rate) > ticks(from.grid, h, rate),
        }
    }

    /// Sets the clock back to where a stretch was broken off.
    pub fn stop_after(&mut self, step: &Step) {
        self.steps = step.after.step;
        self.now.time = step.after.time;
    }
}

/// A remainder below this part of a step is rounding in `t/h` (relative 2⁻⁵³, so a few units of
/// that times the step count), never a step of its own.
fn rounding(steps: f64) -> f64 {
    (4.0 * f64::EPSILON * steps).max(1e-9)
}

fn node(time: f64, h: f64) -> Node {
    let steps = time / h;
    let nearest = steps.round();
    if (steps - nearest).abs() <= rounding(steps) {
        return Node {
            grid: nearest as u64,
            rest: 0.0,
            time,
        };
    }
    let grid = steps.floor();
    Node {
        grid: grid as u64,
        rest: (time - grid * h).clamp(0.0, h),
        time,
    }
}

fn before(a: Node, b: Node) -> bool {
    (a.grid, a.rest) < (b.grid, b.rest)
}

/// The same instant but for rounding.
fn close(a: Node, b: Node, h: f64) -> bool {
    let steps = (a.grid as f64 - b.grid as f64) + (a.rest - b.rest) / h;
    steps.abs() <= rounding(a.grid as f64)
}

fn same(a: Node, b: Node) -> bool {
    (a.grid, a.rest) == (b.grid, b.rest)
}

/// Sampling instants at a rate (1/s) that lie at or before a grid node.
pub fn ticks(grid: u64, h: f64, rate: f64) -> f64 {
    let ticks = grid as f64 * h * rate;
    (ticks + rounding(ticks)).floor()
}

/// The first grid node at or after a sampling instant.
fn grid_of_tick(tick: f64, h: f64, rate: f64) -> u64 {
    let steps = tick / (rate * h);
    (steps - rounding(steps)).ceil() as u64
}
