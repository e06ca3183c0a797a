//! The equations of one body under constant forces at points and constant torques, as the recurrences
//! take them.
//!
//! With u_d = Rᵀ d for a few world directions d, torque in principal axes is linear in them:
//!
//! ```text
//! force F of the world at p of the body    p × Rᵀ F          d = F, map p ×
//! force F of the body at p of the body     p × F             constant
//! torque τ of the world                    Rᵀ τ              d = τ, map 1
//! torque τ of the body                     τ                 constant
//! force F of the world at P of the world   Rᵀ ((P - x) × F)  } three directions: the axes; x a series of its
//! force F of the body at P of the world    Rᵀ (P - x) × F    } own, unless the reference point stands still
//! ```

use super::four::Four;
use crate::body::{Inertial, State};
use crate::effect::{Frame, Load, Term};
use crate::integrator::Interval;
use crate::integrator::flight::Flight;
use crate::math::Dd;
use nalgebra::{Matrix3, Vector3};

/// How a body turns and travels.
#[derive(Clone, Debug)]
pub struct Law {
    pub turning: Turning,
    /// World directions that the torque knows, three at most.
    pub directions: Vec<Vector3<f64>>,
    pub travel: Travel,
}

/// `I ω' = (I_j - I_k) ω_j ω_k + τ - c I ω`, principal axes, the fourth of each row 0.
#[derive(Clone, Copy, Debug)]
pub struct Turning {
    /// `I_j - I_k`; zero without the gyroscopic term.
    pub spread: Four,
    /// 1/I, and what its rounding leaves: without that, a phase grows as ω t 1e-16.
    pub inverse: Four,
    pub rest: Four,
    /// N·m.
    pub constant: Four,
    /// Torque of each direction: columns, for the components of u_d.
    pub maps: [[Four; 3]; 3],
    /// c, 1/s.
    pub drag: Four,
}

/// How the reference point moves.
#[derive(Clone, Debug)]
pub enum Travel {
    /// Under a constant acceleration.
    Flight(Flight),
    /// By a recurrence of its own.
    Carried(Carried),
}

/// `v' = a + R b - k v`, with torques that depend on where the reference point is.
#[derive(Clone, Debug)]
pub struct Carried {
    /// m/s², of the world and of the body.
    pub a_w: Vector3<f64>,
    pub b_p: Vector3<f64>,
    /// k, 1/s.
    pub drag: f64,
    pub levers: Vec<Lever>,
}

/// A force at a point of the world.
#[derive(Clone, Copy, Debug)]
pub struct Lever {
    pub point_w: Vector3<f64>,
    pub force: Frame,
}

impl Law {
    pub fn new(interval: &Interval, terms: &[Term], lane: usize, start: &State) -> Self {
        let (load, body) = (&interval.load, interval.inertial.get(lane));
        let own = || terms.iter().filter(move |term| term.lane() == lane);
        let mut force_w = Vector3::zeros();
        let mut force_p = Vector3::zeros();
        for term in own() {
            match *term {
                Term::Force {
                    force: Frame::World(f),
                    ..
                } => force_w += f,
                Term::Force {
                    force: Frame::Principal(f),
                    ..
                } => force_p += f,
                Term::Torque { .. } => {}
            }
        }
        let (a_w, b_p) = (force_w * body.inv_mass, force_p * body.inv_mass);
        let stands = start.v_w.norm_squared() == 0.0 && a_w == -a_w && b_p == -b_p;
        let mut torque = Torque::default();
        let mut levers = Vec::new();
        for term in own() {
            torque.count(term, stands.then_some(start.x_w), &mut levers);
        }
        let carried = b_p != -b_p || !levers.is_empty();
        let travel = match carried {
            false => Travel::Flight(Flight::new(start, a_w)),
            true => Travel::Carried(Carried {
                a_w,
                b_p,
                drag: load.decay().map_or(0.0, |decay| decay.linear_rate()),
                levers,
            }),
        };
        let directions = torque.directions(carried);
        Self {
            turning: Turning::new(load, &body, torque.constant, &directions),
            directions: directions.iter().map(|(d, _)| *d).collect(),
            travel,
        }
    }
}

impl Turning {
    fn new(
        load: &Load,
        body: &Inertial,
        constant: Vector3<f64>,
        directions: &[(Vector3<f64>, Matrix3<f64>)],
    ) -> Self {
        let i = body.moments;
        let spread = match load.gyroscopic() {
            true => Vector3::new(i.y - i.z, i.z - i.x, i.x - i.y),
            false => Vector3::zeros(),
        };
        // An axis that cannot turn has a moment of 0, and an inverse of 0.
        let inverses = i.map(|i| match i == 0.0 {
            true => Dd::ZERO,
            false => Dd::ONE / Dd::new(i),
        });
        let drag = load.decay().map_or(0.0, |decay| decay.angular_rate());
        let mut maps = [[Four::default(); 3]; 3];
        for (map, (_, matrix)) in maps.iter_mut().zip(directions) {
            for (column, of) in map.iter_mut().zip(matrix.column_iter()) {
                *column = Four([of[0], of[1], of[2], 0.0]);
            }
        }
        Self {
            spread: spread.into(),
            inverse: inverses.map(|inverse| inverse.hi).into(),
            rest: inverses.map(|inverse| inverse.lo).into(),
            constant: constant.into(),
            maps,
            drag: Vector3::repeat(drag).into(),
        }
    }
}

/// The torque of some terms: a constant in principal axes, and maps of directions.
#[derive(Default)]
struct Torque {
    constant: Vector3<f64>,
    maps: Vec<(Vector3<f64>, Matrix3<f64>)>,
}

impl Torque {
    /// Counts a term in; with `x_w` the reference point stands there, else a force at a point of the
    /// world becomes a lever.
    fn count(&mut self, term: &Term, x_w: Option<Vector3<f64>>, levers: &mut Vec<Lever>) {
        match *term {
            Term::Torque {
                torque: Frame::World(tau),
                ..
            } => self.map(tau, Matrix3::identity()),
            Term::Torque {
                torque: Frame::Principal(tau),
                ..
            } => self.constant += tau,
            Term::Force {
                force,
                point: Frame::Principal(p),
                ..
            } => match force {
                Frame::World(f) => self.map(f, p.cross_matrix()),
                Frame::Principal(f) => self.constant += p.cross(&f),
            },
            Term::Force {
                force,
                point: Frame::World(p),
                ..
            } => match (force, x_w) {
                (_, None) => levers.push(Lever { point_w: p, force }),
                (Frame::World(f), Some(x)) => self.map((p - x).cross(&f), Matrix3::identity()),
                (Frame::Principal(f), Some(x)) => self.map(p - x, -f.cross_matrix()),
            },
        }
    }

    fn map(&mut self, direction: Vector3<f64>, matrix: Matrix3<f64>) {
        if direction == -direction || matrix == -matrix {
            return;
        }
        match self.maps.iter_mut().find(|(d, _)| *d == direction) {
            Some((_, sum)) => *sum += matrix,
            None => self.maps.push((direction, matrix)),
        }
    }

    /// The directions as they are, or the axes of the world where there are more than three, or they are
    /// asked for.
    fn directions(&self, axes: bool) -> Vec<(Vector3<f64>, Matrix3<f64>)> {
        if self.maps.len() <= 3 && !axes {
            return self.maps.clone();
        }
        let along = |axis: usize| {
            let parts = self.maps.iter().map(|(d, matrix)| matrix * d[axis]);
            (Vector3::ith(axis, 1.0), parts.sum())
        };
        (0..3).map(along).collect()
    }
}
