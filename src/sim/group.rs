//! Up to eight bodies stepped together, and their translation to and from body axes.

use super::Jump;
use super::choose::{Choice, Choose, Setting};
use super::script::{Acting, Own};
use super::sources::Parts;
use crate::body::{Inertial, InertialBlock, LANES, State, StateBlock};
use crate::effect::{Decay, Frame, Load, Member, Pulse, Push, Term, WrenchBlock};
use crate::integrator::{Interval, Kind, Method, Refusal, Step, Stepper, Work};
use crate::mass::tensor;
use crate::scene::{Body, Change, Event, Framed, Scene, lasting};
use crate::trace::{Deviation, Instant, Motion, PointForce, Poses, Sample, StreamSet, Subject};
use nalgebra::{UnitQuaternion, Vector3};
use std::ops::Range;
use std::sync::Arc;

#[derive(Clone)]
pub struct Group {
    /// Indices of its bodies in the scene; `members.start` is lane 0.
    pub members: Range<usize>,
    inertial: InertialBlock,
    state: StateBlock,
    load: Load,
    /// The pushes in `load` at their peaks, for the force arrows.
    pushes: Vec<(Push, Pulse)>,
    /// What is told apart of what turns each lane, by name.
    sources: Vec<Vec<String>>,
    /// Body axes → principal axes of each lane.
    q_pb: [UnitQuaternion<f64>; LANES],
    /// The method on its way from the last event on.
    stepper: Option<Box<dyn Stepper>>,
    /// The stepper before the stretch that is being taken, and the states kept of it.
    before: Option<Box<dyn Stepper>>,
    kept: Arc<Vec<StateBlock>>,
    /// Room for those of other stretches: the last ones may still be on their way to be recorded.
    room: Vec<Arc<Vec<StateBlock>>>,
    /// By name.
    pub method: &'static str,
    /// How it gets through time.
    pub steps: Option<Kind>,
    /// Its way since it last set out.
    pub choice: Option<Choice>,
    /// What the steppers before this one did.
    done: Work,
}

/// A force that is constant in the world, at a point of a body.
#[derive(Clone, Copy, Debug)]
pub struct Weight {
    /// N.
    pub force_w: Vector3<f64>,
    /// From the reference point, body axes, m.
    pub point_b: Vector3<f64>,
}

/// What about a body does not change, for the trace.
pub fn subject(body: &Body) -> Subject {
    let (inertial, q_bp) = Inertial::new(&body.properties, body.pivot_b);
    let turned = |moments: Vector3<f64>| {
        let r = q_bp.to_rotation_matrix();
        let diagonal = nalgebra::Matrix3::from_diagonal(&moments);
        if r.matrix() == &nalgebra::Matrix3::identity() {
            return diagonal;
        }
        tensor::turned(&diagonal, r.matrix())
    };
    Subject {
        name: body.name.clone(),
        label: body.label.clone(),
        mass: body.properties.mass(),
        pivot_b: body.pivot_b,
        pivot_w: body
            .pivot_b
            .map(|pivot_b| body.position_w + body.q_wb * pivot_b),
        held: body.properties.immovable(),
        inertia_b: turned(inertial.moments),
        inverse_inertia_b: turned(inertial.inv_moments),
        inertia_c: body.properties.inertia_about(Vector3::zeros()),
        start: Motion {
            position_w: body.position_w,
            velocity_w: body.velocity_w,
            q_wb: body.q_wb,
            omega_w: body.omega_w,
        },
        sources: Vec::new(),
        swarm: body.swarm.clone(),
        solid: body.solid.clone(),
    }
}

/// The bodies of a scene in groups of neighbours, at most `width` (up to eight) that go by one model and
/// method, as the scene starts them.
pub fn groups(scene: &Scene, width: usize) -> Vec<Group> {
    let mut groups = Vec::new();
    let mut start = 0;
    for next in 1..=scene.bodies.len() {
        let full = next - start >= width;
        let end = next == scene.bodies.len();
        if end || full || !scene.go_together(start, next) {
            groups.push(Group::new(start..next, &scene.bodies[start..next]));
            start = next;
        }
    }
    groups
}

impl Group {
    fn empty() -> Self {
        Self {
            members: 0..0,
            inertial: InertialBlock::default(),
            state: StateBlock::default(),
            load: Load::default(),
            pushes: Vec::new(),
            sources: Vec::new(),
            q_pb: [UnitQuaternion::identity(); LANES],
            stepper: None,
            before: None,
            kept: Arc::default(),
            room: Vec::new(),
            method: "",
            steps: None,
            choice: None,
            done: Work::default(),
        }
    }

