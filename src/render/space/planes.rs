//! Convex solids as linear functions of the position in samples, and their rows of samples.

use crate::geometry::DVec3;

use super::buffer::{BLOCK, BLOCKS_ALONG, CLASS_BITS, EMPTY};
use super::camera::Projection;
use super::lit::Classes;
use super::solid::View;

/// Share of its slope by which a plane counts as seen edge-on, and a side as one along the rows.
const EDGE_ON: f64 = 1e-12;

/// Samples that are drawn together.
pub(super) const LANES: usize = 8;

/// Length of rows of samples of which the ends may be left out.
pub(super) const LONG: usize = 16;

/// A linear function of the position in samples, `z` + `x` · x + `y` · y.
#[derive(Clone, Copy, Default)]
struct Plane {
    x: f64,
    y: f64,
    z: f64,
}

impl Plane {
    /// Returns the face of a half-space n · x ≤ d as z = plane / across.
    fn of(projection: Projection, normal: DVec3, distance: f64) -> (Self, f64) {
        match projection {
            Projection::Parallel => (
                Self {
                    x: -normal.x,
                    y: -normal.y,
                    z: distance,
                },
                normal.z,
            ),
            Projection::Central { focus, middle } => {
                let [x, y] = [normal.x / focus, normal.y / focus];
                let z = -normal.z - x * middle[0] - y * middle[1];
                // With w = 1 / distance from the viewer, n · x ≤ d is n · ray ≤ d w.
                (
                    Self {
                        x: -x,
                        y: -y,
                        z: -z,
                    },
                    -distance,
                )
            }
        }
    }

    fn divided(&self, by: f64) -> Self {
        Self {
            x: self.x / by,
            y: self.y / by,
            z: self.z / by,
        }
    }

    fn negated(&self) -> Self {
        Self {
            x: -self.x,
            y: -self.y,
            z: -self.z,
        }
    }

    /// Returns the size of the slopes.
    fn slope(&self) -> f64 {
        self.x.abs() + self.y.abs()
    }
}

/// The faces of a convex solid as functions of the position in samples.
///
/// Their values are z in a parallel picture, and one over the distance in a picture from a point, where planes
/// are linear functions, too.
#[derive(Default)]
pub(super) struct Planes {
    /// The solid lies below.
    front: Vec<Plane>,
    /// Classes of these faces.
    classes: Vec<u16>,
    /// The solid lies above.
    back: Vec<Plane>,
    /// Faces seen edge-on: the solid lies where they are at most 0.
    edges: Vec<Plane>,
    /// Sides of the solid as it is seen.
    sides: Sides,
}

/// Lines between which a convex solid is seen: on every row of samples, from the rightmost of the lines `left` to the leftmost of
/// `right`.
#[derive(Default)]
struct Sides {
    left: Vec<[f64; 2]>,
    right: Vec<[f64; 2]>,
}

impl Sides {
    /// Confines the solid to where a linear function of the place is at most 0. `size` is that of the numbers of which its
    /// slope is the difference: a slope across the rows that is rounding confines nothing.
    fn add(&mut self, plane: &Plane, size: f64) {
        // At height y, the function vanishes at x = a y + b.
        let line = [-plane.y / plane.x, -plane.z / plane.x];
        let least = EDGE_ON * size;
        if plane.x > least {
            self.right.push(line);
        } else if plane.x < -least {
            self.left.push(line);
        }
    }

    /// Returns the first and the last place at height `y` between the lines.
    fn at(&self, y: f64) -> [f64; 2] {
        let place = |[a, b]: &[f64; 2]| a * y + b;
        let first = self
            .left
            .iter()
            .map(place)
            .fold(f64::NEG_INFINITY, f64::max);
        let last = self.right.iter().map(place).fold(f64::INFINITY, f64::min);
        [first, last]
    }
}

