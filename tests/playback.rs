//! Values put in by arguments, sweeps, and recordings that are run again.
#![cfg(feature = "cli")]

use assert_cmd::Command;
use rerun::external::arrow::array::{
    Array, ArrayRef, Float64Array, ListArray, RecordBatch, StringArray, UInt64Array,
};
use rerun::external::re_log_encoding::{CrateVersion, DecoderApp, Encoder, EncodingOptions};
use rerun::external::re_log_types::{ArrowMsg, LogMsg};
use rerun::log::Chunk;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use torquescope::record;

/// A body pushed for 0.2 s from 0.05 s on, 0.4 s long.
const SCENE: &str = "duration = 0.4\n[effects]\ngyroscopic = true\ndamping = { angular = 0.5 }\n[[body]]\nname = \"a\"\nmass = 1.0\ninertia = [1, 2, 2.5]\nangular_velocity = [1, 0.1, 0]\n[[event]]\nat = 0.05\nfor = 0.2\nbody = \"a\"\nforce = [0, 0, 3.0]\npoint = { body = [0.5, 0.1, 0] }\n";

fn torquescope(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("torquescope").unwrap();
    command.current_dir(folder);
    command
}

fn folder_with(scene: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("s.toml"), scene).unwrap();
    folder
}

/// Exit code, stdout, stderr.
fn run(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    // Each recording takes the place of the last.
    let output = torquescope(folder)
        .args(["run", "--force"])
        .args(arguments)
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
    let code = output.status.code().unwrap();
    (code, text(&output.stdout), text(&output.stderr))
}

fn json(folder: &Path, arguments: &[&str]) -> serde_json::Value {
    let (code, said, wrong) = run(folder, &[arguments, &["--json"]].concat());
    assert!(code < 2, "{wrong}");
    serde_json::from_str(&said).unwrap()
}

fn vector(value: &serde_json::Value) -> [f64; 3] {
    serde_json::from_value(value.clone()).unwrap()
}

fn messages(path: &Path) -> Vec<LogMsg> {
    let file = std::fs::File::open(path).unwrap();
    let decoder = DecoderApp::decode_lazy(BufReader::new(file));
    decoder.map(Result::unwrap).collect()
}

fn write(path: &Path, messages: &[LogMsg]) {
    let file = std::fs::File::create(path).unwrap();
    let options = EncodingOptions::PROTOBUF_COMPRESSED;
    let mut encoder = Encoder::new_eager(CrateVersion::LOCAL, options, file).unwrap();
    for message in messages {
        encoder.append(message).unwrap();
    }
    encoder.finish().unwrap();
}

/// Step and values of a column of f64, by recording.
fn column(path: &Path, entity: &str, name: &str) -> Vec<Vec<(i64, Vec<f64>)>> {
    let mut stores = Vec::new();
    let mut columns: Vec<Vec<(i64, Vec<f64>)>> = Vec::new();
    for message in messages(path) {
        let LogMsg::ArrowMsg(store, message) = message else {
            continue;
        };
        let chunk = Chunk::from_arrow_msg(&message).unwrap();
        if !store.is_recording() || chunk.entity_path().to_string() != entity || chunk.is_static() {
            continue;
        }
        if !stores.contains(&store) {
            stores.push(store.clone());
            columns.push(Vec::new());
        }
        let index = stores.iter().position(|known| *known == store).unwrap();
        let steps = chunk.timelines()[&"step".into()].times_raw().to_vec();
        let list = chunk
            .components()
            .get_array(rerun::ComponentIdentifier::try_new(name).unwrap())
            .unwrap();
        for (row, step) in steps.into_iter().enumerate() {
            let value = list.value(row);
            let value = value.as_any().downcast_ref::<Float64Array>().unwrap();
            columns[index].push((step, value.values().to_vec()));
        }
    }
    columns
}

