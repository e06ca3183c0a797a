//! How logs spell their columns: one table, from which columns are recognised and docs/logs.md is written.
//!
//! Case, separators and brackets do not count: `Ang_Vel.X`, `angVelX` and `ang vel [x]` are one.

use super::units::plain;

/// What a column can be of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    Time,
    Body,
    /// Which of several runs or copies in one file.
    Run,
    Position,
    Attitude,
    Omega,
    Velocity,
    Torque,
    Force,
    Point,
}

impl Quantity {
    pub const ALL: [Self; 10] = [
        Self::Time,
        Self::Body,
        Self::Run,
        Self::Position,
        Self::Attitude,
        Self::Omega,
        Self::Velocity,
        Self::Torque,
        Self::Force,
        Self::Point,
    ];

    /// As a mapping calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Body => "body",
            Self::Run => "run",
            Self::Position => "position",
            Self::Attitude => "attitude",
            Self::Omega => "omega",
            Self::Velocity => "velocity",
            Self::Torque => "torque",
            Self::Force => "force",
            Self::Point => "point",
        }
    }

    /// What it is, for people.
    pub fn about(self) -> &'static str {
        match self {
            Self::Time => "time, s",
            Self::Body => "whose row it is: a name or a number; absent, there is one body",
            Self::Run => {
                "which run or copy of several in one file: a body of each is a body of its own"
            }
            Self::Position => "position, world, m",
            Self::Attitude => "quaternion, body to world",
            Self::Omega => "angular velocity, world, rad/s",
            Self::Velocity => "velocity, world, m/s",
            Self::Torque => "torque about the centre of mass, world, N m",
            Self::Force => "force, world, N",
            Self::Point => "where the force acts, world, m",
        }
    }

    /// How many columns it has.
    pub fn width(self) -> usize {
        match self {
            Self::Time | Self::Body | Self::Run => 1,
            Self::Attitude => 4,
            _ => 3,
        }
    }

    /// By the name of a mapping, or one that is as common.
    pub fn called(name: &str) -> Option<Self> {
        let key = plain(name);
        let known = Self::ALL
            .into_iter()
            .find(|quantity| quantity.name() == key);
        known.or(match key.as_str() {
            "t" | "timestamp" | "stamp" => Some(Self::Time),
            "name" | "id" => Some(Self::Body),
            "pos" => Some(Self::Position),
            "orientation" | "quaternion" | "quat" | "q" | "rotation" => Some(Self::Attitude),
            "angularvelocity" | "angvel" | "w" => Some(Self::Omega),
            "vel" | "linearvelocity" => Some(Self::Velocity),
            "forcepoint" => Some(Self::Point),
            _ => None,
        })
    }
}

/// The axes that a vector is logged along.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Frame {
    #[default]
    World,
    Body,
}

impl Frame {
    pub fn name(self) -> &'static str {
        match self {
            Self::World => "world",
            Self::Body => "body",
        }
    }
}

/// Names of the columns of one quantity.
pub struct Spelling {
    pub quantity: Quantity,
    pub names: Names,
    pub frame: Frame,
    /// Where several are there, the lower one is read; equals are asked for.
    pub rank: u8,
    /// Read only where nothing else in the file can be meant; see [`super::columns`].
    pub either: bool,
    /// For the docs.
    pub note: &'static str,
}

/// How the columns of a quantity are called.
pub enum Names {
    /// Exactly so, in this order; of an attitude x, y, z, w.
    Exactly(&'static [&'static str]),
    /// Any of these, followed by the component: `x y z` (`w`), or a count from 0 or 1.
    Before(&'static [&'static str]),
    /// The same, where numbers count w, x, y, z.
    BeforeScalarFirst(&'static [&'static str]),
}

const fn exactly(quantity: Quantity, names: &'static [&'static str]) -> Spelling {
    spelling(quantity, Names::Exactly(names))
}

const fn before(quantity: Quantity, names: &'static [&'static str]) -> Spelling {
    spelling(quantity, Names::Before(names))
}

const fn spelling(quantity: Quantity, names: Names) -> Spelling {
    Spelling {
        quantity,
        names,
        frame: Frame::World,
        rank: 1,
        either: false,
        note: "",
    }
}

impl Spelling {
    const fn along_body(self) -> Self {
        Self {
            frame: Frame::Body,
            ..self
        }
    }

