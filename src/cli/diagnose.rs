//! `diagnose LOG`: what is wrong with the rotation of somebody's engine, by what it logged.

use super::{Told, Wrong, print};
use crate::diagnose::{Answer, Evidence, Verdict, cause, diagnose};
use crate::log::{Log, Mapping, Options, Reading, Report, bodies};
use serde_json::{Value, json};
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

/// Say what is wrong with an engine's rotation, by its log.
///
/// Reads CSV or JSON lines: time, pose, angular velocity and, where there are any, torques and forces, a row a body and
/// step (docs/logs.md). Of each body it says one of three: what is wrong, with the numbers that show it; that nothing is; or that
/// the log cannot tell, and what to record instead. docs/causes.md lists what it knows.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  torquescope diagnose run.csv --bodies bodies.toml\n  engine | torquescope diagnose - --bodies bodies.toml --json\n\nExit code: 0 nothing is wrong or the log cannot tell, 1 something is wrong, 2 the log cannot be read."
)]
pub struct Arguments {
    /// The log, CSV or JSON lines; - for standard input.
    log: PathBuf,
    /// Mass properties: TOML with [body.NAME], URDF or MJCF.
    #[arg(long, value_name = "FILE")]
    bodies: Option<PathBuf>,
    /// What a column is, as in omega=wx,wy,wz:deg/s or attitude=a,b,c,d:wxyz.
    #[arg(long, value_name = "QUANTITY=COLUMNS")]
    map: Vec<Mapping>,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let (mut log, mut report) = read(&arguments.log, &arguments.map)?;
    // Of the bodies' own file, in its lines.
    let mut notes = Vec::new();
    if let Some(file) = &arguments.bodies {
        let (declared, told) = bodies::load(file).map_err(|error| Wrong(error.to_string()))?;
        let name = file.display().to_string();
        notes.extend(told.into_iter().map(|note| (note.code, note.told(&name))));
        report.notes.extend(log.declare(declared));
    }
    let verdicts: Vec<Verdict> = log.bodies.iter().map(diagnose).collect();
    match arguments.json {
        true => print::json(&object(&verdicts, &report, &notes))?,
        false => {
            print::err(&format!("{}: {}", report.file, report.columns));
            notes.iter().for_each(|(_, told)| print::err(told));
            let told = report.to_string();
            if !told.is_empty() {
                print::err(&told);
            }
            let texts: Vec<String> = verdicts.iter().map(text).collect();
            print::out(&texts.join("\n\n"))?;
        }
    }
    match verdicts
        .iter()
        .any(|verdict| verdict.answer == Answer::Fault)
    {
        true => Err(Told(1).into()),
        false => Ok(()),
    }
}

fn read(path: &Path, mappings: &[Mapping]) -> anyhow::Result<(Log, Report)> {
    let options = Options {
        mappings: mappings.to_vec(),
        reading: Reading::AsDeclared,
    };
    let unreadable = |error: std::io::Error| Wrong(format!("{}: {error}", path.display()));
    let (name, length, input): (_, _, Box<dyn Read>) = match path == Path::new("-") {
        true => (
            "standard input".to_owned(),
            None,
            Box::new(std::io::stdin()),
        ),
        false => {
            let file = File::open(path).map_err(unreadable)?;
            let length = file.metadata().map_err(unreadable)?.len();
            (path.display().to_string(), Some(length), Box::new(file))
        }
    };
    let bar = print::bytes(length);
    let done = Log::read_telling(&name, BufReader::new(input), options, &mut |bytes| {
        bar.set_position(bytes);
    });
    bar.finish_and_clear();
    done.map_err(|error| Wrong(error.to_string()).into())
}

fn object(verdicts: &[Verdict], report: &Report, notes: &[(&str, String)]) -> Value {
    let bodies: Vec<Value> = verdicts.iter().map(Verdict::to_json).collect();
    let own = report.notes.iter();
    let own = own.map(|note| (note.code, note.told(&report.file)));
    let notes = own.chain(notes.iter().cloned());
    let notes = notes.map(|(code, text)| json!({"code": code, "text": text}));
    json!({
        "bodies": bodies,
        "rows": report.rows,
        "left_out": report.left_out(),
        "columns": report.columns.to_string(),
        "notes": notes.collect::<Vec<_>>(),
    })
}

/// What is said of a body, to be read.
fn text(verdict: &Verdict) -> String {
    let Verdict { body, why, .. } = verdict;
    let mut lines = vec![match verdict.answer {
        Answer::Fault => format!("{body}: wrong: {}{}", named(verdict), sure(verdict)),
        Answer::NoFault => format!("{body}: nothing is wrong{}", sure(verdict)),
        Answer::CannotTell => format!("{body}: this log cannot tell"),
    }];
    let mut say = |what: &str, text: &str| {
        if !text.is_empty() {
            lines.push(format!("  {what:<10}  {text}"));
        }
    };
    say("seen", why);
    if let (Answer::Fault, Some(cause)) = (verdict.answer, cause(verdict.cause)) {
        say("as people", cause.symptom);
    }
    say("numbers", &numbers(&verdict.evidence));
    say("the code", verdict.does);
    say("right is", verdict.formula);
    let remedy = match verdict.answer {
        Answer::CannotTell => "record",
        _ => "remedy",
    };
    say(remedy, &verdict.remedy);
    for surprise in &verdict.surprises {
        say("expected", surprise);
    }
    for left in &verdict.left_out {
        let span = format!("{:.6} s to {:.6} s: {}", left.from, left.until, left.why);
        say("left out", &span);
    }
    for untested in &verdict.untested {
        say("untested", untested);
    }
    lines.join("\n")
}

fn named(verdict: &Verdict) -> String {
    match verdict.one_of.is_empty() {
        true => verdict.cause.to_owned(),
        false => format!("one of {}", verdict.one_of.join(", ")),
    }
}

/// What leaves so many times as much is out of the question, however many.
const MANY: f64 = 1000.0;

fn sure(verdict: &Verdict) -> String {
    let next = verdict.runner_up.as_ref().map(|next| {
        let behind = match next.behind < MANY {
            true => format!("{:.1} times as much", next.behind),
            false => format!("more than {MANY} times as much"),
        };
        format!("; the next best, {}, leaves {behind}", next.cause)
    });
    format!(
        " (sure to {:.2}{})",
        verdict.confidence,
        next.unwrap_or_default()
    )
}

fn numbers(evidence: &[Evidence]) -> String {
    let number = |e: &Evidence| {
        let unit = match e.unit {
            "" => String::new(),
            unit => format!(" {unit}"),
        };
        format!("{} {}{unit}", e.name, crate::trace::brief(e.value))
    };
    evidence.iter().map(number).collect::<Vec<_>>().join(", ")
}
