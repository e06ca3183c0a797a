//! What is added to a scene's text while it runs: events, and effects that take the place of others.
//!
//! Everything is added behind what there is, so that the events and effects that were there keep their places, and
//! nothing of what ran so far is different.

use super::edit::{self, Text, quoted};
use super::script::{Script, float};
use nalgebra::Vector3;
use toml::de::{DeTable, DeValue};

/// A table that is added to a scene: its keys and their values, in TOML.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    list: &'static str,
    pairs: Vec<(&'static str, String)>,
}

impl Entry {
    /// An `[[event]]` at a time, s, that nothing before it depends on.
    pub fn event(at: f64) -> Self {
        Self {
            list: "event",
            pairs: vec![("at", float(at)), ("unforeseen", "true".to_owned())],
        }
    }

    fn effect() -> Self {
        Self {
            list: "effect",
            pairs: Vec::new(),
        }
    }

    /// With a value in TOML.
    #[must_use]
    pub fn with(mut self, key: &'static str, value: String) -> Self {
        self.pairs.push((key, value));
        self
    }

    #[must_use]
    pub fn with_text(self, key: &'static str, value: &str) -> Self {
        self.with(key, quoted(value))
    }

    #[must_use]
    pub fn with_number(self, key: &'static str, value: f64) -> Self {
        self.with(key, float(value))
    }

    #[must_use]
    pub fn with_vector(self, key: &'static str, value: Vector3<f64>) -> Self {
        self.with(key, vector(value))
    }

    /// A point by numbers, in the world or from the shape's origin in the body's axes.
    #[must_use]
    pub fn with_point(self, in_body: bool, point: Vector3<f64>) -> Self {
        let axes = if in_body { "body" } else { "world" };
        self.with("point", format!("{{ {axes} = {} }}", vector(point)))
    }

    /// A part of a body's state, as a value in TOML.
    pub fn with_state(self, key: &str, value: &str) -> Result<Self, String> {
        // One value and no more, so that nothing else gets into the text.
        let value = super::script::toml_value(value)?;
        Ok(self.with("set", format!("{{ {key} = {value} }}")))
    }

    /// An effect of that name on or off.
    #[must_use]
    pub fn with_switch(self, effect: &str, on: bool) -> Self {
        let effect = quoted(effect);
        self.with("switch", format!("{{ effect = {effect}, on = {on} }}"))
    }

    pub(super) fn list(&self) -> &'static str {
        self.list
    }

    /// As lines, or as one table in braces.
    pub(super) fn written(&self, inline: bool) -> String {
        let pairs = self
            .pairs
            .iter()
            .map(|(key, value)| format!("{key} = {value}"));
        let pairs: Vec<String> = pairs.collect();
        match inline {
            true => format!("{{ {} }}", pairs.join(", ")),
            false => format!("\n[[{}]]\n{}\n", self.list, pairs.join("\n")),
        }
    }
}

/// Three numbers with every digit.
fn vector(v: Vector3<f64>) -> String {
    format!("[{}, {}, {}]", float(v.x), float(v.y), float(v.z))
}

/// An effect with another argument, to be switched to.
#[derive(Clone, Debug, PartialEq)]
pub struct Amended {
    /// To be added; it is off.
    pub entry: Entry,
    /// What it is called.
    pub name: String,
    /// Those whose place it takes, by name; none where the scene has no such effect.
    pub instead_of: Vec<String>,
}

impl Script {
    /// Whether a path is that of an effect's argument, for that value: what [`Self::amended`] takes.
    pub fn is_argument(&self, path: &str, value: &str) -> bool {
        let Ok(text) = self.edited() else {
            return false;
        };
        let Ok(document) = edit::parse(text.as_str()) else {
            return false;
        };
        let full = edit::full_path(document.get_ref(), path, value);
        full.is_ok_and(|full| place(document.get_ref(), &full).is_some())
    }

