//! Meshes of sets in space have the faces, edges, surfaces and volumes of their elements.

mod scenes;

use std::collections::BTreeMap;
use std::num::NonZero;

use crate::common;
use kfrac::geometry::{DVec3, Frame3};
use kfrac::graph::Graph;
use kfrac::grow::Growth;
use kfrac::render::{MeshFormat, MeshOptions, Meshed, Options, write_mesh};
use kfrac::style::ColorBy;

fn graph(name: &str) -> (Options, Graph<Frame3>) {
    let model = common::document(name).resolve(&[]).unwrap().0;
    let graph = model.compile_in_space(true).unwrap();
    let options = Options::of(model.metadata()).threads(NonZero::<usize>::MIN);
    (options, graph)
}

fn write(
    name: &str,
    steps: u32,
    format: MeshFormat,
    shell: bool,
    threads: usize,
) -> (Meshed, Vec<u8>) {
    let (options, graph) = graph(name);
    let options = options.threads(NonZero::new(threads).unwrap());
    let mesh = MeshOptions::default().format(format).shell(shell);
    let mut bytes = Vec::new();
    let size = write_mesh(&graph, &Growth::steps(steps), &options, mesh, &mut bytes).unwrap();
    (size, bytes)
}

/// Corners, and the indices of the corners of faces.
type Read = (Vec<DVec3>, Vec<Vec<usize>>);

fn read_obj(mut bytes: &[u8]) -> Read {
    let options = tobj::LoadOptions::default();
    let no_materials = |_: &std::path::Path| Err(tobj::LoadError::GenericFailure);
    let (models, _) = tobj::load_obj_buf(&mut bytes, &options, no_materials).unwrap();
    let [tobj::Model { mesh, .. }] = models.as_slice() else {
        panic!("{} meshes", models.len());
    };
    let corners = mesh.positions.chunks(3).map(DVec3::from_slice);
    let mut indices = mesh.indices.iter().map(|index| *index as usize);
    let triangles = vec![3; mesh.indices.len() / 3];
    let arities = match mesh.face_arities.as_slice() {
        [] => &triangles,
        arities => arities,
    };
    let faces = arities
        .iter()
        .map(|arity| indices.by_ref().take(*arity as usize).collect());
    (corners.collect(), faces.collect())
}

fn read_ply(mut bytes: &[u8]) -> (Read, Vec<[u8; 3]>) {
    use ply_rs_bw::parser::Parser;
    use ply_rs_bw::ply::{DefaultElement, Property};

    let ply = Parser::<DefaultElement>::new()
        .read_ply(&mut bytes)
        .unwrap();
    assert!(bytes.is_empty());
    let corner = |vertex: &DefaultElement| {
        DVec3::from(["x", "y", "z"].map(|axis| match vertex[axis] {
            Property::Float(value) => f64::from(value),
            ref other => panic!("{other:?}"),
        }))
    };
    let face = |face: &DefaultElement| match &face["vertex_indices"] {
        Property::ListUInt(list) => list.iter().map(|index| *index as usize).collect(),
        other => panic!("{other:?}"),
    };
    let colour = |face: &DefaultElement| {
        ["red", "green", "blue"].map(|part| match face[part] {
            Property::UChar(value) => value,
            ref other => panic!("{other:?}"),
        })
    };
    let [vertices, faces] = ["vertex", "face"].map(|name| ply.payload[name].iter());
    let read = (
        vertices.map(corner).collect(),
        faces.clone().map(face).collect(),
    );
    (read, faces.map(colour).collect())
}

fn read_stl(bytes: &[u8]) -> Read {
    assert!(!bytes.starts_with(b"solid"));
    let mesh = stl_io::read_stl(&mut std::io::Cursor::new(bytes)).unwrap();
    // z points up in STL.
    let upright = |x: f32, y: f32, z: f32| DVec3::new(x.into(), z.into(), -f64::from(y));
    let corners = mesh.vertices.iter().map(|it| upright(it[0], it[1], it[2]));
    let corners: Vec<DVec3> = corners.collect();
    for face in &mesh.faces {
        let [a, b, c] = face.vertices.map(|corner| corners[corner]);
        let normal = upright(face.normal[0], face.normal[1], face.normal[2]);
        assert!((b - a).cross(c - a).normalize().dot(normal) > 0.999);
    }
    let faces = mesh.faces.iter().map(|face| face.vertices.to_vec());
    (corners, faces.collect())
}

