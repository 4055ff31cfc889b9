//! Drawing of convex solids into a depth buffer.

#[cfg(test)]
mod tests;

use crate::geometry::{DAffine3, DMat3, DVec3, Frame3, HalfSpace, Round, Solid, eigen};
use crate::graph::Graph;

use super::buffer::{Buffer, CLASS_BITS, EMPTY, SIDE, STEPS};
use super::camera::Projection;
use super::lit::Classes;
use super::open::draw_open;
use super::planes::{Planes, draw_row};
use super::round::{self, Surface};

/// Least thickness of a solid, in samples: what is flat would fall between them.
const THINNEST: f64 = 1.5;

/// Samples by which a flat solid may exceed its extent, as it is drawn.
const PAD: f64 = 1.5;

/// Determinant of a matrix whose columns have a mean square of 1, above which it is not flat. A bar of square section is
/// flat if it is more than five times as long as wide: as long as a pixel, it would fall between samples.
const FLAT: f64 = 0.2;

/// Depths in multiples of 2⁻²² of the range.
#[derive(Clone, Copy)]
pub(super) struct Depths {
    near: f64,
    steps: f64,
}

impl Depths {
    /// Creates the depths of a range of z, which are all equal if it is flat.
    pub(super) fn new([far, near]: [f64; 2]) -> Self {
        // Samples of which a smaller range is rounding.
        const FLAT: f64 = 1e-6;
        let range = near - far;
        let steps = if range > FLAT { STEPS / range } else { 0.0 };
        Self { near, steps }
    }

    /// Returns the number of steps a unit of z.
    pub(super) fn steps(&self) -> f64 {
        self.steps
    }

    /// Returns the depth of a point in steps, 0 at the near end.
    #[inline(always)]
    pub(super) fn exact(&self, z: f64) -> f64 {
        (self.near - z) * self.steps
    }

    /// Returns the depth of a point in whole steps.
    #[inline(always)]
    pub(super) fn of(&self, z: f64) -> u32 {
        let exact = self.exact(z);
        let exact = if exact > 0.0 { exact } else { 0.0 };
        whole(if exact < STEPS { exact } else { STEPS })
    }
}

/// Returns the whole part of a number from 0 to 2³¹, by operations that vectors have.
#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "the low bits are the number"
)]
pub(super) fn whole(value: f64) -> u32 {
    // Of this size, numbers are whole.
    const LARGE: f64 = (1_u64 << 52) as f64;
    let near = (value + LARGE) - LARGE;
    let below = if near > value { near - 1.0 } else { near };
    (below + LARGE).to_bits() as u32
}

/// A solid in its place in the coordinates of the projection.
#[derive(Clone, Copy)]
pub(super) struct Body<'a> {
    solid: &'a Solid,
    place: DAffine3,
    /// Distance by which it is larger, about.
    more: f64,
}

impl<'a> Body<'a> {
    /// Creates the image of a solid under a map.
    pub(super) fn new(solid: &'a Solid, map: &DAffine3) -> Self {
        Self {
            solid,
            place: *map * *solid.place(),
            more: 0.0,
        }
    }

    /// Returns the solid, larger by a distance about its middle.
    pub(super) fn grown(self, more: f64) -> Self {
        Self {
            more: self.more + more,
            ..self
        }
    }

    /// Returns the map to its place, at least as thick as a sample.
    fn thick(&self, view: &View<'_>) -> DAffine3 {
        let at = self.place.translation;
        let least = THINNEST / 2.0 / view.scale(at.z);
        DAffine3::from_mat3_translation(thickened(&self.place.matrix3, least), at)
    }

    /// Returns the half-spaces n · x ≤ d.
    pub(super) fn faces(&self, view: &View<'_>) -> impl Iterator<Item = (DVec3, f64)> {
        let place = self.thick(view);
        let inverse = place.matrix3.inverse().transpose();
        let more = self.more;
        self.solid.faces().iter().map(move |face| {
            let normal = inverse * face.normal;
            let distance = face.distance + normal.dot(place.translation);
            // Without this choice, every face would need a root.
            match more > 0.0 {
                true => (normal, distance + more * normal.length()),
                false => (normal, distance),
            }
        })
    }

    /// Returns the surface, if it is round.
    pub(super) fn surface(&self, view: &View<'_>) -> Option<Surface> {
        let primitive = self.solid.primitive()?;
        let place = self.thick(view);
        let place = match self.more > 0.0 {
            true => grown(primitive, &place, self.more),
            false => place,
        };
        Some(Surface::new(primitive, &place))
    }
}

