//! How a scene's bodies may come to turn, as far as that is seen without running it.

use super::{Alone, struck};
use crate::effect::Load;
use crate::scene::{Action, Scene};
use nalgebra::Vector3;

/// What sets a body turning, in principal axes.
pub struct Motion {
    /// rad/s: at the start, and what each event gives it by itself.
    pub spins_p: Vec<Vector3<f64>>,
    /// rad/s²: by what acts at the start.
    pub alpha_p: Vector3<f64>,
    /// Principal moments about the reference point, kg m².
    pub moments: Vector3<f64>,
}

pub struct Motions(Vec<Motion>);

impl Motions {
    pub fn of(scene: &Scene, load: &Load) -> Self {
        let alone: Vec<Alone> = scene.bodies.iter().map(Alone::new).collect();
        let mut motions: Vec<Motion> = alone
            .iter()
            .map(|body| {
                let tau_w = body.wrench(load, &body.state).tau_w;
                Motion {
                    spins_p: vec![body.state.to_principal(body.state.omega_w)],
                    alpha_p: body
                        .state
                        .to_principal(tau_w)
                        .component_mul(&body.inertial.inv_moments),
                    moments: body.inertial.moments,
                }
            })
            .collect();
        for event in &scene.events {
            let body = &alone[event.body];
            let time = match event.action {
                Action::Push { lasts, .. } | Action::Torque { lasts, .. } => lasts,
                Action::Impulse { .. } | Action::AngularImpulse { .. } => 1.0,
            };
            let impulse_w = struck(event, body, &body.state).tau_w * time;
            let spin = body
                .state
                .to_principal(impulse_w)
                .component_mul(&body.inertial.inv_moments);
            motions[event.body].spins_p.push(spin);
        }
        Self(motions)
    }

    pub fn each(&self) -> impl Iterator<Item = &Motion> {
        self.0.iter()
    }
}

impl Motion {
    /// The fastest it may turn, rad/s: its own spin and the largest that an event adds.
    pub fn fastest(&self) -> f64 {
        let norms = || self.spins_p.iter().map(Vector3::norm);
        norms().next().unwrap_or(0.0) + norms().skip(1).fold(0.0, f64::max)
    }

    /// Whether the gyroscopic term `ω × I ω` is more than rounding for some ω that comes of these spins.
    pub fn feels_gyroscopic(&self) -> bool {
        let largest = self.moments.max();
        let turns: Vec<Vector3<f64>> = self
            .spins_p
            .iter()
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
        self.alpha_p != Vector3::zeros() || self.spins_p.iter().any(|v| *v != Vector3::zeros())
    }
}

/// Of directions that have been turned and divided a few times.
const ROUNDING: f64 = 1e-9;
/// Directions that are looked at: a few say it.
const ENOUGH: usize = 16;
