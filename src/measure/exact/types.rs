//! Exact overlaps: distinct pieces are counted by their types (Ngai & Wang 2001).
//!
//! Pieces of a generation are put in order. A piece that comes of several belongs to the first. The
//! type of a piece is the set of those before it that can still take one of its descendants; it
//! decides which of its steps the piece keeps, and of which types they are.

use std::collections::HashMap;

use super::Effort;
use super::neighbours::Neighbours;
use super::sizes::{Generations, Piece};
use super::spectral::spectral_radius;

/// Types, or earlier pieces in all of them, beyond which the count is given up.
const MOST_TYPES: usize = 10_000;
const MOST_EARLIER: usize = 200_000;

/// How distinct pieces multiply.
#[derive(Clone, Debug)]
pub(super) struct Types {
    /// The number of types.
    pub(super) count: usize,
    /// The growth of their number from generation to generation.
    pub(super) growth: f64,
    /// The steps that every type keeps; the first types are those of the sets.
    pub(super) kept: Vec<Kept>,
}

/// The piece of a type, and the steps that it keeps: their number among those of the piece, and their
/// type.
pub(super) type Kept = (Piece, Vec<(usize, usize)>);

/// A piece, and the pairs that it makes with those before it.
type Type = (Piece, Vec<u32>);

impl Types {
    /// `None` where there are too many types.
    ///
    /// Precondition: the search for neighbours is complete.
    pub(super) fn of(
        generations: &Generations,
        neighbours: &Neighbours,
        effort: Effort,
    ) -> Option<Self> {
        let sharing = neighbours.sharing();
        let mut list = List::default();
        for set in 0..generations.size() {
            list.number((Piece { set, wait: 0 }, Vec::new()));
        }
        let mut kept: Vec<Kept> = Vec::new();
        while let Some((piece, before)) = list.types.get(kept.len()).cloned() {
            let steps = steps_of_type(generations, neighbours, &sharing, piece, &before);
            let steps = steps.into_iter();
            let steps = steps.map(|(step, found)| (step, list.number(found)));
            kept.push((piece, steps.collect()));
            let [types, earlier] = [MOST_TYPES, MOST_EARLIER].map(|most| effort.of(most));
            if list.types.len() > types || list.earlier > earlier {
                return None;
            }
        }
        let targets = |(_, steps): &Kept| steps.iter().map(|(_, to)| *to).collect();
        let targets: Vec<Vec<usize>> = kept.iter().map(targets).collect();
        Some(Self {
            count: kept.len(),
            growth: spectral_radius(&targets)?,
            kept,
        })
    }
}

/// Types by number.
#[derive(Default)]
struct List {
    types: Vec<Type>,
    numbers: HashMap<Type, usize>,
    /// Earlier pieces in all of them.
    earlier: usize,
}

impl List {
    fn number(&mut self, found: Type) -> usize {
        *self.numbers.entry(found).or_insert_with_key(|found| {
            self.earlier += found.1.len();
            self.types.push(found.clone());
            self.types.len() - 1
        })
    }
}

/// The numbers and the types of the steps that a piece keeps.
fn steps_of_type(
    generations: &Generations,
    neighbours: &Neighbours,
    sharing: &[bool],
    piece: Piece,
    before: &[u32],
) -> Vec<(usize, Type)> {
    let steps = generations.steps(piece);
    // By step: whether it belongs to an earlier piece, and the pairs that it makes with those.
    let mut kept: Vec<Option<Vec<u32>>> = vec![Some(Vec::new()); steps.len()];
    let siblings = if piece.wait == 0 {
        neighbours.siblings[piece.set].as_slice()
    } else {
        &[]
    };
    let siblings = siblings.iter().filter(|next| next.steps[1] < next.steps[0]);
    let others = before
        .iter()
        .flat_map(|&pair| &neighbours.next[pair as usize]);
    for next in siblings.chain(others) {
        let step = &mut kept[next.steps[0] as usize];
        let pair = next.pair as usize;
        if neighbours.coincide[pair] {
            *step = None;
        } else if let (Some(pairs), true) = (step, sharing[pair]) {
            pairs.push(next.pair);
        }
    }
    let kept = steps.iter().zip(kept).enumerate();
    let kept = kept.filter_map(|(number, (step, pairs))| {
        let mut pairs = pairs?;
        pairs.sort_unstable();
        pairs.dedup();
        Some((number, (step.piece, pairs)))
    });
    kept.collect()
}
