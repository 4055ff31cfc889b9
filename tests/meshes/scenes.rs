//! Scenes of nested instances hold the surfaces and colours of the elements, for readers of their formats.

use std::collections::BTreeMap;
use std::io::Cursor;

use kfrac::geometry::{DAffine3, DMat3, DVec3};
use kfrac::render::space::{SpaceError, SpaceOptions};
use kfrac::render::{MeshFormat, RenderError, SceneFormat, Unit, write_scene};
use kfrac::render::{Options, Size};
use threemf2::model::domain::model::Model;
use threemf2::model::domain::object::{ObjectKind, ObjectType};
use threemf2::model::domain::transform::Transform;
use threemf2::package::ThreemfPackage;

use crate::common;
use kfrac::style::ColorBy;

use super::{graph, is_near, read_obj, sizes, write};

fn scene(name: &str, steps: u32, format: SceneFormat) -> Vec<u8> {
    let model = common::document(name).resolve(&[]).unwrap().0;
    let options = Options::of(model.metadata());
    let graph = model.compile_in_space(options.style.color_by == ColorBy::LastMap);
    let graph = graph.unwrap();
    let mut bytes = Vec::new();
    write_scene(
        &graph,
        steps,
        &options,
        &SpaceOptions::default(),
        format,
        None,
        &mut bytes,
    )
    .unwrap();
    bytes
}

/// Triangles in their places, with the colours of their elements.
type Soup = Vec<([DVec3; 3], [u8; 4])>;

/// Returns the places of points, and the order of a triangle's corners.
fn placed(place: &DAffine3, corners: [DVec3; 3]) -> [DVec3; 3] {
    let [a, b, c] = corners.map(|corner| place.transform_point3(corner));
    match place.matrix3.determinant() < 0.0 {
        true => [a, c, b],
        false => [a, b, c],
    }
}

/// Reads a scene in binary glTF, and returns the number of its nodes and its triangles.
fn read_glb(bytes: &[u8]) -> (usize, Soup) {
    let gltf = gltf::Gltf::from_slice(bytes).unwrap();
    let blob = gltf.blob.as_deref().unwrap();
    let mut soup = Vec::new();
    let scene = gltf.default_scene().unwrap();
    let mut open: Vec<_> = scene
        .nodes()
        .map(|node| (DAffine3::IDENTITY, node))
        .collect();
    while let Some((before, node)) = open.pop() {
        let columns = node
            .transform()
            .matrix()
            .map(|column| column.map(f64::from));
        let column = |column: usize| DVec3::from_slice(&columns[column]);
        let linear = DMat3::from_cols(column(0), column(1), column(2));
        let place = before * DAffine3::from_mat3_translation(linear, column(3));
        open.extend(node.children().map(|child| (place, child)));
        for primitive in node.mesh().into_iter().flat_map(|mesh| {
            let primitives: Vec<_> = mesh.primitives().collect();
            primitives
        }) {
            let colour = primitive.material().pbr_metallic_roughness();
            let [red, green, blue, alpha] = colour.base_color_factor();
            let colour = [encoded(red), encoded(green), encoded(blue), byte(alpha)];
            let reader = primitive.reader(|_| Some(blob));
            let corners = reader.read_positions().unwrap();
            let corners: Vec<DVec3> = corners.map(|it| DVec3::from(it.map(f64::from))).collect();
            let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
            for triangle in indices.chunks(3) {
                let triangle: [u32; 3] = triangle.try_into().unwrap();
                let triangle = triangle.map(|corner| corners[corner as usize]);
                soup.push((placed(&place, triangle), colour));
            }
        }
    }
    (gltf.nodes().count(), soup)
}

/// Returns the sRGB value of a linear one.
fn encoded(linear: f32) -> u8 {
    byte(if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    })
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "parts of colours are from 0 to 1"
)]
fn byte(part: f32) -> u8 {
    (part * 255.0).round() as u8
}

fn place(transform: Option<&Transform>) -> DAffine3 {
    transform.map_or(DAffine3::IDENTITY, |it| DAffine3::from_cols_slice(&it.0))
}

