//! Whether a log's attitudes and angular velocities belong together, and under which conventions they would.
//!
//! ```text
//! δ_k = Log(q_{k+1} q_k⁻¹) / h      v_k = s (a M_k ω_k + (1 - a) M_{k+1} ω_{k+1})      a ∈ {1, ½, 0}
//! residual = rms(δ̄ - v̄) / max(rms δ̄, rms v̄)
//! ```
//!
//! A bar smooths by a Hann window of unit sum. Tried are the order of q's numbers, its conjugate, M = 1 (omega along the
//! world's axes) and M = R(q) (the body's), and s of every unit that omega and the clock may come in. Both sides are
//! smoothed alike, so the width biases nothing: it is as many rows as turn by a radian, from 12 to 256.
//!
//! Over logs of known conventions the right ones leave at most 0.014, with 1% noise on omega and 0.2° on attitudes, and
//! wrong ones 0.49 and more. Omega along the body's axes and an attitude that is multiplied on the wrong side leave the
//! same: only what drives the body tells them apart.

use super::spellings::Frame;
use crate::math::turned;
use nalgebra::{Quaternion, Vector3};
use std::f64::consts::PI;
use std::fmt;

/// A residual up to here is that of data that belong together.
const BELONGS: f64 = 0.02;
/// What is said to fit instead leaves at most this, and this part of what the data leave as they are.
const FITS: f64 = 0.1;
const BETTER: f64 = 0.3;
/// Beyond this angle from row to row an increment may be any of several, rad.
const ALIASED: f64 = 1.6;
/// Windows for an answer.
const FEWEST_WINDOWS: usize = 3;

/// Where x, y, z, w are among the numbers that were read as x, y, z, w.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Order {
    #[default]
    AsRead,
    /// What was read as x, y, z, w is w, x, y, z.
    ScalarFirst,
    /// What was read as w, x, y, z is x, y, z, w.
    ScalarLast,
}

impl Order {
    const ALL: [Self; 3] = [Self::AsRead, Self::ScalarFirst, Self::ScalarLast];

    pub fn of<T>(self, [a, b, c, d]: [T; 4]) -> [T; 4] {
        match self {
            Self::AsRead => [a, b, c, d],
            Self::ScalarFirst => [b, c, d, a],
            Self::ScalarLast => [d, a, b, c],
        }
    }
}

/// A factor to what was read, and what it means.
#[derive(Debug, PartialEq)]
pub struct Factor {
    pub factor: f64,
    pub about: &'static str,
}

/// Of angular velocities.
static OMEGA_FACTORS: [Factor; 5] = [
    Factor {
        factor: 1.0,
        about: "",
    },
    Factor {
        factor: PI / 180.0,
        about: "angular velocities are in degrees, not radians",
    },
    Factor {
        factor: 180.0 / PI,
        about: "angular velocities are in radians, not degrees",
    },
    Factor {
        factor: 2.0 * PI,
        about: "angular velocities are in turns a second, not radians",
    },
    Factor {
        factor: PI / 30.0,
        about: "angular velocities are in turns a minute, not radians a second",
    },
];

/// Of times.
static TIME_FACTORS: [Factor; 4] = [
    Factor {
        factor: 1.0,
        about: "",
    },
    Factor {
        factor: 1e-3,
        about: "times are a thousand times too large (ms for s)",
    },
    Factor {
        factor: 1e-6,
        about: "times are a million times too large (us for s)",
    },
    Factor {
        factor: 1e-9,
        about: "times are a thousand million times too large (ns for s)",
    },
];

/// What the numbers of a log mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conventions {
    pub order: Order,
    /// Attitudes are from world to body.
    pub conjugated: bool,
    /// The axes of angular velocities.
    pub frame: Frame,
    pub omega: &'static Factor,
    pub time: &'static Factor,
}

impl Conventions {
    /// As a log is declared.
    pub fn declared(frame: Frame, conjugated: bool) -> Self {
        Self {
            order: Order::AsRead,
            conjugated,
            frame,
            omega: &OMEGA_FACTORS[0],
            time: &TIME_FACTORS[0],
        }
    }

