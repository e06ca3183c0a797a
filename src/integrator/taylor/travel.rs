//! A reference point that forces of the body push, and torques that depend on where it is.
//!
//! ```text
//! ξ = x - x_n    ξ' = v    v' = a + R b - k v        (R b)_i = u_i · b,  u_i = Rᵀ e_i
//! force F of the world at P     Rᵀ m,  m = (P - x_n) × F - ξ × F
//! force F of the body at P      Rᵀ (P - x_n) × F - Rᵀ ξ × F
//! (Rᵀ m)_k = Σ_i Σ_j m_ij u_i(k-j)
//! ```

use super::four::Four;
use super::law::{Carried, Lever};
use super::recurrence::{INVERSE, Levers, Order, direction, rows};
use crate::body::State;
use crate::effect::Frame;
use nalgebra::Vector3;

/// The series of v and ξ from where the last step started.
#[derive(Clone, Debug)]
pub struct Journey {
    law: Carried,
    unit: f64,
    /// x at the start of the step.
    x_w: Vector3<f64>,
    /// Coefficients, in powers of time over the unit.
    v: Vec<Vector3<f64>>,
    xi: Vec<Vector3<f64>>,
    /// Σ (P - x_n) × F over forces of the world, and ΣF; ΣF over forces of the body at such points.
    moment: Vec<Vector3<f64>>,
    force_w: Vector3<f64>,
    force_p: Vector3<f64>,
    /// x and v at its end.
    end: (Vector3<f64>, Vector3<f64>),
}

/// The three axes of the world are the directions.
pub const ROWS: usize = rows(3);

fn axis(order: &Order<ROWS>, axis: usize) -> Vector3<f64> {
    direction(order, axis)
}

/// `Rᵀ v`.
fn of_body(order: &Order<ROWS>, v: Vector3<f64>) -> Vector3<f64> {
    axis(order, 0) * v.x + axis(order, 1) * v.y + axis(order, 2) * v.z
}

impl Journey {
    pub fn new(law: Carried, order: usize, start: &State) -> Self {
        let sum = |of: fn(&Lever) -> Vector3<f64>| law.levers.iter().map(of).sum();
        let world = |lever: &Lever| match lever.force {
            Frame::World(f) => f,
            Frame::Principal(_) => Vector3::zeros(),
        };
        let body = |lever: &Lever| match lever.force {
            Frame::World(_) => Vector3::zeros(),
            Frame::Principal(f) => f,
        };
        let none = vec![Vector3::zeros(); order + 1];
        Self {
            unit: 1.0,
            x_w: start.x_w,
            v: none.clone(),
            xi: none.clone(),
            moment: none,
            force_w: sum(world),
            force_p: sum(body),
            end: (start.x_w, start.v_w),
            law,
        }
    }

    /// Sets out from the end of the last step, in powers of time over `unit`.
    pub fn set_out(&mut self, unit: f64) {
        self.unit = unit;
        (self.x_w, self.v[0]) = self.end;
        self.xi[0] = Vector3::zeros();
        let moment = |lever: &Lever| match lever.force {
            Frame::World(f) => (lever.point_w - self.x_w).cross(&f),
            Frame::Principal(_) => Vector3::zeros(),
        };
        self.moment[0] = self.law.levers.iter().map(moment).sum();
    }

    /// Takes x and v at `s` units from the start for the end of the step.
    pub fn arrive(&mut self, s: f64) {
        self.end = self.at(s);
    }

    /// x and v at the end of the last step.
    pub fn end(&self) -> (Vector3<f64>, Vector3<f64>) {
        self.end
    }

    /// x and v at `s` units from the start of the step.
    pub fn at(&self, s: f64) -> (Vector3<f64>, Vector3<f64>) {
        let value = |series: &[Vector3<f64>]| {
            let nested = |sum: Vector3<f64>, c: &Vector3<f64>| c + sum * s;
            series.iter().rev().fold(Vector3::zeros(), nested)
        };
        (self.x_w + value(&self.xi), value(&self.v))
    }

    /// The largest component of v's coefficient k.
    pub fn speed(&self, k: usize) -> f64 {
        self.v[k].amax()
    }
}

impl Levers<ROWS> for Journey {
    fn torque(&mut self, k: usize, orders: &[Order<ROWS>]) -> Four {
        let law = &self.law;
        let step = self.unit * INVERSE[k + 1];
        let pushed = Vector3::from_fn(|i, _| axis(&orders[k], i).dot(&law.b_p));
        let constant = if k == 0 { law.a_w } else { Vector3::zeros() };
        self.v[k + 1] = (constant + pushed - self.v[k] * law.drag) * step;
        self.xi[k + 1] = self.v[k] * step;
        if law.levers.is_empty() {
            return Four::default();
        }
        if k > 0 {
            self.moment[k] = -self.xi[k].cross(&self.force_w);
        }
        let mut turning = Vector3::zeros();
        let mut shift = Vector3::zeros();
        for j in 0..=k {
            turning += of_body(&orders[k - j], self.moment[j]);
            shift += of_body(&orders[k - j], self.xi[j]);
        }
        for lever in &law.levers {
            if let Frame::Principal(f) = lever.force {
                turning += of_body(&orders[k], lever.point_w - self.x_w).cross(&f);
            }
        }
        (turning - shift.cross(&self.force_p)).into()
    }
}
