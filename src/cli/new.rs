//! `new NAME`: a scene to start from.

use super::{Wrong, print, schema};
use crate::scene::{Enclosure, Script};
use std::fs::OpenOptions;
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

/// Write a commented scene that runs: NAME.toml.
///
/// Beside it goes scene.schema.json, where there is none: an editor with a TOML language server completes
/// and checks the scene by it. The files that a copied scene names go there too. Nothing is overwritten.
#[derive(clap::Args)]
#[command(after_help = "Example: torquescope new my_top")]
pub struct Arguments {
    /// Its name, or where it goes: my_top, or tests/my_top.toml.
    name: PathBuf,
    /// Copy this scene instead: a carried one such as @cone, or a file.
    #[arg(long, value_name = "SCENE")]
    from: Option<PathBuf>,
    /// Write no schema.
    #[arg(long)]
    no_schema: bool,
}

/// The scene to start from.
const TEMPLATE: &str = include_str!("new.toml");
const SCHEMA: &str = "scene.schema.json";

pub fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let path = place(&arguments.name)?;
    let (text, files) = match &arguments.from {
        Some(from) => {
            let script = Script::load(from)?;
            // Of a scene that is wrong, whatever it is copied for, the text.
            let files = script.scene().map(|scene| scene.enclosures);
            (script.text().to_owned(), files.unwrap_or_default())
        }
        None => (TEMPLATE.to_owned(), Vec::new()),
    };
    let line = format!("#:schema ./{SCHEMA}\n");
    let text = match text.starts_with("#:schema") || arguments.no_schema {
        true => text,
        false => line + &text,
    };
    if !written(&path, text.as_bytes())? {
        let message = format!(
            "{} exists; choose another name, so that it is not lost",
            path.display()
        );
        return Err(Wrong(message).into());
    }
    let mut said = format!("{}: written", path.display());
    for file in &files {
        said += &enclosed(&path, file)?;
    }
    let beside = path.with_file_name(SCHEMA);
    if !arguments.no_schema {
        said += &match written(&beside, schema::text().as_bytes())? {
            true => format!("\n{}: written, for editors", beside.display()),
            false if is_current(&beside) => String::new(),
            false => format!(
                "\n{}: kept, but of another version; `torquescope schema > {0}` writes it anew",
                beside.display()
            ),
        };
    }
    let shown = path.display();
    said += &format!(
        "\nto run it: torquescope run {shown} --view   to check it: torquescope check {shown}"
    );
    print::out(&said)
}

/// A file that the scene names goes beside it, where its name stays in that folder.
fn enclosed(scene: &Path, file: &Enclosure) -> anyhow::Result<String> {
    let path = scene.with_file_name(&file.name);
    if Path::new(&file.name).file_name() != Some(file.name.as_ref()) {
        return Ok(format!(
            "\n{}: named by the scene, and not copied; write its path anew",
            file.name
        ));
    }
    let there = |path: &Path| std::fs::read(path).is_ok_and(|bytes| *bytes == *file.bytes);
    Ok(match written(&path, &file.bytes)? {
        true => format!("\n{}: written", path.display()),
        false if there(&path) => String::new(),
        false => format!(
            "\n{}: kept, but of another content than the scene is copied with",
            path.display()
        ),
    })
}

/// The file that is meant.
fn place(name: &Path) -> anyhow::Result<PathBuf> {
    let wrong = |why: &str| Wrong(format!("{}: {why}", name.display()));
    let Some(file) = name.file_name() else {
        return Err(wrong("is no name for a scene; write one such as my_top").into());
    };
    if name.to_string_lossy().starts_with('@') {
        return Err(wrong(
            "names a carried scene; write the new one's name, and --from the carried one",
        )
        .into());
    }
    let mut file = file.to_owned();
    if name.extension().is_none_or(|ending| ending != "toml") {
        file.push(".toml");
    }
    Ok(name.with_file_name(file))
}

/// Writes a file that does not exist; whether it could.
fn written(path: &Path, bytes: &[u8]) -> anyhow::Result<bool> {
    let cannot = |error: std::io::Error| {
        Wrong(format!(
            "{}: cannot be written: {error}; choose another place",
            path.display()
        ))
    };
    match OpenOptions::new().write(true).create_new(true).open(path) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => Ok(false),
        file => {
            file.and_then(|mut file| file.write_all(bytes))
                .map_err(cannot)?;
            Ok(true)
        }
    }
}

fn is_current(path: &Path) -> bool {
    std::fs::read_to_string(path).is_ok_and(|text| text == schema::text())
}
