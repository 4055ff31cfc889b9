//! What of an approximant can be seen: how small its elements get, and what lies in the picture.

use std::sync::Arc;

use crate::geometry::{Bounds, DVec2};
use crate::graph::{Chain, Graph, Object, Replacement};
use crate::grow::{Enter, Growth, Subtree};
use crate::rule::Part;
use crate::style::{Cap, ColorBy, Join, Style, Width};

use super::Classes;
use super::survey::relative_overhang;

#[cfg(test)]
mod tests;

/// After more steps than this it is not told how long elements are.
const MOST_POWERS: usize = 1 << 10;

/// Elements that are shorter than others by no more than rounding makes them are as long, as a
/// multiple.
pub(super) const NEARLY: f64 = 1.0 - 1e-9;

/// Where walks for a picture need not go.
#[derive(Clone, Debug)]
pub(super) struct Sight {
    /// Elements whose frames are shorter than this are not replaced, in the rule's units.
    shortest: f64,
    window: Option<Window>,
    /// Whether an object is replaced however small it is, by object; empty if none is.
    is_whole: Arc<[bool]>,
    /// The most that what becomes of an element is long after a number of steps, as a multiple of
    /// its length.
    longest: Arc<[f64]>,
}

/// What part of the plane is seen.
#[derive(Clone, Debug)]
struct Window {
    bounds: Bounds,
    /// How far beyond what is to be seen they lie.
    pad: f64,
    /// How far what becomes of an object reaches from the middle of its frame, by object.
    reaches: Arc<[f64]>,
    /// That middle, in every frame.
    middle: DVec2,
    /// What is done with an element whose descendants all lie outside.
    outside: Enter,
}

impl Sight {
    /// Everything is seen.
    pub(super) fn unbounded() -> Self {
        Self {
            shortest: 0.0,
            window: None,
            is_whole: Arc::new([]),
            longest: Arc::new([]),
        }
    }

    /// Elements shorter than this are not replaced, but where they lead to seeds that are placed as
    /// the initiator: those are as large as ever.
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