/// Reads a 3MF package, and returns the number of its objects and its triangles. Every object stands before those
/// that refer to it.
fn read_3mf(bytes: &[u8]) -> (usize, Soup) {
    let package =
        ThreemfPackage::from_reader_with_memory_optimized_deserializer(Cursor::new(bytes), false)
            .unwrap();
    let model: &Model = &package.root;
    let colours: Vec<[u8; 4]> = { model.resources.basematerials[0].base.iter() }
        .map(|base| {
            let digits = base.displaycolor.to_string();
            let part = |at: usize| u8::from_str_radix(&digits[at..at + 2], 16).unwrap();
            [1, 3, 5, 7].map(part)
        })
        .collect();
    let mut known: BTreeMap<u32, Soup> = BTreeMap::new();
    for object in &model.resources.object {
        let mut soup = Vec::new();
        match object.kind.as_ref().unwrap() {
            ObjectKind::Mesh(mesh) => {
                let corners = mesh.vertices.vertex.iter();
                let corners: Vec<DVec3> = corners
                    .map(|it| DVec3::new(it.x.value(), it.y.value(), it.z.value()))
                    .collect();
                for triangle in &mesh.triangles.triangle {
                    let own = object.pindex.get().unwrap();
                    let colour = colours[triangle.p1.unwrap_or(own) as usize];
                    let triangle = [triangle.v1, triangle.v2, triangle.v3];
                    soup.push((triangle.map(|corner| corners[corner as usize]), colour));
                }
            }
            ObjectKind::Components(components) => {
                for component in &components.component {
                    let place = place(component.transform.as_ref());
                    assert!(place.matrix3.determinant() != 0.0);
                    let inner = known[&component.objectid].iter();
                    soup.extend(inner.map(|(it, colour)| (placed(&place, *it), *colour)));
                }
            }
            _ => panic!("an object of another kind"),
        }
        known.insert(object.id, soup);
    }
    let [item] = &model.build.item[..] else {
        panic!("one item");
    };
    let upright = place(item.transform.as_ref());
    let soup = known[&item.objectid].iter();
    let soup = soup.map(|(it, colour)| (placed(&upright, *it), *colour));
    (model.resources.object.len(), soup.collect())
}

/// Returns volume and area, and the area of every colour.
fn measured(soup: &Soup) -> ([f64; 2], BTreeMap<[u8; 4], f64>) {
    let mut colours = BTreeMap::new();
    let mut all = [0.0; 2];
    for (triangle, colour) in soup {
        let one = sizes(&(triangle.to_vec(), vec![vec![0, 1, 2]]));
        all = [all[0] + one[0], all[1] + one[1]];
        *colours.entry(*colour).or_default() += one[1];
    }
    (all, colours)
}

/// Returns the corners of the bounding box.
fn corners(points: impl Iterator<Item = DVec3>) -> [DVec3; 2] {
    points.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], it| {
        [low.min(it), high.max(it)]
    })
}

fn check(name: &str, soup: &Soup, steps: u32, scale: f64) {
    let read = read_obj(&write(name, steps, MeshFormat::Obj, false, 1).1);
    let [volume, area] = sizes(&read);
    let (found, _) = measured(soup);
    let (volume, area) = (volume * scale.powi(3), area * scale * scale);
    assert!(
        is_near(found[0], volume) && is_near(found[1], area),
        "{name}: {found:?}, {volume} {area}"
    );
}

const SETS: [(&str, u32); 7] = [
    ("menger", 3),
    ("icosahedron-flake", 2),
    ("solid-tetrahedron", 3),
    ("pound-sign-in-space", 3),
    ("hart-tree", 12),
    // Maps are sheared and singular.
    ("fern-in-space", 4),
    ("romanesco", 2),
];

#[test]
fn glb_files_hold_the_surfaces_of_the_elements() {
    for (name, steps) in SETS {
        let (_, soup) = read_glb(&scene(name, steps, SceneFormat::Glb));
        check(name, &soup, steps, 1.0);
    }
    let (nodes, soup) = read_glb(&scene("menger", 3, SceneFormat::Glb));
    // The whole, its single object, and twenty copies of 400 cubes.
    assert_eq!((nodes, soup.len()), (22, 12 * 8000));
}

#[test]
fn packages_of_3mf_hold_the_surfaces_of_the_elements_upright_in_millimetres() {
    for (name, steps) in SETS {
        let read = read_obj(&write(name, steps, MeshFormat::Obj, false, 1).1);
        let [low, high] = corners(read.0.iter().copied());
        let scale = 100.0 / (high - low).max_element();
        let (_, soup) = read_3mf(&scene(name, steps, SceneFormat::ThreeMf));
        check(name, &soup, steps, scale);
        // y, which points up, is z.
        let [from, to] = corners(soup.iter().flat_map(|(triangle, _)| *triangle));
        let size = (high - low) * scale;
        let upright = DVec3::new(size.x, size.z, size.y);
        // The stem of the fern has no faces.
        let is_whole = name != "fern-in-space";
        assert!(
            from.min_element() > -0.01 && (from.max_element() < 0.01 || !is_whole),
            "{name}: {from}"
        );
        assert!(
            to.abs_diff_eq(upright, if is_whole { 0.01 } else { 1.0 }),
            "{name}: {to} {upright}"
        );
    }
    let (objects, _) = read_3mf(&scene("menger", 3, SceneFormat::ThreeMf));
    // A cube, an object for every step, and the whole.
    assert_eq!(objects, 1 + 3 + 1);
}

