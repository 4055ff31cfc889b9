//! `kfrac cat`: prints a rule file.

use std::path::PathBuf;

use crate::catalogue::{Catalogue, Shelf};
use crate::document::Document;

use super::component::Component;
use super::{Failure, help, output, rule};

/// Prints a rule file or a component
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// Rule file, name of a rule or component in the library, or - for standard input
    ///
    /// If a rule and a component share a name, the folder selects the component: generators/koch.
    #[arg(value_name = "RULE")]
    rule: PathBuf,
    /// Inserts the components and rules that the file names
    #[arg(long)]
    inline: bool,
}

const MORE: &str = "\
Examples:
  kfrac cat dragon > mine.yaml
      Copies a rule of the library, to modify and grow it
  kfrac cat --inline pythagoras-30
      Prints a rule together with the rules and components that it is based on
  kfrac cat swaying-roof > generators/mine.yaml
      Copies a component
";

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    if let Some(component) = Component::find(&arguments.rule, catalogue)? {
        return Ok(output::print(without_modeline(component.text()))?);
    }
    let source = rule::open(&arguments.rule, catalogue)?;
    let text = if arguments.inline {
        Document::read(&source, catalogue)?.to_yaml()
    } else {
        without_modeline(source.text()).to_owned()
    };
    Ok(output::print(&text)?)
}

/// Returns the text without the line in which a file of the library names its schema: that path is valid in
/// the library only.
fn without_modeline(text: &str) -> &str {
    match text.split_once('\n') {
        Some((first, rest)) if is_modeline(first.trim_end()) => rest,
        _ => text,
    }
}

fn is_modeline(line: &str) -> bool {
    Shelf::all().any(|shelf| shelf.modeline() == line)
}
