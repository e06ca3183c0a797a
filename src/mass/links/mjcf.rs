//! MJCF, by MuJoCo's XML reference (3.x): `quat` is w x y z; `axisangle` and `euler` are in degrees unless
//! `<compiler angle="radian">`; `eulerseq` is "xyz" unless given, a small letter a turn about the axes as
//! turned so far, a capital one about the fixed axes; `fullinertia` is M(1,1) M(2,2) M(3,3) M(1,2) M(1,3)
//! M(2,3), and takes no orientation beside it.

use super::numbers::{about, list, required, unit, vector};
use super::{Description, Extent, Inertial, Language, Lines, Link, shortened};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use roxmltree::Node;

/// What `<compiler>` says of angles.
pub struct Compiler {
    degrees: bool,
    sequence: String,
}

impl Default for Compiler {
    fn default() -> Self {
        Self {
            degrees: true,
            sequence: "xyz".to_owned(),
        }
    }
}

pub fn description(root: Node<'_, '_>) -> Description {
    let mut compiler = Compiler::default();
    let mut notes = Vec::new();
    for node in root.children().filter(|n| n.has_tag_name("compiler")) {
        if let Some(angle) = node.attribute("angle") {
            compiler.degrees = angle != "radian";
        }
        if let Some(sequence) = node.attribute("eulerseq") {
            compiler.sequence = sequence.to_owned();
        }
        if node.attribute("inertiafromgeom") == Some("true") {
            notes.push("inertiafromgeom=\"true\": MuJoCo takes no <inertial> of this file, but computes all from the geoms".to_owned());
        }
        if node.attribute("balanceinertia") == Some("true") {
            notes.push("balanceinertia=\"true\": MuJoCo replaces moments that break the triangle inequality by their mean, and says nothing".to_owned());
        }
        for bound in ["boundmass", "boundinertia", "settotalmass"] {
            if let Ok(Some([value])) = list::<1>(node, bound)
                && value > 0.0
            {
                notes.push(format!("{bound}=\"{value}\": MuJoCo changes masses or moments by it; here they are as written"));
            }
        }
    }
    if root.descendants().any(|n| n.has_tag_name("include")) {
        notes.push("<include>: bodies of other files are not in this list; compile the model into one file (simulate, or mj_saveLastXML)".to_owned());
    }
    let inside = |section: &'static str| {
        let sections = root.children().filter(move |n| n.has_tag_name(section));
        sections.flat_map(|section| section.descendants())
    };
    let defaults = inside("default").any(|n| n.has_tag_name("geom"));
    let bodies = inside("worldbody").filter(|n| n.has_tag_name("body"));
    let mut lines = Lines::of(root.document());
    let links = bodies.enumerate().map(|(k, node)| Link {
        name: node
            .attribute("name")
            .map_or_else(|| format!("body {}", k + 1), shortened),
        line: lines.line(node),
        inertial: node
            .children()
            .find(|child| child.has_tag_name("inertial"))
            .map(|node| inertial(node, &compiler)),
        extents: extents(node, &compiler, defaults),
    });
    Description {
        language: Language::Mjcf,
        name: shortened(root.attribute("model").unwrap_or_default()),
        links: links.collect(),
        notes,
    }
}

pub fn inertial(node: Node<'_, '_>, compiler: &Compiler) -> Result<Inertial, String> {
    let [mass] = required(node, "mass")?;
    let centre = Vector3::from(required(node, "pos")?);
    let rotation = orientation(node, compiler)?;
    let tensor = match (list(node, "diaginertia")?, list(node, "fullinertia")?) {
        (Some([x, y, z]), None) => Matrix3::from_diagonal(&Vector3::new(x, y, z)),
        (None, Some(_)) if rotation.is_some() => {
            return Err("<inertial> has an orientation beside fullinertia, which has none; keep one of the two".to_owned());
        }
        (None, Some([xx, yy, zz, xy, xz, yz])) => Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz),
        (None, None) => {
            return Err("<inertial> lacks diaginertia=\"…\" or fullinertia=\"…\"".to_owned());
        }
        (Some(_), Some(_)) => {
            return Err(
                "<inertial> has both diaginertia and fullinertia; keep one of the two".to_owned(),
            );
        }
    };
    Ok(Inertial {
        mass,
        centre,
        rotation: rotation.unwrap_or_default(),
        tensor,
    })
}

