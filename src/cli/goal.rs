//! Goals of growth on the command line: the options that give them, and the words for them.

use super::readable;
use crate::fractal::Goal;
use crate::render::{Detail, Unit};

use super::length::Length;
use super::rule::Loaded;
use super::{Failure, steps};

impl Goal {
    /// Returns the goal for `--steps` and `--detail`.
    pub(super) fn asked(
        steps: Option<u32>,
        detail: Option<f64>,
        loaded: &Loaded,
    ) -> Result<Self, Failure> {
        let goal = Self::choose(&loaded.model, steps, detail, |steps| loaded.graph(steps));
        goal.map_err(|error| loaded.failure(&error))
    }

    /// Returns the goal for `--steps` where a step is drawn whole.
    pub(super) fn whole(steps: Option<u32>, loaded: &Loaded) -> Result<Self, Failure> {
        Ok(Self::Steps(steps::choose(steps, loaded)?, None))
    }

    /// Returns the detail in the units of a picture.
    pub(super) fn detail_in(self, unit: Unit) -> Option<Detail> {
        self.detail().map(|detail| Detail {
            pixels: Length::Pixels(detail.pixels).count(unit),
            ..detail
        })
    }

    /// Returns the options that give the goal, with their values.
    pub(super) fn options(self) -> Vec<(&'static str, String)> {
        let (steps, pixels) = match self {
            Self::Steps(steps, pixels) => (Some(steps), pixels),
            Self::Detail(pixels) => (None, Some(pixels)),
        };
        let steps = steps.map(|steps| ("steps", steps.to_string()));
        let detail = pixels.map(|pixels| ("detail", pixels.to_string()));
        steps.into_iter().chain(detail).collect()
    }

    /// Describes the content of a picture, for its labels.
    pub(super) fn described(self) -> String {
        match self {
            Self::Steps(steps, None) => format!("Step {steps}"),
            Self::Steps(steps, Some(pixels)) => {
                format!("Step {steps}, detail down to {},", counted(pixels))
            }
            Self::Detail(pixels) => format!("Detail down to {}", counted(pixels)),
        }
    }

    /// Describes the approximant that has been grown, for the summary.
    pub(super) fn reached(self, name: &str, steps_taken: u32) -> String {
        match self {
            Self::Steps(steps, None) => format!("step {steps} of {name}"),
            Self::Steps(steps, Some(pixels)) => {
                format!("step {steps} of {name} to a detail of {}", counted(pixels))
            }
            Self::Detail(pixels) => format!(
                "{name} to a detail of {}, {}",
                counted(pixels),
                readable::counted(&u64::from(steps_taken).into(), "step")
            ),
        }
    }
}

/// Formats a number of pixels with its noun.
fn counted(pixels: f64) -> String {
    format!("{pixels} pixel{}", if pixels == 1.0 { "" } else { "s" })
}
