//! Bounds of systems that contract little, or by their products only, against other methods.

use kfrac::catalogue::Catalogue;
use kfrac::diagnostic::Source;
use kfrac::document::Document;
use kfrac::geometry::{Bounds, DAffine2, DMat2, DVec2, DVec3};
use kfrac::graph::Graph;
use kfrac::ifs::{Definition, Ifs, Map};

use super::system;

/// A generator of pseudorandom numbers from −1 to 1, by a linear congruence.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(0x5851_f42d_4c95_7f2d) ^ 0x1405_7b7e_f767_814f;
        let bits = u32::try_from(self.0 >> 33).unwrap();
        f64::from(bits) / f64::from(1u32 << 30) - 1.0
    }
}

fn written(maps: &[DAffine2]) -> String {
    let lines = maps.iter().map(|map| {
        let ([a, b, c, d], [x, y]) = (map.matrix2.to_cols_array(), map.translation.to_array());
        format!("  - {{matrix: [[{a:?}, {c:?}], [{b:?}, {d:?}]], shift: [{x:?}, {y:?}]}}\n")
    });
    format!("maps:\n{}", lines.collect::<String>())
}

/// Returns the reach of the limit set along a direction, from below: a beam search follows the maps that lead
/// farthest, and ends at known points of the limit set.
fn reached(maps: &[DAffine2], points: &[DVec2], direction: DVec2) -> f64 {
    const FOLLOWED: usize = 400;
    let far = |vector: DVec2, offset: f64| {
        let along = points.iter().map(|point| vector.dot(*point));
        offset + along.fold(f64::NEG_INFINITY, f64::max)
    };
    let mut beam = vec![(far(direction, 0.0), direction, 0.0)];
    while beam.iter().any(|(_, vector, _)| vector.length() > 1e-13) {
        let mut next = Vec::new();
        for (_, vector, offset) in beam {
            next.extend(maps.iter().map(|map| {
                let offset = offset + vector.dot(map.translation);
                let vector = map.matrix2.transpose() * vector;
                (far(vector, offset), vector, offset)
            }));
        }
        next.sort_by(|a, b| b.0.total_cmp(&a.0));
        next.truncate(FOLLOWED);
        beam = next;
    }
    beam[0].0
}

/// Returns the points of a random orbit that are farthest along several directions.
fn orbit(maps: &[DAffine2], numbers: &mut impl FnMut() -> f64) -> Vec<DVec2> {
    let directions = (0..24).map(|turn| DVec2::from_angle(f64::from(turn) * 0.2618));
    let directions: Vec<DVec2> = directions.collect();
    let mut point = fixed_point(maps[0]);
    let mut farthest = vec![point; directions.len()];
    for _ in 0..100_000 {
        let choice = numbers();
        let map = usize::from(choice > -0.33) + usize::from(choice > 0.33);
        point = maps[map].transform_point2(point);
        for (direction, far) in directions.iter().zip(&mut farthest) {
            if direction.dot(point) > direction.dot(*far) {
                *far = point;
            }
        }
    }
    farthest
}

fn fixed_point(map: DAffine2) -> DVec2 {
    (DMat2::IDENTITY - map.matrix2).inverse() * map.translation
}

fn box_of(maps: &[DAffine2]) -> [DVec2; 2] {
    let bounds = Graph::of_system(&system(&written(maps))).limit_bounds();
    let bounds = bounds.unwrap_or_else(|| panic!("{maps:?}"));
    [bounds.min(), bounds.max()]
}

fn assert_near(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance * (1.0 + b.abs()), "{a} and {b}");
}

/// For the maps x → A x ± t, points of the limit set are Σ ± Aᵏ t, and their reach is a series.
#[test]
fn boxes_of_pairs_are_sums_of_series() {
    for radius in [0.5, 0.9, 0.97, 0.99, 0.995] {
        for (angle, skew) in [(0.0, 0.0), (1.0f64, 0.0), (2.3, 3.0), (0.7, -20.0)] {
            let turn = radius * DMat2::from_angle(angle);
            let there = DMat2::from_cols(DVec2::X, DVec2::new(skew, 1.0));
            let linear = there * turn * there.inverse();
            let shift = DVec2::new(0.3, 0.7);
            let pair = [shift, -shift].map(|it| DAffine2::from_mat2_translation(linear, it));
            let (mut term, mut reach) = (shift, DVec2::ZERO);
            for _ in 0..10_000 {
                reach += term.abs();
                term = linear * term;
            }
            let [min, max] = box_of(&pair);
            for axis in [0, 1] {
                assert_near(max[axis], reach[axis], 1e-11);
                assert_near(min[axis], -reach[axis], 1e-11);
            }
        }
    }
}

