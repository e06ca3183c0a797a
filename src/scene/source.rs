//! Where a scene's text comes from: a file, or the program itself.

use super::carried::CARRIED;
use super::table::nearest;
use super::{Finding, Problems, Scene, SceneError};
use std::io::Read as _;
use std::path::Path;

/// The text of a scene that has not been checked.
#[derive(Clone, Debug)]
pub struct Source {
    /// As messages call it.
    pub file: String,
    /// As the scene is called: the file's name without its ending.
    pub name: String,
    pub text: String,
}

impl Source {
    /// Reads a scene file, or takes a scene that the program carries, such as `@cone`.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let file = path.display().to_string();
        if let Some(name) = file.strip_prefix('@') {
            return Self::carried(name);
        }
        let text = read_to_string(path).map_err(|error| SceneError::Unreadable {
            why: error.to_string(),
            remedy: remedy_for(path, &error),
            file: file.clone(),
        })?;
        let name = path.file_stem().map_or_else(
            || "scene".to_owned(),
            |stem| stem.to_string_lossy().into_owned(),
        );
        Ok(Self { file, name, text })
    }

    fn carried(name: &str) -> Result<Self, SceneError> {
        let file = format!("@{name}");
        match CARRIED.iter().find(|(known, _)| *known == name) {
            Some((name, text)) => Ok(Self {
                file,
                name: (*name).to_owned(),
                text: (*text).to_owned(),
            }),
            None => {
                let names: Vec<String> =
                    CARRIED.iter().map(|(name, _)| format!("@{name}")).collect();
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                let remedy = nearest(&file, &names);
                Err(SceneError::Unreadable {
                    file,
                    why: "no scene of this name is carried".to_owned(),
                    remedy,
                })
            }
        }
    }

    /// Checks it.
    pub fn scene(&self) -> Result<Scene, Problems> {
        Scene::parse(&self.file, &self.name, &self.text)
    }

    /// Checks and judges it: see [`Scene::judge`].
    pub fn judge(&self) -> Result<(Scene, Vec<Finding>), Problems> {
        Scene::judge(&self.file, &self.name, &self.text)
    }
}

/// A scene's bytes at most: 10,000 bodies take two million, and while it is read each byte a hundred.
pub(super) const LARGEST: u64 = 1 << 23;

fn read_to_string(path: &Path) -> std::io::Result<String> {
    let mut source = String::new();
    let file = std::fs::File::open(path)?;
    // By what the file says of itself before a byte of it is read; a pipe says nothing.
    let said = file.metadata()?.len();
    if said > LARGEST || file.take(LARGEST + 1).read_to_string(&mut source)? as u64 > LARGEST {
        let why = format!("it is larger than any scene ({LARGEST} bytes)");
        return Err(std::io::Error::other(why));
    }
    Ok(source)
}

fn remedy_for(path: &Path, error: &std::io::Error) -> String {
    if error.kind() == std::io::ErrorKind::InvalidData {
        return "a scene is a text in UTF-8".to_owned();
    }
    if path.is_dir() {
        return "name a scene file, not a folder".to_owned();
    }
    if error.kind() != std::io::ErrorKind::NotFound {
        return "a scene is a TOML file that you may read".to_owned();
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let scenes: Vec<String> = std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .filter(|name| name.ends_with(".toml") && name != "Cargo.toml")
        .collect();
    let wanted = path.file_name().unwrap_or_default().to_string_lossy();
    match scenes.iter().map(String::as_str).collect::<Vec<_>>() {
        names if names.is_empty() => "`torquescope scenes` lists the scenes there are".to_owned(),
        mut names => {
            names.sort_unstable();
            nearest(&wanted, &names)
        }
    }
}
