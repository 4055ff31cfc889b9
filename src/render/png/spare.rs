//! Memory of finished pictures, for those that follow.

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use tiny_skia::Pixmap;

use super::chunk::Chunk;
use super::part::Layers;
use super::stroker::Strokers;

/// Memory of a finished picture or band, for another one. Threads that repeatedly free and allocate memory would each
/// retain it, and memory that is new costs more than the pixels of a small picture.
#[derive(Default)]
pub(in crate::render) struct Spare {
    pub(super) pixmap: Option<Pixmap>,
    /// Empty coverage buffers.
    pub(super) layers: Layers,
    /// Empty chunk.
    pub(super) chunk: Chunk,
    /// Round pens that have been used.
    pub(super) strokers: Strokers,
}

impl Spare {
    /// Creates memory of some pixels.
    pub(in crate::render) fn of_pixels(pixmap: Pixmap) -> Self {
        Self {
            pixmap: Some(pixmap),
            ..Self::default()
        }
    }

    /// Takes the pixels, if they have this width and height. Their colours are arbitrary.
    pub(in crate::render) fn take_pixels(&mut self, size: [u32; 2]) -> Option<Pixmap> {
        self.pixmap.take_if(|it| [it.width(), it.height()] == size)
    }
}

/// Store of the memory of finished pictures. By default, nothing is stored.
#[derive(Clone, Default)]
pub(crate) struct Spares(Option<Arc<Mutex<Vec<Spare>>>>);

impl Spares {
    /// Creates a store for pictures that follow one another. It has as many entries as pictures are drawn at once.
    #[cfg(feature = "cli")]
    pub(crate) fn kept() -> Self {
        Self(Some(Arc::default()))
    }

    /// Takes the memory of a picture, if there is any.
    pub(in crate::render) fn take(&self) -> Spare {
        let stored = self.0.as_deref().and_then(|stored| {
            let mut stored = stored.lock().unwrap_or_else(PoisonError::into_inner);
            stored.pop()
        });
        stored.unwrap_or_default()
    }

    /// Stores the memory of a finished picture.
    pub(in crate::render) fn put(&self, spare: Spare) {
        if let Some(stored) = &self.0 {
            let mut stored = stored.lock().unwrap_or_else(PoisonError::into_inner);
            stored.push(spare);
        }
    }
}

impl fmt::Debug for Spares {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Spares").finish_non_exhaustive()
    }
}