/// Returns the volume, by the divergence theorem, and the area.
fn sizes((corners, faces): &Read) -> [f64; 2] {
    let triangles = faces.iter().flat_map(|face| {
        let others = face[1..].windows(2);
        others.map(|pair| [face[0], pair[0], pair[1]].map(|corner| corners[corner]))
    });
    triangles.fold([0.0; 2], |[volume, area], [a, b, c]| {
        let normal = (b - a).cross(c - a);
        [
            volume + a.dot(b.cross(c)) / 6.0,
            area + normal.length() / 2.0,
        ]
    })
}

fn is_near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-5 * b.abs()
}

#[test]
fn the_shell_of_a_menger_sponge_is_its_surface() {
    for (steps, expected) in [(1, 72), (2, 1056), (3, 18048)] {
        let (size, bytes) = write("menger", steps, MeshFormat::Obj, true, 2);
        assert_eq!((size.elements, size.faces), (20u64.pow(steps), expected));
        let read = read_obj(&bytes);
        assert_eq!(
            (read.0.len() as u64, read.1.len() as u64),
            (size.corners, size.faces)
        );
        // Menger 1926: volume and surface of approximants of the unit cube.
        let power = |base: f64| base.powi(i32::try_from(steps).unwrap());
        let [volume, area] = sizes(&read);
        assert!(is_near(volume, power(20.0 / 27.0)), "{volume}");
        let surface = 2.0 * power(20.0 / 9.0) + 4.0 * power(8.0 / 9.0);
        assert!(is_near(area, surface), "{area} {surface}");
        assert_eq!(open_edges(&read.1), 0, "step {steps}");
    }
}

/// Cubes that are written as meshes, one of them mirrored, and one turned, are those that are written as boxes.
#[test]
fn faces_of_meshes_keep_their_sides() {
    let mesh = "{points: [[0,0,0], [1,0,0], [1,1,0], [0,1,0], [0,0,1], [1,0,1], [1,1,1], [0,1,1]], \
                faces: [[0,3,2,1], [4,5,6,7], [0,1,5,4], [1,2,6,5], [2,3,7,6], [3,0,4,7]]}";
    let scene = "[cube, {object: cube, translate: [1, 0, 0]}, \
                 {object: cube, scale: [-1, 1, 1], translate: [3, 0, 0]}, \
                 {object: cube, rotate: {z: 180}, translate: [4, 1, 0]}]";
    for (map, expected) in [
        ("", 4.0),
        (", scale: [1, -1, 1]", 4.0),
        (", rotate: {x: 40}, scale: [1, 2, 1]", 8.0),
    ] {
        let text = format!(
            "kind: instancing\nspace: 3\nobjects: {{cube: [{{mesh: {mesh}}}], row: {scene}}}\n\
             scene: [{{object: row{map}}}]\n"
        );
        let model = common::document_of(&text).resolve(&[]).unwrap().0;
        let drawn = model.drawn_in_space(Some(3), &Growth::steps(3), ColorBy::None);
        let drawn = drawn.unwrap().unwrap();
        let growth = Growth::steps(drawn.steps.unwrap());
        let mesh = MeshOptions::default().format(MeshFormat::Obj);
        let mut bytes = Vec::new();
        write_mesh(&drawn.graph, &growth, &Options::default(), mesh, &mut bytes).unwrap();
        let read = read_obj(&bytes);
        let [volume, _] = sizes(&read);
        assert!(is_near(volume, expected), "{map}: {volume}");
    }
}

