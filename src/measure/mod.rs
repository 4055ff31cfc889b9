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
//! The axes are those of the sets: x to the right and y up, but rows of pictures from the top down.
//!
#![doc = include_str!("library.md")]

mod averaging;
mod bits;
mod box_counting;
mod cover;
mod distance;
pub mod exact;
mod extrapolation;
mod grown;
mod limit;
mod mass;
mod points;
mod raster;
mod regression;
mod sample;
mod similarity;
mod spectrum;
mod trend;

pub use bits::Bits;
pub use box_counting::{BoxCounting, Boxes, Window};
pub use cover::{Grid, Scale};
pub use distance::{Distance, NoCover, Precision, Set, Subject, TooMany, hausdorff};
pub use grown::{Grown, grown};
pub use limit::{LimitSet, NoLimit};
pub use mass::{FINENESS, Lacunarity, Masses};
pub use points::{NoExtent, Points, counts};
pub use raster::raster_scales;
pub use regression::Estimate;
pub use sample::Sample;
pub use similarity::{Similarity, similarity_dimension};
pub use spectrum::Generalised;
pub use trend::Trend;
