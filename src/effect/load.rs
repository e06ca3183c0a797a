//! The model and everything that acts on one block of bodies, between two events.

use super::{Called, Decay, Depends, Effect, Member, SpeedLimit, Term};
use crate::body::{InertialBlock, State, StateBlock, Vector3Lanes};
use nalgebra::Vector3;
use std::sync::Arc;

/// A force and a torque about the reference point, world axes, N and N·m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    pub force_w: Vector3<f64>,
    pub tau_w: Vector3<f64>,
}

/// The wrenches on eight bodies.
#[derive(Clone, Copy, Debug, Default)]
pub struct WrenchBlock {
    force_w: Vector3Lanes,
    tau_w: Vector3Lanes,
}

impl WrenchBlock {
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Wrench {
        Wrench {
            force_w: self.force_w.get(lane),
            tau_w: self.tau_w.get(lane),
        }
    }

    #[inline(always)]
    pub fn add(&mut self, lane: usize, force_w: Vector3<f64>, tau_w: Vector3<f64>) {
        self.force_w.add(lane, force_w);
        self.tau_w.add(lane, tau_w);
    }

    #[inline(always)]
    pub fn add_torque(&mut self, lane: usize, tau_w: Vector3<f64>) {
        self.tau_w.add(lane, tau_w);
    }
}

/// What moves one block of bodies: which model, and the effects present. Empty where nothing acts.
#[derive(Clone, Debug, Default)]
pub struct Load {
    gyroscopic: bool,
    /// Each with the name that the scene has for it.
    effects: Vec<(Arc<str>, Arc<dyn Effect>)>,
    decays: Vec<(Arc<str>, Decay)>,
    /// All of them at once.
    decay: Option<Decay>,
    limit: Option<SpeedLimit>,
    /// What is applied, where that is known never to change.
    constant: Option<WrenchBlock>,
}

impl Load {
    /// Adds an effect by its own name.
    pub fn push(&mut self, effect: Arc<dyn Effect>) {
        self.push_named(effect.name().into(), effect);
    }

    pub fn push_named(&mut self, name: Arc<str>, effect: Arc<dyn Effect>) {
        self.effects.push((name, effect));
        self.constant = None;
    }

    pub fn set_gyroscopic(&mut self) {
        self.gyroscopic = true;
    }

    /// Adds what a scene calls for, acting on these bodies of the block; a term of the model acts on
    /// all of them.
    pub fn call(&mut self, name: &Arc<str>, called: &Called, members: &[Member<'_>]) {
        match called {
            Called::Load(spec) => self.push_named(Arc::clone(name), spec.on(members)),
            Called::Gyroscopic => self.gyroscopic = true,
            Called::Decay(decay) => {
                self.decays.push((Arc::clone(name), *decay));
                self.decay = Some(self.decay.map_or(*decay, |before| before.and(*decay)));
            }
            Called::Limit(limit) => {
                self.limit = Some(self.limit.map_or(*limit, |before| before.and(*limit)));
            }
            Called::Off => {}
        }
    }

    /// Whether bodies keep their angular momentum (Euler's equations) and not, as in the
    /// tutorial's model, their angular velocity.
    pub fn gyroscopic(&self) -> bool {
        self.gyroscopic
    }

    /// The names of everything that is active, the model's terms included.
    pub fn names(&self) -> Vec<String> {
        let model = self.gyroscopic.then_some("gyroscopic");
        let decays = self.decays().map(|(name, _)| name);
        let limit = self.limit.map(|_| "speed_limit");
        let effects = self.effects().map(|(name, _)| name);
        let all = model.into_iter().chain(decays).chain(limit).chain(effects);
        all.map(str::to_owned).collect()
    }

    /// Everything that applies a force or a torque, by name, in the order it was added. Each can be asked
    /// for its own ([`Effect::add`]).
    pub fn effects(&self) -> impl Iterator<Item = (&str, &dyn Effect)> {
        let effects = self.effects.iter();
        effects.map(|(name, effect)| (name.as_ref(), effect.as_ref()))
    }

    /// Every decay of the velocities, by name.
    pub fn decays(&self) -> impl Iterator<Item = (&str, &Decay)> {
        let decays = self.decays.iter();
        decays.map(|(name, decay)| (name.as_ref(), decay))
    }

    /// Whether any force or torque is applied.
    pub fn applies(&self) -> bool {
        !self.effects.is_empty()
    }

    /// Exponential decay of the velocities, where the scene has it.
    pub fn decay(&self) -> Option<&Decay> {
        self.decay.as_ref()
    }

    /// What the velocities are cut to after each step, where the scene has it.
    pub fn limit(&self) -> Option<&SpeedLimit> {
        self.limit.as_ref()
    }

    /// Takes the sum of what is applied once and for all, where it depends on nothing: from here on
    /// the load is one on these bodies alone.
    pub fn settle(&mut self, t: f64, inertial: &InertialBlock, state: &StateBlock) {
        self.constant = None;
        if self.applies() && self.depends(inertial).is_constant() {
            self.constant = self.wrench(t, inertial, state);
        }
    }

    /// What is applied, where it was found to be constant ([`Load::settle`]).
    pub fn constant(&self) -> Option<&WrenchBlock> {
        self.constant.as_ref()
    }

    /// Whether what is applied may change: neither nothing nor found to be constant.
    pub fn varies(&self) -> bool {
        self.applies() && self.constant.is_none()
    }

    /// The sum of what is applied, in the order the effects were added: without the gyroscopic
    /// term, without decay. `None` where nothing is.
    pub fn wrench(
        &self,
        t: f64,
        inertial: &InertialBlock,
        state: &StateBlock,
    ) -> Option<WrenchBlock> {
        self.wrench_in(&mut None, t, inertial, state).copied()
    }

    /// The same without a copy: what was found to be constant, or a sum that is made in `room`.
    pub fn wrench_in<'a>(
        &'a self,
        room: &'a mut Option<WrenchBlock>,
        t: f64,
        inertial: &InertialBlock,
        state: &StateBlock,
    ) -> Option<&'a WrenchBlock> {
        if !self.varies() {
            return self.constant();
        }
        let wrench = room.insert(WrenchBlock::default());
        for (_, effect) in &self.effects {
            effect.add(t, inertial, state, wrench);
        }
        Some(wrench)
    }

    /// What the applied forces and torques depend on.
    pub fn depends(&self, inertial: &InertialBlock) -> Depends {
        let each = self.effects().map(|(_, effect)| effect.depends(inertial));
        each.collect()
    }

    /// What acts on one lane: not what events do to its neighbours.
    fn on_lane(&self, lane: usize) -> impl Iterator<Item = &dyn Effect> {
        let effects = self.effects().map(|(_, effect)| effect);
        effects.filter(move |effect| effect.lanes().holds(lane))
    }

    /// Whether what is applied to a body changes with time by itself, whatever the body does.
    pub fn changes_with_time(&self, lane: usize, inertial: &InertialBlock) -> bool {
        self.on_lane(lane)
            .any(|effect| effect.depends(inertial).time)
    }

    /// What acts on one lane as constant forces and torques, where it is nothing else.
    pub fn terms_of(&self, lane: usize, inertial: &InertialBlock) -> Option<Vec<Term>> {
        let mut own = Vec::new();
        for effect in self.on_lane(lane) {
            let terms = effect.terms(inertial)?.into_iter();
            own.extend(terms.filter(|term| term.lane() == lane));
        }
        Some(own)
    }

    /// All effects as constant forces and torques, where they are nothing else.
    pub fn terms(&self, inertial: &InertialBlock) -> Option<Vec<Term>> {
        let each = self.effects().map(|(_, effect)| effect.terms(inertial));
        let terms: Option<Vec<Vec<Term>>> = each.collect();
        Some(terms?.concat())
    }
}

