//! Compilation of the models of all kinds to graphs.

mod ifs;
mod instancing;
mod lsystem;
mod rule;
mod state;

pub(crate) use lsystem::Chords;
