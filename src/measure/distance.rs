//! The Hausdorff distance of two sets: both are covered by points, and the points are compared.

mod cover;
mod hausdorff;
mod nearest;
mod region;
mod squares;

pub use cover::{NoCover, Subject, Subset};
pub use hausdorff::{Distance, Precision, hausdorff};
pub use region::TooMany;
