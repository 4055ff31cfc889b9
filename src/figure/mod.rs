//! Figures about a rule: its components, its approximants side by side, how it differs from another.

pub mod difference;
pub mod dimension;
pub mod rule;
pub mod sheet;
mod text;

use crate::style::Colour;

/// The colour of labels: it can be read on white and on black.
const LABEL: Colour = Colour::grey(118);
