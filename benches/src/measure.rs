//! Time by repeats that take turns: what disturbs one contestant in one round is unlikely to disturb it
//! in all of them, and what slows the machine for a while slows all contestants.
//!
//! What is read is the time that the thread had the processor, so that other people's programs on a
//! shared machine count less; they still take caches and the clock's boost, which is what the minimum
//! and the spread are for.

use cpu_time::ThreadTime;
use std::hint::black_box;
use std::time::Instant;

/// Shortest time of the repeats, ns, and how much longer half of them took: (median - min)/min.
#[derive(Clone, Copy, Debug)]
pub struct Timing {
    pub ns: f64,
    pub spread: f64,
}

impl Timing {
    pub fn of(mut ns: Vec<f64>) -> Self {
        ns.sort_by(f64::total_cmp);
        Self {
            ns: ns[0],
            spread: ns[ns.len() / 2] / ns[0] - 1.0,
        }
    }

    /// Of one of `n` equal parts.
    pub fn per(self, n: usize) -> Self {
        Self {
            ns: self.ns / n as f64,
            ..self
        }
    }
}

/// What takes its turn: sets up, runs and says how long the run took, ns.
pub type Contestant<'a> = Box<dyn FnMut() -> f64 + 'a>;

/// `run` on what `setup` makes, whose making is not counted.
pub fn contestant<'a, S>(
    mut setup: impl FnMut() -> S + 'a,
    mut run: impl FnMut(&mut S) + 'a,
) -> Contestant<'a> {
    Box::new(move || {
        let mut subject = setup();
        let start = ThreadTime::now();
        run(black_box(&mut subject));
        let ns = start.elapsed().as_nanos() as f64;
        black_box(&subject);
        ns
    })
}

/// The same by the clock on the wall, for what runs on several threads.
pub fn wall<'a, S>(
    mut setup: impl FnMut() -> S + 'a,
    mut run: impl FnMut(&mut S) + 'a,
) -> Contestant<'a> {
    Box::new(move || {
        let mut subject = setup();
        let start = Instant::now();
        run(black_box(&mut subject));
        let ns = start.elapsed().as_nanos() as f64;
        black_box(&subject);
        ns
    })
}

/// All of them in turn, `repeats` times, after a round that does not count.
pub fn race(contestants: &mut [Contestant], repeats: usize) -> Vec<Timing> {
    let mut times = vec![Vec::new(); contestants.len()];
    for round in 0..=repeats {
        for (contestant, times) in contestants.iter_mut().zip(&mut times) {
            let ns = contestant();
            if round > 0 {
                times.push(ns);
            }
        }
    }
    times.into_iter().map(Timing::of).collect()
}
