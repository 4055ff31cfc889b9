//! Meshes of sets in space have the faces, edges, surfaces and volumes of their elements.

mod scenes;

use std::collections::BTreeMap;
use std::num::NonZero;

use crate::common;
use kfrac::geometry::{DVec3, Frame3};
use kfrac::graph::Graph;
use kfrac::grow::Growth;
use kfrac::render::{MeshFormat, MeshOptions, Meshed, Options, write_mesh};

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

fn read_obj(bytes: &[u8]) -> Read {
    let (mut corners, mut faces) = (Vec::new(), Vec::new());
    for line in std::str::from_utf8(bytes).unwrap().lines() {
        let mut words = line.split(' ');
        match words.next() {
            Some("v") => {
                let numbers: Vec<f64> = words.map(|word| word.parse().unwrap()).collect();
                corners.push(DVec3::from_slice(&numbers));
            }
            Some("f") => faces.push(
                words
                    .map(|word| word.parse::<usize>().unwrap() - 1)
                    .collect(),
            ),
            first => assert_eq!(first, Some("#"), "{line}"),
        }
    }
    (corners, faces)
}

fn float(bytes: &[u8]) -> f64 {
    f32::from_le_bytes(bytes.try_into().unwrap()).into()
}

fn read_ply(bytes: &[u8]) -> (Read, Vec<[u8; 3]>) {
    let end = b"end_header\n";
    let from = bytes.windows(end.len()).position(|it| it == end).unwrap();
    let head = std::str::from_utf8(&bytes[..from]).unwrap();
    let count = |what: &str| -> usize {
        let line = head.lines().find_map(|line| line.strip_prefix(what));
        line.unwrap().trim().parse().unwrap()
    };
    let (vertices, faces) = (count("element vertex"), count("element face"));
    let (points, mut rest) = bytes[from + end.len()..].split_at(12 * vertices);
    let points = points
        .chunks(12)
        .map(|it| DVec3::new(float(&it[..4]), float(&it[4..8]), float(&it[8..])));
    let (mut all, mut colours) = (Vec::new(), Vec::new());
    for _ in 0..faces {
        let end = 1 + 4 * usize::from(rest[0]);
        let index = |it: &[u8]| u32::from_le_bytes(it.try_into().unwrap()) as usize;
        all.push(rest[1..end].chunks(4).map(index).collect());
        colours.push(rest[end..end + 3].try_into().unwrap());
        rest = &rest[end + 3..];
    }
    assert!(rest.is_empty());
    ((points.collect(), all), colours)
}

fn read_stl(bytes: &[u8]) -> Read {
    assert!(!bytes.starts_with(b"solid"));
    let count = u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize;
    assert_eq!(bytes.len(), 84 + 50 * count);
    let (mut corners, mut faces) = (Vec::new(), Vec::new());
    for facet in bytes[84..].chunks(50) {
        let vectors = facet[..48].chunks(12);
        let vectors: Vec<DVec3> = vectors
            .map(|it| DVec3::new(float(&it[..4]), float(&it[4..8]), float(&it[8..])))
            .collect();
        let own = (vectors[2] - vectors[1]).cross(vectors[3] - vectors[1]);
        assert!(own.normalize().dot(vectors[0]) > 0.999);
        faces.push((corners.len()..corners.len() + 3).collect());
        // z points up in STL.
        corners.extend(vectors[1..].iter().map(|it| DVec3::new(it.x, it.z, -it.y)));
    }
    (corners, faces)
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
        // Every edge is passed once in either direction.
        let mut edges: BTreeMap<[usize; 2], u32> = BTreeMap::new();
        for face in &read.1 {
            for (number, &from) in face.iter().enumerate() {
                *edges
                    .entry([from, face[(number + 1) % face.len()]])
                    .or_default() += 1;
            }
        }
        let is_paired = |(edge, count): (&[usize; 2], &u32)| {
            let [from, to] = *edge;
            *count == 1 && edges.get(&[to, from]) == Some(&1)
        };
        assert!(edges.iter().all(is_paired), "step {steps}");
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
    let text = "{kind: ifs, space: 3, maps: [{matrix: [[-1/2, 0, 0], [0, 1/2, 0], [0, 0, 1/2]]}, \
                {scale: 1/2, translate: [2, 1, 1]}]}";
    let model = common::document_of(text).resolve(&[]).unwrap().0;
    let graph = model.compile_in_space(false).unwrap();
    let options = Options::default().threads(NonZero::<usize>::MIN);
    for steps in [1, 2] {
        let mut bytes = Vec::new();
        let mesh = MeshOptions::default().format(MeshFormat::Obj);
        write_mesh(&graph, &Growth::steps(steps), &options, mesh, &mut bytes).unwrap();
        let (corners, faces) = read_obj(&bytes);
        for faces in faces.chunks(6) {
            let [volume, _] = sizes(&(corners.clone(), faces.to_vec()));
            assert!(volume > 0.0, "step {steps}: {volume}");
        }
    }
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
