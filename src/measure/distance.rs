//! The Hausdorff distance of two sets: both are covered by points, and the points are compared.

mod cells;
mod cover;
mod covering;
mod hausdorff;
mod nearest;
mod region;
mod words;

pub use cover::{NoCover, Subject, Subset};
pub use covering::Covering;
pub use hausdorff::{Distance, Precision, hausdorff};
pub use region::{Covered, Region, TooMany};
