//! `kfrac convert`: converts a fractal to another kind of file.

use std::path::PathBuf;

use clap::ValueHint;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use crate::catalogue::Catalogue;
use crate::convert::{ConvertError, Keeps, Refusal, convert, described};
use crate::kind::Kind;

use super::rule::{Loaded, RuleArguments};
use super::{Failure, help, output};

/// Converts a fractal to a system of maps, objects, a rule or an L-system
///
/// The new file has the same limit set: the limit of infinitely many steps, together with all elements that
/// are kept on the way. Fertile elements become maps, visible infertile ones become condensation sets.
/// Weights, tints and the order of elements are dropped where the new kind has no equivalent, and parameters
/// are replaced by their values. If the fractal has no equivalent in the new kind, the error states why.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    #[command(flatten)]
    rule: RuleArguments,
    /// Kind of the new file
    #[arg(long, value_name = "KIND", value_parser = kind())]
    to: Kind,
    /// Preserves every approximant, not only the limit set
    #[arg(long)]
    approximants: bool,
    /// Output file, or - for standard output
    #[arg(long, short, value_name = "FILE", default_value = "-", value_hint = ValueHint::FilePath)]
    output: PathBuf,
}

const MORE: &str = "\
Examples:
  kfrac convert koch --to ifs
      Prints the Koch curve as a system of four maps
  kfrac convert pythagoras --set angle=30 --to instancing -o tree.yaml
      Writes a tree as objects that instance each other, to tree.yaml
  kfrac convert koch --to ifs --approximants > maps.yaml
      Writes a system with the same approximants at every step
";

fn kind() -> impl TypedValueParser<Value = Kind> {
    let kinds = Kind::ALL.map(|kind| PossibleValue::new(kind.name()).help(described(kind)));
    PossibleValuesParser::new(kinds).try_map(|name| Kind::named(&name).ok_or("unknown"))
}

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let loaded = arguments.rule.load(catalogue, false)?;
    let keeps = if arguments.approximants {
        Keeps::Approximants
    } else {
        Keeps::Limit
    };
    let document = convert(&loaded.model, arguments.to, keeps)
        .map_err(|error| failure(error, &loaded, arguments.to))?;
    output::write_text(&arguments.output, &document.to_yaml())
}

fn failure(error: ConvertError, loaded: &Loaded, to: Kind) -> Failure {
    let name = &loaded.name;
    match error {
        ConvertError::Compile(error) => loaded.model.diagnostic(&error).into(),
        ConvertError::Refused(Refusal::SameKind(_)) => Failure::Usage(format!(
            "{name} is not converted: {error}: `kfrac cat --inline` shows all of it"
        )),
        _ => anyhow::anyhow!("{name} does not become {}: {error}", to.full_name()).into(),
    }
}
