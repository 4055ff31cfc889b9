//! `kfrac schema`: what editors want to know of rule files.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use crate::catalogue::Shelf;
use crate::document::schema;

use super::{Failure, output};

/// Prints the JSON Schema of rule files, for editors
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The kind of file
    #[arg(value_name = "KIND", default_value = "rule", value_parser = kind())]
    kind: Shelf,
}

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
