use std::sync::atomic::Ordering;

use super::descent::PATIENCE;
use super::{Growth, WalkError, Walked};

/// A walk may visit so many elements for each that is allowed, those on the way counted, or so many
/// in all if that is more.
const VISITS_AN_ELEMENT: u64 = 20;
const FEW_VISITS: u64 = 1 << 24;

/// What a walk has met so far, held against its limits.
pub(super) struct Tally<'v> {
    growth: Growth<'v>,
    walked: Walked,
    /// The elements that progress has been told of.
    told: u64,
    visited: u64,
    next_look: u64,
}

impl<'v> Tally<'v> {
    pub(super) fn new(growth: &Growth<'v>) -> Self {
        Self {
            growth: *growth,
            walked: Walked::default(),
            told: 0,
            visited: 0,
            next_look: PATIENCE,
        }
    }

    /// Counts fractals that begin.
    pub(super) fn begin(&mut self, fractals: u64) {
        self.walked.fractals += fractals;
    }

    /// Counts elements that come next.
    #[inline]
    pub(super) fn count<E>(&mut self, elements: u64) -> Result<(), WalkError<E>> {
        self.walked.elements += elements;
        if self.walked.elements > self.growth.most_elements {
            return Err(WalkError::TooManyElements {
                limit: self.growth.most_elements,
            });
        }
        Ok(())
    }

    /// Counts elements that have been visited on the way.
    #[inline]
    pub(super) fn visit<E>(&mut self, count: u64) -> Result<(), WalkError<E>> {
        self.visited += count;
        if self.visited < self.next_look {
            return Ok(());
        }
        self.look()
    }

    fn look<E>(&mut self) -> Result<(), WalkError<E>> {
        self.next_look = self.visited + PATIENCE;
        self.tell_progress();
        let most = FEW_VISITS.max(self.growth.most_elements.saturating_mul(VISITS_AN_ELEMENT));
        if self.visited > most {
            return Err(WalkError::TooLong { limit: most });
        }
        match self.growth.cancel {
            Some(cancel) if cancel.load(Ordering::Relaxed) => Err(WalkError::Cancelled),
            _ => Ok(()),
        }
    }

    fn tell_progress(&mut self) {
        if let Some(progress) = self.growth.progress {
            progress.count(self.walked.elements - self.told);
            self.told = self.walked.elements;
        }
    }

    /// The walk is over.
    pub(super) fn finish(mut self) -> Walked {
        self.tell_progress();
        self.walked
    }
}