impl Planes {
    /// Takes the half-spaces n · x ≤ d whose intersection is a solid, with the classes of its faces.
    pub(super) fn set(
        &mut self,
        projection: Projection,
        faces: impl Iterator<Item = (DVec3, f64)>,
        classes: &mut Classes<'_>,
    ) {
        self.front.clear();
        self.classes.clear();
        self.back.clear();
        self.edges.clear();
        for (normal, distance) in faces {
            let (plane, across) = Plane::of(projection, normal, distance);
            if across.abs() <= EDGE_ON * plane.slope() {
                self.edges.push(plane.negated());
                continue;
            }
            let plane = plane.divided(across);
            if across > 0.0 {
                self.front.push(plane);
                self.classes.push(classes.of(normal));
            } else {
                self.back.push(plane);
            }
        }
        if let Projection::Central { .. } = projection {
            // Nothing is seen that is behind the viewer.
            self.back.push(Plane::default());
        }
    }

    /// Adds a half-space whose face is seen edge-on, but for rounding, before the sides are found.
    pub(super) fn add_edge(&mut self, projection: Projection, (normal, distance): (DVec3, f64)) {
        let (plane, _) = Plane::of(projection, normal, distance);
        self.edges.push(plane.negated());
    }

    /// Adds a half-space that contains the solid, if its face is seen from the front, after the sides have been found. It has no
    /// class, and serves to find [open blocks](Self::open_blocks) only.
    pub(super) fn add_front(&mut self, projection: Projection, (normal, distance): (DVec3, f64)) {
        let (plane, across) = Plane::of(projection, normal, distance);
        if across > EDGE_ON * plane.slope() {
            self.front.push(plane.divided(across));
        }
    }

    /// Finds the sides, farther away by `spread` along the axes, if rows of `width` samples are long enough for them.
    pub(super) fn find_sides(&mut self, width: usize, spread: f64) -> bool {
        let Self {
            front,
            back,
            edges,
            sides,
            ..
        } = self;
        if width < LONG.max(front.len() * back.len() / 2) {
            return false;
        }
        sides.left.clear();
        sides.right.clear();
        for front in &*front {
            for back in &*back {
                let size = front.slope() + back.slope();
                let plane = Plane {
                    x: back.x - front.x,
                    y: back.y - front.y,
                    z: back.z - front.z - size * spread,
                };
                sides.add(&plane, size);
            }
        }
        for edge in &*edges {
            let size = edge.slope();
            let plane = Plane {
                z: edge.z - size * spread,
                ..*edge
            };
            sides.add(&plane, size);
        }
        true
    }

    /// Returns the first and the last place at a height at which the solid may be seen, once its sides are found, and a sample
    /// more on both sides, for rounding.
    pub(super) fn ends(&self, y: f64) -> [f64; 2] {
        let [first, last] = self.sides.at(y);
        [first - 1.0, last + 1.0]
    }

    /// Returns the part of a range of samples on a row of a tile on which the solid may be seen, once its sides are found. It
    /// starts a whole number of lanes after the start of the range, so that samples are computed alike.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "tiles are small, and casts from floats saturate"
    )]
    pub(super) fn seen_on_row(
        &self,
        view: &View<'_>,
        y: usize,
        [left, right]: [usize; 2],
    ) -> [usize; 2] {
        let ends = self.ends(view.corner[1] + y as f64 + 0.5);
        let [first, last] = ends.map(|end| end - view.corner[0] - 0.5);
        let first = (first as usize).clamp(left, right);
        let last = ((last + 2.0) as usize).clamp(left, right);
        let first = left + (first - left) / LANES * LANES;
        [first, last.max(first)]
    }

    /// Returns the blocks of a row of blocks, as bits, on which the solid is not strictly behind all that is shown; only those
    /// between two `columns` are examined. `keys` are the largest of the blocks.
    pub(super) fn open_blocks(
        &self,
        view: &View<'_>,
        row: usize,
        columns: [usize; 2],
        keys: &[u32; BLOCKS_ALONG],
    ) -> u64 {
        open_blocks(&self.front, view, row, columns, keys)
    }

    /// Returns the nearest value at a point of the picture, its slopes, and the class of its face; `None` if the solid is
    /// farther from the point than `spread`, along the axes.
    pub(super) fn meet(&self, [x, y]: [f64; 2], spread: f64) -> Option<(f64, [f64; 2], u16)> {
        let at = |plane: &Plane| plane.z + plane.x * x + plane.y * y;
        let room = |plane: &Plane| plane.slope() * spread;
        if self.edges.iter().any(|edge| at(edge) > room(edge)) {
            return None;
        }
        let (mut high, mut nearest) = (f64::INFINITY, (f64::INFINITY, [0.0; 2], 0));
        for (front, class) in self.front.iter().zip(&self.classes) {
            let z = at(front);
            high = high.min(z + room(front));
            if z < nearest.0 {
                nearest = (z, [front.x, front.y], *class);
            }
        }
        let low = self.back.iter().map(|back| at(back) - room(back));
        (high >= low.fold(f64::NEG_INFINITY, f64::max)).then_some(nearest)
    }
}

