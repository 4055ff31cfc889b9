//! Data sets as wholes: purity, order, laws, mistakes.

use std::num::NonZero;

use crate::chaos::Game;
use crate::geometry::{DAffine2, DAffine3, DMat2, DMat3, DVec3};
use crate::measure::exact::Hausdorff;
use crate::random::Pcg;
use crate::style::Camera;

use super::extent::attractor_box;
use super::maps::{Attractor, weighted};
use super::random::anderson;
use super::{Dataset, DatasetError, Framing, WeightedMap, Weights};

const RANDOM: &str = "{kind: dataset, seed: 3, categories: {systems: {random: {maps: [2, 5]}, count: 12}}, \
                      instances: {count: 30, weights: fractaldb, flips: true}, picture: {size: 48, points: 5k, MORE}}";

fn set(more: &str) -> Dataset {
    Dataset::parse(&RANDOM.replace(", MORE", more)).unwrap()
}

#[test]
fn pictures_do_not_depend_on_what_was_drawn_before() {
    for more in [
        "",
        ", mode: binary",
        ", mode: patch3, colour: hsv",
        ", colour: viridis, fit: shape",
    ] {
        let (forwards, backwards) = (set(more), set(more));
        let len = forwards.len();
        assert_eq!(len, 360);
        let picked: Vec<u64> = (0..len).step_by(23).collect();
        let mut there: Vec<_> = picked
            .iter()
            .map(|it| forwards.example(*it).unwrap())
            .collect();
        let back: Vec<_> = { picked.iter().rev() }
            .map(|it| backwards.example(*it).unwrap())
            .collect();
        there.reverse();
        for (one, other) in there.iter().zip(&back) {
            assert_eq!(one.picture, other.picture);
            assert_eq!(one.label, other.label);
            assert!(one.picture.bytes().iter().any(|byte| *byte > 0));
        }
        let two = NonZero::new(2).unwrap();
        let batch = forwards.render(100..110, two, None).unwrap();
        let one = backwards.example(107).unwrap().picture.into_bytes();
        assert_eq!(batch.bytes[7 * one.len()..8 * one.len()], one[..]);
        assert_eq!(batch.categories, [3; 10]);
    }
}

#[test]
fn instances_differ_by_weights_and_flips() {
    let set = set("");
    let at = |instance: u64| set.example(60 + instance).unwrap();
    let own = set.category(2).unwrap().maps();
    assert_eq!(at(0).label.maps.as_ref(), own);
    // The second coefficient of all maps, times 1 - 2 · 0.4, unless that diverges.
    let varied = at(5).label.maps.unwrap().rows();
    for (one, other) in varied.iter().zip(own.unwrap().rows()) {
        assert!(
            one.iter()
                .zip(&other)
                .enumerate()
                .all(|(place, (a, b))| place == 1 || a == b)
        );
        assert!((one[1] - 0.2 * other[1]).abs() < 1e-12);
    }
    let flips: Vec<u8> = (0..30).map(|it| at(it).label.flip).collect();
    assert_eq!(flips, [[0; 25].as_slice(), &[1; 5]].concat());
}

#[test]
fn parts_cover_the_whole() {
    let set = set("");
    for count in [1, 2, 7, 64, 1000] {
        let parts: Vec<_> = (1..=count).map(|number| set.shard(number, count)).collect();
        assert_eq!(parts[0].start, 0);
        assert_eq!(parts[parts.len() - 1].end, set.len());
        assert!(parts.windows(2).all(|pair| pair[0].end == pair[1].start));
        let sizes = parts.iter().map(|part| part.end - part.start);
        let (least, most) = (sizes.clone().min().unwrap(), sizes.max().unwrap());
        assert!(most - least <= 1);
    }
}