/// Maps whose own norms are above 1, scaled to a spectral radius by its lower bound.
#[test]
fn boxes_hold_what_products_contract() {
    let mut numbers = Numbers(7);
    let mut next = || numbers.next();
    for radius in [0.5, 0.8, 0.9, 0.95, 0.98] {
        for _ in 0..2 {
            let mut maps: Vec<DAffine2> = (0..3)
                .map(|_| {
                    let linear = DMat2::from_cols_array(&[next(), 6.0 * next(), next(), next()]);
                    DAffine2::from_mat2_translation(linear, DVec2::new(next(), next()))
                })
                .collect();
            let own = Ifs::new(Definition {
                maps: maps
                    .iter()
                    .map(|map| scaled(*map, 0.01))
                    .map(Map::new)
                    .collect(),
                ..Definition::default()
            });
            let lower = 100.0 * own.unwrap().contraction().lower;
            for map in &mut maps {
                *map = scaled(*map, radius / lower);
            }
            let [min, max] = box_of(&maps);
            let points = orbit(&maps, &mut next);
            let slack = 1e-9 * (max - min);
            for point in &points {
                assert!((*point + slack).cmpge(min).all() && (*point - slack).cmple(max).all());
            }
            for (direction, reach) in [
                (DVec2::X, max.x),
                (DVec2::NEG_X, -min.x),
                (DVec2::Y, max.y),
                (DVec2::NEG_Y, -min.y),
            ] {
                assert_near(reached(&maps, &points, direction), reach, 1e-9);
            }
        }
    }
}

fn scaled(map: DAffine2, factor: f64) -> DAffine2 {
    DAffine2::from_mat2_translation(factor * map.matrix2, map.translation)
}

/// Maps of space that act on z apart from x and y, whose boxes are those of the plane.
#[test]
fn boxes_in_space_are_those_of_the_plane_beside_the_depth() {
    let plane = "maps:
  - {matrix: [[0, 1.5], [0.2, 0]], shift: [0, 0.3]}
  - {matrix: [[0.3, 0.9], [0, 0.4]], shift: [1, -1]}
";
    let space = "space: 3
maps:
  - {matrix: [[0, 1.5, 0], [0.2, 0, 0], [0, 0, 0.5]], shift: [0, 0.3, 1]}
  - {matrix: [[0.3, 0.9, 0], [0, 0.4, 0], [0, 0, 0.5]], shift: [1, -1, 0]}
";
    let flat = Graph::of_system(&*system(plane)).limit_bounds().unwrap();
    let solid = box_in_space(space);
    for (found, flat, depth) in [
        (solid.min(), flat.min(), 0.0),
        (solid.max(), flat.max(), 2.0),
    ] {
        assert_near(found.x, flat.x, 1e-9);
        assert_near(found.y, flat.y, 1e-9);
        assert_near(found.z, depth, 1e-9);
    }
}

/// Fractint's fern in space: all of it that its longest map has not moved lies in one plane, which bounds it.
#[test]
fn ties_along_a_plane_do_not_multiply() {
    let fern = "space: 3
maps:
  - {matrix: [[0, 0, 0], [0, 0.18, 0], [0, 0, 0]]}
  - {matrix: [[0.85, 0, 0], [0, 0.85, 0.1], [0, -0.1, 0.85]], shift: [0, 1.6, 0]}
  - {matrix: [[0.2, -0.2, 0], [0.2, 0.2, 0], [0, 0, 0.3]], shift: [0, 0.8, 0]}
  - {matrix: [[-0.2, 0.2, 0], [0.2, 0.2, 0], [0, 0, 0.3]], shift: [0, 0.8, 0]}
";
    let found = box_in_space(fern);
    assert_near(found.max().z, 0.0, 1e-12);
    assert_near(found.min().y, 0.0, 1e-12);
    assert_near(found.max().x, -found.min().x, 1e-11);
}

fn box_in_space(text: &str) -> Bounds<DVec3> {
    let source = Source::new("test.yaml", format!("kind: ifs\n{text}"));
    let document = Document::read(&source, &Catalogue::embedded()).unwrap();
    let (model, doubts) = document.resolve(&[]).unwrap();
    assert!(doubts.is_empty(), "{doubts}");
    model
        .compile_in_space(false)
        .unwrap()
        .limit_bounds()
        .unwrap()
}
