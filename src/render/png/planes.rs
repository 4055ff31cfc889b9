use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};

use super::coverage::Plane;

/// Planes beside the first one have no more pixels than this together.
const MOST_PIXELS: u64 = 1 << 24;

/// Planes of one part of a picture, so that several threads cover it at once. What they cover comes
/// together when it is coloured; which of them it is on does not show.
pub(super) struct Planes {
    size: [u32; 2],
    /// Nothing as long as nothing has been covered.
    planes: Vec<Mutex<Option<Plane>>>,
}

impl Planes {
    /// As many planes as there are threads, but no more than memory should hold.
    pub(super) fn new(size: [u32; 2], threads: usize) -> Self {
        let pixels = size.map(u64::from).iter().product::<u64>().max(1);
        let others = usize::try_from(MOST_PIXELS / pixels).unwrap_or(usize::MAX);
        let count = threads.min(others.saturating_add(1));
        Self {
            size,
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
        cover(plane.get_or_insert_with(|| Plane::new(self.size)));
    }

    /// Gives every pixel that is covered with how much of it is, in any order, and uncovers all.
    pub(super) fn drain(&self, paint: impl FnMut(usize, u32)) {
        let mut planes = self.planes.iter().map(lock);
        let Some(mut first) = planes.next() else {
            return;
        };
        let first = first.get_or_insert_with(|| Plane::new(self.size));
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
