//! `inspect FILE.rrd`: what a recording holds, without a viewer.

use super::{Wrong, print};
use crate::record::{
    self, Clock, Export, Extremes, InspectError, Mark, Origin, PlotText, Recording, STATIC, Span,
    Stretch, Survey, Table, TimeUnit, Wanted,
};
use crate::trace::{Chosen, Condition, Vocabulary, short, short_numbers};
use serde::Serialize;
use std::fs::File;
use std::io::{BufWriter, Read as _, Write};
use std::path::{Path, PathBuf};

/// Look into a recording without a viewer.
///
/// Lists entities, clocks and the extremes of every quantity by body; or tells one instant, where a condition holds,
/// or writes the numbers for other programs. Recordings of others are read too, where they hold transforms or scalars.
#[derive(clap::Args)]
#[command(
    after_help = "Examples: torquescope inspect cone.rrd --at 1.5 --body free-A\n          torquescope inspect cone.rrd --when 'energy drift > 1e-6'\n          torquescope inspect cone.rrd --export csv --out cone.csv\n          torquescope inspect cone.rrd --plot torque.free-A"
)]
pub struct Arguments {
    /// The recording, an .rrd file.
    file: PathBuf,
    /// Every quantity at this instant (s), as last recorded; before and after where an event falls on it.
    #[arg(
        long,
        value_name = "SECONDS",
        allow_hyphen_values = true,
        group = "question"
    )]
    at: Option<f64>,
    /// Where a condition begins and ceases to hold: 'energy drift > 1e-6', 'angular_velocity.cone > 50',
    /// 'torque.cone.y < 0', 'not finite'.
    #[arg(long, value_name = "CONDITION", group = "question")]
    when: Option<String>,
    /// Write the numbers, a row an instant and body: csv, json or parquet.
    #[arg(long, value_name = "FORMAT", group = "question")]
    export: Option<Format>,
    /// Draw a quantity against time as an SVG: torque.cone, torque.cone.y, or torque of all bodies.
    #[arg(long, value_name = "QUANTITY", group = "question")]
    plot: Option<String>,
    /// This body alone (of a recording of others: this entity).
    #[arg(long, value_name = "NAME")]
    body: Option<String>,
    /// This recording alone, where a file holds several; the first is 1.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    recording: Option<u32>,
    /// By this clock [default: sim_time, or else the fullest that is not the logger's].
    #[arg(long, value_name = "NAME")]
    timeline: Option<String>,
    /// Where an export or a plot goes [default: standard output; of a plot QUANTITY.svg].
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Print one JSON object with every digit.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    Csv,
    Json,
    Parquet,
}

pub fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let file = &arguments.file;
    if arguments.out.is_some() && arguments.export.is_none() && arguments.plot.is_none() {
        return Err(
            Wrong("--out says where --export or --plot goes; add one of them".to_owned()).into(),
        );
    }
    let survey = record::survey(file)?;
    let look = Look::new(arguments, &survey)?;
    if let Some(seconds) = arguments.at {
        look.instant(seconds)?;
    } else if let Some(text) = &arguments.when {
        look.when(text)?;
    } else if let Some(format) = arguments.export {
        look.export(format)?;
    } else if let Some(text) = &arguments.plot {
        look.plot(text)?;
    } else {
        look.overview()?;
    }
    match &survey.cut {
        None => Ok(()),
        Some(why) => Err(anyhow::anyhow!(
            "{}: is cut or broken ({why}): that is what there is of it",
            file.display()
        )),
    }
}

/// A file, and what is asked of it.
struct Look<'a> {
    arguments: &'a Arguments,
    survey: &'a Survey,
    wanted: Wanted,
}

