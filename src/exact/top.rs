//! Lagrange's top: a heavy symmetric body on a pivot, in closed form.
//!
//! ```text
//! I dω/dt = I ω × ω + u × M e3,   dq/dt = ½ q ω      u = Rᵀ e_z, I = (I1, I1, I3), M = m g l
//! u3 = cos θ:  u̇3² = (1 - u3²)(α - β u3) - (a - b u3)² = β (u3 - r1)(u3 - r2)(u3 - r3)
//! u3 = r1 + (r2 - r1) sn²(κt + v0, k)
//! w + iz = √((1+u3)/2) e^{iΦ₊/2},   Φ̇₊ =  (ω3 - b) + (a+b)/(1+u3)
//! x + iy = √((1-u3)/2) e^{iΦ₋/2},   Φ̇₋ = -(ω3 - b) + (a-b)/(1-u3)
//! ```
//!
//! with a = L_z/I1, b = I3 ω3/I1, β = 2M/I1, κ² = β(r3 - r1)/4, k² = (r2 - r1)/(r3 - r1)
//! (Whittaker, Analytical Dynamics, §71; Klein & Sommerfeld, Über die Theorie des Kreisels, for the
//! halves of precession plus and minus spin). The integrals of Φ are Legendre's third kind, by
//! Carlson's R_J.
//!
//! All constants and phases are double-double. The cubic is solved about the starting point, where
//! its constant term is a square, and with β r3 for unknown, so that nothing is lost for a small
//! weight. Where the axis passes exactly through the vertical one half loses its integral and its
//! root becomes sn or cn, sign and all.

use crate::math::Dd;
use crate::math::elliptic::{first_kind, jacobi, quarter_period, third_kind_excess};
use nalgebra::{Quaternion, Vector3};
use std::f64::consts::TAU;

/// A Lagrange top, set up once and evaluated at any time.
///
/// The pivot is at rest, gravity points along -z of the world, axis 3 of the principal axes is the
/// axis of symmetry and carries the centre of mass.
#[derive(Clone, Debug)]
pub struct LagrangeTop {
    kind: Kind,
    /// M < 0: axes 2 and 3 are turned about, which makes it positive.
    turned: bool,
}

#[derive(Clone, Debug)]
enum Kind {
    /// Axis and momentum vertical: it spins about axis 3.
    Steady {
        q0: Quaternion<f64>,
        turns: Dd,
        spin: f64,
    },
    Nutating(Box<Nutation>),
}

type Complex = (f64, f64);

#[derive(Clone, Debug)]
struct Nutation {
    /// ω3, rad/s.
    spin: f64,
    b: Dd,
    /// a + b and a - b.
    sums: [Dd; 2],
    /// r2 - r1.
    range: Dd,
    kappa: Dd,
    kc2: Dd,
    /// v at t = 0.
    start: Dd,
    quarter: Dd,
    /// w + iz with the lower pole, x + iy with the upper.
    halves: [Half; 2],
}

/// One of the two complex halves of the quaternion.
#[derive(Clone, Debug)]
struct Half {
    /// ±(ω3 - b).
    steady: Dd,
    /// (a ± b)/(κ (1 ± r)), r the root at sn = 0; 0 for one that passes its pole.
    pull: Dd,
    /// `1 ± u3 = least + range · (sn² or cn²)`.
    least: Dd,
    /// 1 ± u3 at sn = 0.
    base: Dd,
    /// Legendre's n.
    n: Dd,
    /// Its integral's excess at t = 0 and over a quarter period.
    start: Dd,
    whole: Dd,
    /// The direction at t = 0.
    phasor: Complex,
    passes: bool,
}

/// Squares of a half below this are a passage through the pole: as an angle, less than a rounding.
const POLE: f64 = 1e-32;

/// On the separatrix v goes on for ever; from here on the axis stands.
const STANDING: f64 = 300.0;

