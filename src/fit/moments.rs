//! Systems whose invariant measure has the moments of a picture (Demko, Hodges & Naylor 1985, section 3.1; Vrscay &
//! Roehrig 1989).
//!
//! The moments of the measure are exact: they solve linear equations in the numbers of the maps. They fall into local
//! minima, so that many starts are searched, and the best are refined on their attractors like collages.

use std::ops::RangeInclusive;

use crate::geometry::{DAffine2, DMat2, DVec2};
use crate::ifs::RawMoments;
use crate::parallel;
use crate::random::{Pcg, mix};

use super::cma::{Budget, Cma};
use super::collage::{Collage, Form};
use super::orbit::Orbit;
use super::refine::{Numbers, Refined};
use super::{Candidate, FitError, Method, Silhouette};

/// Order up to which moments are compared.
const ORDER: usize = 6;
/// Number of random starts, and of those that are continued.
const STARTS: usize = 24;
const CONTINUED: usize = 6;
/// Shares of the effort of a start, and of one that is continued.
const SHARES: [usize; 2] = [20, 8];

/// The moments of a picture, in coordinates in which its points have the mean 0 and are at a distance of 1 in the mean
/// square.
pub(super) struct Target {
    there: DAffine2,
    back: DAffine2,
    moments: RawMoments,
}

impl Target {
    /// Returns the moments of a shape: of its values, or of its area.
    pub(super) fn of(shape: &Silhouette) -> Option<Self> {
        let plain = RawMoments::of_points(shape.masses(), 2)?;
        let at = |i, j| plain.get(i, j).unwrap_or(0.0);
        let mean = DVec2::new(at(1, 0), at(0, 1));
        let size = (at(2, 0) + at(0, 2) - mean.length_squared())
            .max(1e-6)
            .sqrt();
        let back = DAffine2::from_mat2_translation(DMat2::IDENTITY * size, mean);
        let there = back.inverse();
        let masses = shape.masses();
        let moments = RawMoments::of_points(
            masses.map(|(p, mass)| (there.transform_point2(p), mass)),
            ORDER,
        )?;
        Some(Self {
            there,
            back,
            moments,
        })
    }

    /// Returns the distance of the moments of the invariant measure of maps from those of the picture.
    fn distance(&self, maps: &[DAffine2], weights: &[f64]) -> f64 {
        let maps = maps.iter().map(|map| self.there * *map * self.back);
        let maps: Vec<_> = maps.zip(weights.iter().copied()).collect();
        let moments = RawMoments::invariant(&maps, ORDER);
        let distance = moments.map_or(f64::INFINITY, |it| self.moments.distance(&it));
        if distance.is_finite() { distance } else { 1e6 }
    }

    /// Returns the weights with which the invariant measure of maps is closest to the picture, by its moments.
    pub(super) fn weights(&self, maps: &[DAffine2]) -> Vec<f64> {
        let areas = super::file::weights(maps);
        let roots = areas.iter().map(|weight| weight.sqrt()).collect();
        let mut search = Cma::new(roots, 0.1, Pcg::new(5, 3));
        let found = search.minimise(300 * maps.len(), 1e-5, |roots| {
            self.distance(maps, &probabilities(roots))
        });
        probabilities(&found.point)
    }
}

/// Returns the squares of numbers, over their sum.
fn probabilities(roots: &[f64]) -> Vec<f64> {
    let squares = roots.iter().map(|root| root * root + 1e-9);
    let sum: f64 = squares.clone().sum();
    squares.map(|square| square / sum).collect()
}

/// Searches systems by their moments, and refines the best on their attractors.
pub(super) fn search(
    shape: &Silhouette,
    collage: &Collage<'_>,
    counts: RangeInclusive<usize>,
) -> Result<Vec<Refined>, FitError> {
    let target = Target::of(shape).ok_or(FitError::Empty)?;
    collage.search_in(counts, Method::Moments, |count| {
        starts(shape, collage, &target, count)
    })
}

/// Returns the candidates with a number of maps whose moments are closest.
fn starts(
    shape: &Silhouette,
    collage: &Collage<'_>,
    target: &Target,
    count: usize,
) -> Vec<Refined> {
    let options = collage.options();
    let form = match options.similar {
        true => Form::Similar,
        false => Form::Affine,
    };
    let threads = options.threads.get();
    let [some, more] = SHARES.map(|share| options.effort / share);
    let numbers: Vec<u64> = (1000..).take(STARTS).collect();
    let first = parallel::map(&numbers, threads, |_, &number| {
        let random = collage.random(count, mix(number));
        let roots = vec![1.0; count];
        settled(shape, target, form, (&random, &roots), options.budget(some))
    });
    let mut first: Vec<Settled> = first;
    first.sort_by(|one, other| one.distance.total_cmp(&other.distance));
    first.truncate(CONTINUED);
    let last = parallel::map(&first, threads, |_, start| {
        let start = (&start.candidate, &start.roots[..]);
        settled(shape, target, form, start, options.budget(more))
    });
    collage.count(STARTS * some + CONTINUED * more);
    let mut orbit = Orbit::new(collage.fine());
    let refined = last.into_iter().map(|found| Refined {
        loss: orbit.loss(&found.candidate, collage.fine()),
        candidate: found.candidate,
        form,
        evaluations: 0,
    });
    let mut refined: Vec<Refined> = refined.collect();
    refined.sort_by(|one, other| one.loss.total_cmp(&other.loss));
    refined
}

/// A system with the roots of its weights.
struct Settled {
    candidate: Candidate,
    roots: Vec<f64>,
    distance: f64,
}

/// Minimises the distance of moments from a start.
fn settled(
    shape: &Silhouette,
    target: &Target,
    form: Form,
    (start, roots): (&Candidate, &[f64]),
    budget: Budget<'_>,
) -> Settled {
    let numbers = Numbers::new(shape, start, form);
    let radius = shape.radius().max(1.0);
    // Weights vary like positions: by the size of the shape.
    let mut point = numbers.of(start);
    let split = point.len();
    point.extend(roots.iter().map(|root| root * radius / 2.0));
    let candidate = |point: &[f64]| numbers.candidate(&point[..split]);
    let mut search = Cma::new(point, radius / 10.0, Pcg::new(split as u64, 9));
    let found = search.minimise(budget, radius * 1e-4, |point| {
        target.distance(&candidate(point).maps, &probabilities(&point[split..]))
    });
    Settled {
        candidate: candidate(&found.point),
        roots: { found.point[split..].iter() }
            .map(|root| 2.0 * root / radius)
            .collect(),
        distance: found.value,
    }
}