/// The orientation that an element has by whichever of the five attributes; `None` where it has none.
fn orientation(
    node: Node<'_, '_>,
    compiler: &Compiler,
) -> Result<Option<UnitQuaternion<f64>>, String> {
    const WAYS: [&str; 5] = ["quat", "axisangle", "euler", "xyaxes", "zaxis"];
    let mut given = WAYS.into_iter().filter(|way| node.has_attribute(*way));
    let Some(way) = given.next() else {
        return Ok(None);
    };
    if let Some(other) = given.next() {
        return Err(format!(
            "<{}> has both {way} and {other}; keep one orientation",
            node.tag_name().name()
        ));
    }
    let angle = |x: f64| if compiler.degrees { x.to_radians() } else { x };
    let rotation = match way {
        "quat" => unit(required(node, way)?),
        "axisangle" => {
            let [x, y, z, turn] = required(node, way)?;
            about(Vector3::new(x, y, z), angle(turn))
        }
        "euler" => Some(euler(required(node, way)?.map(angle), &compiler.sequence)?),
        "xyaxes" => {
            let [a, b, c, d, e, f] = required(node, way)?;
            axes(Vector3::new(a, b, c), Vector3::new(d, e, f))
        }
        _ => {
            // The least turn that takes z there; half a turn about x where it points the other way.
            let z = Vector3::from(required(node, way)?);
            z.try_normalize(0.0).map(|z| {
                let axis = Vector3::z().cross(&z);
                let turn = libm::atan2(axis.norm(), z.z);
                about(axis, turn).unwrap_or_else(|| {
                    let flip = if z.z < 0.0 { std::f64::consts::PI } else { 0.0 };
                    about(Vector3::x(), flip).unwrap_or_default()
                })
            })
        }
    };
    let none = || format!("{way} of <{}> has no direction", node.tag_name().name());
    rotation.map(Some).ok_or_else(none)
}

fn euler(angles: [f64; 3], sequence: &str) -> Result<UnitQuaternion<f64>, String> {
    let wrong = || {
        format!(
            "eulerseq=\"{}\" is not three letters of xyzXYZ",
            shortened(sequence)
        )
    };
    if sequence.chars().count() != 3 {
        return Err(wrong());
    }
    let mut q = UnitQuaternion::identity();
    for (letter, angle) in sequence.chars().zip(angles) {
        let axis = match letter.to_ascii_lowercase() {
            'x' => Vector3::x(),
            'y' => Vector3::y(),
            'z' => Vector3::z(),
            _ => return Err(wrong()),
        };
        let turn = about(axis, angle).unwrap_or_default();
        q = if letter.is_ascii_lowercase() {
            q * turn
        } else {
            turn * q
        };
    }
    Ok(q)
}

/// y is made square to x.
fn axes(x: Vector3<f64>, y: Vector3<f64>) -> Option<UnitQuaternion<f64>> {
    let x = x.try_normalize(0.0)?;
    let y = (y - x * x.dot(&y)).try_normalize(0.0)?;
    let r = Matrix3::from_columns(&[x, y, x.cross(&y)]);
    Some(UnitQuaternion::from_rotation_matrix(
        &Rotation3::from_matrix_unchecked(r),
    ))
}

/// Of a body's own geoms, where all have type and size written at them.
fn extents(body: Node<'_, '_>, compiler: &Compiler, defaults: bool) -> Option<Vector3<f64>> {
    let geoms = body.children().filter(|node| node.has_tag_name("geom"));
    Extent::about(geoms.map(|geom| extent(geom, compiler, defaults)))
}

fn extent(geom: Node<'_, '_>, compiler: &Compiler, defaults: bool) -> Option<Extent> {
    let kind = match geom.attribute("type") {
        Some(kind) => kind,
        // A class may say another.
        None if defaults => return None,
        None => "sphere",
    };
    let sizes: Vec<f64> = geom
        .attribute("size")?
        .split_whitespace()
        .map(|word| word.parse().ok().filter(|x: &f64| x.is_finite()))
        .collect::<Option<_>>()?;
    if let Some([a, b, c, d, e, f]) = list(geom, "fromto").ok()? {
        let radius = Vector3::repeat(*sizes.first()?);
        let ends = [Vector3::new(a, b, c), Vector3::new(d, e, f)];
        return Some(Extent {
            low: ends[0].inf(&ends[1]) - radius,
            high: ends[0].sup(&ends[1]) + radius,
        });
    }
    let half = match (kind, &sizes[..]) {
        ("sphere", [r, ..]) => Vector3::repeat(*r),
        ("capsule", [r, h, ..]) => Vector3::new(*r, *r, h + r),
        ("cylinder", [r, h, ..]) => Vector3::new(*r, *r, *h),
        ("box" | "ellipsoid", [x, y, z, ..]) => Vector3::new(*x, *y, *z),
        _ => return None,
    };
    let centre = vector(geom, "pos").ok()?.unwrap_or_default();
    let rotation = orientation(geom, compiler).ok()?.unwrap_or_default();
    Some(Extent::of(half, centre, rotation))
}
