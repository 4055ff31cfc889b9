//! `symmetry`: the picture is the union of the images of the set under a cyclic or dihedral group.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use kfrac::catalogue::{Catalogue, LibraryFile, Shelf};
use kfrac::chaos::RandomPoints;
use kfrac::geometry::{DAffine2, DVec2};
use kfrac::graph::Graph;
use kfrac::grow::Growth;
use kfrac::model::Model;
use kfrac::zoom::Address;
use kfrac::{Fractal, Symmetry};
use resvg::tiny_skia::Pixmap;

use crate::common::{document_of, grown, said};

/// A group without an image that coincides with another, and its notation.
const NOTATION: &str = "symmetry: {rotate: 3, mirror: true, centre: [0.3, -0.2], axis: 20}";

fn group() -> Symmetry {
    Symmetry::new(3, Some(20.0), DVec2::new(0.3, -0.2))
}

/// Returns a model of the library as it is, and with the symmetry; `None` for a model in space.
fn both(entry: &LibraryFile) -> Option<[Model; 2]> {
    let kind = entry.shelf.kind();
    let of = |symmetry: &str| {
        let text = format!("kind: {kind}\nextends: {}\n{symmetry}\n", entry.name);
        document_of(&text).resolve(&[]).unwrap().0
    };
    let plain = of("symmetry: none");
    (!plain.is_in_space()).then(|| [plain, of(NOTATION)])
}

fn library() -> Vec<LibraryFile> {
    let mut entries = Catalogue::embedded().entries();
    entries.retain(|entry| Shelf::grown().contains(&entry.shelf));
    entries
}

fn graph(model: &Model, steps: u32) -> Option<Graph> {
    model.compile_for(steps, 7, 20_000).ok()
}

/// Everything in the library: each image is a fractal of its own, with the elements of the first one in their order, with
/// their indices and draws.
#[test]
fn images_have_the_elements_of_the_set() {
    let isometries = group().isometries();
    let mut kinds = BTreeSet::new();
    for entry in library() {
        let Some([plain, symmetric]) = both(&entry) else {
            continue;
        };
        let Some(steps) = (0..=3).rev().find(|&steps| {
            let size = graph(&plain, steps).map(|graph| graph.check_size(steps, 3_000).is_ok());
            size == Some(true)
        }) else {
            continue;
        };
        let growth = Growth::steps(steps).seed(7).max_elements(100_000);
        let [once, all] =
            [&plain, &symmetric].map(|model| grown(&graph(model, steps).unwrap(), &growth));
        assert_eq!(all.len(), once.len() * isometries.len(), "{}", entry.name);
        for (image, isometry) in all.chunks(once.len()).zip(&isometries) {
            for (a, b) in once.iter().zip(image) {
                assert_eq!((a.fractal.age, a.is_ring), (b.fractal.age, b.is_ring));
                assert_eq!(a.elements.len(), b.elements.len(), "{}", entry.name);
                for (a, b) in a.elements.iter().zip(&b.elements) {
                    let expected = *isometry * *a.frame.map();
                    let far = expected.translation.length().max(1.0) + a.frame.stretch();
                    let name = &entry.name;
                    assert!(b.frame.map().abs_diff_eq(expected, 1e-12 * far), "{name}");
                    assert_eq!((a.object, a.index, a.born), (b.object, b.index, b.born));
                    assert_eq!((a.joined, a.visible), (b.joined, b.visible), "{name}");
                    assert_eq!((a.length, a.appearance), (b.length, b.appearance), "{name}");
                }
            }
        }
        kinds.insert(entry.shelf.kind().to_string());
    }
    assert_eq!(kinds.len(), 4, "{kinds:?}");
}

