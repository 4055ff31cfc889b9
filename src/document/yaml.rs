//! YAML read into [`Node`](super::node::Node)s and written from them.
//!
//! It builds on the event parser below `serde-saphyr`, not on its `Spanned` values: only the events
//! say how a scalar was quoted and where a collection ends, and only with them can reading go on
//! behind a mistake.

mod limits;
mod read;
mod repair;
mod scalar;
mod trouble;
mod write;

pub(super) use limits::{Budget, Size};
pub(super) use read::read;
pub(super) use scalar::number;
pub(super) use write::write;

#[cfg(test)]
mod tests;
