//! Rules on the command line, found and resolved.

mod loaded;

use std::ffi::OsStr;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use etcetera::BaseStrategy;

use crate::catalogue::Catalogue;
use crate::diagnostic::{Diagnostic, Severity, Source};
use crate::document::{Document, Setting};
use crate::ifs::{AffineMap, System};
use crate::model::Model;

use super::exchanged::ExchangedComponents;
use super::family::{self, Assignment, Family};
use super::{Failure, input, number, redrawn, text};

pub(super) use loaded::Loaded;

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
#[derive(clap::Args, Clone)]
pub(super) struct RuleArguments {
    /// Rule file, name of a rule in the library, or - for standard input
    #[arg(value_name = "RULE")]
    pub(super) rule: PathBuf,
    /// Sets a parameter of the rule; may be given several times
    ///
    /// The value may be an expression: --set angle=180/7. A complex parameter has a value [RE,IM] or a formula of i, such as
    /// '1/(2 - i)', which shells require in quotes. `kfrac info RULE` lists the parameters.
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

    /// Finds and reads the rule.
    pub(super) fn document(&self, catalogue: &Catalogue) -> Result<Arc<Document>, Failure> {
        Ok(input::document(&self.source(catalogue)?, catalogue)?.into())
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

    /// Returns the members of a family of the settings of this rule, each with the settings that vary.
    pub(super) fn load_family(
        &self,
        family: &Family,
        catalogue: &Catalogue,
        quiet: bool,
    ) -> Result<Vec<Member>, Failure> {
        let document = self.document(catalogue)?;
        let members = family
            .members()
            .into_iter()
            .enumerate()
            .map(|(number, own)| {
                let settings = [family.fixed(), &own].concat();
                let document = Arc::clone(&document);
                let mut loaded = self.resolve(document, settings, quiet || number > 0)?;
                loaded.settings = family.fixed().to_vec();
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
        let omitted = self.omit.clone();
        Ok(Loaded::new(name, document, model, settings, omitted))
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
