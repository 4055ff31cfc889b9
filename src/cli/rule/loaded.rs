//! Rules that have been read and resolved, and their graphs.

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::document::{Document, Setting};
use crate::fractal::Copies;
use crate::geometry::{Frame3, Homothety};
use crate::graph::{CompileError, Graph};
use crate::grow::Growth;
use crate::lsystem::RewriteError;
use crate::model::{DrawnError, DrawnInSpace, MAX_HELD, Model};
use crate::style::{ColorBy, Named};

use super::super::Failure;
use super::super::growth::GrowthArguments;

/// Rule that has been read and resolved.
#[derive(Clone)]
pub(in crate::cli) struct Loaded {
    /// Name in messages.
    pub(in crate::cli) name: String,
    pub(in crate::cli) document: Arc<Document>,
    pub(in crate::cli) model: Model,
    /// Parameters that were set.
    pub(in crate::cli) settings: Vec<Setting>,
    /// Omitted maps, numbered as on the command line.
    pub(in crate::cli) omitted: Vec<u32>,
    /// Names and files of further rules of which the model is made.
    pub(in crate::cli) beside: Vec<(String, Arc<Document>)>,
    /// Options, with their values, by which the model is made of all rules.
    pub(in crate::cli) made_by: Vec<(&'static str, String)>,
    /// Seed and limit of the number of elements, for graphs that depend on them.
    growth: (u64, Option<u64>),
    /// Limit of the number of elements of graphs that list them, which no option changes.
    most_listed: Option<u64>,
    /// Map from the coordinates of compiled graphs to those of the file; [`Model::place`] if `None`.
    place: Option<Homothety>,
    /// Degrees by which graphs are turned about the origin of the file.
    turn: f64,
    /// Copies by which the turned set is replaced.
    copies: Option<Copies>,
}

impl Loaded {
    /// Creates a rule that is grown as written.
    pub(super) fn new(
        name: String,
        document: Arc<Document>,
        model: Model,
        settings: Vec<Setting>,
        omitted: Vec<u32>,
    ) -> Self {
        Self {
            name,
            document,
            model,
            settings,
            omitted,
            beside: Vec::new(),
            made_by: Vec::new(),
            growth: (0, None),
            most_listed: None,
            place: None,
            turn: 0.0,
            copies: None,
        }
    }

    /// Returns the paths of the files of which the model is made.
    pub(in crate::cli) fn paths(&self) -> Vec<PathBuf> {
        let all = { self.beside.iter() }.map(|(_, document)| document);
        let paths = all
            .chain([&self.document])
            .flat_map(|document| document.paths());
        paths.map(Path::to_path_buf).collect()
    }

    /// Sets the seed and the limit of the number of elements.
    pub(in crate::cli) fn grown(mut self, growth: &GrowthArguments) -> Self {
        self.growth = (growth.seed.first(), growth.given_max_elements());
        self
    }

    /// Sets the seed of random draws.
    pub(in crate::cli) fn seeded(mut self, seed: u64) -> Self {
        self.growth.0 = seed;
        self
    }

    /// Limits the number of elements of graphs that list them.
    pub(in crate::cli) fn listing(mut self, max_elements: u64) -> Self {
        self.most_listed = Some(max_elements);
        self
    }

    /// Returns the seed of graphs that list elements, and the limit of their number.
    fn listed(&self) -> (u64, u64) {
        let (seed, max_elements) = self.growth;
        let most = self.most_listed.or(max_elements);
        (seed, most.unwrap_or(Model::MAX_LISTED))
    }

    /// Sets the coordinates in which graphs are compiled: `place` maps them to those of the file.
    pub(in crate::cli) fn within(self, place: Homothety) -> Self {
        Self {
            place: Some(place),
            ..self
        }
    }

    /// Replaces the model by the one that has a limit set, if that is another one.
    pub(in crate::cli) fn led(mut self, to: impl FnOnce(&Model) -> Cow<'_, Model>) -> Self {
        if let Cow::Owned(model) = to(&self.model) {
            self.model = model;
        }
        self
    }

