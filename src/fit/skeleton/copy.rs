//! A copy at a branch point: its angle by algorithm 1, its factors by algorithm 2, and its best place nearby.

use std::f64::consts::{PI, TAU};

use crate::Bits;
use crate::geometry::{DAffine2, DMat2, DVec2, EIGHT_WAYS};
use crate::morphology::{DiskFamily, Operation, Sequence, Skeleton, SkeletonNode};
use crate::random::Pcg;
use crate::saturating::{real, whole};

use super::super::Disk;
use super::super::cma::Cma;
use super::ground::{Ground, centre};

/// A copy of a shape: it is scaled along its axes and turned about the central branch point, and moved to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ShapeCopy {
    /// The central branch point.
    from: DVec2,
    /// The branch point of the copy.
    to: DVec2,
    /// Factors r_x and r_y.
    factors: DVec2,
    /// Angle in radians.
    angle: f64,
    /// Radius at the branch point.
    size: f64,
}

impl ShapeCopy {
    /// Returns the map of the copy.
    pub(super) fn affine(&self) -> DAffine2 {
        let (sin, cos) = libm::sincos(self.angle);
        let DVec2 { x, y } = self.factors;
        let matrix = DMat2::from_cols(DVec2::new(x * cos, x * sin), DVec2::new(-y * sin, y * cos));
        DAffine2::from_mat2_translation(matrix, self.to - matrix * self.from)
    }

    pub(super) fn apply(&self, point: DVec2) -> DVec2 {
        self.affine().transform_point2(point)
    }

    pub(super) fn inverse(&self) -> DAffine2 {
        self.affine().inverse()
    }

    /// Returns whether the copy differs from another one by what inexact radii and branch points allow.
    fn is_near(&self, other: &Self) -> bool {
        let away = self.to.distance(other.to);
        let ratio = self.factors / other.factors;
        let is_smaller = self.ratio() < RATIOS.end;
        is_smaller
            && away <= MAX_MOVE * other.size
            && (ratio - 1.0).abs().max_element() <= MAX_SCALE
    }

    /// Returns the factor of a similar copy; `None` if it is distorted.
    pub(super) fn similar(&self) -> Option<f64> {
        let [x, y] = self.factors.to_array();
        (x == y).then_some(x)
    }

    /// Returns the copy with another factor, and with the nearest multiple of 15 degrees as its angle, if that is near.
    pub(super) fn simplified(&self, factor: f64) -> Self {
        let degrees = self.angle.to_degrees();
        let nearest = (degrees / SIMPLE).round() * SIMPLE;
        let is_near = (degrees - nearest).abs() <= NEAR_ANGLE;
        Self {
            factors: DVec2::splat(factor),
            angle: if is_near {
                nearest.to_radians()
            } else {
                self.angle
            },
            ..*self
        }
    }

    /// Returns the larger factor.
    pub(super) fn ratio(&self) -> f64 {
        self.factors.max_element()
    }
}

/// Ratios of copies.
const RATIOS: std::ops::Range<f64> = 0.05..0.85;

/// Least shift of a copy, in radii at the central branch point.
const LEAST_SHIFT: f64 = 0.5;

/// Largest move of a copy from its branch point, in radii there.
const MAX_MOVE: f64 = 0.25;

/// Largest change of its factors.
const MAX_SCALE: f64 = 0.15;

/// Simple angles are multiples of this many degrees; the largest change to one.
const SIMPLE: f64 = 15.0;
const NEAR_ANGLE: f64 = 2.0;

/// Number of angles from 0 to 2π of algorithm 1.
const ANGLES: u32 = 120;

/// Number of angles of which more pixels are looked at, and their least distance in radians.
const TRIED: usize = 8;
const APART: f64 = 0.2;

/// Number of pixels of a copy that algorithms 1 and 2 look at, about, and improvements of one, and of one that is chosen.
const SAMPLES: f64 = 600.0;
const SOME: f64 = 2000.0;
const MANY: f64 = 16_384.0;

