//! Frames of elements, and the outlines that are drawn in them: the interface of the plane and of space.

use std::fmt::Debug;

use super::{Affine, Bounds, Direction, Point};

/// Message for an element whose frame is not [in range](Frame::is_in_range).
pub const BEYOND: &str = "an element lies beyond the range of numbers";

/// Absolute value below which entries of maps are [in range](Frame::is_in_range).
pub(crate) const LARGEST_ENTRY: f64 = 1e150;

/// The placement of an element: a map of the unit frame, and the direction along the element's path.
///
/// Graphs, walks, forecasts, bounds and draws know elements by this interface alone; [`Frame2`](super::Frame2)
/// is the frame of the plane. In the unit frame an element runs from the origin to the unit point of the x
/// axis. The default is the unit frame itself.
pub trait Frame: Copy + Debug + Default + PartialEq + Send + Sync + 'static {
    /// The points that frames map.
    type Point: Point;
    /// The maps from the unit frame.
    type Map: Affine<Point = Self::Point>;
    /// The shape that is drawn for an element, in the unit frame.
    type Outline: Outline<Self>;
    /// Points that are mapped together.
    type Corners: Corners<Self>;

    /// The unit frame itself.
    const UNIT: Self;

    /// Returns the frame of an element whose frame relative to this one is `inner`.
    #[must_use]
    fn compose(&self, inner: &Self) -> Self;

    /// Returns the map from the unit frame.
    #[must_use]
    fn map(&self) -> &Self::Map;

    /// Returns the product of the directions along the element's path.
    #[must_use]
    fn direction(&self) -> Direction;

    /// Returns the frame with another direction and an unchanged map.
    #[must_use]
    fn with_direction(&self, direction: Direction) -> Self;

    /// Returns the image of the origin.
    #[must_use]
    fn origin(&self) -> Self::Point;

    /// Returns the frame translated to another origin.
    #[must_use]
    fn moved_to(&self, origin: Self::Point) -> Self;

    /// Returns the image of a point of the unit frame.
    #[must_use]
    fn apply(&self, point: Self::Point) -> Self::Point;

    /// Returns the pullback Aᵀv of a linear functional x → v·x, where A is the linear part of the map.
    ///
    /// The support function of the image of a set K is v·M(0) + h(Aᵀv), where h is that of K.
    #[must_use]
    fn pullback(&self, functional: Self::Point) -> Self::Point;

    /// Returns the first and the last point of traversal.
    #[must_use]
    fn ends(&self) -> [Self::Point; 2];

    /// Returns the distance of the two points of traversal.
    #[must_use]
    fn length(&self) -> f64;

    /// Returns the largest factor by which the map lengthens a vector: its largest singular value.
    #[must_use]
    fn stretch(&self) -> f64;

    /// Returns the area of the image of the unit square, which in space lies in the plane z = 0.
    #[must_use]
    fn area(&self) -> f64;

    /// Returns the volume of the image of the unit cube; 0 in the plane.
    #[must_use]
    fn volume(&self) -> f64 {
        0.0
    }

    /// Returns `true` if the map is a similarity of a ratio, up to rounding.
    #[must_use]
    fn is_similarity(&self, ratio: f64) -> bool;

    /// Returns `true` if the squares of all entries of the map are within the range of doubles, as lengths
    /// and areas need.
    #[must_use]
    fn is_in_range(&self) -> bool;
}

/// The shape that is drawn for an element, in its unit frame: lines and curves in the plane, surfaces in
/// space.
pub trait Outline<F: Frame<Outline = Self>>: Clone + Debug + Send + Sync + 'static {
    /// Returns `true` if the shape never joins those of neighbouring elements.
    #[must_use]
    fn is_closed(&self) -> bool;

    /// Returns the dimension of the shape: 2 for a closed one, which is filled, and 1 for a line.
    #[must_use]
    fn dimension(&self) -> f64 {
        if self.is_closed() { 2.0 } else { 1.0 }
    }

    /// Returns `true` if the shape is the line between the ends of the unit frame.
    #[must_use]
    fn is_line(&self) -> bool;

    /// Returns whether the shape starts at the first end of the unit frame, and whether it ends at the last
    /// one. Both are false for a closed shape.
    #[must_use]
    fn ends_meet_frame(&self) -> [bool; 2];

    /// Returns the area of the shape; for open lines of the plane, that between the line and its chord. It is
    /// negative where the contour runs clockwise.
    #[must_use]
    fn signed_area(&self) -> f64;

    /// Returns the volume of the shape; 0 for a flat one, and in the plane.
    #[must_use]
    fn volume(&self) -> f64 {
        0.0
    }

    /// Returns the support function of the shape: the maximum of x·u over its points x.
    #[must_use]
    fn support(&self, direction: F::Point) -> f64;

    /// Returns the approximate number of points that [`add_to`](Self::add_to) looks at.
    #[must_use]
    fn complexity(&self) -> usize {
        1
    }

    /// Extends `bounds` by the box of the shape placed in a frame, padded by `pad` on every side.
    fn add_to(&self, bounds: &mut Bounds<F::Point>, frame: &F, pad: f64);

    /// Adds the corners of the shape placed in a frame, in order of traversal, and returns `true`; `false`
    /// if the shape has curves.
    fn add_corners(&self, corners: &mut F::Corners, frame: &F) -> bool;

    /// Returns the radius of a ball about `centre` that contains the shape: at least the least such radius,
    /// and at most the square root of the dimension times that.
    #[must_use]
    fn radius_about(&self, centre: F::Point) -> f64 {
        let axes = F::Point::AXES.iter();
        let far = axes.map(|&axis| axis.abs() * (self.support(axis) - axis.dot(centre)).abs());
        far.fold(F::Point::ZERO, F::Point::max).length()
    }
}

/// Points that a frame maps together, to extend a box.
pub trait Corners<F: Frame>: Debug + Default + Send + Sync {
    /// Adds a point.
    fn add(&mut self, corner: F::Point);

    /// Extends a box by the images of all points.
    fn add_to(&self, bounds: &mut Bounds<F::Point>, frame: &F);
}
