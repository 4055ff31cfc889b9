use crate::expression::Program;

use super::draw::{Path, pick_by_weight};
use super::generator::Moment;

/// Which generator replaces a fertile element that does not name its own.
#[derive(Clone, Debug, PartialEq)]
pub enum Selection {
    /// Always the same.
    Always(usize),
    /// Element i takes entry (i − 1) mod m of the m entries (Kaandorp 1987, figure 13).
    ByIndex(Vec<usize>),
    /// The first whose condition holds; the last one has none (Kaandorp 1987, figure 6).
    ByCondition {
        /// Conditions, tried in order.
        cases: Vec<(Program, usize)>,
        /// The generator where none holds.
        otherwise: usize,
    },
    /// At random, by weight.
    AtRandom(Vec<(f64, usize)>),
}

impl Selection {
    /// The generator for an element.
    #[inline]
    #[must_use]
    pub fn select(&self, moment: &Moment, path: Path) -> usize {
        match self {
            Self::Always(generator) => *generator,
            Self::ByIndex(entries) => entries[remainder(moment.index, entries.len())],
            Self::ByCondition { cases, otherwise } => {
                let slots = moment.slots();
                cases
                    .iter()
                    .find(|(condition, _)| condition.holds(&slots))
                    .map_or(*otherwise, |(_, generator)| *generator)
            }
            Self::AtRandom(entries) => {
                let weights = entries.iter().map(|(weight, _)| *weight);
                entries[pick_by_weight(path, weights)].1
            }
        }
    }

    /// The generators that may be picked, each once, in the order of listing.
    #[must_use]
    pub fn candidates(&self) -> Vec<usize> {
        let mut all: Vec<usize> = match self {
            Self::Always(generator) => vec![*generator],
            Self::ByIndex(entries) => entries.clone(),
            Self::ByCondition { cases, otherwise } => cases
                .iter()
                .map(|(_, generator)| *generator)
                .chain([*otherwise])
                .collect(),
            Self::AtRandom(entries) => entries
                .iter()
                .filter(|(weight, _)| *weight > 0.0)
                .map(|(_, generator)| *generator)
                .collect(),
        };
        let mut seen = Vec::new();
        all.retain(|generator| {
            let new = !seen.contains(generator);
            seen.push(*generator);
            new
        });
        all
    }

    pub(crate) fn programs(&self) -> impl Iterator<Item = &Program> {
        let cases = match self {
            Self::ByCondition { cases, .. } => cases.as_slice(),
            _ => &[],
        };
        cases.iter().map(|(condition, _)| condition)
    }
}

/// (index − 1) mod count, for an index from 1.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "an index is a whole number from 1"
)]
fn remainder(index: f64, count: usize) -> usize {
    (index as u64 - 1) as usize % count
}
