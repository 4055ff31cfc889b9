//! The method of Libeskind-Hadas & Maragos (1987): copies of a shape at the branch points of its skeleton, and maximal
//! disks for what they leave uncovered.
//!
//! The copy at a branch point b is moved by b − a, where a is the central branch point, and scaled by S(b) / S(a), the
//! ratio of the radii there. Its angle is that of algorithm 1; for distorted copies, angles follow from branches, and two
//! factors from algorithm 2. In place of a person who points at branch points, the copies are chosen that explain most
//! of the shape's boundary.

mod copy;
mod ground;

use std::num::NonZero;
use std::sync::atomic::AtomicBool;

use crate::Bits;
use crate::geometry::{DAffine2, DVec2};
use crate::morphology::{
    DiskFamily, NoDistances, Skeleton, SkeletonNode, SkeletonOptions, SkeletonPoint,
    SkeletonSubsets,
};
use crate::random::Pcg;
use crate::saturating::real;

use super::collage::{FINE, Form};
use super::orbit::{Level, Orbit};
use super::refine::refine;
use super::snap::shared_ratios;
use super::{Candidate, Disk, FitError, FitOptions, Silhouette, methods, score, shape};
use copy::ShapeCopy;
use ground::{Ground, centre};

/// Branch points that a person knows; positions are those of a [`Silhouette`](super::Silhouette).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BranchPoints {
    /// The central branch point; by default the one with the largest radius.
    pub centre: Option<DVec2>,
    /// The branch points of the copies; by default those that explain the boundary.
    pub branches: Vec<DVec2>,
}

/// Options of the method.
pub(super) struct Task<'a> {
    pub(super) points: &'a BranchPoints,
    /// Largest number of copies.
    pub(super) most: usize,
    /// Whether all copies are similar.
    pub(super) similar: bool,
    /// Largest number of disks.
    pub(super) disks: usize,
    pub(super) threads: NonZero<usize>,
    pub(super) cancel: Option<&'a AtomicBool>,
}

impl<'a> Task<'a> {
    /// Returns the task that options describe.
    pub(super) fn of(options: &'a FitOptions) -> Self {
        Self {
            points: &options.branch_points,
            most: *options.maps.end(),
            similar: options.similar,
            disks: match options.disks {
                0 => MAX_DISKS,
                disks => disks,
            },
            threads: options.threads,
            cancel: options.cancel.as_deref(),
        }
    }
}

/// Largest number of branch points at which copies are tried.
const MAX_TRIED: usize = 64;

/// Share of the boundary that a further copy explains at least.
const LEAST_SHARE: f64 = 0.02;

/// Share of the area that may stay without a disk.
const BARE: f64 = 0.004;

/// Overlap that simple numbers are worth.
const SIMPLE: f64 = 0.01;

/// Number of attractors that are drawn to improve copies and disks together.
const ATTRACTORS: usize = 3000;

/// Largest number of disks where no other is asked for.
const MAX_DISKS: usize = 16;

impl From<NoDistances> for FitError {
    fn from(_: NoDistances) -> Self {
        // Shapes are neither empty nor too large.
        Self::Empty
    }
}

