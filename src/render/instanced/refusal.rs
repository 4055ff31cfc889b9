//! Conditions under which nested instances cannot represent a picture.

use crate::geometry::{Frame, Outline};
use crate::graph::{Graph, Replacement};
use crate::rule::Placement;
use crate::style::{Cap, ColorBy, ColorProperty, Join, Named, Style, Width};

/// Reason why a picture cannot be made of nested instances.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NotInstanced {
    /// Random numbers are drawn for each element.
    #[error("its elements are drawn at random, each in its own way")]
    Draws,
    /// Indices are counted by the walk.
    #[error("what replaces an element depends on the number of all those before it")]
    CountsIndex,
    /// Productions are computed for each element.
    #[error("what replaces an element is worked out where it stands")]
    Evaluated,
    /// A seed is placed as the initiator, which is not a map relative to its parent.
    #[error("it seeds parts that are placed as the initiator, whatever they stand in")]
    Resets,
    /// Colours depend on more than the object and the step.
    #[error(
        "colours by {by} distinguish elements of one symbol; those by step, age, generator, direction and tint do \
         not, nor does a single colour"
    )]
    Colours {
        /// Name of the property on which colours depend.
        by: &'static str,
    },
    /// The inside of a closed path of elements is filled.
    #[error(
        "the area inside a path that is grown is no union of copies; a transparent fill leaves it out"
    )]
    Areas,
    /// Caps or joins between single elements would be visible.
    #[error(
        "elements are stroked one by one, so that they join only with round caps and round joins"
    )]
    Corners,
    /// Widths are relative, and maps are not similarities.
    #[error("its maps would flatten strokes of a relative width; a width in pixels works")]
    Flattened,
    /// Rounding would be visible.
    #[error("the window is too small: browsers count in single precision")]
    TooClose,
    /// The number of symbols exceeds the limit.
    #[error("it takes more than {} symbols", super::MAX_SYMBOLS)]
    TooManySymbols,
}

/// Checks that symbols can represent a picture.
pub(super) fn check<F: Frame>(
    graph: &Graph<F>,
    style: &Style,
    steps: u32,
) -> Result<(), NotInstanced> {
    if graph.draws() {
        return Err(NotInstanced::Draws);
    }
    if graph.counts_index() {
        return Err(NotInstanced::CountsIndex);
    }
    if !graph.is_plain() {
        return Err(NotInstanced::Evaluated);
    }
    let successors = || {
        let objects = graph.objects().iter();
        objects.filter_map(|object| match &object.replacement {
            Replacement::Fixed(successor) => Some(successor),
            _ => None,
        })
    };
    let seeds = || successors().flat_map(|successor| &successor.seeds);
    if seeds().any(|seed| seed.placement == Placement::SeedsAsInitiator) {
        return Err(NotInstanced::Resets);
    }
    let distinguishes = match style.color_by {
        ColorBy::Index => true,
        ColorBy::Fractal => graph.has_fractals(),
        by => by.property() == ColorProperty::Frame,
    };
    if distinguishes {
        let by = style.color_by.name();
        return Err(NotInstanced::Colours { by });
    }
    let is_open = |object: usize| {
        let object = &graph.objects()[object];
        !graph.base_elements()[object.base_element].is_closed()
    };
    let drawn = |number: usize| graph.objects()[number].visible;
    let objects = || 0..graph.objects().len();
    let initiator = graph.initiator(steps);
    let is_ring = initiator.is_ring() || seeds().any(|seed| seed.chain.is_ring());
    let fills = style.fill.is_some_and(|fill| fill.opacity() > 0.0);
    if fills && is_ring && objects().any(is_open) {
        return Err(NotInstanced::Areas);
    }
    let is_round = style.cap == Cap::Round && style.join == Join::Round;
    if !is_round && graph.joins() && objects().any(|number| drawn(number) && is_open(number)) {
        return Err(NotInstanced::Corners);
    }
    let strokes = objects().any(|number| drawn(number) && is_open(number));
    let strokes = strokes || style.outlines_polygons();
    if strokes && matches!(style.width, Width::Relative(_)) && !graph.is_similar() {
        return Err(NotInstanced::Flattened);
    }
    Ok(())
}
