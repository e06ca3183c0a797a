//! Recordings without a viewer, and runs that are compared. What is right is known in closed form.
#![cfg(feature = "cli")]

use assert_cmd::Command;
use parquet::file::reader::{FileReader as _, SerializedFileReader};
use parquet::record::RowAccessor as _;
use rerun::external::arrow::array::{Array as _, Float64Array};
use rerun::external::re_log_encoding::DecoderApp;
use rerun::external::re_log_types::LogMsg;
use rerun::log::Chunk;
use serde_json::Value;
use std::io::BufReader;
use std::path::Path;

/// A free symmetric top: moments 1, 1, 2, turning by (0.8, 0, 1.5) rad/s at first, attitude 1.
const TOP: &str = "duration = 3\n[effects]\ngyroscopic = true\n[stepping]\nmethod = \"rkn6\"\nstep = 0.001\n[[body]]\nname = \"top\"\nmass = 2.0\ninertia = [1, 1, 2]\nangular_velocity = [0.8, 0, 1.5]\n";

/// Its angular velocity in the world: what is across L goes round it at |L| / I₁.
fn omega(t: f64) -> [f64; 3] {
    let (l, w) = ([0.8, 0.0, 3.0], [0.8, 0.0, 1.5]);
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let length = dot(l, l).sqrt();
    let axis = l.map(|x| x / length);
    let along = axis.map(|x| x * dot(axis, w));
    let across: [f64; 3] = std::array::from_fn(|k| w[k] - along[k]);
    let side = [
        axis[1] * across[2] - axis[2] * across[1],
        axis[2] * across[0] - axis[0] * across[2],
        axis[0] * across[1] - axis[1] * across[0],
    ];
    let (sin, cos) = (length * t).sin_cos();
    std::array::from_fn(|k| along[k] + across[k] * cos + side[k] * sin)
}

/// The order is 6 and the free motion exact: 3,000 steps leave rounding.
const NEAR: f64 = 1e-12;

fn folder_with(scenes: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in scenes {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// Exit code, stdout, stderr.
fn torquescope(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::cargo_bin("torquescope").unwrap();
    let replacing = arguments.starts_with(&["compare"]).then_some("--force");
    let output = command
        .current_dir(folder)
        .args(arguments)
        // Each comparison takes the place of the last.
        .args(replacing)
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
    let code = output.status.code().unwrap();
    assert!(
        !text(&output.stderr).contains("panicked"),
        "{}",
        text(&output.stderr)
    );
    (code, text(&output.stdout), text(&output.stderr))
}

fn json(folder: &Path, arguments: &[&str]) -> Value {
    let (code, said, wrong) = torquescope(folder, &[arguments, &["--json"]].concat());
    assert!(code < 2, "{wrong}");
    serde_json::from_str(&said).unwrap_or_else(|why| panic!("{why}: {said}"))
}

fn with_top() -> tempfile::TempDir {
    let folder = folder_with(&[("top.toml", TOP)]);
    let (code, _, wrong) = torquescope(folder.path(), &["run", "top.toml"]);
    assert_eq!(code, 0, "{wrong}");
    folder
}

fn near(got: &Value, want: f64, bound: f64) {
    let got = got.as_f64().unwrap_or_else(|| panic!("{got} is no number"));
    assert!((got - want).abs() <= bound, "{got} is not {want}");
}

/// What a list has of a quantity.
fn of<'v>(list: &'v Value, quantity: &str) -> &'v Value {
    let mut all = list.as_array().unwrap().iter();
    let found = all.find(|value| value["quantity"] == quantity);
    found.unwrap_or_else(|| panic!("{quantity} is not in {list}"))
}

