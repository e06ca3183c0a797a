//! Which law do the logged steps obey? All laws of [`super::CAUSES`] compete with the right one; where none fits, what can be fitted
//! (a scale, another inertia, damping, a clamp); where nothing fits everywhere, the windows that nothing explains are left out.
//!
//! A cause is accused where it leaves what noise or a method's own error leaves, and the right law leaves much more.

use super::case::Case;
use super::causes::{CAUSES, Judge};
use super::energy::{self, Drift};
use super::law::{Fit, Gyroscopic, Law, Lever, Life, Predicted, Smoothed, Steps, fit, rms};
use super::motion::Motion;
use super::verdict::{Evidence, Found, LeftOut, RunnerUp};
use nalgebra::{Matrix3, Vector3};

pub struct Dynamics<'a> {
    pub case: &'a Case<'a>,
    pub motion: &'a Motion,
    pub steps: Steps,
    pub inertia: Matrix3<f64>,
    pub mass: Option<f64>,
    /// The windows that count.
    pub kept: Vec<bool>,
    /// What acts about the centre of mass, world; the right way, and as other levers and lives have it.
    tau_w: Vec<Vector3<f64>>,
    centres: Option<Vec<Vector3<f64>>>,
}

/// An explanation of the windows.
pub struct Explained {
    /// The likeliest first.
    pub causes: Vec<&'static str>,
    pub fit: Fit,
    pub evidence: Vec<Evidence>,
    /// In how many ways the engine would be wrong.
    pub faults: usize,
}

impl Explained {
    pub fn new(cause: &'static str, fit: Fit) -> Self {
        Self {
            causes: vec![cause],
            fit,
            evidence: Vec::new(),
            faults: 1,
        }
    }

    /// Besides, the gyroscopic term is left out.
    pub fn faults(self, faults: usize) -> Self {
        Self { faults, ..self }
    }

    pub fn with(mut self, name: &'static str, value: f64, unit: &'static str) -> Self {
        self.evidence.push(Evidence { name, value, unit });
        self
    }
}

/// What the dynamics say.
pub enum Outcome {
    Fault(Found),
    /// The right law holds, and enough was to be seen.
    Fine {
        evidence: Vec<Evidence>,
        drift: Option<Drift>,
    },
    CannotTell(String, String),
}

/// How the right law holds, if it does.
struct Right {
    fit: Fit,
    /// κ, or λ where that fits better; its error.
    stage: (f64, f64),
    restored: bool,
}

/// What can be seen at all.
pub struct Visible {
    pub gyroscopic: bool,
    pub torque: bool,
}

impl<'a> Dynamics<'a> {
    fn new(
        case: &'a Case<'a>,
        m: &'a Motion,
        length: Option<usize>,
    ) -> Result<Self, (String, String)> {
        let no = |why: &str, remedy: &str| (why.to_owned(), remedy.to_owned());
        let Some(inertia) = case.inertia() else {
            return Err(no(
                "no inertia is declared, and without it no law can be tested",
                "declare the body's mass and inertia in a bodies file",
            ));
        };
        let rows = case.rows();
        let n = rows.len();
        let centres = case.centres(m);
        let forces = rows.forces.len() == n;
        let known = forces && rows.points.len() == n && centres.is_some();
        // Where a force acts and its lever is not known, the torque is not either.
        let finite =
            |of: &[[f64; 3]], k: usize| of.get(k).is_none_or(|v| v.iter().all(|x| x.is_finite()));
        let keep = |k: usize| {
            finite(&rows.torques, k)
                && finite(&rows.forces, k)
                && (!forces
                    || rows.forces[k] == [0.0; 3]
                    || (known && finite(&rows.points, k) && finite(&rows.positions, k)))
        };
        let steps = match length {
            Some(length) => Steps::of_length(m, length, keep),
            None => Steps::new(m, keep),
        };
        let Some(steps) = steps else {
            return Err(no(
                "too few rows in a row can be used",
                "record at least a few dozen steps, and where the body is if forces act on it",
            ));
        };
        let kept = vec![true; steps.windows.len()];
        let mut d = Self {
            case,
            motion: m,
            steps,
            inertia,
            mass: case.mass(),
            kept,
            tau_w: Vec::new(),
            centres,
        };
        d.tau_w = d
            .tau(Lever::Centre, Life::Step)
            .unwrap_or_else(|| vec![Vector3::zeros(); n]);
        Ok(d)
    }

