//! Drawing of round solids into a depth buffer: every sample has the exact depth of the surface.

#[cfg(test)]
mod tests;

use std::ops::Range;

use crate::geometry::{DAffine3, DMat3, DVec3, HalfSpace, Round};

use super::buffer::{Buffer, CLASS_BITS, EMPTY};
use super::camera::Projection;
use super::lit::{Classes, Lit};
use super::planes::{LANES, LONG, Planes};
use super::solid::{Depths, View};

/// Points of a ray: `start` + w · `along`, for real w.
#[derive(Clone, Copy, Default)]
struct Ray {
    start: DVec3,
    along: DVec3,
}

/// Draws the image of a primitive under a map that is not singular. `rectangle` contains what is seen of it on the
/// tile.
#[expect(clippy::cast_precision_loss, reason = "tiles are small")]
pub(super) fn draw(
    buffer: &mut Buffer,
    view: &View<'_>,
    primitive: Round,
    place: &DAffine3,
    [left, top, right, bottom]: [usize; 4],
    classes: &mut Classes<'_>,
    (row, planes): (&mut Row, &mut Planes),
) {
    let surface = Surface {
        primitive,
        inverse: place.matrix3.inverse(),
        middle: place.translation,
    };
    let [corner_x, corner_y] = view.corner;
    let width = right - left;
    let may_be_long = primitive != Round::Ball && width >= LONG;
    let is_long = may_be_long && surface.find_sides(view, planes, width);
    for y in top..bottom {
        let [left, right] = match is_long {
            true => planes.seen_on_row(view, y, [left, right]),
            false => [left, right],
        };
        row.resize((right - left).next_multiple_of(LANES));
        let first = [corner_x + left as f64 + 0.5, corner_y + y as f64 + 0.5];
        meet(&surface, view, first, row);
        let keys = &mut buffer.row_mut(y)[left..right];
        let Some(seen) = hide(keys, row) else {
            continue;
        };
        if let (Classes::OfLevels { lit, bits, .. }, []) = (&*classes, view.cuts) {
            light(&surface, view, first, (lit, *bits), (row, seen.clone()));
        }
        for (x, key) in keys.iter_mut().enumerate().take(seen.end).skip(seen.start) {
            if row.depths[x] == EMPTY {
                continue;
            }
            let class = match classes {
                Classes::One(class) => *class,
                Classes::OfLevels { of, .. } if view.cuts.is_empty() => of(row.levels[x]),
                _ => classes.of(surface.normal(view, [first[0] + x as f64, first[1]], row.ways[x])),
            };
            *key = (*key).min(row.depths[x] | u32::from(class));
        }
    }
}

/// Row of samples, as a primitive shows it.
#[derive(Default)]
pub(super) struct Row {
    /// Distances along the rays.
    ways: Vec<f64>,
    /// Keys without classes; [`EMPTY`] where nothing is shown.
    depths: Vec<u32>,
    levels: Vec<u16>,
}

impl Row {
    fn resize(&mut self, count: usize) {
        self.ways.resize(count, 0.0);
        self.depths.resize(count, EMPTY);
        self.levels.resize(count, 0);
    }
}

/// A primitive in its place.
struct Surface {
    primitive: Round,
    inverse: DMat3,
    middle: DVec3,
}

impl Surface {
    /// Finds the sides of the box around the primitive; returns whether rows of `width` samples are long enough
    /// for them.
    fn find_sides(&self, view: &View<'_>, planes: &mut Planes, width: usize) -> bool {
        let across = self.inverse.transpose();
        // All primitives but the ball reach from y = 0 to y = 1.
        let low = DVec3::new(1.0, 0.0, 1.0);
        let face = |normal: DVec3, distance: f64| {
            let normal = across * normal;
            (normal, distance + normal.dot(self.middle))
        };
        let axes = [DVec3::X, DVec3::Y, DVec3::Z].into_iter();
        let faces = axes.flat_map(|axis| [face(axis, 1.0), face(-axis, low.dot(axis))]);
        planes.set(view.projection, faces, &mut Classes::One(0));
        planes.find_sides(width)
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
            let point = inside.start + inside.along * way;
            let normal = match self.primitive {
                Round::Ball => normal::<false>(self.primitive, point),
                _ => normal::<true>(self.primitive, point),
            };
            return self.inverse.transpose() * normal;
        }
        nearest_cut(view.cuts, seen.start + seen.along * way)
    }

    /// Returns the part of a ray, in the coordinates of the primitive, within it; it may be empty.
    fn span(&self, ray: Ray) -> [f64; 2] {
        let quadric = self.primitive.quadric();
        match self.primitive {
            Round::Ball => span::<false>(quadric, ray),
            _ => span::<true>(quadric, ray),
        }
    }
}

