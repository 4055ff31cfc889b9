//! `kfrac show`: the production rule as a figure.

use std::path::PathBuf;

use clap::ValueHint;

use crate::catalogue::Catalogue;
use crate::document::KindDocument;
use crate::figure::rule;
use crate::model::Model;
use crate::render::{self, RenderError, Size};
use crate::style::{Colour, Named};
use crate::wording;

use super::labels::labels;
use super::picture;
use super::rule::{Loaded, RuleArguments};
use super::{Failure, format, help, length, output, text};

/// Draws a production rule as a figure: initiator, generators, base element
///
/// Fertile sides have an asterisk, directions their number; selection and random functions are put
/// into words (in the manner of Kaandorp 1987, figures 1 to 13).
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    #[command(flatten)]
    rule: RuleArguments,
    /// The file to write, or - for standard output [default: NAME-rule.svg]
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// The format [default: from the extension of the file]
    #[arg(long, value_parser = picture::named::<render::Format>())]
    format: Option<render::Format>,
    /// The long side in pixels, or WIDTHxHEIGHT [default: as small as can be read]
    #[arg(long, value_name = "SIZE", value_parser = length::size)]
    size: Option<Size>,
    /// The colour behind the figure
    #[arg(long, value_name = "COLOR", value_parser = picture::colour)]
    background: Option<Colour>,
    /// Says nothing but what is wrong
    #[arg(long, short)]
    quiet: bool,
}

const MORE: &str = "\
Examples:
  kfrac show dragon
      Draws the rule of the dragon sweep, into dragon-rule.svg
  kfrac show pythagoras --set angle=30 --background white -o rule.png
      Draws a rule with a parameter of one's own, as pixels on white
";

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let format = format::choose(arguments.format, arguments.output.as_deref())?;
    let loaded = arguments.rule.load(catalogue, arguments.quiet)?;
    if let Model::LSystem(_) = loaded.model {
        let name = &loaded.name;
        let message = format!(
            "there is no figure of an L-system's productions: `kfrac cat {name}` shows them, and \
             `kfrac sheet {name}` what they draw"
        );
        return Err(anyhow::anyhow!(message).into());
    }
    let default = arguments.rule.file("-rule", format.name());
    let path = arguments.output.as_ref().unwrap_or(&default);
    let options = arguments.options(&loaded, format);
    let ([width, height], bytes) = output::write(path, arguments.quiet, |out, _| {
        let written = match (&loaded.model, loaded.document.kind()) {
            (Model::Rule(rule), KindDocument::Rule(document)) => {
                rule::write(rule, document, &options, out)
            }
            (Model::Ifs(system), _) => rule::write_system(system, &options, out),
            (Model::Instancing(structure), _) => rule::write_structure(structure, &options, out),
            (Model::Rule(_) | Model::LSystem(_), _) => {
                unreachable!("a model is of its document's kind")
            }
        };
        written.map_err(|error| match error {
            RenderError::Io(error) => output::failed(error, path),
            other => anyhow::Error::new(other).into(),
        })
    })?;
    if !arguments.quiet {
        text::say(&format!(
            "{}: the {} of {}, {width} x {height} pixels, {}",
            output::called(path),
            noun(&loaded.model),
            loaded.name,
            wording::bytes(bytes),
        ));
    }
    Ok(())
}

impl Arguments {
    fn options(&self, loaded: &Loaded, format: render::Format) -> rule::Options {
        let mut options = Vec::new();
        if format != render::Format::Svg {
            options.push(("format", format.name().into()));
        }
        options.extend(self.size.map(|size| ("size", size.to_string())));
        let background = self.background.map(|colour| format!("{colour:#}"));
        options.extend(background.map(|colour| ("background", colour)));
        rule::Options {
            format,
            size: self.size,
            background: self.background,
            labels: labels(loaded, shown(&loaded.model), "show", options),
        }
    }
}

fn noun(model: &Model) -> &'static str {
    match model {
        Model::Rule(_) => "rule",
        Model::Ifs(_) => "system",
        Model::Instancing(_) => "structure",
        Model::LSystem(_) => "L-system",
    }
}

fn shown(model: &Model) -> &'static str {
    match model {
        Model::Rule(_) => "The production rule",
        Model::Ifs(_) => "The system",
        Model::Instancing(_) => "The structure",
        Model::LSystem(_) => "The L-system",
    }
}