    /// The same in windows of another length.
    pub fn in_windows_of(&self, length: usize) -> Option<Self> {
        Self::new(self.case, self.motion, Some(length)).ok()
    }

    /// What acts in each step, as levers and lives have it. None where that is no different, or not known.
    fn tau(&self, lever: Lever, life: Life) -> Option<Vec<Vector3<f64>>> {
        let rows = self.case.rows();
        let n = rows.len();
        let vector = |v: &[f64; 3]| {
            let v = Vector3::from(*v);
            if v.iter().all(|x| x.is_finite()) {
                v
            } else {
                Vector3::zeros()
            }
        };
        let torques = rows.torques.len() == n;
        let forces = rows.forces.len() == n && rows.points.len() == n;
        let mut tau: Vec<Vector3<f64>> = if torques {
            rows.torques.iter().map(vector).collect()
        } else {
            vec![Vector3::zeros(); n]
        };
        if forces && let Some(centres) = &self.centres {
            for k in 0..n {
                let from = match lever {
                    Lever::Centre => centres[k],
                    Lever::FirstCentre => centres[0],
                    Lever::WorldOrigin => Vector3::zeros(),
                    Lever::BodyOrigin => Vector3::from(rows.positions[k]),
                };
                let arm = vector(&rows.points[k]) - from;
                let acts = arm.cross(&vector(&rows.forces[k]));
                if acts.iter().all(|x| x.is_finite()) {
                    tau[k] += acts;
                }
            }
        } else if lever != Lever::Centre {
            return None;
        }
        if life != Life::Step && tau.iter().all(|t| *t == Vector3::zeros()) {
            return None;
        }
        let zero = Vector3::zeros();
        match life {
            Life::Step => {}
            Life::Ever => {
                let mut sum = zero;
                for t in &mut tau {
                    sum += *t;
                    *t = sum;
                }
            }
            Life::TwoSteps => {
                let mut before = zero;
                for t in &mut tau {
                    (before, *t) = (*t, *t + before);
                }
            }
            Life::UntilNext => {
                let mut last = zero;
                for t in &mut tau {
                    if *t == zero {
                        *t = last;
                    } else {
                        last = *t;
                    }
                }
            }
        }
        Some(tau)
    }

    fn predicted(&self, law: Law) -> Option<Predicted> {
        if law.lever == Lever::Centre && law.life == Life::Step {
            return self.steps.predict(law, &self.inertia, &self.tau_w);
        }
        self.steps
            .predict(law, &self.inertia, &self.tau(law.lever, law.life)?)
    }

    /// Σφ α of a law half way, of the torque or without any.
    pub fn predict(&self, law: Law, without_torque: bool) -> Option<Smoothed> {
        if without_torque {
            let none = vec![Vector3::zeros(); self.motion.len()];
            return self.steps.predict(law, &self.inertia, &none).map(|p| p.mid);
        }
        self.predicted(law).map(|p| p.mid)
    }

    /// The same at five stages, from implicit to explicit.
    pub fn staged(&self, law: Law) -> Vec<Smoothed> {
        let Some(p) = self.predicted(law) else {
            return Vec::new();
        };
        [0.0, 0.5, -0.5, 0.25, -0.25]
            .iter()
            .map(|k| {
                p.mid
                    .iter()
                    .zip(&p.stage)
                    .map(|(m, s)| m + s * *k)
                    .collect()
            })
            .collect()
    }

