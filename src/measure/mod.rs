//! Dimensions: exact where the graph tells them, measured by boxes where it does not.
//!
//! Three kinds of sets are covered by boxes: the pixels of a picture ([`Bits`]), [`Points`] of the
//! plane, and the [`LimitSet`] of a graph, with nothing drawn in between (or what is [`grown`] of it,
//! where maps are drawn by chance). Every size of boxes is counted on several [`Grid`]s, of which the
//! least cover counts; boxes of a limit set that are too many to be counted are told by a sample of
//! them, which is followed down to 10⁻⁹ of its extent. Points are taken for a [`Sample`] of a set.
//! Of pictures, the mean counts over all grids are told as well, and extrapolated.
//! [`BoxCounting`] is the slope of the counts with its error and its evidence, [`Generalised`] are the
//! other dimensions D_q; [`Masses`] tell lacunarity. [`hausdorff`] tells how far two sets are apart.
//!
//! The D_q of a limit set are those of a measure on it, a [`Cascade`]: what its weights give, or the
//! natural one. Of every entry of the library whose dimension is decided, what is measured lies within 0.03 and
//! three standard errors of it for q from −2 to 5 (`cargo run --release --example spectra`): within 0.01 but
//! for sets whose rim has nearly their own dimension, as the Lévy curve's of 1.934.
//!
//! The axes are those of the sets: x to the right and y up, but rows of pictures from the top down.
//!
#![doc = include_str!("library.md")]

mod averaging;
mod bits;
mod box_counting;
mod copies;
mod cover;
mod distance;
pub mod exact;
mod extrapolation;
mod grown;
mod limit;
mod mass;
mod perron;
mod points;
mod raster;
mod regression;
mod sample;
mod similarity;
mod spectrum;
mod trend;
mod units;

pub use bits::Bits;
pub use box_counting::{BoxCounting, Boxes, Window};
pub use cover::{Grid, Scale};
pub use distance::{Distance, NoCover, Precision, Set, Subject, TooMany, hausdorff};
pub use grown::{Grown, grown};
pub use limit::{Cascade, LimitSet, NoLimit};
pub use mass::{FINENESS, Lacunarity, Masses};
pub use points::{NoExtent, Points, counts};
pub use raster::raster_scales;
pub use regression::Estimate;
pub use sample::Sample;
pub use similarity::{Similarity, similarity_dimension};
pub use spectrum::Generalised;
pub use trend::Trend;
