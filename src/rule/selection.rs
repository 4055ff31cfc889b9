//! Selection of the generator for a fertile element: by index, by condition or by weight.

use crate::expression::Program;
use crate::fast_hash::FastSet;

use super::generator::ElementContext;
use crate::draws::{Path, pick_by_weight};

/// Selection of the generator for a fertile element that does not name its own.
#[derive(Clone, Debug, PartialEq)]
pub enum Selection {
    /// One generator for all elements.
    Always(usize),
    /// By index: element i takes entry (i − 1) mod m of the m entries (Kaandorp 1987, figure 13).
    ByIndex(Vec<usize>),
    /// By condition: the first case that holds, or the last entry, which has no condition (Kaandorp 1987,
    /// figure 6).
    ByCondition {
        /// Conditions in the order in which they are tried.
        cases: Vec<(Program, usize)>,
        /// Generator if no condition holds.
        otherwise: usize,
    },
    /// At random, by weight.
    AtRandom(Vec<(f64, usize)>),
}

impl Selection {
    /// Returns the number of the generator for an element.
    #[inline]
    #[must_use]
    pub fn select(&self, moment: &ElementContext, path: Path) -> usize {
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

    /// Returns the generators that can be selected, each once, in the order of listing.
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
        let mut seen = FastSet::default();
        all.retain(|generator| seen.insert(*generator));
        all
    }

    /// Returns the number of generators that are looked at to select one, at most; one with a long condition counts as several.
    pub(crate) fn choices(&self) -> usize {
        match self {
            Self::Always(_) | Self::ByIndex(_) => 1,
            Self::ByCondition { cases, .. } => {
                let conditions = cases.iter().map(|(condition, _)| 1 + condition.work());
                1 + conditions.sum::<usize>()
            }
            Self::AtRandom(entries) => entries.len(),
        }
    }

    pub(crate) fn programs(&self) -> impl Iterator<Item = &Program> {
        let cases = match self {
            Self::ByCondition { cases, .. } => cases.as_slice(),
            _ => &[],
        };
        cases.iter().map(|(condition, _)| condition)
    }
}

/// Computes (index − 1) mod count, for an index from 1.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "an index is a whole number from 1"
)]
fn remainder(index: f64, count: usize) -> usize {
    (index as u64 - 1) as usize % count
}
