//! `view FILE`: open a recording, in a native Rerun of the same version or in the carried viewer.

use super::{Wrong, print};
use crate::live::page::Page;
use crate::record::{Assets, MAGIC, RERUN_VERSION, native_version_line};
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Open a recording.
///
/// Uses a native `rerun` of the same version where one is on the PATH and there is a screen;
/// otherwise the viewer that this program carries, served to a browser from this machine only.
#[derive(clap::Args)]
#[command(after_help = "Example: torquescope view cone.rrd")]
pub struct Arguments {
    /// The recording, an .rrd file.
    file: PathBuf,
    /// Use the carried viewer even where there is a native one.
    #[arg(long)]
    web: bool,
    #[command(flatten)]
    serve: Serving,
}

impl Serving {
    /// Whether anything was asked for.
    pub fn is_asked_for(&self) -> bool {
        self.port != 0 || self.no_browser
    }
}

/// How the carried viewer is served.
#[derive(clap::Args)]
pub struct Serving {
    /// Port on 127.0.0.1; 0 takes a free one.
    #[arg(long, default_value_t = 0)]
    port: u16,
    /// Print the address and open no browser.
    #[arg(long)]
    no_browser: bool,
}

pub fn run(arguments: &Arguments) -> anyhow::Result<()> {
    must_be_recording(&arguments.file)?;
    if !arguments.web && has_screen() && has_native() {
        print::out(&format!(
            "opening {} in rerun {RERUN_VERSION}",
            arguments.file.display()
        ))?;
        let status = Command::new("rerun").arg(&arguments.file).status()?;
        anyhow::ensure!(
            status.success(),
            "rerun ended with {status}; --web uses the carried viewer"
        );
        return Ok(());
    }
    serve(
        &bind(&arguments.file, &arguments.serve)?,
        &arguments.serve,
        false,
    )
}

/// Takes the port, before anything long is begun.
pub fn bind(file: &Path, serving: &Serving) -> anyhow::Result<Page> {
    Ok(Page::bind(serving.port, file, Assets::load()?)?)
}

/// Serves a recording with the carried viewer until the program is stopped. The address goes to
/// stderr where stdout is taken.
pub fn serve(page: &Page, serving: &Serving, stdout_taken: bool) -> anyhow::Result<()> {
    let address = page.address();
    let line = format!(
        "{} is at {address}  (Ctrl-C stops)",
        page.recording().display()
    );
    if stdout_taken {
        print::err(&line);
    } else {
        print::out(&line)?;
    }
    if !serving.no_browser && has_screen() && webbrowser::open(&address).is_err() {
        print::err("no browser opened by itself; open the address above in one");
    }
    page.serve();
    Ok(())
}

fn must_be_recording(file: &Path) -> anyhow::Result<()> {
    let wrong = |why: String| Wrong(format!("{}: {why}", file.display()));
    if file.to_string_lossy().starts_with('@') {
        let why = "is a scene, no recording; `torquescope run SCENE --view` records and opens it";
        return Err(wrong(why.to_owned()).into());
    }
    let mut magic = [0; 4];
    let read = std::fs::File::open(file).and_then(|mut file| file.read_exact(&mut magic));
    match read {
        Ok(()) if &magic == MAGIC => Ok(()),
        Err(error) if error.kind() != std::io::ErrorKind::UnexpectedEof => Err(wrong(format!(
            "cannot be read: {error}; `torquescope run SCENE` makes recordings"
        ))
        .into()),
        _ => Err(wrong(
            "is no Rerun recording; `torquescope run SCENE` makes one from a scene".to_owned(),
        )
        .into()),
    }
}

/// A browser or a native window has nowhere to open without one.
fn has_screen() -> bool {
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    cfg!(any(target_os = "macos", target_os = "windows"))
        || set("DISPLAY")
        || set("WAYLAND_DISPLAY")
}

fn has_native() -> bool {
    let output = Command::new("rerun").arg("--version").output();
    output.is_ok_and(|output| native_version_line(&String::from_utf8_lossy(&output.stdout)))
}
