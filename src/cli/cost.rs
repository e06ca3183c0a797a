//! `cost SCENE`: what accuracy costs on this scene, by every method.

use super::stop::Stop;
use super::{Told, Wrong, print};
use crate::cost::{self, Advice, Cost, Ladder, Progress, Race, Rung, Spread, plot};
use crate::integrator::{self, METHODS, Method};
use crate::record::{Destination, Heading, RecordError, Recorder};
use crate::scene::{Rate, Scene, Stepping};
use crate::sim::{Choose, Simulation};
use crate::trace::{StreamSet, short};
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use std::fs::OpenOptions;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Duration;

/// Show what accuracy costs in time on a scene, by every method over a ladder of steps.
///
/// Each run is compared, at fifty instants, with the truest motion there is: the closed form where
/// nothing turns a body, else the most accurate method, checked by a second one. An error is the
/// angle between the attitudes (rad), or the distance of a free body's centre of mass as a part of its
/// radius of gyration, whichever is more.
#[derive(clap::Args)]
#[command(after_help = "Example: torquescope cost @free_top --accuracy 1e-9")]
pub struct Arguments {
    /// The scene, a TOML file, or one that the program carries, such as @free_top.
    scene: PathBuf,
    /// The accuracy (rad) that the sentence at the end is about [default: the scene's, or 1e-6].
    #[arg(long, value_name = "RAD", allow_negative_numbers = true)]
    accuracy: Option<f64>,
    /// Only these methods, by comma [default: all that take the scene's torques].
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    methods: Vec<String>,
    /// Where the plots and the recording go: this with .svg, .png and .rrd
    /// [default: the scene's name with -cost, in the current folder].
    #[arg(long, value_name = "PREFIX")]
    out: Option<PathBuf>,
    /// Print every setting that was measured.
    #[arg(long)]
    all: bool,
    /// Replace plots and a recording of that name.
    #[arg(long)]
    force: bool,
    /// Print the table alone: no plots, no recording.
    #[arg(long, conflicts_with = "out")]
    table: bool,
    /// Runs of each setting at least; the median counts.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..=1000))]
    repeats: u16,
    /// Settings that would take longer than this many seconds are left out.
    #[arg(
        long,
        value_name = "S",
        default_value_t = 1.0,
        allow_negative_numbers = true
    )]
    longest: f64,
    /// Print comma-separated values instead of a table.
    #[arg(long, conflicts_with = "json")]
    csv: bool,
    /// Print one JSON object with every digit instead of a table.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let scene = Scene::load(&arguments.scene)?;
    let accuracy = accuracy(arguments, &scene)?;
    let ladder = Ladder {
        methods: methods(&arguments.methods)?,
        repeats: usize::from(arguments.repeats),
        longest: longest(arguments.longest)?,
    };
    let places = Places::of(arguments, &scene);
    if !arguments.table {
        places.can_be_written(arguments.force)?;
    }
    let stop = Stop::listen()?;
    let bar = progress_bar(ladder.methods.len());
    let mut watch = |progress: Progress| {
        bar.set_position(progress.done as u64);
        bar.set_message(progress.method);
        match stop.asked().load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    };
    let cost = ladder.measure(&scene, &weigh, &mut watch)?;
    bar.finish_and_clear();
    let interrupted = stop.code();
    if interrupted.is_some() {
        print::err("interrupted: this is what was measured until then");
    }
    if cost.rungs.is_empty() {
        return Err(Wrong("nothing was measured: it was interrupted, or no method named takes the scene's torques".to_owned()).into());
    }
    let advice = cost.advice(accuracy);
    if arguments.json {
        print::json(&Report::new(&scene, &cost, &advice))?;
    } else if arguments.csv {
        print::out(csv(&cost).trim_end())?;
    } else {
        print::out(&table(&scene, &cost, &advice, arguments.all))?;
    }
    if !arguments.table {
        files(
            &places,
            &scene,
            &ladder.methods,
            (&cost, &advice),
            arguments.force,
        )?;
    }
    match interrupted {
        Some(code) => Err(Told(code).into()),
        None => Ok(()),
    }
}

