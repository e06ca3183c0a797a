//! How far two runs are apart: body by body, quantity by quantity, instant by instant.
//!
//! ```text
//! attitude      the angle of q_aᵀ q_b
//! all else      |a - b|, also as a part of  max(largest |a|, largest |b|, what the body makes of it)
//! ```
//!
//! What the body makes of it: with the radius r, the mass m and the largest moment I of the body, the compared time T and
//! ω, the faster of the two at their fastest and 1/T: r, rω, ω, ω², m r ω², Iω², Iω, Iω²/2 for place, velocity, angular
//! velocity and acceleration, force, torque, angular momentum and energy. So the rounding of what should be zero is small
//! against something. Places compare by how far they are from where the first run starts.
//!
//! Compared at the instants of the first run that lie in both. Where the other has no row there it is interpolated between
//! its neighbours: attitudes by slerp, all else linearly, pushes by the row before. Of two rows of one instant the first is
//! before an event and the last after it, and so are they compared.

use super::mesh;
use super::runs::Run;
use super::survey::STATIC;
use super::table::Series;
use crate::math::angle_between;
use crate::trace::{Shape, Subject};
use nalgebra::{Quaternion, UnitQuaternion};

/// How much is too much.
#[derive(Clone, Debug)]
pub struct Tolerances {
    /// Of attitudes in rad, of all else a part.
    pub part: f64,
    /// By quantity, in its unit.
    pub own: Vec<(String, f64)>,
}

/// A body of the first run and one of another.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    pub a: String,
    pub b: String,
    /// Otherwise by their places among those that are left.
    pub by_name: bool,
}

/// What two bodies differ by.
#[derive(Clone, Debug)]
pub struct Apart {
    /// Index of the other run.
    pub run: usize,
    pub pair: Pair,
    /// First and last instant compared, ns.
    pub from: i64,
    pub until: i64,
    /// Rows compared of the attitude (or of the place where there is none), and those of them that were interpolated.
    pub rows: u64,
    pub interpolated: u64,
    pub quantities: Vec<Measure>,
    /// Quantities that only one of them has.
    pub alone: Vec<String>,
    /// ns and rad.
    pub attitude: Vec<(i64, f64)>,
}

/// What one quantity differs by.
#[derive(Clone, Debug)]
pub struct Measure {
    pub name: String,
    pub unit: &'static str,
    /// In its unit; of attitudes rad.
    pub largest: f64,
    /// When, ns.
    pub at: i64,
    /// As a part of `scale`; of attitudes rad.
    pub part: f64,
    /// In its unit.
    pub scale: f64,
    /// The first instant of more than is tolerated, ns, and what is tolerated, in its unit.
    pub first: Option<i64>,
    pub tolerated: f64,
}

/// What follows from others, or is about the run itself.
fn is_aside(name: &str) -> bool {
    let aside = [
        "attitude_error",
        "energy_drift",
        "angular_momentum_drift",
        "step_time",
        "force_point",
    ];
    aside.contains(&name) || name.ends_with("_norm")
}

/// Bodies by name (of entities the last part of the path), the rest by order.
pub fn pairs(a: &Run, b: &Run) -> Vec<Pair> {
    let name = |body: &str| body.rsplit('/').next().unwrap_or_default().to_owned();
    let (mut left, mut others) = (a.bodies(), b.bodies());
    let mut found = Vec::new();
    left.retain(|body| {
        let same = |other: &&str| other == body || name(other) == name(body);
        let Some(k) = others.iter().position(same) else {
            return true;
        };
        found.push(pair(body, others.remove(k), true));
        false
    });
    let rest = left.into_iter().zip(others);
    found.extend(rest.map(|(a, b)| pair(a, b, false)));
    found
}

fn pair(a: &str, b: &str, by_name: bool) -> Pair {
    Pair {
        a: a.to_owned(),
        b: b.to_owned(),
        by_name,
    }
}

