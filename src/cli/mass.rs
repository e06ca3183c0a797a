//! `mass FILE`: mass and inertia of a mesh, or of every link of a robot's description.

use super::{Wrong, print};
use crate::mass::links::{self, Description, Link, LinksError, Verdict};
use crate::mass::mesh::{self, CubeRow, Cubes, Format, Polyhedron};
use crate::mass::solids::Solid;
use crate::mass::tensor::check_physical;
use crate::math::symmetric_eigen;
use crate::record;
use crate::trace::{short, short_numbers, short_vector};
use nalgebra::Matrix3;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Show mass, centre of mass and inertia of a mesh, or judge those of a robot's links.
///
/// A mesh (.obj, .stl, .glb) is integrated exactly, and sliced into ever smaller cubes that tend to it.
/// A robot's description (URDF, MuJoCo's XML) is listed link by link: its mass and tensor, whether a rigid
/// body can have them, and why not. Ends with exit code 2 where one cannot.
#[derive(clap::Args)]
#[command(
    after_help = "Examples: torquescope mass scenes/t_handle.obj --scale 0.01 --density 7850\n          torquescope mass robot.urdf --record robot.rrd"
)]
pub struct Arguments {
    /// A mesh (.obj, .stl, .glb), or a robot's description (.urdf, .xml).
    file: PathBuf,
    /// Density of the mesh, kg/m³.
    #[arg(
        long,
        value_name = "KG_PER_M3",
        default_value_t = 1000.0,
        allow_negative_numbers = true
    )]
    density: f64,
    /// Metres to a unit of the mesh's file: 0.001 for one in millimetres.
    #[arg(
        long,
        value_name = "M",
        default_value_t = 1.0,
        allow_negative_numbers = true
    )]
    scale: f64,
    /// Cubes along each edge of the box about the mesh, by comma.
    #[arg(long, value_name = "N", value_delimiter = ',', default_values_t = [8_u16, 16, 32, 64, 128],
          value_parser = clap::value_parser!(u16).range(1..=Cubes::MOST as i64))]
    cubes: Vec<u16>,
    /// Draw the robot's links as ellipsoids of the same inertia, into this recording.
    #[arg(long, value_name = "FILE.rrd")]
    record: Option<PathBuf>,
    /// Replace a recording of that name.
    #[arg(long)]
    force: bool,
    /// Print one JSON object with every digit.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let path = &arguments.file;
    let name = path.to_string_lossy();
    let ending = path.extension().map(|e| e.to_ascii_lowercase());
    if Format::of(&name).is_some() {
        return mesh(arguments);
    }
    if ending.is_some_and(|ending| ending == "urdf" || ending == "xml") {
        return robot(arguments);
    }
    Err(Wrong(format!(
        "{name}: is neither a mesh (.obj, .stl, .glb) nor a robot's description (.urdf, .xml)"
    ))
    .into())
}

fn mesh(arguments: &Arguments) -> anyhow::Result<()> {
    if !(arguments.density > 0.0 && arguments.density.is_finite()) {
        let message = format!(
            "--density {:?} is not above zero and finite (kg/m³)",
            arguments.density
        );
        return Err(Wrong(message).into());
    }
    if arguments.record.is_some() {
        let message = "--record draws a robot's links; a mesh is drawn by a scene with it";
        return Err(Wrong(message.to_owned()).into());
    }
    let body = mesh::read(&arguments.file, arguments.scale)
        .map_err(|why| Wrong(format!("{}: {why}", arguments.file.display())))?;
    check_physical(&(body.integrals().tensor * arguments.density)).map_err(|why| {
        Wrong(format!(
            "{}: is too thin or too large for 64-bit numbers to tell its inertia: {why}",
            arguments.file.display()
        ))
    })?;
    let ns: Vec<usize> = arguments.cubes.iter().map(|&n| usize::from(n)).collect();
    let report = MeshReport::new(arguments, &body, &mesh::orders(&body, &ns));
    match arguments.json {
        true => print::json(&report),
        false => print::out(&report.text()),
    }
}

/// What is printed of a mesh, SI units.
#[derive(Serialize)]
struct MeshReport {
    file: String,
    density: f64,
    scale: f64,
    triangles: usize,
    shells: usize,
    degenerate_triangles: usize,
    volume: f64,
    mass: f64,
    centre: [f64; 3],
    /// About the centre of mass, along the mesh's axes, rows.
    inertia: [[f64; 3]; 3],
    principal: Vec<Principal>,
    cubes: Vec<CubeReport>,
    /// How fast the cubes' difference falls with n, over all of them.
    order: Option<f64>,
}

#[derive(Serialize)]
struct Principal {
    moment: f64,
    axis: [f64; 3],
}

#[derive(Serialize)]
struct CubeReport {
    n: usize,
    inside: u64,
    mass: Option<f64>,
    centre: Option<[f64; 3]>,
    inertia: Option<[[f64; 3]; 3]>,
    /// `|I_n - I| / |I|`.
    difference: Option<f64>,
    order: Option<f64>,
}

