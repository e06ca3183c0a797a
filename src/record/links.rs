//! The links of a robot in a row, each as the uniform ellipsoid of its mass and inertia, in its own axes.
//!
//! What no rigid body has no ellipsoid is of: it stands there as a point with the reason.

use super::RecordError;
use super::blueprint::{Blueprint, View};
use super::look;
use super::recorder::Summary;
use super::rrd::RrdFile;
use crate::mass::links::{Description, Inertial, Link, Verdict};
use nalgebra::Vector3;
use rerun::EntityPath;
use rerun::archetypes::{
    Ellipsoids3D, Points3D, RecordingInfo, TextDocument, Transform3D, ViewCoordinates,
};
use rerun::components::{FillMode, Radius};
use rerun::external::re_sdk_types::blueprint::components::ContainerKind;
use std::path::Path;

const LEGEND: &str = "# Equivalent ellipsoids\n\nEach link stands by itself, in its own axes, as the uniform \
    ellipsoid that has its mass and its inertia: half axes `a_i² = 5/(2m) (I_j + I_k - I_i)`. Its size and place beside the \
    grey dot, the link's origin, should be about those of the part itself. A red dot is a link whose inertia no rigid \
    body has.";

/// Writes a recording of what a robot's description says of its links.
pub fn links(path: &Path, robot: &Description) -> Result<Summary, RecordError> {
    let id = format!("{}-links", robot.language.name().to_lowercase());
    let mut file = RrdFile::create(path, &id)?;
    layout(&mut file)?;
    file.begin_recording()?;
    file.statics("/", &[&ViewCoordinates::RIGHT_HAND_Z_UP()])?;
    let title = format!("{}: links", robot.name);
    file.statics(
        "/__properties",
        &[&RecordingInfo::new().with_name(title.as_str())],
    )?;
    file.statics("/legend", &[&TextDocument::from_markdown(LEGEND)])?;
    let mut at = 0.0;
    for (k, link) in robot.links.iter().enumerate() {
        let Some(Ok(inertial)) = &link.inertial else {
            continue;
        };
        let verdict = Verdict::of(inertial, link.extents);
        let reach = reach(inertial, &verdict);
        // Room to the left of it, then to the right.
        at += reach;
        draw(&mut file, k, link, inertial, &verdict, at)?;
        at += 1.2 * reach;
    }
    let (bytes, rows) = file.finish()?;
    Ok(Summary {
        path: path.to_owned(),
        bytes,
        rows,
        verdicts: Vec::new(),
    })
}

fn layout(file: &mut RrdFile) -> Result<(), RecordError> {
    let mut blueprint = Blueprint::new(file);
    let mut view = |class, name, origin, contents: &str| {
        blueprint.view(View {
            class,
            name,
            origin,
            contents: vec![contents.to_owned()],
            properties: Vec::new(),
            visualizers: Vec::new(),
            hidden: Vec::new(),
        })
    };
    let picture = view("3D", "links", "/", "+ /links/**")?;
    let legend = view(
        "TextDocument",
        "reading the picture",
        "/legend",
        "+ /legend",
    )?;
    let shares = [3.0, 1.0];
    let root = blueprint.container(
        ContainerKind::Horizontal,
        "links",
        &[picture, legend],
        &shares,
    )?;
    blueprint.finish(&root)
}

/// How far a link's picture goes from its origin, m.
fn reach(inertial: &Inertial, verdict: &Verdict) -> f64 {
    let half = match verdict.impossible.is_empty() {
        true => inertial.ellipsoid().0.amax(),
        false => 0.05,
    };
    inertial.centre.norm() + half
}

fn draw(
    file: &mut RrdFile,
    index: usize,
    link: &Link,
    inertial: &Inertial,
    verdict: &Verdict,
    at: f64,
) -> Result<(), RecordError> {
    // Two links may have one name, and a name may hold anything.
    let own = EntityPath::from_single_string(format!("{} {}", index + 1, link.name));
    let path = EntityPath::from("/links").join(&own);
    let place = Transform3D::from_translation([at as f32, 0.0, 0.0]);
    let dot = Points3D::new([[0.0_f32; 3]])
        .with_radii([Radius::new_ui_points(4.0)])
        .with_colors([look::PIVOT]);
    file.statics(path.clone(), &[&place, &dot])?;
    let centre: [f32; 3] = single(inertial.centre);
    let label = match verdict.why() {
        why if why.is_empty() => link.name.clone(),
        why => format!("{}: {why}", link.name),
    };
    let name = path.join(&EntityPath::from_single_string("name"));
    let colour = match verdict.word() {
        "possible" => look::NAME,
        _ => look::FORCE,
    };
    let text = Points3D::new([centre])
        .with_radii([Radius::new_ui_points(if verdict.impossible.is_empty() {
            0.0
        } else {
            6.0
        })])
        .with_labels([label])
        .with_colors([colour])
        .with_show_labels(true);
    file.statics(name, &[&text])?;
    if !verdict.impossible.is_empty() {
        return Ok(());
    }
    let (half, q) = inertial.ellipsoid();
    let [x, y, z, w] = q.coords.map(|x| x as f32).into();
    let ellipsoid = Ellipsoids3D::from_centers_and_half_sizes([centre], [single(half)])
        .with_quaternions([rerun::Quaternion::from_xyzw([x, y, z, w])])
        .with_colors([look::with_alpha(look::INERTIA, 0x80)])
        .with_fill_mode(FillMode::Solid);
    let path = path.join(&EntityPath::from_single_string("inertia"));
    file.statics(path, &[&ellipsoid])
}

fn single(v: Vector3<f64>) -> [f32; 3] {
    v.map(|x| x as f32).into()
}
