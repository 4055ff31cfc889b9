//! Numbers of steps on the command line.

use std::cell::RefCell;

use crate::fractal::{Goal, proposed_steps, steps_of_graph};
use crate::geometry::Frame3;
use crate::graph::Graph;
use crate::model::Model;

use super::rule::Loaded;
use super::{Failure, number};

/// Reads a number of steps.
pub(super) fn parse(text: &str) -> Result<u32, String> {
    number::whole("a number of steps", 0..=Goal::MAX_STEPS)(text)
}

/// Largest number of approximants on a sheet by default.
pub(super) const MAX_CELLS: u32 = 12;

/// Several numbers of steps, at least one.
pub(super) type Several = number::Several<u32>;

/// Parses several numbers of steps: `0..6` is 0 to 6, both included, and `0,2,4` is a list.
pub(super) fn parse_several(text: &str) -> Result<Several, String> {
    number::several("a number of steps", 0..=Goal::MAX_STEPS)(text)
}

/// Returns the number of steps that was given, or else the [proposed one](proposed_steps).
pub(super) fn choose(asked: Option<u32>, loaded: &Loaded) -> Result<u32, Failure> {
    Ok(choose_with_graph(asked, loaded)?.0)
}

/// Returns the number of steps as [`choose`] does, with the graph for it if that was compiled for the choice.
pub(super) fn choose_with_graph(
    asked: Option<u32>,
    loaded: &Loaded,
) -> Result<(u32, Option<Graph>), Failure> {
    if let Some(steps) = asked {
        return Ok((steps, None));
    }
    // The graph of a system or a structure is that of all numbers of steps.
    let is_of_all = matches!(loaded.model, Model::Ifs(_) | Model::Instancing(_));
    let compiled = RefCell::new(None);
    let compile = |steps| {
        let graph = loaded.graph(steps)?;
        compiled.replace(is_of_all.then(|| graph.clone()));
        Ok(graph)
    };
    let steps = proposed_steps(&loaded.model, compile).map_err(|error| loaded.failure(&error))?;
    Ok((steps, compiled.into_inner()))
}

/// Returns the number of steps of a set in space that was given, or else the proposed one.
pub(super) fn choose_in_space(asked: Option<u32>, loaded: &Loaded, graph: &Graph<Frame3>) -> u32 {
    asked.unwrap_or_else(|| steps_of_graph(&loaded.model, graph))
}
