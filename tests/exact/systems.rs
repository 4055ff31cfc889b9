//! Exact dimensions of systems and of graphs of them, given by their maps.

use glam::{DAffine3, DMat3, DVec3};
use kfrac::geometry::{DAffine2, DMat2, DVec2};
use kfrac::measure::exact::{
    Dimensions, Equation, GraphDirectedSystem, Overlap, dimensions, dimensions_of_graph,
    distinct_pieces,
};
use serde::Deserialize;

use super::{common, line, near, of, similarity};

/// A system of the reference, computed independently of kfrac.
#[derive(Deserialize)]
struct Entry {
    id: String,
    /// Similarity dimension; `None` where maps are not similarities.
    similarity: Option<f64>,
    maps: Vec<Map>,
}

/// The map x → linear · x + shift, with the matrix row by row.
#[derive(Deserialize)]
struct Map {
    from: usize,
    to: usize,
    linear: Vec<f64>,
    shift: Vec<f64>,
}

impl Entry {
    fn system(&self) -> GraphDirectedSystem {
        let plane = |map: &Map| {
            let linear = DMat2::from_cols_slice(&map.linear).transpose();
            let map_2 = DAffine2::from_mat2_translation(linear, DVec2::from_slice(&map.shift));
            (map.from, map.to, map_2)
        };
        let space = |map: &Map| {
            let linear = DMat3::from_cols_slice(&map.linear).transpose();
            let map_3 = DAffine3::from_mat3_translation(linear, DVec3::from_slice(&map.shift));
            (map.from, map.to, map_3)
        };
        if self.maps[0].shift.len() == 2 {
            GraphDirectedSystem::plane(self.maps.iter().map(plane)).unwrap()
        } else {
            GraphDirectedSystem::space(self.maps.iter().map(space)).unwrap()
        }
    }
}

#[test]
fn the_reference_systems_have_their_dimensions() {
    let entries: Vec<Entry> = serde_json::from_str(include_str!("systems.json")).unwrap();
    assert_eq!(entries.len(), 39);
    // Systems whose dimension differs from the similarity dimension, or is undecided.
    let special = |id: &str| match id {
        "jones_campa_cake" => Some((10.0 + 2.0 * 13f64.sqrt()).ln() / 3f64.ln()),
        "jones_solid_tetrahedron" => Some((5.0 + 5f64.sqrt()).ln() / 2f64.ln()),
        "maple_leaf_chaos" | "jones_cloud_example" | "lh_koch_island_table" => Some(f64::NAN),
        _ => None,
    };
    for entry in &entries {
        let id = &entry.id;
        let found = dimensions(&entry.system()).unwrap();
        let Some(known) = entry.similarity else {
            let affinity = found.affinity.unwrap();
            assert!(
                affinity.estimate > 1.0 && affinity.estimate <= affinity.upper_bound,
                "{id}"
            );
            assert_eq!(found.hausdorff.value, None, "{id}");
            continue;
        };
        assert!(near(found.similarity.unwrap().value, known), "{id}");
        let own = found.hausdorff;
        match special(id) {
            Some(value) if value.is_nan() => {
                assert_eq!((own.value, own.overlap), (None, Overlap::Unknown), "{id}");
            }
            Some(value) => {
                assert!(near(own.value.unwrap(), value), "{id} {own:?}");
                assert_eq!(own.overlap, Overlap::Exact, "{id}");
            }
            None => {
                assert!(near(own.value.unwrap(), known), "{id} {own:?}");
                let apart = id.contains("cantor") || id == "jones_pentagon_as_printed";
                let overlap = if apart {
                    Overlap::None
                } else {
                    Overlap::Touching
                };
                assert_eq!(own.overlap, overlap, "{id}");
            }
        }
        let boundary = match id.as_str() {
            "demko_dragon_sz" | "heighway_dragon" => Some(1.523627086202492),
            "levy_c_ifs" => Some(1.934007182988),
            "koch_snowflake_7" => Some(4f64.ln() / 3f64.ln()),
            "jones_square_fill" => Some(1.0),
            "jones_cube_fill" => Some(2.0),
            _ => None,
        };
        assert_eq!(found.boundary.is_some(), boundary.is_some(), "{id}");
        if let (Some(found), Some(known)) = (found.boundary, boundary) {
            assert!(near(found.value.unwrap(), known), "{id} {found:?}");
        }
    }
}