impl<'a> Look<'a> {
    fn new(arguments: &'a Arguments, survey: &'a Survey) -> anyhow::Result<Self> {
        let look = Self {
            arguments,
            survey,
            wanted: Wanted {
                recording: arguments.recording.map(|n| n as usize - 1),
                body: arguments.body.clone(),
                clock: arguments.timeline.clone(),
                ..Wanted::default()
            },
        };
        let count = survey.recordings.len();
        if let Some(n) = arguments.recording.filter(|&n| n as usize > count) {
            return Err(look
                .not_there(format!("--recording {n} is not there; it holds {count}"))
                .into());
        }
        if let Some(name) = &arguments.timeline
            && look
                .recordings()
                .all(|(_, recording)| recording.clock(Some(name)).is_none())
        {
            let mut known: Vec<&str> = Vec::new();
            for clock in look
                .recordings()
                .flat_map(|(_, recording)| &recording.clocks)
            {
                known.push(&clock.name);
            }
            known.dedup();
            let nearest = crate::trace::nearest(name, &known);
            return Err(look
                .not_there(format!("has no timeline `{name}`; {nearest}"))
                .into());
        }
        if let Some(body) = &arguments.body {
            look.must_know(body)?;
        }
        Ok(look)
    }

    /// Whether there is anything of a body is known by looking.
    fn must_know(&self, body: &str) -> anyhow::Result<()> {
        let all = Wanted {
            body: None,
            ..self.wanted.clone()
        };
        let known = self.vocabulary(&all)?.bodies;
        if known.iter().any(|name| name == body) {
            return Ok(());
        }
        let known: Vec<&str> = known.iter().map(String::as_str).collect();
        let nearest = match known.is_empty() {
            true => "no body has numbers here".to_owned(),
            false => crate::trace::nearest(body, &known),
        };
        Err(self
            .not_there(format!("no body is called `{body}`; {nearest}"))
            .into())
    }

    fn not_there(&self, why: String) -> InspectError {
        InspectError::NotThere {
            path: self.arguments.file.display().to_string(),
            why,
        }
    }

    fn vocabulary(&self, wanted: &Wanted) -> anyhow::Result<Vocabulary> {
        Ok(record::vocabulary(
            &self.arguments.file,
            self.survey,
            wanted,
        )?)
    }

    fn table(&self, wanted: &Wanted) -> anyhow::Result<Table> {
        Ok(Table::read(&self.arguments.file, self.survey, wanted)?)
    }

    /// Those asked for, with their places in the file.
    fn recordings(&self) -> impl Iterator<Item = (usize, &'a Recording)> {
        let only = self.wanted.recording;
        let all = self.survey.recordings.iter().enumerate();
        all.filter(move |(k, _)| only.is_none_or(|only| only == *k))
    }