/// sn, cn, dn in [-K, K], and the half periods taken off.
struct Point {
    sn: Dd,
    cn: Dd,
    dn: Dd,
    halves: f64,
    /// v - v0, and how much of it lies where the axis stands.
    passed: Dd,
    standing: Dd,
}

impl LagrangeTop {
    /// From the moments about the pivot, across the axis and along it (kg m², above zero), M = m g l
    /// (N m; below zero for a centre of mass on the negative axis), the attitude q0 (principal axes
    /// → world; normalised here) and the angular velocity in principal axes (rad/s), both at t = 0.
    pub fn new(
        across: f64,
        along: f64,
        moment: f64,
        q0: Quaternion<f64>,
        omega_p: Vector3<f64>,
    ) -> Self {
        let turned = moment < 0.0;
        let (mut q, mut w) = (q0, omega_p);
        if turned {
            (q, w) = (q * HALF_TURN, about(w));
        }
        let kind = match Nutation::new(across, along, moment.abs(), q, w) {
            Some(motion) => Kind::Nutating(Box::new(motion)),
            None => Kind::Steady {
                q0: q / q.norm(),
                turns: Dd::new(w.z) / Dd::PI.scaled(4.0),
                spin: w.z,
            },
        };
        Self { kind, turned }
    }

    /// Attitude (principal axes → world) and angular velocity in principal axes (rad/s) at `t`
    /// seconds, of either sign.
    ///
    /// Good to a few roundings, but for motions within 1e-8 of the separatrix (k'² < 1e-8: the axis
    /// all but stops upright), where the time it stays there is known to 1e-32/k'⁴ at best.
    pub fn at(&self, t: f64) -> (Quaternion<f64>, Vector3<f64>) {
        let (q, w) = match &self.kind {
            Kind::Steady { q0, turns, spin } => {
                let (cos, sin) = direction(*turns * t);
                let turn = Quaternion::new(cos, 0.0, 0.0, sin);
                (q0 * turn, Vector3::z() * *spin)
            }
            Kind::Nutating(motion) => motion.at(t),
        };
        if self.turned {
            (q * HALF_TURN.conjugate(), about(w))
        } else {
            (q, w)
        }
    }

    /// The attitude (principal axes → world) at `t` seconds.
    pub fn attitude(&self, t: f64) -> Quaternion<f64> {
        self.at(t).0
    }
}

/// Half a turn about axis 1.
const HALF_TURN: Quaternion<f64> = Quaternion::new(0.0, 1.0, 0.0, 0.0);

fn about(v: Vector3<f64>) -> Vector3<f64> {
    Vector3::new(v.x, -v.y, -v.z)
}

/// Cosine and sine of 2π times a number of turns.
fn direction(turns: Dd) -> Complex {
    let (sin, cos) = libm::sincos(TAU * turns.fraction().0);
    (cos, sin)
}

fn times((a, b): Complex, (c, d): Complex) -> Complex {
    (a * c - b * d, a * d + b * c)
}