/// Fractals of Jones & Campa in which cells coincide.
#[test]
fn cells_that_coincide_are_counted_once() {
    let entries: Vec<Entry> = serde_json::from_str(include_str!("systems.json")).unwrap();
    let counts = |id: &str| {
        let entry = entries.iter().find(|entry| entry.id == id).unwrap();
        distinct_pieces(&entry.system(), 3).unwrap()
    };
    assert_eq!(counts("jones_campa_cake"), [1, 32, 592, 10_304]);
    assert_eq!(counts("jones_solid_tetrahedron"), [1, 10, 80, 600]);
    assert_eq!(counts("jones_icosahedron"), [1, 12, 144, 1728]);
}

/// A system of the reference, written as a document, has the same dimensions as its list of maps.
#[test]
fn documents_in_space_have_the_dimensions_of_their_maps() {
    let entries: Vec<Entry> = serde_json::from_str(include_str!("systems.json")).unwrap();
    let entries = entries
        .iter()
        .filter(|entry| entry.maps[0].shift.len() == 3);
    let mut seen = 0;
    for entry in entries {
        seen += 1;
        let sets = entry.maps.iter().map(|map| map.from).max().unwrap() + 1;
        // In a recurrent system the map of a set is the one that all of its copies have.
        let maps = (0..sets).flat_map(|set| {
            let own = entry.maps.iter().filter(move |map| map.from == set);
            own.take(if sets == 1 { usize::MAX } else { 1 })
        });
        let mut text = "kind: ifs\nspace: 3\nmaps:\n".to_owned();
        for Map { linear, shift, .. } in maps {
            let rows: Vec<&[f64]> = linear.chunks(3).collect();
            text += &format!("  - {{matrix: {rows:?}, shift: {shift:?}}}\n");
        }
        if sets > 1 {
            text += "edges:\n";
            for to in 0..sets {
                let after = entry.maps.iter().filter(|map| map.to == to);
                let after: Vec<usize> = after.map(|map| map.from + 1).collect();
                text += &format!("  {}: {after:?}\n", to + 1);
            }
        }
        let (model, _) = common::document_of(&text).resolve(&[]).unwrap();
        let graph = model.compile_in_space(false).unwrap();
        let found = dimensions_of_graph(&graph).dimensions.unwrap();
        let own = dimensions(&entry.system()).unwrap();
        let id = &entry.id;
        let value = |of: &Dimensions| of.similarity.as_ref().map_or(0.0, |it| it.value);
        assert!(near(value(&found), value(&own)), "{id}");
        assert_eq!(found.hausdorff.overlap, own.hausdorff.overlap, "{id}");
        let values = [&found, &own].map(|of| of.hausdorff.value.unwrap_or_default());
        assert!(near(values[0], values[1]), "{id} {values:?}");
        assert_eq!(found.boundary.is_some(), own.boundary.is_some(), "{id}");
    }
    assert_eq!(seen, 12);
}

/// Returns the map of an upright square with a ratio, at a position.
fn square(ratio: f64, x: f64, y: f64) -> DAffine2 {
    similarity(ratio, 0.0, false, [x, y])
}

