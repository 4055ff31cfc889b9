//! Benchmarks of morphology: `cargo bench --locked --bench morphology`.
//!
//! The picture is a Koch island that fills it. Targets, on a quiet machine: the skeleton in 0.03 s at 1024² and 0.5 s
//! at 4096², the opening by a disk of radius 64 in 0.4 s at 4096².

#![allow(missing_docs, reason = "a program of its own")]
#![allow(
    clippy::unwrap_used,
    reason = "a benchmark ends where it unwraps nothing"
)]

use std::num::NonZero;

use divan::Bencher;
use divan::counter::ItemsCount;
use kfrac::import::Raster;
use kfrac::morphology::{
    DiskFamily, DistanceMap, Sequence, Skeleton, SkeletonOptions, SkeletonSubsets,
};
use kfrac::render::Size;
use kfrac::{Bits, Fractal};

fn main() {
    divan::main();
}

const SIDES: [u32; 2] = [1024, 4096];

fn island(side: u32) -> Bits {
    let island = Fractal::named("koch-snowflake").unwrap().steps(6);
    let picture = island.png(Size::Exactly(side, side)).unwrap();
    let picture = Raster::read(&picture, None).unwrap();
    Bits::of_bytes(&picture.values, picture.width, picture.height, 128)
}

fn threads() -> NonZero<usize> {
    std::thread::available_parallelism().unwrap()
}

fn run<T>(bencher: Bencher<'_, '_>, side: u32, work: impl Fn(&Bits) -> T + Sync) {
    let bits = island(side);
    let pixels = ItemsCount::new(bits.width() * bits.height());
    bencher.counter(pixels).bench(|| work(&bits));
}

#[divan::bench(args = SIDES, sample_count = 5)]
fn distance(bencher: Bencher<'_, '_>, side: u32) {
    run(bencher, side, |bits| DistanceMap::to(bits, threads()));
}

#[divan::bench(args = SIDES, sample_count = 5)]
fn opening_of_64(bencher: Bencher<'_, '_>, side: u32) {
    let opening: Sequence = "open:64".parse().unwrap();
    run(bencher, side, |bits| {
        opening.apply(bits, DiskFamily::Euclid, threads())
    });
}

#[divan::bench(args = SIDES, sample_count = 5)]
fn opening_by_64_squares(bencher: Bencher<'_, '_>, side: u32) {
    let opening: Sequence = "open:64".parse().unwrap();
    run(bencher, side, |bits| {
        opening.apply(bits, DiskFamily::Square, threads())
    });
}

#[divan::bench(args = SIDES, sample_count = 5)]
fn skeleton(bencher: Bencher<'_, '_>, side: u32) {
    let options = SkeletonOptions {
        threads: threads(),
        ..SkeletonOptions::default()
    };
    run(bencher, side, |bits| Skeleton::of(bits, &options));
}

#[divan::bench(args = DiskFamily::ALL.map(DiskFamily::name), sample_count = 5)]
fn subsets_at_1024(bencher: Bencher<'_, '_>, name: &str) {
    let disk = DiskFamily::ALL
        .into_iter()
        .find(|disk| disk.name() == name)
        .unwrap();
    run(bencher, 1024, |bits| {
        SkeletonSubsets::of(bits, disk, threads())
    });
}
