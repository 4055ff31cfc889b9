//! `kfrac schema`: what editors want to know of rule files.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use crate::catalogue::Shelf;
use crate::document::schema;

use super::{Failure, help, output};

/// Prints the JSON Schema of rule files, for editors
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// The kind of file
    #[arg(value_name = "KIND", default_value = "rule", value_parser = kind())]
    kind: Shelf,
}

const MORE: &str = "\
Examples:
  kfrac schema > kfrac.schema.json
      Writes the schema that an editor checks rule files with and completes them by; a first line \
# yaml-language-server: $schema=kfrac.schema.json in a rule file names it
  kfrac schema generator > generator.schema.json
      Writes that of a generator in a file of its own
";

/// The kinds as `kfrac list --json` names them; words of the command line are joined by `-` as well.
fn kind() -> impl TypedValueParser<Value = Shelf> {
    let kinds = Shelf::ALL.map(|shelf| match shelf {
        Shelf::BaseElements => PossibleValue::new(shelf.kind()).alias("base-element"),
        _ => PossibleValue::new(shelf.kind()),
    });
    PossibleValuesParser::new(kinds).try_map(|kind| {
        let mut shelves = Shelf::ALL.into_iter();
        let named = shelves.find(|shelf| shelf.kind() == kind.replace('-', "_"));
        named.ok_or("unknown")
    })
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    Ok(output::print(&schema(arguments.kind))?)
}