/// FractalDB's search accepts one system of several, and those cover at least a fifth of the picture.
#[test]
fn accepted_systems_fill_their_pictures() {
    let text = "{kind: dataset, categories: {systems: {random: {sigma: uniform}, count: 6}}, \
                picture: {size: 512, mode: binary}, accept: {fill: 0.2}}";
    let set = Dataset::parse(text).unwrap();
    let mut attempts = 0;
    for index in 0..6 {
        let picture = set.example(index).unwrap().picture;
        let hit = picture.bytes().iter().filter(|byte| **byte > 0).count();
        // The picture has other points than those by which the system was accepted.
        assert!(hit as f64 > 0.19 * 512.0 * 512.0, "{hit}");
        attempts += set
            .category(u32::try_from(index).unwrap())
            .unwrap()
            .attempts();
    }
    assert!(attempts > 12, "{attempts}");
}

#[test]
fn families_draw_their_parameters() {
    let parse = |count: &str| {
        let text = "{kind: dataset, categories: {systems: {rule: pythagoras, params: {angle: 'uniform(20, 70)'}COUNT}}, \
                    instances: {count: 4}, picture: {size: 40}}";
        Dataset::parse(&text.replace("COUNT", count)).unwrap()
    };
    let angle = |set: &Dataset, index| {
        let label = set.label(index).unwrap();
        assert_eq!(label.parameters[0].0, "angle");
        assert!((20.0..70.0).contains(&label.parameters[0].1));
        label.parameters[0].1
    };
    let one = parse("");
    assert_eq!((one.categories(), one.len()), (1, 4));
    assert_ne!(angle(&one, 0), angle(&one, 1));
    assert_ne!(
        one.example(0).unwrap().picture,
        one.example(1).unwrap().picture
    );
    let three = parse(", count: 3");
    assert_eq!(three.len(), 12);
    assert_eq!(angle(&three, 0), angle(&three, 3));
    assert_ne!(angle(&three, 0), angle(&three, 4));
    assert_eq!(three.category(1).unwrap().name(), "00001-pythagoras-1");
}

#[test]
fn the_library_and_tables_are_categories() {
    let folder = tempfile::tempdir().unwrap();
    let gasket = "0.5,0,0,0.5,0,0,0.3\n0.5,0,0,0.5,0.5,0,0.3\n0.5,0,0,0.5,0,0.5,0.4\n";
    std::fs::create_dir(folder.path().join("maps")).unwrap();
    std::fs::write(folder.path().join("maps/gasket.csv"), gasket).unwrap();
    let spec = folder.path().join("set.yaml");
    std::fs::write(&spec, "{kind: dataset, categories: {systems: [{library: [ifs]}, {csv: maps}]}, picture: {size: 32, points: 2k}}").unwrap();
    let set = Dataset::open(&spec).unwrap();
    let last = set.categories() - 1;
    assert!(last > 30);
    for number in 0..=last {
        let picture = set.example(number.into()).unwrap().picture;
        assert!(picture.bytes().iter().any(|byte| *byte > 0), "{number}");
    }
    let category = set.category(last).unwrap();
    assert_eq!(category.name(), format!("{last:05}-gasket"));
    let form = category
        .dimension()
        .and_then(|it: &Hausdorff| it.closed_form.clone());
    assert_eq!(form.as_deref(), Some("log(3)/log(2)"));
    std::fs::write(folder.path().join("maps/gasket.csv"), "1,2\n").unwrap();
    let error = Dataset::open(&spec).unwrap_err().to_string();
    assert!(
        error.contains("gasket.csv:1: a row has 7 numbers"),
        "{error}"
    );
}

/// Every variation is seen from all directions before the next one.
#[test]
fn systems_in_space_are_seen_from_around() {
    let text = "{kind: dataset, categories: {systems: [{random: {maps: 3, space: 3, sigma: uniform}, count: 2}, \
                {rule: sierpinski-tetrahedron}]}, instances: {count: 400, weights: fractaldb, flips: true, views: 6}, \
                picture: {size: 48, points: 5k}, accept: {fill: 0.02}}";
    let set = Dataset::parse(text).unwrap();
    assert_eq!(set.categories(), 3);
    for category in 0..3 {
        let at = |instance: u64| set.example(category * 400 + instance).unwrap();
        let first = at(0);
        let rows = first.label.maps.as_ref().unwrap().rows();
        assert!(rows.iter().all(|row| row.len() == 13));
        for view in 1..6 {
            let other = at(view);
            assert_eq!(other.label.maps, first.label.maps);
            let azimuth = f64::from(u32::try_from(view).unwrap()) * 60.0;
            assert_eq!(other.label.from, Some([azimuth, 30.0]));
            assert_ne!(other.picture, first.picture);
        }
        let next = at(6);
        assert_eq!(next.label.from, first.label.from);
        assert_ne!(next.label.maps, first.label.maps);
        // After 49 variations, the first one is flipped.
        let flipped = at(6 * 49);
        assert_eq!(
            (flipped.label.flip, flipped.label.maps),
            (1, first.label.maps)
        );
    }
}

