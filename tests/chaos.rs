//! The chaos game: its measure and its points, which depend on nothing but the seed.

use std::num::NonZero;
use std::sync::atomic::AtomicBool;

use kfrac::chaos::{
    ClassBy, Game, GameError, Histogram, HistogramWindow, RandomPoints, Start, WeightedMaps, play,
};
use kfrac::geometry::{DAffine2, DMat2, DVec2};
use kfrac::grow::Progress;
use kfrac::ifs::{Condensation, Definition, Edge, Ifs, Map, Moments, Shape};
use kfrac::render::{Density, Labels, Shades, write_density};
use kfrac::style::{Colour, Palette, Tone};

const FERN: [[f64; 7]; 4] = [
    [0.0, 0.0, 0.0, 0.16, 0.0, 0.0, 0.01],
    [0.85, 0.04, -0.04, 0.85, 0.0, 1.6, 0.85],
    [0.2, -0.26, 0.23, 0.22, 0.0, 1.6, 0.07],
    [-0.15, 0.28, 0.26, 0.24, 0.0, 0.44, 0.07],
];

/// Returns maps x → ax + by + e, y → cx + dy + f with their weights.
fn maps(table: &[[f64; 7]]) -> Vec<Map> {
    let map = |&[a, b, c, d, e, f, weight]: &[f64; 7]| {
        Map::new(DAffine2::from_cols_array(&[a, c, b, d, e, f])).weighing(weight)
    };
    table.iter().map(map).collect()
}

fn ifs(maps: Vec<Map>) -> Ifs {
    Ifs::new(Definition {
        maps,
        ..Definition::default()
    })
    .unwrap()
}

/// Returns a recurrent system, given the weights with which the map of a column follows that of a row.
fn recurrent(maps: Vec<Map>, transitions: &[Vec<f64>]) -> Ifs {
    let rows = transitions.iter().enumerate();
    let edges = rows.flat_map(|(from, row)| {
        let weights = row.iter().copied().enumerate();
        let edges = weights.filter(|(_, weight)| *weight > 0.0);
        edges.map(move |(to, weight)| Edge {
            from,
            to,
            weight: Some(weight),
        })
    });
    let edges = Some(edges.collect());
    Ifs::new(Definition {
        maps,
        edges,
        ..Definition::default()
    })
    .unwrap()
}

/// Returns a system with weighted condensation sets.
fn condensed(maps: Vec<Map>, sets: Vec<(Shape, f64)>) -> Ifs {
    let sets = sets.into_iter().map(|(shape, weight)| Condensation {
        shape,
        weight: Some(weight),
    });
    Ifs::new(Definition {
        maps,
        condensation: sets.collect(),
        ..Definition::default()
    })
    .unwrap()
}

fn system(ifs: &Ifs) -> WeightedMaps {
    WeightedMaps::of(ifs).unwrap()
}

fn fern() -> WeightedMaps {
    system(&ifs(maps(&FERN)))
}

/// Returns the map x → (x + digit)/3: points are ternary fractions, and the last map gives the first digit.
fn digit(digit: u32, weight: f64) -> Map {
    let shift = f64::from(digit) / 3.0;
    maps(&[[1.0 / 3.0, 0.0, 0.0, 0.0, shift, 0.5, weight]]).remove(0)
}

/// Returns a window of square pixels, with `scale` pixels in a unit and the given upper left corner.
fn window(corner: DVec2, scale: f64, size: [u32; 2]) -> HistogramWindow {
    let matrix = DMat2::from_diagonal(DVec2::new(scale, -scale));
    HistogramWindow {
        to_pixels: DAffine2::from_mat2_translation(matrix, -(matrix * corner)),
        size,
    }
}

fn fern_window(side: u32) -> HistogramWindow {
    let scale = f64::from(side) / 10.2;
    window(DVec2::new(-5.1, 10.1), scale, [side; 2])
}

/// Returns a window with a pixel for every ternary fraction of a number of digits.
fn ternary(digits: u32) -> HistogramWindow {
    let cells = 3u32.pow(digits);
    window(DVec2::Y, f64::from(cells), [cells, cells])
}

