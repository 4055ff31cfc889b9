//! Tests of coverage: areas, overlaps, threads and borders.

#![allow(clippy::cast_possible_truncation, reason = "positions are small")]

use proptest::prelude::*;

mod outlines;

use super::drain::drained;
use super::{CoverageBuffer, HairPen, Position, RoundPen, SAMPLES, WHOLE};

const SIZE: u32 = 64;

/// A line that continues on another buffer, outside of everything covered there, is not lost.
#[test]
fn lines_go_on_on_other_planes() {
    let corners = [[1000, 1000], [3000, 2000], [500, 3000], [4000, 400]];
    let pen = RoundPen::new(1.0);
    let whole = covered(|plane| {
        plane.dot(&pen, corners[0]);
        corners
            .windows(2)
            .for_each(|line| plane.line(&pen, line[0], line[1]));
    });
    let mut planes = [0; 3].map(|_| CoverageBuffer::new([SIZE; 2]));
    planes[0].dot(&pen, corners[0]);
    for (line, plane) in corners.windows(2).zip(&mut planes) {
        plane.reach(&pen, line[0]);
        plane.line(&pen, line[0], line[1]);
    }
    assert!(drained(&mut planes) == whole);
}

/// Returns the coverage of every pixel.
fn covered(draw: impl FnOnce(&mut CoverageBuffer)) -> Vec<u32> {
    let mut plane = CoverageBuffer::new([SIZE; 2]);
    draw(&mut plane);
    plane.drained()
}

/// Returns the number of covered samples of every pixel.
fn samples(draw: impl FnOnce(&mut CoverageBuffer)) -> Vec<u32> {
    let covered = covered(draw);
    covered
        .iter()
        .map(|part| part / (WHOLE / SAMPLES))
        .collect()
}

/// Returns the covered area, in pixels.
fn area(samples: &[u32]) -> f64 {
    f64::from(samples.iter().sum::<u32>()) / f64::from(SAMPLES)
}

fn length([x, y]: Position, [u, v]: Position) -> f64 {
    f64::hypot((u - x) as f64, (v - y) as f64) / 100.0
}

/// Returns the samples that a stroke of one line covers.
fn stroke(width: f64, from: Position, to: Position) -> Vec<u32> {
    let pen = RoundPen::new(width);
    samples(|plane| {
        plane.dot(&pen, from);
        plane.line(&pen, from, to);
    })
}

/// Returns the area that a hairline covers, in pixels.
fn hair_area(width: f64, from: Position, to: Position) -> f64 {
    let pen = HairPen::new(width, 0.5);
    let covered = covered(|plane| plane.hair(&pen, from, to, true));
    covered.into_iter().map(f64::from).sum::<f64>() / f64::from(WHOLE)
}

/// Returns positions so far inside that pens do not reach the border.
fn inside() -> impl Strategy<Value = Position> {
    [200..6200i64, 200..6200]
}

