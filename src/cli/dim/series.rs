//! Exact dimensions over the values of a parameter.

use std::fmt::Write as _;
use std::path::Path;

use serde_json::{Value, json};

use crate::figure::dimension;
use crate::measure::exact::{Dimensions, GraphDimensions};
use crate::render::{self, Labels};

use super::super::rule::Member;
use super::super::{Failure, output};
use super::input::exact;

/// Members of a family with their exact results.
pub(super) struct Series {
    name: String,
    title: String,
    parameter: String,
    samples: Vec<(f64, GraphDimensions)>,
}

impl Series {
    pub(super) fn of(family: &[Member]) -> Result<Self, Failure> {
        let (settings, first) = &family[0];
        let [setting] = settings.as_slice() else {
            let message = "dimensions are listed along one parameter, not along several together";
            return Err(Failure::Usage(message.into()));
        };
        let title = first.model.metadata().description.title.clone();
        let samples = family
            .iter()
            .map(|(settings, loaded)| Ok((settings[0].value, exact(loaded)?)));
        Ok(Self {
            name: first.name.clone(),
            title: title.unwrap_or_else(|| first.name.clone()),
            parameter: setting.name.clone(),
            samples: samples.collect::<Result<_, Failure>>()?,
        })
    }

    pub(super) fn json(&self) -> Value {
        let samples = self.samples.iter().map(|(value, known)| {
            let dimensions = known.dimensions.as_ref();
            let hausdorff = dimensions.map(|it| &it.hausdorff);
            json!({
                "value": value,
                "similarity": similarity(known),
                "hausdorff": hausdorff.and_then(|it| it.value),
                "overlap": hausdorff.map(|it| it.overlap.to_string()),
                "notes": known.notes,
            })
        });
        json!({
            "name": self.name,
            "parameter": self.parameter,
            "samples": samples.collect::<Vec<_>>(),
        })
    }

    pub(super) fn described(&self) -> String {
        let parameter = &self.parameter;
        let mut text = format!(
            "{parameter:>14}  {:>14}  {:>14}  overlap\n",
            "similarity", "Hausdorff"
        );
        for (value, known) in &self.samples {
            let hausdorff = known.dimensions.as_ref().map(|it| &it.hausdorff);
            let formatted =
                |value: Option<f64>| value.map_or("-".into(), |value| format!("{value:.12}"));
            // Writing to a string does not fail.
            let _ = writeln!(
                text,
                "{value:>14}  {:>14}  {:>14}  {}",
                formatted(similarity(known)),
                formatted(hausdorff.and_then(|it| it.value)),
                hausdorff.map_or("-".into(), |it| it.overlap.to_string()),
            );
        }
        text
    }

    /// Plots the similarity dimension.
    pub(super) fn draw(&self, path: &Path, format: render::Format) -> Result<(), Failure> {
        let points: Vec<_> = self
            .samples
            .iter()
            .map(|(value, known)| (*value, similarity(known)))
            .collect();
        let options = dimension::DimensionFigureOptions {
            format,
            unit: None,
            labels: Labels {
                title: self.title.clone(),
                description: format!("The similarity dimension over {}.", self.parameter),
                provenance: format!("# kfrac {}\n", env!("CARGO_PKG_VERSION")),
            },
        };
        output::write(path, true, |out, _| {
            let written = dimension::write_series(&self.parameter, &points, &options, out);
            written.map_err(|error| output::explain(error, path))
        })?;
        Ok(())
    }
}

fn similarity(known: &GraphDimensions) -> Option<f64> {
    let similar = |dimensions: &Dimensions| dimensions.similarity.as_ref().map(|it| it.value);
    known.dimensions.as_ref().and_then(similar)
}
