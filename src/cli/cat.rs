//! `kfrac cat`: the rule file itself.

use std::path::PathBuf;

use crate::catalogue::Catalogue;
use crate::document::Document;

use super::{Failure, output, rule};

/// Prints a rule file, to start from
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// A rule file, the name of a rule in the library, or - for standard input
    #[arg(value_name = "RULE")]
    rule: PathBuf,
    /// With its components and parents put into it
    #[arg(long)]
    inline: bool,
}

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let source = rule::open(&arguments.rule, catalogue)?;
    let text = if arguments.inline {
        Document::read(&source, catalogue)?.to_yaml()
    } else {
        source.text().to_owned()
    };
    Ok(output::print(&text)?)
}