fn anywhere() -> impl Strategy<Value = Position> {
    let coordinate = || prop_oneof![-1000..8000i64, -100_000_000_000..100_000_000_000i64];
    [coordinate(), coordinate()]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_line_covers_its_area(width in 0.25..3.0, from in inside(), to in inside()) {
        let radius = width / 2.0;
        let expected = width * length(from, to) + std::f64::consts::PI * radius * radius;
        let covered = area(&stroke(width, from, to));
        // Samples lie in rows, some of which are a tenth of a pixel apart.
        prop_assert!(
            (covered - expected).abs() <= 0.02 * expected + 0.05 * length(from, to) + 0.1,
            "{covered} instead of {expected}"
        );
    }

    #[test]
    fn a_dot_covers_a_disk(width in 0.25..3.0, at in inside()) {
        let expected = std::f64::consts::PI * width * width / 4.0;
        let covered = area(&stroke(width, at, at));
        prop_assert!((covered - expected).abs() <= 0.02 * expected + 0.08, "{covered} instead of {expected}");
    }

    #[test]
    fn mirror_images_are_drawn_alike(width in 0.25..3.0, from in inside(), to in inside()) {
        let mirror = |[x, y]: Position| [i64::from(SIZE) * 100 - x, y];
        let one = stroke(width, from, to);
        let other = stroke(width, mirror(from), mirror(to));
        let rows = one.chunks(SIZE as usize).zip(other.chunks(SIZE as usize));
        for (one, other) in rows {
            for (one, other) in one.iter().zip(other.iter().rev()) {
                prop_assert!(one.abs_diff(*other) <= SAMPLES / 5, "{one} and {other}");
            }
        }
    }

    #[test]
    fn order_and_repetition_do_not_show(
        mut lines in proptest::collection::vec((inside(), inside()), 1..20),
    ) {
        let pens = [0.7, 1.5, 3.0].map(RoundPen::new);
        let draw = |plane: &mut CoverageBuffer, lines: &[(Position, Position)]| {
            for (from, to) in lines {
                let pen = &pens[from[0].unsigned_abs() as usize % 3];
                plane.reach(pen, *from);
                plane.line(pen, *from, *to);
            }
        };
        let once = samples(|plane| draw(plane, &lines));
        let again = samples(|plane| {
            draw(plane, &lines);
            lines.reverse();
            draw(plane, &lines);
        });
        prop_assert!(once == again);
    }

    #[test]
    fn lines_from_anywhere_are_cut_at_the_border(from in anywhere(), to in anywhere()) {
        // The visible part of a line is no longer than the line or the diagonal.
        let covered = area(&stroke(1.0, from, to));
        let diagonal = f64::from(SIZE) * std::f64::consts::SQRT_2;
        prop_assert!(covered <= 1.03 * diagonal.min(length(from, to)) + 2.0);
        let polygon = [from, to, [from[0] + 100, from[1] + 100]];
        samples(|plane| {
            plane.polygon(&polygon);
        });
    }

    #[test]
    fn a_hair_covers_its_area(width in 0.01..0.25, from in inside(), to in inside()) {
        let expected = width * (length(from, to) + width);
        let covered = hair_area(width, from, to);
        // A line of length l through a pixel absorbs 1 - (1 - width)^l of its light: its width if l is 1,
        // more than its area if it is short, and less along a diagonal.
        let short = -f64::ln(1.0 - width) / width;
        let diagonal = std::f64::consts::SQRT_2;
        let long = (1.0 - f64::powf(1.0 - width, diagonal)) / (diagonal * width);
        prop_assert!(
            (long * expected - 2e-3..=short * expected + 2e-3).contains(&covered),
            "{covered} instead of {expected}"
        );
        // Along a border between pixels, half lies in either: 2 (1 - √(1 - width)) is at most 1.072 widths.
        if length(from, to) > 16.0 {
            let off = (covered - expected).abs();
            prop_assert!(off <= 0.08 * expected, "{covered} instead of {expected}");
        }
    }

    #[test]
    fn hairs_have_no_order(
        lines in proptest::collection::vec((0.001..0.25, inside(), inside()), 2..40),
    ) {
        let triangle = |[x, y]: Position| [[x, y], [x + 150, y + 40], [x + 60, y + 170]];
        let draw = |plane: &mut CoverageBuffer, (width, from, to): &(f64, Position, Position)| {
            plane.hair(&HairPen::new(*width, 0.0), *from, *to, false);
            plane.polygon(&triangle(*to));
        };
        let whole = covered(|plane| lines.iter().for_each(|line| draw(plane, line)));
        let backwards = covered(|plane| lines.iter().rev().for_each(|line| draw(plane, line)));
        prop_assert!(whole == backwards);
        let mut halves = [CoverageBuffer::new([SIZE; 2]), CoverageBuffer::new([SIZE; 2])];
        for (line, number) in lines.iter().zip(0..) {
            draw(&mut halves[number % 2], line);
        }
        prop_assert!(whole == drained(&mut halves));
    }

    #[test]
    fn hairs_from_anywhere_are_cut_at_the_border(from in anywhere(), to in anywhere()) {
        let diagonal = f64::from(SIZE) * std::f64::consts::SQRT_2;
        let covered = hair_area(0.1, from, to);
        prop_assert!(covered <= 0.11 * (diagonal.min(length(from, to)) + 1.0));
    }

    #[test]
    fn polygons_cover_their_area(centre in inside(), turn in 0.0..6.3f64, radius in 10.0..350.0f64, count in 3..8u32) {
        let corner = |number| {
            let (sine, cosine) = (turn + f64::from(number) * std::f64::consts::TAU / f64::from(count)).sin_cos();
            [centre[0] + (radius * cosine) as i64, centre[1] + (radius * sine) as i64]
        };
        let corners: Vec<Position> = (0..count).map(corner).collect();
        let nexts = corners.iter().cycle().skip(1);
        let sides = || corners.iter().zip(nexts.clone());
        let twice: i64 = sides().map(|(p, q)| p[0] * q[1] - p[1] * q[0]).sum();
        let around: f64 = sides().map(|(p, q)| length(*p, *q)).sum();
        let border = [centre[0], 6400 - centre[0], centre[1], 6400 - centre[1]];
        prop_assume!(border.iter().all(|&border| border as f64 > radius));
        let covered = samples(|plane| assert!(plane.polygon(&corners)));
        let expected = twice as f64 / 20_000.0;
        prop_assert!(
            (area(&covered) - expected).abs() <= 0.04 * around + 0.03,
            "{} instead of {expected}", area(&covered)
        );
        let backwards: Vec<Position> = corners.iter().rev().copied().collect();
        prop_assert!(covered == samples(|plane| assert!(plane.polygon(&backwards))));
    }

    #[test]
    fn neighbours_leave_no_gap_and_do_not_overlap(
        corner in [500..5000i64, 500..5000],
        [x, y] in [20..780i64, 20..780i64],
        (u, v) in (1..19i64, 1..19i64),
    ) {
        let [left, top] = corner;
        let square = [[left, top], [left + x, top], [left + x, top + y], [left, top + y]];
        let middle = [left + x * u / 20, top + y * v / 20];
        let whole = samples(|plane| assert!(plane.polygon(&square)));
        let mut sum = vec![0; whole.len()];
        for (from, to) in [(0, 1), (1, 2), (2, 3), (3, 0)] {
            let part = [square[from], square[to], middle];
            let part = samples(|plane| assert!(plane.polygon(&part)));
            sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
        }
        // Half planes are rounded, so that a sample may be missed or covered twice where three meet.
        for (whole, sum) in whole.iter().zip(sum) {
            prop_assert!(whole.abs_diff(sum) <= 3, "{whole} and {sum}");
        }

    }
}

