//! Warnings about events.

use super::{Alone, Context, Found, first_of_each, is_zero, struck};
use crate::scene::{Body, Event, Target};
use nalgebra::Vector3;

/// The keys under which a scene writes what an event does.
const DOES: &[&str] = &["force", "impulse", "torque", "angular_impulse", "click"];

/// Whether a body moves or turns by an event, however it may have turned until then; `None` where it is no
/// push and no torque on a body that is named.
fn acts(context: &Context<'_, '_>, event: &Event) -> Option<bool> {
    let Target::Body(index) = event.target else {
        return None;
    };
    let body = Alone::new(context.scene, index, &context.ever_on);
    struck(event, &body, &body.state)?;
    let softest = body.inertial.inv_moments.max();
    let moves = |state| {
        let wrench = struck(event, &body, state).unwrap_or_default();
        let response = body.inertial.angular_response(state, wrench.tau_w);
        // About an axis that is held a torque turns nothing but by rounding.
        let turns = response.norm() > 1e-9 * softest * wrench.tau_w.norm();
        turns || wrench.force_w * body.inertial.inv_mass != Vector3::zeros()
    };
    Some(body.attitudes().iter().any(moves))
}

/// The body that an event names.
fn body<'a>(context: &Context<'a, '_>, event: &Event) -> Option<&'a Body> {
    match event.target {
        Target::Body(index) => context.scene.bodies.get(index),
        _ => None,
    }
}

pub fn immovable(context: &Context<'_, '_>, found: &mut Found) {
    for event in first_of_each(context.scene) {
        let Some(body) = body(context, event) else {
            continue;
        };
        let (infinite, held) = (
            body.properties.mass().is_none(),
            !body.properties.is_movable_about_every_axis(),
        );
        if is_zero(event) || !(infinite || held) || acts(context, event) != Some(false) {
            continue;
        }
        let noun = event.action.noun();
        found.add(context.event_place(event, DOES), || match infinite {
            true => format!(
                "a {noun} on {}, whose mass is infinite, does nothing; give the body a mass, or leave the event out",
                body.name
            ),
            false => format!(
                "a {noun} on {} about axes that are held does nothing; turn it about another axis, or leave the event out",
                body.name
            ),
        });
    }
}

pub fn idle(context: &Context<'_, '_>, found: &mut Found) {
    for event in first_of_each(context.scene) {
        let body = body(context, event);
        let held = body
            .filter(|body| body.pivot_b.is_some() && body.properties.is_movable_about_every_axis());
        let noun = event.action.noun();
        if is_zero(event) {
            found.add(context.event_place(event, DOES), || {
                format!("this {noun} is zero; leave the event out")
            });
        } else if let Some(body) = held
            && acts(context, event) == Some(false)
        {
            found.add(context.event_place(event, &["point", "force", "impulse"]), || {
                format!(
                    "a {noun} on {} goes through its pivot and turns nothing; let it act elsewhere",
                    body.name
                )
            });
        }
    }
}

pub fn cut(context: &Context<'_, '_>, found: &mut Found) {
    let end = context.scene.duration;
    // Of what repeats the last may well be cut.
    for event in first_of_each(context.scene) {
        let until = event.at + event.action.lasts();
        // A sum of two numbers that each were written down.
        if until > end * (1.0 + 4.0 * f64::EPSILON) {
            found.add(context.event_place(event, &["for"]), || {
                format!(
                    "this {} would last until {until} s, and the scene ends at {end} s; make the scene longer, or the event shorter",
                    event.action.noun()
                )
            });
        }
    }
}
