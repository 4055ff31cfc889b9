//! Metadata of files of all kinds, as written.

use std::collections::BTreeSet;

use crate::diagnostic::{Place, did_you_mean};
use crate::expression::PARTS;
use crate::metadata::Description;
use crate::style::{DensityView, SpaceView, Style, View};

use super::symmetry::SymmetryDocument;
use super::{FilmOption, Written, WrittenNumber};

/// Metadata of a file as written.
#[derive(Clone, Debug)]
pub struct MetadataDocument {
    /// Title, description, source and tags.
    pub description: Description,
    /// Parameters, in the order of the file.
    pub params: Vec<ParameterDocument>,
    /// Number of steps that the file proposes.
    pub steps: Option<WrittenNumber>,
    /// Published similarity dimension.
    pub dimension: Option<WrittenNumber>,
    /// Published Hausdorff dimension, where overlaps make it smaller than the similarity dimension.
    pub hausdorff_dimension: Option<WrittenNumber>,
    /// Group under whose isometries the picture is repeated.
    pub symmetry: Option<SymmetryDocument>,
    /// Style of the picture.
    pub style: Style,
    /// Whether the style sets `color_by`.
    pub sets_colours: bool,
    /// View: the window and the margin.
    pub view: View,
    /// View of a set in space.
    pub space: SpaceView,
    /// Hits of pixels, as they are drawn in a PNG.
    pub density: DensityView,
    /// Options of the film of the file, in its order.
    pub animation: Vec<FilmOption>,
    /// Names of parameters that ranges of repetitions use.
    pub used_by_ranges: BTreeSet<String>,
    /// Whether all parents, components and fractals were found. Otherwise unknown names may be defined
    /// in a missing file and are not reported.
    pub complete: bool,
    /// Source span of the file's content.
    pub place: Place,
}

/// A parameter as written. A complex parameter is represented by two real ones.
#[derive(Clone, Debug)]
pub struct ParameterDocument {
    /// Name: `s`, or `s.re` and `s.im` for the parts of a complex parameter.
    pub name: Written<String>,
    /// Name of the complex parameter to which this part belongs.
    pub whole: Option<Written<String>>,
    /// Value.
    pub value: WrittenNumber,
    /// Lower limit of the value.
    pub min: Option<WrittenNumber>,
    /// Upper limit of the value.
    pub max: Option<WrittenNumber>,
    /// Description of the parameter.
    pub about: Option<String>,
}

impl ParameterDocument {
    /// Returns the name under which the file defines the parameter: that of the complex parameter for a
    /// part.
    #[must_use]
    pub fn called(&self) -> &Written<String> {
        self.whole.as_ref().unwrap_or(&self.name)
    }
}

impl MetadataDocument {
    /// Returns a help text for a setting of an unknown parameter: how to set it if it is complex or
    /// real, the nearest name, or all names.
    pub(crate) fn instead_of(&self, name: &str) -> String {
        let has = |name: &str| self.params.iter().any(|it| it.called().value == name);
        if has(name) {
            return format!("'{name}' is complex: [real part, imaginary part]");
        }
        let mut wholes = PARTS.iter().filter_map(|part| name.strip_suffix(part));
        if let Some(whole) = wholes.find(|whole| has(whole)) {
            return format!("'{whole}' is a real number");
        }
        let mut names: Vec<&str> = self
            .params
            .iter()
            .map(|it| it.called().value.as_str())
            .collect();
        names.dedup();
        match did_you_mean(name, names.iter().copied()) {
            Some(hint) => hint,
            None if names.is_empty() => "it has none".into(),
            None => format!("it has: {}", names.join(", ")),
        }
    }
}