#[test]
fn lines_have_their_ink_on_average() {
    for width in [0.3, 0.5, 1.0, 1.5, 2.2, 3.0] {
        let (mut covered, mut expected) = (0.0, 0.0);
        for turn in 0..60 {
            let (sine, cosine) = (f64::from(turn) / 60.0 * std::f64::consts::TAU).sin_cos();
            let from = [3200 + 3 * turn, 3200 + 7 * turn].map(i64::from);
            let to = [
                from[0] + (2000.0 * cosine) as i64,
                from[1] + (2000.0 * sine) as i64,
            ];
            covered += area(&stroke(width, from, to));
            expected += width * (length(from, to) + std::f64::consts::PI * width / 4.0);
        }
        let excess = covered / expected - 1.0;
        assert!(excess.abs() <= 0.02, "{excess:.4} too much at {width}");
    }
}

/// Coincident lines transmit as much light as lines at random positions, and any number of them absorbs at
/// most all.
#[test]
fn hairs_that_lie_together_fill_a_pixel() {
    let pen = HairPen::new(0.1, 0.0);
    for (count, expected) in [(1, 0.1), (2, 0.19), (7, 0.5217), (1000, 1.0)] {
        let covered = covered(|plane| {
            for _ in 0..count {
                plane.hair(&pen, [0, 3250], [6400, 3250], false);
            }
        });
        let part = f64::from(covered[32 * SIZE as usize + 20]) / f64::from(WHOLE);
        assert!((part - expected).abs() <= 2e-3, "{part} of {count}");
    }
}

/// A moving hairline crosses the border of a pixel gradually.
#[test]
fn hairs_cross_the_border_of_a_pixel_bit_by_bit() {
    let pen = HairPen::new(0.2, 0.0);
    let mut last = 0;
    for x in 3180..=3220 {
        let covered = covered(|plane| plane.hair(&pen, [x, 0], [x, 6400], false));
        let right = covered[20 * SIZE as usize + 32];
        assert!(right >= last && right - last <= WHOLE / 80, "at {x}");
        last = right;
    }
    assert!(last.abs_diff(WHOLE / 5) <= WHOLE / 500);
}

#[test]
fn a_line_through_the_whole_plane_is_drawn_where_it_is_seen() {
    let far = 100_000_000_000;
    let covered = stroke(1.0, [-far, 3250], [far, 3250]);
    for (pixel, &samples) in covered.iter().enumerate() {
        let expected = if pixel / SIZE as usize == 32 {
            SAMPLES
        } else {
            0
        };
        assert!(
            samples.abs_diff(expected) <= 2,
            "{samples} in pixel {pixel}"
        );
    }
}
