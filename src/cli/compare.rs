//! `compare A B …`: runs overlaid in one recording, and how far they part.

use super::{Wrong, print};
use crate::cost::{Plan, PlanError};
use crate::record::{self, Apart, Collector, Ghosts, Measure, Run, Tolerances, letter};
use crate::scene::{Scene, SceneError, Script, Stepping};
use crate::sim::Simulation;
use crate::trace::{StreamSet, short};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Compare runs: recordings, scenes, or one scene by several methods.
///
/// Every run is compared with the first, body by body. Writes one recording with all bodies overlaid on one clock, and
/// prints the largest differences and when each quantity first differs by more than the tolerance. With --tolerance the exit
/// code is 1 where anything does.
#[derive(clap::Args)]
#[command(
    after_help = "Examples: torquescope compare before.rrd after.rrd --tolerance 1e-6\n          torquescope compare @wing_nut --method closed-form,jolt,rapier\n          torquescope compare mine.rrd @cone --shift 0.5 --tolerance orientation=0.1deg"
)]
pub struct Arguments {
    /// Recordings (.rrd) and scenes (.toml, or @NAME); the first is what the others are compared with.
    #[arg(required = true, value_name = "RUN")]
    runs: Vec<PathBuf>,
    /// Run each scene by each of these methods, by comma (`torquescope methods`).
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    method: Vec<String>,
    /// Add this to the times of the second run (s); again for the third and so on.
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    shift: Vec<f64>,
    /// What is too much: of attitudes an angle in rad, of all else a part of the quantity's scale (1e-6); or of one
    /// quantity in its unit (angular_velocity=0.01, orientation=0.1deg); again for more. Anything above it is exit code 1.
    #[arg(long, value_name = "[QUANTITY=]NUMBER", allow_hyphen_values = true)]
    tolerance: Vec<String>,
    /// Where the recording of all runs goes.
    #[arg(long, value_name = "FILE", default_value = "compare.rrd")]
    out: PathBuf,
    /// Replace a recording of that name.
    #[arg(long)]
    force: bool,
    /// Print one JSON object with every digit.
    #[arg(long)]
    json: bool,
}

/// What counts as differing where nothing is said.
const USUAL: f64 = 1e-3;

pub fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let tolerances = tolerances(arguments)?;
    for input in &arguments.runs {
        super::run::must_not_be_input(&arguments.out, input)?;
    }
    let to = record::Destination::new(&arguments.out).replacing(arguments.force);
    to.check()?;
    print::written_over(&to);
    let mut failed = Vec::new();
    let runs = runs(arguments, &mut failed)?;
    if runs.len() < 2 {
        return Err(Wrong(
            "there is one run only; name another recording or scene, or several with --method a,b"
                .to_owned(),
        )
        .into());
    }
    let shifts = shifts(arguments, runs.len())?;
    let mut apart = Vec::new();
    for (k, other) in runs.iter().enumerate().skip(1) {
        let pairs = record::pairs(&runs[0], other);
        let found = pairs
            .into_iter()
            .filter_map(|pair| record::apart((&runs[0], other), k, pair, shifts[k], &tolerances));
        let before = apart.len();
        apart.extend(found);
        if apart.len() == before {
            return Err(Wrong(format!(
                "{} and {}: have no body with an instant in common; --shift SECONDS lines clocks up",
                runs[0].label, other.label
            ))
            .into());
        }
    }
    let comparison = Comparison {
        runs: &runs,
        apart: &apart,
        shifts: &shifts,
        judged: !arguments.tolerance.is_empty(),
    };
    let title = title(&runs);
    let notes = comparison.notes();
    let ghosts = Ghosts {
        title: &title,
        notes: &notes,
        runs: &runs,
        shifts: &shifts,
        apart: &apart,
    };
    let bytes = ghosts.write(&to)?;
    if arguments.json {
        print::json(&comparison.report(&arguments.out))?;
    } else {
        let path = print::argument(&arguments.out);
        print::out(&format!(
            "{}\n{path}: {bytes} bytes\nto open it: torquescope view {path}",
            comparison.text()
        ))?;
    }
    comparison.verdict(&failed)
}

fn title(runs: &[Run]) -> String {
    let names: Vec<String> = runs
        .iter()
        .enumerate()
        .map(|(k, run)| format!("{} {}", letter(k), run.label))
        .collect();
    names.join(" · ")
}

