//! What files of all kinds say, as it is written.

use crate::diagnostic::{Place, did_you_mean};
use crate::expression::PARTS;
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
    /// Its name: `s`, or `s.re` and `s.im` for the parts of a complex one.
    pub name: Written<String>,
    /// The name of the complex parameter that it is a part of.
    pub whole: Option<Written<String>>,
    /// Its value.
    pub value: Number,
    /// The least value that it may have.
    pub min: Option<Number>,
    /// The largest value that it may have.
    pub max: Option<Number>,
    /// What it means.
    pub about: Option<String>,
}

impl ParameterDocument {
    /// The name that the file gives it.
    #[must_use]
    pub fn called(&self) -> &Written<String> {
        self.whole.as_ref().unwrap_or(&self.name)
    }
}

impl HeadingDocument {
    /// What to set in place of a parameter that there is not.
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
