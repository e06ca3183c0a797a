//! Several runs in one recording: their bodies overlaid in different tints, on one clock, and how far they part.
//!
//! The body NAME of run A is NAME-A: `/bodies/NAME-A` and `/spin` as in every recording, `/numbers/NAME-A`; and
//! `/difference/NAME-B` has a column a quantity, in its unit (of the attitude in degrees).

use super::apart::Apart;
use super::blueprint::{Blueprint, Part, View};
use super::columns::{Ends, Times, numbers, vectors};
use super::look::{self, Colour};
use super::mesh;
use super::recorder::number_descriptor;
use super::rrd::RrdFile;
use super::runs::Run;
use super::scale::nice;
use super::survey::STATIC;
use super::{Destination, RecordError};
use crate::trace::{Instant, STREAMS, Subject};
use nalgebra::Vector3;
use rerun::archetypes::{
    Arrows3D, Points3D, RecordingInfo, Scalars, SeriesLines, TextDocument, Transform3D,
    ViewCoordinates,
};
use rerun::blueprint::VisualizerComponentMapping;
use rerun::components::Radius;
use rerun::external::re_sdk_types::blueprint::archetypes as ba;
use rerun::external::re_sdk_types::blueprint::components::{self as bc, ContainerKind};
use rerun::external::re_sdk_types::{VisualizableArchetype as _, Visualizer, components};

/// What is recorded of a comparison.
pub struct Ghosts<'a> {
    pub title: &'a str,
    /// Markdown.
    pub notes: &'a str,
    /// The first is what the others are compared with.
    pub runs: &'a [Run],
    /// What is added to the times of each run, ns.
    pub shifts: &'a [i64],
    pub apart: &'a [Apart],
}

/// Rows a chunk at most.
const ROWS: usize = 1024;
/// Lines of a plot at most.
const LINES: usize = 16;

/// White, half of it.
const SEEN_THROUGH: u32 = 0xFF_FF_FF_70;

/// One tint a run; quantities have none of them.
const TINTS: [Colour; 6] = [
    0x4A_8F_C7_FF,
    0xE8_59_0C_FF,
    0x2B_8A_3E_FF,
    0xD6_33_6C_FF,
    0x91_67_E0_FF,
    0x9C_74_00_FF,
];

/// A, B, C, …
pub fn letter(run: usize) -> String {
    let letters = b'A'..=b'Z';
    match letters.clone().nth(run) {
        Some(letter) => char::from(letter).to_string(),
        None => format!("{}", run + 1),
    }
}

fn tint(run: usize) -> Colour {
    TINTS[run % TINTS.len()]
}