    /// A law with the stage at which its method takes it.
    pub fn fit(&self, law: Law) -> Option<Fit> {
        let p = self.predicted(law)?;
        let plain = fit(&self.steps.measured, &p.mid, None, &self.kept);
        let staged = fit(
            &self.steps.measured,
            &p.mid,
            Some((&p.stage, STAGES)),
            &self.kept,
        );
        Some(if staged.coefficient.abs() > 3.0 * staged.error {
            staged
        } else {
            plain
        })
    }

    /// Σφ I⁻¹ τ; None where nothing acts.
    pub fn torque_alone(&self) -> Option<Smoothed> {
        let p = self.predict(Law::RIGHT.gyroscopic(Gyroscopic::Off), false)?;
        (rms(&p, &self.kept) > 0.0).then_some(p)
    }

    pub fn nothing(&self) -> Smoothed {
        vec![Vector3::zeros(); self.steps.windows.len()]
    }

    pub fn tau_b(&self) -> Smoothed {
        self.steps.tau_b(&self.tau_w)
    }

    /// The part of the force by which the body is accelerated, and its error: where positions tell.
    pub fn linear_part(&self) -> Option<(f64, f64)> {
        self.case.centre()?.part
    }

    /// rms of noise in a window, rad/s².
    pub fn noise(&self) -> f64 {
        self.steps.noise * 3.0_f64.sqrt()
    }

    /// Whether a law holds; one whose numbers end does not.
    pub fn holds(&self, fit: &Fit) -> bool {
        fit.left.is_finite() && fit.left <= self.bound(fit)
    }

    /// Up to which error a law holds.
    pub fn bound(&self, fit: &Fit) -> f64 {
        let (turn, speed) = (self.motion.turn, self.motion.speed);
        // Where a law says that nothing changes, rounding is all there is.
        let rounding = 1e-7 * speed * speed;
        if self.steps.noisy {
            1.6 * self.noise() + 0.01 * fit.scale
        } else {
            // Derived rates are those of half a step later or earlier, by the method.
            let derived = if self.motion.derived { 0.02 } else { 0.0 };
            // A right engine leaves 0.001; half way is second order in the turn of a step.
            (0.003 + derived + 0.1 * turn * turn) * fit.scale + 1.6 * self.noise() + rounding
        }
    }

    fn right(&self) -> Option<Right> {
        let p = self.predicted(Law::RIGHT)?;
        let plain = fit(&self.steps.measured, &p.mid, None, &self.kept);
        let staged = fit(
            &self.steps.measured,
            &p.mid,
            Some((&p.stage, STAGES)),
            &self.kept,
        );
        let feature = self.steps.restored(&self.inertia, &self.tau_w);
        let restored = fit(
            &self.steps.measured,
            &p.mid,
            Some((&feature, [0.0, 1.1])),
            &self.kept,
        );
        let significant =
            |f: &Fit| f.coefficient.abs() > 4.0 * 1.5 * f.error && f.left < 0.98 * plain.left;
        if significant(&restored) && restored.left < 0.9 * staged.left {
            return Some(Right {
                stage: (restored.coefficient, restored.error),
                fit: restored,
                restored: true,
            });
        }
        let stage = (staged.coefficient, staged.error);
        Some(Right {
            fit: if significant(&staged) { staged } else { plain },
            stage,
            restored: false,
        })
    }

    pub fn visible(&self) -> Visible {
        let seen = |of: Option<Smoothed>| {
            let size = of.map_or(0.0, |p| rms(&p, &self.kept));
            let speed = self.motion.speed;
            size > 5.0 * self.noise() && size > 1e-3 * speed * speed && size > 0.0
        };
        Visible {
            gyroscopic: seen(self.predict(Law::RIGHT, true)),
            torque: seen(self.torque_alone()),
        }
    }

