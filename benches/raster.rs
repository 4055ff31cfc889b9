//! Benchmarks of coverage: lines of a round stroke, hairlines, and small polygons.
//!
//! Rates are in items a second, drawn all over a picture of 1024 × 1024 pixels.

#![allow(missing_docs, reason = "a program of its own")]
#![allow(
    clippy::cast_possible_truncation,
    reason = "positions lie on the picture"
)]

#[path = "../src/render/png/coverage/mod.rs"]
#[allow(
    dead_code,
    unused_imports,
    reason = "the kernels are not public, and not all of them are measured"
)]
mod coverage;

/// Geometry of the kernels.
#[path = "../src/geometry"]
mod geometry {
    #[path = "clip.rs"]
    mod clip;

    pub(crate) use clip::clip;
    pub(crate) use kfrac::geometry::DVec2;
}

use coverage::{CoverageBuffer, HairPen, RoundPen};
use divan::Bencher;
use divan::counter::ItemsCount;

const SIZE: u32 = 1024;

/// Number of items in a sample.
const ITEMS: usize = 100_000;

fn main() {
    divan::main();
}

/// Returns the positions of a walk in random directions, with steps of a length in hundredths of a pixel.
fn walk(length: f64) -> Vec<[i64; 2]> {
    let most = f64::from(SIZE) * 100.0;
    let mut at = [most / 2.0, most / 2.0];
    let mut angle = 0.0f64;
    let mut state = 1u64;
    let mut positions = Vec::with_capacity(ITEMS + 1);
    for _ in 0..=ITEMS {
        positions.push(at.map(|place| place as i64));
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        angle += (state >> 40) as f64 / f64::from(1 << 24) * 4.0 - 2.0;
        let (sine, cosine) = angle.sin_cos();
        at = [at[0] + cosine * length, at[1] + sine * length].map(|place| place.rem_euclid(most));
    }
    positions
}

#[divan::bench(args = [0.03, 0.3, 1.0, 3.0, 10.0], consts = [50, 100, 150, 300])]
fn lines<const WIDTH: u32>(bencher: Bencher, length: f64) {
    let positions = walk(length * 100.0);
    let pen = RoundPen::new(f64::from(WIDTH) / 100.0);
    let mut plane = CoverageBuffer::new([SIZE; 2]);
    bencher.counter(ItemsCount::new(ITEMS)).bench_local(|| {
        for pair in positions.windows(2) {
            let far = (0..2).any(|axis| pair[0][axis].abs_diff(pair[1][axis]) > 5000);
            // The walk re-enters on the opposite side.
            if !far {
                plane.line(&pen, pair[0], pair[1]);
            }
        }
    });
}

/// Every hairline has two ends of its own, as the branches of a tree have.
#[divan::bench(args = [0.03, 0.1, 0.3, 1.0, 3.0])]
fn hairs(bencher: Bencher, length: f64) {
    let positions = walk(length * 100.0);
    let pen = HairPen::new(0.05, 0.5);
    let mut plane = CoverageBuffer::new([SIZE; 2]);
    bencher.counter(ItemsCount::new(ITEMS)).bench_local(|| {
        for pair in positions.windows(2) {
            let far = (0..2).any(|axis| pair[0][axis].abs_diff(pair[1][axis]) > 5000);
            if !far {
                plane.hair(&pen, pair[0], pair[1], true);
            }
        }
    });
}

#[divan::bench(args = [3, 4, 6], consts = [50, 100, 200, 400])]
fn polygons<const SIDE: u32>(bencher: Bencher, vertices: u32) {
    let radius = f64::from(SIDE) / std::f64::consts::SQRT_2;
    let shapes: Vec<Vec<[i64; 2]>> = walk(70.0)
        .into_iter()
        .map(|[x, y]| {
            (0..vertices)
                .map(|vertex| {
                    let turn = f64::from(vertex) / f64::from(vertices) * std::f64::consts::TAU;
                    let (sine, cosine) = (turn + x as f64).sin_cos();
                    [x + (radius * cosine) as i64, y + (radius * sine) as i64]
                })
                .collect()
        })
        .collect();
    let mut plane = CoverageBuffer::new([SIZE; 2]);
    bencher
        .counter(ItemsCount::new(shapes.len()))
        .bench_local(|| {
            for shape in &shapes {
                assert!(plane.polygon(shape));
            }
        });
}

#[divan::bench]
fn pens() -> RoundPen {
    RoundPen::new(divan::black_box(1.5))
}
