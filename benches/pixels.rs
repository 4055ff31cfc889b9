//! Benchmark of pictures for programs: `cargo bench --locked --bench pixels`.
//!
//! Draws by the entry functions of [`kfrac::Fractal`], 1024 pixels on the long side: pixels without an encoder, PNG
//! with each encoding, and an encoding in 8-bit grey where the picture is black on white.

#![allow(missing_docs, reason = "a program of its own")]
#![allow(
    clippy::unwrap_used,
    reason = "a benchmark ends where it unwraps nothing"
)]

use divan::Bencher;
use kfrac::Fractal;
use kfrac::render::PngEncoding;

/// Names and steps: 65,536 elements, 98,302 coloured ones, 2^20 coloured by index.
const FRACTALS: [(&str, u32); 3] = [("koch", 8), ("pythagoras", 15), ("dragon", 20)];

const SIZE: u32 = 1024;

fn main() {
    divan::main();
}

fn fractal((name, steps): (&str, u32)) -> Fractal {
    Fractal::named(name).unwrap().steps(steps)
}

#[divan::bench(args = FRACTALS)]
fn pixels(bencher: Bencher<'_, '_>, case: (&str, u32)) {
    let fractal = fractal(case);
    bencher.bench_local(|| fractal.pixels(SIZE).unwrap());
}

#[divan::bench(args = FRACTALS)]
fn png(bencher: Bencher<'_, '_>, case: (&str, u32)) {
    let fractal = fractal(case);
    bencher.bench_local(|| fractal.png(SIZE).unwrap());
}

#[divan::bench(args = FRACTALS)]
fn png_fast(bencher: Bencher<'_, '_>, case: (&str, u32)) {
    let fractal = fractal(case).png_encoding(PngEncoding::default().fast(true));
    bencher.bench_local(|| fractal.png(SIZE).unwrap());
}

#[divan::bench(args = FRACTALS)]
fn png_fast_grey(bencher: Bencher<'_, '_>, case: (&str, u32)) {
    let fractal = fractal(case).png_encoding(PngEncoding::default().fast(true).grey(true));
    bencher.bench_local(|| fractal.png(SIZE).unwrap());
}