/// Rewrites one column of the chunks of an entity.
fn tamper(
    from: &Path,
    to: &Path,
    entity: &str,
    column: &str,
    change: impl Fn(&ListArray) -> Option<ArrayRef>,
) {
    let mut changed = 0;
    let tampered = messages(from).into_iter().map(|message| {
        let LogMsg::ArrowMsg(store, message) = message else {
            return message;
        };
        let chunk = Chunk::from_arrow_msg(&message).unwrap();
        let index = message.batch.schema().index_of(column);
        let (true, Ok(index)) = (chunk.entity_path().to_string() == entity, index) else {
            return LogMsg::ArrowMsg(store, message);
        };
        let mut columns = message.batch.columns().to_vec();
        let list = columns[index].as_any().downcast_ref::<ListArray>().unwrap();
        if let Some(other) = change(list) {
            columns[index] = other;
            changed += 1;
        }
        let batch = RecordBatch::try_new(message.batch.schema(), columns).unwrap();
        let chunk_id = message.chunk_id;
        LogMsg::ArrowMsg(
            store,
            ArrowMsg {
                chunk_id,
                batch,
                on_release: None,
            },
        )
    });
    let tampered: Vec<LogMsg> = tampered.collect();
    assert!(
        changed > 0,
        "nothing to tamper with in {column} of {entity}"
    );
    write(to, &tampered);
}

fn with_values(list: &ListArray, values: ArrayRef) -> Option<ArrayRef> {
    let rerun::external::arrow::datatypes::DataType::List(field) = list.data_type() else {
        return None;
    };
    let list = ListArray::new(field.clone(), list.offsets().clone(), values, None);
    Some(Arc::new(list))
}

fn with_text(list: &ListArray, change: impl Fn(&str) -> String) -> Option<ArrayRef> {
    let texts = list
        .values()
        .as_any()
        .downcast_ref::<StringArray>()
        .unwrap();
    let texts: Vec<String> = texts.iter().flatten().map(change).collect();
    with_values(list, Arc::new(StringArray::from(texts)))
}

#[test]
fn a_mass_that_is_set_moves_accordingly() {
    let folder = folder_with(SCENE);
    for mass in [1.0, 2.0, 0.25] {
        let set = format!("body.a.mass={mass}");
        let report = json(folder.path(), &["s.toml", "--set", &set]);
        // v = F t / m: 200 steps of 1 ms, each rounded once.
        let v = vector(&report["bodies"][0]["velocity"]);
        let want = 3.0 * 0.2 / mass;
        assert!((v[2] - want).abs() <= 200.0 * f64::EPSILON * want, "{v:?}");
        assert_eq!(v[..2], [0.0, 0.0]);
    }
}

#[test]
fn what_is_set_is_run_stored_and_named() {
    let folder = folder_with(SCENE);
    let arguments = [
        "s.toml",
        "--method",
        "jolt",
        "--step=0.002",
        "--until",
        "0.1",
        "--speed",
        "0.25",
        "--set",
        "title=spun up",
    ];
    let report = json(folder.path(), &arguments);
    assert_eq!(report["method"], "jolt");
    assert_eq!(report["step"], 0.002);
    assert_eq!(report["steps"], 50);
    assert_eq!(report["title"], "spun up");
    let variant =
        "title = \"spun up\", stepping.method = \"jolt\", stepping.step = 0.002, until 0.1 s";
    assert_eq!(report["variant"], variant);
    let made = record::read(&folder.path().join("s.rrd")).unwrap();
    let text = &made.recordings[0].text;
    let scene = torquescope::scene::Scene::parse("s", "s", text).unwrap();
    assert_eq!((scene.duration, scene.step), (0.1, 0.002));
    assert!(text.contains("mass = 1.0\ninertia = [1, 2, 2.5]"), "{text}");
    // It opens at that speed.
    let speeds: Vec<f64> = messages(&folder.path().join("s.rrd"))
        .iter()
        .filter_map(|message| match message {
            LogMsg::ArrowMsg(store, message) if store.is_blueprint() => {
                let column = message
                    .batch
                    .column_by_name("TimePanelBlueprint:playback_speed")?;
                let list = column.as_any().downcast_ref::<ListArray>()?.value(0);
                Some(list.as_any().downcast_ref::<Float64Array>()?.value(0))
            }
            _ => None,
        })
        .collect();
    assert_eq!(speeds, [0.25]);
    // An accuracy takes the place of a method.
    let report = json(
        folder.path(),
        &["s.toml", "--set", "method=rk4", "--accuracy", "1e-6"],
    );
    assert_eq!(report["method"], "chosen by accuracy");
}

