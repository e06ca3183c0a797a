//! Bodies as scenes describe them: compounds, inertia about a point, thin bodies, swarms; and what is
//! said of those that are wrong.

mod common;

use common::Nowhere;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use std::f64::consts::PI;
use torquescope::scene::{Body, Scene, Target};
use torquescope::sim::{Outcome, Simulation};

fn parsed(rest: &str) -> Result<Scene, String> {
    let source = format!("duration = 1.0\n{rest}");
    Scene::parse("s.toml", "s", &source).map_err(|problems| lines(&problems))
}

/// The problems, a line each, without the pictures below them.
fn lines(problems: &torquescope::scene::Problems) -> String {
    let findings = problems.findings();
    let lines: Vec<String> = findings.iter().map(|finding| finding.line()).collect();
    lines.join("\n")
}

fn scene(rest: &str) -> Scene {
    parsed(rest).unwrap_or_else(|problems| panic!("{problems}"))
}

/// A scene of one body with these keys.
fn body(keys: &str) -> Body {
    scene(&format!("[[body]]\nname = \"a\"\n{keys}\n"))
        .bodies
        .remove(0)
}

/// All that is wrong with a body of these keys, without the places.
#[track_caller]
fn refused(keys: &str) -> String {
    let source = format!("[[body]]\nname = \"a\"\n{keys}\n");
    match parsed(&source) {
        Ok(_) => panic!("taken: {keys}"),
        Err(problems) => problems,
    }
}

fn run(scene: &Scene) -> Outcome {
    let (outcome, done) = Simulation::new(scene).run(&mut Nowhere);
    done.unwrap();
    outcome
}

fn inertia(body: &Body) -> Matrix3<f64> {
    body.properties.inertia_about(Vector3::zeros())
}

#[track_caller]
fn near(got: Matrix3<f64>, want: [f64; 3], bound: f64) {
    let want = Matrix3::from_diagonal(&Vector3::from(want));
    assert!((got - want).norm() < bound, "{got} is not {want}");
}

/// Two balls of 1 and 3 kg on the x axis, 2 m apart: reduced mass 3/4, so 3/4 · 4 = 3 about y and z.
const DUMBBELL: &str = "shape = { parts = [
    { name = \"light\", shape = { sphere = { radius = 0.5 } }, mass = 1.0, position = [-1, 0, 0] },
    { name = \"heavy\", shape = { sphere = { radius = 0.5 } }, mass = 3.0, position = [1, 0, 0] },
] }";

#[test]
fn parts_are_weighed_by_themselves_by_the_body_or_by_both() {
    // 2/5 m r² of each ball.
    let own = 0.4 * 0.25;
    let dumbbell = body(DUMBBELL);
    assert_eq!(dumbbell.properties.mass(), Some(4.0));
    near(
        inertia(&dumbbell),
        [4.0 * own, 4.0 * own + 3.0, 4.0 * own + 3.0],
        1e-15,
    );
    // A mass for the whole scales it.
    let scaled = body(&format!("{DUMBBELL}\nmass = 2.0"));
    assert_eq!(scaled.properties.mass(), Some(2.0));
    near(
        inertia(&scaled),
        [2.0 * own, 2.0 * own + 1.5, 2.0 * own + 1.5],
        1e-15,
    );
    assert_eq!(dumbbell.solid.unwrap().centre(), Vector3::x() * 0.5);

    let cubes = |left: &str, right: &str, keys: &str| {
        format!(
            "shape = {{ parts = [
                {{ shape = {{ cuboid = {{ x = 1, y = 1, z = 1 }} }}, position = [-1, 0, 0]{left} }},
                {{ shape = {{ cuboid = {{ x = 1, y = 1, z = 2 }} }}, position = [1, 0, 0]{right} }},
            ] }}\n{keys}"
        )
    };
    let weighed = |left: &str, right: &str, keys: &str| {
        let body = body(&cubes(left, right, keys));
        (
            body.properties.mass().unwrap(),
            body.solid.unwrap().centre().x,
        )
    };
    let close = |(mass, centre): (f64, f64), want: (f64, f64)| {
        assert!((mass - want.0).abs() < 1e-13 * want.0 && (centre - want.1).abs() < 1e-15);
    };
    // 1 m³ at -1 and 2 m³ at 1: the centre a third of the way from the middle to the larger one.
    close(weighed("", "", "mass = 6.0"), (6.0, 1.0 / 3.0));
    close(weighed("", "", "density = 10.0"), (30.0, 1.0 / 3.0));
    // The body's density fills those that have none: 1 m³ · 10 and 2 m³ · 5, and 30 kg and 2 m³ · 5.
    close(
        weighed(", density = 10.0", "", "density = 5.0"),
        (20.0, 0.0),
    );
    close(weighed(", mass = 30.0", "", "density = 5.0"), (40.0, -0.5));
    close(
        weighed(", mass = 30.0", ", density = 5.0", ""),
        (40.0, -0.5),
    );
    close(
        weighed(", mass = 30.0", ", density = 5.0", "mass = 1.0"),
        (1.0, -0.5),
    );

    let infinite = body(&cubes("", "", "mass = \"infinite\""));
    assert_eq!(infinite.properties.mass(), None);
    let infinite = body(&cubes(
        ", mass = 30.0",
        ", density = 5.0",
        "mass = \"infinite\"",
    ));
    assert_eq!(infinite.solid.unwrap().centre().x, -0.5);
}