    /// Every other explanation: what leaves least first.
    fn others(&self) -> Vec<Explained> {
        let mut all = Vec::new();
        for cause in CAUSES {
            match cause.judge {
                Judge::Laws(laws) => {
                    let laws = laws.iter().flat_map(|law| with_and_without(*law));
                    all.extend(laws.filter_map(|law| {
                        let fit = self.fit(law).filter(|f| f.left.is_finite())?;
                        Some(Explained::new(cause.id, fit).faults(law.faults()))
                    }));
                }
                Judge::Fitted(judge) => all.extend(judge(self).filter(|e| e.fit.left.is_finite())),
                _ => {}
            }
        }
        all.sort_by(|a, b| a.fit.left.total_cmp(&b.fit.left));
        all
    }
}

/// An engine that is wrong in one way may leave the gyroscopic term out besides.
fn with_and_without(law: Law) -> impl Iterator<Item = Law> {
    let besides = law.gyroscopic(Gyroscopic::Off);
    let is_on = law.gyroscopic == Gyroscopic::On;
    std::iter::once(law).chain(is_on.then_some(besides))
}

/// Explicit is ½, implicit -½; a little more for what is fitted.
const STAGES: [f64; 2] = [-0.55, 0.55];

pub struct Judged {
    pub outcome: Outcome,
    pub left_out: Vec<LeftOut>,
    pub untested: Vec<String>,
}

pub fn judge(case: &Case, m: &Motion) -> Judged {
    let mut judged = Judged {
        outcome: Outcome::CannotTell(String::new(), String::new()),
        left_out: Vec::new(),
        untested: Vec::new(),
    };
    let mut d = match Dynamics::new(case, m, None) {
        Ok(d) => d,
        Err((why, remedy)) => {
            judged.outcome = Outcome::CannotTell(why, remedy);
            return judged;
        }
    };
    if m.turn > 0.5 {
        judged.untested.push(format!(
            "the body turns by {:.2} rad from row to row: the midpoint is a coarse one",
            m.turn
        ));
    }
    if let Some(outcome) = round(&d, &mut judged.untested) {
        judged.outcome = outcome;
        return judged;
    }
    // Windows that neither the right law nor any other explains are left out.
    let whole = d.kept.len();
    if let Some(kept) = explained(&d) {
        let n = kept.iter().filter(|k| **k).count();
        if n < whole && n >= 5 && 10 * n >= 4 * whole {
            d.kept = kept;
            if braked_at_the_top(&d) {
                judged.left_out = left_out(&d);
                judged.outcome = Outcome::CannotTell(
                    "Euler's equation holds but where |ω| is largest; there something brakes the body: a limit of the speed \
                     (speed-clamp), or a brake that was not logged"
                        .to_owned(),
                    "log every torque, and drive the body up for longer: a limit shows as a plateau of |ω|".to_owned(),
                );
                return judged;
            }
            let right_holds = d.right().is_some_and(|r| d.holds(&r.fit));
            if right_holds && let Some(outcome) = round(&d, &mut judged.untested) {
                judged.left_out = left_out(&d);
                judged.outcome = outcome;
                return judged;
            }
        }
    }
    let left = d.right().map_or(0.0, |r| r.fit.left);
    if let Some(far) = case.turns_elsewhere() {
        judged.outcome = Outcome::CannotTell(
            format!(
                "the body turns about a point {far:.3e} m from its declared centre of mass (a joint, or another centre of mass), and \
                 Euler's equation about the declared one leaves {left:.3e} rad/s² (rms)"
            ),
            "declare where the centre of mass is, log the joint's force and torque, or record a free flight".to_owned(),
        );
        return judged;
    }
    judged.outcome = Outcome::CannotTell(
        format!(
            "Euler's equation leaves {left:.3e} rad/s² (rms) with what was logged, and no cause that is known explains it: most \
             likely a torque acts that was not logged (contact, joint, drag, a motor)"
        ),
        "log every torque and force, or record a free flight".to_owned(),
    );
    judged
}

