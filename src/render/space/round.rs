//! Drawing of round solids into a depth buffer: every sample has the exact depth of the surface.

mod rays;
#[cfg(test)]
mod tests;

use std::ops::Range;

use crate::geometry::{DAffine3, DMat3, DVec3, Round};

use super::buffer::{Buffer, CLASS_BITS, EMPTY, SIDE};
use super::camera::Projection;
use super::lit::{Classes, Lit};
use super::open::draw_open;
use super::planes::{LANES, LONG, Planes};
use super::solid::{Depths, View};

use self::rays::{Ray, Shape, cut, least, most, nearest_cut, span, square};

/// Draws a primitive in its place. `rectangle` contains what is seen of it on the tile.
pub(super) fn draw(
    buffer: &mut Buffer,
    view: &View<'_>,
    surface: &Surface,
    rectangle @ [left, top, right, bottom]: [usize; 4],
    classes: &mut Classes<'_>,
    (row, planes): (&mut Row, &mut Planes),
) {
    let is_long = right - left >= LONG && surface.find_sides(view, planes, right - left);
    let mut draw = |keys: &mut [u32], at| surface.draw_row(view, (keys, at), row, classes);
    if is_long {
        return draw_open(buffer, view, planes, rectangle, draw);
    }
    for y in top..bottom {
        draw(&mut buffer.row_mut(y)[left..right], [left, y]);
    }
    buffer.refresh(rectangle);
}

/// Row of samples, as a primitive shows it.
pub(super) struct Row {
    /// Distances along the rays.
    ways: [f64; SIDE],
    /// Keys without classes; [`EMPTY`] where nothing is shown.
    depths: [u32; SIDE],
    levels: [u16; SIDE],
}

impl Default for Row {
    fn default() -> Self {
        Self {
            ways: [0.0; SIDE],
            depths: [EMPTY; SIDE],
            levels: [0; SIDE],
        }
    }
}

/// Normals n of planes n · x = 1, in the coordinates of a primitive, that touch it along lines.
struct Touching {
    /// The one that faces the viewer.
    front: DVec3,
    /// The normals of planes that are seen edge-on, if there are any.
    edges: Option<[DVec3; 2]>,
}

/// A primitive in its place.
pub(super) struct Surface {
    primitive: Round,
    inverse: DMat3,
    middle: DVec3,
}

impl Surface {
    /// Creates the image of a primitive under a map that is not singular.
    pub(super) fn new(primitive: Round, place: &DAffine3) -> Self {
        Self {
            primitive,
            inverse: place.matrix3.inverse(),
            middle: place.translation,
        }
    }

    /// Returns the z of the surface at a point of a parallel picture, and a vector outwards across it; `None` beyond its outline.
    pub(super) fn meet(&self, at: [f64; 2]) -> Option<(f64, DVec3)> {
        let inside = self.inside(self.ray(Projection::Parallel, at));
        let [low, high] = self.span(inside);
        let is_met = low <= high;
        is_met.then(|| (self.middle.z + high, self.normal_inside(inside, high)))
    }

    /// Draws the part of a row of samples whose first one is given.
    #[expect(clippy::cast_precision_loss, reason = "tiles are small")]
    fn draw_row(
        &self,
        view: &View<'_>,
        (keys, [left, y]): (&mut [u32], [usize; 2]),
        row: &mut Row,
        classes: &mut Classes<'_>,
    ) {
        let [corner_x, corner_y] = view.corner;
        let first = [corner_x + left as f64 + 0.5, corner_y + y as f64 + 0.5];
        let Some(seen) = meet(self, view, first, (keys, row)) else {
            return;
        };
        if let (Classes::OfLevels { lit, bits, .. }, []) = (&*classes, view.cuts) {
            light(self, view, first, (lit, *bits), (row, seen.clone()));
        }
        for (x, key) in keys.iter_mut().enumerate().take(seen.end).skip(seen.start) {
            if row.depths[x] == EMPTY {
                continue;
            }
            let class = match classes {
                Classes::One(class) => *class,
                Classes::OfLevels { of, .. } if view.cuts.is_empty() => of(row.levels[x]),
                _ => classes.of(self.normal(view, [first[0] + x as f64, first[1]], row.ways[x])),
            };
            *key = (*key).min(row.depths[x] | u32::from(class));
        }
    }

