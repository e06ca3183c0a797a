//! How a recording opens: the project's own arrangement, not Rerun's default grid.
//!
//! The first tab holds everything at once: the picture, what to look for, plots of magnitudes by
//! body, the numbers, the events. A tab per body isolates it, with its components and its page.

use super::RecordError;
use super::blueprint::{Blueprint, Part, View};
use super::heading::Heading;
use super::look;
use super::mesh;
use super::picture::DRAWN;
use super::price;
use super::provenance;
use super::rrd::RrdFile;
use super::scale;
use super::sources;
use crate::sim::GYROSCOPIC;
use crate::trace::{Subject, short};
use nalgebra::Vector3;
use rerun::AsComponents;
use rerun::archetypes::{Scalars, SeriesLines};
use rerun::blueprint::VisualizerComponentMapping;
use rerun::external::re_sdk_types::blueprint::archetypes as ba;
use rerun::external::re_sdk_types::blueprint::components::{self as bc, ContainerKind};
use rerun::external::re_sdk_types::{VisualizableArchetype as _, Visualizer, components};

/// What the arrangement depends on.
pub struct Setting<'a> {
    pub heading: &'a Heading,
    /// Those that are in no swarm.
    pub subjects: &'a [Subject],
    /// The others.
    pub swarms: &'a [Subject],
}

impl<'a> Setting<'a> {
    pub fn new(heading: &'a Heading, subjects: &'a [Subject]) -> Self {
        let alone = subjects.partition_point(|subject| subject.swarm.is_none());
        let (subjects, swarms) = subjects.split_at(alone);
        Self {
            heading,
            subjects,
            swarms,
        }
    }
}

/// Bodies that get a tab and a page of their own, and lines in the plots of all bodies: as many
/// as can be read.
pub const MOST_TABS: usize = 12;

/// Samples of a line that a viewer draws one by one without effort.
const MOST_UNTHINNED: f64 = 20_000.0;

/// How long the shortest event is to be seen, in seconds of watching: playback slows for it.
const SEEN_FOR: f64 = 0.5;

/// A plot of one stream.
struct Plot {
    stream: &'static str,
    /// The tab it stands in.
    about: About,
    title: &'static str,
    symbol: &'static str,
    /// Three components, where it is a vector.
    components: Option<&'static str>,
    single: &'static str,
}

/// What a plot is about.
#[derive(Clone, Copy, PartialEq, Eq)]
enum About {
    Motion,
    Sources,
    Accuracy,
}

const TABS: [(About, &str); 3] = [
    (About::Motion, "motion"),
    (About::Sources, "torque by source"),
    (About::Accuracy, "accuracy"),
];

const PLOTS: [Plot; 9] = [
    Plot {
        stream: "torque",
        about: About::Motion,
        title: "torque τ (N·m)",
        symbol: "τ",
        components: Some("torque"),
        single: "torque_norm",
    },
    Plot {
        stream: "alpha",
        about: About::Motion,
        title: "angular acceleration α (rad/s²)",
        symbol: "α",
        components: Some("angular_acceleration"),
        single: "angular_acceleration_norm",
    },
    Plot {
        stream: "omega",
        about: About::Motion,
        title: "angular velocity ω (rad/s)",
        symbol: "ω",
        components: Some("angular_velocity"),
        single: "angular_velocity_norm",
    },
    Plot {
        stream: "state",
        about: About::Motion,
        title: "velocity v (m/s)",
        symbol: "v",
        components: Some("velocity"),
        single: "velocity_norm",
    },
    Plot {
        stream: "energy",
        about: About::Motion,
        title: "kinetic energy E (J)",
        symbol: "E",
        components: None,
        single: "kinetic_energy",
    },
    Plot {
        stream: "error",
        about: About::Accuracy,
        title: "angle from the exact attitude (rad)",
        symbol: "δ",
        components: None,
        single: "attitude_error",
    },
    Plot {
        stream: "drift",
        about: About::Accuracy,
        title: "energy drift (part of E)",
        symbol: "ΔE/E",
        components: None,
        single: "energy_drift",
    },
    Plot {
        stream: "drift",
        about: About::Accuracy,
        title: "angular momentum drift (part of |L|)",
        symbol: "|ΔL|/|L|",
        components: None,
        single: "angular_momentum_drift",
    },
    Plot {
        stream: "step_time",
        about: About::Accuracy,
        title: "wall time of a step (s)",
        symbol: "t",
        components: None,
        single: "step_time",
    },
];