fn accuracy(arguments: &Arguments, scene: &Scene) -> anyhow::Result<f64> {
    let stated = match scene.stepping {
        Stepping::Accuracy(accuracy) => accuracy,
        Stepping::Method { .. } => 1e-6,
    };
    let accuracy = arguments.accuracy.unwrap_or(stated);
    if accuracy > 0.0 && accuracy <= cost::LOST {
        return Ok(accuracy);
    }
    Err(Wrong(format!(
        "--accuracy {accuracy:?} is not above 0 and at most 1 (rad)"
    ))
    .into())
}

fn longest(seconds: f64) -> anyhow::Result<Duration> {
    let longest = Duration::try_from_secs_f64(seconds).ok();
    longest.filter(|time| !time.is_zero()).ok_or_else(|| {
        let message = format!("--longest {seconds:?} is no time to wait; write seconds, such as 1");
        Wrong(message).into()
    })
}

fn methods(names: &[String]) -> anyhow::Result<Vec<&'static dyn Method>> {
    if names.is_empty() {
        return Ok(METHODS.to_vec());
    }
    let find = |name: &String| {
        integrator::find(name.trim()).ok_or_else(|| {
            Wrong(format!(
                "--methods: \"{name}\" is no method; `torquescope methods` lists them"
            ))
            .into()
        })
    };
    let found: anyhow::Result<Vec<&'static dyn Method>> = names.iter().map(find).collect();
    // In the order of the list, each once.
    let found = found?;
    let named = |method: &&dyn Method| {
        let name = method.info().name;
        found.iter().any(|one| one.info().name == name)
    };
    Ok(METHODS.iter().copied().filter(named).collect())
}

