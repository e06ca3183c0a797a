//! Scenes that name other files: meshes and robots, found beside the scene and kept with it.

use nalgebra::Vector3;
use std::path::Path;
use torquescope::mass::mesh;
use torquescope::scene::{Enclosure, Folder, Scene};

fn folder(name: &str) -> Folder {
    Folder(Path::new(env!("CARGO_MANIFEST_DIR")).join(name))
}

/// The problems, a line each, without the pictures below them.
fn lines(problems: &torquescope::scene::Problems) -> String {
    let findings = problems.findings();
    let lines: Vec<String> = findings.iter().map(|finding| finding.line()).collect();
    lines.join("\n")
}

fn body(keys: &str) -> String {
    format!("duration = 0.1\n[[body]]\nname = \"b\"\n{keys}\n")
}

fn robots(keys: &str) -> Result<Scene, String> {
    let folder = folder("tests/fixtures/robots");
    Scene::parse_with("s.toml", "s", &body(keys), folder).map_err(|why| lines(&why))
}

fn meshes(keys: &str) -> Result<Scene, String> {
    Scene::parse_with("s.toml", "s", &body(keys), folder("scenes")).map_err(|why| lines(&why))
}

const HANDLE: &str =
    "shape = { mesh = { file = \"t_handle.obj\", scale = 0.01 } }\ndensity = 1000.0";

#[test]
fn a_mesh_gives_mass_centre_and_the_whole_tensor() {
    let scene = meshes(&format!("{HANDLE}\npivot = \"origin\"")).unwrap();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/t_handle.obj");
    let exact = *mesh::read(&path, 0.01).unwrap().integrals();
    let body = &scene.bodies[0];
    assert_eq!(body.properties.mass(), Some(exact.volume * 1000.0));
    let inertia = body.properties.inertia_about(Vector3::zeros());
    assert!((inertia - exact.tensor * 1000.0).norm() < 1e-15 * inertia.norm());
    // The pivot counts from the centre of mass; the file's origin lies where the file says.
    assert_eq!(body.pivot_b, Some(-exact.centre));
    // Given a mass in place of a density.
    let scene = meshes(&HANDLE.replace("density = 1000.0", "mass = 2.0")).unwrap();
    let inertia = scene.bodies[0].properties.inertia_about(Vector3::zeros());
    assert!((inertia - exact.tensor * (2.0 / exact.volume)).norm() < 1e-15);
}

#[test]
fn a_scene_runs_again_from_its_text_and_what_was_kept() {
    let first = meshes(HANDLE).unwrap();
    let [kept] = &first.enclosures[..] else {
        panic!("one file, read once")
    };
    assert_eq!(*kept, Enclosure::new("t_handle.obj", kept.bytes.to_vec()));
    let again = Scene::parse_with("s.toml", "s", &body(HANDLE), first.enclosures.clone()).unwrap();
    assert_eq!(again.fingerprint, first.fingerprint);
    assert_eq!(again.bodies[0].properties, first.bodies[0].properties);
    // The same text with another mesh is another scene.
    let mut bytes = kept.bytes.to_vec();
    bytes.extend(b"\n# another\n");
    let other = [Enclosure::new("t_handle.obj", bytes)];
    let other = Scene::parse_with("s.toml", "s", &body(HANDLE), other.to_vec()).unwrap();
    assert_ne!(other.fingerprint, first.fingerprint);
    // A thousand bodies of one mesh: read once.
    let many: String = (0..1_000)
        .map(|k| format!("[[body]]\nname = \"b{k}\"\n{HANDLE}\n"))
        .collect();
    let many = format!("duration = 0.1\n{many}");
    let many = Scene::parse_with("s.toml", "s", &many, folder("scenes")).unwrap();
    assert_eq!((many.bodies.len(), many.enclosures.len()), (1_000, 1));
    // Text alone has no files.
    let why = Scene::parse("s.toml", "s", &body(HANDLE))
        .err()
        .unwrap()
        .to_string();
    assert!(
        why.contains("among the files kept with the scene's text"),
        "{why}"
    );
}