impl Nutation {
    /// None where the axis stays vertical.
    fn new(i1: f64, i3: f64, m: f64, q: Quaternion<f64>, w: Vector3<f64>) -> Option<Self> {
        let product = Dd::product;
        let [x, y, z, s] = [q.i, q.j, q.k, q.w];
        // 1 + u3, 1 - u3 and u1 + iu2 = 2i (w - iz)(x + iy), of the normalised quaternion.
        let (ws, xs) = (product(s, s) + product(z, z), product(x, x) + product(y, y));
        let norm = ws + xs;
        let (above, under) = (ws * 2.0 / norm, xs * 2.0 / norm);
        let u = (ws - xs) / norm;
        let u1 = (product(x, z) - product(s, y)) * 2.0 / norm;
        let u2 = (product(y, z) + product(s, x)) * 2.0 / norm;

        let b = product(i3, w.z) / Dd::new(i1);
        let beta = Dd::new(2.0 * m) / Dd::new(i1);
        let climb = u1 * w.y - u2 * w.x;
        let across = product(w.x, w.x) + product(w.y, w.y);
        let level = u1 * w.x + u2 * w.y;
        let sums = [level + b * above, level - b * under];

        // f(u + x) = f0 + f1 x + f2 x² + β x³.
        let f0 = climb.square();
        let f1 = b * level * 2.0 - u * across * 2.0 - beta * above * under;
        let f2 = u * beta * 2.0 - across - b.square();
        let (p, gap) = far_root(f0, f1, f2, beta);
        if (across.hi == 0.0 && above.hi * under.hi == 0.0) || p.hi <= 0.0 {
            return None;
        }
        let (low, high) = near_roots(f0, f1, beta, p);

        let stretch = p - beta * low; // β (r3 - r1)
        let gap = gap.unwrap_or(p - beta * high);
        let range = high - low;
        let kappa = stretch.sqrt() * 0.5;
        let kc2 = gap / stretch;
        // 1 + r2, 1 - r1 are sums; their partners follow from f(±1) = -(a ∓ b)², or from a
        // difference where that is the better one.
        let (above_high, under_low) = (above + high, under - low);
        let (far, near) = (p + beta * above, p - beta * under); // β (r3 ± 1)
        let above_low = sums[0].square() / (above_high * far);
        let direct = under - high;
        let under_high = if near.hi > direct.hi * p.hi {
            sums[1].square() / (under_low * near)
        } else {
            if direct.hi > 0.0 { direct } else { Dd::ZERO }
        };

        let ratio = |x: Dd| {
            if range.hi > 0.0 {
                (x / range).sqrt()
            } else {
                Dd::ZERO
            }
        };
        let way = if climb.hi < 0.0 { -1.0 } else { 1.0 };
        let (sn, cn, dn) = (ratio(-low) * way, ratio(high), (p / stretch).sqrt());
        let cn = if range.hi > 0.0 { cn } else { Dd::ONE };
        let quarter = if kc2.hi <= 0.0 {
            Dd::new(f64::INFINITY)
        } else {
            quarter_period(kc2)
        };
        let mut motion = Self {
            spin: w.z,
            b,
            sums,
            range,
            kappa,
            kc2,
            start: first_kind(sn, cn, dn),
            quarter,
            halves: [
                Half::new(
                    Dd::new(w.z) - b,
                    sums[0] / kappa,
                    above_low,
                    above_low,
                    -range,
                ),
                Half::new(
                    b - Dd::new(w.z),
                    sums[1] / kappa,
                    under_high,
                    under_low,
                    range,
                ),
            ],
        };
        let begin = Point {
            sn,
            cn,
            dn,
            halves: 0.0,
            passed: Dd::ZERO,
            standing: Dd::ZERO,
        };
        let quarter_point = Point {
            sn: Dd::ONE,
            cn: Dd::ZERO,
            dn: kc2.sqrt(),
            ..begin
        };
        let now = [(s, z), (x, y)];
        // dq/dt = ½ q ω.
        let rate = [
            (
                -0.5 * (x * w.x + y * w.y + z * w.z),
                0.5 * (s * w.z + x * w.y - y * w.x),
            ),
            (
                0.5 * (s * w.x + y * w.z - z * w.y),
                0.5 * (s * w.y + z * w.x - x * w.z),
            ),
        ];
        for (k, half) in motion.halves.iter_mut().enumerate() {
            if !half.passes {
                half.start = half.excess(&begin, k, range);
                if kc2.hi > 0.0 {
                    half.whole = half.excess(&quarter_point, k, range);
                }
            }
            half.phasor = half.direction_at_start(&begin, k, now[k], rate[k]);
        }
        Some(motion)
    }

