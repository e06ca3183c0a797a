//! `methods`, `effects`, `streams`, `solids`: the tables of the registries.

use super::print;
use crate::effect::{Argument, EFFECTS};
use crate::integrator::METHODS;
use crate::mass::solids::SOLIDS;
use crate::trace::STREAMS;

/// Options of every list.
#[derive(clap::Args)]
pub struct Arguments {
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// Prints rows as a table or as a JSON list of objects with the same keys.
fn list(arguments: &Arguments, header: &[&str], rows: Vec<Vec<String>>) -> anyhow::Result<()> {
    if !arguments.json {
        return print::out(&print::wrapped(header, rows));
    }
    let object = |row: Vec<String>| {
        let pairs = header.iter().zip(row);
        pairs
            .map(|(key, value)| ((*key).to_owned(), value.into()))
            .collect()
    };
    let objects: Vec<serde_json::Map<String, serde_json::Value>> =
        rows.into_iter().map(object).collect();
    print::json(&objects)
}

pub fn methods(arguments: &Arguments) -> anyhow::Result<()> {
    let rows = METHODS.iter().map(|method| {
        let info = method.info();
        [
            info.name.to_owned(),
            info.order.to_string(),
            info.preserves.to_owned(),
            info.accepts.describe().to_owned(),
            info.damping.describe().to_owned(),
            info.citation.to_owned(),
        ]
        .to_vec()
    });
    let header = [
        "method",
        "order",
        "preserves",
        "torques",
        "damping",
        "citation",
    ];
    list(arguments, &header, rows.collect())
}

pub fn effects(arguments: &Arguments) -> anyhow::Result<()> {
    let rows = EFFECTS.iter().map(|effect| {
        vec![
            effect.name.to_owned(),
            written(effect.name, effect.argument),
            effect.equation.to_owned(),
            effect.about.to_owned(),
        ]
    });
    list(
        arguments,
        &["effect", "in a scene", "equation", "what it does"],
        rows.collect(),
    )
}

fn written(name: &str, argument: Argument) -> String {
    match argument {
        Argument::Switch => format!("{name} = true"),
        Argument::Vector(unit) => format!("{name} = [x, y, z]  # {unit}"),
        Argument::Table(keys) => {
            let keys: Vec<String> = keys
                .iter()
                .map(|(key, unit)| format!("{key} ({unit})"))
                .collect();
            format!("{name} = {{ {} }}", keys.join(", "))
        }
    }
}

pub fn streams(arguments: &Arguments) -> anyhow::Result<()> {
    let mut rows = Vec::new();
    for stream in STREAMS {
        for (k, quantity) in stream.quantities.iter().enumerate() {
            let first = k == 0;
            rows.push(vec![
                if first || arguments.json {
                    stream.name.to_owned()
                } else {
                    String::new()
                },
                quantity.name.to_owned(),
                quantity.symbol.to_owned(),
                quantity.unit.to_owned(),
                quantity.frame.to_owned(),
                quantity.shape.describe().to_owned(),
                if first {
                    stream.about.to_owned()
                } else {
                    String::new()
                },
            ]);
        }
        if stream.quantities.is_empty() {
            let mut row = vec![String::from("–"); 7];
            row[0] = stream.name.to_owned();
            row[6] = stream.about.to_owned();
            rows.push(row);
        }
    }
    list(
        arguments,
        &[
            "stream",
            "column",
            "symbol",
            "unit",
            "frame",
            "numbers",
            "what it shows",
        ],
        rows,
    )
}

pub fn solids(arguments: &Arguments) -> anyhow::Result<()> {
    let rows = SOLIDS.iter().map(|solid| {
        let parameters = solid
            .parameters
            .iter()
            .map(|parameter| match parameter.default {
                None => format!("{} (m)", parameter.name),
                Some(_) => format!("{} (m, optional)", parameter.name),
            });
        let parameters: Vec<String> = parameters.collect();
        vec![
            solid.name.to_owned(),
            parameters.join(", "),
            solid.about.to_owned(),
        ]
    });
    list(
        arguments,
        &["solid", "lengths", "moments about the centre of mass"],
        rows.collect(),
    )
}
