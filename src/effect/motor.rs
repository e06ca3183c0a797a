//! A motor: a torque about an axis, or one that turns the body to an attitude and holds it there.
//!
//! ```text
//! τ = a s(t)        s constant; A sin(2π f t + φ); from s0 to s1 within T seconds, and s1 from then on
//! τ = -k θ - c ω    held: θ the rotation vector of the error, R(θ) = R R_target⁻¹, the short way round;
//!                   no longer than `limit`
//! ```
//!
//! The axis a is fixed in the world, or in the body with `frame = "body"`; t is the scene's time. Half a turn
//! from its target a held body has no short way, and the torque jumps there as it does in any such controller
//! (Wie, Space Vehicle Dynamics and Control (2008), 7.3). A torque that saturates and a ramp at its ends have
//! kinks: a method of fixed steps makes an error of second order in the step that one lies in, unless a step
//! ends there. Nothing stores the momentum: what turns the body takes none from elsewhere.

use super::{
    Argument, Called, Depends, Effect, EffectKind, Frame, Member, Spec, Term, Value, WrenchBlock,
};
use crate::body::{InertialBlock, LaneSet, State, StateBlock};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use std::f64::consts::TAU;
use std::sync::Arc;

pub const KIND: EffectKind = EffectKind {
    name: "motor",
    argument: Argument::Table(&[
        ("torque", Argument::Amount("N·m")),
        ("axis", Argument::Vector("a direction")),
        ("frame", Argument::Word(&["world", "body"])),
        (
            "sine",
            Argument::Table(&[
                ("amplitude", Argument::Number("N·m")),
                ("frequency", Argument::Number("Hz")),
                ("phase", Argument::Number("rad")),
            ]),
        ),
        (
            "ramp",
            Argument::Table(&[
                ("from", Argument::Number("N·m")),
                ("to", Argument::Number("N·m")),
                ("over", Argument::Number("s")),
            ]),
        ),
        ("orientation", Argument::Attitude),
        ("stiffness", Argument::Number("N·m/rad")),
        ("damping", Argument::Number("N·m·s/rad")),
        ("limit", Argument::Number("N·m")),
    ]),
    equation: "τ = a s(t), or τ = -k θ - c ω to an orientation",
    about: "a torque about an axis (axis, and one of torque, sine, ramp; or torque = [x, y, z]) in the world or the body; or one that holds an orientation (stiffness, damping, limit)",
    make: |value, _| match value.get("orientation") {
        Some(Value::Attitude(target)) => hold(value, *target),
        _ => drive(value),
    },
};

const ABOUT_AN_AXIS: [&str; 5] = ["torque", "axis", "frame", "sine", "ramp"];
const TO_AN_ORIENTATION: [&str; 3] = ["stiffness", "damping", "limit"];

/// Refuses keys that say nothing beside the others.
fn only(value: &Value, others: &[&str], beside: &str) -> Result<(), String> {
    match others.iter().find(|key| value.get(key).is_some()) {
        None => Ok(()),
        Some(key) => Err(format!("{key} says nothing beside {beside}; leave it out")),
    }
}

fn drive(value: &Value) -> Result<Called, String> {
    only(
        value,
        &TO_AN_ORIENTATION,
        "a torque about an axis, only with an orientation to turn to",
    )?;
    let in_body = value.word("frame") == Some("body");
    let axis = match value.vector("axis") {
        None => None,
        Some(axis) => Some(direction(axis).ok_or("axis = [0, 0, 0] has no length")?),
    };
    let given = ["torque", "sine", "ramp"];
    let given: Vec<&str> = (given.into_iter())
        .filter(|key| value.get(key).is_some())
        .collect();
    let [one] = given.as_slice() else {
        return Err(match given.is_empty() {
            true => {
                "says neither torque, sine or ramp, about an axis, nor an orientation to turn to"
                    .to_owned()
            }
            false => format!(
                "{} each say what the torque is; keep one",
                given.join(" and ")
            ),
        });
    };
    let (vector, course) = match (*one, axis, value.get("torque")) {
        (_, Some(_), Some(Value::Vector(_))) => {
            return Err(
                "a torque of three numbers has its own axis; leave out axis, or write one number"
                    .to_owned(),
            );
        }
        (_, None, Some(Value::Vector(torque))) => (*torque, Course::Constant),
        (_, None, _) => {
            return Err(format!(
                "{one} lacks its axis; add axis = [x, y, z]{}",
                if *one == "torque" {
                    ", or write torque = [x, y, z]"
                } else {
                    ""
                }
            ));
        }
        (_, Some(axis), Some(Value::Number(torque))) => (axis * *torque, Course::Constant),
        ("sine", Some(axis), _) => (axis, sine(value.get("sine"))?),
        (_, Some(axis), _) => (axis, ramp(value.get("ramp"))?),
    };
    if vector == Vector3::zeros() || course.is_nothing() {
        return Ok(Called::Off);
    }
    Ok(Called::Load(Arc::new(Drive {
        vector,
        in_body,
        course,
    })))
}