fn game(points: u64) -> Game<'static> {
    Game::default().points(points)
}

/// Returns the moments of a histogram, in the units of the plane. Errors of half a pixel in points cancel in
/// the mean of many.
fn moments(histogram: &Histogram, window: &HistogramWindow) -> Moments {
    let back = window.to_pixels.inverse();
    let width = histogram.size()[0] as usize;
    let (mut mass, mut first, mut second) = (0.0, DVec2::ZERO, DMat2::ZERO);
    for (place, &count) in histogram.counts(0).iter().enumerate() {
        let pixel = DVec2::new((place % width) as f64, (place / width) as f64) + 0.5;
        let point = back.transform_point2(pixel);
        let count = f64::from(count);
        mass += count;
        first += count * point;
        second += DMat2::from_cols(point * point.x, point * point.y) * count;
    }
    let mean = first / mass;
    let square = DMat2::from_cols(mean * mean.x, mean * mean.y);
    let covariance = second * (1.0 / mass) - square;
    Moments { mean, covariance }
}

/// Asserts that the moments of a million counted points agree with the exact ones to 1/40 of a standard
/// deviation: steps of the fern are correlated over about ten steps, so the tolerance is eight standard
/// errors.
fn assert_moments(ifs: &Ifs, window: &HistogramWindow) {
    let exact = ifs.measure().unwrap().moments;
    let histogram = play(&system(ifs), window, &game(1_000_000)).unwrap();
    assert_eq!(histogram.inside(), 1_000_000);
    let counted = moments(&histogram, window);
    let variance = exact.covariance.x_axis.x + exact.covariance.y_axis.y;
    let off = (counted.mean - exact.mean).length();
    assert!(off < 0.025 * variance.sqrt(), "{counted:?} {exact:?}");
    let close = counted.covariance;
    assert!(
        close.abs_diff_eq(exact.covariance, 0.03 * variance),
        "{counted:?} {exact:?}"
    );
}

#[test]
fn the_measure_has_its_moments() {
    assert_moments(&ifs(maps(&FERN)), &fern_window(512));
    // The plane is far from its origin, where double precision is needed.
    let mut far = fern_window(512);
    let shift = DAffine2::from_translation(DVec2::splat(1e5));
    far.to_pixels *= shift.inverse();
    let mut maps = maps(&FERN);
    for map in &mut maps {
        map.affine = shift * map.affine * shift.inverse();
    }
    assert_moments(&ifs(maps), &far);
}

#[test]
fn the_measure_of_a_gasket_with_weights_has_its_moments() {
    let table = [
        [0.5, 0.0, 0.0, 0.5, 0.0, 0.0, 3.0],
        [0.5, 0.0, 0.0, 0.5, 0.5, 0.0, 2.0],
        [0.5, 0.0, 0.0, 0.5, 0.25, 0.4330127018922193, 1.0],
    ];
    let window = window(DVec2::new(-0.01, 1.0), 500.0, [512; 2]);
    assert_moments(&ifs(maps(&table)), &window);
}

#[test]
fn the_measure_of_a_recurrent_system_has_its_moments() {
    let transitions = vec![
        vec![0.0, 9.0, 1.0, 2.0],
        vec![1.0, 5.0, 0.0, 2.0],
        vec![0.0, 4.0, 1.0, 0.0],
        vec![1.0, 3.0, 3.0, 0.0],
    ];
    let system = recurrent(maps(&FERN), &transitions);
    assert_moments(&system, &fern_window(512));
}

#[test]
fn the_measure_of_a_condensed_system_has_its_moments() {
    let mut maps = maps(&FERN);
    let stem = Shape::polyline(&[DVec2::ZERO, DVec2::Y * 1.6]).unwrap();
    let disk = Shape::ellipse(DVec2::Y * 3.0, DVec2::new(0.5, 1.0), 17.0).unwrap();
    maps.remove(0);
    let system = condensed(maps, vec![(stem, 0.01), (disk, 0.1)]);
    assert_moments(&system, &fern_window(512));
}