#[test]
fn extremes_are_those_of_the_closed_form() {
    let folder = with_top();
    let report = json(folder.path(), &["inspect", "top.rrd"]);
    assert_eq!(report["cut"], Value::Null);
    let recording = &report["recordings"][0];
    assert_eq!(recording["application"], "torquescope");
    let clock = recording["timelines"].as_array().unwrap();
    let clock = clock
        .iter()
        .find(|clock| clock["name"] == "sim_time")
        .unwrap();
    assert_eq!(
        (&clock["first"], &clock["last"]),
        (&0.0.into(), &3.0.into())
    );
    let found = of(&recording["extremes"], "angular_velocity");
    // At every step.
    assert_eq!(found["rows"], 3001);
    let all: Vec<[f64; 3]> = (0..=3000).map(|k| omega(f64::from(k) / 1000.0)).collect();
    for k in 0..3 {
        let values = all.iter().map(|w| w[k]);
        let least = values.clone().fold(f64::INFINITY, f64::min);
        let greatest = values.fold(f64::NEG_INFINITY, f64::max);
        near(&found["components"][k]["least"][0], least, NEAR);
        near(&found["components"][k]["greatest"][0], greatest, NEAR);
    }
    // |ω| stays: 1.7.
    near(&found["size"]["least"][0], 1.7, NEAR);
    near(&found["size"]["greatest"][0], 1.7, NEAR);
    let energy = of(&recording["extremes"], "kinetic_energy");
    near(
        &energy["components"][0]["greatest"][0],
        0.5 * (0.64 + 2.0 * 2.25),
        NEAR,
    );
    assert_eq!(found["not_finite"], 0);
    let (_, said, _) = torquescope(folder.path(), &["inspect", "top.rrd"]);
    assert!(
        said.contains("|angular_velocity| (rad/s)") && said.contains("sim_time: 0 … 3 s"),
        "{said}"
    );
}

#[test]
fn an_instant_and_a_condition() {
    let folder = with_top();
    // Between two rows of the numbers, at a step.
    let found = json(
        folder.path(),
        &["inspect", "top.rrd", "--at", "1.2345", "--body", "top"],
    );
    let now = of(&found, "angular_velocity");
    assert_eq!(now["at"], 1.234);
    for k in 0..3 {
        near(&now["rows"][0][k], omega(1.234)[k], NEAR);
    }
    assert_eq!(now["rows"].as_array().unwrap().len(), 1);
    // Before the first row there is nothing.
    assert_eq!(
        json(folder.path(), &["inspect", "top.rrd", "--at", "-1"]),
        Value::Array(Vec::new())
    );
    let when = json(
        folder.path(),
        &["inspect", "top.rrd", "--when", "angular_velocity.top.y < 0"],
    );
    let holds = |k: i32| omega(f64::from(k) / 1000.0)[1] < 0.0;
    let begins: Vec<i32> = (1..=3000).filter(|&k| holds(k) && !holds(k - 1)).collect();
    let ends: Vec<i32> = (1..=3000).filter(|&k| !holds(k) && holds(k - 1)).collect();
    let stretches = when["holds"].as_array().unwrap();
    assert!(!begins.is_empty());
    assert_eq!(stretches.len(), begins.len());
    for (stretch, k) in stretches.iter().zip(&begins) {
        near(&stretch["begins"], f64::from(*k) / 1000.0, 1e-12);
    }
    for (stretch, k) in stretches.iter().zip(&ends) {
        near(&stretch["ends"], f64::from(*k) / 1000.0, 1e-12);
        near(&stretch["last"], f64::from(*k - 1) / 1000.0, 1e-12);
    }
    let (code, said, _) = torquescope(
        folder.path(),
        &["inspect", "top.rrd", "--when", "not finite"],
    );
    assert_eq!(code, 0);
    assert!(said.starts_with("not finite: at none of "), "{said}");
}