/// Finds where the rays of a row of samples, of which the first is given, meet a primitive.
fn meet(surface: &Surface, view: &View<'_>, first: [f64; 2], row: &mut Row) {
    let is_parallel = matches!(view.projection, Projection::Parallel);
    match (surface.primitive, is_parallel) {
        _ if !view.cuts.is_empty() => meet_cut(surface, view, first, row),
        (Round::Ball, true) => meet_uncut::<false, true>(surface, view, first, row),
        (Round::Ball, false) => meet_uncut::<false, false>(surface, view, first, row),
        (_, true) => meet_uncut::<true, true>(surface, view, first, row),
        (_, false) => meet_uncut::<true, false>(surface, view, first, row),
    }
}

#[cfg_attr(feature = "simd", multiversion::multiversion(targets("x86_64+avx2")))]
#[expect(clippy::cast_possible_truncation, reason = "tiles are small")]
fn meet_uncut<const CAPPED: bool, const PARALLEL: bool>(
    surface: &Surface,
    view: &View<'_>,
    [first, y]: [f64; 2],
    row: &mut Row,
) {
    let projection = match view.projection {
        _ if PARALLEL => Projection::Parallel,
        central => central,
    };
    let quadric = surface.primitive.quadric();
    let depths_of = view.depths;
    let Row { ways, depths, .. } = row;
    let ways = &mut ways[..depths.len()];
    for x in 0..depths.len() {
        let ray = surface.inside(surface.ray(projection, [first + f64::from(x as u32), y]));
        let span @ [low, high] = span::<CAPPED>(quadric, ray);
        let way = if PARALLEL { high } else { low };
        ways[x] = way;
        depths[x] = key::<PARALLEL>(surface, depths_of, span);
    }
}