impl MeshReport {
    fn new(arguments: &Arguments, body: &Polyhedron, rows: &[CubeRow]) -> Self {
        let density = arguments.density;
        let exact = body.integrals();
        let inertia = exact.tensor * density;
        Self {
            file: arguments.file.display().to_string(),
            density,
            scale: arguments.scale,
            triangles: body.triangles().len(),
            shells: body.shells(),
            degenerate_triangles: body.dropped(),
            volume: exact.volume,
            mass: exact.volume * density,
            centre: body.centre().into(),
            inertia: matrix_rows(&inertia),
            principal: principal(&inertia),
            cubes: rows
                .iter()
                .map(|row| CubeReport::new(row, density))
                .collect(),
            order: mesh::mean_order(rows),
        }
    }

    fn text(&self) -> String {
        let mut text = format!(
            "{}: {} triangles, closed shells: {}\n",
            self.file, self.triangles, self.shells
        );
        if self.degenerate_triangles > 0 {
            text += &format!(
                "left out, as two of their corners are at one place: {} triangles\n",
                self.degenerate_triangles
            );
        }
        text += &format!(
            "\nvolume          {} m³\nmass            {} kg (of {} kg/m³)\ncentre of mass  {} m\n\n",
            short(self.volume),
            short(self.mass),
            short(self.density),
            short_vector(self.centre.into())
        );
        text += "inertia about the centre of mass, along the mesh's axes, kg m²\n";
        text += &print::table(&["", "x", "y", "z"], tensor_cells(&self.inertia));
        text += "\n\nprincipal moments and axes\n";
        let axes = self
            .principal
            .iter()
            .map(|principal| vec![short(principal.moment), short_vector(principal.axis.into())]);
        text += &print::table(&["kg m²", "axis"], axes.collect());
        text += "\n\nsliced into n × n × n cubes, of which count those whose middle is inside\n";
        let rows = self.cubes.iter().map(CubeReport::cells).collect();
        text += &print::table(
            &["n", "inside", "mass, kg", "|I_n - I| / |I|", "order"],
            rows,
        );
        text += "\n(an n-th part of the box about the mesh along each axis. I: the exact tensor. order: log₂ of how \
            much smaller the difference gets as n doubles)";
        if let Some(order) = self.order {
            text += &format!(
                "\nover all rows the difference falls as n^-{order:.2}: from 1 to 2 is what to expect, as the blocks \
                 at the surface err either way; where faces lie along the blocks it jumps"
            );
        }
        text
    }
}

impl CubeReport {
    fn new(row: &CubeRow, density: f64) -> Self {
        let sum = row.cubes.integrals;
        Self {
            n: row.cubes.n,
            inside: row.cubes.inside,
            mass: sum.map(|sum| sum.volume * density),
            centre: sum.map(|sum| sum.centre.into()),
            inertia: sum.map(|sum| matrix_rows(&(sum.tensor * density))),
            difference: row.difference,
            order: row.order,
        }
    }

    fn cells(&self) -> Vec<String> {
        let number = |x: Option<f64>| x.map_or_else(|| "–".to_owned(), short);
        vec![
            self.n.to_string(),
            self.inside.to_string(),
            number(self.mass),
            self.difference
                .map_or_else(|| "–".to_owned(), |x| format!("{x:.2e}")),
            self.order
                .map_or_else(|| "–".to_owned(), |x| format!("{x:.2}")),
        ]
    }
}

fn robot(arguments: &Arguments) -> anyhow::Result<()> {
    let path = &arguments.file;
    let robot = links::read(path).map_err(|why| wrong(path, &why))?;
    if robot.links.is_empty() {
        let part = robot.language.part();
        return Err(Wrong(format!("{}: has no {part}", path.display())).into());
    }
    let judged: Vec<Judged<'_>> = robot.links.iter().map(Judged::of).collect();
    if arguments.json {
        print::json(&RobotReport {
            file: path.display().to_string(),
            language: robot.language.name(),
            notes: &robot.notes,
            links: judged.iter().map(LinkReport::of).collect(),
        })?;
    } else {
        print::out(&robot_text(path, &robot, &judged))?;
    }
    if let Some(out) = &arguments.record {
        let to = record::Destination::new(out).replacing(arguments.force);
        print::written_over(&to);
        record::links(&to, &robot)?;
        if !arguments.json {
            print::out(&format!("drawn: {}", out.display()))?;
        }
    }
    let refused = judged.iter().filter(|one| one.is_refused()).count();
    if refused > 0 {
        return Err(Wrong(format!(
            "{}: {refused} of {} have an inertia that no rigid body has, or that cannot be read",
            path.display(),
            judged.len()
        ))
        .into());
    }
    Ok(())
}

fn wrong(path: &Path, why: &LinksError) -> Wrong {
    Wrong(format!("{}: {why}", path.display()))
}

/// A link beside what there is to say of it.
struct Judged<'a> {
    link: &'a Link,
    verdict: Option<Verdict>,
}

