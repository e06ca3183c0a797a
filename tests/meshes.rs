//! Meshes: read, refused where they enclose nothing, integrated exactly, and sliced into cubes.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use proptest::prelude::*;
use std::collections::HashMap;
use std::f64::consts::PI;
use std::path::Path;
use torquescope::mass::mesh::{
    Cubes, MeshError, Polyhedron, Soup, mean_order, orders, parse, read,
};
use torquescope::mass::solids::Solid;
use torquescope::mass::tensor::turned;

/// The cube of edge 2 about the origin, quads cut in two, outward.
fn cube() -> Soup {
    let mut points = Vec::new();
    for k in 0..8 {
        let sign = |bit: usize| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
        points.push(Vector3::new(sign(0), sign(1), sign(2)));
    }
    let quads = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let triangles = quads
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    Soup::new(points, triangles.collect())
}

fn moved(soup: &Soup, place: impl Fn(Vector3<f64>) -> Vector3<f64>) -> Soup {
    let points = soup.points.iter().map(|&p| place(p)).collect();
    Soup {
        points,
        ..soup.clone()
    }
}

fn both(a: &Soup, b: &Soup) -> Soup {
    let n = a.points.len() as u32;
    let shifted = b.triangles.iter().map(|t| t.map(|k| k + n));
    Soup::new(
        a.points.iter().chain(&b.points).copied().collect(),
        a.triangles.iter().copied().chain(shifted).collect(),
    )
}

fn inward(soup: &Soup) -> Soup {
    let triangles = soup.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    Soup::new(soup.points.clone(), triangles)
}

