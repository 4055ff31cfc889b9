//! Dimensions and distances.

mod cover;
mod hausdorff;
mod nearest;
mod region;
mod similarity;

pub use cover::{NoCover, Set, Subject};
pub use hausdorff::{Distance, Precision, hausdorff};
pub use region::TooMany;
pub use similarity::{Similarity, similarity_dimension};
