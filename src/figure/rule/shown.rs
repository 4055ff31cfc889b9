//! Elements of rules as figures show them: of the plane as they are, of space as the camera sees them.

use crate::geometry::{Bounds, DAffine3, DMat3, DVec2, DVec3, Frame as _, Frame2, Frame3, Solid};
use crate::rule::{BaseElement, Body, ListedAttitude, ListedElement, RuleFrame};

use super::block::Outline;
use super::lines::{flattened, outline};
use super::panel::Shape;
use super::space;

/// Length of the arrow along a normal, as a multiple of the element's length.
const NORMAL: f64 = 0.4;

/// Frame of the elements of a rule that figures show.
pub(super) trait ShownFrame: RuleFrame {
    /// Direction of view.
    type View: Copy;

    /// Returns a point as seen.
    fn seen(point: Self::Point, view: Self::View) -> DVec2;

    /// Returns the base element in the place of a listed element; without outlines if it is not visible, or just the
    /// line of the element.
    fn shape(
        element: &ListedElement,
        points: &[Self::Point],
        base: &Self::BaseElement,
        view: Self::View,
    ) -> Shape;

    /// Returns a base element in the unit frame.
    fn alone(base: &Self::BaseElement, view: Self::View) -> Shape;

    /// Returns the outlines of a base element in a frame, from the back to the front.
    fn outlined(base: &Self::BaseElement, frame: &Self, view: Self::View) -> Vec<Outline>;

    /// Returns whether a base element is just the line of the element.
    fn is_line(base: &Self::BaseElement) -> bool;

    /// Returns whether a base element is closed.
    fn is_closed(base: &Self::BaseElement) -> bool;

    /// Returns whether a base element has a front, and a normal.
    fn has_front(base: &Self::BaseElement) -> bool;
}

impl ShownFrame for Frame2 {
    type View = ();

    fn seen(point: DVec2, (): ()) -> DVec2 {
        point
    }

    fn shape(element: &ListedElement, points: &[DVec2], base: &BaseElement, (): ()) -> Shape {
        let [from, to] = [points[element.from], points[element.to]];
        if base.is_line() || !element.visible || from == to || !from.is_finite() || !to.is_finite()
        {
            return Shape::NONE;
        }
        let frame = Self::between(from, to, element.direction);
        let mut bounds = Bounds::EMPTY;
        base.add_to(&mut bounds, &frame, 0.0);
        Shape {
            outlines: vec![outline(base).transformed(frame.map())],
            bounds,
            normal: None,
        }
    }

    fn alone(base: &BaseElement, (): ()) -> Shape {
        let mut bounds = Bounds::EMPTY;
        base.add_to(&mut bounds, &Self::UNIT, 0.0);
        Shape {
            outlines: vec![outline(base)],
            bounds,
            normal: None,
        }
    }

    fn outlined(base: &BaseElement, frame: &Self, (): ()) -> Vec<Outline> {
        vec![outline(base).transformed(frame.map())]
    }

    fn is_line(base: &BaseElement) -> bool {
        base.is_line()
    }

    fn is_closed(base: &BaseElement) -> bool {
        base.is_closed()
    }

    fn has_front(_: &BaseElement) -> bool {
        false
    }
}

impl ShownFrame for Frame3 {
    /// Rotation to coordinates of the viewer.
    type View = DMat3;

    fn seen(point: DVec3, view: DMat3) -> DVec2 {
        (view * point).truncate()
    }

    fn shape(element: &ListedElement, points: &[DVec3], base: &Body, view: DMat3) -> Shape {
        let frame = Self::placed(element, points);
        let is_free = element.attitude == ListedAttitude::Least && Self::is_line(base);
        if !element.visible || !frame.is_in_range() || is_free {
            return Shape::NONE;
        }
        let shape = shown(base, &frame, view);
        Shape {
            outlines: match Self::is_line(base) {
                true => Vec::new(),
                false => shape.outlines,
            },
            ..shape
        }
    }

    fn alone(base: &Body, view: DMat3) -> Shape {
        let shape = shown(base, &Self::UNIT, view);
        Shape {
            normal: shape.normal.filter(|_| !Self::is_line(base)),
            ..shape
        }
    }

    fn outlined(base: &Body, frame: &Self, view: DMat3) -> Vec<Outline> {
        shown(base, frame, view).outlines
    }

    fn is_line(base: &Body) -> bool {
        *base == Body::line()
    }

    fn is_closed(base: &Body) -> bool {
        !Self::is_line(base)
    }

    fn has_front(base: &Body) -> bool {
        !Self::is_line(base)
    }
}

/// Returns a base element in a frame as seen from a direction, with its farthest parts first.
fn shown(base: &Body, frame: &Frame3, view: DMat3) -> Shape {
    let map = DAffine3::from_mat3(view) * *frame.map();
    let surfaces = base.surfaces().iter();
    let mut seen: Vec<_> = surfaces
        .map(|surface| space::seen(&surface.solid, &map))
        .collect();
    seen.sort_by(|(.., a), (.., b)| a.total_cmp(b));
    let outlines: Vec<_> = seen
        .into_iter()
        .flat_map(|(outline, edges, _)| std::iter::once(outline).chain(edges))
        .collect();
    let mut bounds = Bounds::EMPTY;
    let ends = { outlines.iter().flat_map(flattened) }.flatten();
    ends.for_each(|end| bounds.add(end));
    // The arrow rises from the middle of the front, or else of the element.
    let front = { base.surfaces().iter() }.find(|it| it.solid.polygons().len() == 1);
    let foot = front.map_or(DVec3::X / 2.0, |front| middle(&front.solid));
    let up = map.transform_vector3(DVec3::Z).normalize_or_zero() * frame.length() * NORMAL;
    let foot = map.transform_point3(foot);
    Shape {
        outlines,
        bounds,
        normal: Some([foot, foot + up].map(DVec3::truncate)),
    }
}

/// Returns the mean of the corners of a polygon.
#[expect(clippy::cast_precision_loss, reason = "there are few corners")]
fn middle(polygon: &Solid) -> DVec3 {
    let corners = polygon.corners();
    corners.iter().sum::<DVec3>() / corners.len().max(1) as f64
}