    fn every() -> impl Iterator<Item = Self> {
        let frames = [Frame::World, Frame::Body];
        Order::ALL.into_iter().flat_map(move |order| {
            [false, true].into_iter().flat_map(move |conjugated| {
                frames.into_iter().map(move |frame| Self {
                    order,
                    ..Self::declared(frame, conjugated)
                })
            })
        })
    }

    /// An attitude as it was read, as (x, y, z, w), body to world.
    pub fn attitude(&self, read: [f64; 4]) -> [f64; 4] {
        let [x, y, z, w] = self.order.of(read);
        match self.conjugated {
            true => [-x, -y, -z, w],
            false => [x, y, z, w],
        }
    }

    /// In how many respects it is another.
    fn changes(&self, other: &Self) -> usize {
        usize::from(self.order != other.order)
            + usize::from(self.conjugated != other.conjugated)
            + usize::from(self.frame != other.frame)
            + usize::from(self.omega != other.omega)
            + usize::from(self.time != other.time)
    }

    /// What about it is not as declared, in words.
    pub fn told(&self, declared: &Self) -> String {
        let mut said = Vec::new();
        match self.order {
            order if order == declared.order => {}
            Order::ScalarFirst => {
                said.push("the attitude's numbers are w, x, y, z where x, y, z, w was read");
            }
            _ => said.push("the attitude's numbers are x, y, z, w where w, x, y, z was read"),
        }
        if self.conjugated != declared.conjugated {
            said.push(match self.conjugated {
                true => "attitudes are from world to body",
                false => "attitudes are from body to world",
            });
        }
        if self.frame != declared.frame {
            said.push(match self.frame {
                Frame::Body => {
                    "angular velocities are along the body's axes (or the engine multiplies its quaternion on the wrong side)"
                }
                Frame::World => "angular velocities are along the world's axes",
            });
        }
        said.extend(
            [self.omega.about, self.time.about]
                .iter()
                .filter(|s| !s.is_empty()),
        );
        match said.is_empty() {
            true => "everything is as declared".to_owned(),
            false => said.join(", and "),
        }
    }
}

/// Rows of one body with what their numbers are said to mean.
#[derive(Clone, Debug)]
pub struct Kinematics {
    /// s.
    pub times: Vec<f64>,
    /// As read, in the order x, y, z, w; of any length.
    pub attitudes: Vec<[f64; 4]>,
    /// As read, rad/s.
    pub omegas: Vec<[f64; 3]>,
    pub declared: Conventions,
}

/// Conventions and how well they fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    pub conventions: Conventions,
    pub residual: f64,
}

/// What a search came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    pub declared: Fit,
    pub best: Fit,
    /// All that fit as well, the best first, or the declared one where it is among them; nothing where none fits.
    pub fitting: Vec<Fit>,
    /// The best of those that do not fit: how far behind it is says how sure the answer is.
    pub next: Option<Fit>,
}

/// What a search came to, in a word.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// They belong together as declared.
    AsDeclared,
    /// They would, by these alone.
    LooksLike(Conventions),
    /// They would, by any of several.
    OneOfSeveral,
    /// They do not, by any that was tried.
    NoneFits,
}

impl Found {
    pub fn verdict(&self) -> Verdict {
        match self.fitting[..] {
            [] => Verdict::NoneFits,
            [first, ..] if first.conventions == self.declared.conventions => Verdict::AsDeclared,
            [only] => Verdict::LooksLike(only.conventions),
            _ => Verdict::OneOfSeveral,
        }
    }
}

/// `… (0.003 of what there is to explain is left, against 1.4 as declared; the next best leaves 0.8)`
impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let declared = &self.declared.conventions;
        match self.verdict() {
            Verdict::AsDeclared => write!(
                f,
                "attitudes and angular velocities belong together as declared (residual {:.1e}",
                self.declared.residual
            )?,
            Verdict::LooksLike(found) => write!(
                f,
                "attitudes and angular velocities do not belong together as declared; they look as if {} (residual {:.1e} instead of {:.2}",
                found.told(declared),
                self.best.residual,
                self.declared.residual
            )?,
            Verdict::OneOfSeveral => {
                let told = |fit: &Fit| fit.conventions.told(declared);
                let told: Vec<String> = self.fitting.iter().map(told).collect();
                write!(
                    f,
                    "attitudes and angular velocities do not belong together as declared; they look as if {} (residual {:.1e} instead of {:.2}",
                    told.join("; or "),
                    self.best.residual,
                    self.declared.residual
                )?;
            }
            Verdict::NoneFits => write!(
                f,
                "attitudes and angular velocities do not belong together, by any order, axes or units that were tried (residual {:.2}, the best other {:.2}",
                self.declared.residual, self.best.residual
            )?,
        }
        if let Some(next) = self.next.filter(|_| !self.fitting.is_empty()) {
            write!(f, ", next best {:.2}", next.residual)?;
        }
        write!(f, ")")
    }
}

