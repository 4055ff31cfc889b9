//! Elements and points as tables, for other programs.

mod listed;
mod ply;
mod points;
mod table;

pub use listed::Listed;
pub use ply::{Surface, write_ply};
pub use points::write_points;
pub use table::{TableFormat, write};
