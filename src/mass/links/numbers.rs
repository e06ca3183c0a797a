//! Attributes as numbers.

use super::shortened;
use crate::math::axis_angle;
use nalgebra::{Quaternion, Unit, UnitQuaternion, Vector3};
use roxmltree::Node;

/// `N` finite numbers of an attribute; `None` where it is absent.
pub fn list<const N: usize>(node: Node<'_, '_>, name: &str) -> Result<Option<[f64; N]>, String> {
    let Some(text) = node.attribute(name) else {
        return Ok(None);
    };
    let numbers: Vec<Option<f64>> = text
        .split_whitespace()
        .take(N + 1)
        .map(|word| word.parse().ok().filter(|x: &f64| x.is_finite()))
        .collect();
    let numbers: Option<Vec<f64>> = numbers.into_iter().collect();
    let numbers = numbers.and_then(|numbers| <[f64; N]>::try_from(numbers).ok());
    numbers.map(Some).ok_or_else(|| {
        let what = if N == 1 { "a number" } else { "numbers" };
        let count = if N == 1 {
            String::new()
        } else {
            format!("{N} ")
        };
        format!(
            "{name}=\"{}\" of <{}> is not {count}{what}",
            shortened(text),
            node.tag_name().name()
        )
    })
}

/// `N` finite numbers of an attribute that must be there.
pub fn required<const N: usize>(node: Node<'_, '_>, name: &str) -> Result<[f64; N], String> {
    let lacks = || format!("<{}> lacks {name}=\"…\"", node.tag_name().name());
    list(node, name)?.ok_or_else(lacks)
}

pub fn vector(node: Node<'_, '_>, name: &str) -> Result<Option<Vector3<f64>>, String> {
    Ok(list::<3>(node, name)?.map(Vector3::from))
}

/// The rotation by an angle about an axis of any length.
pub fn about(axis: Vector3<f64>, radians: f64) -> Option<UnitQuaternion<f64>> {
    let size = axis.amax();
    let axis = (size > 0.0).then(|| Unit::new_normalize(axis / size))?;
    Some(axis_angle(axis, radians))
}

/// A quaternion brought to unit length.
pub fn unit([w, x, y, z]: [f64; 4]) -> Option<UnitQuaternion<f64>> {
    let size = [w, x, y, z].iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    let q = Quaternion::new(w / size, x / size, y / size, z / size);
    (size > 0.0).then(|| UnitQuaternion::new_normalize(q))
}