#[cfg_attr(feature = "simd", multiversion::multiversion(targets = "simd"))]
#[expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    reason = "tiles are small"
)]
fn open_blocks(
    front: &[Plane],
    view: &View<'_>,
    row: usize,
    [start, end]: [usize; 2],
    keys: &[u32; BLOCKS_ALONG],
) -> u64 {
    let is_parallel = matches!(view.projection, Projection::Parallel);
    let side = BLOCK as f64;
    let half = (side - 1.0) / 2.0;
    let middle = |corner: f64, block: usize| corner + (block as f64 + 0.5) * side;
    let [corner_x, corner_y] = view.corner;
    let at_y = middle(corner_y, row);
    let mut open = 0;
    for first in (start / LANES * LANES..end).step_by(LANES) {
        let at_x = middle(corner_x, first);
        let mut highest = [f64::INFINITY; LANES];
        for plane in front {
            // The value at the nearest sample of a block.
            let nearest = plane.z + plane.y * at_y + plane.x * at_x + plane.slope() * half;
            for (step, highest) in highest.iter_mut().enumerate() {
                let z = nearest + plane.x * side * step as f64;
                *highest = if z < *highest { z } else { *highest };
            }
        }
        let keys = &keys[first..first + LANES];
        for (lane, (high, key)) in highest.into_iter().zip(keys).enumerate() {
            let z = if is_parallel { high } else { -1.0 / high };
            // One less for rounding.
            let depth = view.depths.of(z).saturating_sub(1);
            open |= u64::from(*key >= depth << CLASS_BITS) << (first + lane);
        }
    }
    let before = |end: usize| !u64::MAX.unbounded_shl(end as u32);
    open & before(end) & !before(start)
}

