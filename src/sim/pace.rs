//! How many steps are taken at once: as many as are done soon, by counted work and never by a clock, so that a scene's
//! stretches, and its recording with them, are the same on every machine.
//!
//! `n = W / w`, with `W` the work that a stretch may be and `w` that of a step: of methods that go by the clock's steps
//! what they declare, of those with steps of their own what was counted in the stretch before.

use super::group::Group;

/// Work of a stretch at most, in steps of rk4: a quarter of a microsecond each where they were measured
/// (docs/performance.md), so some 0.16 s, and half a second where all is three times as slow.
const MOST: f64 = 640_000.0;
/// Radians a step of the clock from which on it is many steps of a method's own: how many is known when they are done.
const FAR: f64 = 1.0;
/// How many times as long as the one before a stretch may be there.
const GROWTH: f64 = 4.0;

/// Steps at once where work does not bound them.
const ANY: f64 = 1e6;

#[derive(Default)]
pub struct Pace {
    /// The steps of the last stretch, since an event, and the work counted until it began.
    last: Option<(usize, f64)>,
}

impl Pace {
    /// From here on bodies go otherwise: what was counted says nothing of what comes.
    pub fn set_out(&mut self) {
        self.last = None;
    }

    /// The steps of `h` that may be taken at once, at least one.
    pub fn steps(&self, groups: &[Group], h: f64) -> u64 {
        let declared: f64 = groups.iter().map(Group::work_a_step).sum();
        let mut own = groups.iter().filter(|group| !group.is_paced_by_the_clock());
        let far = own.any(|group| group.farthest_turn(h) > FAR);
        let (counted, most) = match self.last {
            None => (0.0, 1.0),
            Some((steps, before)) => {
                let steps = steps as f64;
                ((counted(groups) - before) / steps, GROWTH * steps)
            }
        };
        let by_work = MOST / (declared + counted);
        bounded(if far { by_work.min(most) } else { by_work })
    }

    /// So many are about to be taken.
    pub fn take(&mut self, steps: usize, groups: &[Group]) {
        self.last = Some((steps.max(1), counted(groups)));
    }
}

fn counted(groups: &[Group]) -> f64 {
    groups.iter().map(Group::counted_work).sum()
}

fn bounded(steps: f64) -> u64 {
    steps.clamp(1.0, ANY) as u64
}
