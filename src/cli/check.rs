//! `check SCENE…`: read scenes and say what is wrong with them, or probably wrong.

use super::{Told, print};
use crate::scene::{Finding, SceneError, Script, Severity, WARNINGS};
use serde::Serialize;
use std::path::PathBuf;

/// Check scenes without running them.
///
/// Errors and warnings go to stderr, each with its place, the reason and the remedy. A warning is about
/// what is legal and probably wrong; a scene that means it says `allow = ["CODE"]`. Exit code 2: some
/// scene is wrong.
#[derive(clap::Args)]
#[command(after_help = "Example: torquescope check scenes/*.toml")]
pub struct Arguments {
    /// Scene files, or carried scenes such as @cone.
    #[arg(required_unless_present = "list")]
    scenes: Vec<PathBuf>,
    /// Exit code 1 where there are warnings.
    #[arg(long)]
    strict: bool,
    /// How to print what is found: for people, or on stdout as one JSON list for editors.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// List the warnings there are.
    #[arg(long, conflicts_with_all = ["scenes", "strict", "format"])]
    list: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    Text,
    Json,
}

pub fn run(arguments: &Arguments) -> anyhow::Result<()> {
    if arguments.list {
        let row = |warning: &crate::scene::Warning| {
            vec![warning.code.to_owned(), warning.about.to_owned()]
        };
        let rows = WARNINGS.iter().map(row).collect();
        return print::out(&print::wrapped(&["warning", "what it is about"], rows));
    }
    let text = arguments.format == Format::Text;
    let (mut found, mut wrong) = (Vec::new(), false);
    for path in &arguments.scenes {
        match judged(path) {
            Ok((line, warnings)) => {
                if text {
                    print::out(&line)?;
                    for warning in &warnings {
                        print::err(&warning.to_string());
                    }
                }
                found.extend(warnings);
            }
            Err(error) => {
                wrong = true;
                if text {
                    print::err(&error.to_string());
                }
                found.extend(error.findings());
            }
        }
    }
    if !text {
        print::json(&found.iter().map(Report::new).collect::<Vec<_>>())?;
    }
    if wrong {
        return Err(Told(2).into());
    }
    let warnings = found.iter().filter(|f| f.severity == Severity::Warning);
    match warnings.count() {
        0 => Ok(()),
        _ if !arguments.strict => Ok(()),
        _ => Err(Told(1).into()),
    }
}

/// What there is in a scene, in a line, and its warnings.
fn judged(path: &std::path::Path) -> Result<(String, Vec<Finding>), SceneError> {
    let (scenes, warnings) = Script::load(path)?.judge()?;
    let mut line = format!("{}: ok", path.display());
    // A sweep has at least one; of several the first stands for all.
    if let Some(scene) = scenes.first() {
        line += &format!(
            "; bodies: {}, events: {}; {} s by {} in steps of {} s",
            scene.bodies.len(),
            scene.events.len(),
            scene.duration,
            scene.stepping.name(),
            scene.step
        );
    }
    if scenes.len() > 1 {
        line += &format!("; the first of {} that its sweep makes", scenes.len());
    }
    Ok((line, warnings))
}

/// What `--format json` prints of each. Lines and columns from 1, columns in characters, the end behind
/// the last; of an argument, where the scene has been changed by one, there are none.
#[derive(Serialize)]
struct Report<'a> {
    file: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    argument: Option<&'a str>,
    #[serde(flatten)]
    place: Option<Extent>,
    severity: &'static str,
    code: &'static str,
    message: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    remedy: Option<&'a str>,
}

#[derive(Serialize)]
struct Extent {
    line: usize,
    column: usize,
    end_line: usize,
    end_column: usize,
}

impl<'a> Report<'a> {
    fn new(finding: &'a Finding) -> Self {
        Self {
            file: &finding.file,
            argument: finding.argument.as_deref(),
            place: finding.from.zip(finding.to).map(|(from, to)| Extent {
                line: from.line,
                column: from.column,
                end_line: to.line,
                end_column: to.column,
            }),
            severity: finding.severity.name(),
            code: finding.code,
            message: &finding.message,
            remedy: finding.remedy.as_deref(),
        }
    }
}
