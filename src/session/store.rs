//! Stored states, by branch and step, within a limit of memory.
//!
//! One is kept every [`EVERY`] steps as long as there is room. Where there is none the one goes whose neighbours are
//! nearest to each other for how far they are from where the session stands: so they get sparser with the distance.

use crate::sim::Checkpoint;

/// Steps from one stored state to the next, where there is room.
pub const EVERY: u64 = 64;

/// Bytes of stored states where nothing else is said: of two bodies some 30,000 states (8.5 kB each), of a swarm of
/// 100,000 four (62 MB each).
pub const MEMORY: usize = 1 << 28;

pub(super) struct Stored {
    pub branch: usize,
    pub checkpoint: Checkpoint,
    /// Events that the branch's scene had by then.
    pub known: usize,
    bytes: usize,
}

impl Stored {
    pub fn step(&self) -> u64 {
        self.checkpoint.at().step
    }
}

pub(super) struct Store {
    /// By branch and step.
    all: Vec<Stored>,
    bytes: usize,
    limit: usize,
}

impl Store {
    pub fn new(limit: usize) -> Self {
        Self {
            all: Vec::new(),
            bytes: 0,
            limit,
        }
    }

    pub fn bytes(&self) -> usize {
        self.bytes
    }

    pub fn len(&self) -> usize {
        self.all.len()
    }

    fn place(&self, branch: usize, step: u64) -> Result<usize, usize> {
        self.all
            .binary_search_by_key(&(branch, step), |stored| (stored.branch, stored.step()))
    }

    pub fn has(&self, branch: usize, step: u64) -> bool {
        self.place(branch, step).is_ok()
    }

    /// The last of a branch that is right for `is`, which holds of all up to some time and of none after it.
    pub fn last(&self, branch: usize, is: impl Fn(&Checkpoint) -> bool) -> Option<&Stored> {
        let end = self.all.partition_point(|stored| {
            stored.branch < branch || (stored.branch == branch && is(&stored.checkpoint))
        });
        let last = self.all.get(end.checked_sub(1)?)?;
        (last.branch == branch).then_some(last)
    }

    /// Stores one, in place of one of the same step, and makes room for it. The steps count from `near`.
    pub fn put(&mut self, branch: usize, checkpoint: Checkpoint, known: usize) {
        let bytes = checkpoint.bytes();
        let near = checkpoint.at().step;
        let stored = Stored {
            branch,
            checkpoint,
            known,
            bytes,
        };
        self.bytes += bytes;
        match self.place(branch, near) {
            Ok(k) => {
                self.bytes -= self.all[k].bytes;
                self.all[k] = stored;
            }
            Err(k) => self.all.insert(k, stored),
        }
        while self.bytes > self.limit
            && let Some(k) = self.least(branch, near)
        {
            self.bytes -= self.all.remove(k).bytes;
        }
    }

    /// The one that is missed least, but for the newest.
    fn least(&self, branch: usize, near: u64) -> Option<usize> {
        let worth = |k: usize| {
            let stored = &self.all[k];
            let (step, own) = (stored.step(), stored.branch);
            let neighbour = |k: Option<usize>| {
                let other = self.all.get(k?)?;
                (other.branch == own).then(|| other.step())
            };
            let before = neighbour(k.checked_sub(1)).unwrap_or(0);
            // The last of a branch is as far from its end as from the one before.
            let after = neighbour(Some(k + 1)).unwrap_or(2 * step - before);
            let far = step.abs_diff(near) + EVERY;
            (after - before) as f64 / far as f64
        };
        let others = (0..self.all.len()).filter(|&k| {
            let stored = &self.all[k];
            (stored.branch, stored.step()) != (branch, near)
        });
        others.min_by(|&a, &b| worth(a).total_cmp(&worth(b)))
    }
}
