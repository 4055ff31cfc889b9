//! Fuzzing of EisenScript.

#![no_main]

mod imported;

use kfrac::import::{ImportOptions, SourceFormat};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    imported::check(text, SourceFormat::EisenScript, &ImportOptions::default());
});
