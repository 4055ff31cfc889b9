//! Culling: the visible part of an approximant, by the size of elements and by the window.

use std::sync::Arc;

use crate::geometry::{Bounds, DVec2};
use crate::graph::{Chain, Graph, Object, Replacement};
use crate::grow::{Enter, Growth, Subtree};
use crate::rule::Part;
use crate::style::{Cap, ColorBy, Join, Style, Width};

use super::classes::Classes;
use super::paint::relative_overhang;

#[cfg(test)]
mod runs;
#[cfg(test)]
mod tests;

/// Maximum number of steps for which lengths are tabulated.
const MAX_POWERS: usize = 1 << 10;

/// Ratio above which lengths count as equal, since they differ by rounding only.
pub(super) const NEARLY: f64 = 1.0 - 1e-9;

/// Culling of the walks for a picture.
#[derive(Clone, Debug)]
pub(super) struct Culling {
    /// Length of frames below which elements are not replaced, in multiples of [`Graph::unit`].
    shortest: f64,
    window: Option<VisibleRegion>,
    /// By object, whether it is replaced regardless of its size; empty if no object is.
    is_whole: Arc<[bool]>,
    /// By number of steps, upper bound of the lengths of an element's descendants, as a multiple of its
    /// length; empty if no descendant becomes too short.
    longest: Arc<[f64]>,
}

/// Visible part of the plane.
#[derive(Clone, Debug)]
struct VisibleRegion {
    bounds: Bounds,
    /// Part of the plane within which subtrees are replaced whole: that of the picture, of which the bounds may be a part.
    whole: Bounds,
    /// Padding of the bounds around the part that is shown.
    pad: f64,
    /// By object, radius of its subtree about the centre of its frame.
    reaches: Arc<[f64]>,
    /// Centre of every unit frame.
    middle: DVec2,
    /// Treatment of elements whose descendants all lie outside.
    outside: Enter,
}

impl Culling {
    /// Returns a sight without culling.
    pub(super) fn unbounded() -> Self {
        Self {
            shortest: 0.0,
            window: None,
            is_whole: Arc::new([]),
            longest: Arc::new([]),
        }
    }

    /// Returns a sight that does not replace elements shorter than `shortest`, in the rule's units, unless
    /// they lead to seeds that are placed as the initiator, whose size does not depend on theirs.
    pub(super) fn to_length(graph: &Graph, shortest: f64) -> Self {
        Self {
            shortest: NEARLY * shortest / graph.unit(),
            window: None,
            is_whole: if shortest > 0.0 {
                graph.resets().into()
            } else {
                Arc::new([])
            },
            longest: longest(graph, shortest),
        }
    }

    /// Restricts the sight to a part of the plane. Returns it unchanged if the graph does not bound its
    /// subtrees, or if elements outside affect those inside. Ranks do not if they `are_counted` regardless of
    /// the elements that are visited.
    pub(super) fn within(
        self,
        bounds: &Bounds,
        graph: &Graph,
        growth: &Growth<'_>,
        style: &Style,
        are_counted: bool,
    ) -> Self {
        let Some(outside) = outside(graph, style, are_counted) else {
            return self;
        };
        let reaches = graph.reaches(|object| own_reach(graph, object, style));
        let pad = self.links(graph, growth);
        if !pad.is_finite() || reaches.iter().all(|reach| reach.is_infinite()) {
            return self;
        }
        let window = VisibleRegion {
            bounds: padded(bounds, pad),
            whole: padded(bounds, pad),
            pad,
            reaches: reaches.into(),
            middle: graph.middle(),
            outside,
        };
        Self {
            window: Some(window),
            ..self
        }
    }

    /// Returns an upper bound of the length of lines that link elements.
    pub(super) fn links(&self, graph: &Graph, growth: &Growth<'_>) -> f64 {
        links(graph, graph.longest_after(growth.steps).max(self.shortest))
    }

    /// Restricts the sight to a part of the window, if it has one. Runs remain those of the whole window.
    pub(super) fn moved_to(&self, bounds: &Bounds) -> Self {
        let mut moved = self.clone();
        if let Some(window) = &mut moved.window {
            window.bounds = padded(bounds, window.pad);
        }
        moved
    }

    /// Returns whether walks may leave out elements outside a window.
    pub(super) fn is_bounded(&self) -> bool {
        self.window.is_some()
    }

    /// Returns whether walks may leave out any elements.
    pub(super) fn cuts(&self) -> bool {
        self.shortest > 0.0 || self.window.is_some()
    }

    /// Returns the length below which walks replace no elements, if they may leave out any.
    pub(super) fn shortest(&self) -> Option<f64> {
        self.cuts().then_some(self.shortest)
    }

    /// Returns whether an element is too short to be replaced, if it leads to no seeds that are placed as the
    /// initiator.
    #[inline]
    pub(super) fn is_short(&self, length: f64) -> bool {
        length < self.shortest
    }

    /// Returns whether a descendant of an element of a given length may be long enough to be replaced after
    /// `steps` steps.
    #[inline]
    pub(super) fn lasts(&self, length: f64, steps: u32) -> bool {
        let longest = self.longest.get(steps as usize).or(self.longest.last());
        longest.is_none_or(|longest| length * longest >= self.shortest)
    }