#[test]
fn a_scene_that_ends_earlier_leaves_out_what_would_come_later() {
    let folder = folder_with(SCENE);
    let report = json(folder.path(), &["s.toml", "--until", "0.04"]);
    assert_eq!(report["blows"].as_array().unwrap().len(), 0);
    let report = json(folder.path(), &["s.toml", "--until", "0.8"]);
    assert_eq!(report["steps"], 800);
    assert_eq!(report["blows"].as_array().unwrap().len(), 1);
}

#[test]
fn what_cannot_be_set_is_told_at_its_argument() {
    let folder = folder_with(SCENE);
    for (arguments, message) in [
        (
            vec!["--set", "body.b.mass=1"],
            "--set body.b.mass=1: no body is called `b`; did you mean `a`?\n",
        ),
        (
            vec!["--set", "bdy.a.mass=1"],
            "--set bdy.a.mass=1: unknown path `bdy.a.mass`; did you mean `body`?\n",
        ),
        (
            vec!["--set", "body.a.mass=-1"],
            "--set body.a.mass=-1: mass = -1 must be above zero (kg)\n",
        ),
        (
            vec!["--set", "body.a.mas=1"],
            "--set body.a.mas=1: unknown key `mas` in [[body]]; did you mean `mass`?\n",
        ),
        (
            vec!["--set", "event.0.force=[1, 2"],
            "--set event.0.force=[1, 2: the value is not TOML: unclosed array, expected `]`\n",
        ),
        (
            vec!["--set", "body.a.mass"],
            "--set body.a.mass: has no value; write PATH=VALUE, such as body.cone.mass=2\n",
        ),
        (
            vec!["--until", "-1"],
            "--until -1: duration = -1.0 must be above zero (s)\n",
        ),
        (
            vec!["--method", "rk5"],
            "--method rk5: method = \"rk5\" is no method; did you mean `rk4`?\n",
        ),
        (
            vec!["--speed", "0"],
            "--speed 0.0 is no speed to play at; write a factor above 0, such as 0.5\n",
        ),
        (
            vec!["--verify"],
            "s.toml is a scene; --verify takes a recording of one\n",
        ),
        // Two at once, and one in the file, at its own line though others were put in before it.
        (
            vec!["--set", "step=-1", "--set", "title=3", "--set", "a.label=x"],
            "--set step=-1: step = -1 must be above zero (s)\n--set title=3: title = 3 is an integer, not a text in quotes\n",
        ),
    ] {
        let (code, said, wrong) = run(folder.path(), &[&["s.toml"], arguments.as_slice()].concat());
        assert_eq!(
            (code, said.as_str(), wrong.as_str()),
            (2, "", message),
            "{arguments:?}"
        );
    }
    assert!(!folder.path().join("s.rrd").exists());
    let wrong = folder_with(&SCENE.replace("inertia = [1, 2, 2.5]", "inertia = [1, 2, 3.5]"));
    let (_, _, said) = run(wrong.path(), &["s.toml", "--set", "stepping.step=0.01"]);
    assert!(said.starts_with("s.toml:8:11: inertia = "), "{said}");
}

#[test]
fn each_value_of_a_sweep_does_what_theory_says() {
    let folder = tempfile::tempdir().unwrap();
    let scene = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("scenes/spin_down.toml");
    let reports = json(folder.path(), &[scene.to_str().unwrap()]);
    let reports = reports.as_array().unwrap();
    assert_eq!(reports.len(), 3);
    let columns = column(
        &folder.path().join("spin_down.rrd"),
        "/bodies/wheel",
        "angular_velocity",
    );
    assert_eq!(columns.len(), 3);
    for ((rate, rows), report) in [0.0, 0.1, 0.4].into_iter().zip(&columns).zip(reports) {
        assert_eq!(report["variant"], format!("damping = {rate:?}"));
        assert_eq!(rows.len(), 2001);
        for (step, omega) in rows {
            // ω(t) = ω₀ e^(-c t); a rounding a step.
            let want = 10.0 * (-rate * 0.001 * *step as f64).exp();
            assert!(
                (omega[1] - want).abs() <= 2000.0 * f64::EPSILON * want,
                "{rate} {step}"
            );
            assert_eq!((omega[0], omega[2]), (0.0, 0.0));
        }
    }
    // Each holds a scene of its own, which says nothing of the others.
    let made = record::read(&folder.path().join("spin_down.rrd")).unwrap();
    assert_eq!(made.recordings.len(), 3);
    for (rate, from) in ["0.0", "0.1", "0.4"].into_iter().zip(&made.recordings) {
        assert_eq!(
            from.fact("variant"),
            Some(format!("damping = {rate}").as_str())
        );
        let value = format!("damping = {{ angular = {rate} }}");
        assert!(
            from.text.contains(&value) && from.text.contains("\n# [sweep]\n# damping = ["),
            "{}",
            from.text
        );
    }
    let (code, said, wrong) = run(folder.path(), &["spin_down.rrd", "--verify"]);
    assert_eq!((code, said.lines().count()), (0, 3), "{said}{wrong}");
}

