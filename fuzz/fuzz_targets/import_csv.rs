//! Fuzzing of tables of maps, with the columns of their header, and with those of the other orders.

#![no_main]

mod imported;

use kfrac::import::{ImportOptions, SourceFormat};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let stated = ["acbdefp", "-abecdf", "jklabcdefghip"].map(|columns| {
        ImportOptions::default().columns(columns.parse().expect("these are columns"))
    });
    imported::check(text, SourceFormat::Csv, &ImportOptions::default());
    for options in stated {
        imported::check(text, SourceFormat::Csv, &options);
    }
});
