//! `kfrac check`: reports all errors in rule files.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::Serialize;

use crate::catalogue::Catalogue;
use crate::diagnostic::{Diagnostic, Diagnostics, Severity, Source};
use crate::document::Document;
use crate::model::Model;

use super::component::Component;
use super::info::MAX_LISTED;
use super::{Failure, animate, help, output, rule, text};

/// Reports all errors in rule files
///
/// The exit status is 1 if any of the files has an error; warnings alone leave it at 0.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// Rule files, names of rules or components in the library, or - for standard input
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Prints the errors and warnings as JSON
    #[arg(long)]
    json: bool,
}

const MORE: &str = "\
Examples:
  kfrac check mine.yaml
      Reports each error with its place and a correction
  kfrac check rules/*.yaml --json
      Checks several files, with JSON output for an editor
";

/// Diagnostic as it is printed in JSON.
#[derive(Serialize)]
pub(super) struct DiagnosticRow<'a> {
    file: &'a str,
    line: Option<usize>,
    column: Option<usize>,
    severity: &'static str,
    message: &'a str,
    hint: Option<&'a str>,
}

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let mut all = Vec::new();
    for file in &arguments.files {
        let diagnostics = check(file, catalogue).unwrap_or_else(|failure| match failure {
            Failure::File(diagnostics) => diagnostics,
            Failure::Input(error) => Diagnostic::error(format!("{error:#}")).into(),
            _ => Diagnostics::default(),
        });
        all.push((file.to_string_lossy(), diagnostics));
    }
    let wrong = all.iter().any(|(_, diagnostics)| diagnostics.has_errors());
    if arguments.json {
        let rows: Vec<_> = all
            .iter()
            .flat_map(|(file, diagnostics)| {
                let mut rows: Vec<_> = diagnostics.iter().map(|found| row(file, found)).collect();
                rows.sort_by_key(|row| (row.file != *file, row.file, row.line, row.column));
                rows
            })
            .collect();
        output::print_json(&rows)?;
    } else {
        for (file, diagnostics) in &all {
            if diagnostics.is_empty() {
                output::print(&format!("{file}: ok\n"))?;
            } else {
                text::print_diagnostics(diagnostics);
            }
        }
    }
    if wrong {
        Err(Failure::Reported)
    } else {
        Ok(())
    }
}

fn check(file: &Path, catalogue: &Catalogue) -> Result<Diagnostics, Failure> {
    let source = match Component::find(file, catalogue)? {
        Some(component) => component.in_a_rule(),
        None => rule::open(file, catalogue)?,
    };
    Ok(checked(&source, catalogue)?.2)
}

/// Reads, resolves and compiles a rule; returns it with its mistakes that are not of syntax or meaning.
///
/// # Errors
///
/// If the rule cannot be resolved: all mistakes.
pub(crate) fn checked(
    source: &Arc<Source>,
    catalogue: &Catalogue,
) -> Result<(Document, Model, Diagnostics), Diagnostics> {
    let document = Document::read(source, catalogue)?;
    let (model, mut diagnostics) = document.resolve(&[])?;
    diagnostics.extend(model.mistake());
    diagnostics.extend(too_deep(&document, &model));
    diagnostics.extend(animate::mistakes(&document));
    Ok((document, model, diagnostics))
}

/// Returns a warning where a file proposes a number of steps whose sizes are too large to be forecast by `kfrac info`, as far
/// as that is predicted.
fn too_deep(document: &Document, model: &Model) -> Option<Diagnostic> {
    let steps = document.metadata().steps.as_ref()?;
    let error = model.too_deep(model.metadata().steps?, MAX_LISTED)?;
    let hint = match error.deepest() {
        Some(step) => format!("steps: {step}, or fewer symbols and shorter words"),
        None => "fewer symbols and shorter words".into(),
    };
    let warning = Diagnostic::warning(error.to_string());
    Some(warning.at(&steps.place).hint(hint))
}

pub(super) fn row<'a>(file: &'a str, diagnostic: &'a Diagnostic) -> DiagnosticRow<'a> {
    let place = diagnostic.place();
    DiagnosticRow {
        file: place.map_or(file, |place| place.source().name()),
        line: place.map(crate::diagnostic::Place::line),
        column: place.map(crate::diagnostic::Place::column),
        severity: match diagnostic.severity() {
            Severity::Error => "error",
            Severity::Warning => "warning",
        },
        message: diagnostic.message(),
        hint: diagnostic.hint_text(),
    }
}