fn tolerances(arguments: &Arguments) -> anyhow::Result<Tolerances> {
    let mut tolerances = Tolerances {
        part: USUAL,
        own: Vec::new(),
    };
    for text in &arguments.tolerance {
        let wrong = |why: &str| Wrong(format!("--tolerance {text}: {why}"));
        let (name, number) = match text.split_once('=') {
            None => (None, text.trim()),
            Some((name, number)) => (Some(name.trim().replace(' ', "_")), number.trim()),
        };
        let (number, degrees) = match number.strip_suffix("deg") {
            Some(number) => (number.trim(), true),
            None => (number, false),
        };
        let value = number.parse::<f64>().ok();
        let value = value.filter(|x| x.is_finite() && *x >= 0.0);
        let value = value.ok_or_else(|| {
            wrong("write a number of 0 or more, such as 1e-6 or orientation=0.1deg")
        })?;
        match name {
            None if degrees => {
                return Err(wrong("an angle is of one quantity; write orientation=…deg").into());
            }
            None => tolerances.part = value,
            Some(name) => {
                let name = match name.as_str() {
                    "attitude" => "orientation".to_owned(),
                    _ => name,
                };
                let streams = StreamSet::default_set().quantities();
                let known: Vec<&str> = streams.iter().map(|q| q.name).collect();
                if !known.contains(&name.as_str()) {
                    let nearest = crate::trace::nearest(&name, &known);
                    return Err(wrong(&format!("no quantity is called `{name}`; {nearest}")).into());
                }
                if degrees && name != "orientation" {
                    return Err(wrong("degrees are for the orientation").into());
                }
                let value = if degrees { value.to_radians() } else { value };
                tolerances.own.push((name, value));
            }
        }
    }
    Ok(tolerances)
}

/// By run, ns; the first keeps its clock.
fn shifts(arguments: &Arguments, runs: usize) -> anyhow::Result<Vec<i64>> {
    let mut shifts = vec![0; runs];
    if arguments.shift.len() >= runs {
        return Err(Wrong(format!(
            "--shift is given {} times; with {runs} runs there are {} to be shifted",
            arguments.shift.len(),
            runs - 1
        ))
        .into());
    }
    for (own, &shift) in shifts[1..].iter_mut().zip(&arguments.shift) {
        if !shift.is_finite() || shift.abs() >= 1e9 {
            return Err(Wrong(format!(
                "--shift {shift} is no time; write seconds below 1e9"
            ))
            .into());
        }
        *own = (shift * 1e9).round() as i64;
    }
    Ok(shifts)
}

/// Everything that is named, read or run. What was lost on the way goes to `failed`.
fn runs(arguments: &Arguments, failed: &mut Vec<String>) -> anyhow::Result<Vec<Run>> {
    let mut runs = Vec::new();
    for path in &arguments.runs {
        let is_called_one = path.extension().is_some_and(|ending| ending == "rrd");
        if is_called_one || record::is_recording(path) {
            runs.extend(Run::read(path)?);
            continue;
        }
        let methods = arguments.method.iter().map(|name| Some(name.as_str()));
        let methods: Vec<Option<&str>> = match arguments.method.is_empty() {
            true => vec![None],
            false => methods.collect(),
        };
        for method in methods {
            let mut script = Script::load(path)?;
            if let Some(name) = method {
                script.set_method(name, &format!("--method {name}"));
            }
            let file = path.display().to_string();
            let scenes = script.scenes().map_err(SceneError::Wrong)?;
            for scene in &scenes {
                let label = match (method, &scene.variant) {
                    (Some(method), _) if scenes.len() == 1 => format!("{file}, {method}"),
                    (_, Some(variant)) => format!("{file}, {variant}"),
                    (_, None) => file.clone(),
                };
                runs.push(simulated(scene, label, failed)?);
            }
        }
    }
    Ok(runs)
}

fn simulated(scene: &Scene, label: String, failed: &mut Vec<String>) -> anyhow::Result<Run> {
    let plan = match scene.stepping {
        Stepping::Accuracy(_) => {
            let spinner =
                print::spinner("planning: measuring methods on each interval (ctrl-C stops)");
            let plan = Plan::of(scene);
            spinner.finish_and_clear();
            Some(plan.map_err(|error| match error {
                PlanError::Sim(error) => anyhow::anyhow!("{label}: no plan: {error}"),
                error => error.into(),
            })?)
        }
        Stepping::Method { .. } => None,
    };
    let simulation = Simulation::new(scene);
    let state = StreamSet::of("state");
    let streams = state.map_or(scene.record.streams, |state| {
        scene.record.streams.with(state)
    });
    let mut collector = Collector::new(simulation.subjects(), streams);
    let (_, done) = match plan {
        Some(plan) => simulation.run_by(&mut plan.chooser(), &mut collector),
        None => simulation.run(&mut collector),
    };
    if let Err(error) = done {
        failed.push(format!("{label}: {error}"));
    }
    Ok(Run::collected(label, collector))
}

/// What there is to tell.
struct Comparison<'a> {
    runs: &'a [Run],
    apart: &'a [Apart],
    shifts: &'a [i64],
    judged: bool,
}

fn seconds(nanoseconds: i64) -> f64 {
    nanoseconds as f64 / 1e9
}

