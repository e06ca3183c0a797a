//! Mass properties of the bodies of a log: a small TOML, or a robot's description (URDF, MJCF).
//!
//! ```toml
//! [body.box]
//! mass = 2.0                       # kg
//! inertia = [0.1, 0.2, 0.25]       # kg m², about the centre of mass, body axes; or three rows of three
//! centre_of_mass = [0.0, 0.1, 0.0] # m, body axes, from the position that is logged
//! size = [1.0, 0.5, 0.4]           # m, full extents
//! ```
//!
//! What is declared is kept as it is: whether a rigid body can have it is judged by whoever uses it.

use super::read::Note;
use super::{Declared, Log};
use crate::mass::links::{self, Description, LinksError};
use crate::scene::Problems;
use crate::scene::read::document;
use crate::scene::table::{Node, Table};
use nalgebra::{Matrix3, Vector3};
use std::io::Read as _;
use std::path::Path;

/// Bodies by their names.
pub type Bodies = Vec<(String, Declared)>;

/// Why there are no bodies.
#[derive(Debug, thiserror::Error)]
pub enum BodiesError {
    #[error(
        "{file}: cannot be read: {why}; name a file of bodies: docs/logs.md says what is in it"
    )]
    Unreadable { file: String, why: std::io::Error },
    #[error("{file}: {what}; {remedy}")]
    NotBodies {
        file: String,
        what: String,
        remedy: &'static str,
    },
    #[error("{file}: {why}")]
    Links { file: String, why: LinksError },
    #[error(transparent)]
    Wrong(#[from] Problems),
}

/// Bodies of a file; what it holds says which kind it is. Notes tell what of it is not used.
pub fn load(path: &Path) -> Result<(Bodies, Vec<Note>), BodiesError> {
    let file = path.to_string_lossy().into_owned();
    let unreadable = |why| BodiesError::Unreadable {
        file: file.clone(),
        why,
    };
    let mut bytes = Vec::new();
    let opened = std::fs::File::open(path).map_err(unreadable)?;
    opened
        .take(links::LARGEST + 1)
        .read_to_end(&mut bytes)
        .map_err(unreadable)?;
    read(&file, &bytes)
}

/// Bodies of a file's bytes; `file` is what messages call it.
pub fn read(file: &str, bytes: &[u8]) -> Result<(Bodies, Vec<Note>), BodiesError> {
    const REMEDY: &str = "bodies are in TOML ([body.NAME]), URDF or MJCF";
    let not_bodies = |what: &str| BodiesError::NotBodies {
        file: file.to_owned(),
        what: what.to_owned(),
        remedy: REMEDY,
    };
    if bytes.len() as u64 > links::LARGEST {
        return Err(not_bodies("is larger than any file of bodies"));
    }
    let text = std::str::from_utf8(bytes).map_err(|_| not_bodies("is not text in UTF-8"))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    if text.trim_start().starts_with('<') {
        let description = links::parse(file, text.as_bytes());
        let description = description.map_err(|why| BodiesError::Links {
            file: file.to_owned(),
            why,
        })?;
        return Ok(of_links(&description));
    }
    Ok((parse(file, text)?, Vec::new()))
}

/// Bodies of a TOML text: all that is wrong with it at once.
pub fn parse(file: &str, text: &str) -> Result<Bodies, Problems> {
    let mut problems = Problems::new(file, text);
    let mut bodies = Vec::new();
    if let Some(document) = document(text, &mut problems) {
        let top = Table::new(document.get_ref(), 0..0, "a file of bodies");
        match top.get("body") {
            Some(node) => {
                if let Some(table) = node.table("[body]".to_owned(), &mut problems) {
                    bodies = table
                        .named("body")
                        .filter_map(|(name, node)| {
                            let table =
                                node.table(format!("[body.{}]", named(name)), &mut problems)?;
                            Some((name.to_owned(), body(&table, &mut problems)?))
                        })
                        .collect();
                }
            }
            None => problems.add_as(
                "missing-key",
                &(0..0),
                "no body is in it; write [body.NAME] with mass and inertia for each",
            ),
        }
        top.check_keys(&mut problems);
    }
    match problems.is_empty() {
        true => Ok(bodies),
        false => Err(problems),
    }
}

