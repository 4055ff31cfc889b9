//! Dimensions.

mod similarity;

pub use similarity::{Similarity, similarity_dimension};