/// Forecasts multiply by the order of the group, dimensions stay, and boxes are those of all images.
#[test]
fn counts_multiply_and_dimensions_stay() {
    let order = u64::from(group().order());
    for name in [
        "koch-snowflake",
        "pythagoras",
        "meadow",
        "self-seeding-square",
        "random-tree",
    ] {
        let of = |symmetry: &str| {
            let text = format!("extends: {name}\n{symmetry}\n");
            Fractal::parse(&text).unwrap().steps(3)
        };
        let [once, all] = [of("symmetry: none"), of(NOTATION)];
        let [a, b] = [&once, &all].map(|it| it.info().unwrap());
        assert_eq!(a.similarity.value, b.similarity.value, "{name}");
        let levels = a
            .levels
            .into_iter()
            .flatten()
            .zip(b.levels.into_iter().flatten());
        for (a, b) in levels {
            let times = |count: &kfrac::Count| count.to_u64().unwrap() * order;
            assert_eq!(b.elements.to_u64(), Some(times(&a.elements)), "{name}");
            assert_eq!(b.fertile.to_u64(), Some(times(&a.fertile)), "{name}");
            assert_eq!(b.fractals.to_u64(), Some(times(&a.fractals)), "{name}");
            for [a, b] in [[a.length, b.length], [a.area, b.area]] {
                let (Some(a), Some(b)) = (a, b) else {
                    assert_eq!(a, b, "{name}");
                    continue;
                };
                assert!((b - 6.0 * a).abs() < 1e-9 * b.abs(), "{name}: {a} {b}");
            }
        }
    }
}

/// A set that has the symmetry already keeps its box; another one gets the box of its images.
#[test]
fn boxes_are_those_of_all_images() {
    let square =
        "kind: ifs\nvertices: {points: [[1, 1], [-1, 1], [-1, -1], [1, -1]], shrink: 1/3}\n";
    let bounds = |text: &str| Fractal::parse(text).unwrap().bounds().unwrap();
    let plain = bounds(square);
    let same = bounds(&format!("{square}symmetry: {{rotate: 4, mirror: true}}\n"));
    assert!(
        same.min().abs_diff_eq(plain.min(), 1e-12) && same.max().abs_diff_eq(plain.max(), 1e-12)
    );
    let turned = bounds(&format!("{square}symmetry: {{rotate: 8}}\n"));
    assert!(
        turned.max().abs_diff_eq(DVec2::splat(2.0_f64.sqrt()), 1e-9),
        "{turned:?}"
    );
}

fn picture(folder: &Path, arguments: &[&str]) -> Pixmap {
    let arguments = [&["grow"], arguments, &["-o", "a.png"]].concat();
    let (status, message) = said(folder, &arguments);
    assert_eq!(status, Some(0), "{arguments:?}: {message}");
    Pixmap::load_png(folder.join("a.png")).unwrap()
}

/// Returns the fraction of pixels that differ by more than 40 shades, which antialiasing takes, between a picture and its image
/// under a map of pixels.
fn differing(a: &Pixmap, b: &Pixmap, place: impl Fn(u32, u32) -> (u32, u32)) -> f64 {
    let mut wrong = 0;
    for y in 0..a.height() {
        for x in 0..a.width() {
            let (u, v) = place(x, y);
            let (a, b) = (a.pixel(x, y).unwrap(), b.pixel(u, v).unwrap());
            let off = |a: u8, b: u8| a.abs_diff(b) > 40;
            wrong += u32::from(
                off(a.red(), b.red()) || off(a.green(), b.green()) || off(a.blue(), b.blue()),
            );
        }
    }
    f64::from(wrong) / f64::from(a.width() * a.height())
}