/// The text panel: what the scene shows.
pub fn notes(setting: &Setting<'_>) -> String {
    let heading = setting.heading;
    let variant = heading.variant.as_ref();
    let variant = variant.map_or(String::new(), |variant| format!("**{variant}**\n\n"));
    format!("# {}\n\n{variant}{}\n", heading.title, heading.notes)
}

/// How to read the picture.
pub fn legend(setting: &Setting<'_>) -> String {
    let heading = setting.heading;
    let mut text = String::new();
    for drawn in &DRAWN {
        let seen = drawn.stream != "force" || heading.has_pushes;
        if heading.streams.contains(drawn.stream) && seen {
            let hidden = match drawn.hidden {
                true => "; hidden at first: open the blueprint panel (top right) and click its eye",
                false => "",
            };
            let factor = heading.scales.sentence(drawn);
            text += &format!("- {} ({factor}){hidden}\n", drawn.meaning);
        }
    }
    if heading.streams.contains("force") && heading.has_impulses {
        text += &format!(
            "- **red arrow with J**: an impulse, shown where it struck for {} s after (1 N·s = {} m)\n",
            short(heading.impulse_shown_for()),
            short(heading.scales.impulse)
        );
    }
    if !sources::all_names(setting.subjects).is_empty() {
        text += "- **with a source's name, in its colour**: the torque of that source alone, at the scale of the torque; all of them add up to I α (plots: *torque by source*); the gyroscopic term's is hidden at first\n";
    }
    if heading.streams.contains("inertia") {
        text += "- **green ellipsoid**: uniform, with the body's mass and its inertia about the centre of mass (true size)\n";
    }
    if setting
        .subjects
        .iter()
        .any(|subject| subject.pivot_b.is_some())
    {
        text += "- **grey dot**: a pivot; torque, inertia and angular momentum are then about it\n";
    }
    text + "\nEach body has a tab above. Numbers, plots and arrows are sampled less often than poses are: a page says of which instant it is.\n"
}

/// Writes the blueprint.
pub fn write(file: &mut RrdFile, setting: &Setting<'_>) -> Result<(), RecordError> {
    let mut blueprint = Blueprint::new(file);
    let mut tabs = Vec::new();
    if setting.heading.price.is_some() {
        tabs.push(price_tab(&mut blueprint)?);
    }
    tabs.push(overview(&mut blueprint, setting)?);
    for (k, subject) in setting.subjects.iter().enumerate().take(MOST_TABS) {
        tabs.push(body_tab(&mut blueprint, setting, k, subject)?);
    }
    let root = blueprint.container(ContainerKind::Tabs, &setting.heading.title, &tabs, &[])?;
    panels(&mut blueprint, setting.heading)?;
    blueprint.finish(&root)
}

/// The work-precision plot beside what it says.
fn price_tab(blueprint: &mut Blueprint<'_>) -> Result<Part, RecordError> {
    let name = "what accuracy costs";
    let plot = blueprint.view(View {
        class: "2D",
        name: "wall time per simulated second (up) against error (right)",
        origin: price::PATH,
        contents: vec![format!("+ {}/**", price::PATH)],
        properties: Vec::new(),
        visualizers: Vec::new(),
        hidden: Vec::new(),
    })?;
    let text = document(blueprint, "what it says", "/notes")?;
    blueprint.container(ContainerKind::Horizontal, name, &[plot, text], &[3.0, 1.0])
}

