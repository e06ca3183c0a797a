//! What is kept of each body while its rows go by: the row before, and how its motion begins.

use super::super::conventions::{Conventions, Kinematics};
use super::cells::{Cells, Number};
use super::{OMEGA, Raw};

/// Something that happens to rows: how often, and where first.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    pub count: u64,
    /// The line of the first.
    pub line: u64,
    /// The largest, of what it is about.
    pub most: f64,
}

impl Tally {
    fn add(&mut self, line: u64, size: f64) {
        if self.count == 0 {
            self.line = line;
        }
        self.count += 1;
        self.most = self.most.max(size);
    }
}

/// One body.
pub(super) struct Track {
    pub key: Vec<u8>,
    pub name: String,
    pub rows: u64,
    pub first: Option<(f64, u64)>,
    last: (f64, u64),
    /// The mean interval of rows, of those that were no gaps.
    pub interval: f64,
    intervals: u64,
    pub gaps: Tally,
    pub repeats: Tally,
    /// Attitudes whose length is not one.
    pub lengths: Tally,
    /// How its motion begins.
    pub sample: Option<Kinematics>,
}

/// Rows of a body that are kept to find conventions by, and bodies of which they are.
const SAMPLE: usize = 2048;
const SAMPLED_BODIES: usize = 16;
/// An interval so many times the usual one is a gap.
const GAP: f64 = 10.0;
/// A quaternion's length is one but for this: f32 and a little drift.
const LENGTH: f64 = 1e-3;

impl Track {
    pub fn new(key: Vec<u8>, name: String) -> Self {
        Self {
            key,
            name,
            rows: 0,
            first: None,
            last: (f64::NEG_INFINITY, 0),
            interval: 0.0,
            intervals: 0,
            gaps: Tally::default(),
            repeats: Tally::default(),
            lengths: Tally::default(),
            sample: None,
        }
    }

    /// Takes a row in; the error says how its time goes back.
    #[inline]
    pub fn take(&mut self, raw: &mut Raw, declared: &Conventions) -> Result<(), String> {
        let (before, line) = self.last;
        if raw.time < before {
            return Err(format!(
                "the time of `{}` goes back to {} s from {before} s, line {line}",
                self.name, raw.time
            ));
        }
        raw.again = raw.time == before;
        if raw.again {
            self.repeats.add(raw.line, 0.0);
        } else if self.first.is_some() {
            self.step(raw.time - before, raw.line);
        } else {
            self.first = Some((raw.time, raw.line));
        }
        self.last = (raw.time, raw.line);
        self.rows += 1;
        if let Some(q) = raw.attitude {
            let length: f64 = q.iter().map(|x| x * x).sum();
            // |q| is sqrt: to first order half as far from one.
            if (length - 1.0).abs() > 2.0 * LENGTH {
                self.lengths.add(raw.line, (length.sqrt() - 1.0).abs());
            }
        }
        if raw.body < SAMPLED_BODIES {
            self.keep(raw, declared);
        }
        Ok(())
    }

    fn step(&mut self, interval: f64, line: u64) {
        // A few say what is usual.
        if self.intervals >= 8 && interval > GAP * self.interval {
            self.gaps.add(line, interval);
            return;
        }
        self.intervals += 1;
        self.interval += (interval - self.interval) / self.intervals as f64;
    }

    /// Keeps a row of the beginning; while nothing moves, the latest alone.
    fn keep(&mut self, raw: &Raw, declared: &Conventions) {
        let (Some(q), Some(omega)) = (raw.attitude, raw.vectors[OMEGA]) else {
            return;
        };
        let sample = self.sample.get_or_insert_with(|| Kinematics {
            times: Vec::new(),
            attitudes: Vec::new(),
            omegas: Vec::new(),
            declared: *declared,
        });
        if sample.times.len() >= SAMPLE {
            return;
        }
        let rests = sample.attitudes.len() == 1 && sample.attitudes[0] == q;
        let again = sample.times.last().is_some_and(|t| *t == raw.time);
        if rests || again {
            sample.times.pop();
            sample.attitudes.pop();
            sample.omegas.pop();
        }
        sample.times.push(raw.time);
        sample.attitudes.push(q);
        sample.omegas.push(omega);
    }
}

/// The numbers of the first rows, all columns: for what to say where columns look swapped.
#[derive(Default)]
pub(super) struct Beginning {
    rows: Vec<Vec<f64>>,
}

impl Beginning {
    const ROWS: usize = 64;
    const COLUMNS: usize = 64;

    #[inline]
    pub fn take(&mut self, cells: &impl Cells) {
        if self.rows.len() < Self::ROWS {
            let number = |column| match cells.number(column) {
                Number::Is(x) => x,
                _ => f64::NAN,
            };
            self.rows.push((0..Self::COLUMNS).map(number).collect());
        }
    }

    /// Four columns side by side that have length one in every row, though not all of them stand still.
    pub fn quaternion(&self) -> Option<usize> {
        let is_unit = |k: &usize| {
            self.rows.iter().all(|row| {
                let length: f64 = row[*k..k + 4].iter().map(|x| x * x).sum();
                (length - 1.0).abs() < 2e-3
            })
        };
        (self.rows.len() >= 3)
            .then(|| (0..Self::COLUMNS - 3).find(is_unit))
            .flatten()
    }

    /// A column that grows from row to row or stays, and does grow.
    pub fn clock(&self) -> Option<usize> {
        let grows = |k: &usize| {
            let pairs = || self.rows.windows(2).map(|pair| (pair[0][*k], pair[1][*k]));
            pairs().all(|(a, b)| b >= a) && pairs().any(|(a, b)| b > a)
        };
        (self.rows.len() >= 3)
            .then(|| (0..Self::COLUMNS).find(grows))
            .flatten()
    }
}
