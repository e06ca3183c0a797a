//! What is said of scenes without running them: the schema, the warnings.

#[path = "common/json.rs"]
mod json;

use std::collections::BTreeSet;
use std::path::PathBuf;
use torquescope::scene::{Finding, Scene, Script, Severity, WARNINGS};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The scenes of a folder: name and text.
fn scenes(folder: &str) -> Vec<(String, String)> {
    let mut all: Vec<(String, String)> = std::fs::read_dir(root().join(folder))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .map(|path| {
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            (name, std::fs::read_to_string(&path).unwrap())
        })
        .collect();
    all.sort();
    assert!(!all.is_empty(), "{folder}");
    all
}

/// Says why docs/scene.schema.json refuses a text; `None` where it takes it.
fn refusal(text: &str) -> Option<String> {
    let schema = std::fs::read_to_string(root().join("docs/scene.schema.json")).unwrap();
    let schema = serde_json::from_str(&schema).unwrap();
    let (mut schemas, mut compiler) = (boon::Schemas::new(), boon::Compiler::new());
    compiler.add_resource("scene.json", schema).unwrap();
    let index = compiler.compile("scene.json", &mut schemas).unwrap();
    let document = json::document(text)?;
    let why = schemas.validate(&document, index).err()?;
    Some(why.to_string())
}

#[test]
fn the_schema_takes_every_right_scene() {
    for folder in ["scenes", "tests/fixtures/right", "src/cli"] {
        for (name, text) in scenes(folder) {
            assert_eq!(refusal(&text), None, "{name}");
        }
    }
}

/// Wrong scenes whose fault a schema can see. Of meanings it knows nothing: numbers that contradict each
/// other, names that other tables give.
const OF_FORM: [&str; 9] = [
    "contradictions",
    "duplicate_name",
    "method_unknown",
    "not_finite",
    "nothing",
    "single_brackets",
    "unknown_key",
    "wrong_type",
    "zero_step",
];

#[test]
fn the_schema_refuses_what_a_schema_can_see() {
    let all = scenes("tests/fixtures/wrong");
    let mut count = 0;
    for (name, text) in all
        .iter()
        .filter(|(name, _)| OF_FORM.contains(&name.as_str()))
    {
        assert!(refusal(text).is_some(), "{name}");
        count += 1;
    }
    assert_eq!(count, OF_FORM.len());
}

fn warnings(source: &str) -> Vec<Finding> {
    match Script::new("s", "s", source).judge() {
        Ok((_, warnings)) => warnings,
        Err(problems) => panic!("{problems}\n{source}"),
    }
}

#[test]
fn shipped_scenes_have_no_warnings() {
    for folder in ["scenes", "tests/fixtures/right", "src/cli"] {
        for (name, _) in scenes(folder) {
            let path = root().join(folder).join(format!("{name}.toml"));
            let judged = Script::load(&path).unwrap().judge();
            let (_, warnings) = judged.unwrap_or_else(|why| panic!("{why}"));
            let found: Vec<String> = warnings.iter().map(Finding::to_string).collect();
            assert!(found.is_empty(), "{name}: {found:#?}");
        }
    }
}

/// A scene of one body. `top` goes above its tables, `body` into the body, `rest` below.
fn one(top: &str, body: &str, rest: &str) -> String {
    format!("duration = 2.0\n{top}\n[[body]]\nname = \"b\"\n{body}\n{rest}")
}

const BOX: &str = "shape = { cuboid = { x = 1.0, y = 2.0, z = 3.0 } }\nmass = 12.0\n";
const WHEEL: &str = "shape = { cylinder = { radius = 1.0, height = 0.5 } }\nmass = 12.0\n";