#[test]
fn a_sweep_over_several_keys_is_every_value_with_every_other() {
    let sweep = "[sweep]\ndamping = [0.0, 0.1]\n\"body.a.mass\" = [1, 2, 3]\n";
    let folder = folder_with(&format!("{SCENE}{sweep}"));
    let reports = json(folder.path(), &["s.toml", "--until=0.1"]);
    let variants: Vec<&str> = reports
        .as_array()
        .unwrap()
        .iter()
        .map(|r| r["variant"].as_str().unwrap())
        .collect();
    let want = [
        "0.0, body.a.mass = 1",
        "0.0, body.a.mass = 2",
        "0.0, body.a.mass = 3",
        "0.1, body.a.mass = 1",
        "0.1, body.a.mass = 2",
        "0.1, body.a.mass = 3",
    ];
    assert_eq!(
        variants,
        want.map(|v| format!("until 0.1 s, damping = {v}"))
    );
    // Without quotes a path is tables in tables; it is read alike.
    let folder = folder_with(&format!("{SCENE}[sweep]\nbody.a.mass = [1, 2]\n"));
    assert_eq!(
        json(folder.path(), &["s.toml"]).as_array().unwrap().len(),
        2
    );
}

#[test]
fn a_wrong_sweep_is_told_at_its_value() {
    for (sweep, message) in [
        (
            "damping = [0.0, -0.1]",
            "s.toml:17:17: damping = { angular = -0.1 }: angular = -0.1 1/s would make velocities grow",
        ),
        (
            "damping = 0.1",
            "s.toml:17:11: damping = 0.1 is no list of values",
        ),
        (
            "damping = []",
            "s.toml:17:11: damping = [] is no list of values",
        ),
        (
            "dampings = [1]",
            "s.toml:17:1: unknown path `dampings`; did you mean `damping`?",
        ),
        (
            "damping = [0.1, 0.1]",
            "s.toml:17:17: the sweep has damping = 0.1 twice",
        ),
        (
            "damping = [0.1, 1]\nbody.a.mass = [1, \"heavy\"]",
            "s.toml:18:19: mass = \"heavy\"",
        ),
        ("", "s.toml:16:1: the sweep has no values"),
    ] {
        let folder = folder_with(&format!("{SCENE}[sweep]\n{sweep}\n"));
        for verb in ["run", "check"] {
            let output = torquescope(folder.path())
                .args([verb, "s.toml"])
                .output()
                .unwrap();
            let said = String::from_utf8(output.stderr).unwrap();
            assert_eq!(output.status.code(), Some(2), "{sweep}");
            assert!(said.starts_with(message), "{sweep}: {said}");
        }
    }
    let many: Vec<String> = (0..100).map(|k| k.to_string()).collect();
    let folder = folder_with(&format!(
        "{SCENE}[sweep]\nbody.a.mass = [{}]\n",
        many.join(",")
    ));
    let (_, _, said) = run(folder.path(), &["s.toml"]);
    assert!(
        said.starts_with("s.toml:16:1: the sweep is 100 recordings"),
        "{said}"
    );
}

