//! The files that a scene names beside its own text: meshes and robot descriptions.
//!
//! They are read through a [`Library`], and what was read is kept with the scene ([`Enclosure`]): a scene
//! that is kept as text, in a recording, runs again from its text and its enclosures, wherever that is.

use super::problem::Problems;
use super::read::fingerprint;
use super::table::{Node, Table};
use crate::mass::links;
use crate::mass::mesh::{self, MeshError, Polyhedron};
use std::cell::RefCell;
use std::collections::HashMap;
use std::io;
use std::path::PathBuf;
use std::sync::Arc;

/// A file that a scene names, as it was when the scene was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Enclosure {
    /// As the scene writes it.
    pub name: String,
    /// FNV-1a over its bytes.
    pub fingerprint: u64,
    pub bytes: Arc<[u8]>,
}

impl Enclosure {
    pub fn new(name: &str, bytes: Vec<u8>) -> Self {
        Self {
            name: name.to_owned(),
            fingerprint: fingerprint(&bytes),
            bytes: bytes.into(),
        }
    }
}

/// Where the files that a scene names are found.
pub trait Library: std::fmt::Debug + Send + Sync {
    /// The bytes of a file by the name that the scene has for it, no more than `most` and one.
    fn read(&self, name: &str, most: u64) -> io::Result<Vec<u8>>;

    /// Where it looks, as in "looked for HERE".
    fn place(&self) -> String;
}

/// The folder of the scene's file, from which paths count.
#[derive(Clone, Debug)]
pub struct Folder(pub PathBuf);

impl Library for Folder {
    fn read(&self, name: &str, most: u64) -> io::Result<Vec<u8>> {
        use std::io::Read as _;
        let path = self.0.join(name);
        // A pipe would be waited for.
        if !std::fs::metadata(&path)?.is_file() {
            return Err(io::Error::other("it is not a file"));
        }
        let mut bytes = Vec::new();
        let file = std::fs::File::open(path)?;
        file.take(most + 1).read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    fn place(&self) -> String {
        match self.0.as_os_str().is_empty() {
            true => "in the current folder".to_owned(),
            false => format!("from the scene's folder, {}", self.0.display()),
        }
    }
}

/// What was kept of an earlier reading; nothing, for a scene that is text alone.
impl Library for Vec<Enclosure> {
    fn read(&self, name: &str, _: u64) -> io::Result<Vec<u8>> {
        let found = self.iter().find(|enclosure| enclosure.name == name);
        let found = found.ok_or_else(|| io::Error::from(io::ErrorKind::NotFound))?;
        Ok(found.bytes.to_vec())
    }

    fn place(&self) -> String {
        "among the files kept with the scene's text".to_owned()
    }
}

/// A mesh by its file and its scale's bits; `None` where it was refused.
type Meshes = HashMap<(String, u64), Option<Arc<Polyhedron>>>;

/// Files while a scene is read: each read once, each mesh made once.
pub(super) struct Files<'a> {
    library: &'a dyn Library,
    read: RefCell<Vec<Enclosure>>,
    meshes: RefCell<Meshes>,
}

/// Bytes of all files together at most.
const MOST_BYTES: u64 = 2 * mesh::LARGEST;

impl<'a> Files<'a> {
    pub fn new(library: &'a dyn Library) -> Self {
        Self {
            library,
            read: RefCell::default(),
            meshes: RefCell::default(),
        }
    }

    pub fn into_enclosures(self) -> Vec<Enclosure> {
        self.read.into_inner()
    }

    /// The bytes of the file that a node names.
    pub fn bytes(&self, node: &Node<'_>, most: u64, problems: &mut Problems) -> Option<Arc<[u8]>> {
        let name = node.str(problems)?;
        let mut read = self.read.borrow_mut();
        if let Some(known) = read.iter().find(|known| known.name == name) {
            return Some(Arc::clone(&known.bytes));
        }
        let bytes = match self.library.read(name, most) {
            Ok(bytes) => bytes,
            Err(why) => {
                let place = self.library.place();
                node.problem(
                    format!("cannot be read: {why}; looked for {place}"),
                    problems,
                );
                return None;
            }
        };
        let before: u64 = read.iter().map(|file| file.bytes.len() as u64).sum();
        if bytes.len() as u64 > most || before + bytes.len() as u64 > MOST_BYTES {
            let why = format!(
                "is too large: a file of this kind may have {most} bytes, all files of a scene {MOST_BYTES}"
            );
            node.problem(why, problems);
            return None;
        }
        read.push(Enclosure::new(name, bytes));
        read.last().map(|file| Arc::clone(&file.bytes))
    }

    /// `mesh = { file = "…", scale = 0.01 }`.
    pub fn mesh(&self, node: Node<'_>, problems: &mut Problems) -> Option<Arc<Polyhedron>> {
        let table = node.table("mesh = {…}".to_owned(), problems)?;
        let file = table.require(
            "file",
            "the file of the mesh, from the scene's folder: file = \"body.obj\"",
            problems,
        );
        let scale = match table.get("scale") {
            None => Some(1.0),
            Some(node) => node.positive("m a unit of the file", problems),
        };
        table.check_keys(problems);
        let (file, scale) = (file?, scale?);
        let name = file.str(problems)?;
        let key = (name.to_owned(), scale.to_bits());
        if let Some(known) = self.meshes.borrow().get(&key) {
            return known.clone();
        }
        let bytes = self.bytes(&file, mesh::LARGEST, problems)?;
        let body = match mesh::parse(name, &bytes, scale) {
            Ok(body) => Some(Arc::new(body)),
            Err(why @ (MeshError::Unknown | MeshError::TooLarge)) => {
                file.problem(why.to_string(), problems);
                None
            }
            Err(why) => {
                file.problem(format!("is no body: {why}"), problems);
                None
            }
        };
        self.meshes.borrow_mut().insert(key, body.clone());
        body
    }

    /// The description of a robot in the file that a node names.
    pub fn robot(&self, node: &Node<'_>, problems: &mut Problems) -> Option<links::Description> {
        let bytes = self.bytes(node, links::LARGEST, problems)?;
        let robot = links::parse(node.str(problems)?, &bytes);
        let robot = robot.map_err(|why| node.problem(why.to_string(), problems));
        robot.ok()
    }
}

/// What an `inertial` stands in place of.
pub(super) fn nothing_beside_inertial(table: &Table<'_>, problems: &mut Problems) {
    for key in ["shape", "mass", "density", "inertia"] {
        if let Some(node) = table.get(key) {
            let why = "beside inertial, which gives mass, centre of mass and inertia, and is drawn as the box that has them; keep one";
            node.problem(why, problems);
        }
    }
}
