//! Progress of a fit.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use super::{Candidate, Method};

/// The best candidate that a method has found so far.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BestSoFar {
    /// The method.
    pub method: Method,
    /// Number of maps.
    pub maps: usize,
    /// Number of condensation disks.
    pub disks: usize,
    /// Intersection over union of attractor and shape in cells, of at most 160 along a side.
    pub iou: f64,
}

/// Progress of a fit, readable from other threads.
#[derive(Debug, Default)]
pub struct FitProgress {
    evaluated: AtomicUsize,
    best: Mutex<Option<BestSoFar>>,
}

impl FitProgress {
    /// Returns the number of candidates that were evaluated so far.
    #[must_use]
    pub fn evaluated(&self) -> usize {
        self.evaluated.load(Ordering::Relaxed)
    }

    /// Returns the best candidate so far.
    #[must_use]
    pub fn best(&self) -> Option<BestSoFar> {
        let best = self.best.lock().unwrap_or_else(PoisonError::into_inner);
        best.clone()
    }

    pub(super) fn count(&self, evaluations: usize) {
        self.evaluated.fetch_add(evaluations, Ordering::Relaxed);
    }

    /// Notes a candidate, which counts if its intersection over union is the largest.
    pub(super) fn note(&self, method: Method, candidate: &Candidate, iou: f64) {
        let mut best = self.best.lock().unwrap_or_else(PoisonError::into_inner);
        if best.as_ref().is_none_or(|best| iou > best.iou) {
            *best = Some(BestSoFar {
                method,
                maps: candidate.maps.len(),
                disks: candidate.disks.len(),
                iou,
            });
        }
    }
}
