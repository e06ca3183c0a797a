//! The command line, as a user meets it.
#![cfg(feature = "cli")]

use assert_cmd::Command;
use std::path::{Path, PathBuf};

fn torquescope(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("torquescope").unwrap();
    command.current_dir(folder);
    command
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// Every scene in tests/fixtures/wrong against the messages beside it.
/// `UPDATE_GOLDEN=1 cargo test --test cli` writes them anew.
#[test]
fn wrong_scenes_are_told_what_is_wrong_all_at_once() {
    let folder = root().join("tests/fixtures/wrong");
    let mut names: Vec<String> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.ends_with(".toml"))
        .collect();
    names.sort();
    assert!(names.len() >= 11, "{names:?}");
    for name in names {
        let elsewhere = tempfile::tempdir().unwrap();
        let recording = elsewhere.path().join("left.rrd");
        let output = torquescope(&folder)
            .args(["run", &name, "--out"])
            .arg(&recording)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2), "{name}");
        assert!(!recording.exists(), "{name} left a recording");
        assert_eq!(text(&output.stdout), "", "{name}");
        let golden = folder.join(name.replace(".toml", ".txt"));
        // Below each message stand its line and a caret, indented: tests/checking.rs sees to those.
        let said: String = text(&output.stderr)
            .split_inclusive('\n')
            .filter(|line| !line.starts_with("  "))
            .collect();
        for line in said.lines() {
            assert!(line.starts_with(&format!("{name}:")), "{name}: {line}");
        }
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            std::fs::write(&golden, &said).unwrap();
        }
        let wanted = std::fs::read_to_string(&golden).unwrap_or_default();
        assert_eq!(said, wanted, "{name}");
    }
}

/// `UPDATE_GOLDEN=1 cargo test --test cli` writes them anew.
#[test]
fn the_pages_are_what_the_tables_say() {
    for (arguments, page) in [
        (&["methods", "--markdown"][..], "docs/methods.md"),
        (&["schema", "--markdown"][..], "docs/keys.md"),
        (&["schema"][..], "docs/scene.schema.json"),
    ] {
        let output = torquescope(&root()).args(arguments).output();
        let said = text(&output.unwrap().stdout);
        let page = root().join(page);
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            std::fs::write(&page, &said).unwrap();
        }
        let written = std::fs::read_to_string(&page).unwrap_or_default();
        assert_eq!(written, said, "{}", page.display());
    }
}