/// Each warning: a scene that has it, what stands there, and a scene near it that is right.
fn cases() -> Vec<(&'static str, String, &'static str, String)> {
    let body = |more: &str| format!("{BOX}{more}");
    let wheel = |more: &str| format!("{WHEEL}{more}");
    let push = |more: &str| format!("[[event]]\nat = 0.5\nbody = \"b\"\n{more}");
    let real = "[effects]\ngyroscopic = true";
    vec![
        (
            "gyroscopic-off",
            one("", &body("angular_velocity = [0.01, 1.0, 0.0]"), ""),
            "[0.01, 1.0, 0.0]",
            one("", &body("angular_velocity = [0.0, 1.0, 0.0]"), ""),
        ),
        (
            // Two jolts, each about a principal axis, make a spin that is about none.
            "gyroscopic-off",
            one(
                "",
                BOX,
                &(push("torque = [1, 0, 0]\n") + &push("torque = [0, 1, 0]\n")),
            ),
            "{ cuboid = { x = 1.0, y = 2.0, z = 3.0 } }",
            one(
                "",
                BOX,
                &(push("torque = [1, 0, 0]\n") + &push("torque = [-2, 0, 0]\n")),
            ),
        ),
        (
            "gyroscopic-off",
            one("", &wheel("angular_velocity = [1.0, 1.0, 0.0]"), ""),
            "[1.0, 1.0, 0.0]",
            one(real, &wheel("angular_velocity = [1.0, 1.0, 0.0]"), ""),
        ),
        (
            // 2π/30 s is a turn, a tenth of it 0.0209 s.
            "coarse-step",
            one(
                "[stepping]\nstep = 0.022\n[record]\nrate = 40",
                &wheel("angular_velocity = [0, 30, 0]"),
                "",
            ),
            "0.022",
            one(
                "[stepping]\nstep = 0.0205\n[record]\nrate = 40",
                &wheel("angular_velocity = [0, 30, 0]"),
                "",
            ),
        ),
        (
            // A pendulum: √(m g l/I) with l = 1 m, I = m ((1 + 4)/12 + 1) m² about z; a tenth of its period is 0.239 s.
            "coarse-step",
            one(
                "[stepping]\nstep = 0.3\n[record]\nrate = 3\n[effects]\ngyroscopic = true\ngravity = [0, -9.81, 0]",
                &body("pivot = [0.0, 1.0, 0.0]"),
                "",
            ),
            "0.3",
            one(
                "[stepping]\nstep = 0.2\n[record]\nrate = 3\n[effects]\ngyroscopic = true\ngravity = [0, -9.81, 0]",
                &body("pivot = [0.0, 1.0, 0.0]"),
                "",
            ),
        ),
        (
            // A spring of 400 N/m on 4 kg: √(k/m) = 10 rad/s, a tenth of a period is 0.0628 s.
            "coarse-step",
            one(
                "[stepping]\nstep = 0.064\n[record]\nrate = 10",
                "mass = 4.0\ninertia = [1, 1, 1]",
                "[[effect]]\nbodies = [\"b\"]\nspring = { anchor = [0, 1, 0], point = \"centre\", stiffness = 400.0, rest_length = 1.0 }",
            ),
            "0.064",
            one(
                "[stepping]\nstep = 0.062\n[record]\nrate = 10",
                "mass = 4.0\ninertia = [1, 1, 1]",
                "[[effect]]\nbodies = [\"b\"]\nspring = { anchor = [0, 1, 0], point = \"centre\", stiffness = 400.0, rest_length = 1.0 }",
            ),
        ),
        (
            // A motor that holds: √(k/I) = 10 rad/s about the softest axis. It is off at first.
            "coarse-step",
            one(
                "[stepping]\nstep = 0.064\n[record]\nrate = 10",
                "mass = 4.0\ninertia = [4, 4, 4]",
                "[[effect]]\nname = \"servo\"\non = false\nmotor = { orientation = [0, 0, 0, 1], stiffness = 400.0 }\n[[event]]\nat = 1.0\nswitch = { effect = \"servo\", on = true }",
            ),
            "0.064",
            one(
                "[stepping]\nstep = 0.064\n[record]\nrate = 10",
                "mass = 4.0\ninertia = [4, 4, 4]",
                "[[effect]]\nname = \"servo\"\non = false\nmotor = { orientation = [0, 0, 0, 1], stiffness = 400.0 }",
            ),
        ),
        (
            // A body with a method of its own goes by that.
            "coarse-step",
            one(
                "[stepping]\nmethod = \"dop853\"\nstep = 0.022\n[record]\nrate = 40",
                &wheel("angular_velocity = [0, 30, 0]\nmethod = \"rk4\""),
                "",
            ),
            "0.022",
            one(
                "[stepping]\nmethod = \"rk4\"\nstep = 0.022\n[record]\nrate = 40",
                &wheel("angular_velocity = [0, 30, 0]\nmethod = \"dop853\""),
                "",
            ),
        ),
        (
            // Gyroscopic for another body is not gyroscopic for this one.
            "gyroscopic-off",
            one(
                "",
                &body("angular_velocity = [0.01, 1.0, 0.0]"),
                "[[body]]\nname = \"c\"\nmass = 1\ninertia = [1, 1, 1]\n[[effect]]\nbodies = [\"c\"]\ngyroscopic = true",
            ),
            "[0.01, 1.0, 0.0]",
            one(
                "",
                &body("angular_velocity = [0.01, 1.0, 0.0]"),
                "[[body]]\nname = \"c\"\nmass = 1\ninertia = [1, 1, 1]\n[[effect]]\nbodies = [\"b\"]\ngyroscopic = true",
            ),
        ),
        (
            "slow-limit",
            one(
                "[effects]\nspeed_limit = { angular = 47.1 }",
                &wheel("angular_velocity = [0, 48, 0]"),
                "",
            ),
            "[0, 48, 0]",
            one(
                "[effects]\nspeed_limit = { angular = 47.1 }",
                &wheel("angular_velocity = [0, 47, 0]"),
                "",
            ),
        ),
        (
            "idle-event",
            one(
                "",
                WHEEL,
                "[[event]]\nat = 0.5\nevery = 0.1\nclick = { from = [9, 0, 0], toward = [0, 0, 0], force = 0 }",
            ),
            "{ from",
            one(
                "",
                WHEEL,
                "[[event]]\nat = 0.5\nevery = 0.1\nclick = { from = [9, 0, 0], toward = [0, 0, 0], force = 1 }",
            ),
        ),
        (
            "immovable",
            one(
                "",
                "mass = \"infinite\"",
                &push("force = [1, 0, 0]\npoint = \"centre\""),
            ),
            "[1, 0, 0]",
            one("", WHEEL, &push("force = [1, 0, 0]\npoint = \"centre\"")),
        ),
        (
            "immovable",
            one(
                "",
                &wheel("immovable = [\"x\", \"z\"]"),
                &push("torque = [3, 0, 4]"),
            ),
            "[3, 0, 4]",
            one(
                "",
                &wheel("immovable = [\"x\", \"z\"]"),
                &push("torque = [3, 1, 4]"),
            ),
        ),
        (
            "idle-event",
            one("", WHEEL, &push("torque = [0, 0.0, -0.0]")),
            "[0, 0.0, -0.0]",
            one("", WHEEL, &push("torque = [0, 1e-300, 0]")),
        ),
        (
            "idle-event",
            one(
                "",
                &wheel("pivot = \"top\""),
                &push("force = [5, 4, 3]\npoint = \"top\""),
            ),
            "\"top\"",
            one(
                "",
                &wheel("pivot = \"top\""),
                &push("force = [5, 0, 0]\npoint = \"bottom\""),
            ),
        ),
        (
            "cut-event",
            one("", WHEEL, &push("for = 2.0\ntorque = [0, 1, 0]")),
            "2.0",
            one("", WHEEL, &push("for = 1.5\ntorque = [0, 1, 0]")),
        ),
        (
            "far-pivot",
            one("", &wheel("pivot = [0, 500, 0]"), ""),
            "[0, 500, 0]",
            one("", &wheel("pivot = [0, 50, 0]"), ""),
        ),
        (
            "odd-inertia",
            one("", &body("inertia = [13e6, 10e6, 5e6]"), ""),
            "[13e6, 10e6, 5e6]",
            one("", &body("inertia = [13, 10, 5]"), ""),
        ),
        (
            "odd-inertia",
            one("", &body("inertia = [13e-3, 10e-3, 5e-3]"), ""),
            "[13e-3, 10e-3, 5e-3]",
            one("", &body("inertia = [26, 20, 10]"), ""),
        ),
        (
            "odd-density",
            one("", "shape = { sphere = { radius = 50 } }\nmass = 0.5", ""),
            "0.5",
            one("", "shape = { sphere = { radius = 0.05 } }\nmass = 0.5", ""),
        ),
        (
            "odd-density",
            one(
                "",
                "shape = { sphere = { radius = 0.05 } }\ndensity = 7850e3",
                "",
            ),
            "7850e3",
            one(
                "",
                "shape = { sphere = { radius = 0.05 } }\ndensity = 7850",
                "",
            ),
        ),
        (
            "quaternion-order",
            one("", &wheel("orientation = [1, 0, 0, 0]"), ""),
            "[1, 0, 0, 0]",
            one("", &wheel("orientation = [0, 0, 0, 1]"), ""),
        ),
        (
            "quaternion-length",
            one("", &wheel("orientation = [0, 0, 1, 1]"), ""),
            "[0, 0, 1, 1]",
            one("", &wheel("orientation = [0, 0, 0.707, 0.707]"), ""),
        ),
        (
            "rate-above-steps",
            one("[stepping]\nstep = 0.02\n[record]\nstate = 1000", WHEEL, ""),
            "1000",
            one("[stepping]\nstep = 0.01\n[record]\nstate = 100", WHEEL, ""),
        ),
        (
            "rate-above-steps",
            one("[stepping]\nstep = 0.02\n[record]\nrate = 60", WHEEL, ""),
            "60",
            one(
                "[stepping]\nstep = 0.016666666666666666\n[record]\nrate = 60",
                WHEEL,
                "",
            ),
        ),
        (
            "rate-above-steps",
            one(
                "[stepping]\nstep = 0.01\n[record]\nrates = { energy = 50, torque = 240 }",
                WHEEL,
                "",
            ),
            "240",
            one(
                "[stepping]\nstep = 0.01\n[record]\nrates = { energy = 50, torque = \"every\" }",
                WHEEL,
                "",
            ),
        ),
        (
            "unrecorded-rate",
            one(
                "[record]\nstreams = [\"torque\"]\nrates = { alpha = 5 }",
                WHEEL,
                "",
            ),
            "5",
            one(
                "[record]\nstreams = [\"torque\"]\nrates = { torque = 5 }",
                WHEEL,
                "",
            ),
        ),
        (
            "unused-allow",
            one("allow = [\"cut-event\"]", WHEEL, ""),
            "\"cut-event\"",
            one("allow = [\"cut-event\", \"unused-allow\"]", WHEEL, ""),
        ),
    ]
}