    /// The effect that a path is an argument of, with that value: as another effect beside the ones whose place it
    /// takes, called after them: damping, damping_2, damping_3…
    pub fn amended(&self, path: &str, value: &str) -> Result<Amended, String> {
        let value = super::script::toml_value(value)?;
        let text = self.edited().map_err(|why| why.to_string())?;
        let document = edit::parse(text.as_str())?;
        let top = document.get_ref();
        let full = edit::full_path(top, path, &value)?;
        let Some(Place { base, kind, rest }) = place(top, &full) else {
            return Err(format!("`{path}` is no argument of an effect"));
        };
        let family = family(top, &base, &kind);
        let latest = family.last();
        // Where the text has it now; what it has not is added as [effects] would have it.
        let mut target = match latest {
            Some((name, false)) => vec!["effect".to_owned(), name.clone(), kind.clone()],
            _ => vec!["effects".to_owned(), kind.clone()],
        };
        let at = target.len();
        target.extend(rest);
        let mut scratch = Text::new(text.as_str());
        scratch.set(&edit::written_path(&target), &value, edit::From::Here)?;
        let changed = edit::parse(scratch.as_str())?;
        let owner = table_at(changed.get_ref(), &target[..at - 1]);
        let argument = owner.and_then(|owner| owner.get(kind.as_str()));
        let Some(argument) = argument else {
            return Err(format!("`{path}` is no argument of an effect"));
        };
        let argument = inline(scratch.as_str(), argument);
        let name = match family.len() {
            0 => base.clone(),
            _ => free_name(top, &base, family.len() + 1),
        };
        let key = crate::effect::EFFECTS
            .iter()
            .find(|known| known.name == kind);
        let key = key.ok_or_else(|| format!("`{kind}` is no effect"))?.name;
        let mut entry = Entry::effect().with_text("name", &name).with(key, argument);
        let bodies = owner.filter(|_| target[0] == "effect");
        if let Some(bodies) = bodies.and_then(|owner| owner.get("bodies")) {
            entry = entry.with("bodies", inline(scratch.as_str(), bodies));
        }
        Ok(Amended {
            entry: entry.with("on", "false".to_owned()),
            name,
            instead_of: family.into_iter().map(|(name, _)| name).collect(),
        })
    }

    /// All effects that have taken each other's place: damping, damping_2… of any one's name, the latest last.
    pub fn effects_like(&self, name: &str) -> Vec<String> {
        let Ok(text) = self.edited() else {
            return Vec::new();
        };
        let Ok(document) = edit::parse(text.as_str()) else {
            return Vec::new();
        };
        let top = document.get_ref();
        let Some(kind) = kind_of(top, name) else {
            return Vec::new();
        };
        let family = family(top, base_of(top, name, &kind), &kind);
        family.into_iter().map(|(name, _)| name).collect()
    }
}

/// An argument of an effect: the effect's first name, its kind, and what of its argument.
struct Place {
    base: String,
    kind: String,
    rest: Vec<String>,
}

fn place(top: &DeTable<'_>, full: &[String]) -> Option<Place> {
    let known = |kind: &str| crate::effect::EFFECTS.iter().any(|k| k.name == kind);
    match full {
        [first, kind, rest @ ..] if first == "effects" && known(kind) => Some(Place {
            base: kind.clone(),
            kind: kind.clone(),
            rest: rest.to_vec(),
        }),
        [first, which, kind, rest @ ..] if first == "effect" && known(kind) => {
            let item = edit::table_named(top, "effect", which)?;
            let name = item.get("name").and_then(|name| name.get_ref().as_str());
            let name = name.unwrap_or(kind);
            Some(Place {
                base: base_of(top, name, kind).to_owned(),
                kind: kind.clone(),
                rest: rest.to_vec(),
            })
        }
        _ => None,
    }
}