/// The surfaces of an element are one mesh that encloses its volume, with the colours of its surfaces.
#[test]
fn surfaces_of_an_element_are_a_closed_mesh() {
    let text = "{space: 3, initiator: {closed: false, elements: [{from: [0, 0, 0], to: [1, 0, 0]}]}, \
                generator: {elements: [{from: [0, 0, 0], to: [1/2, 0, 0]}, {from: [1/2, 0, 0], to: [1, 0, 0]}]}, \
                base_element: {surfaces: [\
                {points: [[0, 0, 0], [0, 1, 0], [1, 0, 0]], color: red}, \
                {points: [[0, 0, 0], [1, 0, 0], [0, 0, 1]], color: blue}, \
                {points: [[0, 0, 0], [0, 0, 1], [0, 1, 0]], color: red}, \
                {points: [[1, 0, 0], [0, 1, 0], [0, 0, 1]], color: blue}]}}";
    let model = common::document_of(text).resolve(&[]).unwrap().0;
    let growth = kfrac::grow::Growth::steps(1);
    let drawn = { model.drawn_in_space(Some(1), &growth, ColorBy::None) }
        .unwrap()
        .unwrap();
    let steps = drawn.steps.unwrap();
    let written = |format| {
        let mut bytes = Vec::new();
        let space = SpaceOptions::default();
        let mut options = Options::of(model.metadata());
        options.style.color_by = ColorBy::Tint;
        write_scene(
            &drawn.graph,
            steps,
            &options,
            &space,
            format,
            None,
            &mut bytes,
        )
        .unwrap();
        bytes
    };
    let package = written(SceneFormat::ThreeMf);
    let (_, soup) = read_3mf(&package);
    let ([volume, _], colours) = measured(&soup);
    // Two tetrahedra, of which the whole is 100 mm long.
    assert!(is_near(volume, 2.0 * 50f64.powi(3) / 6.0), "{volume}");
    assert_eq!(colours.len(), 2, "{colours:?}");
    let package = ThreemfPackage::from_reader_with_memory_optimized_deserializer(
        Cursor::new(&package),
        false,
    )
    .unwrap();
    for object in &package.root.resources.object {
        if object.get_mesh().is_some() {
            let kind = object.objecttype.as_ref();
            assert!(matches!(kind, None | Some(ObjectType::Model)), "{kind:?}");
        }
    }
    let (_, soup) = read_glb(&written(SceneFormat::Glb));
    let ([volume, _], colours) = measured(&soup);
    assert!(is_near(volume, 2.0 / 8.0 / 6.0), "{volume}");
    assert_eq!(colours.len(), 2, "{colours:?}");
}

#[test]
fn a_length_is_that_of_the_long_side_of_a_package() {
    let (options, graph) = graph("menger");
    let options = options.size(Size::Long(425)).unit(Unit::Tenth);
    let mut bytes = Vec::new();
    write_scene(
        &graph,
        1,
        &options,
        &SpaceOptions::default(),
        SceneFormat::ThreeMf,
        None,
        &mut bytes,
    )
    .unwrap();
    let (_, soup) = read_3mf(&bytes);
    let [low, high] = corners(soup.iter().flat_map(|(triangle, _)| *triangle));
    assert!((high - low).abs_diff_eq(DVec3::splat(42.5), 1e-3));
}

#[test]
fn scenes_have_the_colours_of_the_elements() {
    let (glb, threemf) = (SceneFormat::Glb, SceneFormat::ThreeMf);
    for name in ["solid-tetrahedron", "pound-sign-in-space"] {
        let one = measured(&read_glb(&scene(name, 3, glb)).1);
        let other = measured(&read_3mf(&scene(name, 3, threemf)).1);
        assert!(one.1.len() > 1, "{name}: {:?}", one.1);
        let shares = |(all, colours): ([f64; 2], BTreeMap<[u8; 4], f64>)| {
            let share =
                move |(colour, area): ([u8; 4], f64)| (colour, (area / all[1] * 1e6).round());
            let shares: Vec<_> = colours.into_iter().map(share).collect();
            shares
        };
        assert_eq!(shares(one), shares(other), "{name}");
    }
}

