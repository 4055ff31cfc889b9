//! Validated models of the four kinds of linear fractals, and their compilation to graphs.

mod drawn;
mod ifs;
mod instancing;
mod lsystem;
mod place;
mod rule;
mod steps;

pub use crate::graph::OutOfRange;
pub use crate::kind::Kind;
pub use drawn::{DrawnError, DrawnInSpace, MAX_HELD, for_pixels};

use std::borrow::Cow;
use std::sync::Arc;

use crate::diagnostic::Diagnostic;
use crate::extent::NoLimit;
use crate::geometry::{DAffine3, Frame3, Homothety};
use crate::graph::{CompileError, Graph};
use crate::ifs::System;
use crate::instancing::Instancing;
use crate::lsystem::{LSystem, LSystemInSpace};
use crate::metadata::Metadata;
use crate::rule::Rule;
use crate::style::{Shade, SpaceView};
use crate::symmetry::Symmetry;
use crate::tween::Growing;
use place::Extent;

/// Declares the models of the kinds.
macro_rules! models {
    ($($(#[$doc:meta])* $name:ident: $kind:ident($model:ty);)*) => {
        /// Validated model: immutable, without unparsed text.
        #[derive(Clone, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum Model { $($(#[$doc])* $name(Arc<$model>),)* }

        impl Model {
            /// Returns the kind of the model.
            #[must_use]
            pub fn kind(&self) -> Kind {
                match self { $(Self::$name(_) => Kind::$kind,)* }
            }

            /// Returns the model behind its kind.
            pub(crate) fn as_kind(&self) -> &dyn OfKind {
                match self { $(Self::$name(model) => model,)* }
            }
        }

        $(impl From<$model> for Model {
            fn from(model: $model) -> Self {
                Self::$name(model.into())
            }
        }

        impl TryFrom<Model> for $model {
            type Error = Model;

            /// Returns a model of another kind as it is.
            fn try_from(model: Model) -> Result<Self, Model> {
                match model {
                    Model::$name(model) => Ok(Arc::unwrap_or_clone(model)),
                    model => Err(model),
                }
            }
        })*
    };
}

models! {
    /// Production rule.
    Rule: Rule(Rule);
    /// Production rule in space.
    RuleInSpace: Rule(Rule<Frame3>);
    /// Iterated function system.
    Ifs: Ifs(System);
    /// Iterated function system in space.
    IfsInSpace: Ifs(System<DAffine3>);
    /// Structure of objects that instance each other.
    Instancing: Instancing(Instancing);
    /// Structure of objects in space.
    InstancingInSpace: Instancing(Instancing<DAffine3>);
    /// L-system.
    LSystem: LSystem(LSystem);
    /// L-system in space.
    LSystemInSpace: LSystem(LSystemInSpace);
}

/// Graph of a model in space.
type CompiledInSpace = Result<Graph<Frame3>, CompileError>;

/// Largest number of steps that is proposed, unless a file does.
pub(crate) const DEEPEST: u32 = 12;

/// Largest number of elements of a step that is proposed.
pub(crate) const MOST_PROPOSED: u64 = 20_000;

/// Limit of the elements of a word in which mistakes are looked for.
const MOST_CHECKED: u64 = 20_000;

/// Properties of a model that depend on its kind. Each kind implements them in a file of this module.
pub(crate) trait OfKind {
    /// Returns the metadata of the file.
    fn metadata(&self) -> &Metadata;

    /// Returns why a model is not compiled for a number of steps, as far as that is predicted without any work.
    fn too_deep(&self, _steps: u32, _max_elements: u64) -> Option<CompileError> {
        None
    }

    /// Returns the number of steps, at most `steps`, for which a model is compiled soon.
    fn soon_compiled(&self, steps: u32) -> u32 {
        steps
    }

    /// Compiles a model of the plane as [`Model::compile_for`] does.
    fn compile(&self, _steps: u32, _seed: u64, _max_elements: u64) -> Result<Graph, CompileError> {
        Err(CompileError::InSpace)
    }

    /// Compiles a model in space to a graph that is resolved for at least `steps` steps; `None` for a model of the
    /// plane. Objects of a system record the map that is applied last if `records_last`, unless there are too many for
    /// it.
    fn compile_in_space(&self, _steps: u32, _records_last: bool) -> Option<CompiledInSpace> {
        None
    }

    /// Converts an error of compiling or of a walk to a diagnostic of the model's file.
    fn diagnostic(&self, error: &CompileError) -> Diagnostic {
        Diagnostic::error(error.to_string())
    }

    /// Returns an estimate of position and size; `None` for a model that need not be normalised.
    fn extent(&self) -> Option<Extent> {
        None
    }

    /// Returns the model in the coordinates that a homothety maps to its own; `None` without
    /// [maps of the plane](Self::has_plane_maps), or if a shape has no extent in these coordinates.
    fn within(&self, _place: &Homothety) -> Option<Model> {
        None
    }

    /// Returns whether the maps of the model are maps of the whole plane. Models without them are moved by their
    /// initiators.
    fn has_plane_maps(&self) -> bool {
        false
    }

    /// Returns a graph in units in which the approximant of `steps` steps is within the range of doubles, or `None` if
    /// it is beyond that range.
    fn normalised(&self, graph: Graph, _steps: u32) -> Option<Graph> {
        Some(graph)
    }

    /// Returns the model whose graph has the limit set, if it is another one: see [`Model::of_limit`].
    fn of_limit(&self) -> Option<Model> {
        None
    }

    /// Returns why a model that [stands for a limit set](Self::of_limit) has none; `None` if it has one, and for any other
    /// model.
    fn no_limit(&self) -> Option<NoLimit> {
        None
    }

    /// Returns whether every step has an initiator of its own: a detail cannot decide the number of steps then.
    fn starts_anew(&self) -> bool {
        false
    }

    /// Returns the deepest step, up to a number of steps and of elements, of a model that is compiled for one step
    /// only.
    fn deepest(&self, _most_steps: u32, _most_elements: u64) -> Option<u32> {
        None
    }

    /// Returns the number of steps after which nothing is replaced, if the model states it.
    fn ends(&self) -> Option<u32> {
        None
    }

    /// Returns whether the model has a limit set that it is drawn to where nothing else is asked for. `has_limit`
    /// returns whether the graph has a limit set with a bounding box.
    fn is_drawn_to_limit(&self, _has_limit: &dyn Fn() -> bool) -> bool {
        false
    }
}

impl Model {
    /// Returns the metadata of the file.
    #[must_use]
    pub fn metadata(&self) -> &Metadata {
        self.as_kind().metadata()
    }

    /// Returns how a set in space is seen: as its file gives it. Where that does not name a shading, kinds that
    /// have surfaces, other than systems, have depth cues and light on them.
    #[must_use]
    pub fn space_view(&self) -> SpaceView {
        let own = self.metadata().space.clone();
        let shade = match self.kind() {
            Kind::Ifs => own.shade,
            _ => own.shade.or(Some(Shade::Both)),
        };
        SpaceView { shade, ..own }
    }

    /// Returns the production rule, or `None` for a model of another kind.
    #[must_use]
    pub fn rule(&self) -> Option<&Arc<Rule>> {
        match self {
            Self::Rule(rule) => Some(rule),
            _ => None,
        }
    }

    /// Converts the model to its production rule, or `None` for a model of another kind.
    #[must_use]
    pub fn into_rule(self) -> Option<Arc<Rule>> {
        match self {
            Self::Rule(rule) => Some(rule),
            _ => None,
        }
    }

    /// Returns the model whose step `steps` is drawn while it grows out of the step before: at a `share` of 0 it is about
    /// that step, at 1 the step itself.
    ///
    /// Elements of rules, and those of systems whose maps are chained, rise from the element that they replace: a point (x,
    /// y) begins at (x, 0) with x between 0 and 1, and moves in a straight line. Filled shapes and solids of rules begin as
    /// the element that they replace, and surfaces that tile it begin in its plane; where it is kept, and where they are
    /// seeds, they grow out of a point. Images of other systems, and of objects with an initial set, begin as what they
    /// replace and turn about the fixed points of their maps. Shapes of structures grow out of their origins. Lines of
    /// L-systems rise from the way of the turtle along the module that is replaced.
    ///
    /// The limit set, and points of random iteration, are those of the model.
    #[must_use]
    pub fn between(&self, steps: u32, share: f64) -> Self {
        let share = share.clamp(0.0, 1.0);
        let growing = Some(Growing { steps, share });
        let mut model = self.clone();
        match &mut model {
            Self::Rule(rule) => Arc::make_mut(rule).growing = growing,
            Self::RuleInSpace(rule) => Arc::make_mut(rule).growing = growing,
            Self::Ifs(system) => Arc::make_mut(system).growing = growing,
            Self::IfsInSpace(system) => Arc::make_mut(system).growing = growing,
            Self::Instancing(structure) => Arc::make_mut(structure).growing = growing,
            Self::InstancingInSpace(structure) => Arc::make_mut(structure).growing = growing,
            Self::LSystem(system) => Arc::make_mut(system).growing = growing,
            Self::LSystemInSpace(system) => Arc::make_mut(system).words.growing = growing,
        }
        model
    }

    /// Compiles the model to a graph that is resolved for at least `steps` steps, with the seed 0 and the
    /// limit [`MAX_LISTED`](Self::MAX_LISTED) where these matter.
    ///
    /// # Errors
    ///
    /// As for [`Model::compile_for`].
    pub fn compile(&self, steps: u32) -> Result<Graph, CompileError> {
        self.compile_for(steps, 0, Self::MAX_LISTED)
    }

    /// Default limit of the number of elements that are drawn.
    pub const MAX_ELEMENTS: u64 = 50_000_000;

    /// Default limit of the number of elements of a graph that lists them: of an L-system that is not compiled. They
    /// take about 80 bytes each.
    pub const MAX_LISTED: u64 = 20_000_000;

    /// Compiles the model to a graph that is resolved for at least `steps` steps. For an L-system that is
    /// not compiled, its word is derived for exactly `steps` steps, with the draws of `seed`, if it draws
    /// at most `max_elements` elements.
    ///
    /// # Errors
    ///
    /// As for [`Graph::compile`] and [`Graph::of_lsystem`], and if the initiator and its images under a symmetry have more
    /// than `max_elements` elements.
    pub fn compile_for(
        &self,
        steps: u32,
        seed: u64,
        max_elements: u64,
    ) -> Result<Graph, CompileError> {
        let graph = self.compile_listed(steps, seed, max_elements)?;
        self.with_images(graph, max_elements)
    }

    /// Compiles the model as [`compile_for`](Self::compile_for) does, without the images under its symmetry.
    pub(crate) fn compile_listed(
        &self,
        steps: u32,
        seed: u64,
        max_elements: u64,
    ) -> Result<Graph, CompileError> {
        self.as_kind().compile(steps, seed, max_elements)
    }

    /// Joins a graph of the model with its images under the model's [symmetry](Symmetry), if it has one.
    fn with_images(&self, graph: Graph, max_elements: u64) -> Result<Graph, CompileError> {
        let group = self.check_images(&graph, max_elements)?;
        Ok(match group {
            Some(group) => graph.with_images(&group.isometries()),
            None => graph,
        })
    }

    /// Returns the model's symmetry, if it has one.
    ///
    /// # Errors
    ///
    /// If the images of the graph under it have more than `max_elements` elements.
    fn check_images(
        &self,
        graph: &Graph,
        max_elements: u64,
    ) -> Result<Option<&Symmetry>, CompileError> {
        let Some(group) = &self.metadata().symmetry else {
            return Ok(None);
        };
        let most = max_elements.clamp(1, Self::MAX_LISTED);
        if !graph.has_room_for_images(group.order().into(), most) {
            let group = group.to_string();
            return Err(CompileError::TooManyImages { group, most });
        }
        Ok(Some(group))
    }

    /// Returns the model whose graph has the limit set: the model itself, except for an L-system that does not
    /// rewrite edges. For the latter it returns the system [without widths and
    /// colours](LSystem::without_appearance), and if that does not rewrite edges either, a system whose graph is that of
    /// the limit set of its words: it has no approximants other than those of that graph.
    #[must_use]
    pub fn of_limit(&self) -> Cow<'_, Self> {
        match self.as_kind().of_limit() {
            Some(model) => Cow::Owned(model),
            None => Cow::Borrowed(self),
        }
    }

    /// Returns the model that is grown to a detail if no number of steps is given: the model itself or, for an L-system
    /// whose steps all start anew, that of [its limit set](Self::of_limit), if there is one and its lines have no widths
    /// and colours of their own.
    #[must_use]
    pub fn of_detail(&self) -> Cow<'_, Self> {
        match self {
            Self::LSystem(system)
                if self.as_kind().starts_anew() && system.without_appearance() == **system =>
            {
                self.of_zoom()
            }
            Self::LSystemInSpace(system)
                if system.tube().is_none()
                    && system.words().without_appearance() == *system.words() =>
            {
                self.of_zoom()
            }
            _ => Cow::Borrowed(self),
        }
    }

    /// Returns the model of which parts of any size are grown: the model itself or, for an L-system whose steps all start
    /// anew, that of [its limit set](Self::of_limit), if there is one.
    #[must_use]
    pub fn of_zoom(&self) -> Cow<'_, Self> {
        if !self.as_kind().starts_anew() {
            return Cow::Borrowed(self);
        }
        match self.of_limit() {
            Cow::Owned(limit) if !limit.as_kind().starts_anew() => Cow::Owned(limit),
            _ => Cow::Borrowed(self),
        }
    }

    /// Returns the production rule in space, or `None` for another model.
    #[must_use]
    pub fn rule_in_space(&self) -> Option<&Arc<Rule<Frame3>>> {
        match self {
            Self::RuleInSpace(rule) => Some(rule),
            _ => None,
        }
    }

    /// Returns whether the model lies in space; [`graph_in_space`](Self::graph_in_space) compiles it then.
    #[must_use]
    pub fn is_in_space(&self) -> bool {
        matches!(
            self,
            Self::RuleInSpace(_)
                | Self::IfsInSpace(_)
                | Self::InstancingInSpace(_)
                | Self::LSystemInSpace(_)
        )
    }

    /// Compiles a model in space as [`graph_in_space_for`](Self::graph_in_space_for) does, with the seed 0 and the limit
    /// [`MAX_LISTED`](Self::MAX_LISTED) where these matter.
    ///
    /// # Errors
    ///
    /// As for [`graph_in_space_for`](Self::graph_in_space_for).
    pub fn graph_in_space(&self, steps: u32) -> Option<Result<Graph<Frame3>, CompileError>> {
        self.graph_in_space_for(steps, 0, Self::MAX_LISTED)
    }

    /// Compiles a model in space to the graph of its elements, which is resolved for at least `steps` steps; `None` for
    /// a model of the plane. The word of an L-system that is not compiled is derived for exactly `steps` steps, with the
    /// draws of `seed`, if it draws at most `max_elements` elements.
    ///
    /// # Errors
    ///
    /// If a generator yields points that are not finite within these steps, or a word cannot be derived.
    pub fn graph_in_space_for(
        &self,
        steps: u32,
        seed: u64,
        max_elements: u64,
    ) -> Option<Result<Graph<Frame3>, CompileError>> {
        match self {
            Self::LSystemInSpace(system) => {
                let graph = Graph::of_lsystem_in_space(system, steps, seed, max_elements);
                Some(graph)
            }
            _ => self.as_kind().compile_in_space(steps, false),
        }
    }

    /// Compiles a system or a structure in space to its graph; `None` for other models. Objects of a system record the map
    /// that is applied last if `records_last`, unless there are too many for it.
    #[must_use]
    pub fn compile_in_space(&self, records_last: bool) -> Option<Graph<Frame3>> {
        match self.kind() {
            // The graph of a rule, and of an L-system, depends on the number of steps.
            Kind::Rule | Kind::LSystem => None,
            _ => self.as_kind().compile_in_space(0, records_last)?.ok(),
        }
    }

    /// Returns why the model is not compiled for a number of steps, as far as that is predicted without any work. Words have at
    /// most `max_elements` modules.
    #[must_use]
    pub fn too_deep(&self, steps: u32, max_elements: u64) -> Option<CompileError> {
        self.as_kind().too_deep(steps, max_elements)
    }

    /// Returns the number of generators that are looked at to replace an element, as [`Graph::choices`] does.
    pub(crate) fn choices(&self) -> u64 {
        let choices = match self {
            Self::Rule(rule) => rule.selection().choices(),
            Self::RuleInSpace(rule) => rule.selection().choices(),
            _ => 1,
        };
        choices as u64
    }

    /// Returns a mistake that shows only where elements are replaced, by compiling the model for a few steps.
    pub(crate) fn mistake(&self) -> Option<Diagnostic> {
        let steps = self.metadata().steps.unwrap_or(1).min(16);
        let steps = self.as_kind().soon_compiled(steps);
        // Images under a symmetry have no mistakes of their own, but there may be too many of them.
        let compile = |steps| match self.graph_in_space_for(steps, 0, MOST_CHECKED) {
            Some(graph) => graph.map(drop),
            None => {
                let graph = self.compile_listed(steps, 0, MOST_CHECKED)?;
                self.check_images(&graph, Self::MAX_LISTED).map(drop)
            }
        };
        let compiled = compile(steps).or_else(|error| error.deepest().map_or(Err(error), compile));
        compiled.err().map(|error| self.diagnostic(&error))
    }

    /// Converts an error of [`Model::compile`] or of a walk to a diagnostic of the model's file.
    #[must_use]
    pub fn diagnostic(&self, error: &CompileError) -> Diagnostic {
        self.as_kind().diagnostic(error)
    }
}
