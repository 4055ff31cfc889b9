//! What commands that grow a rule have in common.

use std::path::Path;

use anyhow::anyhow;

use crate::graph::{Graph, TooLarge};
use crate::grow::{Growth, Progress, WalkError};
use crate::render::RenderError;
use crate::wording::{counted, grouped};

use super::rule::Loaded;
use super::{Failure, output, stop};

/// How a rule is grown, and how far at most.
#[derive(clap::Args)]
pub(super) struct GrowthArguments {
    /// What random draws depend on: another seed makes another individual
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// The most elements that are grown
    ///
    /// Where the number is known before, a step that has more is refused before the work starts.
    #[arg(long, value_name = "N", default_value_t = 50_000_000)]
    max_elements: u64,
    /// Says nothing but what is wrong
    #[arg(long, short)]
    pub(super) quiet: bool,
}

impl GrowthArguments {
    /// Refuses a step that has too many elements, as far as that can be told before.
    pub(super) fn check(&self, steps: u32, graph: &Graph, loaded: &Loaded) -> Result<(), Failure> {
        let checked = graph.check_size(steps, self.max_elements);
        checked.map_err(|error| anyhow!(self.too_large(&error, &loaded.name, steps)))?;
        Ok(())
    }

    /// Growth by a number of steps.
    pub(super) fn to<'a>(&self, steps: u32, progress: Option<&'a Progress>) -> Growth<'a> {
        Growth {
            steps,
            seed: self.seed,
            most_elements: self.max_elements,
            cancel: Some(stop::flag()),
            progress,
        }
    }

    fn too_large(&self, error: &TooLarge, name: &str, steps: u32) -> String {
        let limit = grouped(&self.max_elements.into());
        let count = error.elements.as_ref().map_or_else(
            || "more elements than can be counted".into(),
            |elements| counted(elements, "element"),
        );
        let deepest = match error.deepest {
            Some(step) => format!("{step} is the deepest step within --max-elements {limit}"),
            None => format!("no step is within --max-elements {limit}"),
        };
        format!("step {steps} of {name} has {count}; {deepest}")
    }

    /// The options that the draws depend on.
    pub(super) fn options(&self) -> Vec<(&'static str, String)> {
        vec![("seed", self.seed.to_string())]
    }

    /// Why `path` has not been written.
    pub(super) fn explain(&self, error: RenderError, loaded: &Loaded, path: &Path) -> Failure {
        match error {
            RenderError::Io(error) => output::failed(error, path),
            RenderError::Walk(WalkError::Cancelled) => Failure::Interrupted,
            RenderError::Walk(WalkError::NotFinite(error)) => error.diagnostic(&loaded.rule).into(),
            RenderError::Walk(WalkError::TooManyElements { .. }) => {
                let limit = counted(&self.max_elements.into(), "element");
                anyhow!(
                    "{} has more than {limit}; --max-elements allows more",
                    loaded.name
                )
                .into()
            }
            RenderError::Walk(error @ WalkError::TooLong { .. }) => anyhow::Error::new(error)
                .context(format!(
                    "{} takes too long; --max-elements allows more",
                    loaded.name
                ))
                .into(),
            RenderError::NoDetail(_) => anyhow::Error::new(error)
                .context(format!(
                    "{} cannot be grown to a detail, only by a number of --steps",
                    loaded.name
                ))
                .into(),
            other => anyhow::Error::new(other).into(),
        }
    }
}
