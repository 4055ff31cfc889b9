//! Import of external data: pictures, tables of points, and files of other programs.

mod fractint;
mod picture;
mod table;

pub use fractint::{Fractint, Imported, read as read_fractint};
pub use picture::{Channel, PictureError, Raster};
pub use table::{TableError, read_points};
