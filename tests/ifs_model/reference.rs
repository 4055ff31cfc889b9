//! Maps in the notations of papers, and their fixed points in the reference.

use kfrac::geometry::{DAffine2, DMat2, DVec2};
use kfrac::ifs::{Map, about, axes, complex, complex_conjugate, toward};

use super::{assert_near, map, system};

#[track_caller]
fn assert_fixed(maps: Vec<Map>, expected: &[[f64; 2]]) {
    let system = system(maps);
    let points = system.fixed_points();
    assert_eq!(points.len(), expected.len());
    for ((point, &expected), map) in points.into_iter().zip(expected).zip(system.maps()) {
        let point = point.unwrap();
        assert_near(point, expected.into(), 1e-12 * point.length().max(1.0));
        assert_near(
            map.affine.transform_point2(point),
            point,
            1e-13 * point.length().max(1.0),
        );
    }
}

#[test]
fn matrices_and_shifts() {
    let fern = vec![
        map(0.0, 0.0, 0.0, 0.16, [0.0, 0.0]),
        map(0.85, 0.04, -0.04, 0.85, [0.0, 1.6]),
        map(0.2, -0.26, 0.23, 0.22, [0.0, 1.6]),
        map(-0.15, 0.28, 0.26, 0.24, [0.0, 0.44]),
    ];
    let expected = [
        [0.0, 0.0],
        [2.6556016597510372, 9.95850622406639],
        [-0.6083650190114068, 1.8718923661889442],
        [0.15376934598102848, 0.6315526709935098],
    ];
    assert_fixed(fern, &expected);
    let leaf = vec![
        map(0.14, 0.01, 0.0, 0.51, [-0.08, -1.31]),
        map(0.43, 0.52, -0.45, 0.5, [1.49, -0.75]),
        map(0.45, -0.49, 0.47, 0.47, [-1.62, -0.74]),
        map(0.49, 0.0, 0.0, 0.51, [0.02, 1.62]),
    ];
    let expected = [
        [-0.12411010915994306, -2.673469387755102],
        [0.6840077071290941, -2.115606936416185],
        [-0.9505557684936761, -2.239172096588731],
        [0.0392156862745098, 3.306122448979592],
    ];
    assert_fixed(leaf, &expected);
}

/// The tree of Libeskind-Hadas & Maragos: r_x, r_y and theta, in radians as in their table.
#[test]
fn scaled_and_turned_axes() {
    let table = [
        (0.7, 0.85, -0.1f64, [0.0, 50.0]),
        (0.3, 0.4, -0.7, [5.0, 20.0]),
        (0.25, 0.4, 0.6, [-5.0, 30.0]),
    ];
    let maps = table.map(|(x, y, angle, shift)| {
        let linear = axes(DVec2::new(x, y), DVec2::splat(angle.to_degrees()));
        DAffine2::from_mat2_translation(linear, shift.into())
    });
    let expected = [
        [
            0.6965029156946181,
            -0.06988339165277971,
            0.08485840414980393,
            0.8457535404863219,
        ],
        [
            0.22945265618534655,
            -0.1932653061713073,
            0.2576870748950764,
            0.3059368749137954,
        ],
        [
            0.20633390372741958,
            0.14116061834875884,
            -0.22585698935801415,
            0.33013424596387136,
        ],
    ];
    for (map, expected) in maps.iter().zip(&expected) {
        super::assert_near_matrix(map.matrix2, DMat2::from_cols_array(expected), 1e-15);
    }
    let expected = [
        [80.44435205275157, 287.71017486665966],
        [14.751800698244207, 24.708110979596817],
        [-17.96710948169914, 40.998889031342046],
    ];
    assert_fixed(maps.map(Map::new).to_vec(), &expected);
}