    /// Returns what a walk does with a replaceable element.
    #[inline]
    pub(super) fn enter(&self, subtree: &Subtree) -> Enter {
        if !self.cuts() {
            return Enter::Replace;
        }
        let length = subtree.frame.stretch();
        let entered = match &self.window {
            Some(window) => window.enter(subtree, length),
            None => Enter::Replace,
        };
        let replaces = matches!(entered, Enter::Replace | Enter::Divide);
        if replaces && self.is_short(length) && self.is_whole.get(subtree.object) != Some(&true) {
            return Enter::Keep;
        }
        entered
    }
}

fn padded(bounds: &Bounds, pad: f64) -> Bounds {
    Bounds::new(bounds.min() - pad, bounds.max() + pad)
}

impl VisibleRegion {
    /// Returns what a walk does with an element by its place.
    #[inline]
    fn enter(&self, subtree: &Subtree, length: f64) -> Enter {
        // Slack for rounding, so that subtrees which just touch the edge stay visible.
        const SLACK: f64 = 1.0 + 1e-9;
        let middle = subtree.frame.apply(self.middle);
        let nearest = middle.clamp(self.bounds.min(), self.bounds.max());
        let reach = self.reaches[subtree.object] * length * SLACK;
        if middle.distance_squared(nearest) > reach * reach {
            return self.outside;
        }
        let [least, most] = [self.whole.min(), self.whole.max()];
        let is_inside = (middle - reach).cmpge(least) & (middle + reach).cmple(most);
        if is_inside.all() {
            Enter::Replace
        } else {
            Enter::Divide
        }
    }
}

/// Returns, by number of steps, an upper bound of the lengths of an element's descendants, as a multiple of
/// its length; empty if length does not decide which elements are replaced.
fn longest(graph: &Graph, shortest: f64) -> Arc<[f64]> {
    // Slack for rounding, so that descendants of the limiting length are kept.
    const SLACK: f64 = 1.0 + 1e-9;
    let ratio = graph.longest_child() * SLACK;
    if shortest <= 0.0 || ratio >= 1.0 {
        return Arc::new([]);
    }
    let powers = std::iter::successors(Some(SLACK), |power| Some(power * ratio));
    powers.take(MAX_POWERS).collect()
}

/// Returns the treatment of elements outside the window; `None` if they are to be replaced nevertheless.
fn outside(graph: &Graph, style: &Style, are_counted: bool) -> Option<Enter> {
    // Ranks and numbers of fractals depend on the elements that are visited.
    let are_numbered = match style.color_by {
        ColorBy::Index => !are_counted,
        ColorBy::Fractal => true,
        _ => false,
    };
    if are_numbered || graph.counts_index() {
        return None;
    }
    let is_open = |object: &Object| !graph.base_elements()[object.base_element].is_closed();
    if !graph.objects().iter().any(is_open) || !starts_rings(graph) {
        return Some(Enter::Skip);
    }
    // Where a closed path is broken, its two ends may be visible: caps must look like the corner.
    let seam_shows = style.cap != Cap::Round || style.join != Join::Round;
    if style.fill.is_none() && !seam_shows {
        return Some(Enter::Skip);
    }
    // Outside the window an outline may take any path from one end to the other: the winding numbers inside
    // are unchanged. It stays in one piece if the elements of other approximants on that path are of the same
    // class.
    let stays_whole = Classes::before_survey(style, graph, 0).keep_fractals_whole();
    (graph.keeps_lines() && (stays_whole || !seam_shows)).then_some(Enter::Keep)
}

/// Returns the radius, about the centre of its unit frame, of a disc that contains an element with its
/// stroke.
pub(super) fn own_reach(graph: &Graph, object: &Object, style: &Style) -> f64 {
    let stroke = match style.width {
        Width::Relative(width) => {
            width * graph.widest().unwrap_or(1.0) * graph.unit() * relative_overhang(style)
        }
        Width::Pixels(_) => 0.0,
    };
    graph.outline_radius(object) + stroke
}

/// Returns whether a fractal may be a closed chain.
pub(super) fn starts_rings(graph: &Graph) -> bool {
    graph.starts().any(Chain::is_ring)
        || graph
            .objects()
            .iter()
            .any(|object| match &object.replacement {
                Replacement::Fixed(production) => {
                    production.seeds.iter().any(|seed| seed.chain.is_ring())
                }
                Replacement::Evaluated(alternatives) => alternatives.iter().any(|alternative| {
                    let mut seeds = graph
                        .parts(alternative)
                        .iter()
                        .filter(|part| part.placement.seeds());
                    let is_ring = |part: &Part| part.elements.first().is_some_and(|e| e.joined);
                    seeds.any(is_ring)
                }),
                Replacement::Kept | Replacement::Unresolved => false,
            })
}

/// Returns an upper bound of the length of the lines that link base elements which do not run from end to end
/// of their frames: from a visible element to one outside. `longest` is the length of the longest element
/// that could still be replaced.
fn links(graph: &Graph, longest: f64) -> f64 {
    let mut farthest = 0.0;
    for object in graph.objects() {
        let base_element = &graph.base_elements()[object.base_element];
        if !object.visible || base_element.is_closed() || !graph.joins() {
            continue;
        }
        let (start, _) = base_element.outline(false);
        let (end, _) = base_element.outline(true);
        let link = f64::max(start.length(), end.distance(DVec2::X));
        // Elements that are kept may have any length.
        let length = match object.replacement {
            _ if link == 0.0 => continue,
            Replacement::Kept => f64::INFINITY,
            _ => longest,
        };
        farthest = f64::max(farthest, link * length);
    }
    farthest
}
