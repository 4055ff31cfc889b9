//! Elements and points as tables, for other programs.

mod bits;
mod columns;
mod listed;
mod pattern;
mod ply;
mod points;
mod table;

pub use bits::write_bits;
pub use columns::{Column, ColumnError, Columns};
pub use listed::Listed;
pub use ply::{Relief, write_ply};
pub use points::write_points;
pub use table::{TableFormat, write};
