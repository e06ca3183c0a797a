//! `scenes`: what there is to run.

use super::{Wrong, print};
use crate::scene::Scene;
use crate::scene::carried::{CARRIED, Carried};
use std::path::{Path, PathBuf};

/// List the scenes that the program carries, or those in a folder, with their titles.
///
/// A carried scene runs anywhere: torquescope run @cone. `torquescope new my_cone --from @cone` makes a
/// copy to change.
#[derive(clap::Args)]
#[command(after_help = "Example: torquescope scenes")]
pub struct Arguments {
    /// A folder of scenes.
    folder: Option<PathBuf>,
}

pub fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let rows = match &arguments.folder {
        Some(folder) => in_folder(folder)?,
        None => {
            let row = |scene: &Carried| {
                let file = format!("@{}", scene.name);
                let title = title(Path::new(&file));
                vec![file, title]
            };
            CARRIED.iter().map(row).collect()
        }
    };
    print::out(&print::table(&["scene", "title"], rows))
}

fn in_folder(folder: &Path) -> anyhow::Result<Vec<Vec<String>>> {
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
    let row = |path: &PathBuf| vec![path.display().to_string(), title(path)];
    Ok(paths.iter().map(row).collect())
}

fn title(path: &Path) -> String {
    match Scene::load(path) {
        Ok(scene) => scene.title,
        Err(_) => format!("wrong: see `torquescope check {}`", path.display()),
    }
}
