//! Level 7: the command line. One file per verb; the only place that says `clap`.
//!
//! stdout carries results, stderr errors. Exit code 0: done; 1: it failed while running;
//! 2: the command, the scene or the file it names is wrong, and nothing was recorded.

mod check;
mod compare;
mod cost;
mod diagnose;
mod explain;
mod inspect;
mod lists;
mod mass;
mod new;
mod print;
mod recover;
mod run;
mod scenes;
mod schema;
mod stop;
mod verify;
mod view;

use crate::cost::PlanError;
use crate::live::page::PageError;
use crate::record::{InspectError, ReadError, RecordError};
use crate::scene::SceneError;
use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// A live visual debugger for rigid-body rotation.
///
/// Steps a scripted scene and records every body's pose, torque, angular acceleration and world
/// inertia, to be scrubbed through in the viewer that this program carries.
#[derive(Parser)]
#[command(
    name = "torquescope",
    version,
    after_help = "Start with: torquescope run @cone --view"
)]
struct Arguments {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Subcommand)]
enum Verb {
    Run(run::Arguments),
    Cost(cost::Arguments),
    View(view::Arguments),
    Recover(recover::Arguments),
    Inspect(inspect::Arguments),
    Compare(compare::Arguments),
    Diagnose(diagnose::Arguments),
    Check(check::Arguments),
    New(new::Arguments),
    Scenes(scenes::Arguments),
    Mass(mass::Arguments),
    Schema(schema::Arguments),
    /// List the integration methods: order, what they preserve, citation.
    Methods(lists::MethodArguments),
    /// List the effects that a scene's [effects] can name.
    Effects(lists::Arguments),
    /// List the streams that a scene's [record] can choose, with unit and frame.
    Streams(lists::Arguments),
    /// List the solids that a body's shape can name.
    Solids(lists::Arguments),
}

/// The whole program.
pub fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let done = match arguments.verb {
        Verb::Run(arguments) => run::run(&arguments),
        Verb::Cost(arguments) => cost::run(&arguments),
        Verb::View(arguments) => view::run(&arguments),
        Verb::Recover(arguments) => recover::run(&arguments),
        Verb::Inspect(arguments) => inspect::run(&arguments),
        Verb::Compare(arguments) => compare::run(&arguments),
        Verb::Diagnose(arguments) => diagnose::run(&arguments),
        Verb::Check(arguments) => check::run(&arguments),
        Verb::New(arguments) => new::run(&arguments),
        Verb::Scenes(arguments) => scenes::run(&arguments),
        Verb::Mass(arguments) => mass::run(&arguments),
        Verb::Schema(arguments) => schema::run(&arguments),
        Verb::Methods(arguments) => lists::methods(&arguments),
        Verb::Effects(arguments) => lists::effects(&arguments),
        Verb::Streams(arguments) => lists::streams(&arguments),
        Verb::Solids(arguments) => lists::solids(&arguments),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            if let Some(&Told(code)) = error.downcast_ref() {
                return ExitCode::from(code);
            }
            print::err(&format!("{error:#}"));
            ExitCode::from(code(&error))
        }
    }
}

/// The command or what it names is wrong.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct Wrong(String);

/// What there is to say has been said; the exit code is this.
#[derive(Debug, thiserror::Error)]
#[error("exit code {0}")]
struct Told(u8);

fn code(error: &anyhow::Error) -> u8 {
    let record = error.downcast_ref::<RecordError>();
    let nowhere = record.is_some_and(|error| !matches!(error, RecordError::Write { .. }));
    let input = error.is::<SceneError>()
        || matches!(error.downcast_ref(), Some(PlanError::BeyondReach { .. }))
        || error.is::<ReadError>()
        || error.is::<InspectError>()
        || error.is::<Wrong>()
        || error.is::<PageError>();
    if input || nowhere { 2 } else { 1 }
}