#[test]
fn before_and_after_an_event() {
    let scene = "duration = 1\n[[body]]\nname = \"a\"\nmass = 2.0\ninertia = [1, 1, 1]\n[[event]]\nat = 0.5\nbody = \"a\"\nimpulse = [3.0, 0, 0]\npoint = { body = [0, 0, 0] }\n";
    let folder = folder_with(&[("s.toml", scene)]);
    torquescope(folder.path(), &["run", "s.toml"]);
    let found = json(folder.path(), &["inspect", "s.rrd", "--at", "0.5"]);
    let rows = &of(&found, "velocity")["rows"];
    // Δv = J / m.
    assert_eq!(rows[0], serde_json::json!([0.0, 0.0, 0.0]));
    assert_eq!(rows[1], serde_json::json!([1.5, 0.0, 0.0]));
    let (_, said, _) = torquescope(folder.path(), &["inspect", "s.rrd", "--at", "0.5"]);
    assert!(said.contains("before") && said.contains("after"), "{said}");
}

#[test]
fn numbers_for_other_programs() {
    let folder = with_top();
    let path = folder.path();
    let (code, csv, wrong) = torquescope(path, &["inspect", "top.rrd", "--export", "csv"]);
    assert_eq!((code, wrong.as_str()), (0, ""));
    let mut lines = csv.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let place = |name: &str| header.iter().position(|known| *known == name).unwrap();
    let (time, y) = (place("sim_time"), place("angular_velocity.y"));
    let mut rows = Vec::new();
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(cells.len(), header.len());
        let (t, y): (f64, f64) = (cells[time].parse().unwrap(), cells[y].parse().unwrap());
        assert!((y - omega(t)[1]).abs() <= NEAR, "{y} at {t}");
        rows.push((t, y));
    }
    // 60 a second, both ends.
    assert_eq!(rows.len(), 181);
    let (_, text, _) = torquescope(path, &["inspect", "top.rrd", "--export", "json"]);
    let objects: Vec<Value> = serde_json::from_str(&text).unwrap();
    assert_eq!(objects.len(), rows.len());
    for (object, (t, y)) in objects.iter().zip(&rows) {
        // This reader of JSON rounds the last digit now and then.
        near(&object["sim_time"], *t, 4.0 * f64::EPSILON);
        near(&object["angular_velocity"][1], *y, f64::EPSILON);
        assert_eq!(object["body"], "top");
    }
    let (code, _, wrong) = torquescope(
        path,
        &[
            "inspect",
            "top.rrd",
            "--export",
            "parquet",
            "--out",
            "top.parquet",
        ],
    );
    assert_eq!(code, 0, "{wrong}");
    let file = std::fs::File::open(path.join("top.parquet")).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let names = reader
        .metadata()
        .file_metadata()
        .schema_descr()
        .columns()
        .to_vec();
    let names: Vec<&str> = names.iter().map(|column| column.name()).collect();
    assert_eq!(names, header);
    let mut count = 0;
    for (row, (t, omega)) in reader.get_row_iter(None).unwrap().zip(&rows) {
        let row = row.unwrap();
        assert_eq!(
            (row.get_double(time).unwrap(), row.get_double(y).unwrap()),
            (*t, *omega)
        );
        assert_eq!(row.get_string(1).unwrap(), "top");
        count += 1;
    }
    assert_eq!(count, rows.len());
    // What is something else is not written over, an earlier result is.
    for (out, code) in [("top.rrd", 2), ("top.toml", 2), ("top.parquet", 0)] {
        let (got, _, wrong) = torquescope(
            path,
            &["inspect", "top.rrd", "--export", "parquet", "--out", out],
        );
        assert_eq!(got, code, "{wrong}");
    }
    let (code, said, _) = torquescope(
        path,
        &["inspect", "top.rrd", "--plot", "angular_velocity.top"],
    );
    assert_eq!(
        (code, said.as_str()),
        (0, "angular_velocity.top.svg: 4 lines\n")
    );
    let svg = std::fs::read_to_string(path.join("angular_velocity.top.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("rad/s") && svg.contains("angular_velocity.x"));
    assert!(!svg.contains("NaN"));
}

#[test]
fn what_is_not_there_is_told_with_what_was_meant() {
    let folder = with_top();
    for (arguments, part) in [
        (
            &["--when", "angular_velocty > 1"][..],
            "column 1: no quantity is called `angular_velocty`; did you mean `angular_velocity`?",
        ),
        (
            &["--when", "torque.tpo > 1"],
            "column 8: no body is called `tpo`; did you mean `top`?",
        ),
        (&["--when", "step time > 1"], "stream `step_time`"),
        (
            &["--plot", "torque.top.w"],
            "column 12: `torque` has no component `w`",
        ),
        (&["--body", "tip", "--at", "1"], "did you mean `top`?"),
        (&["--recording", "2"], "it holds 1"),
        (&["--timeline", "sim_tim"], "did you mean `sim_time`?"),
        (&["--at", "nan"], "is no time"),
        (&["--out", "x.csv"], "add one of them"),
        (&["--export", "parquet"], "--out FILE"),
    ] {
        let (code, said, wrong) = torquescope(
            folder.path(),
            &[&["inspect", "top.rrd"], arguments].concat(),
        );
        assert_eq!((code, said.as_str()), (2, ""), "{arguments:?}: {wrong}");
        assert!(wrong.contains(part), "{arguments:?}: {wrong}");
    }
}

/// A recording as another program makes it: turning about z at 1 rad/s, moving along x at 2 m/s.
fn foreign(path: &Path) {
    let stream = rerun::RecordingStreamBuilder::new("someone")
        .save(path)
        .unwrap();
    for k in 0..=200 {
        let t = f64::from(k) / 100.0;
        stream.set_duration_secs("seconds", t);
        let (sin, cos) = (0.5 * t).sin_cos();
        let turn = rerun::Quaternion::from_xyzw([0.0, 0.0, sin as f32, cos as f32]);
        let pose =
            rerun::Transform3D::from_translation_rotation([(2.0 * t) as f32, 0.0, 0.0], turn);
        stream.log("world/top", &pose).unwrap();
        let axis =
            rerun::RotationAxisAngle::new([0.0, 0.0, 2.0], rerun::Angle::from_radians(t as f32));
        stream
            .log("world/other.one", &rerun::Transform3D::from_rotation(axis))
            .unwrap();
    }
    let fixed = rerun::Transform3D::from_translation([1.0, 2.0, 3.0]);
    stream.log_static("world/fixed", &fixed).unwrap();
    stream.flush_blocking().unwrap();
}

#[test]
fn recordings_of_others() {
    let folder = tempfile::tempdir().unwrap();
    foreign(&folder.path().join("f.rrd"));
    let report = json(folder.path(), &["inspect", "f.rrd"]);
    let recording = &report["recordings"][0];
    assert_eq!(
        (&recording["application"], &recording["clock"]),
        (&"someone".into(), &"seconds".into())
    );
    let entities = recording["entities"].as_array().unwrap();
    let paths: Vec<&str> = entities
        .iter()
        .filter_map(|entity| entity["path"].as_str())
        .collect();
    assert!(paths.contains(&"/world/top"), "{paths:?}");
    let found = json(
        folder.path(),
        &["inspect", "f.rrd", "--at", "1.505", "--body", "/world/top"],
    );
    let (place, turn) = (of(&found, "position"), of(&found, "orientation"));
    assert_eq!(place["at"], 1.5);
    // Logged as f32.
    near(&place["rows"][0][0], 3.0, 1e-6);
    near(&turn["rows"][0][2], 0.75_f64.sin(), 1e-7);
    let all = json(folder.path(), &["inspect", "f.rrd", "--at", "1.5"]);
    let other = all.as_array().unwrap().iter();
    let mut other =
        other.filter(|v| v["body"] == "/world/other.one" && v["quantity"] == "orientation");
    near(&other.next().unwrap()["rows"][0][2], 0.75_f64.sin(), 1e-7);
    let when = json(
        folder.path(),
        &[
            "inspect",
            "f.rrd",
            "--when",
            "position./world/top.x > 3.01 m",
        ],
    );
    assert_eq!(when["holds"][0]["begins"], 1.51);
    assert_eq!(when["holds"][0]["ends"], Value::Null);
}

#[test]
fn cut_broken_and_empty_files() {
    // Long enough for several chunks of everything.
    let long = TOP.replace("duration = 3\n", "duration = 20\n");
    let folder = folder_with(&[("top.toml", &long)]);
    let path = folder.path();
    let (code, _, wrong) = torquescope(path, &["run", "top.toml"]);
    assert_eq!(code, 0, "{wrong}");
    let bytes = std::fs::read(path.join("top.rrd")).unwrap();
    std::fs::write(path.join("cut.rrd"), &bytes[..bytes.len() / 2]).unwrap();
    let (code, said, wrong) = torquescope(path, &["inspect", "cut.rrd", "--json"]);
    assert_eq!(code, 1, "{wrong}");
    assert!(
        wrong.starts_with("cut.rrd: is cut or broken (") && wrong.lines().count() == 1,
        "{wrong}"
    );
    let report: Value = serde_json::from_str(&said).unwrap();
    assert!(report["cut"].is_string());
    let found = of(&report["recordings"][0]["extremes"], "angular_velocity");
    let rows = found["rows"].as_u64().unwrap();
    assert!((1000..20001).contains(&rows), "{rows}");
    near(&found["size"]["greatest"][0], 1.7, NEAR);
    for (name, content) in [
        ("empty.rrd", &b""[..]),
        ("text.rrd", b"no recording"),
        ("magic.rrd", b"RRF2"),
        ("start.rrd", &bytes[..2000]),
    ] {
        std::fs::write(path.join(name), content).unwrap();
        for arguments in [&["inspect", name][..], &["compare", name, "top.rrd"]] {
            let (code, said, wrong) = torquescope(path, arguments);
            assert_eq!((code, said.as_str()), (2, ""), "{name}: {wrong}");
            assert!(wrong.starts_with(name), "{wrong}");
        }
    }
    let (code, _, wrong) = torquescope(path, &["inspect", "nowhere.rrd"]);
    assert_eq!(code, 2);
    assert!(wrong.starts_with("nowhere.rrd: cannot be read"), "{wrong}");
    // Bytes turned over anywhere end in an exit code of ours.
    for k in 0..16 {
        let mut broken = bytes.clone();
        let at = bytes.len() * (2 * k + 1) / 32;
        broken[at..at + 3].iter_mut().for_each(|byte| *byte ^= 0x5a);
        std::fs::write(path.join("broken.rrd"), broken).unwrap();
        let (code, ..) = torquescope(path, &["inspect", "broken.rrd", "--at", "2"]);
        assert!((0..=2).contains(&code), "{code} at byte {at}");
    }
}

/// Turns about its axis z, at that rate.
fn spinning(name: &str, rate: f64, rows: u32) -> String {
    format!(
        "duration = 2\n[stepping]\nmethod = \"rkn6\"\nstep = 0.001\n[record]\nrate = {rows}\n[[body]]\nname = \"{name}\"\nmass = 1.0\ninertia = [1, 1, 2]\nangular_velocity = [0, 0, {rate:?}]\n"
    )
}

fn measure<'v>(report: &'v Value, quantity: &str) -> &'v Value {
    of(&report["pairs"][0]["quantities"], quantity)
}

