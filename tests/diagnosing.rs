//! `torquescope diagnose`, as one runs it.
#![cfg(feature = "cli")]

use assert_cmd::cargo::cargo_bin;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output, Stdio};

const BODIES: &str = "[body.box]\nmass = 1.0\ninertia = [1.0, 2.0, 2.5]\n";

/// A body that turns about one axis for ever, which is no principal one of [`BODIES`], or one that is.
fn log(axis: [f64; 3]) -> String {
    let speed = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    let mut text = "time,body,qx,qy,qz,qw,wx,wy,wz\n".to_owned();
    for k in 0..500 {
        let t = 0.01 * f64::from(k);
        let (sin, cos) = (0.5 * speed * t).sin_cos();
        let [x, y, z] = axis.map(|x| x / speed * sin);
        let [wx, wy, wz] = axis;
        text += &format!("{t},box,{x},{y},{z},{cos},{wx},{wy},{wz}\n");
    }
    text
}

fn folder(log: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("run.csv"), log).unwrap();
    std::fs::write(folder.path().join("bodies.toml"), BODIES).unwrap();
    folder
}

fn diagnose(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(cargo_bin("torquescope"));
    let command = command.current_dir(folder).arg("diagnose").args(arguments);
    command.output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn a_fault_is_named_with_its_remedy_and_the_exit_code_is_1() {
    let folder = folder(&log([1.0, 2.0, 3.0]));
    let output = diagnose(folder.path(), &["run.csv", "--bodies", "bodies.toml"]);
    let said = text(&output.stdout);
    assert_eq!(
        output.status.code(),
        Some(1),
        "{said}{}",
        text(&output.stderr)
    );
    assert!(said.starts_with("box: wrong: gyroscopic-missing"), "{said}");
    assert!(
        said.contains("right is") && said.contains("remedy"),
        "{said}"
    );

    let json = diagnose(
        folder.path(),
        &["run.csv", "--bodies", "bodies.toml", "--json"],
    );
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    let body = &json["bodies"][0];
    assert_eq!(
        (&body["name"], &body["verdict"], &body["cause"]),
        (&"box".into(), &"fault".into(), &"gyroscopic-missing".into()),
        "{json}"
    );
    assert_eq!(json["rows"], 500);
}

#[test]
fn a_log_that_hides_it_is_told_so() {
    let folder = folder(&log([0.0, 0.0, 3.0]));
    let output = diagnose(folder.path(), &["run.csv", "--bodies", "bodies.toml"]);
    let said = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.starts_with("box: this log cannot tell"), "{said}");
    assert!(said.contains("record"), "{said}");
}

#[test]
fn a_log_comes_through_a_pipe() {
    let folder = folder("");
    let mut child = Command::new(cargo_bin("torquescope"))
        .current_dir(folder.path())
        .args(["diagnose", "-", "--bodies", "bodies.toml", "--json"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut stdin = child.stdin.take().unwrap();
    stdin.write_all(log([1.0, 2.0, 3.0]).as_bytes()).unwrap();
    drop(stdin);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stdout).contains("gyroscopic-missing"));
}

#[test]
fn what_cannot_be_read_is_said_where_and_the_exit_code_is_2() {
    let folder = folder("time,qx,qy\n0,0,0\n");
    std::fs::write(folder.path().join("picture.csv"), b"\x89PNG\r\n\x1a\n0000").unwrap();
    std::fs::write(
        folder.path().join("wrong.toml"),
        "[body.box]\nmass = \"a\"\n",
    )
    .unwrap();
    for (arguments, why) in [
        (&["absent.csv"][..], "absent.csv"),
        (&["run.csv"], "run.csv"),
        (&["picture.csv"], "picture.csv"),
        (&["run.csv", "--map", "omega=a:furlongs"], "furlongs"),
    ] {
        let output = diagnose(folder.path(), arguments);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains(why), "{arguments:?}: {said}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
    std::fs::write(folder.path().join("run.csv"), log([1.0, 2.0, 3.0])).unwrap();
    let output = diagnose(folder.path(), &["run.csv", "--bodies", "wrong.toml"]);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("wrong.toml:2:"), "{said}");
}
