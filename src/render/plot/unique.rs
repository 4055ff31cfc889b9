//! Removal of repeated edges.

use crate::fast_hash::FastSet;

use super::points::Point;
use super::strokes::Strokes;
use super::tree::Tree;

/// Filter that removes edges that have been drawn.
///
/// Edges coincide if they have equal ends, or if they overlap along a line: an edge is split at the points
/// that lie on it, and every piece is drawn once.
pub(super) struct Unique<'a> {
    places: &'a [[i32; 2]],
    tree: Tree,
    drawn: FastSet<u64>,
    /// Number of pieces that have been removed.
    pub(super) repeated: u64,
    pieces: Vec<(f64, Point)>,
}

impl<'a> Unique<'a> {
    pub(super) fn new(places: &'a [[i32; 2]]) -> Self {
        let items = (0..).zip(places).map(|(item, &place)| (place, item));
        Self {
            places,
            tree: Tree::new(items.collect()),
            drawn: FastSet::default(),
            repeated: 0,
            pieces: Vec::new(),
        }
    }

    /// Appends to `kept` the parts of a stroke that have not been drawn.
    pub(super) fn add(&mut self, stroke: &[Point], kept: &mut Strokes) {
        kept.begin(stroke[0]);
        for edge in stroke.windows(2) {
            let [from, to] = [edge[0], edge[1]];
            let line = [from, to].map(|point| self.places[point as usize]);
            self.tree.between(line, &mut self.pieces);
            self.pieces.push((1.0, to));
            let (mut at, before) = (from, self.repeated);
            let mark = kept.mark();
            for &(_, next) in &self.pieces {
                let ends = [at.min(next), at.max(next)].map(u64::from);
                if self.drawn.insert(ends[0] << 32 | ends[1]) {
                    kept.go_on(next);
                } else {
                    self.repeated += 1;
                    kept.begin(next);
                }
                at = next;
            }
            if self.repeated == before {
                // A complete edge is not split.
                kept.go_back(mark);
                kept.go_on(to);
            }
        }
        kept.end();
    }
}