#[test]
fn threads_do_not_tell() {
    let recurrent = recurrent(maps(&FERN), &vec![vec![1.0, 9.0, 2.0, 2.0]; 4]);
    let recurrent = system(&recurrent);
    let starts = Start::Points {
        points: vec![DVec2::new(4.0, 1.0), DVec2::new(-4.0, 9.0)],
        steps: NonZero::new(700).unwrap(),
    };
    let window = fern_window(200);
    for (system, start, classes) in [
        (fern(), Start::Attractor, ClassBy::One),
        (fern(), starts, ClassBy::Map { ago: 2 }),
        (recurrent, Start::Attractor, ClassBy::Map { ago: 0 }),
    ] {
        let on = |threads| {
            let game = game(2_500_001)
                .start(start.clone())
                .classes(classes)
                .threads(NonZero::new(threads).unwrap());
            play(&system, &window, &game).unwrap()
        };
        let one = on(1);
        assert_eq!(one.points(), 2_500_001);
        assert!(on(2) == one && on(3) == one);
    }
}

/// Pins the counts of a fixed seed, which are equal on all machines.
#[test]
fn counts_are_pinned() {
    let window = fern_window(64);
    let hash = |classes, seed| {
        let game = game(200_000).classes(classes).seed(seed);
        let histogram = play(&fern(), &window, &game).unwrap();
        let counts = (0..histogram.classes()).flat_map(|class| histogram.counts(class).to_vec());
        counts.fold(0xcbf2_9ce4_8422_2325u64, |hash, count| {
            (hash ^ u64::from(count)).wrapping_mul(0x0000_0100_0000_01b3)
        })
    };
    assert_eq!(hash(ClassBy::One, 0), 15_809_100_387_334_199_307);
    assert_eq!(hash(ClassBy::One, 1), 2_093_549_398_278_060_051);
    let last_but_one = ClassBy::Map { ago: 1 };
    assert_eq!(hash(last_but_one, 0), 14_089_862_966_029_706_963);
}

#[test]
fn nothing_lies_in_the_gaps_of_the_cantor_set() {
    let system = system(&ifs(vec![digit(0, 1.0), digit(2, 1.0)]));
    let histogram = play(&system, &ternary(6), &game(640_000)).unwrap();
    let mut columns = vec![0u32; 729];
    for (place, count) in histogram.counts(0).iter().enumerate() {
        columns[place % 729] += count;
    }
    let is_in_gap = |cell: usize| {
        let mut digits = (0..6).map(|place| cell / 3usize.pow(place) % 3);
        digits.any(|digit| digit == 1)
    };
    for (cell, &count) in columns.iter().enumerate() {
        // Rounding may move points across the edge of a gap.
        if (cell.max(1) - 1..=cell + 1).all(is_in_gap) {
            assert_eq!(count, 0, "{cell}");
        }
        if !is_in_gap(cell) {
            // Five standard errors of 10,000 points.
            assert!(count.abs_diff(10_000) < 500, "{cell}");
        }
    }
}

/// Returns the distance from the triangles of the gasket after a number of steps, but at most `most`.
fn distance(point: DVec2, corner: DVec2, side: f64, steps: u32, most: f64) -> f64 {
    let height = 0.75f64.sqrt();
    let centre = corner + DVec2::new(0.5, height / 3.0) * side;
    let to_centre = point.distance(centre);
    // The triangle's corners lie side / √3 from its centre.
    if to_centre - side / 3f64.sqrt() > most {
        return most;
    }
    if steps == 0 {
        return to_centre.min(most);
    }
    let half = side / 2.0;
    [DVec2::ZERO, DVec2::X, DVec2::new(0.5, height)]
        .into_iter()
        .fold(most, |most, offset| {
            distance(point, corner + offset * half, half, steps - 1, most)
        })
}

