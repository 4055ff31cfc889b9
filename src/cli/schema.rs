//! `kfrac schema`: what editors want to know of files.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use crate::catalogue::Shelf;
use crate::document::{schema, schema_of_all};

use super::{Failure, help, output};

/// Prints the JSON Schema of files, for editors
///
/// Without a kind it is one for all files that kfrac reads: what a file may say depends on its `kind`, and
/// components are known by their keys.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// The kind of file [default: all]
    #[arg(value_name = "KIND", value_parser = kind())]
    kind: Option<Shelf>,
}

const MORE: &str = "\
Examples:
  kfrac schema > kfrac.schema.json
      Writes the schema that an editor checks files with and completes them by; a first line \
# yaml-language-server: $schema=kfrac.schema.json in a file names it
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
    let schema = match arguments.kind {
        Some(kind) => schema(kind),
        None => schema_of_all(),
    };
    Ok(output::print(&schema)?)
}