#[test]
fn directions_of_view_are_uniform() {
    let text = "{kind: dataset, categories: {systems: [{rule: koch-cube}, {rule: koch}]}, \
                instances: {count: 2000, views: random}, picture: {size: 24, points: 2k}}";
    let set = Dataset::parse(text).unwrap();
    let (mut mean, mut squares) = (DVec3::ZERO, DVec3::ZERO);
    for index in 0..2000 {
        let from = set.label(index).unwrap().from.unwrap();
        let towards = Camera::default().from(from).towards();
        mean += towards / 2000.0;
        squares += towards * towards / 2000.0;
    }
    // The variance of a coordinate is 1/3, that of its square 4/45; four standard errors.
    let [most, most_squares] = [1.0 / 3.0, 4.0 / 45.0].map(|it: f64| 4.0 * (it / 2000.0).sqrt());
    assert!(mean.abs().max_element() < most, "{mean}");
    let apart = (squares - 1.0 / 3.0).abs();
    assert!(apart.max_element() < most_squares, "{squares}");
    // A drawing on black: the set covers a part of it.
    let picture = set.example(0).unwrap().picture;
    let covered = picture.bytes().iter().filter(|byte| **byte > 0).count();
    assert!((100..500).contains(&covered), "{covered}");
    assert_eq!(set.label(2000).unwrap().from, None);
}

/// The plane in space, and space turned with the viewer, are the same picture.
#[test]
fn views_in_space_are_those_of_the_plane() {
    let mut random = Pcg::new(7, 8);
    let (size, fit) = (64, Framing::Box);
    let mut compared = 0;
    for count in 2..8 {
        let flat = weighted(anderson(&mut random, count));
        let game = Game {
            points: 100_000,
            ..Game::default()
        };
        let maps: Vec<DAffine2> = flat.iter().map(|it| it.map).collect();
        let is_found = attractor_box(&maps, &DMat2::IDENTITY).is_some();
        let expected = Attractor::of(&flat, DAffine2::IDENTITY).unwrap();
        let expected = expected.hits(size, fit, &game).unwrap();
        let camera = Camera::default().from([50.0, -20.0]);
        let turned = DAffine3::from_mat3(camera.rotation().unwrap());
        for seen in [DAffine3::IDENTITY, turned] {
            let deep = |it: &WeightedMap| {
                let matrix = DMat3::from_mat2(it.map.matrix2);
                let matrix = DMat3::from_cols(matrix.x_axis, matrix.y_axis, DVec3::Z / 2.0);
                let map = DAffine3::from_mat3_translation(matrix, it.map.translation.extend(0.3));
                WeightedMap::new(seen.inverse() * map * seen, it.weight)
            };
            let deep: Vec<_> = flat.iter().map(deep).collect();
            let maps: Vec<DAffine3> = deep.iter().map(|it| it.map).collect();
            // Boxes that points estimate are smaller than those that are found.
            if attractor_box(&maps, &seen.matrix3).is_some() != is_found {
                continue;
            }
            let game = Game {
                points: 100_000,
                ..Game::default()
            };
            let hits = Attractor::of(&deep, seen).unwrap();
            let hits = hits.hits(size, fit, &game).unwrap();
            // Means and products of the numbers of points, which are drawn apart.
            let product = |a: &[u32], b: &[u32]| {
                let pairs = a.iter().zip(b);
                pairs
                    .map(|(a, b)| f64::from(*a) * f64::from(*b))
                    .sum::<f64>()
            };
            let alike = product(&expected, &hits)
                / (product(&expected, &expected) * product(&hits, &hits)).sqrt();
            assert!(alike > 0.98, "{count}: {alike}");
            compared += 1;
        }
    }
    assert!(compared >= 6, "{compared}");
}

