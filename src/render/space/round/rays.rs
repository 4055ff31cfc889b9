//! Rays, and where they meet quadrics and half-spaces.

use crate::geometry::{DVec3, HalfSpace, Round};

/// Points of a ray: `start` + w · `along`, for real w.
#[derive(Clone, Copy, Default)]
pub(super) struct Ray {
    pub(super) start: DVec3,
    pub(super) along: DVec3,
}

/// The span of a ray that lies outside.
const NOTHING: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// Returns the factor of w² in the equation of the points in which a ray of a direction meets a quadric.
#[inline(always)]
pub(super) fn square([a, _, _]: [f64; 3], along: DVec3) -> f64 {
    along.x * along.x + along.z * along.z + a * along.y * along.y
}

/// Returns the part of a ray within a quadric, and between caps. All cases are computed, and one is selected: several rays
/// are met at once. Rays that are known to meet the quadric in two points or none are `TWICE`.
#[inline(always)]
pub(super) fn span<const CAPPED: bool, const TWICE: bool>(
    quadric @ [a, b, c]: [f64; 3],
    Ray { start, along }: Ray,
) -> [f64; 2] {
    let square = square(quadric, along);
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
    let curved = if TWICE {
        select(discriminant < 0.0, NOTHING, [first, last])
    } else {
        // A ray that is steeper than a cone is within it outside of the roots: below its apex on one side.
        let is_below = along.y > 0.0;
        let steep = [
            if is_below { f64::NEG_INFINITY } else { last },
            if is_below { first } else { f64::INFINITY },
        ];
        let curved = select(square > 0.0, [first, last], steep);
        select((discriminant < 0.0) & (square > 0.0), NOTHING, curved)
    };
    let span @ [low, high] = if TWICE {
        curved
    } else {
        let end = -rest / (2.0 * half);
        let straight = [
            if half > 0.0 { f64::NEG_INFINITY } else { end },
            if half > 0.0 { end } else { f64::INFINITY },
        ];
        let all = [f64::NEG_INFINITY, f64::INFINITY];
        let constant = select(rest > 0.0, NOTHING, all);
        let straight = select(half == 0.0, constant, straight);
        select(square == 0.0, straight, curved)
    };
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
pub(super) fn least(bound: f64, value: f64) -> f64 {
    if value > bound { value } else { bound }
}

/// Returns the smaller of two numbers, in one instruction.
#[inline(always)]
pub(super) fn most(bound: f64, value: f64) -> f64 {
    if value < bound { value } else { bound }
}

/// Surface of a primitive, without choices by its kind, which would keep points from being computed at once.
pub(super) struct Shape {
    quadric: [f64; 3],
    /// Whether it has a cap at y = 1.
    has_top: bool,
}

impl Shape {
    pub(super) fn of(primitive: Round) -> Self {
        Self {
            quadric: primitive.quadric(),
            has_top: primitive == Round::Cylinder,
        }
    }

    /// Returns a vector outwards across the surface at a point of it.
    #[inline(always)]
    pub(super) fn normal<const CAPPED: bool>(&self, point: DVec3) -> DVec3 {
        let [a, b, c] = self.quadric;
        let DVec3 { x, y, z } = point;
        let side = DVec3::new(x, a * y + b, z);
        if !CAPPED {
            return side;
        }
        // A point on a cap is farther from the quadric than from the cap.
        let inside = -(x * x + z * z + (a * y + 2.0 * b) * y + c);
        let is_top = (1.0 - y < inside) & self.has_top;
        let is_bottom = y < inside;
        let sign = if is_bottom { -1.0 } else { 1.0 };
        let is_cap = is_bottom | is_top;
        DVec3::new(
            if is_cap { 0.0 } else { side.x },
            if is_cap { sign } else { side.y },
            if is_cap { 0.0 } else { side.z },
        )
    }
}

/// Returns the normal of the half-space on whose plane a point lies.
pub(super) fn nearest_cut(cuts: &[HalfSpace], point: DVec3) -> DVec3 {
    let away = |cut: &HalfSpace| {
        let distance = cut.distance - cut.normal.dot(point);
        (distance / cut.normal.length()).abs()
    };
    let nearest = cuts.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
    nearest.map_or(DVec3::Z, |cut| cut.normal)
}

/// Returns the part of a ray that lies within half-spaces, too, which may be empty.
pub(super) fn cut([mut low, mut high]: [f64; 2], cuts: &[HalfSpace], ray: Ray) -> [f64; 2] {
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