fn progress_bar(methods: usize) -> ProgressBar {
    let bar = ProgressBar::new(methods as u64);
    let style = "{bar:30} {pos}/{len} methods, {msg}; {eta} left (ctrl-C: what is done)";
    if let Ok(style) = ProgressStyle::with_template(style) {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

/// The bytes of the recording of a scene at this step.
fn weigh(scene: &Scene, chooser: &mut dyn Choose) -> Option<u64> {
    /// Rows that are worth writing to learn their size.
    const MOST_ROWS: f64 = 2e5;
    let rows = scene.duration / scene.step * scene.bodies.len() as f64;
    if rows > MOST_ROWS {
        return None;
    }
    let mut scene = scene.clone();
    scene.record.state = Rate::EveryStep;
    let mut recorded = || -> Result<Option<u64>, RecordError> {
        let simulation = Simulation::new(&scene);
        let subjects = simulation.subjects().to_vec();
        let heading = Heading::of(&scene, &simulation);
        let mut recorder = Recorder::nowhere(&heading, &subjects)?;
        let (_, done) = simulation.run_by(chooser, &mut recorder);
        let bytes = recorder.finish()?.bytes;
        // Of a run that was lost there is no whole recording.
        Ok(done.is_ok().then_some(bytes))
    };
    recorded().unwrap_or_else(|error| {
        print::err(&error.to_string());
        None
    })
}

/// Accuracies for which the first table says what each method costs, rad.
const ACCURACIES: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];

fn table(scene: &Scene, cost: &Cost, advice: &Advice<'_>, all: bool) -> String {
    let mut text = format!(
        "{}\n{} s; compared at {} instants with {}\n\n\
         Wall time per simulated second, and the step or tolerance, for an error of at most\n",
        scene.title,
        short(cost.duration),
        cost.instants,
        truth(cost)
    );
    text += &by_accuracy(cost);
    text += match all {
        true => "\n\nEvery setting (* no other is both cheaper and truer)\n",
        false => {
            "\n\nNo other setting is both cheaper and truer than these (--all: every setting)\n"
        }
    };
    let mut shown: Vec<&Rung> = cost
        .rungs
        .iter()
        .filter(|r| all || r.on_front || r.own)
        .collect();
    if !all {
        shown.sort_by(|a, b| a.time.median.total_cmp(&b.time.median));
    }
    let header = [
        "",
        "method",
        "step or tolerance",
        "error (rad)",
        "energy drift",
        "momentum drift",
        "time per simulated s",
        "spread",
        "evaluations per s",
        "recording",
    ];
    text += &print::table(&header, shown.into_iter().map(row).collect());
    text += "\n";
    for (method, why) in &cost.refused {
        text += &format!("not {method}: {why}\n");
    }
    if let Some(own) = cost.own() {
        text += &format!("\nthis scene, {}", own_words(own));
    }
    text += &format!("\n{advice}");
    text
}

/// What the scene's own setting comes to.
fn own_words(own: &Rung) -> String {
    let setting = own.setting();
    match own.error.is_finite() {
        true => format!(
            "{setting}: off by {} rad, {} a simulated second",
            two(own.error),
            cost::time(own.time.median)
        ),
        false => format!("{setting}: lost before the end"),
    }
}

/// A line a method, a column an accuracy: the cheapest setting that keeps to it.
fn by_accuracy(cost: &Cost) -> String {
    let mut methods: Vec<&str> = cost.rungs.iter().map(|rung| rung.method).collect();
    methods.dedup();
    let line = |method: &&str| {
        let cell = |accuracy: f64| {
            let rung = cost.cheapest(accuracy, |rung| rung.method == *method);
            rung.map_or("–".to_owned(), |rung| match setting(rung) {
                None => cost::time(rung.time.median),
                Some(setting) => format!("{} ({setting})", cost::time(rung.time.median)),
            })
        };
        let mut cells = vec![(*method).to_owned()];
        cells.extend(ACCURACIES.map(cell));
        cells
    };
    let mut header = vec!["method".to_owned()];
    header.extend(ACCURACIES.map(|accuracy| format!("{accuracy:e} rad")));
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    print::table(&header, methods.iter().map(line).collect())
}

/// The step or the tolerance; none where there is neither.
fn setting(rung: &Rung) -> Option<String> {
    let step = rung.step.map(cost::time);
    step.or(rung.tolerance.map(|tolerance| format!("{tolerance:.0e}")))
}

/// What the runs were compared with, and how far that can be believed.
fn truth(cost: &Cost) -> String {
    let by = cost.by.join(", ");
    let off = two(cost.uncertainty);
    match cost.checked_by.is_empty() {
        true => format!("the exact motion ({by}, good to {off} rad)"),
        false => format!(
            "{by} at its tightest; {} differs from it by {off} rad",
            cost.checked_by.join(", ")
        ),
    }
}

fn row(rung: &Rung) -> Vec<String> {
    let front = match (rung.on_front, rung.own) {
        (_, true) => "own",
        (true, _) => "*",
        _ => "",
    };
    let setting = setting(rung).unwrap_or_else(|| "any time at once".to_owned());
    let lost = !rung.error.is_finite();
    let number = |x: f64| if lost { "lost".to_owned() } else { two(x) };
    let Spread {
        least,
        median,
        most,
    } = rung.time;
    vec![
        front.to_owned(),
        rung.method.to_owned(),
        setting,
        number(rung.error),
        number(rung.energy_drift),
        number(rung.momentum_drift),
        cost::time(median),
        format!("{} … {}", cost::time(least), cost::time(most)),
        match rung.evaluations {
            0.0 => "–".to_owned(),
            n => short(n.round()),
        },
        rung.bytes.map_or("–".to_owned(), size),
    ]
}

/// Two significant digits.
fn two(x: f64) -> String {
    format!("{x:.1e}")
}

fn size(bytes: u64) -> String {
    match bytes {
        0..10_000 => format!("{bytes} B"),
        10_000..10_000_000 => format!("{} kB", bytes / 1000),
        _ => format!("{} MB", bytes / 1_000_000),
    }
}

fn csv(cost: &Cost) -> String {
    let mut text = "method,step_s,tolerance,error_rad,energy_drift,momentum_drift,\
                    time_per_simulated_s,time_least,time_most,evaluations_per_simulated_s,\
                    steps_per_simulated_s,recording_bytes,on_front\n"
        .to_owned();
    let or_nothing = |x: Option<f64>| x.map_or(String::new(), |x| format!("{x:?}"));
    for rung in &cost.rungs {
        text += &format!(
            "{},{},{},{:?},{:?},{:?},{:?},{:?},{:?},{:?},{:?},{},{}\n",
            rung.method,
            or_nothing(rung.step),
            or_nothing(rung.tolerance),
            rung.error,
            rung.energy_drift,
            rung.momentum_drift,
            rung.time.median,
            rung.time.least,
            rung.time.most,
            rung.evaluations,
            rung.steps,
            rung.bytes.map_or(String::new(), |bytes| bytes.to_string()),
            rung.on_front
        );
    }
    text
}

/// Where the plots and the recording go.
struct Places {
    svg: PathBuf,
    png: PathBuf,
    recording: PathBuf,
}

impl Places {
    fn of(arguments: &Arguments, scene: &Scene) -> Self {
        let prefix = match &arguments.out {
            Some(path) => path.clone(),
            None => PathBuf::from(format!("{}-cost", scene.name)),
        };
        // A folder takes the usual name.
        let prefix = match prefix.is_dir() {
            true => prefix.join(format!("{}-cost", scene.name)),
            false => prefix,
        };
        let with = |ending: &str| {
            let mut name = prefix.clone().into_os_string();
            name.push(ending);
            PathBuf::from(name)
        };
        Self {
            svg: with(".svg"),
            png: with(".png"),
            recording: with(".rrd"),
        }
    }

    /// Before anything is measured: what cannot be written should not cost a minute first, and what
    /// is there and is no earlier result was put there for something else.
    fn can_be_written(&self, force: bool) -> anyhow::Result<()> {
        let kinds: [(&PathBuf, &[u8]); 3] = [
            (&self.svg, b"<svg"),
            (&self.png, b"\x89PNG"),
            (&self.recording, crate::record::MAGIC),
        ];
        for (path, magic) in kinds {
            let there = path.exists();
            let opened = OpenOptions::new().append(true).create(true).open(path);
            let shown = path.display();
            opened.map_err(|error| {
                Wrong(format!(
                    "{shown}: cannot be written: {error}; choose another --out, or --table for the table alone"
                ))
            })?;
            if !there {
                // It was made to see whether it can be.
                let _ = std::fs::remove_file(path);
                continue;
            }
            let content = std::fs::read(path).unwrap_or_default();
            if !content.is_empty() && !content.starts_with(magic) {
                return Err(Wrong(format!(
                    "{shown} exists and is something else; choose another --out, so that it is not lost"
                ))
                .into());
            }
            if !force && !content.is_empty() {
                return Err(Wrong(format!(
                    "{shown} exists; --force replaces it, or choose another --out"
                ))
                .into());
            }
        }
        Ok(())
    }
}

/// Writes the plots and the recording and says where they are.
fn files(
    places: &Places,
    scene: &Scene,
    methods: &[&'static dyn Method],
    (cost, advice): (&Cost, &Advice<'_>),
    force: bool,
) -> anyhow::Result<()> {
    let title = format!("What accuracy costs: {}", scene.title);
    plot::svg(cost, &title, &places.svg)?;
    plot::png(cost, &title, &places.png)?;
    let to = Destination::new(&places.recording).replacing(force);
    print::written_over(&to);
    record(scene, methods, cost, advice, &to)?;
    print::err(&format!(
        "{}, {}, {recording}\nto open it: torquescope view {recording}",
        places.svg.display(),
        places.png.display(),
        recording = places.recording.display()
    ));
    Ok(())
}

/// A frame of a game: at this step methods part within seconds.
const FRAME: f64 = 1.0 / 60.0;

/// Records the plot, and the body by every method beside the true one.
fn record(
    scene: &Scene,
    methods: &[&'static dyn Method],
    cost: &Cost,
    advice: &Advice<'_>,
    to: &Destination,
) -> anyhow::Result<()> {
    let size = Heading::of(scene, &Simulation::new(scene)).size();
    let mut race = Race::new(scene, methods, FRAME, 2.5 * size)?;
    let streams = ["omega", "momentum", "energy", "error", "drift"];
    let streams = streams.iter().filter_map(|name| StreamSet::of(name));
    race.scene.record.streams = streams.fold(StreamSet::none(), StreamSet::with);
    let simulation = Simulation::new(&race.scene);
    let subjects = simulation.subjects().to_vec();
    let mut heading = Heading::of(&race.scene, &simulation);
    heading.title = format!("What accuracy costs: {}", scene.title);
    heading.notes = notes(scene, cost, advice, &race);
    heading.price = Some(cost.clone());
    let mut recorder = Recorder::create(to, &heading, &subjects)?;
    race.run(&mut recorder)?;
    recorder.finish()?;
    Ok(())
}

fn notes(scene: &Scene, cost: &Cost, advice: &Advice<'_>, race: &Race) -> String {
    let step = cost::time(race.scene.step);
    let own = cost.own().map_or(String::new(), |own| {
        format!("\n\nThis scene, {}.", own_words(own))
    });
    let mut text = format!(
        "**{advice}**{own}\n\nEach line of the plot is a method, each point a step or a tolerance; the \
         lower and the further left the better. Errors are the largest angle from the true attitude, or distance from the true place in radii of \
         gyration, at {} instants of {} s, against {}.\n\nIn the next tab the body is there once for every \
         method, at steps of {step}, beside the true one: watch them part, and read *error* in the \
         accuracy plots.\n",
        cost.instants,
        short(scene.duration),
        truth(cost)
    );
    if !race.lost.is_empty() {
        text += &format!("\nLost before the end: {}.\n", race.lost.join(", "));
    }
    text +=
        "\n| no other is cheaper and truer | error (rad) | time per simulated s |\n|---|--:|--:|\n";
    let mut front: Vec<&Rung> = cost.rungs.iter().filter(|rung| rung.on_front).collect();
    front.sort_by(|a, b| a.time.median.total_cmp(&b.time.median));
    for rung in front {
        let (error, time) = (two(rung.error), cost::time(rung.time.median));
        text += &format!("| {} | {error} | {time} |\n", rung.setting());
    }
    text
}

/// What `--json` prints. A number that is not finite is null.
#[derive(Serialize)]
struct Report<'a> {
    scene: &'a str,
    title: &'a str,
    duration: f64,
    instants: usize,
    reference: Vec<&'static str>,
    checked_by: Vec<&'static str>,
    uncertainty: f64,
    rungs: Vec<RungReport>,
    refused: Vec<RefusalReport<'a>>,
    accuracy: f64,
    advice: String,
}

#[derive(Serialize)]
struct RungReport {
    method: &'static str,
    step: Option<f64>,
    tolerance: Option<f64>,
    error: f64,
    energy_drift: f64,
    momentum_drift: f64,
    /// s a simulated second: median, least, most.
    time: [f64; 3],
    evaluations: f64,
    steps: f64,
    recording_bytes: Option<u64>,
    on_front: bool,
    /// Of the scene's own method and step.
    own: bool,
}

#[derive(Serialize)]
struct RefusalReport<'a> {
    method: &'static str,
    why: &'a str,
}

impl<'a> Report<'a> {
    fn new(scene: &'a Scene, cost: &'a Cost, advice: &Advice<'_>) -> Self {
        let rung = |rung: &Rung| RungReport {
            method: rung.method,
            step: rung.step,
            tolerance: rung.tolerance,
            error: rung.error,
            energy_drift: rung.energy_drift,
            momentum_drift: rung.momentum_drift,
            time: [rung.time.median, rung.time.least, rung.time.most],
            evaluations: rung.evaluations,
            steps: rung.steps,
            recording_bytes: rung.bytes,
            on_front: rung.on_front,
            own: rung.own,
        };
        let refused = cost.refused.iter();
        Self {
            scene: &scene.name,
            title: &scene.title,
            duration: cost.duration,
            instants: cost.instants,
            reference: cost.by.clone(),
            checked_by: cost.checked_by.clone(),
            uncertainty: cost.uncertainty,
            rungs: cost.rungs.iter().map(rung).collect(),
            refused: refused
                .map(|(method, why)| RefusalReport { method, why })
                .collect(),
            accuracy: advice.accuracy,
            advice: advice.to_string(),
        }
    }
}
