//! What a recording was made from: enough to run it again, and to say whether that must give the same
//! bits.

use super::RecordError;
use super::rrd::RrdFile;
use crate::scene::{Enclosure, Scene, Stepping};
use rerun::archetypes::TextDocument;
use rerun::components::MediaType;
use rerun::external::arrow::array::{Array as _, ArrayRef, BinaryArray, StringArray};
use rerun::log::Chunk;
use rerun::{ComponentIdentifier, DynamicArchetype};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Where the scene's text is.
pub const TEXT: &str = "/scene";
/// Where the rest is: the properties of the recording, which a viewer shows.
pub const PROPERTIES: &str = "/__properties/torquescope";
const ARCHETYPE: &str = "torquescope";
/// Before the number of each file that the scene names.
const FILES: &str = "/scene/file_";
const FILE: &str = "torquescope_file";

/// This program's version.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
/// What decides the bits of a step besides the scene: IEEE 754 doubles, the operations in the order in
/// which they are written, functions from `libm`. It is the same on every machine.
const ARITHMETIC: &str = "f64, libm 0.2, nothing fused";

/// What a recording was made from.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance {
    /// The scene's text, as it was run.
    pub text: String,
    /// The files that it names, as they were.
    pub files: Vec<Enclosure>,
    /// The rest by name, as texts: `version`, `scene`, `method`, `step`, …
    facts: BTreeMap<String, Vec<String>>,
}

/// Facts that a run again must share to give the same bits.
const DECISIVE: [&str; 7] = [
    "version",
    "method",
    "step",
    "tolerance",
    "accuracy",
    "arithmetic",
    "files",
];

impl Provenance {
    pub fn of(scene: &Scene) -> Self {
        let mut facts = BTreeMap::new();
        let mut say = |name: &str, value: Option<String>| {
            facts.extend(value.map(|value| (name.to_owned(), vec![value])));
        };
        say("version", Some(VERSION.to_owned()));
        say("scene", Some(scene.name.clone()));
        say("variant", scene.variant.clone());
        say("method", Some(scene.stepping.name().to_owned()));
        // `{:?}` writes every digit that tells two f64 apart.
        say("step", Some(format!("{:?}", scene.step)));
        let (tolerance, accuracy) = match scene.stepping {
            Stepping::Method { tolerance, .. } => (Some(tolerance), None),
            Stepping::Accuracy(accuracy) => (None, Some(accuracy)),
        };
        say("tolerance", tolerance.map(|x| format!("{x:?}")));
        say("accuracy", accuracy.map(|x| format!("{x:?}")));
        say("arithmetic", Some(ARITHMETIC.to_owned()));
        say("machine", Some(machine()));
        say("text", Some(format!("{:016x}", scene.fingerprint)));
        let files = scene.enclosures.iter();
        let files: Vec<String> = files
            .map(|file| format!("{} {:016x}", file.name, file.fingerprint))
            .collect();
        if !files.is_empty() {
            facts.insert("files".to_owned(), files);
        }
        Self {
            text: scene.text.to_string(),
            files: scene.enclosures.clone(),
            facts,
        }
    }

    /// A fact, by its name.
    pub fn fact(&self, name: &str) -> Option<&str> {
        let values = self.facts.get(name)?;
        values.first().map(String::as_str)
    }

    /// What would have to be the same and is not: `method: rk4 there, jolt here`.
    pub fn differences(&self, here: &Self) -> Vec<String> {
        let words = |facts: &Self, name: &str| {
            let values = facts.facts.get(name);
            values.map_or("none".to_owned(), |values| values.join(", "))
        };
        let differ = |name: &&&str| self.facts.get(**name) != here.facts.get(**name);
        let different = DECISIVE.iter().filter(differ);
        different
            .map(|name| {
                format!(
                    "{name}: {} there, {} here",
                    words(self, name),
                    words(here, name)
                )
            })
            .collect()
    }

