//! Descriptions for callers within the program: the forecast goes some steps beyond a limit.

use std::sync::Arc;

use clap::{Args, FromArgMatches};

use crate::catalogue::Catalogue;
use crate::diagnostic::Source;
use crate::geometry::Frame;
use crate::graph::Graph;

use super::super::rule::{Loaded, RuleArguments};
use super::super::{Failure, steps};
use super::{Info, in_plane, info};

/// Number of steps beyond the limit.
const BEYOND: u32 = 3;

/// Largest number of steps of a forecast.
const MOST: u32 = 40;

/// Description of a rule.
pub(crate) struct Described {
    /// Description, as `kfrac info --json` prints it.
    pub(crate) json: serde_json::Value,
    /// Lines on the dimension.
    pub(crate) lines: Vec<String>,
    /// Number of steps that is proposed.
    pub(crate) proposed: u32,
}

/// Describes a rule from its text. The forecast goes beyond the deepest step of at most `most` elements.
///
/// # Errors
///
/// As for the command.
pub(crate) fn hold(
    arguments: &[String],
    source: &Arc<Source>,
    catalogue: &Catalogue,
    most: u64,
) -> Result<Described, Failure> {
    let command = RuleArguments::augment_args(clap::Command::new("info").no_binary_name(true));
    let usage = |error: clap::Error| Failure::usage(&error);
    let matches = command.try_get_matches_from(arguments).map_err(usage)?;
    let rule = RuleArguments::from_arg_matches(&matches).map_err(usage)?;
    let loaded = rule.load_from(source, catalogue, true)?;
    if let Some(graph) = loaded.in_space(None)? {
        let proposed = steps::choose_in_space(None, &loaded, &graph);
        // Elements that depend on draws are counted one by one.
        let last = match graph.draws() {
            true => proposed + BEYOND,
            false => last(&graph, proposed, most),
        };
        let (graph, last) = match loaded.in_space(Some(last)) {
            Ok(Some(further)) => (further, last),
            _ => (graph, proposed),
        };
        let bounds = graph.bounds(last);
        let limit = loaded.other_limit_in_space(&graph)?;
        let graphs = [&graph, limit.as_ref().unwrap_or(&graph)];
        let info = info(&loaded, graphs, last, bounds, |_, _| None);
        return described(&info, proposed);
    }
    let proposed = steps::choose(None, &loaded)?;
    let (graph, last) = graph(&loaded, proposed, most)?;
    let limit = loaded.other_limit(&graph, last)?;
    let info = in_plane(&loaded, &graph, limit.as_ref().unwrap_or(&graph), last);
    described(&info, proposed)
}

/// Returns the graph of the last step of the forecast, and that step.
fn graph(loaded: &Loaded, proposed: u32, most: u64) -> Result<(Graph, u32), Failure> {
    // Each step of such a system has words of its own, which may be long.
    if !loaded.model.as_kind().starts_anew()
        && let Ok(graph) = loaded.compile(proposed.max(MOST))
    {
        let last = last(&graph, proposed, most);
        return Ok((loaded.compile(last)?, last));
    }
    match loaded.compile(proposed + BEYOND) {
        Ok(graph) => Ok((graph, proposed + BEYOND)),
        Err(_) => Ok((loaded.compile(proposed)?, proposed)),
    }
}

/// Returns the last step of a forecast.
fn last<F: Frame>(graph: &Graph<F>, proposed: u32, most: u64) -> u32 {
    let deepest = match graph.check_size(proposed.max(MOST), most) {
        Ok(_) => MOST - BEYOND,
        Err(error) => error.deepest.unwrap_or(0),
    };
    let end = graph.depth().unwrap_or(u32::MAX);
    (deepest + BEYOND).max(proposed).min(end.max(proposed))
}

fn described(info: &Info<'_>, proposed: u32) -> Result<Described, Failure> {
    Ok(Described {
        json: serde_json::to_value(info).map_err(anyhow::Error::new)?,
        lines: info.dimension.lines().into_iter().flatten().collect(),
        proposed,
    })
}
