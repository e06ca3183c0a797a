//! `scenes`: what there is to run.

use super::{Wrong, print};
use crate::scene::Scene;
use std::path::{Path, PathBuf};

/// List the scenes in a folder, with their titles.
#[derive(clap::Args)]
#[command(after_help = "Example: torquescope scenes")]
pub struct Arguments {
    /// The folder.
    #[arg(default_value = "scenes")]
    folder: PathBuf,
}

pub fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let folder = &arguments.folder;
    let entries = std::fs::read_dir(folder).map_err(|error| {
        Wrong(format!(
            "{}: cannot be read: {error}; name a folder of scenes",
            folder.display()
        ))
    })?;
    let is_scene = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "toml");
    let mut paths: Vec<PathBuf> = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(is_scene)
        .collect();
    paths.sort();
    if paths.is_empty() {
        return Err(Wrong(format!(
            "{}: holds no scenes (.toml files)",
            folder.display()
        ))
        .into());
    }
    let rows = paths
        .iter()
        .map(|path| vec![path.display().to_string(), title(path)])
        .collect();
    print::out(&print::table(&["scene", "title"], rows))
}

fn title(path: &Path) -> String {
    match Scene::load(path) {
        Ok(scene) => scene.title,
        Err(_) => format!("wrong: see `torquescope check {}`", path.display()),
    }
}