/// The windows that the right law explains.
fn explained(d: &Dynamics) -> Option<Vec<bool>> {
    let right = d.predicted(Law::RIGHT)?;
    let plain = fit(&d.steps.measured, &right.mid, None, &d.kept);
    // What is typical of the better half, so that what is left out does not set the scale.
    let mut sizes: Vec<f64> = d.steps.measured.iter().map(Vector3::norm).collect();
    let scale = super::motion::median(&mut sizes);
    let limit = if d.steps.noisy {
        2.5 * d.noise() + 0.02 * scale
    } else {
        (0.01 + 0.2 * d.motion.turn) * scale + 2.5 * d.noise()
    };
    Some(plain.each.iter().map(|e| e.sqrt() <= limit).collect())
}

/// Whether most windows that are left out lie where the body is fastest, with the error against ω.
fn braked_at_the_top(d: &Dynamics) -> bool {
    let Some(right) = d.predict(Law::RIGHT, false) else {
        return false;
    };
    let omega = d.steps.of_omega(|w| *w);
    let speed = d.steps.of_omega(|w| Vector3::new(w.norm(), 0.0, 0.0));
    let top = speed.iter().map(|s| s.x).fold(0.0, f64::max);
    let (mut out, mut braked) = (0, 0);
    for w in (0..d.kept.len()).filter(|&w| !d.kept[w]) {
        let left = d.steps.measured[w] - right[w];
        let against = -left.dot(&omega[w]) > 0.8 * left.norm() * omega[w].norm();
        out += 1;
        braked += usize::from(against && speed[w].x > 0.94 * top);
    }
    3 * braked > 2 * out
}

fn left_out(d: &Dynamics) -> Vec<LeftOut> {
    let mut all: Vec<LeftOut> = Vec::new();
    for w in (0..d.kept.len()).filter(|&w| !d.kept[w]) {
        let (from, until) = d.steps.rows(w);
        let (from, until) = (d.motion.times[from], d.motion.times[until]);
        match all.last_mut() {
            Some(last) if last.until >= from => last.until = until,
            _ => all.push(LeftOut {
                from,
                until,
                why: "no law holds there: contact, a joint, or a torque that was not logged",
            }),
        }
    }
    all
}

/// None where nothing explains the windows.
fn round(d: &Dynamics, untested: &mut Vec<String>) -> Option<Outcome> {
    let right = d.right()?;
    if d.holds(&right.fit) {
        return Some(held(d, &right, untested));
    }
    let others = d.others();
    let best = others.first()?;
    let fits = best.fit.left <= 2.0 * d.bound(&best.fit);
    let times = right.fit.left / best.fit.left.max(1e-9 * right.fit.scale);
    if !fits || !far_behind(d, &right.fit, &best.fit) {
        return None;
    }
    Some(Outcome::Fault(found(d, &right, &others, times)))
}

/// Whether one explanation is so much worse than another that it is none: by a factor, or, where noise hides that, by what windows say.
fn far_behind(d: &Dynamics, worse: &Fit, better: &Fit) -> bool {
    let ratio = worse.left / better.left.max(1e-300);
    if ratio >= if d.steps.noisy { 2.5 } else { 4.0 } {
        return true;
    }
    let (mut sum, mut squares, mut n) = (0.0, 0.0, 0.0);
    for w in (0..d.kept.len()).filter(|&w| d.kept[w]) {
        let more = worse.each[w] - better.each[w];
        sum += more;
        squares += more * more;
        n += 1.0;
    }
    let mean: f64 = sum / n;
    let error = ((squares / n - mean * mean).max(0.0) / n).sqrt() * 1.5;
    d.steps.noisy && ratio > 1.15 && mean > 6.0 * error
}