    fn clock(&self, recording: usize) -> Option<&'a Clock> {
        self.survey.recordings[recording].clock(self.arguments.timeline.as_deref())
    }

    fn unit(&self, recording: usize) -> TimeUnit {
        self.clock(recording)
            .map_or(TimeUnit::Duration, |clock| clock.unit)
    }

    /// s, or a count; none of what has no time.
    fn time(&self, recording: usize, time: i64) -> Option<f64> {
        (time != STATIC).then(|| self.unit(recording).number(time))
    }

    fn shown(&self, recording: usize, time: i64) -> String {
        match self.time(recording, time) {
            Some(number) => exact(number),
            None => "always".to_owned(),
        }
    }

    fn heading(&self, k: usize) -> String {
        let recording = &self.survey.recordings[k];
        let name = recording.name.as_deref();
        let name = name.unwrap_or(recording.application());
        match self.survey.recordings.len() {
            1 => name.to_owned(),
            _ => format!("recording {}: {name}", k + 1),
        }
    }

    fn overview(&self) -> anyhow::Result<()> {
        let extremes = record::extremes(&self.arguments.file, self.survey, &self.wanted)?;
        let of = |k: usize| extremes.iter().filter(move |e| e.recording == k);
        if self.arguments.json {
            let recordings = self.recordings();
            return print::json(&Report {
                file: self.arguments.file.display().to_string(),
                cut: self.survey.cut.as_deref(),
                recordings: recordings
                    .map(|(k, recording)| {
                        self.report(k, recording, of(k).map(|e| self.extremes(e)).collect())
                    })
                    .collect(),
            });
        }
        let texts = self.recordings().map(|(k, recording)| {
            let mut text = format!("{}\n{}", self.heading(k), made_by(recording));
            text += &self.clocks(recording);
            text += &entities(recording);
            let own: Vec<&Extremes> = of(k).collect();
            let has =
                |body: &str, name: &str| own.iter().any(|e| e.body == body && e.term.name == name);
            let shown = own.iter().filter(|e| !repeats(&e.body, &e.term.name, has));
            let rows: Vec<_> = shown.map(|e| self.extremes_row(e)).collect();
            if rows.is_empty() {
                return text + "\nno numbers: neither this program's, nor transforms or scalars\n";
            }
            let header = [
                "body",
                "quantity",
                "rows",
                "least",
                "at",
                "greatest",
                "at",
                "components",
            ];
            let clock = self.clock(k).map_or("", |clock| clock.name.as_str());
            text + &format!(
                "\nExtremes (|…|: of the length; by {clock})\n{}\n",
                print::table(&header, rows)
            )
        });
        print::out(texts.collect::<Vec<_>>().join("\n").trim_end())
    }

    fn clocks(&self, recording: &Recording) -> String {
        let clocks = recording.clocks.iter().map(|clock| {
            let [first, last] = [clock.first, clock.last].map(|t| exact(clock.unit.number(t)));
            let unit = clock.unit.symbol();
            format!("{}: {first} … {last} {unit}", clock.name)
                .trim_end()
                .to_owned()
                + "\n"
        });
        clocks.collect()
    }

    fn extremes_row(&self, extremes: &Extremes) -> Vec<String> {
        let term = &extremes.term;
        let (span, name) = match (&extremes.size, extremes.components.as_slice()) {
            (Some(size), _) => (*size, format!("|{}|", term.name)),
            (None, [only]) => (*only, term.name.clone()),
            (None, _) => (Span::default(), term.name.clone()),
        };
        let mark = |mark: Option<Mark>| match mark {
            Some(mark) => [short(mark.value), self.shown(extremes.recording, mark.time)],
            None => ["–".to_owned(), "–".to_owned()],
        };
        let ([least, least_at], [greatest, greatest_at]) = (mark(span.least), mark(span.greatest));
        let picture = match extremes.origin {
            Origin::Picture => " (f32)",
            _ => "",
        };
        let rows = match extremes.known == extremes.rows {
            true => extremes.rows.to_string(),
            false => format!("{} of {}", extremes.known, extremes.rows),
        };
        vec![
            extremes.body.clone(),
            format!("{name}{picture}{}", in_unit(term.unit)),
            rows,
            least,
            least_at,
            greatest,
            greatest_at,
            self.components(extremes),
        ]
    }

    /// The ranges of the components of a vector, and what is no number.
    fn components(&self, extremes: &Extremes) -> String {
        let names = extremes.term.shape.components();
        let mut lines = Vec::new();
        if (1..=4).contains(&names.len()) {
            let ranges = names
                .iter()
                .zip(&extremes.components)
                .filter_map(|(name, span)| {
                    let (least, greatest) = (span.least?, span.greatest?);
                    let range = short_numbers(&[least.value, greatest.value]);
                    Some(format!("{name} {}", range.join(" … ")))
                });
            lines.extend(ranges);
        }
        let mut text = lines.join(", ");
        if let Some(first) = extremes.first_not_finite {
            let first = self.shown(extremes.recording, first);
            let count = extremes.not_finite;
            text = format!("{text} {count} rows not finite, the first at {first}")
                .trim()
                .to_owned();
        }
        text
    }

    fn instant(&self, number: f64) -> anyhow::Result<()> {
        if !number.is_finite() {
            return Err(Wrong(format!("--at {number} is no time; write a finite number")).into());
        }
        let table = self.table(&self.wanted)?;
        let all = self.recordings().map(|(k, _)| {
            let time = self.unit(k).time(number);
            let own = table.series.iter().filter(move |s| s.recording == k);
            own.filter_map(move |series| {
                let rows = series.at(time);
                let last = rows.clone().last()?;
                Some((series, rows, series.times[last]))
            })
            .collect::<Vec<_>>()
        });
        let all: Vec<_> = all.collect();
        if self.arguments.json {
            let values = all
                .iter()
                .flatten()
                .map(|(series, rows, time)| InstantReport {
                    recording: series.recording + 1,
                    body: &series.body,
                    quantity: &series.term.name,
                    unit: series.term.unit,
                    at: self.time(series.recording, *time),
                    rows: rows.clone().map(|row| series.row(row)).collect(),
                });
            return print::json(&values.collect::<Vec<_>>());
        }
        let mut text = String::new();
        for ((k, _), found) in self.recordings().zip(&all) {
            text += &format!("{}\n", self.heading(k));
            if found.is_empty() {
                text += &format!("nothing is recorded up to {number}\n");
                continue;
            }
            let mut rows = Vec::new();
            let has = |body: &str, name: &str| table.find(k, body, name).is_some();
            for (series, range, time) in found {
                if repeats(&series.body, &series.term.name, has) {
                    continue;
                }
                let when = self.shown(k, *time);
                rows.extend(instant_rows(series, range.clone(), &when));
            }
            text += &print::table(&["body", "quantity", "recorded at", "", "value"], rows);
            text += "\n";
        }
        print::out(text.trim_end())
    }

    fn when(&self, text: &str) -> anyhow::Result<()> {
        let vocabulary = self.vocabulary(&self.wanted)?;
        let condition = Condition::parse(text, &vocabulary)
            .map_err(|error| Wrong(format!("--when '{text}': {error}")))?;
        let table = self.table(&Wanted {
            quantities: record::asked(&condition),
            ..self.wanted.clone()
        })?;
        let found = record::stretches(&table, &condition);
        if self.arguments.json {
            let stretches = found.iter().map(|stretch| self.stretch(stretch));
            return print::json(&WhenReport {
                condition: condition.to_string(),
                cut: self.survey.cut.as_deref(),
                holds: stretches.collect(),
            });
        }
        if found.is_empty() {
            let rows: usize = table.series.iter().map(|series| series.times.len()).sum();
            return print::out(&format!("{condition}: at none of {rows} recorded instants"));
        }
        const MOST: usize = 200;
        let rows = found
            .iter()
            .take(MOST)
            .map(|stretch| self.stretch_row(stretch));
        let header = [
            "body",
            "quantity",
            "begins at",
            "there",
            "holds until",
            "rows",
            "farthest",
            "at",
        ];
        let mut text = format!("{condition}\n{}", print::table(&header, rows.collect()));
        if found.len() > MOST {
            text += &format!("\nand {} more times (--json tells all)", found.len() - MOST);
        }
        print::out(&text)
    }

    fn stretch_row(&self, stretch: &Stretch) -> Vec<String> {
        let k = stretch.recording;
        let body = match self.survey.recordings.len() {
            1 => stretch.body.clone(),
            _ => format!("{} ({})", stretch.body, k + 1),
        };
        let until = match stretch.ends {
            Some(_) => self.shown(k, stretch.last),
            None => format!("{}, the end", self.shown(k, stretch.last)),
        };
        vec![
            body,
            format!("{}{}", stretch.quantity, in_unit(stretch.unit)),
            self.shown(k, stretch.begins.time),
            short(stretch.begins.value),
            until,
            stretch.rows.to_string(),
            short(stretch.largest.value),
            self.shown(k, stretch.largest.time),
        ]
    }

    fn export(&self, format: Format) -> anyhow::Result<()> {
        let table = self.table(&Wanted {
            at_one_rate: true,
            ..self.wanted.clone()
        })?;
        let clocks = self.recordings().filter_map(|(k, _)| self.clock(k));
        let clocks: Vec<&Clock> = clocks.collect();
        let Some(clock) = clocks.first().filter(|_| !table.series.is_empty()) else {
            return Err(self.not_there("has no numbers to export".to_owned()).into());
        };
        if clocks
            .iter()
            .any(|other| (&other.name, other.unit) != (&clock.name, clock.unit))
        {
            let why = "its recordings have other clocks; choose one with --timeline or --recording";
            return Err(self.not_there(why.to_owned()).into());
        }
        let export = Export::new(&table, &clock.name, clock.unit);
        let out = match (&self.arguments.out, format) {
            (Some(out), _) => out,
            (None, Format::Parquet) => {
                let why =
                    "--export parquet is not for a terminal; say with --out FILE where it goes";
                return Err(Wrong(why.to_owned()).into());
            }
            (None, _) => return to_stdout(&export, format),
        };
        let begins: &[u8] = match format {
            Format::Csv => b"recording,body,",
            Format::Json => b"[\n{\"body\"",
            Format::Parquet => b"PAR1",
        };
        must_not_be_lost(out, begins)?;
        let written = File::create(out).and_then(|file| {
            let mut file = BufWriter::new(file);
            write(&export, format, &mut file)?;
            file.flush()
        });
        written
            .map_err(|error| anyhow::anyhow!("{}: cannot be written: {error}", out.display()))?;
        print::err(&format!("{}: {} rows", out.display(), export.rows()));
        Ok(())
    }

    fn plot(&self, text: &str) -> anyhow::Result<()> {
        let vocabulary = self.vocabulary(&self.wanted)?;
        let chosen = Chosen::parse(text, &vocabulary)
            .map_err(|error| Wrong(format!("--plot '{text}': {error}")))?;
        let table = self.table(&Wanted {
            quantities: Some(vec![chosen.term.name.clone()]),
            ..self.wanted.clone()
        })?;
        let mut curves = Vec::new();
        for (k, _) in self.recordings() {
            let unit = self.unit(k);
            let mut own = record::curves(&table, k, &chosen, |time| unit.number(time));
            if self.survey.recordings.len() > 1 && self.wanted.recording.is_none() {
                own.iter_mut()
                    .for_each(|curve| curve.name += &format!(" ({})", k + 1));
            }
            curves.append(&mut own);
        }
        let name = match &chosen.body {
            Some(body) => format!("{} of {body}", chosen.term.name),
            None => chosen.to_string(),
        };
        let clock = self.recordings().find_map(|(k, _)| self.clock(k));
        let across = clock.map_or(String::new(), |clock| match clock.unit.symbol() {
            "" => clock.name.clone(),
            unit => format!("{} ({unit})", clock.name),
        });
        let title = self
            .recordings()
            .next()
            .map_or(String::new(), |(k, _)| self.heading(k));
        let out = self
            .arguments
            .out
            .clone()
            .unwrap_or_else(|| file_name(text));
        must_not_be_lost(&out, b"<svg")?;
        let up = format!("{}{}", name.replace('_', " "), in_unit(chosen.term.unit));
        let words = PlotText {
            title: &title,
            across: &across,
            up: &up,
        };
        record::plot(&curves, &words, &out)?;
        if self.arguments.json {
            return print::json(
                &serde_json::json!({ "plot": out.display().to_string(), "lines": curves.len() }),
            );
        }
        print::out(&format!("{}: {} lines", out.display(), curves.len()))
    }
}

