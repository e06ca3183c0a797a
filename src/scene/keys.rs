//! What a scene's tables hold: every key with its type, unit and meaning, one line each.
//!
//! The reader takes from here which keys it knows, and in a debug build refuses to ask for one that is
//! not declared; `torquescope schema` makes the JSON Schema of it, and the reference docs/keys.md.
//! Solids, effects, methods and streams are declared in tables of their own, which are read here.

use super::swarm;
use super::warnings::WARNINGS;
use crate::effect::EFFECTS;
use crate::integrator::METHODS;
use crate::mass::solids::SOLIDS;
use crate::trace::STREAMS;

/// The keys of one table.
pub struct Keys {
    /// As scenes write it.
    pub name: &'static str,
    pub about: &'static str,
    pub keys: &'static [Key],
    /// Keys from a table of the program, beside those above.
    pub also: Option<Registry>,
    /// All keys of this table too.
    pub extends: Option<&'static Keys>,
    /// Exactly one of its keys must be there.
    pub one: bool,
}

/// A key and what stands behind it.
pub struct Key {
    pub name: &'static str,
    pub takes: Takes,
    /// What it means.
    pub about: &'static str,
    pub required: bool,
    /// What it is where absent, as a scene would write it, or in words.
    pub default: Option<&'static str>,
}