#[test]
fn a_recording_run_again_gives_the_same_bits() {
    let folder = folder_with(SCENE);
    run(folder.path(), &["s.toml", "--set", "damping=0.25"]);
    let recorded = std::fs::read(folder.path().join("s.rrd")).unwrap();
    // The scene's file is not needed.
    std::fs::remove_file(folder.path().join("s.toml")).unwrap();
    let (code, said, wrong) = run(folder.path(), &["s.rrd", "--verify"]);
    assert_eq!(code, 0, "{wrong}");
    // At 60 Hz from 0 to 0.4 s, and once more where the push has begun and ended.
    let hashes = "and 27 hashes of all states, up to step 400, t = 0.4 s";
    assert!(
        said.starts_with("s.rrd, effects.damping")
            || said.starts_with("s.rrd, damping = 0.25: the same bits: "),
        "{said}"
    );
    assert!(said.contains(hashes), "{said}");
    // Again, into a file of its own, changed or not.
    assert_eq!(run(folder.path(), &["s.rrd"]).0, 0);
    let (old, new) = ("s.rrd", "s-again.rrd");
    let spin = |file: &str| column(&folder.path().join(file), "/bodies/a", "angular_velocity");
    assert_eq!(spin(old), spin(new));
    let (code, _, wrong) = run(folder.path(), &["s.rrd", "--out", "s.rrd"]);
    assert_eq!(
        (code, wrong.as_str()),
        (
            2,
            "s.rrd is what is run; choose another name for the new recording\n"
        )
    );
    let report = json(
        folder.path(),
        &["s.rrd", "--set", "damping=0.5", "--until", "0.1"],
    );
    assert_eq!(
        report["variant"],
        "damping = 0.25, damping = 0.5, until 0.1 s"
    );
    assert_ne!(spin(old), spin(new));
    let (code, _, _) = run(
        folder.path(),
        &["s.rrd", "--verify", "--set", "damping=0.5"],
    );
    assert_eq!(code, 2);
    assert_eq!(
        std::fs::read(folder.path().join("s.rrd")).unwrap(),
        recorded
    );
}

#[test]
fn a_run_that_lost_its_state_loses_it_again() {
    let scene = "duration = 10.0\n[stepping]\nmethod = \"semi-implicit\"\nstep = 0.01\n[effects]\ngyroscopic = true\n[[body]]\nname = \"top\"\nmass = 1.0\ninertia = [1, 2, 2.5]\nangular_velocity = [90, 20, -60]\n";
    let folder = folder_with(scene);
    assert_eq!(run(folder.path(), &["s.toml"]).0, 1);
    let (code, said, wrong) = run(folder.path(), &["s.rrd", "--verify"]);
    assert_eq!(code, 0, "{said}{wrong}");
}

#[test]
fn a_number_that_was_changed_is_found_where_it_is() {
    let folder = folder_with(SCENE);
    run(folder.path(), &["s.toml"]);
    let at = |name: &str| folder.path().join(name);
    tamper(
        &at("s.rrd"),
        &at("changed.rrd"),
        "/bodies/a",
        "angular_velocity",
        |list| {
            let values = list
                .values()
                .as_any()
                .downcast_ref::<Float64Array>()
                .unwrap();
            let mut values = values.values().to_vec();
            // The last bit of ω_z after step 123 (two rows at step 50 and at 250).
            let slot = 3 * 124 + 2;
            values[slot] = f64::from_bits(values[slot].to_bits() ^ 1);
            with_values(list, Arc::new(Float64Array::from(values)))
        },
    );
    let report = json(
        folder.path(),
        &["changed.rrd", "--verify", "--out", "again.rrd"],
    );
    assert_eq!(report["same"], false);
    let difference = &report["recordings"][0]["difference"];
    let steps: Vec<i64> = column(&at("s.rrd"), "/bodies/a", "angular_velocity")[0]
        .iter()
        .map(|row| row.0)
        .collect();
    assert_eq!(difference["step"], steps[124]);
    assert_eq!(difference["body"], "a");
    assert_eq!(difference["quantity"], "angular_velocity.z");
    assert_ne!(difference["recorded"], difference["again"]);
    // The states themselves were not touched.
    assert_eq!(difference["hash_differs_from"], serde_json::Value::Null);
    let (code, said, wrong) = run(folder.path(), &["changed.rrd", "--verify"]);
    assert_eq!(code, 1);
    assert!(
        said.contains(&format!(
            "differs at step {}, t = 0.{} s: angular_velocity.z of a is ",
            steps[124], steps[124]
        )),
        "{said}"
    );
    assert!(
        wrong.starts_with("changed.rrd: run again it does not give the same bits"),
        "{wrong}"
    );
    // The new run has a mark there.
    let marks: Vec<i64> = messages(&at("again.rrd"))
        .iter()
        .filter_map(|message| {
            let LogMsg::ArrowMsg(_, message) = message else {
                return None;
            };
            let chunk = Chunk::from_arrow_msg(message).unwrap();
            let here = chunk.entity_path().to_string() == "/events/verify";
            here.then(|| chunk.timelines()[&"step".into()].times_raw()[0])
        })
        .collect();
    assert_eq!(marks, [steps[124]]);
}