    /// Finds the sides of the box around the primitive; returns whether rows of `width` samples are long enough
    /// for them.
    pub(super) fn find_sides(&self, view: &View<'_>, planes: &mut Planes, width: usize) -> bool {
        let across = self.inverse.transpose();
        // All primitives but the ball reach from y = 0 to y = 1.
        let low = match self.primitive {
            Round::Ball => DVec3::ONE,
            _ => DVec3::new(1.0, 0.0, 1.0),
        };
        let face = |normal: DVec3, distance: f64| {
            let normal = across * normal;
            (normal, distance + normal.dot(self.middle))
        };
        let axes = [DVec3::X, DVec3::Y, DVec3::Z].into_iter();
        let faces = axes.flat_map(|axis| [face(axis, 1.0), face(-axis, low.dot(axis))]);
        planes.set(view.projection, faces, &mut Classes::One(0));
        let touching = self.touching(view.projection);
        let edges = { touching.iter() }.filter_map(|it| it.edges).flatten();
        for normal in edges {
            planes.add_edge(view.projection, face(normal, 1.0));
        }
        let is_long = planes.find_sides(width, 0.0);
        if let Some(Touching { front, .. }) = touching {
            planes.add_front(view.projection, face(front, 1.0));
        }
        is_long
    }

    /// Returns planes that touch a cone or a cylinder along lines; `None` for a ball, and if it is seen along its axis.
    fn touching(&self, projection: Projection) -> Option<Touching> {
        let slope = match self.primitive {
            Round::Ball => return None,
            Round::Cylinder => 0.0,
            Round::Cone => 1.0,
        };
        // The normals of planes that touch along a line are (cos t, slope, sin t).
        let (across, rest) = match projection {
            Projection::Parallel => {
                let along = self.inverse * DVec3::Z;
                (along, -slope * along.y)
            }
            Projection::Central { .. } => {
                let viewer = self.inverse * -self.middle;
                (viewer, 1.0 - slope * viewer.y)
            }
        };
        let length = across.x.hypot(across.z);
        let [cosine, sine] = [across.x / length, across.z / length];
        // Edges are where x cos t + z sin t = rest.
        let near = rest / length;
        let far = (1.0 - near * near).sqrt();
        let edges = [far, -far].map(|aside| {
            let x = near * cosine - aside * sine;
            let z = near * sine + aside * cosine;
            DVec3::new(x, slope, z)
        });
        (length > 0.0).then_some(Touching {
            front: DVec3::new(cosine, slope, sine),
            edges: (near.abs() < 1.0).then_some(edges),
        })
    }

    /// Returns the ray of a sample. The distance along it is that from the middle, or in perspective from the viewer.
    #[inline(always)]
    fn ray(&self, projection: Projection, [x, y]: [f64; 2]) -> Ray {
        match projection {
            Projection::Parallel => Ray {
                start: DVec3::new(x, y, self.middle.z),
                along: DVec3::Z,
            },
            Projection::Central { focus, middle } => Ray {
                start: DVec3::ZERO,
                along: DVec3::new((x - middle[0]) / focus, (y - middle[1]) / focus, -1.0),
            },
        }
    }

    /// Returns a ray in the coordinates of the primitive.
    #[inline(always)]
    fn inside(&self, seen: Ray) -> Ray {
        Ray {
            start: self.inverse * (seen.start - self.middle),
            along: self.inverse * seen.along,
        }
    }

