//! The methods, and the choice between their results.

use std::sync::atomic::AtomicBool;

use crate::geometry::DAffine2;

use super::attractor::Attractor;
use super::collage::{Collage, Form};
use super::orbit::Orbit;
use super::refine::Refined;
use super::{Candidate, FitError, FitOptions, Method, Rival, Score, Silhouette};
use super::{moments, score, skeleton, snap, symmetry};

/// Bits of a number, and of a cell that is off, in description lengths.
const NUMBER: f64 = 10.0;
const PIXEL: f64 = 6.0;

/// Result of a method.
pub(super) struct Found {
    pub(super) candidate: Candidate,
    pub(super) method: Method,
    pub(super) description: f64,
}

impl Found {
    /// Measures the result at another place.
    pub(super) fn measured(
        self,
        shape: &Silhouette,
        there: &DAffine2,
        cancel: Option<&AtomicBool>,
    ) -> Result<Rival, FitError> {
        let candidate = self.candidate.moved(there);
        let drawn = candidate.attractor(shape.size(), cancel)?;
        Ok(Rival {
            method: self.method,
            score: Score::new(shape.bits(), &drawn.pixels),
            candidate,
            description: self.description,
        })
    }
}

/// Returns the results of the methods that are asked for, the one with the least description length first, and the number
/// of evaluations.
pub(super) fn found(
    shape: &Silhouette,
    options: &FitOptions,
) -> Result<(Vec<Found>, usize), FitError> {
    let is_pointed = options.branch_points != skeleton::BranchPoints::default();
    let method = match options.method {
        Method::Auto if is_pointed => Method::Skeleton,
        method => method,
    };
    let mut all = Vec::new();
    let mut evaluations = 0;
    let collage = match method {
        Method::Skeleton => None,
        _ => Some(Collage::new(shape, options)?),
    };
    let mut orbit_level = None;
    let mut add = |candidate: Candidate, method: Method| {
        let level = orbit_level
            .get_or_insert_with(|| super::orbit::Level::new(shape, super::collage::FINE));
        let description = description(&candidate, &mut Orbit::new(level), level);
        all.push(Found {
            candidate,
            method,
            description,
        });
    };
    let mut maps = options.maps.clone();
    let mut is_exact = false;
    if let (Some(collage), Method::Auto | Method::Collage) = (&collage, method) {
        let found = collage.search()?;
        // Other methods need not look for the number of maps again.
        let count = found[0].candidate.maps.len();
        maps = count..=count;
        let (candidate, drawn) = simplest(shape, collage, found)?;
        is_exact = drawn.is(shape.bits());
        add(candidate, Method::Collage);
    }
    // Results so far are enough for a search that is stopped.
    let is_stopped = collage.as_ref().is_some_and(Collage::is_stopped);
    let is_auto = method == Method::Auto && !is_exact && !is_stopped;
    if let Some(collage) = collage
        .as_ref()
        .filter(|_| method == Method::Moments || is_auto && options.disks == 0)
    {
        let found = moments::search(shape, collage, maps)?;
        let (candidate, _) = simplest(shape, collage, found)?;
        add(candidate, Method::Moments);
    }
    evaluations += collage.as_ref().map_or(0, Collage::evaluations);
    if method == Method::Skeleton || is_auto {
        match skeleton::find(shape, &skeleton::Task::of(options)) {
            Ok((candidate, count)) => {
                evaluations += count;
                add(candidate, Method::Skeleton);
            }
            // The other methods have results.
            Err(FitError::NoCopies) if is_auto => {}
            Err(error) => return Err(error),
        }
    }
    // Of equal ones, the first.
    all.sort_by(|one: &Found, other| one.description.total_cmp(&other.description));
    Ok((all, evaluations))
}

/// Returns the length of a description in bits: of the numbers of a candidate, and of the cells that are off.
#[expect(clippy::cast_precision_loss, reason = "there are few numbers")]
pub(super) fn description(
    candidate: &Candidate,
    orbit: &mut Orbit,
    level: &super::orbit::Level,
) -> f64 {
    NUMBER * candidate.numbers() as f64 + PIXEL * orbit.misfit(candidate, level)
}

/// Returns the best candidate, or an exact system near the best of similarities where its picture is no worse.
fn simplest(
    shape: &Silhouette,
    collage: &Collage<'_>,
    found: Vec<Refined>,
) -> Result<(Candidate, Attractor), FitError> {
    let cancel = collage.cancel();
    let is_similar = |it: &&Refined| it.form == Form::Similar && it.candidate.disks.is_empty();
    let best = found[0].candidate.clone();
    let attractor = best.attractor(shape.size(), cancel)?;
    let similar = found.iter().find(is_similar);
    let Some(similar) = similar.filter(|_| !collage.is_stopped()) else {
        return Ok((best, attractor));
    };
    let before = score::iou(shape.bits(), &attractor.pixels);
    let snapped =
        |candidate: &Candidate| snap::snap(shape, collage.fine(), candidate, before, cancel);
    let simple = symmetry::simplified(&similar.candidate, &symmetry::symmetries(collage.ground()));
    let mut exact = snapped(&simple)?;
    let is_exact = |it: &(Candidate, Attractor)| it.1.is(shape.bits());
    if simple != similar.candidate && !exact.as_ref().is_some_and(is_exact) {
        let other = snapped(&similar.candidate)?;
        exact = other.or(exact);
    }
    Ok(exact.unwrap_or((best, attractor)))
}
