use std::sync::atomic::{AtomicU64, Ordering};

/// How far the walks of a job are, to be read from another thread while they go on.
///
/// Walks count what they have met every few thousand elements. How much there is to be met, over
/// all walks of the job, is announced by those who know: an exporter that walks once, a picture
/// once its survey has told what there is to draw.
#[derive(Debug, Default)]
pub struct Progress {
    walked: AtomicU64,
    expected: AtomicU64,
}

impl Progress {
    /// Announces walks over so many elements, those that have been met already included.
    pub fn expect(&self, elements: u64) {
        // Only ever shown: what is beyond all counting may as well wrap around.
        self.expected.fetch_add(elements, Ordering::Relaxed);
    }

    /// The elements that have been met so far.
    #[must_use]
    pub fn walked(&self) -> u64 {
        self.walked.load(Ordering::Relaxed)
    }

    /// The elements that are going to be met in all, once that is known.
    #[must_use]
    pub fn expected(&self) -> Option<u64> {
        let expected = self.expected.load(Ordering::Relaxed);
        (expected > 0).then_some(expected)
    }

    /// Counts elements that have been met.
    pub(crate) fn count(&self, elements: u64) {
        self.walked.fetch_add(elements, Ordering::Relaxed);
    }
}