/// Draws a solid on a part of a row of samples, whose first one is given. Its faces have their own classes if they
/// are `LIT`, or else all have `class`.
#[cfg_attr(feature = "simd", multiversion::multiversion(targets = "simd"))]
#[expect(clippy::cast_precision_loss, reason = "tiles are small")]
pub(super) fn draw_row<const LIT: bool>(
    planes: &Planes,
    row: &mut [u32],
    view: &View<'_>,
    [left, y]: [usize; 2],
    class: u16,
) {
    let is_parallel = matches!(view.projection, Projection::Parallel);
    let [corner_x, corner_y] = view.corner;
    let at_y = corner_y + y as f64 + 0.5;
    for (number, keys) in row.chunks_mut(LANES).enumerate() {
        let first = corner_x + (left + number * LANES) as f64 + 0.5;
        let at = |plane: &Plane| plane.z + plane.y * at_y + plane.x * first;
        let mut highest = [f64::INFINITY; LANES];
        let mut classes = [u32::from(class); LANES];
        for (plane, own) in planes.front.iter().zip(&planes.classes) {
            let start = at(plane);
            for (step, highest) in highest.iter_mut().enumerate() {
                let z = start + plane.x * step as f64;
                if LIT {
                    classes[step] = if z < *highest {
                        u32::from(*own)
                    } else {
                        classes[step]
                    };
                }
                *highest = if z < *highest { z } else { *highest };
            }
        }
        let mut lowest = [f64::NEG_INFINITY; LANES];
        for plane in &planes.back {
            let start = at(plane);
            for (step, lowest) in lowest.iter_mut().enumerate() {
                let z = start + plane.x * step as f64;
                *lowest = if z > *lowest { z } else { *lowest };
            }
        }
        for plane in &planes.edges {
            let start = at(plane);
            for (step, lowest) in lowest.iter_mut().enumerate() {
                let is_beyond = start + plane.x * step as f64 > 0.0;
                *lowest = if is_beyond { f64::INFINITY } else { *lowest };
            }
        }
        let mut own = [EMPTY; LANES];
        for lane in 0..LANES {
            let (high, low) = (highest[lane], lowest[lane]);
            let z = if is_parallel { high } else { -1.0 / high };
            let key = view.depths.of(z) << CLASS_BITS | classes[lane];
            own[lane] = if (high >= low) & (high < f64::INFINITY) {
                key
            } else {
                EMPTY
            };
        }
        for (key, own) in keys.iter_mut().zip(own) {
            *key = (*key).min(own);
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::render::space::buffer::SIDE;
    use crate::render::space::solid::Depths;

    const CORNER: [f64; 2] = [256.0, 512.0];

    /// Returns faces about a point on the tile, in front of the viewer. Many of them are seen edge-on, or along the rows.
    fn faces() -> impl Strategy<Value = Vec<(DVec3, f64)>> {
        let part = || prop_oneof![-1.0..1.0, Just(0.0), Just(1e-17), Just(-1e-17), Just(1.0)];
        let distance = prop_oneof![5.0..60.0, Just(12.5), Just(30.5)];
        let face = ((part(), part(), part()), distance).prop_map(|((x, y, z), distance)| {
            let normal = DVec3::new(x, y, z);
            let middle = DVec3::new(CORNER[0] + 31.0, CORNER[1] + 40.0, -90.0);
            (normal, distance * normal.length() + normal.dot(middle))
        });
        proptest::collection::vec(face, 1..12)
    }

    fn view(is_central: bool) -> View<'static> {
        let projection = match is_central {
            true => Projection::Central {
                focus: 90.0,
                middle: [CORNER[0] + 3.0, CORNER[1] - 5.0],
            },
            false => Projection::Parallel,
        };
        View {
            projection,
            depths: Depths::new([-300.0, 0.0]),
            cuts: &[],
            corner: CORNER,
        }
    }

    /// Returns the samples of a row from `left` on, in the whole row and in its seen part.
    fn drawn<const LIT: bool>(
        planes: &Planes,
        view: &View<'_>,
        [left, y]: [usize; 2],
    ) -> ([[u32; SIDE]; 2], usize) {
        let (mut whole, mut part) = ([EMPTY; SIDE], [EMPTY; SIDE]);
        draw_row::<LIT>(planes, &mut whole[left..], view, [left, y], 0);
        let [first, last] = planes.seen_on_row(view, y, [left, SIDE]);
        draw_row::<LIT>(planes, &mut part[first..last], view, [first, y], 0);
        ([whole, part], last - first)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]

        #[test]
        fn samples_beyond_the_sides_show_nothing(
            faces in faces(),
            is_central: bool,
            left in 0_usize..64,
        ) {
            let view = view(is_central);
            let mut planes = Planes::default();
            planes.set(view.projection, faces.into_iter(), &mut Classes::One(0));
            prop_assert!(planes.find_sides(SIDE, 0.0));
            for y in (0..SIDE).step_by(5) {
                let ([whole, part], _) = drawn::<false>(&planes, &view, [left, y]);
                prop_assert_eq!(whole, part);
                let ([whole, part], _) = drawn::<true>(&planes, &view, [left, y]);
                prop_assert_eq!(whole, part);
            }
        }
    }

    #[test]
    fn rows_of_a_slanted_board_are_short() {
        let view = view(false);
        let middle = DVec3::new(CORNER[0] + 100.0, CORNER[1] + 100.0, -90.0);
        let axes = [
            DVec3::new(0.6, 0.8, 0.0),
            DVec3::new(0.8, -0.6, 0.0),
            DVec3::Z,
        ];
        let faces = axes
            .into_iter()
            .zip([4.0, 70.0, 3.0])
            .flat_map(|(axis, half)| {
                [axis, -axis].map(|normal| (normal, half + normal.dot(middle)))
            });
        let mut planes = Planes::default();
        planes.set(view.projection, faces, &mut Classes::One(0));
        assert!(planes.find_sides(SIDE, 0.0));
        let ([whole, part], width) = drawn::<false>(&planes, &view, [0, 100]);
        assert_eq!(whole, part);
        let seen = whole.iter().filter(|key| **key < EMPTY).count();
        assert!(seen > 10 && width < seen + 2 * LANES, "{seen} {width}");
    }
}