#[test]
fn boundaries_of_squares_of_unequal_and_of_overlapping_squares() {
    // One square of 2/3 and five of 1/3: the ratios are not powers of one number.
    let (large, small) = (2.0 / 3.0, 1.0 / 3.0);
    let unequal = of(&[
        square(large, 0.0, 0.0),
        square(small, large, 0.0),
        square(small, large, small),
        square(small, large, large),
        square(small, 0.0, large),
        square(small, small, large),
    ]);
    assert_eq!(unequal.hausdorff.value, Some(2.0));
    assert_eq!(unequal.boundary.unwrap().value, Some(1.0));
    // Nine squares of 1/2, at multiples of 1/4: pieces coincide.
    let quarters = [0.0, 0.25, 0.5];
    let all = quarters.map(|x| quarters.map(|y| square(0.5, x, y)));
    let coinciding = of(all.as_flattened());
    assert_eq!(coinciding.hausdorff.overlap, Overlap::Exact);
    assert_eq!(coinciding.hausdorff.value, Some(2.0));
    let boundary = coinciding.boundary.unwrap();
    assert_eq!(boundary.value, None);
    assert_eq!(boundary.method, "not decided: pieces coincide");
}

#[test]
fn ratios_that_are_no_powers_of_one_number() {
    let apart = of(&[line(0.5, 0.0), line(1.0 / 3.0, 2.0 / 3.0)]);
    assert_eq!(apart.hausdorff.overlap, Overlap::None);
    let d = apart.hausdorff.value.unwrap();
    assert!((0.5f64.powf(d) + 3f64.powf(-d) - 1.0).abs() < 1e-12);
    let touching = of(&[
        line(0.5, 0.0),
        line(1.0 / 3.0, 0.5),
        line(1.0 / 6.0, 5.0 / 6.0),
    ]);
    assert_eq!(touching.hausdorff.overlap, Overlap::Touching);
    assert_eq!(touching.hausdorff.value, Some(1.0));
    // A segment has no interior in the plane.
    assert_eq!(touching.boundary, None);
    let overlapping = of(&[line(0.7, 0.0), line(0.55, 0.45)]);
    assert_eq!(overlapping.hausdorff.overlap, Overlap::Unknown);
    assert!(overlapping.similarity.unwrap().value > 1.4);
    assert_eq!(overlapping.hausdorff.upper_bound, Some(1.0));
}

#[test]
fn turns_by_irrational_parts_are_decided_where_copies_are_apart_only() {
    let tree = |ratio: f64| {
        let turn = 50f64.to_radians().sqrt().to_degrees();
        of(&[
            similarity(ratio, turn, false, [0.0, 1.0]),
            similarity(ratio, -turn, false, [0.0, 1.0]),
        ])
    };
    assert_eq!(tree(0.45).hausdorff.overlap, Overlap::None);
    let full = tree(0.68);
    assert_eq!(
        (full.hausdorff.overlap, full.hausdorff.value),
        (Overlap::Unknown, None)
    );
    assert!(
        full.hausdorff.method.starts_with("not decided: more than"),
        "{:?}",
        full.hausdorff
    );
}

/// Two sets, each of four copies of the other, the second smaller by an irregular factor.
#[test]
fn ratios_are_powers_of_one_number_along_cycles() {
    let third = 1.0 / 3.0;
    let koch = [
        similarity(third, 0.0, false, [0.0, 0.0]),
        similarity(third, 60.0, false, [third, 0.0]),
        similarity(third, -60.0, false, [0.5, 0.75f64.sqrt() * third]),
        similarity(third, 0.0, false, [2.0 * third, 0.0]),
    ];
    let scale = DAffine2::from_scale(DVec2::splat(0.71));
    let copies = koch
        .iter()
        .flat_map(|map| [(0, 1, *map * scale.inverse()), (1, 0, scale * *map)]);
    let found = dimensions(&GraphDirectedSystem::plane(copies).unwrap()).unwrap();
    assert_eq!(
        found.hausdorff.overlap,
        Overlap::Touching,
        "{:?}",
        found.hausdorff
    );
    assert_eq!(
        found.hausdorff.closed_form.as_deref(),
        Some("log(4)/log(3)")
    );
    assert!(near(found.hausdorff.value.unwrap(), 4f64.ln() / 3f64.ln()));
}

