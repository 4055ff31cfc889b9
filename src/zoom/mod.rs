//! Zooming at arbitrary magnification: the neighbourhood of a point of a limit set.
//!
//! A picture of a small part of a set is grown from the part's own roots: the instances that meet the
//! window, none of them larger than some thousand windows. A [`Zoom`] is computed in two stages. A
//! descent from the initiator, in numbers of the length that the magnification requires, keeps at every
//! step the instances that meet the window. These are few, because copies of a set have few neighbours
//! unless they overlap. Instances that have become small enough are the roots; a graph that starts from
//! them, in pixels and in doubles, is drawn as any other. The cost of a picture is therefore that of its
//! pixels, and of some products of big integers for each step.
//!
//! # Numbers
//!
//! The maps of a model are evaluated from its programs with constants as written: a
//! third is not the double next to it, and rounded maps would not fit together beyond a magnification of
//! some 1e15. Decimals are exact, random draws are the doubles that were drawn, and conditions are
//! evaluated in doubles, as everywhere. Maps of instances are integer multiples of 2⁻⁶⁴ pixels, and
//! constants have the number of bits that keeps products to that precision; rounding errors add up to
//! some multiples for each step, far below a thousandth of a pixel. Lines of an L-system that rewrites
//! edges are sums of exact turns; the factors of its steps are doubles.
//!
//! # Culling
//!
//! An instance is culled if its subtree is outside the window: with certainty or, where draws are
//! unbounded (such as normal ones), with a probability of error below 2⁻⁶⁴ for each instance.
//!
//! # Consistency
//!
//! A root has the step of its birth, its path, its length and its tints, and a fractal the step of its
//! own birth: draws, conditions and colours have the values that they would have if everything were
//! drawn. Seeds are followed as children are, each in a fractal of its own; the graph records by which
//! fractal, when and where each was seeded, so that fractals have their usual order. Their numbers are
//! not reported, because fractals far from the window are not counted. Of several instances of one object
//! at one place, that of the oldest fractal represents all. An infertile element larger than the window,
//! such as a trunk or a condensation set, is clipped in big integers; the clipped outline runs along a
//! circle about the window, so that the region it encloses stays enclosed.

mod address;
mod centre;
mod clip;
mod constants;
mod descent;
mod factor;
mod fixed;
mod items;
mod merge;
mod nearest;
mod roots;

pub use address::{Address, AddressError, LongDecimal};
pub use factor::{Factor, FactorError};

pub(crate) use nearest::distance;

use std::sync::atomic::AtomicBool;

use crate::extent::NoLimit;
use crate::geometry::DVec2;
use crate::graph::{CompileError, Graph, Object};
use crate::model::Model;
use crate::saturating::whole;

/// Part of the plane that is drawn.
#[derive(Clone, Debug)]
pub struct ZoomWindow {
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// Pixels for each unit of the plane, without magnification.
    pub scale: f64,
    /// Distance outside the picture, in pixels, at which objects may show in it: at least half the width
    /// of a stroke.
    pub margin: f64,
    /// Distance, in the unit frame, by which strokes extend beyond outlines, for stroke widths relative
    /// to their elements; 0 for other strokes.
    pub relative_stroke: f64,
    /// Whether the regions enclosed by closed chains are visible: the parts of such chains outside the
    /// window must then lead around it.
    pub areas: bool,
    /// Length in pixels below which elements are not replaced and seed nothing.
    pub shortest: f64,
    /// Magnification.
    pub factor: Factor,
    /// Centre.
    pub at: Address,
}

/// Conditions of growth.
#[derive(Clone, Copy, Debug, Default)]
#[non_exhaustive]
pub struct ZoomOptions<'a> {
    /// Seed of random draws.
    pub seed: u64,
    /// Number of steps after which no element is replaced; `None` if unlimited.
    pub steps: Option<u32>,
    /// Flag that cancels the computation soon after it is set.
    pub cancel: Option<&'a AtomicBool>,
}

setters!(ZoomOptions<'a> {
    seed: u64,
    steps: Option<u32>,
    cancel: Option<&'a AtomicBool>,
});

/// Part of a graph in a window: a graph of its own, in pixels from the centre of the window, with the y
/// axis upwards.
#[derive(Clone, Debug)]
pub struct Zoom {
    /// Graph.
    pub graph: Graph,
    /// Last step in which a root was created.
    pub deepest: u32,
}

