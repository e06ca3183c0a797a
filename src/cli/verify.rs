//! `run FILE.rrd --verify`: whether a recording's scene, run again, gives the same bits.

use super::run::{Arguments, headings, must_not_be_input, plans, record, scenes};
use super::stop::Stop;
use super::{Told, Wrong, print};
use crate::record::{
    Comparison, Difference, Heading, Made, Provenance, Recorder, VERSION, Verdict,
};
use crate::scene::Scene;
use crate::trace::Subject;
use serde::Serialize;

pub fn run(arguments: &Arguments, made: &Made) -> anyhow::Result<()> {
    let file = arguments.scene.display();
    if arguments.changes() {
        return Err(Wrong(
            "--verify runs a recording as it was made; leave out what changes the scene".to_owned(),
        )
        .into());
    }
    if arguments.views() && arguments.out.is_none() {
        return Err(Wrong("--verify keeps a recording of the new run only where --out says; add --out FILE to view it".to_owned()).into());
    }
    if let Some(out) = &arguments.out {
        must_not_be_input(out, &arguments.scene)?;
    }
    refuse_other_versions(arguments, made)?;
    let scenes = scenes(arguments, Some(made)).map_err(|error| {
        Wrong(format!(
            "{error:#}\n{file}: cannot be verified: its scene is none to this program"
        ))
    })?;
    refuse_other_settings(arguments, made, &scenes)?;
    let stop = Stop::prepare()?;
    let plans = plans(&scenes, false)?;
    let headings = headings(&scenes, arguments, true);
    let comparison = Comparison::new(&arguments.scene, made);
    let comparison =
        comparison.map_err(|error| Wrong(format!("{file}: cannot be read: {error}")))?;
    let comparison = std::cell::Cell::new(Some(comparison));
    let to = arguments.out.as_ref().map(|out| arguments.destination(out));
    let start = |heading: &Heading, subjects: &[Subject]| match comparison.take() {
        Some(comparison) => Recorder::comparing(comparison, to.as_ref(), heading, subjects),
        None => Recorder::nowhere(heading, subjects),
    };
    if let Some(to) = &to {
        print::written_over(to);
    }
    let (_, summary) = record((&scenes, &plans), &headings, &stop, start)?;
    if let Some(code) = stop.code() {
        print::err(&format!(
            "{file}: the run was stopped before it could be told whether it gives the same bits"
        ));
        return Err(Told(code).into());
    }
    tell(arguments, made, &scenes, &summary.verdicts)
}

fn refuse_other_versions(arguments: &Arguments, made: &Made) -> anyhow::Result<()> {
    let version = |from: &Provenance| from.fact("version").unwrap_or("?").to_owned();
    let mut others = made.recordings.iter().map(version);
    match others.find(|version| version != VERSION) {
        None => Ok(()),
        Some(other) => Err(Wrong(format!(
            "{}: cannot be verified: version: {other} there, {VERSION} here; another version may step otherwise: verify it by that one, or run it again without --verify",
            arguments.scene.display()
        ))
        .into()),
    }
}

fn refuse_other_settings(
    arguments: &Arguments,
    made: &Made,
    scenes: &[Scene],
) -> anyhow::Result<()> {
    if scenes.len() != made.recordings.len() {
        return Err(Wrong(format!(
            "{}: cannot be verified: two of its recordings have the same scene",
            arguments.scene.display()
        ))
        .into());
    }
    let pairs = made.recordings.iter().zip(scenes);
    let differ = pairs.flat_map(|(there, scene)| there.differences(&Provenance::of(scene)));
    let differ: Vec<String> = differ.collect();
    match differ.is_empty() {
        true => Ok(()),
        false => Err(Wrong(format!(
            "{}: cannot be verified: {}",
            arguments.scene.display(),
            differ.join("; ")
        ))
        .into()),
    }
}

/// What `--json` prints.
#[derive(Serialize)]
struct Report<'a> {
    recording: String,
    /// Whether all of it gives the same bits; null where a recording that was cut does as far as
    /// it goes.
    same: Option<bool>,
    /// Why there is less of the recording than was meant to be.
    cut: Option<&'a str>,
    recordings: Vec<OneReport<'a>>,
}

