//! Robot descriptions: every link's inertia read as written, and judged.

use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use std::path::Path;
use torquescope::mass::links::{
    Description, Language, Link, LinksError, Lump, Verdict, parse, pasted, read,
};
use torquescope::mass::solids::{Solid, Surface};

fn robot(name: &str) -> Description {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/robots");
    read(&folder.join(name)).unwrap_or_else(|error| panic!("{name} {error}"))
}

fn link<'a>(robot: &'a Description, name: &str) -> &'a Link {
    let found = robot.links.iter().find(|link| link.name == name);
    found.unwrap_or_else(|| panic!("no {name}"))
}

fn tensor(robot: &Description, name: &str) -> Matrix3<f64> {
    let inertial = link(robot, name).inertial.clone().unwrap().unwrap();
    inertial.tensor_in_link()
}

fn verdict(robot: &Description, name: &str) -> Verdict {
    let link = link(robot, name);
    Verdict::of(
        link.inertial.as_ref().unwrap().as_ref().unwrap(),
        link.extents,
    )
}

fn diagonal(x: f64, y: f64, z: f64) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(x, y, z))
}

#[test]
fn urdf_as_it_is_written() {
    let robot = robot("arm.urdf");
    assert_eq!(
        (robot.language, robot.name.as_str()),
        (Language::Urdf, "arm")
    );
    assert_eq!(robot.links.len(), 10);
    assert!(link(&robot, "world").inertial.is_none());
    assert_eq!(link(&robot, "base").line, 6);
    let base = link(&robot, "base");
    let inertial = base.inertial.clone().unwrap().unwrap();
    assert_eq!(
        (inertial.mass, inertial.centre),
        (2.0, Vector3::new(0.0, 0.0, 0.3))
    );
    assert!((base.extents.unwrap() - Vector3::new(0.2, 0.4, 0.6)).norm() < 1e-15);
    let (x, y, z) = (0.52 / 6.0, 0.4 / 6.0, 0.2 / 6.0);
    assert!((tensor(&robot, "base") - diagonal(x, y, z)).norm() < 1e-16);
    // Turned by 90° about x its z is the old y.
    assert!((tensor(&robot, "turned") - diagonal(x, z, y)).norm() < 1e-16);
}

#[test]
fn urdf_rolls_first_and_yaws_last_about_fixed_axes() {
    let text = |rpy: &str| {
        format!(
            "<inertial><origin rpy=\"{rpy}\"/><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"2\" iyz=\"0\" izz=\"2.5\"/></inertial>"
        )
    };
    let quarter = std::f64::consts::FRAC_PI_2;
    let read = |rpy: &str| pasted(Language::Urdf, &text(rpy)).unwrap();
    // Roll takes y to z; pitch then takes z to x: y goes to x, x to -z, z to -y.
    let turned = read(&format!("{quarter} {quarter} 0")).tensor_in_link();
    assert!(
        (turned - diagonal(2.0, 2.5, 1.0)).norm() < 1e-15,
        "{turned}"
    );
    // Roll takes y to z; yaw leaves it there and takes x to y.
    let turned = read(&format!("{quarter} 0 {quarter}")).tensor_in_link();
    assert!(
        (turned - diagonal(2.5, 1.0, 2.0)).norm() < 1e-15,
        "{turned}"
    );
}

#[test]
fn urdf_that_no_body_has_and_why() {
    let robot = robot("arm.urdf");
    for name in ["base", "turned", "meshed"] {
        assert_eq!(verdict(&robot, name).word(), "possible", "{name}");
    }
    let why = |name: &str| verdict(&robot, name).why();
    assert_eq!(
        why("triangle"),
        "4 > 1 + 2; the largest moment may not exceed the sum of the others"
    );
    assert!(
        why("indefinite").starts_with("its principal moment -1"),
        "{}",
        why("indefinite")
    );
    let both = why("weightless");
    assert!(
        both.contains("a mass of 0 kg is not above zero; and its principal moment -1 "),
        "{both}"
    );
    let far = verdict(&robot, "millimetres");
    assert_eq!(far.word(), "implausible");
    // 86667 over 2/12 (0.6² + 0.4²) = 0.08667.
    assert!((far.beside_box.unwrap() / 1e6 - 1.0).abs() < 1e-12);
    assert!(
        far.why().contains("kg mm² in place of kg m²?"),
        "{}",
        far.why()
    );
    // Nothing is known of the size of a mesh: nothing is said.
    assert_eq!(verdict(&robot, "meshed").beside_box, None);
    let garbled = |name: &str| link(&robot, name).inertial.clone().unwrap().unwrap_err();
    assert_eq!(
        garbled("garbled"),
        "value=\"one\" of <mass> is not a number"
    );
    assert_eq!(garbled("halved"), "<inertia> lacks ixy=\"…\"");
}