#[test]
fn parts_that_weigh_nothing_or_twice_are_told_what_to_do() {
    let two = |left: &str, right: &str, keys: &str| {
        refused(&format!(
            "shape = {{ parts = [
                {{ shape = {{ sphere = {{ radius = 1 }} }}{left} }},
                {{ shape = {{ rod = {{ length = 1 }} }}{right} }},
            ] }}\n{keys}"
        ))
    };
    let mass = ", mass = 1.0";
    assert_eq!(
        two("", mass, ""),
        "s.toml:5:17: a part (1) says not what it weighs, and others do; give it a mass (kg) or a density (kg/m³), or give the body a density for all that lack one"
    );
    assert_eq!(two("", mass, ""), two("", mass, "mass = 7.0"));
    assert!(
        two("", "", "density = 1.0")
            .contains("a part (2) has no thickness to fill; give it a mass")
    );
    assert!(
        two("", ", density = 1.0", "density = 1.0").contains("a thin part has none; give its mass")
    );
    assert!(
        two(", mass = 1.0, density = 2.0", mass, "")
            .contains("density = 2.0 beside a mass says the same thing twice")
    );
    assert!(two(mass, mass, "density = 9.0").contains("density = 9.0 has no part to fill"));
    assert!(two(mass, mass, "density = 9.0\nmass = 1.0").contains("keep one"));
    assert!(two(mass, mass, "density = -9.0").contains("must be above zero"));
    let same = ", mass = 1.0, name = \"n\"";
    assert!(two(same, same, "").contains("name = \"n\" is the name of an earlier part too"));
    // Without any mass, and as one message: not one a part.
    let bare = "shape = { parts = [{ shape = { sphere = { radius = 1 } } }] }";
    assert_eq!(refused(bare).lines().count(), 1);
    assert!(refused(bare).contains("[[body]] lacks a mass"));

    assert!(refused("shape = { parts = [] }\nmass = 1.0").contains("has no part"));
    assert!(refused("shape = { parts = 3 }\nmass = 1.0").contains("not a list of tables"));
    assert!(
        refused("shape = { parts = [3] }\nmass = 1.0")
            .contains("a part is an integer, not a table")
    );
    let nested = "shape = { parts = [{ shape = { parts = [] } }] }\nmass = 1.0";
    assert!(refused(nested).contains("put them all into one list"));
    let unknown =
        "shape = { parts = [{ shape = { sphere = { radius = 1 } }, colour = 1 }] }\nmass = 1.0";
    assert!(refused(unknown).contains("unknown key `colour` in a part (1)"));
}

