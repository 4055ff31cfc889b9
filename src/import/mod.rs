//! Pictures and tables of points, as they come from elsewhere.

mod picture;
mod table;

pub use picture::{Channel, Picture, PictureError};
pub use table::{TableError, read_points};
