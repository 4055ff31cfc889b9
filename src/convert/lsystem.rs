//! Conversion to an L-system: objects become symbols, and a turtle moves to their instances.
//!
//! Where all instances are replaced lines of one length, in chains from end to end, and their directions are
//! multiples of one angle, the strings are plain: `F+F--F+F`. Otherwise every instance stands in brackets of
//! its own, with arbitrary angles, moves and scales.

mod bracketed;
mod chain;

use glam::DVec2;

use crate::build::written::Entries;

use super::rule::similarity;
use super::structure::Structure;
use super::{Keeps, Refusal};

/// Letters of symbols, in order of use; letters with a different meaning by default are left out.
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

/// Returns the letter of a symbol, given its index.
fn letter(number: usize) -> Result<char, Refusal> {
    let letters = LETTERS.chars().count();
    LETTERS
        .chars()
        .nth(number)
        .ok_or(Refusal::TooManySymbols(letters))
}

/// Returns the letter of a symbol, which is added to the known ones if it is new.
fn letter_of<S: PartialEq>(symbols: &mut Vec<S>, symbol: S) -> Result<char, Refusal> {
    let known = symbols.iter().position(|known| *known == symbol);
    letter(known.unwrap_or_else(|| {
        symbols.push(symbol);
        symbols.len() - 1
    }))
}

/// Returns the turn from a direction to another in radians, from −π to π; precise for small turns too.
fn turn(from: DVec2, to: DVec2) -> f64 {
    // A reversal is a turn to the left: the sum is never −0.
    libm::atan2(from.perp_dot(to) + 0.0, from.dot(to))
}

/// Returns the turn from a direction to another in degrees, rounded to a simple fraction that differs only by rounding.
fn degrees(from: DVec2, to: DVec2) -> f64 {
    const MAX_PARTS: u32 = 60;
    const ROUNDING: f64 = 1e-12;
    let angle = turn(from, to).to_degrees();
    let simple = (1..=MAX_PARTS).map(f64::from).find_map(|part| {
        let nearest = (angle * part).round() / part;
        ((nearest - angle).abs() <= ROUNDING * 360.0).then_some(nearest)
    });
    simple.unwrap_or(angle) + 0.0
}