    fn new(members: Range<usize>, bodies: &[Body]) -> Self {
        let mut group = Self {
            members,
            ..Self::empty()
        };
        for (lane, body) in bodies.iter().enumerate() {
            let member = body.member(lane);
            group.q_pb[lane] = member.q_pb;
            group.inertial.set(lane, member.inertial);
            group.state.set(lane, body.start(member.q_pb));
        }
        group
    }

    /// Sets out from here, at time `t`, by the way that is chosen for the time `until` the next
    /// event.
    pub fn set_out(&mut self, chooser: &mut dyn Choose, t: f64, until: f64) {
        let interval = self.interval(until);
        let choice = chooser.choose(&Setting {
            members: self.members.clone(),
            interval: &interval,
            from: t,
            state: &self.state,
        });
        self.done = self.work();
        self.method = choice.method.info().name;
        self.steps = Some(choice.method.info().kind);
        self.choice = Some(choice);
        self.stepper = Some(choice.start(interval, t, &self.state));
    }

    /// Why a method does not take what acts now.
    pub fn refusal(&self, method: &dyn Method) -> Option<Refusal> {
        method.info().refuses(&self.load, &self.inertial)
    }

    fn interval(&self, until: f64) -> Interval {
        Interval {
            load: self.load.clone(),
            inertial: self.inertial,
            bodies: self.members.len(),
            until,
            tolerance: 0.0,
        }
    }

    /// The forces on a body, where its model keeps their energy: Euler's equations without damping
    /// or a speed limit, and nothing but forces that are constant in the world at points of the body.
    pub fn weights(&self, body: usize) -> Option<Vec<Weight>> {
        let lane = body - self.members.start;
        if self.load.decay().is_some() || self.load.limit().is_some() || !self.load.gyroscopic() {
            return None;
        }
        let terms = self.load.terms_of(lane, &self.inertial)?;
        let q_bp = self.q_pb[lane].inverse();
        let weight = |term: Term| match term {
            Term::Force {
                force: Frame::World(force_w),
                point: Frame::Principal(point_p),
                ..
            } => Some(Weight {
                force_w,
                point_b: q_bp * point_p,
            }),
            _ => None,
        };
        terms.into_iter().map(weight).collect()
    }

    /// Takes a stretch of steps. Where a body's state is lost it stops after that step: how many
    /// steps it took, and the body.
    pub fn advance(&mut self, steps: &[Step]) -> Option<(usize, usize)> {
        self.before.clone_from(&self.stepper);
        self.take(steps);
        self.first_not_finite()?;
        // Once lost, a state stays lost: find the step by taking them singly.
        self.rewind();
        let mut singly = steps.to_vec();
        for (k, step) in singly.iter_mut().enumerate() {
            step.keep = true;
            self.take(std::slice::from_ref(step));
            if let Some(body) = self.first_not_finite() {
                return Some((k + 1, body));
            }
        }
        None
    }

    /// Takes steps, whatever comes of it.
    pub fn take(&mut self, steps: &[Step]) {
        let Some(stepper) = &mut self.stepper else {
            return;
        };
        let last = std::mem::take(&mut self.kept);
        self.room.push(last);
        let free = self
            .room
            .iter()
            .position(|room| Arc::strong_count(room) == 1);
        let room = free.map(|k| self.room.swap_remove(k));
        let mut kept = room.and_then(Arc::into_inner).unwrap_or_default();
        kept.clear();
        stepper.advance(steps, &mut kept);
        self.kept = Arc::new(kept);
        self.state = stepper.state();
    }

    /// Takes the last stretch again, as far as these steps go and whatever comes of it.
    pub fn retake(&mut self, steps: &[Step]) {
        self.rewind();
        self.take(steps);
    }

    /// Lets go of the last stretch: what is kept of it, and how to take it again.
    pub fn forget(&mut self) {
        // What is still on its way to be recorded is kept there.
        self.kept = Arc::default();
        self.room.clear();
        self.before = None;
    }

    /// Bytes it takes where nothing is kept.
    pub fn bytes(&self) -> usize {
        let stepper = self.stepper.as_ref().map_or(0, |stepper| stepper.bytes());
        let effects = self.load.effects().count() * size_of::<(std::sync::Arc<str>, Term)>();
        // The stepper has a load of its own.
        size_of::<Self>() + stepper + 2 * effects
    }