#[test]
fn points_of_parts_are_named_and_turn_with_them() {
    let cone = "{ name = \"tip\", shape = { cone = { radius = 1, height = 2 } }, position = [0, 3, 0], orientation = { axis = [0, 0, 1], degrees = -90 } }";
    let keys = format!("shape = {{ parts = [{cone}] }}\nmass = 1.0\npivot = \"tip.apex\"\n");
    let body = body(&keys);
    // The part's origin is its base's centre, at (0, 3, 0); its y is the body's x, so its centre of
    // mass lies half a metre along x and the apex another one and a half.
    let solid = body.solid.as_ref().unwrap();
    assert!((solid.centre() - Vector3::new(0.5, 3.0, 0.0)).norm() < 1e-15);
    assert!((body.pivot_b.unwrap() - Vector3::x() * 1.5).norm() < 1e-15);
    // The cone's own moments, x and y changed: 3/80 (4 + 4) and 3/10, with m = r = 1, h = 2.
    near(inertia(&body), [0.3, 0.3, 0.3], 1e-15);
    let why = refused(&keys.replace("tip.apex", "tip.top"));
    assert!(
        why.contains("is no named point of this body (centre, tip.centre, tip.base, tip.apex)"),
        "{why}"
    );
}

#[test]
fn inertia_about_a_point_is_taken_to_the_centre_of_mass() {
    let cone = "shape = { cone = { radius = 1, height = 1 } }\nmass = 1.0\n";
    // docs/physics.md: 0.25, 0.3, 0.25 about the base, 0.1875, 0.3, 0.1875 about the centre of mass.
    let about_centre = [0.1875, 0.3, 0.1875];
    for keys in [
        "inertia = { about = \"base\", moments = [0.25, 0.3, 0.25] }",
        "inertia = { about = \"apex\", moments = [0.75, 0.3, 0.75] }",
        "inertia = { about = [0, 0, 0], moments = [0.25, 0.3, 0.25] }",
        "inertia = { about = { body = [0, 0, 0] }, tensor = [[0.25, 0, 0], [0, 0.3, 0], [0, 0, 0.25]] }",
        "inertia = { moments = [0.1875, 0.3, 0.1875] }",
        "inertia = [0.1875, 0.3, 0.1875]",
    ] {
        near(
            inertia(&body(&format!("{cone}{keys}"))),
            about_centre,
            1e-15,
        );
    }
    // Off an axis there are products: of 2 kg at (1, 2, 3), m (|d|² 1 - d dᵀ) on top of 1.
    let keys = "mass = 2.0\ninertia = { about = [1, 2, 3], tensor = [[27, -4, -6], [-4, 21, -12], [-6, -12, 11]] }";
    near(inertia(&body(keys)), [1.0; 3], 1e-14);

    let why = refused(&format!(
        "{cone}inertia = {{ about = \"apex\", moments = [0.5, 0.3, 0.5] }}"
    ));
    assert!(
        why.ends_with("cannot belong to a rigid body: taken to the centre of mass, 0.75 m away, its principal moment -0.0625 is not above zero; a moment of inertia is a sum of m r²"),
        "{why}"
    );
    for (keys, says) in [
        (
            "{ about = \"base\" }",
            "inertia = {…} lacks its numbers; add moments",
        ),
        (
            "{ moments = [1, 1, 1], tensor = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] }",
            "beside moments says the same thing twice",
        ),
        (
            "{ about = \"top\", moments = [1, 1, 1] }",
            "is no named point of this body (centre, base, apex)",
        ),
        (
            "{ about = \"base\", momenta = [1, 1, 1] }",
            "did you mean `moments`?",
        ),
        (
            "{ moments = [1, 1, 3] }",
            "cannot belong to a rigid body: 3 > 1 + 1",
        ),
        ("7", "or { about = a point, moments = […] }"),
    ] {
        let why = refused(&format!("{cone}inertia = {keys}"));
        assert!(why.contains(says), "{keys}: {why}");
        assert_eq!(
            why.lines().count(),
            if keys.contains("momenta") { 2 } else { 1 },
            "{why}"
        );
    }
}