/// Compares a pair; none where there is no instant that both have. `shift`: what is added to the times of b, ns.
pub fn apart(
    (a, b): (&Run, &Run),
    run: usize,
    pair: Pair,
    shift: i64,
    tolerances: &Tolerances,
) -> Option<Apart> {
    let own = a
        .table
        .series
        .iter()
        .filter(|s| s.body == pair.a && !is_aside(&s.term.name));
    let mut found = Apart {
        run,
        from: i64::MAX,
        until: i64::MIN,
        rows: 0,
        interpolated: 0,
        quantities: Vec::new(),
        alone: Vec::new(),
        attitude: Vec::new(),
        pair: pair.clone(),
    };
    let mut compared = Vec::new();
    for series in own {
        match b.series(&found.pair.b, &series.term.name) {
            Some(other) => compared.push((series, Pairing::new(series, other, shift))),
            None => found.alone.push(series.term.name.clone()),
        }
    }
    let lonely = b
        .table
        .series
        .iter()
        .filter(|s| s.body == found.pair.b && !is_aside(&s.term.name));
    let lonely = lonely.filter(|s| a.series(&found.pair.a, &s.term.name).is_none());
    found.alone.extend(lonely.map(|s| s.term.name.clone()));
    compared.retain(|(_, pairing)| !pairing.rows.is_empty());
    for (_, pairing) in &compared {
        found.from = found.from.min(pairing.rows[0].time);
        found.until = found.until.max(pairing.rows[pairing.rows.len() - 1].time);
    }
    let subject = a.subject(&found.pair.a).or(b.subject(&found.pair.b));
    let omega = compared
        .iter()
        .find(|(series, _)| series.term.name == "angular_velocity");
    let omega = omega.map_or(0.0, |(_, pairing)| pairing.largest());
    let body = Body::new(
        subject,
        omega,
        (found.until.saturating_sub(found.from)) as f64 / 1e9,
    );
    for (series, pairing) in &compared {
        let name = series.term.name.as_str();
        let is_pose = name == "orientation" || name == "position" && found.rows == 0;
        if is_pose {
            found.rows = pairing.rows.len() as u64;
            found.interpolated = pairing.rows.iter().filter(|row| !row.exact).count() as u64;
        }
        if name == "orientation" {
            found.attitude = pairing
                .rows
                .iter()
                .map(|row| (row.time, row.distance))
                .collect();
        }
        let scale = pairing.largest().max(body.makes_of(name));
        found
            .quantities
            .push(pairing.measure(series, scale, tolerances));
    }
    (!found.quantities.is_empty()).then_some(found)
}

/// The differences of two series.
struct Pairing {
    rows: Vec<Row>,
}

struct Row {
    time: i64,
    distance: f64,
    /// The larger of both.
    size: f64,
    exact: bool,
}

impl Pairing {
    fn new(a: &Series, b: &Series, shift: i64) -> Self {
        let name = a.term.name.as_str();
        let origin = match name {
            "position" if !a.times.is_empty() => a.row(0).to_vec(),
            _ => Vec::new(),
        };
        let row = |k: usize| {
            let time = a.times[k];
            let repeats = |other: Option<&i64>| other == Some(&time);
            let before = repeats(a.times.get(k + 1));
            let side = match (before, k > 0 && repeats(a.times.get(k - 1))) {
                (true, _) => Side::Before,
                (false, _) => Side::After,
            };
            let when = match time {
                STATIC => STATIC,
                time => time.checked_sub(shift)?,
            };
            let (other, exact) = value_at(b, when, side)?;
            let own = a.row(k);
            let (distance, size) = match (name, own, other.as_slice()) {
                ("orientation", &[x, y, z, w], &[p, q, r, s]) => {
                    let unit =
                        |x, y, z, w| UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
                    (angle_between(unit(x, y, z, w), unit(p, q, r, s)), 1.0)
                }
                _ => (
                    norm(&difference(own, &other)),
                    norm(&difference(own, &origin)).max(norm(&difference(&other, &origin))),
                ),
            };
            // What is no number is as far away as can be.
            let distance = if distance.is_nan() {
                f64::INFINITY
            } else {
                distance
            };
            Some(Row {
                // What never moves in both is compared once.
                time: if time == STATIC { 0 } else { time },
                distance,
                size,
                exact,
            })
        };
        Self {
            rows: (0..a.times.len()).filter_map(row).collect(),
        }
    }

    fn largest(&self) -> f64 {
        self.rows.iter().map(|row| row.size).fold(0.0, f64::max)
    }

