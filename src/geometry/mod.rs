//! Points, directions, frames and boxes of the plane.
//!
//! The plane has x to the right and y up; positive angles turn counter-clockwise. Points are
//! [`glam::DVec2`], affine maps [`glam::DAffine2`] (they act on column vectors, so `f * g` applies
//! `g` first).

mod bounds;
mod direction;
mod frame;
mod homothety;
mod hull;

pub use bounds::Bounds;
pub use direction::Direction;
pub use frame::{BEYOND, Frame};
pub use glam::{DAffine2, DMat2, DVec2};
pub use homothety::Homothety;

pub(crate) use frame::stretch;
pub(crate) use hull::{convex_hull, distance_to_hull, distance_to_segment, thinned};