#[test]
fn every_warning_is_given_where_it_is_due_and_only_there() {
    let mut given = BTreeSet::new();
    for (code, wrong, marked, right) in cases() {
        let found = warnings(&wrong);
        assert_eq!(found.len(), 1, "{code}: {found:#?}\n{wrong}");
        let warning = &found[0];
        assert_eq!(
            (warning.code, warning.severity),
            (code, Severity::Warning),
            "{wrong}"
        );
        let from = warning.from.unwrap();
        let line = wrong.lines().nth(from.line - 1).unwrap();
        let place: String = line.chars().skip(from.column - 1).collect();
        assert!(place.starts_with(marked), "{code}: {place} is not {marked}");
        assert!(
            warning.remedy.is_some() && warning.picture.is_some(),
            "{warning}"
        );
        assert!(warning.line().ends_with(&format!("[{code}]")), "{warning}");
        let found: Vec<String> = warnings(&right).iter().map(Finding::to_string).collect();
        assert!(found.is_empty(), "{code}: {found:#?}\n{right}");
        // And it can be meant.
        if code != "unused-allow" {
            let meant = format!("allow = [\"{code}\"]\n{wrong}");
            assert_eq!(warnings(&meant), [], "{code}");
        }
        given.insert(code);
    }
    let all: BTreeSet<&str> = WARNINGS.iter().map(|warning| warning.code).collect();
    assert_eq!(given, all, "each warning has a case here");
}

