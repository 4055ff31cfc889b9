//! Choice of copies that cover the shape together.

use crate::random::Pcg;

use super::copies::Copy;

/// Copies that cover a shape, by their numbers in the lists of the slots.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::fit) struct Cover {
    pub(in crate::fit) copies: Vec<usize>,
    /// Uncovered points of the sample, and the errors and overlaps of the copies as a number of points.
    pub(in crate::fit) cost: f64,
}

/// Chooses a copy for each slot from the slot's own list, by exchange: from a random start each copy is replaced by the
/// one that lowers the cost most, until none does. Returns `None` if a list is empty.
pub(in crate::fit) fn choose(slots: &[&[&Copy]], points: usize, random: &mut Pcg) -> Option<Cover> {
    if slots.iter().any(|list| list.is_empty()) {
        return None;
    }
    let words = points.div_ceil(64);
    let drawn = 1 + slots.len() / 4;
    let mut chosen: Vec<usize> = Vec::new();
    for (slot, list) in slots.iter().enumerate() {
        // The first copies are drawn, the others are greedy.
        let place = if slot < drawn {
            pick(random, list.len())
        } else {
            best(list, &union(slots, &chosen, None, words), points).0
        };
        chosen.push(place);
    }
    let mut cost = f64::INFINITY;
    for _ in 0..20 {
        let before = cost;
        for (slot, list) in slots.iter().enumerate() {
            let others = union(slots, &chosen, Some(slot), words);
            let (place, here) = best(list, &others, points);
            let rest = chosen
                .iter()
                .enumerate()
                .filter(|(number, _)| *number != slot);
            let rest: f64 = rest
                .map(|(number, &other)| slots[number][other].price)
                .sum();
            if here + rest < cost - 1e-9 {
                cost = here + rest;
                chosen[slot] = place;
            }
        }
        if cost >= before {
            break;
        }
    }
    Some(Cover {
        copies: chosen,
        cost,
    })
}

/// Returns a random number below a limit.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "the limit is small"
)]
pub(in crate::fit) fn pick(random: &mut Pcg, limit: usize) -> usize {
    (random.unit() * limit as f64) as usize
}

/// Returns the copy that lowers the cost most beside others that cover some points, and the cost with it.
#[expect(clippy::cast_precision_loss, reason = "samples are small")]
fn best(copies: &[&Copy], covered: &[u64], points: usize) -> (usize, f64) {
    let mut best = (0, f64::INFINITY);
    for (number, copy) in copies.iter().enumerate() {
        let both = copy
            .covered
            .iter()
            .zip(covered)
            .map(|(a, b)| (a | b).count_ones());
        let left = points as f64 - f64::from(both.sum::<u32>());
        let cost = left + copy.price;
        if cost < best.1 {
            best = (number, cost);
        }
    }
    best
}

/// Returns the points that copies cover, except for one of them.
fn union(slots: &[&[&Copy]], chosen: &[usize], except: Option<usize>, words: usize) -> Vec<u64> {
    let mut union = vec![0; words];
    for (slot, &number) in chosen.iter().enumerate() {
        if Some(slot) != except {
            let pairs = union.iter_mut().zip(&slots[slot][number].covered);
            pairs.for_each(|(all, word)| *all |= word);
        }
    }
    union
}