fn panels(blueprint: &mut Blueprint<'_>, heading: &Heading) -> Result<(), RecordError> {
    let by_event = |s: f64| scale::nice(s / SEEN_FOR).clamp(1e-3, 1.0);
    let by_events = heading.shortest_event.map_or(1.0, by_event);
    let speed = heading.speed.unwrap_or(by_events);
    let hidden = ba::PanelBlueprint::new().with_state(bc::PanelState::Hidden);
    // Recordings are listed, and chosen, in the panel of the blueprint.
    let listed = match heading.one_of_several {
        true => ba::PanelBlueprint::new().with_state(bc::PanelState::Expanded),
        false => hidden.clone(),
    };
    blueprint.log("blueprint_panel", &listed)?;
    blueprint.log("selection_panel", &hidden)?;
    let time = ba::TimePanelBlueprint::new()
        .with_state(bc::PanelState::Collapsed)
        .with_timeline("sim_time")
        .with_playback_speed(speed)
        .with_loop_mode(bc::LoopMode::All)
        .with_play_state(bc::PlayState::Paused);
    blueprint.log("time_panel", &time)
}

fn overview(blueprint: &mut Blueprint<'_>, setting: &Setting<'_>) -> Result<Part, RecordError> {
    let all: Vec<&Subject> = setting.subjects.iter().collect();
    let contents = pictured().map(|q| format!("+ /{q}/**")).collect();
    let seen: Vec<&Subject> = setting.subjects.iter().chain(setting.swarms).collect();
    let picture = spatial(blueprint, setting, "all bodies", contents, &seen)?;
    let events = text_log(blueprint)?;
    let pushes = state_timeline(blueprint)?;
    let log = blueprint.container(ContainerKind::Tabs, "events", &[events, pushes], &[])?;
    let left = blueprint.container(
        ContainerKind::Vertical,
        "picture",
        &[picture, log],
        &[5.0, 1.0],
    )?;
    let mut notes = vec![
        document(blueprint, "what to look at", "/notes")?,
        document(blueprint, "reading the picture", "/legend")?,
    ];
    if setting.heading.provenance.is_some() {
        notes.push(document(blueprint, "the scene", provenance::TEXT)?);
    }
    let notes = blueprint.container(ContainerKind::Tabs, "text", &notes, &[])?;
    let mut texts = vec![notes];
    if setting.heading.streams.contains("numbers") {
        for subject in all.iter().take(MOST_TABS) {
            texts.push(document(
                blueprint,
                &subject.label,
                &format!("/pages/{}", subject.name),
            )?);
        }
    }
    let mut columns = vec![left];
    let mut shares = vec![5.6];
    let mut pages = vec![texts.remove(0)];
    if !texts.is_empty() {
        pages.push(blueprint.container(ContainerKind::Tabs, "numbers", &texts, &[])?);
    }
    columns.push(blueprint.container(
        ContainerKind::Vertical,
        "text",
        &pages,
        &[1.0, 1.0][..pages.len()],
    )?);
    shares.push(2.4);
    let plots = match setting.subjects.is_empty() {
        true => Vec::new(),
        false => magnitude_plots(blueprint, setting)?,
    };
    if let Some(plots) = tabbed(blueprint, &plots)? {
        columns.push(plots);
        shares.push(2.4);
    }
    blueprint.container(ContainerKind::Horizontal, "all bodies", &columns, &shares)
}

fn body_tab(
    blueprint: &mut Blueprint<'_>,
    setting: &Setting<'_>,
    index: usize,
    subject: &Subject,
) -> Result<Part, RecordError> {
    let name = &subject.name;
    let contents: Vec<String> = pictured().map(|q| format!("+ /{q}/{name}/**")).collect();
    let picture = spatial(blueprint, setting, &subject.label, contents, &[subject])?;
    let mut columns = vec![picture];
    let mut shares = vec![3.0];
    if setting.heading.streams.contains("numbers") {
        columns.push(document(
            blueprint,
            "numbers at the cursor",
            &format!("/pages/{name}"),
        )?);
        shares.push(2.0);
    }
    let mut plots = Vec::new();
    for plot in shown(setting) {
        let drawn = component_plot(blueprint, setting.heading, plot, index, subject)?;
        plots.push((plot.about, drawn));
    }
    plots.extend(source_plots(blueprint, setting, subject)?);
    if let Some(plots) = tabbed(blueprint, &plots)? {
        columns.push(plots);
        shares.push(2.4);
    }
    blueprint.container(ContainerKind::Horizontal, &subject.label, &columns, &shares)
}

