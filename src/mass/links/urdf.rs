//! URDF, as ROS's `urdfdom` reads it: `rpy` turns about the fixed axes x, y, z in that order, so
//! `R = R_z(yaw) R_y(pitch) R_x(roll)`; angles in radians; a missing `<origin>` is the link's own frame.

use super::numbers::{about, list, required, vector};
use super::{Description, Extent, Inertial, Language, Lines, Link, shortened};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use roxmltree::Node;

pub fn description(root: Node<'_, '_>) -> Description {
    let links = root.children().filter(|node| node.has_tag_name("link"));
    let mut lines = Lines::of(root.document());
    Description {
        language: Language::Urdf,
        name: shortened(root.attribute("name").unwrap_or_default()),
        links: links.map(|node| link(node, lines.line(node))).collect(),
        notes: Vec::new(),
    }
}

fn link(node: Node<'_, '_>, line: u32) -> Link {
    Link {
        name: shortened(node.attribute("name").unwrap_or("(no name)")),
        line,
        inertial: child(node, "inertial").map(inertial),
        extents: extents(node, "collision").or_else(|| extents(node, "visual")),
    }
}

pub fn inertial(node: Node<'_, '_>) -> Result<Inertial, String> {
    let mass = child(node, "mass").ok_or("<inertial> lacks <mass value=\"…\"/>")?;
    let inertia = child(node, "inertia").ok_or(
        "<inertial> lacks <inertia ixx=\"…\" ixy=\"…\" ixz=\"…\" iyy=\"…\" iyz=\"…\" izz=\"…\"/>",
    )?;
    let one = |name| required::<1>(inertia, name).map(|[x]| x);
    let (xx, xy, xz) = (one("ixx")?, one("ixy")?, one("ixz")?);
    let (yy, yz, zz) = (one("iyy")?, one("iyz")?, one("izz")?);
    let (centre, rotation) = origin(node)?;
    let [mass] = required(mass, "value")?;
    Ok(Inertial {
        mass,
        centre,
        rotation,
        tensor: Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz),
    })
}

fn origin(node: Node<'_, '_>) -> Result<(Vector3<f64>, UnitQuaternion<f64>), String> {
    let Some(origin) = child(node, "origin") else {
        return Ok((Vector3::zeros(), UnitQuaternion::identity()));
    };
    let xyz = vector(origin, "xyz")?.unwrap_or_default();
    let rotation = match list(origin, "rpy")? {
        None | Some([0.0, 0.0, 0.0]) => UnitQuaternion::identity(),
        Some([roll, pitch, yaw]) => {
            let turn = |axis: Vector3<f64>, angle| about(axis, angle).unwrap_or_default();
            turn(Vector3::z(), yaw) * turn(Vector3::y(), pitch) * turn(Vector3::x(), roll)
        }
    };
    Ok((xyz, rotation))
}

/// Of all shapes of one kind; a mesh's size is in another file.
fn extents(link: Node<'_, '_>, kind: &str) -> Option<Vector3<f64>> {
    let shapes = link.children().filter(|node| node.has_tag_name(kind));
    Extent::about(shapes.map(|shape| {
        let (centre, rotation) = origin(shape).ok()?;
        Some(Extent::of(
            half_edges(child(shape, "geometry")?)?,
            centre,
            rotation,
        ))
    }))
}

fn half_edges(geometry: Node<'_, '_>) -> Option<Vector3<f64>> {
    let shape = geometry.children().find(Node::is_element)?;
    let one = |name| Some(list::<1>(shape, name).ok()??[0]);
    match shape.tag_name().name() {
        "box" => Some(vector(shape, "size").ok()?? * 0.5),
        "sphere" => Some(Vector3::repeat(one("radius")?)),
        "cylinder" => Some(Vector3::new(
            one("radius")?,
            one("radius")?,
            0.5 * one("length")?,
        )),
        "capsule" => {
            let radius = one("radius")?;
            Some(Vector3::new(radius, radius, 0.5 * one("length")? + radius))
        }
        _ => None,
    }
}

fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|child| child.has_tag_name(name))
}
