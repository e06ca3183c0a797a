//! `check SCENE…`: read scenes and say what is wrong with them.

use super::print;
use crate::scene::{Scene, SceneError};
use std::path::PathBuf;

/// Check scenes without running them.
#[derive(clap::Args)]
#[command(after_help = "Example: torquescope check scenes/*.toml")]
pub struct Arguments {
    /// Scene files.
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
}

pub fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let mut wrong: Vec<SceneError> = Vec::new();
    for path in &arguments.scenes {
        match Scene::load(path) {
            Ok(scene) => print::out(&format!(
                "{}: ok; bodies: {}, events: {}; {} s by {} in steps of {} s",
                path.display(),
                scene.bodies.len(),
                scene.events.len(),
                scene.duration,
                scene.stepping.name(),
                scene.step
            ))?,
            Err(error) => wrong.push(error),
        }
    }
    let Some(last) = wrong.pop() else {
        return Ok(());
    };
    for error in wrong {
        print::err(&error.to_string());
    }
    Err(last.into())
}
