//! Counters of a thread, with progress and cancellation.

use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, PoisonError};

use crate::grow::Progress;
use crate::parallel::is_cancelled;

/// Error of a game that was cancelled.
#[derive(Debug)]
pub(super) struct Cancelled;

/// Maximum number of points in a counter of a thread.
const MOST: u64 = u32::MAX as u64;

/// Number of points between two reports of progress.
const PATIENCE: u64 = 1 << 17;

/// Counters that the points of walks are added to.
pub(super) trait Counter: Send {
    /// Place of a point among the counters.
    type Spot: Copy + Default;

    /// Adds points.
    fn add(&mut self, spots: &[Self::Spot]);

    /// Adds the counts of another thread.
    fn merge(&mut self, other: Self);
}

/// Counts of a thread.
pub(super) struct Tally<'a, C> {
    counter: C,
    fresh: &'a (dyn Fn() -> C + Sync),
    counted: u64,
    /// Number of points not yet reported to the progress.
    untold: u64,
    /// Counts of all threads.
    all: &'a Mutex<Option<C>>,
    progress: Option<&'a Progress>,
    cancel: Option<&'a AtomicBool>,
}

impl<'a, C: Counter> Tally<'a, C> {
    pub(super) fn new(
        fresh: &'a (dyn Fn() -> C + Sync),
        all: &'a Mutex<Option<C>>,
        progress: Option<&'a Progress>,
        cancel: Option<&'a AtomicBool>,
    ) -> Self {
        Self {
            counter: fresh(),
            fresh,
            counted: 0,
            untold: 0,
            all,
            progress,
            cancel,
        }
    }

    /// Adds the first points of a block, up to `most`, and returns their number.
    #[inline(always)]
    pub(super) fn add(&mut self, spots: &[C::Spot], most: u64) -> Result<u64, Cancelled> {
        let spots = &spots[..spots.len().min(usize::try_from(most).unwrap_or(usize::MAX))];
        self.counter.add(spots);
        let points = spots.len() as u64;
        self.counted += points;
        self.untold += points;
        if self.untold >= PATIENCE {
            self.look()?;
        }
        Ok(points)
    }

    /// Reports progress, adds counts to those of all threads before they overflow, and checks for
    /// cancellation.
    #[cold]
    fn look(&mut self) -> Result<(), Cancelled> {
        if let Some(progress) = self.progress {
            progress.count(self.untold);
        }
        self.untold = 0;
        if self.counted > MOST - 2 * PATIENCE {
            let counter = std::mem::replace(&mut self.counter, (self.fresh)());
            hand_in(self.all, counter);
            self.counted = 0;
        }
        match is_cancelled(self.cancel) {
            true => Err(Cancelled),
            false => Ok(()),
        }
    }

    /// Ends the count, and adds it to that of all threads.
    pub(super) fn finish(self) {
        hand_in(self.all, self.counter);
        if let Some(progress) = self.progress {
            progress.count(self.untold);
        }
    }
}

/// Adds counts to those of all threads.
fn hand_in<C: Counter>(all: &Mutex<Option<C>>, counter: C) {
    let mut all = all.lock().unwrap_or_else(PoisonError::into_inner);
    match &mut *all {
        None => *all = Some(counter),
        Some(all) => all.merge(counter),
    }
}
