//! Benchmarks of the chaos game, in points a second that are iterated and counted in a histogram.

#![allow(missing_docs, reason = "a program of its own")]
#![allow(
    clippy::unwrap_used,
    reason = "a benchmark ends where it unwraps nothing"
)]

use std::num::NonZero;

use divan::Bencher;
use divan::counter::ItemsCount;
use kfrac::chaos::{ClassBy, Game, HistogramWindow, WeightedMaps, play};
use kfrac::geometry::{DAffine2, DMat2, DVec2};
use kfrac::ifs::{Definition, Edge, Ifs, Map};

fn main() {
    divan::main();
}

const POINTS: u64 = 16 << 20;

/// Barnsley's fern: a, b, c, d, e, f and the weight of the map x → ax + by + e, y → cx + dy + f.
const FERN: [[f64; 7]; 4] = [
    [0.0, 0.0, 0.0, 0.16, 0.0, 0.0, 0.01],
    [0.85, 0.04, -0.04, 0.85, 0.0, 1.6, 0.85],
    [0.2, -0.26, 0.23, 0.22, 0.0, 1.6, 0.07],
    [-0.15, 0.28, 0.26, 0.24, 0.0, 0.44, 0.07],
];

fn fern() -> Vec<Map> {
    let map = |[a, b, c, d, e, f, weight]: [f64; 7]| {
        Map::new(DAffine2::from_cols_array(&[a, c, b, d, e, f])).weighing(weight)
    };
    FERN.map(map).into()
}

fn system(maps: Vec<Map>, edges: Option<Vec<Edge>>) -> WeightedMaps {
    let definition = Definition {
        maps,
        edges,
        ..Definition::default()
    };
    WeightedMaps::of(&Ifs::new(definition).unwrap()).unwrap()
}

/// Returns the window of the fern in a square picture.
fn window(side: u32) -> HistogramWindow {
    let scale = f64::from(side) / 10.2;
    let matrix = DMat2::from_diagonal(DVec2::new(scale, -scale));
    let corner = DVec2::new(5.1, 10.1) * scale;
    HistogramWindow {
        to_pixels: DAffine2::from_mat2_translation(matrix, corner),
        size: [side; 2],
    }
}

fn bench(bencher: Bencher, system: &WeightedMaps, side: u32, classes: ClassBy, threads: usize) {
    let window = window(side);
    let game = Game::default()
        .points(POINTS)
        .classes(classes)
        .threads(NonZero::new(threads).unwrap());
    bencher
        .counter(ItemsCount::new(POINTS))
        .bench(|| play(system, &window, &game).unwrap());
}

/// The counters of 8192 × 8192 pixels exceed every cache.
#[divan::bench(args = [(1024, 1), (1024, 2), (8192, 1)])]
fn fern_by_side_and_threads(bencher: Bencher, (side, threads): (u32, usize)) {
    let system = system(fern(), None);
    bench(bencher, &system, side, ClassBy::One, threads);
}

#[divan::bench]
fn fern_by_last_map(bencher: Bencher) {
    let system = system(fern(), None);
    bench(bencher, &system, 1024, ClassBy::Map { ago: 0 }, 1);
}

#[divan::bench]
fn recurrent_fern(bencher: Bencher) {
    let edges = (0..16).map(|edge| Edge {
        from: edge / 4,
        to: edge % 4,
        weight: Some([1.0, 9.0, 3.0, 2.0][edge % 4]),
    });
    let system = system(fern(), Some(edges.collect()));
    bench(bencher, &system, 1024, ClassBy::One, 1);
}

/// The fern's maps repeat, and copies share their weights.
#[divan::bench(args = [5, 8, 12, 16, 32])]
fn more_maps(bencher: Bencher, count: usize) {
    let maps = fern().into_iter().cycle().take(count).collect();
    bench(bencher, &system(maps, None), 1024, ClassBy::One, 1);
}