#[derive(Serialize)]
struct OneReport<'a> {
    scene: &'a str,
    variant: Option<&'a str>,
    same: bool,
    rows: u64,
    hashes: u64,
    last_step: u64,
    /// s.
    last_time: f64,
    /// Whether the text is another than the one it was recorded from.
    text_changed: bool,
    difference: Option<DifferenceReport<'a>>,
}

#[derive(Serialize)]
struct DifferenceReport<'a> {
    step: u64,
    /// s.
    time: f64,
    body: Option<&'a str>,
    quantity: &'a str,
    unit: &'a str,
    recorded: &'a str,
    again: &'a str,
    hash_agrees_until: Option<u64>,
    hash_differs_from: Option<u64>,
}

impl<'a> From<&'a Difference> for DifferenceReport<'a> {
    fn from(difference: &'a Difference) -> Self {
        Self {
            step: difference.step,
            time: seconds(difference.time),
            body: difference.body.as_deref(),
            quantity: &difference.quantity,
            unit: difference.unit,
            recorded: &difference.recorded,
            again: &difference.again,
            hash_agrees_until: difference.hash_agrees_until,
            hash_differs_from: difference.hash_differs_from,
        }
    }
}

fn seconds(nanoseconds: i64) -> f64 {
    nanoseconds as f64 / 1e9
}

/// Whether a text is another than the one it was recorded from.
fn text_changed(from: &Provenance, scene: &Scene) -> bool {
    from.fact("text") != Some(&format!("{:016x}", scene.fingerprint))
}

fn tell(
    arguments: &Arguments,
    made: &Made,
    scenes: &[Scene],
    verdicts: &[Verdict],
) -> anyhow::Result<()> {
    let file = arguments.scene.display().to_string();
    let same = verdicts.iter().all(|verdict| verdict.difference.is_none());
    let all = made.recordings.iter().zip(scenes).zip(verdicts);
    if arguments.json {
        let recordings = all.map(|((from, scene), verdict)| OneReport {
            scene: &scene.name,
            variant: scene.variant.as_deref(),
            same: verdict.difference.is_none(),
            rows: verdict.rows,
            hashes: verdict.hashes,
            last_step: verdict.last_step,
            last_time: seconds(verdict.last_time),
            text_changed: text_changed(from, scene),
            difference: verdict.difference.as_ref().map(DifferenceReport::from),
        });
        print::json(&Report {
            recording: file.clone(),
            same: (!same || made.cut.is_none()).then_some(same),
            cut: made.cut.as_deref(),
            recordings: recordings.collect(),
        })?;
    } else {
        let lines: Vec<String> = all
            .map(|((from, scene), verdict)| line(&file, from, scene, verdict))
            .collect();
        print::out(&lines.join("\n"))?;
    }
    match (same, &made.cut) {
        (false, _) => Err(anyhow::anyhow!(
            "{file}: run again it does not give the same bits{}",
            marked(arguments)
        )),
        (true, None) => Ok(()),
        (true, Some(why)) => Err(Wrong(format!(
            "{file}: is cut or broken ({why}): what there is of it gives the same bits, the rest is not known"
        ))
        .into()),
    }
}

fn marked(arguments: &Arguments) -> String {
    match &arguments.out {
        Some(out) => format!(
            "; {} has the new run, marked at the first difference",
            out.display()
        ),
        None => "; --out FILE keeps the new run, marked at the first difference".to_owned(),
    }
}

fn line(file: &str, from: &Provenance, scene: &Scene, verdict: &Verdict) -> String {
    let mut text = match &scene.variant {
        Some(variant) => format!("{file}, {variant}: "),
        None => format!("{file}: "),
    };
    text += &match &verdict.difference {
        None => format!(
            "the same bits: {} rows and {} hashes of all states, up to step {}, t = {} s",
            verdict.rows - verdict.hashes,
            verdict.hashes,
            verdict.last_step,
            seconds(verdict.last_time)
        ),
        Some(difference) => format!("differs {difference}"),
    };
    if text_changed(from, scene) {
        text += "; its scene's text is not the one it was recorded from";
    }
    let here = Provenance::of(scene);
    if let (Some(there), Some(here), Some(_)) = (
        from.fact("machine"),
        here.fact("machine"),
        &verdict.difference,
    ) && there != here
    {
        text += &format!("; it was recorded on {there}, this is {here}");
    }
    text
}