    /// No more than a part of the plane is seen; all of it where the graph does not tell how far
    /// its objects reach, or where what lies outside tells in what lies inside. Ranks do not if they
    /// `are_counted` whatever is visited.
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
        let window = Window {
            bounds: padded(bounds, pad),
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

    /// How far the lines may lead from elements that link them.
    pub(super) fn links(&self, graph: &Graph, growth: &Growth<'_>) -> f64 {
        links(graph, graph.longest_after(growth.steps).max(self.shortest))
    }

    /// The same of another part of the plane, where a part is seen.
    pub(super) fn moved_to(&self, bounds: &Bounds) -> Self {
        let mut moved = self.clone();
        if let Some(window) = &mut moved.window {
            window.bounds = padded(bounds, window.pad);
        }
        moved
    }

    /// Whether walks may leave out what lies outside a window.
    pub(super) fn is_bounded(&self) -> bool {
        self.window.is_some()
    }

    /// Whether walks may leave out anything.
    pub(super) fn cuts(&self) -> bool {
        self.shortest > 0.0 || self.window.is_some()
    }

    /// The length below which walks replace nothing, if they may leave out anything.
    pub(super) fn shortest(&self) -> Option<f64> {
        self.cuts().then_some(self.shortest)
    }

    /// Whether an element of a length is too short to be replaced, if it leads to no seeds that are placed
    /// as the initiator.
    #[inline]
    pub(super) fn is_short(&self, length: f64) -> bool {
        length < self.shortest
    }

    /// Whether anything that becomes of an element of a length in a number of steps may be so long
    /// that it is replaced.
    #[inline]
    pub(super) fn lasts(&self, length: f64, steps: u32) -> bool {
        let longest = self.longest.get(steps as usize).or(self.longest.last());
        longest.is_none_or(|longest| length * longest >= self.shortest)
    }

    /// After how many steps nothing that becomes of an element of a length is replaced any more, at the
    /// latest.
    pub(super) fn steps_of(&self, length: f64) -> Option<u32> {
        let steps = 0..u32::try_from(self.longest.len()).ok()?;
        steps.into_iter().find(|&steps| !self.lasts(length, steps))
    }

    /// What a walk does with an element that can be replaced.
    #[inline]
    pub(super) fn enter(&self, subtree: &Subtree) -> Enter {
        if !self.cuts() {
            return Enter::Replace;
        }
        let length = subtree.frame.stretch();
        if let Some(window) = &self.window
            && window.is_outside(subtree, length)
        {
            return window.outside;
        }
        let is_whole = self.is_whole.get(subtree.object);
        if self.is_short(length) && is_whole != Some(&true) {
            return Enter::Keep;
        }
        Enter::Replace
    }
}

fn padded(bounds: &Bounds, pad: f64) -> Bounds {
    Bounds::new(bounds.min() - pad, bounds.max() + pad)
}

impl Window {
    /// Whether all that becomes of an element lies outside.
    fn is_outside(&self, subtree: &Subtree, length: f64) -> bool {
        // Rounding must not hide what just touches the edge.
        const SLACK: f64 = 1.0 + 1e-9;
        let middle = subtree.frame.map.transform_point2(self.middle);
        let nearest = middle.clamp(self.bounds.min(), self.bounds.max());
        let reach = self.reaches[subtree.object] * length * SLACK;
        middle.distance_squared(nearest) > reach * reach
    }
}

/// The most that what becomes of an element is long after each number of steps, as a multiple of its
/// length, where a length decides what is replaced.
fn longest(graph: &Graph, shortest: f64) -> Arc<[f64]> {
    // Rounding must not hide what is just as long.
    const SLACK: f64 = 1.0 + 1e-9;
    let ratio = graph.longest_child() * SLACK;
    if shortest <= 0.0 || ratio >= 1.0 {
        return Arc::new([]);
    }
    let powers = std::iter::successors(Some(SLACK), |power| Some(power * ratio));
    powers.take(MOST_POWERS).collect()
}

/// What can be done with an element that is not seen; `None` if it is to be replaced nevertheless.
fn outside(graph: &Graph, style: &Style, are_counted: bool) -> Option<Enter> {
    // Elements and fractals that are not visited could not be numbered.
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
    // Where a closed path is broken, its two ends may be in sight: caps must look like the corner.
    let seam_shows = style.cap != Cap::Round || style.join != Join::Round;
    if style.fill.is_none() && !seam_shows {
        return Some(Enter::Skip);
    }
    // An outline may take any way outside that leads from one end to the other: what lies inside
    // stays encircled as often. It stays whole if the elements of other approximants on that way
    // are of the same class.
    let stays_whole = Classes::before_survey(style.color_by, graph, 0).keep_fractals_whole();
    (graph.keeps_lines() && (stays_whole || !seam_shows)).then_some(Enter::Keep)
}

/// The radius, about the middle of its unit frame, of a disc that holds an element with its stroke.
pub(super) fn own_reach(graph: &Graph, object: &Object, style: &Style) -> f64 {
    let stroke = match style.width {
        Width::Relative(width) => {
            width * graph.widest().unwrap_or(1.0) * graph.unit() * relative_overhang(style)
        }
        Width::Pixels(_) => 0.0,
    };
    graph.outline_radius(object) + stroke
}

/// Whether a fractal may be a closed chain.
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
                Replacement::Kept | Replacement::Beyond => false,
            })
}

/// How far the lines may lead that link base elements which do not run from end to end of their
/// frames: from an element that is seen to one that is not. `longest` is the length of the longest
/// element that could still be replaced.
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
        // An element that is kept may be as long as any.
        let length = match object.replacement {
            _ if link == 0.0 => continue,
            Replacement::Kept => f64::INFINITY,
            _ => longest,
        };
        farthest = f64::max(farthest, link * length);
    }
    farthest
}
