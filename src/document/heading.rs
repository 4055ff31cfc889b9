//! What files of all kinds say, as it is written.

use crate::diagnostic::Place;
use crate::heading::Description;
use crate::style::{Style, View};

use super::{Number, Written};

/// The heading of a file as written.
#[derive(Clone, Debug)]
pub struct HeadingDocument {
    /// Title, source and the like.
    pub description: Description,
    /// The parameters, in the order of the file.
    pub params: Vec<ParameterDocument>,
    /// What `grow` does without `--steps`.
    pub steps: Option<Number>,
    /// The published similarity dimension.
    pub dimension: Option<Number>,
    /// The set's own dimension, where copies overlap.
    pub hausdorff_dimension: Option<Number>,
    /// How it is drawn.
    pub style: Style,
    /// What part of the plane is drawn.
    pub view: View,
    /// Whether all of the file could be found. Where a parent or a component is missing, names that
    /// are not known may be its own.
    pub complete: bool,
    /// Where the file was written.
    pub place: Place,
}

/// A parameter as written.
#[derive(Clone, Debug)]
pub struct ParameterDocument {
    /// Its name.
    pub name: Written<String>,
    /// Its value.
    pub value: Number,
    /// The least value that it may have.
    pub min: Option<Number>,
    /// The largest value that it may have.
    pub max: Option<Number>,
    /// What it means.
    pub about: Option<String>,
}