/// Triangles of a shell have the colours of the faces that they divide.
#[test]
fn shells_in_ply_keep_their_colours() {
    let (options, graph) = graph("menger");
    let mut options = options;
    options.style.color_by = ColorBy::Normal;
    let mesh = MeshOptions::default().format(MeshFormat::Ply).shell(true);
    let mut bytes = Vec::new();
    write_mesh(&graph, &Growth::steps(1), &options, mesh, &mut bytes).unwrap();
    let ((corners, faces), colours) = read_ply(&bytes);
    assert_eq!((faces.len(), colours.len()), (2 * 72, 2 * 72));
    let mut of_normals: BTreeMap<String, Vec<[u8; 3]>> = BTreeMap::new();
    for (face, colour) in faces.iter().zip(colours) {
        let [a, b, c] = [0, 1, 2].map(|number: usize| corners[face[number]]);
        let normal = (b - a).cross(c - a).normalize().round() + DVec3::ZERO;
        of_normals
            .entry(normal.to_string())
            .or_default()
            .push(colour);
    }
    assert_eq!(of_normals.len(), 6);
    for colours in of_normals.values() {
        assert!(colours.len() == 24 && colours.iter().all(|it| *it == colours[0]));
    }
    let different: std::collections::BTreeSet<_> = of_normals.values().map(|it| it[0]).collect();
    assert!(different.len() > 2);
}

/// Returns the number of edges that faces do not pass as often in one direction as in the other.
fn open_edges(faces: &[Vec<usize>]) -> usize {
    let mut edges: BTreeMap<[usize; 2], i32> = BTreeMap::new();
    for face in faces {
        for (number, &from) in face.iter().enumerate() {
            let to = face[(number + 1) % face.len()];
            let sense = if from < to { 1 } else { -1 };
            *edges.entry([from.min(to), from.max(to)]).or_default() += sense;
        }
    }
    edges.values().filter(|sum| **sum != 0).count()
}

/// Writes a step of a rule of the library as a shell.
fn shell_of_rule(name: &str, steps: u32) -> Read {
    let model = common::document(name).resolve(&[]).unwrap().0;
    let growth = Growth::steps(steps).seed(5);
    let drawn = model.drawn_in_space(Some(steps), &growth, ColorBy::None);
    let drawn = drawn.unwrap().unwrap();
    let growth = Growth::steps(drawn.steps.unwrap());
    let mesh = MeshOptions::default().format(MeshFormat::Obj).shell(true);
    let mut bytes = Vec::new();
    write_mesh(&drawn.graph, &growth, &Options::default(), mesh, &mut bytes).unwrap();
    read_obj(&bytes)
}

/// Koch surfaces stay closed: the faces around a bump, or in a pit, replace the one between. Their fronts are outside, and
/// their volumes have a closed form.
#[test]
fn koch_surfaces_are_closed() {
    // Regular tetrahedron of edge 1, and icosahedron.
    let tetrahedron = 2f64.sqrt() / 12.0;
    let icosahedron = 5.0 * (3.0 + 5f64.sqrt()) / 12.0;
    let triangles = |steps: u32| {
        (0..steps)
            .map(|k| 0.75f64.powi(k.cast_signed()))
            .sum::<f64>()
            / 8.0
    };
    let squares = |steps: u32| {
        (0..steps)
            .map(|k| (13.0f64 / 27.0).powi(k.cast_signed()))
            .sum::<f64>()
            / 27.0
    };
    for steps in 0..4 {
        let on_triangles = tetrahedron * triangles(steps);
        for (name, whole, bumps) in [
            (
                "koch-surface",
                8f64.powf(1.5) * tetrahedron,
                4.0 * 8f64.powf(1.5) * on_triangles,
            ),
            (
                "koch-icosahedron",
                8.0 * icosahedron,
                20.0 * 8.0 * on_triangles,
            ),
            (
                "koch-icosahedron-inwards",
                8.0 * icosahedron,
                -20.0 * 8.0 * on_triangles,
            ),
            ("koch-cube", 1.0, 6.0 * squares(steps)),
            ("koch-cube-inwards", 1.0, -6.0 * squares(steps)),
        ] {
            let read = shell_of_rule(name, steps);
            assert_eq!(open_edges(&read.1), 0, "{name} {steps}");
            let [volume, _] = sizes(&read);
            let expected = whole + bumps;
            assert!(
                (volume - expected).abs() < 1e-4 * whole,
                "{name} {steps}: {volume} {expected}"
            );
        }
    }
}

