//! Warnings about events.

use super::{Alone, Context, Found, is_zero, struck};
use crate::scene::Event;
use nalgebra::Vector3;

/// The keys under which a scene writes what an event does.
const DOES: &[&str] = &["force", "impulse", "torque", "angular_impulse"];

/// Whether an event's body moves or turns by it, however it may have turned until then.
fn acts(context: &Context<'_, '_>, event: &Event) -> bool {
    let body = Alone::new(&context.scene.bodies[event.body]);
    let softest = body.inertial.inv_moments.max();
    body.attitudes().iter().any(|state| {
        let wrench = struck(event, &body, state);
        let response = body.inertial.angular_response(state, wrench.tau_w);
        // About an axis that is held a torque turns nothing but by rounding.
        let turns = response.norm() > 1e-9 * softest * wrench.tau_w.norm();
        turns || wrench.force_w * body.inertial.inv_mass != Vector3::zeros()
    })
}

pub fn immovable(context: &Context<'_, '_>, found: &mut Found) {
    for (k, event) in context.scene.events.iter().enumerate() {
        let body = &context.scene.bodies[event.body];
        let (infinite, held) = (
            body.properties.mass().is_none(),
            !body.properties.is_movable_about_every_axis(),
        );
        if is_zero(event) || !(infinite || held) || acts(context, event) {
            continue;
        }
        let noun = event.action.noun();
        found.add(context.event_place(k, DOES), || match infinite {
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
    for (k, event) in context.scene.events.iter().enumerate() {
        let body = &context.scene.bodies[event.body];
        let held = body.pivot_b.is_some() && body.properties.is_movable_about_every_axis();
        let noun = event.action.noun();
        if is_zero(event) {
            found.add(context.event_place(k, DOES), || {
                format!("this {noun} is zero; leave the event out")
            });
        } else if held && !acts(context, event) {
            found.add(context.event_place(k, &["point", "force", "impulse"]), || {
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
    for (k, event) in context.scene.events.iter().enumerate() {
        let until = event.at + event.action.lasts();
        // A sum of two numbers that each were written down.
        if until > end * (1.0 + 4.0 * f64::EPSILON) {
            found.add(context.event_place(k, &["for"]), || {
                format!(
                    "this {} would last until {until} s, and the scene ends at {end} s; make the scene longer, or the event shorter",
                    event.action.noun()
                )
            });
        }
    }
}
