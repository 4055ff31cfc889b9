//! Pairs of pieces under any affine maps.

use super::disc::Centred;
use super::{Budget, Meeting};
use crate::geometry::{DAffine2, stretch};

/// Descent over pairs of pieces, with its memory.
#[derive(Clone, Debug, Default)]
pub(super) struct Pieces {
    stack: Vec<[Piece; 2]>,
}

/// Piece of the attractor: its image under a composition of maps.
#[derive(Clone, Copy, Debug)]
struct Piece {
    map: DAffine2,
    stretch: f64,
    /// Number of maps in the composition.
    length: u32,
}

impl Piece {
    fn of(map: DAffine2, length: u32) -> Self {
        Self {
            map,
            stretch: stretch(&map.matrix2),
            length,
        }
    }
}

impl Pieces {
    /// Returns whether the pieces of two maps meet.
    pub(super) fn meeting(
        &mut self,
        maps: &Centred,
        pair: [usize; 2],
        depth: u32,
        budget: &mut Budget,
    ) -> Meeting {
        // Each map of both compositions moves a centre, with its error.
        let margin = maps.error * f64::from(2 * depth);
        let are_apart = |[one, other]: &[Piece; 2]| {
            let between = (one.map.translation - other.map.translation).length();
            let reach = (one.stretch + other.stretch) * maps.radius;
            between > reach * (1.0 + 1e-12) + margin
        };
        let start = pair.map(|map| Piece::of(maps.maps[map], 1));
        let mut deepest = 1;
        if are_apart(&start) {
            return Meeting::Apart(deepest);
        }
        self.stack.clear();
        self.stack.push(start);
        while let Some(pair) = self.stack.pop() {
            let number = larger(&pair);
            let divided = pair[number];
            if divided.length == depth {
                return Meeting::Unknown;
            }
            let length = divided.length + 1;
            deepest = deepest.max(length);
            for map in &maps.maps {
                let Some(left) = budget.checked_sub(1) else {
                    return Meeting::Exceeded;
                };
                *budget = left;
                let mut smaller = pair;
                smaller[number] = Piece::of(divided.map * *map, length);
                if !are_apart(&smaller) {
                    self.stack.push(smaller);
                }
            }
        }
        Meeting::Apart(deepest)
    }
}

/// Returns the number of the larger piece; of equally large ones, that with fewer maps.
fn larger([first, second]: &[Piece; 2]) -> usize {
    const EQUAL: f64 = 1e-9;
    let is_second = match second.stretch / first.stretch {
        ratio if (ratio - 1.0).abs() <= EQUAL => second.length < first.length,
        // Two points have no ratio.
        ratio if ratio.is_nan() => second.length < first.length,
        ratio => ratio > 1.0,
    };
    usize::from(is_second)
}
