//! The truest motion there is of a scene: the closed form where nothing turns a body, else the
//! most accurate method at the tightest tolerance, and a second one beside it that tells how far
//! the first can be believed.

use super::check::{self, Run};
use crate::integrator::{Accepts, Interval, Kind, METHODS, Method};
use crate::scene::Scene;
use crate::sim::{Choice, Choose, Setting, SimError};

/// What the closed form keeps to for any body at any time, rad (docs/methods.md; measured at most
/// 1.4e-15 over a hundred outside references).
pub const EXACT: f64 = 5e-15;

/// Of the methods that choose their own steps: half an ulp.
const TIGHTEST: f64 = 1.2e-16;

/// A motion to compare others with.
pub struct Reference {
    pub run: Run,
    /// How far it can be believed, rad.
    pub uncertainty: f64,
    /// By which methods it was had, and by which it was checked.
    pub by: Vec<&'static str>,
    pub checked_by: Vec<&'static str>,
}

impl Reference {
    pub fn of(scene: &Scene) -> Result<Self, SimError> {
        let mut first = Truest::new(0);
        let run = check::run(scene, &mut first)?;
        if first.all_closed {
            return Ok(Self {
                run,
                uncertainty: EXACT,
                by: first.used,
                checked_by: Vec::new(),
            });
        }
        let mut second = Truest::new(1);
        let other = check::run(scene, &mut second)?;
        Ok(Self {
            uncertainty: run.angle(&other).max(EXACT),
            run,
            by: first.used,
            checked_by: second.used,
        })
    }
}

/// Takes the truest method that an interval allows, or the one after it.
struct Truest {
    rank: usize,
    all_closed: bool,
    used: Vec<&'static str>,
}

impl Truest {
    fn new(rank: usize) -> Self {
        Self {
            rank,
            all_closed: true,
            used: Vec::new(),
        }
    }
}

impl Choose for Truest {
    fn choose(&mut self, setting: &Setting<'_>) -> Choice {
        let choice = truest(setting.interval, self.rank);
        let info = choice.method.info();
        self.all_closed &= info.kind == Kind::Closed;
        if !self.used.contains(&info.name) {
            self.used.push(info.name);
        }
        choice
    }
}

/// The methods that take an interval, the truest first: the closed form, those that choose their
/// own steps, then the others by order.
pub fn by_truth(interval: &Interval) -> Vec<&'static dyn Method> {
    let mut methods: Vec<&'static dyn Method> = METHODS
        .iter()
        .copied()
        .filter(|method| (method.info().refuses(&interval.load, &interval.inertial)).is_none())
        .collect();
    methods.sort_by_key(|method| {
        let info = method.info();
        match info.kind {
            Kind::Closed => (0, 0),
            // One made for fewer loads is the truer.
            Kind::Adaptive => (1, u32::from(info.accepts == Accepts::Any)),
            Kind::Fixed => (2, u32::MAX - info.order),
        }
    });
    methods
}

/// Pieces of a clock step for a reference by fixed steps: an order of 4 then gains 1e7.
const FINE: u32 = 64;

pub fn truest(interval: &Interval, rank: usize) -> Choice {
    let methods = by_truth(interval);
    // METHODS always holds methods that take every load, more than one.
    let method = methods[rank.min(methods.len() - 1)];
    Choice {
        method,
        pieces: match method.info().kind {
            Kind::Fixed => FINE,
            _ => 1,
        },
        tolerance: TIGHTEST,
    }
}