/// The self-seeding square as two equal sets, each of copies of both.
#[test]
fn equal_sets_may_have_two_names() {
    let third = 1.0 / 3.0;
    let places = [[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]];
    let shift = |[x, y]: [i32; 2], by: f64| [f64::from(x) * by, f64::from(y) * by];
    let mut maps: Vec<DAffine2> = places
        .map(|place| similarity(third, 0.0, false, shift(place, third)))
        .to_vec();
    maps.extend(
        [[4, 3], [3, 4]].map(|place| similarity(third, 0.0, false, shift(place, third / 3.0))),
    );
    let one = of(&maps).hausdorff;
    assert_eq!(one.overlap, Overlap::Exact);
    let copies = maps.iter().enumerate().flat_map(|(number, map)| {
        [
            (0, number % 2, *map),
            (1, usize::from(number % 3 == 0), *map),
        ]
    });
    let two = dimensions(&GraphDirectedSystem::plane(copies).unwrap())
        .unwrap()
        .hausdorff;
    assert_eq!(two.overlap, Overlap::Exact);
    assert!(
        near(one.value.unwrap(), two.value.unwrap()),
        "{one:?} {two:?}"
    );
}

#[test]
fn what_has_no_finite_type_is_bounded() {
    // With digits 0, v and Av the words 20 and 01 are equal maps; A rotates by an irrational part of a turn.
    let turn = 2f64.sqrt() * 30.0;
    let map = |shift: DVec2| similarity(0.6, turn, false, shift.into());
    let v = DVec2::X;
    let found = of(&[
        map(DVec2::ZERO),
        map(v),
        map(map(DVec2::ZERO).transform_vector2(v)),
    ])
    .hausdorff;
    assert_eq!(
        (found.overlap, found.value),
        (Overlap::Exact, None),
        "{found:?}"
    );
    // The number of words without 20 grows by φ² in a generation.
    let golden = f64::midpoint(3.0, 5f64.sqrt()).ln() / -(0.6f64.ln());
    let bound = found.upper_bound.unwrap();
    assert!(bound >= golden && bound < golden + 0.05, "{bound} {golden}");
}

#[test]
fn a_set_of_the_line_does_not_know_its_reflection() {
    let third = 1.0 / 3.0;
    let twice = of(&[
        line(third, 0.0),
        similarity(third, 0.0, true, [0.0, 0.0]),
        line(third, 2.0 * third),
    ]);
    assert_eq!(twice.hausdorff.overlap, Overlap::Exact);
    assert!(near(twice.hausdorff.value.unwrap(), 2f64.ln() / 3f64.ln()));
}

#[test]
fn the_largest_part_decides() {
    // A carpet row of quarters, and a Cantor set that it leads to.
    let quarters = [0.0, 0.25, 0.75].map(|shift| (0, 0, line(0.25, shift)));
    let thirds = [0.0, 2.0 / 3.0].map(|shift| (1, 1, line(1.0 / 3.0, shift)));
    let bridge = [(0, 1, line(0.25, 0.5))];
    let copies = quarters.into_iter().chain(thirds).chain(bridge);
    let found = dimensions(&GraphDirectedSystem::plane(copies).unwrap()).unwrap();
    assert_eq!(
        found.hausdorff.closed_form.as_deref(),
        Some("log(3)/log(4)")
    );
    assert_eq!(found.similarity.unwrap().equation, Equation::Moran);
}

