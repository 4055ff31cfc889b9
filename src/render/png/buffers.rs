//! Coverage buffers of a part of a picture, which threads fill in parallel.

use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};

use crate::parallel::{for_each, pick};

use super::coverage::{CoverageBuffer, Drain};

/// Maximum total number of pixels of the buffers other than the first.
const MAX_PIXELS: u64 = 1 << 24;

/// Maximum for a picture that is drawn in bands, so that it stays within 300 MB.
const MAX_PIXELS_OF_BANDS: u64 = 1 << 22;

/// Coverage buffers of one part of a picture, so that several threads cover it at once. The buffers are
/// united when the part is coloured, so that the division of paths between them has no effect.
pub(super) struct CoverageBuffers {
    picture: [u32; 2],
    rows: Range<u32>,
    /// Buffers; `None` while nothing is covered.
    planes: Vec<Mutex<Option<CoverageBuffer>>>,
    /// Number of threads that colour pixels.
    threads: usize,
}

impl CoverageBuffers {
    /// Creates one buffer per thread, within the limits of memory.
    pub(super) fn new(picture: [u32; 2], rows: Range<u32>, threads: usize) -> Self {
        let pixels = u64::from(picture[0]) * u64::from(rows.end - rows.start).max(1);
        let is_band = rows != (0..picture[1]);
        let most = if is_band {
            MAX_PIXELS_OF_BANDS
        } else {
            MAX_PIXELS
        };
        let others = usize::try_from(most / pixels).unwrap_or(usize::MAX);
        let count = threads.min(others.saturating_add(1));
        Self {
            picture,
            planes: std::iter::repeat_with(Mutex::default).take(count).collect(),
            rows,
            threads,
        }
    }

    /// Moves the empty buffers to as many other rows of a picture of equal size; `None` if it has another one.
    pub(super) fn moved_to(self, picture: [u32; 2], rows: &Range<u32>) -> Option<Self> {
        if self.picture != picture || self.rows.len() != rows.len() {
            return None;
        }
        let threads = self.threads;
        let planes = self.planes.into_iter().map(|plane| {
            let mut plane = plane.into_inner().unwrap_or_else(PoisonError::into_inner);
            if let Some(plane) = &mut plane {
                plane.move_to(rows.start);
            }
            Mutex::new(plane)
        });
        Some(Self {
            picture,
            rows: rows.clone(),
            planes: planes.collect(),
            threads,
        })
    }

    /// Covers something on a buffer on which no other thread draws.
    pub(super) fn with_one(&self, cover: impl FnOnce(&mut CoverageBuffer)) {
        let planes = self.planes.iter().skip(pick(self.planes.len()));
        let mut free = planes.filter_map(|plane| match plane.try_lock() {
            Ok(plane) => Some(plane),
            Err(TryLockError::Poisoned(poisoned)) => Some(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        });
        let mut plane = free.next().unwrap_or_else(|| lock(&self.planes[0]));
        let made = || CoverageBuffer::of_rows(self.picture, self.rows.clone());
        cover(plane.get_or_insert_with(made));
    }

    /// Calls `paint` with every covered pixel and its coverage, in any order on all threads, and clears the
    /// buffers. `pixels` are those of the rows, row by row.
    pub(super) fn drain<T: Send>(&self, pixels: &mut [T], paint: impl Fn(&mut T, u32) + Sync) {
        let mut planes: Vec<_> = self.planes.iter().map(lock).collect();
        let made = planes.iter_mut().filter_map(|plane| plane.as_mut());
        if let Some(drain) = Drain::of(made) {
            let blocks = drain.blocks(pixels);
            for_each(blocks, self.threads, |block| drain.paint(block, &paint));
        }
    }
}

fn lock(plane: &Mutex<Option<CoverageBuffer>>) -> MutexGuard<'_, Option<CoverageBuffer>> {
    plane.lock().unwrap_or_else(PoisonError::into_inner)
}
