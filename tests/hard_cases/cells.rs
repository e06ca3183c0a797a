//! What a case is, and what a cell must come to.

use crate::run::Seen;
use torquescope::integrator::{Kind, MethodInfo};
use torquescope::trace::Sample;

pub struct Group {
    pub title: &'static str,
    /// What is compared, and with what.
    pub about: &'static str,
    pub cases: Vec<Case>,
}

pub struct Case {
    pub name: String,
    /// What is hard about it.
    pub hard: &'static str,
    pub problem: Problem,
    /// Who comes to what; the first line that names a method counts, and a method that none names
    /// must keep what its order promises.
    pub cells: Vec<Cell>,
}

/// Some methods (none named: all that are left), what they come to, and why.
#[derive(Clone)]
pub struct Cell {
    pub who: &'static [&'static str],
    pub must: Must,
    pub why: &'static str,
}

/// A scene, and how far off its end is.
pub struct Problem {
    /// The text of the scene; `STEPPING` stands for the lines of method and step.
    pub scene: String,
    /// s.
    pub step: f64,
    pub steps: f64,
    /// How fast things turn or swing at most, rad/s: what a step must resolve.
    pub rate: f64,
    /// `|L|/I_min`, rad/s: how fast the equations of a method swing that has L and q for its state, because ω = I⁻¹ Rᵀ L
    /// makes an error of q one of ω. Of a thin body it is far above the rate.
    pub thin: f64,
    /// No torque acts.
    pub free: bool,
    /// From the end of the body; rad, or as the group's `about` says.
    pub off: Box<dyn Fn(&Sample) -> f64 + Send + Sync>,
}

#[derive(Clone, Copy, Debug)]
pub enum Must {
    /// An error of at most that.
    Hold(f64),
    /// An error between these: the method is known to go wrong here, and by how much.
    Degrade(f64, f64),
    /// The scene is refused, with these words.
    BeRefused(&'static str),
    /// The run stops, and says when, at which step, which body, and these words.
    BeLost(&'static str),
    /// Nothing is promised: a step is too long, or a body too thin, for its order to mean anything. It runs on with
    /// attitudes that are attitudes, or stops and says so.
    RunOrBeLost,
    /// Not run.
    NotRun,
}

/// Those that take no torque, and those that know no other than Euler's equations.
const NO_TORQUE: &[&str] = &[
    "buss3",
    "dmv2",
    "dmv4",
    "dmv6",
    "dmv8",
    "dmv10",
    "closed-form",
];
const EULER_ALONE: &[&str] = &["dlm", "dmv2", "dmv4", "dmv6", "dmv8", "dmv10"];
pub const ADAPTIVE: &[&str] = &["dop853", "taylor"];
pub const EXACT: &[&str] = &[
    "closed-form",
    "strang",
    "rkn4",
    "rkn6",
    "s15",
    "aba864",
    "aba1064",
];
pub const REST: &[&str] = &[];

/// A torque acts.
pub fn torque_is_refused() -> Cell {
    cell(
        NO_TORQUE,
        Must::BeRefused("for bodies that no torque turns"),
        "a torque would cost them their order",
    )
}

/// The tutorial's model.
pub fn tutorial_is_refused() -> Cell {
    cell(
        EULER_ALONE,
        Must::BeRefused("keep their angular momentum (gyroscopic = true)"),
        "they have L for what stays",
    )
}

pub fn cell(who: &'static [&'static str], must: Must, why: &'static str) -> Cell {
    Cell { who, must, why }
}

impl Case {
    /// The line that counts for a method; none where its order's promise does.
    pub fn cell(&self, info: &MethodInfo) -> Option<&Cell> {
        let names = |cell: &&Cell| cell.who.is_empty() || cell.who.contains(&info.name);
        self.cells.iter().find(names)
    }

    pub fn must(&self, info: &MethodInfo) -> Must {
        if let Some(cell) = self.cell(info) {
            return cell.must;
        }
        match self.problem.promised(info) {
            bound if bound < MEANINGLESS => Must::Hold(bound),
            _ => Must::RunOrBeLost,
        }
    }

    /// Whether the cell came to what it must.
    pub fn judge(&self, info: &MethodInfo, seen: &Seen) -> Result<(), String> {
        let must = self.must(info);
        let right = match (must, seen) {
            (Must::Hold(bound), Seen::Off { off, .. }) => *off <= bound,
            (Must::Degrade(least, most), Seen::Off { off, .. }) => (least..=most).contains(off),
            (Must::RunOrBeLost, Seen::Off { off, .. }) => off.is_finite(),
            (Must::RunOrBeLost, Seen::Lost { .. }) => true,
            (Must::BeRefused(words), Seen::Refused(said)) => said.contains(words),
            (Must::BeLost(words), Seen::Lost { said, .. }) => said.contains(words),
            (Must::NotRun, Seen::NotRun) => true,
            _ => false,
        };
        match right {
            true => Ok(()),
            false => Err(format!("{seen:?}, must {must:?}")),
        }
    }
}

impl Problem {
    /// The error that a method of its order may make, rad.
    ///
    /// Order p: a step is off by (h ω)^(p+1), and they add up to radians · (h ω)^p, with a factor of 5 for the
    /// shape of the body. Steps of its own: a hundred tolerances a radian, as errors of phase grow with
    /// the square of the time. Rounding: two ulps a step and two a radian, all the same way; as many stages more
    /// where there are kicks.
    pub fn promised(&self, info: &MethodInfo) -> f64 {
        let carries_momentum = CARRY_MOMENTUM.contains(&info.name);
        let rate = if carries_momentum {
            self.thin.max(self.rate)
        } else {
            self.rate
        };
        let radians = rate * self.step * self.steps;
        let stages = f64::from(info.cost.evaluations.unwrap_or(1).max(1));
        let rounding = |steps: f64| 4e-15 + 2.0 * f64::EPSILON * (steps + radians);
        match info.kind {
            Kind::Closed => rounding(0.0),
            Kind::Adaptive => 100.0 * TOLERANCE * (1.0 + radians),
            Kind::Fixed if info.exact_free && self.free => rounding(0.0),
            Kind::Fixed => {
                let order = (self.step * rate).powi(info.order as i32);
                5.0 * radians * order + stages * rounding(self.steps)
            }
        }
    }
}

/// Methods whose state is q and L in the world.
const CARRY_MOMENTUM: &[&str] = &[
    "buss", "buss3", "dlm", "dmv2", "dmv4", "dmv6", "dmv8", "dmv10",
];

/// An error that a bound allows says nothing of an angle.
const MEANINGLESS: f64 = 0.3;

/// Of methods with steps of their own: what a scene has that does not say.
pub const TOLERANCE: f64 = 1e-12;
