//! Points, directions, frames, outlines and boxes, of the plane and generic over the dimension.
//!
//! The plane has x to the right and y up; positive angles turn counter-clockwise. Points are
//! [`glam::DVec2`], affine maps [`glam::DAffine2`] (they act on column vectors, so `f * g` applies
//! `g` first). Space has its z axis towards the viewer, and positive angles turn by the right-hand rule; its
//! points are [`glam::DVec3`], its affine maps [`glam::DAffine3`].

#[macro_use]
mod forward;

mod affine;
mod base_element;
mod bounds;
mod clip;
mod corners;
mod direction;
mod frame;
mod frame2;
mod frame3;
mod homothety;
mod hull;
mod linear;
mod mesh;
mod point;
mod polygon;
mod round;
mod solid;

pub use affine::Affine;
pub use base_element::{BaseElement, Piece, arc};
pub use bounds::Bounds;
pub use corners::Corners2;
pub use direction::Direction;
pub use frame::{BEYOND, Corners, Frame, Outline};
pub use frame2::Frame2;
pub use frame3::{Attitude, Frame3};
pub(crate) use glam::DQuat;
pub use glam::{DAffine2, DAffine3, DMat2, DMat3, DVec2, DVec3};
pub use homothety::Homothety;
pub(crate) use linear::eigen;
pub use linear::{Linear, rotation};
pub use mesh::Mesh;
pub use point::Point;
pub use polygon::{MAX_POINTS, PolygonError, polygon};
pub use round::Round;
pub use solid::{HalfSpace, MAX_HULL_POINTS, Side, Solid};

pub(crate) use clip::clip;
pub(crate) use frame::LARGEST_ENTRY;
pub(crate) use frame2::stretch;
pub(crate) use homothety::exponent_of;
pub(crate) use hull::{
    EIGHT_WAYS, convex_hull, distance_to_segment, farthest, hausdorff_distance, rightmost, thinned,
};
pub(crate) use polygon::triangulated;