/// Finds copies and disks, and counts the copies that were evaluated.
pub(super) fn find(shape: &Silhouette, task: &Task<'_>) -> Result<(Candidate, usize), FitError> {
    let bits = shape.bits();
    let options = SkeletonOptions {
        threads: task.threads,
        ..SkeletonOptions::default()
    };
    let skeleton = Skeleton::of(bits, &options)?;
    let ground = Ground::new(bits, task.threads)?;
    let Some(node) = chosen_centre(&skeleton, bits, task.points) else {
        return Err(FitError::NoCopies);
    };
    let a = ground.deepest(centre(&node.point, bits.height()));
    let mut copies = Vec::new();
    for b in branch_points(&skeleton, node, bits, task.points) {
        copies.extend(copy::fitted(
            &ground,
            &skeleton,
            (node, a),
            &b,
            task.similar,
        ));
    }
    let is_asked = !task.points.branches.is_empty();
    let mut choices = match is_asked {
        true => vec![copies],
        false => choices(&ground, &copies, &a, task.most),
    };
    let is_by_area = choices.len() > 1;
    choices.retain(|copies| !copies.is_empty());
    let placed = |copies: &[ShapeCopy]| {
        let maps: Vec<DAffine2> = copies.iter().map(ShapeCopy::affine).collect();
        let disks = disks(&ground, a, &maps, task)?;
        Ok::<_, FitError>(Candidate { maps, disks })
    };
    let level = Level::new(shape, FINE);
    let mut orbit = Orbit::new(&level);
    let mut best: Option<(f64, Vec<ShapeCopy>, Candidate)> = None;
    for choice in choices {
        let copies: Vec<ShapeCopy> = { choice.into_iter() }
            .map(|copy| copy::refined(&ground, copy))
            .collect();
        let candidate = placed(&copies)?;
        let length = methods::description(&candidate, &mut orbit, &level);
        if best.as_ref().is_none_or(|best| length < best.0) {
            best = Some((length, copies, candidate));
        }
    }
    let Some((length, copies, mut candidate)) = best else {
        return Err(FitError::NoCopies);
    };
    if let Some(simple) = simplified(&copies) {
        let size = [bits.width(), bits.height()];
        let iou = |candidate: &Candidate| {
            let drawn = candidate.attractor(size, task.cancel)?;
            Ok::<_, FitError>(score::iou(bits, &drawn.pixels))
        };
        let simple = placed(&simple)?;
        if iou(&simple)? + SIMPLE >= iou(&candidate)? {
            return Ok((simple, ground.evaluations.get()));
        }
    }
    let mut evaluations = ground.evaluations.get();
    if is_by_area {
        let form = Form::of(&candidate);
        let step = 1.0 / level.scale();
        let random = Pcg::new(3, 5);
        let found = refine(
            shape,
            &level,
            &candidate,
            form,
            step,
            ATTRACTORS.into(),
            random,
        );
        evaluations += found.evaluations;
        if methods::description(&found.candidate, &mut orbit, &level) < length {
            candidate = found.candidate;
        }
    }
    Ok((candidate, evaluations))
}

/// Returns similar copies with simple ratios, which near ones share, and simple angles; `None` if a copy is distorted, or a
/// ratio is not near a simple one.
fn simplified(copies: &[ShapeCopy]) -> Option<Vec<ShapeCopy>> {
    let ratios: Vec<f64> = { copies.iter() }
        .map(ShapeCopy::similar)
        .collect::<Option<_>>()?;
    let ratios = shared_ratios(&ratios)?;
    let simple = copies.iter().zip(ratios);
    Some(simple.map(|(copy, ratio)| copy.simplified(ratio)).collect())
}

/// Returns the node at the position that is given, or the central one.
fn chosen_centre<'a>(
    skeleton: &'a Skeleton,
    bits: &Bits,
    points: &BranchPoints,
) -> Option<&'a SkeletonNode> {
    match points.centre {
        Some(point) => nearest(skeleton, bits, point),
        None => skeleton.centre(),
    }
}

/// Returns the node that is nearest to a position.
fn nearest<'a>(skeleton: &'a Skeleton, bits: &Bits, point: DVec2) -> Option<&'a SkeletonNode> {
    let away = |node: &SkeletonNode| centre(&node.point, bits.height()).distance_squared(point);
    let nodes = skeleton.nodes().iter();
    nodes.min_by(|one, other| away(one).total_cmp(&away(other)))
}

/// Returns the branch points that are given, or those with the largest radii; of close ones, one.
fn branch_points(
    skeleton: &Skeleton,
    a: &SkeletonNode,
    bits: &Bits,
    points: &BranchPoints,
) -> Vec<SkeletonNode> {
    if !points.branches.is_empty() {
        let given = points.branches.iter();
        return given
            .filter_map(|&point| named(skeleton, bits, point))
            .collect();
    }
    let mut nodes: Vec<_> = { skeleton.nodes().iter() }
        .filter(|node| node.is_junction() && node.point != a.point)
        .collect();
    nodes.sort_by(|one, other| other.point.radius.total_cmp(&one.point.radius));
    let mut kept: Vec<&SkeletonNode> = Vec::new();
    for node in nodes {
        let is_near =
            |other: &&SkeletonNode| node.point.distance(&other.point) < other.point.radius / 4.0;
        if kept.len() < MAX_TRIED && !kept.iter().any(is_near) {
            kept.push(node);
        }
    }
    kept.into_iter().cloned().collect()
}

/// Returns the node nearest to a position, or the nearest point of a branch if the node is far.
fn named(skeleton: &Skeleton, bits: &Bits, position: DVec2) -> Option<SkeletonNode> {
    let away = |point: &SkeletonPoint| centre(point, bits.height()).distance(position);
    let node = nearest(skeleton, bits, position)?;
    if away(&node.point) <= node.point.radius / 2.0 {
        return Some(node.clone());
    }
    let point = { skeleton.points() }.min_by(|one, other| away(one).total_cmp(&away(other)))?;
    Some(SkeletonNode {
        point: *point,
        points: vec![*point],
        branches: Vec::new(),
    })
}