/// Pictures of the group D4 are symmetric by pixels, however they are drawn, random rules included.
#[test]
fn pictures_are_symmetric() {
    let folder = tempfile::tempdir().unwrap();
    let symmetry = "symmetry: {rotate: 4, mirror: true}\n";
    let files = [
        ("tree", "extends: random-tree\n"),
        ("koch", "extends: koch\n"),
        (
            "flake",
            "initiator: {elements: [[2, 1], [3, 1], [2.5, 2]], closed: true}\ngenerator: koch\nstyle: {fill: red}\n",
        ),
        ("fern", "kind: ifs\nextends: barnsley-fern\n"),
        ("bush", "kind: lsystem\nextends: hilbert-lsystem\n"),
    ];
    for (name, text) in files {
        let text = format!("{text}{symmetry}");
        fs::write(folder.path().join(format!("{name}.yaml")), text).unwrap();
        let more: &[&[&str]] = match name {
            "fern" => &[
                &[],
                &["--steps", "6"],
                &["--method", "chaos", "--points", "2M"],
            ],
            "flake" => &[&[], &["--color-by", "index"]],
            _ => &[&["--color-by", "none"]],
        };
        for &more in more {
            let rule = format!("{name}.yaml");
            let arguments = [&[rule.as_str(), "--size", "200x200", "--seed", "3"], more].concat();
            let drawn = picture(folder.path(), &arguments);
            let last = drawn.width() - 1;
            assert_eq!(drawn.width(), drawn.height());
            let most = match more.first() {
                // Points near the edges of pixels.
                Some(&"--method") => 0.02,
                _ => 0.002,
            };
            let turned = |x: u32, y: u32| (y, last - x);
            let mirrored = |x: u32, y: u32| (last - x, y);
            for off in [
                differing(&drawn, &drawn, turned),
                differing(&drawn, &drawn, mirrored),
            ] {
                assert!(off <= most, "{arguments:?}: {off}");
            }
        }
    }
}

/// All ways to write a picture agree, on any number of threads.
#[test]
fn threads_and_formats_agree() {
    let folder = tempfile::tempdir().unwrap();
    let text = format!("extends: random-tree\n{NOTATION}\n");
    fs::write(folder.path().join("a.yaml"), text).unwrap();
    for name in ["a.csv", "a.svg", "a.png"] {
        let mut bytes = BTreeSet::new();
        for threads in ["1", "4"] {
            let arguments = [
                "grow",
                "a.yaml",
                "--steps",
                "9",
                "--threads",
                threads,
                "-o",
                name,
            ];
            let (status, message) = said(folder.path(), &arguments);
            assert_eq!(status, Some(0), "{message}");
            bytes.insert(fs::read(folder.path().join(name)).unwrap());
        }
        assert_eq!(bytes.len(), 1, "{name}");
    }
}

/// The points of a random walk come with their images.
#[test]
fn random_points_come_with_their_images() {
    let text = format!("kind: ifs\nextends: gasket\n{NOTATION}\n");
    let Model::Ifs(system) = document_of(&text).resolve(&[]).unwrap().0 else {
        panic!("not a system");
    };
    let plain = kfrac::chaos::WeightedMaps::of(system.ifs()).unwrap();
    let all = plain.clone().with_images(group().isometries());
    let start = kfrac::chaos::Start::Attractor;
    let once: Vec<_> = RandomPoints::new(&plain, &start, 5).take(50).collect();
    let points: Vec<_> = RandomPoints::new(&all, &start, 5).take(300).collect();
    for (point, images) in once.iter().zip(points.chunks(6)) {
        for (isometry, image) in group().isometries().iter().zip(images) {
            assert_eq!(image.place, isometry.transform_point2(point.place));
            assert_eq!(image.map, point.map);
        }
    }
}

/// A zoom into an image shows the image of the zoom into the set, at any magnification.
#[test]
fn zooms_show_images() {
    let folder = tempfile::tempdir().unwrap();
    let text = "extends: koch\nsymmetry: {rotate: 4, mirror: true, centre: [1/3, -1/7]}\n";
    fs::write(folder.path().join("four.yaml"), text).unwrap();
    let zoom = |rule: &str, at: &str| {
        let arguments = [rule, "--zoom", "1e40", "--at", at, "--size", "160x160"];
        picture(folder.path(), &arguments)
    };
    let plain = zoom("four.yaml", "0.(1.2)");
    let last = plain.width() - 1;
    // Positions 1 to 3 are rotations, 4 is the mirror image at the upright line.
    let turned = zoom("four.yaml", "1.(1.2)");
    assert!(differing(&plain, &turned, |x, y| (y, last - x)) < 0.002);
    assert!(differing(&plain, &turned, |x, y| (x, y)) > 0.02);
    let mirrored = zoom("four.yaml", "4.(1.2)");
    assert!(differing(&plain, &mirrored, |x, y| (last - x, y)) < 0.002);
    assert!(matches!("4.(1.2)".parse(), Ok(Address::Path { .. })));
}

