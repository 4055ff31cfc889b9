//! The rule that a command works on, found and resolved.

use std::ffi::OsStr;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use etcetera::BaseStrategy;

use crate::catalogue::Catalogue;
use crate::diagnostic::{Diagnostic, Severity, Source, did_you_mean};
use crate::document::{Document, Setting};
use crate::expression::{Expression, Scope};
use crate::graph::Graph;
use crate::model::Model;

use super::{Failure, text};

/// The catalogue of the folders that were given, of `$KFRAC_LIBRARY`, of the user's data folder
/// and of the embedded library, in this order. Only those that were given must be there.
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

/// A rule, and how its parameters are set.
#[derive(clap::Args)]
pub(super) struct RuleArguments {
    /// A rule file, the name of a rule in the library, or - for standard input
    #[arg(value_name = "RULE")]
    pub(super) rule: PathBuf,
    /// Sets a parameter of the rule; it may be given several times
    ///
    /// The value may be an expression: --set angle=180/7. `kfrac info RULE` lists the parameters.
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    pub(super) set: Vec<Setting>,
}

pub(super) fn setting(text: &str) -> Result<Setting, String> {
    let (name, value) = text.split_once('=').ok_or("write NAME=VALUE")?;
    let program = Expression::parse(value)
        .and_then(|expression| expression.compile(&Scope::new()))
        .map_err(|error| match error.hint {
            Some(hint) => format!("{} ({hint})", error.message),
            None => error.message,
        })?;
    match program.as_constant() {
        Some(value) if value.is_finite() => Ok(Setting {
            name: name.trim().into(),
            value,
        }),
        _ => Err("the value is not finite".into()),
    }
}

/// A rule that has been read.
pub(super) struct Loaded {
    /// What messages call it.
    pub(super) name: String,
    pub(super) document: Document,
    pub(super) model: Model,
    /// The parameters that were set.
    pub(super) settings: Vec<Setting>,
}

impl Loaded {
    /// The graph, resolved for a number of steps.
    pub(super) fn compile(&self, steps: u32) -> Result<Graph, Failure> {
        let compiled = self.model.compile(steps);
        compiled.map_err(|error| self.model.diagnostic(&error).into())
    }
}

/// Standard input, to the most that a rule file may have.
fn standard_input() -> Result<Arc<Source>, Failure> {
    let most = u64::try_from(Source::MOST_BYTES).unwrap_or(u64::MAX) + 1;
    let mut bytes = Vec::new();
    std::io::stdin().lock().take(most).read_to_end(&mut bytes)?;
    Ok(Source::read("<stdin>", bytes)?)
}

/// The text that `argument` names.
pub(super) fn open(argument: &Path, catalogue: &Catalogue) -> Result<Arc<Source>, Failure> {
    if argument == Path::new("-") {
        return standard_input();
    }
    Ok(catalogue.rule(argument)?)
}

/// The name of a rule, without folder and extension.
pub(super) fn name_of(argument: &Path) -> &OsStr {
    let is_rule_file = argument
        .extension()
        .is_some_and(|extension| extension == "yaml" || extension == "yml" || extension == "json");
    let name = if is_rule_file {
        argument.file_stem()
    } else {
        argument.file_name()
    };
    name.filter(|name| *name != "-")
        .unwrap_or(OsStr::new("stdin"))
}

impl RuleArguments {
    /// The file in the current folder that something made from the rule is written to.
    pub(super) fn file(&self, suffix: &str, extension: &str) -> PathBuf {
        let mut name = name_of(&self.rule).to_os_string();
        name.push(suffix);
        name.push(".");
        name.push(extension);
        name.into()
    }

    /// Finds, reads and resolves the rule; warnings are said.
    pub(super) fn load(&self, catalogue: &Catalogue, quiet: bool) -> Result<Loaded, Failure> {
        let source = open(&self.rule, catalogue)?;
        self.resolve(Document::read(&source, catalogue)?, quiet)
    }

    /// Resolves the rule when it has been read.
    pub(super) fn resolve(&self, document: Document, quiet: bool) -> Result<Loaded, Failure> {
        let name = name_of(&self.rule).to_string_lossy().into_owned();
        for setting in &self.set {
            self.check_setting(setting, &document, &name)?;
        }
        let (model, warnings) = document.resolve(&self.set)?;
        if !quiet && !warnings.is_empty() {
            text::complain(&warnings);
        }
        Ok(Loaded {
            name,
            document,
            model,
            settings: self.set.clone(),
        })
    }

    /// What is wrong with a setting is wrong with the command line, not with the file.
    fn check_setting(
        &self,
        setting: &Setting,
        document: &Document,
        rule: &str,
    ) -> Result<(), Failure> {
        let params = &document.heading().params;
        if !params.iter().any(|param| param.name.value == setting.name) {
            let names = params.iter().map(|param| param.name.value.as_str());
            let hint = match did_you_mean(&setting.name, names.clone()) {
                Some(hint) => hint,
                None if params.is_empty() => "it has none".into(),
                None => format!("it has: {}", names.collect::<Vec<_>>().join(", ")),
            };
            let message = format!("{rule} has no parameter '{}' ({hint})", setting.name);
            return Err(Failure::Usage(message));
        }
        let others: Vec<_> = self
            .set
            .iter()
            .filter(|other| other.name == setting.name)
            .cloned()
            .collect();
        let unset = document.resolve(&[]);
        match document.resolve(&others) {
            // The file is right with its own values, so it is this one that is not.
            Err(diagnostics) if unset.is_ok() => {
                let errors = diagnostics
                    .iter()
                    .filter(|diagnostic| diagnostic.severity() == Severity::Error);
                let said: Vec<_> = errors.map(Diagnostic::message).collect();
                let message = format!(
                    "--set {}={}: {}",
                    setting.name,
                    setting.value,
                    said.join("; ")
                );
                Err(Failure::Usage(message))
            }
            _ => Ok(()),
        }
    }
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
