//! Dimensions.

pub mod exact;
mod similarity;

pub use similarity::{Similarity, similarity_dimension};