    /// Returns a vector outwards across the surface where a ray meets it, or a cut through it.
    fn normal(&self, view: &View<'_>, at: [f64; 2], way: f64) -> DVec3 {
        let seen = self.ray(view.projection, at);
        let inside = self.inside(seen);
        let [low, high] = self.span(inside);
        if view.cuts.is_empty() || low <= way && way <= high {
            return self.normal_inside(inside, way);
        }
        nearest_cut(view.cuts, seen.start + seen.along * way)
    }

    /// Returns a vector outwards across the surface where a ray, in the coordinates of the primitive, meets it.
    fn normal_inside(&self, inside: Ray, way: f64) -> DVec3 {
        let point = inside.start + inside.along * way;
        let shape = Shape::of(self.primitive);
        let normal = match self.primitive {
            Round::Ball => shape.normal::<false>(point),
            _ => shape.normal::<true>(point),
        };
        self.inverse.transpose() * normal
    }

    /// Returns the part of a ray, in the coordinates of the primitive, within it; it may be empty.
    fn span(&self, ray: Ray) -> [f64; 2] {
        let quadric = self.primitive.quadric();
        match self.primitive {
            Round::Ball => span::<false, false>(quadric, ray),
            _ => span::<true, false>(quadric, ray),
        }
    }
}

/// Finds where the rays of a row of samples, of which the first is given, meet a primitive. Returns the part that
/// contains all of it that is not behind the `keys`; `None` if nothing is.
fn meet(
    surface: &Surface,
    view: &View<'_>,
    first: [f64; 2],
    row: (&[u32], &mut Row),
) -> Option<Range<usize>> {
    if !view.cuts.is_empty() {
        return meet_cut(surface, view, first, row);
    }
    let is_parallel = matches!(view.projection, Projection::Parallel);
    // All rays are parallel, and meet the surface twice or never.
    let is_twice = is_parallel && square(surface.primitive.quadric(), surface.inverse.z_axis) > 0.0;
    match (surface.primitive, is_parallel, is_twice) {
        (Round::Ball, true, true) => meet_uncut::<false, true, true>(surface, view, first, row),
        (Round::Ball, true, _) => meet_uncut::<false, true, false>(surface, view, first, row),
        (Round::Ball, ..) => meet_uncut::<false, false, false>(surface, view, first, row),
        (_, true, true) => meet_uncut::<true, true, true>(surface, view, first, row),
        (_, true, _) => meet_uncut::<true, true, false>(surface, view, first, row),
        _ => meet_uncut::<true, false, false>(surface, view, first, row),
    }
}

#[cfg_attr(feature = "simd", multiversion::multiversion(targets = "simd"))]
#[expect(clippy::cast_possible_truncation, reason = "tiles are small")]
fn meet_uncut<const CAPPED: bool, const PARALLEL: bool, const TWICE: bool>(
    surface: &Surface,
    view: &View<'_>,
    [first, y]: [f64; 2],
    (keys, row): (&[u32], &mut Row),
) -> Option<Range<usize>> {
    let projection = match view.projection {
        _ if PARALLEL => Projection::Parallel,
        central => central,
    };
    let quadric = surface.primitive.quadric();
    let depths_of = view.depths;
    let count = keys.len().next_multiple_of(LANES);
    let (ways, depths) = (&mut row.ways[..count], &mut row.depths[..count]);
    for x in 0..count {
        let ray = surface.inside(surface.ray(projection, [first + f64::from(x as u32), y]));
        let span @ [low, high] = span::<CAPPED, TWICE>(quadric, ray);
        let way = if PARALLEL { high } else { low };
        ways[x] = way;
        depths[x] = key::<PARALLEL>(surface, depths_of, span);
    }
    hide(keys, depths)
}