#[test]
fn mjcf_as_mujoco_reads_it() {
    let robot = robot("arm.xml");
    assert_eq!(
        (robot.language, robot.name.as_str()),
        (Language::Mjcf, "arm")
    );
    assert_eq!(robot.links.len(), 10);
    assert!(
        robot
            .notes
            .iter()
            .any(|note| note.starts_with("balanceinertia"))
    );
    assert_eq!(verdict(&robot, "diagonal").word(), "possible");
    assert!((verdict(&robot, "diagonal").beside_box.unwrap() - 1.0).abs() < 1e-12);
    // A quarter turn about x: y and z change places.
    // Roundings of numbers of size 2.5.
    assert!((tensor(&robot, "quat") - diagonal(1.0, 2.5, 2.0)).norm() < 4e-15);
    // R = R_x R_y: z of the inertial frame goes to x and stays; x goes to -z and then to y; y to z.
    let euler = tensor(&robot, "euler");
    assert!((euler - diagonal(2.5, 1.0, 2.0)).norm() < 1e-15, "{euler}");
    assert!((tensor(&robot, "axisangle") - diagonal(2.0, 1.0, 2.5)).norm() < 1e-15);
    let full = Matrix3::new(2.0, 0.1, 0.2, 0.1, 3.0, 0.3, 0.2, 0.3, 4.0);
    assert_eq!(tensor(&robot, "full"), full);
    assert!(verdict(&robot, "triangle").why().starts_with("3 > 1 + 1"));
    let why = verdict(&robot, "negative").why();
    assert!(
        why.starts_with("a mass of -1 kg is not above zero; and its principal moment -1"),
        "{why}"
    );
    let both = link(&robot, "both").inertial.clone().unwrap().unwrap_err();
    assert!(both.contains("an orientation beside fullinertia"), "{both}");
    assert!(link(&robot, "body 9").inertial.is_none());
    let size = link(&robot, "body 9").extents.unwrap();
    assert!((size - Vector3::new(0.2, 0.2, 1.2)).norm() < 1e-15);
    assert_eq!(verdict(&robot, "grams").word(), "implausible");
}

#[test]
fn mjcf_angles_by_its_compiler() {
    let text = |compiler: &str, orientation: &str| {
        format!(
            "<mujoco><compiler {compiler}/><worldbody><body name=\"b\"><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 2 2.5\" {orientation}/></body></worldbody></mujoco>"
        )
    };
    let read = |compiler: &str, orientation: &str| {
        let robot = parse("x.xml", text(compiler, orientation).as_bytes()).unwrap();
        tensor(&robot, "b")
    };
    let quarter = std::f64::consts::FRAC_PI_2;
    let radians = read("angle=\"radian\"", &format!("euler=\"{quarter} 0 0\""));
    assert!((radians - diagonal(1.0, 2.5, 2.0)).norm() < 1e-15);
    // Fixed axes: first about x, then about the world's y: R = R_y R_x.
    let fixed = read("eulerseq=\"XYZ\"", "euler=\"90 90 0\"");
    assert!((fixed - diagonal(2.0, 2.5, 1.0)).norm() < 1e-15, "{fixed}");
    let other = read("eulerseq=\"zyx\"", "euler=\"90 0 0\"");
    assert!((other - diagonal(2.0, 1.0, 2.5)).norm() < 1e-15);
    // x to y, y to z.
    let axes = read("", "xyaxes=\"0 2 0 0 7 1\"");
    assert!((axes - diagonal(2.5, 1.0, 2.0)).norm() < 1e-15, "{axes}");
    let z = read("", "zaxis=\"1 0 0\"");
    assert!((z - diagonal(2.5, 2.0, 1.0)).norm() < 1e-15, "{z}");
    let robot = parse(
        "x.xml",
        text("eulerseq=\"xyw\"", "euler=\"1 2 3\"").as_bytes(),
    )
    .unwrap();
    assert!(link(&robot, "b").inertial.as_ref().unwrap().is_err());
}

