//! Parsing of YAML to [`Node`](super::node::Node)s and writing of YAML.
//!
//! The parser builds on the events of `granit-parser`, not on deserialized values: only events contain the
//! quoting of scalars and the ends of collections, and only they allow parsing to continue after a mistake.

mod limits;
mod read;
mod repair;
mod scalar;
mod trouble;
mod write;

pub(super) use limits::{Budget, MAX_VALUES, Size};
pub(super) use read::read;
pub(super) use scalar::number;
pub(super) use write::{scalar_key, scalar_text, write};

#[cfg(test)]
mod tests;
