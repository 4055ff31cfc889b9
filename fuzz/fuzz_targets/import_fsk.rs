//! Fuzzing of FractaSketch's templates.

#![no_main]

mod imported;

use kfrac::import::{ImportOptions, SourceFormat};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    imported::check(text, SourceFormat::FractaSketch, &ImportOptions::default());
});
