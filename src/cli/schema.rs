//! `schema`: the format of scenes, for editors and for reading.

use super::print;
use crate::effect::{Argument, EFFECTS};
use crate::mass::solids::SOLIDS;
use crate::scene::keys::{ATTITUDE, HOW_OFTEN, Key, Keys, POINT_OF_BODY, Registry, SCENE, Takes};
use serde_json::{Map, Value, json};

/// Print the JSON Schema of scenes, by which editors complete and check them.
///
/// The first line `#:schema ./scene.schema.json` tells an editor with a TOML language server (Taplo, in VS
/// Code "Even Better TOML") to use it; `torquescope new` writes both.
#[derive(clap::Args)]
#[command(after_help = "Example: torquescope schema > scene.schema.json")]
pub struct Arguments {
    /// Print the page docs/keys.md instead.
    #[arg(long)]
    markdown: bool,
}

pub fn run(arguments: &Arguments) -> anyhow::Result<()> {
    match arguments.markdown {
        true => print::out(page().trim_end()),
        false => print::out(text().trim_end()),
    }
}

/// The file docs/scene.schema.json.
pub fn text() -> String {
    let mut definitions = Map::new();
    let top = table(&SCENE, &mut definitions);
    let mut schema = Map::new();
    schema.insert(
        "$schema".into(),
        json!("http://json-schema.org/draft-07/schema#"),
    );
    schema.insert("title".into(), json!("A scene of Torquescope"));
    schema.extend(top);
    schema.insert("definitions".into(), Value::Object(definitions));
    // Of values that were made here nothing can fail to be written.
    serde_json::to_string_pretty(&schema).unwrap_or_default() + "\n"
}

/// The schema of a table; those within it go to the definitions.
fn table(keys: &'static Keys, definitions: &mut Map<String, Value>) -> Map<String, Value> {
    let mut properties = Map::new();
    for key in keys.all() {
        properties.insert(key.name.into(), property(key, definitions));
    }
    if let Some(registry) = keys.also {
        properties.extend(entries(registry, definitions));
    }
    let required: Vec<&str> = keys
        .all()
        .filter(|key| key.required)
        .map(|key| key.name)
        .collect();
    let mut schema = Map::new();
    schema.insert("type".into(), json!("object"));
    schema.insert("description".into(), json!(keys.about));
    schema.insert("properties".into(), Value::Object(properties));
    schema.insert("additionalProperties".into(), json!(false));
    if !required.is_empty() {
        schema.insert("required".into(), json!(required));
    }
    if keys.one {
        schema.insert("minProperties".into(), json!(1));
        schema.insert("maxProperties".into(), json!(1));
    }
    schema
}

fn property(key: &'static Key, definitions: &mut Map<String, Value>) -> Value {
    let mut schema = takes(&key.takes, definitions);
    let mut about = key.about.to_owned();
    let units = units(&key.takes);
    if !units.is_empty() {
        about += &format!(" ({})", units.join(" or "));
    }
    if let Some(default) = key.default {
        about += &format!("; default: {default}");
        if let Ok(value) = serde_json::from_str::<Value>(default) {
            schema.insert("default".into(), value);
        }
    }
    schema.insert("description".into(), json!(about));
    // Beside a reference draft 7 reads nothing.
    if let Some(reference) = schema.remove("$ref") {
        schema.insert("allOf".into(), json!([{ "$ref": reference }]));
    }
    Value::Object(schema)
}

fn takes(takes: &'static Takes, definitions: &mut Map<String, Value>) -> Map<String, Value> {
    let value = match takes {
        Takes::Text => json!({ "type": "string" }),
        // No punctuation, no space but - and _; of other scripts the reader knows more.
        Takes::Name => json!({
            "type": "string",
            "minLength": 1,
            "maxLength": 64,
            "pattern": "^[^\\u0000-,./:-@\\[-^`{-\\u007f]+$",
        }),
        Takes::Words(words) => json!({ "enum": words }),
        Takes::NameOf(registry) => json!({ "enum": registry.names() }),
        Takes::Switch => json!({ "type": "boolean" }),
        Takes::Number(_) => json!({ "type": "number" }),
        Takes::Positive(_) => json!({ "type": "number", "exclusiveMinimum": 0 }),
        Takes::NotNegative(_) => json!({ "type": "number", "minimum": 0 }),
        Takes::Whole(least, most) => {
            json!({ "type": "integer", "minimum": least, "maximum": most })
        }
        Takes::Vector(_) => numbers(3),
        Takes::Quaternion => numbers(4),
        Takes::Matrix(_) => {
            json!({ "type": "array", "items": numbers(3), "minItems": 3, "maxItems": 3 })
        }
        Takes::List(inner) => {
            json!({ "type": "array", "items": self::takes(inner, definitions) })
        }
        Takes::Either(several) => {
            let several = several.iter().map(|inner| self::takes(inner, definitions));
            json!({ "anyOf": several.collect::<Vec<_>>() })
        }
        Takes::Table(keys) => reference(keys, definitions),
        Takes::Tables(keys) => {
            json!({ "type": "array", "items": reference(keys, definitions) })
        }
        // A path in quotes is a key, one without is tables in tables.
        Takes::Sweep => json!({
            "type": "object",
            "minProperties": 1,
            "additionalProperties": { "type": ["array", "object"] },
        }),
    };
    object(value)
}

