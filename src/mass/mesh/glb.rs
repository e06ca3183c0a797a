//! glTF 2.0 in one binary file (GLB): triangles, and where the nodes of the scene put them.
//!
//! Read here, on `serde_json`, because the crate for it (gltf 1.4) panics on files that lie about their
//! lengths or counts, and takes four times as long to build. By the specification (Khronos Group, glTF 2.0,
//! sections 3.6 and 4.4): a header, a chunk of JSON, a chunk of binary; accessors are strided views of it.

use super::read::not_that;
use super::{MOST_TRIANGLES, MeshError, Soup};
use nalgebra::{Matrix4, Quaternion, UnitQuaternion, Vector3};
use serde_json::Value;

const FLOAT: u64 = 5126;
const TRIANGLES: u64 = 4;
/// Extensions that change how a mesh looks and not where it is.
const LOOKS: [&str; 3] = ["KHR_materials_", "KHR_texture_", "KHR_lights_"];

pub(super) fn parse(bytes: &[u8]) -> Result<Soup, MeshError> {
    let (json, binary) = chunks(bytes)
        .ok_or_else(|| not_that("it is no GLB of version 2 whose chunks lie inside the file"))?;
    let json: Value = serde_json::from_slice(json)
        .map_err(|why| not_that(format!("its JSON cannot be read: {why}")))?;
    let required = items(&json["extensionsRequired"]).filter_map(Value::as_str);
    if let Some(extension) = required
        .into_iter()
        .find(|name| !LOOKS.iter().any(|looks| name.starts_with(looks)))
    {
        return Err(not_that(format!(
            "it needs {extension}, which is not read here; export it without (no compression, no quantisation)"
        )));
    }
    let mut file = File {
        json: &json,
        binary,
        soup: Soup {
            counted: "triangle",
            ..Soup::default()
        },
    };
    file.scene()?;
    Ok(file.soup)
}

/// The chunk of JSON, and the one of binary if there is one.
fn chunks(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let word = |at: usize| {
        let word = bytes.get(at..at.checked_add(4)?)?;
        Some(u32::from_le_bytes(word.try_into().ok()?))
    };
    let chunk = |at: usize, kind: &[u8; 4]| {
        let length = word(at)? as usize;
        let start = at.checked_add(8)?;
        let is_kind = bytes.get(at + 4..start)? == kind;
        let data = bytes.get(start..start.checked_add(length)?)?;
        is_kind.then_some((data, start + length))
    };
    if bytes.get(..4)? != b"glTF" || word(4)? != 2 {
        return None;
    }
    let (json, end) = chunk(12, b"JSON")?;
    let binary = chunk(end, b"BIN\0").map_or(&[][..], |(data, _)| data);
    Some((json, binary))
}

struct File<'a> {
    json: &'a Value,
    binary: &'a [u8],
    soup: Soup,
}

impl<'a> File<'a> {
    /// Every mesh where the nodes of the scene put it; without a scene every mesh once.
    fn scene(&mut self) -> Result<(), MeshError> {
        let json = self.json;
        let scene = json["scene"].as_u64().unwrap_or(0);
        let Some(scene) = item(&json["scenes"], scene) else {
            for mesh in items(&json["meshes"]) {
                self.mesh(mesh, &Matrix4::identity())?;
            }
            return Ok(());
        };
        let nodes = &json["nodes"];
        let mut seen = vec![false; nodes.as_array().map_or(0, Vec::len)];
        let roots = items(&scene["nodes"]).map(|k| (k, Matrix4::identity()));
        let mut open: Vec<(&Value, Matrix4<f64>)> = roots.collect();
        while let Some((k, parent)) = open.pop() {
            let index = k.as_u64().unwrap_or(u64::MAX);
            let node =
                item(nodes, index).ok_or_else(|| not_that(format!("it has no node {index}")))?;
            // A tree: a node has one parent, and is not its own descendant.
            let seen = &mut seen[index as usize];
            if std::mem::replace(seen, true) {
                return Err(not_that(format!("its node {index} has two parents")));
            }
            let place = parent * transform(node)?;
            if let Some(k) = node["mesh"].as_u64() {
                let mesh = item(&json["meshes"], k);
                let mesh = mesh.ok_or_else(|| not_that(format!("it has no mesh {k}")))?;
                self.mesh(mesh, &place)?;
            }
            open.extend(items(&node["children"]).map(|k| (k, place)));
        }
        Ok(())
    }

