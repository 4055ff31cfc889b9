//! Outlines of an approximant as shapes.

use crate::geometry::{DVec2, Frame2};
use crate::graph::Graph;
use crate::rule::{BaseElement, Piece};

use super::{Element, FractalInfo, Growth, Visitor, WalkError, walk};

/// Computes the outlines of an approximant that is placed in a frame. Elements that join form one open
/// outline; closed base elements form closed ones. If `fills` is set, a fractal that is a closed path forms
/// one closed outline.
///
/// # Errors
///
/// Returns an error if the walk ends early, if there are more than `most` pieces, or if a point is not
/// finite.
pub(crate) fn outlines(
    graph: &Graph,
    growth: &Growth<'_>,
    frame: Frame2,
    fills: bool,
    most: usize,
) -> Result<Vec<BaseElement>, WalkError<OutlineError>> {
    let mut outliner = Outliner {
        graph,
        frame,
        fills,
        left: most,
        is_ring: false,
        lines: Vec::new(),
        done: Vec::new(),
    };
    walk(graph, growth, &mut outliner)?;
    Ok(outliner.done)
}

/// Error of [`outlines`].
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub(crate) enum OutlineError {
    /// The number of pieces exceeds the limit.
    #[error("there are too many lines")]
    TooMany,
    /// A point is not finite.
    #[error("a line leads beyond all numbers")]
    NotFinite,
}

struct Outliner<'g> {
    graph: &'g Graph,
    frame: Frame2,
    fills: bool,
    /// Number of pieces that may still be added.
    left: usize,
    is_ring: bool,
    /// Lines of the current fractal; the next element may continue the last one.
    lines: Vec<Chain>,
    done: Vec<BaseElement>,
}

/// Elements that join.
struct Chain {
    start: DVec2,
    pieces: Vec<Piece>,
    /// Whether its first element joins the preceding element.
    joined: bool,
    /// Whether its last element ends at the end point of its frame.
    meets_end: bool,
}

impl Visitor for Outliner<'_> {
    type Error = OutlineError;

    fn begin(&mut self, fractal: FractalInfo) -> Result<(), OutlineError> {
        self.is_ring = fractal.is_ring;
        Ok(())
    }

    fn element(&mut self, element: &Element) -> Result<(), OutlineError> {
        let object = &self.graph.objects()[element.object];
        if !object.visible {
            return Ok(());
        }
        let base_element = &self.graph.base_elements()[object.base_element];
        let frame = self.frame.compose(&element.frame);
        let reversed = frame.direction().is_reversed();
        let (start, pieces) = base_element.outline(reversed);
        let left = self.left.checked_sub(pieces.len());
        self.left = left.ok_or(OutlineError::TooMany)?;
        let start = frame.apply(start);
        if !frame.is_finite() || !start.is_finite() {
            return Err(OutlineError::NotFinite);
        }
        let pieces = pieces.iter().map(|piece| piece.transformed(frame.map()));
        if base_element.is_closed() {
            self.done
                .extend(BaseElement::new(start, pieces.collect(), true));
            return Ok(());
        }
        let mut meets = base_element.ends_meet_frame();
        if reversed {
            meets.reverse();
        }
        let [meets_start, meets_end] = meets;
        match self.lines.last_mut().filter(|_| element.joined) {
            Some(line) => {
                if !(line.meets_end && meets_start) {
                    line.pieces.push(Piece::Line(start));
                }
                line.pieces.extend(pieces);
                line.meets_end = meets_end;
            }
            None => self.lines.push(Chain {
                start,
                pieces: pieces.collect(),
                joined: element.joined,
                meets_end,
            }),
        }
        Ok(())
    }

    fn end(&mut self, joined: bool) -> Result<(), OutlineError> {
        let is_closed = self.is_ring && joined && self.lines.len() == 1 && self.lines[0].joined;
        let closes = is_closed && self.fills;
        for mut line in self.lines.drain(..) {
            if is_closed
                && line
                    .pieces
                    .last()
                    .is_some_and(|last| last.end() != line.start)
            {
                line.pieces.push(Piece::Line(line.start));
            }
            if closes {
                self.done
                    .extend(BaseElement::new(line.start, line.pieces, true));
            } else {
                self.done.extend(open(line.start, line.pieces));
            }
        }
        Ok(())
    }
}

/// Returns a path as open outlines, which must not end where they start: a path that returns to its start
/// is split into two, and a path without extent becomes a dot.
fn open(start: DVec2, mut pieces: Vec<Piece>) -> impl Iterator<Item = BaseElement> {
    let before = pieces.len().saturating_sub(1);
    let returns = pieces.last().is_some_and(|last| last.end() == start);
    let mut rest = None;
    if returns && before > 0 {
        let turn = pieces[before - 1].end();
        rest = BaseElement::new(turn, pieces.split_off(before), false);
    }
    let first = BaseElement::new(start, pieces, false).or_else(|| {
        let dot = Piece::Line(DVec2::new(start.x.next_up(), start.y));
        BaseElement::new(start, vec![dot], false)
    });
    first.into_iter().chain(rest)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::catalogue::Catalogue;
    use crate::diagnostic::Source;
    use crate::document::Document;

    fn of(text: &str, steps: u32, fills: bool) -> Vec<BaseElement> {
        let source: Arc<Source> = Source::new("test", text.to_owned());
        let document = Document::read(&source, &Catalogue::embedded()).unwrap();
        let (model, _) = document.resolve(&[]).unwrap();
        let graph = model.compile(steps).unwrap();
        let growth = Growth::steps(steps);
        outlines(&graph, &growth, Frame2::UNIT, fills, 10_000).unwrap()
    }

    #[test]
    fn a_curve_is_one_line() {
        let all = of("{initiator: segment, generator: koch}", 3, false);
        let [line] = &all[..] else {
            panic!("{} outlines", all.len())
        };
        assert!(!line.is_closed());
        assert_eq!((line.start(), line.pieces().len()), (DVec2::ZERO, 64));
    }

    #[test]
    fn a_closed_curve_is_a_line_or_what_it_encloses() {
        let text = "{initiator: triangle, generator: koch}";
        let filled = of(text, 2, true);
        assert!(filled.len() == 1 && filled[0].is_closed());
        assert_eq!(filled[0].pieces().len(), 48);
        let lines = of(text, 2, false);
        let pieces: usize = lines.iter().map(|line| line.pieces().len()).sum();
        assert_eq!((lines.len(), pieces), (2, 48));
        let ends = |line: &BaseElement| [line.start(), line.outline(true).0];
        let ([a, b], [c, d]) = (ends(&lines[0]), ends(&lines[1]));
        assert_eq!([a, b], [d, c]);
    }

    #[test]
    fn polygons_are_closed_and_cups_are_linked() {
        let gasket = of(
            "{initiator: segment, generator: gasket, base_element: triangle}",
            2,
            false,
        );
        assert_eq!(gasket.len(), 9);
        assert!(gasket.iter().all(BaseElement::is_closed));
        let hilbert = of(
            "{initiator: segment, generator: hilbert, base_element: hilbert-cup}",
            1,
            false,
        );
        // Four cups of three lines, and three lines between them.
        assert_eq!((hilbert.len(), hilbert[0].pieces().len()), (1, 15));
    }

    #[test]
    fn infertile_and_invisible_elements_break_lines() {
        let gap = "initiator: segment\ngenerator: [[0, 0], [1/3, 0], {to: [2/3, 0], visible: false, fertile: false}, [1, 0]]";
        assert_eq!(of(gap, 2, false).len(), 4);
    }
}
