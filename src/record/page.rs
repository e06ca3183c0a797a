//! A body's numbers at an instant, as a page to read.

use crate::trace::{Instant, Quantity, Sample, Shape, Subject, short, short_numbers};
use std::fmt::Write as _;

/// Markdown with every number of `quantities`.
pub fn page(
    subject: &Subject,
    at: Instant,
    sample: &Sample,
    quantities: &[&'static Quantity],
) -> String {
    let mut text = format!("**{}**", subject.label);
    let _ = writeln!(
        text,
        " at {} s, step {} · world axes, about the {}\n",
        short(at.time),
        at.step,
        subject.reference()
    );
    let held: Vec<&str> = (0..3)
        .filter(|&k| subject.held[k])
        .map(|k| ["x", "y", "z"][k])
        .collect();
    if !held.is_empty() {
        let _ = writeln!(
            text,
            "held about its own {}: nothing turns it there, and its inertia there counts 0\n",
            held.join(", ")
        );
    }
    text.push_str("| | x | y | z | length |\n|---|--:|--:|--:|--:|\n");
    let mut values = Vec::new();
    for quantity in quantities
        .iter()
        .filter(|q| matches!(q.shape, Shape::Vector | Shape::VectorPerPush))
    {
        values.clear();
        (quantity.write)(subject, sample, &mut values);
        for vector in values.chunks_exact(3) {
            row(&mut text, quantity, vector);
        }
    }
    for (name, torque) in subject.sources.iter().zip(&sample.sources) {
        let cells = short_numbers(torque.as_slice()).join(" | ");
        let length = short(torque.norm());
        let _ = writeln!(text, "| torque by {name} (N·m) | {cells} | {length} |");
    }
    for quantity in quantities {
        values.clear();
        (quantity.write)(subject, sample, &mut values);
        match quantity.shape {
            Shape::Matrix => matrix(&mut text, quantity, &values),
            Shape::ScalarWhereKnown => {
                if let Some(&value) = values.first() {
                    let (symbol, unit) = (quantity.symbol, quantity.unit);
                    let unit = if unit == "1" { "" } else { unit };
                    let _ = writeln!(text, "\n{symbol} = {value:.1e} {unit}");
                }
            }
            Shape::Scalar if !quantity.name.ends_with("_norm") => {
                let _ = writeln!(
                    text,
                    "\n{} = {} {}",
                    quantity.symbol,
                    short(values[0]),
                    quantity.unit
                );
            }
            Shape::Quaternion => {
                let parts = short_numbers(&values).join(", ");
                let _ = writeln!(text, "\n{} = ({parts}) x y z w", quantity.symbol);
            }
            Shape::Scalar | Shape::Vector | Shape::VectorPerPush => {}
        }
    }
    text
}

fn row(text: &mut String, quantity: &Quantity, vector: &[f64]) {
    let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    // A place has no length worth reading.
    let length = if quantity.unit == "m" {
        String::new()
    } else {
        short(length)
    };
    let cells = short_numbers(vector).join(" | ");
    let _ = writeln!(
        text,
        "| {} {} ({}) | {cells} | {length} |",
        spoken(quantity),
        quantity.symbol,
        quantity.unit
    );
}

fn matrix(text: &mut String, quantity: &Quantity, values: &[f64]) {
    let _ = writeln!(
        text,
        "\n| **{}** {} | x | y | z |\n|---|--:|--:|--:|",
        quantity.symbol, quantity.unit
    );
    let cells = short_numbers(values);
    for (axis, row) in ["x", "y", "z"].iter().zip(cells.chunks_exact(3)) {
        let _ = writeln!(text, "| {axis} | {} |", row.join(" | "));
    }
}

/// Its name as one says it.
fn spoken(quantity: &Quantity) -> String {
    quantity.name.replace('_', " ")
}
