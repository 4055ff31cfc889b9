//! Convex polygons on a picture, with their distances from the viewer.

use crate::geometry::{Bounds, DVec2, DVec3};

/// Mean width of areas, in pixels, that count as empty: positions are rounded to hundredths.
const SLIVER: f64 = 0.01;

/// Corner of a polygon.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// Position on the picture in pixels, y down, and nearness: a number that rises towards the viewer and that is a
    /// linear function of the position on every plane.
    pub(super) at: DVec3,
    /// Whether the edge to the next corner is one of the surface, that lines show.
    pub(super) is_edge: bool,
}

/// Returns the part of a convex polygon on which a linear function is at most 0; the new edge, where it is 0, is an
/// edge of the surface if `is_edge`.
pub(super) fn clip(corners: &[Corner], is_edge: bool, value: impl Fn(DVec3) -> f64) -> Vec<Corner> {
    let mut part = Vec::with_capacity(corners.len() + 1);
    for (number, corner) in corners.iter().enumerate() {
        let next = &corners[(number + 1) % corners.len()];
        let [here, there] = [value(corner.at), value(next.at)];
        if here <= 0.0 {
            part.push(*corner);
        }
        if (here < 0.0 && there > 0.0) || (here > 0.0 && there < 0.0) {
            let at = corner.at.lerp(next.at, here / (here - there));
            let is_edge = if here < 0.0 { is_edge } else { corner.is_edge };
            part.push(Corner { at, is_edge });
        } else if here == 0.0 && there > 0.0 {
            part.last_mut()
                .into_iter()
                .for_each(|it| it.is_edge = is_edge);
        }
    }
    part
}

/// Returns the area of a polygon, positive if its corners run from x to y.
fn area(corners: &[Corner]) -> f64 {
    let Some(first) = corners.first() else {
        return 0.0;
    };
    let fan = corners.windows(2).map(|pair| {
        let [a, b] = [pair[0].at - first.at, pair[1].at - first.at];
        a.truncate().perp_dot(b.truncate())
    });
    fan.sum::<f64>() / 2.0
}

/// Returns whether a polygon is too narrow to count.
pub(super) fn is_sliver(corners: &[Corner]) -> bool {
    let around = corners.iter().zip(corners.iter().cycle().skip(1));
    let around = around.map(|(a, b)| (b.at - a.at).truncate().length());
    2.0 * area(corners).abs() <= SLIVER * around.sum::<f64>()
}

/// Nearness on a plane, as a function of the position.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    origin: DVec3,
    slope: DVec2,
}

impl Plane {
    /// Returns the plane of a polygon; `None` if it is seen edge-on.
    fn of(corners: &[Corner]) -> Option<Self> {
        let origin = corners.first()?.at;
        let fan = corners.windows(2);
        let normal: DVec3 = fan
            .map(|pair| (pair[0].at - origin).cross(pair[1].at - origin))
            .sum();
        let slope = -normal.truncate() / normal.z;
        slope.is_finite().then_some(Self { origin, slope })
    }

    #[inline]
    pub(super) fn at(&self, point: DVec2) -> f64 {
        self.origin.z + self.slope.dot(point - self.origin.truncate())
    }
}

/// A convex polygon whose corners run from x to y.
#[derive(Clone, Debug)]
pub(super) struct Polygon {
    corners: Vec<Corner>,
    plane: Plane,
    bounds: Bounds,
}

/// Order of two polygons where both are seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// Polygons that do not overlap on the picture.
    Apart,
    /// The first polygon is nearer to the viewer.
    Before,
    /// The second polygon is nearer.
    Behind,
    /// Polygons in one plane.
    Level,
    /// Polygons that cross each other.
    Crossing,
}

impl Polygon {
    /// Creates a polygon; `None` if it is too narrow to be seen.
    pub(super) fn new(mut corners: Vec<Corner>) -> Option<Self> {
        if corners.len() < 3 || is_sliver(&corners) {
            return None;
        }
        let plane = Plane::of(&corners)?;
        if area(&corners) < 0.0 {
            // Edges stay between their corners.
            corners.reverse();
            let first = corners[0].is_edge;
            for number in 1..corners.len() {
                corners[number - 1].is_edge = corners[number].is_edge;
            }
            corners
                .last_mut()
                .into_iter()
                .for_each(|it| it.is_edge = first);
        }
        let mut bounds = Bounds::EMPTY;
        { corners.iter() }.for_each(|corner| bounds.add(corner.at.truncate()));
        Some(Self {
            corners,
            plane,
            bounds,
        })
    }

