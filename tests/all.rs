//! All tests of the crate as a whole, in one program: it is linked once.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps nothing")]

mod bad_input;
mod bands;
mod boxes;
mod build;
mod chaos;
mod clouds;
mod command_line;
mod common;
mod compare;
mod convert;
mod detail;
mod dimensions;
mod estimates;
mod exact;
mod figures;
mod fit;
mod gallery;
mod ifs_model;
mod import;
mod instanced;
mod instancing;
mod laws;
mod library;
mod lsystem;
mod manual;
mod meshes;
mod new_files;
mod pictures;
mod png;
mod random_iteration;
mod readme;
mod reference;
mod schema;
mod sheets;
mod snapshots;
mod surroundings;
mod systems;
mod terminal;
mod threads;
mod tints;
mod vectors;
mod visible;
mod windows;
mod zoom;