fn found(d: &Dynamics, right: &Right, others: &[Explained], times: f64) -> Found {
    // A plainer explanation may leave a little more: what has numbers of its own to fit takes up a method's error besides.
    let floor = 1e-5 * others[0].fit.scale;
    let plain = |e: &&Explained| {
        e.fit.left + floor < 3.0 * (others[0].fit.left + floor)
            && e.fit.left <= 2.0 * d.bound(&e.fit)
    };
    let faults = (others.iter().filter(plain).map(|e| e.faults).min()).unwrap_or(others[0].faults);
    let best = (others.iter().find(|e| e.faults == faults)).unwrap_or(&others[0]);
    // As good as that one, as far as these data tell.
    let alike = |e: &&Explained| {
        let ratio = (e.fit.left + floor) / (best.fit.left + floor);
        e.faults == faults && ratio < if d.steps.noisy { 1.1 } else { 1.5 }
    };
    let mut causes = best.causes.clone();
    for cause in others.iter().filter(alike).flat_map(|e| &e.causes) {
        if !causes.contains(cause) {
            causes.push(cause);
        }
    }
    let second =
        (others.iter()).find(|e| !causes.contains(&e.causes[0]) && e.fit.left > best.fit.left);
    let (name, left) = match second {
        Some(s) if s.fit.left < right.fit.left => (s.causes[0], s.fit.left),
        _ => ("as-declared", right.fit.left),
    };
    let behind = (left + floor) / (best.fit.left + floor);
    let mut found = Found::of(
        causes[0],
        format!(
            "Euler's equation as declared leaves {:.2e} rad/s² (rms, of {:.2e}); this leaves {:.2e}",
            right.fit.left, right.fit.scale, best.fit.left
        ),
    )
    .sure(((1.0 - 1.0 / behind.max(1.0)) / causes.len() as f64).clamp(0.0, 0.999))
    .with("left_as_declared", right.fit.residual, "")
    .with("left", best.fit.residual, "")
    .with("times_better", times, "");
    found.causes = causes;
    found.evidence.extend(best.evidence.iter().cloned());
    found.evidence.extend(coefficient(d));
    found.runner_up = Some(RunnerUp {
        cause: name,
        behind,
    });
    found
}

/// ρ of the gyroscopic term.
fn coefficient(d: &Dynamics) -> Option<Evidence> {
    let turning = d.predict(Law::RIGHT, true)?;
    if !d.visible().gyroscopic {
        return None;
    }
    let torque = d.predict(Law::RIGHT.gyroscopic(Gyroscopic::Off), false)?;
    let rho = fit(
        &d.steps.measured,
        &torque,
        Some((&turning, [-1e3, 1e3])),
        &d.kept,
    );
    Some(Evidence {
        name: "gyroscopic_coefficient",
        value: rho.coefficient,
        unit: "",
    })
}

/// The right law holds: does energy go astray, and was enough to be seen?
fn held(d: &Dynamics, right: &Right, untested: &mut Vec<String>) -> Outcome {
    let all_kept = d.kept.iter().all(|k| *k);
    let drift = if all_kept {
        energy::drift(d.motion, &d.inertia, &d.tau_w)
    } else {
        None
    };
    let seen = d.visible();
    if let Some(drift) = drift
        && drift.part.abs() > 0.005
        && drift.part.abs() > 5.0 * drift.error
        // Noise and the midpoint take the work wrong by parts in a thousand.
        && drift.part.abs() > if d.steps.noisy { 0.01 } else { 0.002 } * drift.flow
        && !d.motion.derived
    {
        if let Some(found) = astray(d, right, &drift) {
            return Outcome::Fault(found);
        }
        untested.push(format!(
            "E less the work of the torques goes off by {:.2}%, by which method is not to be seen",
            100.0 * drift.part
        ));
    }
    let mut evidence = vec![Evidence {
        name: "left",
        value: right.fit.residual,
        unit: "",
    }];
    evidence.extend(coefficient(d));
    if right.stage.0.abs() > 4.0 * right.stage.1 && !d.steps.noisy {
        let name = if right.restored {
            "restored_stage"
        } else {
            "stage"
        };
        evidence.push(Evidence {
            name,
            value: right.stage.0,
            unit: "",
        });
    }
    if !seen.gyroscopic {
        let acts = if seen.torque {
            "the torques act as they should, but "
        } else {
            ""
        };
        return Outcome::CannotTell(
            format!("{acts}the gyroscopic term is nothing here: the moments are equal, or the spin is about a principal axis, or it is slow"),
            "give the body unequal moments, tilt it, and spin it off its axes, by some radians per second".to_owned(),
        );
    }
    if d.motion.turn > 0.5 && (right.stage.0.abs() > 0.1 || right.fit.residual > 0.03) {
        return Outcome::CannotTell(
            format!(
                "the body turns by {:.2} rad from row to row, and what is left of Euler's equation may be its step's",
                d.motion.turn
            ),
            "take, and log, smaller steps: below 0.3 rad a row".to_owned(),
        );
    }
    if !seen.torque {
        untested.push("what torques do (frames, rotation of the inertia, its size): none was logged that can be seen".to_owned());
    }
    Outcome::Fine { evidence, drift }
}

