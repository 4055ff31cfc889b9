//! Fuzzing of genes of curves.

#![no_main]

mod imported;

use kfrac::import::{ImportOptions, SourceFormat};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| imported::check(text, SourceFormat::Genes, &ImportOptions::default()));
