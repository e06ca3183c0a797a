//! A scene's text, what is to be changed in it, and the scenes that come of it: one, or one for each
//! value of its `[sweep]`.

use super::edit::{self, From, Origin, Text, quoted};
use super::problem::{Place, Problems};
use super::read;
use super::{Folder, Library, Scene, SceneError};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A scene's text and the changes asked for.
#[derive(Clone, Debug)]
pub struct Script {
    /// As messages call it.
    file: String,
    name: String,
    source: String,
    /// Each with the argument that asks for it, as it was written.
    changes: Vec<(Change, String)>,
    /// What told the text from others before.
    variant: Option<String>,
    /// Where the files are that it names.
    files: Arc<dyn Library>,
}

#[derive(Clone, Debug)]
enum Change {
    /// A path gets a value, in TOML.
    Set { path: String, value: String },
    /// Values that others take the place of.
    Drop(&'static [&'static str]),
    /// The scene ends there, s.
    Until(f64),
}

/// Recordings of one sweep at most: as many as one can find one's way among.
const MOST_SCENES: usize = 64;

impl Script {
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        let (file, name, source) = super::text_of(path)?;
        let folder = Folder(path.parent().map(Path::to_owned).unwrap_or_default());
        Ok(Self::new(&file, &name, &source).with_files(folder))
    }

    /// A text that names no files. `file` is how messages call it, `name` how recordings are called.
    pub fn new(file: &str, name: &str, source: &str) -> Self {
        Self {
            file: file.to_owned(),
            name: name.to_owned(),
            // Some editors open a file with a mark of its encoding.
            source: source.strip_prefix('\u{feff}').unwrap_or(source).to_owned(),
            changes: Vec::new(),
            variant: None,
            files: Arc::new(Vec::new()),
        }
    }

    /// The files that it names are in this library.
    #[must_use]
    pub fn with_files(mut self, files: impl Library + 'static) -> Self {
        self.files = Arc::new(files);
        self
    }

    /// Of a text that is one of a sweep's already: its values.
    #[must_use]
    pub fn of_variant(mut self, variant: Option<&str>) -> Self {
        self.variant = variant.map(str::to_owned);
        self
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether anything is to be changed.
    pub fn is_changed(&self) -> bool {
        !self.changes.is_empty()
    }

    /// `PATH=VALUE`, as `argument` wrote it.
    pub fn set(&mut self, assignment: &str, argument: &str) -> Result<(), String> {
        let Some((path, value)) = assignment.split_once('=') else {
            return Err(format!(
                "{argument}: has no value; write PATH=VALUE, such as body.cone.mass=2"
            ));
        };
        let value = toml_value(value.trim()).map_err(|why| format!("{argument}: {why}"))?;
        let path = path.trim().to_owned();
        self.changes
            .push((Change::Set { path, value }, argument.to_owned()));
        Ok(())
    }

    /// Steps by a method, by its name.
    pub fn set_method(&mut self, name: &str, argument: &str) {
        self.take_the_place(
            &["stepping.accuracy"],
            "stepping.method",
            quoted(name),
            argument,
        );
    }

    /// s.
    pub fn set_step(&mut self, step: f64, argument: &str) {
        self.take_the_place(
            &["stepping.accuracy"],
            "stepping.step",
            float(step),
            argument,
        );
    }

    /// rad.
    pub fn set_accuracy(&mut self, accuracy: f64, argument: &str) {
        let others = &["stepping.method", "stepping.step", "stepping.tolerance"];
        self.take_the_place(others, "stepping.accuracy", float(accuracy), argument);
    }

    fn take_the_place(
        &mut self,
        others: &'static [&'static str],
        path: &str,
        value: String,
        argument: &str,
    ) {
        let path = path.to_owned();
        self.changes
            .push((Change::Drop(others), argument.to_owned()));
        self.changes
            .push((Change::Set { path, value }, argument.to_owned()));
    }

    /// Ends the scene at `end`, s, earlier or later than it says; what would begin after that does not.
    pub fn end_at(&mut self, end: f64, argument: &str) {
        self.changes.push((Change::Until(end), argument.to_owned()));
    }

    /// What tells the scene from the file's, in words.
    fn label(&self) -> Option<String> {
        let changes = self.changes.iter().filter_map(|(change, _)| match change {
            Change::Set { path, value } => Some(format!("{path} = {}", one_line(value))),
            Change::Drop(_) => None,
            Change::Until(end) => Some(format!("until {end} s")),
        });
        let all: Vec<String> = self.variant.iter().cloned().chain(changes).collect();
        (!all.is_empty()).then(|| all.join(", "))
    }

    /// The scene as it stands, its sweep looked at and left aside.
    pub fn scene(&self) -> Result<Scene, Problems> {
        let text = self.edited()?;
        let scene = self.read(&text)?;
        self.swept(&text)?;
        Ok(scene)
    }

    /// What there is to run: the scene, or one for each value of its sweep.
    pub fn scenes(&self) -> Result<Vec<Scene>, Problems> {
        let text = self.edited()?;
        let mut scene = self.read(&text)?;
        scene.variant = self.label();
        let swept = self.swept(&text)?;
        Ok(if swept.is_empty() { vec![scene] } else { swept })
    }

    fn problems(&self) -> Problems {
        Problems::new(&self.file, &self.source)
    }

    fn edited(&self) -> Result<Text, Problems> {
        let mut text = Text::new(&self.source);
        let mut problems = self.problems();
        if self.changes.is_empty() || edit::parse(&self.source).is_err() {
            // The reader says what is wrong with it.
            return Ok(text);
        }
        let mut end = None;
        for (k, (change, argument)) in self.changes.iter().enumerate() {
            let done = match change {
                Change::Set { path, value } => text.set(path, value, From::Argument(k)),
                Change::Drop(paths) => paths.iter().try_for_each(|path| text.drop(path)),
                Change::Until(until) => {
                    end = Some(*until);
                    text.set("duration", &float(*until), From::Argument(k))
                }
            };
            if let Err(why) = done {
                problems.add_at(Place::Argument(argument.clone()), why);
            }
        }
        // Last, because events are called by their place in the list.
        if let Some(Err(why)) = end.map(|end| text.end_at(end)) {
            problems.add(&(0..0), why);
        }
        match problems.is_empty() {
            true => Ok(text),
            false => Err(problems),
        }
    }

    fn read(&self, text: &Text) -> Result<Scene, Problems> {
        read::scene(&self.file, &self.name, text.as_str(), &*self.files).map_err(|problems| {
            let mut here = self.problems();
            here.take_from(problems, |range| self.whence(text.origin_of(range)));
            here
        })
    }

    fn place(&self, text: &Text, offset: usize) -> Place {
        self.whence(text.origin(offset))
    }

    fn whence(&self, origin: Origin) -> Place {
        match origin {
            Origin::File(offset) => Place::File(offset),
            Origin::Argument(k) => Place::Argument(self.changes[k].1.clone()),
        }
    }

    /// The scene at each value of its sweep; none where it has none.
    fn swept(&self, text: &Text) -> Result<Vec<Scene>, Problems> {
        let mut problems = self.problems();
        let mut wrong = |span: &Range<usize>, why: String| {
            problems.add_at(self.place(text, span.start), why);
        };
        if !text.as_str().contains("sweep") {
            return Ok(Vec::new());
        }
        let Ok(document) = edit::parse(text.as_str()) else {
            return Ok(Vec::new());
        };
        let Some(node) = document.get_ref().get("sweep") else {
            return Ok(Vec::new());
        };
        let Some(axes) = axes(text, node, &mut wrong) else {
            return Err(problems);
        };
        let count = axes
            .iter()
            .try_fold(1_usize, |n, axis| n.checked_mul(axis.values.len()));
        if count.is_none_or(|count| count > MOST_SCENES) {
            let count = count.map_or("more than can be counted".to_owned(), |count| {
                count.to_string()
            });
            wrong(
                &node.span(),
                format!(
                    "the sweep is {count} recordings (every value with every other); at most {MOST_SCENES} are made in one file"
                ),
            );
            return Err(problems);
        }
        let bytes = text.as_str().len().saturating_mul(count.unwrap_or(0));
        if bytes as u64 > super::LARGEST {
            wrong(
                &node.span(),
                format!(
                    "the sweep's scenes together would be larger than any scene ({} bytes)",
                    super::LARGEST
                ),
            );
            return Err(problems);
        }
        let mut scenes: Vec<Scene> = Vec::new();
        for k in 0..count.unwrap_or(0) {
            let point = point(&axes, k);
            match self.at(text, &point) {
                Err(of_this) => problems.merge(of_this),
                Ok(scene) => {
                    let same = |other: &&Scene| other.fingerprint == scene.fingerprint;
                    if let (Some(_), Some((_, value))) = (scenes.iter().find(same), point.last()) {
                        let label = scene.variant.as_deref().unwrap_or_default();
                        let why = format!("the sweep has {label} twice");
                        problems.add_at(self.place(text, value.start), why);
                    }
                    scenes.push(scene);
                }
            }
        }
        match problems.is_empty() {
            true => Ok(scenes),
            false => Err(problems),
        }
    }

    /// The scene with these values, and no sweep.
    fn at(&self, text: &Text, point: &[(&Axis, &Range<usize>)]) -> Result<Scene, Problems> {
        let mut one = text.clone();
        let mut label = Vec::from_iter(self.label());
        for (axis, value) in point {
            let words = &text.as_str()[(*value).clone()];
            label.push(format!("{} = {}", axis.path, one_line(words)));
            if let Err(why) = one.set(&axis.path, words, text.place(value.start)) {
                let mut problems = self.problems();
                problems.add_at(self.place(text, axis.key.start), why);
                return Err(problems);
            }
        }
        if let Err(why) = one.drop("sweep") {
            let mut problems = self.problems();
            problems.add(&(0..0), why);
            return Err(problems);
        }
        let mut scene = self.read(&one)?;
        scene.variant = Some(label.join(", "));
        Ok(scene)
    }
}

