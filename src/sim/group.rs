//! Up to eight bodies stepped together, and their translation to and from body axes.

use crate::body::{Inertial, InertialBlock, LANES, State, StateBlock};
use crate::effect::{Called, Couple, Effect, Frame, Load, Push};
use crate::integrator::Method;
use crate::scene::{Action, Body, Framed, Scene};
use crate::trace::{Moment, Motion, PointForce, Subject};
use nalgebra::{UnitQuaternion, Vector3};
use std::ops::Range;
use std::sync::Arc;

pub struct Group {
    /// Indices of its bodies in the scene; `members.start` is lane 0.
    pub members: Range<usize>,
    inertial: InertialBlock,
    state: StateBlock,
    load: Load,
    /// The pushes in `load`, for the force arrows.
    pushes: Vec<Push>,
    /// Principal axes → body axes of each lane.
    q_bp: [UnitQuaternion<f64>; LANES],
    /// The turn that the last step but the broken one made is judged by this velocity.
    last_finite: StateBlock,
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
        let tensor = r.matrix() * diagonal * r.matrix().transpose();
        (tensor + tensor.transpose()) * 0.5
    };
    Subject {
        name: body.name.clone(),
        label: body.label.clone(),
        mass: body.properties.mass(),
        pivot_b: body.pivot_b,
        pivot_w: body
            .pivot_b
            .map(|pivot_b| body.position_w + body.q_wb * pivot_b),
        inertia_b: turned(inertial.moments),
        inverse_inertia_b: turned(inertial.inv_moments),
        inertia_c: body.properties.inertia_about(Vector3::zeros()),
        start: Motion {
            position_w: body.position_w,
            velocity_w: body.velocity_w,
            q_wb: body.q_wb,
            omega_w: body.omega_w,
        },
        solid: body.solid.clone(),
    }
}

/// The bodies of a scene in groups of eight, at rest as the scene starts them.
pub fn groups(bodies: &[Body]) -> Vec<Group> {
    let starts = (0..bodies.len()).step_by(LANES);
    starts
        .map(|start| {
            let members = start..(start + LANES).min(bodies.len());
            Group::new(members.clone(), &bodies[members])
        })
        .collect()
}

impl Group {
    fn new(members: Range<usize>, bodies: &[Body]) -> Self {
        let mut group = Self {
            members,
            inertial: InertialBlock::default(),
            state: StateBlock::default(),
            load: Load::default(),
            pushes: Vec::new(),
            q_bp: [UnitQuaternion::identity(); LANES],
            last_finite: StateBlock::default(),
        };
        for (lane, body) in bodies.iter().enumerate() {
            let (inertial, q_bp) = Inertial::new(&body.properties, body.pivot_b);
            group.q_bp[lane] = q_bp;
            group.inertial.set(lane, inertial);
            group.state.set(lane, start(body, q_bp));
        }
        group.last_finite = group.state;
        group
    }

    pub fn step(&mut self, method: &dyn Method, t: f64, h: f64) {
        self.last_finite = self.state;
        method.step(t, h, &self.load, &self.inertial, &mut self.state);
    }

    /// The first body whose state is not finite.
    pub fn first_not_finite(&self) -> Option<usize> {
        let lost = |lane: &usize| !self.state.get(*lane).is_finite();
        let lane = (0..self.members.len()).find(lost)?;
        Some(self.members.start + lane)
    }

    /// Radians a body turned in a step of `h` before its state was lost.
    pub fn turn_before_loss(&self, body: usize, h: f64) -> f64 {
        let lane = body - self.members.start;
        self.last_finite.get(lane).omega_w.norm() * h
    }

    /// The effects of the scene and the active events that concern this group.
    pub fn load(&mut self, scene: &Scene, active: &[usize]) {
        self.load = Load::default();
        self.pushes.clear();
        for (_, effect) in &scene.effects {
            match effect {
                Called::Load(effect) => self.load.push(Arc::clone(effect)),
                Called::Decay(decay) => self.load.set_decay(*decay),
                Called::Off => {}
            }
        }
        for event in active.iter().map(|&k| &scene.events[k]) {
            if !self.members.contains(&event.body) {
                continue;
            }
            let lane = event.body - self.members.start;
            match event.action {
                Action::Push { force, point, .. } => {
                    let push = Push {
                        lane,
                        force: self.direction(lane, force),
                        point: self.point(lane, point),
                    };
                    self.pushes.push(push);
                    self.load.push(Arc::new(push) as Arc<dyn Effect>);
                }
                Action::Torque { torque, .. } => {
                    let torque = self.direction(lane, torque);
                    self.load.push(Arc::new(Couple { lane, torque }));
                }
                Action::Impulse { .. } | Action::AngularImpulse { .. } => {}
            }
        }
    }