#[test]
fn what_is_wrong_with_a_mesh_is_told_at_its_place() {
    let why = |keys: &str| meshes(keys).err().unwrap();
    let missing = why("shape = { mesh = { file = \"none.obj\" } }\nmass = 1.0");
    assert!(
        missing.starts_with("s.toml:4:27: file = \"none.obj\" cannot be read: "),
        "{missing}"
    );
    assert!(
        missing.contains("looked for from the scene's folder, "),
        "{missing}"
    );
    let unknown = why("shape = { mesh = { file = \"cone.toml\" } }\nmass = 1.0");
    assert!(unknown.contains("use .obj, .stl or .glb"), "{unknown}");
    let scale = why("shape = { mesh = { file = \"t_handle.obj\", scale = -1 } }\nmass = 1.0");
    assert!(scale.contains("scale = -1 must be above zero"), "{scale}");
    let key = why("shape = { mesh = { file = \"t_handle.obj\", scal = 1 } }\nmass = 1.0");
    assert!(key.contains("did you mean `scale`?"), "{key}");
    let open = [Enclosure::new(
        "o.obj",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec(),
    )];
    let keys = body("shape = { mesh = { file = \"o.obj\" } }\nmass = 1.0");
    let open = Scene::parse_with("s.toml", "s", &keys, open.to_vec());
    let open = lines(&open.err().unwrap());
    assert_eq!(
        open,
        "s.toml:4:27: file = \"o.obj\" is no body: the mesh is open: the edge from (0, 0, 0) to (1, 0, 0) belongs to one face only, line 4 (and so do 2 edges more); close the hole there, an open surface has no inside"
    );
    assert!(why("shape = { mesh = 3 }\nmass = 1.0").contains("not a table"));
    let folder = why("shape = { mesh = { file = \"../scenes\" } }\nmass = 1.0");
    assert!(
        folder.contains("cannot be read: it is not a file"),
        "{folder}"
    );
}

const PASTED: &str = "inertial = { urdf = '<inertial><origin xyz=\"0.1 0 0\" rpy=\"0 0 1.5707963267948966\"/><mass value=\"2\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"2\" iyz=\"0\" izz=\"2.5\"/></inertial>' }";

#[test]
fn an_inertial_is_pasted_as_it_is_or_named_in_its_file() {
    let scene = robots(&format!("{PASTED}\npivot = \"origin\"")).unwrap();
    let body = &scene.bodies[0];
    assert_eq!(body.properties.mass(), Some(2.0));
    // Turned by 90° about z: x and y change places; about the link's origin, 0.1 m away.
    let inertia = body.properties.inertia_about(body.pivot_b.unwrap());
    assert!(
        (inertia.diagonal() - Vector3::new(2.0, 1.02, 2.52)).norm() < 1e-15,
        "{inertia}"
    );
    assert_eq!(body.pivot_b, Some(Vector3::new(-0.1, 0.0, 0.0)));
    let mjcf = "inertial = { mjcf = '<inertial pos=\"0.1 0 0\" euler=\"0 0 90\" mass=\"2\" diaginertia=\"1 2 2.5\"/>' }";
    let other = robots(mjcf).unwrap();
    let about = |scene: &Scene| scene.bodies[0].properties.inertia_about(Vector3::zeros());
    assert!((about(&other) - about(&scene)).norm() < 1e-15);
    let urdf = robots("inertial = { urdf = \"arm.urdf\", link = \"base\" }").unwrap();
    let xml = robots("inertial = { mjcf = \"arm.xml\", body = \"diagonal\" }").unwrap();
    assert_eq!(about(&urdf), about(&xml));
    assert_eq!(xml.enclosures[0].name, "arm.xml");
    let held = robots(&format!("{PASTED}\nimmovable = [\"x\"]")).unwrap();
    assert_eq!(held.bodies[0].properties.immovable(), [true, false, false]);
}

#[test]
fn what_is_wrong_with_an_inertial_is_told_at_its_place() {
    let why = |keys: &str| robots(keys).err().unwrap();
    let triangle = why("inertial = { urdf = \"arm.urdf\", link = \"triangle\" }");
    assert!(
        triangle.starts_with("s.toml:4:12: inertial = ")
            && triangle.contains("cannot belong to a rigid body: 4 > 1 + 2"),
        "{triangle}"
    );
    let none = why("inertial = { urdf = \"arm.urdf\", link = \"bass\" }");
    assert!(none.contains("did you mean `base`?"), "{none}");
    assert!(
        why("inertial = { urdf = \"arm.urdf\", link = \"world\" }").contains("has no <inertial>")
    );
    assert!(why("inertial = { urdf = \"arm.urdf\" }").contains("say which link of it"));
    assert!(
        why("inertial = { mjcf = \"arm.urdf\", body = \"base\" }")
            .contains("is URDF; write it under that key")
    );
    assert!(
        why("inertial = { urdf = \"arm.urdf\", link = \"garbled\" }")
            .contains("value=\"one\" of <mass> is not a number")
    );
    assert!(why("inertial = {}").contains("takes one of urdf and mjcf"));
    assert!(why("inertial = { urdf = '<a' }").contains("is not XML"));
    let twice = why(&format!(
        "{PASTED}\nmass = 1.0\nshape = {{ sphere = {{ radius = 1.0 }} }}"
    ));
    assert_eq!(twice.matches("beside inertial").count(), 2, "{twice}");
}