/// Chooses the copies that explain most of the boundary, one after another; `None` if they explain less than half.
fn chosen(ground: &Ground<'_>, copies: &[ShapeCopy], most: usize) -> Option<Vec<ShapeCopy>> {
    let explained: Vec<Vec<bool>> = copies.iter().map(|copy| ground.explained(copy)).collect();
    let all = ground.boundary.len();
    let mut open = vec![true; all];
    let mut chosen = Vec::new();
    while chosen.len() < most {
        let gain = |number: usize| {
            let own = explained[number].iter().zip(&open);
            own.filter(|(explained, open)| **explained && **open)
                .count()
        };
        let gains = (0..copies.len()).map(|number| (gain(number), number));
        // Of equal ones, the first, which has the largest radius.
        let best = gains.max_by_key(|&(gain, number)| (gain, std::cmp::Reverse(number)));
        let Some((gain, number)) = best else { break };
        if real(gain) < LEAST_SHARE * real(all) {
            break;
        }
        let own = open.iter_mut().zip(&explained[number]);
        own.for_each(|(open, &explained)| *open &= !explained);
        chosen.push(copies[number]);
    }
    let left = open.iter().filter(|open| **open).count();
    (2 * left < all).then_some(chosen)
}

/// Returns choices of copies, of which the shortest description is to decide: one by the boundary, or else several by area.
fn choices(
    ground: &Ground<'_>,
    copies: &[ShapeCopy],
    a: &Disk,
    most: usize,
) -> Vec<Vec<ShapeCopy>> {
    /// Costs of a pixel outside, where one that is covered has the value 1.
    const COSTS: [f64; 4] = [1.0, 2.0, 5.0, 12.0];
    match chosen(ground, copies, most) {
        Some(chosen) => vec![chosen],
        None => COSTS
            .map(|cost| chosen_by_area(ground, copies, a, most, cost))
            .into(),
    }
}

/// Chooses the copies that cover most of what lies outside the disk of the central branch point, less what they have outside
/// the shape, at a cost a pixel, one after another: distorted copies of a natural shape do not share its boundary.
fn chosen_by_area(
    ground: &Ground<'_>,
    copies: &[ShapeCopy],
    a: &Disk,
    most: usize,
    cost: f64,
) -> Vec<ShapeCopy> {
    let mut open = ground::without(ground.bits, a);
    let least = LEAST_SHARE * ground.bits.area();
    let mut outside = ground.bits.complement();
    let images: Vec<Bits> = copies
        .iter()
        .map(|copy| ground.image(&copy.affine()))
        .collect();
    let common = |one: &Bits, other: &Bits| {
        let mut common = one.clone();
        common.keep(other);
        common.area()
    };
    let mut chosen = Vec::new();
    while chosen.len() < most {
        let gains = images
            .iter()
            .map(|image| common(image, &open) - cost * common(image, &outside));
        let best = gains.enumerate().fold(
            (0, least),
            |best, next| {
                if next.1 > best.1 { next } else { best }
            },
        );
        let (number, gain) = best;
        if gain <= least {
            break;
        }
        open.remove(&images[number]);
        outside.remove(&images[number]);
        chosen.push(copies[number]);
    }
    chosen
}

/// Covers what copies leave uncovered by maximal disks: that of the central branch point first, and then from the
/// largest down.
fn disks(
    ground: &Ground<'_>,
    a: Disk,
    maps: &[DAffine2],
    task: &Task<'_>,
) -> Result<Vec<Disk>, NoDistances> {
    let mut bare = ground.uncovered(maps);
    let area = ground.bits.area();
    let mut disks = Vec::new();
    let maximal = SkeletonSubsets::of(ground.bits, DiskFamily::Euclid, task.threads)?;
    let height = ground.bits.height();
    let others = maximal.disks().iter().rev().map(|disk| Disk {
        centre: shape::centre([disk.column as usize, disk.row as usize], height),
        radius: f64::from(disk.size).sqrt() - 0.5,
    });
    for disk in std::iter::once(a).chain(others) {
        if disks.len() == task.disks || bare.area() < BARE * area {
            break;
        }
        let before = bare.area();
        let rest = ground::without(&bare, &disk);
        if before - rest.area() >= BARE * area {
            bare = rest;
            disks.push(disk);
        }
    }
    Ok(disks)
}
