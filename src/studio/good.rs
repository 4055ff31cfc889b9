//! Texts that have been read: mistakes, and what the page has to know of a text without any.

use std::sync::Arc;

use serde::Serialize;
use serde_json::{Value, json};

use crate::catalogue::Catalogue;
use crate::cli::check;
use crate::diagnostic::Source;
use crate::document::node::Node;
use crate::document::{Document, Setting};
use crate::kind::Kind;
use crate::metadata::Parameter;
use crate::model::Model;
use crate::style::{Named, Width};

use super::problems::{Problem, problems};

/// A text without mistakes, with what the page has to know of it.
#[derive(Clone, Debug)]
pub(super) struct Good {
    pub(super) source: Arc<Source>,
    /// Revision of the text.
    pub(super) revision: u64,
    pub(super) kind: Kind,
    pub(super) is_in_space: bool,
    pub(super) parameters: Vec<ParameterState>,
    pub(super) about: Value,
    pub(super) style: Value,
    pub(super) own_steps: Option<u32>,
    /// The document with its parents and components.
    pub(super) document: Arc<Document>,
}

/// Largest number of parameters of a text of which it is tried whether they take whole numbers alone.
const TRIED: usize = 32;

/// Parameter of a rule.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct ParameterState {
    pub(super) name: String,
    /// Name of the complex parameter of which this is a part.
    pub(super) whole: Option<String>,
    pub(super) value: f64,
    pub(super) min: Option<f64>,
    pub(super) max: Option<f64>,
    /// Whether it takes whole numbers alone.
    pub(super) is_integer: bool,
    about: Option<String>,
}

/// A text that has been read.
pub(super) struct Checked {
    pub(super) text: Arc<str>,
    pub(super) good: Option<Good>,
    pub(super) problems: Vec<Problem>,
}

/// Reader of the texts of a rule.
#[derive(Clone, Debug)]
pub(super) struct Reader {
    pub(super) catalogue: Catalogue,
    pub(super) name: String,
}

impl Reader {
    /// Returns the source of a text.
    pub(super) fn source(&self, text: &str) -> Arc<Source> {
        Source::new(self.name.clone(), text)
    }

    /// Reads a text.
    pub(super) fn check(&self, text: Arc<str>) -> Checked {
        let source = self.source(&text);
        let (good, found) = match source.check_size() {
            Err(mistake) => (None, mistake.into()),
            Ok(()) => match check::checked(&source, &self.catalogue) {
                Err(found) => (None, found),
                Ok((document, model, found)) => {
                    let good = Good::of(&source, document, &model);
                    ((!found.has_errors()).then_some(good), found)
                }
            },
        };
        let problems = problems(&found, &source, &text);
        Checked {
            text,
            good,
            problems,
        }
    }
}

impl Good {
    /// Returns the values of the document, with those of its parents and components.
    pub(super) fn node(&self) -> &Node {
        self.document.node()
    }

    /// Returns whether pictures show the set to the pixel where no number of steps is given.
    pub(super) fn is_limit(&self) -> bool {
        self.own_steps.is_none() && matches!(self.kind, Kind::Ifs | Kind::Instancing)
    }

    fn of(source: &Arc<Source>, document: Document, model: &Model) -> Self {
        let parameters = &document.metadata().params;
        let heading = model.metadata();
        let described = &heading.description;
        let style = &heading.style;
        let parameters = parameters.iter().zip(&heading.parameters);
        let hex = |colour: Option<crate::style::Colour>| colour.map(|it| format!("{it:#}"));
        let view = model.space_view();
        let are_few = parameters.len() <= TRIED;
        Self {
            source: Arc::clone(source),
            revision: 0,
            kind: model.kind(),
            is_in_space: model.is_in_space(),
            parameters: parameters
                .map(|(written, parameter)| ParameterState {
                    name: parameter.name.clone(),
                    whole: written.whole.as_ref().map(|whole| whole.value.clone()),
                    value: parameter.value,
                    min: parameter.min,
                    max: parameter.max,
                    is_integer: are_few
                        && written.whole.is_none()
                        && is_integer(&document, parameter),
                    about: parameter.about.clone(),
                })
                .collect(),
            about: json!({
                "title": described.title,
                "about": described.about.as_deref().map(str::trim),
                "source": described.source.as_deref().map(str::trim),
                "tags": described.tags,
            }),
            style: json!({
                "stroke": hex(style.stroke),
                "fill": hex(style.fill),
                "background": hex(style.background),
                "stroke-width": match style.width {
                    Width::Pixels(width) => width.to_string(),
                    Width::Relative(width) => format!("{}%", width * 100.0),
                },
                "color-by": style.color_by.name(),
                "palette": style.palette.name(),
                "cap": style.cap.name(),
                "join": style.join.name(),
                "from": view.direction(),
                "light": view.light().from,
                "perspective": view.perspective,
                "shade": view.shade.map(|shade| shade.name()),
                "occlusion": view.occlusion,
                "shadows": view.shadows,
            }),
            own_steps: heading.steps,
            document: Arc::new(document),
        }
    }
}

/// Returns whether a parameter takes whole numbers alone, such as a number of steps or the end of a range: a rule can be
/// resolved with the next number, and cannot halfway to it.
fn is_integer(document: &Document, parameter: &Parameter) -> bool {
    let [min, max] = [
        parameter.min.unwrap_or(f64::MIN),
        parameter.max.unwrap_or(f64::MAX),
    ];
    if [parameter.value, min, max]
        .iter()
        .any(|it| it.fract() != 0.0)
    {
        return false;
    }
    let takes = |by: f64| {
        let mut values = [parameter.value + by, parameter.value - by].into_iter();
        values.any(|value| {
            let setting = Setting::from((parameter.name.as_str(), value));
            (min..=max).contains(&value) && document.resolve(&[setting]).is_ok()
        })
    };
    !takes(0.5) && takes(1.0)
}
