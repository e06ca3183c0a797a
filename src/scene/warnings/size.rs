//! Warnings about sizes: mostly millimetres for metres, grams for kilograms, or quaternions read in another
//! order.

use super::{Context, Found};
use crate::math::symmetric_eigen;
use crate::scene::problem::Problems;
use nalgebra::{Matrix3, Vector3};

/// Radii of gyration that a pivot may lie away. A ball of 5 cm on a line of 2 m has 63.
const FAR: f64 = 200.0;

pub fn far_pivot(context: &Context<'_, '_>, found: &mut Found) {
    for judged in &context.judged {
        let body = judged.body;
        let (Some(pivot), Some(mass)) = (body.pivot_b, body.properties.mass()) else {
            continue;
        };
        let radius = (largest(&body.properties.inertia_about(Vector3::zeros())) / mass).sqrt();
        if pivot.norm() > FAR * radius {
            found.add(context.place(judged, &["pivot"]), || {
                format!(
                    "{} is held {:.4} m from its centre of mass, {:.0} times its radius of gyration ({radius:.2e} m); lengths are in metres",
                    body.name,
                    pivot.norm(),
                    pivot.norm() / radius
                )
            });
        }
    }
}

/// A thousand, and a shape that is only roughly the body's.
const ODD: f64 = 400.0;

pub fn odd_inertia(context: &Context<'_, '_>, found: &mut Found) {
    for judged in &context.judged {
        let body = judged.body;
        let (Some(solid), Some(mass)) = (&body.solid, body.properties.mass()) else {
            continue;
        };
        let of_shape = solid.moments(mass).max();
        let ratio = largest(&body.properties.inertia_about(Vector3::zeros())) / of_shape;
        if !(1.0 / ODD..=ODD).contains(&ratio) {
            found.add(context.place(judged, &["inertia"]), || {
                format!(
                    "the inertia of {} is {ratio:.0e} of what its shape and mass have ({of_shape:.1e} kg m²); check the units, kg and m, not g or mm",
                    body.name
                )
            });
        }
    }
}

/// kg/m³: from below any gas to several times the densest metal.
const DENSITIES: std::ops::RangeInclusive<f64> = 1e-2..=1e5;

pub fn odd_density(context: &Context<'_, '_>, found: &mut Found) {
    for judged in &context.judged {
        let body = judged.body;
        let volume = body.solid.as_ref().and_then(|solid| solid.volume());
        let (Some(volume), Some(mass)) = (volume, body.properties.mass()) else {
            continue;
        };
        let density = mass / volume;
        if !DENSITIES.contains(&density) {
            found.add(context.place(judged, &["mass", "density"]), || {
                format!(
                    "{} would have a density of {density:.1e} kg/m³, where water has 1000; check the units, kg and m, not g or mm",
                    body.name
                )
            });
        }
    }
}

pub fn quaternion_order(context: &Context<'_, '_>, found: &mut Found) {
    each_quaternion(context, |body, place, q| {
        if q == [1.0, 0.0, 0.0, 0.0] {
            found.add(place, || {
                format!(
                    "the order is x, y, z, w, so {body} is turned half round about x; no turn is [0, 0, 0, 1], and half a turn that is meant {{ axis = [1, 0, 0], degrees = 180 }}"
                )
            });
        }
    });
}

pub fn quaternion_length(context: &Context<'_, '_>, found: &mut Found) {
    each_quaternion(context, |body, place, q| {
        let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        if (length - 1.0).abs() > 0.01 {
            found.add(place, || {
                format!(
                    "the orientation of {body} has length {length:.3}, and a rotation has 1: it is brought to that, and may not be the one that is meant; write it out, or as an axis and degrees"
                )
            });
        }
    });
}

/// Every orientation that is written as four numbers.
fn each_quaternion(
    context: &Context<'_, '_>,
    mut see: impl FnMut(&str, std::ops::Range<usize>, [f64; 4]),
) {
    for table in &context.tables {
        let node = table.get("orientation");
        let Some(node) = node.filter(|node| node.array_length() == Some(4)) else {
            continue;
        };
        let name = table.get("name").and_then(|name| name.quiet_str());
        // It has been read before, and is right.
        if let Some(q) = node.numbers::<4>("", &mut Problems::new("", "")) {
            see(name.unwrap_or_default(), node.span.clone(), q);
        }
    }
}

fn largest(tensor: &Matrix3<f64>) -> f64 {
    symmetric_eigen(tensor).1.max()
}