#[test]
fn a_scene_that_does_not_exist() {
    let output = torquescope(&root())
        .args(["run", "scenes/cones.toml"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(
        text(&output.stderr),
        "scenes/cones.toml: cannot be read: No such file or directory (os error 2); did you mean `cone.toml`?\n"
    );
    let output = torquescope(&root())
        .args(["run", "scenes"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("name a scene file, not a folder"));
}

#[test]
fn an_output_that_cannot_be_written_is_told_before_the_simulation() {
    let folder = tempfile::tempdir().unwrap();
    // 1e12 steps: it would not return if it began.
    let scene = "duration = 1e9\n[record]\nstate = \"every\"\n[[body]]\nname = \"a\"\nmass = 1.0\ninertia = [1, 1, 1]\n";
    std::fs::write(folder.path().join("long.toml"), scene).unwrap();
    let output = torquescope(folder.path())
        .args(["run", "long.toml", "--out", "nowhere/at/all.rrd"])
        .timeout(std::time::Duration::from_secs(20))
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(
        text(&output.stderr),
        "nowhere/at/all.rrd: cannot be written: No such file or directory (os error 2); choose another file or folder for the recording\n"
    );
}

#[test]
fn the_cone_by_its_first_command() {
    let folder = tempfile::tempdir().unwrap();
    let scene = root().join("scenes/cone.toml");
    let output = torquescope(folder.path())
        .arg("run")
        .arg(&scene)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert_eq!(text(&output.stderr), "");
    let said = text(&output.stdout);
    for number in [
        "(0, 0, 40)",
        "(0, 0, 13.3333)",
        "(-9.42809, -23.5702, -9.42809)",
        "(5.33333, 0, 0)",
    ] {
        assert!(said.contains(number), "{number} is not in\n{said}");
    }
    assert!(said.contains("cone.rrd: ") && said.contains("torquescope view cone.rrd"));
    let recording = std::fs::read(folder.path().join("cone.rrd")).unwrap();
    assert_eq!(&recording[..4], b"RRF2");
}

#[test]
fn a_file_that_is_no_recording_is_not_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let scene = "duration = 0.01\n[[body]]\nname = \"a\"\nmass = 1.0\ninertia = [1, 1, 1]\n";
    std::fs::write(folder.path().join("s.toml"), scene).unwrap();
    let output = torquescope(folder.path())
        .args(["run", "s.toml", "--out", "s.toml"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(
        text(&output.stderr),
        "s.toml exists and is no recording; choose another name, so that it is not lost\n"
    );
    assert_eq!(
        std::fs::read_to_string(folder.path().join("s.toml")).unwrap(),
        scene
    );
    // An earlier recording is replaced.
    for _ in 0..2 {
        torquescope(folder.path())
            .args(["run", "s.toml"])
            .assert()
            .success();
    }
}

/// /dev/full takes nothing: the first flush of a run that is long enough fails in its midst.
#[cfg(target_os = "linux")]
#[test]
fn a_disk_that_fills_up_is_told_once_and_without_a_panic() {
    let folder = tempfile::tempdir().unwrap();
    let scene = "duration = 60.0\n[[body]]\nname = \"a\"\nmass = 1.0\ninertia = [1, 1, 1]\nangular_velocity = [0, 1, 0]\n";
    std::fs::write(folder.path().join("s.toml"), scene).unwrap();
    let output = torquescope(folder.path())
        .args(["run", "s.toml", "--out", "/dev/full"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    assert_eq!(
        text(&output.stderr),
        "/dev/full: writing stopped: Failed to write: No space left on device (os error 28); make room there, or record fewer streams or less often\n"
    );
}

/// Reads one answer of a served page.
fn ask(address: &str, request: &str) -> String {
    use std::io::{Read as _, Write as _};
    let mut stream = std::net::TcpStream::connect(address).unwrap();
    stream.write_all(request.as_bytes()).unwrap();
    stream
        .set_read_timeout(Some(std::time::Duration::from_secs(20)))
        .unwrap();
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).unwrap();
    String::from_utf8_lossy(&answer).into_owned()
}

#[test]
fn the_carried_viewer_is_served_to_this_machine_alone() {
    use std::io::BufRead as _;
    let folder = tempfile::tempdir().unwrap();
    let scene = "duration = 0.01\n[[body]]\nname = \"a\"\nmass = 1.0\ninertia = [1, 1, 1]\n";
    std::fs::write(folder.path().join("s.toml"), scene).unwrap();
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin!("torquescope"))
        .current_dir(folder.path())
        .args(["run", "s.toml", "--json", "--view", "--no-browser"])
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    // With --json the address goes to stderr: stdout is one object.
    let mut line = String::new();
    std::io::BufReader::new(child.stderr.take().unwrap())
        .read_line(&mut line)
        .unwrap();
    let address = line
        .split("http://")
        .nth(1)
        .unwrap()
        .split_whitespace()
        .next()
        .unwrap()
        .to_owned();
    let get = |path: &str, host: &str| {
        ask(
            &address,
            &format!("GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n"),
        )
    };
    assert!(address.starts_with("127.0.0.1:"));
    assert!(get("/", &address).starts_with("HTTP/1.1 200") && get("/", &address).contains("s.rrd"));
    assert!(get("/recording.rrd", &address).contains("RRF2"));
    assert!(get("/re_viewer.js", &address).contains("WebHandle"));
    assert!(get("/../Cargo.toml", &address).starts_with("HTTP/1.1 404"));
    assert!(get("/", "evil.example").starts_with("HTTP/1.1 403"));
    // What a request announces is not read, and does not bring the server down.
    let huge =
        format!("POST / HTTP/1.1\r\nHost: {address}\r\nContent-Length: 99999999999999\r\n\r\n");
    assert!(ask(&address, &huge).starts_with("HTTP/1.1 405"));
    assert!(get("/", &address).starts_with("HTTP/1.1 200"));
    // The port is taken now.
    let port = address.rsplit(':').next().unwrap();
    let output = torquescope(folder.path())
        .args(["view", "s.rrd", "--web", "--no-browser", "--port", port])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(
        text(&output.stderr).starts_with(&format!("port {port} on 127.0.0.1 cannot be served"))
    );
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn json_has_every_digit() {
    let folder = tempfile::tempdir().unwrap();
    let scene = root().join("scenes/cone.toml");
    let output = torquescope(folder.path())
        .arg("run")
        .arg(&scene)
        .arg("--json")
        .output()
        .unwrap();
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["method"], "semi-implicit");
    assert_eq!(report["steps"], 1000);
    assert_eq!(report["bodies"][1]["name"], "base-A");
    let omega = report["bodies"][1]["angular_velocity"][2].as_f64().unwrap();
    // 100 additions of 40/1000, rounded.
    assert!((omega - 4.0).abs() < 1e-13);
    let bytes = std::fs::metadata(folder.path().join("cone.rrd"))
        .unwrap()
        .len();
    assert_eq!(report["recording"]["bytes"], bytes);
}

#[test]
fn a_run_that_loses_its_state_closes_its_file_and_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let scene = "duration = 10.0\nallow = [\"coarse-step\"]\n[stepping]\nmethod = \"semi-implicit\"\nstep = 0.01\n[effects]\ngyroscopic = true\n[[body]]\nname = \"top\"\nmass = 1.0\ninertia = [1, 2, 2.5]\nangular_velocity = [90, 20, -60]\n";
    std::fs::write(folder.path().join("burst.toml"), scene).unwrap();
    let output = torquescope(folder.path())
        .args(["run", "burst.toml"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    let said = text(&output.stderr);
    let mut lines: Vec<&str> = said.lines().collect();
    let last = lines.pop().unwrap();
    assert!(
        last.starts_with("top is no longer finite at t = ") && last.contains("by semi-implicit"),
        "{said}"
    );
    // What drifted on the way there.
    assert!(!lines.is_empty(), "{said}");
    for line in lines {
        assert!(
            line.starts_with("warning: top: ") && line.contains(" drifts by semi-implicit "),
            "{said}"
        );
    }
    let recording = std::fs::read(folder.path().join("burst.rrd")).unwrap();
    // The marks of the footer that a whole file ends with.
    assert!(
        recording[recording.len() - 12..].starts_with(b"RRF2FOOT"),
        "no footer"
    );
}

#[test]
fn what_is_not_chosen_is_not_in_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let scene = "duration = 1.0\n[record]\nstreams = [\"torque\"]\n[[body]]\nname = \"a\"\nmass = 1.0\ninertia = [1, 1, 1]\n";
    std::fs::write(folder.path().join("few.toml"), scene).unwrap();
    torquescope(folder.path())
        .args(["run", "few.toml"])
        .assert()
        .success();
    let all = scene.replace("streams = [\"torque\"]", "");
    std::fs::write(folder.path().join("all.toml"), all).unwrap();
    torquescope(folder.path())
        .args(["run", "all.toml"])
        .assert()
        .success();
    let holds = |file: &str, path: &str| {
        let bytes = std::fs::read(folder.path().join(file)).unwrap();
        bytes
            .windows(path.len())
            .any(|window| window == path.as_bytes())
    };
    assert!(holds("few.rrd", "/torque/a") && holds("all.rrd", "/torque/a"));
    for path in [
        "/alpha/a",
        "/omega/a",
        "/momentum/a",
        "/inertia/a",
        "/pages/a",
    ] {
        assert!(holds("all.rrd", path), "{path}");
        assert!(!holds("few.rrd", path), "{path}");
    }
}

#[test]
fn an_impulse_leaves_an_arrow_that_is_taken_away_again() {
    let folder = tempfile::tempdir().unwrap();
    let scene = "duration = 2.0\n[[body]]\nname = \"a\"\nmass = 1.0\ninertia = [1, 1, 1]\n[[event]]\nat = 0.5\nbody = \"a\"\nimpulse = [0, 2, 0]\npoint = [0.5, 0, 0]\n";
    std::fs::write(folder.path().join("s.toml"), scene).unwrap();
    let output = torquescope(folder.path())
        .args(["run", "s.toml"])
        .output()
        .unwrap();
    assert!(
        text(&output.stdout).contains("(0, 0, 1) N·m·s"),
        "{}",
        text(&output.stdout)
    );
    let bytes = std::fs::read(folder.path().join("s.rrd")).unwrap();
    let path = b"/force/a/impulse";
    let rows = bytes
        .windows(path.len())
        .filter(|window| window == path)
        .count();
    // The arrow and its removal are a chunk each, both named in the footer too.
    assert!(rows >= 2, "{rows}");
}

#[test]
fn the_lists_and_help() {
    for verb in ["methods", "effects", "streams", "solids"] {
        let output = torquescope(&root()).arg(verb).output().unwrap();
        assert_eq!(output.status.code(), Some(0));
        assert!(text(&output.stdout).lines().count() > 4, "{verb}");
        let json = torquescope(&root())
            .args([verb, "--json"])
            .output()
            .unwrap();
        let list: Vec<serde_json::Map<String, serde_json::Value>> =
            serde_json::from_slice(&json.stdout).unwrap();
        assert!(!list.is_empty(), "{verb}");
    }
    for verb in ["run", "cost", "view", "check", "scenes", "new", "schema"] {
        let output = torquescope(&root())
            .args([verb, "--help"])
            .output()
            .unwrap();
        assert!(
            text(&output.stdout).contains("Example: torquescope"),
            "{verb}"
        );
    }
    assert_eq!(
        torquescope(&root())
            .arg("rum")
            .output()
            .unwrap()
            .status
            .code(),
        Some(2)
    );
}

/// `cost` on the free top, short and by a few methods, in a folder of its own.
fn cost(folder: &Path, more: &[&str]) -> std::process::Output {
    let scene = std::fs::read_to_string(root().join("scenes/free_top.toml")).unwrap();
    let short = scene.replace("duration = 20.0", "duration = 2.0");
    std::fs::write(folder.join("top.toml"), short).unwrap();
    let mut command = torquescope(folder);
    command.args(["cost", "top.toml", "--methods", "jolt,rk4,closed-form"]);
    command
        .args(["--longest", "0.02", "--repeats", "1"])
        .args(more);
    command.output().unwrap()
}

#[test]
fn what_accuracy_costs_as_a_table_with_plots_and_a_recording() {
    let folder = tempfile::tempdir().unwrap();
    let output = cost(folder.path(), &[]);
    let said = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(said.contains("the exact motion (closed-form"), "{said}");
    let last = said.lines().last().unwrap();
    assert!(last.starts_with("for 1e-9 rad: closed-form"), "{last}");
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    let svg = text(&read("top-cost.svg"));
    for words in [
        "largest error (rad)",
        "wall time per simulated second (s)",
        "rk4",
    ] {
        assert!(svg.contains(words), "{words}");
    }
    assert_eq!(read("top-cost.png")[..8], *b"\x89PNG\r\n\x1a\n");
    // The recording holds the plot and the race.
    let recording = read("top-cost.rrd");
    for path in ["/price/rk4", "/bodies/true", "/bodies/jolt"] {
        let found = recording.windows(path.len()).any(|w| w == path.as_bytes());
        assert!(found, "{path}");
    }
}

#[test]
fn what_accuracy_costs_as_data() {
    let folder = tempfile::tempdir().unwrap();
    let output = cost(folder.path(), &["--json", "--table", "--accuracy", "1e-3"]);
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["accuracy"], 1e-3);
    let rungs = report["rungs"].as_array().unwrap();
    let of = |method: &str| rungs.iter().filter(|r| r["method"] == method).count();
    // How many there are is up to the clock; two there always are.
    assert!(of("jolt") > 1 && of("rk4") > 1);
    assert_eq!(of("closed-form"), 1);
    // An order of 4 against an order of 1, at the same step.
    let error = |method: &str| {
        let rung = rungs
            .iter()
            .find(|r| r["method"] == method && r["step"] == 0.04);
        rung.unwrap()["error"].as_f64().unwrap()
    };
    assert!(error("rk4") < 1e-3 * error("jolt"));
    let output = cost(folder.path(), &["--csv", "--table"]);
    let csv = text(&output.stdout);
    let mut lines = csv.lines();
    let columns = lines.next().unwrap().split(',').count();
    assert!(lines.clone().count() > 3);
    assert!(lines.all(|line| line.split(',').count() == columns));
    assert!(!folder.path().join("top-cost.svg").exists());
}

#[test]
fn cost_is_told_what_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    for (more, message) in [
        (["--accuracy", "0"], "--accuracy 0.0 is not above 0"),
        (["--longest", "-1"], "--longest -1.0 is no time"),
        (["--methods", "rk5"], "--methods: \"rk5\" is no method"),
        (["--out", "gone/cost"], "gone/cost.svg: cannot be written"),
    ] {
        let scene = root().join("scenes/free_top.toml");
        let mut command = torquescope(folder.path());
        let output = command.arg("cost").arg(scene).args(more).output().unwrap();
        let said = text(&output.stderr);
        assert!(said.contains(message), "{more:?}: {said}");
        assert_ne!(output.status.code(), Some(0), "{more:?}");
    }
}

/// What `--out` would replace is looked at before anything is measured.
#[test]
fn cost_overwrites_nothing_but_its_own_results() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["pre.svg", "pre.png", "pre.rrd"] {
        let path = folder.path().join(name);
        std::fs::write(&path, "precious").unwrap();
        let output = cost(folder.path(), &["--out", "pre"]);
        assert_eq!(output.status.code(), Some(2), "{name}");
        assert!(text(&output.stderr).starts_with(&format!("{name} exists")));
        assert_eq!(std::fs::read(&path).unwrap(), b"precious");
        std::fs::remove_file(path).unwrap();
    }
    for _ in 0..2 {
        assert_eq!(
            cost(folder.path(), &["--out", "pre"]).status.code(),
            Some(0)
        );
    }
}

#[test]
fn a_plan_is_explained() {
    let folder = tempfile::tempdir().unwrap();
    let scene = root().join("scenes/heavy_top.toml");
    let run = |more: &[&str]| {
        let mut command = torquescope(folder.path());
        command
            .arg("run")
            .arg(&scene)
            .args(["--explain"])
            .args(more);
        text(&command.output().unwrap().stdout)
    };
    let said = run(&[]);
    assert!(said.contains("gyroscopic, gravity"), "{said}");
    assert!(said.contains("asked for 1e-9 rad; largest error"), "{said}");
    let report: serde_json::Value = serde_json::from_str(&run(&["--json"])).unwrap();
    let plan = &report["plan"];
    assert!(plan["achieved"].as_f64().unwrap() <= 1e-9);
    assert_eq!(plan["intervals"].as_array().unwrap().len(), 1);
    // More than can be had is refused, and nothing is recorded.
    let beyond = std::fs::read_to_string(&scene)
        .unwrap()
        .replace("accuracy = 1e-9", "accuracy = 1e-18");
    std::fs::write(folder.path().join("beyond.toml"), beyond).unwrap();
    let output = torquescope(folder.path())
        .args(["run", "beyond.toml"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = text(&output.stderr);
    assert!(said.contains("cannot be had in this scene"), "{said}");
    assert!(!folder.path().join("beyond.rrd").exists());
}

#[test]
fn check_says_right_or_wrong() {
    let output = torquescope(&root())
        .args(["check", "scenes/cone.toml", "@wheel"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(text(&output.stdout).lines().count(), 2);
    let wrong = "tests/fixtures/wrong/clock.toml";
    let output = torquescope(&root())
        .args(["check", wrong, "gone.toml", "scenes/cone.toml"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = text(&output.stderr);
    let picture = "13 | immovable = [\"z\"]\n     |             ^^^^^\n";
    assert!(said.starts_with(wrong) && said.contains(picture), "{said}");
    assert!(said.contains("gone.toml: cannot be read"), "{said}");
    // The right one among the wrong ones is told as right.
    assert!(text(&output.stdout).starts_with("scenes/cone.toml: ok"));
}

/// A scene whose only fault is that its step is too coarse.
const COARSE: &str = "duration = 1.0\n[stepping]\nstep = 0.1\n[record]\nrate = 10\n[[body]]\nname = \"a\"\nmass = 1.0\ninertia = [1, 1, 1]\nangular_velocity = [0, 9, 0]\n";

#[test]
fn warnings_are_told_and_only_strict_minds_them() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("s.toml"), COARSE).unwrap();
    let check = |more: &[&str]| {
        let mut command = torquescope(folder.path());
        command.args(["check", "s.toml"]).args(more);
        command.output().unwrap()
    };
    let wanted = "s.toml:3:8: warning: a step of 0.1 s is above a tenth of the fastest period, 6.981e-1 s: a turns at 9.000 rad/s; take a step of 6.0e-2 s or less [coarse-step]\n";
    let output = check(&[]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(
        text(&output.stderr),
        format!("{wanted}  3 | step = 0.1\n    |        ^^^\n")
    );
    assert_eq!(check(&["--strict"]).status.code(), Some(1));
    let output = check(&["--format", "json"]);
    assert_eq!(text(&output.stderr), "");
    let list: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let one = &list[0];
    assert_eq!(list.as_array().unwrap().len(), 1);
    assert_eq!(
        (
            &one["file"],
            &one["line"],
            &one["column"],
            &one["end_column"]
        ),
        (&"s.toml".into(), &3.into(), &8.into(), &11.into())
    );
    assert_eq!(
        (&one["severity"], &one["code"], &one["remedy"]),
        (
            &"warning".into(),
            &"coarse-step".into(),
            &"take a step of 6.0e-2 s or less".into()
        )
    );
    // `run` tells them too, in a line each, and does what it was asked.
    let output = torquescope(folder.path())
        .args(["run", "s.toml"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(text(&output.stderr), wanted);
    let meant = format!("allow = [\"coarse-step\"]\n{COARSE}");
    std::fs::write(folder.path().join("s.toml"), meant).unwrap();
    let output = check(&["--strict"]);
    assert_eq!(
        (output.status.code(), text(&output.stderr)),
        (Some(0), String::new())
    );
    // Errors for editors, a file that is not there among them.
    let output = torquescope(&root())
        .args([
            "check",
            "--format",
            "json",
            "tests/fixtures/wrong/nothing.toml",
            "gone.toml",
        ])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let list: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let codes: Vec<&str> = list
        .as_array()
        .unwrap()
        .iter()
        .map(|f| f["code"].as_str().unwrap())
        .collect();
    assert_eq!(codes, ["missing-key", "invalid", "unreadable"]);
}

#[test]
fn carried_scenes_run_without_a_checkout() {
    let folder = tempfile::tempdir().unwrap();
    let output = torquescope(folder.path()).arg("scenes").output().unwrap();
    let said = text(&output.stdout);
    assert!(
        said.contains("@cone") && said.contains("The tutorial's cone"),
        "{said}"
    );
    let inside = torquescope(&root())
        .args(["scenes", "scenes"])
        .output()
        .unwrap();
    // A folder's scenes are listed by file, as many as are carried.
    assert!(text(&inside.stdout).contains("scenes/cone.toml"));
    assert_eq!(text(&inside.stdout).lines().count(), said.lines().count());
    torquescope(folder.path())
        .args(["run", "@wing_nut"])
        .assert()
        .success();
    assert!(folder.path().join("wing_nut.rrd").exists());
    let output = torquescope(folder.path())
        .args(["run", "@wingnut"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(
        text(&output.stderr),
        "@wingnut: cannot be read: no scene of this name is carried; did you mean `@wing_nut`?\n"
    );
    let output = torquescope(folder.path())
        .args(["view", "@cone"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("is a scene, no recording"));
}

#[test]
fn a_new_scene_runs_and_overwrites_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let new = |arguments: &[&str]| {
        let mut command = torquescope(folder.path());
        command.arg("new").args(arguments);
        command.output().unwrap()
    };
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(new(&["top"]).status.code(), Some(0));
    let scene = read("top.toml");
    assert!(scene.starts_with("#:schema ./scene.schema.json\n# "));
    let schema = std::fs::read_to_string(root().join("docs/scene.schema.json")).unwrap();
    assert_eq!(read("scene.schema.json"), schema);
    let check = torquescope(folder.path())
        .args(["check", "--strict", "top.toml"])
        .output()
        .unwrap();
    assert_eq!(
        (check.status.code(), text(&check.stderr)),
        (Some(0), String::new())
    );
    torquescope(folder.path())
        .args(["run", "top.toml"])
        .assert()
        .success();
    // Again: neither the scene nor an older schema is touched.
    std::fs::write(folder.path().join("scene.schema.json"), "{}").unwrap();
    let again = new(&["top.toml"]);
    assert_eq!(again.status.code(), Some(2));
    assert_eq!(
        text(&again.stderr),
        "top.toml exists; choose another name, so that it is not lost\n"
    );
    let other = new(&["other", "--from", "@cone"]);
    assert!(text(&other.stdout).contains("scene.schema.json: kept, but of another version"));
    assert_eq!(
        (read("top.toml"), read("scene.schema.json")),
        (scene, "{}".to_owned())
    );
    let cone = std::fs::read_to_string(root().join("scenes/cone.toml")).unwrap();
    assert_eq!(
        read("other.toml"),
        format!("#:schema ./scene.schema.json\n{cone}")
    );
    for wrong in [
        &["x", "--from", "@con"][..],
        &["@x"],
        &["nowhere/x"],
        &["/"],
    ] {
        let output = new(wrong);
        assert_eq!(output.status.code(), Some(2), "{wrong:?}");
        assert_eq!(text(&output.stderr).lines().count(), 1, "{wrong:?}");
    }
    assert!(!folder.path().join("x.toml").exists());
}

#[test]
fn mass_weighs_a_mesh_and_slices_it() {
    let arguments = [
        "mass",
        "scenes/t_handle.obj",
        "--scale",
        "0.01",
        "--density",
        "7850",
    ];
    let output = torquescope(&root()).args(arguments).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(text(&output.stdout).contains("0.382956 kg"));
    let output = torquescope(&root())
        .args(arguments)
        .args(["--cubes", "8,16", "--json"])
        .output()
        .unwrap();
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    // tests/oracles/t_handle.csv: 311.654 cm⁵.
    let moment = json["principal"][1]["moment"].as_f64().unwrap();
    assert!((moment / (7850.0 * 311.6540344559432e-10) - 1.0).abs() < 1e-13);
    assert_eq!(json["cubes"].as_array().unwrap().len(), 2);
    let output = torquescope(&root())
        .args(["mass", "Cargo.toml"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn mass_judges_a_robots_links_and_draws_them() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("arm.rrd");
    let output = torquescope(&root())
        .args(["mass", "tests/fixtures/robots/arm.urdf", "--record"])
        .arg(&out)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("5 of 10 have an inertia that no rigid body has"));
    assert!(text(&output.stdout).contains("implausible"));
    assert!(std::fs::read(&out).unwrap().starts_with(b"RRF2"));
    let output = torquescope(&root())
        .args(["mass", "tests/fixtures/robots/arm.xml", "--json"])
        .output()
        .unwrap();
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["links"][5]["verdict"], "impossible");
}

#[test]
fn view_refuses_what_is_no_recording() {
    let output = torquescope(&root())
        .args(["view", "Cargo.toml"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).starts_with("Cargo.toml: is no Rerun recording"));
    let output = torquescope(&root())
        .args(["view", "gone.rrd"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("cannot be read"));
}

#[test]
fn a_carried_scene_brings_its_files_and_its_recording_is_verified_anywhere() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| {
        let output = torquescope(folder.path()).args(arguments).output().unwrap();
        (
            output.status.code(),
            text(&output.stdout),
            text(&output.stderr),
        )
    };
    let (code, _, said) = run(&["run", "@t_handle", "--until", "0.5"]);
    assert_eq!((code, said.as_str()), (Some(0), ""));
    let (code, said, wrong) = run(&["run", "t_handle.rrd", "--verify"]);
    assert_eq!(code, Some(0), "{said}{wrong}");
    let (code, _, wrong) = run(&["check", "--strict", "@t_handle", "@spin_down", "@tops"]);
    assert_eq!((code, wrong.as_str()), (Some(0), ""));
    // A copy has the file beside it, and is the same scene.
    let (code, said, _) = run(&["new", "mine", "--from", "@t_handle"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("t_handle.obj: written"), "{said}");
    let (code, said, wrong) = run(&["check", "--strict", "mine.toml"]);
    assert_eq!((code, wrong.as_str()), (Some(0), ""), "{said}");
}

#[test]
fn every_carried_scene_is_right_without_warning() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = torquescope(folder.path());
    command.args(["check", "--strict"]);
    for scene in torquescope::scene::carried::CARRIED {
        command.arg(format!("@{}", scene.name));
    }
    let output = command.output().unwrap();
    assert_eq!(
        (output.status.code(), text(&output.stderr)),
        (Some(0), String::new())
    );
}

#[test]
fn check_looks_at_every_value_of_a_sweep() {
    let folder = tempfile::tempdir().unwrap();
    let scene = format!("{COARSE}[sweep]\n\"body.a.mass\" = [1.0, -1.0]\n");
    std::fs::write(folder.path().join("s.toml"), &scene).unwrap();
    let output = torquescope(folder.path())
        .args(["check", "s.toml"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(
        text(&output.stderr),
        "s.toml:12:23: mass = -1.0 must be above zero (kg)\n  12 | \"body.a.mass\" = [1.0, -1.0]\n     |                       ^^^^\n"
    );
    let right = scene.replace("-1.0]", "2.0]");
    std::fs::write(folder.path().join("s.toml"), &right).unwrap();
    let output = torquescope(folder.path())
        .args(["check", "s.toml"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(text(&output.stdout).ends_with("the first of 2 that its sweep makes\n"));
    // The step's warning is one, whatever the mass.
    let warned = text(&output.stderr);
    assert_eq!(warned.matches("[coarse-step]").count(), 1, "{warned}");
}

#[test]
fn what_an_argument_makes_probably_wrong_is_told_once_by_run() {
    let folder = tempfile::tempdir().unwrap();
    let scene = COARSE.replace("step = 0.1", "step = 0.01");
    std::fs::write(folder.path().join("s.toml"), scene).unwrap();
    let output = torquescope(folder.path())
        .args(["run", "s.toml", "--set", "step=0.1"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0));
    let said = text(&output.stderr);
    assert!(
        said.starts_with("--set step=0.1: warning: a step of 0.1 s"),
        "{said}"
    );
    assert_eq!(said.lines().count(), 1, "{said}");
    // Run again as it was made, a recording has nothing new to say; changed, it has.
    let again = torquescope(folder.path())
        .args(["run", "s.rrd"])
        .output()
        .unwrap();
    assert_eq!(
        (again.status.code(), text(&again.stderr)),
        (Some(0), String::new())
    );
    let changed = torquescope(folder.path())
        .args(["run", "s.rrd", "--set", "step=0.09", "--out", "c.rrd"])
        .output()
        .unwrap();
    assert!(text(&changed.stderr).contains("--set step=0.09: warning:"));
}
