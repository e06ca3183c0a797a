//! What robot descriptions say of their links' inertia: URDF and MuJoCo's MJCF, read as they are written
//! and judged one by one.
//!
//! URDF (`<inertial>`: `<origin xyz rpy>`, `<mass value>`, `<inertia ixx ixy ixz iyy iyz izz>`) gives the
//! tensor about the centre of mass along the axes of the inertial frame; so does MJCF (`<inertial pos quat
//! mass diaginertia>` or `fullinertia`). Both frames are given in the link's.

mod lump;
mod mjcf;
mod numbers;
mod urdf;
mod verdict;

pub use lump::Lump;
pub use verdict::Verdict;

use super::MassProperties;
use super::tensor::turned;
use crate::math::symmetric_eigen;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use roxmltree::{Document, Node, ParsingOptions};
use std::path::Path;

/// Bytes of a description at most, and elements and texts in it.
pub const LARGEST: u64 = 1 << 24;
const MOST_NODES: u32 = 1 << 20;

/// Which language a description is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    Urdf,
    Mjcf,
}

impl Language {
    pub fn name(self) -> &'static str {
        match self {
            Self::Urdf => "URDF",
            Self::Mjcf => "MJCF",
        }
    }

    /// What it calls a rigid part.
    pub fn part(self) -> &'static str {
        match self {
            Self::Urdf => "link",
            Self::Mjcf => "body",
        }
    }
}

/// The rigid parts that a file describes.
#[derive(Clone, Debug)]
pub struct Description {
    pub language: Language,
    pub name: String,
    pub links: Vec<Link>,
    /// What of the file is not looked at, or overrides what is.
    pub notes: Vec<String>,
}

/// A rigid part: URDF's link, MuJoCo's body.
#[derive(Clone, Debug)]
pub struct Link {
    pub name: String,
    /// The line of the file that it begins on.
    pub line: u32,
    /// `None` where it says nothing of its inertia; an error where what it says cannot be read.
    pub inertial: Option<Result<Inertial, String>>,
    /// Full extents of the box about its shapes along its axes, m, where all have a size in the file.
    pub extents: Option<Vector3<f64>>,
}

/// Mass and inertia as written, not yet judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertial {
    /// kg.
    pub mass: f64,
    /// The centre of mass, in the link's frame, m.
    pub centre: Vector3<f64>,
    /// Inertial frame to link frame.
    pub rotation: UnitQuaternion<f64>,
    /// About the centre of mass, along the axes of the inertial frame, kg m².
    pub tensor: Matrix3<f64>,
}

impl Inertial {
    /// About the centre of mass, along the link's axes, kg m².
    pub fn tensor_in_link(&self) -> Matrix3<f64> {
        if self.rotation == UnitQuaternion::identity() {
            return self.tensor;
        }
        turned(&self.tensor, self.rotation.to_rotation_matrix().matrix())
    }

    /// The uniform ellipsoid of the same mass and inertia, half axes `a_i² = 5/(2m) (I_j + I_k - I_i)` (m), and
    /// its attitude in the link; for one that a rigid body can have.
    pub fn ellipsoid(&self) -> (Vector3<f64>, UnitQuaternion<f64>) {
        let (axes, moments) = symmetric_eigen(&self.tensor);
        let half = moments.map(|i| {
            (2.5 / self.mass * (moments.sum() - 2.0 * i))
                .max(0.0)
                .sqrt()
        });
        let axes = Rotation3::from_matrix_unchecked(axes);
        (
            half,
            self.rotation * UnitQuaternion::from_rotation_matrix(&axes),
        )
    }

    /// Mass properties along the link's axes; the error says why no rigid body has them.
    pub fn properties(&self) -> Result<MassProperties, String> {
        let verdict = Verdict::of(self, None);
        match verdict.impossible.is_empty() {
            true => MassProperties::new(self.mass, self.tensor_in_link(), [false; 3])
                .map_err(|why| why.to_string()),
            false => Err(verdict.impossible.join("; and ")),
        }
    }
}

/// Why a file has no list of links.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinksError {
    #[error("cannot be read: {0}; name a description that is there and that you may read")]
    Unreadable(String),
    #[error("is larger than {LARGEST} bytes, which no description of a robot is")]
    TooLarge,
    #[error("is not text in UTF-8; save it so")]
    NotText,
    #[error("is not XML: {0}")]
    NotXml(String),
    #[error("describes no robot: its outermost element is <{0}>; URDF has <robot>, MJCF <mujoco>")]
    NotARobot(String),
    #[error(
        "holds xacro's `${{…}}`, which is not URDF yet; expand it first: xacro {0} > robot.urdf"
    )]
    Xacro(String),
}