/// A sphere of radius 1: an octahedron whose faces are cut in four, over and over.
fn sphere(cuts: usize) -> Soup {
    let mut points: Vec<Vector3<f64>> = [1.0, -1.0]
        .iter()
        .flat_map(|&s| [Vector3::x() * s, Vector3::y() * s, Vector3::z() * s])
        .collect();
    let mut faces: Vec<[u32; 3]> = vec![
        [0, 1, 2],
        [1, 3, 2],
        [3, 4, 2],
        [4, 0, 2],
        [1, 0, 5],
        [3, 1, 5],
        [4, 3, 5],
        [0, 4, 5],
    ];
    for _ in 0..cuts {
        let mut middle: HashMap<(u32, u32), u32> = HashMap::new();
        let mut next = Vec::new();
        for [a, b, c] in faces {
            let mut between = |i: u32, j: u32| {
                *middle.entry((i.min(j), i.max(j))).or_insert_with(|| {
                    let m = points[i as usize] + points[j as usize];
                    points.push(m.normalize());
                    points.len() as u32 - 1
                })
            };
            let (ab, bc, ca) = (between(a, b), between(b, c), between(c, a));
            next.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        faces = next;
    }
    Soup::new(points, faces)
}

/// A torus about y: ring radius 1, tube radius 0.4, n pieces round the ring, m round the tube.
fn torus(n: u32, m: u32) -> Soup {
    let mut points = Vec::new();
    for i in 0..n {
        let (s, c) = (2.0 * PI * f64::from(i) / f64::from(n)).sin_cos();
        for j in 0..m {
            let (t, u) = (2.0 * PI * f64::from(j) / f64::from(m)).sin_cos();
            let r = 1.0 + 0.4 * u;
            points.push(Vector3::new(r * c, 0.4 * t, r * s));
        }
    }
    let at = |i: u32, j: u32| i % n * m + j % m;
    let mut faces = Vec::new();
    for i in 0..n {
        for j in 0..m {
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    Soup::new(points, faces)
}

fn body(soup: &Soup) -> Polyhedron {
    Polyhedron::new(soup, 1.0).unwrap_or_else(|error| panic!("{error}"))
}

fn why(soup: &Soup) -> String {
    Polyhedron::new(soup, 1.0).unwrap_err().to_string()
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn a_cube_is_exact() {
    let cube = body(&cube());
    let sum = cube.integrals();
    assert_eq!(sum.volume, 8.0);
    assert_eq!(sum.centre, Vector3::zeros());
    // m/12 (2² + 2²) = 2/3 · 8; sums of twelve parts, some roundings.
    let want = Matrix3::from_diagonal_element(16.0 / 3.0);
    assert!((sum.tensor - want).norm() < 1e-14, "{}", sum.tensor);
    assert_eq!((cube.shells(), cube.dropped()), (1, 0));
    assert_eq!(cube.triangles().len(), 12);
}

#[test]
fn a_tetrahedron_by_its_closed_form() {
    // Corners at the origin and at a, b, c on the axes: V = abc/6, centre (a, b, c)/4, and
    // ∫ x² = V a²/10, ∫ xy = V ab/20 about the corner.
    let (a, b, c) = (1.0, 2.0, 3.0);
    let points = vec![
        Vector3::zeros(),
        Vector3::x() * a,
        Vector3::y() * b,
        Vector3::z() * c,
    ];
    let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let solid = body(&Soup::new(points, faces));
    let centre = Vector3::new(a, b, c) / 4.0;
    let corner = Vector3::new(a, b, c);
    let second = (corner * corner.transpose()
        + Matrix3::from_diagonal(&corner.component_mul(&corner)))
        / 20.0
        - centre * centre.transpose();
    let want = Matrix3::identity() * second.trace() - second;
    let sum = solid.integrals();
    assert!((sum.volume - 1.0).abs() < 1e-15);
    assert!((sum.centre - centre).norm() < 1e-15);
    // Roundings of numbers of size 1.
    assert!((sum.tensor - want).norm() < 3e-15, "{} {want}", sum.tensor);
    // Its axes are not the principal ones, and the tensor says so.
    assert!(solid.inertia(2.0)[(0, 1)] > 0.04);
    assert!((solid.moments(2.0).sum() - 2.0 * want.trace()).abs() < 1e-14);
}

#[test]
fn a_finer_sphere_tends_to_the_sphere_as_the_square_of_its_edges() {
    let mut before: Option<(f64, f64)> = None;
    for cuts in 2..=6 {
        let solid = body(&sphere(cuts));
        let volume = 1.0 - solid.integrals().volume / (4.0 / 3.0 * PI);
        let moments = solid.moments(1.0);
        let moment = (1.0 - moments.x / 0.4).max(1.0 - moments.z / 0.4);
        if let Some((v, m)) = before {
            // Edges halve: a quarter of the error, but for the next order.
            assert!((3.8..4.1).contains(&(v / volume)), "{}", v / volume);
            assert!((3.8..4.1).contains(&(m / moment)), "{}", m / moment);
        }
        before = Some((volume, moment));
    }
}

#[test]
fn a_torus_mesh_tends_to_the_torus() {
    // V = 2π² R r², I_y = m (R² + 3/4 r²), I_x = m (R²/2 + 5/8 r²).
    let (ring, tube) = (1.0, 0.4_f64);
    let want = Vector3::new(
        ring / 2.0 + 5.0 / 8.0 * tube * tube,
        ring + 0.75 * tube * tube,
        ring / 2.0 + 5.0 / 8.0 * tube * tube,
    );
    let mut before: Option<[f64; 2]> = None;
    for k in [16, 32, 64, 128] {
        let solid = body(&torus(2 * k, k));
        let volume = (solid.integrals().volume / (2.0 * PI * PI * ring * tube * tube) - 1.0).abs();
        let tensor = (solid.inertia(1.0) - Matrix3::from_diagonal(&want)).norm();
        if let Some([v, t]) = before {
            assert!((3.9..4.1).contains(&(v / volume)), "{}", v / volume);
            assert!((3.9..4.1).contains(&(t / tensor)), "{}", t / tensor);
        }
        before = Some([volume, tensor]);
    }
}

#[test]
fn the_t_handle_has_the_mass_of_its_box_and_its_prisms() {
    let text = std::fs::read_to_string(root().join("tests/oracles/t_handle.csv")).unwrap();
    let row: Vec<f64> = text
        .lines()
        .nth(1)
        .unwrap()
        .split(',')
        .map(|x| x.parse().unwrap())
        .collect();
    let solid = read(&root().join("scenes/t_handle.obj"), 1.0).unwrap();
    assert_eq!((solid.shells(), solid.dropped()), (1, 0));
    let sum = solid.integrals();
    // 588 triangles, coordinates rounded to 1e-16 each.
    assert!((sum.volume / row[0] - 1.0).abs() < 1e-14);
    assert!((sum.centre - Vector3::new(row[1], row[2], row[3])).norm() < 1e-14);
    let want = Matrix3::from_diagonal(&Vector3::new(row[4], row[5], row[6]));
    assert!(
        (sum.tensor - want).norm() < 3e-14 * want.norm(),
        "{}",
        sum.tensor
    );
    // Centimetres: lengths by 0.01, volume by 1e-6, moments of a mass by 1e-4.
    let small = read(&root().join("scenes/t_handle.obj"), 0.01).unwrap();
    assert!((small.integrals().volume / row[0] - 1e-6).abs() < 1e-20);
    let ratio = small.inertia(1.0).norm() / solid.inertia(1.0).norm();
    assert!((ratio - 1e-4).abs() < 1e-17);
}

#[test]
fn far_from_the_origin_nothing_is_lost() {
    // Corners on a grid of 2⁻²⁰ m, so that a shift by a million metres moves them without rounding: what is
    // left is the integrals' own. Without their shift of origin (1e6)² would leave four digits.
    let grid = |p: Vector3<f64>| p.map(|x| (x * 1_048_576.0).round() / 1_048_576.0);
    let near = moved(&sphere(3), |p| {
        grid(p.component_mul(&Vector3::new(1.0, 0.5, 0.25)))
    });
    let shift = Vector3::new(1e6, -1e6, 1e6);
    let far = moved(&near, |p| p + shift);
    let (near, far) = (body(&near), body(&far));
    let (a, b) = (near.integrals(), far.integrals());
    assert!((a.volume / b.volume - 1.0).abs() < 1e-14);
    assert!((a.tensor - b.tensor).norm() < 1e-14 * a.tensor.norm());
    // The place itself is a number of size 1e6.
    assert!((b.centre - shift - a.centre).amax() <= 1.2e-10);
}

#[test]
fn an_open_mesh_is_refused_at_its_edge() {
    let mut open = cube();
    open.triangles.remove(3);
    open.faces.remove(3);
    let why = why(&open);
    // The third face's other half: (1, 3, 7) is there, (1, 7, 5) is not.
    assert_eq!(
        why,
        "the mesh is open: the edge from (1, 1, 1) to (1, -1, -1) belongs to one face only, \
         triangle 3 (and so do 2 edges more); close the hole there, an open surface has no inside"
    );
}

#[test]
fn faces_that_look_different_ways_are_refused_at_their_edge() {
    let mut mixed = cube();
    mixed.triangles[0].swap(0, 1);
    let why = why(&mixed);
    assert!(
        why.starts_with("faces look different ways: the edge from ("),
        "{why}"
    );
    assert!(why.contains("by both triangle 1, triangle "), "{why}");
    assert!(
        why.ends_with("turn one of them over, so that all look out"),
        "{why}"
    );
}

#[test]
fn an_edge_of_four_faces_is_refused() {
    // Two cubes that touch along the edge x = y = 1.
    let touching = both(
        &cube(),
        &moved(&cube(), |p| p + Vector3::new(2.0, 2.0, 0.0)),
    );
    let why = why(&touching);
    assert!(why.contains("edge from (1, 1, "), "{why}");
    assert!(why.contains("belongs to 4 faces, triangle "), "{why}");
    // A doubled face is one too many as well.
    let mut doubled = cube();
    doubled.triangles.push(doubled.triangles[0]);
    doubled.faces.push(13);
    let why = self::why(&doubled);
    assert!(why.contains("belongs to 3 faces, triangle 1, "), "{why}");
    assert!(why.contains("triangle 13"), "{why}");
}

#[test]
fn an_inside_out_mesh_is_refused_with_an_edge() {
    let why = why(&inward(&cube()));
    assert!(
        why.starts_with("the mesh is inside-out: the faces at its edge from (-1, "),
        "{why}"
    );
    // One of two, far apart, is enough.
    let apart = moved(&inward(&cube()), |p| p + Vector3::new(5.0, 0.0, 0.0));
    let why = self::why(&both(&cube(), &apart));
    assert!(why.contains("inside-out") && why.contains("(4, "), "{why}");
}

#[test]
fn shells_side_by_side_and_a_cavity_are_fine_and_a_shell_counted_twice_is_not() {
    let apart = both(
        &cube(),
        &moved(&cube(), |p| p + Vector3::new(5.0, 0.3, 0.0)),
    );
    let apart = body(&apart);
    assert_eq!(apart.shells(), 2);
    assert!((apart.integrals().volume - 16.0).abs() < 1e-14);
    let small = moved(&cube(), |p| p * 0.5 + Vector3::new(0.125, 0.0, 0.25));
    let hollow = body(&both(&cube(), &inward(&small)));
    assert!((hollow.integrals().volume - 7.0).abs() < 1e-14);
    // A ball in the cavity: outward again.
    let ball = moved(&sphere(1), |p| p * 0.25 + Vector3::new(0.125, 0.0, 0.25));
    let rattle = body(&both(&both(&cube(), &inward(&small)), &ball));
    assert_eq!(rattle.shells(), 3);
    let twice = why(&both(&cube(), &small));
    assert!(twice.contains("would count twice"), "{twice}");
}

#[test]
fn what_is_flat_or_nothing_is_refused() {
    let flat = moved(&cube(), |p| Vector3::new(p.x, p.y, 0.0));
    let why = why(&flat);
    // Its upper and lower faces fall on each other: four edges are in four faces.
    assert!(why.contains("faces"), "{why}");
    let thin = moved(&cube(), |p| Vector3::new(p.x, p.y, p.x + 0.5 * p.y));
    assert!(Polyhedron::new(&thin, 1.0).is_err());
    assert_eq!(
        Polyhedron::new(&Soup::default(), 1.0)
            .unwrap_err()
            .to_string(),
        "it has no faces"
    );
    let far = moved(&cube(), |p| p * 1e60);
    assert!(matches!(
        Polyhedron::new(&far, 1.0),
        Err(MeshError::OutOfRange { vertex: 1, .. })
    ));
}

fn obj(soup: &Soup) -> String {
    let mut text = String::new();
    for p in &soup.points {
        text += &format!("v {} {} {}\n", p.x, p.y, p.z);
    }
    for [a, b, c] in &soup.triangles {
        text += &format!("f {} {} {}\n", a + 1, b + 1, c + 1);
    }
    text
}

fn facets(soup: &Soup) -> impl Iterator<Item = [[f32; 3]; 3]> + '_ {
    let corner = |k: u32| <[f32; 3]>::from(soup.points[k as usize].map(|x| x as f32));
    soup.triangles.iter().map(move |t| t.map(corner))
}

fn stl_text(soup: &Soup, name: &str) -> String {
    let mut text = format!("solid {name}\n");
    for facet in facets(soup) {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in facet {
            text += &format!("vertex {x} {y} {z}\n");
        }
        text += "endloop\nendfacet\n";
    }
    text + &format!("endsolid {name}\n")
}

fn stl_binary(soup: &Soup, header: &[u8]) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes[..header.len()].copy_from_slice(header);
    bytes.extend((soup.triangles.len() as u32).to_le_bytes());
    for facet in facets(soup) {
        bytes.extend([0; 12]);
        bytes.extend(facet.iter().flatten().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

/// Positions as f32, indices as u16, under a node as given.
fn glb(soup: &Soup, node: &str) -> Vec<u8> {
    let mut binary: Vec<u8> = soup
        .points
        .iter()
        .flat_map(|p| {
            <[f64; 3]>::from(*p)
                .into_iter()
                .flat_map(|x| (x as f32).to_le_bytes())
        })
        .collect();
    let positions = binary.len();
    binary.extend(
        soup.triangles
            .iter()
            .flatten()
            .flat_map(|&k| (k as u16).to_le_bytes()),
    );
    let indices = binary.len() - positions;
    while !binary.len().is_multiple_of(4) {
        binary.push(0);
    }
    let mut json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0{node}}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3"}},
        {{"bufferView":1,"componentType":5123,"count":{},"type":"SCALAR"}}],
        "bufferViews":[{{"buffer":0,"byteLength":{positions}}},{{"buffer":0,"byteOffset":{positions},"byteLength":{indices}}}],
        "buffers":[{{"byteLength":{}}}]}}"#,
        soup.points.len(),
        3 * soup.triangles.len(),
        binary.len()
    );
    while !json.len().is_multiple_of(4) {
        json.push(' ');
    }
    let mut bytes = b"glTF".to_vec();
    bytes.extend(2_u32.to_le_bytes());
    bytes.extend((12 + 8 + json.len() as u32 + 8 + binary.len() as u32).to_le_bytes());
    bytes.extend((json.len() as u32).to_le_bytes());
    bytes.extend(b"JSON");
    bytes.extend(json.as_bytes());
    bytes.extend((binary.len() as u32).to_le_bytes());
    bytes.extend(b"BIN\0");
    bytes.extend(binary);
    bytes
}