/// A thin rod on its own may not turn about itself; then it is a body like others.
#[test]
fn a_rod_by_itself_is_held_about_its_own_axis() {
    let rod = "shape = { rod = { length = 3.0 } }\nmass = 4.0\n";
    let why = refused(rod);
    assert!(
        why.contains("give a thin body some thickness, or hold that axis (immovable)"),
        "{why}"
    );
    // m l²/12 = 3; a couple of 6 N·m across it for half a second: ω = 1 rad/s. None about itself.
    let held = format!(
        "[[body]]\nname = \"a\"\n{rod}immovable = [\"y\"]\n[[event]]\nat = 0.0\nfor = 0.5\nbody = \"a\"\ntorque = [6.0, 5.0, 0.0]\nframe = \"body\"\n"
    );
    let outcome = run(&scene(&held));
    let omega = outcome.end[0].motion.omega_w;
    assert!(
        (omega.x - 1.0).abs() < 1e-12 && omega.y.abs() < 1e-15,
        "{omega}"
    );
    // About its end: m l²/3 = 12, and still nothing about itself.
    let hinged = body(&format!("{rod}immovable = [\"y\"]\npivot = \"top\""));
    near(
        hinged.properties.inertia_about(hinged.pivot_b.unwrap()),
        [12.0, 0.0, 12.0],
        1e-14,
    );
    // Held about another axis it is no body; nor is one whose three parts lie in a line.
    assert!(refused(&format!("{rod}immovable = [\"x\"]")).contains("hold that axis"));
    // Crossed with another it has every moment: m l²/12 + 0, and so on.
    let cross = body("shape = { parts = [
        { shape = { rod = { length = 3.0 } }, mass = 4.0 },
        { shape = { rod = { length = 3.0 } }, mass = 4.0, orientation = { axis = [0, 0, 1], degrees = 90 } },
    ] }");
    near(inertia(&cross), [3.0, 3.0, 6.0], 1e-14);
    assert_eq!(cross.properties.mass(), Some(8.0));
}

#[test]
fn immovable_axes_of_a_compound_are_the_bodys() {
    let body = body(&format!(
        "{DUMBBELL}\nimmovable = [\"y\", \"z\"]\npivot = \"light.centre\""
    ));
    let inverse = body.properties.inverse_inertia_about(body.pivot_b.unwrap());
    near(inverse, [1.0 / 0.4, 0.0, 0.0], 1e-15);
}

const BOX: &str = "shape = { cuboid = { x = 1.0, y = 0.5, z = 0.2 } }\ndensity = 1000.0\n";

fn swarm(name: &str, count: usize, keys: &str) -> String {
    format!("[[swarm]]\nname = \"{name}\"\ncount = {count}\n{BOX}{keys}\n")
}

#[test]
fn a_grid_is_centred_and_goes_along_x_z_and_y() {
    let source = swarm(
        "box",
        10,
        "position = [10, 20, 30]\ngrid = { spacing = [1, 2, 3] }",
    );
    let bodies = scene(&source).bodies;
    assert_eq!(bodies.len(), 10);
    // The smallest cube that holds ten has a side of three: a layer of nine, and one above.
    let at = |k: usize| bodies[k].position_w - Vector3::new(10.0, 20.0, 30.0);
    assert_eq!(at(0), Vector3::new(-1.0, -1.0, -3.0));
    assert_eq!(at(1), Vector3::new(0.0, -1.0, -3.0));
    assert_eq!(at(3), Vector3::new(-1.0, -1.0, 0.0));
    assert_eq!(at(9), Vector3::new(-1.0, 1.0, -3.0));
    assert_eq!(
        (bodies[7].name.as_str(), bodies[7].label.as_str()),
        ("box_7", "box_7")
    );
    let row = scene(&swarm(
        "box",
        3,
        "label = \"a box\"\ngrid = { spacing = 2.0, counts = [1, 1, 4] }",
    ))
    .bodies;
    let z: Vec<f64> = row.iter().map(|body| body.position_w.z).collect();
    assert_eq!(z, [-3.0, -1.0, 1.0]);
    assert_eq!(row[2].label, "a box 2");
    // All else they share.
    assert!(row.iter().all(|body| body.properties == row[0].properties));
}