/// What the picture holds besides the arrows.
const SPATIAL: [&str; 6] = ["bodies", "swarms", "labels", "pivots", "inertia", "sources"];

/// Everything the picture holds, by quantity.
fn pictured() -> impl Iterator<Item = &'static str> {
    SPATIAL
        .into_iter()
        .chain(DRAWN.iter().map(|drawn| drawn.stream))
}

fn spatial(
    blueprint: &mut Blueprint<'_>,
    setting: &Setting<'_>,
    name: &str,
    contents: Vec<String>,
    seen: &[&Subject],
) -> Result<Part, RecordError> {
    let (centre, reach) = bounds(seen, setting.heading.scales.size);
    // From the front, from the right and above, so that arrows along any axis have a length.
    let from = centre + Vector3::new(0.3, 0.5, 1.0).normalize() * (1.55 * reach);
    let point = |v: Vector3<f64>| components::Position3D::new(v.x as f32, v.y as f32, v.z as f32);
    let eye = ba::EyeControls3D::new()
        .with_kind(bc::Eye3DKind::Orbital)
        .with_position(point(from))
        .with_look_target(point(centre))
        .with_eye_up(rerun::datatypes::Vec3D([0.0, 1.0, 0.0]));
    let floor = floor(seen);
    let grid = ba::LineGrid3D::new()
        .with_visible(true)
        .with_spacing(scale::nice(setting.heading.scales.size) as f32)
        .with_plane(components::Plane3D::new([0.0, 1.0, 0.0], floor as f32))
        .with_color(look::GRID)
        .with_stroke_width(1.0);
    let properties: Vec<(&'static str, &dyn AsComponents)> =
        vec![("EyeControls3D", &eye), ("LineGrid3D", &grid)];
    let hidden = DRAWN.iter().filter(|drawn| drawn.hidden);
    blueprint.view(View {
        class: "3D",
        name,
        origin: "/",
        contents,
        properties,
        visualizers: Vec::new(),
        hidden: hidden
            .map(|drawn| drawn.stream.to_owned())
            .chain([format!("sources/{GYROSCOPIC}")])
            .map(|stream| format!("/{stream}"))
            .collect(),
    })
}

/// The middle of the bodies and the distance from there to the farthest part.
fn bounds(seen: &[&Subject], size: f64) -> (Vector3<f64>, f64) {
    let starts = seen.iter().map(|s| s.start.position_w);
    let low = starts
        .clone()
        .fold(Vector3::repeat(f64::INFINITY), |a, b| a.inf(&b));
    let high = starts.fold(Vector3::repeat(f64::NEG_INFINITY), |a, b| a.sup(&b));
    let centre = (low + high) * 0.5;
    let reach = 0.5 * (high - low).norm() + 3.2 * size;
    match centre.iter().all(|x| x.is_finite()) && reach.is_finite() {
        true => (centre, reach),
        false => (Vector3::zeros(), 5.0 * size),
    }
}

/// The height of the ground grid: under the lowest body as it starts.
fn floor(seen: &[&Subject]) -> f64 {
    // Bodies of a swarm are alike: one of them says how far each may reach down.
    let lowest = |alike: &[&Subject]| match alike {
        [alone] => mesh::lowest(alone),
        many => {
            let reach = many.first().map_or(0.0, |first| mesh::radius(first));
            let heights = many.iter().map(|s| s.start.position_w.y - reach);
            heights.fold(f64::INFINITY, f64::min)
        }
    };
    let low = seen
        .chunk_by(|a, b| a.is_like(b))
        .map(lowest)
        .fold(f64::INFINITY, f64::min);
    if low.is_finite() { low } else { 0.0 }
}

fn shown<'s>(setting: &'s Setting<'_>) -> impl Iterator<Item = &'static Plot> + 's {
    PLOTS
        .iter()
        .filter(|plot| setting.heading.streams.contains(plot.stream))
}

