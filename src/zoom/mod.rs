//! Zooming without end: what lies about a point of a limit set, as much larger as one likes.
//!
//! A picture of a small part is that of the part's own roots: the instances that meet the window,
//! none of them larger than some thousand windows. A [`Zoom`] is found in two stages. A descent from
//! the initiator, in numbers as long as the zoom asks for, keeps of every step the instances that meet the
//! window, of which there are few, for copies of a set that overlap no more than they do anywhere
//! have few neighbours. Those that have become small enough are the roots; a graph that starts from
//! them, in pixels and in doubles, is drawn as any other. So the cost of a picture is that of its
//! pixels, and of some products of long numbers a step.
//!
//! # Numbers
//!
//! The maps of a file are evaluated from its expressions as they are written
//! ([`Precision`](crate::expression)), for a third is not the double next to it: maps that were
//! rounded would not fit together beyond a zoom of some 1e15. Decimals are what they say, draws are
//! the doubles that were drawn, and what conditions decide is decided in doubles, as everywhere. Maps
//! of instances are whole multiples of 2⁻⁶⁴ pixels, and constants have as many bits as it takes to
//! keep products that exact; errors of rounding add up to some such multiples a step, far below a
//! thousandth of a pixel. Lines of an L-system that rewrites edges are sums of exact turns; the factors of
//! its steps are the doubles that they come to.
//!
//! # What is left out
//!
//! An instance is left out where all that becomes of it keeps away from the window: surely so, or where
//! draws have no limits, such as normal ones, with a chance of error below 2⁻⁶⁴ each.
//!
//! # What is the same as everywhere
//!
//! A root carries the step of its birth, its path, its length and its tints, and a fractal the step of
//! its own birth: draws, conditions and colours see what they would see if everything were drawn. Seeds
//! are followed as children are, each in a fractal of its own; the graph keeps which of them was seeded
//! by which, when and where, so that fractals come in the order of everywhere. Only their numbers are not
//! told, for those far from the window are not counted. Where many instances of one object stand in
//! one place, that of the oldest fractal stands for all. What stays infertile and is larger than
//! all that is seen, a trunk or a condensation set, is clipped in long numbers; where it is clipped, it
//! runs along a circle about the window, so that what it encloses stays encircled.

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

pub use address::{Address, AddressError};
pub use factor::{Factor, FactorError};

pub(crate) use nearest::distance;

use std::sync::atomic::AtomicBool;

use crate::document::{Document, Setting};
use crate::geometry::DVec2;
use crate::graph::{CompileError, Graph, NoLimit, Object};
use crate::model::Model;
use crate::whole::whole;

/// A model, and the file that says its numbers.
#[derive(Clone, Copy)]
pub struct Source<'a> {
    /// The file.
    pub document: &'a Document,
    /// What the file's parameters are set to.
    pub settings: &'a [Setting],
    /// What came of both.
    pub model: &'a Model,
    /// The maps of a system that have been left out, by their numbers from 1.
    pub omitted: &'a [u32],
}

/// What is looked at.
#[derive(Clone, Debug)]
pub struct Window {
    /// The picture's width and height in pixels.
    pub size: [u32; 2],
    /// Pixels a unit of the plane where nothing is magnified.
    pub scale: f64,
    /// How far outside the picture something may lie that shows in it, in pixels: half a stroke's
    /// width, and more.
    pub margin: f64,
    /// How far strokes reach beyond outlines whose width grows with their elements, in the unit frame;
    /// 0 if none does.
    pub relative_stroke: f64,
    /// Whether what closed chains enclose is seen, so that what of them lies elsewhere has to lead around
    /// the window.
    pub areas: bool,
    /// Elements shorter than so many pixels are not replaced, and seed nothing.
    pub shortest: f64,
    /// How much larger everything is.
    pub factor: Factor,
    /// What lies in the middle.
    pub at: Address,
}

/// How a zoom is grown.
#[derive(Clone, Copy, Debug, Default)]
pub struct Growth<'a> {
    /// What random draws depend on.
    pub seed: u64,
    /// The step after which nothing is replaced any more, if there is one.
    pub steps: Option<u32>,
    /// The work ends soon after this is set.
    pub cancel: Option<&'a AtomicBool>,
}

