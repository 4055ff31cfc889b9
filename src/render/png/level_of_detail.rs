//! Level of detail of outlines: base elements simplified to straight lines, as fine as a surface can show.

use std::sync::OnceLock;

use crate::geometry::{Bounds, DVec2, distance_to_segment};
use crate::graph::Graph;
use crate::render::paint::FINE;
use crate::rule::{BaseElement, Piece};

use super::coverage::{bounding_within, flattened_within};

/// Maximum number of straight sides of an outline that is not simplified.
const FEW_SIDES: usize = 8;

/// Deviation that outlines are permitted, in pixels: twice that of rounding.
const GRAIN: f64 = 1.0 / FINE;

/// Number of tolerances: powers of 1/2 from 1 down, in units of the graph.
const LEVELS: usize = 16;

/// Maximum number of tolerances, each half of the one before, with which a closed curve is simplified.
const MAX_TRIES: u32 = 8;

/// Simplified outlines of base elements, by tolerance.
pub(in crate::render) struct LevelOfDetail {
    /// Corners by base element and tolerance; `None` for base elements that are not simplified.
    outlines: Vec<Option<[OnceLock<Vec<DVec2>>; LEVELS]>>,
}

impl LevelOfDetail {
    /// Creates the simplified outlines of a graph; `None` if no base element needs them.
    pub(super) fn of(graph: &Graph) -> Option<Self> {
        let levels =
            |base_element| is_fine(base_element).then(|| std::array::from_fn(|_| OnceLock::new()));
        let outlines: Vec<_> = graph.base_elements().iter().map(levels).collect();
        let any = outlines.iter().any(Option::is_some);
        any.then_some(Self { outlines })
    }

    /// Returns the corners of a base element, in its unit frame, for frames that stretch a unit to at most
    /// `pixels` pixels. The inside of a closed outline lies to the left; the corners of an open one run from
    /// end to end. `None` if the outline is drawn unchanged: it is simple, or the finest tolerance is
    /// too coarse.
    #[inline]
    pub(in crate::render) fn corners(
        &self,
        graph: &Graph,
        base_element: usize,
        pixels: f64,
    ) -> Option<&[DVec2]> {
        let levels = self.outlines[base_element].as_ref()?;
        let level = doublings(graph.unit() * pixels / GRAIN);
        let corners = levels.get(level)?;
        let made = || {
            #[expect(clippy::cast_precision_loss, reason = "few levels")]
            let tolerance = graph.unit() * libm::exp2(-(level as f64));
            straightened(&graph.base_elements()[base_element], tolerance)
        };
        Some(corners.get_or_init(made))
    }
}

/// Returns the smallest number n with 2ⁿ ≥ `number`, where `number` is not negative.
#[inline]
fn doublings(number: f64) -> usize {
    let (part, exponent) = libm::frexp(number.max(1.0));
    let doublings = if part > 0.5 { exponent } else { exponent - 1 };
    usize::try_from(doublings).unwrap_or(0)
}

/// Returns whether an outline may be simplified.
fn is_fine(base_element: &BaseElement) -> bool {
    let pieces = base_element.pieces();
    let has_curves = pieces.iter().any(|piece| matches!(piece, Piece::Cubic(..)));
    has_curves || pieces.len() > FEW_SIDES
}

/// Returns the corners of lines within a tolerance of an outline, or within twice that of curves that bound
/// an area.
fn straightened(base_element: &BaseElement, tolerance: f64) -> Vec<DVec2> {
    let has_curves = |piece: &Piece| matches!(piece, Piece::Cubic(..));
    let is_curved = base_element.pieces().iter().any(has_curves);
    let corners = match (is_curved, base_element.is_closed()) {
        (true, true) => {
            let fine = flat(base_element, tolerance / 4.0);
            let area = base_element.signed_area();
            let finer = |halvings| 1.25 * tolerance / f64::from(1 << halvings);
            let mut thin = (0..MAX_TRIES).map(|halvings| thinned(&fine, finer(halvings)));
            let swollen = thin.find_map(|thin| swollen(thin, area, tolerance));
            // A few long curves may need fewer chords.
            let corners = flat(base_element, 2.0 * tolerance);
            swollen
                .filter(|thin| thin.len() < corners.len())
                .unwrap_or(corners)
        }
        (true, false) => flat(base_element, tolerance),
        (false, _) => thinned(&flat(base_element, tolerance), tolerance),
    };
    turned(base_element, corners)
}

/// Returns the corners of lines along an outline, from its start to its end, within a tolerance of its
/// curves.
fn flat(base_element: &BaseElement, tolerance: f64) -> Vec<DVec2> {
    let mut at = base_element.start();
    let mut corners = vec![at];
    for piece in base_element.pieces() {
        match *piece {
            Piece::Line(end) => corners.push(end),
            Piece::Cubic(a, b, end) => {
                let curve = [at, a, b, end].map(|point| point.to_array());
                if base_element.is_closed() {
                    // Chords deviate equally to both sides, so that they bound the same area.
                    corners.extend(bounding_within(curve, tolerance).map(DVec2::from));
                } else {
                    corners.extend(flattened_within(curve, tolerance).map(DVec2::from));
                }
            }
        }
        at = piece.end();
    }
    corners
}

/// Returns the corners of an outline with the inside to the left; of a closed one without the last corner,
/// which equals the first.
fn turned(base_element: &BaseElement, mut corners: Vec<DVec2>) -> Vec<DVec2> {
    if base_element.is_closed() {
        corners.pop();
        if base_element.signed_area() < 0.0 {
            corners.reverse();
        }
    }
    corners
}