fn named(name: &str) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    match !name.is_empty() && name.chars().all(is_bare) {
        true => name.to_owned(),
        false => format!("\"{}\"", super::columns::shown(name)),
    }
}

fn body(table: &Table<'_>, problems: &mut Problems) -> Option<Declared> {
    let mass = table.get("mass").map(|node| node.number("kg", problems));
    let what = "three moments or three rows of three, kg m²: inertia = [x, y, z]";
    let inertia = table.require("inertia", what, problems);
    let inertia = inertia.and_then(|node| tensor(&node, problems));
    let vector = |key, problems: &mut Problems| {
        let node = table.get(key)?;
        Some(node.vector("m", problems))
    };
    let centre = vector("centre_of_mass", problems);
    let size = vector("size", problems);
    table.check_keys(problems);
    let absent_or_right = |vector: Option<Option<Vector3<f64>>>| match vector {
        Some(None) => None,
        Some(right) => Some(right),
        None => Some(None),
    };
    Some(Declared {
        mass: match mass {
            Some(None) => return None,
            mass => mass.flatten(),
        },
        inertia_b: inertia?,
        centre_of_mass_b: absent_or_right(centre)?.unwrap_or_default(),
        size: absent_or_right(size)?,
    })
}

fn tensor(node: &Node<'_>, problems: &mut Problems) -> Option<Matrix3<f64>> {
    if node.is_array_of_arrays() {
        return node.matrix("kg m²", problems);
    }
    if node.array_length() != Some(3) {
        node.problem(
            "must be three moments or three rows of three (kg m², about the centre of mass, body axes)",
            problems,
        );
        return None;
    }
    let moments = node.vector("kg m²", problems)?;
    Some(Matrix3::from_diagonal(&moments))
}

/// Bodies of a robot's description: positions are of the link's origin.
pub fn of_links(description: &Description) -> (Bodies, Vec<Note>) {
    let mut notes: Vec<Note> = description
        .notes
        .iter()
        .map(|note| Note::new("description", note.clone()))
        .collect();
    let mut bodies = Vec::new();
    for link in &description.links {
        let without = |why: &str| {
            let part = description.language.part();
            let what = format!("the {part} {why}: nothing is declared of it");
            Note::new("no-inertia", what)
                .of(&super::columns::shown(&link.name))
                .at(u64::from(link.line))
        };
        match &link.inertial {
            None => notes.push(without("says nothing of its inertia")),
            Some(Err(why)) => notes.push(without(&format!(
                "has an inertia that cannot be read ({why})"
            ))),
            Some(Ok(inertial)) => bodies.push((
                link.name.clone(),
                Declared {
                    mass: Some(inertial.mass),
                    inertia_b: inertial.tensor_in_link(),
                    centre_of_mass_b: inertial.centre,
                    size: link.extents,
                },
            )),
        }
    }
    (bodies, notes)
}

impl Log {
    /// Gives bodies what is said of them, by name; one body that is not named in the log takes the only one that is
    /// declared. Notes tell which are left over.
    pub fn declare(&mut self, bodies: Bodies) -> Vec<Note> {
        if let ([one], [(_, declared)]) = (&mut self.bodies[..], &bodies[..])
            && one.name == super::read::NAMELESS
        {
            one.declared = Some(declared.clone());
            return Vec::new();
        }
        let mut notes = Vec::new();
        for (name, declared) in bodies {
            // Copies of a body in other runs have its name and theirs.
            let copies = |logged: &&mut super::Logged| {
                let stem = logged.name.rsplit_once('@').map_or("", |(stem, _)| stem);
                logged.name == name || stem == name
            };
            let mut any = false;
            for logged in self.bodies.iter_mut().filter(copies) {
                logged.declared = Some(declared.clone());
                any = true;
            }
            if !any {
                let known: Vec<&str> = self.bodies.iter().map(|b| b.name.as_str()).collect();
                let note = Note::new("no-rows", "is declared, and the log has no rows of it");
                let remedy = crate::trace::nearest(&name, &known);
                notes.push(note.of(&super::columns::shown(&name)).remedy(remedy));
            }
        }
        for logged in self
            .bodies
            .iter()
            .filter(|logged| logged.declared.is_none())
        {
            let note = Note::new(
                "not-declared",
                "nothing is declared of its mass and inertia",
            );
            notes.push(note.of(&logged.name));
        }
        notes
    }
}
