//! Fuzzing of EisenScript.

#![no_main]

mod imported;

use kfrac::import::{Format, ImportOptions};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    imported::check(text, Format::EisenScript, &ImportOptions::default());
});