fn meet_cut(
    surface: &Surface,
    view: &View<'_>,
    [first, y]: [f64; 2],
    (keys, row): (&[u32], &mut Row),
) -> Option<Range<usize>> {
    for x in 0..keys.len() {
        let seen = surface.ray(view.projection, [first + x as f64, y]);
        let span = cut(surface.span(surface.inside(seen)), view.cuts, seen);
        (row.ways[x], row.depths[x]) = match view.projection {
            Projection::Parallel => (span[1], key::<true>(surface, view.depths, span)),
            Projection::Central { .. } => (span[0], key::<false>(surface, view.depths, span)),
        };
    }
    hide(keys, &mut row.depths)
}

/// Returns the key of a ray, without its class, by its part within the primitive.
#[inline(always)]
fn key<const PARALLEL: bool>(surface: &Surface, depths: Depths, [low, high]: [f64; 2]) -> u32 {
    let z = if PARALLEL {
        surface.middle.z + high
    } else {
        -low
    };
    let is_met = (low <= high) & (PARALLEL | (low > 0.0));
    if is_met {
        depths.of(z) << CLASS_BITS
    } else {
        EMPTY
    }
}

/// Removes what is behind the samples of a row; returns the part that contains all that is left; `None` if nothing is.
#[inline(always)]
fn hide(keys: &[u32], depths: &mut [u32]) -> Option<Range<usize>> {
    let depths = &mut depths[..keys.len()];
    let mut nearest = EMPTY;
    for (depth, key) in depths.iter_mut().zip(keys) {
        *depth = if *depth <= *key { *depth } else { EMPTY };
        nearest = nearest.min(*depth);
    }
    if nearest == EMPTY {
        return None;
    }
    let is_left = |depth: &u32| *depth < EMPTY;
    let start = depths.iter().position(is_left)?;
    let end = depths.iter().rposition(is_left)? + 1;
    Some(start..end)
}

/// Finds the levels of intensity where the rays of a part of a row meet a primitive.
fn light(
    surface: &Surface,
    view: &View<'_>,
    [first, y]: [f64; 2],
    lit: (&Lit, u32),
    (row, part): (&mut Row, Range<usize>),
) {
    // Whole lanes.
    let part = part.start / LANES * LANES..part.end.next_multiple_of(LANES);
    let first = [first + part.start as f64, y];
    let row = (&row.ways[part.clone()], &mut row.levels[part]);
    let is_parallel = matches!(view.projection, Projection::Parallel);
    match (surface.primitive, is_parallel) {
        (Round::Ball, true) => light_on::<false, true>(surface, view, first, lit, row),
        (Round::Ball, false) => light_on::<false, false>(surface, view, first, lit, row),
        (_, true) => light_on::<true, true>(surface, view, first, lit, row),
        (_, false) => light_on::<true, false>(surface, view, first, lit, row),
    }
}

#[cfg_attr(feature = "simd", multiversion::multiversion(targets = "simd"))]
#[expect(clippy::cast_possible_truncation, reason = "tiles are small")]
fn light_on<const CAPPED: bool, const PARALLEL: bool>(
    surface: &Surface,
    view: &View<'_>,
    [first, y]: [f64; 2],
    (lit, bits): (&Lit, u32),
    (ways, levels): (&[f64], &mut [u16]),
) {
    let projection = match view.projection {
        _ if PARALLEL => Projection::Parallel,
        central => central,
    };
    let towards = surface.inverse * lit.towards();
    let across = surface.inverse.transpose();
    let (shape, lit) = (Shape::of(surface.primitive), *lit);
    let ways = &ways[..levels.len()];
    for x in 0..levels.len() {
        let ray = surface.inside(surface.ray(projection, [first + f64::from(x as u32), y]));
        let normal = shape.normal::<CAPPED>(ray.start + ray.along * ways[x]);
        let length = (across * normal).length();
        // Where the normal vanishes, so does the product. A branch would keep rays from being lit at once.
        let cosine = most(1.0, normal.dot(towards) / least(f64::MIN_POSITIVE, length));
        levels[x] = lit.level_of_cosine(cosine, bits);
    }
}