/// Why rows say nothing of their conventions.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CannotTell {
    #[error("there are {0} rows with both attitude and angular velocity, and {least} are needed", least = FEWEST_ROWS)]
    TooFew(usize),
    #[error("the body hardly turns")]
    NoTurn,
    #[error(
        "angular velocities are zero while the body turns; log them, or derive them from the attitudes"
    )]
    NoOmega,
    #[error(
        "the body turns {0:.1} rad from row to row: increments may be any of several; log more often"
    )]
    Aliased(f64),
}

/// Rows that make windows enough.
const FEWEST_ROWS: usize = 1 + NARROWEST + (FEWEST_WINDOWS - 1) * NARROWEST / 2;
const NARROWEST: usize = 12;
const WIDEST: usize = 256;

/// Tries all conventions on the rows of one body.
pub fn search(rows: &Kinematics) -> Result<Found, CannotTell> {
    let usable = rows
        .times
        .len()
        .min(rows.attitudes.len())
        .min(rows.omegas.len());
    if usable < FEWEST_ROWS {
        return Err(CannotTell::TooFew(usable));
    }
    let turns: Vec<f64> = rows.attitudes[..usable]
        .windows(2)
        .map(|pair| turn(pair[0], pair[1]))
        .collect();
    let median = median(&turns);
    if median > ALIASED {
        return Err(CannotTell::Aliased(median));
    }
    let turned: f64 = turns.iter().sum();
    // A thousandth of a radian in all is what rounding to f32 may make of rest.
    if turned.is_nan() || turned <= 1e-3 {
        return Err(CannotTell::NoTurn);
    }
    if rows.omegas[..usable].iter().flatten().all(|x| *x == 0.0) {
        return Err(CannotTell::NoOmega);
    }
    let widest = WIDEST.min((usable - 1) * 2 / (FEWEST_WINDOWS + 1));
    let width = ((turns.len() as f64 / turned) as usize).clamp(NARROWEST, widest.max(NARROWEST));
    let windows = Windows::new(rows, &turns, width);
    if windows.starts.len() < FEWEST_WINDOWS {
        return Err(CannotTell::TooFew(usable));
    }
    let mut fits = Vec::new();
    for conventions in Conventions::every() {
        for a in [1.0, 0.5, 0.0] {
            let sums = windows.sums(rows, &conventions, a);
            for time in &TIME_FACTORS {
                for omega in &OMEGA_FACTORS {
                    let conventions = Conventions {
                        omega,
                        time,
                        ..conventions
                    };
                    let residual = sums.residual(omega.factor * time.factor);
                    fits.push(Fit {
                        conventions,
                        residual,
                    });
                }
            }
        }
    }
    Ok(judged(fits, rows.declared))
}

/// The best of each convention, and which of them fit.
fn judged(mut fits: Vec<Fit>, declared: Conventions) -> Found {
    fits.sort_by(|a, b| a.residual.total_cmp(&b.residual));
    let mut each: Vec<Fit> = Vec::new();
    for fit in fits {
        if !each
            .iter()
            .any(|known| known.conventions == fit.conventions)
        {
            each.push(fit);
        }
    }
    let best = each[0];
    let as_declared = each
        .iter()
        .find(|fit| fit.conventions == declared)
        .copied()
        .unwrap_or(best);
    // Noise is in all of them: what fits as well as the best leaves about as much.
    let bound = BELONGS.max(3.0 * best.residual);
    let fits = |fit: &&Fit| fit.residual <= bound;
    let mut fitting: Vec<Fit> = match best.residual <= FITS {
        true => each.iter().filter(fits).copied().collect(),
        false => Vec::new(),
    };
    if as_declared.residual > bound && best.residual > BETTER * as_declared.residual {
        fitting.clear();
    }
    // As declared before all others, then by what has to change.
    fitting.sort_by_key(|fit| fit.conventions.changes(&declared));
    let next = each.iter().find(|fit| !fitting.contains(fit));
    Found {
        declared: as_declared,
        best,
        next: next.copied(),
        fitting,
    }
}