    /// An impulse at a point (N·s) or, without one, an angular impulse (N·m·s):
    /// `Δv = J/m`, `Δω = I_w⁻¹ ((p - x) × J)`. Returns the angular impulse and Δω.
    pub fn strike(
        &mut self,
        index: usize,
        impulse: Framed,
        point: Option<Framed>,
    ) -> (Vector3<f64>, Vector3<f64>) {
        let lane = index - self.members.start;
        let mut state = self.state.get(lane);
        let inertial = self.inertial.get(lane);
        let impulse_w = self.direction(lane, impulse).vector_w(&state);
        let angular_w = match point {
            None => impulse_w,
            Some(point) => {
                state.v_w += impulse_w * inertial.inv_mass;
                let arm_w = self.point(lane, point).point_w(&state) - state.x_w;
                arm_w.cross(&impulse_w)
            }
        };
        let turn_w = inertial.angular_response(&state, angular_w);
        state.omega_w += turn_w;
        self.state.set(lane, state);
        (angular_w, turn_w)
    }

    /// The states as poses of the bodies' own axes and centres of mass.
    pub fn motions(&self) -> impl Iterator<Item = Motion> + '_ {
        (0..self.members.len()).map(|lane| self.motion(lane))
    }

    /// The states and what the model says follows, at time `t`.
    pub fn moments(&self, t: f64) -> Vec<Moment> {
        let total = self.load.wrench(t, &self.inertial, &self.state);
        let applied = self.load.applied(t, &self.inertial, &self.state);
        let rate = self.load.decay().map(|decay| decay.angular_rate());
        let moment = |lane| {
            let (state, inertial) = (self.state.get(lane), self.inertial.get(lane));
            let mut tau_w = applied.get(lane).tau_w;
            let mut alpha_w = inertial.angular_response(&state, total.get(lane).tau_w);
            if let Some(rate) = rate {
                tau_w -= inertial.momentum_w(&state) * rate;
                alpha_w -= state.omega_w * rate;
            }
            let pushes = self.pushes.iter().filter(|push| push.lane == lane);
            Moment {
                motion: self.motion(lane),
                tau_w,
                alpha_w,
                pushes: pushes.map(|push| acting(push, &state)).collect(),
            }
        };
        (0..self.members.len()).map(moment).collect()
    }

    fn motion(&self, lane: usize) -> Motion {
        let state = self.state.get(lane);
        let arm_w = state.to_world(self.inertial.get(lane).centre_p);
        let q_wp = UnitQuaternion::new_unchecked(state.q_wp);
        Motion {
            position_w: state.x_w + arm_w,
            velocity_w: state.v_w + state.omega_w.cross(&arm_w),
            q_wb: q_wp * self.q_bp[lane].inverse(),
            omega_w: state.omega_w,
        }
    }

    fn direction(&self, lane: usize, vector: Framed) -> Frame {
        match vector {
            Framed::World(v) => Frame::World(v),
            Framed::Body(v) => Frame::Principal(self.q_bp[lane].inverse() * v),
        }
    }

    fn point(&self, lane: usize, point: Framed) -> Frame {
        match point {
            Framed::World(p) => Frame::World(p),
            Framed::Body(p) => {
                let from_centre_p = self.q_bp[lane].inverse() * p;
                Frame::Principal(from_centre_p + self.inertial.get(lane).centre_p)
            }
        }
    }
}

/// The state a scene starts a body in: about its reference point, in its principal axes.
fn start(body: &Body, q_bp: UnitQuaternion<f64>) -> State {
    let (x_w, v_w) = match body.pivot_b {
        Some(pivot_b) => (body.position_w + body.q_wb * pivot_b, Vector3::zeros()),
        None => (body.position_w, body.velocity_w),
    };
    State {
        x_w,
        v_w,
        q_wp: (body.q_wb * q_bp).into_inner(),
        omega_w: body.omega_w,
    }
}

fn acting(push: &Push, state: &State) -> PointForce {
    PointForce {
        force_w: push.force.vector_w(state),
        point_w: push.point.point_w(state),
    }
}
