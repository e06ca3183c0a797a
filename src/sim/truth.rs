//! What is known of the true motion beside the simulated one.
//!
//! As long as nothing turns a body but impulses, its exact motion is known: it goes along in closed
//! form, is struck by the same impulses, and is compared at every instant that is looked at. Where
//! a torque acts the model may still keep something: the energy of constant forces at points of the
//! body, and of the angular momentum what lies along them.

use super::choose::{Choice, Stated};
use super::group::{Group, Weight};
use super::script::Acting;
use crate::integrator::{Kind, METHODS, Method, Step};
use crate::math::angle_between;
use crate::scene::{Change, Framed, Scene};
use crate::trace::{Deviation, Sample, Subject};
use nalgebra::{Unit, Vector3};

/// The truth about one body.
#[derive(Clone)]
pub struct Truth {
    known: Known,
    /// The largest kinetic energy (J) and angular momentum (kg m²/s) so far: what errors are parts of.
    energy: f64,
    momentum: f64,
}

#[derive(Clone)]
enum Known {
    /// The body in closed form, and when it is there (s).
    Exact {
        body: Box<Group>,
        now: f64,
    },
    /// What the model keeps since the last event.
    Kept(Kept),
    Nothing,
}

/// Which part of the angular momentum stays under forces that are constant in the world.
#[derive(Clone, Copy, Debug)]
enum KeptMomentum {
    All,
    /// All of them along one line.
    Along(Unit<Vector3<f64>>),
    /// Along two lines: no component stays, the energy does.
    Nothing,
}

#[derive(Clone)]
struct Kept {
    weights: Vec<Weight>,
    /// Where the reference point was, world, m: heights count from there, so that a scene far from
    /// the origin loses no digits.
    origin_w: Vector3<f64>,
    /// Kinetic and potential, J.
    energy: f64,
    momentum_w: Vector3<f64>,
    momentum: KeptMomentum,
}

/// A body as it is simulated, its group and its index.
pub type Simulated<'a> = (&'a Subject, &'a Sample, &'a Group, usize);

/// The first method in closed form.
fn closed_form() -> Option<&'static dyn Method> {
    let closed = |method: &&dyn Method| method.info().kind == Kind::Closed;
    METHODS.iter().copied().find(closed)
}

impl Truth {
    /// Of a body alone in its group, as the scene starts it.
    pub fn new(body: Group) -> Self {
        Self {
            known: Known::Exact {
                body: Box::new(body),
                now: 0.0,
            },
            energy: 0.0,
            momentum: 0.0,
        }
    }

    /// Of a body of which no exact motion goes along.
    pub fn unknown() -> Self {
        Self {
            known: Known::Nothing,
            energy: 0.0,
            momentum: 0.0,
        }
    }

    /// Bytes it takes beside its own size, and that.
    pub fn bytes(&self) -> usize {
        let known = match &self.known {
            Known::Exact { body, .. } => body.bytes(),
            Known::Kept(kept) => size_of_val(kept.weights.as_slice()),
            Known::Nothing => 0,
        };
        size_of::<Self>() + known
    }

    /// Whether nothing turns the body.
    pub fn is_exact(&self) -> bool {
        match &self.known {
            Known::Exact { .. } => true,
            Known::Kept(kept) => matches!(kept.momentum, KeptMomentum::All),
            Known::Nothing => false,
        }
    }

    /// Strikes the true body as the simulated one is struck.
    pub fn strike(&mut self, index: usize, impulse: Framed, point: Option<Framed>, at: f64) {
        if let Known::Exact { body, now } = &mut self.known {
            move_to(body, now, at);
            body.strike(index, impulse, point);
        }
    }

    /// Starts anew from a body alone in its group, at time `at` (s).
    pub fn restart(&mut self, body: Group, at: f64) {
        *self = Self::new(body);
        if let Known::Exact { now, .. } = &mut self.known {
            *now = at;
        }
    }

    /// Sets the true body as the simulated one is set.
    pub fn set(&mut self, index: usize, change: &Change, at: f64) {
        if let Known::Exact { body, now } = &mut self.known {
            move_to(body, now, at);
            body.set(index, change);
        }
    }