/// Error: a window cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ZoomError {
    /// There is no limit set, and therefore no point to zoom into.
    #[error("there is nothing to zoom into without end: {0}; a window draws a part of a step")]
    NoLimit(NoLimit),
    /// The subtree of an element depends on the elements before it.
    #[error(
        "what becomes of an element depends on the number of all those before it, and those far from \
         the window are not grown; a window draws a part of a step"
    )]
    CountsIndex,
    /// The L-system does not rewrite edges: each number of steps has its own initiator, and only [its limit
    /// set](Model::of_zoom) can be zoomed into.
    #[error(
        "it does not rewrite edges, so that every step of it starts anew: its limit set is zoomed into, without a \
         number of steps; a window draws a part of a step"
    )]
    StartsAnew,
    /// The graph gives no bound on the extent of subtrees.
    #[error(
        "it is not known how far what becomes of its elements reaches; a window draws a part of a step"
    )]
    NoReach,
    /// An address leads to a position that does not exist.
    #[error(
        "{address}: there is no position {position} at depth {depth}, where there are {count}, \
         numbered from 0"
    )]
    NoSuchPosition {
        /// Address.
        address: Address,
        /// Position.
        position: u32,
        /// Index of the position in the address, from 0.
        depth: u32,
        /// Number of existing positions.
        count: usize,
    },
    /// An address leads through an element that is not replaced.
    #[error(
        "{address}: the way ends at depth {depth}, for the element there is infertile: it is never \
         replaced, and no point is named"
    )]
    Infertile {
        /// Address.
        address: Address,
        /// Index of the element's position in the address, from 0.
        depth: u32,
    },
    /// The elements of an address do not shrink to a point.
    #[error("{address}: the elements on this way do not shrink to a point")]
    NoPoint {
        /// Address.
        address: Address,
    },
    /// The coordinates of a point are doubles, which do not resolve the pixels.
    #[error(
        "a point x,y is told to some 16 digits, which do for zooms up to {most:.0e} here; an address \
         such as 0.(1) names a point to the last digit"
    )]
    TooFine {
        /// Largest magnification.
        most: f64,
    },
    /// Too many instances overlap in the window.
    #[error("more than {limit} parts of it overlap in the window; less zoom may do")]
    TooMany {
        /// Limit of their number.
        limit: usize,
    },
    /// The computation would take too long.
    #[error(
        "it would take too long: too many parts of it overlap on the way into the window; less zoom may do"
    )]
    TooLong,
    /// An element is clipped whose stroke width is relative to it.
    #[error(
        "an infertile element is larger than the window, and so is its stroke, whose width is relative \
         to it; a width in pixels can be drawn"
    )]
    WideStroke,
    /// The graph is resolved for too few steps.
    #[error("{depth} steps are not enough")]
    TooShallow {
        /// Number of steps.
        depth: u32,
    },
    /// A generator has a point that is not finite.
    #[error(transparent)]
    NotFinite(#[from] CompileError),
    /// The computation was cancelled.
    #[error("interrupted")]
    Cancelled,
}

/// Precision of positions: the binary logarithm of the number of parts of a pixel.
const GRAIN: usize = 64;

/// Additional bits of constants.
const SPARE: usize = 128;

/// Computes the part of the graph of a model that shows in a window.
///
/// # Errors
///
/// If there is no point to zoom into, if the window contains too much, or if the graph is not resolved
/// for the required number of steps.
pub fn zoom(
    model: &Model,
    graph: &Graph,
    growth: &ZoomOptions<'_>,
    window: &ZoomWindow,
) -> Result<Zoom, ZoomError> {
    check(model, graph)?;
    let own = |object: &Object| graph.outline_radius(object) + window.relative_stroke;
    let is_unknown = |reaches: &[f64]| reaches.iter().any(|reach| !reach.is_finite());
    let mut reaches = graph.reaches(own);
    if is_unknown(&reaches) {
        reaches = graph.probable_radii(own);
    }
    if is_unknown(&reaches) {
        return Err(ZoomError::NoReach);
    }
    if let Address::Point(point) = window.at {
        check_point(point, window)?;
    }
    let lead = (window.factor.log2() + window.scale.log2()).ceil();
    let bits = whole(lead) + GRAIN + SPARE;
    let mut constants = constants::Constants::new(model, graph, bits)?;
    let centre = centre::centre(graph, growth, window, &mut constants)?;
    descent::Descent::new(graph, growth, window, &reaches, &mut constants).run(&centre)
}

/// Checks that a model has points to zoom into, before it is compiled to a graph.
///
/// # Errors
///
/// If an L-system neither rewrites edges nor stands for [its limit set](Model::of_zoom): compiling it may require long
/// words.
pub fn check_model(model: &Model) -> Result<(), ZoomError> {
    if !model.as_kind().starts_anew() {
        return Ok(());
    }
    if let Model::LSystem(system) = model
        && let Err(reason) = system.check_growth()
    {
        return Err(ZoomError::NoLimit(reason.into()));
    }
    Err(ZoomError::StartsAnew)
}

/// Checks that a graph may have points to zoom into.
pub(crate) fn check(model: &Model, graph: &Graph) -> Result<(), ZoomError> {
    check_model(model)?;
    if let Some(reason) = graph.no_limit {
        return Err(ZoomError::NoLimit(reason));
    }
    if graph.counts_index() {
        return Err(ZoomError::CountsIndex);
    }
    if graph.resets().contains(&true) {
        return Err(ZoomError::NoLimit(NoLimit::Resets));
    }
    if !graph.shrinks() {
        return Err(ZoomError::NoLimit(NoLimit::DoesNotShrink));
    }
    Ok(())
}

/// Checks that doubles resolve the pixels about a point.
fn check_point(point: DVec2, window: &ZoomWindow) -> Result<(), ZoomError> {
    let far = point.abs().max_element();
    let step = far.next_up() - far;
    let most = 1.0 / (step * window.scale);
    if window.factor.log2() > libm::log2(most) {
        return Err(ZoomError::TooFine { most });
    }
    Ok(())
}
