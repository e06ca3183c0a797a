//! What can happen to a recording: killed runs, signals, full disks, names that are taken, changed bytes.
#![cfg(all(feature = "cli", unix))]

use assert_cmd::cargo::cargo_bin;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use torquescope::math::draw;
use torquescope::record::{self, Destination, Heading, ReadError, Recorder};
use torquescope::scene::Scene;
use torquescope::sim::Simulation;
use torquescope::trace::{self, Note, Sample, Sink, SinkError, Track};

/// Short, with a push.
const SHORT: &str = "duration = 0.5\n[effects]\ngyroscopic = true\n[[body]]\nname = \"a\"\nmass = 1.0\ninertia = [1, 2, 2.5]\nangular_velocity = [1, 0.1, 0]\n[[event]]\nat = 0.05\nfor = 0.2\nbody = \"a\"\nforce = [0, 0, 3.0]\npoint = { body = [0.5, 0.1, 0] }\n";

/// Some 1e8 rows: it ends when it is made to.
fn endless() -> String {
    let more =
        "duration = 1e5\n[record]\nstate = \"every\"\n[stepping]\nstep = 1e-3\nmethod = \"rk4\"";
    SHORT.replace("duration = 0.5", more)
}

fn folder_with(scene: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("s.toml"), scene).unwrap();
    folder
}

fn torquescope(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(cargo_bin("torquescope"));
    command.current_dir(folder).args(arguments);
    command
}

fn output(folder: &Path, arguments: &[&str]) -> Output {
    torquescope(folder, arguments).output().unwrap()
}

