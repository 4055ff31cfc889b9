//! How far two sets are apart: both are covered by points, and the points compared.

mod cover;
mod hausdorff;
mod nearest;
mod region;
mod squares;

pub use cover::{NoCover, Set, Subject};
pub use hausdorff::{Distance, Precision, hausdorff};
pub use region::TooMany;
