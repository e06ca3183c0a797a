//! The links of a robot in a row, each as the uniform ellipsoid of its mass and inertia, in its own axes.
//!
//! What no rigid body has is no ellipsoid, and what is in other units would hide all others: a red dot in
//! the row, and the reason in the text.

use super::blueprint::{Blueprint, View};
use super::look;
use super::recorder::Summary;
use super::rrd::RrdFile;
use super::{Destination, RecordError};
use crate::mass::links::{Description, Inertial, Link, Verdict};
use nalgebra::Vector3;
use rerun::EntityPath;
use rerun::archetypes::{
    Ellipsoids3D, Points3D, RecordingInfo, TextDocument, Transform3D, ViewCoordinates,
};
use rerun::components::{FillMode, Radius};
use rerun::external::re_sdk_types::blueprint::archetypes as ba;
use rerun::external::re_sdk_types::blueprint::components::{self as bc, ContainerKind};

const LEGEND: &str = "# Equivalent ellipsoids\n\nEach link stands by itself, in its own axes, as the uniform \
    ellipsoid that has its mass and its inertia: half axes `a_i² = 5/(2m) (I_j + I_k - I_i)`. Its size and place beside the \
    grey dot, the link's origin, should be about those of the part itself. A red dot is a link whose inertia no rigid \
    body has, or hardly any of its size.";

/// Writes a recording of what a robot's description says of its links.
pub fn links(to: &Destination, robot: &Description) -> Result<Summary, RecordError> {
    let id = format!("{}-links", robot.language.name().to_lowercase());
    let mut file = RrdFile::create(to, &id)?;
    layout(&mut file)?;
    file.begin_recording()?;
    file.statics("/", &[&ViewCoordinates::RIGHT_HAND_Z_UP()])?;
    let title = format!("{}: links", robot.name);
    file.statics(
        "/__properties",
        &[&RecordingInfo::new().with_name(title.as_str())],
    )?;
    file.statics("/legend", &[&TextDocument::from_markdown(legend(robot))])?;
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
        path: to.path.clone(),
        bytes,
        rows,
        verdicts: Vec::new(),
    })
}

/// How to read the picture, and what is wrong with which link.
fn legend(robot: &Description) -> String {
    let mut text = LEGEND.to_owned();
    for link in &robot.links {
        let Some(Ok(inertial)) = &link.inertial else {
            continue;
        };
        let verdict = Verdict::of(inertial, link.extents);
        if !verdict.why().is_empty() {
            text += &format!(
                "\n\n- **{}**, {}: {}",
                link.name,
                verdict.word(),
                verdict.why()
            );
        }
    }
    text
}

/// Whether there is an ellipsoid to be drawn among the others.
fn is_drawn(verdict: &Verdict) -> bool {
    verdict.word() == "possible"
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
    let hidden = ba::PanelBlueprint::new().with_state(bc::PanelState::Hidden);
    blueprint.log("blueprint_panel", &hidden)?;
    blueprint.log("selection_panel", &hidden)?;
    let time = ba::TimePanelBlueprint::new().with_state(bc::PanelState::Hidden);
    blueprint.log("time_panel", &time)?;
    blueprint.finish(&root)
}

/// How far a link's picture goes from its origin, m.
fn reach(inertial: &Inertial, verdict: &Verdict) -> f64 {
    match is_drawn(verdict) {
        true => inertial.centre.norm() + inertial.ellipsoid().0.amax(),
        false => 0.2,
    }
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
    let label = match is_drawn(verdict) {
        true => link.name.clone(),
        false => format!("{}: {}", link.name, verdict.word()),
    };
    let centre = if is_drawn(verdict) { centre } else { [0.0; 3] };
    let name = path.join(&EntityPath::from_single_string("name"));
    let colour = match is_drawn(verdict) {
        true => look::NAME,
        false => look::FORCE,
    };
    let text = Points3D::new([centre])
        .with_radii([Radius::new_ui_points(if is_drawn(verdict) {
            0.0
        } else {
            6.0
        })])
        .with_labels([label])
        .with_colors([colour])
        .with_show_labels(true);
    file.statics(name, &[&text])?;
    if !is_drawn(verdict) {
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
