//! Figures: the components of a rule, approximants side by side, differences of sets, plots of dimensions.

pub mod difference;
pub mod dimension;
pub mod rule;
pub mod sheet;
pub mod skeleton;
mod text;

use crate::style::Colour;

/// Colour of labels, legible on white and on black.
const LABEL: Colour = Colour::grey(118);