/// Plots one below the other, in a tab for each thing that they are about.
fn tabbed(
    blueprint: &mut Blueprint<'_>,
    plots: &[(About, Part)],
) -> Result<Option<Part>, RecordError> {
    let mut tabs = Vec::new();
    for (about, name) in TABS {
        let of_tab = plots.iter().filter(|(of, _)| *of == about);
        let column: Vec<Part> = of_tab.map(|(_, plot)| plot.clone()).collect();
        if !column.is_empty() {
            let rows = vec![1.0; column.len()];
            tabs.push(blueprint.container(ContainerKind::Vertical, name, &column, &rows)?);
        }
    }
    match tabs.len() {
        0 => Ok(None),
        1 => Ok(tabs.pop()),
        _ => Ok(Some(blueprint.container(
            ContainerKind::Tabs,
            "plots",
            &tabs,
            &[],
        )?)),
    }
}

/// One plot a quantity, one line a body.
fn magnitude_plots(
    blueprint: &mut Blueprint<'_>,
    setting: &Setting<'_>,
) -> Result<Vec<(About, Part)>, RecordError> {
    let mut plots = Vec::new();
    for plot in shown(setting) {
        let lines = setting.subjects.iter().enumerate().take(MOST_TABS);
        let visualizers = lines.map(|(k, subject)| {
            let colour = look::BODIES[k % look::BODIES.len()];
            let series = SeriesLines::new()
                .with_names([subject.name.as_str()])
                .with_colors([colour])
                .with_widths([1.5_f32]);
            (
                numbers(subject),
                vec![line(setting.heading, series, plot.single)],
            )
        });
        let title = match plot.components {
            Some(_) => format!("|{}|, {}", plot.symbol, plot.title),
            None => plot.title.to_owned(),
        };
        let drawn = time_series(blueprint, &title, visualizers.collect())?;
        plots.push((plot.about, drawn));
    }
    plots.extend(source_magnitudes(blueprint, setting)?);
    Ok(plots)
}

/// How the torques of a body's sources add up, axis by axis.
fn source_plots(
    blueprint: &mut Blueprint<'_>,
    setting: &Setting<'_>,
    subject: &Subject,
) -> Result<Vec<(About, Part)>, RecordError> {
    if subject.sources.is_empty() {
        return Ok(Vec::new());
    }
    let all = sources::all_names(setting.subjects);
    let axes = sources::PARTS.into_iter().take(3);
    axes.map(|axis| {
        let series = |name: &str, colour, width| {
            let series = SeriesLines::new()
                .with_names([name])
                .with_colors([colour])
                .with_widths([width]);
            let path = sources::numbers_path(subject, name);
            (path, vec![line(setting.heading, series, axis)])
        };
        // The sum first, so that the parts are drawn over it.
        let mut lines = vec![series(
            sources::SUM,
            look::lightened(look::NAME, 0.25),
            3.5_f32,
        )];
        for name in &subject.sources {
            lines.push(series(name, sources::colour(name, &all), 1.5));
        }
        let title = format!("τ.{axis} by source; sum = I α (N·m)");
        Ok((About::Sources, time_series(blueprint, &title, lines)?))
    })
    .collect()
}

