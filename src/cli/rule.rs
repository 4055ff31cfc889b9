//! Rules on the command line, found and resolved.

use std::borrow::Cow;
use std::ffi::OsStr;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use etcetera::BaseStrategy;

use crate::catalogue::Catalogue;
use crate::diagnostic::{Diagnostic, Severity, Source};
use crate::document::{Document, Setting};
use crate::geometry::{DAffine2, Frame3, Homothety};
use crate::graph::{CompileError, Graph};
use crate::grow::Growth;
use crate::ifs::{AffineMap, System};
use crate::lsystem::RewriteError;
use crate::model::{DrawnError, DrawnInSpace, MAX_HELD, Model};
use crate::style::{ColorBy, Named};

use super::exchanged::ExchangedComponents;
use super::family::{self, Assignment};
use super::growth::GrowthArguments;
use super::{Failure, input, number, redrawn, text};

/// Returns the catalogue of the given folders, of `$KFRAC_LIBRARY`, of the data folder of the user and of the
/// embedded library, in this order. Only the given folders must exist.
pub(super) fn catalogue(given: &[PathBuf]) -> Result<Catalogue, Failure> {
    if let Some(missing) = given.iter().find(|folder| !folder.is_dir()) {
        let message = format!("--library: there is no folder '{}'", missing.display());
        return Err(Failure::Usage(message));
    }
    let mut folders = given.to_vec();
    if let Some(path) = std::env::var_os("KFRAC_LIBRARY") {
        folders.extend(std::env::split_paths(&path).filter(|path| path != Path::new("")));
    }
    if let Ok(strategy) = etcetera::choose_base_strategy() {
        folders.push(strategy.data_dir().join("kfrac"));
    }
    Ok(Catalogue::with_folders(folders))
}

/// Rule with the settings of its parameters.
#[derive(clap::Args)]
pub(super) struct RuleArguments {
    /// Rule file, name of a rule in the library, or - for standard input
    #[arg(value_name = "RULE")]
    pub(super) rule: PathBuf,
    /// Sets a parameter of the rule; may be given several times
    ///
    /// The value may be an expression: --set angle=180/7. A complex parameter has a value [RE,IM], which
    /// shells require in quotes. `kfrac info RULE` lists the parameters.
    #[arg(long, value_name = "NAME=VALUE", value_parser = family::assignment)]
    pub(super) set: Vec<Assignment>,
    /// Omits maps of a system, by their numbers from 1: --omit 2,3
    #[arg(long, value_name = "MAPS", value_delimiter = ',', value_parser = number::whole("a map", 1..=u32::MAX))]
    pub(super) omit: Vec<u32>,
    #[command(flatten)]
    pub(super) components: ExchangedComponents,
}

/// Member of a family, with its settings.
pub(super) type Member = (Vec<Setting>, Loaded);

/// Rule that has been read and resolved.
#[derive(Clone)]
pub(super) struct Loaded {
    /// Name in messages.
    pub(super) name: String,
    pub(super) document: Arc<Document>,
    pub(super) model: Model,
    /// Parameters that were set.
    pub(super) settings: Vec<Setting>,
    /// Omitted maps, numbered as on the command line.
    pub(super) omitted: Vec<u32>,
    /// Names and files of further rules of which the model is made.
    pub(super) beside: Vec<(String, Arc<Document>)>,
    /// Options, with their values, by which the model is made of all rules.
    pub(super) made_by: Vec<(&'static str, String)>,
    /// Seed and limit of the number of elements, for graphs that depend on them.
    growth: (u64, Option<u64>),
    /// Limit of the number of elements of graphs that list them, which no option changes.
    most_listed: Option<u64>,
    /// Map from the coordinates of compiled graphs to those of the file; [`Model::place`] if `None`.
    place: Option<Homothety>,
    /// Degrees by which graphs are turned about the origin of the file.
    turn: f64,
    /// Isometries by whose images the turned set is replaced.
    images: Option<Vec<DAffine2>>,
}

impl Loaded {
    /// Returns the paths of the files of which the model is made.
    pub(super) fn paths(&self) -> Vec<PathBuf> {
        let all = { self.beside.iter() }.map(|(_, document)| document);
        let paths = all
            .chain([&self.document])
            .flat_map(|document| document.paths());
        paths.map(Path::to_path_buf).collect()
    }