#[test]
fn thousands_alike_are_told_three_times() {
    let push = "[[event]]\nat = 0.5\nbody = \"b\"\ntorque = [0, 0, 0]\n";
    let found = warnings(&one("", WHEEL, &push.repeat(1000)));
    assert_eq!(found.len(), 3);
    assert!(
        found[2].message.ends_with("(and 997 more like it)"),
        "{}",
        found[2]
    );
}

#[test]
fn a_warning_that_is_none_cannot_be_allowed() {
    let scene = one("allow = [\"coarse-steps\"]", WHEEL, "");
    let problems = Scene::parse("s", "s", &scene).err().unwrap().to_string();
    assert_eq!(
        problems,
        "s:2:10: \"coarse-steps\" is no warning; did you mean `coarse-step`?\n  2 | allow = [\"coarse-steps\"]\n    |          ^^^^^^^^^^^^^^"
    );
}

#[test]
fn what_is_for_editors_is_not_in_the_notes() {
    let scene = format!(
        "#:schema ./scene.schema.json\n# Look here\n{}",
        one("", WHEEL, "")
    );
    assert_eq!(
        Scene::parse("s", "s", &scene).ok().unwrap().notes,
        "Look here"
    );
}

#[test]
fn a_scene_without_end_is_refused_by_its_size_unread() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.toml");
    // 100 MB of nothing, which takes no room on the disk; read, it would be refused for what it holds.
    std::fs::File::create(&path)
        .unwrap()
        .set_len(100_000_000)
        .unwrap();
    let said = Script::load(&path).err().unwrap().to_string();
    assert!(said.contains("it is larger than any scene"), "{said}");
    let text = "#".repeat(1 << 24);
    let said = Scene::parse("s", "s", &text).err().unwrap().to_string();
    assert!(said.contains("is larger than any scene"), "{said}");
}

