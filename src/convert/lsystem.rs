//! As an L-system: objects are symbols, and a turtle goes where their instances lie.
//!
//! Where all instances are lines of one length that are replaced, in chains from end to end, and their
//! directions are multiples of one angle, the strings are plain: `F+F--F+F`. Otherwise every instance
//! stands in brackets of its own, with free angles, moves and scales.

mod bracketed;
mod chain;

use crate::build::written::Entries;

use super::rule::similarity;
use super::structure::Structure;
use super::{Keeps, Refusal};

/// Letters for symbols, beginning with that for steps; those that mean something else are left out.
const LETTERS: &str = "FABCDEHIJKLMNOPQRSTUVWXYZabcdeghijklmnopqrstuvwxyz";

pub(super) fn write(structure: &Structure, keeps: Keeps) -> Result<Entries, Refusal> {
    let objects = (0..structure.objects.len()).map(Some);
    for object in objects.chain([None]) {
        for (number, placed) in structure.placed(object).iter().enumerate() {
            similarity(&placed.map, &|| structure.called(object, number))?;
        }
    }
    match chain::write(structure) {
        Some(entries) => Ok(entries),
        None => bracketed::write(structure, keeps),
    }
}

/// The letter of a symbol by number.
fn letter(number: usize) -> Result<char, Refusal> {
    let letters = LETTERS.chars().count();
    LETTERS
        .chars()
        .nth(number)
        .ok_or(Refusal::TooManySymbols(letters))
}

/// An angle in degrees, without what rounding has added to a simple one.
fn degrees(radians: f64) -> f64 {
    const MOST_PARTS: u32 = 60;
    const ROUNDING: f64 = 1e-12;
    let angle = radians.to_degrees();
    let simple = (1..=MOST_PARTS).map(f64::from).find_map(|part| {
        let nearest = (angle * part).round() / part;
        ((nearest - angle).abs() <= ROUNDING * 360.0).then_some(nearest)
    });
    simple.unwrap_or(angle) + 0.0
}
