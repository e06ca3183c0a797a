//! A clock that is set down and taken up again, or set back.

use super::{Happening, Kept, Node, Schedule, bands, before, node, same};
use crate::scene::Scene;
use crate::trace::Instant;
use std::collections::HashSet;

/// Where a clock stands. All that happens there has happened.
#[derive(Clone, Debug, Default)]
pub struct Position {
    now: Node,
    steps: u64,
    last: Option<Kept>,
    missed: Vec<usize>,
}

/// A clock without its scene; by default at the end of none.
#[derive(Debug, Default)]
pub struct Parked {
    position: Position,
    happenings: Vec<(Node, Vec<Happening>)>,
    past: usize,
    end: Node,
}

impl Position {
    pub fn instant(&self) -> Instant {
        Instant {
            time: self.now.time,
            step: self.steps,
        }
    }

    /// Bytes it takes beside its own size.
    pub fn bytes(&self) -> usize {
        size_of_val(self.missed.as_slice())
    }
}

impl Parked {
    pub fn position(&self) -> &Position {
        &self.position
    }

    pub fn is_over(&self) -> bool {
        !before(self.position.now, self.end)
    }

    /// Sets it to where it stood, or where a clock of a scene did that has the same events up to there.
    pub fn set(&mut self, position: &Position) {
        self.position = position.clone();
        let here = position.now;
        let is_past = |(at, _): &(Node, Vec<Happening>)| !before(here, *at);
        if !position.missed.is_empty() {
            let missed: HashSet<usize> = position.missed.iter().copied().collect();
            self.happenings.retain_mut(|node| {
                if is_past(node) {
                    return true;
                }
                let ends = |happening: &Happening| match happening {
                    Happening::Ends(event) => missed.contains(event),
                    Happening::Begins(_) => false,
                };
                node.1.retain(|happening| !ends(happening));
                !node.1.is_empty()
            });
        }
        self.past = self.happenings.partition_point(is_past);
    }

    /// The same where of the events there only the first `known` have happened: the others are still to.
    pub fn set_before(&mut self, position: &Position, known: usize) {
        self.set(position);
        let Some(last) = self.past.checked_sub(1) else {
            return;
        };
        let (at, happenings) = &mut self.happenings[last];
        let is_new = |happening: &Happening| happening.event() >= known;
        if same(*at, position.now) && happenings.iter().any(is_new) {
            happenings.retain(is_new);
            self.past = last;
        }
    }
}

impl<'s> Schedule<'s> {
    pub fn park(self) -> Parked {
        Parked {
            position: Position {
                now: self.now,
                steps: self.steps,
                last: self.last,
                missed: self.missed,
            },
            happenings: self.happenings,
            past: self.past,
            end: self.end,
        }
    }

    /// Takes it up again; it may take no step before it is allowed one.
    pub fn unpark(scene: &'s Scene, parked: Parked) -> Self {
        let position = parked.position;
        Self {
            scene,
            now: position.now,
            steps: position.steps,
            bands: bands(scene),
            happenings: parked.happenings,
            past: parked.past,
            end: parked.end,
            most: 0,
            halt: None,
            last: position.last,
            missed: position.missed,
        }
    }

    /// Lets it go on by so many steps, and not beyond a time (s).
    pub fn allow(&mut self, steps: u64, until: Option<f64>) {
        self.most = steps;
        self.halt = until.map(|until| self.last_node_until(until));
    }

    /// The last instant of the clock that is not after `t` (s), where no step is cut for it.
    fn last_node_until(&self, t: f64) -> Node {
        let at = node(t, self.scene.step);
        let grid = Node {
            grid: at.grid,
            rest: 0.0,
            time: at.grid as f64 * self.scene.step,
        };
        let nodes = self.happenings[self.past..].iter().map(|(at, _)| *at);
        let nodes = nodes.take_while(|node| !before(at, *node));
        let last = nodes.last().filter(|last| before(grid, *last));
        last.unwrap_or(grid)
    }
}
