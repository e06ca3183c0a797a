//! A body's log, and what several tests need of it, computed once.

use super::centre::{self, Centre};
use super::kinematics::{self, Reading};
use super::law::{Gyroscopic, Law, Steps, fit};
use super::motion::Motion;
use crate::log::{Logged, Rows};
use nalgebra::{Matrix3, Vector3};
use std::cell::OnceCell;

pub struct Case<'a> {
    pub logged: &'a Logged,
    motion: Option<Motion>,
    kinematics: OnceCell<Option<Kinematics>>,
    centre: OnceCell<Option<Centre>>,
}

/// What the kinematic search found.
pub struct Kinematics {
    /// What is left unexplained as logged.
    pub as_logged: f64,
    /// Up to which that is right.
    pub bound: f64,
    /// The plainest of the best readings; none where as logged is right.
    pub best: Option<Reading>,
    /// Others that are as good and as plain.
    pub others: Vec<Reading>,
    pub runner_up: Option<Reading>,
    pub euler: Option<([usize; 3], f64)>,
}

impl<'a> Case<'a> {
    pub fn new(logged: &'a Logged) -> Self {
        Self {
            logged,
            motion: Motion::new(&logged.rows),
            kinematics: OnceCell::new(),
            centre: OnceCell::new(),
        }
    }