#[test]
fn points_lie_on_the_gasket() {
    let table = [
        [0.5, 0.0, 0.0, 0.5, 0.0, 0.0, 1.0],
        [0.5, 0.0, 0.0, 0.5, 0.5, 0.0, 1.0],
        [0.5, 0.0, 0.0, 0.5, 0.25, 0.4330127018922193, 1.0],
    ];
    let system = system(&ifs(maps(&table)));
    // Pixels of 1e-4 around the middle of the left side.
    let scale = 1e4;
    let window = window(DVec2::new(0.235, 0.45), scale, [300; 2]);
    let histogram = play(&system, &window, &game(1_000_000)).unwrap();
    let hits: Vec<_> = histogram.counts(0).iter().enumerate().collect();
    let back = window.to_pixels.inverse();
    let mut hit = 0;
    for (place, &count) in hits {
        if count > 0 {
            let pixel = DVec2::new((place % 300) as f64, (place / 300) as f64) + 0.5;
            let point = back.transform_point2(pixel);
            let near = distance(point, DVec2::ZERO, 1.0, 16, 1e-4);
            assert!(near < 1e-4, "{point}");
            hit += 1;
        }
    }
    assert!(hit > 200, "{hit}");
}

/// Returns the number of points in each class and column.
fn columns(histogram: &Histogram) -> Vec<Vec<u32>> {
    let width = histogram.size()[0] as usize;
    let classes = (0..histogram.classes()).map(|class| {
        let mut columns = vec![0; width];
        for (place, count) in histogram.counts(class).iter().enumerate() {
            columns[place % width] += count;
        }
        columns
    });
    classes.collect()
}

#[test]
fn weights_are_honoured_and_classes_are_tiles() {
    let weights = [2.0, 5.0, 1.0];
    let digits = (0..3).map(|place| digit(place, weights[place as usize]));
    let system = system(&ifs(digits.collect()));
    for ago in 0..2 {
        let game = game(400_000).classes(ClassBy::Map { ago });
        let columns = columns(&play(&system, &ternary(2), &game).unwrap());
        for (class, columns) in columns.iter().enumerate() {
            for (cell, &count) in columns.iter().enumerate() {
                let digits = [cell / 3, cell % 3];
                let expected = if digits[usize::from(ago)] == class {
                    400_000.0 * weights[digits[0]] * weights[digits[1]] / 64.0
                } else {
                    0.0
                };
                // Rounding may move a few points across the edge of a cell.
                let error = 5.0 * f64::sqrt(expected) + 5.0;
                assert!(
                    (f64::from(count) - expected).abs() < error,
                    "{ago} {class} {cell}"
                );
            }
        }
    }
}

/// After 0 only 1 may follow, after 1 itself or 2, after 2 only 0: the stationary weights are 1, 2, 1. The
/// digits of a point are the last map and the preceding one.
#[test]
fn transitions_lead_from_the_row_to_the_column() {
    let digits = (0..3).map(|place| digit(place, 1.0)).collect();
    let transitions = vec![
        vec![0.0, 7.0, 0.0],
        vec![0.0, 1.0, 1.0],
        vec![0.3, 0.0, 0.0],
    ];
    let system = system(&recurrent(digits, &transitions));
    let columns = columns(&play(&system, &ternary(2), &game(400_000)).unwrap());
    // 10 after 01, 11 and 21 after 1, 02 after 2.
    let expected = [0, 0, 1, 1, 1, 0, 0, 1, 0];
    for (cell, (&count, quarters)) in columns[0].iter().zip(expected).enumerate() {
        let off = f64::from(count) - f64::from(quarters) * 100_000.0;
        assert!(
            off.abs() < 2_500.0 * f64::from(quarters) + 5.0,
            "{cell} {count}"
        );
    }
}

#[test]
fn condensation_sets_are_drawn_at_every_level() {
    let point = Shape::Point(DVec2::new(0.5, 0.5));
    let maps = vec![digit(0, 1.0), digit(2, 1.0)];
    let system = system(&condensed(maps, vec![(point, 2.0)]));
    let game = game(400_000).classes(ClassBy::Map { ago: 0 });
    let columns = columns(&play(&system, &ternary(3), &game).unwrap());
    // Half of the points, then an eighth in the middle of either third, and so on.
    let about = |count: u32, expected: f64| (f64::from(count) - expected).abs() < 1_500.0;
    assert_eq!(columns[2].iter().sum::<u32>(), columns[2][13]);
    assert!(about(columns[2][13], 200_000.0));
    assert!(about(columns[0][4], 50_000.0) && about(columns[1][22], 50_000.0));
    assert!(about(columns[0][1], 12_500.0) && about(columns[0][7], 12_500.0));
    assert_eq!(columns[0][3] + columns[0][5], 0);
}