fn said(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A run that has begun to write.
fn begun(folder: &Path, arguments: &[&str]) -> Child {
    let child = torquescope(folder, arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let partial = folder.join("s.partial.rrd");
    // The scene is in it by then, and rows.
    wait_for(|| std::fs::metadata(&partial).is_ok_and(|data| data.len() > 1_500_000));
    child
}

fn wait_for(is: impl Fn() -> bool) {
    let start = Instant::now();
    while !is() {
        assert!(
            start.elapsed() < Duration::from_secs(60),
            "it does not come"
        );
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn signal(child: &Child, name: &str) {
    let sent = Command::new("kill")
        .args([name, &child.id().to_string()])
        .status();
    assert!(sent.unwrap().success());
}

fn flaw(path: &Path) -> Option<String> {
    match record::read(path) {
        Ok(made) => made.cut,
        Err(ReadError::Cut { why, .. }) => Some(why),
        Err(other) => Some(other.to_string()),
    }
}

#[test]
fn two_runs_give_the_same_file() {
    let folder = folder_with(SHORT);
    for scene in ["s.toml", "@cone", "@t_handle"] {
        let mut files = Vec::new();
        for name in ["one.rrd", "two.rrd", "three.rrd"] {
            let done = output(folder.path(), &["run", scene, "--out", name, "--force"]);
            assert!(done.status.success(), "{}", said(&done.stderr));
            files.push(std::fs::read(folder.path().join(name)).unwrap());
        }
        assert!(files[0] == files[1] && files[1] == files[2], "{scene}");
    }
}

#[test]
fn a_name_that_is_taken_is_asked_for() {
    let folder = folder_with(SHORT);
    let run = |more: &[&str]| output(folder.path(), &[&["run", "s.toml"], more].concat());
    assert!(run(&[]).status.success());
    let again = run(&[]);
    assert_eq!(again.status.code(), Some(2));
    assert_eq!(
        said(&again.stderr),
        "s.rrd exists; --force replaces it, or choose another name\n"
    );
    assert!(again.stdout.is_empty());
    assert!(run(&["--force"]).status.success());
    let files = std::fs::read_dir(folder.path()).unwrap();
    assert_eq!(files.count(), 2);
}

#[test]
fn one_run_does_not_write_over_another_that_goes_on() {
    let folder = folder_with(&endless());
    let mut first = begun(folder.path(), &["run", "s.toml"]);
    let second = output(folder.path(), &["run", "s.toml", "--force"]);
    assert_eq!(second.status.code(), Some(2));
    assert!(said(&second.stderr).contains("s.partial.rrd is being written by another torquescope"));
    let recovering = output(folder.path(), &["recover", "s.partial.rrd"]);
    assert_eq!(recovering.status.code(), Some(2));
    assert!(said(&recovering.stderr).contains("is being written by another torquescope"));
    first.kill().unwrap();
    first.wait().unwrap();
    // Nor over what it left.
    let third = output(folder.path(), &["run", "s.toml"]);
    assert_eq!(third.status.code(), Some(2));
    assert!(said(&third.stderr).contains("`torquescope recover s.partial.rrd` makes a whole"));
}

/// At moments from before the file is there to well within it, by seed: 40, or `TORQUESCOPE_KILLS`.
#[test]
fn whatever_the_moment_a_killed_run_leaves_what_can_be_made_whole() {
    let folder = folder_with(&endless());
    let partial = folder.path().join("s.partial.rrd");
    let whole = folder.path().join("s.rrd");
    // From before there is a file to when there are many rows in it.
    let rows = || std::fs::metadata(&partial).is_ok_and(|data| data.len() > 400_000);
    let start = Instant::now();
    let mut first = torquescope(folder.path(), &["run", "s.toml", "--save-every", "0.01"])
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    wait_for(rows);
    let longest = 1.5 * start.elapsed().as_secs_f64();
    first.kill().unwrap();
    first.wait().unwrap();
    let mut opened = 0;
    let kills = std::env::var("TORQUESCOPE_KILLS").map_or(40, |n| n.parse().unwrap());
    for k in 0..kills {
        let mut child = torquescope(
            folder.path(),
            &["run", "s.toml", "--force", "--save-every", "0.01"],
        )
        .stderr(Stdio::null())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
        std::thread::sleep(Duration::from_secs_f64(longest * draw::unit(11, k)));
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(!whole.exists(), "{k}: it has its name before it is whole");
        if !partial.exists() {
            continue;
        }
        let recovered = output(folder.path(), &["recover", "s.partial.rrd", "--json"]);
        let why = said(&recovered.stderr);
        match recovered.status.code() {
            Some(2) => assert!(
                why.contains("there is nothing in it yet") || why.contains("is no Rerun recording"),
                "{k}: {why}"
            ),
            Some(0) => {
                opened += 1;
                let report: serde_json::Value = serde_json::from_slice(&recovered.stdout).unwrap();
                assert!(report["rows"].as_u64().unwrap() > 0, "{k}");
                assert_eq!(flaw(&whole), None, "{k}");
                assert!(!partial.exists(), "{k}");
                std::fs::remove_file(&whole).unwrap();
            }
            other => panic!("{k}: exit code {other:?}: {why}"),
        }
        let _ = std::fs::remove_file(&partial);
    }
    // Most moments are within the run.
    assert!(opened >= kills / 4, "{opened} of {kills}");
}

/// Records, and looks at every so many instants at what a killed program would leave.
struct Watched {
    recorder: Recorder,
    partial: PathBuf,
    folder: PathBuf,
    every: usize,
    seen: usize,
    looked: usize,
}

impl Sink for Watched {
    fn motions(&mut self, track: &Track<'_>) -> Result<(), SinkError> {
        self.recorder.motions(track)
    }

    fn samples(
        &mut self,
        at: trace::Instant,
        bodies: Range<usize>,
        samples: &[Sample],
    ) -> Result<(), SinkError> {
        self.recorder.samples(at, bodies, samples)?;
        self.seen += 1;
        if !self.seen.is_multiple_of(self.every) {
            return Ok(());
        }
        self.looked += 1;
        let copy = self.folder.join("copy.rrd");
        std::fs::copy(&self.partial, &copy).unwrap();
        let to = Destination::new(self.folder.join("copy-recovered.rrd")).replacing(true);
        let found = record::recover(&copy, &to).unwrap();
        // States come before what is derived of them.
        assert!(found.until >= at.time, "{} s at {} s", found.until, at.time);
        assert_eq!(found.cut, 0);
        let again = Destination::new(self.folder.join("again.rrd"));
        assert_eq!(record::recover(&to.path, &again).unwrap().flaw, None);
        Ok(())
    }

    fn note(&mut self, at: trace::Instant, note: &Note) -> Result<(), SinkError> {
        self.recorder.note(at, note)
    }
}

#[test]
fn what_waits_in_memory_is_in_the_file_in_time_and_leaves_no_trace_in_the_end() {
    let folder = folder_with(SHORT);
    let scene = Scene::load(&folder.path().join("s.toml")).unwrap();
    let mut files = Vec::new();
    // All at once, and as late as can be.
    for (name, keeps_up) in [("soon.rrd", Duration::ZERO), ("late.rrd", Duration::MAX)] {
        let simulation = Simulation::new(&scene);
        let subjects = simulation.subjects().to_vec();
        let heading = Heading::of(&scene, &simulation);
        let to = Destination {
            keeps_up,
            ..Destination::new(folder.path().join(name))
        };
        let mut watched = Watched {
            recorder: Recorder::create(&to, &heading, &subjects).unwrap(),
            partial: record::partial_name(&to.path),
            folder: folder.path().to_owned(),
            every: if keeps_up.is_zero() { 7 } else { usize::MAX },
            seen: 0,
            looked: 0,
        };
        simulation.run(&mut watched).1.unwrap();
        assert!(keeps_up > Duration::ZERO || watched.looked >= 4);
        watched.recorder.finish().unwrap();
        files.push(std::fs::read(&to.path).unwrap());
    }
    assert!(files[0] == files[1]);
}

#[test]
fn signals_finish_the_file() {
    for (name, code) in [("-INT", 130), ("-TERM", 143)] {
        let folder = folder_with(&endless());
        let child = begun(folder.path(), &["run", "s.toml"]);
        signal(&child, name);
        let done = child.wait_with_output().unwrap();
        let said = said(&done.stderr);
        assert_eq!(done.status.code(), Some(code), "{said}");
        assert!(said.contains("stopped at t = "), "{said}");
        assert!(!folder.path().join("s.partial.rrd").exists());
        assert_eq!(flaw(&folder.path().join("s.rrd")), None);
    }
}

#[test]
fn a_file_that_is_removed_while_it_is_written_is_there_in_the_end() {
    let folder = folder_with(&endless());
    let child = begun(folder.path(), &["run", "s.toml"]);
    std::fs::remove_file(folder.path().join("s.partial.rrd")).unwrap();
    std::thread::sleep(Duration::from_millis(100));
    signal(&child, "-INT");
    let done = child.wait_with_output().unwrap();
    assert_eq!(done.status.code(), Some(130), "{}", said(&done.stderr));
    assert_eq!(flaw(&folder.path().join("s.rrd")), None);
}

/// A good recording is not replaced by one of nothing.
#[cfg(target_os = "linux")]
#[test]
fn a_signal_while_planning_leaves_what_there_is() {
    let folder = folder_with(SHORT);
    assert!(output(folder.path(), &["run", "s.toml"]).status.success());
    let good = std::fs::read(folder.path().join("s.rrd")).unwrap();
    // A plan of many bodies takes seconds.
    let body = |k: usize| {
        format!(
            "[[body]]\nname = \"b{k}\"\nmass = 1.0\ninertia = [1, 2, 2.5]\nangular_velocity = [1, 0.{k}, 0]\n"
        )
    };
    let bodies: String = (1..200).map(body).collect();
    let slow = format!(
        "duration = 50.0\n[stepping]\naccuracy = 1e-11\n[effects]\ngravity = [0, -9.81, 0]\ngyroscopic = true\n{bodies}"
    );
    std::fs::write(folder.path().join("slow.toml"), slow).unwrap();
    for (name, code) in [("-INT", 130), ("-TERM", 143)] {
        let arguments = ["run", "slow.toml", "--out", "s.rrd", "--force"];
        let child = torquescope(folder.path(), &arguments)
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // It listens to signals where its status says so.
        let status = format!("/proc/{}/status", child.id());
        let catches = || {
            let status = std::fs::read_to_string(&status).unwrap_or_default();
            let line = status.lines().find(|line| line.starts_with("SigCgt:"));
            let bits = line.and_then(|line| u64::from_str_radix(line[7..].trim(), 16).ok());
            bits.is_some_and(|bits| bits >> 14 & 1 == 1)
        };
        wait_for(catches);
        std::thread::sleep(Duration::from_millis(20));
        signal(&child, name);
        let done = child.wait_with_output().unwrap();
        assert_eq!(done.status.code(), Some(code), "{}", said(&done.stderr));
        assert!(std::fs::read(folder.path().join("s.rrd")).unwrap() == good);
        assert!(!folder.path().join("s.partial.rrd").exists());
    }
}

#[test]
fn a_sweep_that_is_stopped_says_what_of_it_is_missing() {
    let more = "[sweep]\n\"body.a.mass\" = [1.0, 2.0, 3.0]\n";
    let folder = folder_with(&format!("{}{more}", endless()));
    let child = begun(folder.path(), &["run", "s.toml", "--json"]);
    signal(&child, "-INT");
    let done = child.wait_with_output().unwrap();
    let why = said(&done.stderr);
    assert_eq!(done.status.code(), Some(130), "{why}");
    assert!(why.contains("stopped at t = "), "{why}");
    let last = why.lines().last().unwrap();
    assert!(last.starts_with("not run: "), "{why}");
    assert!(
        last.contains("mass = 2") && last.contains("mass = 3"),
        "{why}"
    );
    assert!(!last.contains("mass = 1"), "{why}");
    let report: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    assert_eq!(report.as_array().unwrap().len(), 1);
}

/// A disk of one megabyte, in a name space of our own. Says whether there can be one here.
fn on_a_small_disk(folder: &Path, options: &str, then: &str) -> Option<Output> {
    let script = format!("mount -t tmpfs -o {options} tmpfs small && {{ {then}; }}");
    std::fs::create_dir(folder.join("small")).unwrap();
    let inside = |script: &str| {
        let mut command = Command::new("unshare");
        command.current_dir(folder).args([
            "--user",
            "--map-root-user",
            "--mount",
            "sh",
            "-c",
            script,
        ]);
        command.env("T", cargo_bin("torquescope"));
        command.output()
    };
    let can = inside("mount -t tmpfs tmpfs small").is_ok_and(|done| done.status.success());
    if !can {
        eprintln!("no disk of one's own can be mounted here: not tested");
        return None;
    }
    Some(inside(&script).unwrap())
}

#[test]
fn a_full_disk_is_told_and_what_is_there_is_kept() {
    let folder = folder_with(&endless());
    let then = "cd small; $T run ../s.toml; code=$?; ls; $T recover s.partial.rrd --out ../s.rrd; exit $code";
    let Some(done) = on_a_small_disk(folder.path(), "size=3m", then) else {
        return;
    };
    let (out, why) = (said(&done.stdout), said(&done.stderr));
    assert_eq!(done.status.code(), Some(1), "{why}");
    assert!(
        why.starts_with("s.rrd: writing stopped: No space left on device (os error 28); make room there, or record fewer streams or less often; what was recorded until then is in "),
        "{why}"
    );
    assert!(
        out.contains("s.partial.rrd\n") && !out.contains("\ns.rrd\n"),
        "{out}"
    );
    assert_eq!(flaw(&folder.path().join("s.rrd")), None);
}

#[test]
fn a_device_that_is_full_is_told() {
    if !Path::new("/dev/full").exists() {
        return;
    }
    let folder = folder_with(SHORT);
    let done = output(folder.path(), &["run", "s.toml", "--out", "/dev/full"]);
    let why = said(&done.stderr);
    assert_eq!(done.status.code(), Some(1), "{why}");
    assert!(
        why.starts_with("/dev/full: writing stopped: No space left on device"),
        "{why}"
    );
}

#[test]
fn a_disk_that_is_only_read_is_told_before_anything_is_computed() {
    let folder = folder_with(&endless());
    let Some(done) = on_a_small_disk(folder.path(), "ro", "cd small; $T run ../s.toml") else {
        return;
    };
    let why = said(&done.stderr);
    assert_eq!(done.status.code(), Some(2), "{why}");
    assert!(
        why.contains("cannot be written: Read-only file system"),
        "{why}"
    );
}

#[test]
fn a_reader_that_has_seen_enough_is_no_failure() {
    let folder = folder_with(SHORT);
    let mut child = torquescope(folder.path(), &["run", "s.toml", "--explain"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    assert!(child.wait().unwrap().success());
    assert_eq!(flaw(&folder.path().join("s.rrd")), None);
}

fn recording(scene: &str) -> (tempfile::TempDir, PathBuf, Vec<u8>) {
    let folder = folder_with(scene);
    let done = output(folder.path(), &["run", "s.toml"]);
    assert!(done.status.success(), "{}", said(&done.stderr));
    let path = folder.path().join("s.rrd");
    let bytes = std::fs::read(&path).unwrap();
    (folder, path, bytes)
}

/// Where the message before the footer is: each begins with its kind, 0 for the end, and its length.
fn last_message(bytes: &[u8]) -> Range<usize> {
    let number = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
    let (mut before, mut at) = (12, 12);
    while number(at) != 0 {
        before = at;
        at += 16 + number(at + 8);
    }
    before..at
}

#[test]
fn no_changed_byte_passes() {
    let few = format!("{SHORT}[record]\nstreams = [\"torque\", \"omega\"]\n");
    let (_folder, path, bytes) = recording(&few);
    assert_eq!(flaw(&path), None);
    // Everywhere, and every byte of the head and of the end.
    let anywhere = (0..80).map(|k| (draw::unit(7, k) * bytes.len() as f64) as usize);
    let ends = bytes.len() - 32..bytes.len();
    let places = anywhere.chain(0..12).chain(ends);
    // The last checksums are of what comes before them, and of no use to anybody.
    let last = last_message(&bytes);
    for place in places.filter(|place| !last.contains(place)) {
        let mut changed = bytes.clone();
        changed[place] ^= 1 << (place % 8);
        std::fs::write(&path, &changed).unwrap();
        assert!(flaw(&path).is_some(), "byte {place} of {}", bytes.len());
    }
}

#[test]
fn no_cut_passes() {
    let (_folder, path, bytes) = recording(SHORT);
    for k in 0..50 {
        let length = (draw::unit(8, k) * bytes.len() as f64) as usize;
        std::fs::write(&path, &bytes[..length]).unwrap();
        assert!(flaw(&path).is_some(), "{length} of {}", bytes.len());
    }
}

#[test]
fn what_is_damaged_is_left_out_and_the_rest_recovered() {
    let (folder, path, mut bytes) = recording(SHORT);
    let middle = bytes.len() / 2;
    bytes[middle] ^= 64;
    std::fs::write(&path, &bytes).unwrap();
    let done = output(folder.path(), &["recover", "s.rrd"]);
    let out = said(&done.stdout);
    assert_eq!(done.status.code(), Some(1), "{out}");
    assert!(
        out.contains("of it are not those that were written"),
        "{out}"
    );
    assert!(
        out.contains(
            "left out, because their bytes are not those that were written: 1 of its chunks"
        ),
        "{out}"
    );
    assert!(path.exists());
    assert_eq!(flaw(&folder.path().join("s-recovered.rrd")), None);
    let whole = output(folder.path(), &["recover", "s-recovered.rrd"]);
    assert!(whole.status.success());
    assert!(said(&whole.stdout).ends_with("is whole; there is nothing to recover\n"));
}

/// A head that is not as it was written hides all that follows: what is there is taken, and nothing away.
#[test]
fn a_partial_file_that_cannot_be_read_to_its_end_stays() {
    let more = "duration = 60.0\n[record]\nstate = \"every\"";
    let (folder, path, bytes) = recording(&SHORT.replace("duration = 0.5", more));
    let partial = record::partial_name(&path);
    std::fs::remove_file(&path).unwrap();
    let number = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
    let mut at = 12;
    while at < bytes.len() / 4 {
        at += 16 + number(at + 8);
    }
    assert!(bytes.len() - at > 2 << 20, "{}", bytes.len());
    // Its kind, and its length.
    for (place, value) in [(at, 0x40), (at + 12, 1)] {
        let mut broken = bytes.clone();
        broken[place] ^= value;
        std::fs::write(&partial, &broken).unwrap();
        let done = output(folder.path(), &["recover", "s.partial.rrd", "--force"]);
        let out = said(&done.stdout);
        assert_eq!(done.status.code(), Some(1), "{out}");
        assert!(
            out.contains("there may be more in it than could be read; it stays as it is"),
            "{out}"
        );
        assert_eq!(std::fs::read(&partial).unwrap(), broken);
        assert_eq!(flaw(&path), None);
    }
}

/// Rows that were only written ahead of time are there when the recorder goes before its time.
#[test]
fn rows_written_ahead_of_time_are_kept() {
    let folder = folder_with(SHORT);
    // Nothing happens, so that no row is settled.
    let scene = "duration = 0.1\n[[body]]\nname = \"a\"\nmass = 1.0\ninertia = [1, 1, 1]\n";
    let scene = Scene::parse("still", "still", scene).unwrap();
    let simulation = Simulation::new(&scene);
    let heading = Heading::of(&scene, &simulation);
    let to = Destination {
        keeps_up: Duration::ZERO,
        ..Destination::new(folder.path().join("s.rrd"))
    };
    let subjects = simulation.subjects().to_vec();
    let mut recorder = Recorder::create(&to, &heading, &subjects).unwrap();
    simulation.run(&mut recorder).1.unwrap();
    drop(recorder);
    let partial = record::partial_name(&to.path);
    let found = record::recover(&partial, &to).unwrap();
    assert!(found.rows > 0 && found.until == 0.1, "{found:?}");
}

/// All that a run was killed before is the name.
#[test]
fn a_whole_file_that_lacks_its_name_gets_it() {
    let (folder, path, bytes) = recording(SHORT);
    let partial = record::partial_name(&path);
    std::fs::rename(&path, &partial).unwrap();
    let run = output(folder.path(), &["run", "s.toml"]);
    assert_eq!(run.status.code(), Some(2));
    assert!(said(&run.stderr).contains("`torquescope recover s.partial.rrd` makes a whole"));
    std::fs::write(&path, "a letter").unwrap();
    let occupied = output(folder.path(), &["recover", "s.partial.rrd", "--force"]);
    assert_eq!(occupied.status.code(), Some(2));
    std::fs::remove_file(&path).unwrap();
    let done = output(folder.path(), &["recover", "s.partial.rrd"]);
    let out = said(&done.stdout);
    assert!(done.status.success(), "{}", said(&done.stderr));
    assert!(
        out.starts_with("s.partial.rrd: is whole, and lacked only its name\ns.rrd: "),
        "{out}"
    );
    assert!(std::fs::read(&path).unwrap() == bytes);
    assert!(!partial.exists());
}

/// `run` and `recover` agree on what a killed run has left.
#[test]
fn a_partial_file_with_nothing_in_it_is_in_nobodys_way() {
    let (folder, path, bytes) = recording(SHORT);
    let partial = record::partial_name(&path);
    std::fs::remove_file(&path).unwrap();
    for length in [0, 3, 12, 500] {
        std::fs::write(&partial, &bytes[..length]).unwrap();
        let done = output(folder.path(), &["recover", "s.partial.rrd"]);
        assert_eq!(done.status.code(), Some(2), "{length}");
        let done = output(folder.path(), &["run", "s.toml"]);
        assert!(done.status.success(), "{length}: {}", said(&done.stderr));
        assert!(std::fs::read(&path).unwrap() == bytes);
        std::fs::remove_file(&path).unwrap();
    }
    // What cannot be read is not known to be nothing.
    let mut broken = bytes[..500].to_vec();
    broken[12] = 0x40;
    std::fs::write(&partial, &broken).unwrap();
    let done = output(folder.path(), &["recover", "s.partial.rrd"]);
    assert_eq!(done.status.code(), Some(2));
    let why = said(&done.stderr);
    assert!(
        why.contains("nothing that was simulated can be read of it"),
        "{why}"
    );
    assert_eq!(
        output(folder.path(), &["run", "s.toml"]).status.code(),
        Some(2)
    );
    let done = output(folder.path(), &["run", "s.toml", "--force"]);
    assert!(done.status.success());
    assert_eq!(
        said(&done.stderr),
        "s.partial.rrd was left by a run that was killed; --force writes over it\n"
    );
}

/// What a run says that fails with exit code 1 because no file may be larger than so many blocks of 512 bytes.
fn without_room(folder: &Path, blocks: u32, arguments: &str) -> String {
    // That a file is too large is no signal.
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec $T {arguments}");
    let done = Command::new("sh")
        .current_dir(folder)
        .args(["-c", &script])
        .env("T", cargo_bin("torquescope"))
        .output()
        .unwrap();
    let why = said(&done.stderr);
    assert_eq!(done.status.code(), Some(1), "{why}");
    why
}

#[test]
fn a_recovery_that_fails_leaves_nothing() {
    let (folder, _, bytes) = recording(&SHORT.replace("duration = 0.5", "duration = 5.0"));
    let cut = folder.path().join("cut.rrd");
    std::fs::write(&cut, &bytes[..bytes.len() - 100]).unwrap();
    // Some 50 KB.
    let why = without_room(folder.path(), 100, "recover cut.rrd");
    assert!(why.contains("File too large"), "{why}");
    let mut names: Vec<String> = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["cut.rrd", "s.rrd", "s.toml"]);
}

/// A chunk that fills seldom is in the file ahead of time, and stays there when no more can be written.
#[test]
fn what_waited_is_kept_when_there_is_no_more_room() {
    let scene = endless().replace("[record]\n", "[record]\nrate = 1\n");
    let folder = folder_with(&scene);
    // 6 MB: some 50 s of states, of numbers a fifth of a chunk.
    let why = without_room(folder.path(), 12_000, "run s.toml --save-every 0");
    assert!(why.contains("writing stopped: File too large"), "{why}");
    let done = output(folder.path(), &["recover", "s.partial.rrd", "--json"]);
    assert!(done.status.success(), "{}", said(&done.stderr));
    let report: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    let until = report["until"].as_f64().unwrap();
    let survey = record::survey(&folder.path().join("s.rrd")).unwrap();
    let entities = &survey.recordings[0].entities;
    let numbers = entities.iter().find(|entity| entity.path == "/numbers/a");
    let rows = numbers.unwrap().rows;
    // Numbers, one a second, come after the states of a stretch of 1,024 steps, about a second too.
    assert!(rows as f64 > until - 3.0, "{rows} rows of {until} s");
}