    fn mesh(&mut self, mesh: &Value, place: &Matrix4<f64>) -> Result<(), MeshError> {
        for primitive in items(&mesh["primitives"]) {
            let mode = primitive["mode"].as_u64().unwrap_or(TRIANGLES);
            if mode != TRIANGLES {
                return Err(not_that(format!(
                    "it has a primitive of mode {mode}; export triangles (mode 4)"
                )));
            }
            let first = self.soup.points.len();
            let positions = &primitive["attributes"]["POSITION"];
            let view = self.accessor(positions, "VEC3", &[FLOAT])?;
            // What a byte of the file can be pointed at by, over and over: bounded all the same.
            if view.count > 3 * MOST_TRIANGLES || first > 3 * MOST_TRIANGLES {
                return Err(MeshError::TooMany(view.count / 3));
            }
            for k in 0..view.count {
                let xyz = [0, 1, 2].map(|i| f64::from(f32::from_le_bytes(view.word(k, 4 * i))));
                let placed = place.transform_point(&xyz.into());
                self.soup.points.push(placed.coords);
            }
            let corners = match &primitive["indices"] {
                Value::Null => (0..view.count as u32).collect(),
                indices => self.indices(indices)?,
            };
            // A mirror turns faces over; so the format says that their corners then run the other way.
            let mirrored = place.fixed_view::<3, 3>(0, 0).determinant() < 0.0;
            for face in corners.chunks_exact(3) {
                let number = self.soup.triangles.len() + 1;
                if number > MOST_TRIANGLES {
                    return Err(MeshError::TooMany(number));
                }
                let corner = |k: usize| match first + face[k] as usize {
                    index if (face[k] as usize) < view.count => Ok(index as u32),
                    _ => Err(MeshError::NoVertex {
                        face: format!("triangle {number}"),
                        vertex: face[k] as usize + 1,
                    }),
                };
                let mut corners = [corner(0)?, corner(1)?, corner(2)?];
                if mirrored {
                    corners.swap(1, 2);
                }
                self.soup.push(corners, number);
            }
        }
        Ok(())
    }

    fn indices(&self, accessor: &Value) -> Result<Vec<u32>, MeshError> {
        let view = self.accessor(accessor, "SCALAR", &[5121, 5123, 5125])?;
        if view.count > 3 * MOST_TRIANGLES {
            return Err(MeshError::TooMany(view.count / 3));
        }
        let one = |k: usize| match view.width {
            1 => u32::from(view.at(k)[0]),
            2 => u32::from(u16::from_le_bytes([view.at(k)[0], view.at(k)[1]])),
            _ => u32::from_le_bytes(view.word(k, 0)),
        };
        Ok((0..view.count).map(one).collect())
    }