#[test]
fn two_spins_part_as_their_rates_do() {
    let folder = folder_with(&[
        ("a.toml", &spinning("top", 1.0, 50)),
        ("b.toml", &spinning("top", 1.1, 50)),
        ("c.toml", &spinning("tip", 1.1, 37)),
    ]);
    let path = folder.path();
    let report = json(
        path,
        &["compare", "a.toml", "b.toml", "--tolerance", "0.05"],
    );
    assert_eq!(report["within"], false);
    let attitude = measure(&report, "orientation");
    // 0.1 t rad; above 0.05 first at the row after 0.5 s.
    near(&attitude["largest"], 0.2, 1e-12);
    near(&attitude["at"], 2.0, 0.0);
    near(&attitude["first"], 0.52, 1e-12);
    let omega = measure(&report, "angular_velocity");
    near(&omega["largest"], 0.1, 1e-12);
    near(&omega["part"], 0.1 / 1.1, 1e-12);
    near(
        &measure(&report, "kinetic_energy")["largest"],
        // I / 2 (1.1² - 1²)
        0.21,
        1e-12,
    );
    // In the recording, in degrees.
    let column = column(
        &path.join("compare.rrd"),
        "/difference/top-B",
        "attitude_difference",
    );
    assert_eq!(column.len(), 101);
    for (nanoseconds, degrees) in column {
        let want = (0.1 * nanoseconds as f64 / 1e9).to_degrees();
        assert!((degrees - want).abs() < 1e-10, "{degrees} is not {want}");
    }
    // By another rate and name: told aloud, and slerp follows an even turn exactly.
    let report = json(path, &["compare", "a.toml", "c.toml"]);
    let pair = &report["pairs"][0];
    assert_eq!(
        (&pair["by_name"], &pair["other"]),
        (&false.into(), &"tip".into())
    );
    assert!(pair["interpolated"].as_u64().unwrap() > 80, "{pair}");
    near(&measure(&report, "orientation")["largest"], 0.2, 1e-12);
    let (_, said, _) = torquescope(path, &["compare", "a.toml", "c.toml"]);
    assert!(
        said.contains("paired by their order, not by name") && said.contains("by slerp"),
        "{said}"
    );
    // The same a quarter of a second later is a quarter of a radian behind.
    let report = json(path, &["compare", "a.toml", "a.toml", "--shift", "0.24"]);
    near(&measure(&report, "orientation")["largest"], 0.24, 1e-12);
    assert_eq!(
        (&report["pairs"][0]["from"], &report["pairs"][0]["until"]),
        (&0.24.into(), &2.0.into())
    );
}