/// Reads the objects of a scene of POV-Ray: declarations of meshes, primitives and unions. Returns volume and area of
/// the whole, of meshes, and its number of primitives.
fn read_pov(text: &str) -> ([f64; 2], u64) {
    let numbers = |text: &str| -> Vec<f64> {
        let words = text.split(|it: char| !(it.is_ascii_digit() || ".-e".contains(it)));
        words.filter_map(|word| word.parse().ok()).collect()
    };
    let mut known: BTreeMap<String, (Soup, u64)> = BTreeMap::new();
    let mut own = (Vec::new(), 0);
    let mut name = String::new();
    let (_, objects) = text.split_once("light_source").unwrap();
    let mut lines = objects.lines().skip(1);
    while let Some(line) = lines.next() {
        let line = match line.strip_prefix("#declare ") {
            Some(rest) => {
                let (new, rest) = rest.split_once(" = ").unwrap();
                name = new.to_owned();
                rest
            }
            None => line,
        };
        let ends = if let Some(rest) = line.strip_prefix("object { ") {
            let (inner, rest) = rest.split_once(" matrix ").unwrap();
            let place = DAffine3::from_cols_slice(&numbers(rest));
            let (soup, primitives) = known[inner].clone();
            own.0.extend(
                soup.iter()
                    .map(|(it, colour)| (placed(&place, *it), *colour)),
            );
            own.1 += primitives;
            false
        } else if line.starts_with("mesh2") {
            let corners = numbers(lines.next().unwrap());
            assert!(lines.next().unwrap().contains("texture_list"));
            lines.next();
            assert!(lines.next().unwrap().contains("face_indices"));
            let indices = numbers(lines.next().unwrap());
            assert_eq!(lines.next(), Some("} }"));
            for face in indices.chunks(4) {
                let corner = |it: usize| DVec3::from_slice(&corners[3 * index(face[it])..]);
                own.0.push(([corner(0), corner(1), corner(2)], [0; 4]));
            }
            // A mesh in a union is a part of it.
            name.starts_with('E')
        } else if line.starts_with("union") {
            false
        } else {
            own.1 += u64::from(line != "}");
            true
        };
        if ends {
            known.insert(std::mem::take(&mut name), std::mem::take(&mut own));
        }
    }
    let (soup, primitives) = &known[""];
    (measured(soup).0, *primitives)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "indices are small"
)]
fn index(number: f64) -> usize {
    number as usize
}

#[test]
fn scenes_of_pov_ray_hold_the_surfaces_of_the_elements() {
    let text = |name, steps| String::from_utf8(scene(name, steps, SceneFormat::Pov)).unwrap();
    for (name, steps) in SETS.into_iter().filter(|(name, _)| *name != "hart-tree") {
        let read = read_obj(&write(name, steps, MeshFormat::Obj, false, 1).1);
        let [volume, area] = sizes(&read);
        let (found, primitives) = read_pov(&text(name, steps));
        assert!(
            is_near(found[0], volume) && is_near(found[1], area) && primitives == 0,
            "{name}: {found:?}, {volume} {area}, {primitives}"
        );
    }
    // Round solids stay round.
    let elements = write("hart-tree", 12, MeshFormat::Obj, false, 1).0.elements;
    let (_, primitives) = read_pov(&text("hart-tree", 12));
    assert_eq!(primitives, elements);
}

#[test]
fn a_glb_that_would_be_too_large_is_refused_before_it_is_written() {
    // Sheared copies are no nodes.
    let text = "{kind: ifs, space: 3, maps: [{matrix: [[1/2, 1/4, 0], [0, 1/2, 0], [0, 0, 1/2]]}, \
                {scale: 1/2, translate: [1/2, 0, 0]}, {scale: 1/2, translate: [0, 1/2, 0]}, \
                {matrix: [[1/2, 0, 1/3], [0, 1/2, 0], [0, 0, 1/2]], translate: [1, 1, 1]}]}";
    let model = common::document_of(text).resolve(&[]).unwrap().0;
    let graph = model.compile_in_space(false).unwrap();
    let written = |steps| {
        let mut bytes = Vec::new();
        let options = Options::default();
        let format = SceneFormat::Glb;
        let written = write_scene(
            &graph,
            steps,
            &options,
            &SpaceOptions::default(),
            format,
            None,
            &mut bytes,
        );
        written.map(|_| bytes)
    };
    let (_, soup) = read_glb(&written(5).unwrap());
    assert_eq!(soup.len(), 12 << 10);
    let error = written(16).unwrap_err();
    let is_expected =
        matches!(error, RenderError::Space(SpaceError::TooLarge { bytes, .. }) if bytes > 1e9);
    assert!(is_expected, "{error}");
}
