//! A mesh from a file's bytes, by the ending of its name.

use super::{Flaw, MOST_TRIANGLES, Polyhedron, Soup, glb, obj, stl};
use nalgebra::Vector3;
use std::io::Read as _;
use std::path::Path;

/// Bytes of a file at most: a binary STL of [`MOST_TRIANGLES`] has 100 MB.
pub const LARGEST: u64 = 1 << 27;

/// A format of meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// STL, as text or binary.
    Stl,
    /// glTF 2.0 in one binary file.
    Glb,
}

impl Format {
    /// By the ending of a file's name.
    pub fn of(name: &str) -> Option<Self> {
        let (_, ending) = name.rsplit_once('.')?;
        match ending.to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            "glb" => Some(Self::Glb),
            _ => None,
        }
    }
}

/// Why there is no body; the file's name is for the caller to say.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    #[error("cannot be read: {0}; name a mesh that is there and that you may read")]
    Unreadable(String),
    #[error("is larger than {LARGEST} bytes; make the mesh coarser")]
    TooLarge,
    #[error("is no mesh that can be read by its ending; use .obj, .stl or .glb")]
    Unknown,
    #[error("{0}")]
    NotThat(String),
    #[error("it has {0} triangles, more than {MOST_TRIANGLES}; make the mesh coarser")]
    TooMany(usize),
    #[error("{face} names the vertex {vertex}, and there is none of that number")]
    NoVertex { face: String, vertex: usize },
    #[error(
        "its vertex {vertex} is at ({x}, {y}, {z}), which is not finite or beyond 1e50 m",
        x = .at.x, y = .at.y, z = .at.z
    )]
    OutOfRange { vertex: usize, at: Vector3<f64> },
    #[error("scale = {0} is not above zero and finite")]
    Scale(f64),
    #[error(transparent)]
    Flaw(#[from] Flaw),
}

/// Reads a mesh file; its lengths times `scale` are metres.
pub fn read(path: &Path, scale: f64) -> Result<Polyhedron, MeshError> {
    let unreadable = |error: std::io::Error| MeshError::Unreadable(error.to_string());
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(unreadable)?;
    file.take(LARGEST + 1)
        .read_to_end(&mut bytes)
        .map_err(unreadable)?;
    parse(&path.to_string_lossy(), &bytes, scale)
}

/// Reads a mesh from a file's bytes; the ending of its name says which format they are in.
pub fn parse(name: &str, bytes: &[u8], scale: f64) -> Result<Polyhedron, MeshError> {
    if bytes.len() as u64 > LARGEST {
        return Err(MeshError::TooLarge);
    }
    if !(scale.is_finite() && scale > 0.0) {
        return Err(MeshError::Scale(scale));
    }
    let soup: Soup = match Format::of(name).ok_or(MeshError::Unknown)? {
        Format::Obj => obj::parse(bytes)?,
        Format::Stl => stl::parse(bytes)?,
        Format::Glb => glb::parse(bytes)?,
    };
    Polyhedron::new(&soup, scale)
}

pub(super) fn not_that(why: impl Into<String>) -> MeshError {
    MeshError::NotThat(why.into())
}