/// Each axis rotates counter-clockwise by its own angle (Demko, Hodges & Naylor, section 4.3).
#[test]
fn axes_turn_apart() {
    let linear = axes(DVec2::new(2.0, 3.0), DVec2::new(90.0, 0.0));
    assert_eq!(linear, DMat2::from_cols_array(&[0.0, 2.0, 0.0, 3.0]));
    let linear = axes(DVec2::new(2.0, 3.0), DVec2::new(0.0, 90.0));
    assert_eq!(linear, DMat2::from_cols_array(&[2.0, 0.0, -3.0, 0.0]));
    let map = about(linear, DVec2::new(5.0, -7.0));
    assert_eq!(
        map.transform_point2(DVec2::new(5.0, -7.0)),
        DVec2::new(5.0, -7.0)
    );
    assert_eq!(
        map.transform_point2(DVec2::new(6.0, -6.0)),
        DVec2::new(4.0, -7.0)
    );
}

#[test]
fn complex_numbers() {
    let s = DVec2::new(0.5, 0.5);
    let twindragon = vec![
        Map::new(complex(s, DVec2::X)),
        Map::new(complex(s, -DVec2::X)),
    ];
    assert_fixed(twindragon, &[[1.0, 1.0], [-1.0, -1.0]]);
    // z → sz and z → 1 − conj(s) z.
    let heighway = vec![
        Map::new(complex(s, DVec2::ZERO)),
        Map::new(complex(DVec2::new(-0.5, 0.5), DVec2::X)),
    ];
    assert_fixed(heighway, &[[0.0, 0.0], [0.6, 0.2]]);
    let z = DVec2::new(3.0, 2.0);
    let (s, t) = (DVec2::new(1.0, 4.0), DVec2::new(10.0, 20.0));
    // (1 + 4i)(3 − 2i) + 10 + 20i
    assert_eq!(
        complex_conjugate(s, t).transform_point2(z),
        DVec2::new(21.0, 30.0)
    );
    assert_eq!(complex(s, t).transform_point2(z), DVec2::new(5.0, 34.0));
}

#[test]
fn vertices_and_a_shrink_factor() {
    let vertices = [
        [0.0, 1.0],
        [-0.9510565162951535, 0.3090169943749475],
        [-0.5877852522924732, -0.8090169943749473],
        [0.5877852522924729, -0.8090169943749476],
        [0.9510565162951536, 0.3090169943749472],
    ];
    let factor = 0.38196601125010515;
    let maps = vertices.map(|vertex| Map::new(toward(vertex.into(), factor)));
    assert_eq!(
        maps[0].affine.transform_point2(DVec2::ZERO),
        DVec2::new(0.0, 1.0 - factor)
    );
    assert_fixed(maps.to_vec(), &vertices);
}

#[test]
fn there_may_be_no_fixed_point_or_many() {
    let maps = vec![
        map(1.0, 0.0, 0.0, 1.0, [1.0, 0.0]),
        map(1.0, 0.0, 0.0, 0.5, [0.0, 0.0]),
        map(0.6, 0.4, 0.3, 0.7, [0.0, 0.0]),
        map(1.0, 1e-8, 0.0, 1.0 - 1e-8, [0.0, 1e-8]),
    ];
    let points = system(maps).fixed_points();
    assert_eq!(points[..3], [None; 3]);
    assert_eq!(points[3], None);
}

/// Demko, Hodges & Naylor, section 3.2: from 2 by the maps f, f, g, f.
#[test]
fn maps_are_applied_in_the_order_of_the_word() {
    let cantor = system(vec![
        map(1.0 / 3.0, 0.0, 0.0, 1.0 / 3.0, [0.0, 0.0]),
        map(1.0 / 3.0, 0.0, 0.0, 1.0 / 3.0, [2.0 / 3.0, 0.0]),
    ]);
    let word = [0, 0, 1, 0];
    let expected = [2.0 / 3.0, 2.0 / 9.0, 20.0 / 27.0, 20.0 / 81.0];
    for (length, expected) in (1..).zip(expected) {
        let image = cantor
            .composition(&word[..length])
            .transform_point2(2.0 * DVec2::X);
        assert_near(image, expected * DVec2::X, 1e-15);
    }
}