/// Returns the map to the place of a larger primitive, about its middle.
fn grown(primitive: Round, place: &DAffine3, more: f64) -> DAffine3 {
    // Half the height, and the middle: all primitives but the ball reach from y = 0 to y = 1.
    let (half, middle) = match primitive {
        Round::Ball => (1.0, DVec3::ZERO),
        _ => (0.5, DVec3::Y / 2.0),
    };
    let unit = DMat3::from_diagonal(DVec3::new(1.0, half, 1.0));
    let matrix = with_values(&(place.matrix3 * unit), |value| value + more) * unit.inverse();
    let at = place.translation + place.matrix3 * middle - matrix * middle;
    DAffine3::from_mat3_translation(matrix, at)
}

/// Draws solids; the lists are reused.
#[derive(Default)]
pub(super) struct Pencil {
    planes: Planes,
    row: round::Row,
}

impl Pencil {
    /// Draws a solid. `rectangle` contains what is seen of it on the tile.
    pub(super) fn draw(
        &mut self,
        buffer: &mut Buffer,
        view: &View<'_>,
        body: &Body<'_>,
        rectangle: [usize; 4],
        mut classes: Classes<'_>,
    ) {
        if let Some(surface) = body.surface(view) {
            let memory = (&mut self.row, &mut self.planes);
            round::draw(buffer, view, &surface, rectangle, &mut classes, memory);
            return;
        }
        let cuts = view.cuts.iter().map(|cut| (cut.normal, cut.distance));
        let faces = body.faces(view).chain(cuts);
        self.planes.set(view.projection, faces, &mut classes);
        let planes = &mut self.planes;
        let [left, top, right, bottom] = rectangle;
        let is_long = planes.find_sides(right - left, 0.0);
        let planes = &*planes;
        let draw = |keys: &mut [u32], at| match classes {
            Classes::One(class) => draw_row::<false>(planes, keys, view, at, class),
            _ => draw_row::<true>(planes, keys, view, at, 0),
        };
        if is_long {
            return draw_open(buffer, view, planes, rectangle, draw);
        }
        for y in top..bottom {
            draw(&mut buffer.row_mut(y)[left..right], [left, y]);
        }
        buffer.refresh(rectangle);
    }
}

/// View of a tile, which all its solids share.
pub(super) struct View<'a> {
    pub(super) projection: Projection,
    pub(super) depths: Depths,
    /// Half-spaces to which the picture is confined, in the coordinates of the projection.
    pub(super) cuts: &'a [HalfSpace],
    /// Upper left corner of the tile, in samples.
    pub(super) corner: [f64; 2],
}

impl View<'_> {
    /// Returns the number of samples a unit at a z.
    fn scale(&self, z: f64) -> f64 {
        match self.projection {
            Projection::Parallel => 1.0,
            Projection::Central { focus, .. } => focus / (-z).max(f64::MIN_POSITIVE),
        }
    }

    /// Returns whether nothing of a box about a point is shown.
    pub(super) fn cuts_off(&self, middle: DVec3, half: DVec3) -> bool {
        self.cuts
            .iter()
            .any(|cut| cut.normal.dot(middle) - cut.normal.abs().dot(half) > cut.distance)
    }

    /// Returns whether a part of a box about a point is not shown.
    pub(super) fn cuts_through(&self, middle: DVec3, half: DVec3) -> bool {
        self.cuts
            .iter()
            .any(|cut| cut.normal.dot(middle) + cut.normal.abs().dot(half) > cut.distance)
    }

    /// Returns the largest number of samples a unit of a box whose nearest point is at a z.
    #[inline]
    pub(super) fn scale_of_box(&self, near: f64) -> f64 {
        match self.projection {
            Projection::Parallel => 1.0,
            Projection::Central { focus, .. } if near < 0.0 => focus / -near,
            Projection::Central { .. } => f64::INFINITY,
        }
    }

    /// Returns the extents of the picture of a box about a point, across and down, in samples; `None` if it is behind the viewer.
    #[inline]
    fn spans(&self, middle: DVec3, half: DVec3) -> Option<[[f64; 2]; 2]> {
        match self.projection {
            Projection::Parallel => Some([
                [middle.x - half.x, middle.x + half.x],
                [middle.y - half.y, middle.y + half.y],
            ]),
            Projection::Central {
                focus,
                middle: axis,
            } => {
                let (near, far) = (-(middle.z + half.z), -(middle.z - half.z));
                if near <= 0.0 {
                    // The box reaches behind the viewer, who may see any part of it.
                    let all = [f64::NEG_INFINITY, f64::INFINITY];
                    return (far > 0.0).then_some([all; 2]);
                }
                let span = |at: f64, half: f64, axis: f64| {
                    let seen = |side: f64, end: f64| axis + focus * side / end;
                    let (low, high) = (at - half, at + half);
                    [
                        seen(low, near).min(seen(low, far)),
                        seen(high, near).max(seen(high, far)),
                    ]
                };
                Some([
                    span(middle.x, half.x, axis[0]),
                    span(middle.y, half.y, axis[1]),
                ])
            }
        }
    }

    /// Returns whether a box about a point may be seen in the row of tiles of this one.
    #[expect(clippy::cast_precision_loss, reason = "tiles are small")]
    pub(super) fn has_in_row(&self, middle: DVec3, half: DVec3) -> bool {
        let side = SIDE as f64;
        { self.spans(middle, half) }.is_some_and(|[_, [top, bottom]]| {
            top <= self.corner[1] + side && bottom >= self.corner[1]
        })
    }

    /// Returns the samples of the tile that a box about a point meets; `None` if there are none.
    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "the values are clamped"
    )]
    pub(super) fn rectangle(&self, middle: DVec3, half: DVec3) -> Option<[usize; 4]> {
        let spans = self.spans(middle, half)?;
        let [[left, right], [top, bottom]] = [0, 1].map(|axis| {
            let corner = self.corner[axis];
            let [low, high] = spans[axis].map(|end| end - corner);
            let side = SIDE as f64;
            // Samples lie in the middle of their squares.
            let low = (low - 0.5).clamp(0.0, side);
            let before = low as usize;
            let is_between = low > before as f64;
            [
                before + usize::from(is_between),
                (high + 0.5).clamp(0.0, side) as usize,
            ]
        });
        (left < right && top < bottom).then_some([left, top, right, bottom])
    }
}

