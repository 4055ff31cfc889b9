//! What files of all kinds say beside their mathematics.

use crate::style::{Style, View};

/// What a file says about itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Description {
    /// The title.
    pub title: Option<String>,
    /// A few sentences.
    pub about: Option<String>,
    /// The paper, book or person that it comes from.
    pub source: Option<String>,
    /// Words to find it by.
    pub tags: Vec<String>,
}

/// A parameter with its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// The name that expressions and `--set` call it by.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// The least value that it may have.
    pub min: Option<f64>,
    /// The largest value that it may have.
    pub max: Option<f64>,
    /// What it means.
    pub about: Option<String>,
}

impl Parameter {
    /// A parameter without limits.
    #[must_use]
    pub fn new(name: impl Into<String>, value: f64) -> Self {
        Self {
            name: name.into(),
            value,
            min: None,
            max: None,
            about: None,
        }
    }
}

/// The heading of a file: what it says of itself, its parameters, and how it likes to be drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Heading {
    /// Title, source and the like.
    pub description: Description,
    /// The parameters with their values.
    pub parameters: Vec<Parameter>,
    /// The number of steps that the file proposes.
    pub steps: Option<u32>,
    /// The published similarity dimension.
    pub dimension: Option<f64>,
    /// The published Hausdorff dimension, where it differs from the similarity dimension.
    pub hausdorff_dimension: Option<f64>,
    /// How it is drawn.
    pub style: Style,
    /// What part of the plane is drawn.
    pub view: View,
}