#[test]
fn every_format_gives_the_same_body() {
    // Coordinates that an f32 holds exactly.
    let soup = moved(&sphere(2), |p| (p * 1024.0).map(f64::round) / 512.0);
    let want = body(&soup);
    let mut upper = obj(&soup).replace('\n', "\r\n");
    upper.insert_str(0, "# caf\u{e9}\r\nmtllib x.mtl\r\no ball\r\nvn 0 0 1\r\n");
    let files: [(&str, Vec<u8>); 6] = [
        ("a.obj", obj(&soup).into()),
        ("b.OBJ", upper.into()),
        ("c.stl", stl_text(&soup, "a ball").into()),
        ("d.stl", stl_binary(&soup, b"made by a test")),
        ("e.stl", stl_binary(&soup, b"solid, says a binary file")),
        ("f.glb", glb(&soup, "")),
    ];
    for (name, bytes) in files {
        let got = parse(name, &bytes, 1.0).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(got.triangles().len(), soup.triangles.len(), "{name}");
        assert_eq!(
            got.triangles().points.len(),
            soup.points.len(),
            "{name}: welded"
        );
        // The order of the corners is another, and so the mean's last bit.
        let (a, b) = (got.integrals(), want.integrals());
        assert!((a.volume / b.volume - 1.0).abs() < 1e-14, "{name}");
        assert!(
            (a.tensor - b.tensor).norm() < 1e-14 * b.tensor.norm(),
            "{name}"
        );
    }
}