/// Demko et al. 1985, section 3.2: the walk from 2 by f, f, g, f passes 2/3, 2/9, 20/27 and 20/81.
#[test]
fn walks_from_given_starts_are_drawn_whole() {
    let system = system(&ifs(vec![digit(0, 1.0), digit(2, 1.0)]));
    let walk = |steps| {
        let start = Start::Points {
            points: vec![DVec2::new(2.02, 0.0)],
            steps: NonZero::new(steps).unwrap(),
        };
        let window = window(DVec2::Y, 27.0, [54, 27]);
        let game = game(100_000).start(start);
        columns(&play(&system, &window, &game).unwrap()).remove(0)
    };
    let hit = |columns: Vec<u32>| -> Vec<usize> {
        let cells = columns.into_iter().enumerate();
        cells
            .filter(|(_, count)| *count > 0)
            .map(|(cell, _)| cell)
            .collect()
    };
    // 2/3 and 4/3; then 2/9, 8/9, 4/9 and 10/9.
    assert_eq!(hit(walk(1)), [18, 36]);
    assert_eq!(hit(walk(2)), [6, 12, 18, 24, 30, 36]);
}

#[test]
fn what_lies_outside_is_counted_but_not_drawn() {
    let window = window(DVec2::new(-0.5, 5.5), 10.0, [10, 10]);
    let histogram = play(&fern(), &window, &game(100_000)).unwrap();
    assert_eq!(histogram.points(), 100_000);
    let drawn: u64 = histogram
        .counts(0)
        .iter()
        .map(|&count| u64::from(count))
        .sum();
    assert_eq!(histogram.inside(), drawn);
    assert!(drawn > 1_000 && drawn < 50_000, "{drawn}");
    assert_eq!(histogram.counts(1), [0; 0]);
}

#[test]
fn progress_is_told_and_games_can_be_cancelled() {
    let progress = Progress::default();
    let cancel = AtomicBool::new(false);
    let mut game = game(1_234_567)
        .progress(Some(&progress))
        .cancel(Some(&cancel));
    let window = fern_window(32);
    play(&fern(), &window, &game).unwrap();
    assert_eq!(progress.walked(), 1_234_567);
    assert_eq!(progress.expected(), Some(1_234_567));
    cancel.store(true, std::sync::atomic::Ordering::Relaxed);
    // The game would take forever.
    game.points = u64::MAX;
    let cancelled = play(&fern(), &window, &game);
    assert_eq!(cancelled, Err(GameError::Cancelled));
}

#[test]
fn what_cannot_be_played_is_refused() {
    let refused =
        |window: HistogramWindow, game: Game<'_>| play(&fern(), &window, &game).unwrap_err();
    let flat = HistogramWindow {
        to_pixels: DAffine2::ZERO,
        size: [10, 10],
    };
    assert_eq!(refused(flat, game(1)), GameError::Window);
    assert_eq!(refused(fern_window(0), game(1)), GameError::Window);
    let size = [1 << 15; 2];
    let large = HistogramWindow {
        size,
        ..fern_window(64)
    };
    let classes = 1;
    assert_eq!(
        refused(large, game(1)),
        GameError::TooManyBins { size, classes }
    );
    let start = Start::Points {
        points: vec![DVec2::ZERO, DVec2::NAN],
        steps: NonZero::<u32>::MIN,
    };
    let game = game(1).start(start);
    assert_eq!(
        refused(fern_window(64), game),
        GameError::Start { start: 1 }
    );
}