/// `damping` of `damping_3`, where there is such a one of the same kind.
fn base_of<'a>(top: &DeTable<'_>, name: &'a str, kind: &str) -> &'a str {
    let stem = name.rsplit_once('_').filter(|(_, number)| {
        let digits = number.bytes().all(|digit| digit.is_ascii_digit());
        digits && number.parse::<usize>().is_ok_and(|number| number >= 2)
    });
    match stem {
        Some((stem, _)) if kind_of(top, stem).is_some_and(|of| of == kind) => stem,
        _ => name,
    }
}

/// The effects of the text, each with its name and kind, and whether it stands in [effects].
fn effects(top: &DeTable<'_>) -> Vec<(String, String, bool)> {
    let mut all = Vec::new();
    let short = top
        .get("effects")
        .and_then(|node| node.get_ref().as_table());
    for kind in crate::effect::EFFECTS {
        if short.is_some_and(|table| table.contains_key(kind.name)) {
            all.push((kind.name.to_owned(), kind.name.to_owned(), true));
        }
    }
    let long = top.get("effect").and_then(|node| node.get_ref().as_array());
    for item in long.into_iter().flat_map(|list| list.iter()) {
        let Some(table) = item.get_ref().as_table() else {
            continue;
        };
        let mut kinds = crate::effect::EFFECTS.iter();
        let Some(kind) = kinds.find(|kind| table.contains_key(kind.name)) else {
            continue;
        };
        let name = table.get("name").and_then(|name| name.get_ref().as_str());
        let name = name.unwrap_or(kind.name).to_owned();
        all.push((name, kind.name.to_owned(), false));
    }
    all
}

fn kind_of(top: &DeTable<'_>, name: &str) -> Option<String> {
    let mut all = effects(top).into_iter();
    all.find(|(known, ..)| known == name)
        .map(|(_, kind, _)| kind)
}

/// Those that took each other's place, in that order, and whether each stands in [effects].
fn family(top: &DeTable<'_>, base: &str, kind: &str) -> Vec<(String, bool)> {
    let number = |name: &str| match name.strip_prefix(base)? {
        "" => Some(1),
        rest => rest
            .strip_prefix('_')?
            .parse()
            .ok()
            .filter(|k: &usize| *k >= 2),
    };
    let all = effects(top).into_iter();
    let own = all.filter(|(_, of, _)| of == kind);
    let mut family: Vec<(usize, String, bool)> = own
        .filter_map(|(name, _, short)| Some((number(&name)?, name, short)))
        .collect();
    family.sort();
    if family.first().is_none_or(|(number, ..)| *number != 1) {
        return Vec::new();
    }
    family
        .into_iter()
        .map(|(_, name, short)| (name, short))
        .collect()
}

/// The first of `base_2`, `base_3`… from `number` on that nothing is called.
fn free_name(top: &DeTable<'_>, base: &str, number: usize) -> String {
    let taken = effects(top);
    let mut names = (number..).map(|number| format!("{base}_{number}"));
    let free = names.find(|name| taken.iter().all(|(other, ..)| other != name));
    free.unwrap_or_else(|| base.to_owned())
}

fn table_at<'t, 'd>(top: &'t DeTable<'d>, path: &[String]) -> Option<&'t DeTable<'d>> {
    match path {
        [list, name] => edit::table_named(top, list, name),
        [table] => top.get(table.as_str())?.get_ref().as_table(),
        _ => None,
    }
}