    pub(super) fn corners(&self) -> &[Corner] {
        &self.corners
    }

    pub(super) fn plane(&self) -> &Plane {
        &self.plane
    }

    pub(super) fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// Returns the mean of the corners.
    pub(super) fn middle(&self) -> DVec3 {
        #[expect(clippy::cast_precision_loss, reason = "polygons have few corners")]
        let number = self.corners.len() as f64;
        { self.corners.iter() }
            .map(|corner| corner.at)
            .sum::<DVec3>()
            / number
    }

    /// Returns whether a point lies in the polygon.
    pub(super) fn contains(&self, point: DVec2) -> bool {
        self.edges().all(|([from, to], _)| {
            let edge = (to - from).truncate();
            edge.perp_dot(point - from.truncate()) >= 0.0
        })
    }

    /// Iterates over the edges: their ends, and whether they are edges of the surface.
    pub(super) fn edges(&self) -> impl Iterator<Item = ([DVec3; 2], bool)> {
        let ends = self.corners.iter().zip(self.corners.iter().cycle().skip(1));
        ends.map(|(from, to)| ([from.at, to.at], from.is_edge))
    }

    /// Returns the part in which a linear function is at most 0.
    pub(super) fn part(&self, value: impl Fn(DVec3) -> f64) -> Option<Self> {
        let corners = clip(&self.corners, false, value);
        (!is_sliver(&corners)).then(|| {
            let mut bounds = Bounds::EMPTY;
            { corners.iter() }.for_each(|corner| bounds.add(corner.at.truncate()));
            Self {
                corners,
                plane: self.plane,
                bounds,
            }
        })
    }

    /// Returns the parts behind the plane of another polygon, and before it.
    pub(super) fn split(&self, plane: &Plane) -> [Option<Self>; 2] {
        [1.0, -1.0].map(|side| self.part(|at| side * (at.z - plane.at(at.truncate()))))
    }

    /// Returns the order of two polygons; differences of nearness up to `tolerance` are none.
    pub(super) fn order(&self, other: &Self, tolerance: f64) -> Order {
        let (a, b) = (&self.bounds, &other.bounds);
        let overlap = a.max().min(b.max()) - a.min().max(b.min());
        if overlap.min_element() <= 0.0 {
            return Order::Apart;
        }
        let mut common = self.corners.clone();
        for ([from, to], _) in other.edges() {
            let (from, along) = (from.truncate(), (to - from).truncate());
            common = clip(&common, false, |at| -along.perp_dot(at.truncate() - from));
            if common.len() < 3 {
                return Order::Apart;
            }
        }
        if is_sliver(&common) {
            return Order::Apart;
        }
        let nearer = |at: DVec3| {
            let at = at.truncate();
            self.plane.at(at) - other.plane.at(at)
        };
        let ends = common.iter().map(|corner| nearer(corner.at));
        let (least, most) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), it| {
            (least.min(it), most.max(it))
        });
        match (least >= -tolerance, most <= tolerance) {
            (true, true) => Order::Level,
            (true, false) => Order::Before,
            (false, true) => Order::Behind,
            (false, false) if is_sliver(&clip(&common, false, nearer)) => Order::Before,
            (false, false) if is_sliver(&clip(&common, false, |at| -nearer(at))) => Order::Behind,
            (false, false) => Order::Crossing,
        }
    }

    /// Returns the part of a line, from 0 to 1 along it, that lies in the polygon, made larger on all sides by a
    /// number of pixels.
    pub(super) fn crossing(&self, [from, to]: [DVec2; 2], larger: f64) -> Option<[f64; 2]> {
        let along = to - from;
        let (mut begin, mut end) = (0.0f64, 1.0f64);
        for ([corner, next], _) in self.edges() {
            let edge = (next - corner).truncate();
            let room = larger * edge.length();
            // The line is inside where edge × (point − corner) ≥ −room.
            let (at, rise) = (
                edge.perp_dot(from - corner.truncate()) + room,
                edge.perp_dot(along),
            );
            if rise > 0.0 {
                begin = begin.max(-at / rise);
            } else if rise < 0.0 {
                end = end.min(at / -rise);
            } else if at < 0.0 {
                return None;
            }
        }
        (begin < end).then_some([begin, end])
    }
}
