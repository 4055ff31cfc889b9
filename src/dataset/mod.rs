//! Data sets of pictures of fractals, with labels, for the training of networks.
//!
//! A file of the kind `dataset` describes categories, the variation of their pictures, and how these are drawn:
//!
//! ```yaml
//! kind: dataset
//! categories: {systems: {random: {maps: [2, 7], sigma: anderson}, count: 1000}}
//! instances: {count: 1000, weights: fractaldb, flips: true}
//! picture: {size: 256, points: 100k, mode: hits, colour: gray, fit: box}
//! accept: {fill: 0.2}
//! ```
//!
//! Categories are systems of maps that are drawn at random by published laws ([`Law`]), members of a family with laws
//! of their parameters, tables of maps as FractalDB has them, or the fractals of the library. A picture is a pure function
//! of the file, the category and the instance: it is the same on every machine, in any order and in any part of the work.
//! Draws that are rejected are drawn again by their path, so that no number depends on them.
//!
//! Systems of maps are drawn by random iteration, fitted to their box ([`Framing`]); the box is exact where every map
//! contracts clearly, and otherwise that of 20,000 points. Other fractals are drawn as their files state, in
//! proportion, with the opacity as the level. Sets in space are seen in parallel projection, from directions that the
//! file chooses by `views`.
//!
//! ```
//! # fn main() -> Result<(), kfrac::dataset::DatasetError> {
//! use kfrac::dataset::Dataset;
//!
//! let text = "{kind: dataset, categories: {systems: {random: {maps: [2, 4]}, count: 10}}, \
//!              instances: {count: 50, weights: jitter(0.1)}, picture: {size: 64, points: 10k}}";
//! let set = Dataset::parse(text)?;
//! assert_eq!(set.len(), 500);
//! let example = set.example(123)?;
//! assert_eq!((example.category, example.instance), (2, 23));
//! assert_eq!(example.picture.size(), [64, 64]);
//! assert!(example.label.maps.unwrap().rows().len() >= 2);
//! # Ok(())
//! # }
//! ```

mod batch;
mod category;
mod csv;
mod extent;
mod maps;
mod origins;
mod picture;
mod random;
mod spec;
#[cfg(test)]
mod tests;
mod vary;

pub use crate::document::{Framing, Law, Mode};
pub use batch::Batch;
pub use category::{Category, Example, Label};
pub use maps::{Maps, WeightedMap};
pub use picture::Colouring;
pub use vary::Weights;

use std::path::Path as FilePath;
use std::sync::{Arc, OnceLock};

use crate::catalogue::{Catalogue, read_file};
use crate::diagnostic::{Diagnostic, Diagnostics, Source};
use crate::draws::Path;

use category::Prepared;
use spec::Spec;

/// A validated data set; see the [module](self).
#[derive(Debug)]
pub struct Dataset {
    spec: Spec,
    text: Arc<Source>,
    /// Categories that have been worked out.
    categories: Vec<OnceLock<Category>>,
}

/// Error of a data set.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DatasetError {
    /// The file is not valid.
    #[error("{0}")]
    Invalid(Diagnostics),
    /// No system that was drawn for a category meets the conditions.
    #[error(
        "no system of {attempts} that were drawn for category {category} can be drawn and has the fill that is asked for; a smaller \
         `accept: {{fill: …}}` accepts more"
    )]
    NoSystem {
        /// Number of the category.
        category: u32,
        /// Number of systems that were drawn.
        attempts: u32,
    },
    /// A picture cannot be drawn.
    #[error("picture {instance} of category {category} cannot be drawn: {reason}")]
    Picture {
        /// Number of the category.
        category: u32,
        /// Number of the picture in the category.
        instance: u32,
        /// The reason.
        reason: String,
    },
    /// There is no picture of this number.
    #[error("there is no picture {index}: the data set has {len}")]
    Index {
        /// The number.
        index: u64,
        /// Number of pictures.
        len: u64,
    },
    /// The work was cancelled.
    #[error("interrupted")]
    Cancelled,
}

impl From<Diagnostics> for DatasetError {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::Invalid(diagnostics)
    }
}

impl From<Diagnostic> for DatasetError {
    fn from(diagnostic: Diagnostic) -> Self {
        Self::Invalid(diagnostic.into())
    }
}

/// Largest number of categories.
const MAX_CATEGORIES: usize = 10_000_000;

impl Dataset {
    /// Reads the text of a data set.
    ///
    /// # Errors
    ///
    /// If the text is not valid: all mistakes, with their places.
    pub fn parse(text: &str) -> Result<Self, DatasetError> {
        Self::read(&Source::new("text", text), &Catalogue::embedded())
    }