#[test]
fn exit_codes_of_a_comparison() {
    let folder = folder_with(&[
        ("a.toml", &spinning("top", 1.0, 500)),
        ("b.toml", &spinning("top", 1.1, 500)),
        // Long enough for several chunks of everything.
        (
            "long.toml",
            &spinning("top", 1.0, 500).replace("= 2\n", "= 20\n"),
        ),
    ]);
    let path = folder.path();
    torquescope(path, &["run", "a.toml"]);
    torquescope(path, &["run", "long.toml"]);
    let bytes = std::fs::read(path.join("long.rrd")).unwrap();
    std::fs::write(path.join("cut.rrd"), &bytes[..bytes.len() / 2]).unwrap();
    for (arguments, code, part) in [
        // A recording against the scene it was made from.
        (&["a.rrd", "a.toml", "--tolerance", "0"][..], 0, ""),
        (&["a.toml", "b.toml"], 0, ""),
        (&["a.toml", "b.toml", "--tolerance", "0.21"], 0, ""),
        (
            &["a.toml", "b.toml", "--tolerance", "0.19"],
            1,
            "orientation of top",
        ),
        (
            &[
                "a.toml",
                "b.toml",
                "--tolerance",
                "1",
                "--tolerance",
                "attitude=11.4deg",
            ],
            1,
            "orientation of top",
        ),
        (
            &[
                "a.toml",
                "b.toml",
                "--tolerance",
                "1",
                "--tolerance",
                "attitude=11.5deg",
            ],
            0,
            "",
        ),
        (
            &[
                "a.toml",
                "b.toml",
                "--tolerance",
                "1",
                "--tolerance",
                "angular velocity=0.09",
            ],
            1,
            "angular_velocity of top",
        ),
        (
            &["a.toml", "--method", "jolt,rk4", "--tolerance", "1e-3"],
            0,
            "",
        ),
        (
            &["cut.rrd", "long.toml", "--tolerance", "1e-9"],
            2,
            "is cut or broken",
        ),
        (
            &["cut.rrd", "b.toml", "--tolerance", "1e-9"],
            1,
            "above the tolerance",
        ),
        (&["a.toml"], 2, "one run only"),
        (
            &["a.toml", "b.toml", "--shift", "5"],
            2,
            "no body with an instant in common",
        ),
        (
            &["a.toml", "b.toml", "--shift", "1", "--shift", "1"],
            2,
            "--shift is given 2 times",
        ),
        (
            &["a.toml", "b.toml", "--tolerance", "much"],
            2,
            "write a number",
        ),
        (
            &["a.toml", "b.toml", "--tolerance", "torqe=1"],
            2,
            "did you mean `torque`?",
        ),
        (&["a.rrd", "b.toml", "--out", "a.rrd"], 2, "is what is run"),
        (
            &["a.toml", "b.toml", "--out", "b.toml"],
            2,
            "is no recording",
        ),
        (&["a.toml", "nowhere.toml"], 2, "nowhere.toml"),
    ] {
        let (got, _, wrong) = torquescope(path, &[&["compare"], arguments].concat());
        assert_eq!(got, code, "{arguments:?}: {wrong}");
        assert!(wrong.contains(part), "{arguments:?}: {wrong}");
        assert_eq!(code == 0, wrong.is_empty(), "{arguments:?}: {wrong}");
    }
}

