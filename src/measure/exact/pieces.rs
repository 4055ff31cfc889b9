//! Sets whose pieces coincide, rewritten as sets of distinct pieces for their natural measure.

use crate::digraph::{components, count};
use crate::geometry::{Affine, DAffine3};
use crate::measure::copies::{Copies, Copy};

use super::Effort;
use super::hull::Flat;
use super::neighbours::{End, Neighbours};
use super::sizes::Generations;
use super::system::GraphDirectedSystem;
use super::types::Types;

/// Rewrites sets whose pieces coincide as sets of distinct pieces, where pieces are of finitely many types:
/// there is a set for every type (Ngai & Wang 2001). The sets keep their numbers.
///
/// Sets are unchanged where pieces are of too many types, or where a set holds copies of others that do not
/// hold copies of it.
pub(in crate::measure) fn distinct<M: Affine>(copies: Copies<M>) -> Copies<M> {
    let mut targets = vec![Vec::new(); copies.size];
    for copy in &copies.copies {
        targets[copy.from].push(copy.to);
    }
    let component = components(&targets);
    let count = count(&component);
    let mut distinct = Copies {
        copies: Vec::new(),
        ..copies.clone()
    };
    for part in 0..count {
        let all = copies.copies.iter();
        let own: Vec<Copy<M>> = all
            .filter(|copy| component[copy.from] == part)
            .copied()
            .collect();
        let sets = (0..copies.size).filter(|&set| component[set] == part);
        let sets: Vec<usize> = sets.collect();
        let is_closed = !own.is_empty() && own.iter().all(|copy| component[copy.to] == part);
        let pieces = is_closed
            .then(|| pieces(&sets, &own, distinct.size))
            .flatten();
        match pieces {
            Some((size, pieces)) => {
                distinct.size = size;
                distinct.copies.extend(pieces);
            }
            None => distinct.copies.extend(own),
        }
    }
    distinct
}

/// Returns the number of sets including the new ones, and the copies of types that the sets are made of;
/// `None` where no pieces coincide, or where they are of too many types.
fn pieces<M: Affine>(
    sets: &[usize],
    copies: &[Copy<M>],
    size: usize,
) -> Option<(usize, Vec<Copy<M>>)> {
    // The sets are in increasing order.
    let number = |set: usize| sets.binary_search(&set).unwrap_or(0);
    let inside = copies.iter();
    let inside = inside.map(|copy| (number(copy.from), number(copy.to), copy.map));
    let system = GraphDirectedSystem::of_maps(inside).filter(GraphDirectedSystem::shrinks)?;
    let flat = Flat::of(&system);
    let generations = Generations::of(&flat)?;
    let neighbours = Neighbours::of(&generations, Effort::Full);
    if !neighbours.coincide.contains(&true) || neighbours.end != End::Complete {
        return None;
    }
    let types = Types::of(&generations, &neighbours, Effort::Full)?;
    let of_type = |kind: usize| match sets.get(kind) {
        Some(&set) => set,
        None => size + kind - sets.len(),
    };
    let frame = |set: usize| {
        let scale = DAffine3::from_scale(glam::DVec3::splat(1.0 / generations.scale[set]));
        flat.frames[set] * scale
    };
    let mut pieces = Vec::new();
    for (kind, (piece, kept)) in types.kept.iter().enumerate() {
        let steps = generations.steps(*piece);
        for &(step, to) in kept {
            let step = &steps[step];
            let map = frame(piece.set) * step.map * frame(step.piece.set).inverse();
            pieces.push(Copy {
                from: of_type(kind),
                to: of_type(to),
                map: M::of_space(&map),
            });
        }
    }
    Some((size + types.kept.len() - sets.len(), pieces))
}
