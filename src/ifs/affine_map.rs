//! Affine maps of systems, in the plane and in space.

use std::fmt::Debug;
use std::sync::Arc;

use super::norm::in_best_coordinates;
use super::{Shape, Shrinking};
use crate::expression::{AffineOf, Doubles, Program};
use crate::geometry::{
    Affine, BaseElement, Bounds, DAffine2, DAffine3, DMat2, DMat3, DVec2, DVec3, Frame, Frame2,
    Frame3, Piece, Solid, convex_hull,
};

/// Affine map of a system: [`DAffine2`] of the plane, [`DAffine3`] of space.
pub trait AffineMap: Affine {
    /// Frames of the graph of a system.
    type Frame: Frame<Point = Self::Point, Map = Self> + From<Self>;
    /// Condensation sets and initial sets.
    type Set: Clone + Debug + PartialEq + Send + Sync;
    /// A map with the expressions of its file.
    type Written: Clone + Debug + PartialEq + Send + Sync + From<Self>;

    /// Evaluates the product of maps as written, of which the first one is applied first.
    #[must_use]
    fn product(written: &[Self::Written], slots: &[f64]) -> Self;

    /// Returns a map as written as one of space, which takes all z to 0 if it is one of the plane.
    #[must_use]
    fn written_in_space(written: &Self::Written) -> AffineOf<Program, 3>;

    /// Returns the fixed point; `None` if there is none, or more than one.
    #[must_use]
    fn fixed_point(&self) -> Option<PointOf<Self>>;

    /// Returns linear maps in coordinates in which their largest stretch is less; in space, the maps
    /// themselves.
    #[must_use]
    fn in_best_coordinates(linear: &[Self::Linear]) -> Vec<Self::Linear>;

    /// Returns a length at which all products of linear maps shrink; `None` if none is found. `images` lists for
    /// every kind of object the linear maps of its instances and the kinds that they instance.
    #[must_use]
    fn shrinking(images: &[Vec<(Self::Linear, usize)>]) -> Option<(u32, f64)>;

    /// Returns whether a condensation set has an extent.
    #[must_use]
    fn has_extent(set: &Self::Set) -> bool;

    /// Returns whether an initial set is finite.
    #[must_use]
    fn is_bounded(set: &Self::Set) -> bool;

    /// Returns the shapes that a set consists of, at least one.
    #[must_use]
    fn outlines(set: &Self::Set) -> Vec<OutlineOf<Self>>;

    /// Returns the sets, each of one shape, of which a set is the union.
    #[must_use]
    fn parts(set: &Self::Set) -> Vec<Self::Set>;

    /// Returns a shape for objects that are not drawn.
    #[must_use]
    fn unseen() -> OutlineOf<Self>;

    /// Returns a key that equal shapes share.
    #[must_use]
    fn key(shape: &OutlineOf<Self>) -> Vec<u64>;

    /// Returns the shape that fills a box; the unit box if there is none.
    #[must_use]
    fn filling(bounds: Option<Bounds<PointOf<Self>>>) -> OutlineOf<Self>;

    /// Returns the convex hull of points.
    #[must_use]
    fn hull(points: &[PointOf<Self>]) -> Self::Set;
}

/// The points that a map moves.
pub type PointOf<M> = <<M as AffineMap>::Frame as Frame>::Point;

/// The shapes that are drawn in the frames of a map.
pub type OutlineOf<M> = <<M as AffineMap>::Frame as Frame>::Outline;

impl AffineMap for DAffine2 {
    type Frame = Frame2;
    type Set = Shape;
    type Written = AffineOf<Program>;

    fn product(written: &[Self::Written], slots: &[f64]) -> Self {
        AffineOf::product(&mut Doubles, written, slots).into()
    }

    fn written_in_space(written: &Self::Written) -> AffineOf<Program, 3> {
        written.in_space()
    }

    fn fixed_point(&self) -> Option<DVec2> {
        let moving = DMat2::IDENTITY - self.matrix2;
        let (x, y) = (moving.x_axis, moving.y_axis);
        let area = x.perp_dot(y);
        // Cramer's rule. Where the columns are parallel, rounding leaves a small area instead of zero.
        if area.abs() <= 1e-15 * x.length() * y.length() {
            return None;
        }
        let shift = self.translation;
        let point = DVec2::new(shift.perp_dot(y), x.perp_dot(shift)) / area;
        point.is_finite().then_some(point)
    }

    fn in_best_coordinates(linear: &[DMat2]) -> Vec<DMat2> {
        in_best_coordinates(linear)
    }

    fn shrinking(images: &[Vec<(DMat2, usize)>]) -> Option<(u32, f64)> {
        let found = Shrinking::found(images)?;
        Some((found.length, found.stretch))
    }

    fn has_extent(set: &Shape) -> bool {
        set.moments().is_some()
    }

    fn is_bounded(set: &Shape) -> bool {
        !matches!(set, Shape::Point(point) if !point.is_finite())
    }

    fn outlines(set: &Shape) -> Vec<BaseElement> {
        match set {
            Shape::Union(outlines) => outlines.to_vec(),
            one => vec![outline(one)],
        }
    }

