//! Moments of shapes, against closed forms.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use kfrac::geometry::{DMat2, DVec2, Outline};
use kfrac::ifs::Shape;
use kfrac::rule::{BaseElement, arc};

use super::{assert_near, assert_near_matrix};

#[track_caller]
fn assert_moments(shape: &Shape, mean: [f64; 2], [xx, xy, yy]: [f64; 3], tolerance: f64) {
    let moments = shape.moments().unwrap();
    assert_near(moments.mean, mean.into(), tolerance);
    let covariance = DMat2::from_cols_array(&[xx, xy, xy, yy]);
    assert_near_matrix(moments.covariance, covariance, tolerance);
}

fn points(list: &[[f64; 2]]) -> Vec<DVec2> {
    list.iter().copied().map(DVec2::from).collect()
}

#[test]
fn lines_are_measured_by_length() {
    let stem = Shape::polyline(&points(&[[0.0, 0.0], [0.0, 1.6]])).unwrap();
    assert_moments(&stem, [0.0, 0.8], [0.0, 0.0, 1.6 * 1.6 / 12.0], 1e-15);
    // Legs of 1 and 3: the longer has three quarters of the points.
    let angle = Shape::polyline(&points(&[[1.0, 0.0], [0.0, 0.0], [0.0, 3.0]])).unwrap();
    let (mx, my) = (0.125, 1.125);
    let covariance = [1.0 / 12.0 - mx * mx, -mx * my, 2.25 - my * my];
    assert_moments(&angle, [mx, my], covariance, 1e-15);
    let pieces = arc(2.0 * DVec2::X, 2.0 * DVec2::Y, -2.0 * DVec2::X).unwrap();
    let half = Shape::Outline(BaseElement::new(2.0 * DVec2::X, pieces, false).unwrap());
    let height = 4.0 / PI;
    assert_moments(
        &half,
        [0.0, height],
        [2.0, 0.0, 2.0 - height * height],
        2e-7,
    );
}

#[test]
fn closed_outlines_are_measured_by_area() {
    for (x, y) in [(0.0, 0.0), (1e7, -1e7)] {
        let corners = [[x, y], [x + 3.0, y], [x + 3.0, y + 2.0], [x, y + 2.0]];
        let square = Shape::polygon(&points(&corners)).unwrap();
        assert_moments(
            &square,
            [x + 1.5, y + 1.0],
            [0.75, 0.0, 1.0 / 3.0],
            1e-13 + 1e-16 * x,
        );
    }
    // The orientation may be clockwise; a triangle's covariance is that of its sides' mid-points.
    let triangle = Shape::polygon(&points(&[[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]])).unwrap();
    let third = 1.0 / 3.0;
    assert_moments(
        &triangle,
        [third, third],
        [1.0 / 18.0, -1.0 / 36.0, 1.0 / 18.0],
        1e-15,
    );
}

#[test]
fn ellipses_have_half_axes_and_an_angle() {
    let disk = Shape::ellipse(DVec2::new(0.0, -3.0), DVec2::splat(20.0), 0.0).unwrap();
    assert_moments(&disk, [0.0, -3.0], [100.0, 0.0, 100.0], 1e-5);
    // A quarter of the half axes' squares, rotated by 45°.
    let ellipse = Shape::ellipse(DVec2::ONE, DVec2::new(6.0, 2.0), 45.0).unwrap();
    assert_moments(&ellipse, [1.0, 1.0], [5.0, 4.0, 5.0], 1e-6);
    let Shape::Outline(outline) = &ellipse else {
        panic!("{ellipse:?}");
    };
    let reach = outline.support(DVec2::splat(FRAC_1_SQRT_2));
    assert!((reach - (6.0 + 2f64.sqrt())).abs() < 6e-7);
    assert!((outline.signed_area() - 12.0 * PI).abs() < 1e-13);
    assert_eq!(Shape::ellipse(DVec2::ZERO, DVec2::X, 0.0), None);
}

/// Arcs and their chords enclose segments of circles.
#[test]
fn arcs_have_the_areas_of_their_segments() {
    for degrees in [0.01, 0.5, 1.5, 20.0, 90.0, 181.0, 300.0, 359.0] {
        for way in [1.0, -1.0] {
            let angle = f64::to_radians(degrees);
            let at = |share: f64| DVec2::from_angle(way * angle * share);
            let pieces = arc(at(0.0), at(0.5), at(1.0)).unwrap();
            let segment = BaseElement::new(at(0.0), pieces, false).unwrap();
            let area = way * (angle - angle.sin()) / 2.0;
            assert!((segment.signed_area() - area).abs() < 2e-15, "{degrees}");
        }
    }
}

#[test]
fn flat_polygons_have_no_moments() {
    let flat = Shape::polygon(&points(&[[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]])).unwrap();
    assert_eq!(flat.moments(), None);
    assert_eq!(Shape::Point(DVec2::new(f64::NAN, 0.0)).moments(), None);
    assert_eq!(Shape::polyline(&points(&[[1.0, 2.0]])), None);
}
