//! End of growth: a number of steps, or a size in pixels below which nothing is seen.

use crate::geometry::Frame;
use crate::graph::{CompileError, Graph};
use crate::grow::WalkError;
use crate::model::{DEEPEST, MOST_PROPOSED, Model};
use crate::render::{Detail, NoDetail, RenderError};
use crate::zoom::ZoomError;

/// End of growth.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Goal {
    /// A number of steps. Elements shorter than a length in pixels, where there is one, are not replaced.
    Steps(u32, Option<f64>),
    /// The number of steps after which all elements are shorter than a length in pixels.
    Detail(f64),
}

impl Goal {
    /// Largest number of steps.
    pub const MAX_STEPS: u32 = 1_000_000;

    /// Number of steps that a search for a detail starts with.
    const FIRST_STEPS: u32 = 64;

    /// Returns the goal of a model for given steps and detail, each of which may be left open.
    ///
    /// A detail alone decides the number of steps, unless every step has an initiator of its own
    /// ([`Graph::is_time_indexed`]). Without either, systems and endless structures that contract, and propose no number
    /// of steps, grow to one pixel, and others by [`proposed_steps`]. `compile` returns the
    /// model's graph for a number of steps.
    ///
    /// # Errors
    ///
    /// As for `compile`.
    pub fn choose(
        model: &Model,
        steps: Option<u32>,
        detail: Option<f64>,
        compile: impl Fn(u32) -> Result<Graph, CompileError>,
    ) -> Result<Self, CompileError> {
        Ok(match (steps, detail) {
            (None, Some(pixels)) if !model.as_kind().starts_anew() => Self::Detail(pixels),
            (None, None) if needs_detail(model, &compile) => Self::Detail(1.0),
            (Some(steps), pixels) => Self::Steps(steps, pixels),
            (None, pixels) => Self::Steps(proposed_steps(model, compile)?, pixels),
        })
    }

    /// Returns the goal for a window of arbitrary size, which is grown to a detail always: one pixel where
    /// none is given.
    #[must_use]
    pub fn zoomed(steps: Option<u32>, detail: Option<f64>) -> Self {
        let pixels = detail.unwrap_or(1.0);
        match steps {
            Some(steps) => Self::Steps(steps, Some(pixels)),
            None => Self::Detail(pixels),
        }
    }

    /// Returns the number of steps, or the one that the search for a detail starts with.
    #[must_use]
    pub fn steps(self) -> u32 {
        match self {
            Self::Steps(steps, _) => steps,
            Self::Detail(_) => Self::FIRST_STEPS,
        }
    }

    /// Returns the detail of a picture, in pixels.
    #[must_use]
    pub fn detail(self) -> Option<Detail> {
        let detail = |pixels, decides_steps| Detail {
            pixels,
            decides_steps,
        };
        match self {
            Self::Steps(_, pixels) => pixels.map(|pixels| detail(pixels, false)),
            Self::Detail(pixels) => Some(detail(pixels, true)),
        }
    }

    /// Draws a picture with as many steps as the goal takes.
    ///
    /// `graph` is compiled for [`steps`](Self::steps) steps. Where `draw` reports that a detail needs more
    /// steps, the number is doubled, up to [`MAX_STEPS`](Self::MAX_STEPS), and the graph is compiled again.
    ///
    /// # Errors
    ///
    /// As for `compile` and `draw`.
    pub fn reach<T>(
        self,
        mut graph: Graph,
        compile: impl Fn(u32) -> Result<Graph, CompileError>,
        mut draw: impl FnMut(&Graph, u32) -> Result<T, RenderError>,
    ) -> Result<T, RenderError> {
        let mut steps = match self {
            Self::Detail(_) if graph.depth().is_none() && graph.is_plain() => Self::MAX_STEPS,
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
            let more = (2 * steps).min(Self::MAX_STEPS);
            graph =
                compile(more).map_err(|error| RenderError::Walk(WalkError::NotFinite(error)))?;
            // A graph that is too large to resolve cannot be cut.
            if more == steps || graph.counts_index() {
                return drawn;
            }
            steps = more;
        }
    }
}

/// Returns the number of steps that a model is grown by unless another is given.
///
/// That is the number which its file proposes, or else the deepest step, up to 12, of at most 20,000 elements; 6
/// where that number is unknown. A structure that ends after fewer elements is grown to its end.
///
/// # Errors
///
/// As for `compile`, which returns the model's graph for a number of steps.
pub fn proposed_steps(
    model: &Model,
    compile: impl Fn(u32) -> Result<Graph, CompileError>,
) -> Result<u32, CompileError> {
    if let Some(steps) = model.metadata().steps {
        return Ok(steps);
    }
    if let Some(deepest) = model.as_kind().deepest(DEEPEST, MOST_PROPOSED) {
        return Ok(deepest);
    }
    Ok(steps_of_graph(model, &compile(DEEPEST)?))
}

/// Returns the number of steps that [`proposed_steps`] proposes for a model whose graph is known.
pub(crate) fn steps_of_graph<F: Frame>(model: &Model, graph: &Graph<F>) -> u32 {
    if let Some(steps) = model.metadata().steps {
        return steps;
    }
    if let Model::LSystemInSpace(_) = model {
        return model.resolved_steps_in_space(None);
    }
    if !graph.has_forecast() {
        return DEEPEST / 2;
    }
    if let Some(depth) = model.as_kind().ends()
        && depth <= Goal::MAX_STEPS
        && graph.deepest_step(depth, MOST_PROPOSED) == depth
    {
        return depth;
    }
    graph.deepest_step(DEEPEST, MOST_PROPOSED)
}

/// Returns whether a model is drawn to a pixel where neither steps nor a detail are given: a system, or a
/// structure without end, that contracts and proposes no number of steps.
fn needs_detail(model: &Model, compile: impl Fn(u32) -> Result<Graph, CompileError>) -> bool {
    let has_limit = || compile(0).is_ok_and(|graph| graph.limit_bounds().is_some());
    model.metadata().steps.is_none() && model.as_kind().is_drawn_to_limit(&has_limit)
}
