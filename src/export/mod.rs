//! Elements as tables, for other programs.

mod table;

pub use table::{Format, write};