#[test]
fn the_nodes_of_a_glb_place_its_meshes_and_a_mirror_keeps_them_outward() {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let node =
        format!(r#","translation":[10,0,0],"rotation":[0,0,{half},{half}],"scale":[-1,2,1]"#);
    let solid = parse("x.glb", &glb(&cube(), &node), 1.0).unwrap();
    assert!((solid.integrals().volume - 16.0).abs() < 1e-13);
    assert!((solid.integrals().centre - Vector3::new(10.0, 0.0, 0.0)).norm() < 1e-14);
    // Scaled along y, then turned by 90° about z: long along x.
    let m = 16.0 / 12.0;
    let want = Matrix3::from_diagonal(&Vector3::new(8.0 * m, 20.0 * m, 20.0 * m));
    assert!(
        (solid.integrals().tensor - want).norm() < 1e-13,
        "{}",
        solid.integrals().tensor
    );
}

#[test]
fn obj_counts_backwards_cuts_polygons_and_names_lines() {
    let text = "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n\
        f 1/1/1 5/1/1 7/1/1 3/1/1\nf 2//1 4//1 8//1 6//1\nf 1 2 \\\n6 5\nf 3 7 8 4\nf -8 -6 -5 -7\nf 5 6 8 7\n";
    assert_eq!(
        parse("c.obj", text.as_bytes(), 1.0)
            .unwrap()
            .integrals()
            .volume,
        8.0
    );
    let wrong = |text: &str| {
        parse("c.obj", text.as_bytes(), 1.0)
            .unwrap_err()
            .to_string()
    };
    assert!(wrong(&text.replace("f 3 7 8 4\n", "")).contains("line 9"));
    assert_eq!(
        wrong(&text.replace("f 3 7 8 4", "f 3 7 8 99")),
        "line 13 names the vertex 99, and there is none of that number"
    );
    assert!(wrong("v 1 2\n").starts_with("line 1 is no vertex"));
    assert!(wrong("v 1 2 3\nf 1 1\n").starts_with("line 2 is no face"));
    assert!(wrong("v 1 2 3\nf 1 0 1\n").starts_with("line 2 is no face"));
    assert!(wrong("v 1 2 nan\nf 1 1 1\n").contains("not finite"));
}

#[test]
fn an_stl_of_several_solids_is_read_to_its_end() {
    let other = moved(&cube(), |p| p + Vector3::new(4.0, 0.0, 0.0));
    let text = stl_text(&cube(), "a") + &stl_text(&other, "b");
    let two = parse("x.stl", text.as_bytes(), 1.0).unwrap();
    assert!((two.integrals().volume - 16.0).abs() < 1e-14);
    let torn = &text[..text.len() - 60];
    assert!(parse("x.stl", torn.as_bytes(), 1.0).is_err());
}

#[test]
fn cubes_tend_to_the_exact_tensor() {
    // A box that fills its own bounding box is cut without a remainder: exact at any n.
    let solid = body(&moved(&cube(), |p| {
        p.component_mul(&Vector3::new(1.0, 2.0, 0.1))
    }));
    for n in [1, 3, 8] {
        let cubes = Cubes::of(&solid, n).integrals.unwrap();
        let exact = solid.integrals();
        assert!((cubes.volume / exact.volume - 1.0).abs() < 1e-14, "{n}");
        assert!(
            (cubes.tensor - exact.tensor).norm() < 1e-14 * exact.tensor.norm(),
            "{n}"
        );
    }
    let rows = orders(&solid, &[8, 16]);
    assert_eq!(
        (rows[1].order, mean_order(&rows)),
        (None, None),
        "rounding has no order"
    );
    // Bodies in general position, one of them with a cavity: at the surface n² blocks of n³ are counted wholly or not.
    let turn = Rotation3::from_euler_angles(0.3, 0.7, 0.2);
    let hollow = both(&sphere(4), &inward(&moved(&sphere(3), |p| p * 0.5)));
    for soup in [torus(96, 48), hollow, cube()] {
        let solid = body(&moved(&soup, |p| turn * p + Vector3::new(3.0, 2.0, -1.0)));
        let rows = orders(&solid, &[8, 16, 32, 64, 128]);
        let differences: Vec<f64> = rows.iter().map(|row| row.difference.unwrap()).collect();
        // First order at worst; where errors of n² blocks cancel like random ones, second.
        let order = mean_order(&rows).unwrap();
        assert!((1.0..2.6).contains(&order), "{order}: {differences:?}");
        for pair in rows.windows(2) {
            let ratio = pair[0].difference.unwrap() / pair[1].difference.unwrap();
            assert!((pair[1].order.unwrap() - ratio.log2()).abs() < 1e-12);
        }
        assert!(differences[4] < 1e-3, "{differences:?}");
        let cubes = rows[4].cubes.integrals.unwrap();
        assert!((cubes.centre - solid.integrals().centre).norm() < 1e-3);
    }
}

#[test]
fn a_ray_through_corners_and_along_edges_counts_right() {
    // An octahedron's rays at odd n go through its corners, its edges and the middles of its faces.
    let solid = body(&sphere(0));
    for n in [1, 3, 5, 9, 27] {
        let cubes = Cubes::of(&solid, n);
        let mut want = 0;
        for k in 0..n * n * n {
            let place = |i: usize| (2.0 * i as f64 + 1.0 - n as f64) / n as f64;
            let p = [k % n, k / n % n, k / n / n].map(place);
            want += u64::from(p.iter().map(|x| x.abs()).sum::<f64>() < 1.0 - 1e-12);
        }
        // Middles on the surface itself may count or not: |x| + |y| + |z| = 1 for odd multiples of 1/n has
        // none for n odd (three even numbers over n).
        assert_eq!(cubes.inside, want, "{n}");
    }
}

proptest! {
    #[test]
    fn turned_and_moved_the_body_is_the_same(axis in [-3.0..3.0_f64, -3.0..3.0, -3.0..3.0], shift in [-50.0..50.0_f64, -50.0..50.0, -50.0..50.0]) {
        let r = UnitQuaternion::new(Vector3::from(axis)).to_rotation_matrix();
        let soup = moved(&torus(12, 7), |p| p.component_mul(&Vector3::new(1.0, 2.0, 0.7)));
        let there = body(&moved(&soup, |p| r * p + Vector3::from(shift)));
        let (a, b) = (*body(&soup).integrals(), *there.integrals());
        // Corners are rounded where they lie, to 1e-14 at 50.
        prop_assert!((a.volume / b.volume - 1.0).abs() < 1e-13);
        prop_assert!((r * a.centre + Vector3::from(shift) - b.centre).norm() < 1e-13);
        prop_assert!((turned(&a.tensor, r.matrix()) - b.tensor).norm() < 1e-13 * a.tensor.norm());
    }

    #[test]
    fn no_bytes_make_a_panic(which in 0..5_usize, seed in any::<u64>(), hits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..12), cut in any::<prop::sample::Index>(), truncate in any::<bool>()) {
        let (name, mut bytes) = match which {
            0 => ("x.obj", obj(&cube()).into_bytes()),
            1 => ("x.stl", stl_text(&cube(), "s").into_bytes()),
            2 => ("x.stl", stl_binary(&cube(), b"b")),
            3 => ("x.glb", glb(&cube(), "")),
            _ => ("x.glb", glb(&cube(), r#","scale":[1,2,3],"children":[1]"#)),
        };
        // Digits for digits as often as any byte for any byte: so that numbers change and syntax holds.
        for (k, (index, byte)) in hits.iter().enumerate() {
            let at = index.index(bytes.len());
            let digit = bytes[at].is_ascii_digit() && seed >> k & 1 == 1;
            bytes[at] = if digit { b'0' + byte % 10 } else { *byte };
        }
        if truncate {
            bytes.truncate(cut.index(bytes.len()));
        }
        if let Ok(solid) = parse(name, &bytes, 1.0) {
            let sum = solid.integrals();
            prop_assert!(sum.volume.is_finite() && sum.tensor.iter().all(|x| x.is_finite()));
            let _ = Cubes::of(&solid, 8);
        }
    }
}
