use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};

use super::coverage::Plane;

/// Planes beside the first one have no more pixels than this together.
const MOST_PIXELS: u64 = 1 << 24;

/// Those of a picture that is drawn in bands, so that it stays within 300 MB.
const MOST_PIXELS_OF_BANDS: u64 = 1 << 22;

/// Planes of one part of a picture, so that several threads cover it at once. What they cover comes
/// together when it is coloured; which of them it is on does not show.
pub(super) struct Planes {
    picture: [u32; 2],
    rows: Range<u32>,
    /// Nothing as long as nothing has been covered.
    planes: Vec<Mutex<Option<Plane>>>,
}

impl Planes {
    /// As many planes as there are threads, but no more than memory should hold.
    pub(super) fn new(picture: [u32; 2], rows: Range<u32>, threads: usize) -> Self {
        let pixels = u64::from(picture[0]) * u64::from(rows.end - rows.start).max(1);
        let is_band = rows != (0..picture[1]);
        let most = if is_band {
            MOST_PIXELS_OF_BANDS
        } else {
            MOST_PIXELS
        };
        let others = usize::try_from(most / pixels).unwrap_or(usize::MAX);
        let count = threads.min(others.saturating_add(1));
        Self {
            picture,
            rows,
            planes: std::iter::repeat_with(Mutex::default).take(count).collect(),
        }
    }

    /// Covers something on a plane on which no other thread draws.
    pub(super) fn with_one(&self, cover: impl FnOnce(&mut Plane)) {
        let mut free = self
            .planes
            .iter()
            .filter_map(|plane| match plane.try_lock() {
                Ok(plane) => Some(plane),
                Err(TryLockError::Poisoned(poisoned)) => Some(poisoned.into_inner()),
                Err(TryLockError::WouldBlock) => None,
            });
        let mut plane = free.next().unwrap_or_else(|| lock(&self.planes[0]));
        cover(plane.get_or_insert_with(|| self.plane()));
    }

    fn plane(&self) -> Plane {
        Plane::of_rows(self.picture, self.rows.clone())
    }

    /// Gives every pixel that is covered with how much of it is, in any order, and uncovers all.
    pub(super) fn drain(&self, paint: impl FnMut(usize, u32)) {
        let mut planes = self.planes.iter().map(lock);
        let Some(mut first) = planes.next() else {
            return;
        };
        let first = first.get_or_insert_with(|| self.plane());
        for mut other in planes {
            if let Some(other) = &mut *other {
                first.take_over(other);
            }
        }
        first.drain(paint);
    }
}

fn lock(plane: &Mutex<Option<Plane>>) -> MutexGuard<'_, Option<Plane>> {
    plane.lock().unwrap_or_else(PoisonError::into_inner)
}