    fn point(&self, t: f64) -> Point {
        let passed = self.kappa * t;
        let v = passed + self.start;
        let (rest, halves, standing) = if self.quarter.hi == f64::INFINITY {
            let rest = if v.hi.abs() > STANDING {
                Dd::new(STANDING.copysign(v.hi))
            } else {
                v
            };
            (rest, 0.0, v - rest)
        } else {
            let period = self.quarter * 2.0;
            let (_, halves) = (v / period).fraction();
            (v - period * halves, halves, Dd::ZERO)
        };
        let (sn, cn, dn) = jacobi(rest, self.kc2);
        Point {
            sn,
            cn,
            dn,
            halves,
            passed,
            standing,
        }
    }

    fn at(&self, t: f64) -> (Quaternion<f64>, Vector3<f64>) {
        let point = self.point(t);
        let side = if libm::fmod(point.halves, 2.0) == 0.0 {
            1.0
        } else {
            -1.0
        };
        // The sizes of the two halves, and their squares 2 |half|² = 1 ± u3.
        let squares: [Dd; 2] =
            std::array::from_fn(|k| self.halves[k].doubled_square(&point, k, self.range));
        let zeros = [point.sn, point.cn];
        let root = (self.range * 0.5).sqrt();
        let sizes: [f64; 2] = std::array::from_fn(|k| {
            if self.halves[k].passes {
                side * (root * zeros[k]).to_f64()
            } else {
                (squares[k] * 0.5).sqrt().to_f64()
            }
        });
        let turns: [Complex; 2] = std::array::from_fn(|k| {
            let half = &self.halves[k];
            times(half.phasor, direction(half.turns(t, &point, k, self.range)))
        });
        let scale = |by: f64, (re, im): Complex| (by * re, by * im);
        let [(w, z), (x, y)] = [scale(sizes[0], turns[0]), scale(sizes[1], turns[1])];
        let q = Quaternion::new(w, x, y, z);

        // ω1 + iω2 = (u1 + iu2)(a - b u3 + i u̇3)/(1 - u3²), u1 + iu2 = 2i (w - iz)(x + iy).
        let f = Dd::to_f64;
        let [passes_low, passes_high] = [self.halves[0].passes, self.halves[1].passes];
        let b = f(self.b);
        let level = match (passes_low, passes_high) {
            (true, true) => 0.0,
            (true, false) => -2.0 * b * sizes[0] / sizes[1],
            (false, true) => 2.0 * b * sizes[1] / sizes[0],
            (false, false) => {
                let near_top = squares[1] < squares[0];
                let level = if near_top {
                    self.sums[1] + self.b * squares[1]
                } else {
                    self.sums[0] - self.b * squares[0]
                };
                f(level) / (sizes[0] * sizes[1])
            }
        };
        let over = |k: usize| match self.halves[k].passes {
            true => 1.0 / f(root),
            false => side * f(zeros[k]) / sizes[k],
        };
        let climb = if self.range.hi > 0.0 {
            2.0 * f(self.range * self.kappa * point.dn) * over(0) * over(1)
        } else {
            0.0
        };
        let (c, s) = turns[0];
        // i (w - iz)/|..| (x + iy)/|..|.
        let (re, im) = times((s, c), turns[1]);
        let (w1, w2) = times((re, im), (0.5 * level, 0.5 * climb));
        (q / q.norm(), Vector3::new(w1, w2, self.spin))
    }
}

impl Half {
    fn new(steady: Dd, sum: Dd, least: Dd, base: Dd, range: Dd) -> Self {
        let passes = least.hi <= POLE;
        let (pull, n) = if passes {
            (Dd::ZERO, Dd::ZERO)
        } else {
            (sum / base, range / base)
        };
        Self {
            steady,
            pull,
            least,
            base,
            n,
            start: Dd::ZERO,
            whole: Dd::ZERO,
            phasor: (1.0, 0.0),
            passes,
        }
    }

    /// 1 + u3 (k = 0) or 1 - u3 (k = 1).
    fn doubled_square(&self, point: &Point, k: usize, range: Dd) -> Dd {
        let zero = if k == 0 { point.sn } else { point.cn };
        self.least + range * zero.square()
    }

