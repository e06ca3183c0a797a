//! When to step and when to look: a grid of whole steps, and the events between them.
//!
//! A node is a whole number of steps and a remainder, so time never drifts by adding steps up:
//! `t = k h + r`. A step that an event divides is taken in two pieces.

mod parked;

pub use parked::{Parked, Position};

use super::script::Happening;
use crate::integrator::Step;
use crate::scene::{Rate, Scene};
use crate::trace::{Instant, StreamSet};

/// A place on the clock.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Node {
    /// Whole steps.
    grid: u64,
    /// s beyond them, in [0, h).
    rest: f64,
    /// s; for an event exactly the number the scene has.
    time: f64,
}

/// Steps without an event inside, and what is wanted on the way.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stretch {
    pub steps: Vec<Step>,
    /// The steps whose states are kept, in order.
    pub kept: Vec<Kept>,
    /// What happens at its end.
    pub happenings: Vec<Happening>,
}

/// A state on the way that somebody asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kept {
    /// Index of the step that it ends.
    pub step: usize,
    pub at: Instant,
    /// Whether it is recorded as part of the state.
    pub state: bool,
    /// Whether it is an instant of the display rate: hashes are recorded, and it is looked for drift.
    pub display: bool,
    /// The derived streams that are due.
    pub due: StreamSet,
}

impl Stretch {
    /// The instant after step `k`.
    pub fn after(&self, k: usize, first: Instant) -> Instant {
        Instant {
            time: self.steps[k].to,
            step: first.step + k as u64 + 1,
        }
    }

    /// Only the first `taken` steps, the last of them recorded as a state.
    pub fn cut(&self, taken: usize, first: Instant) -> Self {
        let mut kept: Vec<Kept> = self.kept.clone();
        kept.retain(|kept| kept.step + 1 < taken);
        let mut steps = self.steps[..taken].to_vec();
        if let Some(last) = steps.last_mut() {
            last.keep = true;
            kept.push(Kept {
                step: taken - 1,
                at: self.after(taken - 1, first),
                state: true,
                display: false,
                due: StreamSet::none(),
            });
        }
        Self {
            steps,
            kept,
            happenings: Vec::new(),
        }
    }
}

/// Steps in a stretch at most, and states of bodies in one: what is buffered between two
/// deliveries, some 20 MB.
const LONGEST_STRETCH: u64 = 1024;
const MOST_STATES: u64 = 200_000;
/// Steps in a stretch at least, where they are not much work: threads are started once a stretch, which costs as much as some
/// thousand body-steps.
const SHORTEST_STRETCH: u64 = 64;

/// Streams that are due together.
struct Band {
    rate: Rate,
    streams: StreamSet,
}

