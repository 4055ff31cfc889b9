//! Limits of steps of fractals in space.

use anyhow::anyhow;

use crate::geometry::Frame3;
use crate::graph::Graph;

use super::Failure;
use super::readable::{counted, grouped};
use super::rule::Loaded;

/// Returns an error if a step has too many elements.
pub(super) fn check(
    loaded: &Loaded,
    graph: &Graph<Frame3>,
    steps: u32,
    most: u64,
) -> Result<(), Failure> {
    let Err(error) = graph.check_size(steps, most) else {
        return Ok(());
    };
    let count = error.elements.as_ref().map_or_else(
        || "more elements than can be counted".into(),
        |elements| counted(elements, "element"),
    );
    let limit = grouped(&most.into());
    let deepest = match error.deepest {
        Some(step) => format!("{step} is the deepest step within --max-elements {limit}"),
        None => format!("no step is within --max-elements {limit}"),
    };
    Err(anyhow!("step {steps} of {} has {count}; {deepest}", loaded.name).into())
}