#[test]
fn no_points_are_an_empty_histogram() {
    let histogram = play(&fern(), &fern_window(64), &game(0)).unwrap();
    assert_eq!((histogram.points(), histogram.inside()), (0, 0));
    assert_eq!(histogram.counts(0).len(), 64 * 64);
}

/// Returns the pixels of a picture of two points in a row of three; the second point is hit three times as
/// often.
fn pixels(density: &Density, classes: ClassBy) -> Vec<[u8; 4]> {
    // Two maps, each onto a point.
    let point = |x: f64, weight: f64| maps(&[[0.0, 0.0, 0.0, 0.0, x, 0.5, weight]]).remove(0);
    let system = system(&ifs(vec![point(0.5, 1.0), point(1.5, 3.0)]));
    let game = game(100_000).classes(classes);
    let histogram = play(&system, &window(DVec2::Y, 1.0, [3, 1]), &game).unwrap();
    let mut bytes = Vec::new();
    write_density(&histogram, density, &Labels::default(), &mut bytes).unwrap();
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::EXPAND | png::Transformations::ALPHA);
    let mut reader = decoder.read_info().unwrap();
    // Few colours are written as a palette, which is read as colours with opacity.
    let mut pixels = [0; 12];
    reader.next_frame(&mut pixels).unwrap();
    pixels.as_chunks().0.to_vec()
}

#[test]
fn histograms_are_drawn_in_ink_in_palettes_and_by_class() {
    let paper = Some(Colour::grey(255));
    let linear = Density::default().tone(Tone::Linear).background(paper);
    let [first, second, none] = pixels(&linear, ClassBy::One)[..] else {
        panic!("three pixels");
    };
    assert_eq!((second, none), ([0, 0, 0, 255], [255; 4]));
    // A third of the ink.
    assert!(first[0].abs_diff(170) <= 3 && first[3] == 255, "{first:?}");

    let plain = linear.clone().tone(Tone::Plain).background(None);
    let drawn = pixels(&plain, ClassBy::One);
    assert_eq!(drawn, [[0, 0, 0, 255], [0, 0, 0, 255], [0; 4]]);

    let inks = [
        Colour::of_rgba([255, 0, 0, 255]),
        Colour::of_rgba([0, 0, 255, 255]),
    ];
    let classes = plain.shades(Shades::Classes(inks.into()));
    let drawn = pixels(&classes, ClassBy::Map { ago: 0 });
    assert_eq!(drawn, [[255, 0, 0, 255], [0, 0, 255, 255], [0; 4]]);

    let palette = linear.shades(Shades::Palette(Palette::default()));
    let drawn = pixels(&palette, ClassBy::One);
    assert_eq!(drawn[1], Palette::default().at(1.0).rgba());
    assert_eq!(drawn[2], [255; 4]);
}

/// The list is a different walk with the same probabilities.
#[test]
fn points_can_be_listed() {
    let weights = [2.0, 5.0, 1.0];
    let digits = (0..3).map(|place| digit(place, weights[place as usize]));
    let system = system(&ifs(digits.collect()));
    let mut counts = [0; 3];
    for point in RandomPoints::new(&system, &Start::Attractor, 7).take(80_000) {
        counts[point.map] += 1;
        assert_eq!(point.map as f64, (point.place.x * 3.0 + 1e-9).floor());
    }
    for (count, weight) in counts.into_iter().zip(weights) {
        assert!(
            (f64::from(count) - 10_000.0 * weight).abs() < 700.0,
            "{count}"
        );
    }
    let start = Start::Points {
        points: vec![DVec2::new(2.0, 0.0), DVec2::new(5.0, 0.0)],
        steps: NonZero::new(2).unwrap(),
    };
    let [first, second, third, _, fifth] = RandomPoints::new(&system, &start, 0)
        .take(5)
        .map(|point| point.place.x * 3.0 - point.map as f64)
        .collect::<Vec<_>>()[..]
    else {
        panic!("there is no end")
    };
    assert!((first - 2.0).abs() < 1e-12 && (third - 5.0).abs() < 1e-12);
    assert!((0.0..2.0).contains(&second) && (fifth - 2.0).abs() < 1e-12);
}