    /// What turns a body, by its name: all that is active.
    pub fn torques(&self, body: usize, t: f64) -> Vec<(String, Vector3<f64>)> {
        let lane = body - self.members.start;
        let mut names = self.load.names();
        let mut seen = std::collections::HashSet::new();
        names.retain(|name| name != "speed_limit" && seen.insert(name.clone()));
        let parts = Parts::of(&self.load, t, &self.inertial, &self.state);
        let (inertial, state) = (self.inertial.get(lane), self.state.get(lane));
        let torques = parts.torques(&names, (&self.load, lane), &inertial, &state);
        names.into_iter().zip(torques).collect()
    }

    /// Back to before the last stretch.
    fn rewind(&mut self) {
        self.stepper.clone_from(&self.before);
        if let Some(stepper) = &self.stepper {
            self.state = stepper.state();
        }
    }

    /// The first body whose state is not finite.
    fn first_not_finite(&self) -> Option<usize> {
        let lost = |lane: &usize| !self.state.get(*lane).is_finite();
        let lane = (0..self.members.len()).find(lost)?;
        Some(self.members.start + lane)
    }

    pub fn is_finite(&self, body: usize) -> bool {
        self.state.get(body - self.members.start).is_finite()
    }

    /// Radians a body turned in a step of `h` before its state was lost: the last turn in which
    /// the body still turned less than a whole turn, or the first there is.
    pub fn turn_in_a_step(&self, body: usize, h: f64) -> f64 {
        let lane = body - self.members.start;
        let turn = |block: &StateBlock| block.get(lane).omega_w.norm() * h;
        let sane = self
            .kept
            .iter()
            .map(turn)
            .rfind(|&x| x < std::f64::consts::TAU);
        let before = self.before.as_ref().map(|stepper| turn(&stepper.state()));
        sane.or(before).unwrap_or(f64::NAN)
    }

    /// The larger damping rate times a step of `h`: how far velocities decay in it.
    pub fn decay_in_a_step(&self, h: f64) -> f64 {
        let rate = |decay: &Decay| decay.linear_rate().max(decay.angular_rate());
        h * self.load.decay().map_or(0.0, rate)
    }

    pub fn is_gyroscopic(&self) -> bool {
        self.load.gyroscopic()
    }

    pub fn work(&self) -> Work {
        let now = self.stepper.as_ref().map(|stepper| stepper.work());
        self.done + now.unwrap_or_default()
    }

    /// Whether it takes the clock's steps, or pieces of them, and no others.
    pub fn is_paced_by_the_clock(&self) -> bool {
        self.steps != Some(Kind::Adaptive)
    }

    /// Radians that the fastest of its bodies turns in a step of `h` as they turn now.
    pub fn farthest_turn(&self, h: f64) -> f64 {
        let speeds = (0..self.members.len()).map(|lane| self.state.get(lane).omega_w.norm());
        h * speeds.fold(0.0, f64::max)
    }

    /// What its method declares of a step of the clock, in steps of rk4; nothing where it has steps of its own.
    pub fn work_a_step(&self) -> f64 {
        let Some(choice) = self.choice.filter(|_| self.is_paced_by_the_clock()) else {
            return 0.0;
        };
        let weight = choice.method.info().cost.weight;
        // Of a block those weigh least that take its lanes at once. (What two engines do is as light, and goes body by
        // body.)
        let bodies = match weight <= 1.0 {
            true => 1,
            false => self.members.len(),
        };
        weight * f64::from(choice.pieces) * bodies as f64
    }

    /// The work of steps of its own since it set out, in steps of rk4.
    pub fn counted_work(&self) -> f64 {
        match (&self.choice, &self.stepper) {
            (Some(choice), Some(stepper)) if !self.is_paced_by_the_clock() => {
                choice.method.info().cost.weight * stepper.work().steps as f64
            }
            _ => 0.0,
        }
    }

    /// The effects of the scene that are on, and the active events that concern this group.
    pub fn load(&mut self, scene: &Scene, acting: &Acting) {
        let bodies = scene.bodies[self.members.clone()].iter().enumerate();
        let members = bodies.map(|(lane, body)| Member {
            lane,
            inertial: self.inertial.get(lane),
            q_pb: self.q_pb[lane],
            body,
        });
        let members: Vec<Member<'_>> = members.collect();
        self.load = lasting(scene, self.members.start, &members, &acting.on);
        self.pushes.clear();
        for acting in &acting.events {
            if !self.members.contains(&acting.body) {
                continue;
            }
            let lane = acting.body - self.members.start;
            let (inertial, q_pb) = (self.inertial.get(lane), self.q_pb[lane]);
            let push = acting.event.push(lane, &inertial, q_pb);
            let pulse = acting.event.pulse();
            self.pushes.extend(push.map(|push| (push, pulse)));
            if let Some(effect) = acting.event.effect(lane, &inertial, q_pb) {
                self.load.push(effect);
            }
        }
    }

