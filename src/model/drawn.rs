//! Graphs of models in space as they are drawn.

use std::convert::Infallible;

use crate::geometry::Frame3;
use crate::graph::{Chain, CompileError, Graph, Instance, Object, Replacement};
use crate::grow::{Elements, Growth, WalkError};
use crate::rule::Rule;

use super::Model;

/// Largest number of elements of an approximant that is held in memory.
pub const MAX_HELD: u64 = 1_000_000;

/// Graph of a model in space as it is drawn: with fixed instances, and one object for each surface.
#[derive(Clone, Debug)]
pub struct DrawnInSpace {
    /// Graph to be drawn.
    pub graph: Graph<Frame3>,
    /// Number of steps of the graph to be drawn; `None` for the limit set.
    pub steps: Option<u32>,
}

/// Error: a model in space cannot be compiled or grown.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DrawnError {
    /// It cannot be compiled.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// It cannot be grown.
    #[error(transparent)]
    Walk(#[from] WalkError<Infallible>),
}

impl Model {
    /// Returns the graph of a model in space as it is drawn after a number of steps, or in the limit; `None` for a model
    /// of the plane. A rule whose elements depend on draws or on more than place and age is grown: its approximant is
    /// held in memory, with at most [`MAX_HELD`] elements.
    ///
    /// Objects of a system record the map that is applied last if `records_last`, unless there are too many for it.
    ///
    /// # Errors
    ///
    /// If a generator yields points that are not finite within these steps, or there are too many elements.
    pub fn drawn_in_space(
        &self,
        steps: Option<u32>,
        growth: &Growth<'_>,
        records_last: bool,
    ) -> Option<Result<DrawnInSpace, DrawnError>> {
        let Self::RuleInSpace(rule) = self else {
            let graph = self.compile_in_space(records_last)?;
            return Some(Ok(DrawnInSpace { graph, steps }));
        };
        Some(drawn(rule, steps, growth))
    }
}

fn drawn(
    rule: &std::sync::Arc<Rule<Frame3>>,
    steps: Option<u32>,
    growth: &Growth<'_>,
) -> Result<DrawnInSpace, DrawnError> {
    let graph = Graph::compile(rule, steps.unwrap_or(growth.steps))?;
    let is_fixed = graph.is_plain() && !graph.resets().contains(&true);
    let (graph, steps) = match (is_fixed, steps) {
        (true, Some(_)) => (graph, steps),
        // A graph that is resolved for any number of steps has a limit.
        (true, None) if graph.depth().is_none() => (graph, None),
        _ => (held(&graph, growth)?, Some(0)),
    };
    Ok(DrawnInSpace {
        graph: graph.with_surfaces(rule.base_elements()),
        steps,
    })
}

/// Returns a graph whose initiator consists of the elements of an approximant, none of which is replaced.
fn held(
    graph: &Graph<Frame3>,
    growth: &Growth<'_>,
) -> Result<Graph<Frame3>, WalkError<Infallible>> {
    let growth = Growth {
        max_elements: growth.max_elements.min(MAX_HELD),
        ..*growth
    };
    let mut instances = Vec::new();
    for element in Elements::of(graph, &growth) {
        let (_, element) = element?;
        if graph.objects()[element.object].visible {
            instances.push(Instance::new(element.object, element.frame, 0));
        }
    }
    let objects = graph.objects().iter().map(|object| Object {
        replacement: Replacement::Kept,
        behaviour: 0,
        ..object.clone()
    });
    Ok(Graph {
        origins: graph.origins(),
        tints: graph.tints(),
        middle: graph.middle,
        ..Graph::of(
            objects.collect(),
            graph.base_elements().to_vec(),
            vec![Chain::loose(instances)],
        )
    })
}