fn meet_cut(surface: &Surface, view: &View<'_>, [first, y]: [f64; 2], row: &mut Row) {
    for x in 0..row.depths.len() {
        let seen = surface.ray(view.projection, [first + x as f64, y]);
        let span = cut(surface.span(surface.inside(seen)), view.cuts, seen);
        (row.ways[x], row.depths[x]) = match view.projection {
            Projection::Parallel => (span[1], key::<true>(surface, view.depths, span)),
            Projection::Central { .. } => (span[0], key::<false>(surface, view.depths, span)),
        };
    }
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
#[cfg_attr(feature = "simd", multiversion::multiversion(targets("x86_64+avx2")))]
fn hide(keys: &[u32], row: &mut Row) -> Option<Range<usize>> {
    let mut nearest = EMPTY;
    for (depth, key) in row.depths.iter_mut().zip(keys) {
        *depth = if *depth <= *key { *depth } else { EMPTY };
        nearest = nearest.min(*depth);
    }
    if nearest == EMPTY {
        return None;
    }
    let depths = &row.depths[..keys.len()];
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

#[cfg_attr(feature = "simd", multiversion::multiversion(targets("x86_64+avx2")))]
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
    let (primitive, lit) = (surface.primitive, *lit);
    let ways = &ways[..levels.len()];
    for x in 0..levels.len() {
        let ray = surface.inside(surface.ray(projection, [first + f64::from(x as u32), y]));
        let normal = normal::<CAPPED>(primitive, ray.start + ray.along * ways[x]);
        let square = (across * normal).length_squared();
        let cosine = normal.dot(towards) / square.sqrt();
        levels[x] = lit.level_of_cosine(if square > 0.0 { cosine } else { 0.0 }, bits);
    }
}

/// The span of a ray that lies outside.
const NOTHING: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// Returns the part of a ray within a quadric, and between caps. All cases are computed, and one is selected: several rays
/// are met at once.
#[inline(always)]
fn span<const CAPPED: bool>([a, b, c]: [f64; 3], Ray { start, along }: Ray) -> [f64; 2] {
    let square = along.x * along.x + along.z * along.z + a * along.y * along.y;
    let half = start.x * along.x + start.z * along.z + (a * start.y + b) * along.y;
    let rest = start.x * start.x + start.z * start.z + (a * start.y + 2.0 * b) * start.y + c;
    let discriminant = half * half - square * rest;
    // The form without cancellation.
    let root = least(0.0, discriminant).sqrt();
    let sum = -(half + root.copysign(half));
    let is_double = sum == 0.0;
    let one = if is_double { 0.0 } else { sum / square };
    let other = if is_double { 0.0 } else { rest / sum };
    let [first, last] = [most(one, other), least(one, other)];
    // A ray that is steeper than a cone is within it outside of the roots: below its apex on one side.
    let is_below = along.y > 0.0;
    let steep = [
        if is_below { f64::NEG_INFINITY } else { last },
        if is_below { first } else { f64::INFINITY },
    ];
    let curved = select(square > 0.0, [first, last], steep);
    let curved = select((discriminant < 0.0) & (square > 0.0), NOTHING, curved);
    let end = -rest / (2.0 * half);
    let straight = [
        if half > 0.0 { f64::NEG_INFINITY } else { end },
        if half > 0.0 { end } else { f64::INFINITY },
    ];
    let all = [f64::NEG_INFINITY, f64::INFINITY];
    let constant = select(rest > 0.0, NOTHING, all);
    let straight = select(half == 0.0, constant, straight);
    let span @ [low, high] = select(square == 0.0, straight, curved);
    if !CAPPED {
        return span;
    }
    // The caps y = 0 and y = 1.
    let is_between = (0.0 <= start.y) & (start.y <= 1.0);
    let [bottom, top] = [-start.y / along.y, (1.0 - start.y) / along.y];
    let capped = [
        least(low, most(bottom, top)),
        most(high, least(bottom, top)),
    ];
    let level = select(is_between, span, NOTHING);
    select(along.y == 0.0, level, capped)
}

#[inline(always)]
fn select(condition: bool, yes: [f64; 2], no: [f64; 2]) -> [f64; 2] {
    [
        if condition { yes[0] } else { no[0] },
        if condition { yes[1] } else { no[1] },
    ]
}

/// Returns the larger of two numbers, in one instruction.
#[inline(always)]
fn least(bound: f64, value: f64) -> f64 {
    if value > bound { value } else { bound }
}

/// Returns the smaller of two numbers, in one instruction.
#[inline(always)]
fn most(bound: f64, value: f64) -> f64 {
    if value < bound { value } else { bound }
}

/// Returns a vector outwards across the surface of a primitive at a point of it.
#[inline(always)]
fn normal<const CAPPED: bool>(primitive: Round, point: DVec3) -> DVec3 {
    let [a, b, c] = primitive.quadric();
    let DVec3 { x, y, z } = point;
    let side = DVec3::new(x, a * y + b, z);
    if !CAPPED {
        return side;
    }
    // A point on a cap is farther from the quadric than from the cap.
    let inside = -(x * x + z * z + (a * y + 2.0 * b) * y + c);
    let is_top = (1.0 - y < inside) & (primitive == Round::Cylinder);
    let is_bottom = y < inside;
    let sign = if is_bottom { -1.0 } else { 1.0 };
    let is_cap = is_bottom | is_top;
    DVec3::new(
        if is_cap { 0.0 } else { side.x },
        if is_cap { sign } else { side.y },
        if is_cap { 0.0 } else { side.z },
    )
}

/// Returns the normal of the half-space on whose plane a point lies.
fn nearest_cut(cuts: &[HalfSpace], point: DVec3) -> DVec3 {
    let away = |cut: &HalfSpace| {
        let distance = cut.distance - cut.normal.dot(point);
        (distance / cut.normal.length()).abs()
    };
    let nearest = cuts.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
    nearest.map_or(DVec3::Z, |cut| cut.normal)
}

/// Returns the part of a ray that lies within half-spaces, too, which may be empty.
fn cut([mut low, mut high]: [f64; 2], cuts: &[HalfSpace], ray: Ray) -> [f64; 2] {
    for HalfSpace { normal, distance } in cuts {
        let along = normal.dot(ray.along);
        let rest = distance - normal.dot(ray.start);
        if along > 0.0 {
            high = high.min(rest / along);
        } else if along < 0.0 {
            low = low.max(rest / along);
        } else if rest < 0.0 {
            return NOTHING;
        }
    }
    [low, high]
}