/// Energy gained or lost: by the method, or by damping.
fn astray(d: &Dynamics, right: &Right, drift: &Drift) -> Option<Found> {
    let damped = CAUSES.iter().find_map(|c| match (c.id, &c.judge) {
        ("damping-explicit", Judge::Fitted(judge)) => judge(d),
        _ => None,
    });
    // Of clean data the stage at which the law is taken tells; of noisy ones, whether the drift is that of an Euler step or sub-steps.
    let (eta, error) = if d.steps.noisy {
        drift.eta_of_drift
    } else {
        (drift.eta, 0.0)
    };
    let like_euler = eta * drift.part > 0.0 && (0.1..=1.15 + 3.0 * error).contains(&eta.abs());
    let staged = if d.steps.noisy {
        like_euler
    } else {
        right.stage.0.abs() > 4.0 * right.stage.1
    };
    if drift.part < 0.0
        && let Some(damped) = damped
    {
        let better = damped.fit.left < right.fit.left * if d.steps.noisy { 0.995 } else { 0.7 };
        if better || !staged {
            let behind = right.fit.left / damped.fit.left.max(1e-300);
            return Some(Found {
                runner_up: Some(RunnerUp {
                    cause: "energy-lost-by-integrator",
                    behind,
                }),
                evidence: damped.evidence,
                ..Found::of(
                    damped.causes[0],
                    format!(
                        "E less the work of the torques falls by {:.2}%, and ω is damped",
                        -100.0 * drift.part
                    ),
                )
                .sure((1.0 - 1.0 / behind).clamp(0.5, 0.99))
            });
        }
    }
    if !staged {
        return None;
    }
    let (cause, way) = if drift.part > 0.0 {
        ("energy-gained-by-integrator", "rises")
    } else {
        ("energy-lost-by-integrator", "falls")
    };
    let parts = (1.0 / eta.abs()).round().max(1.0);
    let a_whole_number = (eta.abs() - 1.0 / parts).abs() < 3.0 * error + 0.05 / parts;
    let mut found =
        Found::of(
            cause,
            format!(
                "Euler's equation holds as a method of first order takes it, and E less the work of the torques {way} by {:.2}%",
                100.0 * drift.part.abs()
            ),
        )
        .sure((1.0 - 5.0 * drift.error / drift.part.abs()).clamp(0.5, 0.99))
        .with("energy_drift", drift.part, "")
        .with("energy_drift_error", drift.error, "")
        .with("energy_coefficient", eta, "");
    if d.steps.noisy {
        // A light damping would take as much, and noise hides which of the two it is.
        if drift.part < 0.0 && (!a_whole_number || parts > 4.0) {
            found.causes.push("damping-explicit");
            found.confidence *= 0.5;
        }
    } else {
        let name = if right.restored {
            "restored_stage"
        } else {
            "stage"
        };
        found = found.with(name, right.stage.0, "");
    }
    Some(found)
}