/// What a key takes; numbers with their unit.
pub enum Takes {
    Text,
    /// A name that becomes a path of the recording.
    Name,
    /// One of these words.
    Words(&'static [&'static str]),
    /// A name out of a table of the program.
    NameOf(Registry),
    Switch,
    Number(&'static str),
    /// Above zero.
    Positive(&'static str),
    /// Zero or more.
    NotNegative(&'static str),
    /// A whole number from the first to the second.
    Whole(u64, u64),
    /// Three numbers.
    Vector(&'static str),
    /// Four numbers: x, y, z, w.
    Quaternion,
    /// Three rows of three numbers.
    Matrix(&'static str),
    List(&'static Takes),
    Either(&'static [Takes]),
    Table(&'static Keys),
    /// An array of tables.
    Tables(&'static Keys),
    /// Paths, each with a list of values.
    Sweep,
}

/// A table of the program whose entries scenes call by name.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Registry {
    Solids,
    Effects,
    Methods,
    Streams,
    Warnings,
}

const fn key(name: &'static str, takes: Takes, about: &'static str) -> Key {
    Key {
        name,
        takes,
        about,
        required: false,
        default: None,
    }
}

impl Key {
    const fn required(self) -> Self {
        Self {
            required: true,
            ..self
        }
    }

    const fn default(self, default: &'static str) -> Self {
        Self {
            default: Some(default),
            ..self
        }
    }
}

/// A table of which nothing is said yet.
const PLAIN: Keys = Keys {
    name: "",
    about: "",
    keys: &[],
    also: None,
    extends: None,
    one: false,
};

pub static SCENE: Keys = Keys {
    name: "the scene",
    about: "A scene of Torquescope: bodies, what acts on them, and what happens when. SI units, radians, y up.",
    keys: &[
        key("title", Takes::Text, "a short line").default("the file's name"),
        key("duration", Takes::Positive("s"), "how long it lasts").required(),
        key(
            "allow",
            Takes::List(&Takes::NameOf(Registry::Warnings)),
            "warnings that are meant",
        )
        .default("[]"),
        key(
            "stepping",
            Takes::Table(&STEPPING),
            "how bodies get through time",
        ),
        key(
            "record",
            Takes::Table(&RECORD),
            "what is recorded, and how often",
        ),
        key(
            "effects",
            Takes::Table(&EFFECTS_TABLE),
            "what acts on every body; what is absent is not simulated",
        ),
        key(
            "effect",
            Takes::Tables(&EFFECT),
            "effects with a name, on some bodies, or off at first",
        ),
        key(
            "body",
            Takes::Tables(&BODY),
            "the bodies; a scene has one or a swarm",
        ),
        key("swarm", Takes::Tables(&SWARM), "many bodies by one table"),
        key("event", Takes::Tables(&EVENT), "what happens, and when"),
        key(
            "sweep",
            Takes::Sweep,
            "paths such as damping or \"body.cone.mass\", each with a list of values: every one is a recording",
        ),
    ],
    ..PLAIN
};

pub static STEPPING: Keys = Keys {
    name: "[stepping]",
    about: "How bodies get through time: a method and its step or tolerance, or an accuracy in place of them.",
    keys: &[
        key(
            "method",
            Takes::NameOf(Registry::Methods),
            "the method, or an engine's name",
        )
        .default("\"rk4\""),
        key(
            "step",
            Takes::Positive("s"),
            "of a method of fixed steps; of others the clock",
        )
        .default("0.001"),
        key(
            "tolerance",
            Takes::Positive("relative error a step"),
            "of a method that chooses its own steps",
        )
        .default("1e-12"),
        key(
            "accuracy",
            Takes::Positive("rad"),
            "the program chooses method and step; in place of the other three",
        ),
    ],
    ..PLAIN
};

pub static RECORD: Keys = Keys {
    name: "[record]",
    about: "What is recorded, and how often. Events always are.",
    keys: &[
        key(
            "rate",
            Takes::Positive("1/s"),
            "samples of the derived streams per simulated second",
        )
        .default("60"),
        key(
            "state",
            HOW_OFTEN,
            "pose and angular velocity: at every step, or samples per simulated second",
        )
        .default("\"every\""),
        key(
            "streams",
            Takes::List(&Takes::NameOf(Registry::Streams)),
            "what to record",
        )
        .default("all but step_time"),
        key(
            "rates",
            Takes::Table(&RATES),
            "streams that go at a rate of their own",
        ),
    ],
    ..PLAIN
};

/// A rate: every step, or so many a second.
pub const HOW_OFTEN: Takes = Takes::Either(&[Takes::Words(&["every"]), Takes::Positive("1/s")]);

pub static RATES: Keys = Keys {
    name: "[record.rates]",
    about: "Streams that go at a rate of their own: each by its name, \"every\" (step) or samples per simulated second. Pictures are drawn no oftener than `rate`.",
    also: Some(Registry::Streams),
    ..PLAIN
};

pub static EFFECTS_TABLE: Keys = Keys {
    name: "[effects]",
    about: "What acts on every body. What is not named is not simulated.",
    also: Some(Registry::Effects),
    ..PLAIN
};

pub static EFFECT: Keys = Keys {
    name: "[[effect]]",
    about: "An effect by its name: one of those that [effects] takes, on some bodies if wished.",
    keys: &[
        key(
            "name",
            Takes::Name,
            "what its torque and `switch` call it; no other has it",
        )
        .default("what it does, such as motor"),
        key(
            "bodies",
            Takes::List(&Takes::Text),
            "names of bodies and swarms that it acts on",
        )
        .default("all of them"),
        key(
            "on",
            Takes::Switch,
            "whether it acts from the start, or from when an event switches it on",
        )
        .default("true"),
    ],
    also: Some(Registry::Effects),
    ..PLAIN
};

/// An attitude, body to world.
pub const ATTITUDE: Takes = Takes::Either(&[Takes::Quaternion, Takes::Table(&ORIENTATION)]);
/// A point of a body.
pub const POINT_OF_BODY: Takes =
    Takes::Either(&[Takes::Text, Takes::Vector("m"), Takes::Table(&BODY_POINT)]);

pub static BODY: Keys = Keys {
    name: "[[body]]",
    about: "A rigid body. It needs a shape, an inertia or an inertial.",
    keys: &[
        key("name", Takes::Name, "up to 64 letters, digits, - and _; events call it by this").required(),
        key("label", Takes::Text, "what the picture calls it").default("the name"),
        key("shape", Takes::Table(&SHAPE), "what it looks like, and its inertia where none is given").default("the box of the same inertia"),
        key("mass", Takes::Either(&[Takes::Positive("kg"), Takes::Words(&["infinite"])]), "its mass; an infinite one is moved by nothing"),
        key("density", Takes::Positive("kg/m³"), "in place of a mass, where the shape has a volume; of parts that say nothing themselves"),
        key("inertia", Takes::Either(&[Takes::Vector("kg m²"), Takes::Matrix("kg m²"), Takes::Table(&INERTIA)]), "three moments or three rows, body axes, about the centre of mass or another point").default("the shape's"),
        key("inertial", Takes::Table(&INERTIAL), "a robot description's `<inertial>`, in place of shape, mass and inertia"),
        key("immovable", Takes::List(&Takes::Words(&["x", "y", "z"])), "body axes that no torque turns it about; not with gyroscopic").default("[]"),
        key("position", Takes::Vector("m"), "of the centre of mass, world").default("[0, 0, 0]"),
        key("velocity", Takes::Vector("m/s"), "of the centre of mass, world; not with a pivot").default("[0, 0, 0]"),
        key("orientation", ATTITUDE, "body to world: x, y, z, w, or an axis and degrees").default("[0, 0, 0, 1]"),
        key("angular_velocity", Takes::Vector("rad/s"), "world").default("[0, 0, 0]"),
        key("pivot", POINT_OF_BODY, "the point of the body that stays where it is: a named one, or from the shape's origin, body axes").default("none: a free body"),
        key("method", Takes::NameOf(Registry::Methods), "of its own").default("that of [stepping]"),
        key("tolerance", Takes::Positive("relative error a step"), "of its own method, where that chooses its own steps").default("1e-12"),
    ],
    ..PLAIN
};

pub static SWARM: Keys = Keys {
    name: "[[swarm]]",
    about: "Many bodies by one table: NAME_0, NAME_1, … Their places are a grid, or random, or both.",
    keys: &[
        key("count", Takes::Whole(1, swarm::MOST), "how many").required(),
        key(
            "grid",
            Takes::Table(&GRID),
            "in rows along x, beside each other along z, in layers along y, about `position`",
        ),
        key(
            "random",
            Takes::Table(&RANDOM),
            "what differs by chance, the same for the same seed",
        ),
    ],
    extends: Some(&BODY),
    ..PLAIN
};

pub static GRID: Keys = Keys {
    name: "grid = {…}",
    about: "Places in rows and layers.",
    keys: &[
        key(
            "spacing",
            Takes::Either(&[Takes::Number("m"), Takes::Vector("m")]),
            "from one to the next: along every axis, or along each",
        )
        .required(),
        key(
            "counts",
            Takes::Vector("bodies along x, y, z"),
            "whole numbers",
        )
        .default("nearly a cube"),
    ],
    ..PLAIN
};

pub static RANDOM: Keys = Keys {
    name: "random = {…}",
    about: "What is drawn for each body.",
    keys: &[
        key(
            "seed",
            Takes::Whole(0, 1 << 53),
            "another seed, other numbers",
        )
        .default("0"),
        key(
            "within",
            Takes::Vector("m"),
            "half widths of the box in which it is, about where it would be",
        )
        .default("[0, 0, 0]"),
        key(
            "spin",
            Takes::NotNegative("rad/s"),
            "the longest angular velocity that is added",
        )
        .default("0"),
        key("orientation", Takes::Switch, "any attitude").default("false"),
    ],
    ..PLAIN
};

pub static SHAPE: Keys = Keys {
    name: "shape = {…}",
    about: "One solid and its lengths in m, a mesh, or parts.",
    keys: &[
        key("mesh", Takes::Table(&MESH), "a closed mesh from a file"),
        key(
            "parts",
            Takes::Tables(&PART),
            "several solids that are one body",
        ),
    ],
    also: Some(Registry::Solids),
    one: true,
    ..PLAIN
};

pub static MESH: Keys = Keys {
    name: "mesh = {…}",
    about: "A mesh: OBJ, STL or GLB, closed and turned outward.",
    keys: &[
        key("file", Takes::Text, "its path from the scene's folder").required(),
        key("scale", Takes::Positive("m a unit of the file"), "its unit").default("1.0"),
    ],
    ..PLAIN
};

pub static PART: Keys = Keys {
    name: "parts = [{…}]",
    about: "A solid in its place, from the body's origin, body axes.",
    keys: &[
        key(
            "name",
            Takes::Name,
            "its points are called NAME.POINT by this",
        ),
        key("shape", Takes::Table(&SHAPE), "its solid or mesh; no parts").required(),
        key("position", Takes::Vector("m"), "of its origin").default("[0, 0, 0]"),
        key("orientation", ATTITUDE, "part to body").default("[0, 0, 0, 1]"),
        key("mass", Takes::Positive("kg"), "its own"),
        key("density", Takes::Positive("kg/m³"), "its own").default("the body's"),
    ],
    ..PLAIN
};

pub static INERTIA: Keys = Keys {
    name: "inertia = {…}",
    about: "An inertia about a point of the body: moments or a tensor.",
    keys: &[
        key(
            "about",
            POINT_OF_BODY,
            "what it is about: a named point, or from the shape's origin, body axes",
        )
        .default("the centre of mass"),
        key("moments", Takes::Vector("kg m²"), "about the body axes"),
        key("tensor", Takes::Matrix("kg m²"), "three rows, body axes"),
    ],
    ..PLAIN
};

pub static INERTIAL: Keys = Keys {
    name: "inertial = {…}",
    about: "Mass, centre of mass and inertia as a robot description has them: urdf or mjcf, pasted or of a file.",
    keys: &[
        key(
            "urdf",
            Takes::Text,
            "`<inertial>…</inertial>`, or a file of URDF",
        ),
        key("link", Takes::Text, "which link of the URDF file"),
        key("mjcf", Takes::Text, "`<inertial …/>`, or a file of MJCF"),
        key("body", Takes::Text, "which body of the MJCF file"),
    ],
    ..PLAIN
};

pub static ORIENTATION: Keys = Keys {
    name: "orientation = {…}",
    about: "A turn about an axis.",
    keys: &[
        key(
            "axis",
            Takes::Vector("a direction"),
            "the axis, of any length",
        )
        .required(),
        key("degrees", Takes::Number("°"), "the angle, right-handed").required(),
    ],
    ..PLAIN
};

pub static BODY_POINT: Keys = Keys {
    name: "pivot = {…}",
    about: "A point of the body.",
    keys: &[key(
        "body",
        Takes::Either(&[Takes::Text, Takes::Vector("m")]),
        "a named point, or from the shape's origin, body axes",
    )],
    one: true,
    ..PLAIN
};

pub static POINT: Keys = Keys {
    name: "point = {…}",
    about: "A point in axes of its own.",
    keys: &[
        key(
            "body",
            Takes::Either(&[Takes::Text, Takes::Vector("m")]),
            "a named point, or from the shape's origin, body axes; carried along",
        ),
        key(
            "world",
            Takes::Either(&[Takes::Text, Takes::Vector("m")]),
            "in the world; it stays",
        ),
    ],
    one: true,
    ..PLAIN
};

pub static EVENT: Keys = Keys {
    name: "[[event]]",
    about: "Something done at an exact time: one of force, impulse, torque, angular_impulse, click, set, switch, method, note.",
    keys: &[
        key("name", Takes::Name, "what paths and the log call it"),
        key("at", Takes::NotNegative("s"), "when").required(),
        key(
            "every",
            Takes::Positive("s"),
            "again and again after so long",
        ),
        key("until", Takes::NotNegative("s"), "repeats none later").default("the end"),
        key(
            "for",
            Takes::Positive("s"),
            "how long a force, a torque or a click lasts",
        )
        .default("an instant"),
        key(
            "profile",
            Takes::Words(&["box", "half_sine", "ramp"]),
            "how it goes through that time; what is written is the peak",
        )
        .default("\"box\""),
        key(
            "body",
            Takes::Text,
            "the name of the body; not of a click or a switch, and a note needs none",
        ),
        key(
            "force",
            Takes::Vector("N; N·s without `for`"),
            "a push at `point`",
        ),
        key("impulse", Takes::Vector("N·s"), "a blow at `point`"),
        key(
            "torque",
            Takes::Vector("N·m; N·m·s without `for`"),
            "a torque",
        ),
        key("angular_impulse", Takes::Vector("N·m·s"), "a jolt"),
        key(
            "click",
            Takes::Table(&CLICK),
            "a ray: the first body that it hits is pushed there, along it",
        ),
        key(
            "set",
            Takes::Table(&SET),
            "a body's state, or parts of it, made what is written",
        ),
        key("switch", Takes::Table(&SWITCH), "an effect on or off"),
        key(
            "method",
            Takes::NameOf(Registry::Methods),
            "another method from here on, for all bodies that have none of their own; not with accuracy",
        ),
        key(
            "tolerance",
            Takes::Positive("relative error a step"),
            "of that method, where it chooses its own steps",
        )
        .default("1e-12"),
        key(
            "note",
            Takes::Text,
            "a line in the log and a mark on the timeline",
        ),
        key(
            "point",
            Takes::Either(&[Takes::Text, Takes::Vector("m"), Takes::Table(&POINT)]),
            "where a force or an impulse acts: a named point, or numbers in `frame`",
        ),
        key(
            "frame",
            Takes::Words(&["world", "body"]),
            "axes of the vector and of the point",
        )
        .default("\"world\""),
        key(
            "unforeseen",
            Takes::Switch,
            "no method with steps of its own shortens them for it: whatever is before it stays, bit by bit, as it would be without",
        )
        .default("false"),
    ],
    ..PLAIN
};

pub static CLICK: Keys = Keys {
    name: "click = {…}",
    about: "A ray from an eye, by toward or by direction.",
    keys: &[
        key("from", Takes::Vector("m"), "the eye, world").required(),
        key(
            "toward",
            Takes::Vector("m"),
            "a point that it looks at, world",
        ),
        key(
            "direction",
            Takes::Vector("a direction"),
            "in place of that, world",
        ),
        key(
            "force",
            Takes::Number("N; N·s without `for`"),
            "along the ray",
        )
        .required(),
    ],
    ..PLAIN
};

pub static SET: Keys = Keys {
    name: "set = {…}",
    about: "What becomes of a body's state; the rest stays.",
    keys: &[
        key(
            "position",
            Takes::Vector("m"),
            "of the centre of mass, world; not with a pivot",
        ),
        key(
            "velocity",
            Takes::Vector("m/s"),
            "of the centre of mass, world; not with a pivot",
        ),
        key("angular_velocity", Takes::Vector("rad/s"), "world"),
        key("orientation", ATTITUDE, "body to world"),
    ],
    ..PLAIN
};

pub static SWITCH: Keys = Keys {
    name: "switch = {…}",
    about: "An effect on or off.",
    keys: &[
        key("effect", Takes::Text, "its name").required(),
        key("on", Takes::Switch, "which").required(),
    ],
    ..PLAIN
};

impl Keys {
    /// Every key that is declared here, in the order of messages and lists.
    pub fn all(&'static self) -> impl Iterator<Item = &'static Key> {
        let inherited = self.extends.iter().flat_map(|keys| keys.keys);
        inherited.chain(self.keys)
    }

    pub(super) fn find(&'static self, name: &str) -> Option<&'static Key> {
        self.all().find(|key| key.name == name)
    }

    /// Whether a scene may write the key.
    pub(super) fn has(&'static self, name: &str) -> bool {
        self.find(name).is_some() || self.also.is_some_and(|registry| registry.has(name))
    }

    /// Every key that a scene may write.
    pub fn names(&'static self) -> Vec<&'static str> {
        let registry = self.also.map_or_else(Vec::new, Registry::names);
        self.all().map(|key| key.name).chain(registry).collect()
    }
}

impl Takes {
    /// The table that may stand here.
    pub(super) fn table(&'static self) -> Option<&'static Keys> {
        match self {
            Self::Table(keys) | Self::Tables(keys) => Some(keys),
            Self::Either(several) => several.iter().find_map(Self::table),
            _ => None,
        }
    }

    /// What the entries of a list are that may stand here; those of an array of tables are tables.
    pub(super) fn entry(&'static self) -> Option<&'static Takes> {
        match self {
            // `table` finds the keys of an entry by the same word.
            Self::Tables(_) => Some(self),
            Self::List(takes) => Some(takes),
            Self::Either(several) => several.iter().find_map(Self::entry),
            _ => None,
        }
    }
}

impl Registry {
    /// The names in it, with all that stand for the same.
    pub fn names(self) -> Vec<&'static str> {
        match self {
            Self::Solids => SOLIDS.iter().map(|kind| kind.name).collect(),
            Self::Effects => EFFECTS.iter().map(|kind| kind.name).collect(),
            Self::Methods => {
                let names = METHODS.iter().map(|method| method.info());
                names
                    .flat_map(|info| std::iter::once(info.name).chain(info.other_names()))
                    .collect()
            }
            Self::Streams => STREAMS.iter().map(|stream| stream.name).collect(),
            Self::Warnings => WARNINGS.iter().map(|warning| warning.code).collect(),
        }
    }

    fn has(self, name: &str) -> bool {
        match self {
            Self::Solids => SOLIDS.iter().any(|kind| kind.name == name),
            Self::Effects => EFFECTS.iter().any(|kind| kind.name == name),
            _ => self.names().contains(&name),
        }
    }
}