#[test]
fn a_hash_that_was_changed_is_found_between_its_neighbours() {
    let folder = folder_with(SCENE);
    run(folder.path(), &["s.toml"]);
    let at = |name: &str| folder.path().join(name);
    tamper(
        &at("s.rrd"),
        &at("changed.rrd"),
        "/hashes",
        "state",
        |list| {
            let values = list
                .values()
                .as_any()
                .downcast_ref::<UInt64Array>()
                .unwrap();
            let mut values = values.values().to_vec();
            values[3] ^= 1 << 63;
            with_values(list, Arc::new(UInt64Array::from(values)))
        },
    );
    let report = json(folder.path(), &["changed.rrd", "--verify"]);
    let difference = &report["recordings"][0]["difference"];
    assert_eq!(difference["quantity"], "the hash of all states");
    // Hashes at 60 Hz: steps 0, 17, 34, 50 (the push begins), …
    assert_eq!(
        (
            &difference["hash_agrees_until"],
            &difference["hash_differs_from"]
        ),
        (&34.into(), &50.into())
    );
}

#[test]
fn another_scene_is_found_where_its_motion_parts() {
    let folder = folder_with(SCENE);
    run(folder.path(), &["s.toml"]);
    let at = |name: &str| folder.path().join(name);
    tamper(
        &at("s.rrd"),
        &at("changed.rrd"),
        "/scene",
        "TextDocument:text",
        |list| {
            with_text(list, |text| {
                text.replace("force = [0, 0, 3.0]", "force = [0, 0, 3.5]")
            })
        },
    );
    let report = json(folder.path(), &["changed.rrd", "--verify"]);
    let one = &report["recordings"][0];
    assert_eq!(
        (&one["same"], &one["text_changed"]),
        (&false.into(), &true.into())
    );
    // The push begins at step 50: what it does is other at once, the states after the next step.
    let difference = &one["difference"];
    assert_eq!(
        (&difference["step"], &difference["body"]),
        (&50.into(), &"a".into())
    );
    assert!(
        ["force.z", "torque.x"].contains(&difference["quantity"].as_str().unwrap())
            || difference["quantity"]
                .as_str()
                .unwrap()
                .starts_with("force"),
        "{difference}"
    );
    assert_eq!(
        (
            &difference["hash_agrees_until"],
            &difference["hash_differs_from"]
        ),
        (&50.into(), &67.into())
    );
    // A word in a comment changes the text and not the motion.
    tamper(
        &at("s.rrd"),
        &at("comment.rrd"),
        "/scene",
        "TextDocument:text",
        |list| with_text(list, |text| format!("{text}# A word.\n")),
    );
    let report = json(folder.path(), &["comment.rrd", "--verify"]);
    assert_eq!(
        (&report["same"], &report["recordings"][0]["text_changed"]),
        (&true.into(), &true.into())
    );
}

#[test]
fn what_cannot_be_verified_is_refused_with_what_differs() {
    let folder = folder_with(SCENE);
    run(folder.path(), &["s.toml"]);
    let at = |name: &str| folder.path().join(name);
    tamper(
        &at("s.rrd"),
        &at("old.rrd"),
        "/__properties/torquescope",
        "torquescope:version",
        |list| with_text(list, |_| "0.0.7".to_owned()),
    );
    let (code, said, wrong) = run(folder.path(), &["old.rrd", "--verify"]);
    assert_eq!((code, said.as_str()), (2, ""));
    let want = format!(
        "old.rrd: cannot be verified: version: 0.0.7 there, {} here;",
        env!("CARGO_PKG_VERSION")
    );
    assert!(wrong.starts_with(&want), "{wrong}");
    // Run again it is all the same.
    assert_eq!(run(folder.path(), &["old.rrd"]).0, 0);

    tamper(
        &at("s.rrd"),
        &at("other.rrd"),
        "/scene",
        "TextDocument:text",
        |list| {
            with_text(list, |text| {
                format!("stepping = {{ method = \"jolt\", step = 0.002 }}\n{text}")
            })
        },
    );
    let (code, _, wrong) = run(folder.path(), &["other.rrd", "--verify"]);
    let want = "other.rrd: cannot be verified: method: rk4 there, jolt here; step: 0.001 there, 0.002 here\n";
    assert_eq!((code, wrong.as_str()), (2, want));

    tamper(
        &at("s.rrd"),
        &at("none.rrd"),
        "/scene",
        "TextDocument:text",
        |list| with_text(list, |_| "mass = 1".to_owned()),
    );
    let (code, _, wrong) = run(folder.path(), &["none.rrd", "--verify"]);
    assert_eq!(code, 2);
    assert!(
        wrong.starts_with("none.rrd (its scene):1:1: ")
            && wrong.contains("none.rrd: cannot be verified"),
        "{wrong}"
    );
}