    /// Goes on under what acts from `t` until `until`; `simulated` is the body as it is now.
    pub fn set_out(
        &mut self,
        (scene, acting): (&Scene, &Acting),
        (t, until): (f64, f64),
        simulated: Simulated<'_>,
    ) {
        let known = std::mem::replace(&mut self.known, Known::Nothing);
        let exact = match (known, closed_form()) {
            (Known::Exact { mut body, mut now }, Some(method)) => {
                move_to(&mut body, &mut now, t);
                body.load(scene, acting);
                let takes = body.refusal(method).is_none();
                takes.then(|| {
                    let mut exactly = Stated::by(Choice {
                        method,
                        pieces: 1,
                        tolerance: f64::EPSILON,
                    });
                    body.set_out(&mut exactly, t, until);
                    body
                })
            }
            _ => None,
        };
        self.known = match exact {
            Some(body) => Known::Exact { body, now: t },
            None => kept(simulated).map_or(Known::Nothing, Known::Kept),
        };
    }

    /// The same as [`Self::deviation`] for whoever looks in between: it counts for nothing that comes later.
    pub fn peek(&mut self, subject: &Subject, sample: &Sample, t: f64) -> Deviation {
        let largest = (self.energy, self.momentum);
        let deviation = self.deviation(subject, sample, t);
        (self.energy, self.momentum) = largest;
        deviation
    }

    /// How far the simulated body is off at time `t`.
    pub fn deviation(&mut self, subject: &Subject, sample: &Sample, t: f64) -> Deviation {
        if matches!(self.known, Known::Nothing) {
            return Deviation::default();
        }
        let momentum_w = subject.momentum_w(&sample.motion);
        let kinetic = subject.energy_with(&sample.motion, momentum_w);
        let (attitude, energy, momentum) = match &mut self.known {
            Known::Nothing => return Deviation::default(),
            Known::Exact { body, now } => {
                move_to(body, now, t);
                let Some(truth) = body.motions().next() else {
                    return Deviation::default();
                };
                let off = angle_between(truth.q_wb, sample.motion.q_wb);
                let true_momentum_w = subject.momentum_w(&truth);
                let true_energy = subject.energy_with(&truth, true_momentum_w);
                let energy = kinetic - true_energy;
                self.energy = self.energy.max(true_energy);
                self.momentum = self.momentum.max(true_momentum_w.norm());
                let momentum = (momentum_w - true_momentum_w).norm();
                (Some(off), energy, Some(momentum))
            }
            Known::Kept(kept) => {
                self.energy = self.energy.max(kinetic);
                self.momentum = self.momentum.max(momentum_w.norm());
                let change = momentum_w - kept.momentum_w;
                let energy = kinetic + kept.potential(subject, sample) - kept.energy;
                let momentum = match kept.momentum {
                    KeptMomentum::All => Some(change.norm()),
                    KeptMomentum::Along(direction) => Some(change.dot(&direction).abs()),
                    KeptMomentum::Nothing => None,
                };
                (None, energy, momentum)
            }
        };
        let part = |off: f64, of: f64| if off == 0.0 { 0.0 } else { off / of };
        Deviation {
            attitude,
            energy: Some(part(energy, self.energy)),
            momentum: momentum.map(|off| part(off, self.momentum)),
        }
    }
}

/// Takes a body in closed form to time `t`.
fn move_to(body: &mut Group, now: &mut f64, t: f64) {
    if t > *now {
        body.take(&[Step {
            from: *now,
            h: t - *now,
            to: t,
            keep: false,
        }]);
        *now = t;
    }
}

/// What the model keeps of a body under its load.
fn kept((subject, sample, group, body): Simulated<'_>) -> Option<Kept> {
    let weights = group.weights(body)?;
    // A force at the reference point turns nothing.
    let levers = weights.iter().filter(|w| w.point_b != Vector3::zeros());
    let directions = levers.filter_map(|w| Unit::try_new(w.force_w, 0.0));
    let mut directions = directions;
    let momentum = match directions.next() {
        None => KeptMomentum::All,
        // 1e-15 is a rounding of unit vectors.
        Some(first) => match directions.all(|other| first.cross(&other).norm() <= 1e-15) {
            true => KeptMomentum::Along(first),
            false => KeptMomentum::Nothing,
        },
    };
    let mut kept = Kept {
        origin_w: sample.reference_w(subject),
        energy: 0.0,
        momentum_w: subject.momentum_w(&sample.motion),
        momentum,
        weights,
    };
    kept.energy = subject.energy(&sample.motion) + kept.potential(subject, sample);
    Some(kept)
}

impl Kept {
    /// `-Σ F · p`, p where the force acts, J.
    fn potential(&self, subject: &Subject, sample: &Sample) -> f64 {
        let reference_w = sample.reference_w(subject) - self.origin_w;
        let of = |weight: &Weight| {
            let point_w = reference_w + sample.motion.q_wb * weight.point_b;
            -weight.force_w.dot(&point_w)
        };
        self.weights.iter().map(of).sum()
    }
}
