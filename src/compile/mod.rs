//! Compilation of the models of all kinds to graphs.

mod distinguished;
mod drawn;
pub(crate) mod growing;
mod ifs;
mod instancing;
mod lsystem;
mod rule;
mod state;
mod surfaces;

pub(crate) use lsystem::Chords;
