//! `kfrac schema`: prints the JSON Schema of files, for editors.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use crate::catalogue::Shelf;
use crate::document::{schema, schema_of_all};

use super::{Failure, help, output};

/// Prints the JSON Schema of rule files, for editors
///
/// Without a kind, the schema covers all files that kfrac reads: the allowed keys depend on the `kind` of a
/// file, and components are recognised by their keys.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// Kind of file [default: all]
    #[arg(value_name = "KIND", value_parser = kind())]
    kind: Option<Shelf>,
}

const MORE: &str = "\
Examples:
  kfrac schema > kfrac.schema.json
      Writes the schema for validation and completion in an editor; a file names it in its first line, \
# yaml-language-server: $schema=kfrac.schema.json
  kfrac schema generator > generator.schema.json
      Writes the schema of generators in files of their own
";

/// Returns a parser for the kinds as `kfrac list --json` names them; `-` is accepted for `_`.
fn kind() -> impl TypedValueParser<Value = Shelf> {
    let kinds = Shelf::all().map(|shelf| match shelf {
        Shelf::BaseElements => PossibleValue::new(shelf.kind()).alias("base-element"),
        _ => PossibleValue::new(shelf.kind()),
    });
    PossibleValuesParser::new(kinds).try_map(|kind| {
        let mut shelves = Shelf::all();
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
