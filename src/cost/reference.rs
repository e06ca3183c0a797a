//! The truest motion there is of a scene: the closed form where nothing turns a body, else the
//! most accurate method at the tightest tolerance, and a second one beside it that tells how far
//! the first can be believed.

use super::check::{self, Run};
use crate::integrator::{Accepts, Interval, Kind, METHODS, Method};
use crate::scene::Scene;
use crate::sim::{Choice, Choose, Setting, SimError};
use std::collections::BTreeMap;

/// What the closed form keeps to from given numbers, at any time, rad: measured at most 1.2e-15 over
/// 110 outside references, and 2.4e-15 beside a second form over 9,000 bodies.
pub const EXACT: f64 = 5e-15;

/// Roundings of ω and of the time since it set out with which a body sets out on an interval: its
/// phase is off by so many times as many radians as it turns.
const SETTING_OUT: f64 = 4.0 * f64::EPSILON;

/// How far the closed form is off at the end of an interval, rad.
pub fn exact_to(setting: &Setting<'_>) -> f64 {
    let spin = |lane: usize| setting.state.get(lane).omega_w.norm();
    let fastest = (0..setting.members.len()).map(spin).fold(0.0, f64::max);
    EXACT + SETTING_OUT * fastest * (setting.interval.until - setting.from)
}

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

/// Methods tried for a reference at most.
const RANKS: usize = 6;

impl Reference {
    pub fn of(scene: &Scene) -> Result<Self, SimError> {
        Self::by_pieces(scene, FINE)
    }

    /// The same with smaller steps, where methods of fixed steps had a part in it: where a force has a kink
    /// they are of second order.
    pub fn finer(self, scene: &Scene) -> Result<Self, SimError> {
        let fixed = |name: &&'static str| {
            let found = METHODS.iter().find(|method| method.info().name == *name);
            found.is_some_and(|method| method.info().kind == Kind::Fixed)
        };
        match self.by.iter().chain(&self.checked_by).any(fixed) {
            true => Self::by_pieces(scene, FINEST),
            false => Ok(self),
        }
    }

    fn by_pieces(scene: &Scene, pieces: u32) -> Result<Self, SimError> {
        let (rank, first, run) = Self::first_from(scene, 0, pieces)?;
        if first.all_closed {
            return Ok(Self {
                run,
                uncertainty: first.off.values().fold(EXACT, |a, &b| a.max(b)),
                by: first.used,
                checked_by: Vec::new(),
            });
        }
        let (_, second, other) = Self::first_from(scene, rank + 1, pieces)?;
        Ok(Self {
            uncertainty: run.apart(&other).max(EXACT),
            run,
            by: first.used,
            checked_by: second.used,
        })
    }

    /// The run by the first rank from `from` on that follows the scene to its end.
    fn first_from(
        scene: &Scene,
        from: usize,
        pieces: u32,
    ) -> Result<(usize, Truest, Run), SimError> {
        let mut rank = from;
        loop {
            let mut truest = Truest::new(rank, pieces);
            match check::run(scene, &mut truest) {
                Ok(run) => return Ok((rank, truest, run)),
                Err(SimError::NotFinite { .. }) if rank < RANKS => rank += 1,
                Err(error) => return Err(error),
            }
        }
    }
}

/// Takes the truest method that an interval allows, or the one after it.
struct Truest {
    rank: usize,
    /// Of a step of the clock, for methods of fixed steps.
    pieces: u32,
    all_closed: bool,
    used: Vec<&'static str>,
    /// By first body of a group: how far the closed form is off so far, rad.
    off: BTreeMap<usize, f64>,
}

impl Truest {
    fn new(rank: usize, pieces: u32) -> Self {
        Self {
            rank,
            pieces,
            all_closed: true,
            used: Vec::new(),
            off: BTreeMap::new(),
        }
    }
}

impl Choose for Truest {
    fn choose(&mut self, setting: &Setting<'_>) -> Choice {
        let mut choice = truest(setting.interval, self.rank);
        let info = choice.method.info();
        if info.kind == Kind::Fixed {
            choice.pieces = self.pieces;
        }
        self.all_closed &= info.kind == Kind::Closed;
        *self.off.entry(setting.members.start).or_default() += exact_to(setting);
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
/// Where that is not enough.
const FINEST: u32 = 1024;

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
