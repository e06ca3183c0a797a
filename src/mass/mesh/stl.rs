//! STL, text or binary, through `stl_io`.

use super::read::not_that;
use super::{MOST_TRIANGLES, MeshError, Soup};
use nalgebra::Vector3;
use std::io::Cursor;

/// Of a binary file: a header, the number of facets, and their size.
const HEADER: usize = 80;
const FACET: usize = 50;

pub(super) fn parse(bytes: &[u8]) -> Result<Soup, MeshError> {
    let mut soup = Soup {
        counted: "facet",
        ..Soup::default()
    };
    if let Some(facets) = binary_facets(bytes) {
        if facets > MOST_TRIANGLES {
            return Err(MeshError::TooMany(facets));
        }
        // Many a binary file opens with the word that text files open with.
        let mut bytes = bytes.to_vec();
        bytes[..HEADER].fill(0);
        read(&bytes, &mut soup)?;
        return Ok(soup);
    }
    if !bytes.trim_ascii_start().starts_with(b"solid") {
        return Err(not_that(
            "it is no STL: text opens with `solid`, and a binary file is as long as its number of facets says",
        ));
    }
    // A file may hold several solids; the reader stops after one.
    let text = String::from_utf8_lossy(bytes);
    let mut rest = text.trim_start();
    while rest.starts_with("solid") {
        let end = end_of_solid(rest);
        // The name says nothing, and the reader wants one.
        let body = rest[..end].split_once('\n').map_or("", |(_, body)| body);
        read(format!("solid x\n{body}").as_bytes(), &mut soup)?;
        rest = rest[end..].trim_start();
    }
    match rest {
        "" => Ok(soup),
        _ => Err(not_that(
            "what follows its last `endsolid` is not another solid",
        )),
    }
}

/// Where the line with `endsolid` ends.
fn end_of_solid(text: &str) -> usize {
    let mut end = 0;
    for line in text.split_inclusive('\n') {
        end += line.len();
        if line.trim_start().starts_with("endsolid") {
            break;
        }
    }
    end
}

/// The number of facets, where the file is as long as that says.
fn binary_facets(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(HEADER..HEADER + 4)?;
    let count = u32::from_le_bytes(count.try_into().ok()?) as usize;
    let length = count.checked_mul(FACET)?.checked_add(HEADER + 4)?;
    (bytes.len() == length).then_some(count)
}

fn read(bytes: &[u8], soup: &mut Soup) -> Result<(), MeshError> {
    let mut cursor = Cursor::new(bytes);
    let fail = |facet: usize, why: std::io::Error| not_that(format!("facet {facet}: {why}"));
    let facets = stl_io::create_stl_reader(&mut cursor).map_err(|why| fail(1, why))?;
    for facet in facets {
        let number = soup.triangles.len() + 1;
        let facet = facet.map_err(|why| fail(number, why))?;
        if number > MOST_TRIANGLES {
            return Err(MeshError::TooMany(number));
        }
        let first = soup.points.len() as u32;
        for vertex in facet.vertices {
            soup.points.push(Vector3::from(vertex.0.map(f64::from)));
        }
        soup.push([first, first + 1, first + 2], number);
    }
    Ok(())
}
