//! Which of a body's torques did this? Each source by itself.
//!
//! ```text
//! I α = Σ τ_source - ω × (I ω) - c I ω
//! ```
//!
//! The last two are the model's own (where a scene has them) and stand beside what is applied: only
//! then do the parts add up to what turns the body. Sources are told apart by name; two pushes at
//! once are one source.

use crate::body::{Inertial, InertialBlock, State, StateBlock};
use crate::effect::{Called, Effect, Load, WrenchBlock};
use crate::scene::{Action, Event, Scene, SceneEffect, Target};
use crate::trace::Subject;
use nalgebra::Vector3;

/// The model's own term, which of a fast body is many times what is applied.
pub const GYROSCOPIC: &str = "gyroscopic";

/// Names every source of torque on each body, and some that are expected; none where one says all there is to say.
pub fn tell_apart(scene: &Scene, subjects: &mut [Subject], expected: &[&str]) {
    for (k, (subject, body)) in subjects.iter_mut().zip(&scene.bodies).enumerate() {
        let member = body.member(0);
        let mut block = InertialBlock::default();
        block.set(0, member.inertial);
        let turns = |called: &Called| match called {
            // The weight of a free body, say, turns nothing.
            Called::Load(spec) => spec.on(&[member]).depends(&block).torque,
            Called::Gyroscopic => true,
            Called::Decay(decay) => decay.angular_rate() > 0.0,
            // A limit cuts a velocity; it is no torque.
            Called::Limit(_) | Called::Off => false,
        };
        let own = scene.effects.iter().filter(|effect| effect.concerns(k));
        let lasting = own.filter(|effect| turns(&effect.called));
        let name = |effect: &SceneEffect| match effect.called {
            Called::Gyroscopic => GYROSCOPIC.to_owned(),
            _ => effect.name.to_string(),
        };
        let mut names: Vec<String> = lasting.map(name).collect();
        for event in scene.events.iter().filter(|event| may_reach(event, k)) {
            let name = match &event.action {
                Action::Torque { .. } => "torque",
                Action::Push { .. } => "push",
                Action::Click(click) if click.lasts > 0.0 => "push",
                // At once, or none of a torque.
                Action::Click(_)
                | Action::Impulse { .. }
                | Action::AngularImpulse { .. }
                | Action::Set(_)
                | Action::Switch { .. }
                | Action::Method(_)
                | Action::Note(_) => continue,
            };
            if !names.iter().any(|known| known == name) {
                names.push(name.to_owned());
            }
        }
        for name in expected {
            if !names.iter().any(|known| known == name) {
                names.push((*name).to_owned());
            }
        }
        if names.len() > 1 {
            subject.sources = names;
        }
    }
}

fn may_reach(event: &Event, body: usize) -> bool {
    match &event.target {
        Target::Body(target) => *target == body,
        Target::Hit(bodies) => bodies.contains(&body),
        Target::All | Target::Log(_) => false,
    }
}

/// What each effect applies to a block, by the effect's name.
#[derive(Default)]
pub struct Parts<'l>(Vec<(&'l str, WrenchBlock)>);

impl<'l> Parts<'l> {
    pub fn of(load: &'l Load, t: f64, inertial: &InertialBlock, state: &StateBlock) -> Self {
        let part = |(name, effect): (&'l str, &dyn Effect)| {
            let mut wrench = WrenchBlock::default();
            effect.add(t, inertial, state, &mut wrench);
            (name, wrench)
        };
        Self(load.effects().map(part).collect())
    }

    /// The torques of these sources on a lane.
    pub fn torques(
        &self,
        names: &[String],
        (load, lane): (&Load, usize),
        inertial: &Inertial,
        state: &State,
    ) -> Vec<Vector3<f64>> {
        let momentum_w = || inertial.momentum_w(state);
        let own = |name: &str| {
            if name == GYROSCOPIC && load.gyroscopic() {
                return -state.omega_w.cross(&momentum_w());
            }
            let decay = load.decays().find(|(decay, _)| *decay == name);
            decay.map_or(Vector3::zeros(), |(_, decay)| {
                -momentum_w() * decay.angular_rate()
            })
        };
        let applied = |name: &String| -> Vector3<f64> {
            let parts = self.0.iter().filter(|(part, _)| part == name);
            parts.map(|(_, wrench)| wrench.get(lane).tau_w).sum()
        };
        let total = |name: &String| own(name) + applied(name);
        names.iter().map(total).collect()
    }
}