/// A path and the places of its values.
struct Axis {
    path: String,
    key: Range<usize>,
    values: Vec<Range<usize>>,
}

/// What a sweep goes through, in the order of the file.
fn axes(
    text: &Text,
    sweep: &Spanned<DeValue<'_>>,
    wrong: &mut dyn FnMut(&Range<usize>, String),
) -> Option<Vec<Axis>> {
    let Some(table) = sweep.get_ref().as_table() else {
        wrong(
            &sweep.span(),
            "`sweep` takes a table: [sweep] and below it PATH = [values]".to_owned(),
        );
        return None;
    };
    let mut axes = Vec::new();
    let whole = collect(text, table, "", &mut axes, wrong);
    if whole && axes.is_empty() {
        wrong(
            &sweep.span(),
            "the sweep has no values; add a line such as damping = [0.0, 0.1]".to_owned(),
        );
        return None;
    }
    axes.sort_by_key(|axis: &Axis| axis.key.start);
    whole.then_some(axes)
}

/// Paths in quotes are keys, paths without are tables in tables: both are read alike.
fn collect(
    text: &Text,
    table: &DeTable<'_>,
    prefix: &str,
    axes: &mut Vec<Axis>,
    wrong: &mut dyn FnMut(&Range<usize>, String),
) -> bool {
    let mut whole = true;
    for (key, node) in table.iter() {
        let path = match prefix {
            "" => key.get_ref().to_string(),
            _ => format!("{prefix}.{}", key.get_ref()),
        };
        if let Some(inner) = node.get_ref().as_table() {
            whole &= collect(text, inner, &path, axes, wrong);
            continue;
        }
        let list = node.get_ref().as_array().filter(|list| !list.is_empty());
        let Some(list) = list else {
            wrong(
                &node.span(),
                format!(
                    "{path} = {} is no list of values; write it in brackets: [0.0, 0.1]",
                    one_line(&text.as_str()[node.span()])
                ),
            );
            whole = false;
            continue;
        };
        axes.push(Axis {
            path,
            key: key.span(),
            values: list.iter().map(Spanned::span).collect(),
        });
    }
    whole
}

/// The `k`-th combination, the last axis going fastest.
fn point(axes: &[Axis], mut k: usize) -> Vec<(&Axis, &Range<usize>)> {
    let mut point = Vec::new();
    for axis in axes.iter().rev() {
        point.push((axis, &axis.values[k % axis.values.len()]));
        k /= axis.values.len();
    }
    point.reverse();
    point
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn float(x: f64) -> String {
    // Rust writes what TOML reads: 1.0, 1e-9, inf, NaN but for its case.
    format!("{x:?}").to_lowercase()
}

/// A value as TOML has it; a bare word is a text.
fn toml_value(value: &str) -> Result<String, String> {
    let Err(error) = DeValue::parse(value) else {
        return Ok(value.to_owned());
    };
    let mut letters = value.chars();
    let word = letters.next().is_some_and(char::is_alphabetic)
        && letters.all(|c| c.is_alphanumeric() || " -_./@".contains(c));
    match word {
        true => Ok(quoted(value)),
        false => Err(format!("the value is not TOML: {}", error.message().trim())),
    }
}