#[test]
fn mistakes_have_their_places() {
    let wrong = [
        (
            "{kind: rule, categories: {systems: {random: {}}}}",
            "is no data set",
        ),
        ("kind: dataset", "needs categories"),
        ("{kind: dataset, categories: {}}", "need `systems`"),
        (
            "{kind: dataset, categories: {systems: {}}}",
            "one of `random`, `rule`",
        ),
        (
            "{kind: dataset, categories: {systems: {random: {}, rule: koch}}}",
            "one of `random`, `rule`",
        ),
        (
            "{kind: dataset, categories: {systems: {random: {maps: [5, 2]}}}}",
            "above the largest",
        ),
        (
            "{kind: dataset, categories: {systems: {random: {maps: 99}}}}",
            "whole number from 1 to 32",
        ),
        (
            "{kind: dataset, categories: {systems: {random: {sigma: andersen}}}}",
            "did you mean 'anderson'",
        ),
        (
            "{kind: dataset, categories: {systems: {rule: kock}}}",
            "did you mean 'koch'",
        ),
        (
            "{kind: dataset, categories: {systems: {rule: menger}}}",
            "needs views",
        ),
        (
            "{kind: dataset, categories: {systems: {rule: pythagoras, params: {angel: 3}}}}",
            "did you mean 'angle'",
        ),
        (
            "{kind: dataset, categories: {systems: {rule: pythagoras, params: {angle: 'uniform(x, 3)'}}}}",
            "x",
        ),
        (
            "{kind: dataset, categories: {systems: {library: [ifz]}}}",
            "did you mean 'ifs'",
        ),
        (
            "{kind: dataset, categories: {systems: {library: [ifs], count: 3}}}",
            "leave `count` out",
        ),
        (
            "{kind: dataset, categories: {systems: {csv: nowhere}}}",
            "cannot be read",
        ),
        (
            "{kind: dataset, categories: {systems: {random: {}}}, instances: {weights: jitter}}",
            "no variation",
        ),
        (
            "{kind: dataset, categories: {systems: {random: {}}}, picture: {points: many}}",
            "number of points",
        ),
        (
            "{kind: dataset, categories: {systems: {random: {}}}, picture: {colour: veridis}}",
            "did you mean 'viridis'",
        ),
        (
            "{kind: dataset, categories: {systems: {random: {}}}, picture: {sise: 3}}",
            "unknown key 'sise'",
        ),
        (
            "{kind: dataset, categories: {systems: {random: {}}}, accept: {fill: 2}}",
            "a share from 0 to 1",
        ),
        (
            "{kind: dataset, categories: {systems: {random: {space: 3, sigma: uniform}}}}",
            "needs views",
        ),
        (
            "{kind: dataset, categories: {systems: {random: {space: 3}}}, instances: {views: random}}",
            "maps of the plane",
        ),
        (
            "{kind: dataset, categories: {systems: {random: {space: 4}}}}",
            "whole number from 2 to 3",
        ),
        (
            "{kind: dataset, categories: {systems: {random: {}}}, instances: {views: 0}}",
            "'0' is no choice of views",
        ),
    ];
    for (text, expected) in wrong {
        let error = Dataset::parse(text).unwrap_err();
        let DatasetError::Invalid(found) = &error else {
            panic!("{text}: {error}");
        };
        assert!(
            found.iter().all(|it| it.place().is_some()),
            "{text}: {error}"
        );
        assert!(error.to_string().contains(expected), "{text}: {error}");
    }
    let impossible =
        "{kind: dataset, categories: {systems: {random: {maps: 1}}}, accept: {fill: 0.9}}";
    let set = Dataset::parse(impossible).unwrap();
    assert!(matches!(
        set.example(7),
        Err(DatasetError::Index { index: 7, len: 1 })
    ));
    assert_eq!(Weights::default(), Weights::None);
}