/// A vector's direction, however long it is.
fn direction(v: Vector3<f64>) -> Option<Vector3<f64>> {
    (v.amax() > 0.0).then(|| (v / v.amax()).normalize())
}

fn sine(table: Option<&Value>) -> Result<Course, String> {
    let get = |key: &str| table.and_then(|table| table.number(key));
    let (Some(amplitude), Some(frequency)) = (get("amplitude"), get("frequency")) else {
        return Err(
            "sine takes amplitude (N·m), frequency (Hz) and, if wanted, phase (rad)".into(),
        );
    };
    Ok(Course::Sine {
        amplitude,
        rate: TAU * frequency,
        phase: get("phase").unwrap_or(0.0),
    })
}

fn ramp(table: Option<&Value>) -> Result<Course, String> {
    let get = |key: &str| table.and_then(|table| table.number(key));
    let (Some(to), Some(over)) = (get("to"), get("over")) else {
        return Err("ramp takes to (N·m), over (s) and, if it is not 0, from (N·m)".into());
    };
    if over <= 0.0 {
        return Err(format!("ramp over {over} s is none; write a time above 0"));
    }
    Ok(Course::Ramp {
        from: get("from").unwrap_or(0.0),
        to,
        over,
    })
}

fn hold(value: &Value, target: UnitQuaternion<f64>) -> Result<Called, String> {
    only(
        value,
        &ABOUT_AN_AXIS,
        "an orientation: a motor that turns to one needs stiffness, damping and perhaps limit",
    )?;
    let hold = Hold {
        target,
        stiffness: value.not_negative("stiffness")?,
        damping: value.not_negative("damping")?,
        limit: value.number("limit"),
    };
    if value.number("stiffness").is_none() {
        return Err("lacks stiffness, N·m for a radian off".to_owned());
    }
    if let Some(limit) = hold.limit
        && limit <= 0.0
    {
        return Err(format!("limit = {limit} leaves no torque; it is above 0"));
    }
    if hold.stiffness == 0.0 && hold.damping == 0.0 {
        return Ok(Called::Off);
    }
    Ok(Called::Load(Arc::new(hold)))
}

/// How strong a torque is in time.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Course {
    Constant,
    Sine {
        /// N·m.
        amplitude: f64,
        /// rad/s.
        rate: f64,
        /// rad.
        phase: f64,
    },
    Ramp {
        /// N·m.
        from: f64,
        /// N·m.
        to: f64,
        /// s.
        over: f64,
    },
}

impl Course {
    fn at(&self, t: f64) -> f64 {
        match *self {
            Self::Constant => 1.0,
            Self::Sine {
                amplitude,
                rate,
                phase,
            } => amplitude * libm::sin(rate * t + phase),
            Self::Ramp { from, to, over } => {
                let part = (t / over).clamp(0.0, 1.0);
                from + (to - from) * part
            }
        }
    }

    fn is_nothing(&self) -> bool {
        match *self {
            Self::Constant => false,
            Self::Sine { amplitude, .. } => amplitude == 0.0,
            Self::Ramp { from, to, .. } => from == 0.0 && to == 0.0,
        }
    }
}

/// A torque about an axis.
#[derive(Clone, Copy, Debug)]
struct Drive {
    /// World or body axes: the torque (N·m) where it is constant, else a unit vector.
    vector: Vector3<f64>,
    in_body: bool,
    course: Course,
}

impl Spec for Drive {
    fn on(&self, members: &[Member<'_>]) -> Arc<dyn Effect> {
        let direction = |member: &Member<'_>| {
            let direction = match self.in_body {
                true => Frame::Principal(member.q_pb * self.vector),
                false => Frame::World(self.vector),
            };
            (member.lane, direction)
        };
        Arc::new(Driven {
            course: self.course,
            directions: members.iter().map(direction).collect(),
        })
    }
}