fn object(value: Value) -> Map<String, Value> {
    match value {
        Value::Object(object) => object,
        _ => Map::new(),
    }
}

fn numbers(count: usize) -> Value {
    json!({ "type": "array", "items": { "type": "number" }, "minItems": count, "maxItems": count })
}

/// A reference to a table, which is then among the definitions.
fn reference(keys: &'static Keys, definitions: &mut Map<String, Value>) -> Value {
    let letters = |c: &char| c.is_ascii_alphanumeric() || *c == '_';
    let name: String = keys.name.chars().filter(letters).collect();
    if !definitions.contains_key(&name) {
        // Its place first: tables may hold themselves.
        definitions.insert(name.clone(), Value::Null);
        let schema = table(keys, definitions);
        definitions.insert(name.clone(), Value::Object(schema));
    }
    json!({ "$ref": format!("#/definitions/{name}") })
}

/// The properties that a table of the program stands for.
fn entries(registry: Registry, definitions: &mut Map<String, Value>) -> Vec<(String, Value)> {
    match registry {
        Registry::Solids => {
            let solid = |kind: &&crate::mass::solids::SolidKind| {
                let length = |p: &crate::mass::solids::Parameter| {
                    let value = json!({ "type": "number", "minimum": 0, "description": "m" });
                    (p.name.to_owned(), value)
                };
                let needed = kind.parameters.iter().filter(|p| p.default.is_none());
                let schema = json!({
                    "type": "object",
                    "description": kind.about,
                    "properties": kind.parameters.iter().map(length).collect::<Map<_, _>>(),
                    "required": needed.map(|p| p.name).collect::<Vec<_>>(),
                    "additionalProperties": false,
                });
                (kind.name.to_owned(), schema)
            };
            SOLIDS.iter().map(solid).collect()
        }
        Registry::Effects => {
            let effect = |kind: &&crate::effect::EffectKind| {
                let mut schema = argument(&kind.argument, definitions);
                let about = format!("{}; {}", kind.about, kind.equation);
                schema.insert("description".into(), json!(about));
                (kind.name.to_owned(), Value::Object(schema))
            };
            EFFECTS.iter().map(effect).collect()
        }
        Registry::Streams => {
            let rate = |name: &str| {
                let schema = Value::Object(takes(&HOW_OFTEN, definitions));
                (name.to_owned(), schema)
            };
            registry.names().into_iter().map(rate).collect()
        }
        // Their names are values, not keys.
        Registry::Methods | Registry::Warnings => Vec::new(),
    }
}

/// The schema of what an effect takes.
fn argument(argument: &Argument, definitions: &mut Map<String, Value>) -> Map<String, Value> {
    object(match argument {
        Argument::Switch => json!({ "type": "boolean" }),
        Argument::Number(_) => json!({ "type": "number" }),
        Argument::Vector(_) => numbers(3),
        Argument::Amount(_) => json!({ "anyOf": [{ "type": "number" }, numbers(3)] }),
        Argument::Word(words) => json!({ "enum": words }),
        Argument::Attitude => Value::Object(takes(&ATTITUDE, definitions)),
        Argument::Point => Value::Object(takes(&POINT_OF_BODY, definitions)),
        Argument::Table(keys) => {
            let mut properties = Map::new();
            for (key, inner) in *keys {
                let mut schema = self::argument(inner, definitions);
                if let Some(unit) = unit(inner) {
                    schema.insert("description".into(), json!(unit));
                }
                properties.insert((*key).to_owned(), Value::Object(schema));
            }
            json!({
                "type": "object",
                "properties": properties,
                "additionalProperties": false,
            })
        }
    })
}