/// `torque.cone` → `torque.cone.svg`, without what a file cannot be called.
fn file_name(text: &str) -> PathBuf {
    let plain = |c: char| match c.is_alphanumeric() || "-_.".contains(c) {
        true => c,
        false => '_',
    };
    let name: String = text.trim().chars().map(plain).collect();
    PathBuf::from(format!("{}.svg", name.trim_matches('.')))
}

fn to_stdout(export: &Export<'_>, format: Format) -> anyhow::Result<()> {
    let mut stdout = BufWriter::new(std::io::stdout());
    match write(export, format, &mut stdout) {
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(anyhow::anyhow!(
            "standard output: cannot be written: {error}; send it elsewhere"
        )),
        Ok(()) => Ok(()),
    }
}

fn write(export: &Export<'_>, format: Format, mut out: impl Write + Send) -> std::io::Result<()> {
    match format {
        Format::Csv => export.csv(&mut out),
        Format::Json => export.json(&mut out),
        Format::Parquet => export.parquet(out),
    }
}

/// A file that is there and is no earlier result was put there for something else.
pub(super) fn must_not_be_lost(path: &Path, begins: &[u8]) -> anyhow::Result<()> {
    let is_file = std::fs::metadata(path).is_ok_and(|data| data.is_file() && data.len() > 0);
    let mut start = vec![0; begins.len()];
    let mut read = || File::open(path).and_then(|mut file| file.read_exact(&mut start));
    if is_file && (read().is_err() || start != begins) {
        return Err(Wrong(format!(
            "{} exists and is something else; choose another --out, so that it is not lost",
            path.display()
        ))
        .into());
    }
    Ok(())
}