    const fn rank(self, rank: u8) -> Self {
        Self { rank, ..self }
    }

    const fn either(self) -> Self {
        Self {
            either: true,
            ..self
        }
    }

    const fn note(self, note: &'static str) -> Self {
        Self { note, ..self }
    }
}

use Quantity::{Attitude, Body, Force, Omega, Point, Position, Run, Time, Torque, Velocity};

/// Every spelling that is recognised.
pub static SPELLINGS: &[Spelling] = &[
    exactly(Time, &["sim_time"]).rank(0),
    exactly(Time, &["simulation_time"]).rank(0),
    exactly(Time, &["time"]),
    exactly(Time, &["t"]),
    exactly(Time, &["timestamp"]),
    exactly(Time, &["stamp"]),
    exactly(Time, &["__time"]).note("PlotJuggler"),
    exactly(Time, &["header.stamp"])
        .rank(2)
        .note("ROS; also in two columns, `sec` and `nanosec`"),
    exactly(Time, &["elapsed"]),
    exactly(Time, &["elapsed_time"]),
    exactly(Body, &["body"]).rank(0),
    exactly(Body, &["body_name"]).rank(1),
    exactly(Body, &["name"]).rank(2),
    exactly(Body, &["child_frame_id"]).rank(3),
    exactly(Body, &["entity"]).rank(4),
    exactly(Body, &["object"]).rank(5),
    exactly(Body, &["link"]).rank(6),
    exactly(Body, &["model"]).rank(7),
    exactly(Body, &["frame_id"]).rank(8),
    exactly(Body, &["body_id"]).rank(9),
    exactly(Body, &["id"]).rank(10),
    exactly(Run, &["recording"]).rank(0),
    exactly(Run, &["run"]).rank(1),
    exactly(Run, &["episode"]).rank(2),
    exactly(Run, &["env"]).rank(3),
    exactly(Run, &["env_id"]).rank(4),
    exactly(Position, &["x", "y", "z"]).note("not where `w` stands beside them: then asked for"),
    before(
        Position,
        &[
            "pos",
            "position",
            "translation",
            "location",
            "loc",
            "com",
            "xpos",
            "pose.position",
        ],
    ),
    exactly(Position, &["qpos[0]", "qpos[1]", "qpos[2]"]).note("MuJoCo, of one free body"),
    before(Position, &["p"])
        .either()
        .note("the force's point where another position is there"),
    exactly(Attitude, &["qx", "qy", "qz", "qw"]).note("by name, in any order"),
    before(
        Attitude,
        &[
            "quat",
            "quaternion",
            "orientation",
            "orient",
            "attitude",
            "rot",
            "rotation",
            "xquat",
            "pose.orientation",
        ],
    )
    .note("where numbered, the order is asked for"),
    spelling(Attitude, Names::BeforeScalarFirst(&["q", "e"]))
        .note("numbered from 0, w comes first, as in ULog"),
    exactly(Attitude, &["qi", "qj", "qk", "qr"]),
    exactly(Attitude, &["x", "y", "z", "w"])
        .either()
        .note("where the position has other columns"),
    exactly(Attitude, &["qpos[4]", "qpos[5]", "qpos[6]", "qpos[3]"])
        .note("MuJoCo, of one free body"),
    before(
        Omega,
        &[
            "w",
            "omega",
            "ang_vel",
            "angular_velocity",
            "angvel",
            "av",
            "rot_vel",
            "rotational_velocity",
            "angular",
        ],
    ),
    before(Omega, &["twist.angular"])
        .along_body()
        .note("ROS odometry, whose twist is of the child frame"),
    before(Omega, &["gyro", "gyro_rad", "body_rate", "body_rates"])
        .along_body()
        .note("sensors and ULog"),
    exactly(Omega, &["rollspeed", "pitchspeed", "yawspeed"])
        .along_body()
        .note("PX4, MAVLink"),
    exactly(Omega, &["p", "q", "r"])
        .along_body()
        .note("flight mechanics"),
    exactly(Omega, &["qvel[3]", "qvel[4]", "qvel[5]"])
        .along_body()
        .note("MuJoCo, of one free body"),
    before(
        Velocity,
        &[
            "v",
            "vel",
            "velocity",
            "lin_vel",
            "linear_velocity",
            "linvel",
            "linear",
        ],
    ),
    before(Velocity, &["twist.linear"])
        .along_body()
        .note("ROS odometry, whose twist is of the child frame"),
    exactly(Velocity, &["qvel[0]", "qvel[1]", "qvel[2]"]).note("MuJoCo, of one free body"),
    before(Torque, &["torque", "tau", "trq", "wrench.torque"]),
    before(Torque, &["t"])
        .either()
        .note("asked for where nothing else is a position"),
    before(Force, &["f", "force", "frc", "wrench.force"]),
    before(
        Point,
        &[
            "point",
            "force_point",
            "application_point",
            "contact_point",
            "lever",
        ],
    ),
];