    fn excess(&self, point: &Point, k: usize, range: Dd) -> Dd {
        let p = self.doubled_square(point, k, range) / self.base;
        third_kind_excess(self.n, point.sn, point.cn, point.dn, p)
    }

    /// How far Φ/2 has turned since t = 0, in turns.
    fn turns(&self, t: f64, point: &Point, k: usize, range: Dd) -> Dd {
        let mut phase = self.steady * t;
        if !self.passes {
            let mut third = point.passed + self.whole * (2.0 * point.halves) - self.start
                + self.excess(point, k, range);
            if point.standing.hi != 0.0 {
                third = third + point.standing * self.n / (Dd::ONE - self.n);
            }
            phase = phase + self.pull * third;
        }
        phase / Dd::PI.scaled(4.0)
    }

    /// The half's direction at t = 0; for one that passes through 0, that of its size with sign.
    fn direction_at_start(&self, begin: &Point, k: usize, now: Complex, rate: Complex) -> Complex {
        let unit = |(re, im): Complex, sign: f64| {
            let size = sign * (re * re + im * im).sqrt();
            if size == 0.0 {
                (1.0, 0.0)
            } else {
                (re / size, im / size)
            }
        };
        if !self.passes {
            return unit(now, 1.0);
        }
        let f = Dd::to_f64;
        let (zero, slope) = match k {
            0 => (f(begin.sn), f(begin.cn * begin.dn)),
            _ => (f(begin.cn), -f(begin.sn * begin.dn)),
        };
        if zero.abs() > 0.1 {
            return unit(now, zero.signum());
        }
        // Size e^{iνt} has the rate (size' + iν size) e^{iνt}.
        let nu = 0.5 * f(self.steady);
        let rate = (rate.0 + nu * now.1, rate.1 - nu * now.0);
        unit(rate, if slope < 0.0 { -1.0 } else { 1.0 })
    }
}

/// `P = β r` for the largest root r of `f0 + f1 x + f2 x² + β x³` (three real ones), and β times its
/// distance from the next where the two are one: `P³ + f2 P² + β f1 P + β² f0 = 0`.
fn far_root(f0: Dd, f1: Dd, f2: Dd, beta: Dd) -> (Dd, Option<Dd>) {
    let (c1, c0) = (f1 * beta, f0 * beta.square());
    // From the minimum c of the cubic outwards: δ² (δ + r) = -(cubic at c), r = √(f2² - 3 c1).
    let r = (f2.square() - c1 * 3.0).sqrt();
    let c = (r - f2) / Dd::new(3.0);
    let depth = -(((c + f2) * c + c1) * c + c0);
    let size = r * c.square() + f2.abs() * c.square() + c1.abs() * c.abs() + c0.abs();
    // What is left of terms that cancel is their rounding.
    if depth.hi <= 4e-32 * size.hi || r.hi <= 0.0 {
        return (c, Some(Dd::ZERO));
    }
    // Convex, and the start lies beyond the root: Newton comes down to it.
    let mut delta = (depth / r).sqrt();
    for _ in 0..200 {
        let value = delta.square() * (delta + r) - depth;
        let slope = delta * (delta * 3.0 + r * 2.0);
        let step = value / slope;
        delta = delta - step;
        if step.hi.abs() <= 1e-31 * delta.hi {
            break;
        }
    }
    (c + delta, None)
}

/// The other two roots, one on each side of 0, by what is left after division by `x - P/β`:
/// `x² + h x + g`, `g = -f0/P`, `h = (β g - f1)/P`.
fn near_roots(f0: Dd, f1: Dd, beta: Dd, p: Dd) -> (Dd, Dd) {
    let g = -f0 / p;
    let h = (beta * g - f1) / p;
    let root = (h.square() - g * 4.0).sqrt();
    if h.hi > 0.0 {
        let low = -(h + root) * 0.5;
        (low, g / low)
    } else {
        let high = (root - h) * 0.5;
        let low = if high.hi > 0.0 { g / high } else { Dd::ZERO };
        (low, high)
    }
}
