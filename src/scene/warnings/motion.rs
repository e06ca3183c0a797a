//! How a scene's bodies may come to turn, as far as that is seen without running it.

use super::{Alone, struck};
use crate::body::State;
use crate::scene::{Action, Event};
use nalgebra::Vector3;

/// What sets a body turning, in principal axes.
pub struct Motion {
    /// rad/s: at the start, and what it is set to.
    spins_p: Vec<Vector3<f64>>,
    /// rad/s: what each event gives it by itself.
    added_p: Vec<Vector3<f64>>,
    /// rad/s²: by what acts at the start.
    alpha_p: Vector3<f64>,
    /// Principal moments about the reference point, kg m².
    moments: Vector3<f64>,
}

impl Motion {
    /// As it starts.
    pub fn of(body: &Alone) -> Self {
        let tau_w = body.wrench(&body.state).tau_w;
        let alpha_p = body.state.to_principal(tau_w);
        Self {
            spins_p: vec![body.state.to_principal(body.state.omega_w)],
            added_p: Vec::new(),
            alpha_p: alpha_p.component_mul(&body.inertial.inv_moments),
            moments: body.inertial.moments,
        }
    }

    /// Takes in what an event does to the body.
    pub fn meets(&mut self, event: &Event, body: &Alone) {
        if let Action::Set(change) = &event.action {
            let q_wp = change.q_wb.map(|q_wb| q_wb * body.q_pb.inverse());
            let state = State {
                q_wp: q_wp.map_or(body.state.q_wp, |q_wp| q_wp.into_inner()),
                ..body.state
            };
            let omega_w = change.omega_w.unwrap_or(body.state.omega_w);
            self.spins_p.push(state.to_principal(omega_w));
        }
        let time = match event.action.lasts() {
            0.0 => 1.0,
            lasts => lasts,
        };
        if let Some(wrench) = struck(event, body, &body.state) {
            let impulse_p = body.state.to_principal(wrench.tau_w * time);
            let spin = impulse_p.component_mul(&body.inertial.inv_moments);
            self.added_p.push(spin);
        }
    }

    /// The fastest it may turn, rad/s: its own spin and the largest that an event adds.
    pub fn fastest(&self) -> f64 {
        let longest = |of: &[Vector3<f64>]| of.iter().map(Vector3::norm).fold(0.0, f64::max);
        longest(&self.spins_p) + longest(&self.added_p)
    }

    /// Whether the gyroscopic term `ω × I ω` is more than rounding for some ω that comes of these spins.
    pub fn feels_gyroscopic(&self) -> bool {
        let largest = self.moments.max();
        let turns: Vec<Vector3<f64>> = self
            .spins_p
            .iter()
            .chain(&self.added_p)
            .chain([&self.alpha_p])
            .filter_map(|v| v.try_normalize(0.0))
            .collect();
        // Of directions only, each once: a body may have thousands of events.
        let mut distinct: Vec<Vector3<f64>> = Vec::new();
        for v in turns {
            if !distinct.iter().any(|u| u.cross(&v).norm() < ROUNDING) {
                distinct.push(v);
            }
            if distinct.len() == ENOUGH {
                break;
            }
        }
        let moment = |v: &Vector3<f64>| self.moments.component_mul(v);
        let term = |u: &Vector3<f64>, v: &Vector3<f64>| u.cross(&moment(v)) + v.cross(&moment(u));
        let pairs = |u| distinct.iter().map(move |v| (u, v));
        let matters =
            |(u, v): (&Vector3<f64>, &Vector3<f64>)| term(u, v).norm() > ROUNDING * largest;
        // A pair in different principal axes makes a term even where neither does by itself.
        self.spins() && distinct.iter().flat_map(pairs).any(matters)
    }

    fn spins(&self) -> bool {
        let mut all = self.spins_p.iter().chain(&self.added_p);
        self.alpha_p != Vector3::zeros() || all.any(|v| *v != Vector3::zeros())
    }
}

/// Of directions that have been turned and divided a few times.
const ROUNDING: f64 = 1e-9;
/// Directions that are looked at: a few say it.
const ENOUGH: usize = 16;
