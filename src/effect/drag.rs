//! Drag, linear and quadratic, the same in every direction:
//!
//! ```text
//! F = -(b1 + b2 |v|) v at the centre of mass      τ = -(c1 + c2 |ω|) ω
//! ```
//!
//! v is the velocity of the centre of mass, so a body held at a pivot is braked by its way through the
//! air too: `(R c) × F`, c from the pivot to the centre of mass. Linear: a small or slow body in a viscous
//! fluid (Stokes: b1 = 6π η r, c1 = 8π η r³ of a sphere; Landau & Lifshitz, Fluid Mechanics, § 20). Quadratic:
//! a large or fast one (b2 = ½ ρ C A). At a high ratio of drag to mass a method of fixed steps needs
//! (b1 + b2 |v|) h/m well below 1: the rate is not bounded as that of `damping` is.

use super::{
    Argument, Called, Depends, Effect, EffectKind, Member, Spec, WrenchBlock, lanes as lanes_of,
};
use crate::body::{InertialBlock, LANES, LaneSet, StateBlock};
use multiversion::multiversion;
use std::sync::Arc;

pub const KIND: EffectKind = EffectKind {
    name: "drag",
    argument: Argument::Table(&[
        ("linear", Argument::Number("N·s/m")),
        ("quadratic", Argument::Number("N·s²/m²")),
        ("angular_linear", Argument::Number("N·m·s")),
        ("angular_quadratic", Argument::Number("N·m·s²")),
    ]),
    equation: "F = -(b1 + b2 |v|) v at the centre of mass, τ = -(c1 + c2 |ω|) ω",
    about: "a fluid's drag on a body as it moves (linear, quadratic) and as it turns (angular_linear, angular_quadratic)",
    make: |value, _| {
        let drag = Drag {
            linear: value.not_negative("linear")?,
            quadratic: value.not_negative("quadratic")?,
            angular_linear: value.not_negative("angular_linear")?,
            angular_quadratic: value.not_negative("angular_quadratic")?,
        };
        Ok(match drag {
            Drag::NONE => Called::Off,
            drag => Called::Load(Arc::new(drag)),
        })
    },
};

#[derive(Clone, Copy, Debug, PartialEq)]
struct Drag {
    /// b1, N·s/m.
    linear: f64,
    /// b2, N·s²/m².
    quadratic: f64,
    /// c1, N·m·s.
    angular_linear: f64,
    /// c2, N·m·s².
    angular_quadratic: f64,
}

impl Drag {
    const NONE: Self = Self {
        linear: 0.0,
        quadratic: 0.0,
        angular_linear: 0.0,
        angular_quadratic: 0.0,
    };

    fn moves(&self) -> bool {
        self.linear > 0.0 || self.quadratic > 0.0
    }

    fn turns(&self) -> bool {
        self.angular_linear > 0.0 || self.angular_quadratic > 0.0
    }
}

impl Spec for Drag {
    fn on(&self, members: &[Member<'_>]) -> Arc<dyn Effect> {
        Arc::new(Dragged {
            drag: *self,
            lanes: lanes_of(members),
        })
    }
}

/// Drag on some bodies of a block.
#[derive(Debug)]
struct Dragged {
    drag: Drag,
    lanes: LaneSet,
}

impl Effect for Dragged {
    fn name(&self) -> &'static str {
        "drag"
    }

    fn lanes(&self) -> LaneSet {
        self.lanes
    }

    fn add(&self, _t: f64, inertial: &InertialBlock, state: &StateBlock, wrench: &mut WrenchBlock) {
        brake(self.lanes, self.drag, inertial, state, wrench);
    }

    fn depends(&self, inertial: &InertialBlock) -> Depends {
        // The lever from the reference point turns with the body.
        let levered = |lane: usize| inertial.get(lane).centre_p.norm_squared() > 0.0;
        let lever = self.drag.moves() && self.lanes.iter().any(levered);
        Depends {
            torque: self.drag.turns() || lever,
            velocity: true,
            place: lever,
            time: false,
        }
    }
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2", "aarch64+neon"))]
fn brake(
    lanes: LaneSet,
    drag: Drag,
    inertial: &InertialBlock,
    state: &StateBlock,
    wrench: &mut WrenchBlock,
) {
    if lanes == LaneSet::ALL {
        for lane in 0..LANES {
            brake_one(lane, drag, inertial, state, wrench);
        }
    } else {
        for lane in lanes.iter() {
            brake_one(lane, drag, inertial, state, wrench);
        }
    }
}

#[inline(always)]
fn brake_one(
    lane: usize,
    drag: Drag,
    inertial: &InertialBlock,
    state: &StateBlock,
    wrench: &mut WrenchBlock,
) {
    let s = state.get(lane);
    let arm_w = s.to_world(inertial.get(lane).centre_p);
    let v_w = s.v_w + s.omega_w.cross(&arm_w);
    let force_w = v_w * -(drag.linear + drag.quadratic * v_w.norm());
    let tau_w = s.omega_w * -(drag.angular_linear + drag.angular_quadratic * s.omega_w.norm());
    wrench.add(lane, force_w, arm_w.cross(&force_w) + tau_w);
}