/// Torques on bodies of a block.
#[derive(Debug)]
struct Driven {
    course: Course,
    /// By lane.
    directions: Vec<(usize, Frame)>,
}

impl Effect for Driven {
    fn name(&self) -> &'static str {
        "motor"
    }

    fn lanes(&self) -> LaneSet {
        self.directions.iter().map(|(lane, _)| *lane).collect()
    }

    fn add(&self, t: f64, _: &InertialBlock, state: &StateBlock, wrench: &mut WrenchBlock) {
        let strength = self.course.at(t);
        for &(lane, direction) in &self.directions {
            let tau_w = direction.vector_w(&state.get(lane)) * strength;
            wrench.add_torque(lane, tau_w);
        }
    }

    fn terms(&self, _: &InertialBlock) -> Option<Vec<Term>> {
        let term = |&(lane, torque): &(usize, Frame)| Term::Torque { lane, torque };
        match self.course {
            Course::Constant => Some(self.directions.iter().map(term).collect()),
            Course::Sine { .. } | Course::Ramp { .. } => None,
        }
    }

    fn depends(&self, _: &InertialBlock) -> Depends {
        let turns = |(_, direction): &(usize, Frame)| matches!(direction, Frame::Principal(_));
        Depends {
            torque: true,
            time: self.course != Course::Constant,
            place: self.directions.iter().any(turns),
            velocity: false,
        }
    }
}

/// A torque towards an attitude.
#[derive(Clone, Copy, Debug)]
struct Hold {
    /// Body to world.
    target: UnitQuaternion<f64>,
    /// k, N·m/rad.
    stiffness: f64,
    /// c, N·m·s/rad.
    damping: f64,
    /// N·m.
    limit: Option<f64>,
}

impl Hold {
    /// World, N·m, of a body whose principal axes should be at `target`.
    fn torque_w(&self, target: Quaternion<f64>, s: &State) -> Vector3<f64> {
        let error = rotation_vector(s.q_wp * target.conjugate());
        let tau_w = error * -self.stiffness - s.omega_w * self.damping;
        match self.limit {
            Some(limit) if tau_w.norm() > limit => tau_w * (limit / tau_w.norm()),
            _ => tau_w,
        }
    }
}

/// The shortest rotation vector of a rotation, rad: `2 atan2(|u|, |w|) u/|u|`, its sign that of w.
fn rotation_vector(q: Quaternion<f64>) -> Vector3<f64> {
    let (u, w) = match q.w < 0.0 {
        true => (-q.imag(), -q.w),
        false => (q.imag(), q.w),
    };
    let sin = u.norm();
    // atan2(x, w)/x is 1/w to rounding where x is too small to divide by.
    let factor = if sin > 1e-100 {
        libm::atan2(sin, w) / sin
    } else {
        1.0
    };
    u * (2.0 * factor)
}

impl Spec for Hold {
    fn on(&self, members: &[Member<'_>]) -> Arc<dyn Effect> {
        let target = |member: &Member<'_>| {
            let q_wp = self.target * member.q_pb.inverse();
            (member.lane, q_wp.into_inner())
        };
        Arc::new(Held {
            hold: *self,
            targets: members.iter().map(target).collect(),
        })
    }
}

/// Bodies of a block on their way to an attitude.
#[derive(Debug)]
struct Held {
    hold: Hold,
    /// Of the principal axes, by lane.
    targets: Vec<(usize, Quaternion<f64>)>,
}

impl Effect for Held {
    fn name(&self) -> &'static str {
        "motor"
    }

    fn lanes(&self) -> LaneSet {
        self.targets.iter().map(|(lane, _)| *lane).collect()
    }

    fn add(&self, _t: f64, _: &InertialBlock, state: &StateBlock, wrench: &mut WrenchBlock) {
        for &(lane, target) in &self.targets {
            let tau_w = self.hold.torque_w(target, &state.get(lane));
            wrench.add_torque(lane, tau_w);
        }
    }

    fn depends(&self, _: &InertialBlock) -> Depends {
        Depends {
            torque: true,
            place: self.hold.stiffness > 0.0,
            velocity: self.hold.damping > 0.0,
            time: false,
        }
    }
}
