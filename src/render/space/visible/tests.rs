//! Tests of the order of polygons and of visible edges, against the nearest polygon at random points.

use super::arrange::{Piece, arranged};
use super::lines::Hiding;
use super::polygon::{Corner, Polygon};
use crate::geometry::{Bounds, DVec2, DVec3};
use crate::random::Pcg;

const TOLERANCE: f64 = 1e-7;

fn polygon(corners: &[[f64; 3]]) -> Polygon {
    let corners = corners.iter().map(|corner| Corner {
        at: DVec3::from_array(*corner),
        is_edge: true,
    });
    Polygon::new(corners.collect()).unwrap()
}

/// Returns random triangles, most of which cross others.
fn triangles(random: &mut Pcg, number: usize) -> Vec<Polygon> {
    let mut all = Vec::new();
    while all.len() < number {
        let middle = DVec3::new(random.unit(), random.unit(), random.unit()) * 100.0;
        let mut corner = || {
            let away = DVec3::new(random.unit(), random.unit(), random.unit()) - 0.5;
            Corner {
                at: middle + away * 60.0,
                is_edge: true,
            }
        };
        all.extend(Polygon::new(vec![corner(), corner(), corner()]));
    }
    all
}

/// Three bars, each of which lies before the next one at one end.
fn circle() -> Vec<Polygon> {
    let bar = |angle: f64| {
        let (sine, cosine) = angle.to_radians().sin_cos();
        let at = |along: f64, across: f64, nearness: f64| {
            let point = DVec2::new(along, across - 20.0);
            let turned = DVec2::new(
                cosine * point.x - sine * point.y,
                sine * point.x + cosine * point.y,
            );
            (turned + 50.0).extend(nearness).to_array()
        };
        polygon(&[
            at(-50.0, -5.0, -1.0),
            at(50.0, -5.0, 1.0),
            at(50.0, 5.0, 1.0),
            at(-50.0, 5.0, -1.0),
        ])
    };
    [0.0, 120.0, 240.0].map(bar).into()
}

/// Checks that the last of the arranged polygons at a point is the nearest of the given ones.
fn check_order(polygons: &[Polygon], random: &mut Pcg) -> usize {
    let pieces = polygons.iter().enumerate().map(|(face, polygon)| Piece {
        polygon: polygon.clone(),
        face,
    });
    let pieces = arranged(pieces.collect(), TOLERANCE);
    let mut covered = 0;
    for _ in 0..3000 {
        let at = DVec2::new(random.unit(), random.unit()) * 140.0 - 20.0;
        // Near an outline, rounding decides.
        let is_clear = |polygon: &Polygon| {
            polygon.edges().all(|([from, to], _)| {
                let edge = (to - from).truncate();
                let away = edge.perp_dot(at - from.truncate()) / edge.length();
                away.abs() > 0.05
            })
        };
        if !pieces.iter().all(|piece| is_clear(&piece.polygon)) {
            continue;
        }
        let there = |polygon: &&Polygon| polygon.contains(at);
        let nearness = |polygon: &Polygon| polygon.plane().at(at);
        let nearest = polygons.iter().filter(there).map(nearness).reduce(f64::max);
        let mut drawn = pieces.iter().rev().map(|piece| &piece.polygon);
        let drawn = drawn.find(there).map(nearness);
        match (nearest, drawn) {
            (None, None) => {}
            (Some(nearest), Some(drawn)) => {
                covered += 1;
                assert!(
                    (nearest - drawn).abs() < 1e-6,
                    "{at}: {drawn}, not {nearest}"
                );
            }
            other => panic!("{at}: {other:?}"),
        }
    }
    assert!(covered > 300, "{covered}");
    pieces.len()
}

#[test]
fn nothing_is_hidden_by_what_lies_behind_it() {
    let mut random = Pcg::new(7, 1);
    for number in [40, 150] {
        let triangles = triangles(&mut random, number);
        assert!(check_order(&triangles, &mut random) > number);
    }
}

#[test]
fn bars_in_a_circle_are_divided() {
    let bars = circle();
    assert!(check_order(&bars, &mut Pcg::new(3, 1)) > 3);
}

#[test]
fn polygons_that_need_no_division_stay_whole() {
    // A staircase: each step lies before the one above, and touches it.
    let steps = (0..20u32).flat_map(|step| {
        let (y, near) = (f64::from(step) * 5.0, -f64::from(step));
        let riser = polygon(&[
            [0.0, y, near],
            [100.0, y, near],
            [100.0, y + 4.0, near],
            [0.0, y + 4.0, near],
        ]);
        let tread = polygon(&[
            [0.0, y + 4.0, near],
            [100.0, y + 4.0, near],
            [100.0, y + 5.0, near - 1.0],
            [0.0, y + 5.0, near - 1.0],
        ]);
        [riser, tread]
    });
    let steps: Vec<Polygon> = steps.collect();
    assert_eq!(check_order(&steps, &mut Pcg::new(5, 1)), steps.len());
}

