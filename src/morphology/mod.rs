//! Morphology of pictures of [bits](crate::Bits): distances.
//!
//! Pictures have columns to the right and rows from the top down; indices of pixels run along the rows.

mod distance;

pub use distance::{DistanceMap, NoDistances};
