//! Bookkeeping of a game: progress and cancellation.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::grow::Progress;

use super::walkers::Bins;

/// The game was cancelled.
#[derive(Debug)]
pub(super) struct Cancelled;

/// The most points that a counter of a thread may get.
const MOST: u64 = u32::MAX as u64;

/// Points are told to the progress when there are so many.
const PATIENCE: u64 = 1 << 17;

/// What a thread has counted.
pub(super) struct Tally<'a> {
    counts: Vec<u32>,
    counted: u64,
    /// Points that progress has not been told of.
    untold: u64,
    /// What all threads have counted.
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

    /// Counts the first points of a block, as many as there are up to a number, and tells how many.
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

    /// Tells progress, and looks whether to go on.
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
        match self.cancel {
            Some(cancel) if cancel.load(Ordering::Relaxed) => Err(Cancelled),
            _ => Ok(()),
        }
    }

    /// Adds what has been counted to what all have.
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

    /// Ends the count.
    pub(super) fn finish(mut self) {
        let counts = std::mem::take(&mut self.counts);
        self.hand_in(counts);
        if let Some(progress) = self.progress {
            progress.count(self.untold);
        }
    }
}