impl Ghosts<'_> {
    /// Writes it; returns the bytes of the file.
    pub fn write(&self, to: &Destination) -> Result<u64, RecordError> {
        let mut file = RrdFile::create(to, &format!("compare-{}", self.title))?;
        self.blueprint(&mut file)?;
        file.begin_recording()?;
        file.statics("/", &[&ViewCoordinates::RIGHT_HAND_Y_UP()])?;
        let info = RecordingInfo::new().with_name(self.title);
        file.statics("/__properties", &[&info])?;
        file.statics("/notes", &[&TextDocument::from_markdown(self.notes)])?;
        for k in 0..self.runs.len() {
            for body in self.runs[k].bodies() {
                self.body(&mut file, k, body)?;
            }
        }
        for apart in self.apart {
            self.difference(&mut file, apart)?;
        }
        Ok(file.finish()?.0)
    }

    /// How a run's body is called here: by the first run's name for it.
    fn name(&self, run: usize, body: &str) -> String {
        let mut known = self.apart.iter();
        let known = known.find(|apart| apart.run == run && apart.pair.b == body);
        let body = known.map_or(body, |apart| &apart.pair.a);
        let plain = |c: char| {
            if c.is_alphanumeric() || "-_".contains(c) {
                c
            } else {
                '_'
            }
        };
        let body: String = body.trim_matches('/').chars().map(plain).collect();
        format!("{body}-{}", letter(run))
    }

    /// What is known of a body, from whichever run knows it.
    fn subject(&self, run: usize, body: &str) -> Option<&Subject> {
        let partners = self.apart.iter().filter_map(|apart| match run {
            0 if apart.pair.a == body => self.runs[apart.run].subject(&apart.pair.b),
            run if run == apart.run && apart.pair.b == body => self.runs[0].subject(&apart.pair.a),
            _ => None,
        });
        self.runs[run]
            .subject(body)
            .or_else(|| partners.into_iter().next())
    }

    fn body(&self, file: &mut RrdFile, run: usize, body: &str) -> Result<(), RecordError> {
        let name = self.name(run, body);
        self.shape(file, run, body, &name)?;
        let series = |quantity| self.runs[run].series(body, quantity);
        let pose = [
            (
                "position",
                format!("/bodies/{name}"),
                Transform3D::descriptor_translation(),
                3,
            ),
            (
                "orientation",
                format!("/bodies/{name}/spin"),
                Transform3D::descriptor_quaternion(),
                4,
            ),
        ];
        for (quantity, entity, descriptor, width) in pose {
            let Some(series) = series(quantity) else {
                continue;
            };
            let rows: Vec<(i64, &[f64])> =
                series.rows().filter(|(_, v)| v.len() == width).collect();
            for (k, rows) in rows.chunks(ROWS).enumerate() {
                let values = rows.iter().flat_map(|(_, v)| v.iter().map(|&x| x as f32));
                let one = Ends::uniform(rows.len(), 1);
                let column = vectors(descriptor.clone(), values.collect(), width as i32, one);
                file.columns(
                    entity.as_str(),
                    &self.times(run, k * ROWS, rows.iter().map(|(t, _)| *t)),
                    vec![column],
                )?;
            }
        }
        let quantities = STREAMS.iter().flat_map(|stream| stream.quantities);
        for quantity in quantities {
            let Some(series) = series(quantity.name) else {
                continue;
            };
            let rows: Vec<(i64, &[f64])> = series.rows().collect();
            for (k, rows) in rows.chunks(ROWS).enumerate() {
                let mut ends = Ends::default();
                rows.iter().for_each(|(_, v)| ends.push(v.len()));
                let values = rows.iter().flat_map(|(_, v)| v.iter().copied()).collect();
                let column = numbers(number_descriptor(quantity.name), values, ends);
                file.columns(
                    format!("/numbers/{name}"),
                    &self.times(run, k * ROWS, rows.iter().map(|(t, _)| *t)),
                    vec![column],
                )?;
            }
        }
        Ok(())
    }

    /// On the clock of the first run; static data is as it is from the start.
    fn times(&self, run: usize, first: usize, times: impl Iterator<Item = i64>) -> Times {
        let mut all = Times::default();
        for (row, time) in times.enumerate() {
            let time = match time {
                STATIC => 0,
                time => time.saturating_add(self.shifts[run]),
            };
            all.push(Instant {
                time: time as f64 / 1e9,
                step: (first + row) as u64,
            });
        }
        all
    }

    /// The first solid, the others to be seen through; axes where no scene tells a shape.
    fn shape(
        &self,
        file: &mut RrdFile,
        run: usize,
        body: &str,
        name: &str,
    ) -> Result<(), RecordError> {
        let entity = format!("/bodies/{name}/spin/shape");
        let size = match self.subject(run, body) {
            Some(subject) => {
                let mesh = mesh::mesh(subject, tint(run));
                let mesh = match run {
                    0 => mesh,
                    _ => mesh.with_albedo_factor(rerun::datatypes::Rgba32(SEEN_THROUGH)),
                };
                file.statics(entity, &[&mesh])?;
                mesh::radius(subject)
            }
            None => {
                let length = self.size() as f32;
                let axes = [[length, 0.0, 0.0], [0.0, length, 0.0], [0.0, 0.0, length]];
                let axes = Arrows3D::from_vectors(axes)
                    .with_colors([tint(run)])
                    .with_radii([Radius::new_ui_points(look::MEDIUM)]);
                file.statics(entity, &[&axes])?;
                f64::from(length)
            }
        };
        // One label above another.
        let above = (1.1 + 0.25 * run as f64) * size;
        let label = Points3D::new([[0.0, above as f32, 0.0]])
            .with_radii([Radius::new_ui_points(0.0)])
            .with_labels([name])
            .with_colors([tint(run)])
            .with_show_labels(true);
        file.statics(format!("/bodies/{name}/label"), &[&label])
    }

    /// A typical radius, m.
    fn size(&self) -> f64 {
        let subjects = self.runs.iter().flat_map(|run| &run.subjects);
        let known = subjects.map(mesh::radius).fold(0.0, f64::max);
        if known > 0.0 {
            return known;
        }
        let (low, high) = self.bounds();
        let reach = (high - low).norm() / 8.0;
        if reach.is_finite() && reach > 0.0 {
            reach
        } else {
            1.0
        }
    }

    /// Where bodies are at the start.
    fn bounds(&self) -> (Vector3<f64>, Vector3<f64>) {
        let runs = self.runs.iter();
        let starts = runs.flat_map(|run| {
            run.bodies().into_iter().filter_map(|body| {
                let series = run.series(body, "position")?;
                let first = series.rows().map(|(_, v)| v).find(|v| v.len() == 3)?;
                Some(Vector3::new(first[0], first[1], first[2]))
            })
        });
        let all: Vec<Vector3<f64>> = starts.filter(|v| v.iter().all(|x| x.is_finite())).collect();
        let low = all.iter().copied().reduce(|a, b| a.inf(&b));
        let high = all.iter().copied().reduce(|a, b| a.sup(&b));
        (low.unwrap_or_default(), high.unwrap_or_default())
    }

    fn difference(&self, file: &mut RrdFile, apart: &Apart) -> Result<(), RecordError> {
        let entity = format!("/difference/{}", self.name(apart.run, &apart.pair.b));
        for (k, rows) in apart.attitude.chunks(ROWS).enumerate() {
            let degrees = rows.iter().map(|(_, angle)| angle.to_degrees()).collect();
            let column = numbers(
                number_descriptor(ATTITUDE),
                degrees,
                Ends::uniform(rows.len(), 1),
            );
            let times = self.times(0, k * ROWS, rows.iter().map(|(t, _)| *t));
            file.columns(entity.as_str(), &times, vec![column])?;
        }
        Ok(())
    }

    fn blueprint(&self, file: &mut RrdFile) -> Result<(), RecordError> {
        let mut blueprint = Blueprint::new(file);
        let picture = self.picture(&mut blueprint)?;
        let plots = [
            self.differences_plot(&mut blueprint)?,
            self.plot(&mut blueprint, "|ω| (rad/s)", "angular_velocity_norm")?,
            self.plot(&mut blueprint, "kinetic energy (J)", "kinetic_energy")?,
        ];
        let plots: Vec<Part> = plots.into_iter().flatten().collect();
        let notes = blueprint.view(View {
            class: "TextDocument",
            name: "what differs",
            origin: "/notes",
            contents: vec!["+ /notes".to_owned()],
            properties: Vec::new(),
            visualizers: Vec::new(),
            hidden: Vec::new(),
        })?;
        let left = blueprint.container(
            ContainerKind::Vertical,
            "picture",
            &[picture, notes],
            &[3.0, 2.0],
        )?;
        let shares = vec![1.0; plots.len()];
        let right = blueprint.container(ContainerKind::Vertical, "plots", &plots, &shares)?;
        let root = blueprint.container(
            ContainerKind::Horizontal,
            self.title,
            &[left, right],
            &[3.0, 2.0],
        )?;
        let hidden = ba::PanelBlueprint::new().with_state(bc::PanelState::Hidden);
        blueprint.log("blueprint_panel", &hidden)?;
        blueprint.log("selection_panel", &hidden)?;
        let time = ba::TimePanelBlueprint::new()
            .with_state(bc::PanelState::Collapsed)
            .with_timeline("sim_time")
            .with_loop_mode(bc::LoopMode::All)
            .with_play_state(bc::PlayState::Paused);
        blueprint.log("time_panel", &time)?;
        blueprint.finish(&root)
    }

    fn picture(&self, blueprint: &mut Blueprint<'_>) -> Result<Part, RecordError> {
        let (low, high) = self.bounds();
        let (centre, size) = ((low + high) * 0.5, self.size());
        let reach = 0.5 * (high - low).norm() + 2.2 * size;
        let from = centre + Vector3::new(0.3, 0.5, 1.0).normalize() * (1.55 * reach);
        let point =
            |v: Vector3<f64>| components::Position3D::new(v.x as f32, v.y as f32, v.z as f32);
        let eye = ba::EyeControls3D::new()
            .with_kind(bc::Eye3DKind::Orbital)
            .with_position(point(from))
            .with_look_target(point(centre))
            .with_eye_up(rerun::datatypes::Vec3D([0.0, 1.0, 0.0]));
        let grid = ba::LineGrid3D::new()
            .with_visible(true)
            .with_spacing(nice(size) as f32)
            .with_plane(components::Plane3D::new(
                [0.0, 1.0, 0.0],
                (low.y - size) as f32,
            ))
            .with_color(look::GRID)
            .with_stroke_width(1.0);
        blueprint.view(View {
            class: "3D",
            name: "overlaid",
            origin: "/",
            contents: vec!["+ /bodies/**".to_owned()],
            properties: vec![("EyeControls3D", &eye), ("LineGrid3D", &grid)],
            visualizers: Vec::new(),
            hidden: Vec::new(),
        })
    }

    /// The attitude's difference, a line a pair.
    fn differences_plot(&self, blueprint: &mut Blueprint<'_>) -> Result<Option<Part>, RecordError> {
        let with = self
            .apart
            .iter()
            .filter(|apart| !apart.attitude.is_empty())
            .take(LINES);
        let lines = with.enumerate().map(|(k, apart)| {
            let name = self.name(apart.run, &apart.pair.b);
            // Of two runs all lines are about the second: bodies are told apart, by what is no run's tint here.
            let colour = match (self.runs.len(), self.apart.len()) {
                (2, 2..) => tint(2 + k % (TINTS.len() - 2)),
                _ => tint(apart.run),
            };
            (format!("/difference/{name}"), line(&name, colour, ATTITUDE))
        });
        time_series(
            blueprint,
            "attitude difference from A (degrees)",
            lines.collect(),
        )
    }

    /// A number of every body of every run.
    fn plot(
        &self,
        blueprint: &mut Blueprint<'_>,
        title: &str,
        quantity: &'static str,
    ) -> Result<Option<Part>, RecordError> {
        let runs = self.runs.iter().enumerate();
        let all = runs.flat_map(|(k, run)| {
            let bodies = run.bodies().into_iter().enumerate();
            bodies.map(move |(place, body)| (k, run, place, body))
        });
        let with = all
            .filter(|(_, run, _, body)| run.series(body, quantity).is_some())
            .take(LINES);
        let lines = with.map(|(k, _, place, body)| {
            let name = self.name(k, body);
            let colour = look::lightened(tint(k), 0.3 * (place % 3) as f32);
            (format!("/numbers/{name}"), line(&name, colour, quantity))
        });
        time_series(blueprint, title, lines.collect())
    }
}

const ATTITUDE: &str = "attitude_difference";

fn line(name: &str, colour: Colour, quantity: &str) -> Visualizer {
    let series = SeriesLines::new()
        .with_names([name])
        .with_colors([colour])
        .with_widths([1.5_f32]);
    let scalars = Scalars::descriptor_scalars().component;
    let mapping = VisualizerComponentMapping::new_source_component(scalars, quantity);
    series.visualizer().with_mappings([mapping.into()])
}

fn time_series(
    blueprint: &mut Blueprint<'_>,
    name: &str,
    lines: Vec<(String, Visualizer)>,
) -> Result<Option<Part>, RecordError> {
    if lines.is_empty() {
        return Ok(None);
    }
    let legend = ba::PlotLegend::new().with_corner(bc::Corner2D::RightTop);
    let part = blueprint.view(View {
        class: "TimeSeries",
        name,
        origin: "/",
        contents: lines
            .iter()
            .map(|(entity, _)| format!("+ {entity}"))
            .collect(),
        properties: vec![("PlotLegend", &legend)],
        visualizers: lines
            .into_iter()
            .map(|(entity, line)| (entity, vec![line]))
            .collect(),
        hidden: Vec::new(),
    })?;
    Ok(Some(part))
}