/// Reads the description in a file.
pub fn read(path: &Path) -> Result<Description, LinksError> {
    use std::io::Read as _;
    let unreadable = |error: std::io::Error| LinksError::Unreadable(error.to_string());
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(unreadable)?;
    file.take(LARGEST + 1)
        .read_to_end(&mut bytes)
        .map_err(unreadable)?;
    parse(&path.to_string_lossy(), &bytes)
}

/// Reads a description from a file's bytes; its outermost element says which language it is in.
pub fn parse(name: &str, bytes: &[u8]) -> Result<Description, LinksError> {
    if bytes.len() as u64 > LARGEST {
        return Err(LinksError::TooLarge);
    }
    let text = std::str::from_utf8(bytes).map_err(|_| LinksError::NotText)?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let document = document(text).map_err(LinksError::NotXml)?;
    let root = document.root_element();
    match root.tag_name().name() {
        "robot" if has_xacro(root) => Err(LinksError::Xacro(name.to_owned())),
        "robot" => Ok(urdf::description(root)),
        "mujoco" => Ok(mjcf::description(root)),
        other => Err(LinksError::NotARobot(shortened(other))),
    }
}

/// Reads a pasted `<inertial>` element, alone or inside its link or body.
pub fn pasted(language: Language, text: &str) -> Result<Inertial, String> {
    let document = document(text).map_err(|why| format!("is not XML: {why}"))?;
    let mut found = document
        .descendants()
        .filter(|node| node.has_tag_name("inertial"));
    let (Some(inertial), None) = (found.next(), found.next()) else {
        return Err("must hold one <inertial> element, no more".to_owned());
    };
    match language {
        Language::Urdf => urdf::inertial(inertial),
        Language::Mjcf => mjcf::inertial(inertial, &mjcf::Compiler::default()),
    }
}

fn document(text: &str) -> Result<Document<'_>, String> {
    // Without a document type, so without entities that grow.
    let options = ParsingOptions {
        nodes_limit: MOST_NODES,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(text, options).map_err(|why| why.to_string())
}

fn has_xacro(root: Node<'_, '_>) -> bool {
    root.descendants()
        .flat_map(|node| node.attributes())
        .any(|attribute| attribute.value().contains("${"))
}

/// Lines of elements that are asked for in the order of the file: counted once, from one to the next.
struct Lines<'a> {
    text: &'a str,
    offset: usize,
    line: u32,
}

impl<'a> Lines<'a> {
    fn of(document: &'a Document<'_>) -> Self {
        Self {
            text: document.input_text(),
            offset: 0,
            line: 1,
        }
    }

    fn line(&mut self, node: Node<'_, '_>) -> u32 {
        let start = node.range().start;
        let between = self.text.get(self.offset..start).unwrap_or_default();
        self.line += between.bytes().filter(|&b| b == b'\n').count() as u32;
        self.offset = self.offset.max(start);
        self.line
    }
}

/// Not longer than one reads, and on one line.
fn shortened(name: &str) -> String {
    let name = name.replace(char::is_control, " ");
    match name.char_indices().nth(64) {
        Some((cut, _)) => format!("{}…", &name[..cut]),
        None => name,
    }
}

/// The box about some shapes: from corners as far as it has them.
#[derive(Clone, Copy)]
struct Extent {
    low: Vector3<f64>,
    high: Vector3<f64>,
}

impl Extent {
    /// A box of these half edges at a place of the link.
    fn of(half: Vector3<f64>, centre: Vector3<f64>, rotation: UnitQuaternion<f64>) -> Self {
        // Half the box of a turned box: |R| times the half edges.
        let reach = rotation.to_rotation_matrix().matrix().abs() * half;
        Self {
            low: centre - reach,
            high: centre + reach,
        }
    }

    fn with(self, other: Self) -> Self {
        Self {
            low: self.low.inf(&other.low),
            high: self.high.sup(&other.high),
        }
    }

    /// Of all shapes, where every one has a size.
    fn about(shapes: impl Iterator<Item = Option<Self>>) -> Option<Vector3<f64>> {
        let all: Option<Vec<Self>> = shapes.collect();
        let all = all?.into_iter().reduce(Self::with)?;
        Some(all.high - all.low)
    }
}
