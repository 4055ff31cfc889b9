//! Figures about a rule: its approximants side by side.

pub mod sheet;
mod text;

use crate::style::Colour;

/// The colour of labels: it can be read on white and on black.
const LABEL: Colour = Colour::grey(118);
