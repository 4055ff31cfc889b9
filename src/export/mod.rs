//! Elements and points as tables, for other programs.

mod points;
mod table;

pub use points::write_points;
pub use table::{TableFormat, write};
