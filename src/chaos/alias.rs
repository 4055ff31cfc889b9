//! Weighted random choice from one random word, by the alias method.

use super::lookup::{ENTRIES, LookUp};
use super::random::LANES;

/// An alias table: chooses by weight in constant time, without a branch (Walker 1977, in the construction of
/// Vose 1991).
#[derive(Clone, Debug)]
pub(super) struct AliasTable {
    /// Number of upper bits of a word that choose an entry.
    bits: u32,
    entries: Vec<Entry>,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    /// Threshold: where the rest of the word, as a fraction of 2³², lies below it, the entry's own index is
    /// chosen.
    rest: u32,
    /// Index that is chosen otherwise.
    alias: u32,
}

/// One row of an alias table of few entries, from which several choices are made at once.
#[derive(Clone, Copy)]
pub(super) struct FewAliases {
    bits: u32,
    rests: [u32; ENTRIES],
    aliases: [u32; ENTRIES],
}

impl FewAliases {
    /// Chooses as [`AliasTable::choose`] does, for all walkers. Every line is for all of them at once, so that it can be
    /// vectorised; `look_up` looks entries up.
    #[inline(always)]
    pub(super) fn choose(&self, words: &[u32; LANES], look_up: impl LookUp) -> [u32; LANES] {
        let mut own = [0; LANES];
        for lane in 0..LANES {
            own[lane] = words[lane] >> (32 - self.bits);
        }
        let (rests, aliases) = (look_up(&self.rests, &own), look_up(&self.aliases, &own));
        let mut chosen = [0; LANES];
        for lane in 0..LANES {
            let keeps = (words[lane] << self.bits) < rests[lane];
            chosen[lane] = if keeps { own[lane] } else { aliases[lane] };
        }
        chosen
    }
}

impl AliasTable {
    /// Returns the first row, if it has few entries.
    pub(super) fn few(&self) -> Option<FewAliases> {
        let row = self.entries.get(..1 << self.bits)?;
        if row.len() > ENTRIES {
            return None;
        }
        let mut few = FewAliases {
            bits: self.bits,
            rests: [0; ENTRIES],
            aliases: [0; ENTRIES],
        };
        for (place, entry) in row.iter().enumerate() {
            few.rests[place] = entry.rest;
            few.aliases[place] = entry.alias;
        }
        Some(few)
    }

    /// Creates tables for rows of weights, all of one length and none all zero, one after the other.
    /// Probabilities are exact to 2⁻³² times the number of weights.
    pub(super) fn of_rows(rows: &[Vec<f64>]) -> Self {
        let count = rows.first().map_or(0, Vec::len);
        // At least two entries, for a word cannot be shifted by all of its bits.
        let bits = count.next_power_of_two().trailing_zeros().max(1);
        let entries = rows.iter().flat_map(|row| entries(row, 1 << bits));
        Self {
            bits,
            entries: entries.collect(),
        }
    }

    /// Chooses from a row.
    #[inline(always)]
    pub(super) fn choose(&self, row: usize, word: u32) -> usize {
        let own = word >> (32 - self.bits);
        let Entry { rest, alias } = self.entries[(row << self.bits) + own as usize];
        // A branch would be mispredicted at random.
        let keeps = u32::from((word << self.bits) < rest).wrapping_neg();
        (alias ^ ((alias ^ own) & keeps)) as usize
    }
}

/// Returns the entries of a row of weights, padded to `count` entries.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "indices are small, and chances lie between 0 and 1"
)]
fn entries(weights: &[f64], count: usize) -> Vec<Entry> {
    let total: f64 = weights.iter().sum();
    let mut chances: Vec<f64> = weights
        .iter()
        .map(|weight| weight / total * count as f64)
        .collect();
    chances.resize(count, 0.0);
    let mut entries: Vec<Entry> = (0..count as u32)
        .map(|alias| Entry { rest: 0, alias })
        .collect();
    let (mut poor, mut rich): (Vec<_>, Vec<_>) = (0..count).partition(|&own| chances[own] < 1.0);
    while let (Some(&own), Some(&giver)) = (poor.last(), rich.last()) {
        poor.pop();
        entries[own] = Entry {
            rest: (chances[own] * 2f64.powi(32)) as u32,
            alias: giver as u32,
        };
        chances[giver] -= 1.0 - chances[own];
        if chances[giver] < 1.0 {
            rich.pop();
            poor.push(giver);
        }
    }
    // The remaining entries are full up to rounding, and keep themselves as alias. One without a weight
    // remains by rounding only, and gets the heaviest as alias.
    let heaviest = (0..weights.len()).fold(0, |heaviest, own| {
        if weights[own] > weights[heaviest] {
            own
        } else {
            heaviest
        }
    });
    for own in poor {
        if weights.get(own).is_none_or(|&weight| weight == 0.0) {
            entries[own].alias = heaviest as u32;
        }
    }
    entries
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chaos::lookup;

    /// Returns the probability of every choice, summed over the table's entries.
    fn chances(table: &AliasTable, row: usize, count: usize) -> Vec<f64> {
        let mut chances = vec![0.0; count];
        for entry in 0..1usize << table.bits {
            let Entry { rest, alias } = table.entries[row << table.bits | entry];
            let own = f64::from(rest) / 2f64.powi(32);
            if own > 0.0 {
                chances[entry] += own;
            }
            chances[alias as usize] += 1.0 - own;
        }
        let all = f64::from(1u32 << table.bits);
        chances.iter().map(|chance| chance / all).collect()
    }

    #[test]
    fn few_aliases_choose_alike() {
        let weights: Vec<f64> = (1..=20).map(f64::from).collect();
        let table = AliasTable::of_rows(&[weights]);
        let mut word = 0_u32;
        for _ in 0..30 {
            let words: [u32; LANES] = std::array::from_fn(|_| {
                word = word.wrapping_add(2_654_435_761);
                word
            });
            let chosen = table.few().unwrap().choose(&words, lookup::one_by_one);
            for (word, chosen) in words.into_iter().zip(chosen) {
                assert_eq!(table.choose(0, word), chosen as usize);
            }
        }
        assert!(AliasTable::of_rows(&[vec![1.0; 33]]).few().is_none());
    }

    #[test]
    fn chances_are_the_weights() {
        let rows = [
            vec![0.01, 0.85, 0.07, 0.07],
            vec![1.0, 1.0, 1.0, 1.0],
            vec![0.0, 0.0, 5.0, 0.0],
            vec![1e-6, 0.0, 0.0, 3.0],
        ];
        let table = AliasTable::of_rows(&rows);
        for (index, row) in rows.iter().enumerate() {
            let total: f64 = row.iter().sum();
            for (chance, weight) in chances(&table, index, 4).iter().zip(row) {
                assert!((chance - weight / total).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn what_has_no_weight_is_never_chosen() {
        for count in [1, 2, 3, 5, 7, 12] {
            for only in 0..count {
                let mut weights = vec![0.0; count];
                weights[only] = 0.3;
                let table = AliasTable::of_rows(&[weights]);
                for word in [0, 1, 1 << 27, 1 << 31, u32::MAX - 1, u32::MAX] {
                    assert_eq!(table.choose(0, word), only);
                }
                assert_eq!(chances(&table, 0, count)[only], 1.0);
            }
        }
    }
}
