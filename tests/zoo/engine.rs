//! An engine with a switch for each thing that can be wrong with it.
//!
//! ```text
//! α = I_w⁻¹ (τ - ω × I_w ω),  I_w = R I Rᵀ        τ = Σ torques + Σ (p - c) × f
//! ```
//!
//! and every switch changes one thing in this, in how it is stepped, or in what is written down of it.

use super::turn::*;

/// What is wrong. The names are the causes'.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    None,
    GyroscopicMissing,
    GyroscopicSign,
    GyroscopicDiagonalOnly,
    InertiaNotRotated,
    InertiaRotatedBackwards,
    InertiaNotInverted,
    TorqueInBodyFrame,
    /// The same mistake the other way: a body torque was meant, and is turned although it is in the world.
    TorqueTurnedBack,
    OmegaInBody,
    /// About which axes, in which order: angles of turns one after the other about body axes.
    EulerRates([usize; 3]),
    QuaternionOrder,
    QuaternionConjugated,
    WrongSide,
    /// The attitude turns by this many times ω h.
    Factor(f64),
    /// ω is written down times this.
    Degrees(f64),
    /// ω is written down on axes `sign · axis`.
    Axes([(f64, usize); 3]),
    CentreIgnored,
    LeverStale,
    LeverFromOrigin,
    LeverFromBodyOrigin,
    /// The engine has `I + m(d² - d dᵀ)`.
    InertiaAbout(V),
    ProductsSign,
    ProductsDropped,
    InertiaScale(f64),
    /// Forces and torques act for a part of the step.
    ForPart(f64),
    /// They are never cleared.
    NeverCleared,
    /// They are cleared a step late.
    ClearedLate,
    Damping(f64),
    Clamp(f64),
    /// Speed below which, time after which.
    Sleep(f64, f64),
    /// Positions are f32 this far from the origin.
    FarAway,
    /// Attitudes go through 16 bits.
    CoarseAttitude,
    NotNormalised,
    DoubleCover,
    /// A controller that holds an attitude by τ = -k u - c ω, u of a q whose sign flips now and then.
    LongWay,
}

/// How it is stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stepping {
    /// RK4 with this many steps a row: as good as exact.
    Fine(usize),
    /// `ω += h α(q, ω)`, then `q` by the new ω, so many steps a row.
    SemiImplicit(usize),
    /// `ω' = ω + h α(q, ω')` in body axes, iterated until it stays.
    Implicit(usize),
    /// As `SemiImplicit`, and |L| is put back to what it is without the gyroscopic term.
    Restored(usize),
}

#[derive(Clone, Debug)]
pub struct Body {
    pub mass: f64,
    pub inertia: M,
    pub centre: V,
    pub size: Option<V>,
}

/// What acts, as waves, so that directions and sizes go about.
#[derive(Clone, Debug)]
pub struct Waves {
    pub amplitude: V,
    pub frequency: V,
    pub phase: V,
    /// Acts from, until.
    pub span: (f64, f64),
    /// On for the first half of each such time; 0: always.
    pub beat: f64,
}

impl Waves {
    pub fn at(&self, t: f64) -> V {
        let off = self.beat > 0.0 && libm::fmod(t, self.beat) > 0.5 * self.beat;
        if t < self.span.0 || t >= self.span.1 || off {
            return [0.0; 3];
        }
        std::array::from_fn(|i| {
            self.amplitude[i]
                * libm::sin(std::f64::consts::TAU * self.frequency[i] * t + self.phase[i])
        })
    }
}

/// What is run.
#[derive(Clone, Debug)]
pub struct Run {
    pub fault: Fault,
    pub gyroscopic: bool,
    pub stepping: Stepping,
    pub body: Body,
    pub q: Q,
    pub omega: V,
    /// Of the centre of mass.
    pub x: V,
    pub v: V,
    pub gravity: V,
    pub torque: Option<Waves>,
    /// And where on the body, from the centre of mass.
    pub force: Option<(Waves, V)>,
    pub rate: f64,
    pub rows: usize,
    /// A floor: |ω| and its direction jump here, unlogged, so many times.
    pub knocks: usize,
    /// The floor: from here to there a torque against the spin that nobody writes down.
    pub contact: (f64, f64),
    /// A torque that nobody writes down.
    pub unlogged: Option<Waves>,
}

/// A row as the engine knows it.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    pub t: f64,
    pub q: Q,
    pub omega: V,
    pub x: V,
    pub torque: V,
    pub force: V,
    pub point: V,
}

struct Mind<'a> {
    run: &'a Run,
    inertia: M,
}