/// One way in which the columns of a spelling can be called, as keys without case or separators.
pub(super) struct Way {
    /// Of an attitude in the order x, y, z, w.
    pub keys: Vec<String>,
    /// Which number comes first where they are counted; what the names do not say.
    pub counted: Counted,
}

/// The order of an attitude's numbered columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Counted {
    /// Components have names.
    No,
    ScalarFirst,
    /// Nothing says.
    Unknown,
}

const COUNTS: [&str; 5] = ["0", "1", "2", "3", "4"];

impl Spelling {
    /// All ways to write it.
    pub(super) fn ways(&self) -> Vec<Way> {
        let (prefixes, scalar_first) = match self.names {
            Names::Exactly(names) => {
                let keys = names.iter().map(|name| plain(name)).collect();
                return vec![Way {
                    keys,
                    counted: Counted::No,
                }];
            }
            Names::Before(prefixes) => (prefixes, false),
            Names::BeforeScalarFirst(prefixes) => (prefixes, true),
        };
        let mut ways = Vec::new();
        for prefix in prefixes {
            let way = |ends: &[&str], counted: Counted| Way {
                keys: ends
                    .iter()
                    .map(|end| plain(&format!("{prefix}{end}")))
                    .collect(),
                counted,
            };
            match self.quantity {
                Attitude => {
                    ways.push(way(&["x", "y", "z", "w"], Counted::No));
                    match scalar_first {
                        true => ways.push(way(&["1", "2", "3", "0"], Counted::ScalarFirst)),
                        false => ways.push(way(&COUNTS[..4], Counted::Unknown)),
                    }
                    ways.push(way(&COUNTS[1..], Counted::Unknown));
                }
                _ => {
                    ways.push(way(&["x", "y", "z"], Counted::No));
                    ways.push(way(&COUNTS[..3], Counted::No));
                    ways.push(way(&COUNTS[1..4], Counted::No));
                }
            }
        }
        ways
    }

    /// How people write it, for the docs.
    fn written(&self) -> String {
        match self.names {
            Names::Exactly(names) => format!("`{}`", names.join(" ")),
            Names::Before(prefixes) | Names::BeforeScalarFirst(prefixes) => {
                let end = match self.quantity {
                    Attitude => "`… x y z w`",
                    _ => "`… x y z`",
                };
                let prefixes: Vec<String> = prefixes.iter().map(|p| format!("`{p}`")).collect();
                format!("{} {end}", prefixes.join(", "))
            }
        }
    }
}

/// The table as Markdown, for docs/logs.md.
pub fn markdown() -> String {
    let mut text = String::from("| quantity | columns |\n| --- | --- |\n");
    for quantity in Quantity::ALL {
        let mut ways: Vec<String> = Vec::new();
        for spelling in SPELLINGS.iter().filter(|s| s.quantity == quantity) {
            let mut way = spelling.written();
            let mut notes = Vec::new();
            if spelling.frame == Frame::Body {
                notes.push("body axes");
            }
            if !spelling.note.is_empty() {
                notes.push(spelling.note);
            }
            if !notes.is_empty() {
                way += &format!(" ({})", notes.join("; "));
            }
            ways.push(way);
        }
        text += &format!(
            "| **{}**: {} | {} |\n",
            quantity.name(),
            quantity.about(),
            ways.join("<br>")
        );
    }
    text += "\n| quantity | units, the first where none is written |\n| --- | --- |\n";
    for quantity in Quantity::ALL {
        let units: Vec<String> = quantity
            .units()
            .map(|unit| format!("`{}`", unit.written().join("` `")))
            .collect();
        if !units.is_empty() {
            text += &format!("| {} | {} |\n", quantity.name(), units.join("<br>"));
        }
    }
    text
}