    /// Sets the seed and the limit of the number of elements.
    pub(super) fn grown(mut self, growth: &GrowthArguments) -> Self {
        self.growth = (growth.seed, growth.given_max_elements());
        self
    }

    /// Sets the seed of random draws.
    pub(super) fn seeded(mut self, seed: u64) -> Self {
        self.growth.0 = seed;
        self
    }

    /// Limits the number of elements of graphs that list them.
    pub(super) fn listing(mut self, max_elements: u64) -> Self {
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
    pub(super) fn within(self, place: Homothety) -> Self {
        Self {
            place: Some(place),
            ..self
        }
    }

    /// Replaces the model by the one that has a limit set, if that is another one.
    pub(super) fn led(mut self, to: impl FnOnce(&Model) -> Cow<'_, Model>) -> Self {
        if let Cow::Owned(model) = to(&self.model) {
            self.model = model;
        }
        self
    }

    /// Sets the degrees by which graphs are turned about the origin of the file.
    pub(super) fn turned(self, turn: Option<f64>) -> Self {
        Self {
            turn: turn.unwrap_or(0.0),
            ..self
        }
    }

    /// Sets isometries, in the coordinates of the file, by whose images the turned set is replaced in graphs.
    pub(super) fn with_images(self, images: Option<Vec<DAffine2>>) -> Self {
        Self { images, ..self }
    }

    /// Returns a graph in the coordinates of this rule as it is grown: turned, and with its images.
    fn placed(&self, graph: Graph) -> Graph {
        let graph = graph.turned(self.turn);
        let Some(images) = &self.images else {
            return graph;
        };
        let place = *graph.place();
        let images: Vec<_> = images.iter().map(|image| place.within(image)).collect();
        graph.with_images(&images)
    }

    /// Returns [`Model::place`]; an error is reported as an error in the file.
    pub(super) fn place(&self) -> Result<Homothety, Failure> {
        let place = self.model.place().map_err(CompileError::from);
        place.map_err(|error| self.model.diagnostic(&error).into())
    }

    /// Returns the graph for a number of steps, near the unit box around the origin: [`Graph::place`] maps
    /// its coordinates to those of the rule.
    pub(super) fn graph(&self, steps: u32) -> Result<Graph, CompileError> {
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
    pub(super) fn compile(&self, steps: u32) -> Result<Graph, Failure> {
        self.compiled(&self.model, steps)
    }

    /// Compiles the graph of [the model that has the limit set](Model::of_limit).
    pub(super) fn compile_limit(&self, steps: u32) -> Result<Graph, CompileError> {
        self.graph_of(&self.model.of_limit(), steps)
    }

    /// Compiles the graph of the model that has the limit set; `None` if it is the model itself.
    pub(super) fn other_limit(&self, steps: u32) -> Result<Option<Graph>, Failure> {
        match self.model.of_limit() {
            Cow::Borrowed(_) => Ok(None),
            Cow::Owned(model) => self.compiled(&model, steps).map(Some),
        }
    }

    fn compiled(&self, model: &Model, steps: u32) -> Result<Graph, Failure> {
        self.graph_of(model, steps)
            .map_err(|error| self.failure(&error))
    }

    /// Returns the graph of the elements of a set in space, resolved for the number of steps that is given or proposed;
    /// `None` for a set of the plane.
    pub(super) fn in_space(&self, steps: Option<u32>) -> Result<Option<Graph<Frame3>>, Failure> {
        let (seed, max_elements) = self.listed();
        let steps = self.model.resolved_steps_in_space(steps);
        let graph = self.model.graph_in_space_for(steps, seed, max_elements);
        graph.transpose().map_err(|error| self.failure(&error))
    }

    /// Returns the graph of a set in space as it is drawn after a number of steps, or in the limit.
    pub(super) fn drawn_in_space(
        &self,
        steps: Option<u32>,
        color_by: ColorBy,
    ) -> Result<DrawnInSpace, Failure> {
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

    /// Returns an error of compiling as a mistake in the file.
    pub(super) fn failure(&self, error: &CompileError) -> Failure {
        let diagnostic = self.model.diagnostic(error);
        match error {
            CompileError::Word(RewriteError::TooLong { .. }) if self.most_listed.is_none() => {
                diagnostic.hint("--max-elements allows more").into()
            }
            _ => diagnostic.into(),
        }
    }

    /// Returns the graph for pictures with a `color_by`, which may need a graph that records more.
    pub(super) fn compile_for(&self, steps: u32, color_by: ColorBy) -> Result<Graph, Failure> {
        if let (Model::Rule(_), ColorBy::FirstMap | ColorBy::LastMap) = (&self.model, color_by) {
            let message = format!(
                "{} is a rule and has no maps that --color-by {} could distinguish",
                self.name,
                color_by.name()
            );
            return Err(anyhow::anyhow!(message).into());
        }
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

/// Reads standard input, up to the limit of a rule file.
fn standard_input() -> Result<Arc<Source>, Failure> {
    let most = u64::try_from(Source::MAX_BYTES).unwrap_or(u64::MAX) + 1;
    let mut bytes = Vec::new();
    std::io::stdin().lock().take(most).read_to_end(&mut bytes)?;
    Ok(Source::read("<stdin>", bytes)?)
}

/// Opens a file that is no rule, or standard input.
pub(super) fn open_as_written(path: &Path) -> Result<Arc<Source>, Failure> {
    input::note(path);
    if path == Path::new("-") {
        return standard_input();
    }
    Ok(crate::catalogue::read_file(path)?)
}

/// Opens the file that `argument` names.
pub(super) fn open(argument: &Path, catalogue: &Catalogue) -> Result<Arc<Source>, Failure> {
    input::note(argument);
    if argument == Path::new("-") {
        return standard_input();
    }
    if let Some(held) = redrawn::source(argument) {
        return Ok(held?);
    }
    Ok(catalogue.rule(argument)?)
}

/// Returns the name of a rule, without folder and extension.
pub(super) fn name_of(argument: &Path) -> &OsStr {
    let is_rule_file = redrawn::format(argument).is_some()
        || argument.extension().is_some_and(|extension| {
            extension == "yaml" || extension == "yml" || extension == "json"
        });
    let name = if is_rule_file {
        argument.file_stem()
    } else {
        argument.file_name()
    };
    name.filter(|name| *name != "-")
        .unwrap_or(OsStr::new("stdin"))
}

impl RuleArguments {
    /// Returns the default output file for the rule, in the current folder.
    pub(super) fn file(&self, suffix: &str, extension: &str) -> PathBuf {
        let mut name = name_of(&self.rule).to_os_string();
        name.push(suffix);
        name.push(".");
        name.push(extension);
        name.into()
    }

    /// Finds, reads and resolves the rule; warnings are printed unless `quiet`.
    pub(super) fn load(&self, catalogue: &Catalogue, quiet: bool) -> Result<Loaded, Failure> {
        let source = self.source(catalogue)?;
        self.load_from(&source, catalogue, quiet)
    }

    /// Returns the text of the rule, with its components exchanged.
    fn source(&self, catalogue: &Catalogue) -> Result<Arc<Source>, Failure> {
        match self.components.exchanged(&self.rule)? {
            Some(source) => {
                input::note(&self.rule);
                Ok(source)
            }
            None => open(&self.rule, catalogue),
        }
    }

    /// Reads and resolves the rule from its text.
    pub(super) fn load_from(
        &self,
        source: &Arc<Source>,
        catalogue: &Catalogue,
        quiet: bool,
    ) -> Result<Loaded, Failure> {
        let settings = self.settings()?;
        let document = input::document(source, catalogue)?;
        self.resolve(document.into(), settings, quiet)
    }

    /// Returns the settings of parameters, each of which has a single value.
    pub(super) fn settings(&self) -> Result<Vec<Setting>, Failure> {
        let settings: Result<Vec<_>, _> = self.set.iter().map(Assignment::settings).collect();
        Ok(settings?.concat())
    }

    /// Returns the members of a family, each with its settings; `samples` is the number of values of a range.
    /// The result is empty if no parameter has several values.
    pub(super) fn load_family(
        &self,
        catalogue: &Catalogue,
        quiet: bool,
        samples: u32,
    ) -> Result<Vec<Member>, Failure> {
        let (fixed, swept) = family::split(&self.set, samples)?;
        if swept.is_empty() {
            return Ok(Vec::new());
        }
        let document = Arc::new(input::document(&self.source(catalogue)?, catalogue)?);
        let members = swept.into_iter().enumerate().map(|(number, own)| {
            let settings = [fixed.as_slice(), &own].concat();
            let document = Arc::clone(&document);
            let mut loaded = self.resolve(document, settings, quiet || number > 0)?;
            loaded.settings.clone_from(&fixed);
            Ok((own, loaded))
        });
        members.collect()
    }

    /// Resolves the rule after it has been read.
    pub(super) fn resolve(
        &self,
        document: Arc<Document>,
        settings: Vec<Setting>,
        quiet: bool,
    ) -> Result<Loaded, Failure> {
        let name = name_of(&self.rule).to_string_lossy().into_owned();
        for setting in &settings {
            check_name(setting, &document, &name)?;
        }
        let (model, warnings) = document.resolve(&settings).map_err(|diagnostics| {
            let mut causes = settings.iter();
            let cause = causes.find_map(|setting| mistake(setting, &settings, &document));
            cause.unwrap_or_else(|| diagnostics.into())
        })?;
        if !quiet && !warnings.is_empty() {
            text::print_diagnostics(&warnings);
        }
        let model = self.without_omitted(model, &name)?;
        Ok(Loaded {
            name,
            document,
            model,
            settings,
            omitted: self.omit.clone(),
            beside: Vec::new(),
            made_by: Vec::new(),
            growth: (0, None),
            most_listed: None,
            place: None,
            turn: 0.0,
            images: None,
        })
    }

    /// Returns the model without the omitted maps.
    fn without_omitted(&self, model: Model, name: &str) -> Result<Model, Failure> {
        if self.omit.is_empty() {
            return Ok(model);
        }
        match &model {
            Model::Ifs(system) => Ok(Model::Ifs(self.omitting(system, name)?.into())),
            Model::IfsInSpace(system) => Ok(Model::IfsInSpace(self.omitting(system, name)?.into())),
            _ => Err(Failure::Usage(format!(
                "--omit leaves maps out, and {name} has none"
            ))),
        }
    }

    /// Returns a system without the omitted maps.
    fn omitting<M: AffineMap>(&self, system: &System<M>, name: &str) -> Result<System<M>, Failure> {
        let usage = |message: String| Failure::Usage(message);
        let count = system.ifs().maps().len();
        let mut maps = Vec::new();
        for &number in &self.omit {
            match usize::try_from(number) {
                Ok(number) if number <= count => maps.push(number - 1),
                _ => {
                    let message = format!("--omit {number}: {name} has {count} maps");
                    return Err(usage(message));
                }
            }
        }
        system.omitting(&maps).map_err(|errors| {
            let messages: Vec<_> = errors.iter().map(ToString::to_string).collect();
            usage(format!(
                "--omit: of the remaining maps, {}",
                messages.join("; ")
            ))
        })
    }
}

/// Checks the name of a setting.
fn check_name(setting: &Setting, document: &Document, rule: &str) -> Result<(), Failure> {
    let params = &document.metadata().params;
    if params.iter().any(|param| param.name.value == setting.name) {
        return Ok(());
    }
    let hint = document.metadata().instead_of(&setting.name);
    let message = format!("{rule} has no parameter '{}' ({hint})", setting.name);
    Err(Failure::Usage(message))
}

/// Returns the mistake that a setting causes: it is one on the command line, not in the file.
fn mistake(setting: &Setting, settings: &[Setting], document: &Document) -> Option<Failure> {
    let others: Vec<_> = settings
        .iter()
        .filter(|other| other.name == setting.name)
        .cloned()
        .collect();
    let diagnostics = document.resolve(&others).err()?;
    // The file is correct with its own values, so that this setting causes the error.
    document.resolve(&[]).ok()?;
    let errors = diagnostics
        .iter()
        .filter(|diagnostic| diagnostic.severity() == Severity::Error);
    let messages: Vec<_> = errors.map(Diagnostic::message).collect();
    Some(Failure::Usage(format!(
        "--set {}={}: {}",
        setting.name,
        setting.value,
        messages.join("; ")
    )))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::name_of;

    #[test]
    fn a_name_has_no_folder_and_no_extension_of_a_rule_file() {
        for (argument, name) in [
            ("koch", "koch"),
            ("rules/koch.yaml", "koch"),
            ("koch.yml", "koch"),
            ("koch.json", "koch"),
            ("my.rule", "my.rule"),
            ("my.rule.yaml", "my.rule"),
            (".yaml", ".yaml"),
            ("-", "stdin"),
        ] {
            assert_eq!(name_of(Path::new(argument)), name);
        }
    }
}
