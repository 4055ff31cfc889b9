//! Counters of a thread, with progress and cancellation.

use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, PoisonError};

use crate::grow::Progress;
use crate::parallel::is_cancelled;

use super::walkers::Bins;

/// Error of a game that was cancelled.
#[derive(Debug)]
pub(super) struct Cancelled;

/// Maximum number of points in a counter of a thread.
const MOST: u64 = u32::MAX as u64;

/// Number of points between two reports of progress.
const PATIENCE: u64 = 1 << 17;

/// Counts of a thread.
pub(super) struct Tally<'a> {
    counts: Vec<u32>,
    counted: u64,
    /// Number of points not yet reported to the progress.
    untold: u64,
    /// Counts of all threads.
    all: &'a Mutex<Option<Vec<u32>>>,
    progress: Option<&'a Progress>,
    cancel: Option<&'a AtomicBool>,
}

impl<'a> Tally<'a> {
    pub(super) fn new(
        bins: usize,
        all: &'a Mutex<Option<Vec<u32>>>,
        progress: Option<&'a Progress>,
        cancel: Option<&'a AtomicBool>,
    ) -> Self {
        Self {
            counts: vec![0; bins],
            counted: 0,
            untold: 0,
            all,
            progress,
            cancel,
        }
    }

    /// Counts the first points of a block, up to `most`, and returns their number.
    #[inline(always)]
    pub(super) fn add(&mut self, bins: &Bins, most: u64) -> Result<u64, Cancelled> {
        let bins = bins.as_flattened();
        let bins = &bins[..bins.len().min(usize::try_from(most).unwrap_or(usize::MAX))];
        for &bin in bins {
            if let Some(count) = self.counts.get_mut(bin as usize) {
                *count += 1;
            }
        }
        let points = bins.len() as u64;
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
            let none = vec![0; self.counts.len()];
            let counts = std::mem::replace(&mut self.counts, none);
            self.hand_in(counts);
            self.counted = 0;
        }
        match is_cancelled(self.cancel) {
            true => Err(Cancelled),
            false => Ok(()),
        }
    }

    /// Adds counts to those of all threads.
    fn hand_in(&mut self, counts: Vec<u32>) {
        let mut all = self.all.lock().unwrap_or_else(PoisonError::into_inner);
        match &mut *all {
            None => *all = Some(counts),
            Some(all) => {
                for (all, count) in all.iter_mut().zip(counts) {
                    *all = all.saturating_add(count);
                }
            }
        }
    }

    /// Ends the count, and adds it to that of all threads.
    pub(super) fn finish(mut self) {
        let counts = std::mem::take(&mut self.counts);
        self.hand_in(counts);
        if let Some(progress) = self.progress {
            progress.count(self.untold);
        }
    }
}