    /// Sets the degrees by which graphs are turned about the origin of the file.
    pub(in crate::cli) fn turned(self, turn: Option<f64>) -> Self {
        Self {
            turn: turn.unwrap_or(0.0),
            ..self
        }
    }

    /// Sets the copies by which the turned set is replaced in graphs.
    pub(in crate::cli) fn with_copies(self, copies: Option<Copies>) -> Self {
        Self { copies, ..self }
    }

    /// Returns a graph in the coordinates of this rule as it is grown: turned, and with its images.
    fn placed(&self, graph: Graph) -> Graph {
        let graph = graph.turned(self.turn);
        match &self.copies {
            Some(copies) => copies.of(graph),
            None => graph,
        }
    }

    /// Returns [`Model::place`]; an error is reported as an error in the file.
    pub(in crate::cli) fn place(&self) -> Result<Homothety, Failure> {
        let place = self.model.place().map_err(CompileError::from);
        place.map_err(|error| self.model.diagnostic(&error).into())
    }

    /// Returns the graph for a number of steps, near the unit box around the origin: [`Graph::place`] maps
    /// its coordinates to those of the rule.
    pub(in crate::cli) fn graph(&self, steps: u32) -> Result<Graph, CompileError> {
        self.graph_of(&self.model, steps)
    }

    fn graph_of(&self, model: &Model, steps: u32) -> Result<Graph, CompileError> {
        let graph = self.graph_as_written(model, steps)?;
        Ok(self.placed(graph))
    }

    fn graph_as_written(&self, model: &Model, steps: u32) -> Result<Graph, CompileError> {
        let (seed, max_elements) = self.listed();
        match &self.place {
            Some(place) => model.compile_within(place, steps, seed, max_elements),
            None => model.compile_normalised(steps, seed, max_elements),
        }
    }

    /// Returns the graph like [`Loaded::graph`]; an error is reported as an error in the file.
    pub(in crate::cli) fn compile(&self, steps: u32) -> Result<Graph, Failure> {
        self.compiled(&self.model, steps)
    }

    /// Compiles the graph of [the model that has the limit set](Model::of_limit).
    pub(in crate::cli) fn compile_limit(&self, steps: u32) -> Result<Graph, CompileError> {
        self.graph_of(&self.model.of_limit(), steps)
    }

    /// Compiles the graph of the model that has the limit set; `None` if it is the model itself, whose graph is given.
    pub(in crate::cli) fn other_limit(
        &self,
        graph: &Graph,
        steps: u32,
    ) -> Result<Option<Graph>, Failure> {
        match self.model.of_limit() {
            Cow::Borrowed(_) => Ok(None),
            Cow::Owned(model) => match model.as_kind().no_limit() {
                Some(reason) => Ok(Some(graph.without_limit(reason))),
                None => self.compiled(&model, steps).map(Some),
            },
        }
    }

    fn compiled(&self, model: &Model, steps: u32) -> Result<Graph, Failure> {
        self.graph_of(model, steps)
            .map_err(|error| self.failure(&error))
    }

    /// Returns the graph of the elements of a set in space, resolved for the number of steps that is given or proposed;
    /// `None` for a set of the plane.
    pub(in crate::cli) fn in_space(
        &self,
        steps: Option<u32>,
    ) -> Result<Option<Graph<Frame3>>, Failure> {
        self.in_space_of(&self.model, steps)
    }

    /// Returns the graph of the model in space that has the limit set; `None` if it is the model itself, whose graph is
    /// given.
    pub(in crate::cli) fn other_limit_in_space(
        &self,
        graph: &Graph<Frame3>,
    ) -> Result<Option<Graph<Frame3>>, Failure> {
        match self.model.of_limit() {
            Cow::Borrowed(_) => Ok(None),
            Cow::Owned(model) => match model.as_kind().no_limit() {
                Some(reason) => Ok(Some(graph.without_limit(reason))),
                None => self.in_space_of(&model, None),
            },
        }
    }