/// Scales a polygon about its centre to a given area; `None` if a corner would move by more than a tolerance.
/// A picture may have millions of polygons, which would visibly lose what the chords cut off.
fn swollen(mut corners: Vec<DVec2>, area: f64, tolerance: f64) -> Option<Vec<DVec2>> {
    let sides = corners.iter().zip(&corners[1..]);
    let own = sides.map(|(a, b)| a.perp_dot(*b)).sum::<f64>() / 2.0;
    let times = (area / own).sqrt();
    let mut bounds = Bounds::EMPTY;
    corners.iter().for_each(|&corner| bounds.add(corner));
    let middle = bounds.min() + bounds.size() / 2.0;
    let moves = (times - 1.0).abs() * bounds.size().length() / 2.0;
    (moves <= tolerance).then(|| {
        for corner in &mut corners {
            *corner = middle + (*corner - middle) * times;
        }
        corners
    })
}

/// Returns the corners of a line, from end to end, without redundant ones: no corner is farther than a
/// tolerance from the side that replaces it (Ramer 1972; Douglas & Peucker 1973).
fn thinned(corners: &[DVec2], tolerance: f64) -> Vec<DVec2> {
    let Some(last) = corners.len().checked_sub(1) else {
        return Vec::new();
    };
    let mut stays = vec![false; corners.len()];
    (stays[0], stays[last]) = (true, true);
    let mut open = vec![(0, last)];
    while let Some((from, to)) = open.pop() {
        let [start, end] = [corners[from], corners[to]];
        let far = |&corner: &usize| distance_to_segment(corners[corner], start, end);
        let farthest = (from + 1..to).max_by(|a, b| far(a).total_cmp(&far(b)));
        if let Some(corner) = farthest.filter(|corner| far(corner) > tolerance) {
            stays[corner] = true;
            open.extend([(from, corner), (corner, to)]);
        }
    }
    let stay = corners.iter().zip(stays).filter(|(_, stays)| *stays);
    stay.map(|(&corner, _)| corner).collect()
}

#[cfg(test)]
mod tests {
    use super::{straightened, thinned};
    use crate::geometry::{DVec2, distance_to_segment};
    use crate::rule::{BaseElement, Piece};

    /// Returns the area of a polygon.
    fn area(corners: &[DVec2]) -> f64 {
        let nexts = corners.iter().cycle().skip(1);
        corners
            .iter()
            .zip(nexts)
            .map(|(a, b)| a.perp_dot(*b))
            .sum::<f64>()
            / 2.0
    }

    #[test]
    fn circles_become_polygons_of_their_area() {
        // The usual approximation of a circle by four curves, with an error below 3e-4.
        let k = 0.552_284_749_8;
        let quarters = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].map(DVec2::from);
        let piece = |number: usize| {
            let (from, to) = (quarters[number], quarters[(number + 1) % 4]);
            Piece::Cubic(from + k * to, to + k * from, to)
        };
        let circle = BaseElement::new(quarters[0], (0..4).map(piece).collect(), true).unwrap();
        let mut before = 0;
        for level in 0..14 {
            let tolerance = libm::exp2(-f64::from(level));
            let corners = straightened(&circle, tolerance);
            let off = |corner: &DVec2| (corner.length() - 1.0).abs();
            assert!(
                corners
                    .iter()
                    .all(|corner| off(corner) <= 2.0 * tolerance + 3e-4)
            );
            let missed = (area(&corners) / std::f64::consts::PI - 1.0).abs();
            assert!(missed <= 0.5 * tolerance + 3e-4, "{missed} at {tolerance}");
            assert!(corners.len() >= before);
            before = corners.len();
        }
        assert!((80..400).contains(&before), "{before}");
    }

    #[test]
    fn open_curves_keep_their_ends() {
        let [start, a, b, end] = [[0.0, 0.0], [0.2, 0.7], [0.8, -0.6], [1.0, 0.0]].map(DVec2::from);
        let curve = BaseElement::new(start, vec![Piece::Cubic(a, b, end)], false).unwrap();
        let finest = straightened(&curve, 1e-7);
        for level in 2..14 {
            let tolerance = libm::exp2(-f64::from(level));
            let corners = straightened(&curve, tolerance);
            assert_eq!([corners[0], corners[corners.len() - 1]], [start, end]);
            for &point in &finest {
                let sides = corners.iter().zip(&corners[1..]);
                let far = sides.map(|(a, b)| distance_to_segment(point, *a, *b));
                assert!(far.fold(f64::INFINITY, f64::min) <= tolerance);
            }
        }
    }

    #[test]
    fn what_is_left_out_lies_within_the_tolerance() {
        let corner = |number: u32| {
            let turn = f64::from(number) / 500.0 * std::f64::consts::TAU;
            let radius = 1.0 + 0.1 * libm::sin(37.0 * turn) + 0.01 * libm::cos(301.0 * turn);
            DVec2::from_angle(turn) * radius
        };
        let corners: Vec<DVec2> = (0..=500).map(corner).collect();
        let mut before = corners.len() + 1;
        for tolerance in [1e-6, 1e-3, 0.02, 0.1, 0.3] {
            let thin = thinned(&corners, tolerance);
            assert!(thin.len() < before, "{tolerance}");
            before = thin.len();
            let sides: Vec<_> = thin.iter().zip(&thin[1..]).collect();
            assert_eq!([thin[0], thin[thin.len() - 1]], [corners[0], corners[500]]);
            for &corner in &corners {
                let far = sides
                    .iter()
                    .map(|(a, b)| distance_to_segment(corner, **a, **b));
                assert!(far.fold(f64::INFINITY, f64::min) <= tolerance);
            }
        }
        assert!(before < 10);
    }
}