impl Comparison<'_> {
    fn all(&self) -> impl Iterator<Item = (&Apart, &Measure)> {
        let measures = |apart| {
            let apart: &Apart = apart;
            apart.quantities.iter().map(move |m| (apart, m))
        };
        self.apart.iter().flat_map(measures)
    }

    fn above(&self) -> impl Iterator<Item = (&Apart, &Measure)> {
        self.all().filter(|(_, measure)| measure.first.is_some())
    }

    /// How it was compared, aloud.
    fn remarks(&self) -> Vec<String> {
        let mut lines = Vec::new();
        for (k, run) in self.runs.iter().enumerate() {
            let shift = match self.shifts[k] {
                0 => String::new(),
                shift => format!(", {} s later", seconds(shift)),
            };
            lines.push(format!("{}: {}{shift}", letter(k), run.label));
            if let Some(why) = &run.cut {
                lines.push(format!(
                    "   is cut or broken ({why}): compared as far as it goes"
                ));
            }
        }
        for apart in self.apart {
            let (a, b) = (&apart.pair.a, &apart.pair.b);
            let other = letter(apart.run);
            let how = match (apart.pair.by_name, a == b) {
                (true, true) => format!("{a}, A and {other}"),
                (true, false) => format!("{a} of A and {b} of {other}"),
                (false, _) => {
                    format!("{a} of A and {b} of {other}, paired by their order, not by name")
                }
            };
            let rows = match apart.interpolated {
                0 => format!("{} rows, all of one instant", apart.rows),
                n => format!(
                    "{} rows of A; for {n} of them {other} has none at that instant and is interpolated (attitudes by slerp, all else linearly)",
                    apart.rows
                ),
            };
            lines.push(format!(
                "{how}: {} … {} s, {rows}",
                seconds(apart.from),
                seconds(apart.until)
            ));
            if !apart.alone.is_empty() {
                lines.push(format!(
                    "   not compared, as only one has it: {}",
                    apart.alone.join(", ")
                ));
            }
        }
        lines.extend(self.unpaired());
        lines
    }

    /// Bodies that have no partner.
    fn unpaired(&self) -> Vec<String> {
        let mut lines = Vec::new();
        for k in 1..self.runs.len() {
            let of = |run: usize, is_a: bool| {
                let taken = |body: &&str| {
                    let own = self.apart.iter().filter(|apart| apart.run == k);
                    let mut own = own.map(|apart| if is_a { &apart.pair.a } else { &apart.pair.b });
                    own.any(|name| name == body)
                };
                let bodies = self.runs[run].bodies().into_iter();
                bodies
                    .filter(|body| !taken(body))
                    .map(str::to_owned)
                    .collect::<Vec<_>>()
            };
            for (run, is_a) in [(0, true), (k, false)] {
                let alone = of(run, is_a);
                if !alone.is_empty() {
                    let other = letter(if is_a { k } else { 0 });
                    lines.push(format!(
                        "of {} without a partner in {other} at any instant: {}",
                        letter(run),
                        alone.join(", ")
                    ));
                }
            }
        }
        lines
    }

    fn text(&self) -> String {
        let header = [
            "body",
            "run",
            "quantity",
            "largest difference",
            "of its scale",
            "at (s)",
            "first above tolerance (s)",
        ];
        let rows: Vec<_> = self.differing().map(|(apart, m)| row(apart, m)).collect();
        let mut text = self.remarks().join("\n");
        if !rows.is_empty() {
            text += &format!("\n{}", print::table(&header, rows));
        }
        let same = self.same();
        if !same.is_empty() {
            text += &format!("\n{}", same.join("\n"));
        }
        text
    }

    fn differing(&self) -> impl Iterator<Item = (&Apart, &Measure)> {
        self.all().filter(|(_, measure)| measure.largest > 0.0)
    }

    /// What is the same, pair by pair.
    fn same(&self) -> Vec<String> {
        let of = |apart: &Apart| {
            let (same, rest): (Vec<&Measure>, Vec<&Measure>) = apart
                .quantities
                .iter()
                .partition(|measure| measure.largest == 0.0);
            let who = format!("{} of A and {}", apart.pair.a, letter(apart.run));
            match (same.is_empty(), rest.is_empty()) {
                (true, _) => None,
                (_, true) => Some(format!("no difference at all: {who}")),
                (false, false) => {
                    let names: Vec<&str> = same.iter().map(|m| m.name.as_str()).collect();
                    Some(format!("no difference in {}: {who}", names.join(", ")))
                }
            }
        };
        self.apart.iter().filter_map(of).collect()
    }

    /// For the recording.
    fn notes(&self) -> String {
        let mut text = format!(
            "{}\n\n",
            self.remarks()
                .iter()
                .map(|line| format!("- {}", line.trim()))
                .collect::<Vec<_>>()
                .join("\n")
        );
        text += "| body | run | quantity | largest difference | of its scale | at (s) | first above tolerance (s) |\n|---|---|---|--:|--:|--:|--:|\n";
        for (apart, measure) in self.differing() {
            text += &format!("| {} |\n", row(apart, measure).join(" | "));
        }
        text + &self
            .same()
            .iter()
            .map(|line| format!("\n- {line}"))
            .collect::<String>()
    }

    fn verdict(&self, failed: &[String]) -> anyhow::Result<()> {
        let mut lines: Vec<String> = failed.to_vec();
        let above: Vec<_> = self.above().collect();
        if self.judged
            && let Some((apart, first)) = above.iter().min_by_key(|(_, m)| m.first)
        {
            lines.push(format!(
                "above the tolerance: {} differences, the first at t = {} s: {} of {} ({} and A)",
                above.len(),
                seconds(first.first.unwrap_or_default()),
                first.name,
                apart.pair.a,
                letter(apart.run)
            ));
        }
        if self.judged && !self.unpaired().is_empty() {
            lines.push("above the tolerance: there are bodies without a partner".to_owned());
        }
        if !lines.is_empty() {
            return Err(anyhow::anyhow!("{}", lines.join("\n")));
        }
        match self.runs.iter().find(|run| run.cut.is_some()) {
            Some(run) => Err(Wrong(format!(
                "{}: is cut or broken: what there is of it was compared, the rest is not known",
                run.label
            ))
            .into()),
            None => Ok(()),
        }
    }
}