    /// Returns the graph that has the limit set of a model in space; `None` for a set of the plane.
    pub(in crate::cli) fn limit_in_space(&self) -> Result<Option<Graph<Frame3>>, Failure> {
        self.in_space_of(&self.model.of_limit(), None)
    }

    fn in_space_of(
        &self,
        model: &Model,
        steps: Option<u32>,
    ) -> Result<Option<Graph<Frame3>>, Failure> {
        let (seed, max_elements) = self.listed();
        let steps = self.model.resolved_steps_in_space(steps);
        let graph = model.graph_in_space_for(steps, seed, max_elements);
        graph.transpose().map_err(|error| self.failure(&error))
    }

    /// Returns the graph of a set in space as it is drawn after a number of steps, or in the limit.
    pub(in crate::cli) fn drawn_in_space(
        &self,
        steps: Option<u32>,
        color_by: ColorBy,
    ) -> Result<DrawnInSpace, Failure> {
        self.check_maps(color_by)?;
        let (seed, max_elements) = self.growth;
        let growth = Growth {
            seed,
            max_elements: max_elements.unwrap_or(Model::MAX_ELEMENTS),
            ..Growth::steps(self.model.resolved_steps_in_space(steps))
        };
        let Some(drawn) = self.model.drawn_in_space(steps, &growth, color_by) else {
            return Err(anyhow::anyhow!("{} lies in the plane", self.name).into());
        };
        drawn.map_err(|error| match error {
            DrawnError::Compile(error) => self.failure(&error),
            error => {
                let message = format!(
                    "step {} of {}: {error}; elements that depend on draws, that are placed as the initiator, or that have \
                     colours by index or fractal are held in memory, and --max-elements allows up to {MAX_HELD}",
                    growth.steps, self.name
                );
                anyhow::anyhow!(message).into()
            }
        })
    }

    /// Refuses colours by maps of a rule, which has none.
    fn check_maps(&self, color_by: ColorBy) -> Result<(), Failure> {
        let is_rule = matches!(self.model, Model::Rule(_) | Model::RuleInSpace(_));
        if is_rule && matches!(color_by, ColorBy::FirstMap | ColorBy::LastMap) {
            let message = format!(
                "{} is a rule and has no maps that --color-by {} could distinguish",
                self.name,
                color_by.name()
            );
            return Err(anyhow::anyhow!(message).into());
        }
        Ok(())
    }

    /// Returns an error of compiling as a mistake in the file.
    pub(in crate::cli) fn failure(&self, error: &CompileError) -> Failure {
        let diagnostic = self.model.diagnostic(error);
        match error {
            CompileError::Word(RewriteError::TooLong { .. } | RewriteError::TooMuchWork { .. })
            | CompileError::LargeGraph {
                word: RewriteError::TooLong { .. } | RewriteError::TooMuchWork { .. },
                ..
            } if self.most_listed.is_none() => diagnostic.hint("--max-elements allows more").into(),
            _ => diagnostic.into(),
        }
    }

    /// Returns the graph for pictures with a `color_by`, which may need a graph that records more.
    pub(in crate::cli) fn compile_for(
        &self,
        steps: u32,
        color_by: ColorBy,
    ) -> Result<Graph, Failure> {
        self.check_maps(color_by)?;
        if color_by == ColorBy::Normal {
            let message = format!(
                "{} lies in the plane, where all normals are equal",
                self.name
            );
            return Err(anyhow::anyhow!(message).into());
        }
        let model = &self.model;
        let graph = model.compile_coloured(color_by, || self.graph_as_written(model, steps));
        let graph = graph.map_err(|error| self.failure(&error))?;
        let placed = graph.map(|graph| self.placed(graph));
        placed.ok_or_else(|| {
            let name = &self.name;
            let message = "too many maps and sets to distinguish the map that is applied last";
            anyhow::anyhow!("{name} has {message}").into()
        })
    }
}
