//! Extents of subtrees, approximants and limit sets: boxes, hulls, radii and the contraction of maps, computed
//! from the graph alone or by a search.
//!
//! Support functions along the axes yield the box of an approximant or of the limit set, exact to rounding, level
//! by level or, where there are many behaviours, by policy iteration; radii of balls about subtrees decide what a
//! walk may leave out; polygons tighten both in the plane, where maps contract little or only in products. Where
//! random draws are unbounded, radii hold for all but improbable draws. A [search](bounding_box()) finds the box of
//! an approximant whose successors are computed for each element.

mod bounded;
mod bounding_box;
mod bounds;
mod contract;
mod farthest;
mod hull;
mod limit;
mod limit_boxes;
mod place;
mod policy;
mod probable_reach;
mod reach;
mod recurrent;
mod search;
mod sectors;
mod terms;
mod union;

pub use bounded::{Bounded, Fineness, Hulls, LinearOf, Own};
pub use bounding_box::bounding_box;
pub use bounds::ApproximantBounds;
pub(crate) use contract::Products;
pub use limit::{Limit, NoLimit};
pub(crate) use limit_boxes::LimitBoxes;
pub(crate) use search::{Limits, Reaches, search};