/// Returns whether the image of a cube is not flat.
fn is_thick(matrix: &DMat3) -> bool {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let square = x.length_squared() + y.length_squared() + z.length_squared();
    let mean = (square / 3.0).sqrt();
    matrix.determinant().abs() > FLAT * mean * mean * mean
}

/// Returns a matrix whose singular values are at least `least`; the matrix itself if it is not flat.
fn thickened(matrix: &DMat3, least: f64) -> DMat3 {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let square = x.length_squared() + y.length_squared() + z.length_squared();
    let volume = matrix.determinant().abs();
    // The product of all singular values is the determinant, and that of two is at most half the sum of squares.
    if is_thick(matrix) || volume >= least * square / 2.0 && volume > 0.0 {
        return *matrix;
    }
    // The sum of squares of the inverse is that of the inverse values, of which the largest is that of the least.
    let pairs =
        x.cross(y).length_squared() + y.cross(z).length_squared() + z.cross(x).length_squared();
    if volume >= least * pairs.sqrt() && volume > 0.0 {
        return *matrix;
    }
    with_values(matrix, |value| value.max(least))
}

/// Returns a matrix with other singular values.
fn with_values(matrix: &DMat3, change: impl Fn(f64) -> f64) -> DMat3 {
    let (squares, inner) = eigen(&(matrix.transpose() * *matrix));
    let largest = squares.max_element().max(0.0).sqrt();
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| squares[*b].total_cmp(&squares[*a]));
    let mut outer = [DVec3::ZERO; 3];
    let mut changed = DMat3::ZERO;
    for (number, &axis) in order.iter().enumerate() {
        let image = *matrix * inner.col(axis);
        let value = image.length();
        // The directions of vanishing images are those that remain.
        let mut across = image;
        for known in &outer[..number] {
            across -= *known * across.dot(*known);
        }
        let unit = match number {
            _ if across.length() > 1e-9 * largest => across.normalize(),
            0 => DVec3::Z,
            1 => outer[0].any_orthonormal_vector(),
            _ => outer[0].cross(outer[1]),
        };
        outer[number] = unit;
        let direction = inner.col(axis);
        let image = unit * change(value);
        changed += DMat3::from_cols(
            image * direction.x,
            image * direction.y,
            image * direction.z,
        );
    }
    changed
}

/// Returns the samples by which solids may exceed the hulls of their objects: flat ones are drawn thicker than
/// they are, unless all maps are similarities and no solid is flat.
pub(super) fn pad(graph: &Graph<Frame3>) -> f64 {
    let is_flat = |solid: &Solid| !is_thick(&solid.place().matrix3);
    match graph.is_similar() && !graph.base_elements().iter().any(is_flat) {
        true => 0.0,
        false => PAD,
    }
}

/// Returns the depth of a key; `None` if the sample shows nothing.
#[inline]
pub(super) fn depth_of(key: u32) -> Option<u32> {
    (key != EMPTY).then_some(key >> CLASS_BITS)
}
