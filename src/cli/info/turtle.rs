//! Information that only L-systems in space have.

use serde::Serialize;

use crate::geometry::Frame3;
use crate::graph::Graph;
use crate::lsystem::NoGraph;
use crate::model::Model;

/// Way in which the elements of a word are found.
#[derive(Serialize)]
pub(super) struct TurtleInfo {
    /// Whether there is a graph with an object for each module and number of steps.
    compiled: bool,
    /// Reason why the turtle reads the derived word instead.
    walked: Option<String>,
}

impl TurtleInfo {
    /// Collects the information of a model whose graph is known.
    pub(super) fn of(model: &Model, graph: &Graph<Frame3>) -> Option<Self> {
        let Model::LSystemInSpace(system) = model else {
            return None;
        };
        // The graph of a word is the same for any number of steps.
        let compiled = graph.depth().is_some();
        let others = match system.words().is_deterministic() {
            true => NoGraph::Modules,
            false => NoGraph::Draws,
        };
        let why = system.walked().unwrap_or(others);
        Some(Self {
            compiled,
            walked: (!compiled).then(|| why.to_string()),
        })
    }

    /// Describes the way.
    pub(super) fn line(&self) -> String {
        match &self.walked {
            None => "compiled: no word is written down".into(),
            Some(why) => format!("reads the word of the step: {why}"),
        }
    }
}