    fn parts(set: &Shape) -> Vec<Shape> {
        match set {
            Shape::Union(outlines) => outlines.iter().cloned().map(Shape::Outline).collect(),
            one => vec![one.clone()],
        }
    }

    fn unseen() -> BaseElement {
        BaseElement::line()
    }

    fn key(shape: &BaseElement) -> Vec<u64> {
        let mut bits = vec![u64::from(shape.is_closed())];
        let mut add = |point: DVec2| bits.extend([point.x, point.y].map(f64::to_bits));
        add(shape.start());
        for piece in shape.pieces() {
            match *piece {
                Piece::Line(end) => add(end),
                Piece::Cubic(a, b, end) => {
                    // NaN marks a curve: no line ends there.
                    add(DVec2::NAN);
                    [a, b, end].into_iter().for_each(&mut add);
                }
            }
        }
        bits
    }

    /// Returns the filled rectangle of a box; the unit square if it is `None`.
    fn filling(bounds: Option<Bounds>) -> BaseElement {
        let bounds = bounds.unwrap_or(Bounds::new(DVec2::ZERO, DVec2::ONE));
        let (min, max) = (bounds.min(), bounds.max());
        let corners = [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
        let size = bounds.size();
        let shape = if size.x > 0.0 && size.y > 0.0 {
            Shape::polygon(&corners)
        } else {
            Shape::polyline(&[min, max])
        };
        outline(&shape.unwrap_or(Shape::Point(min)))
    }

    /// Returns the convex hull of points as a polygon, a segment or a point.
    fn hull(points: &[DVec2]) -> Shape {
        let around = convex_hull(points.to_vec(), 0.0);
        let shape = match around[..] {
            [from, to] => Shape::polyline(&[from, to]),
            _ => Shape::polygon(&around),
        };
        shape.unwrap_or_else(|| Shape::Point(around.first().copied().unwrap_or_default()))
    }
}

/// Returns the outline of a shape, the first of a union; for a point, the shortest possible line, which
/// is stroked as a dot.
fn outline(shape: &Shape) -> BaseElement {
    match shape {
        Shape::Outline(outline) => outline.clone(),
        Shape::Union(outlines) => outlines[0].clone(),
        Shape::Point(point) => {
            let next = DVec2::new(point.x.next_up(), point.y);
            BaseElement::new(*point, vec![Piece::Line(next)], false)
                .unwrap_or_else(BaseElement::line)
        }
    }
}

impl AffineMap for DAffine3 {
    type Frame = Frame3;
    type Set = Arc<[Solid]>;
    type Written = AffineOf<Program, 3>;

    fn product(written: &[Self::Written], slots: &[f64]) -> Self {
        AffineOf::product(&mut Doubles, written, slots).into()
    }

    fn written_in_space(written: &Self::Written) -> AffineOf<Program, 3> {
        written.clone()
    }

    fn fixed_point(&self) -> Option<DVec3> {
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis - self.matrix3 * axis);
        let volume = x.dot(y.cross(z));
        if volume.abs() <= 1e-15 * x.length() * y.length() * z.length() {
            return None;
        }
        let shift = self.translation;
        let parts = DVec3::new(
            shift.dot(y.cross(z)),
            x.dot(shift.cross(z)),
            x.dot(y.cross(shift)),
        );
        let point = parts / volume;
        point.is_finite().then_some(point)
    }

    fn in_best_coordinates(linear: &[DMat3]) -> Vec<DMat3> {
        linear.to_vec()
    }

    fn shrinking(_images: &[Vec<(DMat3, usize)>]) -> Option<(u32, f64)> {
        None
    }

    fn has_extent(set: &Arc<[Solid]>) -> bool {
        !set.is_empty() && Self::is_bounded(set)
    }

    fn is_bounded(set: &Arc<[Solid]>) -> bool {
        set.iter().all(Solid::is_finite)
    }

    fn outlines(set: &Arc<[Solid]>) -> Vec<Solid> {
        set.to_vec()
    }

    fn parts(set: &Arc<[Solid]>) -> Vec<Arc<[Solid]>> {
        set.iter().map(|solid| [solid.clone()].into()).collect()
    }

    fn unseen() -> Solid {
        Solid::hull(&[DVec3::ZERO])
    }

    fn key(shape: &Solid) -> Vec<u64> {
        let place = shape.place().to_cols_array();
        let corners = shape.corners().iter().flat_map(DVec3::to_array);
        let numbers = place.into_iter().chain(corners).map(f64::to_bits);
        let round = shape.primitive().map_or(0, |round| 1 + round as u64);
        std::iter::once(round).chain(numbers).collect()
    }

    fn filling(bounds: Option<Bounds<DVec3>>) -> Solid {
        Solid::cuboid(&bounds.unwrap_or(Bounds::new(DVec3::ZERO, DVec3::ONE)))
    }

    fn hull(points: &[DVec3]) -> Arc<[Solid]> {
        [Solid::hull(points)].into()
    }
}
