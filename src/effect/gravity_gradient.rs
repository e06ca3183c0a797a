//! Gravity of a planet that pulls the near side of a body harder than the far one:
//!
//! ```text
//! τ = 3 μ/r³  r̂ × (I_w r̂)                        r from the planet's centre to the reference point
//! F = -μ m/r²  r̂ - 3 μ/r⁴ (I_w r̂ + ½ (tr I - 5 r̂·I_w r̂) r̂)          with `orbit = true`
//! ```
//!
//! Both follow from the potential `V = -μ m/r - μ/(2 r³) (tr I - 3 r̂·I_w r̂)` (MacCullagh), all terms up to
//! second order in size over distance: with the force, energy and the angular momentum about the planet
//! are those of one system and stay, to the digits of the method (with `gyroscopic = true`). Without `orbit`
//! there is the torque alone, and the body goes where it otherwise would: one that stands still has the planet
//! in a fixed direction. A body of infinite mass feels nothing. At r = 0 there is no force to speak of; a
//! body that starts there is refused, and one that falls in is lost and said to be.
//!
//! Hughes, Spacecraft Attitude Dynamics (1986), 8.1; Wertz, Spacecraft Attitude Determination and Control
//! (1978), 17.2.1.

use super::{
    Argument, Called, Depends, Described, Effect, EffectKind, Member, Spec, WrenchBlock,
    lanes as lanes_of,
};
use crate::body::{InertialBlock, LaneSet, StateBlock};
use nalgebra::Vector3;
use std::sync::Arc;

pub const KIND: EffectKind = EffectKind {
    name: "gravity_gradient",
    argument: Argument::Table(&[
        ("mu", Argument::Number("m³/s²")),
        ("centre", Argument::Vector("m")),
        ("orbit", Argument::Switch),
    ]),
    equation: "τ = 3 μ/r⁵ r × (I r), r from the planet's centre",
    about: "the torque of a planet's gravity (mu = 3.986e14 is the Earth's) about its centre, by default the origin; with orbit = true its force as well",
    make: |value, _| {
        let Some(mu) = value.number("mu") else {
            return Err("lacks mu, the planet's gravity constant times its mass, m³/s²".to_owned());
        };
        if mu < 0.0 {
            return Err(format!("mu = {mu} would push away; it is 0 or more"));
        }
        if mu == 0.0 {
            return Ok(Called::Off);
        }
        Ok(Called::Load(Arc::new(Planet {
            mu,
            centre_w: value.vector("centre").unwrap_or_default(),
            orbit: value.switch("orbit"),
        })))
    },
};

#[derive(Clone, Copy, Debug)]
struct Planet {
    /// m³/s².
    mu: f64,
    /// World, m.
    centre_w: Vector3<f64>,
    /// Whether it pulls as well.
    orbit: bool,
}

impl Spec for Planet {
    fn on(&self, members: &[Member<'_>]) -> Arc<dyn Effect> {
        Arc::new(Gradient {
            planet: *self,
            lanes: lanes_of(members),
        })
    }

    fn check(&self, body: &dyn Described) -> Result<(), String> {
        if body.reference_w() == self.centre_w {
            return Err(format!(
                "{} is at the planet's centre, where there is no direction to it; give the body another position, or write the planet's centre",
                body.name()
            ));
        }
        if body.has_immovable_axes() {
            return Err(format!(
                "needs moments that the immovable axes of {} take away; leave those out, or name other bodies",
                body.name()
            ));
        }
        if self.orbit && body.is_held() {
            return Err(format!(
                "a pivot holds {}, so it is in no orbit; leave out orbit, or the pivot",
                body.name()
            ));
        }
        if body.is_held_off_centre() {
            return Err(format!(
                "a pivot holds {} off its centre of mass, where the planet's pull turns it more than the gradient does; hold it at its centre, or write the pull as gravity",
                body.name()
            ));
        }
        Ok(())
    }

    fn moved(&self, by_w: Vector3<f64>) -> Option<Arc<dyn Spec>> {
        let centre_w = self.centre_w + by_w;
        Some(Arc::new(Self { centre_w, ..*self }))
    }
}

/// A planet's gravity on some bodies of a block.
#[derive(Debug)]
struct Gradient {
    planet: Planet,
    lanes: LaneSet,
}

impl Effect for Gradient {
    fn name(&self) -> &'static str {
        "gravity_gradient"
    }

    fn lanes(&self) -> LaneSet {
        self.lanes
    }

    fn add(&self, _t: f64, inertial: &InertialBlock, state: &StateBlock, wrench: &mut WrenchBlock) {
        let Planet {
            mu,
            centre_w,
            orbit,
        } = self.planet;
        for lane in self.lanes.iter() {
            let (body, s) = (inertial.get(lane), state.get(lane));
            let r_w = s.x_w - centre_w;
            let r = r_w.norm();
            let towards_w = r_w / r;
            let towards_p = s.to_principal(towards_w);
            let inertia_p = body.moments.component_mul(&towards_p);
            // 3 μ/r³, 1/s².
            let rate = 3.0 * mu / (r * r * r);
            let tau_w = s.to_world(towards_p.cross(&inertia_p) * rate);
            if !orbit {
                wrench.add_torque(lane, tau_w);
                continue;
            }
            let along = 0.5 * (body.moments.sum() - 5.0 * towards_p.dot(&inertia_p));
            let shape_w = s.to_world(inertia_p) + towards_w * along;
            let force_w = towards_w * (-mu * body.mass / (r * r)) - shape_w * (rate / r);
            wrench.add(lane, force_w, tau_w);
        }
    }

    fn depends(&self, _: &InertialBlock) -> Depends {
        Depends {
            torque: true,
            place: true,
            ..Depends::NOTHING
        }
    }
}
