//! Convex hulls of subtrees, as far as frames of a kind have them: the interface of bounds.

use crate::geometry::{Affine, Frame, Frame3};
use crate::graph::{Graph, Instance};
use crate::ifs::sum_of_products;
use crate::rule::RuleFrame;

use super::sectors::MANY;

/// Precision of polygons as approximations of the convex hulls.
#[derive(Clone, Copy)]
pub struct Fineness {
    /// Relative distance from the hulls at which iteration stops.
    pub(super) tolerance: f64,
    /// Limit of the number of corners that are mapped.
    pub(super) max_work: usize,
    /// Number of corners beyond which polygons are thinned more, where there are many images and where there are few.
    pub(super) max_corners: [usize; 2],
    /// Length by which a box may fall short, relative to its extent; rounding adds to it in any case.
    pub(super) spared: f64,
}

impl Fineness {
    /// For a point that lies about in the middle.
    pub(crate) const ROUGH: Self = Self {
        tolerance: 1e-2,
        max_work: 1 << 16,
        max_corners: [32, 32],
        spared: 0.0,
    };

    pub(crate) const COARSE: Self = Self {
        tolerance: 1e-4,
        max_work: 1 << 20,
        max_corners: [256, 2048],
        spared: 0.0,
    };

    pub(super) const FINE: Self = Self {
        tolerance: 1e-8,
        max_work: 1 << 21,
        max_corners: [2048, 2048],
        spared: 1e-10,
    };

    /// Returns the number of corners beyond which polygons are thinned more, given the images of which each consists.
    pub(super) fn corners_of<I>(&self, images: &[Vec<I>]) -> usize {
        /// Number of rounds for which the work should suffice.
        const ROUNDS: usize = 16;
        // Corners of the hull of many images are sought among few of them.
        let mapped = images.iter().map(|images| images.len().min(MANY));
        let affordable = self.max_work / ROUNDS / mapped.sum::<usize>().max(1);
        let [least, most] = self.max_corners;
        affordable.clamp(least, most)
    }

    /// Returns that number for objects that do not lead back to themselves, whose images are mapped once.
    pub(super) fn corners_from_below<I>(&self, images: &[Vec<I>]) -> usize {
        /// Number of corners below which hulls bound loosely.
        const LEAST: usize = 16;
        let mapped = images.iter().map(Vec::len).sum::<usize>();
        (self.max_work / mapped.max(1)).clamp(LEAST, self.max_corners[0])
    }
}

/// Shapes of the objects themselves, for hulls of their subtrees.
#[derive(Clone, Copy, Debug)]
pub enum Own<'a> {
    /// Outlines, with a padding by object.
    Outlines(&'a [f64]),
    /// Balls about the middle of the unit frame, with a radius by object.
    Discs(&'a [f64]),
}

/// Convex sets that contain the subtrees of objects.
pub trait Hulls<F: Frame> {
    /// Returns an upper bound of x·u over the subtree of an object, u being the vector, and a lower bound of
    /// its maximum in the limit.
    fn along(&self, object: usize, vector: F::Point) -> [f64; 2];

    /// Returns an upper bound of x·u over the subtree of an object, as [`along`](Self::along) does: found faster, and larger.
    fn at_most(&self, object: usize, vector: F::Point) -> f64;

    /// Returns the radius of a ball about a point that contains the subtree of an object.
    fn radius(&self, object: usize, centre: F::Point) -> f64;

    /// Returns points whose convex hull approximates the subtree of an object.
    fn corners(&self, object: usize) -> &[F::Point];

    /// Returns the numbers of those of the instances in the place of an object that may reach farthest along a vector in the
    /// limit; `None` if they are not known. The hulls must be those of the limit.
    fn contenders(
        &self,
        _object: usize,
        _instances: &[Instance<F>],
        _vector: F::Point,
    ) -> Option<&[u32]> {
        None
    }

    /// Returns the length by which a box of instances may fall short.
    fn spared(&self, instances: &[Instance<F>], fineness: Fineness) -> f64;
}

/// Frames whose graphs are bounded: by ratios of lengths and the stretch of products of maps, or more closely where
/// the frames of a kind have hulls of subtrees.
pub trait Bounded: RuleFrame {
    /// Whether frames of the kind have hulls of subtrees.
    const HAS_HULLS: bool = false;

    /// Returns convex sets that contain the subtrees of objects: at every step, or in the limit if `drawn`
    /// states which objects are drawn there. `None` if there are none.
    fn hulls(
        _graph: &Graph<Self>,
        _own: &Own<'_>,
        _drawn: Option<&[bool]>,
        _fineness: Fineness,
    ) -> Option<Box<dyn Hulls<Self>>> {
        None
    }

    /// Returns the sum, over all n, of the largest stretch of products of n linear maps; `None` if no bound is
    /// found. `linear` lists for every kind of object the linear parts of its instances and the kinds that they
    /// instance.
    fn products(linear: &[Vec<(LinearOf<Self>, usize)>]) -> Option<f64> {
        sum_of_products(linear)
    }
}

/// Linear parts of maps between frames.
pub type LinearOf<F> = <<F as Frame>::Map as Affine>::Linear;

/// Sets in space are bounded by stretches.
impl Bounded for Frame3 {}