/// Checks that points of a line are drawn that no face hides but that to which the line belongs, and counts the hidden and
/// the drawn ones.
fn check_line(
    faces: &[Polygon],
    own: Option<usize>,
    [from, to]: [DVec3; 2],
    drawn: &[[DVec2; 2]],
    random: &mut Pcg,
    seen: &mut [u32; 2],
) {
    for _ in 0..20 {
        let point = from.lerp(to, random.unit());
        let at = point.truncate();
        let is_clear = |other: &Polygon| {
            let outline = other.edges().all(|([from, to], _)| {
                let edge = (to - from).truncate();
                (edge.perp_dot(at - from.truncate()) / edge.length()).abs() > 0.1
            });
            outline && (other.plane().at(at) - point.z).abs() > 0.5
        };
        let others = faces.iter().enumerate();
        let mut others = others
            .filter(|(other, _)| Some(*other) != own)
            .map(|(_, other)| other)
            .filter(|it| it.bounds().meets(&Bounds::new(at, at)));
        if !others.clone().all(is_clear) {
            continue;
        }
        let is_hidden = others.any(|it| it.contains(at) && it.plane().at(at) > point.z);
        let is_drawn = drawn.iter().any(|[a, b]| {
            let along = (b - a).normalize();
            let away = at - a;
            away.perp_dot(along).abs() < 1e-6 && (0.0..=a.distance(*b)).contains(&away.dot(along))
        });
        seen[usize::from(is_drawn)] += 1;
        assert_eq!(is_drawn, !is_hidden, "{own:?} at {at}");
    }
}

#[test]
fn edges_end_where_faces_lie_before_them() {
    let mut random = Pcg::new(11, 1);
    let faces = triangles(&mut random, 60);
    let mut drawn: Vec<Vec<[DVec2; 2]>> = vec![Vec::new(); faces.len()];
    let outcome: Result<(), ()> = Hiding::of(faces.iter().collect(), TOLERANCE).edges(
        |_, _| true,
        |face, line| {
            drawn[face].push(line);
            Ok(())
        },
    );
    outcome.unwrap();
    let mut seen = [0, 0];
    for (number, face) in faces.iter().enumerate() {
        for (edge, _) in face.edges() {
            let drawn = &drawn[number];
            check_line(&faces, Some(number), edge, drawn, &mut random, &mut seen);
        }
    }
    assert!(seen.iter().all(|seen| *seen > 300), "{seen:?}");
}

#[test]
fn lines_end_where_faces_lie_before_them() {
    let mut random = Pcg::new(12, 1);
    let faces = triangles(&mut random, 60);
    let mut hiding = Hiding::of(faces.iter().collect(), TOLERANCE);
    let mut seen = [0, 0];
    for _ in 0..200 {
        let mut end = || DVec3::new(random.unit(), random.unit(), random.unit()) * 100.0;
        let ends = [end(), end()];
        let mut drawn = Vec::new();
        let outcome: Result<(), ()> = hiding.line(ends, |line| {
            drawn.push(line);
            Ok(())
        });
        outcome.unwrap();
        check_line(&faces, None, ends, &drawn, &mut random, &mut seen);
    }
    assert!(seen.iter().all(|seen| *seen > 300), "{seen:?}");
}

#[test]
fn faces_in_one_plane_have_no_edge_between_them() {
    let square = |x: f64| {
        polygon(&[
            [x, 0.0, 0.3 * x],
            [x + 10.0, 0.0, 0.3 * (x + 10.0)],
            [x + 10.0, 10.0, 0.3 * (x + 10.0)],
            [x, 10.0, 0.3 * x],
        ])
    };
    let faces = [square(0.0), square(10.0), square(30.0)];
    let lines = |is_alike: bool| {
        let mut lengths = [0.0; 3];
        let outcome: Result<(), ()> = Hiding::of(faces.iter().collect(), TOLERANCE).edges(
            |_, _| is_alike,
            |face, [a, b]| {
                lengths[face] += a.distance(b);
                Ok(())
            },
        );
        outcome.unwrap();
        lengths.map(|length: f64| (length * 1e3).round() / 1e3)
    };
    assert_eq!(lines(true), [30.0, 30.0, 40.0]);
    assert_eq!(lines(false), [40.0, 40.0, 40.0]);
}