    pub fn rows(&self) -> &'a Rows {
        &self.logged.rows
    }

    pub fn motion(&self) -> Option<&Motion> {
        self.motion.as_ref()
    }

    /// kg m², where it was declared and is one of numbers.
    pub fn inertia(&self) -> Option<Matrix3<f64>> {
        let i = self.logged.declared.as_ref()?.inertia_b;
        i.iter().all(|x| x.is_finite()).then_some(i)
    }

    pub fn mass(&self) -> Option<f64> {
        self.logged
            .declared
            .as_ref()?
            .mass
            .filter(|m| *m > 0.0 && m.is_finite())
    }

    /// Whether a torque or a force was logged as acting in the step that follows a row.
    pub fn acts_at(&self, row: usize) -> bool {
        let some = |of: &[[f64; 3]]| of.get(row).is_some_and(|v| v.iter().any(|x| *x != 0.0));
        some(&self.rows().torques) || some(&self.rows().forces)
    }

    /// None where there is nothing to search: ω not logged, nothing that turns, too few rows.
    pub fn kinematics(&self) -> Option<&Kinematics> {
        self.kinematics.get_or_init(|| self.search()).as_ref()
    }

    fn search(&self) -> Option<Kinematics> {
        let m = self.motion()?;
        if m.derived || m.windows(kinematics::WINDOW, kinematics::WINDOW).len() < 3 {
            return None;
        }
        // Right ones leave up to 0.014, wrong ones 0.49 and more.
        let bound = (3.0 * kinematics::floor(m)).clamp(0.02, 0.3);
        let as_logged = kinematics::as_logged(m);
        if as_logged <= bound {
            return Some(Kinematics {
                as_logged,
                bound,
                best: None,
                others: Vec::new(),
                runner_up: None,
                euler: None,
            });
        }
        let all = kinematics::search(self.rows(), m);
        let least = all.first()?.residual;
        let alike = 1.5 * least + 0.005;
        let tied: Vec<Reading> = all
            .iter()
            .take_while(|r| r.residual <= alike)
            .copied()
            .collect();
        let plainest = tied.iter().map(Reading::oddities).min()?;
        let mut plain = tied.iter().filter(|r| r.oddities() == plainest);
        let best = plain.next().copied();
        Some(Kinematics {
            as_logged,
            bound,
            best,
            others: plain.copied().collect(),
            runner_up: all
                .iter()
                .find(|r| r.residual > alike && r.oddities() <= plainest.max(1))
                .copied(),
            euler: kinematics::euler(m),
        })
    }

    /// Forces over the mass, m/s², as held from each row; empty where none was logged.
    fn accelerations(&self) -> Vec<Vector3<f64>> {
        let Some(mass) = self.mass() else {
            return Vec::new();
        };
        self.rows()
            .forces
            .iter()
            .map(|f| Vector3::from(*f) / mass)
            .collect()
    }

    /// Positions say that the body turns about another point than its declared centre of mass: how far that is from it, m.
    pub fn turns_elsewhere(&self) -> Option<f64> {
        let c = self.logged.declared.as_ref()?.centre_of_mass_b;
        let centre = self.centre()?;
        // The radius of gyration.
        let size = (0.5 * self.inertia()?.trace() / self.mass()?).sqrt();
        centre.is_not(&c, size).then(|| (centre.r - c).norm())
    }

    pub fn centre(&self) -> Option<&Centre> {
        self.centre
            .get_or_init(|| {
                centre::centre(
                    self.motion()?,
                    &self.rows().positions,
                    &self.accelerations(),
                )
            })
            .as_ref()
    }

    /// Where attitudes turn by R ω: whether ω is one in body axes that obeys Euler's equation there (true), or one in the world that
    /// obeys it there (false), whether or not the gyroscopic term is in it. None where both or neither does.
    pub fn body_or_side(&self) -> Option<bool> {
        let (m, inertia) = (self.motion()?, self.inertia()?);
        let turned =
            m.q.iter()
                .zip(&m.omega_w)
                .map(|(q, w)| q.transform_vector(w))
                .collect();
        let least = |m: &Motion, world: bool| {
            let steps = Steps::new(m, |_| true)?;
            let tau_w = self.torque_about_centre(m)?;
            let measured = if world {
                steps.measured_in_world()
            } else {
                steps.measured.clone()
            };
            let kept = vec![true; measured.len()];
            let left = [Gyroscopic::On, Gyroscopic::Off].map(|g| {
                steps
                    .predict(Law::RIGHT.gyroscopic(g), &inertia, &tau_w)
                    .map_or(f64::INFINITY, |p| {
                        fit(&measured, &p.mid, Some((&p.stage, [-0.55, 0.55])), &kept).left
                    })
            });
            let floor = 1e-6 * m.speed * m.speed + 0.3 * steps.noise;
            Some(left[0].min(left[1]) + floor)
        };
        let body = least(&m.with_omega(turned), false)?;
        let side = least(m, true)?;
        (body.max(side) > 2.0 * body.min(side)).then_some(body < side)
    }

    /// The torques and the forces' with the right levers; None where levers are not known.
    pub fn torque_about_centre(&self, m: &Motion) -> Option<Vec<Vector3<f64>>> {
        let rows = self.rows();
        let n = rows.len();
        let mut tau: Vec<Vector3<f64>> = if rows.torques.len() == n {
            rows.torques.iter().map(|t| Vector3::from(*t)).collect()
        } else {
            vec![Vector3::zeros(); n]
        };
        if rows.forces.len() == n && rows.forces.iter().flatten().any(|f| *f != 0.0) {
            let centres = self.centres(m)?;
            if rows.points.len() != n {
                return None;
            }
            for k in 0..n {
                tau[k] += (Vector3::from(rows.points[k]) - centres[k])
                    .cross(&Vector3::from(rows.forces[k]));
            }
        }
        Some(tau)
    }

    /// The centre of mass in the world at each row; None without positions.
    pub fn centres(&self, m: &Motion) -> Option<Vec<Vector3<f64>>> {
        let rows = self.rows();
        if rows.positions.len() != rows.len() {
            return None;
        }
        let c = self
            .logged
            .declared
            .as_ref()
            .map_or(Vector3::zeros(), |d| d.centre_of_mass_b);
        Some(
            (rows.positions.iter().zip(&m.q))
                .map(|(x, q)| Vector3::from(*x) + q.transform_vector(&c))
                .collect(),
        )
    }
}