    pub(super) fn write(&self, file: &mut RrdFile) -> Result<(), RecordError> {
        let text = TextDocument::new(self.text.as_str()).with_media_type(MediaType::plain_text());
        file.statics(TEXT, &[&text])?;
        let mut properties = DynamicArchetype::new(ARCHETYPE);
        for (name, values) in &self.facts {
            let values = Arc::new(StringArray::from(values.clone()));
            let name = ComponentIdentifier::try_new(name);
            if let Ok(name) = name {
                properties = properties.with_component_from_data(name, values);
            }
        }
        file.statics(PROPERTIES, &[&properties])?;
        for (k, enclosure) in self.files.iter().enumerate() {
            let name = StringArray::from(vec![enclosure.name.as_str()]);
            let bytes = BinaryArray::from_vec(vec![&enclosure.bytes]);
            let columns: [(&str, ArrayRef); 2] =
                [("name", Arc::new(name)), ("bytes", Arc::new(bytes))];
            let mut held = DynamicArchetype::new(FILE);
            for (field, values) in columns {
                if let Ok(field) = ComponentIdentifier::try_new(field) {
                    held = held.with_component_from_data(field, values);
                }
            }
            file.statics(format!("{FILES}{k}"), &[&held])?;
        }
        Ok(())
    }
}

pub(super) fn machine() -> String {
    format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS)
}

/// What is read of a provenance so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Parts {
    text: Option<String>,
    files: Vec<Enclosure>,
    facts: BTreeMap<String, Vec<String>>,
}

impl Parts {
    /// Reads what a chunk says of it, if anything.
    pub fn read(&mut self, chunk: &Chunk) {
        let path = chunk.entity_path().to_string();
        if path.starts_with(FILES) {
            self.files.extend(enclosure(chunk));
            return;
        }
        if path != TEXT && path != PROPERTIES {
            return;
        }
        for column in chunk.components().values() {
            let name = column.descriptor.component.to_string();
            let values = match column.list_array.is_empty() {
                true => continue,
                false => column.list_array.value(0),
            };
            let Some(values) = values.as_any().downcast_ref::<StringArray>() else {
                continue;
            };
            let values: Vec<String> = values.iter().flatten().map(str::to_owned).collect();
            // `TextDocument:text`, or `torquescope:version`.
            let name = name.rsplit(':').next().unwrap_or_default().to_owned();
            match path == TEXT {
                true if name == "text" => self.text = values.into_iter().next(),
                true => {}
                false => self.facts.extend([(name, values)]),
            }
        }
    }

    pub fn whole(self) -> Option<Provenance> {
        let facts = self.facts;
        let text = self.text?;
        facts.contains_key("version").then_some(Provenance {
            text,
            files: self.files,
            facts,
        })
    }
}

/// A file that the scene names, as a chunk holds it.
fn enclosure(chunk: &Chunk) -> Option<Enclosure> {
    let first = |field: &str| -> Option<ArrayRef> {
        let mut columns = chunk.components().values();
        let column = columns.find(|column| {
            let name = column.descriptor.component.to_string();
            name.rsplit(':').next() == Some(field)
        })?;
        (!column.list_array.is_empty()).then(|| column.list_array.value(0))
    };
    let (name, bytes) = (first("name")?, first("bytes")?);
    let name = name.as_any().downcast_ref::<StringArray>()?;
    let bytes = bytes.as_any().downcast_ref::<BinaryArray>()?;
    if name.is_empty() || bytes.is_empty() {
        return None;
    }
    Some(Enclosure::new(name.value(0), bytes.value(0).to_vec()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_decides_the_bits_is_compared_and_what_does_not_is_not() {
        let text = "duration = 1\n[[body]]\nname = \"a\"\nmass = 1\ninertia = [1, 1, 1]\n";
        let scene = |text: &str, files: &[(&str, u8)]| {
            let mut scene = Scene::parse("s", "s", text).unwrap_or_else(|why| panic!("{why}"));
            let files = files
                .iter()
                .map(|&(name, byte)| Enclosure::new(name, vec![byte]));
            scene.enclosures = files.collect();
            Provenance::of(&scene)
        };
        let one = scene(text, &[("t.obj", 1)]);
        let same = scene(&text.replace("\"a\"", "\"b\""), &[("t.obj", 1)]);
        assert!(one.differences(&same).is_empty());
        let other = format!("stepping = {{ step = 0.25 }}\n{text}");
        let different = one.differences(&scene(&other, &[("t.obj", 2)]));
        assert_eq!(different.len(), 2, "{different:?}");
        assert_eq!(different[0], "step: 0.001 there, 0.25 here");
        assert!(different[1].starts_with("files: t.obj "), "{different:?}");
        let none = one.differences(&scene(text, &[]));
        assert!(
            none.len() == 1 && none[0].ends_with("there, none here"),
            "{none:?}"
        );
    }
}