/// A window's part of a graph: a graph of its own, in pixels from the middle of the window, y up.
#[derive(Clone, Debug)]
pub struct Zoom {
    /// The graph.
    pub graph: Graph,
    /// The deepest step in which a root was born.
    pub deepest: u32,
}

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ZoomError {
    /// There is no limit set, and so no point to zoom into.
    #[error(
        "there is nothing to zoom into without end: {0}; --view X,Y,W,H draws a part of a step"
    )]
    NoLimit(NoLimit),
    /// What becomes of an element depends on what stands before it.
    #[error(
        "what becomes of an element depends on the number of all those before it, and those far from \
         the window are not grown; --view X,Y,W,H draws a part of a step"
    )]
    CountsIndex,
    /// Every number of steps of an L-system is grown out of an initiator of its own.
    #[error(
        "there is nothing to zoom into without end: it does not rewrite edges, so that every step of it \
         starts anew; --view X,Y,W,H draws a part of a step"
    )]
    StartsAnew,
    /// The graph does not tell how far what becomes of elements reaches.
    #[error(
        "it is not known how far what becomes of its elements reaches; --view X,Y,W,H draws a part of a \
         step"
    )]
    NoReach,
    /// An address leads to an element that is not there.
    #[error(
        "{address}: there is no position {position} at depth {depth}, where there are {count}, \
         numbered from 0"
    )]
    NoSuchPosition {
        /// The address.
        address: Address,
        /// The position.
        position: u32,
        /// Its place in the address, from 0.
        depth: u32,
        /// How many positions there are.
        count: usize,
    },
    /// An address leads through an element that is not replaced.
    #[error(
        "{address}: the way ends at depth {depth}, for the element there is infertile: it is never \
         replaced, and no point is named"
    )]
    Infertile {
        /// The address.
        address: Address,
        /// The place of the element's position in the address, from 0.
        depth: u32,
    },
    /// The elements of an address do not shrink to a point.
    #[error("{address}: the elements on this way do not shrink to a point")]
    NoPoint {
        /// The address.
        address: Address,
    },
    /// A point is told by doubles.
    #[error(
        "a point x,y is told to some 16 digits, which do for zooms up to {most:.0e} here; an address \
         such as 0.(1) names a point to the last digit"
    )]
    TooFine {
        /// The largest zoom.
        most: f64,
    },
    /// Too much overlaps.
    #[error("more than {limit} parts of it overlap in the window; less zoom may do")]
    TooMany {
        /// How many may.
        limit: usize,
    },
    /// The numbers are too long for so many.
    #[error(
        "it would take too long: too many parts of it overlap on the way into the window; less zoom may do"
    )]
    TooLong,
    /// Strokes are wider than the window.
    #[error(
        "an infertile element is larger than the window, and so is its stroke, whose width is relative \
         to it; a width in pixels can be drawn"
    )]
    WideStroke,
    /// A graph is resolved for fewer steps than it takes.
    #[error("{depth} steps are not enough")]
    TooShallow {
        /// The number of steps.
        depth: u32,
    },
    /// A generator has a point that is not finite.
    #[error(transparent)]
    NotFinite(#[from] CompileError),
    /// The work was cancelled.
    #[error("interrupted")]
    Cancelled,
}

/// Parts of a pixel that are counted: 2⁶⁴.
const GRAIN: usize = 64;

/// Bits beyond those that tell a part of a pixel.
const SPARE: usize = 128;

/// Finds what lies in a window.
///
/// # Errors
///
/// If there is no point to zoom into, if too much lies there, or if the graph is not resolved for as
/// many steps as it takes.
pub fn zoom(
    source: &Source<'_>,
    graph: &Graph,
    growth: &Growth<'_>,
    window: &Window,
) -> Result<Zoom, ZoomError> {
    check(source, graph)?;
    let own = |object: &Object| graph.outline_radius(object) + window.relative_stroke;
    let is_unknown = |reaches: &[f64]| reaches.iter().any(|reach| !reach.is_finite());
    let mut reaches = graph.reaches(own);
    if is_unknown(&reaches) {
        reaches = graph.likely_reaches(own);
    }
    if is_unknown(&reaches) {
        return Err(ZoomError::NoReach);
    }
    if let Address::Point(point) = window.at {
        check_point(point, window)?;
    }
    let lead = (window.factor.log2() + window.scale.log2()).ceil();
    let bits = whole(lead) + GRAIN + SPARE;
    let mut constants = constants::Constants::new(source, graph, bits)?;
    let centre = centre::centre(graph, growth, window, &mut constants)?;
    descent::Descent::new(graph, growth, window, &reaches, &mut constants).run(&centre)
}

/// Refuses a model that has no points to zoom into, before a graph is made of it.
///
/// # Errors
///
/// If every step of an L-system starts anew: its words may be long.
pub fn check_model(model: &Model) -> Result<(), ZoomError> {
    match model {
        Model::LSystem(system) if !Graph::rewrites_edges(system) => Err(ZoomError::StartsAnew),
        _ => Ok(()),
    }
}

/// Whether there may be points to zoom into.
pub(crate) fn check(source: &Source<'_>, graph: &Graph) -> Result<(), ZoomError> {
    check_model(source.model)?;
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

/// Refuses pixels that doubles cannot tell apart.
fn check_point(point: DVec2, window: &Window) -> Result<(), ZoomError> {
    let far = point.abs().max_element();
    let step = far.next_up() - far;
    let most = 1.0 / (step * window.scale);
    if window.factor.log2() > libm::log2(most) {
        return Err(ZoomError::TooFine { most });
    }
    Ok(())
}
