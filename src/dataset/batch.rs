//! Pictures of a data set in one array.

use std::num::NonZero;
use std::ops::Range;
use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, PoisonError};

use crate::parallel::{for_each, is_cancelled};

use super::{Dataset, DatasetError};

/// Consecutive pictures, and their classes.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Batch {
    /// Bytes of all pictures, one after another: rows from the top, [channels](Dataset::channels) a pixel.
    pub bytes: Vec<u8>,
    /// Number of the category of each picture.
    pub categories: Vec<u32>,
}

impl Dataset {
    /// Draws consecutive pictures on several threads. The result does not depend on their number.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::dataset::DatasetError> {
    /// use kfrac::dataset::Dataset;
    ///
    /// let text = "{kind: dataset, categories: {systems: {random: {maps: 3}, count: 5}}, picture: {size: 32, points: 1k}}";
    /// let batch = Dataset::parse(text)?.render(1..4, std::num::NonZero::new(2).unwrap(), None)?;
    /// assert_eq!(batch.categories, [1, 2, 3]);
    /// assert_eq!(batch.bytes.len(), 3 * 32 * 32);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If there are no such pictures, if one cannot be drawn (the first one that was found), or if `cancel` is set.
    pub fn render(
        &self,
        range: Range<u64>,
        threads: NonZero<usize>,
        cancel: Option<&AtomicBool>,
    ) -> Result<Batch, DatasetError> {
        if range.end > self.len() || range.start > range.end {
            let (index, len) = (range.end, self.len());
            return Err(DatasetError::Index { index, len });
        }
        let side = self.size() as usize;
        let one = side * side * usize::from(self.channels());
        let count = usize::try_from(range.end - range.start).unwrap_or(usize::MAX);
        let mut batch = Batch {
            bytes: vec![0; one.saturating_mul(count)],
            categories: vec![0; count],
        };
        let failed: Mutex<Option<DatasetError>> = Mutex::new(None);
        let places = batch.bytes.chunks_exact_mut(one);
        let places = range.zip(places.zip(&mut batch.categories));
        for_each(places, threads.get(), |(index, (bytes, category))| {
            let failed = || failed.lock().unwrap_or_else(PoisonError::into_inner);
            if failed().is_some() {
                return;
            }
            let drawn = match is_cancelled(cancel) {
                true => Err(DatasetError::Cancelled),
                false => self.example(index),
            };
            match drawn {
                Ok(example) => {
                    bytes.copy_from_slice(example.picture.bytes());
                    *category = example.category;
                }
                Err(error) => *failed() = Some(error),
            }
        });
        match failed.into_inner().unwrap_or_else(PoisonError::into_inner) {
            Some(error) => Err(error),
            None => Ok(batch),
        }
    }
}