/// Hann windows over the increments of a log, half overlapping.
struct Windows {
    /// The first increment of each.
    starts: Vec<usize>,
    weights: Vec<f64>,
}

/// `Σ δ̄·δ̄`, `Σ δ̄·v̄` and `Σ v̄·v̄` over windows.
struct Sums {
    dd: f64,
    dv: f64,
    vv: f64,
}

impl Windows {
    fn new(rows: &Kinematics, turns: &[f64], width: usize) -> Self {
        let weight = |k: usize| {
            let s = libm::sin(PI * (k as f64 + 0.5) / width as f64);
            // Σ sin² over the window is half of its width.
            2.0 * s * s / width as f64
        };
        let is_whole = |&start: &usize| {
            let turns = &turns[start..start + width];
            let times = &rows.times[start..=start + width];
            turns.iter().all(|turn| *turn <= ALIASED) && times.windows(2).all(|t| t[1] > t[0])
        };
        Self {
            starts: (0..=turns.len() - width)
                .step_by(width / 2)
                .filter(is_whole)
                .collect(),
            weights: (0..width).map(weight).collect(),
        }
    }

    fn sums(&self, rows: &Kinematics, conventions: &Conventions, a: f64) -> Sums {
        let attitude = |k: usize| {
            let [x, y, z, w] = conventions.attitude(rows.attitudes[k]);
            Quaternion::new(w, x, y, z).normalize()
        };
        let omega = |k: usize, q: Quaternion<f64>| {
            let omega = Vector3::from(rows.omegas[k]);
            match conventions.frame {
                Frame::World => omega,
                Frame::Body => turned(q, omega),
            }
        };
        let mut sums = Sums {
            dd: 0.0,
            dv: 0.0,
            vv: 0.0,
        };
        for &start in &self.starts {
            let (mut d, mut v) = (Vector3::zeros(), Vector3::zeros());
            for (k, weight) in (start..).zip(&self.weights) {
                let (from, to) = (attitude(k), attitude(k + 1));
                let h = rows.times[k + 1] - rows.times[k];
                d += logarithm(to * from.conjugate()) * (weight / h);
                v += (omega(k, from) * a + omega(k + 1, to) * (1.0 - a)) * *weight;
            }
            sums.dd += d.norm_squared();
            sums.dv += d.dot(&v);
            sums.vv += v.norm_squared();
        }
        sums
    }
}

impl Sums {
    /// `|δ̄ - s v̄|` of the larger of both.
    fn residual(&self, s: f64) -> f64 {
        let left = self.dd - 2.0 * s * self.dv + s * s * self.vv;
        let whole = self.dd.max(s * s * self.vv);
        let residual = (left.max(0.0) / whole).sqrt();
        match residual.is_finite() {
            true => residual,
            false => f64::INFINITY,
        }
    }
}

/// The rotation vector of a quaternion, rad, by the shorter way: `2 atan2(|u|, w) u/|u|`.
fn logarithm(q: Quaternion<f64>) -> Vector3<f64> {
    let q = if q.w < 0.0 { -q } else { q };
    let u = q.imag();
    let length = u.norm();
    match length > 0.0 {
        true => u * (2.0 * libm::atan2(length, q.w) / length),
        false => Vector3::zeros(),
    }
}

/// The angle between two attitudes, rad, whatever the order of their numbers.
fn turn(a: [f64; 4], b: [f64; 4]) -> f64 {
    let dot: f64 = a.iter().zip(b).map(|(x, y)| x * y).sum();
    let (aa, bb): (f64, f64) = (a.iter().map(|x| x * x).sum(), b.iter().map(|x| x * x).sum());
    let across = (aa * bb - dot * dot).max(0.0).sqrt();
    2.0 * libm::atan2(across, dot.abs())
}

fn median(numbers: &[f64]) -> f64 {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}