/// Number of evaluations of a refinement, and value of what is not admitted.
const REFINEMENTS: usize = 500;
const FORBIDDEN: f64 = 1e9;

/// Range and number of the factors of algorithm 2, in multiples of S(b) / S(a).
const FACTORS: [f64; 2] = [0.7, 1.6];
const STEPS: u32 = 7;

/// Least gain, as a share of the copy's own, for which a copy is distorted.
const DISTORTED: f64 = 1.1;

/// The pixels that the opening removes, which a copy is to cover.
struct Target<'a> {
    ground: &'a Ground<'a>,
    details: Bits,
}

/// Fits the copy at a branch point; `None` if it would be too small or not smaller than the shape.
pub(super) fn fitted(
    ground: &Ground<'_>,
    skeleton: &Skeleton,
    (node, a): (&SkeletonNode, Disk),
    b: &SkeletonNode,
    similar: bool,
) -> Option<ShapeCopy> {
    let ratio = b.point.radius / a.radius;
    let to = centre(&b.point, ground.bits.height());
    if !RATIOS.contains(&ratio) || to.distance(a.centre) < LEAST_SHIFT * a.radius {
        return None;
    }
    let target = Target::new(ground, b.point.radius);
    let start = ShapeCopy {
        from: a.centre,
        to,
        factors: DVec2::splat(ratio),
        angle: 0.0,
        size: b.point.radius,
    };
    let turned = target.turned(&start)?;
    if similar {
        return Some(turned);
    }
    let directions = |node: &SkeletonNode| {
        let branches = node.branches.iter();
        let own = branches.map(|&branch| direction(skeleton, branch, node));
        own.collect::<Vec<_>>()
    };
    let (here, there) = (directions(node), directions(b));
    let angles = { there.iter() }.flat_map(|there| here.iter().map(move |here| there - here));
    let factor = |step: u32| {
        let [low, high] = FACTORS;
        ratio * (low + (high - low) * f64::from(step) / f64::from(STEPS))
    };
    let distorted = angles.chain([turned.angle]).flat_map(|angle| {
        let pairs = (0..=STEPS).flat_map(|x| (0..=STEPS).map(move |y| [x, y]));
        pairs.map(move |[x, y]| ShapeCopy {
            angle,
            factors: DVec2::new(factor(x), factor(y)),
            ..start
        })
    });
    let distorted = distorted.filter(|copy| copy.ratio() < RATIOS.end);
    let distorted = target.improved(target.best(distorted)?, affine_steps, [0.25, SOME]);
    let gain = |copy: &ShapeCopy| target.gain(copy, target.step(copy, MANY));
    let is_better = gain(&distorted) > DISTORTED * gain(&turned).max(1.0);
    Some(if is_better { distorted } else { turned })
}

/// Improves a copy that is chosen, on all its pixels or many: by CMA-ES, as the numbers of a copy depend on each other.
pub(super) fn refined(ground: &Ground<'_>, copy: ShapeCopy) -> ShapeCopy {
    let target = Target::new(ground, copy.size);
    let step = target.step(&copy, MANY);
    // Numbers are pixels at the rim of the copy.
    let rim = ground.radius() * copy.ratio();
    let is_similar = copy.factors.x == copy.factors.y;
    let moved = |numbers: &[f64]| ShapeCopy {
        to: copy.to + DVec2::new(numbers[0], numbers[1]),
        angle: copy.angle + numbers[2] / rim,
        factors: copy.factors
            * (1.0 + DVec2::new(numbers[3], numbers[if is_similar { 3 } else { 4 }]) / rim),
        ..copy
    };
    let start = vec![0.0; if is_similar { 4 } else { 5 }];
    let mut search = Cma::new(start, 1.0, Pcg::new(7, 3));
    let found = search.minimise(REFINEMENTS, 0.02, |numbers| {
        let next = moved(numbers);
        match next.is_near(&copy) {
            true => -target.gain(&next, step),
            false => FORBIDDEN,
        }
    });
    moved(&found.point)
}

