//! `kfrac cat`: the rule file itself.

use std::path::PathBuf;

use crate::catalogue::{Catalogue, Shelf};
use crate::document::Document;

use super::component::Component;
use super::{Failure, help, output, rule};

/// Prints a rule file, or a component, to start from
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// A rule file, the name of a rule or a component in the library, or - for standard input
    ///
    /// Where a rule has the name of a component, the folder tells them apart: generators/koch.
    #[arg(value_name = "RULE")]
    rule: PathBuf,
    /// With the components and rules that it names put into it
    #[arg(long)]
    inline: bool,
}

const MORE: &str = "\
Examples:
  kfrac cat dragon > mine.yaml
      Copies a rule of the library, to change it and grow it
  kfrac cat --inline pythagoras-30
      Shows all of a rule that others are part of
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

/// The text without the line in which a file of the library names its schema: the path would lead
/// nowhere from where the text is put.
fn without_modeline(text: &str) -> &str {
    match text.split_once('\n') {
        Some((first, rest)) if is_modeline(first.trim_end()) => rest,
        _ => text,
    }
}

fn is_modeline(line: &str) -> bool {
    Shelf::ALL.iter().any(|shelf| shelf.modeline() == line)
}
