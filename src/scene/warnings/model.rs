//! Warnings about the model and its step.

use super::{Alone, Context, Found, Judged, turned};
use crate::body::State;
use crate::integrator::Kind;
use crate::scene::{Stepping, read};
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// The tutorial's model keeps ω where a real body keeps L; the two part where `ω × I ω` is not nothing.
pub fn gyroscopic_off(context: &Context<'_, '_>, found: &mut Found) {
    for judged in &context.judged {
        let body = judged.body;
        let movable = body.properties.is_movable_about_every_axis();
        if movable && !judged.alone.load.gyroscopic() && judged.motion.feels_gyroscopic() {
            let place = context.place(judged, &["angular_velocity", "inertia", "shape"]);
            found.add(place, || {
                format!(
                    "{} does not turn about a principal axis alone, and without the gyroscopic term it will not wobble as a real body does; write gyroscopic = true in [effects], or allow = [\"gyroscopic-off\"] if the tutorial's model is meant",
                    body.name
                )
            });
        }
    }
}

/// Of a period that a step may be.
const PART: f64 = 0.1;

/// A method of fixed steps sees nothing that is over within a few of them.
pub fn coarse_step(context: &Context<'_, '_>, found: &mut Found) {
    let Stepping::Method { method, .. } = context.scene.stepping else {
        return;
    };
    let mut fastest: Option<(f64, String)> = None;
    let mut see = |rate: f64, what: String| {
        if rate.is_finite() && fastest.as_ref().is_none_or(|(most, _)| rate > *most) {
            fastest = Some((rate, what));
        }
    };
    for Judged {
        body,
        alone,
        motion,
        ..
    } in &context.judged
    {
        let info = body.method.map_or(method, |own| own.method).info();
        if info.kind != Kind::Fixed {
            continue;
        }
        // A turn that a method takes exactly needs no steps.
        if !info.exact_free {
            let rate = motion.fastest();
            see(rate, format!("{} turns at {rate:.3} rad/s", body.name));
        }
        let rate = swing(alone);
        see(rate, format!("{} swings at {rate:.3} rad/s", body.name));
    }
    let step = context.scene.step;
    let Some((rate, what)) = fastest.filter(|(rate, _)| rate * step > PART * TAU) else {
        return;
    };
    let period = TAU / rate;
    found.add(read::clock_place(context.top), || {
        format!(
            "a step of {step} s is above a tenth of the fastest period, {period:.3e} s: {what}; take a step of {:.1e} s or less",
            one_digit_down(PART * period)
        )
    });
}

/// The fastest that what acts on a body as long as the scene lasts makes it swing about where it starts,
/// or settle, rad/s: `√(|∂τ/∂θ|/I)`, `√(|∂F/∂x|/m)`, `|∂τ/∂ω|/I` and `|∂F/∂v|/m`, by differences. Pendulums,
/// springs, motors, drag: whatever there is.
fn swing(body: &Alone) -> f64 {
    if !body.load.applies() {
        return 0.0;
    }
    let at = |state: &State| body.wrench(state);
    let (here, inertial) = (body.state, &body.inertial);
    let mut fastest = 0.0_f64;
    for axis_p in [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()] {
        let inv_moment = axis_p.dot(&inertial.inv_moments);
        let axis_w = here.to_world(axis_p.into_inner());
        let torque = |state: &State| at(state).tau_w.dot(&axis_w);
        // Small beside a turn, large beside rounding.
        let slope =
            0.5e3 * (torque(&turned(&here, axis_w, 1e-3)) - torque(&turned(&here, axis_w, -1e-3)));
        fastest = fastest.max((slope.abs() * inv_moment).sqrt());
        let spun = |by: f64| State {
            omega_w: here.omega_w + axis_w * by,
            ..here
        };
        let slope = 0.5e3 * (torque(&spun(1e-3)) - torque(&spun(-1e-3)));
        fastest = fastest.max(slope.abs() * inv_moment);

        let force = |state: &State| at(state).force_w.dot(&axis_w);
        let moved = |by: f64| State {
            x_w: here.x_w + axis_w * by,
            ..here
        };
        let slope = 0.5e3 * (force(&moved(1e-3)) - force(&moved(-1e-3)));
        fastest = fastest.max((slope.abs() * inertial.inv_mass).sqrt());
        let thrown = |by: f64| State {
            v_w: here.v_w + axis_w * by,
            ..here
        };
        let slope = 0.5e3 * (force(&thrown(1e-3)) - force(&thrown(-1e-3)));
        fastest = fastest.max(slope.abs() * inertial.inv_mass);
    }
    fastest
}

/// With one digit, not above what it was.
fn one_digit_down(x: f64) -> f64 {
    let unit = libm::pow(10.0, x.log10().floor());
    (x / unit).floor() * unit
}

/// What starts too fast for a limit is another motion from its first step on.
pub fn slow_limit(context: &Context<'_, '_>, found: &mut Found) {
    for judged in &context.judged {
        let limit = judged.alone.load.limit();
        if limit.is_some_and(|limit| limit.clamped(&judged.alone.state).is_some()) {
            let place = context.place(judged, &["angular_velocity", "velocity", "random"]);
            found.add(place, || {
                format!(
                    "{} starts faster than its speed limit, and loses what is above it in the first step; raise the limit, start slower, or allow = [\"slow-limit\"] if that is to be seen",
                    judged.body.name
                )
            });
        }
    }
}