    /// Tells apart what turns these bodies, from now on.
    pub fn watch(&mut self, subjects: &[Subject]) {
        self.sources = subjects.iter().map(|s| s.sources.clone()).collect();
    }

    /// What an event on a body applies by itself, at its peak.
    pub fn own(&self, body: usize, event: &Event) -> Own {
        let lane = body - self.members.start;
        let (inertial, q_pb) = (self.inertial.get(lane), self.q_pb[lane]);
        let peak = event.at_peak();
        let mut wrench = WrenchBlock::default();
        if let Some(effect) = peak.effect(lane, &inertial, q_pb) {
            effect.add(event.at, &self.inertial, &self.state, &mut wrench);
        }
        let state = self.state.get(lane);
        let push = peak.push(lane, &inertial, q_pb);
        Own {
            tau_w: wrench.get(lane).tau_w,
            push: push.map(|push| acting(&push, 1.0, &state)),
        }
    }

    /// Makes parts of a body's state what a change says. What is held stays where it is held.
    pub fn set(&mut self, body: usize, change: &Change) {
        let lane = body - self.members.start;
        let mut state = self.state.get(lane);
        if let Some(position_w) = change.position_w {
            state.x_w = position_w;
        }
        if let Some(velocity_w) = change.velocity_w {
            state.v_w = velocity_w;
        }
        if let Some(q_wb) = change.q_wb {
            state.q_wp = (q_wb * self.q_pb[lane].inverse()).into_inner();
        }
        if let Some(omega_w) = change.omega_w {
            state.omega_w = omega_w;
        }
        self.state.set(lane, state);
    }

    /// A body as it is, alone in a group.
    pub fn alone(&self, body: usize) -> Self {
        let lane = body - self.members.start;
        let mut alone = Self {
            members: body..body + 1,
            ..Self::empty()
        };
        alone.q_pb[0] = self.q_pb[lane];
        alone.inertial.set(0, self.inertial.get(lane));
        alone.state.set(0, self.state.get(lane));
        alone
    }

    /// An impulse at a point (N·s) or, without one, an angular impulse (N·m·s):
    /// `Δv = J/m`, `Δω = I_w⁻¹ ((p - x) × J)`.
    pub fn strike(&mut self, index: usize, impulse: Framed, point: Option<Framed>) -> Jump {
        let lane = index - self.members.start;
        let mut state = self.state.get(lane);
        let inertial = self.inertial.get(lane);
        let q_pb = self.q_pb[lane];
        let impulse_w = impulse.direction(q_pb).vector_w(&state);
        let strike = point.map(|point| PointForce {
            force_w: impulse_w,
            point_w: point.point(&inertial, q_pb).point_w(&state),
        });
        let angular_w = match strike {
            None => impulse_w,
            Some(at) => {
                state.v_w += impulse_w * inertial.inv_mass;
                (at.point_w - state.x_w).cross(&impulse_w)
            }
        };
        let turn_w = inertial.angular_response(&state, angular_w);
        state.omega_w += turn_w;
        self.state.set(lane, state);
        Jump {
            angular_impulse_w: angular_w,
            omega_w: turn_w,
            strike,
        }
    }

    /// Mixes the states into a hash.
    pub fn hash_into(&self, hash: u64) -> u64 {
        self.hash_of(&self.state, hash)
    }

    /// The same of the `k`-th state kept of the last stretch.
    pub fn hash_kept_into(&self, k: usize, hash: u64) -> u64 {
        self.hash_of(&self.kept[k], hash)
    }

    fn hash_of(&self, block: &StateBlock, hash: u64) -> u64 {
        let states = (0..self.members.len()).map(|lane| block.get(lane));
        states.fold(hash, |hash, state| state.hash_into(hash))
    }

