//! Metadata that files of all kinds have beside their mathematics.

use crate::expression::Program;
use crate::geometry::Homothety;
use crate::style::{DensityView, SpaceView, Style, View};
use crate::symmetry::Symmetry;

/// Maximum number of steps that a file may propose.
pub(crate) const MAX_STEPS: u32 = 1_000_000;

/// Description of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Description {
    /// Title.
    pub title: Option<String>,
    /// Description in a few sentences.
    pub about: Option<String>,
    /// Paper, book or author from which the fractal is taken.
    pub source: Option<String>,
    /// Keywords for searches.
    pub tags: Vec<String>,
}

/// Parameter with its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name in expressions and settings.
    pub name: String,
    /// Value.
    pub value: f64,
    /// Least permitted value.
    pub min: Option<f64>,
    /// Greatest permitted value.
    pub max: Option<f64>,
    /// Meaning of the parameter.
    pub about: Option<String>,
}

impl Parameter {
    /// Creates a parameter without limits.
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

/// Metadata of a file: its description, its parameters, published dimensions, and how it is drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metadata {
    /// Title, source and related metadata.
    pub description: Description,
    /// Parameters with their values.
    pub parameters: Vec<Parameter>,
    /// Values of the parameters as written, each after those on which it depends.
    pub(crate) numbers: Vec<Program>,
    /// Number of steps that the file proposes.
    pub steps: Option<u32>,
    /// Published similarity dimension.
    pub dimension: Option<f64>,
    /// Published Hausdorff dimension, where it differs from the similarity dimension.
    pub hausdorff_dimension: Option<f64>,
    /// Group under whose isometries the picture is repeated.
    pub symmetry: Option<Symmetry>,
    /// Style of drawings.
    pub style: Style,
    /// Part of the plane that is drawn, and the margin.
    pub view: View,
    /// View of a set in space.
    pub space: SpaceView,
    /// Hits of pixels, as they are drawn in a PNG.
    pub density: DensityView,
}

impl Metadata {
    /// Returns the metadata in the coordinates that a homothety maps to the present ones.
    pub(crate) fn within(&self, place: &Homothety) -> Self {
        let symmetry = self.symmetry.as_ref();
        Self {
            symmetry: symmetry.map(|group| group.within(place)),
            ..self.clone()
        }
    }
}
