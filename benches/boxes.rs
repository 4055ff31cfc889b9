//! Benchmarks of box counting: `cargo bench --locked --bench boxes`.

#![allow(missing_docs, reason = "a program of its own")]
#![allow(
    clippy::unwrap_used,
    reason = "a benchmark ends where it unwraps nothing"
)]

use std::num::NonZero;

use divan::Bencher;
use divan::counter::ItemsCount;
use kfrac::catalogue::Catalogue;
use kfrac::document::Document;
use kfrac::geometry::{DAffine2, DAffine3, DVec2, DVec3};
use kfrac::measure::{Bits, BoxCounting, Grid, LimitSet, counts};

fn main() {
    divan::main();
}

const SIDE: usize = 1 << 14;

/// Returns a Sierpinski gasket of 16384² pixels, one byte each.
fn bytes() -> Vec<u8> {
    let pixel = |place: usize| {
        let (column, row) = (place % SIDE, place / SIDE);
        if column & row == 0 { 255 } else { 0 }
    };
    (0..SIDE * SIDE).map(pixel).collect()
}

fn pyramid(mut bits: Bits) -> u64 {
    let mut all = bits.count();
    while bits.width() > 1 {
        bits = bits.folded([false; 2]);
        all += bits.count();
    }
    all
}

#[divan::bench(sample_count = 10)]
fn bytes_of_16384_squared(bencher: Bencher) {
    let bytes = bytes();
    bencher
        .counter(ItemsCount::new(bytes.len()))
        .bench(|| pyramid(Bits::of_bytes(&bytes, SIDE, SIDE, 128)));
}

#[divan::bench(sample_count = 10)]
fn bits_of_16384_squared(bencher: Bencher) {
    let bits = Bits::of_bytes(&bytes(), SIDE, SIDE, 128);
    bencher
        .counter(ItemsCount::new(SIDE * SIDE))
        .bench(|| pyramid(bits.clone()));
}

/// Returns points of a gasket in random order.
fn points() -> Vec<DVec2> {
    let corners = [DVec2::ZERO, DVec2::X, DVec2::Y];
    let (mut state, mut at) = (1u64, DVec2::ZERO);
    let point = |_| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        at = (at + corners[(state >> 33) as usize % 3]) / 2.0;
        at
    };
    (0..10_000_000).map(point).collect()
}

/// Counts boxes down to 2⁻¹⁴ with bits, or down to 2⁻²⁰ with sorted keys.
#[divan::bench(args = [14, 20], sample_count = 5)]
fn ten_million_points(bencher: Bencher, levels: u32) {
    let points = points();
    let boxes = 1usize << levels;
    let map = DAffine2::from_scale(DVec2::splat(0.999_999_999 * boxes as f64));
    bencher
        .counter(ItemsCount::new(points.len()))
        .bench(|| counts(points.iter().copied(), &map, [boxes, boxes, 1], levels));
}

/// Counts cubes of nine sizes about ten million points in space.
#[divan::bench(sample_count = 5)]
fn ten_million_points_in_space(bencher: Bencher) {
    const LEVELS: u32 = 9;
    let points: Vec<DVec3> = points()
        .chunks(2)
        .flat_map(|pair| [pair[0].extend(pair[1].x), pair[1].extend(pair[0].y)])
        .collect();
    let boxes = 1usize << LEVELS;
    let map = DAffine3::from_scale(DVec3::splat(0.999_999_999 * boxes as f64));
    bencher
        .counter(ItemsCount::new(points.len()))
        .bench(|| counts(points.iter().copied(), &map, [boxes; 3], LEVELS));
}

/// Counts the cubes of Menger's sponge to 3⁻¹².
#[divan::bench(sample_count = 5)]
fn cubes_of_a_sponge(bencher: Bencher) {
    let catalogue = Catalogue::embedded();
    let source = catalogue.rule("menger").unwrap();
    let (model, _) = Document::read(&source, &catalogue)
        .unwrap()
        .resolve(&[])
        .unwrap();
    let graph = model.compile_in_space(false).unwrap();
    let base = NonZero::new(3).unwrap();
    bencher.bench(|| {
        let set = LimitSet::of(&graph).unwrap();
        set.sampled_scales(base, &[Grid::ALONG], NonZero::<usize>::MIN)
    });
}

/// Measures a limit set completely, on one thread.
#[divan::bench(args = ["koch", "carpet", "dragon"], sample_count = 3)]
fn limit_set(bencher: Bencher, name: &str) {
    let catalogue = Catalogue::embedded();
    let source = catalogue.rule(name).unwrap();
    let (model, _) = Document::read(&source, &catalogue)
        .unwrap()
        .resolve(&[])
        .unwrap();
    let graph = model.compile(20).unwrap();
    let set = LimitSet::of(&graph).unwrap();
    let grids = Grid::spread(NonZero::new(8).unwrap());
    let one = NonZero::<usize>::MIN;
    bencher.bench(|| BoxCounting::of_limit(&set, None, &grids, one));
}