    /// Reads the file of a data set. Paths in it are relative to its folder, and names are those of the embedded library.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, or is not valid: all mistakes, with their places.
    pub fn open(path: impl AsRef<FilePath>) -> Result<Self, DatasetError> {
        Self::read(&read_file(path.as_ref())?, &Catalogue::embedded())
    }

    /// Reads a source whose names are looked up in a catalogue.
    ///
    /// # Errors
    ///
    /// If the source is not valid: all mistakes, with their places.
    pub fn read(source: &Arc<Source>, catalogue: &Catalogue) -> Result<Self, DatasetError> {
        let spec = Spec::read(source, catalogue)?;
        let counts = spec.origins.iter().map(|origin| origin.count() as usize);
        let count = counts.fold(0, usize::saturating_add);
        if count > MAX_CATEGORIES {
            let message = format!("{count} categories are more than {MAX_CATEGORIES}");
            return Err(Diagnostic::error(message).into());
        }
        Ok(Self {
            spec,
            text: Arc::clone(source),
            categories: (0..count).map(|_| OnceLock::new()).collect(),
        })
    }

    /// Returns the text from which it was read.
    #[must_use]
    pub fn text(&self) -> &str {
        self.text.text()
    }

    /// Returns the number of pictures.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "there is a picture")]
    pub fn len(&self) -> u64 {
        u64::from(self.categories()) * u64::from(self.instances())
    }

    /// Returns the number of categories.
    #[must_use]
    pub fn categories(&self) -> u32 {
        u32::try_from(self.categories.len()).unwrap_or(u32::MAX)
    }

    /// Returns the number of pictures of a category.
    #[must_use]
    pub fn instances(&self) -> u32 {
        self.spec.instances
    }

    /// Returns the side of pictures, in pixels.
    #[must_use]
    pub fn size(&self) -> u32 {
        self.spec.size
    }

    /// Returns the number of bytes a pixel: 1 for grey levels, 3 for colours.
    #[must_use]
    pub fn channels(&self) -> u8 {
        match self.spec.colouring {
            Colouring::Grey => 1,
            _ => 3,
        }
    }

    /// Returns category and instance of a picture: pictures of a category follow each other.
    ///
    /// # Errors
    ///
    /// If there is no picture of this number.
    pub fn place(&self, index: u64) -> Result<(u32, u32), DatasetError> {
        let len = self.len();
        let instances = u64::from(self.instances());
        let place = (index < len).then(|| {
            let category = u32::try_from(index / instances).ok()?;
            Some((category, u32::try_from(index % instances).ok()?))
        });
        place.flatten().ok_or(DatasetError::Index { index, len })
    }

    /// Returns the pictures of a part of the work: part `number` (from 1) of `count` parts, which differ by at most one
    /// picture.
    #[must_use]
    pub fn shard(&self, number: u32, count: u32) -> std::ops::Range<u64> {
        let end = |number: u32| {
            let end =
                u128::from(self.len()) * u128::from(number.min(count)) / u128::from(count.max(1));
            u64::try_from(end).unwrap_or(u64::MAX)
        };
        end(number.saturating_sub(1))..end(number)
    }

    /// Returns a category. Random systems are drawn when they are asked for, and kept.
    ///
    /// # Errors
    ///
    /// If there is no such category, or none that meets the conditions.
    pub fn category(&self, number: u32) -> Result<&Category, DatasetError> {
        let Some(place) = self.categories.get(number as usize) else {
            let (index, len) = (number.into(), self.categories().into());
            return Err(DatasetError::Index { index, len });
        };
        if let Some(known) = place.get() {
            return Ok(known);
        }
        let category = Category::find(&self.spec, number)?;
        Ok(place.get_or_init(|| category))
    }

    /// Returns a picture with its label.
    ///
    /// # Errors
    ///
    /// If there is no such picture, its category has no system, or it cannot be drawn.
    pub fn example(&self, index: u64) -> Result<Example, DatasetError> {
        self.prepared(index)?.draw(&self.spec)
    }

    /// Returns the label of a picture without drawing it.
    ///
    /// # Errors
    ///
    /// If there is no such picture, or its category has no system.
    pub fn label(&self, index: u64) -> Result<Label, DatasetError> {
        Ok(self.prepared(index)?.label)
    }

    fn prepared(&self, index: u64) -> Result<Prepared, DatasetError> {
        let (category, instance) = self.place(index)?;
        self.category(category)?.prepare(&self.spec, instance)
    }
}

/// Returns the path of the draws of a category.
fn path_of(spec: &Spec, category: u32) -> Path {
    Path::of_seed(spec.seed).child(category)
}