impl Mind<'_> {
    /// α in the world, of what acts about the centre of mass.
    fn alpha(&self, q: Q, omega: V, torque: V) -> V {
        let r = matrix(q);
        let back = transposed(&r);
        let fault = self.run.fault;
        let world = match fault {
            Fault::InertiaNotRotated => self.inertia,
            Fault::InertiaRotatedBackwards => carried(&back, &self.inertia),
            _ => carried(&r, &self.inertia),
        };
        let inverted = match fault {
            Fault::InertiaNotInverted => world,
            _ => inverse(&world),
        };
        let torque = match fault {
            Fault::TorqueInBodyFrame => apply(&r, torque),
            Fault::TorqueTurnedBack => apply(&back, torque),
            _ => torque,
        };
        let gyroscopic = match fault {
            _ if !self.run.gyroscopic => [0.0; 3],
            Fault::GyroscopicMissing => [0.0; 3],
            Fault::GyroscopicSign => scaled(cross(omega, apply(&world, omega)), -1.0),
            Fault::GyroscopicDiagonalOnly => {
                let i = self.inertia;
                let only = carried(&r, &diagonal([i[0][0], i[1][1], i[2][2]]));
                cross(omega, apply(&only, omega))
            }
            _ => cross(omega, apply(&world, omega)),
        };
        apply(&inverted, sub(torque, gyroscopic))
    }

    fn turned(&self, q: Q, by: V) -> Q {
        match self.run.fault {
            Fault::WrongSide => unit(times(q, turn(by))),
            Fault::Factor(s) => unit(times(turn(scaled(by, s)), q)),
            Fault::NotNormalised => {
                let d = times([0.5 * by[0], 0.5 * by[1], 0.5 * by[2], 0.0], q);
                [q[0] + d[0], q[1] + d[1], q[2] + d[2], q[3] + d[3]]
            }
            _ => unit(times(turn(by), q)),
        }
    }

    /// One step of `h` under what is held in the world.
    fn stepped(&self, q: Q, omega: V, torque: V, h: f64) -> (Q, V) {
        match self.run.stepping {
            Stepping::Fine(_) => self.fine(q, omega, torque, h),
            Stepping::SemiImplicit(_) => {
                let omega = add(omega, scaled(self.alpha(q, omega, torque), h));
                (self.turned(q, scaled(omega, h)), omega)
            }
            Stepping::Implicit(_) => {
                let mut next = omega;
                for _ in 0..60 {
                    next = add(omega, scaled(self.alpha(q, next, torque), h));
                }
                (self.turned(q, scaled(next, h)), next)
            }
            Stepping::Restored(_) => {
                let world = carried(&matrix(q), &self.inertia);
                let kept = norm(add(apply(&world, omega), scaled(torque, h)));
                let next = add(omega, scaled(self.alpha(q, omega, torque), h));
                let next = scaled(next, kept / norm(apply(&world, next)).max(1e-300));
                (self.turned(q, scaled(next, h)), next)
            }
        }
    }

    /// Runge and Kutta's, on the rotation vector from the attitude at the beginning, to second order in it: steps are short.
    fn fine(&self, q: Q, omega: V, torque: V, h: f64) -> (Q, V) {
        let rate = |v: V, w: V| {
            // v̇ = dexp⁻¹ ω = ω - ½ v × ω + 1/12 v × (v × ω) for turns that go on the left.
            let vw = cross(v, w);
            add(w, add(scaled(vw, -0.5), scaled(cross(v, vw), 1.0 / 12.0)))
        };
        let at = |v: V| self.turned(q, v);
        let (v1, a1) = (omega, self.alpha(q, omega, torque));
        let p2 = scaled(v1, 0.5 * h);
        let w2 = add(omega, scaled(a1, 0.5 * h));
        let (v2, a2) = (rate(p2, w2), self.alpha(at(p2), w2, torque));
        let p3 = scaled(v2, 0.5 * h);
        let w3 = add(omega, scaled(a2, 0.5 * h));
        let (v3, a3) = (rate(p3, w3), self.alpha(at(p3), w3, torque));
        let p4 = scaled(v3, h);
        let w4 = add(omega, scaled(a3, h));
        let (v4, a4) = (rate(p4, w4), self.alpha(at(p4), w4, torque));
        let mean = |a: V, b: V, c: V, d: V| scaled(add(add(a, d), scaled(add(b, c), 2.0)), h / 6.0);
        (
            self.turned(q, mean(v1, v2, v3, v4)),
            add(omega, mean(a1, a2, a3, a4)),
        )
    }
}

impl Run {
    fn minded(&self) -> M {
        let i = self.body.inertia;
        let off = |s: f64| {
            let mut j = i;
            for (a, row) in j.iter_mut().enumerate() {
                for (b, x) in row.iter_mut().enumerate() {
                    if a != b {
                        *x *= s;
                    }
                }
            }
            j
        };
        match self.fault {
            Fault::ProductsSign => off(-1.0),
            Fault::ProductsDropped => off(0.0),
            Fault::InertiaScale(s) => i.map(|row| row.map(|x| x * s)),
            Fault::InertiaAbout(d) => {
                let (mut j, dd) = (i, dot(d, d));
                for a in 0..3 {
                    for b in 0..3 {
                        let one = if a == b { dd } else { 0.0 };
                        j[a][b] += self.body.mass * (one - d[a] * d[b]);
                    }
                }
                j
            }
            _ => i,
        }
    }