#[test]
fn recordings_of_others_and_cut_or_broken_files() {
    let folder = folder_with(&SCENE.replace("duration = 0.4", "duration = 0.06"));
    run(folder.path(), &["s.toml"]);
    let at = |name: &str| folder.path().join(name);
    let stream = rerun::RecordingStreamBuilder::new("somebody_else")
        .save(at("foreign.rrd"))
        .unwrap();
    stream
        .log("a", &rerun::archetypes::TextLog::new("hello"))
        .unwrap();
    drop(stream);
    std::fs::write(
        at("garbage.rrd"),
        b"RRF2 and then something else altogether",
    )
    .unwrap();
    std::fs::write(at("text.rrd"), b"duration = 1").unwrap();
    std::fs::write(at("empty.rrd"), b"").unwrap();
    let whole = std::fs::read(at("s.rrd")).unwrap();
    std::fs::write(at("cut.rrd"), &whole[..whole.len() - 20_000]).unwrap();
    std::fs::write(at("start.rrd"), &whole[..2_000]).unwrap();
    for (file, message) in [
        (
            "foreign.rrd",
            "foreign.rrd: was made by `somebody_else`, not by torquescope",
        ),
        (
            "garbage.rrd",
            "garbage.rrd: is cut or broken before its scene: ",
        ),
        ("text.rrd", "text.rrd: is no Rerun recording"),
        ("empty.rrd", "empty.rrd: is no Rerun recording"),
        ("gone.rrd", "gone.rrd: cannot be read: "),
        (
            "start.rrd",
            "start.rrd: is cut or broken before its scene: ",
        ),
        (
            "cut.rrd",
            "cut.rrd: is cut or broken (it lacks the footer that rerun 0.36.3 ends a file with): what there is of it gives the same bits",
        ),
    ] {
        let (code, _, wrong) = run(folder.path(), &[file, "--verify"]);
        assert_eq!(code, 2, "{file}: {wrong}");
        assert!(wrong.starts_with(message), "{file}: {wrong}");
    }
    // What `cost` makes has no one scene.
    let (code, _, wrong) = {
        let output = torquescope(folder.path())
            .args([
                "cost",
                "s.toml",
                "--methods",
                "rk4",
                "--longest",
                "0.01",
                "--repeats",
                "1",
            ])
            .output()
            .unwrap();
        assert!(output.status.success());
        run(folder.path(), &["s-cost.rrd"])
    };
    assert_eq!(code, 2);
    assert!(wrong.starts_with("s-cost.rrd: holds no scene"), "{wrong}");

    // Cut anywhere, or with any bit another: an answer or a reason, never a panic.
    let few =
        folder_with(&SCENE.replace("duration = 0.4", "duration = 0.06\n[record]\nstreams = []"));
    run(few.path(), &["s.toml"]);
    let whole = std::fs::read(few.path().join("s.rrd")).unwrap();
    let broken = at("broken.rrd");
    let mut read = 0;
    for cut in (0..whole.len()).step_by(whole.len() / 30) {
        std::fs::write(&broken, &whole[..cut]).unwrap();
        read += usize::from(record::read(&broken).is_ok_and(|made| made.cut.is_some()));
    }
    assert!(read > 3, "{read}");
    let mut random = 1_u64;
    for _ in 0..100 {
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let mut bytes = whole.clone();
        let place = (random >> 20) as usize % bytes.len();
        bytes[place] ^= 1 << (random >> 60 & 7);
        std::fs::write(&broken, bytes).unwrap();
        if let Ok(made) = record::read(&broken) {
            assert!(!made.recordings.is_empty());
        }
    }
}
