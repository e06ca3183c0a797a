//! What a method promises, what it takes and where it comes from.

use crate::body::InertialBlock;
use crate::effect::{Depends, Load};

#[derive(Clone, Copy, Debug)]
pub struct MethodInfo {
    /// As scenes and the command line name it.
    pub name: &'static str,
    /// Engines whose scheme this is; scenes can call it by them.
    pub engines: &'static [&'static str],
    pub kind: Kind,
    /// Global order of accuracy in attitude, for smooth forces that it accepts. For methods that
    /// choose their own steps, of the formula they use.
    pub order: u32,
    /// Where forces of the size ε beside the free motion make errors of `ε h^a + ε² h^b + ε³ h^c`: a, b and
    /// c, of which the last is the order above. a is also the order under torques of time alone.
    pub weak_orders: Option<[u32; 3]>,
    pub accepts: Accepts,
    pub models: Models,
    pub damping: Damping,
    /// A step back undoes a step forth, to rounding.
    pub reversible: bool,
    /// Of a free body |L|, in the world its direction too, is kept to rounding.
    pub keeps_momentum: bool,
    /// The motion of a body on which nothing acts is exact to rounding, whatever the steps.
    pub exact_free: bool,
    /// What it keeps, for readers.
    pub preserves: &'static str,
    pub cost: Cost,
    pub citation: &'static str,
}

/// How a method gets through time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// By the steps it is given.
    Fixed,
    /// By steps of its own, as long as its tolerance allows.
    Adaptive,
    /// At once, to any time.
    Closed,
}

/// Which torques a method takes without losing its order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accepts {
    /// Any.
    Any,
    /// Any that do not depend on velocities.
    Place,
    /// Constant forces at points and constant torques, in either frame.
    Terms,
    /// No torque, and forces that are constant.
    Free,
}

/// Whether bodies may keep their angular velocity where no torque acts (the tutorial's model) or
/// must keep their angular momentum (Euler's equations).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Models {
    Both,
    Gyroscopic,
}

/// How damping enters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Damping {
    /// Velocities by themselves decay exactly as `e^{-ct}`; this is how.
    Exact(&'static str),
    /// To the method's tolerance; this is how.
    Within(&'static str),
    /// As the engine does it.
    Engine(&'static str),
    /// Not at all: such loads are refused.
    Refused,
}

/// What it costs, for plans that must not depend on a clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Evaluations of the equations of motion a step, 0 of a closed form; `None` where they vary.
    pub evaluations: Option<u32>,
    /// Time of a step of one body alone, in units of a step of rk4, as the benchmark measured it: of a top
    /// under gravity; of a free body for methods that take no torque, and of an evaluation at one instant for
    /// a closed form, rk4's being of a free body too.
    pub weight: f64,
}

impl Cost {
    /// Evaluations in so many steps. Methods whose evaluations vary count them as they go.
    pub fn evaluations_in(&self, steps: u64) -> u64 {
        self.evaluations.map_or(0, |each| steps * u64::from(each))
    }
}

/// Why a method does not take a load.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Refusal(pub String);

impl Kind {
    pub fn describe(self) -> &'static str {
        match self {
            Self::Fixed => "as given",
            Self::Adaptive => "its own, by tolerance",
            Self::Closed => "none: any time at once",
        }
    }
}

impl Accepts {
    pub fn describe(self) -> &'static str {
        match self {
            Self::Any => "any",
            Self::Place => "any of time, place and attitude, not of velocities",
            Self::Terms => "constant forces at points and constant torques, world or body",
            Self::Free => "none, and forces that are constant",
        }
    }
}

impl Damping {
    pub fn describe(self) -> &'static str {
        match self {
            Self::Exact(how) | Self::Within(how) | Self::Engine(how) => how,
            Self::Refused => "refused",
        }
    }
}

impl MethodInfo {
    /// The names of engines by which it is known besides its own.
    pub fn other_names(&self) -> impl Iterator<Item = &'static str> {
        let own = self.name;
        self.engines
            .iter()
            .copied()
            .filter(move |name| *name != own)
    }

    /// Whether there is no load that it refuses.
    pub fn takes_every_load(&self) -> bool {
        let any = self.accepts == Accepts::Any && self.models == Models::Both;
        any && self.kind == Kind::Fixed && self.damping != Damping::Refused
    }

    /// Why this load would cost the method its order, if it would.
    pub fn refuses(&self, load: &Load, inertial: &InertialBlock) -> Option<Refusal> {
        let refusal = |why: &str| Some(Refusal(format!("{} {why}", self.name)));
        if self.damping == Damping::Refused && load.decay().is_some() {
            return refusal("takes no damping");
        }
        if self.models == Models::Gyroscopic && !load.gyroscopic() {
            return refusal(
                "moves bodies that keep their angular momentum (gyroscopic = true); in the tutorial's model they keep their angular velocity",
            );
        }
        if load.limit().is_some() && self.kind != Kind::Fixed {
            return refusal(
                "gets through time by no steps that it is given, and a speed limit is applied after each of them",
            );
        }
        let depends: Depends = load.depends(inertial);
        match self.accepts {
            Accepts::Any => None,
            Accepts::Place if depends.velocity => refusal(
                "kicks by torques that depend on place and time alone: one that depends on velocity would cost it its order",
            ),
            Accepts::Terms if load.terms(inertial).is_none() => refusal(
                "knows the recurrences of constant forces at points and constant torques alone, and something else acts here",
            ),
            Accepts::Free if depends.torque => {
                refusal("is for bodies that no torque turns, and a torque acts here")
            }
            Accepts::Free if depends != Depends::NOTHING => {
                refusal("takes forces that are constant, and one here is not")
            }
            _ => None,
        }
    }
}
