//! Limits, cancellation and progress of a walk.

use crate::parallel::is_cancelled;

use super::descent::PATIENCE;
use super::{Growth, WalkError, Walked};

/// Maximum number of visits, replaced elements included, for each element that is allowed.
const VISITS_AN_ELEMENT: u64 = 20;
/// Number of visits that is always allowed.
const FEW_VISITS: u64 = 1 << 24;

/// Counters of a walk, compared with its limits.
pub(super) struct Tally<'v> {
    growth: Growth<'v>,
    walked: Walked,
    /// Number of elements already reported as progress.
    reported: u64,
    visited: u64,
    next_check: u64,
}

impl<'v> Tally<'v> {
    pub(super) fn new(growth: &Growth<'v>) -> Self {
        Self {
            growth: *growth,
            walked: Walked::default(),
            reported: 0,
            visited: 0,
            next_check: PATIENCE,
        }
    }

    /// Counts fractals that begin.
    pub(super) fn begin(&mut self, fractals: u64) {
        self.walked.fractals += fractals;
    }

    /// Counts elements of the approximant.
    #[inline]
    pub(super) fn count<E>(&mut self, elements: u64) -> Result<(), WalkError<E>> {
        self.walked.elements += elements;
        if self.walked.elements > self.growth.max_elements {
            return Err(WalkError::TooManyElements {
                limit: self.growth.max_elements,
            });
        }
        Ok(())
    }

    /// Counts visits of elements, replaced ones included.
    #[inline]
    pub(super) fn visit<E>(&mut self, count: u64) -> Result<(), WalkError<E>> {
        self.visited += count;
        if self.visited < self.next_check {
            return Ok(());
        }
        self.look()
    }

    fn look<E>(&mut self) -> Result<(), WalkError<E>> {
        self.next_check = self.visited + PATIENCE;
        self.report_progress();
        let most = FEW_VISITS.max(self.growth.max_elements.saturating_mul(VISITS_AN_ELEMENT));
        if self.visited > most {
            return Err(WalkError::TooLong { limit: most });
        }
        match is_cancelled(self.growth.cancel) {
            true => Err(WalkError::Cancelled),
            false => Ok(()),
        }
    }

    fn report_progress(&mut self) {
        if let Some(progress) = self.growth.progress {
            progress.count(self.walked.elements - self.reported);
            self.reported = self.walked.elements;
        }
    }

    /// Reports the remaining progress, and returns the totals.
    pub(super) fn finish(mut self) -> Walked {
        self.report_progress();
        self.walked
    }
}