/// A file that extends another inherits its symmetry, changes it, or takes it back.
#[test]
fn symmetry_is_inherited() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(
        path.join("six.yaml"),
        "extends: koch\nsymmetry: {rotate: 6}\n",
    )
    .unwrap();
    for (name, own, group) in [
        ("heir", "", Some("C6")),
        ("other", "symmetry: {mirror: true}\n", Some("D1")),
        ("none", "symmetry: none\n", None),
        (
            "formula",
            "params: {n: 5}\nsymmetry: {rotate: 2 * n, mirror: true}\n",
            Some("D10"),
        ),
    ] {
        let file = path.join(format!("{name}.yaml"));
        fs::write(&file, format!("extends: six.yaml\n{own}")).unwrap();
        let fractal = Fractal::open(&file).unwrap();
        let found = fractal
            .model()
            .metadata()
            .symmetry
            .as_ref()
            .map(ToString::to_string);
        assert_eq!(found.as_deref(), group, "{name}");
        let (status, _) = said(path, &["info", &format!("{name}.yaml")]);
        assert_eq!(status, Some(0));
    }
}

/// A set of another kind has the symmetry as well.
#[test]
fn conversions_keep_it() {
    let text = format!("extends: koch\n{NOTATION}\n");
    let model = document_of(&text).resolve(&[]).unwrap().0;
    let expected = Fractal::parse(&text).unwrap().bounds().unwrap();
    for kind in [
        kfrac::Kind::Ifs,
        kfrac::Kind::Instancing,
        kfrac::Kind::LSystem,
    ] {
        let converted = kfrac::convert::convert(&model, kind, Default::default()).unwrap();
        let other = converted.resolve(&[]).unwrap().0;
        assert_eq!(
            other.metadata().symmetry,
            model.metadata().symmetry,
            "{kind:?}"
        );
        let graph = other.of_limit().compile(3).unwrap();
        let bounds = graph.limit_bounds().unwrap();
        let limit = model.compile(3).unwrap().limit_bounds().unwrap();
        assert!(bounds.min().abs_diff_eq(limit.min(), 1e-9), "{kind:?}");
        assert!(bounds.max().abs_diff_eq(limit.max(), 1e-9), "{kind:?}");
    }
    assert!(expected.size().min_element() > 0.5);
}

/// An initiator and its images are listed up to the limit of elements.
#[test]
fn images_do_not_exhaust_memory() {
    let folder = tempfile::tempdir().unwrap();
    let text = "extends: koch\nsymmetry: {rotate: 360, mirror: true}\n";
    fs::write(folder.path().join("many.yaml"), text).unwrap();
    let listed = ["grow", "many.yaml", "--max-elements", "500", "-o", "a.svg"];
    let (status, message) = said(folder.path(), &listed);
    assert_eq!(status, Some(1), "{message}");
    let expected = "the initiator and its images under D360 have more than 500 elements";
    assert!(message.contains(expected), "{message}");
    assert!(!folder.path().join("a.svg").exists());
}

/// The isometries of the group are those of the file's axes.
#[test]
fn the_axis_is_a_mirror_line() {
    let all = group().isometries();
    let on_axis = DVec2::new(0.3, -0.2) + 2.0 * DVec2::from_angle(20_f64.to_radians());
    let keeps = |map: &&DAffine2| map.transform_point2(on_axis).abs_diff_eq(on_axis, 1e-12);
    let kept: Vec<_> = all.iter().filter(keeps).collect();
    assert_eq!(kept.len(), 2);
    assert!(kept[1].matrix2.determinant() < 0.0);
}
