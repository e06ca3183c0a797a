//! What a recording was made from: enough to run it again, and to say whether that must give the same
//! bits.

use super::RecordError;
use super::rrd::RrdFile;
use crate::scene::{Scene, Stepping};
use rerun::archetypes::TextDocument;
use rerun::components::MediaType;
use rerun::external::arrow::array::{Array as _, StringArray};
use rerun::log::Chunk;
use rerun::{ComponentIdentifier, DynamicArchetype};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Where the scene's text is.
pub const TEXT: &str = "/scene";
/// Where the rest is: the properties of the recording, which a viewer shows.
pub const PROPERTIES: &str = "/__properties/torquescope";
const ARCHETYPE: &str = "torquescope";

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
        Self {
            text: scene.text.to_string(),
            facts,
        }
    }

    /// Files that the scene reads besides its text, by name and what tells their contents apart.
    #[must_use]
    pub fn with_files(mut self, files: impl IntoIterator<Item = (String, u64)>) -> Self {
        let files = files.into_iter();
        let files: Vec<String> = files
            .map(|(name, hash)| format!("{name} {hash:016x}"))
            .collect();
        if !files.is_empty() {
            self.facts.insert("files".to_owned(), files);
        }
        self
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
        file.statics(PROPERTIES, &[&properties])
    }
}

pub(super) fn machine() -> String {
    format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS)
}

/// What is read of a provenance so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Parts {
    text: Option<String>,
    facts: BTreeMap<String, Vec<String>>,
}

impl Parts {
    /// Reads what a chunk says of it, if anything.
    pub fn read(&mut self, chunk: &Chunk) {
        let path = chunk.entity_path().to_string();
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
        facts
            .contains_key("version")
            .then_some(Provenance { text, facts })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_decides_the_bits_is_compared_and_what_does_not_is_not() {
        let text = "duration = 1\n[[body]]\nname = \"a\"\nmass = 1\ninertia = [1, 1, 1]\n";
        let scene = |text: &str| Scene::parse("s", "s", text).unwrap_or_else(|why| panic!("{why}"));
        let one = Provenance::of(&scene(text)).with_files([("t.obj".to_owned(), 1)]);
        let same = Provenance::of(&scene(&text.replace("\"a\"", "\"b\"")));
        let same = same.with_files([("t.obj".to_owned(), 1)]);
        assert!(one.differences(&same).is_empty());
        let other = format!("stepping = {{ step = 0.25 }}\n{text}");
        let other = Provenance::of(&scene(&other)).with_files([("t.obj".to_owned(), 2)]);
        let want = [
            "step: 0.001 there, 0.25 here",
            "files: t.obj 0000000000000001 there, t.obj 0000000000000002 here",
        ];
        assert_eq!(one.differences(&other), want);
        let none = Provenance::of(&scene(text));
        assert_eq!(
            one.differences(&none),
            ["files: t.obj 0000000000000001 there, none here"]
        );
    }
}