fn unit(argument: &Argument) -> Option<&'static str> {
    match argument {
        Argument::Number(unit) | Argument::Vector(unit) | Argument::Amount(unit) => Some(unit),
        Argument::Point => Some("m"),
        _ => None,
    }
}

/// The units that may stand there, each once.
fn units(takes: &'static Takes) -> Vec<&'static str> {
    let mut units = match takes {
        Takes::Number(unit)
        | Takes::Positive(unit)
        | Takes::NotNegative(unit)
        | Takes::Vector(unit)
        | Takes::Matrix(unit) => vec![*unit],
        Takes::Either(several) => several.iter().flat_map(units).collect(),
        _ => Vec::new(),
    };
    units.dedup();
    units
}

/// In words.
fn describe(takes: &'static Takes) -> String {
    match takes {
        Takes::Text => "a text".to_owned(),
        Takes::Name => "a name".to_owned(),
        Takes::Words(words) => {
            let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
            quoted.join(" or ")
        }
        Takes::NameOf(registry) => match registry {
            Registry::Methods => "a name from `torquescope methods`",
            Registry::Streams => "names from `torquescope streams`",
            Registry::Warnings => "codes from `torquescope check --list`",
            Registry::Solids => "a name from `torquescope solids`",
            Registry::Effects => "a name from `torquescope effects`",
        }
        .to_owned(),
        Takes::Switch => "true or false".to_owned(),
        Takes::Number(unit) => format!("a number, {unit}"),
        Takes::Positive(unit) => format!("a number above 0, {unit}"),
        Takes::NotNegative(unit) => format!("a number from 0, {unit}"),
        Takes::Whole(least, most) => format!("a whole number from {least} to {most}"),
        Takes::Vector(unit) => format!("3 numbers, {unit}"),
        Takes::Quaternion => "4 numbers x, y, z, w".to_owned(),
        Takes::Matrix(unit) => format!("3 rows of 3 numbers, {unit}"),
        Takes::List(inner) => format!("a list: {}", describe(inner)),
        Takes::Either(several) => {
            let several: Vec<String> = several.iter().map(describe).collect();
            several.join(", or ")
        }
        Takes::Table(keys) | Takes::Tables(keys) => format!("`{}`", keys.name),
        Takes::Sweep => "PATH = a list of values".to_owned(),
    }
}

/// docs/keys.md.
fn page() -> String {
    let mut text = "# Keys\n\n\
        Every key a scene can write. Written by `torquescope schema --markdown` from the tables in \
        src/scene/keys.rs, as is the JSON Schema docs/scene.schema.json; tests hold both to that, and the \
        reader to the same tables. docs/scenes.md says what it is all about.\n"
        .to_owned();
    let mut tables = vec![&SCENE];
    let mut k = 0;
    while let Some(&keys) = tables.get(k) {
        k += 1;
        let heading = keys.name;
        text += &format!("\n## {heading}\n\n{}\n", keys.about);
        if let Some(base) = keys.extends {
            text += &format!("All keys of `{}`, and:\n", base.name);
        }
        if keys.one {
            text += "Exactly one of:\n";
        }
        if !keys.keys.is_empty() {
            text += "\n| key | takes | meaning | default |\n|---|---|---|---|\n";
        }
        for key in keys.keys {
            let default = match (key.required, key.default) {
                (true, _) => "**required**".to_owned(),
                (false, None) => "–".to_owned(),
                (false, Some(default))
                    if default.contains(['"', '[']) || default.parse::<f64>().is_ok() =>
                {
                    format!("`{default}`")
                }
                (false, Some(default)) => default.to_owned(),
            };
            let takes = describe(&key.takes);
            text += &format!("| `{}` | {takes} | {} | {default} |\n", key.name, key.about);
            within(&key.takes, &mut tables);
        }
        text += match keys.also {
            Some(Registry::Solids) => "\nThe solids and their lengths: `torquescope solids`.\n",
            Some(Registry::Effects) => "\nThe effects and what they take: `torquescope effects`.\n",
            Some(Registry::Streams) => "\nThe streams: `torquescope streams`.\n",
            _ => "",
        };
    }
    text
}

/// The tables that may stand there, after those that are known.
fn within(takes: &'static Takes, tables: &mut Vec<&'static Keys>) {
    match takes {
        Takes::Table(keys) | Takes::Tables(keys)
            if !tables.iter().any(|known| known.name == keys.name) =>
        {
            tables.push(keys);
        }
        Takes::List(inner) => within(inner, tables),
        Takes::Either(several) => several.iter().for_each(|inner| within(inner, tables)),
        _ => {}
    }
}