/// The torque of every source of every body, by its length, while that can be read.
fn source_magnitudes(
    blueprint: &mut Blueprint<'_>,
    setting: &Setting<'_>,
) -> Result<Vec<(About, Part)>, RecordError> {
    if let [subject] = setting.subjects {
        return source_plots(blueprint, setting, subject);
    }
    let all = sources::all_names(setting.subjects);
    let plot = |&source: &&str| {
        let with = setting.subjects.iter().take(MOST_TABS).enumerate();
        let with = with.filter(|(_, subject)| subject.sources.iter().any(|name| name == source));
        let lines = with.map(|(k, subject)| {
            let series = SeriesLines::new()
                .with_names([subject.name.as_str()])
                .with_colors([look::BODIES[k % look::BODIES.len()]])
                .with_widths([1.5_f32]);
            let path = sources::numbers_path(subject, source);
            (path, vec![line(setting.heading, series, "length")])
        });
        let title = format!("|τ| by {source} (N·m)");
        Ok((
            About::Sources,
            time_series(blueprint, &title, lines.collect())?,
        ))
    };
    all.iter().map(plot).collect()
}

/// The components of one body's vector.
fn component_plot(
    blueprint: &mut Blueprint<'_>,
    heading: &Heading,
    plot: &Plot,
    index: usize,
    subject: &Subject,
) -> Result<Part, RecordError> {
    let visualizer = match plot.components {
        Some(quantity) => {
            let names = ["x", "y", "z"].map(|axis| format!("{}.{axis}", plot.symbol));
            let series = SeriesLines::new()
                .with_names(names)
                .with_colors(look::COMPONENTS)
                .with_widths([1.5_f32; 3]);
            line(heading, series, quantity)
        }
        None => {
            let series = SeriesLines::new()
                .with_names([plot.symbol])
                .with_colors([look::BODIES[index % look::BODIES.len()]])
                .with_widths([1.5_f32]);
            line(heading, series, plot.single)
        }
    };
    time_series(
        blueprint,
        plot.title,
        vec![(numbers(subject), vec![visualizer])],
    )
}

fn numbers(subject: &Subject) -> String {
    format!("/numbers/{}", subject.name)
}

/// A line drawn from one of the number columns.
fn line(heading: &Heading, mut series: SeriesLines, quantity: &str) -> Visualizer {
    // Rerun thins what falls on one pixel to its least and greatest value, in that order, and so
    // draws a step down as a spike. A recording short enough is drawn as it is.
    if heading.duration * heading.rate <= MOST_UNTHINNED {
        series = series.with_aggregation_policy(components::AggregationPolicy::Off);
    }
    let scalars = Scalars::descriptor_scalars().component;
    let mapping = VisualizerComponentMapping::new_source_component(scalars, quantity);
    series.visualizer().with_mappings([mapping.into()])
}

fn time_series(
    blueprint: &mut Blueprint<'_>,
    name: &str,
    visualizers: Vec<(String, Vec<Visualizer>)>,
) -> Result<Part, RecordError> {
    let legend = ba::PlotLegend::new().with_corner(bc::Corner2D::RightTop);
    let contents = visualizers
        .iter()
        .map(|(entity, _)| format!("+ {entity}"))
        .collect();
    blueprint.view(View {
        class: "TimeSeries",
        name,
        origin: "/numbers",
        contents,
        properties: vec![("PlotLegend", &legend)],
        visualizers,
        hidden: Vec::new(),
    })
}

fn document(blueprint: &mut Blueprint<'_>, name: &str, path: &str) -> Result<Part, RecordError> {
    plain(
        blueprint,
        "TextDocument",
        name,
        path,
        vec![format!("+ {path}")],
    )
}

fn text_log(blueprint: &mut Blueprint<'_>) -> Result<Part, RecordError> {
    plain(
        blueprint,
        "TextLog",
        "events",
        "/events",
        vec!["+ /events".to_owned()],
    )
}

fn state_timeline(blueprint: &mut Blueprint<'_>) -> Result<Part, RecordError> {
    plain(
        blueprint,
        "StateTimeline",
        "when pushes act",
        "/events",
        vec!["+ /events/**".to_owned()],
    )
}

fn plain(
    blueprint: &mut Blueprint<'_>,
    class: &'static str,
    name: &str,
    origin: &str,
    contents: Vec<String>,
) -> Result<Part, RecordError> {
    blueprint.view(View {
        class,
        name,
        origin,
        contents,
        properties: Vec::new(),
        visualizers: Vec::new(),
        hidden: Vec::new(),
    })
}