fn in_unit(unit: &str) -> String {
    match unit {
        "" | "1" => String::new(),
        unit => format!(" ({unit})"),
    }
}

/// Whether a number is the length of a vector that is told beside it.
fn repeats(body: &str, name: &str, has: impl Fn(&str, &str) -> bool) -> bool {
    name.strip_suffix("_norm")
        .is_some_and(|vector| has(body, vector))
}

/// Every digit of a time.
fn exact(x: f64) -> String {
    format!("{}", x + 0.0)
}

fn made_by(recording: &Recording) -> String {
    let Some(from) = &recording.provenance else {
        return format!(
            "made by {}, recording {}\n",
            recording.application(),
            recording.id()
        );
    };
    let fact = |name: &str| from.fact(name).unwrap_or("?");
    format!(
        "torquescope {}, scene {}, method {}, step {} s, on {}\n",
        fact("version"),
        fact("scene"),
        fact("method"),
        fact("step"),
        fact("machine")
    )
}

/// Of recordings of others one by one, as many as one reads; those of this program have them in known places.
fn entities(recording: &Recording) -> String {
    const MOST: usize = 40;
    let all = &recording.entities;
    let moving = all.iter().filter(|entity| entity.rows > 0);
    let rows: u64 = moving.clone().map(|entity| entity.rows).sum();
    let mut text = format!(
        "{} entities, {} of them with {rows} rows in time\n",
        all.len(),
        moving.clone().count()
    );
    if recording.is_own() {
        return text;
    }
    let row = |entity: &record::Entity| {
        let rows = match (entity.rows, entity.statics) {
            (0, _) => "static".to_owned(),
            (rows, _) => rows.to_string(),
        };
        vec![entity.path.clone(), rows, entity.columns.join(", ")]
    };
    let rows: Vec<_> = all.iter().take(MOST).map(row).collect();
    text += &print::wrapped(&["entity", "rows", "components"], rows);
    text += "\n";
    if all.len() > MOST {
        text += &format!("and {} more (--json tells all)\n", all.len() - MOST);
    }
    text
}