/// A value on one line, its numbers and texts as they are written.
fn inline(text: &str, node: &toml::Spanned<DeValue<'_>>) -> String {
    match node.get_ref() {
        DeValue::Array(list) => {
            let items: Vec<String> = list.iter().map(|item| inline(text, item)).collect();
            format!("[{}]", items.join(", "))
        }
        DeValue::Table(table) => {
            let pairs = table.iter().map(|(key, node)| {
                format!("{} = {}", edit::key(key.get_ref()), inline(text, node))
            });
            let pairs: Vec<String> = pairs.collect();
            format!("{{ {} }}", pairs.join(", "))
        }
        DeValue::String(string) => quoted(string),
        _ => text[node.span()].to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn script(text: &str) -> Script {
        Script::new("s", "s", text)
    }

    #[test]
    fn an_entry_goes_behind_what_there_is() {
        let push = Entry::event(0.1 + 0.2)
            .with_text("body", "a\"b")
            .with_vector("force", Vector3::new(1.0, -1e-300, 0.1))
            .with_point(true, Vector3::new(0.0, 0.5, 0.0));
        let headed = "[[event]]\nat = 1\n# the end";
        let lines = "\n[[event]]\nat = 0.30000000000000004\nunforeseen = true\nbody = \"a\\\"b\"\nforce = [1.0, -1e-300, 0.1]\npoint = { body = [0.0, 0.5, 0.0] }\n";
        let braces = "{ at = 0.30000000000000004, unforeseen = true, body = \"a\\\"b\", force = [1.0, -1e-300, 0.1], point = { body = [0.0, 0.5, 0.0] } }";
        for (before, after) in [
            (headed, format!("{headed}\n{lines}")),
            ("duration = 1\n", format!("duration = 1\n{lines}")),
            ("event = []", format!("event = [{braces}]")),
            (
                "event = [{ at = 1 }, # one, two\n]",
                format!("event = [{{ at = 1 }}, {braces}, # one, two\n]"),
            ),
        ] {
            let mut text = Text::new(before);
            text.add(&push, edit::From::Here).unwrap();
            assert_eq!(text.as_str(), after);
            edit::parse(text.as_str()).unwrap();
        }
        assert!(Text::new("event = 3").add(&push, edit::From::Here).is_err());
    }

    #[test]
    fn an_argument_becomes_another_effect() {
        let text = "[effects]\ngravity = [0, -9.81, 0]\n[effects.damping]\nangular = 0.1 # 1/s\nlinear = 1e-3\n\
                    [[effect]]\nname = \"wheel\"\nmotor = { axis = [0, 1, 0], torque = 0.5 }\nbodies = [ \"a\", 'b' ]\n";
        for (path, value, name, argument, instead_of) in [
            (
                "damping.angular",
                "0.2",
                "damping_2",
                "damping = { angular = 0.2, linear = 1e-3 }",
                "damping",
            ),
            (
                "gravity",
                "[0, 0, 0]",
                "gravity_2",
                "gravity = [0, 0, 0]",
                "gravity",
            ),
            (
                "wheel.motor.torque",
                "0.7",
                "wheel_2",
                "motor = { axis = [0, 1, 0], torque = 0.7 }\nbodies = [\"a\", \"b\"]",
                "wheel",
            ),
            ("drag.linear", "0.7", "drag", "drag = { linear = 0.7 }", ""),
        ] {
            let amended = script(text).amended(path, value).unwrap();
            let want = format!("\n[[effect]]\nname = \"{name}\"\n{argument}\non = false\n");
            assert_eq!(amended.entry.written(false), want);
            assert_eq!(amended.name, name);
            assert_eq!(amended.instead_of.join(" "), instead_of);
            assert!(script(text).is_argument(path, value));
        }
        // And again, of the one that took its place.
        let mut twice = script(text);
        let amended = twice.amended("damping.angular", "0.2").unwrap();
        twice.add(amended.entry, "set damping.angular 0.2");
        let third = twice.amended("damping.linear", "0").unwrap();
        assert_eq!(third.instead_of, ["damping", "damping_2"]);
        let want = "\n[[effect]]\nname = \"damping_3\"\ndamping = { angular = 0.2, linear = 0 }\non = false\n";
        assert_eq!(third.entry.written(false), want);
        assert_eq!(twice.effects_like("damping_2"), ["damping", "damping_2"]);
        for path in ["duration", "body.a.mass", "effect.wheel.on", "nothing", ""] {
            assert!(!twice.is_argument(path, "1"), "{path}");
            assert!(twice.amended(path, "1").is_err(), "{path}");
        }
    }
}