    /// The states as poses of the bodies' own axes and centres of mass.
    pub fn motions(&self) -> impl Iterator<Item = Motion> + '_ {
        (0..self.members.len()).map(|lane| self.motion(lane, self.state.get(lane)))
    }

    /// The same of one body.
    pub fn motion_of(&self, body: usize) -> Motion {
        let lane = body - self.members.start;
        self.motion(lane, self.state.get(lane))
    }

    /// The same of some states kept of the last stretch, by their places in it.
    pub fn poses_kept(&self, states: &Arc<[usize]>, instants: &Arc<[Instant]>) -> Poses {
        let (states, kept) = (Arc::clone(states), Arc::clone(&self.kept));
        let axes: [Axes; LANES] = std::array::from_fn(|lane| self.axes_of(lane));
        let count = self.members.len();
        Poses {
            bodies: self.members.clone(),
            instants: Arc::clone(instants),
            bytes: size_of_val(kept.as_slice()),
            motions: Box::new(move || {
                let mut motions = Vec::with_capacity(states.len() * count);
                for &k in states.iter() {
                    let lanes = axes.iter().enumerate().take(count);
                    motions.extend(lanes.map(|(lane, axes)| axes.motion(kept[k].get(lane))));
                }
                motions
            }),
        }
    }

    fn axes_of(&self, lane: usize) -> Axes {
        Axes {
            centre_p: self.inertial.get(lane).centre_p,
            q_pb: self.q_pb[lane],
        }
    }

    /// The states and what the model says follows, at time `t`.
    pub fn samples(&self, t: f64) -> Vec<Sample> {
        self.samples_of(t, &self.state, true)
    }

    /// The same of the `k`-th state kept of the last stretch, which was at time `t`; whether its torques
    /// are told apart.
    pub fn samples_kept(&self, k: usize, t: f64, apart: bool) -> Vec<Sample> {
        self.samples_of(t, &self.kept[k], apart)
    }

    fn samples_of(&self, t: f64, block: &StateBlock, apart: bool) -> Vec<Sample> {
        let wrench = self.wrench(t, block);
        let parts = apart.then(|| self.parts(t, block));
        (0..self.members.len())
            .map(|lane| self.sample_of(lane, block.get(lane), (t, &wrench), parts.as_ref()))
            .collect()
    }

    /// The same of one body.
    pub fn sample(&self, body: usize, t: f64) -> Sample {
        let wrench = self.wrench(t, &self.state);
        let parts = self.parts(t, &self.state);
        let lane = body - self.members.start;
        self.sample_of(lane, self.state.get(lane), (t, &wrench), Some(&parts))
    }

    /// Each effect's own share, where any body wants to know it.
    fn parts(&self, t: f64, block: &StateBlock) -> Parts<'_> {
        match self.sources.iter().all(Vec::is_empty) {
            true => Parts::default(),
            false => Parts::of(&self.load, t, &self.inertial, block),
        }
    }

    fn wrench(&self, t: f64, block: &StateBlock) -> WrenchBlock {
        let wrench = self.load.wrench(t, &self.inertial, block);
        wrench.unwrap_or_default()
    }

    fn sample_of(
        &self,
        lane: usize,
        state: State,
        (t, wrench): (f64, &WrenchBlock),
        parts: Option<&Parts<'_>>,
    ) -> Sample {
        let inertial = self.inertial.get(lane);
        let mut tau_w = wrench.get(lane).tau_w;
        let mut alpha_w = match self.load.gyroscopic() {
            true => inertial.gyroscopic_response(&state, tau_w),
            false => inertial.angular_response(&state, tau_w),
        };
        if let Some(decay) = self.load.decay() {
            tau_w -= inertial.momentum_w(&state) * decay.angular_rate();
            alpha_w -= state.omega_w * decay.angular_rate();
        }
        let pushes = self.pushes.iter().filter(|(push, _)| push.lane == lane);
        let pushes = pushes.map(|(push, pulse)| acting(push, pulse.part(t), &state));
        Sample {
            due: StreamSet::none(),
            shown: true,
            motion: self.motion(lane, state),
            tau_w,
            alpha_w,
            pushes: pushes.collect(),
            sources: match (self.sources.get(lane), parts) {
                (Some(names), Some(parts)) => {
                    parts.torques(names, (&self.load, lane), &inertial, &state)
                }
                _ => Vec::new(),
            },
            deviation: Deviation::default(),
            step_time: None,
        }
    }

    fn motion(&self, lane: usize, state: State) -> Motion {
        self.axes_of(lane).motion(state)
    }
}

/// A body's own axes and centre of mass, as its state sees them.
#[derive(Clone, Copy)]
struct Axes {
    /// From the reference point, principal axes, m.
    centre_p: Vector3<f64>,
    /// Body axes → principal axes.
    q_pb: UnitQuaternion<f64>,
}

impl Axes {
    fn motion(&self, state: State) -> Motion {
        let arm_w = state.to_world(self.centre_p);
        let q_wp = UnitQuaternion::new_unchecked(state.q_wp);
        Motion {
            position_w: state.x_w + arm_w,
            velocity_w: state.v_w + state.omega_w.cross(&arm_w),
            q_wb: q_wp * self.q_pb,
            omega_w: state.omega_w,
        }
    }
}

/// A part of a push.
fn acting(push: &Push, part: f64, state: &State) -> PointForce {
    PointForce {
        force_w: push.force.vector_w(state) * part,
        point_w: push.point.point_w(state),
    }
}
