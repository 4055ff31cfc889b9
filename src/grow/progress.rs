//! Progress of walks, shared between threads.

use std::sync::atomic::{AtomicU64, Ordering};

/// Progress of the walks of a job, readable from other threads.
///
/// A walk adds the number of elements visited every few thousand elements. The total over all walks of a job
/// is announced by the code that knows it: by an exporter before its single walk, by a picture after its
/// prepass has determined the number of elements to draw.
#[derive(Debug, Default)]
pub struct Progress {
    walked: AtomicU64,
    expected: AtomicU64,
}

impl Progress {
    /// Adds elements to the expected total, which includes those already visited.
    pub fn expect(&self, elements: u64) {
        // A wrapped sum is harmless: the value is only displayed.
        self.expected.fetch_add(elements, Ordering::Relaxed);
    }

    /// Returns the number of elements visited so far.
    #[must_use]
    pub fn walked(&self) -> u64 {
        self.walked.load(Ordering::Relaxed)
    }

    /// Returns the total number of elements to be visited, if it has been announced.
    #[must_use]
    pub fn expected(&self) -> Option<u64> {
        let expected = self.expected.load(Ordering::Relaxed);
        (expected > 0).then_some(expected)
    }

    /// Adds elements that have been visited.
    pub(crate) fn count(&self, elements: u64) {
        self.walked.fetch_add(elements, Ordering::Relaxed);
    }
}
