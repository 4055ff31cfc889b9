//! What commands that grow a rule have in common.

use std::path::Path;

use anyhow::anyhow;

use crate::graph::{Graph, TooLarge};
use crate::grow::{Growth, WalkError};
use crate::render::RenderError;
use crate::wording::{counted, grouped};

use super::rule::Loaded;
use super::{Failure, stop};

/// How a rule is grown, and how far at most.
#[derive(clap::Args)]
pub(super) struct GrowthArguments {
    /// What random draws depend on
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// Refuses to grow more elements than this
    #[arg(long, value_name = "N", default_value_t = 50_000_000)]
    max_elements: u64,
    /// Says nothing but what is wrong
    #[arg(long, short)]
    pub(super) quiet: bool,
}

impl GrowthArguments {
    /// Grows to a number of steps, if that is within the limit as far as can be told before.
    pub(super) fn steps(
        &self,
        steps: u32,
        graph: &Graph,
        loaded: &Loaded,
    ) -> Result<Growth<'static>, Failure> {
        graph
            .check_size(steps, self.max_elements)
            .map_err(|error| anyhow!(self.too_large(&error, &loaded.name, steps)))?;
        Ok(Growth {
            steps,
            seed: self.seed,
            most_elements: self.max_elements,
            cancel: Some(stop::flag()),
        })
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
            RenderError::Io(error) => anyhow::Error::new(error)
                .context(match path == Path::new("-") {
                    true => "standard output cannot be written".into(),
                    false => format!("'{}' cannot be written", path.display()),
                })
                .into(),
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
            other => anyhow::Error::new(other).into(),
        }
    }
}