pub struct Schedule<'s> {
    scene: &'s Scene,
    now: Node,
    steps: u64,
    /// The derived streams by how often they are due, the display rate first.
    bands: Vec<Band>,
    /// Begins and ends after the start, in order of time.
    happenings: Vec<(Node, Vec<Happening>)>,
    /// How many of them are past.
    past: usize,
    end: Node,
    /// Steps that may be taken still, and where it stops.
    most: u64,
    halt: Option<Node>,
    /// What was kept of the last step.
    last: Option<Kept>,
    /// Events that hit nothing, so that their ends were taken back.
    missed: Vec<usize>,
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
            bands: bands(scene),
            happenings: nodes,
            past: 0,
            end,
            most: u64::MAX,
            halt: None,
            last: None,
            missed: Vec::new(),
        }
    }

    pub fn now(&self) -> Instant {
        Instant {
            time: self.now.time,
            step: self.steps,
        }
    }

    /// The steps up to the next event, or as many as are taken at once, at most so many; `None` at the
    /// end of the scene, or where it is to halt.
    pub fn next_stretch(&mut self, most: u64) -> Option<Stretch> {
        let happens_here = self.coming().is_some_and(|at| same(at, self.now));
        let halts = self.most == 0 || self.halt.is_some_and(|halt| !before(self.now, halt));
        if (halts || self.is_over()) && !happens_here {
            return None;
        }
        let target = self.target(most);
        let mut stretch = Stretch::default();
        if happens_here {
            stretch.kept.extend(self.last);
        }
        while before(self.now, target) && self.most > 0 {
            self.most -= 1;
            let index = stretch.steps.len();
            let from = self.now;
            let (mut step, state) = self.step_towards(target);
            let (display, due) = self.streams_due(from);
            step.keep = state || display || !due.is_empty();
            stretch.steps.push(step);
            if step.keep {
                stretch.kept.push(Kept {
                    step: index,
                    at: self.now(),
                    state,
                    display,
                    due,
                });
            }
        }
        if !stretch.steps.is_empty() {
            let last = stretch.kept.last().copied();
            self.last = last.filter(|last| last.at.step == self.steps);
        }
        let here = self.now;
        if let Some((at, happenings)) = self.happenings.get(self.past)
            && same(*at, here)
        {
            stretch.happenings.clone_from(happenings);
            self.past += 1;
        }
        Some(stretch)
    }

    /// When the next event that satisfies `touches` happens after now, or else the end, s.
    pub fn until(&self, touches: impl Fn(Happening) -> bool) -> f64 {
        let mut coming = self.happenings[self.past..].iter();
        coming
            .find(|(_, group)| group.iter().any(|&happening| touches(happening)))
            .map_or(self.end.time, |(at, _)| at.time)
    }

    /// Takes back what was to happen: the clock no longer stops for it.
    pub fn cancel(&mut self, happening: Happening) {
        self.missed.push(happening.event());
        let coming = self.happenings[self.past..].iter();
        let found = coming.zip(self.past..).find_map(|((_, group), k)| {
            let place = group.iter().position(|&other| other == happening)?;
            Some((k, place))
        });
        if let Some((k, place)) = found {
            self.happenings[k].1.remove(place);
            if self.happenings[k].1.is_empty() {
                self.happenings.remove(k);
            }
        }
    }

    fn coming(&self) -> Option<Node> {
        self.happenings.get(self.past).map(|(at, _)| *at)
    }

    /// The earliest of: the next event, the end, the longest stretch.
    fn target(&self, most: u64) -> Node {
        let bodies = self.scene.bodies.len().max(1) as u64;
        let longest = (MOST_STATES / bodies).clamp(SHORTEST_STRETCH, LONGEST_STRETCH);
        let on_grid = self.now.grid + longest.min(most);
        let mut target = Node {
            grid: on_grid,
            rest: 0.0,
            time: on_grid as f64 * self.scene.step,
        };
        for candidate in [Some(self.end), self.coming(), self.halt] {
            if let Some(at) = candidate
                && !before(target, at)
            {
                target = at;
            }
        }
        target
    }

    /// A step, and whether the state after it is recorded.
    fn step_towards(&mut self, target: Node) -> (Step, bool) {
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
        let at_event = self.coming().is_some_and(|at| same(at, to));
        let step = Step {
            from: from.time,
            h: length,
            to: to.time,
            keep: false,
        };
        let state = at_event || !before(to, self.end) || self.state_is_due(from, to);
        (step, state)
    }

    /// Whether the display rate is due at the end of a step, and which streams.
    fn streams_due(&self, from: Node) -> (bool, StreamSet) {
        let (here, h) = (self.now, self.scene.step);
        let ended = !before(here, self.end);
        let (mut display, mut due) = (false, StreamSet::none());
        for (k, band) in self.bands.iter().enumerate() {
            let now = match band.rate {
                Rate::EveryStep => true,
                Rate::PerSecond(rate) => {
                    let is_whole = here.rest == 0.0;
                    is_whole && ticks(here.grid, h, rate) > ticks(from.grid, h, rate)
                }
            };
            if now || ended {
                display |= k == 0;
                due = due.with(band.streams);
            }
        }
        (display, due)
    }

    /// Whether a sampling instant of the state lies in a step.
    fn state_is_due(&self, from: Node, to: Node) -> bool {
        let h = self.scene.step;
        match self.scene.record.state {
            Rate::EveryStep => true,
            Rate::PerSecond(rate) => ticks(to.grid, h, rate) > ticks(from.grid, h, rate),
        }
    }

    pub fn is_over(&self) -> bool {
        !before(self.now, self.end)
    }

    /// Sets the clock back to where a stretch was broken off.
    pub fn stop_at(&mut self, at: Instant) {
        self.steps = at.step;
        self.now.time = at.time;
    }
}

fn bands(scene: &Scene) -> Vec<Band> {
    let bands = scene.record.bands().into_iter();
    bands
        .map(|(rate, streams)| Band { rate, streams })
        .collect()
}

/// A remainder below this part of a step is rounding in `t/h` (relative 2⁻⁵³, so a few units of
/// that times the step count), never a step of its own.
fn rounding(steps: f64) -> f64 {
    slack(steps, 1.0)
}

/// How far apart two times are at most (s) that the clock, in steps of `h`, takes for one.
pub fn slack(t: f64, h: f64) -> f64 {
    (4.0 * f64::EPSILON * t).max(1e-9 * h)
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A step of 1 ms, summed up 1e12 times, would be off by seconds or so; here a time is a product.
    #[test]
    fn after_1e12_steps_the_clock_shows_1e9_seconds_to_the_last_bit() {
        let text = "duration = 1e9\n[stepping]\nstep = 1e-3\n[record]\nstate = 1e-3\nrate = 1e-3\n\
                    [[body]]\nname = \"a\"\nmass = 1.0\ninertia = [1, 1, 1]\n\
                    [[event]]\nat = 999999999.9995\nbody = \"a\"\ntorque = [1, 0, 0]\n";
        let scene = Scene::parse("a", "a", text).unwrap();
        let mut schedule = Schedule::new(&scene);
        // As it is when all but the last 5,000 steps are done.
        let done = 1_000_000_000_000 - 5_000;
        schedule.now = Node {
            grid: done,
            rest: 0.0,
            time: done as f64 * scene.step,
        };
        schedule.steps = done;
        let (mut steps, mut event) = (Vec::new(), None);
        while let Some(stretch) = schedule.next_stretch(u64::MAX) {
            steps.extend(stretch.steps);
            if !stretch.happenings.is_empty() {
                event = steps.last().map(|step| step.to);
            }
        }
        // The event divides one.
        assert_eq!(steps.len(), 5_001);
        assert_eq!(event, Some(999_999_999.999_5));
        assert_eq!(steps.last().map(|step| step.to), Some(1e9));
        assert_eq!(schedule.now().step, 1_000_000_000_001);
        for (k, step) in (done..).zip(&steps[..4_999]) {
            assert_eq!(
                (step.from, step.to),
                (k as f64 * 1e-3, (k + 1) as f64 * 1e-3)
            );
            assert_eq!(step.h, 1e-3);
        }
    }
}
