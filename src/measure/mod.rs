//! Dimensions of fractals: exact where the graph determines them, else measured by box counting.
//!
//! Three kinds of sets are covered by boxes: the pixels of a picture ([`Bits`]), [`Points`] of the plane, and
//! the [`LimitSet`] of a graph, which is covered directly, with nothing drawn. Where maps are drawn by
//! chance, [`grown`] computes points near the limit set instead. Boxes of every size are counted on several
//! [`Grid`]s, and the smallest count of each size is kept. Boxes of a limit set that are too many to be
//! counted are estimated from a sample of boxes, which is refined down to 10⁻⁹ of the set's extent. Points
//! are treated as a [`Sample`] of a set. For pictures, the mean counts over all grids are computed as well,
//! and extrapolated.
//!
//! A [`BoxCounting`] is the slope of the counts with its error and its evidence, [`Generalised`] holds the
//! generalised dimensions D_q, and [`Masses`] gives lacunarity. The function [`hausdorff`] computes the
//! distance of two sets.
//!
//! The D_q of a limit set are those of a measure on it, a [`Cascade`]: the measure that the weights define,
//! or the natural one. For every entry of the library whose dimension is decided, the measured D_q lie within
//! 0.03 and three standard errors of it for q from −2 to 5 (`cargo run --locked --release --example spectra`), and
//! within 0.01 except for sets whose rim has nearly their own dimension, as the Lévy curve's of 1.934.
//!
//! The axes are those of the sets: x to the right and y up. Rows of pictures run from the top down.
//!
#![doc = include_str!("library.md")]

mod averaging;
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
mod space;
mod spectrum;
mod statistics;
mod trend;
mod units;
mod voxels;

pub use crate::bits::Bits;
pub use box_counting::{BoxCounting, Boxes, Window};
pub use cover::{Grid, Scale};
pub use distance::{
    Covered, Covering, Distance, NoCover, Precision, Region, Subject, Subset, TooMany, hausdorff,
};
pub use grown::{GrownPoints, grown};
pub use limit::{Cascade, LimitSet, SlicedSet};
pub use mass::{Lacunarity, Masses};
pub use points::{NoExtent, Points, counts};
pub use raster::raster_scales;
pub use regression::Estimate;
pub use sample::Sample;
pub use similarity::{Similarity, moran_dimension, similarity_dimension};
pub use space::Space;
pub use spectrum::Generalised;
pub use trend::Trend;