/// Before and after where an event falls on the instant and changes something.
fn instant_rows(
    series: &record::Series,
    range: std::ops::Range<usize>,
    when: &str,
) -> Vec<Vec<String>> {
    // What the event left as it was is told once.
    let same = range
        .clone()
        .all(|row| series.row(row) == series.row(range.start));
    let range = if same {
        range.start..range.start + 1
    } else {
        range
    };
    let count = range.len();
    let row = |(k, row): (usize, usize)| {
        let which = match (k, count) {
            (_, 1) => "",
            (0, _) => "before",
            (k, count) if k + 1 == count => "after",
            _ => "between",
        };
        vec![
            series.body.clone(),
            format!("{}{}", series.term.name, in_unit(series.term.unit)),
            when.to_owned(),
            which.to_owned(),
            words(series, series.row(row)),
        ]
    };
    range.enumerate().map(row).collect()
}

fn words(series: &record::Series, values: &[f64]) -> String {
    let width = series.term.shape.components().len().max(1);
    let group = |values: &[f64]| match short_numbers(values).as_slice() {
        [one] => one.clone(),
        nine if nine.len() == 9 => {
            let rows: Vec<String> = nine
                .chunks(3)
                .map(|row| format!("({})", row.join(", ")))
                .collect();
            rows.join("\n")
        }
        several => format!("({})", several.join(", ")),
    };
    match values {
        [] => "–".to_owned(),
        values => values
            .chunks(width)
            .map(group)
            .collect::<Vec<_>>()
            .join("\n"),
    }
}

/// What `--json` prints. A number that is not finite is null.
#[derive(Serialize)]
struct Report<'a> {
    file: String,
    cut: Option<&'a str>,
    recordings: Vec<RecordingReport<'a>>,
}

#[derive(Serialize)]
struct RecordingReport<'a> {
    application: &'a str,
    id: &'a str,
    name: Option<&'a str>,
    /// What the times of the extremes are by.
    clock: Option<&'a str>,
    timelines: Vec<ClockReport<'a>>,
    entities: Vec<EntityReport<'a>>,
    extremes: Vec<ExtremesReport<'a>>,
}