#[test]
fn a_swarm_is_told_once_by_its_fastest_body() {
    let swarm = "duration = 2.0\n[[swarm]]\nname = \"s\"\ncount = 1000\nshape = { cuboid = { x = 1.0, y = 2.0, z = 3.0 } }\nmass = 12.0\nrandom = { within = [9, 9, 9], spin = 3.0 }\n";
    let found = warnings(swarm);
    assert_eq!(found.len(), 1, "{found:#?}");
    assert_eq!(found[0].code, "gyroscopic-off");
    assert!(!found[0].message.contains("more like it"), "{}", found[0]);
    let (scenes, _) = Script::new("s", "s", swarm).judge().unwrap();
    let speed = |body: &torquescope::scene::Body| body.omega_w.norm();
    let bodies = &scenes[0].bodies;
    let fastest = bodies
        .iter()
        .max_by(|a, b| speed(a).total_cmp(&speed(b)))
        .unwrap();
    assert!(found[0].message.contains(&fastest.name), "{}", found[0]);
    // One of them that another effect acts on is another body.
    let two = format!("{swarm}[[effect]]\nbodies = [\"s_7\"]\ngyroscopic = true\n");
    assert_eq!(warnings(&two).len(), 1);
    let all = format!("{swarm}[effects]\ngyroscopic = true\n");
    assert_eq!(warnings(&all), []);
}

#[test]
fn a_sweep_is_told_by_its_values_and_each_place_once() {
    let scene = one(
        "allow = [\"gyroscopic-off\"]\n[stepping]\nstep = 0.001\n[record]\nrate = 10",
        &format!("{BOX}angular_velocity = [0.01, 9.0, 0.0]"),
        "[sweep]\nstep = [0.01, 0.08, 0.09]\n\"body.b.mass\" = [12, 13]\n\"effects.gyroscopic\" = [false, true]",
    );
    let found = warnings(&scene);
    let said: Vec<String> = found.iter().map(Finding::line).collect();
    // What only some of its scenes have a reason for is allowed in all.
    assert_eq!(said.len(), 2, "{said:#?}");
    assert!(
        said[0].starts_with("s:13:15: warning: a step of 0.08 s"),
        "{}",
        said[0]
    );
    assert!(
        said[1].starts_with("s:13:21: warning: a step of 0.09 s"),
        "{}",
        said[1]
    );
    let picture = found[0].picture.as_deref().unwrap();
    assert!(
        picture.ends_with("\n     |               ^^^^"),
        "{picture}"
    );
}

#[test]
fn what_an_argument_makes_probably_wrong_is_told_at_the_argument() {
    let mut script = Script::new(
        "s",
        "s",
        &one("", &format!("{WHEEL}angular_velocity = [0, 30, 0]"), ""),
    );
    script.set("step=0.022", "--set step=0.022").unwrap();
    script.set("rate=40", "--set rate=40").unwrap();
    let (_, found) = script.judge().unwrap();
    assert_eq!(found.len(), 1, "{found:#?}");
    let warning = &found[0];
    assert!(
        warning
            .line()
            .starts_with("--set step=0.022: warning: a step of 0.022 s"),
        "{warning}"
    );
    assert_eq!((warning.from, &warning.picture), (None, &None));
    assert_eq!(warning.argument.as_deref(), Some("--set step=0.022"));
}
