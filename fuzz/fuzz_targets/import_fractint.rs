//! Fuzzing of files of Fractint, as L-systems and as systems of maps.

#![no_main]

mod imported;

use kfrac::import::{ImportOptions, SourceFormat};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    for format in [SourceFormat::LSystems, SourceFormat::Ifs] {
        imported::check(text, format, &ImportOptions::default());
    }
});