#[test]
fn affine_maps_are_bounded_by_the_affinity_dimension() {
    // Four boxes of 1/2 by 1/3: 4 · 1/2 · (1/3)^(s − 1) = 1.
    let shape = DMat2::from_diagonal(DVec2::new(0.5, 1.0 / 3.0));
    let boxes = [[0.0, 0.0], [0.5, 0.0], [0.0, 2.0 / 3.0], [0.5, 1.0 / 3.0]];
    let boxes = boxes.map(|shift| DAffine2::from_mat2_translation(shape, DVec2::from(shift)));
    let found = of(&boxes);
    let affinity = found.affinity.unwrap();
    let known = 1.0 + 2f64.ln() / 3f64.ln();
    assert!(
        near(affinity.upper_bound, known) && near(affinity.estimate, known),
        "{affinity:?}"
    );
    // Both columns have two boxes: the dimensions of the carpet agree.
    let carpet = [found.hausdorff.value, found.box_dimension.unwrap().value];
    assert!(
        carpet.into_iter().all(|it| near(it.unwrap(), known)),
        "{carpet:?}"
    );
    // Boxes that overlap are bounded.
    let mut moved = boxes;
    moved[3].translation.x = 0.25;
    let found = of(&moved);
    let affinity = found.affinity.unwrap();
    assert_eq!(found.hausdorff.upper_bound, Some(affinity.upper_bound));
    assert_eq!(
        [found.hausdorff.value, found.similarity.map(|it| it.value)],
        [None; 2]
    );
    assert_eq!(found.box_dimension, None);
    // Maps that shrink areas but stretch in one direction.
    let sheared = DAffine2::from_mat2(DMat2::from_diagonal(DVec2::new(2.0, 0.25)));
    let turned = DAffine2::from_mat2(DMat2::from_diagonal(DVec2::new(0.25, 2.0)));
    let copies = [(0, 0, sheared), (0, 0, turned)];
    assert_eq!(
        dimensions(&GraphDirectedSystem::plane(copies).unwrap()),
        None
    );
}

#[test]
fn dimensions_are_at_most_those_of_affine_hulls() {
    // On a line: ratios that are no powers of one number, and turns by 180 degrees.
    let along = |ratio: f64, shift: f64| {
        let (sin, cos) = 0.5f64.sin_cos();
        similarity(ratio, 0.0, false, [shift * cos, shift * sin])
    };
    let bound = |maps: &[DAffine2]| {
        let found = of(maps);
        assert_eq!(found.hausdorff.value, None, "{found:?}");
        assert!(found.similarity.is_none_or(|it| it.value > 1.3));
        found.hausdorff.upper_bound
    };
    let on_line = [along(0.6, 0.0), along(0.55, 0.45), along(-0.37, 0.68)];
    assert_eq!(bound(&on_line), Some(1.0));
    let off = [
        on_line[0],
        on_line[1],
        similarity(0.37, 0.0, false, [0.0, 0.3]),
    ];
    assert!(bound(&off).unwrap() > 1.6);
    // Maps that are no similarities, of a set on the x axis.
    let flat = |x: f64, y: f64, shift: f64| {
        let shape = DMat2::from_diagonal(DVec2::new(x, y));
        DAffine2::from_mat2_translation(shape, DVec2::new(shift, 0.0))
    };
    let on_axis = [flat(0.7, 0.2, 0.0), flat(0.6, 0.3, 0.4)];
    assert!(of(&on_axis).affinity.unwrap().upper_bound > 1.0);
    assert_eq!(bound(&on_axis), Some(1.0));
    // A set in a plane of space.
    let copies = [[0.0, 0.0, 0.0], [0.3, 0.3, 0.0], [0.3, 0.0, 0.3]].map(|shift| {
        let axis = DVec3::new(-1.0, 1.0, 1.0).normalize();
        let turn = DMat3::from_axis_angle(axis, 1.0);
        (
            0,
            0,
            DAffine3::from_mat3_translation(0.75 * turn, DVec3::from(shift)),
        )
    });
    let found = dimensions(&GraphDirectedSystem::space(copies).unwrap()).unwrap();
    assert!(found.similarity.unwrap().value > 3.0);
    assert_eq!(found.hausdorff.upper_bound, Some(2.0));
}

#[test]
fn bad_numbers_are_refused() {
    assert!(GraphDirectedSystem::plane([(0, 0, line(f64::NAN, 0.0))]).is_none());
    assert_eq!(
        dimensions(&GraphDirectedSystem::plane([(0, 0, line(1.0, 0.5))]).unwrap()),
        None
    );
    assert_eq!(dimensions(&GraphDirectedSystem::plane([]).unwrap()), None);
    // A map onto a point is not a similarity.
    let point = of(&[line(0.0, 0.0)]);
    assert_eq!(
        (point.similarity, point.hausdorff.upper_bound),
        (None, Some(0.0))
    );
}
