//! Wavefront OBJ: its vertices and its faces; how they look is left alone.
//!
//! Read here, because what refuses a mesh must name the lines of the faces at fault, and the crate for it
//! (tobj 4.0) numbers no lines and overflows on a texture's index out of range (`f 1/-5 2/1 3/1`).

use super::read::not_that;
use super::{MOST_TRIANGLES, MeshError, Soup};
use nalgebra::Vector3;

pub(super) fn parse(bytes: &[u8]) -> Result<Soup, MeshError> {
    let mut soup = Soup {
        counted: "line",
        ..Soup::default()
    };
    // Names and comments may be in any encoding; what is read is ASCII.
    let mut continued: Option<(usize, Vec<u8>)> = None;
    for (k, line) in bytes.split(|&b| b == b'\n').enumerate() {
        let (number, mut whole) = continued.take().unwrap_or((k + 1, Vec::new()));
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        if let Some(start) = line.strip_suffix(b"\\") {
            whole.extend_from_slice(start);
            whole.push(b' ');
            continued = Some((number, whole));
        } else if whole.is_empty() {
            read(line, number, &mut soup)?;
        } else {
            whole.extend_from_slice(line);
            read(&whole, number, &mut soup)?;
        }
    }
    if let Some((number, whole)) = continued {
        read(&whole, number, &mut soup)?;
    }
    Ok(soup)
}

fn read(line: &[u8], number: usize, soup: &mut Soup) -> Result<(), MeshError> {
    let line = String::from_utf8_lossy(line);
    let mut words = line.split_whitespace();
    match words.next() {
        Some("v") => {
            let mut xyz = words.map_while(|word| word.parse::<f64>().ok());
            match (xyz.next(), xyz.next(), xyz.next()) {
                (Some(x), Some(y), Some(z)) => soup.points.push(Vector3::new(x, y, z)),
                _ => return Err(wrong(number, "is no vertex: three numbers follow a `v`")),
            }
        }
        Some("f") => face(words, number, soup)?,
        Some("surf" | "curv") => {
            return Err(wrong(
                number,
                "is a free-form surface; export the mesh as polygons",
            ));
        }
        _ => {}
    }
    Ok(())
}

/// Corners count from 1, or back from the last vertex so far; a polygon is cut into a fan.
fn face<'a>(
    words: impl Iterator<Item = &'a str>,
    number: usize,
    soup: &mut Soup,
) -> Result<(), MeshError> {
    let have = soup.points.len();
    let corner = |word: &str| {
        let index: i64 = word.split('/').next()?.parse().ok()?;
        let index = match index {
            1.. => usize::try_from(index).ok()? - 1,
            0 => return None,
            _ => have.checked_sub(usize::try_from(index.unsigned_abs()).ok()?)?,
        };
        u32::try_from(index).ok()
    };
    let corners: Option<Vec<u32>> = words
        .take_while(|word| !word.starts_with('#'))
        .map(corner)
        .collect();
    match corners.as_deref() {
        Some([a, rest @ ..]) if rest.len() >= 2 => {
            for pair in rest.windows(2) {
                soup.push([*a, pair[0], pair[1]], number);
            }
        }
        _ => {
            return Err(wrong(
                number,
                "is no face: the numbers of three vertices or more follow an `f`, from 1 or backwards from -1",
            ));
        }
    }
    match soup.triangles.len() {
        n if n > MOST_TRIANGLES => Err(MeshError::TooMany(n)),
        _ => Ok(()),
    }
}

fn wrong(number: usize, why: &str) -> MeshError {
    not_that(format!("line {number} {why}"))
}
