//! Pictures of known sets, rotated, moved and drawn with pens: their dimensions lie within their errors.

use kfrac::measure::{Bits, BoxCounting, Estimate, Generalised};

use super::{grids, number, picture};

/// Returns the pixels of a square picture that points fall into, with `pen` pixels to the right and down.
fn marked(side: usize, pen: usize, points: impl Iterator<Item = [f64; 2]>) -> Bits {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "points lie in the picture"
    )]
    let pixel = |at: f64| at as usize;
    let mut bits = Bits::new(side, side);
    for [x, y] in points {
        for across in 0..pen {
            for down in 0..pen {
                bits.set(pixel(x) + across, pixel(y) + down);
            }
        }
    }
    bits
}

/// Returns a similarity: a factor, a rotation in degrees, and a translation.
fn placed(scale: f64, degrees: f64, [left, top]: [f64; 2]) -> impl Fn([f64; 2]) -> [f64; 2] {
    let (sin, cos) = degrees.to_radians().sin_cos();
    move |[x, y]| {
        [
            left + scale * (cos * x - sin * y),
            top + scale * (sin * x + cos * y),
        ]
    }
}

/// Iterates over points of the segment from 0 to 1.
fn segment() -> impl Iterator<Item = [f64; 2]> {
    (0..=8000).map(|number| [f64::from(number) / 8000.0, 0.0])
}

/// Returns the corners of a Koch curve after a number of steps, on the segment from 0 to 1.
fn koch(steps: u32) -> Vec<[f64; 2]> {
    let turns = [0.0, 60.0, -60.0, 0.0];
    let (mut at, scale) = ([0.0; 2], 3f64.powi(-steps.cast_signed()));
    let mut points = vec![at];
    for number in 0..4u32.pow(steps) {
        let digits = (0..steps).map(|step| (number >> (2 * step)) & 3);
        let turn: f64 = digits.map(|digit| turns[digit as usize]).sum();
        at = placed(scale, turn, at)([1.0, 0.0]);
        points.push(at);
    }
    points
}

fn measured(pixels: &Bits) -> BoxCounting {
    BoxCounting::of_pixels(pixels, None, &grids(), number(2))
}

fn assert_covers(pixels: &Bits, dimension: f64, tolerance: f64) -> Estimate {
    let estimate = measured(pixels).estimate.unwrap();
    let off = (estimate.value - dimension).abs();
    assert!(off <= 2.0 * estimate.std_error, "{estimate:?}");
    assert!(off <= tolerance, "{estimate:?}");
    estimate
}

#[test]
fn a_turned_line_has_dimension_1() {
    for (degrees, pen) in [(31.0, 1), (31.0, 3), (12.0, 2)] {
        let place = placed(1800.0, degrees, [60.0, 40.0]);
        let line = marked(2048, pen, segment().map(place));
        assert_covers(&line, 1.0, 0.05);
    }
}

#[test]
fn a_turned_koch_curve_has_its_dimension() {
    let place = placed(1700.0, 17.0, [100.0, 40.0]);
    for pen in [1, 2] {
        let curve = marked(2000, pen, koch(7).into_iter().map(&place));
        assert_covers(&curve, 4f64.ln() / 3f64.ln(), 0.06);
    }
}

#[test]
fn a_spiral_is_a_curve_below_the_distance_of_its_turns() {
    // To boxes larger than this distance the spiral is an area, and no power describes the transition.
    for (side, pen) in [(1000_u16, 1), (700, 3)] {
        let radius = f64::from(side) / 2.0 - 10.0;
        let point = |number: i32| {
            let part = f64::from(number) / 60_000.0;
            let (sin, cos) = (25.0 * part).sin_cos();
            [cos, sin].map(|it| f64::from(side) / 2.0 + radius * part * it)
        };
        let spiral = marked(usize::from(side), pen, (0..=60_000).map(point));
        assert_covers(&spiral, 1.0, 0.03);
    }
}

#[test]
fn spectra_have_the_error_that_a_pen_makes() {
    let place = placed(580.0, 17.0, [40.0; 2]);
    let curve = marked(640, 2, koch(6).into_iter().map(place));
    let counted = measured(&curve).estimate;
    for order in [1.0, 2.0] {
        let spectrum = Generalised::of_pixels(&curve, counted, &[order], &grids(), number(2));
        let estimate = spectrum[0].estimate.unwrap();
        let off = (estimate.value - 4f64.ln() / 3f64.ln()).abs();
        assert!(off <= 2.0 * estimate.std_error, "{order}: {estimate:?}");
    }
}

#[test]
fn filled_shapes_have_dimension_2_at_any_angle() {
    for degrees in [0.0, 31.0, 77.0] {
        let back = placed(1.0, -degrees, [0.0; 2]);
        let rectangle = picture(900, |column, row| {
            let [x, y] = back([column as f64 - 450.0, row as f64 - 450.0]);
            x.abs() < 300.0 && y.abs() < 110.0
        });
        assert_covers(&rectangle, 2.0, 0.01);
    }
}

#[test]
fn a_carpet_is_measured_by_thirds() {
    let carpet = picture(900, |column, row| {
        let (mut column, mut row) = (column.wrapping_sub(40), row.wrapping_sub(100));
        let is_inside = column.max(row) < 729;
        while is_inside && column.max(row) > 0 {
            if column % 3 == 1 && row % 3 == 1 {
                return false;
            }
            (column, row) = (column / 3, row / 3);
        }
        is_inside
    });
    let counting = measured(&carpet);
    assert_eq!(
        (counting.base, counting.fitting_base),
        (Some(3.0), Some(3.0))
    );
    let estimate = assert_covers(&carpet, 8f64.ln() / 3f64.ln(), 1e-9);
    assert!(estimate.std_error < 0.002, "{estimate:?}");
    let by_halves = BoxCounting::of_pixels(&carpet, Some(number(2)), &grids(), number(1));
    assert_eq!(
        (by_halves.base, by_halves.fitting_base),
        (Some(2.0), Some(3.0))
    );
    let estimate = by_halves.estimate.unwrap();
    let off = (estimate.value - 8f64.ln() / 3f64.ln()).abs();
    assert!(off <= 2.0 * estimate.std_error, "{estimate:?}");
}

#[test]
fn where_a_set_lies_in_a_picture_changes_nothing() {
    let place = |left: f64, top: f64| placed(300.0, 20.0, [left, top]);
    let at = |left, top| marked(640, 2, koch(5).into_iter().map(place(left, top)));
    let here = measured(&at(10.0, 10.0));
    for there in [at(75.0, 10.0), at(201.0, 333.0)] {
        let there = measured(&there);
        assert_eq!(here.estimate, there.estimate);
        assert_eq!(here.boxes, there.boxes);
        assert_eq!(here.means, there.means);
    }
}

#[test]
fn slopes_that_drift_are_told() {
    // A ring is an area to boxes smaller than its width, and a curve to larger ones.
    let ring = picture(700, |column, row| {
        let away = libm::hypot(column as f64 - 350.0, row as f64 - 350.0);
        (300.0..308.0).contains(&away)
    });
    let trend = measured(&ring).trend.unwrap();
    assert!(
        trend.is_significant() && trend.per_decade > 0.0,
        "{trend:?}"
    );
}