/// Returns the direction in which a branch leaves a node, by a line of least squares through its first points.
fn direction(skeleton: &Skeleton, branch: usize, node: &SkeletonNode) -> f64 {
    let branch = &skeleton.branches()[branch];
    let mut points = branch.points.clone();
    if points.last() == Some(&node.point) {
        points.reverse();
    }
    let count = points.len().min(2 + whole(node.point.radius));
    let points: Vec<DVec2> = { points[..count].iter() }
        .map(|point| DVec2::new(real(point.column), -real(point.row)))
        .collect();
    let mean = points.iter().sum::<DVec2>() / real(count);
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for point in &points {
        let away = *point - mean;
        xx += away.x * away.x;
        xy += away.x * away.y;
        yy += away.y * away.y;
    }
    let angle = 0.5 * libm::atan2(2.0 * xy, xx - yy);
    let (sin, cos) = libm::sincos(angle);
    let along = (points[count - 1] - points[0]).dot(DVec2::new(cos, sin));
    if along < 0.0 { angle + PI } else { angle }
}

impl<'a> Target<'a> {
    fn new(ground: &'a Ground<'a>, radius: f64) -> Self {
        let mut details = ground.bits.clone();
        // A disk about b itself is to be removed as well.
        let opening = Sequence::one(Operation::Open, radius + 1.0);
        if let Ok(opened) = opening.apply(ground.bits, DiskFamily::Euclid, ground.threads) {
            details.remove(&opened);
        }
        Self { ground, details }
    }

    /// Returns the copy that gains most.
    fn best(&self, copies: impl Iterator<Item = ShapeCopy>) -> Option<ShapeCopy> {
        let mut copies = copies.peekable();
        let step = self.step(copies.peek()?, SAMPLES);
        self.best_of(copies, step).map(|(_, copy)| copy)
    }

    /// Returns a copy with the angle of algorithm 1: of the best angles that are apart, few pixels of the copy are looked at
    /// first, then all or many, and those two that are left are improved.
    fn turned(&self, start: &ShapeCopy) -> Option<ShapeCopy> {
        let [some, many] = [SAMPLES, MANY].map(|samples| self.step(start, samples));
        let angles = (0..ANGLES).map(|step| TAU * f64::from(step) / f64::from(ANGLES));
        let turned = angles.map(|angle| ShapeCopy { angle, ..*start });
        let ranked = |copies: &mut dyn Iterator<Item = ShapeCopy>, step: f64| {
            let gains = copies.map(|copy| (self.gain(&copy, step), copy));
            let mut all: Vec<(f64, ShapeCopy)> = gains.collect();
            all.sort_by(|one, other| other.0.total_cmp(&one.0));
            all
        };
        let mut apart: Vec<ShapeCopy> = Vec::new();
        for (_, copy) in ranked(&mut turned.into_iter(), some) {
            let is_near = |other: &ShapeCopy| {
                let away = (copy.angle - other.angle).abs();
                away.min(TAU - away) < APART
            };
            if apart.len() < TRIED && !apart.iter().any(is_near) {
                apart.push(copy);
            }
        }
        let best = ranked(&mut apart.into_iter(), many);
        let improved = { best.into_iter().take(2) }
            .map(|(_, copy)| self.improved(copy, similar_steps, [0.25, SOME]));
        self.best_of(improved, many).map(|(_, copy)| copy)
    }

    /// Returns the distance of pixels of which a copy has about a number.
    fn step(&self, copy: &ShapeCopy, samples: f64) -> f64 {
        let area = self.ground.bits.area() * copy.factors.x * copy.factors.y;
        (area / samples).sqrt().floor().max(1.0)
    }