/// Triangles on both sides of an edge draw the same displacement: only the rim of the mountain is open.
#[test]
fn a_mountain_has_no_cracks() {
    for steps in [1, 3, 5] {
        let (corners, faces) = shell_of_rule("mountain", steps);
        let [side, count] = [2usize.pow(steps), 4usize.pow(steps)];
        assert_eq!(faces.len(), 6 * count);
        // The points of a triangular grid in a hexagon: three times as many triangles would have 18 · 4ⁿ corners.
        assert_eq!(corners.len(), 3 * side * side + 3 * side + 1);
        assert_eq!(open_edges(&faces), 6 * side);
        // It is no plane, and projects to the grid.
        let heights: Vec<f64> = corners.iter().map(|corner| corner.y).collect();
        assert!(heights.iter().any(|height| height.abs() > 0.02));
        let area = |face: &Vec<usize>| {
            let [a, b, c] = [0, 1, 2].map(|it| corners[face[it]]);
            (b - a).cross(c - a).y / 2.0
        };
        let whole = 6.0 * 3f64.sqrt() / 4.0;
        let sum: f64 = faces.iter().map(area).sum();
        assert!((sum.abs() - whole).abs() < 1e-5, "{sum}");
    }
}

#[test]
fn all_formats_hold_the_same_surface() {
    for name in ["menger", "icosahedron-flake"] {
        let obj = sizes(&read_obj(&write(name, 2, MeshFormat::Obj, false, 1).1));
        let stl = sizes(&read_stl(&write(name, 2, MeshFormat::Stl, false, 1).1));
        let (ply, _) = read_ply(&write(name, 2, MeshFormat::Ply, false, 1).1);
        for other in [stl, sizes(&ply)] {
            assert!(
                is_near(other[0], obj[0]) && is_near(other[1], obj[1]),
                "{name}: {other:?} {obj:?}"
            );
        }
        let shell = sizes(&read_stl(&write(name, 2, MeshFormat::Stl, true, 1).1));
        assert!(is_near(shell[0], obj[0]), "{name}: {shell:?} {obj:?}");
    }
}

#[test]
fn faces_of_mirrored_elements_turn_outwards() {
    for steps in [1, 2] {
        let obj = read_obj(&write_mirrored(steps, MeshFormat::Obj, 1));
        let (ply, _) = read_ply(&write_mirrored(steps, MeshFormat::Ply, 1));
        for ((corners, faces), sides) in [(obj, 6), (ply, 12)] {
            for faces in faces.chunks(sides) {
                let volume = volume(&corners, faces);
                assert!(volume > 0.0, "step {steps}: {volume}");
            }
        }
    }
}

/// Writes a system of two maps, of which the first mirrors, in colours by the last map.
fn write_mirrored(steps: u32, format: MeshFormat, threads: usize) -> Vec<u8> {
    let text = "{kind: ifs, space: 3, maps: [{matrix: [[-1/2, 0, 0], [0, 1/2, 0], [0, 0, 1/2]]}, \
                {scale: 1/2, translate: [2, 1, 1]}], style: {color_by: last-map, palette: viridis}}";
    let model = common::document_of(text).resolve(&[]).unwrap().0;
    let graph = model.compile_in_space(true).unwrap();
    let threads = NonZero::new(threads).unwrap();
    let options = Options::of(model.metadata()).threads(threads);
    let mut bytes = Vec::new();
    let mesh = MeshOptions::default().format(format);
    write_mesh(&graph, &Growth::steps(steps), &options, mesh, &mut bytes).unwrap();
    bytes
}

/// Returns the volume of an element from its faces.
fn volume(corners: &[DVec3], faces: &[Vec<usize>]) -> f64 {
    sizes(&(corners.to_vec(), faces.to_vec()))[0]
}