/// The axes in which a vector or a point is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Frame {
    /// Fixed in space.
    World(Vector3<f64>),
    /// Turning with the body: principal axes; a point counts from the reference point.
    Principal(Vector3<f64>),
}

impl Frame {
    /// The direction in world axes.
    #[inline]
    pub fn vector_w(&self, state: &State) -> Vector3<f64> {
        match *self {
            Frame::World(v) => v,
            Frame::Principal(v) => state.to_world(v),
        }
    }

    /// The point in the world.
    #[inline]
    pub fn point_w(&self, state: &State) -> Vector3<f64> {
        match *self {
            Frame::World(p) => p,
            Frame::Principal(p) => state.x_w + state.to_world(p),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Inertial;
    use crate::effect::{Couple, Push};
    use nalgebra::Quaternion;

    fn body() -> (InertialBlock, StateBlock) {
        let (mut inertial, mut state) = (InertialBlock::default(), StateBlock::default());
        let moments = Vector3::new(1.0, 2.0, 2.5);
        let body = Inertial {
            mass: 2.0,
            inv_mass: 0.5,
            moments,
            inv_moments: moments.map(|i| 1.0 / i),
            centre_p: Vector3::zeros(),
        };
        inertial.set(0, body);
        let at = State {
            x_w: Vector3::new(1.0, -2.0, 0.5),
            v_w: Vector3::new(0.1, 0.2, 0.3),
            q_wp: Quaternion::new(0.5, 0.5, -0.5, 0.5),
            omega_w: Vector3::new(1.0, 2.0, 3.0),
        };
        state.set(0, at);
        (inertial, state)
    }

    #[test]
    fn what_depends_on_nothing_is_summed_once_and_is_the_same_sum() {
        let (inertial, state) = body();
        let mut load = Load::default();
        load.settle(0.0, &inertial, &state);
        assert!(!load.varies() && load.constant().is_none());
        load.push(Arc::new(Push {
            lane: 0,
            force: Frame::World(Vector3::new(0.1, -0.2, 0.7)),
            point: Frame::Principal(Vector3::zeros()),
        }));
        for torque in [Vector3::new(0.1, 0.2, 0.3), Vector3::new(-0.7, 0.4, 0.2)] {
            let torque = Frame::World(torque);
            load.push(Arc::new(Couple { lane: 0, torque }));
        }
        assert!(load.varies());
        let each_time = load.wrench(3.0, &inertial, &state).unwrap().get(0);
        load.settle(0.0, &inertial, &StateBlock::default());
        assert!(!load.varies());
        let once = load.wrench(3.0, &inertial, &state).unwrap().get(0);
        assert_eq!(once, each_time);
        assert_eq!(load.constant().map(|wrench| wrench.get(0)), Some(once));
    }

    #[test]
    fn what_turns_with_the_body_is_asked_for_each_time() {
        let (inertial, state) = body();
        let mut load = Load::default();
        let torque = Frame::World(Vector3::x());
        load.push(Arc::new(Couple { lane: 0, torque }));
        load.settle(0.0, &inertial, &state);
        assert!(!load.varies());
        // One more, and the sum is no longer what it was.
        let torque = Frame::Principal(Vector3::x());
        load.push(Arc::new(Couple { lane: 0, torque }));
        assert!(load.varies());
        load.settle(0.0, &inertial, &state);
        assert!(load.varies() && load.constant().is_none());
        let tau_w = load.wrench(0.0, &inertial, &state).unwrap().get(0).tau_w;
        assert_eq!(tau_w, Vector3::x() + state.get(0).to_world(Vector3::x()));
    }
}