    /// Returns the copy with the largest gain, of several the first.
    fn best_of(
        &self,
        copies: impl Iterator<Item = ShapeCopy>,
        step: f64,
    ) -> Option<(f64, ShapeCopy)> {
        let gains = copies.map(|copy| (self.gain(&copy, step), copy));
        gains.fold(None, |best: Option<(f64, ShapeCopy)>, next| match best {
            Some(best) if best.0 >= next.0 => Some(best),
            _ => Some(next),
        })
    }

    /// Returns by how many pixels a copy f(A) lowers the area of ((A ∘ kD) ∪ f(A)) Δ A, from every `step`-th pixel: those
    /// details that it covers, less those pixels that it has outside.
    fn gain(&self, copy: &ShapeCopy, step: f64) -> f64 {
        let counted = &self.ground.evaluations;
        counted.set(counted.get() + 1);
        let map = copy.affine();
        let back = map.inverse();
        let bounds = self.ground.bounds(&map);
        let mut gain = 0.0;
        let mut y = bounds[0].y + 0.5;
        while y < bounds[1].y {
            let mut x = bounds[0].x + 0.5;
            while x < bounds[1].x {
                let point = DVec2::new(x, y);
                if self.ground.holds(back.transform_point2(point)) {
                    gain += match self.ground.pixel(point) {
                        Some([column, row]) if self.details.get(column, row) => 1.0,
                        Some([column, row]) if self.ground.bits.get(column, row) => 0.0,
                        _ => -1.0,
                    };
                }
                x += step;
            }
            y += step;
        }
        gain * step * step
    }

    /// Improves a copy by steps of its numbers, which are halved while none is better, down to a size; looks at a number of
    /// pixels of the copy.
    fn improved(
        &self,
        mut copy: ShapeCopy,
        steps: Steps,
        [finest, samples]: [f64; 2],
    ) -> ShapeCopy {
        let mut size = 1.0;
        let start = copy;
        let step = self.step(&copy, samples);
        let mut gain = self.gain(&copy, step);
        let mut left = 100;
        while size >= finest && left > 0 {
            let next = { steps(&copy, size).into_iter() }.filter(|next| next.is_near(&start));
            let next = self.best_of(next, step);
            left -= 1;
            match next {
                Some((better, next)) if better > gain => (gain, copy) = (better, next),
                _ => size /= 2.0,
            }
        }
        copy
    }
}

/// Steps from a copy, by their size.
type Steps = fn(&ShapeCopy, f64) -> Vec<ShapeCopy>;

/// Returns copies that are moved, turned or scaled; `size` is that of a step in pixels at the rim of the copy.
fn similar_steps(copy: &ShapeCopy, size: f64) -> Vec<ShapeCopy> {
    let mut steps = moved(copy, size);
    let scale = 0.02 * size;
    for sign in [-1.0, 1.0] {
        steps.push(ShapeCopy {
            factors: copy.factors * (1.0 + sign * scale),
            ..*copy
        });
    }
    steps
}

fn affine_steps(copy: &ShapeCopy, size: f64) -> Vec<ShapeCopy> {
    let mut steps = similar_steps(copy, size);
    let scale = 0.02 * size;
    for sign in [-1.0, 1.0] {
        for axis in [DVec2::X, DVec2::Y] {
            steps.push(ShapeCopy {
                factors: copy.factors * (DVec2::ONE + sign * scale * axis),
                ..*copy
            });
        }
    }
    steps
}

fn moved(copy: &ShapeCopy, size: f64) -> Vec<ShapeCopy> {
    let places = EIGHT_WAYS.map(|step| ShapeCopy {
        to: copy.to + size * step,
        ..*copy
    });
    let turned = [-1.0, 1.0].map(|sign| ShapeCopy {
        angle: copy.angle + sign * 0.02 * size,
        ..*copy
    });
    places.into_iter().chain(turned).collect()
}