#[test]
fn files_that_describe_no_robot() {
    let why = |text: &str| parse("x.urdf", text.as_bytes()).unwrap_err();
    assert!(matches!(why("<html/>"), LinksError::NotARobot(_)));
    assert!(matches!(why("<robot>"), LinksError::NotXml(_)));
    assert!(matches!(
        why("<robot><link name=\"${n}\"/></robot>"),
        LinksError::Xacro(_)
    ));
    // Entities that would grow a thousandfold a line are not even begun.
    let bomb =
        "<!DOCTYPE r [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;\">]><robot>&b;</robot>";
    assert!(matches!(why(bomb), LinksError::NotXml(_)));
}

#[test]
fn as_deep_and_as_many_as_a_file_can_hold_in_moments() {
    let began = std::time::Instant::now();
    let deep = "<body>".repeat(200_000) + &"</body>".repeat(200_000);
    let deep = format!("<mujoco><worldbody>{deep}</worldbody></mujoco>");
    assert_eq!(
        parse("x.xml", deep.as_bytes()).unwrap().links.len(),
        200_000
    );
    let many = "<link name=\"a\"/>\n".repeat(200_000);
    let robot = parse("x.urdf", format!("<robot>\n{many}</robot>").as_bytes()).unwrap();
    assert_eq!(robot.links[199_999].line, 200_001);
    // Unoptimised, on a machine that does other things; anything quadratic would take hours.
    assert!(began.elapsed().as_secs() < 20);
}

#[test]
fn a_pasted_inertial_is_a_solid_whose_box_has_its_inertia() {
    let text = "<inertial><origin xyz=\"0.1 -0.2 0.3\" rpy=\"0.3 0.2 0.1\"/><mass value=\"3\"/>\
        <inertia ixx=\"0.4\" ixy=\"0.05\" ixz=\"-0.02\" iyy=\"0.5\" iyz=\"0.03\" izz=\"0.6\"/></inertial>";
    let inertial = pasted(Language::Urdf, text).unwrap();
    let lump = Lump::new(&inertial);
    assert!(
        (lump.inertia(3.0)
            - inertial
                .properties()
                .unwrap()
                .inertia_about(Vector3::zeros()))
        .norm()
            < 1e-15
    );
    assert_eq!(
        lump.points(),
        [
            ("centre".into(), Vector3::new(0.1, -0.2, 0.3)),
            ("origin".into(), Vector3::zeros())
        ]
    );
    let Surface::Mesh(faces) = lump.surface() else {
        panic!("no box");
    };
    // The box as a mesh, integrated by the other module: same centre, same tensor.
    let triangles = (0..faces.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]);
    let soup = torquescope::mass::mesh::Soup::new(
        faces.corners().flatten().collect(),
        triangles.collect(),
    );
    let box_ = torquescope::mass::mesh::Polyhedron::new(&soup, 1.0).unwrap();
    assert!((box_.centre() - lump.centre()).norm() < 1e-14);
    assert!((box_.inertia(3.0) - lump.inertia(3.0)).norm() < 1e-14);
    assert!(pasted(Language::Urdf, "<link/>").is_err());
    assert!(pasted(Language::Urdf, &format!("<a>{text}{text}</a>")).is_err());
    assert!(pasted(Language::Urdf, "no xml").is_err());
}

proptest! {
    #[test]
    fn no_bytes_make_a_panic(mjcf in any::<bool>(), hits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), any::<bool>()), 1..10)) {
        let name = if mjcf { "arm.xml" } else { "arm.urdf" };
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/robots").join(name);
        let mut bytes = std::fs::read(path).unwrap();
        for (index, byte, digit) in hits {
            let at = index.index(bytes.len());
            bytes[at] = if digit && bytes[at].is_ascii_digit() { b'0' + byte % 10 } else { byte % 128 };
        }
        if let Ok(robot) = parse(name, &bytes) {
            for link in robot.links {
                if let Some(Ok(inertial)) = link.inertial {
                    let verdict = Verdict::of(&inertial, link.extents);
                    // What is called possible has mass properties, and the other way round.
                    prop_assert_eq!(verdict.impossible.is_empty(), inertial.properties().is_ok());
                }
            }
        }
    }
}