#[derive(Serialize)]
struct ClockReport<'a> {
    name: &'a str,
    /// s, or nothing of a count.
    unit: &'static str,
    first: f64,
    last: f64,
    rows: u64,
}

#[derive(Serialize)]
struct EntityReport<'a> {
    path: &'a str,
    rows: u64,
    statics: u64,
    components: &'a [String],
}

#[derive(Serialize)]
struct ExtremesReport<'a> {
    body: &'a str,
    quantity: &'a str,
    unit: &'static str,
    /// Whether it is of a picture, in f32.
    f32: bool,
    rows: u64,
    known: u64,
    not_finite: u64,
    first_not_finite: Option<f64>,
    size: Option<SpanReport>,
    components: Vec<SpanReport>,
}

#[derive(Serialize)]
struct SpanReport {
    /// Value and time.
    least: Option<(f64, Option<f64>)>,
    greatest: Option<(f64, Option<f64>)>,
}

#[derive(Serialize)]
struct InstantReport<'a> {
    recording: usize,
    body: &'a str,
    quantity: &'a str,
    unit: &'static str,
    at: Option<f64>,
    /// One; where an event falls on the instant what was before and what is after.
    rows: Vec<&'a [f64]>,
}

#[derive(Serialize)]
struct WhenReport<'a> {
    condition: String,
    cut: Option<&'a str>,
    holds: Vec<StretchReport<'a>>,
}

#[derive(Serialize)]
struct StretchReport<'a> {
    recording: usize,
    body: &'a str,
    quantity: &'a str,
    unit: &'static str,
    begins: Option<f64>,
    value: f64,
    /// The last row at which it holds, and the first after that at which it does not.
    last: Option<f64>,
    ends: Option<f64>,
    rows: u64,
    farthest: f64,
    farthest_at: Option<f64>,
}

impl<'a> Look<'a> {
    fn report(
        &self,
        k: usize,
        recording: &'a Recording,
        extremes: Vec<ExtremesReport<'a>>,
    ) -> RecordingReport<'a> {
        let clock = |clock: &'a Clock| ClockReport {
            name: &clock.name,
            unit: clock.unit.symbol(),
            first: clock.unit.number(clock.first),
            last: clock.unit.number(clock.last),
            rows: clock.rows,
        };
        let entity = |entity: &'a record::Entity| EntityReport {
            path: &entity.path,
            rows: entity.rows,
            statics: entity.statics,
            components: &entity.columns,
        };
        RecordingReport {
            application: recording.application(),
            id: recording.id(),
            name: recording.name.as_deref(),
            clock: self.clock(k).map(|clock| clock.name.as_str()),
            timelines: recording.clocks.iter().map(clock).collect(),
            entities: recording.entities.iter().map(entity).collect(),
            extremes,
        }
    }

    fn extremes<'e>(&self, extremes: &'e Extremes) -> ExtremesReport<'e> {
        let k = extremes.recording;
        let mark = |mark: Mark| (mark.value, self.time(k, mark.time));
        let span = |span: &Span| SpanReport {
            least: span.least.map(mark),
            greatest: span.greatest.map(mark),
        };
        ExtremesReport {
            body: &extremes.body,
            quantity: &extremes.term.name,
            unit: extremes.term.unit,
            f32: extremes.origin == Origin::Picture,
            rows: extremes.rows,
            known: extremes.known,
            not_finite: extremes.not_finite,
            first_not_finite: extremes.first_not_finite.and_then(|t| self.time(k, t)),
            size: extremes.size.as_ref().map(span),
            components: extremes.components.iter().map(span).collect(),
        }
    }

    fn stretch<'s>(&self, stretch: &'s Stretch) -> StretchReport<'s> {
        let time = |t: i64| self.time(stretch.recording, t);
        StretchReport {
            recording: stretch.recording + 1,
            body: &stretch.body,
            quantity: &stretch.quantity,
            unit: stretch.unit,
            begins: time(stretch.begins.time),
            value: stretch.begins.value,
            last: time(stretch.last),
            ends: stretch.ends.and_then(time),
            rows: stretch.rows,
            farthest: stretch.largest.value,
            farthest_at: time(stretch.largest.time),
        }
    }
}
