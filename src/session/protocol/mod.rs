//! The line protocol: one command a line, one reply a line.
//!
//! Commands are words and numbers with blanks between, SI units; a reply is a JSON object (`console`). What is wrong is
//! told with its column.

mod parse;
#[cfg(test)]
mod tests;

pub use parse::parse;

use super::hand::Push;
use crate::mass::ray::Ray;
use nalgebra::Vector3;

/// Bytes of a line at most.
pub const LONGEST: usize = 4096;

/// A command as it is understood.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    Play,
    Pause,
    Step(u64),
    Back(u64),
    /// s.
    Seek(f64),
    /// Simulated seconds a second; infinite is as fast as it goes.
    Speed(f64),
    Loop(bool),
    Reset,
    /// A push in numbers.
    Push(Push),
    /// A push or torque so strong that it gives so much spin, rad/s.
    Spin(Push, f64),
    Click(Click),
    Again,
    Set {
        path: String,
        value: String,
        from_start: bool,
    },
    Method {
        name: String,
        tolerance: Option<f64>,
        from_start: bool,
    },
    /// s.
    StepSize {
        step: f64,
        from_start: bool,
    },
    Effect {
        name: String,
        on: bool,
    },
    /// A condition, and its column in the line.
    Break(String, usize),
    Breaks,
    Clear(u64),
    Save(String),
    Branches,
    Branch(String),
    State(String),
    Where,
    Help(Option<&'static Form>),
    Quit,
}

/// A push where a ray first meets a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Click {
    /// World.
    pub ray: Ray,
    pub strength: Strength,
    pub lasts: Option<f64>,
    pub along: Along,
    /// The torque of that force, without the force.
    pub couple: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Strength {
    /// N, or N·s of a blow.
    Force(f64),
    /// What it gives by itself, rad/s.
    Spin(f64),
}

/// Which way a click pushes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Along {
    /// Into the body, at right angles to its surface.
    Normal,
    Ray,
    /// World.
    Axis(Vector3<f64>),
}

/// What a click does where it says nothing: rad/s, and for how long, s.
pub const CLICK_SPIN: f64 = 2.0;
pub const CLICK_LASTS: f64 = 0.1;

/// Why a line is no command.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("column {column}: {why}")]
pub struct Wrong {
    /// In characters, from 1.
    pub column: usize,
    pub why: String,
}

/// How a command is written.
#[derive(Debug, PartialEq)]
pub struct Form {
    pub name: &'static str,
    /// What comes after it; capitals stand for what one puts in.
    pub takes: &'static str,
    pub about: &'static str,
    pub example: &'static str,
}

const fn form(
    name: &'static str,
    takes: &'static str,
    about: &'static str,
    example: &'static str,
) -> Form {
    Form {
        name,
        takes,
        about,
        example,
    }
}

/// Every command, in the order of the lists.
pub const FORMS: &[Form] = &[
    form("play", "", "goes on, at its speed", "play"),
    form("pause", "", "stands still", "pause"),
    form(
        "step",
        "[N]",
        "N steps of the clock on, 1 where nothing is said; stops at breakpoints",
        "step 10",
    ),
    form("back", "[N]", "N steps back", "back 5"),
    form(
        "seek",
        "T",
        "to the last instant of the clock until T s, back or on, past breakpoints",
        "seek 1.25",
    ),
    form(
        "speed",
        "X|max",
        "simulated seconds a second; max is as fast as it goes",
        "speed 0.1",
    ),
    form(
        "loop",
        "on|off",
        "from the start again at the end",
        "loop on",
    ),
    form("reset", "", "to the start of this branch", "reset"),
    form(
        "push",
        "BODY PX PY PZ FX FY FZ [for T] [body|world]",
        "a force (N) at a point (m) for T s; without for a blow (N·s). world (where nothing is said): the point and the direction stay; body: axes of the body, the point from its shape's origin, both go with it",
        "push cone 0 1 0  -10 0 0 for 0.1",
    ),
    form(
        "torque",
        "BODY TX TY TZ [for T] [body|world]",
        "a torque (N·m) for T s; without for N·m·s",
        "torque cone 0 2 0 for 0.1 body",
    ),
    form(
        "spin",
        "BODY PX PY PZ DX DY DZ S [for T] [body|world]",
        "a force at a point along D, so strong that by itself it gives S rad/s",
        "spin cone 0 1 0  -1 0 0  2 for 0.1",
    ),
    form(
        "twist",
        "BODY DX DY DZ S [for T] [body|world]",
        "a torque about D that by itself gives S rad/s",
        "twist cone 0 1 0  3",
    ),
    form(
        "click",
        "OX OY OZ DX DY DZ [force F|spin S] [for T|blow] [normal|ray|along X Y Z] [couple]",
        "pushes the first body that a ray from O along D (world) meets, there; where nothing is said so that it gives 2 rad/s in 0.1 s, along the inward normal. couple: the torque alone",
        "click 0 0.5 5  0 0 -1 force 10 for 0.1 ray",
    ),
    form(
        "again",
        "",
        "the last push with exactly its numbers",
        "again",
    ),
    form(
        "set",
        "PATH VALUE [from start]",
        "a body's position, velocity, orientation or angular_velocity, or an effect's argument, from now on; anything, from the start",
        "set damping.angular 0.1",
    ),
    form(
        "method",
        "NAME [tolerance X] [from start]",
        "another method from now on, for bodies that have none of their own",
        "method rkn6",
    ),
    form(
        "step-size",
        "H from start",
        "another step of the clock, s: only from the start, because all its instants are multiples of it",
        "step-size 1e-3 from start",
    ),
    form(
        "effect",
        "NAME on|off",
        "an effect of the scene on or off from now on",
        "effect drag off",
    ),
    form(
        "break",
        "when CONDITION",
        "stops at the first step at which it begins to hold",
        "break when energy drift > 1e-6",
    ),
    form("breaks", "", "lists the breakpoints", "breaks"),
    form("clear", "N", "removes a breakpoint", "clear 1"),
    form(
        "save",
        "NAME.toml",
        "writes this branch as a scene, which plays back to the same bits",
        "save pushes.toml",
    ),
    form(
        "branches",
        "",
        "lists the branches, and where each leaves another",
        "branches",
    ),
    form(
        "branch",
        "NAME",
        "goes over to a branch, at the same time",
        "branch main",
    ),
    form("state", "BODY", "a body's numbers as it is", "state cone"),
    form("where", "", "time, step, branch, speed", "where"),
    form(
        "help",
        "[COMMAND]",
        "lists the commands, or tells of one",
        "help push",
    ),
    form("quit", "", "ends the session", "quit"),
];

/// The commands as a table in Markdown, as docs/live.md has it.
pub fn table() -> String {
    let mut table = "| command | what it does | for example |\n| --- | --- | --- |\n".to_owned();
    for form in FORMS {
        let written = format!("{} {}", form.name, form.takes);
        let written = written.trim().replace('|', "\\|");
        table += &format!("| `{written}` | {} | `{}` |\n", form.about, form.example);
    }
    table
}