    fn measure(&self, series: &Series, scale: f64, tolerances: &Tolerances) -> Measure {
        let name = series.term.name.as_str();
        let is_attitude = name == "orientation";
        let scale = if is_attitude { 1.0 } else { scale };
        let own = tolerances.own.iter().find(|(own, _)| own == name);
        let tolerated = own.map_or(tolerances.part * scale, |(_, tolerated)| *tolerated);
        let mut measure = Measure {
            name: name.to_owned(),
            unit: if is_attitude { "rad" } else { series.term.unit },
            largest: 0.0,
            at: self.rows.first().map_or(0, |row| row.time),
            part: 0.0,
            scale,
            first: None,
            tolerated,
        };
        for row in &self.rows {
            if row.distance > measure.largest {
                (measure.largest, measure.at) = (row.distance, row.time);
            }
            if row.distance > tolerated && measure.first.is_none() {
                measure.first = Some(row.time);
            }
        }
        measure.part = match measure.largest {
            0.0 => 0.0,
            largest => largest / scale,
        };
        measure
    }
}

#[derive(Clone, Copy)]
enum Side {
    Before,
    After,
}

/// What a series has at an instant, and whether a row says so.
fn value_at(series: &Series, time: i64, side: Side) -> Option<(Vec<f64>, bool)> {
    let at = series.at(time);
    let last = at.clone().next_back()?;
    if series.times[last] == time {
        let row = match side {
            Side::Before => at.start,
            Side::After => last,
        };
        return Some((series.row(row).to_vec(), true));
    }
    let (next, start) = (last + 1, series.times[last]);
    let Some(&end) = series.times.get(next) else {
        // What never moves has one row, of no time.
        return (start == STATIC).then(|| (series.row(last).to_vec(), true));
    };
    let part = (time.abs_diff(start)) as f64 / (end.abs_diff(start)) as f64;
    let (before, after) = (series.row(last), series.row(next));
    if series.term.shape == Shape::VectorPerPush || before.len() != after.len() {
        return Some((before.to_vec(), false));
    }
    let value = match (series.term.name.as_str(), before, after) {
        ("orientation", &[x, y, z, w], &[p, q, r, s]) => slerp([x, y, z, w], [p, q, r, s], part),
        _ => before
            .iter()
            .zip(after)
            .map(|(a, b)| a + (b - a) * part)
            .collect(),
    };
    Some((value, false))
}

/// The shorter way; half a turn apart there is none, and the nearer end is taken.
fn slerp(a: [f64; 4], b: [f64; 4], part: f64) -> Vec<f64> {
    let unit =
        |[x, y, z, w]: [f64; 4]| UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
    let (a, b) = (unit(a), unit(b));
    let between = a.try_slerp(&b, part, 1e-12);
    let nearer = if part < 0.5 { a } else { b };
    between.unwrap_or(nearer).coords.as_slice().to_vec()
}

/// What one does not have counts as zero.
fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    let value = |of: &[f64], k: usize| of.get(k).copied().unwrap_or(0.0);
    (0..a.len().max(b.len()))
        .map(|k| value(a, k) - value(b, k))
        .collect()
}

fn norm(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// What scales come from.
struct Body {
    radius: f64,
    mass: f64,
    moment: f64,
    omega: f64,
}

impl Body {
    fn new(subject: Option<&Subject>, omega: f64, duration: f64) -> Self {
        let slow = if duration > 0.0 { 1.0 / duration } else { 0.0 };
        Self {
            radius: subject.map_or(0.0, mesh::radius),
            mass: subject.and_then(|s| s.mass).unwrap_or(0.0),
            moment: subject.map_or(0.0, |s| s.inertia_b.diagonal().amax()),
            omega: omega.max(slow),
        }
    }

    fn makes_of(&self, quantity: &str) -> f64 {
        let Self {
            radius: r,
            mass: m,
            moment: i,
            omega: w,
        } = *self;
        match quantity {
            "position" => r,
            "velocity" => r * w,
            "angular_velocity" => w,
            "angular_acceleration" => w * w,
            "force" => m * r * w * w,
            "torque" => i * w * w,
            "angular_momentum" => i * w,
            "kinetic_energy" => 0.5 * i * w * w,
            _ => 0.0,
        }
    }
}