/// Two of three elements of step 17 are mirrored where the one before is not, or the other way round: too often to be noted,
/// so that a second walk writes the faces.
#[test]
fn faces_do_not_depend_on_how_they_are_written() {
    const SIDES: usize = 12;
    const CORNERS: usize = 8;
    let (few, few_colours) = read_ply(&write_mirrored(3, MeshFormat::Ply, 1));
    let many = write_mirrored(17, MeshFormat::Ply, 1);
    assert!(many == write_mirrored(17, MeshFormat::Ply, 3));
    let (many, many_colours) = read_ply(&many);
    assert_eq!((few.1.len(), many.1.len()), (8 * SIDES, SIDES << 17));
    // The map that is applied last, and whether the first one, which mirrors, is applied an odd number of times.
    let kind = |element: usize, steps: u32| {
        let mirrors = steps - element.count_ones();
        (element >> (steps - 1), mirrors % 2)
    };
    for element in 0..1 << 17 {
        let alike = (0..8).find(|other| kind(*other, 3) == kind(element, 17));
        let alike = alike.unwrap();
        for side in 0..SIDES {
            let [own, other] = [element, alike].map(|it| it * SIDES + side);
            let moved = few.1[other]
                .iter()
                .map(|it| it + (element - alike) * CORNERS);
            assert!(moved.eq(many.1[own].iter().copied()), "{element}");
            assert_eq!(many_colours[own], few_colours[other], "{element}");
        }
    }
    assert!(few_colours[0] != few_colours[4 * SIDES]);
}

#[test]
fn faces_of_a_ply_have_the_colours_of_their_elements() {
    let (size, bytes) = write("solid-tetrahedron", 3, MeshFormat::Ply, false, 1);
    let (_, colours) = read_ply(&bytes);
    let mut counts: BTreeMap<[u8; 3], usize> = BTreeMap::new();
    for colour in colours {
        *counts.entry(colour).or_default() += 1;
    }
    // Four maps of ten go to corners.
    assert_eq!(size.elements, 1000);
    let sides = usize::try_from(size.faces).unwrap() / 1000;
    let (faces, _) = read_ply(&write("menger", 1, MeshFormat::Ply, false, 1).1);
    assert!(faces.1.len() == 240 && faces.1.iter().all(|face| face.len() == 3));
    assert_eq!(
        counts.into_values().collect::<Vec<_>>(),
        [600 * sides, 400 * sides]
    );
}

#[test]
fn threads_change_no_byte() {
    for (format, shell) in [
        (MeshFormat::Stl, false),
        (MeshFormat::Obj, false),
        (MeshFormat::Ply, false),
        (MeshFormat::Ply, true),
    ] {
        let one = write("menger", 3, format, shell, 1);
        for threads in [2, 5] {
            assert!(
                write("menger", 3, format, shell, threads) == one,
                "{format:?} {threads}"
            );
        }
    }
}

#[test]
fn flat_sets_have_faces_and_lines_have_none() {
    let text = "{kind: ifs, space: 3, maps: [{scale: 1/2, translate: [0, 0, 1]}], condensation: [\
                {ellipse: {centre: [1, 0, 3], axes: [2, 1], rotate: 30}}, {point: [1, 2, 3]}, \
                {polyline: [[0, 0, 0], [1, 0, 0], [1, 1, 0]]}]}";
    let model = common::document_of(text).resolve(&[]).unwrap().0;
    let graph = model.compile_in_space(false).unwrap();
    let options = Options::default().threads(NonZero::<usize>::MIN);
    let mut bytes = Vec::new();
    let mesh = MeshOptions::default().format(MeshFormat::Obj);
    let size = write_mesh(&graph, &Growth::steps(1), &options, mesh, &mut bytes).unwrap();
    // An ellipse, a point and two segments, and their image.
    let (corners, faces) = read_obj(&bytes);
    assert_eq!((size.elements, faces.len()), (8, 2), "{size:?}");
    let faces = faces.iter();
    let mut faces = faces.map(|face| face.iter().map(|it| corners[*it]).collect::<Vec<_>>());
    let face = faces.find(|face| face[0].z == 3.0).unwrap();
    let (sine, cosine) = (0.5, 3f64.sqrt() / 2.0);
    for corner in &face {
        let at = *corner - DVec3::new(1.0, 0.0, 3.0);
        let [along, across] = [at.x * cosine + at.y * sine, at.y * cosine - at.x * sine];
        let radius = (along / 2.0).powi(2) + across.powi(2);
        assert!((radius - 1.0).abs() < 1e-6 && at.z == 0.0, "{at}");
    }
    assert_eq!(face.len(), 48);
    assert!((face[1] - face[0]).cross(face[2] - face[1]).z > 0.0);
}
