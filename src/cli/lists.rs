//! `methods`, `effects`, `streams`, `solids`: the tables of the registries.

use super::print;
use crate::effect::{Argument, EFFECTS};
use crate::integrator::METHODS;
use crate::mass::solids::SOLIDS;
use crate::trace::{STREAMS, short};

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

/// Options of the list of methods.
#[derive(clap::Args)]
pub struct MethodArguments {
    #[command(flatten)]
    list: Arguments,
    /// Print the page docs/methods.md.
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
}

pub fn methods(arguments: &MethodArguments) -> anyhow::Result<()> {
    if arguments.markdown {
        return print::out(methods_page().trim_end());
    }
    let rows = METHODS.iter().map(|method| {
        let info = method.info();
        [
            info.name.to_owned(),
            info.other_names().collect::<Vec<_>>().join(", "),
            info.order.to_string(),
            info.kind.describe().to_owned(),
            info.accepts.describe().to_owned(),
            info.preserves.to_owned(),
            info.damping.describe().to_owned(),
            short(info.cost.weight),
            info.citation.to_owned(),
        ]
        .to_vec()
    });
    let header = [
        "method",
        "also called",
        "order",
        "steps",
        "torques",
        "preserves",
        "damping",
        "cost",
        "citation",
    ];
    if arguments.list.json {
        return list(&arguments.list, &header, rows.collect());
    }
    // Citations and damping would make the table too wide to read: they stand in the page.
    let narrow = rows.map(|row| [0, 2, 3, 4, 5, 7].map(|k| row[k].clone()).to_vec());
    let header = [0, 2, 3, 4, 5, 7].map(|k| header[k]);
    list(&arguments.list, &header, narrow.collect())?;
    print::out(
        "cost: of a step of one heavy top, in steps of rk4. Damping, other names and citations: \
         docs/methods.md, or --json. What they cost on your scene: torquescope cost SCENE",
    )
}

/// docs/methods.md.
fn methods_page() -> String {
    let mut text = "# Methods\n\n\
        Written by `torquescope methods --markdown` from the table `METHODS`; a test holds it to that.\n\n\
        A scene names one (`[stepping] method = \"rk4\"`), or states `accuracy = 1e-9` (rad) and lets \
        the program choose. `torquescope cost SCENE` shows what each costs on a scene of yours.\n\n\
        Orders are those of the attitude at a fixed time, for smooth torques of the kinds accepted; a \
        test measures each on a free, a damped and a driven body. A torque that would cost a method \
        its order is refused. Nothing an event does falls inside a step. *Cost* is the time of a step \
        of one heavy top in steps of rk4 (of a free body where a method takes no torque), as the \
        benchmark measured it: the program's choice counts by it, so that a plan does not depend on a \
        clock.\n\n\
        | method | order | steps | torques | preserves | reversible | evaluations a step | cost |\n\
        |---|--:|---|---|---|---|--:|--:|\n"
        .to_owned();
    for method in METHODS {
        let info = method.info();
        text += &format!(
            "| {} | {} | {} | {} | {} | {} | {} | {} |\n",
            info.name,
            info.order,
            info.kind.describe(),
            info.accepts.describe(),
            // A bar would end the cell.
            info.preserves.replace('|', "\\|"),
            if info.reversible { "yes" } else { "no" },
            match info.cost.evaluations {
                None => "varies".to_owned(),
                Some(0) => "none".to_owned(),
                Some(n) => n.to_string(),
            },
            short(info.cost.weight)
        );
    }
    text += "\n## Damping, other names, sources\n\n";
    for method in METHODS {
        let info = method.info();
        let called = match info.other_names().collect::<Vec<_>>() {
            names if names.is_empty() => String::new(),
            names => format!(" Also called {}.", names.join(", ")),
        };
        let weak = info.weak_orders.map_or_else(String::new, |[a, b, c]| {
            format!(" Forces of the size ε make errors of ε h^{a} + ε² h^{b} + ε³ h^{c}.")
        });
        text += &format!(
            "- **{}**: damping {}.{called}{weak} {}.\n",
            info.name,
            info.damping.describe(),
            info.citation
        );
    }
    text
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

/// How a scene writes it, units after the keys.
fn written(name: &str, argument: Argument) -> String {
    match argument {
        Argument::Switch => format!("{name} = true"),
        Argument::Number(unit) => format!("{name} = x  # {unit}"),
        Argument::Vector(unit) => format!("{name} = [x, y, z]  # {unit}"),
        Argument::Table(keys) => format!("{name} = {{ {} }}", entries(keys)),
        Argument::Amount(_) | Argument::Word(_) | Argument::Attitude | Argument::Point => {
            entry(name, argument)
        }
    }
}

fn entries(keys: &[(&str, Argument)]) -> String {
    let keys: Vec<String> = keys
        .iter()
        .map(|&(key, argument)| entry(key, argument))
        .collect();
    keys.join(", ")
}

fn entry(key: &str, argument: Argument) -> String {
    match argument {
        Argument::Switch => format!("{key} = true"),
        Argument::Number(unit) => format!("{key} ({unit})"),
        Argument::Vector(unit) => format!("{key} = [x, y, z] ({unit})"),
        Argument::Amount(unit) => format!("{key} = a or [x, y, z] ({unit})"),
        Argument::Word(words) => {
            let words: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
            format!("{key} = {}", words.join(" or "))
        }
        Argument::Attitude => format!("{key} = {{ axis, degrees }} or [x, y, z, w]"),
        Argument::Point => format!("{key} = a name or [x, y, z] (m)"),
        Argument::Table(keys) => format!("{key} = {{ {} }}", entries(keys)),
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
