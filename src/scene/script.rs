//! A scene's text, from a file or from the program itself; what is to be changed in it; and the scenes that
//! come of it: one, or one for each value of its `[sweep]`.

use super::amend::Entry;
use super::carried;
use super::edit::{self, From, Origin, Text, quoted};
use super::finding::{Finding, Severity};
use super::problem::{At, Problems};
use super::read;
use super::table::nearest;
use super::warnings::{self, Told};
use super::{Folder, LARGEST, Library, Scene, SceneError};
use std::io::Read as _;
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
    /// A table is added.
    Add(Entry),
}

/// Recordings of one sweep at most: as many as one can find one's way among.
const MOST_SCENES: usize = 64;

/// Bytes of all the texts of a sweep at most: they are held at once.
const SWEPT: usize = 1 << 26;

impl Script {
    /// Reads a scene file, or takes a scene that the program carries, such as `@cone`.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        let file = path.display().to_string();
        if let Some(name) = file.strip_prefix('@') {
            return Self::carried(name);
        }
        let source = read_to_string(path).map_err(|error| SceneError::Unreadable {
            why: error.to_string(),
            remedy: remedy_for(path, &error),
            file: file.clone(),
        })?;
        let name = path.file_stem().map_or_else(
            || "scene".to_owned(),
            |stem| stem.to_string_lossy().into_owned(),
        );
        let folder = Folder(path.parent().map(Path::to_owned).unwrap_or_default());
        Ok(Self::new(&file, &name, &source).with_files(folder))
    }

    fn carried(name: &str) -> Result<Self, SceneError> {
        let file = format!("@{name}");
        if let Some(scene) = carried::find(name) {
            let script = Self::new(&file, scene.name, scene.text);
            return Ok(script.with_files(scene.enclosures()));
        }
        let names: Vec<String> = carried::CARRIED
            .iter()
            .map(|scene| format!("@{}", scene.name))
            .collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let remedy = nearest(&file, &names);
        Err(SceneError::Unreadable {
            file,
            why: "no scene of this name is carried".to_owned(),
            remedy,
        })
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

    /// As it was written, without what is to be changed.
    pub fn text(&self) -> &str {
        &self.source
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

    /// Adds an event or an effect behind those there are.
    pub fn add(&mut self, entry: Entry, argument: &str) {
        self.changes.push((Change::Add(entry), argument.to_owned()));
    }

    /// Leaves its sweep out: the scene as it stands.
    pub fn drop_sweep(&mut self) {
        self.changes.push((Change::Drop(&["sweep"]), String::new()));
    }

    /// The same with all its changes done: the text that they came to, and the files that it names.
    #[must_use]
    pub fn settled(mut self, text: &str, files: impl Library + 'static) -> Self {
        text.clone_into(&mut self.source);
        self.changes.clear();
        self.with_files(files)
    }

    /// What tells the scene from the file's, in words.
    fn label(&self) -> Option<String> {
        let changes = self.changes.iter().filter_map(|(change, _)| match change {
            Change::Set { path, value } => Some(format!("{path} = {}", one_line(value))),
            Change::Drop(_) | Change::Add(_) => None,
            Change::Until(end) => Some(format!("until {end} s")),
        });
        let all: Vec<String> = self.variant.iter().cloned().chain(changes).collect();
        (!all.is_empty()).then(|| all.join(", "))
    }

    /// The scene as it stands, its sweep looked at and left aside.
    pub fn scene(&self) -> Result<Scene, Problems> {
        let text = self.edited()?;
        let (scene, _) = self.read(&text, false)?;
        self.swept(&text, false)?;
        Ok(scene)
    }

    /// What there is to run: the scene, or one for each value of its sweep.
    pub fn scenes(&self) -> Result<Vec<Scene>, Problems> {
        let all = self.all(false)?;
        Ok(all.into_iter().map(|(scene, _)| scene).collect())
    }

    /// The same, judged: what is legal and probably wrong with any of them, but for what the scene says is
    /// meant. Of a sweep each place is told once.
    pub fn judge(&self) -> Result<(Vec<Scene>, Vec<Finding>), Problems> {
        let (scenes, told) = self.all(true)?.into_iter().unzip();
        let finding = |(code, at, message): (&'static str, At, String)| {
            let finding = Finding::at(&self.file, &self.source, &at);
            finding.saying(Severity::Warning, code, &message)
        };
        let told = warnings::together(told);
        Ok((scenes, told.into_iter().map(finding).collect()))
    }

    fn all(&self, judge: bool) -> Result<Vec<(Scene, Told)>, Problems> {
        let text = self.edited()?;
        let (mut scene, told) = self.read(&text, judge)?;
        scene.variant = self.label();
        let swept = self.swept(&text, judge)?;
        Ok(if swept.is_empty() {
            vec![(scene, told)]
        } else {
            swept
        })
    }

    fn problems(&self) -> Problems {
        Problems::new(&self.file, &self.source)
    }

    pub(super) fn edited(&self) -> Result<Text, Problems> {
        let mut text = Text::new(&self.source);
        let mut problems = self.problems();
        let too_large = self.source.len() as u64 > LARGEST;
        if self.changes.is_empty() || too_large || edit::parse(&self.source).is_err() {
            // The reader says what is wrong with it.
            return Ok(text);
        }
        let mut end = None;
        for (k, (change, argument)) in self.changes.iter().enumerate() {
            let done = match change {
                Change::Set { path, value } => text.set(path, value, From::Argument(k)),
                Change::Add(entry) => text.add(entry, From::Argument(k)),
                Change::Drop(paths) => paths.iter().try_for_each(|path| text.drop(path)),
                Change::Until(until) => {
                    end = Some(*until);
                    text.set("duration", &float(*until), From::Argument(k))
                }
            };
            if let Err(why) = done {
                problems.add_at(At::Argument(argument.clone()), why);
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

    fn read(&self, text: &Text, judge: bool) -> Result<(Scene, Told), Problems> {
        let named = (self.file.as_str(), self.name.as_str(), text.as_str());
        match read::scene(named, &*self.files, judge) {
            Ok((scene, found)) => Ok((scene, Told::new(found, |span| self.whence(text, span)))),
            Err(problems) => {
                let mut here = self.problems();
                here.take_from(problems, |span| self.whence(text, span));
                Err(here)
            }
        }
    }

    /// Where what stands there in the edited text came from.
    fn whence(&self, text: &Text, span: &Range<usize>) -> At {
        if *span == (0..0) {
            // About the scene as a whole.
            return At::File(0..0);
        }
        match text.origin_of(span.clone()) {
            Origin::Argument(k) => At::Argument(self.changes[k].1.clone()),
            Origin::File(start) => {
                // By the last byte, because behind it something else may have been put in; where all of it is
                // there for what was put into it, only the start is known.
                let last = text.origin(span.end.saturating_sub(1));
                let whole = !span.is_empty() && text.origin(span.start) == Origin::File(start);
                let end = match last {
                    Origin::File(last) if whole && last >= start => last + 1,
                    _ => start,
                };
                At::File(start..end)
            }
        }
    }

    /// The scene at each value of its sweep; none where it has none.
    fn swept(&self, text: &Text, judge: bool) -> Result<Vec<(Scene, Told)>, Problems> {
        let mut problems = self.problems();
        let mut wrong = |span: &Range<usize>, why: String| {
            problems.add_at(self.whence(text, span), why);
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
        if bytes > SWEPT {
            wrong(
                &node.span(),
                format!(
                    "the sweep's scenes together would have {bytes} bytes, more than the {SWEPT} that are held at once; take fewer values, or a [[swarm]] in place of many bodies"
                ),
            );
            return Err(problems);
        }
        let mut scenes: Vec<(Scene, Told)> = Vec::new();
        for k in 0..count.unwrap_or(0) {
            let point = point(&axes, k);
            match self.at(text, &point, judge) {
                Err(of_this) => problems.merge(of_this),
                Ok((scene, told)) => {
                    let same = |(other, _): &&(Scene, Told)| other.fingerprint == scene.fingerprint;
                    if let (Some(_), Some((_, value))) = (scenes.iter().find(same), point.last()) {
                        let label = scene.variant.as_deref().unwrap_or_default();
                        let why = format!("the sweep has {label} twice");
                        problems.add_at(self.whence(text, value), why);
                    }
                    scenes.push((scene, told));
                }
            }
        }
        match problems.is_empty() {
            true => Ok(scenes),
            false => Err(problems),
        }
    }

    /// The scene with these values, and no sweep.
    fn at(
        &self,
        text: &Text,
        point: &[(&Axis, &Range<usize>)],
        judge: bool,
    ) -> Result<(Scene, Told), Problems> {
        let mut one = text.clone();
        let mut label = Vec::from_iter(self.label());
        for (axis, value) in point {
            let words = &text.as_str()[(*value).clone()];
            label.push(format!("{} = {}", axis.path, one_line(words)));
            if let Err(why) = one.set(&axis.path, words, text.place(value)) {
                let mut problems = self.problems();
                problems.add_at(self.whence(text, &axis.key), why);
                return Err(problems);
            }
        }
        if let Err(why) = one.drop("sweep") {
            let mut problems = self.problems();
            problems.add(&(0..0), why);
            return Err(problems);
        }
        let (mut scene, told) = self.read(&one, judge)?;
        scene.variant = Some(label.join(", "));
        Ok((scene, told))
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

pub(super) fn float(x: f64) -> String {
    // Rust writes what TOML reads: 1.0, 1e-9, inf, NaN but for its case.
    format!("{x:?}").to_lowercase()
}

/// A value as TOML has it; a bare word is a text.
pub(super) fn toml_value(value: &str) -> Result<String, String> {
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

fn read_to_string(path: &Path) -> std::io::Result<String> {
    let mut source = String::new();
    let file = std::fs::File::open(path)?;
    // By what the file says of itself before a byte of it is read; a pipe says nothing.
    let said = file.metadata()?.len();
    if said > LARGEST || file.take(LARGEST + 1).read_to_string(&mut source)? as u64 > LARGEST {
        let why = format!("it is larger than any scene ({LARGEST} bytes)");
        return Err(std::io::Error::other(why));
    }
    Ok(source)
}

fn remedy_for(path: &Path, error: &std::io::Error) -> String {
    if error.kind() == std::io::ErrorKind::InvalidData {
        return "a scene is a text in UTF-8".to_owned();
    }
    if path.is_dir() {
        return "name a scene file, not a folder".to_owned();
    }
    if error.kind() != std::io::ErrorKind::NotFound {
        return "a scene is a TOML file that you may read".to_owned();
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let scenes: Vec<String> = std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .filter(|name| name.ends_with(".toml") && name != "Cargo.toml")
        .collect();
    let wanted = path.file_name().unwrap_or_default().to_string_lossy();
    match scenes.iter().map(String::as_str).collect::<Vec<_>>() {
        names if names.is_empty() => "`torquescope scenes` lists the scenes there are".to_owned(),
        mut names => {
            names.sort_unstable();
            nearest(&wanted, &names)
        }
    }
}
