//! Where growth ends: after a number of steps, or where nothing more can be seen.

use crate::graph::Graph;
use crate::grow::WalkError;
use crate::ifs::Verdict;
use crate::model::Model;
use crate::render::{Detail, NoDetail, RenderError, Unit};
use crate::wording;
use crate::zoom::ZoomError;

use super::length::Length;
use super::rule::Loaded;
use super::{Failure, steps};

/// Where growth ends.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Goal {
    /// After a number of steps, or sooner, where elements are smaller than so many pixels.
    Steps(u32, Option<f64>),
    /// Where all elements are smaller than so many pixels.
    Detail(f64),
}

impl Goal {
    /// What was asked for.
    pub(super) fn choose(
        steps: Option<u32>,
        detail: Option<f64>,
        loaded: &Loaded,
    ) -> Result<Self, Failure> {
        Ok(match (steps, detail) {
            (None, Some(pixels)) if !starts_anew(loaded) => Self::Detail(pixels),
            (None, None) if goes_on_to_a_detail(loaded) => Self::Detail(1.0),
            (asked, pixels) => Self::Steps(steps::choose(asked, loaded)?, pixels),
        })
    }

    /// What was asked for where all of a step is drawn.
    pub(super) fn whole(steps: Option<u32>, loaded: &Loaded) -> Result<Self, Failure> {
        Ok(Self::Steps(steps::choose(steps, loaded)?, None))
    }

    /// What was asked for where a part is drawn that may be as small as one likes: everything that
    /// can be seen.
    pub(super) fn zoomed(steps: Option<u32>, detail: Option<f64>) -> Self {
        let pixels = detail.unwrap_or(1.0);
        match steps {
            Some(steps) => Self::Steps(steps, Some(pixels)),
            None => Self::Detail(pixels),
        }
    }

    /// The number of steps, or one to begin with.
    pub(super) fn steps(self) -> u32 {
        match self {
            Self::Steps(steps, _) => steps,
            Self::Detail(_) => 64,
        }
    }

    /// Draws a picture of so many steps or, where a detail decides it, of at most more and more:
    /// the graph is compiled for as many, if it is not the same for any number.
    pub(super) fn come_to<T>(
        self,
        loaded: &Loaded,
        mut graph: Graph,
        mut draw: impl FnMut(&Graph, u32) -> Result<T, RenderError>,
    ) -> Result<T, RenderError> {
        let mut steps = match self {
            Self::Detail(_) if graph.depth().is_none() && graph.is_plain() => steps::MOST_STEPS,
            _ => self.steps(),
        };
        loop {
            let drawn = draw(&graph, steps);
            let is_too_few = matches!(
                drawn,
                Err(RenderError::NoDetail(NoDetail::TooFewSteps { .. })
                    | RenderError::Zoom(ZoomError::TooShallow { .. }))
            );
            if !is_too_few {
                return drawn;
            }
            let more = (2 * steps).min(steps::MOST_STEPS);
            graph = loaded
                .graph(more)
                .map_err(|error| RenderError::Walk(WalkError::NotFinite(error)))?;
            // A graph that is too large to resolve cannot be cut.
            if more == steps || graph.counts_index() {
                return drawn;
            }
            steps = more;
        }
    }

    /// Down to what size elements are replaced, in the units of a picture.
    pub(super) fn detail(self, unit: Unit) -> Option<Detail> {
        let count = |pixels| Length::Pixels(pixels).count(unit);
        match self {
            Self::Steps(_, pixels) => pixels.map(|pixels| Detail {
                pixels: count(pixels),
                decides_steps: false,
            }),
            Self::Detail(pixels) => Some(Detail {
                pixels: count(pixels),
                decides_steps: true,
            }),
        }
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
                wording::counted(&u64::from(steps_taken).into(), "step")
            ),
        }
    }
}

/// Whether nobody says how far, and a system, or a structure that has no end, is drawn as far as it
/// can be seen.
fn goes_on_to_a_detail(loaded: &Loaded) -> bool {
    match &loaded.model {
        Model::Ifs(system) => {
            system.heading().steps.is_none() && system.contraction().verdict == Verdict::Contracts
        }
        Model::Instancing(structure) => {
            structure.heading().steps.is_none()
                && structure.depth().is_none()
                && (loaded.graph(0)).is_ok_and(|graph| graph.limit_bounds().is_some())
        }
        Model::Rule(_) | Model::LSystem(_) => false,
    }
}

/// Whether every step is grown out of an initiator of its own, so that a detail cannot tell how many there
/// are.
fn starts_anew(loaded: &Loaded) -> bool {
    matches!(&loaded.model, Model::LSystem(system) if !Graph::rewrites_edges(system))
}

/// A number of pixels as words have it.
fn counted(pixels: f64) -> String {
    format!("{pixels} pixel{}", if pixels == 1.0 { "" } else { "s" })
}
