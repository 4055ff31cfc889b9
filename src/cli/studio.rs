//! `kfrac studio`: a page in the browser that shows, steps and changes a rule.

use std::path::PathBuf;

use clap::ValueHint;

use crate::catalogue::Catalogue;
use crate::studio::{Studio, StudioError, StudioOptions};

use super::{Failure, family, help, number, output, text};

/// Opens a page in the browser that shows, steps and changes a rule
///
/// The page shows the picture that `kfrac grow` writes, to the byte; it steps forwards and backwards, zooms without
/// end, has a slider for each parameter, and an editor that marks mistakes. It is served to this machine only, at an
/// address that holds a key. Ctrl-C ends it.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// Rule file, or name of a rule in the library [default: pythagoras]
    ///
    /// A rule of the library is opened as a copy that is not saved yet.
    #[arg(value_name = "RULE")]
    rule: Option<PathBuf>,
    /// Port of the page [default: any that is free]
    #[arg(long, value_name = "N", value_parser = number::whole("a port", 1..=u16::MAX))]
    port: Option<u16>,
    /// Prints the address of the page without opening a browser
    #[arg(long)]
    no_open: bool,
    /// Sets a parameter of the rule; may be given several times
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    set: Vec<String>,
    /// Seed of random draws
    #[arg(long, value_name = "S", default_value_t = 0)]
    #[arg(value_parser = number::whole("a seed", 0..=u64::MAX), allow_negative_numbers = true, value_hint = ValueHint::Other)]
    seed: u64,
}

const MORE: &str = "\
Examples:
  kfrac studio
      Opens the Pythagoras tree
  kfrac studio mine.yaml
      Opens a rule from a file; changes of the file by an editor arrive
  kfrac studio pythagoras --set angle=30 --no-open
      Prints the address of the page, with a parameter set
";

/// Checks the value of a parameter, and keeps it as written.
fn setting(text: &str) -> Result<String, String> {
    family::assignment(text).map(|_| text.to_owned())
}

pub(super) fn run(arguments: &Arguments, catalogue: Catalogue) -> Result<(), Failure> {
    let options = StudioOptions::default()
        .rule(arguments.rule.clone())
        .library(catalogue.first_folder().map(PathBuf::from))
        .catalogue(catalogue)
        .settings(arguments.set.clone())
        .seed(arguments.seed)
        .port(arguments.port.unwrap_or(0));
    let studio = Studio::bind(options).map_err(|error| match error {
        StudioError::File(diagnostics) => Failure::File(diagnostics),
        other => anyhow::Error::new(other).into(),
    })?;
    let url = studio.url();
    output::print(&format!("{url}\n"))?;
    if !arguments.no_open && open::that_detached(&url).is_err() {
        text::print_message("note: no browser could be opened: open the address above");
    }
    studio
        .serve()
        .map_err(|error| anyhow::Error::new(error).into())
}