    /// A strided view of the binary chunk that lies inside it.
    fn accessor(&self, index: &Value, shape: &str, types: &[u64]) -> Result<View<'a>, MeshError> {
        let index = index
            .as_u64()
            .ok_or_else(|| not_that("it has a primitive without positions"))?;
        let wrong = |why: &str| not_that(format!("its accessor {index} {why}"));
        let accessor = item(&self.json["accessors"], index).ok_or_else(|| wrong("is not there"))?;
        if !accessor["sparse"].is_null() {
            return Err(wrong("is sparse; export it without sparse accessors"));
        }
        let kind = accessor["componentType"].as_u64().unwrap_or(0);
        if accessor["type"].as_str() != Some(shape) || !types.contains(&kind) {
            return Err(wrong(
                "is of a type that positions or indices do not have; export without quantisation",
            ));
        }
        let view = accessor["bufferView"].as_u64();
        let view = view.and_then(|k| item(&self.json["bufferViews"], k));
        let view = view.ok_or_else(|| wrong("has no buffer view"))?;
        let buffer = item(&self.json["buffers"], number(view, "buffer", 0));
        if buffer.is_none_or(|buffer| !buffer["uri"].is_null()) {
            return Err(wrong("is in another file; export everything into one .glb"));
        }
        let width = match kind {
            5121 => 1,
            5123 => 2,
            _ => 4,
        };
        let size = width * if shape == "VEC3" { 3 } else { 1 };
        let bytes = part(
            self.binary,
            number(view, "byteOffset", 0),
            number(view, "byteLength", 0),
        );
        let bytes = bytes.and_then(|b| b.get(as_size(number(accessor, "byteOffset", 0))?..));
        let stride = as_size(number(view, "byteStride", size as u64));
        let count = as_size(number(accessor, "count", 0));
        let view = bytes
            .zip(stride)
            .zip(count)
            .map(|((bytes, stride), count)| View {
                bytes,
                stride,
                count,
                size,
                width,
            });
        view.filter(View::fits)
            .ok_or_else(|| wrong("does not lie inside the file"))
    }
}

struct View<'a> {
    bytes: &'a [u8],
    stride: usize,
    count: usize,
    /// Of an element, and of a number of it, bytes.
    size: usize,
    width: usize,
}

impl View<'_> {
    /// Whether all elements lie inside and none on another.
    fn fits(&self) -> bool {
        let last = self.count.saturating_sub(1).checked_mul(self.stride);
        let end = last.and_then(|last| last.checked_add(self.size));
        self.stride >= self.size
            && (self.count == 0 || end.is_some_and(|end| end <= self.bytes.len()))
    }

    fn at(&self, k: usize) -> &[u8] {
        &self.bytes[k * self.stride..][..self.size]
    }

    fn word(&self, k: usize, at: usize) -> [u8; 4] {
        let element = self.at(k);
        [0, 1, 2, 3].map(|i| element[at + i])
    }
}

fn items(list: &Value) -> impl Iterator<Item = &Value> {
    list.as_array().into_iter().flatten()
}

fn item(list: &Value, index: u64) -> Option<&Value> {
    list.as_array()?.get(as_size(index)?)
}

/// A whole number; one that is none counts as too large for anything.
fn number(object: &Value, key: &str, default: u64) -> u64 {
    match &object[key] {
        Value::Null => default,
        value => value.as_u64().unwrap_or(u64::MAX),
    }
}

fn as_size(number: u64) -> Option<usize> {
    usize::try_from(number).ok()
}

fn part(bytes: &[u8], start: u64, length: u64) -> Option<&[u8]> {
    let (start, length) = (as_size(start)?, as_size(length)?);
    bytes.get(start..start.checked_add(length)?)
}

/// A node's matrix, or its translation, rotation (x, y, z, w) and scale.
fn transform(node: &Value) -> Result<Matrix4<f64>, MeshError> {
    if let Some(m) = numbers::<16>(&node["matrix"])? {
        return Ok(Matrix4::from_column_slice(&m));
    }
    let translation = numbers::<3>(&node["translation"])?.unwrap_or([0.0; 3]);
    let [x, y, z, w] = numbers::<4>(&node["rotation"])?.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let scale = numbers::<3>(&node["scale"])?.unwrap_or([1.0; 3]);
    let rotation = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 0.0)
        .ok_or_else(|| not_that("a node's rotation has no length"))?;
    Ok(Matrix4::new_translation(&Vector3::from(translation))
        * rotation.to_homogeneous()
        * Matrix4::new_nonuniform_scaling(&Vector3::from(scale)))
}

fn numbers<const N: usize>(value: &Value) -> Result<Option<[f64; N]>, MeshError> {
    if value.is_null() {
        return Ok(None);
    }
    let numbers: Option<Vec<f64>> = items(value).map(Value::as_f64).collect();
    let array = numbers.and_then(|numbers| <[f64; N]>::try_from(numbers).ok());
    let wrong = || not_that(format!("a node's transform is not {N} numbers"));
    array.map(Some).ok_or_else(wrong)
}
