//! The methods, and the choice between their results.

use std::sync::atomic::AtomicBool;

use crate::geometry::{DAffine2, DVec2};
use crate::saturating::{real, whole};

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
    /// Measures the result at another place; returns it, and whether its picture is the shape's.
    pub(super) fn measured(
        self,
        shape: &Silhouette,
        there: &DAffine2,
        cancel: Option<&AtomicBool>,
    ) -> Result<(Rival, bool), FitError> {
        let candidate = self.candidate.moved(there);
        let drawn = candidate.attractor(shape.size(), cancel)?;
        let rival = Rival {
            method: self.method,
            score: match drawn.leaves {
                true => score_around(shape, &candidate, cancel)?,
                false => Score::new(shape.bits(), &drawn.pixels),
            },
            candidate,
            description: self.description,
        };
        Ok((rival, drawn.is(shape.bits())))
    }
}

/// Largest number of pixels around a shape in which an attractor is compared with it.
const MOST_AROUND: f64 = 1e8;

/// Returns how far around a picture an attractor counts, in pixels: twice the long side, or less where more than
/// [`MOST_AROUND`] pixels would be compared.
fn reach(size: DVec2) -> f64 {
    // (width + 2 reach) (height + 2 reach) is their number.
    let most = (size.x - size.y).hypot(2.0 * MOST_AROUND.sqrt()) - (size.x + size.y);
    let most = (most / 4.0).floor().max(0.0);
    most.min(2.0 * size.max_element())
}

/// Compares a shape with an attractor that leaves its picture: in a picture that holds both, or all of the attractor within
/// [`reach`].
fn score_around(
    shape: &Silhouette,
    candidate: &Candidate,
    cancel: Option<&AtomicBool>,
) -> Result<Score, FitError> {
    let [width, height] = shape.size();
    let size = DVec2::new(real(width), real(height));
    let [middle, half] = candidate.bounds().ok_or(FitError::DoesNotContract)?;
    let most = DVec2::splat(reach(size));
    let outside = |by: DVec2| by.ceil().clamp(DVec2::ZERO, most);
    let [low, high] = [outside(half - middle), outside(middle + half - size)];
    let [left, bottom, right, top] = [low.x, low.y, high.x, high.y].map(whole);
    let [wide, high] = [left + width + right, bottom + height + top];
    let corner = [left, top].map(|it| -it.cast_signed());
    let around = shape.bits().window(corner, wide, high);
    let candidate = candidate.moved(&DAffine2::from_translation(low));
    let drawn = candidate.attractor([wide, high], cancel)?;
    Ok(Score::new(&around, &drawn.pixels))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Bits;
    use crate::geometry::DMat2;
    use crate::ifs::about;

    #[test]
    fn large_pictures_have_less_around_them() {
        assert_eq!(reach(DVec2::new(300.0, 100.0)), 600.0);
        let size = DVec2::new(8000.0, 3000.0);
        let count = |reach: f64| (size + 2.0 * reach).element_product();
        let found = reach(size);
        assert!(count(found) <= MOST_AROUND && count(found + 1.0) > MOST_AROUND);
        assert_eq!(reach(DVec2::splat(20_000.0)), 0.0);
    }

    #[test]
    fn the_part_of_an_attractor_outside_the_picture_counts() {
        let shape = Silhouette::new(Bits::of(40, 40, |column, _| column < 20)).unwrap();
        // A square of which half lies left of the picture.
        let half = DMat2::from_diagonal(DVec2::splat(0.5));
        let corners = [(-20.0, 0.0), (20.0, 0.0), (-20.0, 40.0), (20.0, 40.0)];
        let maps = corners.map(|(x, y)| about(half, DVec2::new(x, y)));
        let candidate = Candidate::of_maps(maps.into());
        let score = score_around(&shape, &candidate, None).unwrap();
        assert!((score.iou - 0.5).abs() < 0.03, "{score:?}");
        assert!((score.hausdorff - 20.0).abs() <= 1.0, "{score:?}");
        let found = Found {
            candidate,
            method: Method::Collage,
            description: 0.0,
        };
        let (rival, is_exact) = found.measured(&shape, &DAffine2::IDENTITY, None).unwrap();
        assert_eq!((rival.score, is_exact), (score, false));
    }
}
