//! Streams: what a scene can choose to record. One line each in [`STREAMS`].

use super::quantity::{self as q, Quantity};

/// Something to record, by the name a scene calls it.
pub struct Stream {
    pub name: &'static str,
    pub quantities: &'static [&'static Quantity],
    /// What it shows.
    pub about: &'static str,
    /// Whether it is recorded where a scene chooses none.
    pub by_default: bool,
}

/// Every stream, in the order of the lists.
pub const STREAMS: &[Stream] = &[
    Stream {
        name: "state",
        quantities: &[
            &q::POSITION,
            &q::ORIENTATION,
            &q::VELOCITY,
            &q::VELOCITY_NORM,
        ],
        about: "the pose as numbers; the picture's pose is recorded always",
        by_default: true,
    },
    Stream {
        name: "force",
        quantities: &[&q::FORCE, &q::FORCE_POINT],
        about: "pushes: an arrow that ends where it pushes, and its lever arm",
        by_default: true,
    },
    Stream {
        name: "torque",
        quantities: &[&q::TORQUE, &q::TORQUE_NORM],
        about: "applied torque about the centre of mass or the pivot: an axis with a turning arrow",
        by_default: true,
    },
    Stream {
        name: "sources",
        quantities: &[],
        about: "the torque of each source by itself, gyroscopic term and damping among them, where there are several: they add up to I α",
        by_default: true,
    },
    Stream {
        name: "alpha",
        quantities: &[&q::ALPHA, &q::ALPHA_NORM],
        about: "angular acceleration by the model, gyroscopic term included where the scene has it",
        by_default: true,
    },
    Stream {
        name: "omega",
        quantities: &[&q::OMEGA, &q::OMEGA_NORM],
        about: "angular velocity",
        by_default: true,
    },
    Stream {
        name: "momentum",
        quantities: &[&q::MOMENTUM],
        about: "angular momentum about the centre of mass or the pivot",
        by_default: true,
    },
    Stream {
        name: "inertia",
        quantities: &[&q::INERTIA],
        about: "world inertia about the centre of mass or the pivot; the picture is the equivalent ellipsoid",
        by_default: true,
    },
    Stream {
        name: "inverse_inertia",
        quantities: &[&q::INVERSE_INERTIA],
        about: "world inverse inertia, zero about held axes",
        by_default: true,
    },
    Stream {
        name: "energy",
        quantities: &[&q::ENERGY],
        about: "kinetic energy",
        by_default: true,
    },
    Stream {
        name: "error",
        quantities: &[&q::ATTITUDE_ERROR],
        about: "angle from the exact attitude, as long as nothing has acted but impulses, damping and forces without a torque",
        by_default: true,
    },
    Stream {
        name: "drift",
        quantities: &[&q::ENERGY_DRIFT, &q::MOMENTUM_DRIFT],
        about: "what the method adds to energy and angular momentum, where the true values are known: beside the exact motion, or since the last event where the model keeps them",
        by_default: true,
    },
    Stream {
        name: "step_time",
        quantities: &[&q::STEP_TIME],
        about: "wall time a step takes; only where asked for by name, because no two runs have the same",
        by_default: false,
    },
    Stream {
        name: "numbers",
        quantities: &[],
        about: "a page a body, at the cursor: every number above that is recorded, to read",
        by_default: true,
    },
];

/// A choice of streams; by default none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StreamSet(u32);

impl StreamSet {
    pub fn none() -> Self {
        Self(0)
    }

    /// What is recorded where a scene chooses nothing.
    pub fn default_set() -> Self {
        let streams = STREAMS.iter().enumerate();
        let chosen = streams.filter(|(_, stream)| stream.by_default);
        Self(chosen.fold(0, |set, (k, _)| set | 1 << k))
    }

    /// The set of the one stream of that name.
    pub fn of(name: &str) -> Option<Self> {
        let index = STREAMS.iter().position(|stream| stream.name == name)?;
        Some(Self(1 << index))
    }

    pub fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Those that are in both.
    pub fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    pub fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether any is in both.
    pub fn meets(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    pub fn contains(self, name: &str) -> bool {
        Self::of(name).is_some_and(|one| self.0 & one.0 != 0)
    }

    /// The chosen streams, in the order of the lists.
    pub fn iter(self) -> impl Iterator<Item = &'static Stream> {
        let chosen = move |(k, stream)| (self.0 & (1u32 << k) != 0).then_some(stream);
        STREAMS.iter().enumerate().filter_map(chosen)
    }

    /// The quantities of the chosen streams, in the order of the lists.
    pub fn quantities(self) -> Vec<&'static Quantity> {
        self.iter()
            .flat_map(|s| s.quantities.iter().copied())
            .collect()
    }
}