fn row(apart: &Apart, measure: &Measure) -> Vec<String> {
    let (largest, part) = match measure.name.as_str() {
        "orientation" => (
            format!("{}°", short(measure.largest.to_degrees())),
            format!("{} rad", short(measure.largest)),
        ),
        _ => {
            let unit = if measure.unit == "1" {
                ""
            } else {
                measure.unit
            };
            let largest = format!("{} {unit}", short(measure.largest));
            (largest.trim_end().to_owned(), short(measure.part))
        }
    };
    vec![
        apart.pair.a.clone(),
        letter(apart.run),
        measure.name.clone(),
        largest,
        part,
        seconds(measure.at).to_string(),
        measure
            .first
            .map_or("–".to_owned(), |time| seconds(time).to_string()),
    ]
}

/// What `--json` prints. A number that is not finite is null.
#[derive(Serialize)]
struct Report<'a> {
    recording: String,
    /// Whether nothing is above the tolerance.
    within: bool,
    runs: Vec<RunReport<'a>>,
    pairs: Vec<PairReport<'a>>,
    remarks: Vec<String>,
}

#[derive(Serialize)]
struct RunReport<'a> {
    letter: String,
    label: &'a str,
    /// s.
    shift: f64,
    cut: Option<&'a str>,
}

#[derive(Serialize)]
struct PairReport<'a> {
    run: String,
    body: &'a str,
    other: &'a str,
    by_name: bool,
    from: f64,
    until: f64,
    rows: u64,
    interpolated: u64,
    not_compared: &'a [String],
    quantities: Vec<MeasureReport<'a>>,
}

#[derive(Serialize)]
struct MeasureReport<'a> {
    quantity: &'a str,
    /// Of `largest`, `scale` and `tolerance`.
    unit: &'static str,
    largest: f64,
    at: f64,
    part: f64,
    scale: f64,
    tolerance: f64,
    first: Option<f64>,
}

impl Comparison<'_> {
    fn report(&self, path: &Path) -> Report<'_> {
        let runs = self.runs.iter().enumerate();
        let measure = |m| {
            let m: &Measure = m;
            MeasureReport {
                quantity: m.name.as_str(),
                unit: m.unit,
                largest: m.largest,
                at: seconds(m.at),
                part: m.part,
                scale: m.scale,
                tolerance: m.tolerated,
                first: m.first.map(seconds),
            }
        };
        Report {
            recording: path.display().to_string(),
            within: self.above().next().is_none() && self.unpaired().is_empty(),
            runs: runs
                .map(|(k, run)| RunReport {
                    letter: letter(k),
                    label: &run.label,
                    shift: seconds(self.shifts[k]),
                    cut: run.cut.as_deref(),
                })
                .collect(),
            pairs: self
                .apart
                .iter()
                .map(|apart| PairReport {
                    run: letter(apart.run),
                    body: &apart.pair.a,
                    other: &apart.pair.b,
                    by_name: apart.pair.by_name,
                    from: seconds(apart.from),
                    until: seconds(apart.until),
                    rows: apart.rows,
                    interpolated: apart.interpolated,
                    not_compared: &apart.alone,
                    quantities: apart.quantities.iter().map(measure).collect(),
                })
                .collect(),
            remarks: self.remarks(),
        }
    }
}
