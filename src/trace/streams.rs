//! Streams: what a scene can choose to record. One line each in [`STREAMS`].

use super::quantity::{self as q, Quantity};

/// Something to record, by the name a scene calls it.
pub struct Stream {
    pub name: &'static str,
    pub quantities: &'static [&'static Quantity],
    /// What it shows.
    pub about: &'static str,
}

/// Every stream, in the order of the lists. All are recorded where a scene chooses none.
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
    },
    Stream {
        name: "force",
        quantities: &[&q::FORCE, &q::FORCE_POINT],
        about: "pushes: an arrow that ends where it pushes, and its lever arm",
    },
    Stream {
        name: "torque",
        quantities: &[&q::TORQUE, &q::TORQUE_NORM],
        about: "applied torque about the centre of mass or the pivot: an axis with a turning arrow",
    },
    Stream {
        name: "alpha",
        quantities: &[&q::ALPHA, &q::ALPHA_NORM],
        about: "angular acceleration by the model, gyroscopic term included where the scene has it",
    },
    Stream {
        name: "omega",
        quantities: &[&q::OMEGA, &q::OMEGA_NORM],
        about: "angular velocity",
    },
    Stream {
        name: "momentum",
        quantities: &[&q::MOMENTUM],
        about: "angular momentum about the centre of mass or the pivot",
    },
    Stream {
        name: "inertia",
        quantities: &[&q::INERTIA],
        about: "world inertia about the centre of mass or the pivot; the picture is the equivalent ellipsoid",
    },
    Stream {
        name: "inverse_inertia",
        quantities: &[&q::INVERSE_INERTIA],
        about: "world inverse inertia, zero about held axes",
    },
    Stream {
        name: "energy",
        quantities: &[&q::ENERGY],
        about: "kinetic energy",
    },
    Stream {
        name: "numbers",
        quantities: &[],
        about: "a page a body, at the cursor: every number above that is recorded, to read",
    },
];

/// A choice of streams.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StreamSet(u32);

impl StreamSet {
    pub fn none() -> Self {
        Self(0)
    }

    /// What is recorded where a scene chooses nothing.
    pub fn default_set() -> Self {
        Self((1 << STREAMS.len()) - 1)
    }

    /// The set of the one stream of that name.
    pub fn of(name: &str) -> Option<Self> {
        let index = STREAMS.iter().position(|stream| stream.name == name)?;
        Some(Self(1 << index))
    }

    pub fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
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