#[test]
fn a_seed_says_where_every_body_is_however_many_there_are() {
    let keys = |seed: u64| {
        format!(
            "position = [1, 0, 0]\nangular_velocity = [0, 9, 0]\nrandom = {{ seed = {seed}, within = [5, 0, 2], spin = 3.0, orientation = true }}"
        )
    };
    let bodies = scene(&swarm("box", 1000, &keys(7))).bodies;
    for body in &bodies {
        let from = body.position_w - Vector3::x();
        assert!(from.x.abs() <= 5.0 && from.y == 0.0 && from.z.abs() <= 2.0);
        assert!((body.omega_w - Vector3::y() * 9.0).norm() <= 3.0 * (1.0 + 1e-15));
        assert!((body.q_wb.norm() - 1.0).abs() < 1e-15);
    }
    let pose = |b: &Body| (b.position_w, b.q_wb, b.omega_w);
    let fewer = scene(&swarm("crate", 17, &keys(7))).bodies;
    assert!(fewer.iter().zip(&bodies).all(|(a, b)| pose(a) == pose(b)));
    let other = scene(&swarm("box", 17, &keys(8))).bodies;
    assert!(other.iter().zip(&bodies).all(|(a, b)| pose(a) != pose(b)));
    // The numbers themselves, by hand from the published generator: the same on every machine.
    let mix = |n: u64| {
        let z = 7_u64.wrapping_add((n + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / 2.0_f64.powi(53)
    };
    let x = 1.0 + 5.0 * (2.0 * mix(16 * 17) - 1.0);
    assert_eq!(bodies[17].position_w.x, x);
    // What is not asked for is as the table says.
    let plain = scene(&swarm("box", 5, "random = { within = [1, 1, 1] }")).bodies;
    assert!(
        plain
            .iter()
            .all(|b| b.q_wb == UnitQuaternion::identity() && b.omega_w == Vector3::zeros())
    );
}

#[test]
fn a_swarm_of_pendulums_swings_each_about_its_own_pivot() {
    let source = format!(
        "[effects]\ngyroscopic = true\ngravity = [0, -9.81, 0]\n{}",
        swarm(
            "box",
            20,
            "pivot = \"top\"\ngrid = { spacing = 3.0 }\nrandom = { spin = 2.0, orientation = true }"
        )
    );
    let scene = scene(&source);
    let pivot =
        |body: &Body, x: Vector3<f64>, q: UnitQuaternion<f64>| x + q * body.pivot_b.unwrap();
    for (body, end) in scene.bodies.iter().zip(run(&scene).end) {
        let (from, to) = (
            pivot(body, body.position_w, body.q_wb),
            pivot(body, end.motion.position_w, end.motion.q_wb),
        );
        // Roundings of places up to 5 m.
        assert!((from - to).norm() < 1e-14);
        assert_ne!(body.q_wb, end.motion.q_wb);
        assert!(
            (body.velocity_w - body.omega_w.cross(&(body.q_wb * -body.pivot_b.unwrap()))).norm()
                < 1e-15
        );
    }
}

/// A body of a swarm goes as the same body written out, to the last bit, and events find it.
#[test]
fn events_name_bodies_of_swarms() {
    let event = |name: &str| {
        format!("[[event]]\nat = 0.5\nbody = \"{name}\"\nangular_impulse = [0, 1, 0]\n")
    };
    let keys = "random = { seed = 3, within = [9, 9, 9], spin = 3.0, orientation = true }";
    let scene_of = |event: &str| {
        scene(&format!(
            "[effects]\ngyroscopic = true\n[[body]]\nname = \"first\"\n{BOX}{}{event}",
            swarm("box", 20, keys)
        ))
    };
    let struck = scene_of(&event("box_17"));
    assert_eq!(struck.events[0].target, Target::Body(18));
    let ends = run(&struck).end;
    let free = run(&scene_of("")).end;
    for k in 0..21 {
        assert_eq!(ends[k] == free[k], k != 18, "{k}");
    }
    let body = &struck.bodies[18];
    let list = |v: &[f64]| format!("{v:?}");
    let (p, q, w) = (body.position_w, body.q_wb.coords, body.omega_w);
    let alone = scene(&format!(
        "[effects]\ngyroscopic = true\n[[body]]\nname = \"alone\"\n{BOX}position = {}\norientation = {}\nangular_velocity = {}\n{}",
        list(p.as_slice()),
        list(q.as_slice()),
        list(w.as_slice()),
        event("alone")
    ));
    let gap = run(&alone).end[0]
        .motion
        .q_wb
        .angle_to(&ends[18].motion.q_wb);
    // The attitude was brought to unit length once more: a rounding, and what 1 s makes of it.
    assert!(gap < 4e-15, "{gap}");

    let wrong = |name: &str| {
        parsed(&format!("{}{}", swarm("box", 20, keys), event(name)))
            .err()
            .unwrap()
    };
    let none = "names no body of the scene; the swarm box has box_0 to box_19";
    for name in [
        "box_20",
        "box_017",
        "box_+1",
        "box",
        "box_",
        "box_-1",
        "box_99999999999999999999",
    ] {
        assert!(wrong(name).contains(none), "{name}: {}", wrong(name));
    }
    assert!(
        wrong("bix").contains("did you mean `box`?"),
        "{}",
        wrong("bix")
    );
}

#[test]
fn swarms_that_are_wrong_are_told_what_to_do() {
    let grid = "grid = { spacing = 2.0 }";
    let wrong = |source: &str| parsed(source).err().unwrap();
    for (keys, says) in [
        ("", "puts all its bodies into one place; add grid"),
        ("grid = {}", "lacks `spacing`"),
        (
            "grid = { spacing = 2.0, counts = [3, 3, 2] }",
            "has 18 places for 20 bodies",
        ),
        (
            "grid = { spacing = 2.0, counts = [3, 3, 2.5] }",
            "are not three whole numbers",
        ),
        (
            "grid = { spacing = 2.0, counts = [3, 3, 0] }",
            "are not three whole numbers",
        ),
        ("random = { seed = -1 }", "is not a whole number from 0 to"),
        ("random = { seed = 1.5 }", "is not a whole number from 0 to"),
        ("random = { spin = -3 }", "is below zero"),
        ("random = { wthin = [1, 1, 1] }", "did you mean `within`?"),
        ("random = 7", "is an integer, not a table"),
    ] {
        let why = wrong(&swarm("box", 20, keys));
        assert!(why.contains(says), "{keys}: {why}");
        assert_eq!(why.lines().count(), 1, "{why}");
    }
    for (count, says) in [
        ("0", "is not a whole number from 1 to 100000"),
        ("1e3", "is not a whole number"),
        ("100001", "is not a whole number from 1 to 100000"),
        ("99999999999999999999999", "is not a whole number"),
        ("nan", "is not finite"),
    ] {
        let source = swarm("box", 20, grid).replace("count = 20", &format!("count = {count}"));
        let why = wrong(&source);
        assert!(
            why.contains(says) && why.lines().count() == 1,
            "{count}: {why}"
        );
    }
    let two = swarm("a", 60_000, grid) + &swarm("b", 60_000, grid);
    assert!(wrong(&two).contains("makes more than 100000 bodies"));
    let same = swarm("a", 5, grid) + &swarm("a", 5, grid);
    assert!(wrong(&same).contains("is the name of an earlier body too"));
    let clash = format!("[[body]]\nname = \"a_3\"\n{BOX}{}", swarm("a", 5, grid));
    assert!(
        wrong(&clash).contains("s.toml:3:8: name = \"a_3\" is the name of a body of a swarm too")
    );
    assert!(parsed(&clash.replace("a_3", "a_5")).is_ok());
    // A wrong body is told once, not once for each; events on it are not judged.
    let wrong_body = swarm("box", 20, grid).replace("x = 1.0", "x = -1.0")
        + "[[event]]\nat = 0.5\nbody = \"box_7\"\nangular_impulse = [0, 1, 0]\n";
    assert_eq!(
        wrong(&wrong_body).lines().count(),
        1,
        "{}",
        wrong(&wrong_body)
    );
    let refuses = format!("[stepping]\nmethod = \"dmv2\"\n{}", swarm("box", 20, grid));
    let why = wrong(&refuses);
    assert!(why.contains("box_0: ") && why.lines().count() == 1, "{why}");
}

#[test]
fn bodies_of_swarms_count_where_rows_are_limited() {
    let long = |bodies: usize| {
        let source = format!(
            "duration = 100.0\n[effects]\ngyroscopic = true\n{}",
            swarm("box", bodies, "grid = { spacing = 2.0 }")
        );
        Scene::parse("s.toml", "s", &source).map_err(|why| why.to_string())
    };
    // A thousand steps a second: 1e5 rows a body, of 3e7.
    assert!(long(300).is_ok());
    assert!(
        long(301)
            .err()
            .unwrap()
            .contains("the state at every step would be 3.0e7 rows")
    );
}

#[test]
fn a_swarm_may_state_an_accuracy() {
    let keys = "random = { seed = 7, within = [5, 5, 5], spin = 3.0, orientation = true }";
    let source = format!(
        "[stepping]\naccuracy = 1e-9\n[effects]\ngyroscopic = true\n{}",
        swarm("box", 24, keys)
    );
    let scene = scene(&source);
    let plan = torquescope::cost::Plan::of(&scene).unwrap();
    assert!(plan.achieved <= 1e-9);
    let (outcome, done) = Simulation::new(&scene).run_by(&mut plan.chooser(), &mut Nowhere);
    done.unwrap();
    assert_eq!(outcome.end.len(), 24);
}

/// The density of a solid of the table fills the volume of each kind.
#[test]
fn every_solid_can_be_named_in_a_scene() {
    for (shape, volume) in [
        (
            "tube = { radius = 0.5, inner_radius = 0.4, height = 2.0 }",
            PI * 0.09 * 2.0,
        ),
        (
            "capsule = { radius = 0.5, height = 2.0 }",
            PI * (0.5 + 0.5 / 3.0),
        ),
        ("ellipsoid = { x = 1.0, y = 2.0, z = 3.0 }", PI),
        (
            "torus = { radius = 1.0, tube_radius = 0.1 }",
            2.0 * PI * PI * 0.01,
        ),
        (
            "hollow_sphere = { radius = 1.0, inner_radius = 0.5 }",
            PI * 3.5 / 3.0,
        ),
    ] {
        let body = body(&format!("shape = {{ {shape} }}\ndensity = 2.0"));
        let mass = body.properties.mass().unwrap();
        assert!((mass / (2.0 * volume) - 1.0).abs() < 1e-15 * 4.0, "{shape}");
    }
    let disc = body("shape = { disc = { radius = 2.0 } }\nmass = 1.0\npivot = \"rim\"");
    assert_eq!(disc.pivot_b, Some(Vector3::x() * 2.0));
    near(inertia(&disc), [1.0, 2.0, 1.0], 1e-15);
    assert!(
        refused("shape = { disc = { radius = 2.0 } }\ndensity = 1.0")
            .contains("what is thin has none")
    );
}

/// Looking for the nearest of many names takes its time; of many names that miss, only those that are
/// told about are worth it.
#[test]
fn many_events_on_no_body_are_told_in_a_moment() {
    let mut source = String::new();
    for k in 0..5_000 {
        source += &format!(
            "[[body]]\nname = \"box_{k}\"\nmass = 1.0\ninertia = [1, 1, 1]\n[[event]]\nat = 0.5\nbody = \"bax_{k}\"\nangular_impulse = [0, 1, 0]\n"
        );
    }
    let source = format!("duration = 1.0\n{source}");
    let start = std::time::Instant::now();
    let why = Scene::parse("s.toml", "s", &source).err().unwrap();
    let why = why.to_string();
    assert!(why.contains("did you mean `box_0`?") && why.ends_with("and 4950 problems more"));
    // 50 searches take a second where the build is slow and the machine shared, 5,000 some minutes.
    assert!(start.elapsed().as_secs() < 30);
}

#[test]
fn the_examples_of_the_page_are_right() {
    let page = include_str!("../docs/scenes.md");
    let block = |start: &str| {
        let from = page.find(start).unwrap();
        let to = page[from..].find("```").unwrap();
        scene(&page[from..from + to]).bodies
    };
    let handle = block("[[body]]\nname = \"t-handle\"");
    // 7800 · 0.12 + 600 · 0.2, times π r².
    let mass = (7800.0 * 0.12 + 600.0 * 0.2) * PI * 1e-4;
    assert!((handle[0].properties.mass().unwrap() - mass).abs() < 1e-15);
    let swarm = format!(
        "[record]\nstate = 60\n{}",
        &page[page.find("[[swarm]]").unwrap()..]
    );
    let swarm = scene(swarm.split("```").next().unwrap()).bodies;
    assert_eq!(swarm.len(), 10_000);
}

/// A race is run by one body: that it was one of many is over.
#[test]
fn the_first_of_a_swarm_races_as_any_body_does() {
    let keys = "grid = { spacing = 2.0 }\nangular_velocity = [1, 2, 3]";
    let scene = scene(&format!(
        "[effects]\ngyroscopic = true\n{}",
        swarm("box", 3, keys)
    ));
    let methods = [torquescope::integrator::find("rk4").unwrap()];
    let race = torquescope::cost::Race::new(&scene, &methods, 0.01, 3.0).unwrap();
    race.run(&mut Nowhere).unwrap();
    assert_eq!(race.scene.outside_swarms(), race.scene.bodies.len());
}
