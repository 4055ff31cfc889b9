//! Import of external data: pictures, tables of points, and files of other programs.

mod fractint;
mod picture;
#[cfg(feature = "tables")]
mod ply;
#[cfg(feature = "tables")]
mod table;

pub use fractint::{Fractint, Imported, read as read_fractint};
pub use picture::{Channel, PictureError, Raster};
#[cfg(feature = "tables")]
pub use ply::{PlyError, read_ply};
#[cfg(feature = "tables")]
pub use table::{Table, TableError, read_points};