impl<'a> Judged<'a> {
    fn of(link: &'a Link) -> Self {
        let verdict = match &link.inertial {
            Some(Ok(inertial)) => Some(Verdict::of(inertial, link.extents)),
            _ => None,
        };
        Self { link, verdict }
    }

    fn word(&self) -> &'static str {
        match (&self.link.inertial, &self.verdict) {
            (None, _) => "no inertial",
            (_, Some(verdict)) => verdict.word(),
            (_, None) => "unreadable",
        }
    }

    fn why(&self) -> String {
        match (&self.link.inertial, &self.verdict) {
            (Some(Err(why)), _) => why.clone(),
            (_, Some(verdict)) => verdict.why(),
            _ => String::new(),
        }
    }

    fn is_refused(&self) -> bool {
        matches!(self.word(), "impossible" | "unreadable")
    }
}

fn robot_text(path: &Path, robot: &Description, judged: &[Judged<'_>]) -> String {
    let mut text = format!(
        "{}: {} of {}\n\n",
        path.display(),
        robot.language.name(),
        robot.name
    );
    let rows = judged.iter().map(|one| {
        let inertial = one.link.inertial.as_ref().and_then(|i| i.as_ref().ok());
        let cells = inertial.map(|inertial| {
            let t = inertial.tensor_in_link();
            let t = short_numbers(&[t.m11, t.m22, t.m33, t.m12, t.m13, t.m23]);
            let (diagonal, off) = (t[..3].join(" "), t[3..].join(" "));
            let moments = one.verdict.as_ref().map(|v| short_numbers(&v.moments));
            [
                short(inertial.mass),
                short_vector(inertial.centre),
                format!("{diagonal}; {off}"),
                moments.unwrap_or_default().join(" "),
            ]
        });
        let [mass, centre, tensor, moments] = cells.unwrap_or_default();
        let verdict = match one.why() {
            why if why.is_empty() => one.word().to_owned(),
            why => format!("{}: {why}", one.word()),
        };
        vec![
            one.link.line.to_string(),
            one.link.name.clone(),
            mass,
            centre,
            tensor,
            moments,
            verdict,
        ]
    });
    let part = robot.language.part();
    let header = [
        "line",
        part,
        "kg",
        "centre, m",
        "xx yy zz; xy xz yz, kg m²",
        "moments",
        "verdict",
    ];
    text += &print::wrapped(&header, rows.collect());
    text += &format!("\n(tensors about the centre of mass, along the {part}'s axes)");
    for note in &robot.notes {
        text += &format!("\nnote: {note}");
    }
    text
}

#[derive(Serialize)]
struct RobotReport<'a> {
    file: String,
    language: &'static str,
    notes: &'a [String],
    links: Vec<LinkReport<'a>>,
}

#[derive(Serialize)]
struct LinkReport<'a> {
    name: &'a str,
    line: u32,
    mass: Option<f64>,
    centre: Option<[f64; 3]>,
    /// About the centre of mass, along the link's axes, rows.
    inertia: Option<[[f64; 3]; 3]>,
    /// Ascending.
    moments: Option<Vec<f64>>,
    /// Full extents of its shapes, m.
    extents: Option<[f64; 3]>,
    beside_box: Option<f64>,
    verdict: &'static str,
    why: String,
}

impl<'a> LinkReport<'a> {
    fn of(judged: &Judged<'a>) -> Self {
        let link = judged.link;
        let inertial = link.inertial.as_ref().and_then(|i| i.as_ref().ok());
        Self {
            name: &link.name,
            line: link.line,
            mass: inertial.map(|i| i.mass),
            centre: inertial.map(|i| i.centre.into()),
            inertia: inertial.map(|i| matrix_rows(&i.tensor_in_link())),
            moments: judged.verdict.as_ref().map(|v| v.moments.clone()),
            extents: link.extents.map(Into::into),
            beside_box: judged.verdict.as_ref().and_then(|v| v.beside_box),
            verdict: judged.word(),
            why: judged.why(),
        }
    }
}

fn matrix_rows(m: &Matrix3<f64>) -> [[f64; 3]; 3] {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| m[(i, j)]))
}

fn tensor_cells(rows: &[[f64; 3]; 3]) -> Vec<Vec<String>> {
    let numbers = short_numbers(rows.as_flattened());
    let cells = numbers.chunks(3).zip(["x", "y", "z"]);
    cells
        .map(|(row, axis)| {
            let axis = std::iter::once(axis.to_owned());
            axis.chain(row.iter().cloned()).collect()
        })
        .collect()
}

/// Moments, ascending, with their axes.
fn principal(inertia: &Matrix3<f64>) -> Vec<Principal> {
    let (axes, moments) = symmetric_eigen(inertia);
    let one = |k: usize| Principal {
        moment: moments[k],
        axis: [0, 1, 2].map(|i| axes[(i, k)]),
    };
    let mut principal: Vec<Principal> = (0..3).map(one).collect();
    principal.sort_by(|a, b| a.moment.total_cmp(&b.moment));
    principal
}