    /// The rows of the engine: the state at each, and what acts in the step that follows.
    pub fn rows(&self) -> Vec<Row> {
        let mind = Mind {
            run: self,
            inertia: self.minded(),
        };
        let h = 1.0 / self.rate;
        let parts = match self.stepping {
            Stepping::Fine(n)
            | Stepping::SemiImplicit(n)
            | Stepping::Implicit(n)
            | Stepping::Restored(n) => n,
        };
        let (mut q, mut omega, mut v) = (self.q, self.omega, self.v);
        let ignored = self.fault == Fault::CentreIgnored;
        // The point that the engine moves: the centre of mass, or the body's origin.
        let origin = |x: V, q: Q| sub(x, apply(&matrix(q), self.body.centre));
        let mut x = if ignored { origin(self.x, q) } else { self.x };
        let began = x;
        let (mut heaped, mut last) = (([0.0; 3], [0.0; 3]), ([0.0; 3], [0.0; 3]));
        let (mut slow, mut asleep) = (0.0, false);
        let mut rows = Vec::with_capacity(self.rows);
        for k in 0..self.rows {
            let t = k as f64 * h;
            let r = matrix(q);
            let centre = if ignored {
                add(x, apply(&r, self.body.centre))
            } else {
                x
            };
            let mut torque = self.torque.as_ref().map_or([0.0; 3], |w| w.at(t));
            if self.fault == Fault::LongWay {
                if k % 41 == 40 {
                    q = q.map(|x| -x);
                }
                let i = self.body.inertia;
                let k = (i[0][0] + i[1][1] + i[2][2]) * 2.0;
                torque = add(scaled([q[0], q[1], q[2]], -k), scaled(omega, -0.02 * k));
            }
            let (force, point) = self.force.as_ref().map_or(([0.0; 3], centre), |(w, p)| {
                (w.at(t), add(centre, apply(&r, *p)))
            });
            rows.push(Row {
                t,
                q,
                omega,
                x: centre,
                torque,
                force,
                point,
            });
            let lever = match self.fault {
                Fault::LeverStale => sub(point, began),
                Fault::LeverFromOrigin => point,
                Fault::LeverFromBodyOrigin => sub(point, origin(x, q)),
                _ => sub(point, x),
            };
            let acts = (add(torque, cross(lever, force)), force);
            heaped = (add(heaped.0, acts.0), add(heaped.1, acts.1));
            let (mut tau, mut f) = match self.fault {
                Fault::ForPart(s) => (scaled(acts.0, s), scaled(acts.1, s)),
                Fault::NeverCleared => heaped,
                Fault::ClearedLate => (add(acts.0, last.0), add(acts.1, last.1)),
                _ => acts,
            };
            last = acts;
            if let Some(waves) = &self.unlogged {
                tau = add(tau, waves.at(t));
            }
            if t >= self.contact.0 && t < self.contact.1 {
                let i = self.body.inertia;
                let c = 0.4 * (i[0][0] + i[1][1] + i[2][2]);
                tau = add(tau, scaled(add(omega, [0.0, 2.0, 0.5]), -c));
            }
            if self.knocks > 0 && k > 0 && k % (self.rows / (self.knocks + 1)) == 0 {
                let turn = apply(
                    &[[0.0, 0.8, 0.6], [0.6, 0.48, -0.64], [-0.8, 0.36, -0.48]],
                    omega,
                );
                omega = scaled(turn, 0.9);
                f = add(f, scaled([0.3, 0.9, 0.1], 2.0 * self.body.mass / h));
            }
            let part = h / parts as f64;
            for _ in 0..parts {
                (q, omega) = mind.stepped(q, omega, tau, part);
            }
            match self.fault {
                Fault::Damping(c) => omega = scaled(omega, 1.0 - c * h),
                Fault::Clamp(limit) if norm(omega) > limit => {
                    omega = scaled(omega, limit / norm(omega));
                }
                Fault::Sleep(below, after) => {
                    slow = if norm(omega) < below { slow + h } else { 0.0 };
                    asleep |= slow >= after;
                    if asleep {
                        (omega, v) = ([0.0; 3], [0.0; 3]);
                    }
                }
                _ => {}
            }
            if !asleep {
                let a = add(self.gravity, scaled(f, 1.0 / self.body.mass));
                v = add(v, scaled(a, h));
                x = add(x, scaled(v, h));
            }
        }
        rows
    }
}