#[test]
fn another_programs_recording_against_a_scene() {
    let scene = spinning("top", 1.0, 50).replace("mass = 1.0", "mass = 1.0\nvelocity = [2, 0, 0]");
    let folder = folder_with(&[("a.toml", &scene)]);
    foreign(&folder.path().join("f.rrd"));
    let report = json(
        folder.path(),
        &["compare", "a.toml", "f.rrd", "--tolerance", "1e-5"],
    );
    let pair = &report["pairs"][0];
    assert_eq!(
        (&pair["other"], &pair["by_name"]),
        (&"/world/top".into(), &true.into())
    );
    // f32: a pose is good to some 1e-7.
    for quantity in ["orientation", "position"] {
        let part = measure(&report, quantity)["part"].as_f64().unwrap();
        assert!(part < 1e-6, "{quantity}: {part}");
    }
    // With itself, what never moves included.
    let itself = ["compare", "f.rrd", "f.rrd", "--tolerance", "0"];
    let (code, said, wrong) = torquescope(folder.path(), &itself);
    assert_eq!((code, wrong.as_str()), (0, ""));
    assert_eq!(said.matches("no difference at all").count(), 3, "{said}");
    assert!(
        pair["not_compared"]
            .as_array()
            .unwrap()
            .contains(&"torque".into())
    );
}

/// ns and values of a column of numbers.
fn column(path: &Path, entity: &str, name: &str) -> Vec<(i64, f64)> {
    let file = std::fs::File::open(path).unwrap();
    let mut found = Vec::new();
    for message in DecoderApp::decode_lazy(BufReader::new(file)) {
        let LogMsg::ArrowMsg(store, message) = message.unwrap() else {
            continue;
        };
        let chunk = Chunk::from_arrow_msg(&message).unwrap();
        if !store.is_recording() || chunk.entity_path().to_string() != entity || chunk.is_static() {
            continue;
        }
        let times = chunk.timelines()[&"sim_time".into()].times_raw().to_vec();
        let id = rerun::ComponentIdentifier::try_new(name).unwrap();
        let list = chunk.components().get_array(id).unwrap();
        for (row, time) in times.into_iter().enumerate() {
            let value = list.value(row);
            let value = value.as_any().downcast_ref::<Float64Array>().unwrap();
            found.push((time, value.value(0)));
        }
    }
    found
}
